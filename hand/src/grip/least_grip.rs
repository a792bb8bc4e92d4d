//! The least grip that holds a load.

use core::marker::PhantomData;

use fingertip_wrench::{ContactForce, Frame, Real, Wrench};
use nalgebra::{Vector3, Vector6};

use crate::grip::assemble::{Assembled, assemble};
use crate::grip::iterate::Iterate;
use crate::grip::program::{Ending, Program, Stop};
use crate::{CannotHold, FingerLimits, Grasp, Grip, GripOutcome};

/// How exactly, and for how long, the least grip is looked for.
///
/// ```
/// use fingertip_hand::Precision;
///
/// assert_eq!(Precision::<f64>::usual().steps, 30);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precision<T> {
    /// Of the cost and of the equilibrium, relative: at least a few rounding errors.
    pub tolerance: T,
    /// Most steps of the interior-point method.
    pub steps: u32,
}

impl<T: Real> Precision<T> {
    /// Half the digits of the scalar type, and 30 steps; four to nine are usual.
    #[must_use]
    pub fn usual() -> Self {
        Self { tolerance: T::EPSILON.root(), steps: 30 }
    }
}

/// Looks for the least normal forces that hold a load within friction and limits: the second-order cone program of
/// `docs/theory/hand.md#least-grip`.
///
/// It remembers the last solution and starts from there if the contacts are the same. Every call is bounded:
/// nothing is allocated, and the number of steps is limited.
///
/// ```
/// use fingertip_hand::{FingerLimits, Grasp, GraspContact, GripOutcome, LeastGrip};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // Two soft fingers hold 0.2 kg between them.
/// let left = GraspContact::<f64>::soft(Vector3::new(-0.02, 0.0, 0.0), Vector3::x(), 0.5, 3e-3)?;
/// let right = GraspContact::soft(Vector3::new(0.02, 0.0, 0.0), -Vector3::x(), 0.5, 3e-3)?;
/// let grasp = Grasp::new([Some(left), Some(right)]);
/// let limits = [FingerLimits::<f64, 1>::none().with_greatest_normal(20.0)?; 2];
///
/// // The object loads the fingertips with its weight.
/// let weight = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.96), Vector3::zeros());
/// let mut least = LeastGrip::new();
/// let GripOutcome::Held(grip) = least.solve(&grasp, &limits, &weight) else { panic!() };
/// // 1.96 N over two contacts with friction 0.5.
/// assert!((grip.forces[0].normal - 1.96).abs() < 1e-6);
/// assert!(grip.gap() < 1e-7);
///
/// // With slippery fingers that may press with 20 N, 100 N cannot be held: it will go down.
/// let anvil = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -100.0), Vector3::zeros());
/// let GripOutcome::CannotHold(why) = least.solve(&grasp, &limits, &anvil) else { panic!() };
/// assert!(why.velocity.z < 0.0 && why.excess > 0.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastGrip<T: Real, const N: usize, const ROWS: usize> {
    precision: Precision<T>,
    last: Option<Last<T, N, ROWS>>,
}

/// What the next call starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Last<T: Real, const N: usize, const ROWS: usize> {
    /// An iterate on the way to the solution, with `τ = 1`.
    midway: Iterate<T, N, ROWS>,
    /// The twist of the solution.
    twist: Vector6<T>,
    /// Rows of each finger; `None` where it does not touch.
    counts: [Option<usize>; N],
    per_newton: T,
    length: T,
    wrench: Vector6<T>,
}

impl<T: Real, const N: usize, const ROWS: usize> Default for LeastGrip<T, N, ROWS> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const N: usize, const ROWS: usize> LeastGrip<T, N, ROWS> {
    /// With the [usual](Precision::usual) precision.
    #[must_use]
    pub fn new() -> Self {
        Self::with_precision(Precision::usual())
    }

    /// With a precision of one's own; a tolerance below 64 rounding errors, or not a number, is taken as 64 rounding
    /// errors, and more than 100 steps as 100.
    #[must_use]
    pub fn with_precision(precision: Precision<T>) -> Self {
        let least = T::EPSILON * T::literal(64.0);
        let tolerance = if precision.tolerance > least { precision.tolerance } else { least };
        let tolerance = tolerance.min(T::literal(0.1));
        Self { precision: Precision { tolerance, steps: precision.steps.min(100) }, last: None }
    }

    /// Forgets the last solution.
    pub fn forget(&mut self) {
        self.last = None;
    }

