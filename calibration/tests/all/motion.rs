//! Shape from motion: errors as stated, and the same sensor in any units, order and frame.

use fingertip_calibration::fit::FitError;
use fingertip_calibration::motion::{LeverArm, LeverArmFit, MotionError, constant_force, lever_arms};
use fingertip_calibration::nalgebra::{DMatrix, DVector, Vector3};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{gaussians, sensor, turn};
use super::spread::Spread;
use super::testing::Largest as _;

/// Noise of a reading; forces of 5 N give readings of 10.
const NOISE: f64 = 0.02;

/// Readings under a force of 5 N in so many directions.
fn directions(random: &mut Pcg64Mcg, count: usize) -> DMatrix<f64> {
    let mut forces = gaussians(random, count, 3);
    for mut row in forces.row_iter_mut() {
        let norm = row.norm();
        row *= 5.0 / norm;
    }
    forces
}

fn with_zero(mut signals: DMatrix<f64>, zero: &DVector<f64>) -> DMatrix<f64> {
    signals.row_iter_mut().for_each(|mut row| row += zero.transpose());
    signals
}

#[test]
fn errors_of_three_components_are_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(41);
    for (gauges, trials) in [(3, 1_400), (5, 1_100)] {
        let truth = sensor(random, 3, gauges);
        let zero = DVector::from_fn(gauges, |i, _| 10.0 - i as f64);
        let forces = directions(random, 25);
        let clean = with_zero(&forces * &truth, &zero);
        let spread = Spread::over(trials, || {
            let fit = constant_force(&(&clean + gaussians(random, 25, gauges) * NOISE), 5.0).unwrap();
            let mut errors: Vec<f64> = (&fit.zero - &zero).iter().copied().collect();
            let mut variances: Vec<f64> = fit.zero_deviation.iter().map(|s| s * s).collect();
            // The size of forces without noise, told by a fit with it.
            let squares = (0..25).map(|i| {
                let force = fit.force(&clean.row(i).transpose()).unwrap();
                (force.norm() / 5.0 - 1.0).powi(2) / 25.0
            });
            errors.push(squares.sum::<f64>().sqrt());
            variances.push(fit.size_deviation.powi(2));
            errors.push(fit.noise);
            variances.push(NOISE * NOISE);
            (errors, variances)
        });
        spread.agrees_in_the_mean(&format!("three components, {gauges} gauges"));
    }
}

fn arms(random: &mut Pcg64Mcg, truth: &DMatrix<f64>, zero: &DVector<f64>) -> Vec<LeverArm> {
    [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1], [-0.05, -0.06, 0.02]]
        .into_iter()
        .map(|arm| {
            let arm = Vector3::from(arm);
            let forces = directions(random, 14);
            let loads = DMatrix::from_fn(14, 6, |i, j| {
                let force = Vector3::from_fn(|k, _| forces[(i, k)]);
                if j < 3 { force[j] } else { arm.cross(&force)[j - 3] }
            });
            LeverArm { arm, signals: with_zero(loads * truth.transpose(), zero) }
        })
        .collect()
}

fn six(random: &mut Pcg64Mcg) -> (DMatrix<f64>, DVector<f64>) {
    let mut truth = sensor(random, 6, 6).transpose();
    truth.columns_mut(3, 3).scale_mut(10.0);
    (truth, DVector::from_fn(6, |i, _| i as f64))
}

fn noisy(random: &mut Pcg64Mcg, arms: &[LeverArm], noise: f64) -> Vec<LeverArm> {
    arms.iter()
        .map(|arm| LeverArm { signals: &arm.signals + gaussians(random, 14, 6) * noise, ..arm.clone() })
        .collect()
}

/// A seed whose only start finds the solution: the noise is too small to change its way.
fn lucky_seed(arms: &[LeverArm]) -> u64 {
    (0..200).find(|seed| lever_arms(arms, 5.0, 1e-6, 1, *seed).is_ok()).unwrap()
}

#[test]
fn errors_of_six_components_are_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(42);
    let (truth, zero) = six(random);
    let clean = arms(random, &truth, &zero);
    let seed = lucky_seed(&clean);
    let spread = Spread::over(330, || {
        let fit = lever_arms(&noisy(random, &clean, 1e-3), 5.0, 1e-2, 1, seed).unwrap();
        // The sign is not observable.
        let fit = fit.with_sign(&(truth.column(0) + &zero), &Vector3::x()).unwrap();
        let mut errors: Vec<f64> = (&fit.sensitivities - &truth).iter().copied().collect();
        errors.extend((&fit.zero - &zero).iter());
        let deviations = fit.deviations.iter().chain(fit.zero_deviation.iter());
        (errors, deviations.map(|s| s * s).collect())
    });
    spread.agrees_in_the_mean("six components");
}

