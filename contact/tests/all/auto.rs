//! The pitch test, against its definition and against differences.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::Wrench;
use nalgebra::{Matrix6, Vector3, Vector6};

/// A full covariance, of about 10 mN and 0.1 mN·m.
fn noise() -> Matrix6<f64> {
    let scale = Matrix6::from_diagonal(&Vector6::new(1e-2, 2e-2, 1e-2, 1e-4, 2e-4, 3e-4));
    let root = Matrix6::from_fn(|i, j| ((5 * i + 3 * j) % 7) as f64 - 2.5 + 0.3 * j as f64);
    scale * root * root.transpose() * scale
}

fn auto(noise: Matrix6<f64>) -> Auto<f64> {
    Auto::new(PointContact::new(0.0).unwrap(), SoftFinger::new(0.0).unwrap(), noise).unwrap()
}

fn pitch(w: &Vector6<f64>) -> f64 {
    let (f, m) = (w.fixed_rows::<3>(0), w.fixed_rows::<3>(3));
    f.dot(&m) / f.norm_squared()
}

fn wrench() -> Wrench<f64> {
    Wrench::on_fingertip(Vector3::new(0.4, -0.3, -1.6), Vector3::new(0.004, 0.01, -0.003))
}

#[test]
fn statistic_and_deviation_are_as_defined() {
    let (wrench, sigma) = (wrench(), noise());
    let w = wrench.components();
    let test = auto(sigma).test(&wrench).unwrap();
    assert!((test.pitch / pitch(&w) - 1.0).abs() < 1e-14);
    let power = wrench.force().dot(&wrench.torque());
    let (f, m) = (wrench.force(), wrench.torque());
    let gradient = Vector6::new(m.x, m.y, m.z, f.x, f.y, f.z);
    let expected = power * power / gradient.dot(&(sigma * gradient));
    assert!((test.statistic / expected - 1.0).abs() < 1e-12, "{test:?} {expected}");
    // Central differences of the pitch.
    let slope = Vector6::from_fn(|k, _| {
        let step = Vector6::ith(k, 1e-5);
        (pitch(&(w + step)) - pitch(&(w - step))) / 2e-5
    });
    let deviation = slope.dot(&(sigma * slope)).sqrt();
    assert!((test.deviation / deviation - 1.0).abs() < 1e-8, "{test:?} {deviation}");
    // Without a limit nothing exceeds it.
    assert_eq!(test.excess, -f64::MAX);
    let limit = 0.001;
    let limited = auto(sigma).with_greatest_pitch(limit, 3.0).unwrap().test(&wrench).unwrap();
    let excess = (pitch(&w).abs() - limit) / deviation;
    assert!((limited.excess / excess - 1.0).abs() < 1e-7, "{limited:?} {excess}");
    // A left-handed pitch is as good.
    let mirrored = auto(sigma).test(&Wrench::on_fingertip(-f, m)).unwrap();
    assert!((mirrored.pitch + test.pitch).abs() < 1e-16);
}

#[test]
fn each_verdict_begins_where_it_should() {
    let wrench = wrench();
    let test = auto(noise()).test(&wrench).unwrap();
    let verdict = |auto: Auto<f64>| auto.test(&wrench).unwrap().choice;
    for (factor, choice) in
        [(0.999, Choice::SoftFinger), (1.0, Choice::PointContact), (1.001, Choice::PointContact)]
    {
        let threshold = test.statistic * factor;
        assert_eq!(verdict(auto(noise()).with_threshold(threshold).unwrap()), choice, "{factor}");
    }
    let limit = test.pitch.abs() - 2.0 * test.deviation;
    for (deviations, refused) in [(1.999, true), (2.001, false)] {
        let choice = verdict(auto(noise()).with_greatest_pitch(limit.max(0.0), deviations).unwrap());
        let beyond = limit > 0.0 || test.pitch.abs() / test.deviation > deviations;
        assert_eq!(choice == Choice::NotOneContact, refused && beyond, "{deviations} {test:?}");
    }
    // The usual threshold is the quantile of χ² with one degree of freedom for one in a hundred.
    let exact: f64 = 6.634_896_601_021_213;
    for (factor, soft) in [(1.0 + 1e-9, true), (1.0 - 1e-9, false)] {
        let scaled = auto(noise() * (test.statistic / (exact * factor)));
        assert_eq!(verdict(scaled) == Choice::SoftFinger, soft, "{factor}");
    }
}

