//! Shape from motion: a constant force in unknown directions.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use thiserror::Error;

use super::likelihood::{Hung, MostLikely, most_likely};
use crate::fit::{FitError, least_squares};
use crate::linear::{Singular, Unobserved, pseudo_inverse};

/// What a force of constant size in unknown directions tells of a sensor: its forces up to one
/// rotation (or reflection) of all of them, and its zero.
///
/// ```
/// use fingertip_calibration::motion::{ConstantForce, constant_force};
/// use fingertip_calibration::nalgebra::{DMatrix, DVector, Vector3};
///
/// // 5 N in 40 directions that nobody knows; three gauges of 0.1 V/N, 0.2 V/N and 0.3 V/N with a zero of 0.5 V.
/// let direction = |k: usize| {
///     let (around, up) = (2.4 * k as f64, (k as f64 - 19.5) / 20.0);
///     Vector3::new(around.cos() * (1.0 - up * up).sqrt(), around.sin() * (1.0 - up * up).sqrt(), up)
/// };
/// let volts = DMatrix::from_fn(40, 3, |k, i| 0.5 + 0.1 * (i + 1) as f64 * 5.0 * direction(k)[i]);
/// let found: ConstantForce = constant_force(&volts, 5.0)?;
/// assert!((found.zero[0] - 0.5).abs() < 1e-9);
/// // How strong a force is, if not yet where it points: 0.9 V beyond zero on the last gauge.
/// let force = found.force(&DVector::from_vec(vec![0.5, 0.5, 1.4])).ok_or("wrong length")?;
/// assert!((force.norm() - 3.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantForce {
    /// Forces \[N\] = this · (signals − zero), 3 × gauges; known up to an orthogonal matrix from the left.
    pub force_from_signals: DMatrix<f64>,
    /// The inverse on the span of the readings: signals − zero = this · force, gauges × 3.
    pub signals_from_force: DMatrix<f64>,
    /// The readings without load.
    pub zero: DVector<f64>,
    /// Standard deviations of the zero.
    pub zero_deviation: DVector<f64>,
    /// Standard deviation of the size of a force that it tells of, relative, because of the fit alone (root
    /// mean square over the directions of the fit).
    pub size_deviation: f64,
    /// Standard deviation of one reading of one gauge; infinite, as the other deviations, if there are not
    /// more readings than unknowns.
    pub noise: f64,
    /// Degrees of freedom behind the noise and all deviations: readings less unknowns; zero if there are not more. An
    /// interval is a deviation times [`student_factor`](crate::fit::student_factor).
    pub freedom: f64,
    /// RMS deviation of the fitted forces' size from the given one, relative.
    pub misfit: f64,
    /// Fourth over third singular value of the readings: noise and nonlinearity over signal. Near
    /// zero for a good sensor of three components.
    pub leakage: f64,
}

/// Why motion tells no shape.
///
/// ```
/// use fingertip_calibration::motion::{MotionError, constant_force};
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// // Readings of a force that was not constant: they lie on a hyperboloid.
/// let volts = DMatrix::from_fn(40, 3, |k, i| {
///     let (around, up) = (2.4 * k as f64, (k as f64 - 19.5) / 10.0);
///     [around.cos() * up.cosh(), around.sin() * up.cosh(), up.sinh()][i]
/// });
/// assert!(matches!(constant_force(&volts, 5.0), Err(MotionError::NotAnEllipsoid)));
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MotionError {
    /// A size, count or number is wrong, or directions are too few or too alike.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The readings lie on no ellipsoid: the force was not constant, or its directions cover too
    /// little.
    #[error(
        "the readings do not lie on an ellipsoid: the force was not constant, or its directions are too alike"
    )]
    NotAnEllipsoid,
    /// No start of the search came near a solution.
    #[error("no solution in {starts} starts; the best leaves a relative residual of {residual:.2e}")]
    NoSolution {
        /// How many starts were made.
        starts: usize,
        /// What the best left.
        residual: f64,
    },
    /// Directions for the alignment are missing or parallel.
    #[error("two known directions that are not parallel are needed")]
    NoAlignment,
}