/// Forces in other units, readings of gauges in others and mixed among each other, another order; the
/// frame of the sensor turned.
#[test]
fn shape_from_motion_does_not_mind_units_order_and_frames() {
    let random = &mut Pcg64Mcg::seed_from_u64(43);
    let (newton, metre, volt) = (1e3, 1e-2, 1e-4);
    // The search ends where the sum of squares does not fall any more: at the root of its rounding, of
    // the noise.
    let allowed = 100.0 * f64::EPSILON.sqrt();
    for _ in 0..10 {
        let truth = sensor(random, 3, 4);
        let signals = &directions(random, 25) * &truth + gaussians(random, 25, 4) * NOISE;
        let mix = {
            let (a, b) = (turn(random), turn(random));
            let mut mix = DMatrix::identity(4, 4);
            mix.view_mut((0, 0), (3, 3)).copy_from(&a);
            let mut other = DMatrix::identity(4, 4);
            other.view_mut((1, 1), (3, 3)).copy_from(&b);
            mix * other
        };
        let order: Vec<usize> = (0..25).map(|i| (7 * i + 3) % 25).collect();
        let one = constant_force(&signals, 5.0).unwrap();
        let two = constant_force(&(signals.select_rows(&order) * &mix * volt), 5.0 * newton).unwrap();
        // What does not know of the rotation of all forces.
        let gram = |map: &DMatrix<f64>| map * map.transpose();
        let back = mix.transpose() * gram(&one.signals_from_force) * &mix * (volt / newton).powi(2);
        let change = (gram(&two.signals_from_force) - &back).largest() / back.largest();
        assert!(change < allowed * one.size_deviation.max(1e-3), "{change:e}");
        let zero = &two.zero / volt - mix.transpose() * &one.zero;
        assert!(zero.largest() < allowed * one.zero_deviation.largest(), "{zero}");
        assert!((two.noise / volt / one.noise - 1.0).abs() < 1e-9);
        assert!((two.size_deviation / one.size_deviation - 1.0).abs() < 1e-6);
    }
    for _ in 0..2 {
        let (truth, zero) = six(random);
        let clean = arms(random, &truth, &zero);
        let arms = noisy(random, &clean, 1e-3);
        let frame = turn(random);
        let turned: Vec<LeverArm> = arms
            .iter()
            .rev()
            .map(|arm| LeverArm { arm: frame * arm.arm * metre, signals: &arm.signals * volt })
            .collect();
        let settle = |arms: &[LeverArm], force| lever_arms(arms, force, 1e-2, 60, 5).unwrap();
        let (one, two) = (settle(&arms, 5.0), settle(&turned, 5.0 * newton));
        let mut blocks = DMatrix::zeros(6, 6);
        for k in [0, 3] {
            blocks.view_mut((k, k), (3, 3)).copy_from(&frame);
        }
        let mut back = &two.sensitivities * blocks * (newton / volt);
        back.columns_mut(3, 3).scale_mut(metre);
        if back.dot(&one.sensitivities) < 0.0 {
            back.neg_mut();
        }
        let change = (&back - &one.sensitivities).component_div(&one.deviations).largest();
        assert!(change < allowed, "{change:e}");
        assert!(((&two.zero / volt - &one.zero).component_div(&one.zero_deviation)).largest() < allowed);
        assert!((two.noise / volt / one.noise - 1.0).abs() < 1e-9);
    }
}

#[test]
fn too_few_directions_or_gauges_are_refused() {
    let random = &mut Pcg64Mcg::seed_from_u64(44);
    let signals = directions(random, 10) * sensor(random, 3, 4);
    assert!(constant_force(&signals, 5.0).is_ok());
    for few in [signals.rows(0, 9).into_owned(), signals.columns(0, 2).into_owned()] {
        let error = constant_force(&few, 5.0).unwrap_err();
        let expected = FitError::TooFewSamples { samples: few.nrows(), coefficients: 9 };
        assert_eq!(error.to_string(), MotionError::Fit(expected).to_string());
    }
    for force in [0.0, -5.0, f64::NAN, f64::INFINITY] {
        let error = constant_force(&signals, force).unwrap_err().to_string();
        assert!(error.contains("the force or the readings"), "{force}: {error}");
    }
}

