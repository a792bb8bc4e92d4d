//! The curvature of an object from how a contact runs over the fingertip while it rolls.

use fingertip_wrench::Real;
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3};
use thiserror::Error;

use super::FingerVelocity;
use crate::track::bad_track::is_ordinary;
use crate::track::fold::Fold;
use crate::track::{BadTrack, Sighting, Tracked};

/// Learns the curvature of an object from a contact that rolls without sliding
/// (`docs/theory/contact.md#rolling-and-sliding`).
///
/// While it rolls, the way of the contact over the fingertip is in proportion to the angle by which finger and object turned
/// against each other; two directions tell all three numbers. The tracker's way lays the fingertip flat; each
/// sighting counts by its own noise. Start anew when it slides or the contact is new. It takes the finger's curvature
/// for constant, as on a sphere, a cylinder or a plane; on other shapes its mean over the way counts.
///
/// ```
/// use fingertip_contact::{FingerVelocity, RollingCurvature, Sighting, Tracker};
/// use fingertip_surfaces::{Sphere, numeric::vectors::tangents};
/// use nalgebra::{Matrix2, Rotation3, Vector3};
///
/// // A fingertip of 13 mm rolls over a ball of 50 mm at 2 rad/s, first about y, then about x of the fingertip.
/// let (tip, ball) = (0.013_f64, 0.05);
/// let (mut tracker, mut rolling) = (Tracker::new(0.026, 0.2)?, RollingCurvature::new(tip)?);
/// let mut normal = -Vector3::z();
/// for axis in [Vector3::y_axis(), Vector3::x_axis()] {
///     for _ in 0..300 {
///         normal = Rotation3::from_axis_angle(&axis, 2e-3) * normal;
///         let way = axis.cross(&normal) * (2.0 * tip);
///         let angular = (way * (1.0 / tip + 1.0 / ball)).cross(&normal);
///         let finger = FingerVelocity { linear: -angular.cross(&(normal * tip)), angular };
///         let seen = Sighting::new(normal * tip, normal, tangents(&normal).into(), Matrix2::identity() * 1e-12)
///             .ok_or("not finite")?;
///         let tracked = tracker.follow(&Sphere::centred(tip)?, Some(&seen), 1e-3).ok_or("lost")?;
///         rolling.roll(&tracked, &seen, &finger, &(Matrix2::identity() / tip), 1e-3);
///     }
/// }
/// let found = rolling.find()?.curvature;
/// assert!((found.m11 - 1.0 / ball).abs() < 2.0 && (found.m22 - 1.0 / ball).abs() < 2.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct RollingCurvature<T: Real> {
    /// The unit of length [m].
    unit: T,
    last: Option<Tracked<T>>,
    /// Of the way over the fingertip [units] and of the angle [rad], in the tangents that are carried along.
    way: Vector2<T>,
    angle: Vector2<T>,
    finger: Matrix2<T>,
    count: u32,
    matrix: SMatrix<T, 5, 5>,
    right: SVector<T, 5>,
}

/// The curvature of an object where it is touched.
///
/// ```
/// # use fingertip_contact::{FingerVelocity, Sighting, Tracker};
/// # use fingertip_surfaces::{Sphere, numeric::vectors::tangents};
/// # use nalgebra::{Matrix2, Rotation3, Vector3};
/// # let tip = 0.013_f64;
/// # let (mut tracker, mut rolling) = (Tracker::new(0.026, 0.2)?, RollingCurvature::new(tip)?);
/// # let mut normal = -Vector3::z();
/// # for axis in [Vector3::y_axis(), Vector3::x_axis()] {
/// #     for _ in 0..300 {
/// #         normal = Rotation3::from_axis_angle(&axis, 2e-3) * normal;
/// #         let way = axis.cross(&normal) * (2.0 * tip);
/// #         let angular = (way / tip).cross(&normal);
/// #         let finger = FingerVelocity { linear: -angular.cross(&(normal * tip)), angular };
/// #         let seen = Sighting::new(normal * tip, normal, tangents(&normal).into(), Matrix2::identity() * 1e-12)
/// #             .ok_or("not finite")?;
/// #         let tracked = tracker.follow(&Sphere::centred(tip)?, Some(&seen), 1e-3).ok_or("lost")?;
/// #         rolling.roll(&tracked, &seen, &finger, &(Matrix2::identity() / tip), 1e-3);
/// #     }
/// # }
/// use fingertip_contact::{ObjectCurvature, RollingCurvature};
///
/// // A fingertip of 13 mm has rolled over a flat table in two directions.
/// let table: ObjectCurvature<f64> = rolling.find()?;
/// assert!(table.curvature.norm() < 3.0);
/// assert!(table.tangents[0].dot(&table.tangents[1]).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectCurvature<T: Real> {
    /// Along the tangents of the last sample \[1/m\], positive where the object is convex.
    pub curvature: Matrix2<T>,
    /// Covariance of its entries 11, 12 and 22 \[1/m²\].
    pub covariance: Matrix3<T>,
    /// The tangents that it refers to.
    pub tangents: [Vector3<T>; 2],
}

/// Why no curvature can be told.
///
/// ```
/// use fingertip_contact::{NoCurvature, RollingCurvature};
///
/// // Nothing has rolled yet.
/// let rolling = RollingCurvature::new(0.013_f64)?;
/// assert_eq!(rolling.find(), Err(NoCurvature::OneDirection));
/// # Ok::<(), fingertip_contact::BadTrack>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NoCurvature {
    /// Nothing has rolled yet, or not in two directions.
    #[error("the contact has not rolled in two directions yet")]
    OneDirection,
    /// The way of the contact does not fit to any object.
    #[error("the contact moved as no rolling object moves it; it may have slid")]
    NotRolling,
}

