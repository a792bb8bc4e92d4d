//! What an interior-point step does to one contact, in the scaled space of its cone.

use fingertip_wrench::Real;
use nalgebra::{Matrix6, Matrix6x4, Vector4, Vector6};

use crate::grip::block::{Block, Residual};
use crate::grip::cone::{Scaling, divide, product};
use crate::grip::interior::{Interior, unit};
use crate::grip::kernels::{add_pull, add_square, reflect_columns, subtract};
use crate::grip::scaled_row::ScaledRow;

/// A block that was factored at an iterate, and where it goes.
///
/// The inverse Hessian is `F Fᵀ` with `F = W P`: the scaling, and a reflection `I − β u uᵀ` for each direction of the
/// half-spaces. What is near the boundary is never formed from large parts that cancel: forces are `F x`, with `x` of the
/// size of the scaled point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scaled<T: Real, const ROWS: usize> {
    scaling: Scaling<T>,
    /// `u` and `β`; zero where there is none.
    reflections: [(Vector4<T>, T); ROWS],
    /// `map·F`.
    mapped: Matrix6x4<T>,
    rows: [ScaledRow<T>; ROWS],
    /// How many of these there are, the first ones; see [`Self::present`].
    used: usize,
    /// `Pᵀ W r + Σ Fᵀg D r`: what the residuals ask for.
    missing: Vector4<T>,
    /// `Σ bound D r`, the same in the equation of τ.
    missing_of_tau: T,
    /// `FᵀGᵀD h + Fᵀcost`.
    weights: Vector4<T>,
    /// `x` for one of τ: before it is known, what is asked of it, `FᵀGᵀD h − Fᵀcost`.
    of_tau: Vector4<T>,
    /// What is asked of the complementarity, `W⁻¹dy + W dz`.
    target: Vector4<T>,
    /// Where it goes: `F⁻¹dy`, `W⁻¹dy` and `W dz`.
    x: Vector4<T>,
    /// What the last correction adds to it.
    more: Vector4<T>,
    y: Vector4<T>,
    z: Vector4<T>,
}

/// `(I − β u uᵀ) v`.
#[inline]
fn reflect<T: Real>((u, beta): &(Vector4<T>, T), v: &mut Vector4<T>) {
    *v -= u * (*beta * u.dot(v));
}

impl<T: Real, const ROWS: usize> Scaled<T, ROWS> {
    /// How many rows to look at, of so many that there are: one or two are passed over faster than they are counted.
    #[inline(always)]
    const fn present(used: usize) -> usize {
        if ROWS > 2 { used } else { ROWS }
    }

    /// Not factored yet.
    pub(crate) fn none() -> Self {
        let none = Vector4::zeros();
        Self {
            scaling: Scaling::none(),
            reflections: [(none, T::zero()); ROWS],
            mapped: Matrix6x4::zeros(),
            rows: [ScaledRow::none(); ROWS],
            used: 0,
            missing: none,
            missing_of_tau: T::zero(),
            weights: none,
            of_tau: none,
            target: none,
            x: none,
            more: none,
            y: none,
            z: none,
        }
    }

    /// Factors at an iterate, and adds `map H⁻¹ mapᵀ` to the lower half of a sum.
    #[inline]
    pub(crate) fn factor(
        &mut self,
        block: &Block<T, ROWS>,
        at: &Interior<T, ROWS>,
        residual: &Residual<T, ROWS>,
        sum: &mut Matrix6<T>,
    ) {
        let scaling = Scaling::new(&at.y, &at.z);
        self.scaling = scaling;
        self.used = block.count();
        scaling.map(&block.map, &mut self.mapped);
        self.missing = scaling.apply(&residual.dual);
        for (scaled, ((row, pair), residual)) in
            self.rows.iter_mut().zip(block.rows.iter().zip(&at.rows).zip(&residual.rows))
        {
            let Some(row) = row else { continue };
            let inverse_slack = T::one() / pair.slack;
            *scaled = ScaledRow {
                normal: scaling.apply(&row.normal),
                bound: row.bound,
                slack: pair.slack,
                price: pair.price,
                inverse_slack,
                stiffness: pair.price * inverse_slack,
                residual: *residual,
                ..ScaledRow::none()
            };
        }
        let mut costs = scaling.first_row() * block.cost;
        for i in 0..Self::present(self.used) {
            if let Some(Some(row)) = block.rows.get(i)
                && !row.opposite
            {
                let next = block.rows.get(i + 1).and_then(Option::as_ref).is_some_and(|next| next.opposite);
                self.reflect(i, next, &mut costs);
            }
        }
        let mut weighted = Vector4::zeros();
        self.missing_of_tau = T::zero();
        for row in self.rows.iter().take(Self::present(self.used)) {
            weighted += row.normal * (row.bound * row.stiffness);
            self.missing += row.normal * (row.stiffness * row.residual);
            self.missing_of_tau += row.bound * row.stiffness * row.residual;
        }
        (self.weights, self.of_tau) = (weighted + costs, weighted - costs);
        add_square(&self.mapped, sum);
    }

