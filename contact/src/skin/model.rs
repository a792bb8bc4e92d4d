//! Contact through a skin.

use fingertip_surfaces::{ActiveSurface, BadShape};
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix3, Vector3};

use super::{Indentation, IndentationSlope, SkinLaw};
use crate::{Contact, ContactModel, NoContact, PointContact, Resolution, SoftFinger};

/// A contact model for a fingertip with a soft skin: under the force the skin's surface gives way,
/// so that the contact lies on the parallel surface below the undeformed one.
///
/// Exactly (`docs/theory/contact.md#the-contact-under-a-skin`): with the depth `δ` of the fingertip's own
/// part of the indentation, the contact is `c = c_s − δ n` below a point `c_s` of the undeformed surface with
/// normal `n`, and `τ n + c × f = m` reads `τ n + c_s × f = m + δ n × f`. So the rigid model, given the
/// torque `m + δ n × f`, finds `c_s`. As `δ` and `n` depend on the answer this is solved by iteration
/// (Broyden's method on the vector `δ n`, at most 40 rigid solutions, usually 4 to 6). No surface
/// but a sphere has its parallel surface among shapes of its kind: to shrink the semi-axes of an
/// ellipsoid instead would put the contact somewhere else.
///
/// Neglecting the skin puts the contact off by about `δ tan φ` along the surface.
///
/// ```
/// use fingertip_contact::{Compliant, ContactModel, LinearStiffness, PointContact};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // A skin of 1 N/mm on a sphere of 10 mm; the object is as soft, and takes half.
/// let law = LinearStiffness::new(1000.0, 0.01)?;
/// let skin = Compliant::new(PointContact::new(0.05)?, law).with_share(0.5)?;
/// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
/// let contact = skin.resolve(&push, &Sphere::centred(0.01)?).into_result()?;
/// assert!((contact.point.z - 9.5e-3_f64).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Compliant<T, M, L> {
    rigid: M,
    law: L,
    share: T,
}

/// [`PointContact`] through a skin.
pub type CompliantPointContact<T, L> = Compliant<T, PointContact<T>, L>;
/// [`SoftFinger`] through a skin.
pub type CompliantSoftFinger<T, L> = Compliant<T, SoftFinger<T>, L>;

/// A contact through a skin.
///
/// ```
/// use fingertip_contact::{Compliant, CompliantContact, LinearStiffness, PointContact};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 1 N on a skin of 1 N/mm.
/// let skin = Compliant::new(PointContact::new(0.05)?, LinearStiffness::new(1000.0, 0.01)?);
/// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
/// let found: CompliantContact<f64> = skin.resolve_indented(&push, &Sphere::centred(0.01)?, None)?;
/// // It lies 1 mm below the sphere of 10 mm.
/// assert!((found.undeformed.z - 0.01).abs() < 1e-9 && (found.contact.point.z - 9e-3).abs() < 1e-9);
/// assert!((found.indentation.depth - 1e-3).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompliantContact<T: Real> {
    /// The contact; its point lies on the deformed surface.
    pub contact: Contact<T>,
    /// The point of the undeformed surface above it \[m\].
    pub undeformed: Vector3<T>,
    /// Approach of skin and object, and the semi-axes of the contact patch \[m\].
    pub indentation: Indentation<T>,
}

impl<T: Real, M, L> Compliant<T, M, L> {
    /// A rigid model under a skin that takes all of the indentation: the object is hard.
    pub fn new(rigid: M, law: L) -> Self {
        Self { rigid, law, share: T::one() }
    }

    /// The skin takes only this share of the indentation, the object the rest:
    /// `c₁/(c₁ + c₂)` with `c = (1 − ν²)/E` of skin and object.
    ///
    /// # Errors
    /// [`BadShape`] unless the share is between 0 and 1.
    pub fn with_share(self, share: T) -> Result<Self, BadShape> {
        BadShape::check(
            "skin",
            "share of the indentation",
            "between 0 and 1",
            share >= T::zero() && share <= T::one(),
        )
        .map(|()| Self { share, ..self })
    }

    /// How the depth of the fingertip's own part of the indentation changes at a contact that was found.
    #[must_use]
    pub fn slope<S>(&self, found: &CompliantContact<T>, surface: &S) -> IndentationSlope<T>
    where
        L: SkinLaw<T, S>,
    {
        let above = Contact { point: found.undeformed, ..found.contact };
        let slope = self.law.slope_at(surface, &above, above.normal_force().max(T::zero()));
        IndentationSlope { by_force: slope.by_force * self.share, along: slope.along * self.share }
    }

    /// The contact together with the indentation and the patch.
    ///
    /// # Errors
    /// What the rigid model says where there is no contact; [`NoContact::Unresolved`] if the
    /// iteration does not settle, as where the skin is softer than the surface is round, or an edge nearer
    /// than the skin is deep.
    pub fn resolve_indented<S>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> Result<CompliantContact<T>, NoContact<T>>
    where
        M: ContactModel<T, S>,
        L: SkinLaw<T, S>,
        S: ActiveSurface<T>,
    {
        let force = wrench.force();
        let evaluate = |shift: &Vector3<T>| {
            let torque = wrench.torque() + shift.cross(&force);
            let effective = Wrench::on_fingertip(force, torque);
            let contact = self.rigid.resolve_near(&effective, surface, last).into_result()?;
            let pressing = contact.normal_force().max(T::zero());
            let indentation = self.law.indentation_at(surface, &contact, pressing);
            let next = contact.normal * (indentation.depth * self.share);
            Ok::<_, NoContact<T>>((contact, indentation, next))
        };
        let mut shift = Vector3::zeros();
        let mut seen = evaluate(&shift)?;
        // Inverse of the Jacobian of `next(shift) − shift`: −1 to begin with, since the shift
        // changes little with itself.
        let mut inverse = -Matrix3::identity();
        let mut residual = seen.2 - shift;
        let half = T::literal(0.5);
        for _ in 0..40 {
            let size = seen.0.point.amax().max(seen.2.amax());
            if residual.amax() <= T::EPSILON * T::literal(4.0) * size {
                let (contact, indentation, shift) = seen;
                let undeformed = contact.point;
                let contact = Contact { point: undeformed - shift, ..contact };
                return Ok(CompliantContact { contact, undeformed, indentation });
            }
            let mut step = -(inverse * residual);
            // A step may lead past the silhouette, where there is no contact: come back.
            let mut next = evaluate(&(shift + step));
            for _ in 0..8 {
                if next.is_ok() {
                    break;
                }
                step *= half;
                next = evaluate(&(shift + step));
            }
            // What the rigid model says of a torque on the way is not true of the wrench.
            seen = next.map_err(|_| NoContact::Unresolved)?;
            shift += step;
            let new_residual = seen.2 - shift;
            let change = new_residual - residual;
            let moved = inverse * change;
            let divisor = step.dot(&moved);
            let update = (step - moved) * (step.transpose() * inverse) / divisor;
            if update.sum().is_number() {
                inverse += update;
            }
            residual = new_residual;
        }
        Err(NoContact::Unresolved)
    }
}

impl<T, M, L, S> ContactModel<T, S> for Compliant<T, M, L>
where
    T: Real,
    M: ContactModel<T, S>,
    L: SkinLaw<T, S>,
    S: ActiveSurface<T>,
{
    fn resolve_near(&self, wrench: &Wrench<T>, surface: &S, last: Option<&Vector3<T>>) -> Resolution<T> {
        match self.resolve_indented(wrench, surface, last) {
            Ok(found) => Resolution::Contact(found.contact),
            Err(reason) => Resolution::NoContact(reason),
        }
    }
}
