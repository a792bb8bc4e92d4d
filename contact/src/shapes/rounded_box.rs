//! The rounded box.

use fingertip_surfaces::numeric::vectors::wide;
use fingertip_surfaces::{ForceLine, LocalSurface, RoundedBox, SmoothSurface, Sphere};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::cylinder::steeply_on_round_side;
use super::sphere::steeply_on_sphere;
use crate::model::flat;
use crate::soft_finger::closed_form::{is_steady, soft_finger, told};
use crate::soft_finger::double::{finely, spins_little};
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

/// On the plane through a point with a normal: `docs/theory/contact.md#central-quadrics`.
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
    Some(SoftContact { point, normal: *normal, spin_torque, active: true })
}

/// By Newton's method; in double precision if the type is narrower and the spin torque rules: then rounding
/// decides between faces, edges and corners.
fn on_rounded_box<T: Real>(
    shape: &RoundedBox<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    let mut found = None;
    let search = newton_soft_contacts(shape, wrench, last, |contact| found = Some(contact));
    finely(found.ok_or(search), spins_little(wrench, shape.rounding()), wrench, |wrench| {
        rounded_box_in_double(shape, wrench, last.map(wide).as_ref())
    })
}

fn rounded_box_in_double<T: Real>(
    shape: &RoundedBox<T>,
    wrench: &Wrench<f64>,
    last: Option<&Vector3<f64>>,
) -> Option<Result<SoftContact<f64>, Search<f64>>> {
    let double = shape.in_double()?;
    let mut found = None;
    let search = newton_soft_contacts(&double, wrench, last, |contact| found = Some(contact));
    Some(found.ok_or(search))
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
