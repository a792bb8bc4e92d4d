//! The cone program and its interior-point iteration.
//!
//! `docs/theory/hand.md#the-interior-point-iteration` has the formulas: the homogeneous self-dual embedding of Xu,
//! Hung & Ye 1996 and Andersen, Roos & Terlaky 2003, with Mehrotra's predictor and corrector.

use fingertip_wrench::Real;
use nalgebra::{Matrix6, Vector4, Vector6};

use crate::grip::block::{Block, Factored, Interior, Target};
use crate::grip::cholesky::Cholesky;
use crate::grip::iterate::{Each, Iterate};

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

/// What is missing of optimality.
struct Missing<T: Real> {
    primal: T,
    dual: T,
    cost: T,
    value: T,
}

/// The factored system of an iterate.
struct System<T: Real, const N: usize, const ROWS: usize> {
    factored: Each<Option<Factored<T, ROWS>>, N>,
    cholesky: Cholesky<T>,
    /// The solution for the column of `τ`.
    twist: Vector6<T>,
    share: Each<Vector4<T>, N>,
    pivot: T,
}

impl<T: Real, const N: usize, const ROWS: usize> Program<T, N, ROWS> {
    #[inline]
    fn present<'a>(
        &'a self,
        at: &'a Iterate<T, N, ROWS>,
    ) -> impl Iterator<Item = (&'a Block<T, ROWS>, &'a Interior<T, ROWS>)> {
        self.blocks.iter().zip(at.blocks.iter()).filter_map(|(block, at)| block.as_ref().map(|b| (b, at)))
    }

    fn complementarity(&self, at: &Iterate<T, N, ROWS>) -> T {
        let mut degree = T::one();
        let mut sum = at.tau * at.kappa;
        for (block, at) in self.present(at) {
            sum += block.complementarity(at);
            degree += T::literal((block.count() + 1) as f64);
        }
        sum / degree
    }

    /// `Σ map y − wrench τ`.
    #[inline]
    pub(crate) fn equilibrium(&self, at: &Iterate<T, N, ROWS>) -> Vector6<T> {
        self.present(at).fold(self.wrench * -at.tau, |sum, (block, at)| sum + block.map * at.y)
    }

    /// `Σ cost y₀`.
    pub(crate) fn cost(&self, at: &Iterate<T, N, ROWS>) -> T {
        self.present(at).fold(T::zero(), |sum, (block, at)| sum + block.cost * at.y.x)
    }

    /// `wrench·ν − Σ bound·price`.
    pub(crate) fn value(&self, at: &Iterate<T, N, ROWS>) -> T {
        self.present(at).fold(self.wrench.dot(&at.twist), |sum, (block, at)| sum - block.priced(at))
    }

    fn missing(&self, at: &Iterate<T, N, ROWS>) -> Missing<T> {
        let mut primal = self.equilibrium(at).amax();
        let mut dual = T::zero();
        for (block, inner) in self.present(at) {
            primal = primal.max(block.row_residual(inner, at.tau));
            let mut pull = block.pull(inner, &at.twist) - inner.z;
            pull.x += block.cost * at.tau;
            dual = dual.max(pull.amax());
        }
        Missing { primal, dual, cost: self.cost(at), value: self.value(at) }
    }

    /// By how much the pull on the contacts leaves the dual cones.
    pub(crate) fn violation(&self, at: &Iterate<T, N, ROWS>) -> T {
        self.present(at).fold(T::zero(), |worst, (block, inner)| {
            worst.max(block.violation(&block.pull(inner, &at.twist)))
        })
    }

    /// A cost that no forces undercut: the value of the dual at a feasible point near this one, `τ = 1`.
    pub(crate) fn lower_bound(&self, at: &Iterate<T, N, ROWS>) -> T {
        // The twist and the prices times a factor so that `cost e + t pull` is in every dual cone.
        let mut factor = T::one();
        for (block, inner) in self.present(at) {
            let pull = block.pull(inner, &at.twist);
            let outside = block.violation(&pull);
            if outside * factor > block.cost {
                factor = block.cost / outside;
            }
        }
        (self.value(at) * factor).max(T::zero())
    }

    /// Goes on from an interior iterate, and leaves the last one there. Returns how it ended, after how many
    /// steps.
    pub(crate) fn iterate(&self, at: &mut Iterate<T, N, ROWS>, stop: &Stop<T>) -> (Ending, u32) {
        let nearly_enough = (stop.tolerance * T::literal(32.0)).min(T::literal(2e-3)).max(stop.tolerance);
        let loose = Stop { tolerance: nearly_enough, ..*stop };
        // The best that is nearly there: rounding may stop progress just before the end.
        let mut nearly: Option<(Iterate<T, N, ROWS>, T)> = None;
        let mut steps = 0;
        loop {
            let missing = self.missing(at);
            if let Some(ending) = self.ending(at, &missing, stop) {
                return (ending, steps);
            }
            if self.ending(at, &missing, &loose) == Some(Ending::Solved) {
                let off = (missing.cost - missing.value).abs() / at.tau;
                if nearly.as_ref().is_none_or(|(_, least)| off < *least) {
                    nearly = Some((*at, off));
                }
            }
            let mut next = *at;
            if steps >= stop.steps || !self.step(&mut next) {
                break;
            }
            *at = next;
            steps += 1;
        }
        match nearly {
            Some((best, _)) => {
                *at = best;
                (Ending::Solved, steps)
            }
            None => (Ending::Undecided, steps),
        }
    }

    fn ending(&self, at: &Iterate<T, N, ROWS>, missing: &Missing<T>, stop: &Stop<T>) -> Option<Ending> {
        let least = T::literal(1e-3);
        let gap = (missing.cost - missing.value).abs();
        let size = missing.cost.abs().max(missing.value.abs()).max(least * at.tau);
        let tolerance = stop.tolerance;
        if missing.primal <= tolerance * at.tau
            && missing.dual <= tolerance * at.tau
            && gap <= tolerance * size
        {
            return Some(Ending::Solved);
        }
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

    fn system(&self, at: &Iterate<T, N, ROWS>) -> System<T, N, ROWS> {
        let mut factored: Each<_, N> = Each::all(None);
        let mut sum = Matrix6::zeros();
        let mut share: Each<_, N> = Each::all(Vector4::zeros());
        let mut right = self.wrench;
        let mut pivot = at.kappa / at.tau;
        let each = self.blocks.iter().zip(at.blocks.iter()).zip(factored.iter_mut()).zip(share.iter_mut());
        for (((block, inner), factored), share) in each {
            let Some(block) = block else { continue };
            let f = block.factor(inner, &at.twist, at.tau);
            f.add_to(&mut sum);
            *share = block.homogeneous(&f);
            right -= f.wrench(share);
            pivot += block.row_stiffness(inner);
            *factored = Some(f);
        }
        let cholesky = Cholesky::new(&sum);
        let twist = cholesky.solve(&right);
        pivot += self.wrench.dot(&twist);
        for (factored, share) in factored.iter().zip(share.iter()) {
            let Some(f) = factored else { continue };
            pivot -= f.weighed(&f.scaled(&twist, share));
        }
        System { factored, cholesky, twist, share, pivot }
    }

    /// The direction towards targets. `missing` is `b·ν − h·λ − c·y − κ`.
    #[allow(clippy::too_many_arguments, reason = "the parts of one step")]
    fn direction(
        &self,
        system: &System<T, N, ROWS>,
        at: &Iterate<T, N, ROWS>,
        targets: &Each<Target<T, ROWS>, N>,
        of_tau: T,
        keep: T,
        equilibrium: &Vector6<T>,
        missing: T,
        refined: bool,
    ) -> Iterate<T, N, ROWS> {
        let mut share: Each<_, N> = Each::all(Vector4::zeros());
        let mut right = equilibrium * -keep;
        let mut last = of_tau / at.tau - missing * keep;
        let of_blocks = self.blocks.iter().zip(at.blocks.iter());
        let each = of_blocks.zip(targets.iter()).zip(system.factored.iter()).zip(share.iter_mut());
        for ((((block, inner), target), factored), share) in each {
            let (Some(block), Some(f)) = (block, factored) else { continue };
            *share = block.right_hand_side(f, inner, target, keep);
            right -= f.wrench(share);
            last += block.row_terms(f, inner, target, keep);
        }
        let mut twist = system.cholesky.solve(&right);
        last -= self.wrench.dot(&twist);
        for (factored, share) in system.factored.iter().zip(share.iter()) {
            let Some(f) = factored else { continue };
            last += f.weighed(&f.scaled(&twist, share));
        }
        let tau = last / system.pivot;
        twist += system.twist * tau;

        // The forces, and one refinement of their equilibrium.
        let mut forces: Each<_, N> = Each::all(Vector4::zeros());
        let mut left = self.wrench * tau - equilibrium * keep;
        let each = system.factored.iter().zip(forces.iter_mut());
        for ((factored, force), (share, of_tau)) in each.zip(share.iter().zip(system.share.iter())) {
            let Some(f) = factored else { continue };
            *force = f.scaled(&twist, &(share + of_tau * tau));
            if refined {
                left -= f.wrench_of(force);
            }
        }
        // The predictor need not be exact.
        let more = if refined { system.cholesky.solve(&left) } else { Vector6::zeros() };
        twist += more;

        let mut along = *at;
        let each = self.blocks.iter().zip(at.blocks.iter()).zip(targets.iter()).zip(system.factored.iter());
        for ((((block, inner), target), factored), (force, along)) in
            each.zip(forces.iter().zip(along.blocks.iter_mut()))
        {
            let (Some(block), Some(f)) = (block, factored) else { continue };
            let scaled = if refined { f.scaled(&more, force) } else { *force };
            *along = block.direction(f, inner, target, keep, &scaled, &twist, tau);
        }
        along.twist = twist;
        along.tau = tau;
        along.kappa = (of_tau - at.kappa * tau) / at.tau;
        along
    }

    fn greatest_step(&self, at: &Iterate<T, N, ROWS>, along: &Iterate<T, N, ROWS>, most: T) -> T {
        let mut step = most;
        for (x, d) in [(at.tau, along.tau), (at.kappa, along.kappa)] {
            if d < T::zero() {
                step = step.min(-x / d);
            }
        }
        let each = self.blocks.iter().zip(at.blocks.iter()).zip(along.blocks.iter());
        for ((block, at), along) in each {
            if let Some(block) = block {
                step = block.greatest_step(at, along, step);
            }
        }
        step
    }

    /// One step of predictor and corrector; `false` if it leads nowhere.
    fn step(&self, at: &mut Iterate<T, N, ROWS>) -> bool {
        let system = self.system(at);
        let equilibrium = self.equilibrium(at);
        let missing = self.value(at) - self.cost(at) - at.kappa;
        let mean = self.complementarity(at);
        let one = T::one();

        let none = Target::none();
        let mut targets: Each<_, N> = Each::all(none);
        let each = self.blocks.iter().zip(system.factored.iter()).zip(at.blocks.iter());
        for (((block, factored), inner), target) in each.zip(targets.iter_mut()) {
            if let (Some(block), Some(f)) = (block, factored) {
                *target = block.predictor(f, inner);
            }
        }
        let of_tau = -at.tau * at.kappa;
        let predicted = self.direction(&system, at, &targets, of_tau, one, &equilibrium, missing, false);
        let reach = self.greatest_step(at, &predicted, one);
        let left = one - reach;
        let sigma = left * left * left;
        let centre = sigma * mean;

        let of_blocks = self.blocks.iter().zip(system.factored.iter());
        let each = of_blocks.zip(at.blocks.iter().zip(predicted.blocks.iter())).zip(targets.iter_mut());
        for (((block, factored), (inner, predicted)), target) in each {
            if let (Some(block), Some(f)) = (block, factored) {
                *target = block.corrector(f, inner, predicted, centre);
            }
        }
        let of_tau = centre - at.tau * at.kappa - predicted.tau * predicted.kappa;
        let along = self.direction(&system, at, &targets, of_tau, one - sigma, &equilibrium, missing, true);
        let step = (self.greatest_step(at, &along, T::literal(2.0)) * T::literal(0.99)).min(one);
        if !(step > T::literal(1e-6)) {
            return false;
        }
        for ((block, inner), along) in self.blocks.iter().zip(at.blocks.iter_mut()).zip(along.blocks.iter()) {
            if block.is_some() {
                inner.advance(along, step);
            }
        }
        at.twist += along.twist * step;
        at.tau += along.tau * step;
        at.kappa += along.kappa * step;
        at.is_inside()
    }
}
