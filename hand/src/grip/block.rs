//! One contact's share of the cone program, and what an interior-point step does to it.

use fingertip_wrench::Real;
use nalgebra::{Matrix4, Matrix6x4, Vector4, Vector6};

use crate::grip::cone::{Scaling, divide, product, step_to_boundary, tail};

/// A half-space `normal·y ≤ bound` of a contact's forces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<T: Real> {
    pub(crate) normal: Vector4<T>,
    pub(crate) bound: T,
}

/// What a contact can give: columns of the grasp map, what its normal force costs, half-spaces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block<T: Real, const ROWS: usize> {
    pub(crate) map: Matrix6x4<T>,
    pub(crate) cost: T,
    pub(crate) rows: [Option<Row<T>>; ROWS],
}

/// A point of the interior: forces and their dual, the slack of each half-space and its price.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interior<T: Real, const ROWS: usize> {
    pub(crate) y: Vector4<T>,
    pub(crate) z: Vector4<T>,
    pub(crate) rows: [Pair<T>; ROWS],
}

/// A slack and its price.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair<T> {
    pub(crate) slack: T,
    pub(crate) price: T,
}

/// What does not change while an iteration solves several times.
///
/// What is near the boundary is never formed from large parts that cancel: forces are `root·x`, with `x` of the size
/// of the scaled point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factored<T: Real, const ROWS: usize> {
    scaling: Scaling<T>,
    /// The inverse Hessian is `root·rootᵀ`, with `root = W·turned`.
    root: Matrix4<T>,
    turned: Matrix4<T>,
    /// `map·root`.
    mapped: Matrix6x4<T>,
    /// `rootᵀ normal` of each row.
    normals: [Vector4<T>; ROWS],
    /// What is missing of the half-spaces: `slack + normal·y − bound τ`.
    row_residuals: [T; ROWS],
    /// What is missing of the dual: `Gᵀprice − mapᵀν − z + cost τ`.
    residual: Vector4<T>,
    /// `rootᵀGᵀD h`, with `D = price/slack`, and `rootᵀ cost`.
    weighted: Vector4<T>,
    costs: Vector4<T>,
}

/// What is asked of the complementarity of a block: `W⁻¹dy + W dz`, and `price dσ + slack dλ` of each row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target<T: Real, const ROWS: usize> {
    cone: Vector4<T>,
    rows: [T; ROWS],
}

fn unit<T: Real>(first: T) -> Vector4<T> {
    Vector4::new(first, T::zero(), T::zero(), T::zero())
}

impl<T: Real, const ROWS: usize> Interior<T, ROWS> {
    /// The middle of everything.
    pub(crate) fn middle() -> Self {
        let one = Pair { slack: T::one(), price: T::one() };
        Self { y: unit(T::one()), z: unit(T::one()), rows: [one; ROWS] }
    }

    /// Whether all is finite and inside, as rounding may have it otherwise.
    pub(crate) fn is_inside(&self) -> bool {
        let cone = |v: &Vector4<T>| v.x > tail(v) && v.x.is_number();
        let positive = |x: T| x > T::zero() && x.is_number();
        cone(&self.y)
            && cone(&self.z)
            && self.rows.iter().all(|row| positive(row.slack) && positive(row.price))
    }

    /// Multiplies all by a factor.
    pub(crate) fn scale(&mut self, factor: T) {
        self.y *= factor;
        self.z *= factor;
        for row in &mut self.rows {
            row.slack *= factor;
            row.price *= factor;
        }
    }

    /// Moves by `step` along a direction.
    #[inline]
    pub(crate) fn advance(&mut self, along: &Self, step: T) {
        self.y += along.y * step;
        self.z += along.z * step;
        for (row, along) in self.rows.iter_mut().zip(&along.rows) {
            row.slack += along.slack * step;
            row.price += along.price * step;
        }
    }
}

