//! Where there is none, or one more: forces along a cylinder, without a torque, through a hole.

use fingertip_contact::{ContactModel, NoContact, Resolution, Search, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{
    CappedCylinder, Capsule, Cylinder, CylinderEnds, EllipticCylinder, Frustum, HalfSpace, Implicit,
    ImplicitSurface, Posed, RoundedBox, Sphere, Term, Topology, Torus, Trimmed,
};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use crate::wrenches::{Case, Random};

fn soft_finger() -> SoftFinger<f64> {
    SoftFinger::new(0.0).unwrap().without_friction_limit()
}

/// A force along a cylinder that is held at an angle has a part across it, of rounding, and that has no say.
#[test]
fn a_force_along_a_cylinder_does_not_touch_its_side() {
    let mut random = Random::new(301);
    for _ in 0..300 {
        let (centre, axis) = (random.direction() * 0.02, random.direction());
        let round = Cylinder::new(centre, axis, 0.009).unwrap();
        let upright = EllipticCylinder::new([0.002, 0.02], CylinderEnds::Unbounded).unwrap();
        let turn = RigidTransform::from_axis_angle(random.direction() * 2.0, centre).unwrap();
        let elliptic = Posed::new(upright, turn);
        let along = turn.rotate(&Vector3::z());
        // Through a place inside.
        let force = round.axis() * random.log_uniform(0.1, 100.0);
        let wrench = Wrench::on_fingertip(force, (centre + random.direction() * 0.002).cross(&force));
        let found = soft_finger().resolve(&wrench, &round);
        assert!(found.contact().is_none(), "{wrench:?} {found:?}");
        let force = along * random.log_uniform(0.1, 100.0);
        let wrench = Wrench::on_fingertip(force, centre.cross(&force));
        let found = soft_finger().resolve(&wrench, &elliptic);
        assert!(found.contact().is_none(), "{wrench:?} {found:?}");
    }
}

/// Beyond the end of a cylinder that is open there is no finger, in either precision.
#[test]
fn a_contact_beyond_the_end_is_outside() {
    fn ends<T: Real>() {
        let mut random = Random::new(302);
        let unbounded = Cylinder::new(Vector3::zeros(), Vector3::z(), 0.009).unwrap();
        let open = Cylinder::new(Vector3::zeros(), Vector3::z(), T::literal(0.009))
            .unwrap()
            .with_half_length(T::literal(0.006))
            .unwrap();
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..400 {
            let case = Case::random(&mut random, &unbounded, 0.02, [1e-3, 0.3], 1.0);
            let height = case.point.z.abs();
            if (height - 0.006).abs() < 1e-5 {
                continue;
            }
            let wrench = Wrench::on_fingertip(
                case.wrench.force().map(T::literal),
                case.wrench.torque().map(T::literal),
            );
            match SoftFinger::new(T::zero()).unwrap().without_friction_limit().resolve(&wrench, &open) {
                Resolution::Contact(_) if height < 0.006 => inside += 1,
                Resolution::NoContact(NoContact::OutsideActiveRegion { .. }) if height > 0.006 => {
                    outside += 1
                }
                found => panic!("{height} {found:?}"),
            }
        }
        assert!(inside > 50 && outside > 50, "{inside} {outside}");
    }
    ends::<f64>();
    ends::<f32>();
}

/// A force without any torque, about a body that stands beside the sensor's origin.
#[test]
fn a_force_without_torque_beside_a_body_misses() {
    let aside = Vector3::new(0.05, 0.0, 0.0);
    let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.3, -2.0), Vector3::zeros());
    let turn = RigidTransform::from_axis_angle(Vector3::new(0.1, 0.2, 0.3), aside).unwrap();
    let misses = |name: &str, found: Resolution<f64>| {
        assert!(matches!(found, Resolution::NoContact(NoContact::Misses { .. })), "{name} {found:?}");
    };
    let model = soft_finger();
    let upright = Vector3::new(0.1, 0.0, 1.0);
    // On a sphere the two places are told on which it could only graze.
    let found = model.resolve(&wrench, &Sphere::new(aside, 0.01).unwrap());
    assert!(matches!(found, Resolution::NoContact(NoContact::Ambiguous { .. })), "{found:?}");
    misses("capsule", model.resolve(&wrench, &Capsule::new(aside, upright, 0.008, 0.01).unwrap()));
    misses("cylinder", model.resolve(&wrench, &CappedCylinder::new(aside, upright, 0.01, 0.008).unwrap()));
    misses("frustum", model.resolve(&wrench, &Frustum::new(aside, upright, 0.01, 0.004, 0.02).unwrap()));
    let box_shaped = RoundedBox::new(Vector3::new(0.01, 0.008, 0.012), 0.003).unwrap();
    misses("rounded box", model.resolve(&wrench, &Posed::new(box_shaped, turn)));
    let elliptic = EllipticCylinder::new([0.007, 0.01], CylinderEnds::Capped(0.01)).unwrap();
    misses("elliptic cylinder", model.resolve(&wrench, &Posed::new(elliptic, turn)));
}

