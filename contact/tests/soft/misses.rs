//! Pure forces that miss are no contacts, however their torque is rounded, and friction is what tells a contact.

use fingertip_contact::{ContactModel, NoContact, PointContact, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::{
    HalfSpace, Heightfield, Implicit, ImplicitSurface, Mesh, Plane, Sphere, Term, Topology, Torus, Trimmed,
};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::wrenches::{Case, Random};

/// The force of the torus that was told to spin with 15.7 mN·m, at a cosine of incidence of 4e-17.
#[test]
fn a_pure_force_past_a_torus_misses_it() {
    let torus = Torus::<f64>::new(0.01, 0.004).unwrap();
    let (force, point) = (Vector3::new(1.0, -2.0, 0.3), Vector3::new(0.010, 0.012, 0.006));
    let wrench = Wrench::from_force_at(&point, force);
    let found = SoftFinger::new(0.0).unwrap().resolve(&wrench, &torus);
    let Resolution::NoContact(NoContact::Misses { closest: Some(closest) }) = found else {
        panic!("{found:?}")
    };
    assert!((closest.gap - 0.0039).abs() < 1e-4, "{closest:?}");
}

/// A line crosses a shape or not: a pure force along it has contacts or none, and none spins.
fn as_the_line_says<T: Real, S: SoftFingerSurface<T>>(name: &str, surface: &S) {
    let (mut random, mut missed, mut met) = (Random::new(901), 0, 0);
    let model = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
    for _ in 0..1500 {
        let number = |v: Vector3<f64>| v.map(T::literal);
        let (force, point) = (number(random.direction()), number(random.direction() * 0.02));
        let wrench = Wrench::from_force_at(&point, force);
        let axis = wrench.line_of_action().unwrap();
        let (mut entries, mut nearly) = (0, false);
        surface.crossings(&axis.line, |crossing| {
            let cosine = -axis.line.direction.dot(&crossing.normal).to_f64();
            nearly |= cosine.abs() < 0.05;
            entries += usize::from(cosine > 0.0);
        });
        let gap = surface.closest_approach(&axis.line).map_or(1.0, |closest| closest.gap.to_f64());
        nearly |= entries == 0 && gap < 1e-5;
        if nearly {
            continue;
        }
        match model.resolve(&wrench, surface) {
            Resolution::Contact(contact) => {
                assert!(entries > 0, "{name} {wrench:?} {contact:?}");
                let spin = contact.spin_torque.to_f64().abs();
                assert!(spin < 100.0 * 0.02 * T::EPSILON.to_f64(), "{name} {wrench:?} {contact:?}");
                met += 1;
            }
            Resolution::NoContact(NoContact::Misses { .. } | NoContact::OnlyPulling { .. }) => {
                assert!(entries == 0, "{name} {wrench:?}");
                missed += 1;
            }
            other => panic!("{name} {wrench:?} {other:?}"),
        }
    }
    assert!(met > 20 && missed > 100, "{name} {met} {missed}");
}

fn ball<T: Real>() -> Mesh<T> {
    let (vertices, triangles) = ball_of_triangles::<T>(7, 9, None);
    let vertices: Vec<_> = vertices.iter().map(|v| v * T::literal(0.012)).collect();
    Mesh::new(&vertices, &triangles).unwrap()
}

fn pad<T: Real>() -> Heightfield<T> {
    let at = |k: usize| 0.002 * k as f64 - 0.008;
    let heights =
        (0..81).map(|k| T::literal(-(at(k % 9).powi(2) / 0.020 + at(k / 9).powi(2) / 0.030))).collect();
    Heightfield::new([T::literal(-0.008); 2], [T::literal(0.002); 2], 9, heights).unwrap()
}

#[test]
fn pure_forces_touch_where_their_line_enters() {
    fn all<T: Real>() {
        as_the_line_says::<T, _>("torus", &Torus::new(T::literal(0.010), T::literal(0.004)).unwrap());
        as_the_line_says::<T, _>("mesh", &ball::<T>());
        as_the_line_says::<T, _>("heightfield", &pad::<T>());
    }
    all::<f64>();
    all::<f32>();
}

/// 2 N that pass a sphere of 13 mm at 14 mm: whatever noise is along them, no friction holds them.
#[test]
fn noise_makes_no_contact_of_a_miss() {
    let sphere = Sphere::<f64>::centred(0.013).unwrap();
    let force = Vector3::new(0.0, 2.0, 0.0);
    let model = SoftFinger::new(0.0).unwrap();
    for noise in [1e-12, 1e-9, 1e-6, 1e-5] {
        let torque = Vector3::new(0.014, 0.0, 0.0).cross(&force) + Vector3::y() * noise;
        let found = model.resolve(&Wrench::on_fingertip(force, torque), &sphere);
        let Resolution::NoContact(NoContact::BeyondFriction { point, friction_ratio }) = found else {
            panic!("{noise} {found:?}")
        };
        // It is the contact that there would be: on the sphere, with that ratio.
        let pressing = -force.dot(&point) / 0.013;
        assert!((point.norm() - 0.013).abs() < 1e-12 && pressing > 0.0, "{found:?}");
        let ratio = (force + point / 0.013 * pressing).norm() / pressing;
        assert!((friction_ratio / ratio - 1.0).abs() < 1e-4 && ratio > 10.0, "{ratio} {found:?}");
    }
}

/// A contact that friction holds is found as without a limit; one that it does not hold is not.
#[test]
fn the_limit_is_the_ellipse_of_force_and_spin() {
    let (sphere, torus) = (Sphere::<f64>::centred(0.013).unwrap(), Torus::new(0.01, 0.004).unwrap());
    let arm = 0.002;
    let mut random = Random::new(902);
    let free = SoftFinger::new(0.0).unwrap().without_friction_limit();
    let (mut held, mut refused) = (0, 0);
    for _ in 0..400 {
        let case = Case::random(&mut random, &sphere, 0.013, [0.001, 0.3], 1.0);
        let pressing = case.incidence;
        let needed = (1.0 - pressing * pressing + (case.spin / arm).powi(2)).sqrt() / pressing;
        for (friction, holds) in [(needed * 1.001, true), (needed * 0.999, false)] {
            let model = free.with_greatest_friction(friction).and_then(|m| m.with_torque_arm(arm)).unwrap();
            match (model.resolve(&case.wrench, &sphere), holds) {
                (Resolution::Contact(contact), true) => {
                    assert!((contact.point - case.point).norm() < 1e-9, "{case:?} {contact:?}");
                    held += 1;
                }
                (Resolution::NoContact(NoContact::BeyondFriction { point, friction_ratio }), false) => {
                    assert!((point - case.point).norm() < 1e-9, "{case:?}");
                    assert!((friction_ratio / needed - 1.0).abs() < 1e-6, "{friction_ratio} {needed}");
                    refused += 1;
                }
                found => panic!("{case:?} {found:?}"),
            }
        }
        // Of several contacts, those that friction does not hold do not count.
        let case = Case::random(&mut random, &torus, 0.014, [0.01, 0.3], 1.0);
        let mut within = Vec::new();
        let _ = torus.soft_contacts(&case.wrench, None, |contact| {
            let pressing = -case.wrench.force().dot(&contact.normal);
            if (1.0 - pressing * pressing).max(0.0).sqrt() <= 2.0 * pressing {
                within.push(contact.point);
            }
        });
        let found = free.with_greatest_friction(2.0).unwrap().resolve(&case.wrench, &torus);
        assert_eq!(found.contact().map_or(0, |c| usize::from(c.alternatives) + 1), within.len(), "{case:?}");
    }
    assert_eq!((held, refused), (400, 400));
}

/// With the same limit, a point contact and a soft finger refuse the same pure force.
#[test]
fn both_models_have_one_limit() {
    let (sphere, mut random) = (Sphere::<f64>::centred(0.013).unwrap(), Random::new(903));
    let soft = SoftFinger::new(0.0).and_then(|model| model.with_greatest_friction(0.7)).unwrap();
    let point = PointContact::new(0.0).and_then(|model| model.with_greatest_friction(0.7)).unwrap();
    for _ in 0..300 {
        let (place, normal) = random.place(&sphere, 0.013);
        let wrench = Wrench::from_force_at(&place, random.force(&normal, 0.05, 1.0));
        let [soft, point] = [soft.resolve(&wrench, &sphere), point.resolve(&wrench, &sphere)];
        assert_eq!(soft.contact().is_some(), point.contact().is_some(), "{wrench:?} {soft:?} {point:?}");
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(SoftFinger::new(0.0).unwrap().with_greatest_friction(bad).is_err(), "{bad}");
        assert!(SoftFinger::new(0.0).unwrap().with_torque_arm(bad).is_err(), "{bad}");
    }
    assert!(SoftFinger::new(0.0).unwrap().with_torque_arm(0.0).is_err());
}

/// A friction limit of zero is one: only what presses straight down is a contact. None is less, nor no number.
#[test]
fn limits_that_cannot_be_are_refused() {
    let free = SoftFinger::<f64>::new(0.0).unwrap();
    assert!(free.with_greatest_friction(0.0).is_ok());
    assert!(free.with_torque_arm(f64::MIN_POSITIVE).is_ok() && free.with_torque_arm(0.0).is_err());
    for bad in [-1e-300, -1.0, f64::NAN, f64::INFINITY] {
        assert!(free.with_greatest_friction(bad).is_err(), "{bad}");
        assert!(free.with_torque_arm(bad).is_err(), "{bad}");
    }
}

/// Whatever friction a model is given, one that is generous takes the short way to a contact and one that is not the
/// long one: both say the same.
#[test]
fn the_short_way_knows_the_limit() {
    let sphere = Sphere::<f64>::centred(0.013).unwrap();
    let (default, mut random) = (SoftFinger::new(0.0).unwrap(), Random::new(904));
    let (mut held, mut refused) = (0, 0);
    assert_eq!(default.greatest_friction(), Some(SoftFinger::<f64>::GREATEST_FRICTION));
    for friction in [0.5, 3.0, 3.3, 3.4, 10.0] {
        let model = default.with_greatest_friction(friction).unwrap();
        for _ in 0..300 {
            let case = Case::random(&mut random, &sphere, 0.013, [0.001, 0.3], 1.0);
            let ratio = (1.0 - case.incidence.powi(2)).sqrt() / case.incidence;
            let found = model.resolve(&case.wrench, &sphere);
            assert_eq!(found.contact().is_some(), ratio <= friction, "{friction} {case:?} {found:?}");
            (held, refused) =
                (held + usize::from(ratio <= friction), refused + usize::from(ratio > friction));
        }
    }
    assert!(held > 400 && refused > 100, "{held} {refused}");
    assert_eq!(default.without_friction_limit().greatest_friction(), None);
}

/// Where a line misses, a torque along it within the noise may be of either sign: then both places are told. Where
/// it does not miss, or the torque is beyond the noise, the contact is.
#[test]
fn noise_tells_what_is_ambiguous() {
    let sphere = Sphere::<f64>::centred(0.013).unwrap();
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit().with_torque_noise(1e-4).unwrap();
    let force = Vector3::new(0.0, 2.0, 0.0);
    let beside = |x: f64, along: f64| {
        Wrench::on_fingertip(force, Vector3::new(x, 0.0, 0.0).cross(&force) + Vector3::y() * along)
    };
    for along in [0.0, 1e-12, 9.9e-5, -9.9e-5] {
        let found = model.resolve(&beside(0.014, along), &sphere);
        let Resolution::NoContact(NoContact::Ambiguous { first, second }) = found else {
            panic!("{along} {found:?}")
        };
        assert!((first - second).norm() > 1e-3 && (first.norm() - 0.013).abs() < 1e-12, "{first} {second}");
        // The mirror image: what opposite torques along the force have.
        assert!((first.z + second.z).abs() < 1e-12 && (first.x - second.x).abs() < 1e-12, "{first} {second}");
    }
    assert!(model.resolve(&beside(0.014, 1.01e-4), &sphere).contact().is_some());
    assert!(model.resolve(&beside(0.0129, 1e-5), &sphere).contact().is_some());
    // With the limit too, of contacts that it would refuse.
    let limited = SoftFinger::new(0.0).unwrap().with_torque_noise(1e-4).unwrap();
    for (along, ambiguous) in [(1e-5, true), (1.01e-4, false)] {
        let found = limited.resolve(&beside(0.014, along), &sphere);
        let Resolution::NoContact(reason) = found else { panic!("{found:?}") };
        assert_eq!(matches!(reason, NoContact::Ambiguous { .. }), ambiguous, "{reason:?}");
        assert_eq!(matches!(reason, NoContact::BeyondFriction { .. }), !ambiguous, "{reason:?}");
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(model.with_torque_noise(bad).is_err(), "{bad}");
    }
}

/// A surface that is no closed body is entered without being left: where the line of action meets the part that may
/// touch, the contact is told, whatever the noise; and where it meets only the far side, from within, it is not met.
#[test]
fn a_line_that_enters_an_open_surface_is_not_ambiguous() {
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit().with_torque_noise(1e-4).unwrap();
    let upper = HalfSpace::new(Vector3::zeros(), Vector3::z()).unwrap();
    let dome = Trimmed::new(Sphere::<f64>::centred(0.013).unwrap(), upper);
    let plane = Plane::new(Vector3::new(0.0, 0.0, 0.005), Vector3::z()).unwrap();
    let force = Vector3::new(0.3, 0.2, -2.0);
    for through in [Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.001, -0.002, 0.013)] {
        for along in [1e-6, -1e-6, 9e-5] {
            let pressing = Wrench::on_fingertip(force, through.cross(&force) + force.normalize() * along);
            let pulling = Wrench::on_fingertip(-pressing.force(), -pressing.torque());
            assert!(model.resolve(&pressing, &dome).contact().is_some(), "{pressing:?}");
            assert!(model.resolve(&pressing, &plane).contact().is_some(), "{pressing:?}");
            assert!(model.resolve(&pulling, &plane).contact().is_none(), "{pulling:?}");
        }
    }
}

