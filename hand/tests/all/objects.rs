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
    // Two components that tell the same but for rounding, in any unit.
    for unit in [2_f64.powi(-50), 1.0, 2_f64.powi(50)] {
        for (more, tells) in [(T::EPSILON * T::literal(0.9), false), (T::EPSILON * T::literal(64.0), true)] {
            let mut alike = one;
            (alike[(4, 5)], alike[(5, 4)], alike[(5, 5)]) = (T::one(), T::one(), T::one() + more);
            let mut other = ObjectWeight::<T>::new();
            assert_eq!(other.observe(&load(1.0, alike * T::literal(unit)), &down), tells, "{unit}");
        }
    }
    assert_eq!(weight, ObjectWeight::new());
    // So little gravity that the deviation leaves the range, though the mass does not.
    let mut weightless = weight;
    let little = down * (T::LEAST_NORMAL * T::literal(0.01));
    assert!(weightless.observe(&load(0.0, one), &little));
    assert!(weightless.mass().is_none());
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

/// Two orientations tell a mass that is none: what pulls up is no weight.
#[test]
fn what_pulls_up_has_no_centre() {
    let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
    let centre = Vector3::new(0.01, -0.02, 0.03);
    for mass in [0.2, -0.2] {
        let mut weight = ObjectWeight::<f64>::default();
        for gravity in [Vector3::new(0.0, 0.0, -9.81), Vector3::new(-9.81, 0.0, 0.0)] {
            let wrench = Wrench::<f64, TestHand>::from_force_at(&centre, gravity * mass);
            assert!(weight.observe(&UncertainWrench { wrench, covariance: noise }, &gravity));
        }
        assert!((weight.mass().unwrap().0 - mass).abs() < 1e-12);
        match weight.estimate() {
            Some(found) => assert!(mass > 0.0 && (found.centre - centre).norm() < 1e-12),
            None => assert!(mass < 0.0),
        }
    }
}

/// The load of the weight alone, and its covariance, against what the samples leave uncertain: by differences of what is
/// learnt, as each component of each sample changes.
#[test]
fn the_load_of_the_weight_has_the_covariance_of_its_samples() {
    let mut rng = Pcg64Mcg::seed_from_u64(22);
    let root = Matrix6::from_fn(|i, j| {
        (if i < 3 { 0.02 } else { 4e-4 }) * (f64::from(i == j) + 0.2 * rng.random_range(-1.0..1.0))
    });
    let noise = root * root.transpose();
    let (centre, mass) = (Vector3::new(0.01, -0.02, 0.03), 0.3);
    let downs = [Vector3::new(0.0, 0.0, -9.8), Vector3::new(-6.0, 3.0, -7.0), Vector3::new(1.0, -9.0, 2.0)];
    let now = Vector3::new(4.0, 5.0, -7.0);
    let learn = |errors: [Vector6<f64>; 3]| {
        let mut weight = ObjectWeight::<f64>::new();
        for (down, error) in downs.iter().zip(errors) {
            let wrench = Wrench::<f64, TestHand>::from_force_at(&centre, down * mass)
                + Wrench::from_components(&error);
            assert!(weight.observe(&UncertainWrench { wrench, covariance: noise }, down));
        }
        weight
    };
    let exact = learn([Vector6::zeros(); 3]);
    let load = exact.load::<TestHand>(&now).unwrap();
    let expected = Wrench::<f64, TestHand>::from_force_at(&centre, now * mass);
    assert!((load.wrench - expected).components().amax() < 1e-12);
    let estimate = exact.estimate().unwrap();
    let (mut covariance, mut of_centre, mut of_mass) = (Matrix6::zeros(), nalgebra::Matrix3::zeros(), 0.0);
    for sample in 0..3 {
        for column in root.column_iter() {
            let mut errors = [Vector6::zeros(); 3];
            errors[sample] = column * 1e-4;
            let moved = learn(errors);
            let slope = (moved.load::<TestHand>(&now).unwrap().wrench - load.wrench).components() / 1e-4;
            covariance += slope * slope.transpose();
            let other = moved.estimate().unwrap();
            let slope = (other.centre - estimate.centre) / 1e-4;
            of_centre += slope * slope.transpose();
            of_mass += ((other.mass - estimate.mass) / 1e-4).powi(2);
        }
    }
    assert!((covariance - load.covariance).amax() < 1e-6 * covariance.amax());
    assert!((of_centre - estimate.centre_covariance).amax() < 1e-3 * of_centre.amax());
    assert!((of_mass.sqrt() / estimate.mass_deviation - 1.0).abs() < 1e-6);
}

/// Against the quantiles of χ² with six degrees of freedom in any table, at both sides of each.
#[test]
fn alarms_are_at_the_quantiles() {
    let one = Matrix6::identity();
    let mut weight = ObjectWeight::<f64>::new();
    let down = Vector3::new(0.0, 0.0, -9.81);
    let load = |force: Vector3<f64>, covariance| UncertainWrench {
        wrench: Wrench::<f64, TestHand>::on_fingertip(force, Vector3::zeros()),
        covariance,
    };
    for down in [down, Vector3::new(-9.81, 0.0, 0.0)] {
        assert!(weight.observe(&load(Vector3::zeros(), one * 1e-18), &down));
    }
    for (probability, quantile) in
        [(0.05, 12.591_587), (0.01, 16.811_894), (0.001, 22.457_745), (0.5, 5.348_121)]
    {
        for (share, expected) in [(0.999, false), (1.001, true)] {
            let force = Vector3::new(0.6, 0.0, 0.8) * f64::sqrt(quantile * share);
            let other = OtherContact::new(&load(force, one), &weight, &down).unwrap();
            assert!((other.statistic / (quantile * share) - 1.0).abs() < 1e-9);
            assert_eq!(other.touches(probability), expected, "{probability}");
            assert!((other.load.wrench.force() - force).norm() < 1e-6);
        }
    }
    // What no probability is left of touches.
    assert!(OtherContact::new(&load(Vector3::x() * 1e9, one), &weight, &down).unwrap().touches(1e-300));
    assert!(OtherContact::new(&load(Vector3::x() * 1e200, one), &weight, &down).is_none());
}

/// Under a gravity at which a load is a number and its covariance is beyond them all, no load is told.
#[test]
fn a_load_without_a_covariance_is_none() {
    let covariance = Matrix6::from_diagonal(&Vector6::new(1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8));
    let mut weight = ObjectWeight::<f64>::new();
    for gravity in [-Vector3::z() * 9.81, -Vector3::x() * 9.81] {
        let wrench = Wrench::<f64, TestHand>::from_force_at(&(Vector3::z() * 0.02), gravity * 0.2);
        assert!(weight.observe(&UncertainWrench { wrench, covariance }, &gravity));
    }
    assert!(weight.load::<TestHand>(&(Vector3::y() * 1e100)).is_some());
    assert!(weight.load::<TestHand>(&(Vector3::y() * 1e200)).is_none());
}
