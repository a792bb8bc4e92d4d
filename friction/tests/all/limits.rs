//! The laws of every friction limit, on both scalars, and figures from closed forms.

use fingertip_friction::testing::{Claims, Draws, friction_laws};
use fingertip_friction::{
    AnisotropicCoulomb, Coulomb, FrictionLimit, FrictionModel, LoadDependentLimit, PowerLimit,
    PressureDistribution, SoftFingerLimit,
};
use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;

fn literal<T: Real>(x: f64) -> T {
    T::literal(x)
}

fn claims<T: Real>(arm: f64) -> Claims<T> {
    Claims { homogeneous: true, convex: true, arm: literal(arm), tolerance: literal::<T>(32.0) * T::EPSILON }
}

fn soft_norm<T: Real>(arm: f64, exponent: f64) -> impl Fn(&ContactForce<T>) -> T {
    move |f| {
        let (t, s) = (f.tangential_magnitude().to_f64(), (f.spin.to_f64() / arm).abs());
        let load = (t.powf(exponent) + s.powf(exponent)).powf(1.0 / exponent);
        T::literal(load.hypot(f.normal.to_f64()))
    }
}

#[allow(clippy::unwrap_used, reason = "test")]
fn laws_of_all<T: Real>(count: usize) {
    for mu in [0.05, 0.5, 1.0, 3.0] {
        let euclid = |f: &ContactForce<T>| (f.tangential.norm_squared() + f.normal * f.normal).root();
        friction_laws(&Coulomb::new(literal(mu)).unwrap(), &claims::<T>(0.0), euclid, count);
        let directions = [
            Vector3::new(literal::<T>(0.6), literal(0.8), T::zero()),
            Vector3::new(literal::<T>(-0.8), literal(0.6), T::zero()),
        ];
        for ratio in [1.0, 1.6, 20.0] {
            let model = AnisotropicCoulomb::new(directions, [literal(mu * ratio), literal(mu)]).unwrap();
            let claims = Claims { tolerance: literal::<T>(256.0) * T::EPSILON, ..claims::<T>(0.0) };
            friction_laws(&model, &claims, euclid, count);
        }
        let arm = 3.4e-3;
        let model = SoftFingerLimit::new(literal(mu), literal(arm)).unwrap();
        friction_laws(&model, &claims::<T>(arm), soft_norm(arm, 2.0), count);
        for exponent in [1.0, 1.725, 2.0] {
            let model = PowerLimit::new(literal(mu), literal(arm), literal(exponent)).unwrap();
            friction_laws(&model, &claims::<T>(arm), soft_norm(arm, exponent), count);
        }
        let model =
            LoadDependentLimit::new(literal(mu), literal(arm), literal(5.0), literal(1.0 / 3.0)).unwrap();
        // Neither a cone nor convex, and its norm moves with the load.
        let claims = Claims { homogeneous: false, convex: false, ..claims::<T>(0.0) };
        friction_laws(
            &model,
            &Claims { tolerance: literal::<T>(256.0) * T::EPSILON, ..claims },
            euclid,
            count,
        );
    }
}

#[test]
fn laws_hold() {
    laws_of_all::<f64>(1500);
    laws_of_all::<f32>(1500);
}

/// Every model of the crate is tried above: `$limit` is what both soft fingers are made of.
#[test]
fn no_model_is_left_out() {
    let tried = ["$limit", "AnisotropicCoulomb", "Coulomb", "LoadDependentLimit"];
    assert_eq!(crate::laws_of_detectors::implementers("FrictionModel"), tried);
}

fn force(normal: f64, one: f64, two: f64, spin: f64) -> ContactForce<f64> {
    ContactForce::new(normal, Vector3::new(one, two, 0.0), spin)
}

#[test]
fn coulomb_matches_its_closed_form() {
    let model = Coulomb::new(0.75).unwrap();
    // A 3-4-5 triangle: margin (0.75·4 − 1)/1.25.
    let margin = model.slip_margin(&force(4.0, 1.0, 0.0, 0.0));
    assert!((margin.newtons - 1.6).abs() < 1e-15 && (margin.utilisation - 1.0 / 3.0).abs() < 1e-15);
    // Pulling: the apex is nearest.
    assert_eq!(model.slip_margin(&force(-4.0, 3.0, 0.0, 0.0)).newtons, -5.0);
    assert_eq!(model.project(&force(-4.0, 3.0, 0.0, 0.0)), ContactForce::zero());
    let angle = model.angle_margin(&force(4.0, 1.0, 0.0, 0.0));
    assert!((angle - (0.75_f64.atan() - 0.25_f64.atan())).abs() < 1e-15);
    assert!((model.factor_of_safety(&force(4.0, 1.0, 0.0, 0.0)) - 3.0).abs() < 1e-14);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Coulomb::new(bad).is_err());
    }
}

