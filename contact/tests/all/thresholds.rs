//! What models, laws and bounds take, to the last number, and what they refuse.

use fingertip_contact::*;
use fingertip_surfaces::{BadShape, Sphere, Torus};
use fingertip_wrench::Wrench;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

const LEAST: f64 = f64::MIN_POSITIVE;
const NEGATIVE: f64 = -5e-324;
const BAD: [f64; 4] = [NEGATIVE, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[track_caller]
fn takes<S>(make: impl Fn(f64) -> Result<S, BadShape>, good: &[f64], bad: &[f64], parameter: &str) {
    for x in good {
        assert!(make(*x).is_ok(), "{x:e}: {}", make(*x).err().unwrap());
    }
    for x in bad {
        let refused = make(*x).err().unwrap_or_else(|| panic!("{x:e} as {parameter}"));
        assert_eq!(refused.parameter, parameter, "{x:e}");
        assert!(!refused.requirement.is_empty() && !refused.shape.is_empty());
    }
}

fn point() -> PointContact<f64> {
    PointContact::new(0.0).unwrap()
}

#[test]
fn of_models() {
    let any = [0.0, 5e-324, 1.0, f64::MAX];
    takes(PointContact::new, &any, &BAD, "least force");
    takes(SoftFinger::new, &any, &BAD, "least force");
    takes(|gap| point().with_greatest_gap(gap), &any, &BAD, "greatest gap");
    takes(|mu| point().with_greatest_friction(mu), &any, &BAD, "greatest friction");
    let full = point().with_greatest_gap(0.5).and_then(|m| m.with_greatest_friction(0.25)).unwrap();
    assert_eq!((full.least_force(), full.greatest_gap(), full.greatest_friction()), (0.0, 0.5, Some(0.25)));
    let auto = Auto::new(point(), SoftFinger::new(0.0).unwrap(), Matrix6::identity()).unwrap();
    takes(
        |t| auto.with_threshold(t),
        &[5e-324, 3.8, f64::MAX],
        &[0.0, -1.0, f64::NAN, f64::INFINITY],
        "threshold",
    );
    takes(|p| auto.with_greatest_pitch(p, 3.0), &any[..3], &BAD, "greatest pitch");
    takes(|d| auto.with_greatest_pitch(0.01, d), &any[..3], &BAD, "greatest pitch");
    let skin = |share| Compliant::new(point(), LinearStiffness::new(1.0, 1.0).unwrap()).with_share(share);
    let beyond = [NEGATIVE, 1.0_f64.next_up(), f64::NAN];
    takes(skin, &[0.0, 0.5, 1.0], &beyond, "share of the indentation");
    let fusion = |mu| Fusion::new(Matrix6::identity(), mu);
    takes(fusion, &[5e-324, 0.5, 10.0], &[0.0, -1.0, f64::NAN, f64::INFINITY], "friction coefficient");
}

#[test]
fn of_skins() {
    let greatest = 1.0 / LEAST;
    let bad = [0.0, -1.0, LEAST.next_down(), greatest.next_up(), f64::NAN, f64::INFINITY];
    takes(|k| LinearStiffness::new(k, 1.0), &[LEAST, 1.0, greatest], &bad, "stiffness");
    takes(|r| LinearStiffness::new(1.0, r), &[LEAST, 1.0, greatest], &bad, "radius");
    takes(|c| PowerLaw::new([c, 0.3], [1.0, 0.5]), &[LEAST, 1.0], &bad, "lengths at 1 N");
    takes(|c| PowerLaw::new([1.0, 0.3], [c, 0.5]), &[LEAST, 1.0], &bad, "lengths at 1 N");
    let exponents = [5e-324, 0.5, 1.0];
    let beyond = [0.0, -0.5, 1.0_f64.next_up(), f64::NAN];
    takes(|e| PowerLaw::new([1.0, e], [1.0, 0.5]), &exponents, &beyond, "exponents");
    takes(|e| PowerLaw::new([1.0, 0.5], [1.0, e]), &exponents, &beyond, "exponents");
    let hertz = |modulus| Hertz::sphere(0.01, modulus);
    takes(hertz, &[1e-3, 1e6, 1e12], &[0.0, -1.0, f64::NAN, f64::INFINITY], "contact modulus");
    let thin = f64::EPSILON.sqrt();
    for radii in [|r| [r, 1.0], |r| [1.0, r]] {
        let hertz = |r: f64| Hertz::new(radii(r), 1e6);
        takes(
            hertz,
            &[thin, 1.0, 1.0 / thin],
            &[thin.next_down(), (1.0 / thin).next_up(), 0.0, f64::NAN],
            "radii of curvature",
        );
    }
    takes(|r| Hertz::new([r, r], 1e-300), &[], &[1e300], "radii and modulus");
    let local = |r| LocalHertz::new(1e6, 0.0, r);
    takes(local, &[1e-3, 1.0], &[0.0, -1.0, f64::NAN], "radii of curvature");
    takes(
        |c| LocalHertz::new(1e6, c, 0.1),
        &[-5.0, 0.0, 5.0],
        &[f64::NAN, f64::INFINITY],
        "curvature of the object",
    );
}

#[test]
fn of_two_bodies() {
    let young = |e| contact_modulus([e, 1e6], [0.3, 0.3]);
    let bad = [0.0, -1.0, f64::NAN];
    takes(young, &[5e-300, 1.0, f64::INFINITY], &bad, "elastic constants");
    let poisson = |nu| contact_modulus([1e6, f64::INFINITY], [nu, 0.3]);
    takes(
        poisson,
        &[(-1.0_f64).next_up(), 0.0, 0.5],
        &[-1.0, 0.5_f64.next_up(), f64::NAN],
        "elastic constants",
    );
    takes(|nu| contact_modulus([1e6, 1e6], [0.3, nu]), &[0.5], &[-1.0, 0.6], "elastic constants");
    assert!(contact_modulus([f64::INFINITY; 2], [0.3; 2]).is_err());
    // Of two alike, each gives way by as much.
    let both: f64 = contact_modulus([2e6, 2e6], [0.5, 0.5]).unwrap();
    assert!((both - 1e6 / 0.75).abs() < 1e-9 * both);
    let one: f64 = contact_modulus([2e6, f64::INFINITY], [0.5, 0.1]).unwrap();
    assert!((one - 2e6 / 0.75).abs() < 1e-9 * one);
}

#[test]
fn of_tables() {
    let of = |points: [[f64; 3]; 2]| Tabulated::new(points);
    let good = [[1.0, 0.1, 0.2], [2.0, 0.1, 0.2]];
    assert!(of(good).is_ok());
    // Of the first row, forces above zero; of others, above those before; depths and radii may stay.
    assert!(of([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]).is_ok());
    for (row, column, value) in [
        (0, 0, 0.0),
        (1, 0, 1.0),
        (0, 1, NEGATIVE),
        (1, 1, 0.1_f64.next_down()),
        (0, 2, NEGATIVE),
        (1, 2, 0.2_f64.next_down()),
        (1, 0, f64::INFINITY),
        (1, 1, f64::INFINITY),
        (1, 2, f64::NAN),
    ] {
        let mut points = good;
        points[row][column] = value;
        assert_eq!(of(points).unwrap_err().parameter, "points", "{row} {column} {value}");
    }
}

#[test]
fn of_uncertainties() {
    let zero = GeometryUncertainty::<f64>::none();
    assert_eq!(zero.checked(), Ok(zero));
    takes(|offset| GeometryUncertainty { offset, ..zero }.checked(), &[0.0, 5e-324], &BAD, "offset");
    let turned =
        |variance| GeometryUncertainty { attitude: Matrix3::identity() * variance, ..zero }.checked();
    takes(turned, &[0.0, 1.0], &BAD, "attitude");
    let moved = |variance| GeometryUncertainty { position: Matrix3::identity() * variance, ..zero }.checked();
    takes(moved, &[0.0, 1.0], &BAD, "position");
    takes(|e| PaperBounds::new(0.013, e), &[0.0, 5e-324, 0.5], &BAD, "relative error");
    takes(|r| PaperBounds::new(r, 0.01), &[LEAST, 1.0], &[0.0, -1.0, f64::NAN], "radius");
    let noise = |x| WrenchNoise::new(Vector6::repeat(x), 0.0);
    takes(noise, &[0.0, 1.0], &BAD, "standard deviations");
    takes(|x| WrenchNoise::new(Vector6::zeros(), x), &[0.0, 1.0], &BAD, "standard deviations");
}

/// A force as strong as the threshold is a contact, one weaker by the last digit is not.
#[test]
fn of_forces() {
    let sphere = Sphere::centred(0.5).unwrap();
    for least in [0.125, 1.0, 3.0] {
        let model = PointContact::new(least).unwrap();
        let soft = SoftFinger::new(least).unwrap();
        for (strength, found) in [(least, true), (least * (1.0 - 1e-15), false)] {
            let push = Wrench::from_force_at(&Vector3::zeros(), Vector3::z() * -strength);
            for resolution in [model.resolve(&push, &sphere), soft.resolve(&push, &sphere)] {
                assert_eq!(resolution.contact().is_some(), found, "{strength}: {resolution:?}");
                if let Err(reason) = resolution.into_result() {
                    assert_eq!(reason, NoContact::BelowThreshold { force: strength });
                }
            }
        }
    }
}

/// On a shape without a short way, too.
#[test]
fn a_force_at_the_threshold_is_a_contact_on_a_ring() {
    let ring = Torus::new(0.01, 0.003).unwrap();
    let model = PointContact::new(0.5).unwrap();
    for (force, touches) in [(0.5, true), (0.5 + f64::EPSILON, true), (0.5 - f64::EPSILON, false)] {
        let push = Wrench::from_force_at(&Vector3::new(0.01, 0.0, 0.003), Vector3::new(0.0, 0.0, -force));
        assert_eq!(model.resolve(&push, &ring).contact().is_some(), touches, "{force}");
    }
}