    /// The least normal forces, weighed by the costs of the fingers, with which the contacts bear `load`: what the
    /// object hands on to the fingertips together (its weight, say), as a wrench about the origin of the grasp's
    /// frame. A measured one is the sum of the wrenches on the fingertips.
    ///
    /// Where it is said that none hold, a certificate says why. NaN and infinity are
    /// [`GripOutcome::NotFinite`].
    pub fn solve<F: Frame>(
        &mut self,
        grasp: &Grasp<T, N, F>,
        limits: &[FingerLimits<T, ROWS>; N],
        load: &Wrench<T, F>,
    ) -> GripOutcome<T, N, F> {
        // The fingers bear the load: what they give is its opposite.
        let wanted = -grasp.normalised(load);
        if !wanted.iter().all(|x| x.is_number()) {
            return GripOutcome::NotFinite;
        }
        let mut size = wanted.amax();
        for (contact, limits) in grasp.contacts().iter().zip(limits) {
            if let (Some(_), Some(least)) = (contact, limits.least_normal()) {
                size = size.max(least);
            }
        }
        if !(size > T::zero()) {
            return GripOutcome::Held(Grip {
                forces: [ContactForce::zero(); N],
                cost: T::zero(),
                least_cost: T::zero(),
                imbalance: Wrench::zero(),
                steps: 0,
            });
        }
        let per_newton = self.per_newton(size);
        let Some(Assembled { program, most }) = assemble(grasp, limits, &(wanted * per_newton), per_newton)
        else {
            return GripOutcome::NotFinite;
        };
        let mut stop = Stop {
            tolerance: self.precision.tolerance,
            greatest: T::one() / self.precision.tolerance,
            steps: self.precision.steps,
        };
        // More than all limits allow is enough.
        if let Some(most) = most {
            stop.greatest = stop.greatest.min(most * T::literal(1.001));
        }
        let counts = program.blocks.fingers.map(|block| block.map(|block| block.count()));
        let mut midway = None;
        let (ending, steps, iterate) =
            self.run(&program, &stop, per_newton, grasp.length(), &counts, &mut midway);
        match ending {
            Ending::Solved => {
                let mut iterate = iterate;
                iterate.rescale(T::one() / iterate.tau);
                let grip = held(grasp, &program, &iterate, per_newton, steps);
                // Of forces near the end of the range a torque may lie beyond it.
                if !is_finite(&grip) {
                    self.last = None;
                    return GripOutcome::NotFinite;
                }
                let (wrench, length, twist) = (program.wrench, grasp.length(), iterate.twist);
                self.last = midway.map(|mut midway| {
                    midway.rescale(T::one() / midway.tau);
                    Last { midway, twist, counts, per_newton, length, wrench }
                });
                GripOutcome::Held(grip)
            }
            Ending::Infeasible => {
                self.last = None;
                cannot_hold(grasp, &program, &iterate, per_newton, steps)
            }
            Ending::Unbounded | Ending::Undecided => {
                self.last = None;
                GripOutcome::Undecided
            }
        }
    }

    /// The twist that proves the last cost to be least, of any length, in the units of the grasp map.
    pub(crate) fn twist(&self) -> Option<Vector6<T>> {
        self.last.as_ref().map(|last| last.twist)
    }

    /// A power of two that brings forces near 1: that of the last call while it does.
    fn per_newton(&self, size: T) -> T {
        match &self.last {
            Some(last)
                if size * last.per_newton > T::literal(0.25) && size * last.per_newton < T::literal(8.0) =>
            {
                last.per_newton
            }
            _ => size.normalising_factor(),
        }
    }

    fn run(
        &self,
        program: &Program<T, N, ROWS>,
        stop: &Stop<T>,
        per_newton: T,
        length: T,
        counts: &[Option<usize>; N],
        midway: &mut Option<Iterate<T, N, ROWS>>,
    ) -> (Ending, u32, Iterate<T, N, ROWS>) {
        let mut steps = 0;
        if let Some(last) = &self.last
            && last.counts == *counts
            && last.per_newton == per_newton
            && last.length == length
        {
            let mut iterate = last.midway;
            iterate.lift((program.wrench - last.wrench).amax());
            let (ending, used) = program.iterate(&mut iterate, stop, midway);
            if ending != Ending::Undecided {
                return (ending, used, iterate);
            }
            steps = used;
        }
        let mut iterate = Iterate::middle();
        let (ending, used) = program.iterate(&mut iterate, stop, midway);
        (ending, steps + used, iterate)
    }
}

fn held<T: Real, const N: usize, const ROWS: usize, F: Frame>(
    grasp: &Grasp<T, N, F>,
    program: &Program<T, N, ROWS>,
    iterate: &Iterate<T, N, ROWS>,
    per_newton: T,
    steps: u32,
) -> Grip<T, N, F> {
    let mut forces = [ContactForce::zero(); N];
    for ((force, contact), inner) in forces.iter_mut().zip(grasp.contacts()).zip(&iterate.blocks.fingers) {
        if let Some(contact) = contact {
            *force = contact.force(&(inner.y / per_newton));
        }
    }
    // The fingers' wrench on the object has the other sign of that on the fingertips.
    let imbalance = grasp.wrench_of(&(program.equilibrium(iterate) / -per_newton));
    let unit = per_newton * program.cost_factor;
    let cost = program.cost(iterate) / unit;
    let least_cost = program.lower_bound(iterate) / unit;
    Grip { forces, cost, least_cost, imbalance, steps }
}

fn is_finite<T: Real, const N: usize, F: Frame>(grip: &Grip<T, N, F>) -> bool {
    grip.forces.iter().all(ContactForce::is_finite)
        && grip.imbalance.is_finite()
        && grip.cost.is_number()
        && grip.least_cost.is_number()
}

fn cannot_hold<T: Real, const N: usize, const ROWS: usize, F: Frame>(
    grasp: &Grasp<T, N, F>,
    program: &Program<T, N, ROWS>,
    iterate: &Iterate<T, N, ROWS>,
    per_newton: T,
    steps: u32,
) -> GripOutcome<T, N, F> {
    let scale = T::one() / iterate.twist.amax();
    let [vx, vy, vz, wx, wy, wz] = (iterate.twist * -scale).into();
    let turning = Vector3::new(wx, wy, wz) / grasp.length();
    let velocity = Vector3::new(vx, vy, vz) - turning.cross(&grasp.centre());
    let value = program.value(iterate);
    let violation = program.violation(iterate);
    let needs = value / violation / per_newton;
    let excess = value * scale / per_newton;
    // Of a size, or with a centre, at the end of the range a motion may lie beyond it.
    if !(velocity.sum() + turning.sum() + excess).is_number() {
        return GripOutcome::NotFinite;
    }
    GripOutcome::CannotHold(CannotHold {
        velocity,
        turning,
        excess,
        needs: if needs.is_number() { needs } else { T::GREATEST },
        steps,
        frame: PhantomData,
    })
}
