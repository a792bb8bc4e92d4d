//! What skins give way, against closed forms and differences.

use fingertip_contact::*;
use fingertip_surfaces::{Cylinder, Ellipsoid, Plane, SmoothSurface, Sphere};
use nalgebra::Vector3;

fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-12 * expected.abs()
}

/// `compliance` is the slope of the depth, by differences.
fn slopes(name: &str, indentation: impl Fn(f64) -> Indentation<f64>, compliance: impl Fn(f64) -> f64) {
    for force in [0.03, 0.4, 1.7, 6.0, 25.0] {
        let step = force * 1e-5;
        let depth = |force| indentation(force).depth;
        let slope = (depth(force + step) - depth(force - step)) / (2.0 * step);
        assert!((compliance(force) / slope - 1.0).abs() < 1e-8, "{name} {force}: {slope}");
        let [a, b] = indentation(force).patch;
        assert!(a >= b && b > 0.0, "{name}");
    }
    let nothing = indentation(0.0);
    assert_eq!((nothing.depth, nothing.patch), (0.0, [0.0; 2]), "{name}");
}

#[test]
fn laws_are_what_they_say() {
    let spring = LinearStiffness::new(2000.0, 0.01).unwrap();
    let found = spring.indentation(4.0);
    assert!(near(found.depth, 0.002) && near(found.patch[0], (2.0_f64 * 0.01 * 0.002).sqrt()));
    assert_eq!(found.patch[0], found.patch[1]);
    let power = PowerLaw::new([0.003, 0.25], [0.001, 0.5]).unwrap();
    let found = power.indentation(16.0);
    assert!(near(found.depth, 0.004) && near(found.patch[0], 0.006) && near(found.patch[1], 0.006));
    assert_eq!(power.indentation(-1.0).depth, 0.0);
    let hertz = Hertz::new([0.01, 0.03], 2e6).unwrap();
    let table = Tabulated::new([[1.0, 0.1, 0.2], [4.0, 0.3, 0.3], [9.0, 0.9, 0.5]]).unwrap();
    slopes("spring", |force| spring.indentation(force), |force| spring.compliance(force));
    slopes("power", |force| power.indentation(force), |force| power.compliance(force));
    slopes("hertz", |force| hertz.indentation(force), |force| hertz.compliance(force));
    slopes("table", |force| table.indentation(force), |force| table.compliance(force));
    // Beyond a table, and in the range of the type.
    let beyond = table.indentation(f64::MAX);
    assert!(beyond.depth <= f64::MAX && beyond.depth > 1e300 && beyond.patch[1] > 1e300);
    let steep = PowerLaw::new([1e300, 1.0], [1e300, 1.0]).unwrap().indentation(1e300);
    assert_eq!((steep.depth, steep.patch), (f64::MAX, [f64::MAX; 2]));
    // What has no force gives way by no compliance but a linear one.
    assert_eq!(PowerLaw::new([1.0, 0.5], [2.0, 1.0]).unwrap().compliance(0.0), 2.0);
    assert_eq!(hertz.compliance(0.0), f64::INFINITY);
}

/// Johnson 1985, (4.22)-(4.24): `a³ = 3FR/4E*`, `δ = a²/R`, `p₀ = 3F/2πa²`.
#[test]
fn hertz_of_spheres_is_in_closed_form() {
    for (radius, modulus, force) in [(0.013_f64, 1e6_f64, 2.0_f64), (1e-3, 7e10, 100.0), (5.0, 1e3, 0.01)] {
        let law = Hertz::sphere(radius, modulus).unwrap();
        let a = (3.0 * force * radius / (4.0 * modulus)).cbrt();
        let found = law.indentation(force);
        assert!(near(found.patch[0], a) && near(found.patch[1], a) && near(found.depth, a * a / radius));
        let pressure = 1.5 * force / (core::f64::consts::PI * a * a);
        assert!(near(law.peak_pressure(force), pressure));
        assert_eq!((law.peak_pressure(0.0), law.peak_pressure(-1.0)), (0.0, 0.0));
    }
}

/// `R_F(0, k², 1)`, `R_D(0, k², 1)/3` and `R_D(0, 1, k²)/3` by the arithmetic-geometric mean, another way than
/// Carlson's: with `K` and `E` of the modulus² `m = 1 − k²` they are `K`, `(K − E)/m` and `(E/k² − K)/m`.
/// `1 − E/K = Σ 2ⁿ⁻¹ cₙ²` begins with `m/2`, so that nothing cancels.
fn complete_integrals(k: f64) -> [f64; 3] {
    let m = (1.0 - k) * (1.0 + k);
    let (mut a, mut g, mut rest, mut power) = (1.0, k, 0.0, 1.0);
    for _ in 0..40 {
        let c = (a - g) * 0.5;
        (a, g) = ((a + g) * 0.5, (a * g).sqrt());
        rest += power * c * c;
        power *= 2.0;
    }
    let whole = core::f64::consts::FRAC_PI_2 / a;
    let share = rest / m;
    [whole, whole * (0.5 + share), whole * (0.5 - share) / (k * k)]
}

