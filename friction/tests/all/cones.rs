//! Margins, projections and grip forces of the cones against a search over the cone, with norms of the load
//! that are written down anew.

use fingertip_friction::testing::Draws;
use fingertip_friction::{
    Coulomb, FrictionLimit, FrictionModel, LimitCurve, PowerLimit, PressureDistribution, SoftFingerLimit,
};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;

const ARM: f64 = 3e-3;

struct Case {
    model: Box<dyn FrictionLimit<f64>>,
    coefficient: f64,
    /// Exponent of the norm of tangential force and spin; `None` where spin does not count.
    exponent: Option<f64>,
}

impl Case {
    fn load(&self, force: &ContactForce<f64>) -> f64 {
        let (t, s) = (force.tangential.vector().norm(), (force.spin / ARM).abs());
        self.exponent.map_or(t, |q| (t.powf(q) + s.powf(q)).powf(1.0 / q))
    }
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for coefficient in [0.2, 0.9, 1.0, 4.0] {
        let model = Box::new(Coulomb::new(coefficient).unwrap());
        cases.push(Case { model, coefficient, exponent: None });
        let model = Box::new(SoftFingerLimit::new(coefficient, ARM).unwrap());
        cases.push(Case { model, coefficient, exponent: Some(2.0) });
        for exponent in [1.0, 1.3, 1.725] {
            let model = Box::new(PowerLimit::new(coefficient, ARM, exponent).unwrap());
            cases.push(Case { model, coefficient, exponent: Some(exponent) });
        }
    }
    cases
}

fn force(normal: f64, one: f64, two: f64, spin: f64) -> ContactForce<f64> {
    ContactForce::new(normal, Vector3::new(one, two, 0.0), spin)
}

/// Distance of a load and normal force to the edge `(μs, s)`, `s ≥ 0`, by trisection: it has one minimum.
fn distance_to_edge(load: f64, normal: f64, coefficient: f64) -> (f64, f64) {
    let distance = |s: f64| (load - coefficient * s).hypot(normal - s);
    let (mut low, mut high) = (0.0, 4.0 * (load + normal.abs()) + 1.0);
    for _ in 0..200 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if distance(a) <= distance(b) { high = b } else { low = a }
    }
    (distance(low), low)
}

#[test]
fn margins_and_utilisation_match_a_search() {
    let mut draws = Draws::new(91);
    for case in cases() {
        for _ in 0..300 {
            let f: ContactForce<f64> = draws.force(ARM);
            let load = case.load(&f);
            let margin = case.model.slip_margin(&f);
            let inside = load <= case.coefficient * f.normal;
            let (distance, _) = distance_to_edge(load, f.normal, case.coefficient);
            let wanted = if inside { distance } else { -distance };
            // The search stops where the distance is flat to rounding.
            assert!((margin.newtons - wanted).abs() < 1e-12, "{f:?} {margin:?} {wanted}");
            assert_eq!(case.model.holds(&f), margin.newtons >= 0.0);
            let used = match (f.normal > 0.0, load > 0.0) {
                (true, _) => load / (case.coefficient * f.normal),
                (false, false) if f.normal >= 0.0 => 0.0,
                _ => f64::MAX,
            };
            assert!((margin.utilisation / used - 1.0).abs() < 1e-13 || margin.utilisation == used, "{f:?}");
            let safety = case.model.factor_of_safety(&f);
            let wanted = if used == f64::MAX {
                0.0
            } else if used > 0.0 {
                1.0 / used
            } else {
                f64::MAX
            };
            assert!((safety - wanted).abs() <= 1e-13 * wanted, "{f:?} {safety} {wanted}");
        }
    }
}