impl<T: Real, const ROWS: usize> Block<T, ROWS> {
    /// The rows that are there, with what belongs to them.
    #[inline]
    fn with<'a, A>(&'a self, other: &'a [A; ROWS]) -> impl Iterator<Item = (&'a Row<T>, &'a A)> {
        self.rows.iter().zip(other).filter_map(|(row, a)| row.as_ref().map(|row| (row, a)))
    }

    /// How many rows there are.
    pub(crate) fn count(&self) -> usize {
        self.rows.iter().flatten().count()
    }

    /// `Σ bound·price`.
    #[inline]
    pub(crate) fn priced(&self, at: &Interior<T, ROWS>) -> T {
        self.with(&at.rows).fold(T::zero(), |sum, (row, pair)| sum + row.bound * pair.price)
    }

    /// `Gᵀprice − mapᵀν`: what the dual cone must hold, but for the cost.
    #[inline]
    pub(crate) fn pull(&self, at: &Interior<T, ROWS>, twist: &Vector6<T>) -> Vector4<T> {
        let start = -self.map.tr_mul(twist);
        self.with(&at.rows).fold(start, |sum, (row, pair)| sum + row.normal * pair.price)
    }

    /// `y·z + Σ slack·price`.
    #[inline]
    pub(crate) fn complementarity(&self, at: &Interior<T, ROWS>) -> T {
        self.with(&at.rows).fold(at.y.dot(&at.z), |sum, (_, pair)| sum + pair.slack * pair.price)
    }

    /// The largest of what is missing of the half-spaces.
    #[inline]
    pub(crate) fn row_residual(&self, at: &Interior<T, ROWS>, tau: T) -> T {
        self.with(&at.rows).fold(T::zero(), |worst, (row, pair)| {
            worst.max((row.normal.dot(&at.y) + pair.slack - row.bound * tau).abs())
        })
    }

    /// Factors for the present iterate.
    #[inline]
    pub(crate) fn factor(&self, at: &Interior<T, ROWS>, twist: &Vector6<T>, tau: T) -> Factored<T, ROWS> {
        let scaling = Scaling::new(&at.y, &at.z);
        let mut root = scaling.matrix();
        let mut turned = Matrix4::identity();
        let mut normals = [Vector4::zeros(); ROWS];
        let mut row_residuals = [T::zero(); ROWS];
        for (i, (row, pair)) in self.rows.iter().zip(&at.rows).enumerate() {
            let Some(row) = row else { continue };
            // H = (F Fᵀ)⁻¹ + d g gᵀ has the inverse root F (I − β u uᵀ), u = Fᵀg, β = (1 − 1/r)/|u|²,
            // r² = 1 + d|u|²: without cancellation until the price of a slack has reached 1/ε².
            let u = root.tr_mul(&row.normal);
            let weight = pair.price / pair.slack;
            let r = (T::one() + weight * u.norm_squared()).root();
            let beta = weight / (r * (r + T::one()));
            let reflect = |m: &Matrix4<T>| m - (m * u * beta) * u.transpose();
            root = reflect(&root);
            turned = reflect(&turned);
            for normal in normals.iter_mut().take(i) {
                *normal -= u * (beta * u.dot(normal));
            }
            if let (Some(normal), Some(residual)) = (normals.get_mut(i), row_residuals.get_mut(i)) {
                *normal = u / r;
                *residual = row.normal.dot(&at.y) + pair.slack - row.bound * tau;
            }
        }
        let mut weighted = Vector4::zeros();
        for ((row, pair), normal) in self.rows.iter().zip(&at.rows).zip(&normals) {
            if let Some(row) = row {
                weighted += normal * (row.bound * (pair.price / pair.slack));
            }
        }
        let residual = self.pull(at, twist) - at.z + unit(self.cost * tau);
        let costs = root.row(0).transpose() * self.cost;
        let mapped = self.map * root;
        Factored { scaling, root, turned, mapped, normals, row_residuals, residual, weighted, costs }
    }

    /// The predictor's target: no complementarity left.
    #[inline]
    pub(crate) fn predictor(&self, factored: &Factored<T, ROWS>, at: &Interior<T, ROWS>) -> Target<T, ROWS> {
        let mut rows = [T::zero(); ROWS];
        for (target, pair) in rows.iter_mut().zip(&at.rows) {
            *target = -pair.slack * pair.price;
        }
        Target { cone: -factored.scaling.point, rows }
    }

    /// The corrector's target: `centre` everywhere, and second order (Mehrotra 1992).
    #[inline]
    pub(crate) fn corrector(
        &self,
        factored: &Factored<T, ROWS>,
        at: &Interior<T, ROWS>,
        predicted: &Interior<T, ROWS>,
        centre: T,
    ) -> Target<T, ROWS> {
        let scaling = &factored.scaling;
        let second = product(&scaling.undo(&predicted.y), &scaling.apply(&predicted.z));
        let wanted = divide(&scaling.point, &(unit(centre) - second));
        let mut rows = [T::zero(); ROWS];
        for ((target, pair), step) in rows.iter_mut().zip(&at.rows).zip(&predicted.rows) {
            *target = centre - pair.slack * pair.price - step.slack * step.price;
        }
        Target { cone: wanted - scaling.point, rows }
    }

    /// The right-hand side for `τ`: `ρ₂ = GᵀD h − c`.
    #[inline]
    pub(crate) fn homogeneous(&self, factored: &Factored<T, ROWS>) -> Vector4<T> {
        factored.weighted - factored.costs
    }

    /// The right-hand side of a target, with `keep` of the residuals to go.
    #[inline]
    pub(crate) fn right_hand_side(
        &self,
        factored: &Factored<T, ROWS>,
        at: &Interior<T, ROWS>,
        target: &Target<T, ROWS>,
        keep: T,
    ) -> Vector4<T> {
        let missing = factored.scaling.apply(&(factored.residual * keep));
        let mut force = target.cone - missing;
        if ROWS > 0 {
            force = factored.turned.tr_mul(&force);
        }
        let rows = at.rows.iter().zip(&target.rows).zip(&factored.row_residuals);
        for ((row, normal), ((pair, target), residual)) in self.rows.iter().zip(&factored.normals).zip(rows) {
            if row.is_some() {
                force -= normal * ((*target + pair.price * *residual * keep) / pair.slack);
            }
        }
        force
    }

    /// `h·(e/slack + D η r)`: what the rows add to the equation of `τ`.
    #[inline]
    pub(crate) fn row_terms(
        &self,
        factored: &Factored<T, ROWS>,
        at: &Interior<T, ROWS>,
        target: &Target<T, ROWS>,
        keep: T,
    ) -> T {
        let rows = at.rows.iter().zip(&target.rows).zip(&factored.row_residuals);
        self.rows.iter().zip(rows).fold(T::zero(), |sum, (row, ((pair, target), residual))| match row {
            Some(row) => sum + row.bound * (*target + pair.price * *residual * keep) / pair.slack,
            None => sum,
        })
    }

    /// `h·D h`.
    #[inline]
    pub(crate) fn row_stiffness(&self, at: &Interior<T, ROWS>) -> T {
        self.with(&at.rows)
            .fold(T::zero(), |sum, (row, pair)| sum + row.bound * row.bound * (pair.price / pair.slack))
    }

    /// The whole direction from those of `y`, `ν` and `τ`.
    #[inline]
    #[allow(clippy::too_many_arguments, reason = "the parts of one step")]
    pub(crate) fn direction(
        &self,
        factored: &Factored<T, ROWS>,
        at: &Interior<T, ROWS>,
        target: &Target<T, ROWS>,
        keep: T,
        scaled: &Vector4<T>,
        twist: &Vector6<T>,
        tau: T,
    ) -> Interior<T, ROWS> {
        let y = factored.root * scaled;
        let none = Pair { slack: T::zero(), price: T::zero() };
        let mut along = Interior { y, z: Vector4::zeros(), rows: [none; ROWS] };
        let mut z = factored.residual * keep + unit(self.cost * tau) - self.map.tr_mul(twist);
        let given = at.rows.iter().zip(&target.rows).zip(&factored.row_residuals);
        let rows = self.rows.iter().zip(&factored.normals).zip(&mut along.rows);
        for (((row, normal), found), ((pair, target), residual)) in rows.zip(given) {
            let Some(row) = row else { continue };
            found.slack = row.bound * tau - normal.dot(scaled) - *residual * keep;
            found.price = (*target - pair.price * found.slack) / pair.slack;
            z += row.normal * found.price;
        }
        along.z = z;
        along
    }

    /// The greatest step that stays inside; at most `most`.
    #[inline]
    pub(crate) fn greatest_step(&self, at: &Interior<T, ROWS>, along: &Interior<T, ROWS>, most: T) -> T {
        let mut step = step_to_boundary(&at.y, &along.y, most);
        step = step_to_boundary(&at.z, &along.z, step);
        let within = |step: T, x: T, d: T| if d < T::zero() { step.min(-x / d) } else { step };
        for ((row, at), along) in self.rows.iter().zip(&at.rows).zip(&along.rows) {
            if row.is_some() {
                step = within(within(step, at.slack, along.slack), at.price, along.price);
            }
        }
        step
    }

    /// By how much the pull leaves the dual cone: no more than this and rounding.
    #[inline]
    pub(crate) fn violation(&self, pull: &Vector4<T>) -> T {
        (tail(pull) - pull.x).max(T::zero())
    }
}

