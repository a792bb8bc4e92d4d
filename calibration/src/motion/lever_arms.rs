//! Shape from motion for six components: a weight on known lever arms.

use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::constant_force::on_ellipsoid;
use super::likelihood::{Hung, most_likely};
use super::{ConstantForce, MotionError};
use crate::fit::FitError;
use crate::linear::pseudo_inverse;

/// A weight hung at one point of the sensor, turned into unknown directions.
///
/// ```
/// # use fingertip_calibration::nalgebra::{DMatrix, Vector3};
/// # // Six gauges: 0.5 V/N or 5 V/(N·m) on the axis of each, and a tenth of it on the next; a zero of 0.2 V.
/// # let volts_of = |force: &Vector3<f64>, arm: &Vector3<f64>| -> [f64; 6] {
/// #     let torque = arm.cross(force) * 10.0;
/// #     let load = [force.x, force.y, force.z, torque.x, torque.y, torque.z];
/// #     core::array::from_fn(|i| 0.2 + 0.5 * load[i] + 0.05 * load[(i + 1) % 6])
/// # };
/// # let volts = |arm: &Vector3<f64>, k: usize| {
/// #     let (around, up) = (2.4 * k as f64 + 50.0 * arm.sum(), (k as f64 - 6.5) / 7.0);
/// #     let across = (1.0 - up * up).sqrt();
/// #     volts_of(&(Vector3::new(around.cos() * across, around.sin() * across, up) * 5.0), arm)
/// # };
/// # let places = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1], [-0.05, -0.06, 0.02]].map(Vector3::from);
/// use fingertip_calibration::motion::{LeverArm, lever_arms};
///
/// // 5 N hung 100 mm from the sensor along x, y and z, and at a fourth point that is in no plane with these.
/// let hung: Vec<LeverArm> = places
///     .map(|arm| LeverArm { arm, signals: DMatrix::from_fn(14, 6, |k, i| volts(&arm, k)[i]) })
///     .into();
/// let found = lever_arms(&hung, 5.0, 1e-6, 60, 1)?;
/// // Its zero is 0.2 V on each gauge.
/// assert!(found.zero.iter().all(|zero| (zero - 0.2).abs() < 1e-6));
/// // Three arms are too few.
/// assert!(lever_arms(&hung[..3], 5.0, 1e-6, 60, 1).is_err());
/// # Ok::<(), fingertip_calibration::motion::MotionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LeverArm {
    /// Where it hangs, in the sensor frame \[m\].
    pub arm: Vector3<f64>,
    /// Readings, samples × gauges; ten directions at least.
    pub signals: DMatrix<f64>,
}