    /// Takes a row into the root, together with the opposite one after it.
    #[inline]
    fn reflect(&mut self, i: usize, with_next: bool, costs: &mut Vector4<T>) {
        let Some(row) = self.rows.get(i) else { return };
        let next = self.rows.get(i + 1).filter(|_| with_next).map_or(T::zero(), |next| next.stiffness);
        // H = (F Fᵀ)⁻¹ + d g gᵀ has the inverse root F (I − β u uᵀ), u = Fᵀg, β = (1 − 1/r)/|u|²,
        // r² = 1 + d|u|²: without cancellation until the price of a slack has reached 1/ε².
        let (u, weight) = (row.normal, row.stiffness + next);
        let r = (T::one() + weight * u.norm_squared()).root();
        let reflection = (u, weight / (r * (r + T::one())));
        reflect_columns(&mut self.mapped, &u, reflection.1);
        reflect(&reflection, costs);
        reflect(&reflection, &mut self.missing);
        for (j, row) in self.rows.iter_mut().enumerate().take(Self::present(self.used)) {
            // Its own direction becomes u/r: said so, since the reflection would lose it to rounding.
            if j == i {
                row.normal = u / r;
            } else if with_next && j == i + 1 {
                row.normal = -u / r;
            } else {
                reflect(&reflection, &mut row.normal);
            }
        }
        if let Some(place) = self.reflections.get_mut(i) {
            *place = reflection;
        }
    }

    /// Takes off a wrench what one of τ asks for.
    #[inline]
    pub(crate) fn ask_of_tau(&self, right: &mut Vector6<T>) {
        subtract(&self.mapped, &self.of_tau, right);
    }

    /// Knows the twist for one of τ from here on, and takes the wrench of its forces off another. Returns what the block
    /// adds to the pivot of τ, a sum of squares: `|W⁻¹dy|² + Σ D dσ²`.
    #[inline]
    pub(crate) fn solve_tau(&mut self, twist: &Vector6<T>, left: &mut Vector6<T>) -> T {
        add_pull(&self.mapped, twist, &mut self.of_tau);
        subtract(&self.mapped, &self.of_tau, left);
        let x = &self.of_tau;
        self.rows.iter().take(Self::present(self.used)).fold(self.unturned(x).norm_squared(), |sum, row| {
            let slack = row.bound - row.normal.dot(x);
            sum + row.stiffness * slack * slack
        })
    }

    /// The predictor's target: no complementarity left.
    #[inline]
    pub(crate) fn predict(&mut self) {
        self.target = -self.scaling.point;
        for row in self.rows.iter_mut().take(Self::present(self.used)) {
            row.target = -row.slack * row.price;
        }
    }

    /// The corrector's target: `centre` everywhere, and second order by where it went (Mehrotra 1992).
    #[inline]
    pub(crate) fn correct(&mut self, centre: T) {
        let point = &self.scaling.point;
        let second = product(&self.y, &self.z);
        self.target = divide(point, self.scaling.det, &(unit(centre) - second)) - point;
        for row in self.rows.iter_mut().take(Self::present(self.used)) {
            row.target = centre - row.slack * row.price - row.slack_along * row.price_along;
        }
    }

    /// What the target asks for, with `keep` of the residuals to go: takes it off a wrench, and returns it of τ.
    #[inline]
    pub(crate) fn ask(&mut self, keep: T, right: &mut Vector6<T>) -> T {
        let mut x = self.turned(&self.target) - self.missing * keep;
        let mut of_tau = self.missing_of_tau * keep;
        self.ask_of_rows(&self.rows.map(|row| row.target), &mut x, &mut of_tau);
        self.x = x;
        subtract(&self.mapped, &self.x, right);
        of_tau
    }

    /// Takes off `x` what targets of the half-spaces ask for, and adds it to what is asked of τ.
    #[inline]
    fn ask_of_rows(&self, targets: &[T; ROWS], x: &mut Vector4<T>, of_tau: &mut T) {
        for (row, target) in self.rows.iter().zip(targets).take(Self::present(self.used)) {
            let share = *target * row.inverse_slack;
            *x -= row.normal * share;
            *of_tau += row.bound * share;
        }
    }

