//! What the fingertips feel, with how sure it is.

use core::ops::Add;

use fingertip_wrench::{Frame, Real, RigidTransform, Wrench};
use nalgebra::{Matrix3, Matrix6};

use crate::{GraspContact, Hand};

/// A wrench and its covariance \[N², N·N·m, N²·m²\], both about the origin of the frame.
///
/// The sum of what all fingertips feel, in one frame, is what the object loads them with, whatever and wherever the
/// contacts are (`docs/theory/hand.md#grasp-map`).
///
/// ```
/// use fingertip_hand::{Hand, UncertainWrench};
/// use fingertip_wrench::{RigidTransform, Sensor, Wrench};
/// use nalgebra::{Matrix6, Vector3};
///
/// // Two fingertips, 20 mN and 0.2 N·mm of noise each, 0.1 m apart.
/// let noise = Matrix6::from_diagonal(&[4e-4, 4e-4, 4e-4, 4e-8, 4e-8, 4e-8].into());
/// let felt = Wrench::<f64, Sensor>::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
/// let left: RigidTransform<f64, Hand, Sensor> = RigidTransform::translation(Vector3::new(-0.05, 0.0, 0.0));
/// let right: RigidTransform<f64, Hand, Sensor> = RigidTransform::translation(Vector3::new(0.05, 0.0, 0.0));
/// let felt = UncertainWrench { wrench: felt, covariance: noise };
/// let load = felt.expressed_in(&left) + felt.expressed_in(&right);
/// assert_eq!(load.wrench.force().z, -2.0);
/// // The forces' noise at 0.05 m is more in the torque than the torques' own.
/// assert!(load.covariance[(4, 4)] > 2.0 * 4e-4 * 0.05 * 0.05);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct UncertainWrench<T: Real, F: Frame = Hand> {
    /// The wrench.
    pub wrench: Wrench<T, F>,
    /// Its covariance, symmetric.
    pub covariance: Matrix6<T>,
}

impl<T: Real, F: Frame> UncertainWrench<T, F> {
    /// None, for certain: where a sum starts.
    #[must_use]
    pub fn zero() -> Self {
        Self { wrench: Wrench::zero(), covariance: Matrix6::zeros() }
    }

    /// The same in another frame, of which the place is known exactly: `Σ' = X Σ Xᵀ` with `X = [R 0; [t]R R]`.
    #[must_use]
    pub fn expressed_in<To: Frame>(&self, to_from_here: &RigidTransform<T, To, F>) -> UncertainWrench<T, To> {
        let rotation = to_from_here.rotation();
        let origin = to_from_here.origin();
        let mut transport = Matrix6::zeros();
        transport.fixed_view_mut::<3, 3>(0, 0).copy_from(&rotation);
        transport.fixed_view_mut::<3, 3>(3, 3).copy_from(&rotation);
        transport.fixed_view_mut::<3, 3>(3, 0).copy_from(&(origin.cross_matrix() * rotation));
        UncertainWrench {
            wrench: self.wrench.expressed_in(to_from_here),
            covariance: symmetric(&(transport * self.covariance * transport.transpose())),
        }
    }

    /// The sum over fingers; one that is not there is `None`. Errors of different sensors are independent.
    #[must_use]
    pub fn total<const N: usize>(fingers: &[Option<Self>; N]) -> Self {
        fingers.iter().flatten().fold(Self::zero(), |sum, finger| sum + *finger)
    }
}

impl<T: Real, F: Frame> Add for UncertainWrench<T, F> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { wrench: self.wrench + other.wrench, covariance: self.covariance + other.covariance }
    }
}

/// A contact that a fingertip has told: its place and friction, how sure the place is, and what the fingertip feels.
///
/// ```
/// use fingertip_hand::{FingerContact, GraspContact, Hand, UncertainWrench};
/// use fingertip_wrench::{RigidTransform, Sensor};
/// use nalgebra::{Matrix3, Vector3};
///
/// let contact: GraspContact<f64, Sensor> = GraspContact::point(Vector3::z() * 0.01, Vector3::z(), 0.5)?;
/// let finger = FingerContact {
///     contact,
///     point_covariance: Matrix3::from_diagonal(&Vector3::new(1e-8, 4e-8, 0.0)),
///     load: UncertainWrench::zero(),
/// };
/// let turned: RigidTransform<f64, Hand, Sensor> =
///     RigidTransform::from_axis_angle(Vector3::z() * core::f64::consts::FRAC_PI_2, Vector3::zeros())?;
/// let in_hand = finger.expressed_in(&turned);
/// assert!((in_hand.point_covariance[(0, 0)] - 4e-8).abs() < 1e-20);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerContact<T: Real, F: Frame = Hand> {
    /// Where it touches.
    pub contact: GraspContact<T, F>,
    /// Covariance of the place \[m²\].
    pub point_covariance: Matrix3<T>,
    /// What the fingertip feels, about the origin of the frame.
    pub load: UncertainWrench<T, F>,
}

impl<T: Real, F: Frame> FingerContact<T, F> {
    /// The same in another frame, as a pose of this sample gives it.
    #[must_use]
    pub fn expressed_in<To: Frame>(&self, to_from_here: &RigidTransform<T, To, F>) -> FingerContact<T, To> {
        let rotation = to_from_here.rotation();
        let covariance = rotation * self.point_covariance * rotation.transpose();
        FingerContact {
            contact: self.contact.expressed_in(to_from_here),
            point_covariance: (covariance + covariance.transpose()) * T::literal(0.5),
            load: self.load.expressed_in(to_from_here),
        }
    }
}

/// Takes the last digits' asymmetry out.
pub(crate) fn symmetric<T: Real>(matrix: &Matrix6<T>) -> Matrix6<T> {
    (matrix + matrix.transpose()) * T::literal(0.5)
}
