//! Where lines of action enter a rounded box, without a branch: for columns.

use core::hint::select_unpredictable;

use fingertip_surfaces::{Entry, ForceLine, RoundedBox};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::parts::{beyond, part_of};

crate::batch::each::entering!(RoundedBox, |rounded, push| Some(entry_of_rounded_box(rounded, push)));

/// Where the line of a force enters: through a flat face, or over the edge or corner that its place in the plane of that face
/// is beyond. Otherwise the incidence is zero.
#[inline(always)]
fn entry_of_rounded_box<T: Real>(shape: &RoundedBox<T>, push: &ForceLine<T>) -> Entry<T> {
    let (f, half, rounding) = (push.force(), shape.half_extents(), shape.rounding());
    let (core, share) = (half.map(|half| half - rounding), T::one() / push.squared());
    let (zero, one) = (T::zero(), T::one());
    let s = f.cross(&push.torque()) * share;
    // Of the planes of the three faces that the line comes to, the last.
    let to = |k: usize| (-half[k].copysign(f[k]) - s[k]) / f[k];
    let [x, y, z] = [to(0), to(1), to(2)];
    let later = |a: T, b: T| select_unpredictable(a > b, a, b);
    let along = later(later(x, y), z);
    let is_last = [x == along, y == along, z == along];
    let place = s + f * along;
    // At a sharp edge two planes are last, and it is none.
    let part = |k: usize| select_unpredictable(is_last[k], one.copysign(-f[k]), beyond(place[k], core[k]));
    let side = Vector3::new(part(0), part(1), part(2));
    let sole = (is_last[0] ^ is_last[1] ^ is_last[2]) & !(is_last[0] & is_last[1] & is_last[2]);
    let flat = sole & (side.norm_squared() <= one);
    let pressing = f.dot(&side);
    let (_, next) = over(&side, &core, rounding, &s, push);
    let (far, last) = over(&next, &core, rounding, &s, push);
    // Where the second is the part of the first again, both say the same.
    let is_round = sole & (next.norm_squared() > one) & (last == next);
    // Exactly on the face.
    let on_face = |k: usize| select_unpredictable(is_last[k], half[k].copysign(-f[k]), place[k]);
    let point = |k: usize| select_unpredictable(flat, on_face(k), far.point[k]);
    let normal = |k: usize| select_unpredictable(flat, side[k], far.normal[k]);
    let round = select_unpredictable(is_round, far.incidence_squared, zero);
    Entry {
        point: Vector3::new(point(0), point(1), point(2)),
        normal: Vector3::new(normal(0), normal(1), normal(2)),
        incidence_squared: select_unpredictable(flat, pressing * pressing * share, round),
        parts: None,
        active: true,
    }
}

/// Where the line of a force with this foot enters the cylinder or ball, whole, of the edge or corner on this side of the core,
/// and on which side that place is.
///
/// With the foot `q` from the core's edge or corner and the force `f`, both without what is along an edge:
/// `|f|² t² + 2 q·f t + |q|² = r²`, whose discriminant is `|f|² r² − |f × q|²`. What rounding makes of a far foot turns the
/// normal by as many roundings as the foot is radii away: of a foot beyond [`FARTHEST`] of them the incidence is zero.
#[inline(always)]
fn over<T: Real>(
    side: &Vector3<T>,
    core: &Vector3<T>,
    rounding: T,
    foot: &Vector3<T>,
    push: &ForceLine<T>,
) -> (Entry<T>, Vector3<T>) {
    let (zero, one, f) = (T::zero(), T::one(), push.force());
    let centre = core.component_mul(side);
    let from_centre = foot - centre;
    let weights = side.component_mul(side);
    let (across, q) = (f.component_mul(&weights), from_centre.component_mul(&weights));
    let (squared, reach) = (across.norm_squared(), rounding * rounding);
    let discriminant = squared * reach - across.cross(&q).norm_squared();
    let along = -(q.dot(&across) + discriminant.root()) / squared;
    let normal = (q + across * along) * (one / rounding);
    let point = centre + (from_centre + f * along);
    let part = |k: usize| part_of(side[k], normal[k], point[k], core[k]);
    let farthest = T::literal(FARTHEST);
    let is_near = q.norm_squared() <= reach * (farthest * farthest);
    let incidence_squared = select_unpredictable(is_near, discriminant / (reach * push.squared()), zero);
    let next = Vector3::new(part(0), part(1), part(2));
    (Entry { point, normal, incidence_squared, parts: None, active: true }, next)
}

