//! The rounded box.

#[cfg(feature = "batch")]
use core::hint::select_unpredictable;

#[cfg(feature = "batch")]
use fingertip_surfaces::Entry;
use fingertip_surfaces::numeric::vectors::{larger, largest, length, wide};
use fingertip_surfaces::{ForceLine, LocalSurface, RoundedBox, SmoothSurface, Sphere};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::cylinder::{on_round_side, steeply_on_round_side};
use super::plane::on_plane;
use super::sphere::{on_sphere, steeply_on_sphere};
use crate::model::flat;
use crate::soft_finger::closed_form::{is_pure_force_of, is_steady, soft_finger, told};
use crate::soft_finger::double::{finely, is_steady as is_steady_at};
use crate::{GeometrySensitivity, Search, SoftContact, newton_soft_contacts};

/// Faces, edges and corners that are tried before the long way is taken.
const PARTS: usize = 5;

/// The contact of a force that presses steeply, by the closed form of a plane, a cylinder or a ball: of the face that the
/// force presses on most, and then of the part that the contact lies on whose place the part before does not hold. A convex
/// body has no other.
#[inline(always)]
fn steeply_on_rounded_box<T: Real>(shape: &RoundedBox<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    let (half, rounding) = (shape.half_extents(), shape.rounding());
    let core = half.map(|half| half - rounding);
    // As near to a sharp edge as rounding brings a contact.
    let inner = core.map(|core| core - half.sum() * (T::literal(64.0) * T::EPSILON));
    let (zero, one) = (T::zero(), T::one());
    let most = push.force().amax();
    // On which side of the core, along which axes: −1, 0 or 1.
    let mut side = push.force().map(|f| if f.abs() >= most { -f.signum() } else { zero });
    for _ in 0..PARTS {
        let centre = core.component_mul(&side);
        let parts = side.norm_squared();
        let found = if parts <= one {
            on_face(&half.component_mul(&side), &side, push)?
        } else if parts <= one + one {
            let along = side.map(|side| if side.is_zero() { one } else { zero });
            steeply_on_round_side((&centre, &along), rounding, push)?.0
        } else {
            let contact = steeply_on_sphere(&Sphere::new(centre, rounding).ok()?, push)?;
            Some(contact).filter(|contact| is_steady(push, contact, rounding * T::literal(0.5)))?
        };
        let beyond = found.point.zip_map(&core, |x, core| if x.abs() > core { x.signum() } else { zero });
        let next = side.zip_zip_map(&found.normal, &beyond, |side, normal, beyond| {
            if side.is_zero() {
                beyond
            } else if normal * side >= zero {
                side
            } else {
                zero
            }
        });
        if next == side {
            let clear = parts > one
                || found.point.zip_zip_map(&inner, &side, |x, inner, side| {
                    if side.is_zero() && !(x.abs() <= inner) { one } else { zero }
                }) == Vector3::zeros();
            return (clear && (found.point.sum() + found.spin_torque).is_number()).then_some(found);
        }
        side = next;
    }
    None
}

/// On the plane through a point with a normal: `docs/theory/contact.md#central-quadrics`. `None` where the force presses
/// at a flat angle, and where the spin torque is more than the force has at a lever as long as the place is far: a plane
/// answers to what rounding of the wrench makes of it in the other torques, and a pose that turns the wrench rounds it.
#[inline(always)]
fn on_face<T: Real>(origin: &Vector3<T>, normal: &Vector3<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    let force = push.force();
    let pressing = -force.dot(normal);
    if !(pressing > T::zero() && pressing * pressing >= flat::<T>() * flat::<T>() * push.squared()) {
        return None;
    }
    let share = T::one() / pressing;
    let point = origin + push.torque_about(origin).cross(normal) * share;
    let spin_torque = -force.dot(&push.torque()) * share;
    let is_steady = spin_torque * spin_torque <= push.squared() * point.norm_squared();
    is_steady.then_some(SoftContact { point, normal: *normal, spin_torque, active: true })
}

/// The contact by the closed forms of all faces, edges and corners: that of which the place is on its own part, or by rounding
/// beside it.
///
/// For what Newton's method does not settle: it goes to and fro where a contact is next to a seam, at which the curvature
/// jumps.
#[cold]
#[inline(never)]
fn by_parts<T: Real>(shape: &RoundedBox<T>, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
    let (half, rounding, zero) = (shape.half_extents(), shape.rounding(), T::zero());
    let core = half.map(|half| half - rounding);
    let force = wrench.force();
    let least = largest(&force) * T::EPSILON * T::literal(4.0);
    let mut best: Option<(SoftContact<T>, T)> = None;
    let signs = [zero, T::one(), -T::one()];
    for side in
        signs.iter().flat_map(|x| signs.iter().flat_map(move |y| signs.map(|z| Vector3::new(*x, *y, z))))
    {
        let Some(found) = on_part(&side, &half, rounding, wrench) else { continue };
        let beside = found.point.zip_zip_map(&core, &side, |x, core, side| {
            if side.is_zero() { larger(x.abs() - core, zero) } else { zero }
        });
        let behind = found.normal.zip_map(&side, |normal, side| larger(-(normal * side), zero) * rounding);
        let off = largest(&beside) + largest(&behind);
        let is_best = best.is_none_or(|(_, least)| off < least);
        if is_best && -force.dot(&found.normal) > least {
            best = Some((found, off));
        }
    }
    best.filter(|(_, off)| *off <= T::EPSILON.root() * rounding).map(|(found, _)| found)
}

