//! What ordinary touches tell: errors as stated, and the same in any units, order and frame.

use fingertip_calibration::file::Covariance;
use fingertip_calibration::in_situ::{PointContactForm, angle_between, form_of, refine};
use fingertip_calibration::nalgebra::DMatrix;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{gaussian, gaussians, sensor, turn, vector};
use super::spread::Spread;
use super::testing::Largest as _;

/// Loads of touches of a surface of unit size, their pitch wrong by so much.
fn touches(random: &mut Pcg64Mcg, count: usize, pitch: f64) -> DMatrix<f64> {
    let mut loads = DMatrix::zeros(count, 6);
    for i in 0..count {
        let (force, point) = (vector(random), vector(random));
        let torque = point.cross(&force);
        let torque = torque + force.normalize() * (torque.norm() * pitch * gaussian(random));
        loads.view_mut((i, 0), (1, 3)).copy_from(&force.transpose());
        loads.view_mut((i, 3), (1, 3)).copy_from(&torque.transpose());
    }
    loads
}

fn signals(loads: &DMatrix<f64>, loads_per_signal: &DMatrix<f64>) -> DMatrix<f64> {
    loads * loads_per_signal.clone().try_inverse().unwrap().transpose()
}

fn gathered(signals: &DMatrix<f64>) -> PointContactForm {
    let mut form = PointContactForm::new(6);
    for row in signals.row_iter() {
        assert!(form.push(row.transpose().as_slice()));
    }
    form
}

/// Gauges of equal gain, so that the noise shows alike in all touches, as the statement has it.
#[test]
fn error_of_the_form_is_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(51);
    let mut truth = DMatrix::identity(6, 6);
    for k in [0, 3] {
        truth.view_mut((k, k), (3, 3)).copy_from(&turn(random));
    }
    let (form, clean) = (form_of(&truth), signals(&touches(random, 300, 0.0), &truth));
    let spread = Spread::over(600, || {
        let mut noisy = clean.clone();
        for mut row in noisy.row_iter_mut() {
            let noise = 1e-3 * row.norm();
            row += gaussians(random, 1, 6) * noise;
        }
        let found = gathered(&noisy).solve().unwrap();
        (vec![angle_between(&found.matrix, &form)], vec![found.deviation.powi(2)])
    });
    spread.agrees("form of point contacts");
}

#[test]
fn errors_of_a_mended_sensor_are_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(52);
    let truth = sensor(random, 6, 6);
    let known = gaussians(random, 6, 6);
    let loads = &known * truth.transpose();
    let (pitch, noise) = (1e-3, 1e-3);
    let mut places = Pcg64Mcg::seed_from_u64(53);
    let spread = Spread::over(780, || {
        places.clone_from(&Pcg64Mcg::seed_from_u64(53));
        // The same touches each time, but for their pitch.
        let mut touches = touches(&mut places, 40, 0.0);
        for mut row in touches.row_iter_mut() {
            let (force, torque) = (row.columns(0, 3).normalize(), row.columns(3, 3).norm());
            let mut part = row.columns_mut(3, 3);
            part += force * (torque * pitch * gaussian(random));
        }
        let measured = &loads + gaussians(random, 6, 6) * noise;
        let fit = refine(&truth, &signals(&touches, &truth), pitch, &known, &measured, noise).unwrap();
        assert_eq!(fit.unobserved, 0);
        let errors = &fit.loads_per_signal - &truth;
        (errors.as_slice().to_vec(), fit.deviations.iter().map(|s| s * s).collect())
    });
    spread.agrees_in_the_mean("mended sensor");
}

/// Gauges in other units and mixed among each other, touches in another order, the sensor frame turned.
#[test]
fn touches_do_not_mind_units_order_and_frames() {
    let random = &mut Pcg64Mcg::seed_from_u64(54);
    for _ in 0..10 {
        let truth = sensor(random, 6, 6);
        let order: Vec<usize> = (0..60).map(|i| (7 * i + 3) % 60).collect();
        let signals = signals(&touches(random, 60, 1e-3), &truth);
        let mut mix = DMatrix::identity(6, 6);
        for k in 0..4 {
            let mut part = DMatrix::identity(6, 6);
            part.view_mut((k, k), (3, 3)).copy_from(&turn(random));
            mix *= part;
        }
        let form = gathered(&signals).solve().unwrap();
        let mixed = &signals.select_rows(&order) * &mix * 1e-4;
        let other = gathered(&mixed).solve().unwrap();
        let angle = angle_between(&(&mix * &other.matrix * mix.transpose()), &form.matrix);
        // Rounding over the gap of the singular values.
        assert!(angle < 1e3 * f64::EPSILON / form.deviation, "{angle:e}");
        assert!((other.deviation / form.deviation - 1.0).abs() < 1e-6 && other.signature == form.signature);

        // A calibration of it that has drifted, with five known loads.
        let drifted = &truth + gaussians(random, 6, 6) * 0.01;
        let known = gaussians(random, 5, 6);
        let loads = &known * truth.transpose() + gaussians(random, 5, 6) * 1e-3;
        let mut frame = DMatrix::zeros(6, 6);
        let rotation = turn(random);
        for k in [0, 3] {
            frame.view_mut((k, k), (3, 3)).copy_from(&rotation);
        }
        let one = refine(&drifted, &signals, 1e-3, &known, &loads, 1e-3).unwrap();
        let start = &frame * &drifted * &mix * 1e4;
        let turned = &loads * frame.transpose();
        let two = refine(&start, &mixed, 1e-3, &(&known * &mix * 1e-4), &turned, 1e-3).unwrap();
        let back = frame.transpose() * &two.loads_per_signal * mix.transpose() * 1e-4;
        // It ends where the sum of squares does not fall by 1e-12 of itself any more.
        let change = (back - &one.loads_per_signal).component_div(&one.deviations).largest();
        assert!(change < 1e-3, "{change:e}");
        assert!((two.pitch.1 / one.pitch.1 - 1.0).abs() < 1e-5);
        assert_eq!((one.unobserved, two.unobserved), (0, 0));
        let (a, b) = (one.deviations.norm(), two.deviations.norm() * 1e-4);
        // Entries mix with the gauges; the sum of their variances does not.
        assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    }
    assert!(gathered(&DMatrix::zeros(0, 6)).solve().is_err());
}