/// The distance to the elliptic cone against a dense search over its surface.
#[test]
fn anisotropic_distance_matches_a_search() {
    let model = AnisotropicCoulomb::new([Vector3::x(), Vector3::y()], [0.3, 0.9]).unwrap();
    let mut draws = Draws::new(7);
    for _ in 0..60 {
        let f: ContactForce<f64> = draws.force(0.0);
        let mut nearest = f64::INFINITY;
        for step in 0..20_000 {
            let (sine, cosine) = (f64::from(step) * core::f64::consts::TAU / 20_000.0).sin_cos();
            // The nearest point of one ray of the cone.
            let ray = Vector3::new(0.3 * cosine, 0.9 * sine, 1.0);
            let point = Vector3::new(f.tangential.x, f.tangential.y, f.normal);
            let along = (point.dot(&ray) / ray.norm_squared()).max(0.0);
            nearest = nearest.min((point - ray * along).norm());
        }
        let margin = model.slip_margin(&f).newtons;
        // The search's own error: half a step of angle, squared.
        assert!((margin.abs() - nearest).abs() < 2e-6, "{f:?} {margin} {nearest}");
    }
    assert!(AnisotropicCoulomb::new([Vector3::x(), Vector3::x()], [0.3, 0.9]).is_err());
    assert!(AnisotropicCoulomb::new([Vector3::x() * 1.1, Vector3::y()], [0.3, 0.9]).is_err());
    assert!(AnisotropicCoulomb::new([Vector3::x(), Vector3::y()], [0.3, f64::NAN]).is_err());
}

#[test]
fn equal_coefficients_are_coulomb() {
    let round = Coulomb::new(0.6).unwrap();
    let model = AnisotropicCoulomb::new([Vector3::x(), Vector3::y()], [0.6, 0.6]).unwrap();
    let power = PowerLimit::new(0.6, 2e-3, 2.0).unwrap();
    let soft = SoftFingerLimit::new(0.6, 2e-3).unwrap();
    let mut draws = Draws::new(8);
    for _ in 0..2000 {
        let f: ContactForce<f64> = draws.force(2e-3);
        let (a, b) = (round.slip_margin(&f).newtons, model.slip_margin(&f).newtons);
        assert!((a - b).abs() < 1e-13, "{a} {b}");
        let (a, b) = (soft.slip_margin(&f).newtons, power.slip_margin(&f).newtons);
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
}

#[test]
fn load_dependent_margin_is_certain_and_the_set_is_not_convex() {
    // `docs/theory/friction.md#load-dependent-limit`: between N = 1 and 8 with γ = 1/3, the mid-point torque
    // is above the cap.
    let model = LoadDependentLimit::new(1.0_f64, 1e-3, 1.0, 1.0 / 3.0).unwrap();
    let cap = |n: f64| n * model.arm_at(n);
    let middle = force(4.5, 0.0, 0.0, 0.5 * (cap(1.0) + cap(8.0)));
    assert!(!model.holds(&middle));
    assert!((middle.spin - 8.5e-3).abs() < 1e-12 && (cap(4.5) - 7.43e-3).abs() < 1e-5);
    // Random changes shorter than the margin never slip.
    let model = LoadDependentLimit::new(0.7_f64, 3e-3, 5.0, 0.3).unwrap();
    let mut draws = Draws::new(9);
    for _ in 0..4000 {
        let f: ContactForce<f64> = draws.force(3e-3);
        let margin = model.slip_margin(&f).newtons;
        if margin <= 0.0 {
            continue;
        }
        let arm = model.arm_at(f.normal);
        for _ in 0..20 {
            let step = [draws.signed(), draws.signed(), draws.signed(), draws.signed()];
            let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
            let step = step.map(|x| x * margin * 0.999_999 / length);
            let there = ContactForce::new(
                f.normal + step[0],
                *f.tangential + Vector3::new(step[1], step[2], 0.0),
                f.spin + step[3] * arm,
            );
            assert!(model.holds(&there), "{f:?} {there:?}");
        }
    }
    for bad in [-0.1, 1.1, f64::NAN] {
        assert!(LoadDependentLimit::new(0.7_f64, 3e-3, 5.0, bad).is_err());
    }
}

#[test]
fn patches_give_their_arms() {
    let hertz = PowerLimit::for_patch(0.5_f64, 4e-3, PressureDistribution::Hertz).unwrap();
    assert!((hertz.arm() - 3.0 * core::f64::consts::PI / 16.0 * 4e-3).abs() < 1e-15);
    assert!((hertz.exponent() - 1.725).abs() < 2e-3);
    assert!(PowerLimit::for_patch(0.5_f64, 4e-3, PressureDistribution::PowerLaw(0.1)).is_err());
    assert!(PowerLimit::for_patch(0.5_f64, f64::NAN, PressureDistribution::Hertz).is_err());
    assert!(PowerLimit::new(0.5_f64, 1e-3, 2.5).is_err());
}
