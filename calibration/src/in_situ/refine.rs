//! Mending a calibration with touches and a few known loads.

use nalgebra::{DMatrix, DVector};

use crate::file::{Covariance, of_pseudo_inverse};
use crate::fit::FitError;
use crate::linear::{Singular, Triangular, pseudo_inverse};

/// What mending a calibration gave.
///
/// ```
/// # use fingertip_calibration::nalgebra::{DMatrix, DVector, Vector3, Vector6};
/// # // What a touch at a place of a ball of 12 mm reads: N, and N·m times 100.
/// # let touch = |k: i32| -> Vector6<f64> {
/// #     let at = f64::from(k);
/// #     let normal = Vector3::new((2.4 * at).cos(), (2.4 * at).sin(), (1.3 * at).sin()).normalize();
/// #     let force = Vector3::new((3.1 * at).sin(), (1.7 * at).cos(), (0.9 * at).sin()) - normal * 2.0;
/// #     let torque = (normal * 0.012 + Vector3::new(0.0, 0.0, 0.005)).cross(&force) * 100.0;
/// #     Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
/// # };
/// use fingertip_calibration::in_situ::{Refined, refine};
///
/// // The signals are loads in nominal loads. The calibration that there is has 2 % too much of one entry.
/// let mut start = DMatrix::identity(6, 6);
/// start[(0, 0)] = 1.02;
/// // A hundred touches, and one known load on each axis.
/// let touches = DMatrix::from_fn(100, 6, |k, i| touch(k as i32)[i]);
/// let known = DMatrix::identity(6, 6);
/// let refined: Refined = refine(&start, &touches, 1e-3, &known, &known, 1e-2)?;
/// assert!((refined.loads_per_signal[(0, 0)] - 1.0).abs() < 0.005);
/// // The pitch of the touches is less than before.
/// assert!(refined.pitch.1 < 0.1 * refined.pitch.0);
/// # Ok::<(), fingertip_calibration::fit::FitError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// From signals to loads in nominal loads, 6 × gauges.
    pub loads_per_signal: DMatrix<f64>,
    /// Standard deviations of these, by the deviations that were given, to first order; directions that
    /// are not observed add nothing, since they stay as they were.
    pub deviations: DMatrix<f64>,
    /// Covariance of these, entries row by row, likewise.
    pub covariance: DMatrix<f64>,
    /// An orthonormal basis, as columns, of what is not observed: combinations of the entries, row by row.
    pub kept: DMatrix<f64>,
    /// RMS of the pitch `f·m / (|f||m|)` of the touches, before and after: 0 for point contacts.
    pub pitch: (f64, f64),
    /// How many directions of the 6 × gauges numbers neither touches nor known loads show: they stay as
    /// they were.
    pub unobserved: usize,
    /// Iterations.
    pub iterations: usize,
}

/// Mends the map from signals to loads (in nominal loads, so that forces and torques weigh alike) so that
/// the touches have no pitch and the known loads come out: Levenberg-Marquardt on
/// `Σ (fᵀm / (|f||m|) / pitch_deviation)² + Σ |B V − P|² / load_deviation²` from the calibration that there
/// is (`docs/theory/calibration.md#point-contacts-in-use`). Changes that nothing asks for are not made.
///
/// Touches leave a scale and the group O(3,3) open, 16 numbers; known loads in general directions that
/// are no point contacts leave 3 open if there are three of them, 1 with four, none with five (against
/// six without touches).
///
/// `touches` and `signals` hold tared readings, samples × gauges; `loads` are samples × 6.
///
/// # Errors
/// [`FitError`].
pub fn refine(
    start: &DMatrix<f64>,
    touches: &DMatrix<f64>,
    pitch_deviation: f64,
    signals: &DMatrix<f64>,
    loads: &DMatrix<f64>,
    load_deviation: f64,
) -> Result<Refined, FitError> {
    const MOST_ITERATIONS: usize = 200;
    let gauges = start.ncols();
    let finite = |m: &DMatrix<f64>| m.iter().all(|x| x.is_finite());
    if start.nrows() != 6 || touches.ncols() != gauges || !finite(start) || !finite(touches) {
        return Err(FitError::BadInput { what: "the calibration or the touches" });
    }
    let matching = signals.ncols() == gauges && loads.ncols() == 6 && signals.nrows() == loads.nrows();
    if !(matching || loads.is_empty()) || !finite(signals) || !finite(loads) {
        return Err(FitError::BadInput { what: "the known loads" });
    }
    if !(pitch_deviation > 0.0 && load_deviation > 0.0) {
        return Err(FitError::BadInput { what: "the standard deviations" });
    }
    let target = Target::new(start, (touches, pitch_deviation), (signals, loads, load_deviation));
    let mut map = start.clone();
    let (mut residual, mut jacobian) = target.at(&map);
    let mut iterations = 0;
    let mut unobserved = 0;
    while iterations < MOST_ITERATIONS {
        iterations += 1;
        // The step of least norm, so that what is not observed does not move.
        let (singular, projected) = reduced(&jacobian, &residual)?;
        let threshold = 1e-9 * singular.values.max();
        unobserved = 6 * gauges - singular.values.iter().filter(|value| **value > threshold).count();
        let mut damping = 0.0;
        let mut better = false;
        for _ in 0..30 {
            let mut step = DVector::zeros(6 * gauges);
            for (k, value) in singular.values.iter().enumerate() {
                if *value > threshold {
                    let along = singular.left.column(k).dot(&projected);
                    step -= singular.right.column(k) * (along * value / (value * value + damping));
                }
            }
            let trial = &map + DMatrix::from_row_slice(6, gauges, step.as_slice());
            let (next, slope) = target.at(&trial);
            if next.norm() < residual.norm() {
                let gain = 1.0 - next.norm() / residual.norm();
                (map, residual, jacobian) = (trial, next, slope);
                better = gain > 1e-12;
                break;
            }
            damping = (damping * 10.0_f64).max(1e-6 * singular.values.max().powi(2));
        }
        if !better {
            break;
        }
    }
    let (singular, _) = reduced(&jacobian, &residual)?;
    let threshold = 1e-9 * singular.values.max();
    let mut covariance = DMatrix::zeros(6 * gauges, 6 * gauges);
    let mut kept = Vec::new();
    for (k, value) in singular.values.iter().enumerate() {
        let direction = singular.right.column(k);
        if *value > threshold {
            covariance += direction * direction.transpose() / (value * value);
        } else {
            kept.push(direction.into_owned());
        }
    }
    let deviations = covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
    Ok(Refined {
        deviations: DMatrix::from_row_slice(6, gauges, deviations.as_slice()),
        covariance,
        kept: if kept.is_empty() { DMatrix::zeros(6 * gauges, 0) } else { DMatrix::from_columns(&kept) },
        pitch: (pitch(touches, start), pitch(touches, &map)),
        loads_per_signal: map,
        unobserved,
        iterations,
    })
}