/// Shape from motion for three components (Voyles, Morrow & Khosla 1997;
/// `docs/theory/calibration.md#shape-from-motion`): a weight of known size (`force` \[N\]) is turned into
/// nine or more unknown directions.
///
/// The centred readings (samples × gauges) have rank three; in the coordinates of their singular
/// vectors they lie on an ellipsoid, whose centre is the zero and whose shape is the sensor. From there, sensor,
/// zero and all directions are brought to their most likely values, for noise that is alike in all
/// gauges; deviations are those of this estimate, to first order.
///
/// # Errors
/// [`MotionError::NotAnEllipsoid`], or [`MotionError::Fit`] for too few or too similar directions.
pub fn constant_force(signals: &DMatrix<f64>, force: f64) -> Result<ConstantForce, MotionError> {
    let start = on_ellipsoid(signals, force)?;
    let (samples, gauges) = signals.shape();
    let hung = [Hung { load: DMatrix::identity(3, 3), signals }];
    let Some(found) = most_likely(&hung, &(&start.signals_from_force * force), &start.zero, true) else {
        return Ok(start);
    };
    let signals_from_force = &found.map / force;
    let inverse = pseudo_inverse(&signals_from_force).ok_or(MotionError::NotAnEllipsoid)?;
    let squares: f64 = (0..samples)
        .map(|i| ((&inverse * (signals.row(i).transpose() - &found.zero)).norm() / force - 1.0).powi(2))
        .sum();
    Ok(ConstantForce {
        size_deviation: size_deviation(&found, &(&inverse / force)),
        force_from_signals: inverse,
        signals_from_force,
        zero_deviation: found.covariance.diagonal().rows(3 * gauges, gauges).map(|v| v.max(0.0).sqrt()),
        zero: found.zero,
        noise: found.noise,
        freedom: found.freedom,
        misfit: (squares / samples as f64).sqrt(),
        leakage: start.leakage,
    })
}