impl<T: Real, const ROWS: usize> Target<T, ROWS> {
    pub(crate) fn none() -> Self {
        Self { cone: Vector4::zeros(), rows: [T::zero(); ROWS] }
    }
}

impl<T: Real, const ROWS: usize> Factored<T, ROWS> {
    /// `map H⁻¹ mapᵀ`, the upper half of it added to `sum`.
    #[inline]
    pub(crate) fn add_to(&self, sum: &mut nalgebra::Matrix6<T>) {
        *sum += self.mapped * self.mapped.transpose();
    }

    /// `map H⁻¹ ρ`.
    #[inline]
    pub(crate) fn wrench(&self, share: &Vector4<T>) -> Vector6<T> {
        self.mapped * share
    }

    /// `rootᵀ(mapᵀν + ρ)`: of which `root` makes forces.
    #[inline]
    pub(crate) fn scaled(&self, twist: &Vector6<T>, share: &Vector4<T>) -> Vector4<T> {
        self.mapped.tr_mul(twist) + share
    }

    /// `(GᵀD h + c)·forces`.
    #[inline]
    pub(crate) fn weighed(&self, scaled: &Vector4<T>) -> T {
        (self.weighted + self.costs).dot(scaled)
    }

    /// The wrench of forces.
    #[inline]
    pub(crate) fn wrench_of(&self, scaled: &Vector4<T>) -> Vector6<T> {
        self.mapped * scaled
    }
}
