//! The capsule.

use fingertip_wrench::{Real, Wrench};

use super::closed_form::{soft_finger, sole, told};
use super::cylinder::on_round_side;
use super::double::{finely, is_steady, spins_little};
use super::ellipsoid::on_sphere;
use super::refined::refined;
use crate::{Search, SoftContact};
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_surfaces::{Capsule, Cylinder, LocalSurface, Sphere};

/// The soft-finger contact on a capsule: of the side, or of the round ends, each by its closed form where
/// it applies.
///
/// # Errors
/// That there is none: [`Search::Complete`], or the pair of points of an end that a pure force grazes.
fn on_capsule<T: Real>(shape: &Capsule<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    let (centre, axis, half) = (shape.centre(), shape.axis(), shape.half_length());
    let torque = wrench.torque_about(&centre);
    // Rounding under a large spin torque, or at a flat angle, moves a contact along the side, and past its
    // ends.
    let is_steady = is_steady(wrench, shape.radius());
    if let Ok(side) = Cylinder::new(centre, axis, shape.radius())
        && let Some(contact) = on_round_side(&centre, &axis, shape.radius(), &wrench.force(), &torque)
        && let contact = if is_steady(&contact) { contact } else { refined(wrench, &side, &contact) }
        && (contact.point - centre).dot(&axis).abs() <= half
    {
        return Ok(contact);
    }
    let mut search = Search::Complete;
    for end in [axis, -axis] {
        // A convex surface has one contact at most; a point of the seam belongs to the side.
        let Ok(ball) = Sphere::new(centre + end * half, shape.radius()) else { continue };
        match on_sphere(&ball, wrench) {
            Ok(contact) if contact.normal.dot(&end) >= T::zero() => return Ok(contact),
            Ok(_) => {}
            Err(pair) => {
                if pair.iter().all(|point| (point - ball.centre()).dot(&end) >= T::zero()) {
                    search = Search::Grazing(pair);
                }
            }
        }
    }
    Err(search)
}

/// The same, in double precision if the type is narrower and the spin torque rules: then rounding decides
/// between the side and an end.
fn on_capsule_finely<T: Real>(shape: &Capsule<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    finely(on_capsule(shape, wrench), spins_little(wrench, shape.radius()), wrench, |wrench| {
        let [half, radius] = [shape.half_length(), shape.radius()].map(Real::to_f64);
        let double = Capsule::new(wide(&shape.centre()), wide(&shape.axis()), half, radius);
        double.ok().map(|double| on_capsule(&double, wrench))
    })
}

soft_finger!(
    /// The closed forms of the side and of the two round ends, each where it applies.
    Capsule,
    |shape, wrench, _, visit| told(
        on_capsule_finely(shape, wrench).or_else(|search| match search {
            Search::Complete => sole(None, wrench),
            other => Err(other),
        }),
        visit
    ),
    patch | shape,
    point | {
        let (origin, axis) = (wide(&shape.centre()), wide(&shape.axis()));
        let (height, half) = ((point - shape.centre()).dot(&shape.axis()), shape.half_length());
        let radius = shape.radius().to_f64();
        Some(if height.abs() <= half {
            LocalSurface::Cone { origin, axis, radius, taper: [0.0, 1.0] }
        } else {
            LocalSurface::Ball { origin, axis, height: half.copysign(height).to_f64(), radius }
        })
    }
);
