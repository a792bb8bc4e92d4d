//! Does the finger stick, roll or slide?

use fingertip_wrench::Real;
use nalgebra::{Matrix2, Matrix3, Vector2};

use super::FingerVelocity;
use crate::track::{BadTrack, Tracked};

const WHAT: &str = "a judge of motion";

/// Tells sticking, rolling and sliding apart, with the probability of each.
///
/// What slides is told by the velocity of the finger at the contact, what rolls by that of the contact over the fingertip;
/// each is compared with its noise (`docs/theory/contact.md#rolling-and-sliding`). Before a sample the three are equally
/// probable, and velocities of what moves have the deviation `speed`.
///
/// ```
/// use fingertip_contact::{Continuity, FingerVelocity, MotionJudge, Tracked};
/// use nalgebra::{Matrix2, Vector2, Vector3};
///
/// let judge = MotionJudge::new(0.01, 0.0005, 0.01)?;
/// let tracked = Tracked {
///     point: Vector3::new(0.0, 0.0, -0.013),
///     normal: -Vector3::z(),
///     tangents: [Vector3::x(), -Vector3::y()],
///     velocity: Vector3::x() * 0.013,
///     position_covariance: Matrix2::identity() * 1e-8,
///     velocity_covariance: Matrix2::identity() * 1e-6,
///     innovation: Vector2::zeros(),
///     surprise: 0.0,
///     continuity: Continuity::Followed,
/// };
/// let rolls = FingerVelocity { linear: Vector3::x() * 0.013, angular: Vector3::y() };
/// assert!(judge.judge(&tracked, &rolls).ok_or("no numbers")?.rolling > 0.9);
/// let slides = FingerVelocity { linear: Vector3::x() * 0.013, angular: Vector3::zeros() };
/// assert!(judge.judge(&tracked, &slides).ok_or("no numbers")?.sliding > 0.9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionJudge<T: Real> {
    /// Variances: of what moves, and of the finger's velocity, linear and angular.
    moving: T,
    linear: T,
    angular: T,
}

/// The probability of each; they add up to one.
///
/// ```
/// use fingertip_contact::{FingerVelocity, MotionJudge, Motions, Sighting, Tracker};
/// use fingertip_surfaces::Sphere;
/// use nalgebra::{Matrix2, Vector3};
///
/// // A contact that stays at the lowest point of a ball of 13 mm, seen to 0.01 mm, while the finger rests.
/// let (ball, normal) = (Sphere::centred(0.013)?, -Vector3::z());
/// let seen = Sighting::new(normal * 0.013, normal, [Vector3::x(), -Vector3::y()], Matrix2::identity() * 1e-10);
/// let mut tracker = Tracker::new(0.01, 0.1)?;
/// let tracked = (0..500).filter_map(|_| tracker.follow(&ball, seen.as_ref(), 1e-3)).last().ok_or("no contact")?;
/// let rests = FingerVelocity { linear: Vector3::zeros(), angular: Vector3::zeros() };
/// let motions: Motions<f64> = MotionJudge::new(0.01, 5e-4, 0.01)?.judge(&tracked, &rests).ok_or("no numbers")?;
/// assert!(motions.sticking > 0.9);
/// assert!((motions.sticking + motions.rolling + motions.sliding - 1.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Motions<T: Real> {
    /// The contact stays where it is, on finger and object.
    pub sticking: T,
    /// It moves over both, and they do not slide.
    pub rolling: T,
    /// The finger slides over the object, whether or not it rolls, too.
    pub sliding: T,
}