/// A sensor of six components found without knowing any direction.
///
/// ```
/// # use fingertip_calibration::nalgebra::{DMatrix, Vector3};
/// # // Six gauges: 0.5 V/N or 5 V/(N·m) on the axis of each, and a tenth of it on the next; a zero of 0.2 V.
/// # let volts_of = |force: &Vector3<f64>, arm: &Vector3<f64>| -> [f64; 6] {
/// #     let torque = arm.cross(force) * 10.0;
/// #     let load = [force.x, force.y, force.z, torque.x, torque.y, torque.z];
/// #     core::array::from_fn(|i| 0.2 + 0.5 * load[i] + 0.05 * load[(i + 1) % 6])
/// # };
/// # let volts = |arm: &Vector3<f64>, k: usize| {
/// #     let (around, up) = (2.4 * k as f64 + 50.0 * arm.sum(), (k as f64 - 6.5) / 7.0);
/// #     let across = (1.0 - up * up).sqrt();
/// #     volts_of(&(Vector3::new(around.cos() * across, around.sin() * across, up) * 5.0), arm)
/// # };
/// # let places = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1], [-0.05, -0.06, 0.02]].map(Vector3::from);
/// use fingertip_calibration::motion::{LeverArm, LeverArmFit, lever_arms};
/// use fingertip_calibration::nalgebra::DVector;
///
/// // 5 N hung at four points, in directions that nobody knows.
/// let hung: Vec<LeverArm> = places
///     .map(|arm| LeverArm { arm, signals: DMatrix::from_fn(14, 6, |k, i| volts(&arm, k)[i]) })
///     .into();
/// let found: LeverArmFit = lever_arms(&hung, 5.0, 1e-6, 60, 1)?;
/// // The sign is settled by a push of 1 N along z, which gives 0.5 V and more.
/// let reading = DVector::from_iterator(6, volts_of(&Vector3::z(), &Vector3::zeros()));
/// let signed = found.with_sign(&reading, &Vector3::z()).ok_or("wrong length")?;
/// assert!((signed.sensitivities[(2, 2)] - 0.5).abs() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LeverArmFit {
    /// signals − zero = this · \[force; torque\], gauges × 6, \[signal/N, signal/(N·m)\]. **Its sign is
    /// not observable** from weights in unknown directions; see [`LeverArmFit::with_sign`].
    pub sensitivities: DMatrix<f64>,
    /// Standard deviations of the sensitivities.
    pub deviations: DMatrix<f64>,
    /// Readings without load.
    pub zero: DVector<f64>,
    /// Standard deviations of these.
    pub zero_deviation: DVector<f64>,
    /// Standard deviation of one reading of one gauge; infinite, as the other deviations, if there are not
    /// more readings than unknowns.
    pub noise: f64,
    /// Degrees of freedom behind the noise and all deviations: readings less unknowns; zero if there are not more. An
    /// interval is a deviation times [`student_factor`](crate::fit::student_factor).
    pub freedom: f64,
    /// What is left of the blocks, relative.
    pub residual: f64,
    /// How many of the starts reached this solution.
    pub hits: usize,
    /// How many starts were made.
    pub starts: usize,
    /// Greatest relative misfit of the single lever arms.
    pub misfit: f64,
}