/// The ellipsoid of the readings, by linear least squares: near the most likely sensor, not at it.
pub(super) fn on_ellipsoid(signals: &DMatrix<f64>, force: f64) -> Result<ConstantForce, MotionError> {
    let (samples, gauges) = signals.shape();
    if !(force > 0.0 && force.is_finite()) || signals.iter().any(|x| !x.is_finite()) {
        return Err(FitError::BadInput { what: "the force or the readings" }.into());
    }
    if samples < 10 || gauges < 3 {
        return Err(FitError::TooFewSamples { samples, coefficients: 9 }.into());
    }
    let mean = signals.row_mean();
    let mut centred = signals.clone();
    for mut row in centred.row_iter_mut() {
        row -= &mean;
    }
    let singular = Singular::new(&centred).ok_or(FitError::BadInput { what: "the matrix of readings" })?;
    if singular.rank() < 3 {
        let directions = singular.right.columns(singular.rank(), 3 - singular.rank()).into_owned();
        return Err(
            FitError::Unobserved(Unobserved { regressors: gauges, directions, names: Vec::new() }).into()
        );
    }
    // Unit variance along each direction: the quadric is then near a sphere.
    let scale = (samples as f64).sqrt();
    let points = singular.left.columns(0, 3) * scale;
    let mut design = DMatrix::zeros(samples, 9);
    for i in 0..samples {
        let (x, y, z) = (points[(i, 0)], points[(i, 1)], points[(i, 2)]);
        for (j, value) in
            [x * x, y * y, z * z, 2.0 * x * y, 2.0 * x * z, 2.0 * y * z, x, y, z].into_iter().enumerate()
        {
            design[(i, j)] = value;
        }
    }
    let fit = least_squares(&design, &DMatrix::from_element(samples, 1, 1.0), None)?;
    let c = &fit.coefficients;
    let shape = Matrix3::new(c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2]);
    let linear = Vector3::new(c[6], c[7], c[8]);
    let factor = shape.cholesky().ok_or(MotionError::NotAnEllipsoid)?;
    let centre = factor.solve(&linear) * -0.5;
    let size = 1.0 + centre.dot(&(shape * centre));
    let root =
        (shape * (force * force / size)).cholesky().ok_or(MotionError::NotAnEllipsoid)?.l().transpose();
    let inverse_root = root.try_inverse().ok_or(MotionError::NotAnEllipsoid)?;
    // points = (signals − mean) · V Σ⁻¹ · scale.
    let mut whiten = singular.right.columns(0, 3).into_owned();
    let mut colour = whiten.clone();
    for j in 0..3 {
        whiten.column_mut(j).scale_mut(scale / singular.values[j]);
        colour.column_mut(j).scale_mut(singular.values[j] / scale);
    }
    let dynamic = |m: &Matrix3<f64>| DMatrix::from_fn(3, 3, |i, j| m[(i, j)]);
    let force_from_signals = dynamic(&root) * whiten.transpose();
    let signals_from_force = &colour * dynamic(&inverse_root);
    let zero = mean.transpose() + &colour * DVector::from_column_slice(centre.as_slice());
    let squares: f64 = (0..samples)
        .map(|i| {
            let point = Vector3::new(points[(i, 0)], points[(i, 1)], points[(i, 2)]);
            ((root * (point - centre)).norm() / force - 1.0).powi(2)
        })
        .sum();
    Ok(ConstantForce {
        force_from_signals,
        signals_from_force,
        zero_deviation: DVector::from_element(gauges, f64::INFINITY),
        zero,
        size_deviation: f64::INFINITY,
        noise: f64::INFINITY,
        freedom: 0.0,
        misfit: (squares / samples as f64).sqrt(),
        leakage: if gauges > 3 { singular.values[3] / singular.values[2] } else { 0.0 },
    })
}

/// Errors of map and zero move the size of the force along d by `−dᵀB (δmap d + δzero)`, B the inverse.
fn size_deviation(found: &MostLikely, inverse: &DMatrix<f64>) -> f64 {
    let gauges = found.zero.len();
    let variance = |direction: &Vector3<f64>| {
        let along = inverse.transpose() * direction;
        let slope = DVector::from_fn(4 * gauges, |k, _| {
            if k < 3 * gauges { along[k / 3] * direction[k % 3] } else { along[k - 3 * gauges] }
        });
        slope.dot(&(&found.covariance * &slope))
    };
    let sum: f64 = found.directions.iter().map(variance).sum();
    (sum / found.directions.len() as f64).max(0.0).sqrt()
}

impl ConstantForce {
    /// The force that a reading tells of.
    #[must_use]
    pub fn force(&self, reading: &DVector<f64>) -> Option<Vector3<f64>> {
        if reading.len() != self.zero.len() {
            return None;
        }
        let force = &self.force_from_signals * (reading - &self.zero);
        Some(Vector3::new(force[0], force[1], force[2]))
    }

