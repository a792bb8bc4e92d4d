//! The rounded box.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::closed_form::{soft_finger, told};
use super::double::{finely, spins_little};
use crate::{Search, SoftContact, newton_soft_contacts};
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_surfaces::{LocalSurface, RoundedBox};

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
        let double = RoundedBox::new(wide(&shape.half_extents()), shape.rounding().to_f64()).ok()?;
        let (last, mut found) = (last.map(wide), None);
        let search = newton_soft_contacts(&double, wrench, last.as_ref(), |contact| found = Some(contact));
        Some(found.ok_or(search))
    })
}

soft_finger!(
    RoundedBox,
    |shape, wrench, last, visit| told(on_rounded_box(shape, wrench, last), visit),
    patch | shape,
    point | {
        let (half_extents, rounding) = (wide(&shape.half_extents()), shape.rounding().to_f64());
        let point = wide(point);
        let beyond = core::array::from_fn(|k| point[k].abs() - half_extents[k] + rounding > 0.0);
        Some(LocalSurface::RoundedBox { half_extents, rounding, beyond })
    }
);