impl<T: Real> MotionJudge<T> {
    /// For motions of about `speed` \[m/s\], and a velocity of the finger that is known with a standard deviation of each
    /// component, `linear` \[m/s\] and `angular` \[rad/s\].
    ///
    /// # Errors
    /// [`BadTrack`] unless the speed is positive, the deviations are not negative, and the squares of all are finite.
    pub fn new(speed: T, linear: T, angular: T) -> Result<Self, BadTrack> {
        let [moving, linear_variance, angular_variance] = [speed, linear, angular].map(|x| x * x);
        let positive = speed > T::zero() && moving >= T::LEAST_NORMAL && moving.is_number();
        BadTrack::check(WHAT, "speed", "positive and of ordinary size", positive)?;
        let good = |x: T, square: T| x >= T::zero() && square.is_number();
        let requirement = "not negative and of ordinary size";
        BadTrack::check(WHAT, "noise of the linear velocity", requirement, good(linear, linear_variance))?;
        BadTrack::check(WHAT, "noise of the angular velocity", requirement, good(angular, angular_variance))?;
        Ok(Self { moving, linear: linear_variance, angular: angular_variance })
    }

    /// How probable each is for a contact that is followed while the finger moves so. `None` if numbers are out of range.
    #[must_use]
    pub fn judge(&self, tracked: &Tracked<T>, finger: &FingerVelocity<T>) -> Option<Motions<T>> {
        let [e1, e2] = &tracked.tangents;
        let in_plane = |v: &nalgebra::Vector3<T>| Vector2::new(v.dot(e1), v.dot(e2));
        let c = &tracked.point;
        let sliding = in_plane(&finger.sliding(c, &tracked.normal));
        // Of v + ω × c: by noise of v, of ω on the arm c, and of c.
        let arm = (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * self.angular;
        let across = e1.dot(&(arm * e2));
        let of_arm = Matrix2::new(e1.dot(&(arm * e1)), across, across, e2.dot(&(arm * e2)));
        let spin = finger.angular.dot(&tracked.normal);
        let quarter = Matrix2::new(T::zero(), -spin, spin, T::zero());
        let of_place = quarter * tracked.position_covariance * quarter.transpose();
        let noise = Matrix2::identity() * self.linear + of_arm + of_place;
        let slides = self.evidence(&sliding, &noise)?;
        let runs = self.evidence(&tracked.velocity_in_plane(), &tracked.velocity_covariance)?;
        // Logarithms: sticking 0, rolling, and sliding with or without rolling, which are equally probable.
        let most = runs.max(T::zero());
        let either =
            most + (((-most).exponential() + (runs - most).exponential()) * T::literal(0.5)).logarithm();
        let together = slides + either;
        let top = most.max(together);
        let [stick, roll, slide] = [T::zero(), runs, together].map(|log| (log - top).exponential());
        let sum = stick + roll + slide;
        let motions = Motions { sticking: stick / sum, rolling: roll / sum, sliding: slide / sum };
        (motions.sticking + motions.rolling + motions.sliding).is_number().then_some(motions)
    }

    /// The logarithm of the likelihood that a velocity with this noise is that of something that moves, over that of
    /// something at rest. Certain of a velocity, of no noise at all, it takes a millionth of `speed` for its noise.
    fn evidence(&self, velocity: &Vector2<T>, noise: &Matrix2<T>) -> Option<T> {
        let floor = self.moving * T::EPSILON;
        let rest = noise + Matrix2::identity() * floor;
        let moving = rest + Matrix2::identity() * self.moving;
        let half = T::literal(0.5);
        let log = |m: &Matrix2<T>| -> Option<T> {
            // In units of the speed, so that no determinant leaves the range.
            let scaled = m / self.moving;
            let unit = velocity / self.moving.root();
            let determinant = scaled.m11 * scaled.m22 - scaled.m12 * scaled.m21;
            let inverse = Matrix2::new(scaled.m22, -scaled.m12, -scaled.m21, scaled.m11) / determinant;
            let square = unit.dot(&(inverse * unit));
            (determinant > T::zero() && (square + determinant).is_number())
                .then(|| -(square + determinant.logarithm()) * half)
        };
        Some(log(&moving)? - log(&rest)?)
    }
}
