//! A soft finger whose patch grows: its arm, its certified margin as defined, and its grip forces.

use fingertip_friction::testing::Draws;
use fingertip_friction::{FrictionLimit, FrictionModel, LoadDependentLimit, SoftFingerLimit};
use fingertip_test_support::Worst;
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;

const MU: f64 = 0.7;
const ARM: f64 = 3e-3;
const REFERENCE: f64 = 5.0;

fn model(growth: f64) -> LoadDependentLimit<f64> {
    LoadDependentLimit::new(MU, ARM, REFERENCE, growth).unwrap()
}

fn arm(normal: f64, growth: f64) -> f64 {
    ARM * (normal / REFERENCE).powf(growth)
}

fn load(f: &ContactForce<f64>, growth: f64) -> f64 {
    f.tangential.vector().norm().hypot(f.spin / arm(f.normal, growth))
}

#[test]
fn arm_grows_with_the_load() {
    for growth in [0.0, 0.3, 1.0] {
        for normal in [1e-3, 1.0, 5.0, 40.0] {
            assert!((model(growth).arm_at(normal) / arm(normal, growth) - 1.0).abs() < 1e-14);
        }
        for none in [0.0, -1.0, f64::NAN] {
            assert_eq!(model(growth).arm_at(none), f64::MIN_POSITIVE);
        }
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(LoadDependentLimit::new(bad, ARM, 5.0, 0.3).is_err());
        assert!(LoadDependentLimit::new(MU, bad, 5.0, 0.3).is_err());
        assert!(LoadDependentLimit::new(MU, ARM, bad, 0.3).is_err());
    }
    assert!(LoadDependentLimit::new(MU, ARM, 5.0, 1.0).is_ok());
}

/// The certified margin is the greatest radius for which, at every fall ν of the normal force, friction
/// still holds the load that grows by the rest of the radius, with the arm shrunk as by the whole radius.
/// Found here by a scan over radius and fall.
#[test]
fn margin_is_the_greatest_that_is_certain() {
    let mut draws = Draws::new(111);
    for growth in [0.1, 1.0 / 3.0, 1.0] {
        for _ in 0..150 {
            let f: ContactForce<f64> = draws.force(ARM);
            let found = model(growth).slip_margin(&f);
            if f.normal <= 0.0 || load(&f, growth) >= MU * f.normal {
                assert!(found.newtons <= 0.0, "{f:?} {found:?}");
                continue;
            }
            let rho = load(&f, growth);
            let holds = |radius: f64| {
                let shrunk = (f.normal / (f.normal - radius)).powf(growth);
                (0..=2000).map(|k| radius * f64::from(k) / 2000.0).all(|fall| {
                    MU * (f.normal - fall) >= shrunk * (rho + (radius * radius - fall * fall).max(0.0).sqrt())
                })
            };
            let (mut low, mut high) = (0.0, 0.999 * f.normal);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if holds(middle) { low = middle } else { high = middle }
            }
            // The scan misses the worst fall by a two-thousandth at most, to the second order.
            assert!((found.newtons - low).abs() < 1e-5 * (low + 0.1), "{f:?} {found:?} {low}");
            assert!((found.utilisation - rho / (MU * f.normal)).abs() < 1e-13);
        }
    }
    // Without load, nothing depends on the arm but the last of the margin.
    let free = model(0.3).slip_margin(&ContactForce::new(5.0, Vector3::zeros(), 0.0));
    assert!(
        free.newtons > 0.0 && free.newtons < 5.0 * MU / (1.0 + MU * MU).sqrt() && free.utilisation == 0.0
    );
}

/// Outside, margin and projection are those of the ellipse with the present arm.
#[test]
fn outside_it_is_the_ellipse_with_the_present_arm() {
    let mut draws = Draws::new(112);
    for _ in 0..400 {
        let f: ContactForce<f64> = draws.force(ARM);
        if f.normal <= 0.0 {
            continue;
        }
        let ellipse = SoftFingerLimit::new(MU, arm(f.normal, 0.3)).unwrap();
        let (found, plain) = (model(0.3).slip_margin(&f), ellipse.slip_margin(&f));
        assert!((found.utilisation - plain.utilisation).abs() <= 1e-13 * plain.utilisation);
        if plain.newtons <= 0.0 {
            assert!((found.newtons - plain.newtons).abs() < 1e-12, "{f:?}");
        }
        let (a, b) = (model(0.3).project(&f), ellipse.project(&f));
        let apart = (a.normal - b.normal).abs() + (*a.tangential - *b.tangential).norm();
        assert!(apart + (a.spin - b.spin).abs() / ARM < 1e-11, "{f:?} {a:?} {b:?}");
        let (a, b) = (model(0.3).slip_direction(&f), ellipse.slip_direction(&f));
        assert_eq!(a.is_some(), b.is_some());
        if let (Some(a), Some(b)) = (a, b) {
            assert!((a.velocity - b.velocity).norm() + (a.spin - b.spin).abs() * ARM < 1e-12);
        }
    }
}