    /// Settles the rotation by readings under forces of known direction: at least two that are not
    /// parallel. Three that are clear of one plane (by some 3·10⁻⁵ of a radian or more) tell a reflection,
    /// too; of those that are not, it is taken that there is none.
    ///
    /// # Errors
    /// [`MotionError::NoAlignment`].
    pub fn aligned(&self, known: &[(DVector<f64>, Vector3<f64>)]) -> Result<Self, MotionError> {
        let mut covariance = Matrix3::zeros();
        for (reading, direction) in known {
            let force = self.force(reading).ok_or(MotionError::NoAlignment)?;
            let norms = force.norm() * direction.norm();
            if !(norms > 0.0 && norms.is_finite()) {
                return Err(MotionError::NoAlignment);
            }
            covariance += direction * force.transpose() / norms;
        }
        let singular = Singular::new(&DMatrix::from_fn(3, 3, |i, j| covariance[(i, j)]))
            .ok_or(MotionError::NoAlignment)?;
        if !(singular.values[1] > 1e-6 * singular.values[0]) {
            return Err(MotionError::NoAlignment);
        }
        let (mut u, v) = (singular.left, singular.right);
        if !(singular.values[2] > 1e-9 * singular.values[0]) {
            // Two directions: complete them to right-handed triples, which assumes no reflection.
            let cross = |m: &DMatrix<f64>| {
                let a = Vector3::new(m[(0, 0)], m[(1, 0)], m[(2, 0)]);
                a.cross(&Vector3::new(m[(0, 1)], m[(1, 1)], m[(2, 1)]))
            };
            let (third, other) = (cross(&u), cross(&v));
            let mut right = v;
            right.set_column(2, &other);
            u.set_column(2, &third);
            return Ok(self.turned(&(u * right.transpose())));
        }
        Ok(self.turned(&(u * v.transpose())))
    }

