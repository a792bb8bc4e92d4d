//! What a wrench and a tactile array together say.

use fingertip_wrench::Real;
use nalgebra::{Matrix3, Vector3};

use super::Grip;

/// One contact of the estimate.
///
/// ```
/// # use fingertip_contact::{ArrayContact, Fusion};
/// # use fingertip_surfaces::Plane;
/// # use fingertip_wrench::Wrench;
/// # use nalgebra::{Matrix3, Matrix6, Vector3};
/// # let pad = Plane::new(Vector3::zeros(), Vector3::z())?;
/// # let sensor = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// # let wrench = Wrench::on_fingertip(Vector3::new(0.2, 0.0, -1.0), Vector3::zeros());
/// // The array knows the force to 0.1 N, the sensor to 10 mN: of a single contact nearly all is told by the wrench.
/// let reading = ArrayContact {
///     centroid: Vector3::zeros(),
///     centroid_covariance: Matrix3::identity() * 1e-8,
///     normal_force: 1.05,
///     normal_deviation: 0.1,
/// };
/// let [contact] = Fusion::new(sensor, 0.5)?.estimate(&pad, &wrench, &[reading])?.contacts;
/// assert!((contact.force - Vector3::new(0.2, 0.0, -1.0)).norm() < 0.02 && contact.share_from_wrench > 0.9);
/// assert!(contact.force_covariance[(2, 2)] < 1e-4);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct FusedContact<T: Real> {
    /// Where \[m\], on the surface.
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// Force on the fingertip \[N\].
    pub force: Vector3<T>,
    /// Covariance of the point \[m²\], of rank 2, to first order.
    pub point_covariance: Matrix3<T>,
    /// Covariance of the force \[N²\] before the cone cuts anything off: where
    /// [`grip`](Self::grip) is not [`Grip::Sticks`] the force is known better than that.
    pub force_covariance: Matrix3<T>,
    /// How much of the variance of the force the wrench removed: 1, nearly all is known from the
    /// wrench; 0, nothing.
    pub share_from_wrench: T,
    /// Where in its friction cone the force lies.
    pub grip: Grip,
}

/// The estimate.
///
/// ```
/// # use fingertip_contact::{ArrayContact, Fusion};
/// # use fingertip_surfaces::Plane;
/// # use fingertip_wrench::Wrench;
/// # use nalgebra::{Matrix3, Matrix6, Vector3};
/// # let pad = Plane::new(Vector3::zeros(), Vector3::z())?;
/// # let sensor = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// # let fusion = Fusion::new(sensor, 0.5)?;
/// # let reading = |x: f64| ArrayContact {
/// #     centroid: Vector3::new(x, 0.0, 0.0),
/// #     centroid_covariance: Matrix3::identity() * 1e-8,
/// #     normal_force: 1.0,
/// #     normal_deviation: 0.1,
/// # };
/// // The array feels 1 N ± 0.1 N at each of two places, 6 mm apart.
/// let readings = [reading(-0.003), reading(0.003)];
/// let two_newtons = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
/// let fused = fusion.estimate(&pad, &two_newtons, &readings)?;
/// // Forces that pull the two apart cancel; of these the wrench says nothing.
/// assert!(fused.settled && fused.internal_forces == 1 && fused.disagreement < 1.0);
/// // A sensor that says 4 N tells of something that the array does not see.
/// let four_newtons = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -4.0), Vector3::zeros());
/// assert!(fusion.estimate(&pad, &four_newtons, &readings)?.disagreement > 100.0);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fused<T: Real, const K: usize> {
    /// In the order of the readings.
    pub contacts: [FusedContact<T>; K],
    /// `yᵀS⁻¹y` for the difference between the wrench and what the array alone predicts, linearised
    /// at the estimate: follows χ² with six degrees of freedom if the readings are right. Much more,
    /// and a contact is missing.
    pub disagreement: T,
    /// Dimension of the forces that the wrench cannot see: 0, 1, 3, 6 for one to four contacts, one
    /// more for three or four of them in a line.
    pub internal_forces: u8,
    /// `false` if the iteration ended at its bound, or where the readings contradict the wrench by so
    /// much that it found no rest: see [`disagreement`](Self::disagreement).
    pub settled: bool,
}
