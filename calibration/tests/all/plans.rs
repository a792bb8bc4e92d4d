//! Plans of loads, against a choice by determinants in full.

use fingertip_calibration::experiment::{Information, plan_after};
use fingertip_calibration::fit::FitError;
use fingertip_calibration::nalgebra::DMatrix;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::gaussians;

/// Regressors as rows: loads, and the constant.
fn with_constant(loads: &DMatrix<f64>, bias: bool) -> DMatrix<f64> {
    if bias { loads.clone().insert_column(loads.ncols(), 1.0) } else { loads.clone() }
}

/// Each load is the one that makes the determinant greatest; after each, the deviation at the worst candidate is that
/// of the inverse, as soon as the loads determine the sensor; it ends where that is small enough.
#[test]
fn each_load_of_a_plan_is_the_best_of_all() {
    let random = &mut Pcg64Mcg::seed_from_u64(221);
    let one = gaussians(random, 1, 3);
    let same = DMatrix::from_fn(5, 3, |_, j| one[(0, j)]);
    for round in 0..12 {
        let (bias, accuracy) = (round % 2 == 0, [0.7, 0.45][round % 4 / 2]);
        let done = match round % 3 {
            0 => DMatrix::zeros(0, 3),
            1 => gaussians(random, 2, 3),
            // Five loads that are one.
            _ => same.clone(),
        };
        let candidates = gaussians(random, 9, 3);
        let found = plan_after(&done, &candidates, bias, accuracy, 100).unwrap();
        let (rows, before) = (with_constant(&candidates, bias), with_constant(&done, bias));
        let mut applied: Vec<_> = before.row_iter().map(|row| row.into_owned()).collect();
        let size = rows.ncols();
        let mut gram = DMatrix::identity(size, size) * 1e-6 + before.transpose() * &before;
        for (step, candidate) in found.order.iter().enumerate() {
            let with = |i: usize| (&gram + rows.row(i).transpose() * rows.row(i)).determinant();
            assert!((0..9).all(|i| with(i) <= with(*candidate) * (1.0 + 1e-9)), "{round} {step}");
            gram += rows.row(*candidate).transpose() * rows.row(*candidate);
            applied.push(rows.row(*candidate).into_owned());
            let inverse = gram.clone().try_inverse().unwrap();
            let variance = |i: usize| (rows.row(i) * &inverse * rows.row(i).transpose())[(0, 0)];
            let worst = (0..9).map(variance).fold(0.0, f64::max).sqrt();
            let determined = DMatrix::from_rows(&applied).rank(1e-6) == size;
            let deviation = found.deviation[step];
            if determined {
                assert!((deviation / worst - 1.0).abs() < 1e-6, "{round} {step}: {deviation} {worst}");
            } else {
                assert!(deviation.is_infinite(), "{round} {step}: {deviation}");
            }
            assert_eq!(deviation <= accuracy, step + 1 == found.order.len(), "{round} {step}");
        }
        assert_eq!(found.order.len(), found.deviation.len());
        // As many are enough, and one less is not.
        let count = found.order.len();
        assert_eq!(plan_after(&done, &candidates, bias, accuracy, count).unwrap(), found);
        let short = FitError::TooFewSamples { samples: count - 1, coefficients: size };
        assert_eq!(plan_after(&done, &candidates, bias, accuracy, count - 1).unwrap_err(), short);
    }
}

#[test]
fn bad_plans_are_refused() {
    let (none, candidates) = (DMatrix::zeros(0, 2), DMatrix::identity(2, 2));
    let refused = |done: &DMatrix<f64>, candidates: &DMatrix<f64>, accuracy: f64| {
        matches!(plan_after(done, candidates, false, accuracy, 50), Err(FitError::BadInput { .. }))
    };
    assert!(!refused(&none, &candidates, 0.5) && !refused(&candidates, &candidates, 0.5));
    for accuracy in [0.0, -1.0, f64::NAN] {
        assert!(refused(&none, &candidates, accuracy));
    }
    for bad in [f64::NAN, f64::INFINITY] {
        let mut spoilt = candidates.clone();
        spoilt[(1, 0)] = bad;
        assert!(refused(&none, &spoilt, 0.5) && refused(&spoilt, &candidates, 0.5));
    }
    assert!(refused(&none, &DMatrix::zeros(0, 2), 0.5) && refused(&DMatrix::zeros(0, 3), &candidates, 0.5));
    // Candidates that are no loads are not ranked, and have no variance.
    let mut information = Information::new(2, true);
    assert!(information.add(&[1.0, 0.0]) && !information.add(&[1.0, 0.0, 1.0]));
    assert_eq!((information.variance(&[1.0]), information.variance(&[f64::NAN, 0.0])), (None, None));
    let ranked = information.rank(&DMatrix::from_row_slice(3, 2, &[2.0, 0.0, f64::NAN, 1.0, 0.0, 3.0]));
    assert_eq!(ranked.iter().map(|gain| gain.candidate).collect::<Vec<_>>(), [2, 0]);
}
