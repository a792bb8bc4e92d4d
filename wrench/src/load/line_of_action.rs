//! The line along which a wrench's force acts.

use nalgebra::Vector3;
use thiserror::Error;

use crate::scalar::largest::largest;
use crate::{Frame, Real, Wrench};

/// An oriented straight line: points `point + along · direction`.
///
/// ```
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// let line = Line { point: Vector3::new(0.01, 0.0, 0.0), direction: Vector3::z() };
/// assert_eq!(line.at(-0.02), Vector3::new(0.01, 0.0, -0.02));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Line<T: Real> {
    /// A point of the line \[m\]; numerically best if near the surface to be met.
    pub point: Vector3<T>,
    /// Unit vector.
    pub direction: Vector3<T>,
}

impl<T: Real> Line<T> {
    /// The point at a signed distance along the direction \[m\].
    #[inline]
    #[must_use]
    pub fn at(&self, along: T) -> Vector3<T> {
        self.point + self.direction * along
    }
}

/// The axis of a wrench: the line about which it is a force along, and a couple about, one and
/// the same direction.
///
/// With force `f` and torque `m` about the origin (`docs/theory/wrench.md#line-of-action`; Salisbury 1984,
/// equation (1) of Bicchi & Dario 1987):
/// foot point `f × m / |f|²`, direction `f/|f|`, pitch `f·m / |f|²`.
///
/// ```
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 2 N down at x = 10 mm, and a couple of 4 N·mm about the same direction.
/// let force = Vector3::new(0.0, 0.0, -2.0);
/// let couple = Vector3::new(0.0, 0.0, -0.004);
/// let pressed: Wrench<f64> = Wrench::from_force_at(&Vector3::new(0.01, 0.0, 0.03), force);
/// let axis = (pressed + Wrench::on_fingertip(Vector3::zeros(), couple)).line_of_action()?;
/// assert!((axis.line.point - Vector3::new(0.01, 0.0, 0.0)).amax() < 1e-15);
/// assert_eq!(axis.line.direction, -Vector3::z());
/// assert!((axis.pitch - 0.002).abs() < 1e-15); // 4 N·mm over 2 N
/// # Ok::<(), fingertip_wrench::NoLineOfAction>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct LineOfAction<T: Real> {
    /// The line, oriented along the force on the fingertip; its `point` is the one closest to the
    /// origin of the frame.
    pub line: Line<T>,
    /// Pitch `f·m/|f|²` \[m\]: zero for a pure force.
    pub pitch: T,
    /// Magnitude of the force \[N\].
    pub force: T,
}

/// Why a wrench has no line of action.
///
/// ```
/// use fingertip_wrench::{NoLineOfAction, Wrench};
/// use nalgebra::Vector3;
///
/// let couple: Wrench<f64> = Wrench::on_fingertip(Vector3::zeros(), Vector3::new(0.0, 0.0, 0.01));
/// assert_eq!(couple.line_of_action(), Err(NoLineOfAction::NoForce));
/// assert_eq!(NoLineOfAction::NoForce.to_string(), "the force is zero");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NoLineOfAction {
    /// A component is NaN or infinite.
    #[error("the wrench has a component that is not a finite number")]
    NotFinite,
    /// The force is zero: there is no load, or a pure couple.
    #[error("the force is zero")]
    NoForce,
    /// The line lies so far from the origin that its distance cannot be represented.
    #[error("the line of action lies too far away to be represented")]
    TooFar,
}

impl<T: Real, F: Frame> Wrench<T, F> {
    /// The line of action, accurate to a few rounding errors for forces over the whole range of
    /// the type: the components are first brought near 1 by a power of two, and `|f|⁴` is never
    /// formed.
    ///
    /// # Errors
    /// [`NoLineOfAction`] if a component is not finite, if the force is exactly zero, or if the
    /// line is too far away.
    #[inline]
    pub fn line_of_action(&self) -> Result<LineOfAction<T>, NoLineOfAction> {
        let (force, torque) = (self.force(), self.torque());
        let scale = largest(&force).normalising_factor();
        let f = force * scale;
        let m = torque * scale;
        let squared = f.norm_squared();
        let inverse_squared = T::one() / squared;
        let magnitude = squared.root();
        let foot = f.cross(&m) * inverse_squared;
        let pitch = f.dot(&m) * inverse_squared;
        // One test on the way out instead of eight on the way in: any NaN or infinity among the
        // components ends up here, as does a line beyond the range.
        let witness = foot.x + foot.y + foot.z + pitch;
        if witness.is_number() && squared > T::zero() {
            Ok(LineOfAction {
                line: Line { point: foot, direction: f * (magnitude * inverse_squared) },
                pitch,
                // The factor of a power of two is its reciprocal.
                force: magnitude * scale.normalising_factor(),
            })
        } else {
            Err(self.why_no_line())
        }
    }

    #[cold]
    fn why_no_line(&self) -> NoLineOfAction {
        if !self.is_finite() {
            NoLineOfAction::NotFinite
        } else if self.force() == Vector3::zeros() {
            NoLineOfAction::NoForce
        } else {
            NoLineOfAction::TooFar
        }
    }
}