#[test]
fn what_nothing_asks_for_is_not_changed() {
    let start = DMatrix::from_fn(6, 6, |i, j| if i == j { 2.0 } else { 0.1 * (i + 2 * j) as f64 });
    let none = DMatrix::zeros(0, 6);
    let same = refine(&start, &none, 1e-2, &none, &none, 1e-2).unwrap();
    assert_eq!((same.unobserved, &same.loads_per_signal), (36, &start));
    assert_eq!((same.deviations, same.pitch), (DMatrix::zeros(6, 6), (0.0, 0.0)));
}

/// What is not observed is as uncertain as before; what is, by the touches and loads alone.
#[test]
fn the_covariance_after_is_of_both() {
    let random = &mut Pcg64Mcg::seed_from_u64(58);
    for gauges in [6, 8] {
        let matrix = sensor(random, 6, gauges).transpose();
        let root = gaussians(random, gauges, gauges);
        let loads = gaussians(random, 9, 6);
        let before = Covariance::product(&root * root.transpose(), loads.transpose() * &loads);
        let start = (matrix.transpose() * &matrix).try_inverse().unwrap() * matrix.transpose();
        let none = DMatrix::zeros(0, gauges);
        let same = refine(&start, &none, 1e-2, &none, &DMatrix::zeros(0, 6), 1e-2).unwrap();
        let after = same.covariance_after(&matrix, &before).unwrap();
        assert_eq!(after.signals, before.signals);
        if gauges == 6 {
            assert!((after.all() - before.all()).largest() < 1e-9 * before.all().largest());
        }
        // What it does to a load is the same of any number of gauges.
        let (load, signals) = (gaussians(random, 6, 1).column(0).into_owned(), &start);
        let of_load = |of: &Covariance| signals * of.of_signals(&load) * signals.transpose();
        let (found, expected) = (of_load(&after), of_load(&before));
        assert!((found - &expected).largest() < 1e-9 * expected.largest(), "{gauges}");
        assert_eq!(same.covariance_after(&matrix.transpose(), &before).is_none(), gauges != 6);
    }
    // Six known loads observe all of it: of each row of the map (VᵀV)⁻¹σ².
    let truth = sensor(random, 6, 6);
    let known = gaussians(random, 9, 6);
    let fit =
        refine(&truth, &DMatrix::zeros(0, 6), 1e-3, &known, &(&known * truth.transpose()), 1e-3).unwrap();
    let spread = (known.transpose() * &known).try_inverse().unwrap() * 1e-6;
    assert_eq!((fit.unobserved, fit.kept.ncols()), (0, 0));
    let expected = DMatrix::identity(6, 6).kronecker(&spread);
    assert!((&fit.covariance - &expected).largest() < 1e-9 * expected.largest());
    let matrix = truth.clone().try_inverse().unwrap();
    let vague = Covariance::product(DMatrix::identity(6, 6), DMatrix::identity(6, 6));
    let after = fit.covariance_after(&matrix, &vague).unwrap();
    // C δB C of a load x, with δB of rows alike: C Cᵀ · (C x)ᵀ spread (C x).
    let load = gaussians(random, 6, 1).column(0).into_owned();
    let reading = &matrix * &load;
    let expected = &matrix * matrix.transpose() * reading.dot(&(&spread * &reading));
    assert!((after.of_signals(&load) - &expected).largest() < 1e-9 * expected.largest());
}

/// What is to vanish, by the statement of `refine`: `Σ (fᵀm / (|f||m|) / σ)² + Σ |B V − P|² / σ²`, with the sizes
/// of the start.
fn target(
    start: &DMatrix<f64>,
    map: &DMatrix<f64>,
    touches: &DMatrix<f64>,
    known: &DMatrix<f64>,
    loads: &DMatrix<f64>,
) -> f64 {
    let of_touches: f64 = touches
        .row_iter()
        .map(|row| {
            let (first, now) = (start * row.transpose(), map * row.transpose());
            let size = first.rows(0, 3).norm() * first.rows(3, 3).norm();
            (now.rows(0, 3).dot(&now.rows(3, 3)) / size / 1e-3).powi(2)
        })
        .sum();
    of_touches + (known * map.transpose() - loads).norm_squared() / 1e-6
}