/// Force, torque and noise in other units give the same verdict.
#[test]
fn the_size_of_the_force_does_not_matter() {
    let (wrench, limits) = (wrench(), (0.001, 0.5));
    let of = |scale: f64| {
        let auto = auto(noise() * (scale * scale)).with_greatest_pitch(limits.0, limits.1).unwrap();
        auto.test(&(wrench * scale)).unwrap()
    };
    let usual = of(1.0);
    for exponent in [-300, -40, -3, 5, 60, 300] {
        assert_eq!(of(2.0_f64.powi(exponent)), usual, "2^{exponent}");
    }
}

#[test]
fn without_noise_every_pitch_is_certain() {
    let certain = auto(Matrix6::zeros());
    let test = certain.test(&wrench()).unwrap();
    assert_eq!((test.statistic, test.choice, test.deviation), (f64::MAX, Choice::SoftFinger, 0.0));
    let flat = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::new(0.01, 0.02, 0.0));
    let test = certain.test(&flat).unwrap();
    assert_eq!((test.statistic, test.choice), (0.0, Choice::PointContact));
    // At the greatest pitch exactly there is no excess, on either side of it all there can be.
    let screw = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::new(0.0, 0.0, -0.01));
    for (greatest, excess) in [(0.005, 0.0), (0.004, f64::MAX), (0.006, -f64::MAX)] {
        let test = certain.with_greatest_pitch(greatest, 3.0).unwrap().test(&screw).unwrap();
        assert_eq!((test.pitch, test.excess), (0.005, excess));
    }
    // Also if not one deviation is granted: the greatest pitch is still allowed.
    let strict = certain.with_greatest_pitch(0.005, 0.0).unwrap().test(&screw).unwrap();
    assert_eq!(strict.choice, Choice::SoftFinger);
    assert_eq!(certain.test(&Wrench::on_fingertip(Vector3::zeros(), Vector3::x())), None);
    assert_eq!(certain.test(&Wrench::on_fingertip(Vector3::x() * f64::NAN, Vector3::x())), None);
}

/// What no single contact can give is refused from the least force on; a weaker force is below it.
#[test]
fn a_weak_force_is_weak_before_it_is_too_much() {
    let sphere = Sphere::centred(0.013).unwrap();
    let model = |least| {
        Auto::new(PointContact::new(least).unwrap(), SoftFinger::new(least).unwrap(), Matrix6::zeros())
            .unwrap()
            .with_greatest_pitch(0.001, 3.0)
            .unwrap()
    };
    let screw = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::new(0.0, 0.0, -0.01));
    for least in [0.0, 1.9, 2.0] {
        let found = model(least).resolve(&screw, &sphere);
        assert!(matches!(found, Resolution::NoContact(NoContact::NotOneContact { .. })), "{least} {found:?}");
    }
    let weak = model(2.1).resolve(&screw, &sphere);
    assert_eq!(weak, Resolution::NoContact(NoContact::BelowThreshold { force: 2.0 }));
    let nothing = model(0.0).resolve(&Wrench::on_fingertip(Vector3::zeros(), Vector3::x()), &sphere);
    assert!(nothing.contact().is_none());
}

#[test]
fn limits_are_validated() {
    let usual = auto(noise());
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(usual.with_threshold(bad).is_err(), "{bad}");
    }
    for bad in [-1e-9, f64::NAN, f64::INFINITY] {
        assert!(
            usual.with_greatest_pitch(bad, 3.0).is_err() && usual.with_greatest_pitch(0.001, bad).is_err()
        );
    }
    assert!(usual.with_greatest_pitch(0.0, 0.0).is_ok());
}
