//! Torques of forces at points of a shape: least squares with errors in both.

use fingertip_wrench::Wrench;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::{GeometryError, WrenchNoise};
use crate::fit::{FitError, with_noise_of_regressors};
use crate::linear::{Factors, Triangular, Unobserved};

/// The points at which the forces act, as a shape has them, and how they move with its parameters.
pub(super) struct Points {
    /// \[m\]
    pub(super) at: Vec<Vector3<f64>>,
    /// Derivative of the points by each parameter.
    pub(super) slopes: Vec<Vec<Vector3<f64>>>,
    /// A direction along which nothing is known of the points.
    pub(super) free: Option<Vector3<f64>>,
}

/// One step towards the shape, and what is known of it there.
pub(super) struct Step {
    /// Change of the parameters.
    pub(super) change: DVector<f64>,
    /// Change of the points along the free direction \[m\].
    pub(super) slide: Vec<f64>,
    /// `Σ rᵀWr`.
    pub(super) misfit: f64,
    pub(super) freedom: f64,
    /// RMS of the torque that is left, per component that the fit could not take up \[N·m\].
    pub(super) rms: f64,
    factors: Factors,
    /// What the noise of forces, as large as stated, makes of the triangle's square.
    hidden: DMatrix<f64>,
}

impl Step {
    /// The covariance of the parameters where the noise has this variance in units of the stated one.
    ///
    /// # Errors
    /// [`GeometryError::Undetermined`] if some combination of parameters, which is named, shows in noise alone.
    pub(super) fn covariance(&self, variance: f64, names: &[&str]) -> Result<DMatrix<f64>, GeometryError> {
        let hidden = &self.hidden * variance;
        let root =
            self.factors.inverse_root().map_err(|unobserved| GeometryError::unobserved(unobserved, names))?;
        match with_noise_of_regressors(&root, &hidden) {
            Ok(spread) => Ok(spread * variance),
            Err(error) => Err(self.hidden_by_noise(names).unwrap_or(error.into())),
        }
    }

    /// The combination of parameters of which the errors of the forces make the most, as the error that names it.
    fn hidden_by_noise(&self, names: &[&str]) -> Option<GeometryError> {
        let root = self.factors.inverse_root().ok()?;
        let share = root.transpose() * &self.hidden * &root;
        if share.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let eigen = share.symmetric_eigen();
        let mut direction = &root * eigen.eigenvectors.column(eigen.eigenvalues.imax());
        // In units of each parameter's own spread.
        for (entry, row) in direction.iter_mut().zip(root.row_iter()) {
            *entry /= row.norm().max(f64::MIN_POSITIVE);
        }
        let length = direction.norm();
        let directions = DMatrix::from_fn(names.len(), 1, |i, _| direction[i] / length);
        let (regressors, names) = (names.len(), names.iter().map(|name| (*name).to_owned()).collect());
        Some(GeometryError::hidden(&Unobserved { regressors, directions, names }))
    }
    /// Variance of the noise in units of the stated one.
    pub(super) fn variance(&self) -> f64 {
        self.misfit / self.freedom
    }
}

/// The covariance of the residual `r = m − c × f` of a point c: `[−[c], I] Σ [−[c], I]ᵀ`, and that of the force with it.
fn of_residual(noise: &WrenchNoise, point: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    let cross = point.cross_matrix();
    let with_force = noise.mixed + noise.forces * cross;
    (noise.torques - cross * with_force + noise.mixed.transpose() * cross, with_force)
}

/// L⁻¹ of a covariance LLᵀ.
fn whitener(covariance: &Matrix3<f64>) -> Result<Matrix3<f64>, GeometryError> {
    let factor = covariance.cholesky().ok_or(GeometryError::BadNoise)?;
    let mut inverse = Matrix3::identity();
    factor.l().solve_lower_triangular_mut(&mut inverse);
    Ok(inverse)
}

/// What one touch says at a step.
struct Row {
    /// Whitens torques, and leaves out what sliding along the free direction can take up.
    left: Matrix3<f64>,
    /// The force as adjusted to the point.
    adjusted: Vector3<f64>,
    /// `m − c × f`.
    residual: Vector3<f64>,
    /// Takes a torque to the slide along the free direction that gives it \[m\]; zero without one.
    slide: Vector3<f64>,
    /// Covariance of the adjusted force.
    unknown: Matrix3<f64>,
}

