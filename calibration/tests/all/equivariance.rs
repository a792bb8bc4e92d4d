//! Units of loads and signals, the order of samples and the frame change every fit only as they must.

use fingertip_calibration::fit::{
    Fit, FitError, Ransac, fit_temperature, gauss_helmert, huber, least_squares, ransac, ridge,
    total_least_squares,
};
use fingertip_calibration::nalgebra::{DMatrix, Rotation3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::random::{gaussian, gaussians, sensor, vector};
use super::testing::Largest as _;

const SAMPLES: usize = 40;

/// One problem: loads are in units of `load`, signals in units of `signal`, turned by `frame`.
struct Setting {
    loads: DMatrix<f64>,
    signals: DMatrix<f64>,
    load: f64,
    signal: f64,
    frame: DMatrix<f64>,
    order: Vec<usize>,
}

/// How a method fits a setting, how closely it must, and whether one reading is wrong.
type Method = (&'static str, f64, bool, fn(&Setting) -> Result<Fit, FitError>);

const METHODS: [Method; 6] = [
    ("least squares", 1e-11, false, |s| least_squares(&s.loads, &s.signals, Some(&s.weights()))),
    // The iteration stops at a relative change of 1e-10.
    ("Huber", 1e-7, true, |s| huber(&s.loads, &s.signals, None)),
    ("RANSAC", 1e-11, true, |s| ransac(&s.loads, &s.signals, None, &Ransac::new(vec![0.5 * s.signal; 6]))),
    ("total least squares", 1e-10, false, |s| {
        total_least_squares(&s.loads, &s.signals, &[0.02 * s.load; 6], &[0.1 * s.signal; 6], false)
    }),
    ("Gauss-Helmert", 1e-8, false, |s| {
        let errors = DMatrix::from_element(SAMPLES, 6, 0.02 * s.load);
        gauss_helmert(&s.loads, &s.signals, &errors, &DMatrix::from_element(SAMPLES, 6, 0.1 * s.signal))
    }),
    ("ridge", 1e-11, false, |s| {
        let prior = s.frame.transpose() * DMatrix::from_diagonal_element(6, 6, 2.0 * s.signal / s.load);
        let precision = DMatrix::from_diagonal_element(6, 6, 3.0 * s.load * s.load);
        ridge(&s.loads, &s.signals, None, &prior, &precision)
    }),
];

impl Setting {
    fn new(random: &mut Pcg64Mcg, wrong: bool) -> Self {
        let loads = gaussians(random, SAMPLES, 6);
        let mut signals = &loads * sensor(random, 6, 6) + gaussians(random, SAMPLES, 6) * 0.1;
        if wrong {
            signals[(7, 2)] += 30.0;
        }
        let frame = DMatrix::identity(6, 6);
        Self { loads, signals, load: 1.0, signal: 1.0, frame, order: (0..SAMPLES).collect() }
    }

    /// Weights belong to samples, wherever these stand.
    fn weights(&self) -> Vec<f64> {
        self.order.iter().map(|i| 1.0 + (i % 3) as f64).collect()
    }

    /// The same problem in other units, another order and another frame: forces and torques turned.
    fn changed(&self, random: &mut Pcg64Mcg) -> Self {
        let mut power = || 10_f64.powi(random.random_range(-6..6));
        let (load, signal) = (power(), power());
        let turn = Rotation3::from_scaled_axis(vector(random));
        let mut frame = DMatrix::zeros(6, 6);
        for i in 0..3 {
            for j in 0..3 {
                frame[(i, j)] = turn[(i, j)];
                frame[(3 + i, 3 + j)] = turn[(i, j)];
            }
        }
        let start = random.random_range(0..SAMPLES);
        let order: Vec<usize> = (0..SAMPLES).map(|i| (7 * i + start) % SAMPLES).collect();
        Self {
            loads: self.loads.select_rows(&order) * &frame * load,
            signals: self.signals.select_rows(&order) * signal,
            load,
            signal,
            frame,
            order,
        }
    }
}

#[test]
fn of_every_regression() {
    let random = &mut Pcg64Mcg::seed_from_u64(4);
    for _ in 0..40 {
        for (name, tolerance, wrong, method) in METHODS {
            let setting = Setting::new(random, wrong);
            let changed = setting.changed(random);
            let (one, other) = (method(&setting).unwrap(), method(&changed).unwrap());
            let back = &changed.frame * other.coefficients * (changed.load / changed.signal);
            let difference = (back - &one.coefficients).largest();
            assert!(difference < tolerance, "{name}: {difference:e}");
            let unit = changed.signal * changed.signal;
            let spread = (other.residual_covariance / unit - &one.residual_covariance).largest();
            assert!(spread < 10.0 * tolerance, "{name}: {spread:e}");
        }
    }
}

#[test]
fn of_the_temperature_terms() {
    let random = &mut Pcg64Mcg::seed_from_u64(5);
    for _ in 0..20 {
        let loads = gaussians(random, SAMPLES, 3);
        let celsius: Vec<f64> = (0..SAMPLES).map(|_| random.random_range(15.0..35.0)).collect();
        let matrix = sensor(random, 2, 3);
        let signals = DMatrix::from_fn(SAMPLES, 2, |i, j| {
            0.3 + 0.01 * celsius[i]
                + (1.0 + 1e-3 * (celsius[i] - 20.0)) * loads.row(i).dot(&matrix.row(j))
                + 0.01 * gaussian(random)
        });
        let fit = fit_temperature(&loads, &signals, None, &celsius, 20.0).unwrap();
        let frame = *Rotation3::from_scaled_axis(vector(random)).matrix();
        let frame = DMatrix::from_fn(3, 3, |i, j| frame[(i, j)]);
        let order: Vec<usize> = (0..SAMPLES).map(|i| (11 * i + 5) % SAMPLES).collect();
        let warm: Vec<f64> = order.iter().map(|i| celsius[*i]).collect();
        let turned = loads.select_rows(&order) * &frame * 1e3;
        let other =
            fit_temperature(&turned, &(signals.select_rows(&order) * 1e-4), None, &warm, 20.0).unwrap();
        assert!((other.matrix * frame.transpose() * 1e7 - &fit.matrix).largest() < 1e-10);
        for (a, b) in [
            (&other.temperature.zero_drift, &fit.temperature.zero_drift),
            (&other.temperature.zero_curvature, &fit.temperature.zero_curvature),
        ] {
            assert_eq!((a.len(), b.len()), (2, 2));
            assert!(a.iter().zip(b).all(|(a, b)| (1e4 * a - b).abs() < 1e-11));
        }
        assert_eq!(other.temperature.gain_drift.len(), 2);
        let gains = other.temperature.gain_drift.iter().zip(&fit.temperature.gain_drift);
        assert!(gains.into_iter().all(|(a, b)| (a - b).abs() < 1e-11));
    }
}
