//! Which samples robust fits believe: how many must agree, and where there is nothing to tell.

use fingertip_calibration::fit::{FitError, Ransac, huber, ransac};
use fingertip_calibration::loads::Names;
use fingertip_calibration::nalgebra::DMatrix;
use fingertip_calibration::report::outliers;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{gaussian, gaussians};
use super::testing::Largest as _;

/// Readings `2 x + 1` of loads from 0 on, of which the first are wrong by something of its own each.
fn line(samples: usize, wrong: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let design = DMatrix::from_fn(samples, 2, |i, j| if j == 0 { i as f64 } else { 1.0 });
    let readings = DMatrix::from_fn(samples, 1, |i, _| {
        2.0 * i as f64 + 1.0 + if i < wrong { 10.0 + (i * i) as f64 } else { 0.0 }
    });
    (design, readings)
}

#[test]
fn as_many_must_agree_as_are_said_to_be_good() {
    let options = Ransac { outliers: 0.2, ..Ransac::new(vec![1e-6]) };
    // 80 % of 21 are 16.8.
    for (wrong, answer) in [(4, None), (5, Some((16, 17))), (8, Some((13, 17)))] {
        let (design, readings) = line(21, wrong);
        let found = ransac(&design, &readings, None, &options);
        match answer {
            None => {
                let fit = found.unwrap();
                let expected = DMatrix::from_column_slice(2, 1, &[2.0, 1.0]);
                assert!((fit.coefficients - expected).largest() < 1e-9);
                assert!((0..21).all(|i| fit.trust[(i, 0)] == if i < wrong { 0.0 } else { 1.0 }));
            }
            Some((agreeing, needed)) => {
                assert_eq!(found.unwrap_err(), FitError::NoConsensus { agreeing, samples: 21, needed });
            }
        }
    }
    // A residual at the threshold agrees.
    let design = DMatrix::from_element(9, 1, 1.0);
    let readings = DMatrix::from_column_slice(9, 1, &[0.0, 0.0, 0.0, 0.0, 0.5, -0.5, 0.5, -0.5, 1.0]);
    let fit = ransac(&design, &readings, None, &Ransac { outliers: 0.4, ..Ransac::new(vec![0.5]) }).unwrap();
    assert!((0..9).all(|i| fit.trust[(i, 0)] == if i < 8 { 1.0 } else { 0.0 }));
    for bad in [0.0, -1.0, f64::NAN] {
        let refused = ransac(&design, &readings, None, &Ransac::new(vec![bad]));
        assert_eq!(refused.unwrap_err(), FitError::BadInput { what: "the list of thresholds" });
    }
    let refused = ransac(&design, &readings, None, &Ransac::new(vec![0.5; 2]));
    assert_eq!(refused.unwrap_err(), FitError::BadInput { what: "the list of thresholds" });
    let one = ransac(&design.rows(0, 1).into(), &readings.rows(0, 1).into(), None, &Ransac::new(vec![0.5]));
    assert_eq!(one.unwrap_err(), FitError::TooFewSamples { samples: 1, coefficients: 1 });
}

/// The set that agrees with any one reading is smaller than that which agrees with the mean of such a set.
#[test]
fn the_set_that_agrees_is_settled_by_fitting_to_it() {
    // Within 1 of 0.3 are the first ten; of the others' values, nine at most. The mean of the ten is 0.39, within 1 of
    // which are those at 1.35 too. That of all twelve is 0.54, which would lose those at −0.6.
    let values = [&[-0.6; 3][..], &[0.3; 1], &[0.9; 6], &[1.35; 2], &[50.0, -50.0]].concat();
    let design = DMatrix::from_element(14, 1, 1.0);
    let readings = DMatrix::from_column_slice(14, 1, &values);
    for seed in 0..5 {
        let options = Ransac { outliers: 0.4, confidence: 0.999_999, seed, ..Ransac::new(vec![1.0]) };
        // As many draws as it takes to meet the 0.3.
        let options = Ransac { outliers: 0.9, ..options };
        let fit = ransac(&design, &readings, None, &options).unwrap();
        assert!((0..14).all(|i| fit.trust[(i, 0)] == if i < 12 { 1.0 } else { 0.0 }), "{}", fit.trust);
        assert!((fit.coefficients[(0, 0)] - 6.6 / 12.0).abs() < 1e-12);
    }
}

/// Loads along one axis after another: six drawn blindly are hardly ever one of each.
#[test]
fn draws_are_of_loads_that_determine_the_sensor() {
    let random = &mut Pcg64Mcg::seed_from_u64(101);
    let design = DMatrix::from_fn(30, 6, |i, j| if i % 6 == j { 1.0 + (i / 6) as f64 } else { 0.0 });
    let truth = gaussians(random, 6, 2);
    let mut readings = &design * &truth;
    [2, 9, 22].into_iter().for_each(|i| readings[(i, i % 2)] += 5.0);
    for seed in 0..10 {
        let options = Ransac { seed, ..Ransac::new(vec![1e-6; 2]) };
        let fit = ransac(&design, &readings, None, &options).unwrap();
        assert!((&fit.coefficients - &truth).largest() < 1e-12);
        assert_eq!((0..30).filter(|i| fit.trust[(*i, 0)] == 0.0).collect::<Vec<_>>(), [2, 9, 22]);
    }
}

