//! The elliptic cone against searches over its surface and differences of its gauge.

use fingertip_friction::testing::Draws;
use fingertip_friction::{AnisotropicCoulomb, Coulomb, FrictionLimit, FrictionModel};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;

fn directions() -> [Vector3<f64>; 2] {
    [Vector3::new(0.6, 0.8, 0.0), Vector3::new(-0.8, 0.6, 0.0)]
}

/// The higher coefficient is along the first direction, so that the model turns them round.
const COEFFICIENTS: [f64; 2] = [0.9, 0.3];

fn model() -> AnisotropicCoulomb<f64> {
    AnisotropicCoulomb::new(directions(), COEFFICIENTS).unwrap()
}

/// Components along the directions as given, and the normal force.
fn parts(f: &ContactForce<f64>) -> Vector3<f64> {
    let [one, two] = directions();
    Vector3::new(f.tangential.dot(&one), f.tangential.dot(&two), f.normal)
}

fn gauge(f: &ContactForce<f64>) -> f64 {
    let p = parts(f);
    (p.x / COEFFICIENTS[0]).hypot(p.y / COEFFICIENTS[1])
}

/// The nearest point of the cone's surface: the best of many rays, and then of ever finer ones about it.
fn nearest(point: &Vector3<f64>) -> Vector3<f64> {
    let on_ray = |angle: f64| {
        let ray = Vector3::new(COEFFICIENTS[0] * angle.cos(), COEFFICIENTS[1] * angle.sin(), 1.0);
        ray * (point.dot(&ray) / ray.norm_squared()).max(0.0)
    };
    let (mut best, mut width) = (0.0, core::f64::consts::PI);
    for count in [720, 20, 20, 20, 20, 20, 20] {
        let middle = best;
        for step in -count..=count {
            let angle = middle + width * f64::from(step) / f64::from(count);
            if (on_ray(angle) - point).norm() < (on_ray(best) - point).norm() {
                best = angle;
            }
        }
        width = 2.0 * width / f64::from(count);
    }
    on_ray(best)
}

#[test]
fn margins_and_projections_match_a_search() {
    let mut draws = Draws::new(101);
    for _ in 0..400 {
        let f: ContactForce<f64> = draws.force(0.0);
        let (point, margin, found) = (parts(&f), model().slip_margin(&f), model().project(&f));
        let edge = nearest(&point);
        let distance = (edge - point).norm();
        let holds = gauge(&f) <= f.normal;
        let wanted = if holds { distance } else { -distance };
        assert!((margin.newtons - wanted).abs() < 1e-10, "{f:?} {margin:?} {wanted}");
        assert_eq!(model().holds(&f), holds);
        let used = if f.normal > 0.0 { gauge(&f) / f.normal } else { f64::MAX };
        assert!((margin.utilisation / used - 1.0).abs() < 1e-13 || used == 0.0, "{f:?} {margin:?}");
        assert_eq!(found.spin, 0.0);
        let wanted = if holds { point } else { edge };
        assert!((parts(&found) - wanted).norm() < 1e-5, "{f:?} {found:?} {wanted:?}");
        assert!(model().holds(&found), "{f:?} {found:?}");
    }
}

#[test]
fn grip_forces_are_just_enough() {
    let mut draws = Draws::new(102);
    for _ in 0..400 {
        let f: ContactForce<f64> = draws.force(0.0);
        for safety in [1.0, 3.0] {
            let least = model().least_normal_force(&f, safety);
            assert!((least - safety * gauge(&f)).abs() <= 1e-13 * least, "{f:?} {least}");
        }
        for margin in [0.25, 3.0] {
            let keeping = model().normal_force_keeping(&f, margin);
            let there = model().slip_margin(&ContactForce { normal: keeping, ..f }).newtons;
            assert!((there - margin).abs() < 1e-12 * (1.0 + keeping), "{f:?} {margin} {keeping} {there}");
        }
        for none in [0.0, -1.0] {
            let keeping = model().normal_force_keeping(&f, none);
            assert!((keeping - gauge(&f)).abs() <= 1e-12 * keeping, "{f:?} {keeping}");
        }
    }
    for bad in [f64::NAN, f64::INFINITY, f64::MAX] {
        let f = ContactForce::new(1.0, directions()[1] * bad, 0.0);
        assert_eq!(model().normal_force_keeping(&f, 1.0), f64::MAX);
        assert_eq!(model().least_normal_force(&f, 2.0), f64::MAX);
    }
}