#[test]
fn projections_match_a_search() {
    let mut draws = Draws::new(92);
    for case in cases() {
        for _ in 0..300 {
            let f: ContactForce<f64> = draws.force(ARM);
            let (load, found) = (case.load(&f), case.model.project(&f));
            let (tangential, spin) = (*f.tangential, if case.exponent.is_some() { f.spin } else { 0.0 });
            let (factor, normal) = if load <= case.coefficient * f.normal {
                (1.0, f.normal)
            } else {
                let (_, normal) = distance_to_edge(load, f.normal, case.coefficient);
                (if load > 0.0 { case.coefficient * normal / load } else { 0.0 }, normal)
            };
            // The place of a minimum is known to the root of the rounding of its value.
            let close = |a: f64, b: f64| (a - b).abs() < 3e-6;
            assert!(close(found.normal, normal), "{f:?} {found:?} {normal}");
            assert!((found.tangential.vector() - tangential * factor).norm() < 1e-5, "{f:?} {found:?}");
            assert!(close(found.spin / ARM, spin / ARM * factor), "{f:?} {found:?}");
            // Twice is once.
            let again = case.model.project(&found);
            assert!((again.normal - found.normal).abs() < 1e-13 * (1.0 + found.normal));
        }
    }
}

#[test]
fn grip_forces_are_just_enough() {
    let mut draws = Draws::new(93);
    for case in cases() {
        for _ in 0..300 {
            let f: ContactForce<f64> = draws.force(ARM);
            let load = case.load(&f);
            for safety in [1.0, 1.5, 4.0] {
                let least = case.model.least_normal_force(&f, safety);
                let wanted = safety * load / case.coefficient;
                assert!((least - wanted).abs() <= 1e-13 * wanted, "{f:?} {least} {wanted}");
            }
            for margin in [0.0, 0.25, 3.0] {
                let keeping = case.model.normal_force_keeping(&f, margin);
                let there = case.model.slip_margin(&ContactForce { normal: keeping, ..f }).newtons;
                assert!((there - margin).abs() < 1e-13 * (1.0 + load + keeping), "{f:?} {margin} {there}");
            }
            let none = case.model.normal_force_keeping(&f, 0.0);
            assert_eq!(case.model.normal_force_keeping(&f, -5.0), none);
        }
        for (load, greatest) in
            [(0.0, 0.0), (f64::NAN, f64::MAX), (f64::INFINITY, f64::MAX), (1e308, f64::MAX)]
        {
            let f = force(1.0, load, 0.0, 0.0);
            let least = case.model.least_normal_force(&f, 10.0);
            assert!(least == greatest || (load == 1e308 && least.is_finite()), "{load} {least}");
            assert!(case.model.normal_force_keeping(&f, 0.0) >= greatest.min(1e307));
        }
        // No safety asked, or less than none.
        assert_eq!(case.model.least_normal_force(&force(1.0, 1.0, 0.0, 0.0), 0.0), 0.0);
        assert_eq!(case.model.least_normal_force(&force(1.0, 1.0, 0.0, 0.0), -1.0), 0.0);
    }
}

