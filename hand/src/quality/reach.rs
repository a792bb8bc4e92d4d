//! How much more the best forces could bear.

use fingertip_wrench::{Frame, Real, Wrench};
use nalgebra::{Matrix6x4, Vector6};

use crate::grip::{Assembled, Block, Ending, Iterate, Stop, assemble};
use crate::{FingerLimits, Grasp};

/// How far a load can grow in a direction before no forces hold it.
///
/// ```
/// use fingertip_hand::{FingerLimits, Grasp, GraspContact, Reach};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let below = GraspContact::<f64>::soft(Vector3::zeros(), Vector3::z(), 0.5, 3e-3)?;
/// let grasp = Grasp::new([Some(below)]);
/// let force = |x: f64, z: f64| Wrench::on_fingertip(Vector3::new(x, 0.0, z), Vector3::zeros());
/// let reach = |load, more| grasp.reach(&[FingerLimits::<f64, 1>::none()], &load, &more);
/// // What lies on a finger with 2 N can be pushed aside with half of that, and be loaded without end.
/// assert!(matches!(reach(force(0.0, -2.0), force(1.0, 0.0)), Reach::Times(most) if (most - 1.0).abs() < 1e-5));
/// assert_eq!(reach(force(0.0, -2.0), force(0.0, -1.0)), Reach::Unlimited);
/// assert_eq!(reach(force(0.0, 2.0), force(1.0, 0.0)), Reach::NotHeld);
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Reach<T> {
    /// This many times the disturbance, and no more.
    Times(T),
    /// As much as one likes: the fingers have no limits that matter. (A load that is not held alone may be with a
    /// disturbance.)
    Unlimited,
    /// Neither the load alone nor any multiple beside it can be held.
    NotHeld,
    /// A number is NaN or infinite or out of range, or it could not be told in a bounded number of steps.
    Unknown,
}

impl<T: Real, const N: usize, F: Frame> Grasp<T, N, F> {
    /// The greatest multiple of `disturbance` that the fingers can bear beside `load`, with the best forces within
    /// friction and limits: a cone program with one unknown more (`docs/theory/hand.md#margins-of-a-grasp`). A
    /// disturbance of zero is borne without limit if the load is held.
    ///
    /// ```
    /// use fingertip_hand::{FingerLimits, Grasp, GraspContact, Reach};
    /// use fingertip_wrench::Wrench;
    /// use nalgebra::Vector3;
    ///
    /// let left: GraspContact<f64> = GraspContact::soft(-Vector3::x() * 0.02, Vector3::x(), 0.5, 3e-3)?;
    /// let right = GraspContact::soft(Vector3::x() * 0.02, -Vector3::x(), 0.5, 3e-3)?;
    /// let grasp = Grasp::new([Some(left), Some(right)]);
    /// let limits = [FingerLimits::<f64, 1>::none().with_greatest_normal(10.0)?; 2];
    /// let down = |newtons: f64| Wrench::on_fingertip(-Vector3::z() * newtons, Vector3::zeros());
    /// // Two fingers of 10 N with friction 0.5 carry 10 N: 2 N now and 8 N more.
    /// let Reach::Times(more) = grasp.reach(&limits, &down(2.0), &down(1.0)) else { panic!() };
    /// assert!((more - 8.0).abs() < 1e-5);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    pub fn reach<const ROWS: usize>(
        &self,
        limits: &[FingerLimits<T, ROWS>; N],
        load: &Wrench<T, F>,
        disturbance: &Wrench<T, F>,
    ) -> Reach<T> {
        self.reach_and_twist(limits, load, disturbance).0
    }

    /// The [reach](Self::reach) with the twist that proves it, of any length, in the units of the grasp map; nothing where
    /// it is not finite.
    pub(crate) fn reach_and_twist<const ROWS: usize>(
        &self,
        limits: &[FingerLimits<T, ROWS>; N],
        load: &Wrench<T, F>,
        disturbance: &Wrench<T, F>,
    ) -> (Reach<T>, Vector6<T>) {
        let none = Vector6::zeros();
        let (wanted, along) = (-self.normalised(load), self.normalised(disturbance));
        let size = along.amax();
        if !wanted.iter().chain(along.iter()).all(|x| x.is_number()) {
            return (Reach::Unknown, none);
        }
        let mut unit = wanted.amax();
        for limits in self.contacts().iter().zip(limits).filter_map(|(contact, l)| contact.and(Some(l))) {
            unit = [limits.least_normal(), limits.greatest_normal()].into_iter().flatten().fold(unit, T::max);
        }
        let unit = if unit > T::zero() { unit } else { T::one() };
        let per_newton = unit.normalising_factor();
        let Some(Assembled { mut program, .. }) = assemble(self, limits, &(wanted * per_newton), per_newton)
        else {
            return (Reach::Unknown, none);
        };
        if size > T::zero() {
            // Only the disturbance counts: as much of it as can be.
            for block in program.blocks.fingers.iter_mut().flatten() {
                block.cost = T::zero();
            }
            let factor = size.normalising_factor();
            let mut map = Matrix6x4::zeros();
            map.set_column(0, &Vector6::from(along * factor));
            program.blocks.extra = Some(Block { map, cost: -T::one(), rows: [None; ROWS] });
        }
        let tolerance = T::EPSILON.root();
        let stop = Stop { tolerance, greatest: T::one() / tolerance, steps: 50 };
        let mut iterate = Iterate::middle();
        match program.iterate(&mut iterate, &stop, &mut None).0 {
            Ending::Solved if size > T::zero() => {
                let found = iterate.blocks.extra.y.x / iterate.tau;
                // What an imbalance is worth: near a reach that takes forces without bound it is worth much.
                let imbalance = program.equilibrium(&iterate).component_mul(&iterate.twist).abs().sum();
                if imbalance / (iterate.tau * iterate.tau) > tolerance.root() * found.max(tolerance.root()) {
                    return (Reach::Unknown, none);
                }
                let times = found / per_newton * size.normalising_factor();
                let times =
                    if times.is_number() { Reach::Times(times.max(T::zero())) } else { Reach::Unlimited };
                (times, iterate.twist)
            }
            Ending::Solved | Ending::Unbounded => (Reach::Unlimited, none),
            Ending::Infeasible => (Reach::NotHeld, none),
            Ending::Undecided => (Reach::Unknown, none),
        }
    }
}