#[test]
fn slip_is_against_the_gradient() {
    let mut draws = Draws::new(103);
    for _ in 0..300 {
        let f: ContactForce<f64> = draws.force(0.0);
        if f.tangential.norm() < 0.1 {
            continue;
        }
        let at = |one: f64, two: f64| {
            gauge(&ContactForce::new(1.0, *f.tangential + Vector3::new(one, two, 0.0), 0.0))
        };
        let slope = Vector3::new(at(1e-5, 0.0) - at(-1e-5, 0.0), at(0.0, 1e-5) - at(0.0, -1e-5), 0.0);
        let found = model().slip_direction(&f).unwrap();
        assert!((found.velocity + slope.normalize()).norm() < 1e-6, "{f:?} {found:?}");
        assert_eq!(found.spin, 0.0);
    }
    // Along a direction, of which the other component is zero.
    let straight = AnisotropicCoulomb::new([Vector3::x(), Vector3::y()], COEFFICIENTS).unwrap();
    for along in [Vector3::x(), -Vector3::y()] {
        let found = straight.slip_direction(&ContactForce::new(1.0, along * 3.0, 0.0)).unwrap();
        assert_eq!(found.velocity, -along);
    }
    let none = ContactForce::new(1.0, Vector3::zeros(), 0.0);
    assert_eq!(model().slip_direction(&none), None);
    for size in [1e-300, 1e300] {
        let f = ContactForce::new(1.0, directions()[0] * size, 0.0);
        let found = model().slip_direction(&f).unwrap();
        assert!((found.velocity + directions()[0]).norm() < 1e-14, "{found:?}");
    }
}

/// What lies outside the plane of the directions counts as if along the lower coefficient, or for more by
/// the root of three at most.
#[test]
fn what_is_out_of_the_plane_counts_against_the_lower_coefficient() {
    let lower = Coulomb::new(0.3).unwrap();
    for (inside, outside) in [(0.0, 1.0), (0.5, 0.3), (-0.5, 0.3), (0.2, -1.0)] {
        for along in [Vector3::z(), Vector3::z() + directions()[1] * 0.0] {
            let f = ContactForce::new(10.0, directions()[1] * inside + along * outside, 0.0);
            let used = model().slip_margin(&f).utilisation;
            let least = lower.slip_margin(&f).utilisation;
            let most = inside.hypot(3.0_f64.sqrt() * outside) / 3.0;
            assert!(used >= least - 1e-14 && used <= most + 1e-14, "{f:?} {least} {used} {most}");
            // Its sign is kept by a projection, which comes back into the plane.
            let strong = ContactForce::new(0.1, *f.tangential, 0.0);
            let found = model().project(&strong);
            assert!(
                found.tangential.z.abs() < 1e-15 && found.tangential.dot(&directions()[1]) * inside >= 0.0
            );
        }
    }
}

/// At any size of the force.
#[test]
fn what_is_out_of_the_plane_counts_at_any_scale() {
    let at = |scale: f64| {
        let tangential = directions()[0] * 0.5 + Vector3::z();
        model().slip_margin(&ContactForce::new(10.0 * scale, tangential * scale, 0.0)).utilisation
    };
    for scale in [2.0_f64.powi(-900), 2.0_f64.powi(-60), 2.0_f64.powi(60), 2.0_f64.powi(900)] {
        assert!((at(scale) / at(1.0) - 1.0).abs() < 1e-14, "{scale:e}: {} {}", at(scale), at(1.0));
    }
}

#[test]
fn the_lower_coefficient_comes_first() {
    let [one, two] = directions();
    for (given, coefficients) in [([one, two], [0.9, 0.3]), ([two, one], [0.3, 0.9])] {
        let model = AnisotropicCoulomb::new(given, coefficients).unwrap();
        assert_eq!((model.coefficients(), model.directions()), ([0.3, 0.9], [two, one]));
    }
    let round = AnisotropicCoulomb::new([two, one], [0.5, 0.5]).unwrap();
    assert_eq!(round.directions(), [two, one]);
    for bad in [0.0, -0.1, f64::INFINITY] {
        assert!(AnisotropicCoulomb::new(directions(), [bad, 0.3]).is_err());
        assert!(AnisotropicCoulomb::new(directions(), [0.3, bad]).is_err());
    }
    for bad in [[one, two * 1.001], [one * 0.999, two], [one, one], [one, (two + one * 1e-3).normalize()]] {
        assert!(AnisotropicCoulomb::new(bad, [0.9, 0.3]).is_err());
    }
}

#[test]
fn what_is_not_finite_holds_nothing() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for f in [
            ContactForce::new(bad, Vector3::x(), 0.0),
            ContactForce::new(bad, Vector3::zeros(), 0.0),
            ContactForce::new(4.0, Vector3::new(0.0, bad, 0.0), 0.0),
        ] {
            let margin = model().slip_margin(&f);
            assert_eq!((margin.newtons, margin.utilisation), (-f64::MAX, f64::MAX), "{f:?}");
            assert!(!model().holds(&f), "{f:?}");
            assert_eq!(model().project(&f), ContactForce::zero(), "{f:?}");
            assert_eq!(model().slip_direction(&f), None, "{f:?}");
        }
        // A spin is not limited, but one that is no number is no force.
        assert_eq!(model().project(&ContactForce::new(4.0, Vector3::x(), bad)), ContactForce::zero());
    }
    // Without load and without pressing nothing is used; without load, pulling, all is.
    let margin = |normal: f64| model().slip_margin(&ContactForce::new(normal, Vector3::zeros(), 0.0));
    assert_eq!((margin(0.0).newtons, margin(0.0).utilisation), (0.0, 0.0));
    assert_eq!((margin(-2.0).newtons, margin(-2.0).utilisation), (-2.0, f64::MAX));
    assert_eq!(margin(2.0).utilisation, 0.0);
}