/// Johnson 1985, (4.28)-(4.32), with Legendre's integrals, down to radii as unequal as may be.
#[test]
fn hertz_of_unequal_radii_obeys_its_equations() {
    for ratio in [0.999_999, 0.99, 0.9, 0.5, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1.6e-8] {
        let (long, short, modulus, force) = (0.02, 0.02 * ratio, 1.5e6, 3.0);
        for radii in [[long, short], [short, long]] {
            let law = Hertz::new(radii, modulus).unwrap();
            let Indentation { depth, patch: [a, b] } = law.indentation(force);
            let k = b / a;
            let [whole, d, e] = complete_integrals(k);
            assert!((e / d * ratio - 1.0).abs() < 2e-14, "{ratio}: {k} {:e}", e / d * ratio - 1.0);
            let pressure = 1.5 * force / (core::f64::consts::PI * a * b);
            assert!((law.peak_pressure(force) / pressure - 1.0).abs() < 1e-14);
            // 1/2R = p₀ b/(E* a²)·d
            let width = pressure * b / (modulus * a * a) * d * 2.0 * long;
            assert!((width - 1.0).abs() < 1e-14, "{ratio}: {:e}", width - 1.0);
            let deep = pressure * b * whole / modulus / depth;
            assert!((deep - 1.0).abs() < 1e-14, "{ratio}: {:e}", deep - 1.0);
        }
    }
}