impl<T: Real> RollingCurvature<T> {
    /// For a fingertip of about this radius \[m\], the unit in which lengths are counted.
    ///
    /// # Errors
    /// [`BadTrack`] unless the radius is positive and its square and the reciprocal of that are finite.
    pub fn new(radius: T) -> Result<Self, BadTrack> {
        let good = radius > T::zero() && is_ordinary(radius);
        BadTrack::check("a curvature from rolling", "radius", "positive and of ordinary size", good)?;
        Ok(Self::fresh(radius))
    }

    /// Takes a sample: what the tracker said of it, where it was seen, how the finger moved since the sample before, the
    /// curvature of the fingertip along the track's tangents \[1/m\], and the time since the sample before \[s\].
    ///
    /// Where the track is new, it starts anew. What is not finite is passed over.
    pub fn roll(
        &mut self,
        tracked: &Tracked<T>,
        sighting: &Sighting<T>,
        finger: &FingerVelocity<T>,
        curvature: &Matrix2<T>,
        time_step: T,
    ) {
        if tracked.is_new() {
            self.reset();
        }
        let time = if time_step > T::zero() { time_step } else { T::zero() };
        let along =
            |tangents: &[Vector3<T>; 2], v: &Vector3<T>| Vector2::new(tangents[0].dot(v), tangents[1].dot(v));
        let (mut way, mut angle) = (self.way, self.angle);
        if let Some(last) = &self.last {
            let Some(fold) = Fold::new(&last.normal, &tracked.normal) else { return };
            way += along(&last.tangents, &fold.flat(&(tracked.point - last.point))) / self.unit;
            angle += along(&tracked.tangents, &tracked.normal.cross(&finger.angular)) * time;
        }
        let Some(fold) = Fold::new(&tracked.normal, &sighting.normal) else { return };
        let seen = way + along(&tracked.tangents, &fold.flat(&(sighting.point - tracked.point))) / self.unit;
        let turned = sighting.tangents().map(|t| along(&tracked.tangents, &fold.flat(&t)));
        let turn = Matrix2::from_columns(&turned);
        let noise = turn * sighting.covariance() * turn.transpose() / (self.unit * self.unit);
        let Some(weight) = noise.try_inverse() else { return };
        let (one, zero) = (T::one(), T::zero());
        let rows = SMatrix::<T, 2, 5>::from_row_slice(&[
            one, zero, angle.x, angle.y, zero, //
            zero, one, zero, angle.x, angle.y,
        ]);
        let matrix = self.matrix + rows.transpose() * weight * rows;
        let right = self.right + rows.transpose() * (weight * seen);
        let mean = self.finger + curvature * self.unit;
        if (matrix.sum() + right.sum() + mean.sum()).is_number() {
            (self.matrix, self.right, self.finger) = (matrix, right, mean);
            (self.way, self.angle, self.last) = (way, angle, Some(*tracked));
            self.count = self.count.saturating_add(1);
        }
    }

    /// The curvature of the object so far.
    ///
    /// # Errors
    /// [`NoCurvature`].
    pub fn find(&self) -> Result<ObjectCurvature<T>, NoCurvature> {
        let tangents = self.last.as_ref().ok_or(NoCurvature::OneDirection)?.tangents;
        // With correlations in the place of the matrix, of which the least pivot says whether directions differ.
        let scale = SVector::<T, 5>::from_fn(|i, _| self.matrix[(i, i)].max(T::zero()).root());
        if !(scale.min() > T::zero()) {
            return Err(NoCurvature::OneDirection);
        }
        let correlation = SMatrix::<T, 5, 5>::from_fn(|i, j| self.matrix[(i, j)] / (scale[i] * scale[j]));
        let factored = correlation.cholesky().ok_or(NoCurvature::OneDirection)?;
        let least = factored.l_dirty().diagonal().min();
        if !(least * least > T::EPSILON * T::literal(256.0)) {
            return Err(NoCurvature::OneDirection);
        }
        let inverse = factored.inverse();
        let inverse = SMatrix::<T, 5, 5>::from_fn(|i, j| inverse[(i, j)] / (scale[i] * scale[j]));
        let solution = inverse * self.right;
        let softness = Matrix2::new(solution[2], solution[3], solution[3], solution[4]);
        let convex = softness.m11 > T::zero() && softness.determinant() > T::zero();
        let total = softness.try_inverse().filter(|_| convex).ok_or(NoCurvature::NotRolling)?;
        let count = T::literal(f64::from(self.count));
        // d(C⁻¹) = −C⁻¹ dC C⁻¹, entry by entry.
        let (a, b, c) = (total.m11, total.m12, total.m22);
        let two = T::literal(2.0);
        let slope = -Matrix3::new(
            a * a,
            two * a * b,
            b * b, //
            a * b,
            a * c + b * b,
            b * c, //
            b * b,
            two * b * c,
            c * c,
        );
        let of_softness: Matrix3<T> = inverse.fixed_view::<3, 3>(2, 2).into_owned();
        let squared = self.unit * self.unit;
        let found = ObjectCurvature {
            curvature: (total - self.finger / count) / self.unit,
            covariance: slope * of_softness * slope.transpose() / squared,
            tangents,
        };
        let good = (found.curvature.sum() + found.covariance.sum()).is_number();
        good.then_some(found).ok_or(NoCurvature::NotRolling)
    }

    /// Forgets all samples.
    pub fn reset(&mut self) {
        *self = Self::fresh(self.unit);
    }

    fn fresh(unit: T) -> Self {
        Self {
            unit,
            last: None,
            way: Vector2::zeros(),
            angle: Vector2::zeros(),
            finger: Matrix2::zeros(),
            count: 0,
            matrix: SMatrix::zeros(),
            right: SVector::zeros(),
        }
    }
}
