//! Weight and other contacts: consistency of what is stated, by many trials.

use fingertip_hand::{ObjectWeight, OtherContact, UncertainWrench};
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix6, Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::{TestHand, narrow, vector};

fn normal(rng: &mut Pcg64Mcg) -> f64 {
    let (a, b): (f64, f64) = (rng.random_range(1e-300..1.0), rng.random_range(0.0..1.0));
    (-2.0 * a.ln()).sqrt() * (core::f64::consts::TAU * b).cos()
}

/// Errors over stated deviations: their squares must average to one, and those of the statistic to six.
fn trials(count: u32) {
    let mut rng = Pcg64Mcg::seed_from_u64(21);
    let (mut of_mass, mut of_alone, mut of_centre, mut of_statistic, mut alarms) = (0.0, 0.0, 0.0, 0.0, 0);
    for _ in 0..count {
        let (mass, centre) = (rng.random_range(0.02..0.4), vector(&mut rng) * 0.03);
        let root = Matrix6::from_fn(|i, j| {
            let size = if i < 3 { 0.02 } else { 2e-4 };
            size * (if i == j { 1.0 } else { 0.0 } + 0.4 * rng.random_range(-1.0..1.0))
        });
        let noise = root * root.transpose();
        let mut weight = ObjectWeight::<f64>::new();
        let feel = |rng: &mut Pcg64Mcg, gravity: &Vector3<f64>| {
            let error = root * Vector6::from_fn(|_, _| normal(rng));
            let wrench = Wrench::<f64, TestHand>::from_force_at(&centre, gravity * mass)
                + Wrench::from_components(&error);
            UncertainWrench { wrench, covariance: noise }
        };
        for _ in 0..30 {
            let gravity = (Vector3::new(0.0, 0.0, -1.0) + vector(&mut rng) * 0.7).normalize() * 9.81;
            assert!(weight.observe(&feel(&mut rng, &gravity), &gravity));
        }
        let found = weight.estimate().unwrap();
        of_mass += ((found.mass - mass) / found.mass_deviation).powi(2);
        let (alone, deviation) = weight.mass().unwrap();
        assert!((alone - found.mass).abs() < 1e-9 && (deviation / found.mass_deviation - 1.0).abs() < 1e-9);
        of_alone += ((alone - mass) / deviation).powi(2);
        let off = found.centre - centre;
        of_centre += off.dot(&found.centre_covariance.cholesky().unwrap().solve(&off));
        let gravity = vector(&mut rng).normalize() * 9.81;
        let other = OtherContact::new(&feel(&mut rng, &gravity), &weight, &gravity).unwrap();
        of_statistic += other.statistic;
        alarms += u32::from(other.touches(0.05));
    }
    let n = f64::from(count);
    println!("{} {} {} {}", of_mass / n, of_centre / n, of_statistic / n, f64::from(alarms) / n);
    // Four deviations of the mean of a χ².
    let within =
        |mean: f64, degrees: f64| (mean - degrees).abs() < 4.0 * (2.0 * degrees / n).sqrt() + 0.02 * degrees;
    assert!(within(of_mass / n, 1.0) && within(of_alone / n, 1.0));
    assert!(within(of_centre / n, 3.0) && within(of_statistic / n, 6.0));
    assert!((f64::from(alarms) / n - 0.05).abs() < 4.0 * (0.05 * 0.95 / n).sqrt());
}

#[test]
fn stated_deviations_are_honest() {
    trials(2_000);
}

/// From one orientation the mass is known and the centre along gravity is not, and it is said so.
#[test]
fn one_orientation_tells_the_mass_alone() {
    let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
    for gravity in [Vector3::new(0.0, 0.0, -9.81), Vector3::new(3.0, -5.0, -7.0)] {
        let mut weight = ObjectWeight::<f64>::new();
        let wrench = Wrench::<f64, TestHand>::from_force_at(&Vector3::new(0.01, 0.02, 0.03), gravity * 0.2);
        for _ in 0..100 {
            weight.observe(&UncertainWrench { wrench, covariance: noise }, &gravity);
        }
        let (mass, deviation) = weight.mass().unwrap();
        assert!((mass - 0.2).abs() < 1e-9 && deviation < 2e-4, "{mass} {deviation}");
        if let Some(found) = weight.estimate() {
            let along = gravity.normalize();
            assert!(along.dot(&(found.centre_covariance * along)) > 1.0, "more than a metre");
        }
    }
}

fn refuses<T: Real>() {
    let one = Matrix6::<T>::identity();
    let load = |x: f64, covariance| UncertainWrench {
        wrench: Wrench::<T, TestHand>::on_fingertip(Vector3::z() * T::literal(x), Vector3::zeros()),
        covariance,
    };
    let down: Vector3<T> = narrow(Vector3::new(0.0, 0.0, -9.81));
    let mut weight = ObjectWeight::<T>::new();
    assert!(weight.mass().is_none() && weight.estimate().is_none());
    assert!(OtherContact::new(&load(1.0, one), &weight, &down).is_none());
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(!weight.observe(&load(bad, one), &down));
        assert!(!weight.observe(&load(1.0, one * T::literal(bad)), &down));
        assert!(!weight.observe(&load(1.0, one), &(down * T::literal(bad))));
    }
    assert!(!weight.observe(&load(1.0, Matrix6::zeros()), &down));
    assert!(!weight.observe(&load(1.0, -one), &down));
    assert_eq!(weight, ObjectWeight::new());
    // Without gravity nothing is learnt of the mass.
    assert!(weight.observe(&load(1.0, one), &Vector3::zeros()));
    assert!(weight.mass().is_none());
    assert!(weight.observe(&load(-1.0, one), &down));
    assert!(weight.mass().is_some());
}

#[test]
fn what_tells_nothing_is_refused() {
    refuses::<f64>();
    refuses::<f32>();
}