/// In radii.
const FARTHEST: f64 = 16.0;

#[cfg(test)]
mod tests {
    use fingertip_surfaces::{ForceLine, RoundedBox};
    use fingertip_wrench::Wrench;
    use nalgebra::Vector3;

    use super::entry_of_rounded_box;

    /// Through the middle of every face.
    #[test]
    fn forces_enter_through_faces() {
        let shape = RoundedBox::new(Vector3::new(0.01_f64, 0.007, 0.004), 0.002).unwrap();
        let entry = |at: Vector3<f64>, force: Vector3<f64>| {
            let wrench: Wrench<f64> = Wrench::from_force_at(&at, force);
            entry_of_rounded_box(&shape, &ForceLine::new(&wrench, ForceLine::least_squared()).unwrap())
        };
        for k in 0..3 {
            for sign in [1.0, -1.0] {
                let mut normal = Vector3::zeros();
                normal[k] = sign;
                let mut point = Vector3::new(1e-3, -5e-4, 7e-4);
                point[k] = sign * shape.half_extents()[k];
                let force = Vector3::new(0.2, -0.1, 0.15) - normal * 2.0;
                let found = entry(point, force);
                assert!((found.point - point).amax() < 1e-15 && found.normal == normal, "{found:?} {point}");
                let squared = force[k] * force[k] / force.norm_squared();
                assert!((found.incidence_squared - squared).abs() < 1e-15);
            }
        }
    }

    /// Over every edge and corner: the place is that of the core and a radius along the normal.
    #[test]
    fn forces_enter_over_edges_and_corners() {
        let (half, rounding) = (Vector3::new(0.01_f64, 0.007, 0.004), 0.002);
        let shape = RoundedBox::new(half, rounding).unwrap();
        let signs = [0.0, 1.0, -1.0];
        let sides = signs.iter().flat_map(|x| signs.iter().flat_map(move |y| signs.map(|z| [*x, *y, z])));
        for side in sides.map(Vector3::from).filter(|side| side.norm_squared() > 1.0) {
            for lean in [Vector3::new(0.9, 1.0, 1.1), Vector3::new(1.2, 0.8, 0.7)] {
                let normal = side.component_mul(&lean).normalize();
                let core =
                    (half.add_scalar(-rounding)).component_mul(&side.map(|x| if x == 0.0 { 0.3 } else { x }));
                let point = core + normal * rounding;
                let force = Vector3::new(0.2, -0.1, 0.15) - normal * 2.0;
                let wrench: Wrench<f64> = Wrench::from_force_at(&point, force);
                let push = ForceLine::new(&wrench, ForceLine::least_squared()).unwrap();
                let found = entry_of_rounded_box(&shape, &push);
                assert!((found.point - point).amax() < 1e-15, "{side:?} {found:?} {point}");
                assert!((found.normal - normal).amax() < 1e-12);
                let cosine = force.dot(&normal) / force.norm();
                assert!((found.incidence_squared - cosine * cosine).abs() < 1e-12);
            }
        }
        // Past an edge, and of a box whose rounding is little beside how far the line is from it.
        let entry = |shape: &RoundedBox<f64>, at: Vector3<f64>| {
            let wrench: Wrench<f64> = Wrench::from_force_at(&at, Vector3::new(-1.0, -1.0, 0.0));
            entry_of_rounded_box(shape, &ForceLine::new(&wrench, ForceLine::least_squared()).unwrap())
        };
        assert!(!(entry(&shape, Vector3::new(0.02, 0.002, 0.0)).incidence_squared > 0.0));
        let sharp = RoundedBox::new(half, 1e-5).unwrap();
        let edge =
            Vector3::new(0.01 - 1e-5, 0.007 - 1e-5, 0.0) + Vector3::new(1e-5, 1e-5, 0.0).normalize() * 1e-5;
        assert_eq!(entry(&sharp, edge).incidence_squared, 0.0);
    }
}
