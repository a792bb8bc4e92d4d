//! What a skin does under a force.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::{Hertz, LinearStiffness, PowerLaw, Tabulated};
use crate::Contact;

/// How a skin gives way to a normal force.
///
/// ```
/// use fingertip_contact::{Hertz, Indentation};
///
/// // A barrel with radii of 20 mm and 5 mm and a contact modulus of 1 MPa, pressed on a flat with 2 N.
/// let found: Indentation<f64> = Hertz::new([0.02, 0.005], 1e6)?.indentation(2.0);
/// // The patch is longer along the barrel, and the skin gives way by half a millimetre or so.
/// assert!(found.patch[0] > 2.0 * found.patch[1]);
/// assert!(found.depth > 0.4e-3 && found.depth < 0.8e-3);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Indentation<T: Real> {
    /// How far the skin and what presses on it approach each other \[m\].
    pub depth: T,
    /// Semi-axes of the contact patch, the longer first \[m\].
    pub patch: [T; 2],
}

/// The derivative at a positive number, from central differences.
fn slope<T: Real>(at: T, of: impl Fn(T) -> T) -> T {
    let step = at * T::EPSILON.cube_root();
    let (high, low) = (at + step, at - step);
    (of(high) - of(low)) / (high - low)
}

/// How the depth of an indentation changes.
///
/// ```
/// use fingertip_contact::{Compliant, IndentationSlope, PointContact, PowerLaw};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 0.4 mm deep at 1 N, as the 2/3 power of the force: the slope is 2/3 of depth over force.
/// let law = PowerLaw::new([2e-3, 1.0 / 3.0], [4e-4, 2.0 / 3.0])?;
/// let (model, sphere) = (Compliant::new(PointContact::new(0.05)?, law), Sphere::centred(0.01)?);
/// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
/// let found = model.resolve_indented(&push, &sphere, None)?;
/// let slope: IndentationSlope<f64> = model.slope(&found, &sphere);
/// assert!((slope.by_force - 2.0 / 3.0 * 4e-4).abs() < 1e-9 && slope.along == Vector3::zeros());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndentationSlope<T: Real> {
    /// With the normal force \[m/N\].
    pub by_force: T,
    /// From place to place, per metre along the undeformed surface: a vector in the tangent plane.
    pub along: Vector3<T>,
}

/// Depth and patch under a normal force, which may also depend on the place: on the curvature, or on a skin
/// that is thicker here than there. What [`Compliant`](crate::Compliant) takes.
///
/// # For implementers
/// Depth and patch shall be finite, not negative and not falling with the force, and the depth
/// zero at a force of zero. The force given is finite and not negative.
///
/// ```
/// use fingertip_contact::{Compliant, Contact, Indentation, PointContact, SkinLaw};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// /// Foam that gives way by 0.5 mm/N at the tip and half as much below it.
/// struct Foam;
///
/// impl<S> SkinLaw<f64, S> for Foam {
///     fn indentation_at(&self, _: &S, contact: &Contact<f64>, newtons: f64) -> Indentation<f64> {
///         let softness = if contact.normal.z > 0.5 { 5e-4 } else { 2.5e-4 };
///         Indentation { depth: softness * newtons, patch: [2e-3; 2] }
///     }
/// }
///
/// let skin = Compliant::new(PointContact::new(0.05)?, Foam);
/// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
/// let found = skin.resolve_indented(&push, &Sphere::centred(0.01)?, None)?;
/// // 1 mm deep under 2 N.
/// assert!((found.contact.point.z - 0.009).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not say how a skin on `{S}` gives way to a force of `{T}`",
    note = "take `LinearStiffness`, `PowerLaw`, `Hertz` or `Tabulated`, or implement `SkinLaw::indentation_at`"
)]
pub trait SkinLaw<T: Real, S> {
    /// The indentation under a contact on the undeformed surface that presses with a normal force
    /// \[N\].
    fn indentation_at(&self, surface: &S, contact: &Contact<T>, normal_force: T) -> Indentation<T>;

    /// How the depth changes with force and place: what the covariance of a contact needs. The default
    /// takes differences over the force and supposes that the place does not matter.
    fn slope_at(&self, surface: &S, contact: &Contact<T>, normal_force: T) -> IndentationSlope<T> {
        let by_force = slope(normal_force, |force| self.indentation_at(surface, contact, force).depth);
        IndentationSlope { by_force, along: Vector3::zeros() }
    }
}

/// The same law everywhere. (A blanket implementation would shut out laws that depend on the
/// place.)
macro_rules! same_everywhere {
    ($law:ident $(, $points:ident)?) => {
        impl<T: Real, S $(, $points: AsRef<[[T; 3]]>)?> SkinLaw<T, S> for $law<T $(, $points)?> {
            #[inline]
            fn indentation_at(&self, _surface: &S, _contact: &Contact<T>, normal_force: T) -> Indentation<T> {
                self.indentation(normal_force)
            }

            #[inline]
            fn slope_at(
                &self,
                _surface: &S,
                _contact: &Contact<T>,
                normal_force: T,
            ) -> IndentationSlope<T> {
                IndentationSlope { by_force: self.compliance(normal_force), along: Vector3::zeros() }
            }
        }
    };
}

same_everywhere!(Hertz);
same_everywhere!(LinearStiffness);
same_everywhere!(PowerLaw);
same_everywhere!(Tabulated, P);