    /// The corrector's target again, now that it is known better where it goes: takes what that asks for besides off a
    /// wrench, and returns it of τ.
    #[inline]
    pub(crate) fn correct_again(&mut self, centre: T, right: &mut Vector6<T>) -> T {
        let before = self.target;
        let mut of_rows = self.rows.map(|row| row.target);
        self.correct(centre);
        for (more, row) in of_rows.iter_mut().zip(&self.rows) {
            *more = row.target - *more;
        }
        let mut more = self.turned(&(self.target - before));
        let mut of_tau = T::zero();
        self.ask_of_rows(&of_rows, &mut more, &mut of_tau);
        self.more = more;
        subtract(&self.mapped, &self.more, right);
        of_tau
    }

    /// Goes with what a twist asks for besides. Returns the same of τ as [`Self::pull`].
    #[inline]
    pub(crate) fn pull_more(&mut self, twist: &Vector6<T>) -> T {
        add_pull(&self.mapped, twist, &mut self.more);
        self.x += self.more;
        self.weights.dot(&self.more)
    }

    /// Goes with a twist. Returns `(GᵀD h + cost)·F x`.
    #[inline]
    pub(crate) fn pull(&mut self, twist: &Vector6<T>) -> T {
        add_pull(&self.mapped, twist, &mut self.x);
        self.weights.dot(&self.x)
    }

    /// Goes with τ.
    #[inline]
    pub(crate) fn go_with_tau(&mut self, tau: T) {
        self.x += self.of_tau * tau;
    }

    /// Takes the wrench of its forces off another.
    #[inline]
    pub(crate) fn take_wrench(&self, left: &mut Vector6<T>) {
        subtract(&self.mapped, &self.x, left);
    }

    /// `Pᵀ v`.
    #[inline]
    fn turned(&self, v: &Vector4<T>) -> Vector4<T> {
        let mut x = *v;
        for reflection in self.reflections.iter().take(Self::present(self.used)) {
            reflect(reflection, &mut x);
        }
        x
    }

    /// `P x`: `W⁻¹` of the forces `F x`.
    #[inline]
    fn unturned(&self, x: &Vector4<T>) -> Vector4<T> {
        let mut y = *x;
        for reflection in self.reflections.iter().take(Self::present(self.used)).rev() {
            reflect(reflection, &mut y);
        }
        y
    }

    /// Knows by the equations of complementarity where it goes.
    #[inline]
    pub(crate) fn arrive(&mut self, keep: T, tau: T) {
        self.y = self.unturned(&self.x);
        self.z = self.target - self.y;
        let x = &self.x;
        for row in self.rows.iter_mut().take(Self::present(self.used)) {
            row.slack_along = row.bound * tau - row.normal.dot(x) - row.residual * keep;
            row.price_along = (row.target - row.price * row.slack_along) * row.inverse_slack;
        }
    }

    /// The greatest step that stays inside; at most `most`.
    #[inline]
    pub(crate) fn greatest_step(&self, most: T) -> T {
        let mut step = self.scaling.step_to_boundary(&self.y, most);
        step = self.scaling.step_to_boundary(&self.z, step);
        for row in self.rows.iter().take(Self::present(self.used)) {
            for (x, d) in [(row.slack, row.slack_along), (row.price, row.price_along)] {
                // A division only where it is the shortest.
                if x + d * step < T::zero() {
                    step = step.min(-x / d);
                }
            }
        }
        step
    }

    /// Goes from an iterate a step along. What is dual comes from its equation, so that it stays feasible; what is left of
    /// the residuals of that equation and of the half-spaces follows from it, too.
    #[inline]
    pub(crate) fn advance(
        &self,
        block: &Block<T, ROWS>,
        at: &mut Interior<T, ROWS>,
        residual: &mut Residual<T, ROWS>,
        (keep, step): (T, T),
        (against, tau): (&Vector6<T>, T),
    ) {
        let mut z = residual.dual * keep;
        z.x += block.cost * tau;
        add_pull(&block.map, against, &mut z);
        for ((row, pair), scaled) in block.rows.iter().zip(&mut at.rows).zip(&self.rows) {
            if let Some(row) = row {
                pair.slack += scaled.slack_along * step;
                pair.price += scaled.price_along * step;
                z += row.normal * scaled.price_along;
            }
        }
        at.y += self.scaling.apply(&self.y) * step;
        at.z += z * step;
        let left = T::one() - keep * step;
        residual.dual *= left;
        for residual in &mut residual.rows {
            *residual *= left;
        }
    }
}