/// `None` where the force is along the free direction: its line tells nothing of where it is.
fn row(
    wrench: &Wrench<f64>,
    point: &Vector3<f64>,
    free: Option<&Vector3<f64>>,
    noise: &WrenchNoise,
    of_torques: &Matrix3<f64>,
) -> Result<Option<Row>, GeometryError> {
    let (force, torque) = (wrench.force(), wrench.torque());
    let residual = torque - point.cross(&force);
    let (whitener, with_force) = if noise.forces_are_exact() {
        (*of_torques, Matrix3::zeros())
    } else {
        let (covariance, with_force) = of_residual(noise, point);
        (whitener(&covariance)?, with_force)
    };
    let (mut adjusted, mut left, mut slide) = (force, whitener, Vector3::zeros());
    // What sliding takes up depends on the adjusted force, and that on what is left: settled in a few rounds.
    for _ in 0..if free.is_some() && !noise.forces_are_exact() { 4 } else { 1 } {
        if let Some(direction) = free {
            let blind = direction.cross(&adjusted);
            if !(blind.norm() > 64.0 * f64::EPSILON * adjusted.norm()) {
                return Ok(None);
            }
            let white = whitener * blind;
            slide = whitener.tr_mul(&white) / white.norm_squared();
            left = whitener - white * slide.transpose();
        }
        adjusted = force - with_force * (left.tr_mul(&(left * residual)));
    }
    let weight = left.transpose() * left;
    let unknown = noise.forces - with_force * weight * with_force.transpose();
    Ok(Some(Row { left, adjusted, residual, slide, unknown }))
}

/// One step of Gauss-Newton of `m = c(p) × f` for the parameters p, with the errors of forces and torques that
/// `noise` states (`docs/theory/calibration.md#the-shape-of-the-tip`): residuals are weighted by
/// `W = (Cov r)⁻¹`, and forces adjusted, `f̂ = f − Cov(f, r) W r`. Along a free direction d the points are where
/// they fit best, so that W leaves out what `d × f̂` can take up.
///
/// With exact forces this is least squares of the torques.
///
/// # Errors
/// [`GeometryError::Undetermined`] for parameters that nothing observes, by name; too few touches.
pub(super) fn step(
    wrenches: &[Wrench<f64>],
    points: &Points,
    noise: &WrenchNoise,
    names: &[&str],
) -> Result<Step, GeometryError> {
    let count = points.slopes.len();
    let free = points.free.as_ref();
    let mut hidden = DMatrix::zeros(count, count);
    let mut design = DMatrix::zeros(3 * wrenches.len(), count);
    let mut white = DVector::zeros(3 * wrenches.len());
    let (mut misfit, mut squares, mut components) = (0.0, 0.0, 0_usize);
    let mut sizes = vec![0.0_f64; count];
    let mut carried = vec![Matrix3::zeros(); count];
    let mut rows = Vec::with_capacity(wrenches.len());
    let of_torques = whitener(&noise.torques)?;
    for (i, (wrench, point)) in wrenches.iter().zip(&points.at).enumerate() {
        let row = row(wrench, point, free, noise, &of_torques)?;
        if let Some(Row { left, adjusted, residual, slide, unknown }) = &row {
            let fitted = left * residual;
            misfit += fitted.norm_squared();
            components += if free.is_some() { 2 } else { 3 };
            white.fixed_rows_mut::<3>(3 * i).copy_from(&fitted);
            let direction = free.copied().unwrap_or_default();
            // Once it is settled, nothing of it is what sliding could take up.
            squares += residual.norm_squared();
            for (j, column) in points.slopes.iter().enumerate() {
                // Less what sliding makes up for.
                let slope = column[i] - direction * slide.dot(&column[i].cross(adjusted));
                design.fixed_view_mut::<3, 1>(3 * i, j).copy_from(&(left * slope.cross(adjusted)));
                sizes[j] += column[i].norm_squared() * adjusted.norm_squared() * left.norm_squared();
                carried[j] = left * slope.cross_matrix();
            }
            if !noise.forces_are_exact() {
                for (k, other) in carried.iter().enumerate() {
                    let spread = other * unknown;
                    for (j, one) in carried.iter().enumerate() {
                        hidden[(j, k)] += one.dot(&spread);
                    }
                }
            }
        }
        rows.push(row);
    }
    if components <= count {
        return Err(FitError::TooFewSamples { samples: components, coefficients: count }.into());
    }
    for (column, size) in sizes.iter().enumerate() {
        // A column that is nothing but rounding observes nothing.
        if design.column(column).norm() <= 64.0 * f64::EPSILON * size.sqrt() {
            design.column_mut(column).fill(0.0);
        }
    }
    let (mut triangular, mut line) = (Triangular::new(count, 1), vec![0.0; count]);
    for (row, value) in design.row_iter().zip(white.iter()) {
        line.iter_mut().zip(row.iter()).for_each(|(slot, value)| *slot = *value);
        triangular.push(&line, &[*value]);
    }
    let factors = triangular.factors();
    let unseen = |unobserved| GeometryError::unobserved(unobserved, names);
    let change = factors.coefficients().map_err(unseen)?.column(0).into_owned();
    let moved = |i: usize| (0..count).map(|j| points.slopes[j][i] * change[j]).sum::<Vector3<f64>>();
    let slide = |(i, row): (usize, &Option<Row>)| {
        row.as_ref().map_or(0.0, |row| row.slide.dot(&(row.residual - moved(i).cross(&row.adjusted))))
    };
    Ok(Step {
        slide: rows.iter().enumerate().map(slide).collect(),
        misfit,
        freedom: (components - count) as f64,
        rms: (squares / components as f64).sqrt(),
        factors,
        change,
        hidden,
    })
}

