//! How far each contact is from slipping.

use fingertip_friction::{Coulomb, FrictionModel, SlipMargin, SoftFingerLimit};
use fingertip_wrench::{ContactForce, Frame, Real};

use crate::Grasp;

impl<T: Real, const N: usize, F: Frame> Grasp<T, N, F> {
    /// How far each contact is from slipping under given forces; `None` for a finger that does not touch. The norms
    /// are those of [`Coulomb`] and [`SoftFingerLimit`]. A force that is not finite has a margin of minus the largest
    /// number.
    ///
    /// ```
    /// use fingertip_hand::{Grasp, GraspContact, Hand};
    /// use fingertip_wrench::ContactForce;
    /// use nalgebra::Vector3;
    ///
    /// let contact: GraspContact<f64> = GraspContact::point(Vector3::zeros(), Vector3::z(), 0.5)?;
    /// let grasp = Grasp::new([Some(contact), None]);
    /// let force = ContactForce::new(2.0, Vector3::x() * 0.8, 0.0);
    /// let [margin, none] = grasp.slip_margins(&[force, ContactForce::zero()]);
    /// assert_eq!(none, None);
    /// assert!((margin.expect("it touches").utilisation - 0.8).abs() < 1e-15);
    /// # Ok::<(), fingertip_hand::BadContact>(())
    /// ```
    #[must_use]
    pub fn slip_margins(&self, forces: &[ContactForce<T>; N]) -> [Option<SlipMargin<T>>; N] {
        let mut margins = [None; N];
        for ((margin, contact), force) in margins.iter_mut().zip(self.contacts()).zip(forces) {
            let Some(contact) = contact else { continue };
            *margin = if contact.arm() > T::zero() {
                SoftFingerLimit::new(contact.friction(), contact.arm())
                    .ok()
                    .map(|limit| limit.slip_margin(force))
            } else {
                Coulomb::new(contact.friction()).ok().map(|limit| limit.slip_margin(force))
            };
        }
        margins
    }

    /// The least of the [margins](Self::slip_margins): by how much any one contact force may change before the first
    /// contact slips \[N\]. `None` if no finger touches.
    #[must_use]
    pub fn least_slip_margin(&self, forces: &[ContactForce<T>; N]) -> Option<SlipMargin<T>> {
        let margins = self.slip_margins(forces);
        margins.into_iter().flatten().reduce(|a, b| if b.newtons < a.newtons { b } else { a })
    }
}