/// From calibrations that are far off, where a whole step of Gauss and Newton goes too far: no change near by
/// makes it better still.
#[test]
fn far_off_calibrations_are_mended_as_well_as_can_be() {
    let random = &mut Pcg64Mcg::seed_from_u64(56);
    for round in 0..24 {
        let truth = sensor(random, 6, 6);
        let (wrong, count) = ([0.5, 2.0, 10.0][round / 8], [5, 4, 3][round % 3]);
        let start = &truth + gaussians(random, 6, 6) * wrong;
        let signals = signals(&touches(random, 60, 1e-3), &truth);
        let known = gaussians(random, count, 6);
        let loads = &known * truth.transpose() + gaussians(random, count, 6) * 1e-3;
        let found = refine(&start, &signals, 1e-3, &known, &loads, 1e-3).unwrap();
        let cost = |map: &DMatrix<f64>| target(&start, map, &signals, &known, &loads);
        let (before, least) = (cost(&start), cost(&found.loads_per_signal));
        // There are a thousandth of noise and sixty touches.
        assert!(least < 1e3 && before > 1e6, "{round}: {before:e} {least:e}");
        for k in 0..36 {
            // A hundredth of a deviation is worth 1e-4 where it is least.
            let mut change = DMatrix::zeros(6, 6);
            change[k] = 0.01 * found.deviations[k];
            for map in [&found.loads_per_signal + &change, &found.loads_per_signal - &change] {
                assert!(
                    cost(&map) > least - 1e-5 * (1.0 + least * 1e-6),
                    "{round} {k}: {:e}",
                    cost(&map) - least
                );
            }
        }
    }
}

/// Two known loads tell of two directions of the readings, in whatever units these are.
#[test]
fn what_is_not_observed_is_counted_in_any_units() {
    let random = &mut Pcg64Mcg::seed_from_u64(55);
    let truth = sensor(random, 6, 6);
    let drifted = &truth + gaussians(random, 6, 6) * 0.05;
    let (none, known) = (DMatrix::zeros(0, 6), gaussians(random, 2, 6));
    let loads = &known * truth.transpose();
    let plain = refine(&drifted, &none, 1e-3, &known, &loads, 1e-3).unwrap();
    assert_eq!(plain.unobserved, 24);
    assert!((&known * plain.loads_per_signal.transpose() - &loads).largest() < 1e-12);
    for unit in [1e-9, 1e-5, 1e5, 1e9] {
        let other = refine(&(&drifted / unit), &none, 1e-3, &(&known * unit), &loads, 1e-3).unwrap();
        assert_eq!(other.unobserved, 24, "{unit:e}");
        let change = (&other.loads_per_signal * unit - &plain.loads_per_signal).largest();
        assert!(change < 1e-12, "{unit:e}: {change:e}");
        let change = (&other.deviations * unit - &plain.deviations).largest();
        assert!(change < 1e-12, "{unit:e}: {change:e}");
    }
    // Of a known load in one direction only: its size over that of the reading.
    let lone = DMatrix::from_fn(1, 6, |_, j| if j == 2 { 0.25 } else { 0.0 });
    let one = refine(&drifted, &none, 1e-3, &lone, &(&lone * truth.transpose()), 1e-3).unwrap();
    let expected = DMatrix::from_fn(6, 6, |_, j| if j == 2 { 1e-3 / 0.25 } else { 0.0 });
    assert!((one.deviations - expected).largest() < 1e-15 && one.unobserved == 30);
}

/// How well one form stands out: the least singular value of the products of the signals over the next.
#[test]
fn the_ambiguity_is_that_of_the_products_of_signals() {
    let random = &mut Pcg64Mcg::seed_from_u64(57);
    for (count, pitch) in [(30, 1e-2), (60, 0.1), (200, 1.0)] {
        let signals = signals(&touches(random, count, pitch), &sensor(random, 6, 6));
        let pairs: Vec<(usize, usize)> = (0..6).flat_map(|i| (i..6).map(move |j| (i, j))).collect();
        let products = DMatrix::from_fn(count, pairs.len(), |row, k| {
            let (i, j) = pairs[k];
            let twice = if i == j { 1.0 } else { core::f64::consts::SQRT_2 };
            twice * signals[(row, i)] * signals[(row, j)] / signals.row(row).norm_squared()
        });
        let mut squares: Vec<f64> =
            (products.transpose() * products).symmetric_eigenvalues().iter().copied().collect();
        squares.sort_by(f64::total_cmp);
        let expected = (squares[0] / squares[1]).sqrt();
        let found = gathered(&signals).solve().unwrap();
        assert!((found.ambiguity / expected - 1.0).abs() < 1e-6, "{} {expected}", found.ambiguity);
        assert_eq!(found.contacts, count as u64);
    }
}