impl Refined {
    /// Covariance of the normalised matrix that a calibration has after it was mended, from that of the calibration before,
    /// gauges × 6 `matrix` and `covariance`: of what was observed by this, of what was kept by that, to first order. One
    /// reading is as noisy as before. `None` for a matrix of another size or of deficient rank.
    #[must_use]
    pub fn covariance_after(&self, matrix: &DMatrix<f64>, covariance: &Covariance) -> Option<Covariance> {
        let (gauges, count) = (self.loads_per_signal.ncols(), self.loads_per_signal.len());
        if matrix.shape() != (gauges, 6) || covariance.signals.shape() != (gauges, gauges) {
            return None;
        }
        // Of the map before: it is the pseudo-inverse of the matrix, which both transposed have independent rows.
        // Entry (i, j) of the map, or of the transposed matrix, stands at (j, i) of its transpose, gauges × 6.
        let place = |entry: usize| (entry % gauges) * 6 + entry / gauges;
        let transposed = |of: &DMatrix<f64>| DMatrix::from_fn(count, count, |a, b| of[(place(a), place(b))]);
        let all = covariance.all();
        if all.shape() != (count, count) {
            return None;
        }
        let before = pseudo_inverse(matrix)?;
        let of_transposed = of_pseudo_inverse(&matrix.transpose(), &before.transpose(), &transposed(&all));
        let of_before = transposed(&of_transposed);
        let kept = &self.kept * self.kept.transpose();
        let of_map = &self.covariance + &kept * of_before * &kept;
        let mended = pseudo_inverse(&self.loads_per_signal)?;
        let entries = of_pseudo_inverse(&self.loads_per_signal, &mended, &of_map);
        Some(Covariance::of_entries(covariance.signals.clone(), entries))
    }
}

/// What is to vanish: the pitches of the touches, and what the known loads are off by.
struct Target<'a> {
    touches: &'a DMatrix<f64>,
    pitch_deviation: f64,
    /// `|f||m|` of each touch by the start. The weights stay those of the start, so that the target is polynomial.
    sizes: Vec<f64>,
    signals: &'a DMatrix<f64>,
    loads: &'a DMatrix<f64>,
    load_deviation: f64,
}