/// A reading under a force that points roughly along x settles the sign; across it, or nowhere, it does not.
#[test]
fn the_sign_is_settled_by_a_known_force_only() {
    let zero = DVector::from_fn(6, |i, _| 0.1 * i as f64);
    let found = LeverArmFit {
        sensitivities: DMatrix::identity(6, 6) * 2.0,
        deviations: DMatrix::zeros(6, 6),
        zero: zero.clone(),
        zero_deviation: DVector::zeros(6),
        noise: 0.0,
        freedom: 0.0,
        residual: 0.0,
        hits: 1,
        starts: 1,
        misfit: 0.0,
    };
    let mut reading = zero;
    reading[0] += 3.0;
    for (force, sign) in [(Vector3::new(1.0, 0.9, 0.0), 1.0), (Vector3::new(-2.0, 0.0, 5.0), -1.0)] {
        let settled = found.clone().with_sign(&reading, &force).unwrap();
        assert_eq!(settled, LeverArmFit { sensitivities: &found.sensitivities * sign, ..found.clone() });
    }
    assert_eq!(found.clone().with_sign(&reading, &Vector3::zeros()), None);
    assert_eq!(found.clone().with_sign(&reading, &Vector3::repeat(f64::NAN)), None);
    assert_eq!(found.with_sign(&DVector::zeros(5), &Vector3::x()), None);
}

/// What a fit says of itself: how far the forces that it tells of are from their size, and how much of the readings is
/// in a fourth direction.
#[test]
fn misfit_and_leakage_are_those_of_the_readings() {
    let random = &mut Pcg64Mcg::seed_from_u64(45);
    for gauges in 3..7 {
        let truth = sensor(random, 3, gauges);
        let signals = (directions(random, 18) * &truth).add_scalar(1.0) + gaussians(random, 18, gauges) * 0.2;
        let fit = constant_force(&signals, 5.0).unwrap();
        let squares: f64 = signals
            .row_iter()
            .map(|row| (fit.force(&row.transpose()).unwrap().norm() / 5.0 - 1.0).powi(2))
            .sum();
        assert!(
            fit.misfit > 1e-3 && (fit.misfit / (squares / 18.0).sqrt() - 1.0).abs() < 1e-9,
            "{}",
            fit.misfit
        );
        assert!(
            (&fit.force_from_signals * &fit.signals_from_force - DMatrix::identity(3, 3)).largest() < 1e-12
        );
        let mut centred = signals.clone();
        centred.row_iter_mut().for_each(|mut row| row -= signals.row_mean());
        // Squares of the singular values.
        let mut sizes: Vec<f64> =
            (centred.transpose() * centred).symmetric_eigenvalues().iter().copied().collect();
        sizes.sort_by(|a, b| b.total_cmp(a));
        let expected = if gauges > 3 { (sizes[3] / sizes[2]).sqrt() } else { 0.0 };
        assert!((fit.leakage - expected).abs() < 1e-9, "{gauges}: {} {expected}", fit.leakage);
        assert_eq!(fit.force(&DVector::zeros(gauges + 1)), None);
    }
}

/// Readings that are tiny or huge numbers are told as exactly as others.
#[test]
fn the_most_likely_sensor_does_not_mind_how_large_readings_are() {
    let random = &mut Pcg64Mcg::seed_from_u64(46);
    for _ in 0..5 {
        let signals = (directions(random, 15) * sensor(random, 3, 5)).add_scalar(2.0);
        let signals = signals + gaussians(random, 15, 5) * 0.3;
        let plain = constant_force(&signals, 5.0).unwrap();
        let gram = &plain.signals_from_force * plain.signals_from_force.transpose();
        for unit in [1e-12, 1e-6, 1e6, 1e12] {
            let other = constant_force(&(&signals * unit), 5.0).unwrap();
            let scaled = &other.signals_from_force * other.signals_from_force.transpose() / (unit * unit);
            assert!((scaled - &gram).largest() < 1e-6 * gram.largest(), "{unit:e}");
            assert!((other.noise / unit / plain.noise - 1.0).abs() < 1e-9, "{unit:e}");
            assert!((other.zero / unit - &plain.zero).largest() < 1e-6, "{unit:e}");
        }
    }
}

#[test]
fn too_few_arms_or_gauges_are_named() {
    let random = &mut Pcg64Mcg::seed_from_u64(47);
    let (truth, zero) = six(random);
    let good = arms(random, &truth, &zero);
    let refused = |arms: &[LeverArm]| lever_arms(arms, 5.0, 1e-6, 1, 1).unwrap_err().to_string();
    let mut uneven = good.clone();
    uneven[1].signals = uneven[1].signals.columns(0, 5).into_owned();
    let five: Vec<LeverArm> = (good.iter())
        .map(|arm| LeverArm { signals: arm.signals.columns(0, 5).into_owned(), ..arm.clone() })
        .collect();
    for wrong in [&good[..3], &five, &uneven, &[]] {
        assert!(refused(wrong).contains("four at least, six gauges at least"), "{}", refused(wrong));
    }
    // Arms in a plane through the origin say nothing of a torque across it.
    let mut flat = good;
    flat.iter_mut().for_each(|arm| arm.arm.z = 0.0);
    flat[2].arm = Vector3::new(0.05, 0.05, 0.0);
    assert!(lever_arms(&flat, 5.0, 1e-6, 20, 1).is_err());
}