/// A torus, as a formula of which nothing is known but its kind.
#[derive(Clone, Copy, Debug)]
struct Ring;

impl Ring {
    const RING: f64 = 0.010;
    const TUBE: f64 = 0.004;
}

impl<T: Real> ImplicitSurface<T> for Ring {
    fn formula(&self, point: [Term<T>; 3]) -> Term<T> {
        let [x, y, z] = point.map(|x| (x * T::literal(1.0 / Self::RING)).square());
        let tube = Self::TUBE / Self::RING;
        let whole = (x + y + z + T::literal(1.0 - tube * tube)).square();
        whole - (x + y) * T::literal(4.0)
    }

    fn ball(&self) -> (Vector3<T>, T) {
        (Vector3::zeros(), T::literal((Self::RING + Self::TUBE) * 1.01))
    }

    fn topology(&self) -> Topology {
        Topology::Closed { euler_characteristic: 0 }
    }
}

/// All contacts of a ring, which come in pairs, and of a pure force through its hole or past it none.
#[test]
fn a_formula_with_a_hole_has_the_contacts_of_the_torus() {
    let torus = Torus::new(Ring::RING, Ring::TUBE).unwrap();
    let ring: Implicit<f64, Ring> = Implicit::new(Ring).unwrap();
    let mut random = Random::new(303);
    let (mut pairs, mut more) = (0, 0);
    for _ in 0..6 {
        let case = Case::random(&mut random, &torus, 0.02, [0.05, 0.6], 1.0);
        let (mut expected, mut found) = (Vec::new(), Vec::new());
        let _ = torus.soft_contacts(&case.wrench, None, |contact| expected.push(contact.point));
        let search = ring.soft_contacts(&case.wrench, None, |contact| found.push(contact.point));
        assert_eq!(search, Search::Complete, "{case:?}");
        assert_eq!(found.len(), expected.len(), "{case:?} {found:?} {expected:?}");
        for point in &expected {
            assert!(found.iter().any(|other| (point - other).norm() < 1e-10), "{found:?} {expected:?}");
        }
        (pairs, more) = (pairs + usize::from(found.len() == 2), more + usize::from(found.len() > 2));
    }
    assert!(pairs + more > 3, "{pairs} {more}");
    for place in [Vector3::new(0.001, -0.002, 0.0), Vector3::new(0.03, 0.01, 0.0)] {
        let force = Vector3::new(0.0, 0.0, -1.5);
        let found = soft_finger().resolve(&Wrench::on_fingertip(force, place.cross(&force)), &ring);
        assert!(matches!(found, Resolution::NoContact(NoContact::Misses { .. })), "{found:?}");
    }
}

/// The least force is enough, and anything less is not, however small it is set.
#[test]
fn the_least_force_is_enough() {
    let sphere = Sphere::centred(0.01).unwrap();
    for least in [2.0, 1e-200, 1e200] {
        let model = SoftFinger::new(least).unwrap();
        let at = |force: f64| {
            model.resolve(&Wrench::on_fingertip(Vector3::z() * -force, Vector3::zeros()), &sphere)
        };
        assert!(at(least).contact().is_some(), "{least:e}");
        let less = at(least * (1.0 - 1e-12));
        assert!(matches!(less, Resolution::NoContact(NoContact::BelowThreshold { .. })), "{less:?}");
    }
}

/// What is beyond the end of a shape is not part of it by being in a region as well.
#[test]
fn a_region_does_not_give_back_what_a_shape_has_not() {
    let open = Cylinder::new(Vector3::zeros(), Vector3::z(), 0.009).unwrap().with_half_length(0.006).unwrap();
    let right = HalfSpace::new(Vector3::zeros(), Vector3::x()).unwrap();
    let trimmed = Trimmed::new(open, right);
    for (side, height, inside) in
        [(1.0, 0.0, true), (1.0, 0.01, false), (-1.0, 0.0, false), (-1.0, 0.01, false)]
    {
        let force = Vector3::x() * -side;
        let wrench = Wrench::on_fingertip(force, Vector3::new(0.0, 0.0, height).cross(&force));
        let found = soft_finger().resolve(&wrench, &trimmed);
        assert_eq!(found.contact().is_some(), inside, "{side} {height} {found:?}");
        let outside = matches!(found, Resolution::NoContact(NoContact::OutsideActiveRegion { .. }));
        assert_eq!(outside, !inside, "{side} {height} {found:?}");
    }
}