/// A recording of thousands of loads along one axis after another: each is a small part of all.
#[test]
fn long_tables_are_no_trouble() {
    let random = &mut Pcg64Mcg::seed_from_u64(98);
    let design = DMatrix::from_fn(3000, 2, |i, j| if i % 2 == j { 1.0 + (i % 7) as f64 } else { 0.0 });
    let truth = DMatrix::from_row_slice(2, 2, &[2.0, 0.1, -0.2, 1.0]);
    let mut readings = &design * &truth + gaussians(random, 3000, 2) * 0.01;
    (0..300).for_each(|i| readings[(10 * i, i % 2)] += 5.0);
    let options = Ransac { outliers: 0.15, ..Ransac::new(vec![0.06; 2]) };
    let fit = ransac(&design, &readings, None, &options).unwrap();
    assert!((fit.coefficients - truth).largest() < 1e-3);
    assert_eq!((0..3000).filter(|i| fit.trust[(*i, 0)] == 0.0).count(), 300);
}

#[test]
fn the_number_of_draws_has_bounds() {
    let draws = |outliers: f64, confidence: f64, size| {
        Ransac { outliers, confidence, ..Ransac::new(Vec::new()) }.draws(size)
    };
    // Half of them bad: a draw of 1 is good every other time.
    assert_eq!([0.5, 0.75, 0.9].map(|confidence| draws(0.5, confidence, 1)), [1, 2, 4]);
    assert_eq!((draws(0.0, 0.999, 6), draws(0.5, 0.0, 6)), (1, 1));
    assert_eq!((draws(0.99, 0.999, 40), draws(0.5, 1.0, 1)), (100_000, 40));
}

/// A gauge that always reads zero beside others.
#[test]
fn a_dead_gauge_is_no_trouble() {
    let random = &mut Pcg64Mcg::seed_from_u64(99);
    let design = gaussians(random, 30, 2);
    let mut readings = &design * DMatrix::from_element(2, 2, 1.5) + gaussians(random, 30, 2) * 0.01;
    readings.column_mut(1).fill(0.0);
    readings[(4, 0)] += 1.0;
    let fit = huber(&design, &readings, None).unwrap();
    assert_eq!(fit.coefficients.column(1), DMatrix::zeros(2, 1).column(0));
    assert!(fit.trust.column(1).iter().all(|trust| *trust == 1.0));
    assert!((fit.coefficients.column(0) - DMatrix::from_element(2, 1, 1.5).column(0)).largest() < 0.01);
    assert!(fit.trust[(4, 0)] < 0.1);
    let found = outliers(&design, &readings, None, &Names::default(), &[]);
    assert_eq!(found.iter().map(|outlier| outlier.index).collect::<Vec<_>>(), [4]);
    assert_eq!((found[0].sample.as_str(), found[0].response.as_str()), ("sample 5", "response 0"));
}

/// Loads of which one is in other units: the same samples are believed.
#[test]
fn consensus_does_not_mind_units() {
    let random = &mut Pcg64Mcg::seed_from_u64(97);
    let design = gaussians(random, 40, 3);
    let mut readings = &design * gaussians(random, 3, 2) + gaussians(random, 40, 2) * 0.01;
    (0..6).for_each(|i| readings[(5 * i + 2, i % 2)] += 3.0);
    let options = Ransac { outliers: 0.2, ..Ransac::new(vec![0.05; 2]) };
    let one = ransac(&design, &readings, None, &options).unwrap();
    assert!((0..40).all(|i| (one.trust[(i, 0)] == 0.0) == (i % 5 == 2 && i < 30)));
    for unit in [1e-6, 1e6] {
        let mut scaled = design.clone();
        scaled.column_mut(1).scale_mut(unit);
        let mut other = ransac(&scaled, &readings, None, &options).unwrap();
        other.coefficients.row_mut(1).scale_mut(unit);
        assert!((other.coefficients - &one.coefficients).largest() < 1e-12);
        assert_eq!(other.trust, one.trust);
    }
}

/// A weight is as many samples: the same outliers as of rows and readings times its root.
#[test]
fn weights_of_outliers_are_those_of_scaled_rows() {
    let random = &mut Pcg64Mcg::seed_from_u64(96);
    let design = gaussians(random, 40, 3);
    let mut readings = &design * gaussians(random, 3, 2) + gaussians(random, 40, 2) * 0.01;
    [(4, 0), (11, 1), (30, 0)].into_iter().for_each(|place| readings[place] += 0.3);
    let weights: Vec<f64> = (0..40).map(|_| (0.5 * gaussian(random)).exp()).collect();
    let scaled = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(40, matrix.ncols(), |i, j| matrix[(i, j)] * weights[i].sqrt())
    };
    let weighted = outliers(&design, &readings, Some(&weights), &Names::default(), &[]);
    let plain = outliers(&scaled(&design), &scaled(&readings), None, &Names::default(), &[]);
    assert_eq!((weighted.len(), plain.len()), (3, 3));
    for (one, other) in weighted.iter().zip(&plain) {
        assert_eq!((one.index, &one.response), (other.index, &other.response));
        assert!((one.deviations / other.deviations - 1.0).abs() < 1e-9);
    }
    // One that counts for nothing is none.
    let without: Vec<f64> = (0..40).map(|i| if i == 11 { 0.0 } else { weights[i] }).collect();
    let found = outliers(&design, &readings, Some(&without), &Names::default(), &[]);
    assert!(found.len() == 2 && found.iter().all(|outlier| outlier.index != 11));
}
