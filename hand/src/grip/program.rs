//! The cone program and its interior-point iteration.
//!
//! `docs/theory/hand.md#the-interior-point-iteration` has the formulas: the homogeneous self-dual embedding of Xu,
//! Hung & Ye 1996 and Andersen, Roos & Terlaky 2003, with Mehrotra's predictor and corrector.

use fingertip_wrench::Real;
use nalgebra::Vector6;

use crate::grip::block::{Block, Residual};
use crate::grip::interior::Interior;
use crate::grip::iterate::{Each, Iterate};
use crate::grip::kernels::add;
use crate::grip::workspace::Workspace;

/// Minimise `Σ cost y₀` with `Σ map y = wrench`, `y` in the cones and the half-spaces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Program<T: Real, const N: usize, const ROWS: usize> {
    pub(crate) blocks: Each<Option<Block<T, ROWS>>, N>,
    pub(crate) wrench: Vector6<T>,
    /// By what the costs were multiplied.
    pub(crate) cost_factor: T,
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Ending {
    /// Optimal within the tolerances.
    Solved,
    /// No forces hold the wrench: the twist is the certificate.
    Infeasible,
    /// There is no greatest disturbance.
    Unbounded,
    /// Neither, after so many steps.
    Undecided,
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop<T> {
    /// Of the gap, relative to the optimum, and of the equations.
    pub(crate) tolerance: T,
    /// How many times the wrench's size the forces may be.
    pub(crate) greatest: T,
    pub(crate) steps: u32,
}

/// What an iterate misses of optimality.
pub(crate) struct Missing<T: Real, const N: usize, const ROWS: usize> {
    pub(crate) blocks: Each<Residual<T, ROWS>, N>,
    /// `Σ map y − wrench τ`.
    pub(crate) equilibrium: Vector6<T>,
    /// `value − cost − κ`: what is missing of the equation of τ.
    pub(crate) of_tau: T,
    /// The mean of the products of what is complementary.
    pub(crate) complementarity: T,
    /// The largest of each kind.
    primal: T,
    dual: T,
    cost: T,
    value: T,
}

impl<T: Real, const N: usize, const ROWS: usize> Missing<T, N, ROWS> {
    /// What a step leaves of the equations: this share of what was missing.
    pub(crate) fn leave(&mut self, share: T) {
        self.equilibrium *= share;
        self.primal *= share;
        self.dual *= share;
    }

    /// How much it is: of the gap as a share of the optimum, and of the equations.
    pub(crate) fn off(&self, tau: T) -> T {
        let size = self.cost.abs().max(self.value.abs()).max(T::literal(1e-3) * tau);
        (self.primal.max(self.dual) / tau).max((self.cost - self.value).abs() / size)
    }
}

/// The largest magnitude, and at least so much. (A NaN counts for nothing here: iterates have none.)
#[inline]
fn largest<T: Real>(values: &[T], least: T) -> T {
    values.iter().fold(least, |largest, value| largest.max(value.abs()))
}

impl<T: Real, const N: usize, const ROWS: usize> Program<T, N, ROWS> {
    #[inline]
    fn present<'a>(
        &'a self,
        at: &'a Iterate<T, N, ROWS>,
    ) -> impl Iterator<Item = (&'a Block<T, ROWS>, &'a Interior<T, ROWS>)> {
        self.blocks.iter().zip(at.blocks.iter()).filter_map(|(block, at)| block.as_ref().map(|b| (b, at)))
    }

    /// `Σ map y − wrench τ`.
    #[inline]
    pub(crate) fn equilibrium(&self, at: &Iterate<T, N, ROWS>) -> Vector6<T> {
        self.present(at).fold(self.wrench * -at.tau, |mut sum, (block, at)| {
            add(&block.map, &at.y, &mut sum);
            sum
        })
    }

    /// `Σ cost y₀`.
    pub(crate) fn cost(&self, at: &Iterate<T, N, ROWS>) -> T {
        self.present(at).fold(T::zero(), |sum, (block, at)| sum + block.cost * at.y.x)
    }

    /// `wrench·ν − Σ bound·price`.
    pub(crate) fn value(&self, at: &Iterate<T, N, ROWS>) -> T {
        self.present(at).fold(self.wrench.dot(&at.twist), |sum, (block, at)| sum - block.priced(at))
    }

    /// What an iterate misses: all of it.
    pub(crate) fn missing(&self, at: &Iterate<T, N, ROWS>) -> Missing<T, N, ROWS> {
        let (zero, against) = (T::zero(), -at.twist);
        let mut blocks: Each<_, N> = Each::all(Residual::none());
        blocks.change_with_two((&self.blocks, &at.blocks), |residual, block, inner| {
            if let Some(block) = block {
                *residual = block.residual(inner, &against, at.tau);
            }
        });
        let mut missing = Missing {
            blocks,
            equilibrium: self.equilibrium(at),
            of_tau: zero,
            complementarity: zero,
            primal: zero,
            dual: zero,
            cost: zero,
            value: zero,
        };
        missing.primal = largest(missing.equilibrium.as_slice(), zero);
        for residual in missing.blocks.iter() {
            missing.dual = largest(residual.dual.as_slice(), missing.dual);
            missing.primal = largest(&residual.rows, missing.primal);
        }
        self.look(at, &mut missing);
        missing
    }

    /// What costs and complementarity are, and by them the equation of τ.
    fn look(&self, at: &Iterate<T, N, ROWS>, missing: &mut Missing<T, N, ROWS>) {
        let (mut cost, mut value) = (T::zero(), self.wrench.dot(&at.twist));
        let (mut complementarity, mut degree) = (at.tau * at.kappa, T::one());
        for (block, inner) in self.present(at) {
            cost += block.cost * inner.y.x;
            complementarity += inner.y.dot(&inner.z);
            degree += T::one();
            for (row, pair) in block.with(&inner.rows) {
                value -= row.bound * pair.price;
                complementarity += pair.slack * pair.price;
                degree += T::one();
            }
        }
        missing.of_tau = value - cost - at.kappa;
        missing.complementarity = complementarity / degree;
        (missing.cost, missing.value) = (cost, value);
    }

    /// By how much the pull on the contacts leaves the dual cones.
    pub(crate) fn violation(&self, at: &Iterate<T, N, ROWS>) -> T {
        self.present(at).fold(T::zero(), |worst, (block, inner)| {
            worst.max(block.violation(&block.pull(inner, &-at.twist)))
        })
    }

    /// A cost that no forces undercut: the value of the dual at a feasible point near this one, `τ = 1`.
    pub(crate) fn lower_bound(&self, at: &Iterate<T, N, ROWS>) -> T {
        // The twist and the prices times a factor so that `cost e + t pull` is in every dual cone.
        let mut factor = T::one();
        for (block, inner) in self.present(at) {
            let pull = block.pull(inner, &-at.twist);
            let outside = block.violation(&pull);
            if outside * factor > block.cost {
                factor = block.cost / outside;
            }
        }
        (self.value(at) * factor).max(T::zero())
    }

    /// Goes on from an interior iterate, and leaves the last one there. Returns how it ended, after how many steps.
    /// `midway` becomes the point on the way that is a thousandth off the end: well inside everything, so that a
    /// problem that is nearly the same is better begun there than at the solution.
    pub(crate) fn iterate(
        &self,
        at: &mut Iterate<T, N, ROWS>,
        stop: &Stop<T>,
        midway: &mut Option<Iterate<T, N, ROWS>>,
    ) -> (Ending, u32) {
        let nearly_enough = (stop.tolerance * T::literal(32.0)).min(T::literal(2e-3)).max(stop.tolerance);
        let close = T::literal(1e-3).max(stop.tolerance);
        let half = T::literal(0.5);
        // The best that is nearly there: rounding may stop progress just before the end.
        let mut nearly: Option<(Iterate<T, N, ROWS>, T)> = None;
        let mut missing = self.missing(at);
        let mut work = Workspace::new(&self.blocks);
        let mut steps = 0;
        let (mut before, mut off_before) = (*at, close);
        *midway = None;
        if self.blocks.iter().all(Option::is_none) && self.wrench.amax() > T::zero() {
            // Nothing gives a force: any wrench is its own certificate.
            at.twist = self.wrench;
            return (Ending::Infeasible, 0);
        }
        loop {
            let mut off = missing.off(at.tau);
            // What a step carries on of the residuals loses what rounding takes: what may end it is looked at anew.
            if off <= nearly_enough || missing.cost < T::zero() {
                missing = self.missing(at);
                off = missing.off(at.tau);
            }
            if midway.is_none() && off <= close {
                let share =
                    if off_before > close { (off_before - close) / (off_before - off) } else { T::one() };
                *midway = Some(at.between(&before, share));
            }
            if off <= stop.tolerance {
                return (Ending::Solved, steps);
            }
            if let Some(ending) = self.ending(at, &missing, stop) {
                return (ending, steps);
            }
            if off <= nearly_enough {
                let gap = (missing.cost - missing.value).abs() / at.tau;
                if nearly.as_ref().is_none_or(|(_, least)| gap < *least) {
                    nearly = Some((*at, gap));
                }
            }
            (before, off_before) = (*at, off);
            if steps >= stop.steps || !self.step(at, &mut missing, &mut work, stop.tolerance * half / off) {
                break;
            }
            steps += 1;
            if at.is_inside() {
                self.look(at, &mut missing);
            } else if at.return_inside(&before) {
                missing = self.missing(at);
            } else {
                break;
            }
        }
        match nearly {
            Some((best, _)) => {
                *at = best;
                (Ending::Solved, steps)
            }
            None => (Ending::Undecided, steps),
        }
    }

    /// Whether it has become clear that there is no solution.
    fn ending(
        &self,
        at: &Iterate<T, N, ROWS>,
        missing: &Missing<T, N, ROWS>,
        stop: &Stop<T>,
    ) -> Option<Ending> {
        // Any forces that hold cost Σ y₀ ≥ value/violation.
        if missing.value > T::zero()
            && at.kappa > at.tau
            && self.violation(at) * stop.greatest <= missing.value
        {
            return Some(Ending::Infeasible);
        }
        if missing.cost < T::zero() && at.kappa > at.tau && missing.primal * stop.greatest <= -missing.cost {
            return Some(Ending::Unbounded);
        }
        None
    }
}

#[cfg(test)]
mod tests;
