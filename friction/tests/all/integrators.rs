//! Each integrator against the equation that it solves, and the laws against their definitions.

use fingertip_friction::testing::Draws;
use fingertip_friction::{
    Bristle, BristleLaw, Dahl, ElastoPlastic, Implicit, Integrator, LuGre, ReturnMap, Stribeck,
    StribeckFriction,
};
use nalgebra::{SVector, Vector1, Vector3};

fn curve() -> Stribeck<f64> {
    Stribeck::new(0.8, 1.2, 1e-2).unwrap()
}

/// Random steps in space; `check` gets deflection before and after, velocity, step, `σ₀/g` and `F_s/σ₀`.
fn walk<M: Integrator>(seed: u64, check: impl Fn(Vector3<f64>, Vector3<f64>, Vector3<f64>, f64, f64)) {
    let mut draws = Draws::new(seed);
    let law = LuGre::new(2e3, 0.0, 0.0, curve()).unwrap();
    let mut bristle = Bristle::<f64, _, 3, M>::with_method(law);
    for _ in 0..3000 {
        let v = Vector3::from_fn(|_, _| 0.3 * draws.signed().powi(3));
        let h = 1e-5 * 1e4_f64.powf(draws.share());
        let before = *bristle.deflection();
        bristle.step(&v, h);
        let steady = 0.8 + 0.4 * (-(v.norm() / 1e-2).powi(2)).exp();
        check(before, *bristle.deflection(), v, h, steady / 2e3);
    }
}

/// The greatest deflection of the law, to which every step is cut.
const GREATEST: f64 = 1.2 / 2e3;
const ROUNDING: f64 = 32.0 * f64::EPSILON * GREATEST;

#[test]
fn exponential_step_decays_towards_steady_sliding() {
    walk::<fingertip_friction::Exponential>(41, |before, after, v, h, limit| {
        let settled = v * (limit / v.norm());
        let exact = settled + (before - settled) * (-v.norm() * h / limit).exp();
        assert!((after - exact).norm() <= ROUNDING, "{after:?} {exact:?}");
    });
}

#[test]
fn implicit_step_solves_the_backward_equation() {
    walk::<Implicit>(42, |before, after, v, h, limit| {
        let rate = v - after * (v.norm() / limit);
        let error = before + rate * h - after;
        assert!(error.norm() <= 4.0 * ROUNDING * (1.0 + h * v.norm() / limit), "{error:?}");
    });
}

#[test]
fn return_map_is_the_nearest_deflection_within_the_limit() {
    walk::<ReturnMap>(43, |before, after, v, h, limit| {
        let moved = before + v * h;
        assert!(after.norm() <= limit + ROUNDING);
        if moved.norm() <= limit {
            assert!((after - moved).norm() <= ROUNDING);
        } else {
            // The nearest point of a ball lies on its edge and in the same direction.
            assert!((after.norm() - limit).abs() <= ROUNDING, "{after:?} {limit}");
            assert!(after.cross(&moved).norm() <= ROUNDING * moved.norm() && after.dot(&moved) > 0.0);
        }
    });
}

#[test]
fn stribeck_curve_is_its_definition() {
    for speed in [0.0_f64, 1e-3, 1e-2, 0.02, 0.05, 1.0, 1e300] {
        let exact = 0.8 + 0.4 * (-(speed / 1e-2) * (speed / 1e-2)).exp();
        assert!((curve().at(speed) - exact).abs() <= 4.0 * f64::EPSILON, "{speed}");
        assert_eq!(curve().at(-speed), curve().at(speed));
    }
    assert_eq!((curve().kinetic(), curve().breakaway(), curve().speed()), (0.8, 1.2, 1e-2));
    assert_eq!(curve().at(f64::NAN), 0.8);
    let flat = Stribeck::constant(0.7).unwrap();
    assert_eq!((flat.at(0.0), flat.at(3.0)), (0.7, 0.7));
    // Equal coefficients are no fault, a static one below the kinetic is.
    assert!(Stribeck::new(0.8, 0.8, 1.0).is_ok() && Stribeck::new(0.8, 0.799, 1.0).is_err());
    assert!(Stribeck::constant(0.0).is_err());
}

