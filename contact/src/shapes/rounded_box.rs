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
crate::batch::each::entering!(RoundedBox, |rounded, push| Some(entry_through_face(rounded, push)));

/// Where the line of a force enters through a flat face: of the planes of the three faces that it comes to, the last. Over
/// edges and corners, which no closed form tells, the incidence is zero.
#[cfg(feature = "batch")]
#[inline(always)]
fn entry_through_face<T: Real>(shape: &RoundedBox<T>, push: &ForceLine<T>) -> Entry<T> {
    let (f, half, rounding) = (push.force(), shape.half_extents(), shape.rounding());
    let s = f.cross(&push.torque()) * (T::one() / push.squared());
    let to = |k: usize| (-half[k].copysign(f[k]) - s[k]) / f[k];
    let [x, y, z] = [to(0), to(1), to(2)];
    let later = |a: T, b: T| select_unpredictable(a > b, a, b);
    let along = later(later(x, y), z);
    let is_last = [x == along, y == along, z == along];
    let point = s + f * along;
    let is_within = |k: usize| is_last[k] | (point[k].abs() <= half[k] - rounding);
    // At a sharp edge it is two of them.
    let sole = (is_last[0] ^ is_last[1] ^ is_last[2]) & !(is_last[0] & is_last[1] & is_last[2]);
    let flat = sole & is_within(0) & is_within(1) & is_within(2);
    let part = |k: usize| select_unpredictable(is_last[k], T::one().copysign(-f[k]), T::zero());
    let normal = Vector3::new(part(0), part(1), part(2));
    let pressing = f.dot(&normal);
    // Exactly on the face.
    let on_face = |k: usize| select_unpredictable(is_last[k], half[k].copysign(-f[k]), point[k]);
    Entry {
        point: Vector3::new(on_face(0), on_face(1), on_face(2)),
        normal,
        incidence_squared: select_unpredictable(flat, pressing * pressing / push.squared(), T::zero()),
        parts: None,
        active: true,
    }
}

#[cfg(all(test, feature = "batch"))]
mod tests {
    use fingertip_surfaces::{ForceLine, RoundedBox};
    use fingertip_wrench::Wrench;
    use nalgebra::Vector3;

    use super::entry_through_face;

    /// Through the middle of every face, and over an edge.
    #[test]
    fn forces_enter_through_faces() {
        let shape = RoundedBox::new(Vector3::new(0.01_f64, 0.007, 0.004), 0.002).unwrap();
        let entry = |at: Vector3<f64>, force: Vector3<f64>| {
            let wrench: Wrench<f64> = Wrench::from_force_at(&at, force);
            entry_through_face(&shape, &ForceLine::new(&wrench, ForceLine::least_squared()).unwrap())
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
        let edge = entry(Vector3::new(0.0099, 0.0069, 0.0), Vector3::new(-1.0, -1.0, 0.0));
        assert_eq!(edge.incidence_squared, 0.0);
    }
}
