//! A wrench as a contact sees it.

use nalgebra::Vector3;
use thiserror::Error;

use crate::{ContactForce, Frame, Real, Wrench, tangents};

/// A point of a surface with its outward unit normal and two tangents: right-handed,
/// `tangent₁ × tangent₂ = normal`.
///
/// ```
/// use fingertip_wrench::{ContactFrame, Wrench};
/// use nalgebra::Vector3;
///
/// // The top of a sphere of 13 mm, and a force that acts there.
/// let top = ContactFrame::new(Vector3::new(0.0, 0.0, 0.013), Vector3::z())?;
/// let wrench: Wrench<f64> = Wrench::from_force_at(&top.point(), Vector3::new(0.3, 0.0, -2.0));
/// let load = top.decompose(&wrench);
/// assert_eq!(load.force.normal, 2.0);
/// assert_eq!(load.force.tangential_magnitude(), 0.3);
/// let again: Wrench<f64> = top.compose(&load);
/// assert!((again - wrench).components().amax() < 1e-15);
/// # Ok::<(), fingertip_wrench::BadNormal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFrame<T: Real> {
    point: Vector3<T>,
    normal: Vector3<T>,
    tangents: [Vector3<T>; 2],
}

/// A wrench taken apart at a contact.
///
/// ```
/// use fingertip_wrench::{ContactFrame, Wrench};
/// use nalgebra::Vector3;
///
/// // A flat tip is pressed off its centre and turned about its normal.
/// let centre = ContactFrame::new(Vector3::zeros(), Vector3::z())?;
/// let (force, torque) = (Vector3::new(0.0, 0.0, -2.0), Vector3::new(0.02, 0.0, 0.001));
/// let wrench: Wrench<f64> = Wrench::on_fingertip(force, torque);
/// let load = centre.decompose(&wrench);
/// assert_eq!(load.force.spin, 0.001);
/// // A point contact carries no such torque: it must be 0.02/2 m away.
/// assert_eq!(load.rolling, Vector3::new(0.02, 0.0, 0.0));
/// # Ok::<(), fingertip_wrench::BadNormal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct ContactLoad<T: Real> {
    /// Normal force, tangential force and spin torque: all that a point or soft-finger contact can
    /// carry.
    pub force: ContactForce<T>,
    /// The part of the torque about the contact point that lies in the tangent plane \[N·m\]: zero
    /// for a single point or soft-finger contact there.
    pub rolling: Vector3<T>,
}

/// A normal without direction.
///
/// ```
/// use fingertip_wrench::ContactFrame;
/// use nalgebra::Vector3;
///
/// let refused = ContactFrame::new(Vector3::z(), Vector3::<f64>::zeros()).unwrap_err();
/// assert_eq!(refused.to_string(), "the point or normal of the contact is zero or not finite");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the point or normal of the contact is zero or not finite")]
pub struct BadNormal;

impl<T: Real> ContactFrame<T> {
    /// From a point \[m\] and an outward normal of any length.
    ///
    /// # Errors
    /// [`BadNormal`] if the normal is zero, or a component of either is NaN or infinite.
    pub fn new(point: Vector3<T>, outward: Vector3<T>) -> Result<Self, BadNormal> {
        let scaled = outward * outward.amax().normalising_factor();
        let length = scaled.norm_squared().root();
        if !(length > T::zero() && length.is_number() && point.iter().all(|x| x.is_number())) {
            return Err(BadNormal);
        }
        let normal = scaled / length;
        let (first, second) = tangents(&normal);
        Ok(Self { point, normal, tangents: [first, second] })
    }

    /// The point \[m\].
    #[inline]
    #[must_use]
    pub const fn point(&self) -> Vector3<T> {
        self.point
    }

    /// The outward unit normal.
    #[inline]
    #[must_use]
    pub const fn normal(&self) -> Vector3<T> {
        self.normal
    }

    /// Two orthogonal unit vectors of the tangent plane.
    #[inline]
    #[must_use]
    pub const fn tangents(&self) -> [Vector3<T>; 2] {
        self.tangents
    }

    /// Takes a wrench of the same frame apart.
    #[inline]
    #[must_use]
    pub fn decompose<F: Frame>(&self, wrench: &Wrench<T, F>) -> ContactLoad<T> {
        let torque = wrench.torque_about(&self.point);
        let spin = torque.dot(&self.normal);
        ContactLoad {
            force: ContactForce::split(&wrench.force(), &self.normal, spin),
            rolling: torque - self.normal * spin,
        }
    }

    /// Puts a wrench together again, about the origin of the frame.
    #[inline]
    #[must_use]
    pub fn compose<F: Frame>(&self, load: &ContactLoad<T>) -> Wrench<T, F> {
        let force = load.force.tangential.vector() - self.normal * load.force.normal;
        let torque = load.rolling + self.normal * load.force.spin;
        Wrench::on_fingertip(force, torque + self.point.cross(&force))
    }
}