impl<'a> Target<'a> {
    fn new(
        start: &DMatrix<f64>,
        (touches, pitch_deviation): (&'a DMatrix<f64>, f64),
        (signals, loads, load_deviation): (&'a DMatrix<f64>, &'a DMatrix<f64>, f64),
    ) -> Self {
        let sizes = touches
            .row_iter()
            .map(|row| {
                let load = start * row.transpose();
                (load.rows(0, 3).norm() * load.rows(3, 3).norm()).max(f64::MIN_POSITIVE)
            })
            .collect();
        Self { touches, pitch_deviation, sizes, signals, loads, load_deviation }
    }

    /// Residuals, and their derivatives by the entries of the map, row by row.
    fn at(&self, b: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let &Self { touches, pitch_deviation, ref sizes, signals, loads, load_deviation } = self;
        let gauges = b.ncols();
        let (t, p) = (touches.nrows(), loads.nrows());
        let mut residual = DVector::zeros(t + 6 * p);
        let mut jacobian = DMatrix::zeros(t + 6 * p, 6 * gauges);
        for i in 0..t {
            let v = touches.row(i);
            let load = b * v.transpose();
            let factor = 1.0 / (sizes[i] * pitch_deviation);
            residual[i] = factor * load.rows(0, 3).dot(&load.rows(3, 3));
            for axis in 0..6 {
                // ∂(fᵀm)/∂B[axis][g] = (the other vector)[axis] V[g].
                let other = load[(axis + 3) % 6] * factor;
                for g in 0..gauges {
                    jacobian[(i, axis * gauges + g)] = other * v[g];
                }
            }
        }
        for i in 0..p {
            let v = signals.row(i);
            let load = b * v.transpose();
            for axis in 0..6 {
                let row = t + 6 * i + axis;
                residual[row] = (load[axis] - loads[(i, axis)]) / load_deviation;
                for g in 0..gauges {
                    jacobian[(row, axis * gauges + g)] = v[g] / load_deviation;
                }
            }
        }
        (residual, jacobian)
    }
}

/// RMS of the pitch of the touches, `f·m / (|f||m|)`.
fn pitch(touches: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    let sum: f64 = touches
        .row_iter()
        .map(|row| {
            let load = b * row.transpose();
            let (f, m) = (load.rows(0, 3), load.rows(3, 3));
            (f.dot(&m) / (f.norm() * m.norm()).max(f64::MIN_POSITIVE)).powi(2)
        })
        .sum();
    (sum / touches.nrows().max(1) as f64).sqrt()
}

/// The singular values of a tall matrix and the right side that belongs to them, by way of its triangle: the
/// same, for the cost of a few columns however many rows there are.
fn reduced(jacobian: &DMatrix<f64>, residual: &DVector<f64>) -> Result<(Singular, DVector<f64>), FitError> {
    let mut triangular = Triangular::new(jacobian.ncols(), 1);
    let mut line = vec![0.0; jacobian.ncols()];
    for (row, value) in jacobian.row_iter().zip(residual.iter()) {
        line.iter_mut().zip(row.iter()).for_each(|(slot, value)| *slot = *value);
        triangular.push(&line, &[*value]);
    }
    let factors = triangular.factors();
    let singular = Singular::new(&factors.regressors).ok_or(FitError::BadInput { what: "the touches" })?;
    Ok((singular, factors.projected.column(0).into_owned()))
}

#[cfg(test)]
mod tests {
    use super::refine;
    use crate::fit::testing::{gaussian, gaussian_matrix, sensor};
    use crate::testing::Largest as _;
    use nalgebra::{DMatrix, Vector3};
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    fn touches(random: &mut Pcg64Mcg, count: usize, truth: &DMatrix<f64>) -> DMatrix<f64> {
        let mut loads = DMatrix::zeros(count, 6);
        for i in 0..count {
            let mut vector = || Vector3::from_fn(|_, _| gaussian(random));
            let (f, r) = (vector(), vector());
            loads.view_mut((i, 0), (1, 3)).copy_from(&f.transpose());
            loads.view_mut((i, 3), (1, 3)).copy_from(&r.cross(&f).transpose());
        }
        let inverse = truth.clone().try_inverse().unwrap();
        loads * inverse.transpose()
    }

    #[test]
    fn touches_and_few_loads_mend_a_drifted_sensor() {
        let random = &mut Pcg64Mcg::seed_from_u64(8);
        let truth = sensor(random, 6, 6);
        let drifted = &truth + gaussian_matrix(random, 6, 6) * 0.02;
        let signals = touches(random, 100, &truth);
        // Touches alone: 16 numbers stay open, and the pitch vanishes.
        let empty = DMatrix::zeros(0, 6);
        let alone = refine(&drifted, &signals, 1e-3, &empty, &empty, 1.0).unwrap();
        assert_eq!(alone.unobserved, 16);
        assert!(alone.pitch.1 < 1e-9 && alone.pitch.0 > 1e-3);
        // What is left is the orthogonal group of what is perpendicular to the known loads: of dimension
        // 15 − … = 3, 1, 0 after three, four, five of them. Without touches, 6 (6 − loads) stay open.
        for (count, open) in [(3, 3), (4, 1), (5, 0)] {
            let known = gaussian_matrix(random, count, 6);
            let loads = &known * truth.transpose();
            let both = refine(&drifted, &signals, 1e-3, &known, &loads, 1e-3).unwrap();
            assert_eq!(both.unobserved, open);
            if open == 0 {
                assert!((both.loads_per_signal - &truth).largest() < 1e-7);
            }
            let none = DMatrix::zeros(0, 6);
            assert_eq!(
                refine(&drifted, &none, 1e-3, &known, &loads, 1e-3).unwrap().unobserved,
                6 * (6 - count)
            );
        }
    }
}