/// Finds the matrix of a sensor from weights of known size at four or more known lever arms that do
/// not lie in a plane, in unknown directions (`docs/theory/calibration.md#shape-from-motion`).
///
/// Each arm alone gives `B_k = C G_k O_k`, `G_k = [I; [r_k]×]`, with an unknown orthogonal `O_k`
/// ([`constant_force`](super::constant_force())). The rotations are found by Levenberg-Marquardt on
/// `min ‖[B_k O_kᵀ] (I − G⁺G)‖` from `starts` random starts, since the problem has many local minima; then
/// `C = [B_k O_kᵀ] G⁺`. From there, sensor, zero and all directions are brought to their most likely values,
/// for noise that is alike in all gauges; deviations are those of this estimate, to first order.
///
/// # Errors
/// [`MotionError`]; `NoSolution` if the best residual exceeds `tolerance` (1e-6 for clean data, a few times
/// the relative noise otherwise).
pub fn lever_arms(
    arms: &[LeverArm],
    force: f64,
    tolerance: f64,
    starts: usize,
    seed: u64,
) -> Result<LeverArmFit, MotionError> {
    let gauges = arms.first().map_or(0, |arm| arm.signals.ncols());
    if arms.len() < 4 || gauges < 6 || arms.iter().any(|arm| arm.signals.ncols() != gauges) {
        return Err(FitError::BadInput {
            what: "the list of lever arms (four at least, six gauges at least)",
        }
        .into());
    }
    let blocks: Vec<ConstantForce> =
        arms.iter().map(|arm| on_ellipsoid(&arm.signals, force)).collect::<Result<_, _>>()?;
    // Lengths in units of the arms', so that forces and torques weigh alike.
    let length = arms.iter().map(|arm| arm.arm.norm()).fold(0.0, f64::max);
    if !(length > 0.0 && length.is_finite()) {
        return Err(FitError::BadInput { what: "the list of lever arms (all are zero)" }.into());
    }
    let count = arms.len();
    let mut g = DMatrix::zeros(6, 3 * count);
    for (k, arm) in arms.iter().enumerate() {
        g.view_mut((0, 3 * k), (3, 3)).fill_with_identity();
        g.view_mut((3, 3 * k), (3, 3)).copy_from(&(arm.arm / length).cross_matrix());
    }
    let inverse = pseudo_inverse(&g)
        .ok_or(FitError::BadInput { what: "the list of lever arms (they lie in a plane)" })?;
    let annihilator = DMatrix::identity(3 * count, 3 * count) - &inverse * &g;
    let size = blocks.iter().map(|block| block.signals_from_force.norm_squared()).sum::<f64>().sqrt();
    let (best, residuals) = search(&blocks, &annihilator, size, starts, seed);
    let Some((residual, map)) = best.filter(|(residual, _)| *residual <= tolerance) else {
        let residual = residuals.iter().copied().fold(f64::INFINITY, f64::min);
        return Err(MotionError::NoSolution { starts, residual });
    };
    let mut sensitivities = map * inverse;
    let mut zero = DVector::zeros(gauges);
    for block in &blocks {
        zero += &block.zero / count as f64;
    }
    let hung: Vec<Hung<'_>> = arms
        .iter()
        .enumerate()
        .map(|(k, arm)| Hung { load: g.columns(3 * k, 3).into_owned(), signals: &arm.signals })
        .collect();
    let mut deviations = DMatrix::from_element(gauges, 6, f64::INFINITY);
    let mut zero_deviation = DVector::from_element(gauges, f64::INFINITY);
    let (mut noise, mut freedom) = (f64::INFINITY, 0.0);
    if let Some(found) = most_likely(&hung, &(&sensitivities * force), &zero, false) {
        sensitivities = found.map / force;
        let spread = found.covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
        deviations = DMatrix::from_row_slice(gauges, 6, &spread.as_slice()[..6 * gauges]) / force;
        zero = found.zero;
        zero_deviation = spread.rows(6 * gauges, gauges).into_owned();
        (noise, freedom) = (found.noise, found.freedom);
    }
    sensitivities.columns_mut(3, 3).scale_mut(1.0 / length);
    deviations.columns_mut(3, 3).scale_mut(1.0 / length);
    Ok(LeverArmFit {
        sensitivities,
        deviations,
        zero,
        zero_deviation,
        noise,
        freedom,
        residual,
        hits: residuals.iter().filter(|r| **r <= (2.0 * residual).max(tolerance)).count(),
        starts,
        misfit: blocks.iter().map(|block| block.misfit).fold(0.0, f64::max),
    })
}

/// The map that the annihilator leaves least of, relative to `size`, among those found from random starts; and
/// what it leaves of each of them.
fn search(
    blocks: &[ConstantForce],
    annihilator: &DMatrix<f64>,
    size: f64,
    starts: usize,
    seed: u64,
) -> (Option<(f64, DMatrix<f64>)>, Vec<f64>) {
    let gauges = blocks.first().map_or(0, |block| block.signals_from_force.nrows());
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut best: Option<(f64, DMatrix<f64>)> = None;
    let mut residuals = Vec::with_capacity(starts);
    for _ in 0..starts {
        let mut map = DMatrix::zeros(gauges, 3 * blocks.len());
        for (k, block) in blocks.iter().enumerate() {
            let mut draw = || random.random_range(-1.0..1.0);
            let q = nalgebra::Quaternion::new(draw(), draw(), draw(), draw());
            let rotation = UnitQuaternion::from_quaternion(q).to_rotation_matrix();
            // Each block's handedness is unknown; one sign for all is not observable.
            let sign = if k > 0 && random.random_bool(0.5) { -1.0 } else { 1.0 };
            set_block(&mut map, k, &(&block.signals_from_force * dynamic(&(rotation.matrix() * sign))));
        }
        let residual = refine(&mut map, annihilator) / size;
        residuals.push(residual);
        if best.as_ref().is_none_or(|(least, _)| residual < *least) {
            best = Some((residual, map));
        }
    }
    (best, residuals)
}