/// The same in single precision, with the double's answer for the numbers it has.
/// From round to unequal without a step: to first order the law is that of the geometric mean of the radii.
#[test]
fn nearly_equal_radii_are_nearly_a_sphere() {
    fn check<T: fingertip_wrench::Real>() {
        for exponent in 1..60 {
            let apart = 2.0_f64.powi(-exponent);
            let radii = [T::literal(0.013), T::literal(0.013 * (1.0 - apart))];
            let law = Hertz::new(radii, T::literal(2e6)).unwrap().indentation(T::one());
            let mean = T::literal((0.013_f64 * 0.013 * (1.0 - apart)).sqrt());
            let round = Hertz::sphere(mean, T::literal(2e6)).unwrap().indentation(T::one());
            let off = (law.depth / round.depth).to_f64() - 1.0;
            assert!(off.abs() <= 0.2 * apart * apart + 16.0 * T::EPSILON.to_f64(), "{exponent}: {off:e}");
        }
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn hertz_in_single_precision_is_that_of_double() {
    for ratio in [1.0, 0.999, 0.7, 0.2, 0.03, 1e-3, 4e-4_f32] {
        let law = Hertz::<f32>::new([0.02 * ratio, 0.02], 1.5e6).unwrap().indentation(3.0);
        let exact =
            Hertz::new([f64::from(0.02 * ratio), f64::from(0.02_f32)], 1.5e6).unwrap().indentation(3.0);
        let near = |found: f32, exact: f64| (f64::from(found) / exact - 1.0).abs() < 2e-6;
        assert!(near(law.depth, exact.depth), "{ratio} {law:?} {exact:?}");
        assert!(
            near(law.patch[0], exact.patch[0]) && near(law.patch[1], exact.patch[1]),
            "{law:?} {exact:?}"
        );
    }
}

/// What cannot be represented is no law, and says of what.
#[test]
fn hertz_refuses_what_it_cannot_represent() {
    let refused = |radii, modulus| Hertz::<f64>::new(radii, modulus).unwrap_err().to_string();
    for radii in [[0.0, 1.0], [1.0, -1.0], [f64::NAN, 1.0], [1.0, f64::INFINITY]] {
        assert!(refused(radii, 1e6).contains("radii of curvature"), "{radii:?}");
    }
    assert!(refused([1.0, 1e-9], 1e6).contains("comparable"));
    for modulus in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(refused([0.01, 0.01], modulus).contains("contact modulus"), "{modulus}");
    }
    // The patch or the depth would be beyond all numbers, or the patch zero.
    for (radius, modulus) in [(1e100, 1e-300), (0.01, 1e308)] {
        assert!(refused([radius; 2], modulus).contains("represented"), "{radius:e} {modulus:e}");
    }
    for young in [[5e-324, 1e6], [0.0, 1e6], [1e6, -1.0], [f64::INFINITY; 2], [1e6, f64::NAN]] {
        assert!(contact_modulus(young, [0.3, 0.3]).is_err(), "{young:?}");
    }
    for poisson in [[-1.0, 0.3], [0.3, 0.500_001], [f64::NAN, 0.3]] {
        assert!(contact_modulus([1e6, 1e6], poisson).is_err(), "{poisson:?}");
    }
    assert_eq!(contact_modulus([f64::INFINITY, 3e6], [0.5, 0.5]).unwrap(), 4e6);
}

/// Where the fingertip is a sphere, a cylinder or flat, with the curvature of the object added.
#[test]
fn local_hertz_takes_the_curvature_where_it_touches() {
    let contact = |point: Vector3<f64>, normal: Vector3<f64>| Contact {
        point,
        normal,
        force: normal * -1.0,
        spin_torque: 0.0,
        gap: 0.0,
        alternatives: 0,
        searched: false,
    };
    let z = Vector3::z();
    let law = |object, largest| LocalHertz::new(1e6, object, largest).unwrap();
    let depth = |found: Indentation<f64>, expected: Hertz<f64>| {
        let expected = expected.indentation(2.0);
        assert!((found.depth / expected.depth - 1.0).abs() < 1e-9, "{found:?} {expected:?}");
        assert!((found.patch[0] / expected.patch[0] - 1.0).abs() < 1e-9);
        assert!((found.patch[1] / expected.patch[1] - 1.0).abs() < 1e-9);
    };
    let sphere = Sphere::centred(0.01).unwrap();
    let top = contact(z * 0.01, z);
    for (object, radius) in [(0.0, 0.01), (100.0, 0.005), (-50.0, 0.02), (-100.0, 1.0), (-200.0, 1.0)] {
        depth(law(object, 1.0).indentation_at(&sphere, &top, 2.0), Hertz::sphere(radius, 1e6).unwrap());
    }
    let cylinder = Cylinder::new(Vector3::zeros(), Vector3::x(), 0.01).unwrap();
    depth(law(0.0, 0.5).indentation_at(&cylinder, &top, 2.0), Hertz::new([0.5, 0.01], 1e6).unwrap());
    depth(law(25.0, 0.5).indentation_at(&cylinder, &top, 2.0), Hertz::new([0.04, 0.008], 1e6).unwrap());
    let plane = Plane::new(z * 0.01, z).unwrap();
    depth(law(0.0, 0.5).indentation_at(&plane, &top, 2.0), Hertz::sphere(0.5, 1e6).unwrap());
    // At the end of an axis the radii are b²/a, in any frame.
    let ellipsoid = Ellipsoid::new(Vector3::new(0.02, 0.01, 0.03)).unwrap();
    let end = contact(z * 0.03, z);
    let radii = [0.02 * 0.02 / 0.03, 0.01 * 0.01 / 0.03];
    depth(law(0.0, 0.5).indentation_at(&ellipsoid, &end, 2.0), Hertz::new(radii, 1e6).unwrap());
    // How the depth changes from place to place, by walking there.
    let point = Vector3::new(0.02 * 0.36, 0.01 * 0.48, 0.03 * 0.8);
    let normal = ellipsoid.level(&point).normal().unwrap().0;
    let here = contact(point, normal);
    let slope = law(0.0, 0.5).slope_at(&ellipsoid, &here, 2.0);
    assert!(slope.along.dot(&normal).abs() < 1e-9 * slope.along.norm() && slope.along.norm() > 0.0);
    for along in [normal.cross(&Vector3::x()).normalize(), normal.cross(&Vector3::y()).normalize()] {
        let depth_at = |step: f64| {
            let there = point + along * step;
            let there = there / (1.0 + ellipsoid.level(&there).value);
            let normal = ellipsoid.level(&there).normal().unwrap().0;
            law(0.0, 0.5).indentation_at(&ellipsoid, &contact(there, normal), 2.0).depth
        };
        let expected = (depth_at(1e-6) - depth_at(-1e-6)) / 2e-6;
        assert!(
            (slope.along.dot(&along) - expected).abs() < 1e-4 * slope.along.norm(),
            "{slope:?} {expected}"
        );
    }
    let exact = Hertz::sphere(0.01, 1e6).unwrap().compliance(2.0);
    assert!((law(0.0, 1.0).slope_at(&sphere, &top, 2.0).by_force / exact - 1.0).abs() < 1e-9);
}
