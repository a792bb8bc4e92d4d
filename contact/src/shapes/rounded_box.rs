//! The rounded box.

use fingertip_surfaces::numeric::vectors::wide;
use fingertip_surfaces::{LocalSurface, RoundedBox, SmoothSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::soft_finger::closed_form::{soft_finger, told};
use crate::soft_finger::double::{finely, spins_little};
use crate::{GeometrySensitivity, Search, SoftContact, newton_soft_contacts};

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