/// The slip direction is against the gradient of the utilisation, by differences.
#[test]
fn slip_is_against_the_gradient() {
    let mut draws = Draws::new(94);
    for case in cases() {
        let arm = if case.exponent.is_some() { ARM } else { 0.0 };
        for _ in 0..200 {
            let f: ContactForce<f64> = draws.force(arm);
            let (t, s) = (f.tangential.vector().norm(), (f.spin / ARM).abs());
            if t < 0.1 || (arm > 0.0 && (s < 0.1 || (case.exponent == Some(1.0) && (t - s).abs() < 0.1))) {
                continue;
            }
            let used = |d: f64, one: f64, two: f64, spin: f64| {
                let there = ContactForce::new(
                    1.0,
                    *f.tangential + Vector3::new(one * d, two * d, 0.0),
                    f.spin + spin * d * ARM,
                );
                case.model.slip_margin(&there).utilisation
            };
            let slope = |one, two, spin| (used(1e-5, one, two, spin) - used(-1e-5, one, two, spin)) / 2e-5;
            let gradient = Vector3::new(slope(1.0, 0.0, 0.0), slope(0.0, 1.0, 0.0), slope(0.0, 0.0, 1.0));
            let wanted = -gradient.normalize();
            let found = case.model.slip_direction(&f).unwrap();
            let found = Vector3::new(found.velocity.x, found.velocity.y, found.spin * arm);
            assert!((found - wanted).norm() < 1e-6, "{f:?} {found:?} {wanted:?}");
        }
        assert_eq!(case.model.slip_direction(&force(1.0, 0.0, 0.0, 0.0)), None);
        for bad in [f64::NAN, f64::INFINITY] {
            for f in [force(1.0, bad, 0.0, 0.0), force(bad, 1.0, 0.0, 0.0), force(1.0, 1.0, 0.0, bad)] {
                assert_eq!(case.model.slip_direction(&f), None, "{f:?}");
            }
        }
        // At the ends of the range it is unit all the same.
        for size in [1e-300, 1e300] {
            let v = case.model.slip_direction(&force(1.0, 3.0 * size, -4.0 * size, 0.0)).unwrap().velocity;
            assert!((v - Vector3::new(-0.6, 0.8, 0.0)).norm() < 1e-15, "{v:?}");
        }
    }
    // Spin alone: none of it slides.
    for (model, spin) in
        [(SoftFingerLimit::new(0.5, ARM).unwrap(), 2.0), (SoftFingerLimit::new(0.5, ARM).unwrap(), -2.0)]
    {
        let found = model.slip_direction(&force(1.0, 0.0, 0.0, spin)).unwrap();
        assert_eq!(found.velocity, Vector3::zeros());
        assert!((found.spin + spin.signum() / ARM).abs() < 1e-12 / ARM, "{found:?}");
    }
    let power = PowerLimit::new(0.5, ARM, 1.5).unwrap();
    assert_eq!(power.slip_direction(&force(1.0, 0.0, 0.0, 2.0)).unwrap().velocity, Vector3::zeros());
}

#[test]
fn what_is_not_finite_holds_nothing() {
    for case in cases() {
        let spins = case.exponent.is_some();
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for f in [force(bad, 1.0, 0.0, 0.0), force(4.0, 0.0, bad, 0.0), force(4.0, 0.1, 0.0, bad)] {
                if !spins && !f.spin.is_finite() {
                    continue;
                }
                let margin = case.model.slip_margin(&f);
                assert_eq!((margin.newtons, margin.utilisation), (-f64::MAX, f64::MAX), "{f:?}");
                assert!(!case.model.holds(&f));
                assert_eq!(case.model.factor_of_safety(&f), 0.0);
                assert_eq!(case.model.project(&f), ContactForce::zero(), "{f:?}");
            }
        }
    }
}

/// Scaled by powers of two to the ends of the range, answers scale exactly.
#[test]
fn answers_scale_to_the_ends_of_the_range() {
    let mut draws = Draws::new(95);
    for case in cases() {
        for _ in 0..50 {
            let f: ContactForce<f64> = draws.force(ARM);
            let plain = case.model.slip_margin(&f);
            for factor in [2.0_f64.powi(-900), 2.0_f64.powi(-500), 2.0_f64.powi(500), 2.0_f64.powi(1000)] {
                let far = ContactForce::new(f.normal * factor, *f.tangential * factor, f.spin * factor);
                let found = case.model.slip_margin(&far);
                let error = (found.newtons / factor - plain.newtons).abs();
                assert!(error <= 1e-14 * (1.0 + case.load(&f) + f.normal.abs()) * 8.0, "{f:?} {factor:e}");
                assert!((found.utilisation - plain.utilisation).abs() <= 1e-13 * plain.utilisation);
            }
        }
    }
}

