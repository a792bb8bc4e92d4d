//! Which entry a point contact takes, and how exactly.

use crate::point_contact::*;
use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::{Line, Wrench};
use nalgebra::Vector3;

/// A line through a torus enters it twice.
#[test]
fn non_convex_shapes_give_all_candidates() {
    let ring = Torus::new(0.02, 0.005).unwrap();
    let wrench = Wrench::from_force_at(&v(0.0, 0.0, 0.001), v(-1.0, 0.0, 0.0));
    let mut points = Vec::new();
    model().candidates(&wrench, &ring, |contact| points.push(contact.point)).unwrap();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    assert_eq!(points.len(), 2);
    let side = 0.005_f64.hypot(0.0).mul_add(0.005, -1e-6).sqrt();
    assert!((points[0].x - (-0.02 + side)).abs() < 1e-15 && (points[1].x - (0.02 + side)).abs() < 1e-15);

    // Continuity with the last contact decides.
    for near in [v(-0.014, 0.0, 0.0), v(0.026, 0.001, 0.0)] {
        let contact = *model().resolve_near(&wrench, &ring, Some(&near)).contact().unwrap();
        assert!((contact.point - near).norm() < 0.005);
        assert_eq!(contact.alternatives, 1);
    }
    // Without it, the squarer one; both are equally square here but for rounding.
    assert_eq!(model().resolve(&wrench, &ring).contact().unwrap().alternatives, 1);
}

#[test]
fn friction_sets_candidates_aside() {
    let ring = Torus::new(0.02, 0.005).unwrap();
    // Through the tube at x = 0.02 far off its middle, and squarely at x = −0.02.
    let (a, b) = (v(-0.02, 0.0, 0.005), v(0.024, 0.0, 0.003));
    let force = (a - b).normalize();
    let wrench = Wrench::from_force_at(&b, force);
    let mut ratios = Vec::new();
    model().candidates(&wrench, &ring, |c| ratios.push(c.contact_force().friction_ratio().unwrap())).unwrap();
    assert_eq!(ratios.len(), 2, "{ratios:?}");
    ratios.sort_by(f64::total_cmp);
    let between = model().with_greatest_friction((ratios[0] + ratios[1]) / 2.0).unwrap();
    let contact = *between.resolve(&wrench, &ring).contact().unwrap();
    assert_eq!(contact.alternatives, 0);
    assert!((contact.contact_force().friction_ratio().unwrap() - ratios[0]).abs() < 1e-12);
    // Even if the last contact was near the other one.
    assert_eq!(between.resolve_near(&wrench, &ring, Some(&a)).contact(), Some(&contact));
    let strict = model().with_greatest_friction(ratios[0] * 0.5).unwrap();
    let found = strict.resolve(&wrench, &ring);
    let Resolution::NoContact(NoContact::BeyondFriction { friction_ratio, .. }) = found else {
        panic!("{found:?}")
    };
    assert!((friction_ratio - ratios[0]).abs() < 1e-12);
    assert!(strict.candidates(&wrench, &ring, |_| ()).is_err());
}

/// A line that is tangent is a contact without a normal force, which no friction holds: with any limit it
/// is refused. On shapes that are entered once, and on others.
#[test]
fn tangent_lines_and_friction() {
    let limited = model().with_greatest_friction(5.0).unwrap();
    // Tangent to the rounding: lines a few units in the last place inside and outside of the surface.
    let ring = Torus::new(0.02, 0.005).unwrap();
    let tube = Cylinder::new(Vector3::zeros(), Vector3::z(), 0.025).unwrap();
    let ball = Sphere::centred(0.025).unwrap();
    let (mut touched, mut refused) = (0, 0);
    for ulps in -40..=40_i32 {
        let wrench =
            Wrench::from_force_at(&v(0.025 + 3.5e-18 * f64::from(ulps), 0.0, 0.0), v(0.0, -1.0, 0.0));
        for free in [
            model().resolve(&wrench, &ring),
            model().resolve(&wrench, &tube),
            model().resolve(&wrench, &ball),
        ] {
            match free {
                Resolution::Contact(contact) => {
                    touched += 1;
                    assert!(contact.incidence() < 1e-6, "{contact:?}");
                }
                other => {
                    assert!(matches!(other, Resolution::NoContact(NoContact::Misses { .. })), "{other:?}")
                }
            }
        }
        for held in [
            limited.resolve(&wrench, &ring),
            limited.resolve(&wrench, &tube),
            limited.resolve(&wrench, &ball),
        ] {
            assert!(held.contact().is_none(), "{ulps} {held:?}");
            refused += 1;
        }
    }
    assert!(touched > 20 && refused == 243, "{touched} {refused}");
}

/// A sphere that tells of a point how far outside it is, right or wrong.
struct Telling(f64);

impl ActiveSurface<f64> for Telling {
    fn crossings(&self, line: &Line<f64>, visit: impl FnMut(Crossing<f64>)) {
        tip().crossings(line, visit);
    }

    fn shortcuts(&self) -> impl Shortcuts<f64> {
        self
    }
}

impl Shortcuts<f64> for Telling {
    fn surface_residual(&self, _: &Vector3<f64>) -> f64 {
        self.0
    }
}

/// At a flat angle a contact is moved along the line by what rounding explains, and by no more.
#[test]
fn only_rounding_is_undone_at_a_flat_angle() {
    let point = v(0.0, 0.013, 0.0);
    for cosine in [0.05, 0.2] {
        let force = v(1.0, -cosine, 0.0).normalize();
        let wrench = Wrench::from_force_at(&point, force);
        let at = |outside: f64| model().resolve(&wrench, &Telling(outside)).contact().unwrap().point;
        let told = 1e-17;
        let moved = at(told) - at(0.0);
        // Farther along the force, into the sphere; the coordinates are exact to 1e-18.
        let expected = force * (told / -force.dot(&Vector3::y()));
        assert!((moved - expected).norm() < 4e-18, "{cosine}: {moved:e} {expected:e}");
        for lie in [1e-10, 1e-3, f64::NAN] {
            assert!((at(lie) - point).norm() < 1e-15, "{cosine} {lie}");
        }
    }
}
