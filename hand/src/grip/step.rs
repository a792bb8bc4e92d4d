//! One interior-point step: predictor and corrector (Mehrotra 1992), with one factorisation.

use fingertip_wrench::Real;
use nalgebra::{Matrix6, Vector6};

use crate::grip::cholesky::Cholesky;
use crate::grip::iterate::{Each, Iterate};
use crate::grip::program::{Missing, Program};
use crate::grip::scaled::Scaled;
use crate::grip::workspace::Workspace;

/// Most corrections of a step after the first.
const MORE_CORRECTIONS: usize = 3;

/// The equations of a step, factored at an iterate.
struct System<'a, T: Real, const N: usize, const ROWS: usize> {
    program: &'a Program<T, N, ROWS>,
    missing: &'a Missing<T, N, ROWS>,
    scaled: &'a mut Each<Option<Scaled<T, ROWS>>, N>,
    cholesky: Cholesky<T>,
    at: (T, T),
    /// The twist for one of `τ`, and what is left of the equation of `τ` then.
    twist: Vector6<T>,
    pivot: T,
}

/// Where an iterate goes, but for its blocks, which know it themselves.
struct Direction<T: Real> {
    twist: Vector6<T>,
    tau: T,
    kappa: T,
    /// The part of second order in `τκ` that it was made for.
    second: T,
}

/// What the correctors aim at: so much complementarity everywhere, and all but this share of the residuals to stay.
struct Aim<T> {
    centre: T,
    keep: T,
}

impl<'a, T: Real, const N: usize, const ROWS: usize> System<'a, T, N, ROWS> {
    fn new(
        program: &'a Program<T, N, ROWS>,
        at: &Iterate<T, N, ROWS>,
        missing: &'a Missing<T, N, ROWS>,
        scaled: &'a mut Each<Option<Scaled<T, ROWS>>, N>,
    ) -> Self {
        let (mut sum, mut right) = (Matrix6::zeros(), program.wrench);
        let given = (&program.blocks, &at.blocks, &missing.blocks);
        scaled.change_with_three(given, |scaled, block, at, residual| {
            if let (Some(block), Some(scaled)) = (block, scaled) {
                scaled.factor(block, at, residual, &mut sum);
                scaled.ask_of_tau(&mut right);
            }
        });
        let cholesky = Cholesky::new(&sum);
        let twist = cholesky.solve(&right);
        let (mut pivot, mut left) = (at.kappa / at.tau, program.wrench);
        scaled.iter_mut().flatten().for_each(|scaled| pivot += scaled.solve_tau(&twist, &mut left));
        // What the twist does not solve: nothing but rounding, but all there is where no contact can push.
        pivot += left.dot(&twist);
        Self { program, missing, scaled, cholesky, at: (at.tau, at.kappa), twist, pivot }
    }

    /// Every block that is there.
    #[inline(always)]
    fn each(&mut self, visit: impl FnMut(&mut Scaled<T, ROWS>)) {
        self.scaled.iter_mut().flatten().for_each(visit);
    }

    /// The direction towards the targets of the blocks, with `keep` of the residuals to go. Where it is `refined`, the
    /// equilibrium of its forces is solved for once more.
    fn direction(&mut self, (first, second): (T, T), keep: T, refined: bool) -> Direction<T> {
        let of_tau = first - second;
        let (missing, wrench) = (self.missing, &self.program.wrench);
        let (tau_now, kappa_now) = self.at;
        let mut right = missing.equilibrium * -keep;
        let mut last = of_tau / tau_now - missing.of_tau * keep;
        self.each(|block| last += block.ask(keep, &mut right));
        let mut twist = self.cholesky.solve(&right);
        last -= wrench.dot(&twist);
        self.each(|block| last += block.pull(&twist));
        let tau = last / self.pivot;
        twist += self.twist * tau;
        if refined {
            let mut left = wrench * tau - missing.equilibrium * keep;
            self.each(|block| {
                block.go_with_tau(tau);
                block.take_wrench(&mut left);
            });
            let more = self.cholesky.solve(&left);
            twist += more;
            self.each(|block| {
                block.pull(&more);
                block.arrive(keep, tau);
            });
        } else {
            self.each(|block| {
                block.go_with_tau(tau);
                block.arrive(keep, tau);
            });
        }
        Direction { twist, tau, kappa: (of_tau - kappa_now * tau) / tau_now, second }
    }

    /// The predictor: towards no complementarity and no residuals.
    fn predict(&mut self) -> Direction<T> {
        self.each(Scaled::predict);
        let (tau, kappa) = self.at;
        self.direction((-(tau * kappa), T::zero()), T::one(), false)
    }