#[test]
fn a_model_behind_a_reference_is_the_model() {
    fn through<M: FrictionLimit<f64>>(model: M, f: &ContactForce<f64>) -> String {
        format!(
            "{:?} {} {} {:?} {:?} {}",
            model.slip_margin(f),
            model.least_normal_force(f, 2.0),
            model.normal_force_keeping(f, 0.3),
            model.project(f),
            model.slip_direction(f),
            model.holds(f)
        )
    }
    let model = SoftFingerLimit::new(0.5, ARM).unwrap();
    for f in [force(1.0, 2.0, 0.5, 1e-3), force(9.0, 2.0, 0.5, 1e-3)] {
        let reference: &dyn FrictionLimit<f64> = &model;
        assert_eq!(through(reference, &f), through(model, &f));
    }
}

/// The shrunk ellipse lies inside the exact limit, and a wider one would not.
#[test]
fn the_conservative_ellipse_lies_inside_the_exact_limit() {
    let model = SoftFingerLimit::conservative(0.5, ARM).unwrap();
    assert_eq!(model.arm(), ARM);
    let mut least = f64::INFINITY;
    for pressure in
        [PressureDistribution::Uniform, PressureDistribution::Hertz, PressureDistribution::Winkler]
    {
        for point in LimitCurve::new(pressure).table(41) {
            // The exact limit for 1 N.
            let f = force(1.0, 0.5 * point.force, 0.0, 0.5 * ARM * point.torque);
            least = least.min(model.slip_margin(&f).utilisation);
        }
    }
    assert!((1.0 - 1e-6..1.003).contains(&least), "{least}");
    assert_eq!(SoftFingerLimit::new(0.5, ARM).unwrap().coefficient(), 0.5);
    let power = PowerLimit::new(0.5, ARM, 1.5).unwrap();
    assert_eq!((power.coefficient(), power.arm(), power.exponent()), (0.5, ARM, 1.5));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(SoftFingerLimit::new(bad, ARM).is_err() && SoftFingerLimit::new(0.5, bad).is_err());
        assert!(PowerLimit::new(bad, ARM, 1.5).is_err() && PowerLimit::new(0.5, bad, 1.5).is_err());
        assert!(PowerLimit::new(0.5, ARM, bad).is_err());
    }
    assert!(PowerLimit::new(0.5, ARM, 0.99).is_err() && PowerLimit::new(0.5, ARM, 2.01).is_err());
}

/// On the limit itself it holds, and is projected to itself.
#[test]
fn the_limit_is_included() {
    let model = Coulomb::new(0.75).unwrap();
    let edge = force(4.0, 3.0, 0.0, 0.0);
    assert!(model.holds(&edge) && model.slip_margin(&edge).newtons == 0.0);
    assert_eq!(model.project(&edge), edge);
    // What holds is left as it is, to the last digit.
    for normal in [0.1, 0.7, 1.3, 5.9, 11.1] {
        let model = Coulomb::new(0.6).unwrap();
        let edge = force(normal, 0.6 * normal, 0.0, 0.0);
        assert_eq!(model.project(&edge), edge);
    }
    // On a rhombus, a tangential force alone slides without spin.
    let rhombus = PowerLimit::new(0.75, ARM, 1.0).unwrap();
    let found = rhombus.slip_direction(&edge).unwrap();
    assert_eq!((found.velocity, found.spin), (-Vector3::x(), 0.0));
}

#[test]
fn angles_of_coulomb() {
    let model = Coulomb::new(0.75).unwrap();
    assert_eq!(model.coefficient(), 0.75);
    for angle in [0.0_f64, 0.3, 1.0, 1.5, 2.0, 3.0] {
        let found = model.angle_margin(&force(2.0 * angle.cos(), 2.0 * angle.sin(), 0.0, 0.0));
        assert!((found - (0.75_f64.atan() - angle)).abs() < 1e-15, "{angle} {found}");
    }
    for bad in [force(f64::NAN, 1.0, 0.0, 0.0), force(1.0, f64::NAN, 0.0, 0.0)] {
        assert_eq!(model.angle_margin(&bad), -core::f64::consts::FRAC_PI_2);
    }
}