#[test]
fn laws_hand_on_their_parameters() {
    let lugre = LuGre::new(2e3, 3.0, 0.5, curve()).unwrap();
    let said = |law: &dyn BristleLaw<f64>| {
        (law.stiffness(), law.damping(), law.viscous(), law.steady(1e-3), law.greatest())
    };
    let steady = curve().at(1e-3);
    assert_eq!(said(&lugre), (2e3, 3.0, 0.5, steady, 1.2));
    assert_eq!(lugre.curve(), &curve());
    assert_eq!(said(&ElastoPlastic::new(lugre, 0.5).unwrap()), (2e3, 3.0, 0.5, steady, 1.2));
    assert_eq!(said(&StribeckFriction::new(2e3, 0.5, curve()).unwrap()), (2e3, 0.0, 0.5, steady, 1.2));
    assert_eq!(said(&Dahl::new(2e3, 0.7).unwrap()), (2e3, 0.0, 0.0, 0.7, 0.7));
    assert_eq!(lugre.plastic_share(1e-9, true, 1.0), 1.0);
    let reference = LuGre::<f64>::reference().unwrap();
    assert_eq!(said(&reference), (1e5, 1e5_f64.sqrt(), 0.4, 1.0 + 0.5 * (-1.0_f64).exp(), 1.5));
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(LuGre::new(bad, 3.0, 0.5, curve()).is_err() && LuGre::new(2e3, bad, 0.5, curve()).is_err());
        assert!(LuGre::new(2e3, 3.0, bad, curve()).is_err() && ElastoPlastic::new(lugre, bad).is_err());
        assert!(StribeckFriction::new(bad, 0.5, curve()).is_err() && Dahl::new(2e3, bad).is_err());
    }
    assert!(ElastoPlastic::new(lugre, 0.0).is_ok());
    // The defaults of a law of one's own.
    struct Own;
    impl BristleLaw<f64> for Own {
        fn stiffness(&self) -> f64 {
            1.0
        }
        fn steady(&self, _speed: f64) -> f64 {
            2.0
        }
        fn greatest(&self) -> f64 {
            2.0
        }
    }
    assert_eq!(said(&Own), (1.0, 0.0, 0.0, 2.0, 2.0));
}

/// Dupont's share: none up to the elastic deflection, all from that of steady sliding on, between them half
/// a wave of a sine; none while the motion unloads.
#[test]
fn plastic_share_rises_along_half_a_sine() {
    let law = ElastoPlastic::new(LuGre::new(2e3, 0.0, 0.0, curve()).unwrap(), 0.5).unwrap();
    let elastic = 0.5 * 1.2 / 2e3;
    for speed in [0.0, 5e-3, 1.0] {
        let sliding = curve().at(speed) / 2e3;
        let at = |x: f64| law.plastic_share(elastic + x * (sliding - elastic), false, speed);
        let sure = 1e-12;
        assert_eq!((at(-0.1), at(-sure), at(1.0 + sure), at(2.0)), (0.0, 0.0, 1.0, 1.0));
        assert_eq!(law.plastic_share(elastic, false, speed), 0.0);
        // sin(−π/2), −π/4, 0, π/6, π/2.
        let root = core::f64::consts::FRAC_1_SQRT_2;
        for (x, share) in [(0.0, 0.0), (0.25, 0.5 * (1.0 - root)), (0.5, 0.5), (2.0 / 3.0, 0.75), (1.0, 1.0)]
        {
            assert!((at(x) - share).abs() < 1e-12, "{x} {}", at(x));
        }
        assert_eq!(law.plastic_share(sliding, true, speed), 0.0);
    }
}

#[test]
fn elasto_plastic_contact_is_elastic_when_loaded_a_little_and_when_unloaded() {
    let law = ElastoPlastic::new(LuGre::new(2e3, 0.0, 0.0, curve()).unwrap(), 0.5).unwrap();
    let mut bristle = Bristle::<f64, _, 1>::new(law);
    let mut way = 0.0;
    // 0.3 mm are elastic.
    for _ in 0..29 {
        bristle.step(&Vector1::new(1e-2), 1e-3);
        way += 1e-5;
        assert!((bristle.deflection()[0] - way).abs() < 1e-15);
    }
    for _ in 0..1000 {
        bristle.step(&Vector1::new(1e-2), 1e-3);
    }
    let sliding = bristle.deflection()[0];
    assert!((sliding - curve().at(1e-2) / 2e3).abs() < 1e-9, "{sliding}");
    for step in 1..=50 {
        bristle.step(&Vector1::new(-1e-2), 1e-3);
        let wanted = sliding - 1e-5 * f64::from(step);
        assert!((bristle.deflection()[0] - wanted).abs() < 1e-15, "{step}");
    }
}