    /// The corrector, of second order by where the predictor went.
    fn correct(&mut self, predicted: &Direction<T>, aim: &Aim<T>) -> Direction<T> {
        self.each(|block| block.correct(aim.centre));
        let (tau, kappa) = self.at;
        self.direction((aim.centre - tau * kappa, predicted.tau * predicted.kappa), aim.keep, true)
    }

    /// Corrects a direction by where it went itself, and that one again, until its greatest step is enough. Where that
    /// shortens the step by a third, it is the first corrector's.
    fn correct_more(&mut self, first: (Direction<T>, T), aim: &Aim<T>, enough: T) -> (Direction<T>, T) {
        let most = T::literal(2.0);
        let (mut along, mut reach) = first;
        for _ in 0..MORE_CORRECTIONS {
            if reach >= enough {
                break;
            }
            self.correct_again(&mut along, aim);
            let further = self.greatest_step(&along, most);
            if further < reach * T::literal(2.0 / 3.0) {
                let predicted = self.predict();
                along = self.correct(&predicted, aim);
                reach = self.greatest_step(&along, most);
                break;
            }
            reach = further;
        }
        (along, reach)
    }

    /// One of these corrections. Only what changes is solved for, so that rounding does not come in anew.
    fn correct_again(&mut self, along: &mut Direction<T>, aim: &Aim<T>) {
        let (tau_now, kappa_now) = self.at;
        let second = along.tau * along.kappa;
        let change = along.second - second;
        let mut right = Vector6::zeros();
        let mut last = change / tau_now;
        self.each(|block| last += block.correct_again(aim.centre, &mut right));
        let mut twist = self.cholesky.solve(&right);
        last -= self.program.wrench.dot(&twist);
        self.each(|block| last += block.pull_more(&twist));
        let tau = last / self.pivot;
        twist += self.twist * tau;
        let whole = along.tau + tau;
        self.each(|block| {
            block.go_with_tau(tau);
            block.arrive(aim.keep, whole);
        });
        along.twist += twist;
        along.tau = whole;
        along.kappa += (change - kappa_now * tau) / tau_now;
        along.second = second;
    }

    fn greatest_step(&mut self, along: &Direction<T>, most: T) -> T {
        let mut step = most;
        let (tau, kappa) = self.at;
        for (x, d) in [(tau, along.tau), (kappa, along.kappa)] {
            if x + d * step < T::zero() {
                step = step.min(-x / d);
            }
        }
        self.each(|block| step = block.greatest_step(step));
        step
    }
}

impl<T: Real, const N: usize, const ROWS: usize> Program<T, N, ROWS> {
    /// One step of predictor and correctors from an iterate, of which it is known what it misses; of that, what is left of
    /// the equations. It need not leave less than so small a share. `false`, and nothing changed, if the step leads nowhere.
    pub(crate) fn step(
        &self,
        at: &mut Iterate<T, N, ROWS>,
        missing: &mut Missing<T, N, ROWS>,
        work: &mut Workspace<T, N, ROWS>,
        may_leave: T,
    ) -> bool {
        let mut system = System::new(self, at, missing, &mut work.scaled);
        let one = T::one();
        let predicted = system.predict();
        let left = one - system.greatest_step(&predicted, one);
        let sigma = left * left;
        let aim = Aim { centre: sigma * missing.complementarity, keep: one - sigma };
        // The better the prediction, the nearer to the border.
        let held_back = sigma.min(T::literal(0.01)).max(T::EPSILON.root());
        let mut along = system.correct(&predicted, &aim);
        let mut reach = system.greatest_step(&along, T::literal(2.0));
        let needed = (one - may_leave) / aim.keep;
        if left < T::literal(0.6) {
            let enough = needed.min(one) / (one - held_back);
            (along, reach) = system.correct_more((along, reach), &aim, enough);
        }
        // Where it is the end anyway, no nearer than rounding bears.
        let well_inside = reach * T::literal(0.99);
        let step = if well_inside >= needed { well_inside } else { reach * (one - held_back) }.min(one);
        if !(step > T::literal(1e-6)) {
            return false;
        }
        let against = (&-along.twist, along.tau);
        let given = (&self.blocks, &work.scaled);
        at.blocks.change_both_with_two(&mut missing.blocks, given, |at, residual, block, scaled| {
            if let (Some(block), Some(scaled)) = (block, scaled) {
                scaled.advance(block, at, residual, (aim.keep, step), against);
            }
        });
        missing.leave(one - aim.keep * step);
        at.twist += along.twist * step;
        at.tau += along.tau * step;
        at.kappa += along.kappa * step;
        true
    }
}

#[cfg(test)]
mod tests;
