//! The contacts of a hand, and what they make of forces.

use fingertip_wrench::{ContactForce, Frame, Real, Wrench};
use nalgebra::{Matrix6x4, Vector3, Vector6};

use crate::{FingerState, GraspContact, Hand};

/// The contacts of a hand with `N` fingers on one object; `None` for a finger that touches nothing.
///
/// ```
/// use fingertip_hand::{Grasp, GraspContact};
/// use nalgebra::Vector3;
///
/// let left = GraspContact::<f64>::soft(Vector3::new(-0.02, 0.0, 0.0), Vector3::x(), 0.5, 3e-3)?;
/// let right = GraspContact::soft(Vector3::new(0.02, 0.0, 0.0), -Vector3::x(), 0.5, 3e-3)?;
/// let grasp = Grasp::new([Some(left), None, Some(right)]);
/// assert_eq!(grasp.touching(), 2);
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grasp<T: Real, const N: usize, F: Frame = Hand> {
    contacts: [Option<GraspContact<T, F>>; N],
    origin: Vector3<T>,
    length: T,
}

impl<T: Real, const N: usize, F: Frame> Grasp<T, N, F> {
    /// From the contacts, all in one frame.
    #[must_use]
    pub fn new(contacts: [Option<GraspContact<T, F>>; N]) -> Self {
        // The first place and the mean of what the others are away from it: no sum of large numbers.
        let mut places = contacts.iter().flatten().map(GraspContact::place);
        let first = places.next().unwrap_or_else(Vector3::zeros);
        let mut count = T::one();
        let mut origin = first;
        for place in places {
            count += T::one();
            origin += (place - origin) / count;
        }
        let mut size = T::zero();
        for contact in contacts.iter().flatten() {
            size = size.max((contact.place() - origin).amax()).max(contact.arm());
        }
        let length = if size > T::zero() && size.is_number() {
            T::one() / size.normalising_factor()
        } else {
            T::one()
        };
        Self { contacts, origin, length }
    }

    /// The grasp of what fingers say, and the forces that they feel: zero of a finger without a contact.
    #[must_use]
    pub fn of_fingers(fingers: &[FingerState<T, F>; N]) -> (Self, [ContactForce<T>; N]) {
        let mut contacts = [None; N];
        let mut forces = [ContactForce::zero(); N];
        for ((contact, force), finger) in contacts.iter_mut().zip(&mut forces).zip(fingers) {
            if let Some(sample) = finger.sample() {
                (*contact, *force) = (Some(sample.contact), sample.force);
            }
        }
        (Self::new(contacts), forces)
    }

    /// The contacts, by finger.
    #[must_use]
    pub const fn contacts(&self) -> &[Option<GraspContact<T, F>>; N] {
        &self.contacts
    }

    /// How many fingers touch.
    #[must_use]
    pub fn touching(&self) -> usize {
        self.contacts.iter().flatten().count()
    }

    /// The mean of the contacts' places \[m\]: torques are weighed about it.
    #[must_use]
    pub const fn centre(&self) -> Vector3<T> {
        self.origin
    }

    /// The length \[m\] by which torques are divided where they are compared with forces: a power of two near the
    /// greatest distance of a contact from the [centre](Self::centre); 1 where there is none.
    #[must_use]
    pub const fn length(&self) -> T {
        self.length
    }

    /// What contact forces are together: the wrench on the fingertips, about the origin of the frame. What it is on
    /// the object is the [reaction](Wrench::reaction).
    #[must_use]
    pub fn wrench(&self, forces: &[ContactForce<T>; N]) -> Wrench<T, F> {
        self.contacts.iter().zip(forces).fold(Wrench::zero(), |sum, (contact, force)| match contact {
            Some(contact) => sum + contact.wrench(force),
            None => sum,
        })
    }

    /// A wrench about the [centre](Self::centre), with torques divided by the [length](Self::length).
    #[inline]
    pub(crate) fn normalised(&self, wrench: &Wrench<T, F>) -> Vector6<T> {
        let torque = wrench.torque_about(&self.origin) / self.length;
        let force = wrench.force();
        Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
    }

    /// The reverse of [`normalised`](Self::normalised).
    pub(crate) fn wrench_of(&self, normalised: &Vector6<T>) -> Wrench<T, F> {
        let [fx, fy, fz, tx, ty, tz] = (*normalised).into();
        let force = Vector3::new(fx, fy, fz);
        let torque = Vector3::new(tx, ty, tz) * self.length;
        Wrench::on_fingertip(force, torque + self.origin.cross(&force))
    }

    /// The block of the grasp map of each contact.
    #[inline]
    pub(crate) fn blocks(&self) -> impl Iterator<Item = Option<Matrix6x4<T>>> {
        self.contacts
            .iter()
            .map(|contact| contact.as_ref().map(|contact| contact.columns(&self.origin, self.length)))
    }
}