/// Motion across the deflection does not unload it: the contact slides.
#[test]
fn a_motion_across_the_deflection_slides() {
    let law = ElastoPlastic::new(LuGre::new(2e3, 0.0, 0.0, curve()).unwrap(), 0.5).unwrap();
    let mut bristle = Bristle::<f64, _, 2>::new(law);
    for _ in 0..1000 {
        bristle.step(&SVector::<f64, 2>::new(1e-2, 0.0), 1e-3);
    }
    let before = bristle.deflection().x;
    bristle.step(&SVector::<f64, 2>::new(0.0, 1e-2), 1e-3);
    // Nearly at steady sliding, the share is one.
    let wanted = before * (-1e-5 * 2e3 / curve().at(1e-2)).exp();
    assert!((bristle.deflection().x / wanted - 1.0).abs() < 1e-3, "{before} {wanted} {bristle:?}");
}

#[test]
fn load_scales_force_and_energy_and_its_loss_releases() {
    let law = LuGre::new(2e3, 3.0, 0.5, curve()).unwrap();
    let v = SVector::<f64, 2>::new(3e-2, -4e-2);
    let mut one = Bristle::<f64, _, 2>::new(law);
    let mut three = one;
    three.set_load(3.0);
    let (single, triple) = (one.step(&v, 1e-3).mean, three.step(&v, 1e-3).mean);
    assert!((triple - single * 3.0).norm() <= 8.0 * f64::EPSILON * triple.norm());
    let energy = 0.5 * 2e3 * one.deflection().norm_squared();
    assert!((one.energy() - energy).abs() <= 4.0 * f64::EPSILON * energy);
    assert!((three.energy() - 3.0 * energy).abs() <= 16.0 * f64::EPSILON * energy);
    assert!(three.deflection().norm() > 0.0 && three.law() == &law);
    for none in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut released = three;
        released.set_load(none);
        assert_eq!(released.energy(), 0.0);
        assert_eq!(released.step(&v, 1e-3).mean, SVector::<f64, 2>::zeros());
        assert_eq!(*released.deflection(), SVector::<f64, 2>::zeros());
        // Pressed again, it starts without deflection.
        released.set_load(3.0);
        let mut fresh = Bristle::<f64, _, 2>::new(law);
        fresh.set_load(3.0);
        assert_eq!(released, fresh);
    }
    three.reset();
    let mut fresh = Bristle::<f64, _, 2>::new(law);
    fresh.set_load(3.0);
    assert_eq!(three, fresh);
}

#[test]
fn bad_motion_returns_the_elastic_force() {
    let mut bristle = Bristle::<f64, _, 2>::new(LuGre::new(2e3, 3.0, 0.5, curve()).unwrap());
    bristle.set_load(2.0);
    bristle.step(&SVector::<f64, 2>::new(3e-2, -4e-2), 1e-3);
    let before = bristle;
    let elastic = *before.deflection() * (2e3 * 2.0);
    let good = SVector::<f64, 2>::new(1e-2, 0.0);
    for (v, h) in [
        (SVector::<f64, 2>::new(0.0, f64::NAN), 1e-3),
        (SVector::<f64, 2>::new(f64::INFINITY, 0.0), 1e-3),
        (good, f64::NAN),
        (good, f64::INFINITY),
        (good, -1e-3),
        // The way is out of range.
        (good * 1e300, 1e20),
        // As is the speed, at no way.
        (SVector::<f64, 2>::new(f64::INFINITY, 0.0), 0.0),
    ] {
        let force = bristle.step(&v, h);
        assert_eq!((force.mean, force.end), (elastic, elastic), "{v:?} {h}");
        assert_eq!(bristle, before);
    }
}
