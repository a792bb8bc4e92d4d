//! From wrench and surface to contact.

use fingertip_wrench::{ContactForce, Real, Wrench};
use nalgebra::Vector3;

use crate::{Contact, Resolution};

/// An assumption about what the contact can transmit, and how to find the contact under it.
///
/// ```
/// use fingertip_contact::{ContactModel, PointContact, SoftFinger};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// /// Which height a force is felt at \[m\], by whatever model.
/// fn height(model: &impl ContactModel<f64, Sphere<f64>>, sphere: &Sphere<f64>) -> Option<f64> {
///     let wrench = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.01), Vector3::new(0.1, 0.0, -1.0));
///     model.resolve(&wrench, sphere).contact().map(|contact| contact.point.z)
/// }
///
/// let sphere = Sphere::centred(0.01)?;
/// let point = height(&PointContact::new(0.05)?, &sphere).ok_or("no contact")?;
/// let soft = height(&SoftFinger::new(0.05)?, &sphere).ok_or("no contact")?;
/// assert!((point - 0.01).abs() < 1e-12 && (soft - 0.01).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` finds no contact of `{T}` on `{S}`",
    note = "a point contact takes any `ActiveSurface`, a soft finger any `SoftFingerSurface`; both must be of one scalar"
)]
pub trait ContactModel<T: Real, S> {
    /// The contact that explains the wrench. `last` is the contact point of the sample before, if
    /// the caller wants continuity where several points explain the wrench.
    fn resolve_near(&self, wrench: &Wrench<T>, surface: &S, last: Option<&Vector3<T>>) -> Resolution<T>;

    /// [`resolve_near`](Self::resolve_near), and the force of the contact split at its tangent plane, of
    /// which the way to the contact may know more than [`Contact::contact_force`](crate::Contact::contact_force)
    /// can tell afterwards. `None` without a contact.
    #[inline(always)]
    fn feel_near(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> (Resolution<T>, Option<ContactForce<T>>) {
        let resolution = self.resolve_near(wrench, surface, last);
        let force = resolution.contact().map(Contact::contact_force);
        (resolution, force)
    }

    /// The contact that explains the wrench.
    #[inline]
    fn resolve(&self, wrench: &Wrench<T>, surface: &S) -> Resolution<T> {
        self.resolve_near(wrench, surface, None)
    }
}
