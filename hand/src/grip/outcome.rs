//! What is known of a grip after it was looked for.

use fingertip_wrench::{ContactForce, Frame, Real, Wrench};
use nalgebra::Vector3;

use crate::Hand;

/// Forces that hold a load, and how near they are to the least that do.
///
/// ```
/// use fingertip_hand::{FingerLimits, Grasp, GraspContact, LeastGrip};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let left = GraspContact::<f64>::soft(Vector3::new(-0.02, 0.0, 0.0), Vector3::x(), 0.5, 3e-3)?;
/// let right = GraspContact::soft(Vector3::new(0.02, 0.0, 0.0), -Vector3::x(), 0.5, 3e-3)?;
/// let grasp = Grasp::new([Some(left), Some(right)]);
/// let weight = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
/// let outcome = LeastGrip::new().solve(&grasp, &[FingerLimits::<f64, 1>::none(); 2], &weight);
/// let grip = outcome.grip().ok_or("it holds")?;
/// // Friction 0.5 bears 2 N on two fingers that press with 2 N each.
/// assert!(grip.forces.iter().all(|force| (force.normal - 2.0).abs() < 1e-6));
/// assert!(grip.gap() < 1e-6 && grip.imbalance.force().norm() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Grip<T: Real, const N: usize, F: Frame = Hand> {
    /// What each finger should feel: the force of the object on the fingertip. Zero for a finger that does not touch.
    /// Every force is within its friction limit and every limit of its finger.
    #[cfg_attr(feature = "serde", serde(with = "serde_big_array::BigArray"))]
    pub forces: [ContactForce<T>; N],
    /// `Σ cost·normal force` \[N\] of these forces.
    pub cost: T,
    /// No forces that hold the load cost less \[N\]: the value of the dual program, which is feasible.
    pub least_cost: T,
    /// What these forces and the load miss of equilibrium: forces less load.
    pub imbalance: Wrench<T, F>,
    /// Steps of the interior-point method.
    pub steps: u32,
}

impl<T: Real, const N: usize, F: Frame> Grip<T, N, F> {
    /// By how much the cost may differ from the least one, as a share of it. (Where the imbalance is in its favour, it
    /// may be below.)
    #[must_use]
    pub fn gap(&self) -> T {
        let gap = (self.cost - self.least_cost).abs();
        if gap > T::zero() { gap / self.cost.abs().max(T::LEAST_NORMAL) } else { T::zero() }
    }
}

/// Why no forces hold a load: a motion of the object against which all that the fingers can do is too little.
///
/// For every wrench `w` that the fingers can bear within friction and limits, `power(w)` along the motion is at most
/// that of the limits, and the load's is greater (`docs/theory/hand.md#the-certificate`).
///
/// ```
/// use fingertip_hand::{FingerLimits, Grasp, GraspContact, GripOutcome, LeastGrip};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // One finger from below: nothing keeps the object from going up.
/// let below = GraspContact::<f64>::soft(Vector3::zeros(), Vector3::z(), 0.5, 3e-3)?;
/// let pull = Wrench::on_fingertip(Vector3::new(0.0, 0.0, 3.0), Vector3::zeros());
/// let outcome = LeastGrip::new().solve(&Grasp::new([Some(below)]), &[FingerLimits::<f64, 1>::none()], &pull);
/// let GripOutcome::CannotHold(why) = outcome else { panic!() };
/// assert!(why.velocity.z > 0.0);
/// assert!((why.power(&pull) - why.excess).abs() < 1e-9); // the finger takes up nothing
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct CannotHold<T: Real, F: Frame = Hand> {
    /// Velocity \[m/s\], at the origin of the frame, of the motion by which the object will go; only the direction
    /// of the motion has a meaning.
    pub velocity: Vector3<T>,
    /// Angular velocity \[rad/s\] of that motion.
    pub turning: Vector3<T>,
    /// The load's power along the motion less the most that the fingers' limits take up \[W\], positive.
    pub excess: T,
    /// Forces that hold would have a sum of normal forces above this \[N\]: infinite, or more than the limits
    /// allow, or out of proportion to the load.
    pub needs: T,
    /// Steps of the interior-point method.
    pub steps: u32,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) frame: core::marker::PhantomData<F>,
}

impl<T: Real, F: Frame> CannotHold<T, F> {
    /// The power \[W\] of a wrench along the motion.
    #[must_use]
    pub fn power(&self, wrench: &Wrench<T, F>) -> T {
        self.velocity.dot(&wrench.force()) + self.turning.dot(&wrench.torque())
    }
}

/// What came of looking for the least grip.
///
/// ```
/// use fingertip_hand::{FingerLimits, Grasp, GraspContact, GripOutcome, LeastGrip};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let below = GraspContact::<f64>::soft(Vector3::zeros(), Vector3::z(), 0.5, 3e-3)?;
/// let solve = |newtons: f64| {
///     let load = Wrench::on_fingertip(Vector3::new(0.0, 0.0, newtons), Vector3::zeros());
///     LeastGrip::new().solve(&Grasp::new([Some(below)]), &[FingerLimits::<f64, 1>::none()], &load)
/// };
/// // It lies on the finger; it is pulled off; a sensor says nonsense.
/// assert!(matches!(solve(-3.0), GripOutcome::Held(grip) if (grip.forces[0].normal - 3.0).abs() < 1e-6));
/// assert!(matches!(solve(3.0), GripOutcome::CannotHold(_)));
/// assert_eq!(solve(f64::NAN), GripOutcome::NotFinite);
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        rename_all = "snake_case",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub enum GripOutcome<T: Real, const N: usize, F: Frame = Hand> {
    /// These forces hold.
    Held(Grip<T, N, F>),
    /// None do, and why.
    CannotHold(CannotHold<T, F>),
    /// The load, a contact or a limit is NaN or infinite, or leaves the range of the scalar type.
    NotFinite,
    /// Neither was found within the bounded number of steps: the problem is at the edge of what the scalar type can
    /// tell. Keep the grip that was commanded before.
    Undecided,
}

impl<T: Real, const N: usize, F: Frame> GripOutcome<T, N, F> {
    /// The forces that hold, if any were found.
    #[must_use]
    pub const fn grip(&self) -> Option<&Grip<T, N, F>> {
        match self {
            Self::Held(grip) => Some(grip),
            _ => None,
        }
    }
}