impl LeverArmFit {
    /// Settles the sign by one reading under a force whose direction is known roughly (within 90°).
    #[must_use]
    pub fn with_sign(mut self, reading: &DVector<f64>, force: &Vector3<f64>) -> Option<Self> {
        if reading.len() != self.zero.len() {
            return None;
        }
        let load = pseudo_inverse(&self.sensitivities)? * (reading - &self.zero);
        let along = force.dot(&Vector3::new(load[0], load[1], load[2]));
        if !(along.abs() > 0.0) {
            return None;
        }
        self.sensitivities *= along.signum();
        Some(self)
    }
}

fn dynamic(matrix: &Matrix3<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(3, 3, |i, j| matrix[(i, j)])
}

fn set_block(map: &mut DMatrix<f64>, k: usize, block: &DMatrix<f64>) {
    map.view_mut((0, 3 * k), (block.nrows(), 3)).copy_from(block);
}

/// Levenberg-Marquardt over the rotations of the blocks; what is left of the residual.
fn refine(map: &mut DMatrix<f64>, annihilator: &DMatrix<f64>) -> f64 {
    let gauges = map.nrows();
    let count = map.ncols() / 3;
    let mut residual = &*map * annihilator;
    let mut damping = 1e-3;
    for _ in 0..200 {
        let mut jacobian = DMatrix::zeros(residual.len(), 3 * count);
        for k in 0..count {
            let block = map.view((0, 3 * k), (gauges, 3)).into_owned();
            for j in 0..3 {
                let turn = dynamic(&Vector3::ith(j, 1.0).cross_matrix());
                let change = &block * turn * annihilator.rows(3 * k, 3);
                jacobian.set_column(3 * k + j, &DVector::from_column_slice(change.as_slice()));
            }
        }
        // The damped step: small and well conditioned by the damping, so its normal equations do no harm.
        let gradient = jacobian.transpose() * DVector::from_column_slice(residual.as_slice());
        let mut normal = jacobian.transpose() * &jacobian;
        let diagonal = normal.diagonal();
        normal.set_diagonal(&diagonal.add_scalar(damping * diagonal.max()));
        let Some(factor) = normal.cholesky() else { break };
        let step = factor.solve(&-gradient);
        let mut trial = map.clone();
        for k in 0..count {
            let turn =
                Rotation3::from_scaled_axis(Vector3::new(step[3 * k], step[3 * k + 1], step[3 * k + 2]));
            let block = map.view((0, 3 * k), (gauges, 3)) * dynamic(turn.matrix());
            set_block(&mut trial, k, &block);
        }
        let next = &trial * annihilator;
        if next.norm() < residual.norm() {
            let gain = 1.0 - next.norm() / residual.norm();
            *map = trial;
            residual = next;
            damping = (damping * 0.2).max(1e-15);
            if gain < 1e-9 && step.amax() < 1e-9 {
                break;
            }
        } else {
            damping *= 5.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    residual.norm()
}

#[cfg(test)]
mod tests {
    use super::{LeverArm, dynamic, lever_arms, refine, set_block};
    use crate::fit::testing::{gaussian, gaussian_matrix, sensor};
    use crate::motion::MotionError;
    use crate::testing::Largest as _;
    use nalgebra::{DMatrix, DVector, Rotation3, Vector3};
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    fn arms(random: &mut Pcg64Mcg, truth: &DMatrix<f64>, zero: &DVector<f64>, noise: f64) -> Vec<LeverArm> {
        [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1], [-0.05, -0.06, 0.02]]
            .into_iter()
            .map(|arm| {
                let arm = Vector3::from(arm);
                let mut signals = DMatrix::zeros(20, truth.nrows());
                for i in 0..20 {
                    let f = Vector3::from_fn(|_, _| gaussian(random)).normalize() * 5.0;
                    let m = arm.cross(&f);
                    let load = DVector::from_column_slice(&[f.x, f.y, f.z, m.x, m.y, m.z]);
                    signals.set_row(i, &(truth * load + zero).transpose());
                }
                LeverArm { arm, signals: signals + gaussian_matrix(random, 20, truth.nrows()) * noise }
            })
            .collect()
    }

    fn truth(random: &mut Pcg64Mcg) -> (DMatrix<f64>, DVector<f64>) {
        let mut truth = sensor(random, 6, 6).transpose();
        truth.columns_mut(3, 3).scale_mut(10.0);
        (truth, DVector::from_fn(6, |i, _| i as f64))
    }

    #[test]
    fn sensor_is_found_without_any_known_direction() {
        let random = &mut Pcg64Mcg::seed_from_u64(11);
        for seed in 0..3 {
            let (truth, zero) = truth(random);
            let arms = arms(random, &truth, &zero, 0.0);
            let fit = lever_arms(&arms, 5.0, 1e-6, 300, seed).unwrap();
            assert!((&fit.zero - &zero).largest() < 1e-6);
            // One force is known to point roughly along −z.
            let load = DVector::from_column_slice(&[1.0, 0.5, -3.0, 0.0, 0.0, 0.0]);
            let fit = fit.with_sign(&(&truth * load + zero), &-Vector3::z()).unwrap();
            assert!((&fit.sensitivities - &truth).largest() < 1e-5 * truth.largest(), "{}", fit.residual);
            println!("{} of {} starts", fit.hits, fit.starts);
        }
    }

    #[test]
    fn noise_is_tolerated_and_nonsense_refused() {
        let random = &mut Pcg64Mcg::seed_from_u64(12);
        let (truth, zero) = truth(random);
        let noisy = arms(random, &truth, &zero, 1e-3);
        let fit = lever_arms(&noisy, 5.0, 1e-2, 300, 1).unwrap();
        let fit = fit.with_sign(&(truth.column(0) + &zero), &Vector3::x()).unwrap();
        assert!((&fit.sensitivities - &truth).largest() < 0.02 * truth.largest());
        let of_arm =
            |arm: &LeverArm| crate::motion::constant_force::on_ellipsoid(&arm.signals, 5.0).unwrap().misfit;
        let mut worst = fingertip_test_support::Worst::new();
        noisy.iter().for_each(|arm| worst.see(of_arm(arm)));
        assert_eq!(fit.misfit, worst.get());
        let mut wrong = noisy.clone();
        wrong[2].arm = Vector3::new(0.0, 0.05, 0.03);
        assert!(matches!(lever_arms(&wrong, 5.0, 1e-3, 100, 1), Err(MotionError::NoSolution { .. })));
        assert!(lever_arms(&noisy[..3], 5.0, 1e-2, 10, 1).is_err());
        let refusal = |arm: &dyn Fn(Vector3<f64>) -> Vector3<f64>| {
            let mut arms = noisy.clone();
            arms.iter_mut().for_each(|one| one.arm = arm(one.arm));
            lever_arms(&arms, 5.0, 1e-2, 10, 1).unwrap_err().to_string()
        };
        assert!(refusal(&|_| Vector3::zeros()).contains("all are zero"));
        assert!(refusal(&|arm| arm * f64::INFINITY).contains("all are zero"));
    }

    /// Wherever it starts, a search ends where no turn of a block leaves less: a step that goes too far is made shorter.
    #[test]
    fn every_search_ends_in_a_minimum() {
        let random = &mut Pcg64Mcg::seed_from_u64(13);
        for _ in 0..40 {
            let g = gaussian_matrix(random, 6, 12);
            let annihilator = DMatrix::identity(12, 12) - crate::linear::pseudo_inverse(&g).unwrap() * &g;
            let mut map = gaussian_matrix(random, 6, 12);
            let left = refine(&mut map, &annihilator);
            assert!(((&map * &annihilator).norm() - left).abs() < 1e-12);
            for k in 0..4 {
                for axis in 0..3 {
                    let turned = |angle: f64| {
                        let turn = Rotation3::new(Vector3::ith(axis, angle));
                        let mut other = map.clone();
                        set_block(&mut other, k, &(map.view((0, 3 * k), (6, 3)) * dynamic(turn.matrix())));
                        (other * &annihilator).norm_squared()
                    };
                    let slope = (turned(1e-4) - turned(-1e-4)) / 2e-4;
                    assert!(slope.abs() < 1e-4 * map.norm_squared(), "{slope:e} {left}");
                }
            }
        }
    }
}