/// On the whole plane, cylinder or ball of the part on this side of the core (−1, 0 or 1 along each axis).
fn on_part<T: Real>(
    side: &Vector3<T>,
    half: &Vector3<T>,
    rounding: T,
    wrench: &Wrench<T>,
) -> Option<SoftContact<T>> {
    let (one, parts) = (T::one(), side.norm_squared());
    if parts.is_zero() {
        return None;
    }
    if parts <= one {
        let origin = half.component_mul(side);
        let found = on_plane(side, &wrench.force(), &wrench.torque_about(&origin))?;
        return Some(SoftContact { point: found.point + origin, ..found });
    }
    let centre = half.zip_map(side, |half, side| (half - rounding) * side);
    if parts <= one + one {
        let along = side.map(|side| if side.is_zero() { one } else { T::zero() });
        return on_round_side(&centre, &along, rounding, &wrench.force(), &wrench.torque_about(&centre));
    }
    on_sphere(&Sphere::new(centre, rounding).ok()?, wrench).ok()
}

/// By Newton's method, and where that does not settle, by all parts. Of a pure force, by numbers that are rounded to so much of
/// them, which either hits or misses, only a contact at an angle that rounding does not make: the root of it is what rounding
/// makes of a line that touches.
fn search<T: Real>(
    shape: &RoundedBox<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    epsilon: T,
) -> Result<SoftContact<T>, Search<T>> {
    let mut found = None;
    let search = newton_soft_contacts(shape, wrench, last, |contact| found = Some(contact));
    if found.is_none() && search == Search::Incomplete {
        let force = wrench.force();
        let is_pure = is_pure_force_of(&force, &wrench.torque(), epsilon);
        let least = if is_pure { epsilon.root() * length(&force) } else { T::zero() };
        found = by_parts(shape, wrench).filter(|found| -force.dot(&found.normal) >= least);
    }
    found.ok_or(search)
}

/// In double precision if the type is narrower and the spin torque rules or the force meets it at a flat angle: then rounding
/// decides between faces, edges and corners.
fn on_rounded_box<T: Real>(
    shape: &RoundedBox<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    let found = search(shape, wrench, last, T::EPSILON);
    finely(found, is_steady_at(wrench, shape.rounding()), wrench, |wrench| {
        rounded_box_in_double(shape, wrench, last.map(wide).as_ref())
    })
}

fn rounded_box_in_double<T: Real>(
    shape: &RoundedBox<T>,
    wrench: &Wrench<f64>,
    last: Option<&Vector3<f64>>,
) -> Option<Result<SoftContact<f64>, Search<f64>>> {
    Some(search(&shape.in_double()?, wrench, last, T::EPSILON.to_f64()))
}

soft_finger!(
    RoundedBox,
    |shape, wrench, last, visit| told(on_rounded_box(shape, wrench, last), visit),
    sole | shape,
    push | steeply_on_rounded_box(shape, push),
    double | shape,
    wrench | rounded_box_in_double(shape, wrench, None),
    patch | shape,
    point | {
        let (half_extents, rounding) = (wide(&shape.half_extents()), shape.rounding().to_f64());
        let point = wide(point);
        let beyond = core::array::from_fn(|k| point[k].abs() - half_extents[k] + rounding > 0.0);
        Some(LocalSurface::RoundedBox { half_extents, rounding, beyond })
    },
    sizes | shape,
    size,
    point | of_rounded_box(shape, point).get(size).copied()
);

/// The three half extents, then the rounding: a half extent moves a face with the edges and corners at
/// its rim; a rounding moves edges and corners inward as it grows.
fn of_rounded_box<T: Real>(shape: &RoundedBox<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 4] {
    let level = shape.level(point);
    let sign = point.map(|x| T::one().copysign(x));
    let n = level.gradient;
    let of = |value: T, turned: Vector3<T>| GeometrySensitivity::of_level(value, &turned, &n, &level.hessian);
    let wider = |i: usize| {
        let mut moved = Vector3::zeros();
        moved[i] = sign[i];
        of(-n.dot(&moved), -(level.hessian * moved))
    };
    [wider(0), wider(1), wider(2), of(n.dot(&sign) - T::one(), level.hessian * sign)]
}

#[cfg(feature = "batch")]
crate::batch::each::entering!(RoundedBox, |rounded, push| Some(entry_of_rounded_box(rounded, push)));

/// Where the line of a force enters: through a flat face, or over the edge or corner that its place in the plane of that face
/// is beyond. Otherwise the incidence is zero.
#[cfg(feature = "batch")]
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
#[cfg(feature = "batch")]
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
    let part = |k: usize| {
        let kept = select_unpredictable(normal[k] * side[k] >= zero, side[k], zero);
        select_unpredictable(side[k] == zero, beyond(point[k], core[k]), kept)
    };
    let farthest = T::literal(FARTHEST);
    let is_near = q.norm_squared() <= reach * (farthest * farthest);
    let incidence_squared = select_unpredictable(is_near, discriminant / (reach * push.squared()), zero);
    let next = Vector3::new(part(0), part(1), part(2));
    (Entry { point, normal, incidence_squared, parts: None, active: true }, next)
}

/// On which side a coordinate is beyond the core: −1 or 1, or 0 if it is not.
#[cfg(feature = "batch")]
#[inline(always)]
fn beyond<T: Real>(coordinate: T, core: T) -> T {
    select_unpredictable(coordinate.abs() > core, T::one().copysign(coordinate), T::zero())
}

/// In radii.
#[cfg(feature = "batch")]
const FARTHEST: f64 = 16.0;

#[cfg(all(test, feature = "batch"))]
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
