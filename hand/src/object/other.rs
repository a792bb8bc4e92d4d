//! What touches the object beside the hand.

use fingertip_wrench::{Frame, LineOfAction, NoLineOfAction, Real};
use nalgebra::Vector3;

use crate::object::weight::Whitener;
use crate::{Hand, ObjectWeight, UncertainWrench};

/// What the fingertips feel beyond the weight of the object: what a table, a wall or another hand does to it.
///
/// ```
/// use fingertip_hand::{Hand, ObjectWeight, OtherContact, UncertainWrench};
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix6, Vector3};
///
/// let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let felt = |wrench: Wrench<f64, Hand>| UncertainWrench { wrench, covariance: noise };
/// let mut weight = ObjectWeight::new();
/// for gravity in [-Vector3::z() * 9.81, -Vector3::x() * 9.81] {
///     weight.observe(&felt(Wrench::from_force_at(&Vector3::zeros(), gravity * 0.2)), &gravity);
/// }
/// // It is put down, and the table bears half of it 2 cm to the side.
/// let gravity = -Vector3::z() * 9.81;
/// let table = Wrench::from_force_at(&Vector3::new(0.02, 0.0, -0.05), Vector3::z() * 0.981);
/// let load = felt(Wrench::from_force_at(&Vector3::zeros(), gravity * 0.2) + table);
/// let other = OtherContact::new(&load, &weight, &gravity).expect("the weight is known");
/// assert!(other.touches(1e-3));
/// let line = other.line.expect("one contact");
/// assert!((line.line.point.x - 0.02).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherContact<T: Real, F: Frame = Hand> {
    /// The wrench of the others on the object, about the origin of the frame, with its covariance.
    pub load: UncertainWrench<T, F>,
    /// `wᵀΣ⁻¹w`: χ² with six degrees of freedom if nothing else touches.
    pub statistic: T,
    /// The line along which it acts, if it is one contact without friction torque: the contact lies on it.
    pub line: Result<LineOfAction<T>, NoLineOfAction>,
}

impl<T: Real, F: Frame> OtherContact<T, F> {
    /// From what the fingertips feel together now and the weight that was learnt before. `gravity` as in
    /// [`ObjectWeight::observe`]. `None` if the weight is not known, a number is not finite or the covariance is not
    /// positive definite.
    #[must_use]
    pub fn new(load: &UncertainWrench<T, F>, weight: &ObjectWeight<T>, gravity: &Vector3<T>) -> Option<Self> {
        let weight = weight.load::<F>(gravity)?;
        let wrench = load.wrench - weight.wrench;
        let covariance = load.covariance + weight.covariance;
        let white = Whitener::new(&covariance)?.apply(&wrench.components());
        let statistic = white.norm_squared();
        if !statistic.is_number() {
            return None;
        }
        Some(Self { load: UncertainWrench { wrench, covariance }, statistic, line: wrench.line_of_action() })
    }

    /// Whether something touches: a statistic this large has a probability of at most `false_alarm` if nothing does.
    /// `P(χ²₆ > s) = e^{−s/2}(1 + s/2 + s²/8)`.
    #[must_use]
    pub fn touches(&self, false_alarm: f64) -> bool {
        let half = self.statistic.to_f64() * 0.5;
        let tail = Real::exponential(-half) * (1.0 + half + 0.5 * half * half);
        tail < false_alarm || !tail.is_finite()
    }
}