#[test]
fn grip_forces_are_just_enough() {
    let mut draws = Draws::new(113);
    for growth in [0.0, 0.3, 1.0] {
        let model = model(growth);
        for _ in 0..200 {
            let f: ContactForce<f64> = draws.force(ARM);
            for safety in [1.0, 2.5] {
                let least = model.least_normal_force(&f, safety);
                let there = ContactForce { normal: least, ..f };
                if least > 0.0 {
                    let held = MU * least / load(&there, growth);
                    assert!((held / safety - 1.0).abs() < 1e-12, "{f:?} {least} {held}");
                } else {
                    assert!(f.spin == 0.0 && f.tangential.norm() == 0.0, "{f:?}");
                }
            }
            for margin in [0.0, 0.25, 2.0] {
                let keeping = model.normal_force_keeping(&f, margin);
                let margin_at = |normal: f64| model.slip_margin(&ContactForce { normal, ..f }).newtons;
                assert!(margin_at(keeping) >= margin - 1e-12 * (1.0 + keeping), "{f:?} {margin} {keeping}");
                // It is raised by a sixty-fourth at a time.
                assert!(margin_at(keeping * 0.98) <= margin, "{f:?} {margin} {keeping}");
            }
            assert_eq!(model.normal_force_keeping(&f, -3.0), model.normal_force_keeping(&f, 0.0));
        }
        let f = ContactForce::new(1.0, Vector3::x(), 1e-3);
        assert_eq!(model.least_normal_force(&f, 0.0), 0.0);
        assert_eq!(model.least_normal_force(&f, -1.0), 0.0);
        assert_eq!(model.least_normal_force(&f, f64::NAN), f64::MAX);
        for bad in [f64::NAN, f64::INFINITY] {
            for f in
                [ContactForce::new(1.0, Vector3::x() * bad, 0.0), ContactForce::new(1.0, Vector3::x(), bad)]
            {
                assert_eq!(model.least_normal_force(&f, 1.0), f64::MAX, "{f:?}");
                assert_eq!(model.normal_force_keeping(&f, 1.0), f64::MAX, "{f:?}");
            }
        }
    }
    // No load needs no force.
    let none = ContactForce::new(1.0, Vector3::zeros(), 0.0);
    assert_eq!(model(0.3).least_normal_force(&none, 1.5), 0.0);
    assert_eq!(model(0.3).normal_force_keeping(&none, 0.0), 0.0);
    // A spin that no force of the type holds.
    let greatest = ContactForce::new(1.0, Vector3::zeros(), f64::MAX);
    assert_eq!(model(0.0).least_normal_force(&greatest, 1.0), f64::MAX);
    assert_eq!(model(0.0).normal_force_keeping(&greatest, 1.0), f64::MAX);
    // A coefficient with which the cone is wide: the search does not start too far below.
    let wide = LoadDependentLimit::new(50.0, ARM, REFERENCE, 0.3).unwrap();
    let f = ContactForce::new(1.0, Vector3::x() * 1e-3, 1e-6);
    for margin in [0.25, 2.0, 100.0] {
        let normal = wide.normal_force_keeping(&f, margin);
        assert!(wide.slip_margin(&ContactForce { normal, ..f }).newtons >= margin, "{margin} {normal}");
    }
    // Spin alone, over the whole range of the type.
    for spin in [1e-300, 1e-12, 1.0, 1e100] {
        let least = model(0.3).least_normal_force(&ContactForce::new(1.0, Vector3::zeros(), spin), 1.0);
        // μN·e₀(N/N₀)^γ = τ.
        let exact = (spin * REFERENCE.powf(0.3) / (MU * ARM)).powf(1.0 / 1.3);
        assert!((least / exact - 1.0).abs() < 1e-12, "{spin:e} {least:e} {exact:e}");
    }
}

/// No more than that: against a bisection over the margin itself.
#[test]
fn keeping_a_margin_asks_for_no_more_than_it_takes() {
    let mut worst = Worst::new();
    for index in 1..1000_u32 {
        let growth = f64::from(index % 10) / 10.0;
        let model = LoadDependentLimit::new(0.5, 3e-3, 2.0, growth).unwrap();
        let load = 0.01 * f64::from(index);
        let force = ContactForce::new(1.0, Vector3::new(load, 0.0, 0.0), 1e-3 * f64::from(index % 7));
        let margin = 0.1 * f64::from(index % 13);
        let keeping = model.normal_force_keeping(&force, margin);
        let kept = |normal: f64| model.slip_margin(&ContactForce { normal, ..force }).newtons >= margin;
        assert!(kept(keeping), "{index}");
        let (mut low, mut high) = (0.5 * keeping, keeping);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if kept(middle) { high = middle } else { low = middle }
        }
        worst.see(keeping / high - 1.0);
    }
    println!("too great by {:.1e}", worst.get());
    assert!(worst.get() < 1e-4, "{}", worst.get());
}