const MOST_ITERATIONS: usize = 200;

/// Steps until they no longer change the shape: first with exact forces, since forces that are adjusted to a wrong
/// shape lead astray, then with the errors of both. `advance` makes a step and returns its size, in units of the
/// shape's own; infinite if it was shortened.
///
/// # Errors
/// As [`step`]; [`GeometryError::NoConvergence`].
pub(super) fn settle<S>(
    wrenches: &[Wrench<f64>],
    noise: &WrenchNoise,
    names: &[&str],
    mut shape: S,
    points: impl Fn(&S) -> Points,
    mut advance: impl FnMut(&mut S, &Step) -> f64,
) -> Result<(S, Step), GeometryError> {
    let exact = noise.without_forces();
    let stages = if noise.forces_are_exact() { &[exact][..] } else { &[exact, *noise][..] };
    for (stage, noise) in stages.iter().enumerate() {
        let settled = settle_with(wrenches, noise, names, shape, &points, &mut advance);
        match settled {
            Ok((settled, step)) if stage + 1 == stages.len() => return Ok((settled, step)),
            Ok((settled, _)) => shape = settled,
            // Of forces that are adjusted, and lead nowhere: what shows in their errors alone is the cause.
            Err((error, Some(first))) if stage > 0 => {
                return Err(first.hidden_by_noise(names).unwrap_or(error));
            }
            Err((error, _)) => return Err(error),
        }
    }
    Err(GeometryError::NoConvergence { iterations: 0 })
}

/// The shape and the last step, or the error and the first step.
type Settled<S> = Result<(S, Step), (GeometryError, Option<Box<Step>>)>;

fn settle_with<S>(
    wrenches: &[Wrench<f64>],
    noise: &WrenchNoise,
    names: &[&str],
    mut shape: S,
    points: impl Fn(&S) -> Points,
    mut advance: impl FnMut(&mut S, &Step) -> f64,
) -> Settled<S> {
    let (mut first, mut last) = (None, f64::INFINITY);
    for iteration in 0..MOST_ITERATIONS {
        let step = match step(wrenches, &points(&shape), noise, names) {
            Ok(step) => step,
            Err(error) => return Err((error, first)),
        };
        let size = advance(&mut shape, &step);
        // Steps that are small and no longer shrink are rounding; those of ill-conditioned touches are larger.
        let rounding = if iteration < 50 { 1e-9 } else { 1e-6 };
        if size <= 1e-12 || (size < rounding && size > 0.1 * last) {
            return Ok((shape, step));
        }
        if size.is_nan() {
            return Err((GeometryError::NoConvergence { iterations: iteration + 1 }, first));
        }
        last = size;
        first.get_or_insert_with(|| Box::new(step));
    }
    Err((GeometryError::NoConvergence { iterations: MOST_ITERATIONS }, first))
}
