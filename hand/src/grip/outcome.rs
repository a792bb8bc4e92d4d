//! What is known of a grip after it was looked for.

use fingertip_wrench::{ContactForce, Frame, Real, Wrench};
use nalgebra::Vector3;

use crate::Hand;

/// Forces that hold a load, and how near they are to the least that do.
///
/// [`LeastGrip`](crate::LeastGrip) has an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip<T: Real, const N: usize, F: Frame = Hand> {
    /// What each finger should feel: the force of the object on the fingertip. Zero for a finger that does not touch.
    /// Every force is within its friction limit and every limit of its finger.
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
#[derive(Clone, Copy, Debug, PartialEq)]
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
#[derive(Clone, Copy, Debug, PartialEq)]
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