/// A force that presses where a torus is cut off does so, whatever grazing contacts its noise would make.
#[test]
fn a_part_that_is_cut_off_is_told_before_what_no_friction_holds() {
    let torus = Torus::<f64>::new(0.01, 0.004).unwrap();
    let trimmed = Trimmed::new(torus, HalfSpace::new(Vector3::zeros(), Vector3::x()).unwrap());
    let (model, mut random, mut outside) = (SoftFinger::new(0.0).unwrap(), Random::new(905), 0);
    for _ in 0..500 {
        let (point, normal) = random.place(&torus, 0.014);
        if point.x > -0.002 {
            continue;
        }
        let force = random.force(&normal, 0.7, 1.0);
        let torque = point.cross(&force) + force * (random.sign() * 1e-9);
        let wrench = Wrench::on_fingertip(force, torque);
        match model.resolve(&wrench, &trimmed) {
            Resolution::NoContact(NoContact::OutsideActiveRegion { .. }) => outside += 1,
            // The line goes on, and may press on what is there.
            Resolution::Contact(contact) => assert!(contact.point.x >= 0.0, "{contact:?}"),
            found => panic!("{wrench:?} {found:?}"),
        }
    }
    assert!(outside > 100, "{outside}");
}

/// On a formula of which nothing is known contacts are searched for, and it is said; on one that is known to be
/// convex there is one.
#[test]
fn a_search_is_said_to_be_one() {
    #[derive(Clone, Copy, Debug)]
    struct Untold(bool);
    impl ImplicitSurface<f64> for Untold {
        fn formula(&self, [x, y, z]: [Term<f64>; 3]) -> Term<f64> {
            (x / 0.01).square() + (y / 0.012).square() + (z / 0.014).square() - 1.0
        }
        fn ball(&self) -> (Vector3<f64>, f64) {
            (Vector3::zeros(), 0.0141)
        }
        fn topology(&self) -> Topology {
            if self.0 { Topology::Convex } else { Topology::Unknown }
        }
    }
    let [known, unknown] = [true, false].map(|told| Implicit::new(Untold(told)).unwrap());
    let (model, mut random) = (SoftFinger::new(0.0).unwrap(), Random::new(906));
    for _ in 0..20 {
        let case = Case::random(&mut random, &known, 0.013, [0.01, 0.3], 1.0);
        if case.incidence < 0.2 {
            continue;
        }
        let [told, found] = [model.resolve(&case.wrench, &known), model.resolve(&case.wrench, &unknown)];
        let (Resolution::Contact(told), Resolution::Contact(found)) = (told, found) else {
            panic!("{told:?} {found:?}")
        };
        assert!(!told.searched && found.searched, "{told:?} {found:?}");
        assert!((told.point - found.point).norm() < 1e-12, "{told:?} {found:?}");
    }
    // A pure force that misses is told by its line, whatever is not known of the surface.
    let past = Wrench::from_force_at(&Vector3::new(0.03, 0.0, 0.0), Vector3::new(0.0, 0.0, -1.0));
    let found = model.resolve(&past, &unknown);
    assert!(matches!(found, Resolution::NoContact(NoContact::Misses { .. })), "{found:?}");
}
