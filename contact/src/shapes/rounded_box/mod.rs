//! The rounded box.

#[cfg(feature = "batch")]
mod entry;
mod parts;

use fingertip_surfaces::numeric::mixed_precision::is_asked_again;
use fingertip_surfaces::numeric::vectors::{larger, largest, length, wide};
use fingertip_surfaces::{ForceLine, LocalSurface, RoundedBox, SmoothSurface, Sphere};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use self::parts::{steeply_in_columns, steeply_on_an_edge, steeply_on_rounded_box};
use super::cylinder::on_round_side;
use super::plane::on_plane;
use super::sphere::on_sphere;
use crate::soft_finger::closed_form::{is_pure_force_of, soft_finger, steady_levers, told};
use crate::soft_finger::double::{finely, is_steady as is_steady_at, narrow, widened};
use crate::soft_finger::resolve::mirrored;
use crate::{GeometrySensitivity, Search, SoftContact, newton_soft_contacts};

/// The contact by the closed forms of all faces, edges and corners: that of which the place is on its own part, or by rounding
/// beside it, and how far.
#[cold]
#[inline(never)]
fn by_parts<T: Real>(shape: &RoundedBox<T>, wrench: &Wrench<T>) -> Option<(SoftContact<T>, T)> {
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
    best.filter(|(_, off)| *off <= T::EPSILON.root() * rounding)
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
    on_sphere(&Sphere::new(centre, rounding).ok()?, wrench, T::EPSILON).ok()
}

/// By the closed form of the part that the contact lies on: under a large spin torque Newton's method goes to and fro between
/// parts, since the curvature jumps at their seams. At flat angles, and where rounding puts the contact beside its part, by
/// Newton's method, and if that does not settle, on the part that it is beside.
///
/// `epsilon` is that of the type in which the wrench was told: a pure force that presses by no more than rounding of it grazes,
/// as on a sphere.
fn search<T: Real>(
    shape: &RoundedBox<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    epsilon: T,
) -> Result<SoftContact<T>, Search<T>> {
    let on_part = by_parts(shape, wrench);
    if let Some((contact, off)) = on_part
        && off.is_zero()
        && is_steady_at(wrench, shape.rounding() * T::literal(1e4))(&contact)
    {
        return Ok(contact);
    }
    let mut found = None;
    let search = newton_soft_contacts(shape, wrench, last, |contact| found = Some(contact));
    if let Some(found) = found {
        return Ok(found);
    }
    if search != Search::Incomplete {
        return Err(search);
    }
    let (found, _) = on_part.ok_or(search)?;
    let force = wrench.force();
    let least = epsilon * T::literal(4.0) * length(&force);
    if -force.dot(&found.normal) > least || !is_pure_force_of(&force, &wrench.torque(), epsilon) {
        return Ok(found);
    }
    let (other, _) = by_parts(shape, &mirrored(wrench)).unwrap_or((found, T::zero()));
    Err(Search::Grazing([found.point, other.point]))
}

/// In double precision if the type is narrower: where the closed forms do not answer, the spin torque rules or the force
/// meets it at a flat angle, and rounding decides between faces, edges and corners. What double precision does not find is
/// left to the type.
fn on_rounded_box<T: Real>(
    shape: &RoundedBox<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    let again = is_asked_again::<T>()
        .then(|| rounded_box_in_double(shape, &widened(wrench), last.map(wide).as_ref()))
        .flatten();
    if let Some(Ok(contact)) = again {
        return Ok(narrow(&contact));
    }
    finely(search(shape, wrench, last, T::EPSILON), is_steady_at(wrench, shape.rounding()), wrench, |_| again)
}

/// [`steady_levers`] in double precision for a narrower type: rounding of a wrench grows by the square of it.
const LEVERS_IN_DOUBLE: f64 = 1024.0;

fn rounded_box_in_double<T: Real>(
    shape: &RoundedBox<T>,
    wrench: &Wrench<f64>,
    last: Option<&Vector3<f64>>,
) -> Option<Result<SoftContact<f64>, Search<f64>>> {
    let double = shape.in_double()?;
    let steep = steeply_in_double(&double, wrench);
    Some(steep.map_or_else(|| search(&double, wrench, last, T::EPSILON.to_f64()), Ok))
}

fn steeply_in_double(double: &RoundedBox<f64>, wrench: &Wrench<f64>) -> Option<SoftContact<f64>> {
    let push = ForceLine::new(wrench, ForceLine::least_squared())?;
    steeply_on_rounded_box(double, &push, LEVERS_IN_DOUBLE)
        .or_else(|| steeply_on_an_edge(double, &push, LEVERS_IN_DOUBLE))
}

soft_finger!(
    RoundedBox,
    |shape, wrench, last, visit| told(on_rounded_box(shape, wrench, last), visit),
    sole | shape,
    push | steeply_on_rounded_box(shape, push, steady_levers()),
    columns | shape,
    push | steeply_in_columns(shape, push),
    exactly | shape,
    wrench | steeply_in_double(&shape.in_double()?, wrench),
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