    fn turned(&self, rotation: &DMatrix<f64>) -> Self {
        Self {
            force_from_signals: rotation * &self.force_from_signals,
            signals_from_force: &self.signals_from_force * rotation.transpose(),
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{MotionError, constant_force, on_ellipsoid};
    use crate::fit::testing::{gaussian, gaussian_matrix, sensor};
    use crate::testing::Largest as _;
    use nalgebra::{DMatrix, DVector, Vector3};
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    fn directions(random: &mut Pcg64Mcg, count: usize) -> DMatrix<f64> {
        let mut forces = gaussian_matrix(random, count, 3);
        for mut row in forces.row_iter_mut() {
            let norm = row.norm();
            row *= 5.0 / norm;
        }
        forces
    }

    /// Says whether the three known directions were clear of one plane.
    fn come_back_up_to_a_rotation(seed: u64, gauges: usize) -> Result<bool, TestCaseError> {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let truth = sensor(random, 3, gauges);
        let forces = directions(random, 30);
        let zero = DVector::from_fn(gauges, |_, _| 10.0 * gaussian(random));
        let mut signals = &forces * &truth;
        for mut row in signals.row_iter_mut() {
            row += zero.transpose();
        }
        let found = constant_force(&signals, 5.0).unwrap();
        prop_assert!(found.misfit < 1e-9 && found.leakage < 1e-9);
        prop_assert!((&found.zero - &zero).largest() < 1e-8);
        // The Gram matrix does not know of rotations.
        let again = DMatrix::from_fn(30, 3, |i, j| found.force(&signals.row(i).transpose()).unwrap()[j]);
        let gram = &again * again.transpose();
        prop_assert!((gram - &forces * forces.transpose()).largest() < 1e-7);
        let known: Vec<_> =
            (0..3).map(|i| (signals.row(i).transpose(), Vector3::from_fn(|j, _| forces[(i, j)]))).collect();
        let spread = (forces.rows(0, 3) / 5.0).singular_values();
        let clear = spread[2] > 1e-3 * spread[0];
        if let Ok(aligned) = found.aligned(&known) {
            for (signals, force) in &known {
                // In the plane of the directions a reflection at it changes nothing.
                prop_assert!((aligned.force(signals).unwrap() - force).norm() < 5e-4);
            }
            if clear {
                prop_assert!((aligned.signals_from_force - truth.transpose()).largest() < 1e-5);
            }
        }
        Ok(clear)
    }

    proptest! {
        #[test]
        fn forces_come_back_up_to_a_rotation(seed in any::<u64>(), gauges in 3..8_usize) {
            come_back_up_to_a_rotation(seed, gauges)?;
        }
    }

    /// Three directions within 2·10⁻⁵ of one plane, and a fit that is a reflection of the sensor.
    #[test]
    fn directions_in_a_plane_tell_no_reflection() {
        assert!(!come_back_up_to_a_rotation(2_509_477_007_351_754_047, 6).unwrap());
    }

    /// The misfit of the ellipsoid is that of the forces it tells of. Forces of half and double size tell of a sensor of
    /// double and half the gain.
    #[test]
    fn an_ellipsoid_says_how_far_its_forces_are_off() {
        let random = &mut Pcg64Mcg::seed_from_u64(4);
        for gauges in 3..6 {
            let truth = sensor(random, 3, gauges);
            let signals = (directions(random, 15) * &truth).add_scalar(2.0);
            let signals = signals + gaussian_matrix(random, 15, gauges) * 0.1;
            let found = on_ellipsoid(&signals, 5.0).unwrap();
            let size = |i: usize| found.force(&signals.row(i).transpose()).unwrap().norm();
            let squares: f64 = (0..15).map(|i| (size(i) / 5.0 - 1.0).powi(2)).sum();
            assert!(found.misfit > 1e-4 && (found.misfit / (squares / 15.0).sqrt() - 1.0).abs() < 1e-9);
            let inverse = &found.force_from_signals * &found.signals_from_force;
            assert!((inverse - DMatrix::identity(3, 3)).largest() < 1e-12);
            for force in [2.5, 10.0] {
                let other = on_ellipsoid(&signals, force).unwrap();
                let change = &other.signals_from_force * (force / 5.0) - &found.signals_from_force;
                assert!(change.largest() < 1e-12 && (other.misfit - found.misfit).abs() < 1e-12);
                assert!((other.zero - &found.zero).largest() < 1e-12);
            }
        }
    }

    /// One direction, but for a milliradian in one of ten readings, tells of no turn about itself; a hundredth of
    /// a radian does.
    #[test]
    fn parallel_forces_settle_no_rotation() {
        let random = &mut Pcg64Mcg::seed_from_u64(3);
        let truth = sensor(random, 3, 4);
        let found = constant_force(&(directions(random, 30) * &truth), 5.0).unwrap();
        let known = |angle: f64| -> Vec<_> {
            (0..10)
                .map(|i| {
                    let angle = if i == 4 { angle } else { 0.0 };
                    let force = Vector3::new(0.0, 5.0 * angle.sin(), 5.0 * angle.cos());
                    (truth.tr_mul(&force), force)
                })
                .map(|(signals, force)| (DVector::from_column_slice(signals.as_slice()), force))
                .collect()
        };
        assert_eq!(found.aligned(&known(1e-3)).unwrap_err(), MotionError::NoAlignment);
        assert_eq!(found.aligned(&[]).unwrap_err(), MotionError::NoAlignment);
        for bad in [Vector3::zeros(), Vector3::new(f64::NAN, 0.0, 1.0)] {
            let mut with = known(0.5);
            with[7].1 = bad;
            assert_eq!(found.aligned(&with).unwrap_err(), MotionError::NoAlignment);
        }
        let aligned = found.aligned(&known(0.01)).unwrap();
        // Of a turn about the common direction an error of 1e-9 shows a hundredfold.
        assert!((aligned.signals_from_force - truth.transpose()).largest() < 1e-5);
    }

    #[test]
    fn hopeless_data_are_refused() {
        let random = &mut Pcg64Mcg::seed_from_u64(1);
        let noise = gaussian_matrix(random, 200, 3);
        if let Ok(found) = constant_force(&noise, 5.0) {
            assert!(found.misfit > 0.2);
        }
        let mut flat = directions(random, 30);
        flat.column_mut(2).fill(0.0);
        assert!(matches!(constant_force(&flat, 5.0), Err(MotionError::Fit(_))));
        assert!(matches!(constant_force(&noise.rows(0, 5).into(), 5.0), Err(MotionError::Fit(_))));
        assert!(matches!(constant_force(&noise, f64::NAN), Err(MotionError::Fit(_))));
    }
}
