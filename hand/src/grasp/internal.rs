//! The part of contact forces that the object feels as a whole, and the part with which it is squeezed.

use fingertip_wrench::{ContactForce, Frame, Real};
use nalgebra::Vector4;

use crate::Grasp;
use crate::grasp::spectrum::Spectrum;

/// Contact forces taken apart: `forces = bearing + internal`.
///
/// ```
/// use fingertip_hand::{Grasp, GraspContact, Hand};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let left: GraspContact<f64> = GraspContact::soft(-Vector3::x() * 0.02, Vector3::x(), 0.5, 3e-3)?;
/// let right = GraspContact::soft(Vector3::x() * 0.02, -Vector3::x(), 0.5, 3e-3)?;
/// let grasp = Grasp::new([Some(left), Some(right)]);
/// // 5 N from the left, 4 N from the right: 1 N pushes, and 4.5 N squeeze.
/// let press = |newtons| ContactForce::new(newtons, Vector3::zeros(), 0.0);
/// let parts = grasp.split(&[press(5.0), press(4.0)]);
/// assert!((parts.internal[0].normal - 4.5).abs() < 1e-12 && (parts.internal[1].normal - 4.5).abs() < 1e-12);
/// assert!((parts.bearing[0].normal - 0.5).abs() < 1e-12);
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct SplitForces<T: Real, const N: usize> {
    /// The smallest forces with the wrench of them all: least `Σ f_n² + |f_t|²/μ² + τ²/(μe)²`.
    #[cfg_attr(feature = "serde", serde(with = "serde_big_array::BigArray"))]
    pub bearing: [ContactForce<T>; N],
    /// What is left: forces that cancel, with which the object is squeezed.
    #[cfg_attr(feature = "serde", serde(with = "serde_big_array::BigArray"))]
    pub internal: [ContactForce<T>; N],
}

impl<T: Real, const N: usize, F: Frame> Grasp<T, N, F> {
    /// Takes contact forces apart (`docs/theory/hand.md#internal-forces`). A finger that does not touch has none, and
    /// the spin torque of a point contact is dropped. Forces that are not finite give forces that are not finite.
    #[must_use]
    pub fn split(&self, forces: &[ContactForce<T>; N]) -> SplitForces<T, N> {
        let spectrum = Spectrum::new(self.blocks().flatten());
        let mut sum = nalgebra::Vector6::zeros();
        let mut scaled = [Vector4::zeros(); N];
        let contacts = self.contacts().iter().zip(self.blocks());
        for ((scaled, force), (contact, map)) in scaled.iter_mut().zip(forces).zip(contacts) {
            if let (Some(contact), Some(map)) = (contact, map) {
                *scaled = contact.scaled(force);
                sum += map * *scaled;
            }
        }
        let twist = spectrum.pseudo_solve(&sum);
        let mut parts =
            SplitForces { bearing: [ContactForce::zero(); N], internal: [ContactForce::zero(); N] };
        let contacts = self.contacts().iter().zip(self.blocks()).zip(&scaled);
        let each = parts.bearing.iter_mut().zip(&mut parts.internal);
        for ((bearing, internal), ((contact, map), scaled)) in each.zip(contacts) {
            if let (Some(contact), Some(map)) = (contact, map) {
                let part = map.tr_mul(&twist);
                *bearing = contact.force(&part);
                *internal = contact.force(&(scaled - part));
            }
        }
        parts
    }
}
