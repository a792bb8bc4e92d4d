//! The least grip where numbers are tiny, huge, subnormal, NaN, infinite, parallel, singular or at one point; and in both
//! precisions.

use fingertip_friction::{Coulomb, SoftFingerLimit, UncertainCoulomb};
use fingertip_hand::{
    BadContact, BadLimit, ContactFriction, FingerLimits, Grasp, GraspContact, GripOutcome, Hand, LeastGrip,
    Metric, Precision, Reach,
};
use fingertip_wrench::{ContactForce, Frame, Real, Wrench};
use nalgebra::{SMatrix, Vector3};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::{Place, TestHand, narrow, places, vector};

fn two<T: Real>(soft: bool, friction: f64, half: T) -> Grasp<T, 2, TestHand> {
    let at = |side: T| {
        let (place, outward) = (Vector3::x() * (half * side), -Vector3::x() * side);
        let friction = T::literal(friction);
        Some(if soft {
            GraspContact::soft(place, outward, friction, half * T::literal(0.1)).unwrap()
        } else {
            GraspContact::point(place, outward, friction).unwrap()
        })
    };
    Grasp::new([at(-T::one()), at(T::one())])
}

/// Without a load nothing has to press, whatever was held before, and it is said at once.
#[test]
fn nothing_presses_without_a_load() {
    let grasp = two::<f64>(true, 0.5, 0.02);
    let none = [FingerLimits::<f64, 1>::none(); 2];
    let mut least = LeastGrip::new();
    for load in [-1.0, 0.0, 3.0, 0.0, 0.0] {
        let load = Wrench::on_fingertip(Vector3::z() * load, Vector3::zeros());
        let found = least.solve(&grasp, &none, &load);
        let grip = found.grip().unwrap();
        if load == Wrench::zero() {
            assert_eq!((grip.cost, grip.least_cost, grip.steps), (0.0, 0.0, 0));
            assert_eq!((grip.forces, grip.imbalance), ([ContactForce::zero(); 2], Wrench::zero()));
        } else {
            assert!(grip.cost > 0.0 && grip.steps > 0);
        }
    }
    // A finger that must touch does.
    let touching = [FingerLimits::<f64, 1>::none().with_least_normal(0.5).unwrap(); 2];
    let grip = least.solve(&grasp, &touching, &Wrench::zero());
    assert!((grip.grip().unwrap().cost - 1.0).abs() < 1e-6, "{grip:?}");
}

/// Forces over the whole range of the type, sizes too: the grip is in proportion.
fn scales<T: Real>(forces: &[f64], sizes: &[f64], tolerance: f64) {
    let none = [FingerLimits::<T, 1>::none(); 2];
    for (newtons, half) in forces.iter().flat_map(|f| sizes.iter().map(move |s| (*f, *s))) {
        let grasp = two(true, 0.5, T::literal(half));
        let load = Wrench::on_fingertip(Vector3::z() * T::literal(-newtons), Vector3::zeros());
        let found = LeastGrip::new().solve(&grasp, &none, &load);
        // The torque of such forces about the other finger may be beyond the range of the type.
        if !T::literal(newtons * half).is_number() && found == GripOutcome::NotFinite {
            continue;
        }
        let GripOutcome::Held(grip) = found else { panic!("{newtons} {half}: {found:?}") };
        for force in &grip.forces {
            let share = (force.normal / T::literal(newtons)).to_f64();
            assert!((share - 1.0).abs() < tolerance, "{newtons} {half}: {share}");
        }
        let anvil = Wrench::on_fingertip(Vector3::z(), Vector3::x() * T::literal(half));
        // A torque about the line, by the spin torque alone: 2 μ e N = τ.
        let GripOutcome::Held(grip) = LeastGrip::new().solve(&grasp, &none, &anvil) else { panic!() };
        assert!(grip.forces[0].normal > T::literal(5.0));
    }
}

#[test]
fn any_scale_will_do() {
    scales::<f64>(&[1e-300, 1e-100, 1e-9, 1.0, 1e9, 1e100, 1e300], &[1e-100, 1e-6, 0.02, 1e3, 1e100], 1e-7);
    scales::<f32>(&[1e-37, 1e-15, 1e-3, 1.0, 1e15, 1e37], &[1e-15, 1e-6, 0.02, 1e3, 1e12], 1e-3);
}

#[test]
fn two_points_hold_what_they_can_and_certify_the_rest() {
    let grasp = two(false, 0.5, 0.02);
    let none = [FingerLimits::<f64, 1>::none(); 2];
    let along = Wrench::on_fingertip(-Vector3::z() * 2.0, Vector3::zeros());
    let GripOutcome::Held(grip) = LeastGrip::new().solve(&grasp, &none, &along) else { panic!() };
    assert!((grip.forces[0].normal - 2.0).abs() < 1e-6 && (grip.forces[1].normal - 2.0).abs() < 1e-6);
    // A torque about the line: it turns, and nothing holds it.
    let about = along + Wrench::on_fingertip(Vector3::zeros(), Vector3::x() * 1e-3);
    let GripOutcome::CannotHold(why) = LeastGrip::new().solve(&grasp, &none, &about) else { panic!() };
    assert!(why.turning.x > 0.0 && why.velocity.norm() < 1e-3 * why.turning.norm(), "{why:?}");
    assert!(why.needs > 1e6);
}

#[test]
fn all_fingers_at_one_point_and_none() {
    let here = Place { point: Vector3::new(0.1, 0.2, 0.3), normal: Vector3::z(), friction: 0.5, arm: None };
    let grasp =
        Grasp::<f64, 3, TestHand>::new([Some(here.contact()), Some(here.contact()), Some(here.contact())]);
    let none = [FingerLimits::<f64, 0>::none(); 3];
    // They bear what presses on the point, and share it.
    let pressed = Wrench::from_force_at(&here.point, -Vector3::z() * 3.0);
    let GripOutcome::Held(grip) = LeastGrip::new().solve(&grasp, &none, &pressed) else { panic!() };
    assert!((grip.cost - 3.0).abs() < 1e-6);
    for load in [-pressed, Wrench::on_fingertip(-Vector3::z(), Vector3::zeros())] {
        assert!(matches!(LeastGrip::new().solve(&grasp, &none, &load), GripOutcome::CannotHold(_)));
    }
    // Where there is no distance a torque counts by the metre.
    assert_eq!(grasp.length(), 1.0);
    let twisted = pressed + Wrench::on_fingertip(Vector3::zeros(), Vector3::z());
    assert!(matches!(LeastGrip::new().solve(&grasp, &none, &twisted), GripOutcome::CannotHold(_)));
    let nothing = Grasp::<f64, 3, TestHand>::new([None; 3]);
    assert_eq!(nothing.length(), 1.0);
    let found = LeastGrip::new().solve(&nothing, &none, &pressed);
    let GripOutcome::CannotHold(why) = found else { panic!("{found:?}") };
    assert!(why.power(&pressed) > 0.0 && why.excess > 0.0);
    let found = LeastGrip::new().solve(&nothing, &none, &Wrench::zero());
    assert_eq!(found.grip().unwrap().cost, 0.0);
    // A sphere pressed at one place with parallel normals.
    let parallel = Grasp::new(
        [0.0, 0.01, 0.02].map(|x| Some(Place { point: Vector3::x() * x, ..here }.contact::<f64>())),
    );
    let weight = Wrench::from_force_at(&(Vector3::x() * 0.01), -Vector3::z());
    assert!(LeastGrip::new().solve(&parallel, &none, &weight).grip().is_some());
    assert!(LeastGrip::new().solve(&parallel, &none, &-weight).grip().is_none());
}

fn bad_numbers<T: Real>() {
    let grasp = two(true, 0.5, T::literal(0.02));
    let none = [FingerLimits::<T, 1>::none(); 2];
    let mut least = LeastGrip::new();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let load = Wrench::on_fingertip(Vector3::z() * T::literal(bad), Vector3::zeros());
        assert_eq!(least.solve(&grasp, &none, &load), GripOutcome::NotFinite);
        assert_eq!(grasp.reach(&none, &load, &load), Reach::Unknown);
        assert!(
            GraspContact::<T, Hand>::point(Vector3::z() * T::literal(bad), Vector3::z(), T::one()).is_err()
        );
        let finger = FingerLimits::<T, 2>::none();
        assert!(finger.with_greatest_normal(T::literal(bad)).is_err());
        assert!(finger.with_cost(T::literal(bad)).is_err());
    }
    assert!(
        least.solve(&grasp, &none, &Wrench::on_fingertip(-Vector3::z(), Vector3::zeros())).grip().is_some()
    );
    let precise =
        LeastGrip::<T, 2, 1>::with_precision(Precision { tolerance: T::literal(f64::NAN), steps: 1_000 });
    let mut precise = precise;
    assert!(
        precise.solve(&grasp, &none, &Wrench::on_fingertip(-Vector3::z(), Vector3::zeros())).grip().is_some()
    );
    let mut short = LeastGrip::with_precision(Precision { tolerance: T::EPSILON, steps: 1 });
    let found = short.solve(&grasp, &none, &Wrench::on_fingertip(-Vector3::z(), Vector3::zeros()));
    assert_eq!(found, GripOutcome::Undecided);
}

/// What leaves the range of the type in the units of the load is said, whichever number it is.
#[test]
fn what_leaves_the_range_is_said() {
    let grasp = two(true, 0.5, 0.02);
    let weight = Wrench::on_fingertip(-Vector3::z() * 1e-20, Vector3::zeros());
    let far = FingerLimits::<f64, 2>::none().with_greatest_normal(1e300).unwrap();
    assert_eq!(LeastGrip::new().solve(&grasp, &[far; 2], &weight), GripOutcome::NotFinite);
    let mut jacobian = SMatrix::<f64, 6, 1>::zeros();
    jacobian[0] = 1.0;
    let strong = FingerLimits::<f64, 2>::none().with_joint_torques(&jacobian, &[1e300]).unwrap();
    assert_eq!(LeastGrip::new().solve(&grasp, &[strong; 2], &weight), GripOutcome::NotFinite);
    jacobian[0] = 1e308;
    jacobian[1] = 1e308;
    let steep = FingerLimits::<f64, 2>::none().with_joint_torques(&jacobian, &[1.0]).unwrap();
    let leaning = Vector3::new(1.0, 1.0, 0.0);
    let leans =
        |side: f64| Place { point: Vector3::x() * side, normal: -leaning * side, friction: 5.0, arm: None };
    let grasp = Grasp::new([leans(-0.02).contact(), leans(0.02).contact()].map(Some));
    let weight = Wrench::on_fingertip(-Vector3::z(), Vector3::zeros());
    assert_eq!(LeastGrip::new().solve(&grasp, &[steep; 2], &weight), GripOutcome::NotFinite);
    assert_eq!(grasp.reach(&[steep; 2], &weight, &weight), Reach::Unknown);
}

#[test]
fn bad_numbers_are_said() {
    bad_numbers::<f64>();
    bad_numbers::<f32>();
}

#[test]
fn constructors_name_what_is_wrong() {
    let (at, z) = (Vector3::<f64>::zeros(), Vector3::z());
    type Contact = GraspContact<f64, Hand>;
    assert_eq!(Contact::point(at, z, 0.0), Err(BadContact::BadFriction));
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        assert_eq!(Contact::point(at, z, bad), Err(BadContact::BadFriction));
        assert_eq!(Contact::soft(at, z, 0.5, bad), Err(BadContact::BadArm));
        assert_eq!(Contact::point(at, z, 0.5).unwrap().with_safety(bad), Err(BadContact::BadSafety));
        let finger = FingerLimits::<f64, 2>::none();
        assert!(finger.with_greatest_normal(bad).is_err() && finger.with_least_normal(bad).is_err());
        assert!(finger.with_cost(bad).is_err());
    }
    assert_eq!(Contact::point(at, z, 0.5).unwrap().with_safety(1.0), Contact::point(at, z, 0.5));
    assert_eq!(Contact::point(at, z, 1e-300).unwrap().with_safety(1e300), Err(BadContact::BadSafety));
    assert_eq!(Contact::point(at, z, 0.5).unwrap().with_safety(0.9), Err(BadContact::BadSafety));
    let sure = UncertainCoulomb::new(0.6, 0.1, None).unwrap();
    let contact = Contact::new(at, z, ContactFriction::uncertain(&sure, 0.01).unwrap()).unwrap();
    assert!((contact.friction() - (0.6 - 2.326_347_874_040_841 * 0.1)).abs() < 1e-12);
    let unsure = UncertainCoulomb::new(0.6, 0.5, None).unwrap();
    assert_eq!(ContactFriction::uncertain(&unsure, 0.01), Err(BadContact::NoFriction));
    let soft = ContactFriction::uncertain(&sure, 0.01).unwrap().with_arm(2e-3).unwrap();
    assert_eq!((soft.coefficient(), soft.arm()), (contact.friction(), 2e-3));
    let (limit, patch) = (Coulomb::new(0.6).unwrap(), SoftFingerLimit::new(0.6, 2e-3).unwrap());
    assert_eq!(Contact::new(at, z, limit), Contact::point(at, z, 0.6));
    assert_eq!(Contact::new(at, z, patch), Contact::soft(at, z, 0.6, 2e-3));
    assert_eq!(Contact::new(at, at, limit), Err(BadContact::BadPlace));
    let limits = FingerLimits::<f64, 2>::none().with_least_normal(1.0).unwrap();
    let error = limits.with_greatest_normal(0.5).unwrap_err();
    assert_eq!(error.to_string(), "the greatest normal force must be at least the least normal force");
    // Just as much is a grip of one force.
    assert!(limits.with_greatest_normal(1.0).is_ok());
    let jacobian = SMatrix::<f64, 6, 1>::zeros();
    assert!(
        FingerLimits::<f64, 3>::none()
            .with_least_normal(1.0)
            .unwrap()
            .with_joint_torques(&jacobian, &[1.0])
            .is_ok()
    );
    let jointed = FingerLimits::<f64, 3>::none().with_joint_torques(&jacobian, &[1.0]).unwrap();
    let both = jointed.with_least_normal(1.0).unwrap().with_greatest_normal(2.0);
    assert_eq!(both, Err(BadLimit::NoRoom { room: 3, needed: 4 }));
    let full =
        FingerLimits::<f64, 3>::none().with_least_normal(1.0).unwrap().with_greatest_normal(2.0).unwrap();
    assert_eq!(full.with_joint_torques(&jacobian, &[1.0]), Err(BadLimit::NoRoom { room: 3, needed: 4 }));
    let half = FingerLimits::<f64, 2>::none().with_greatest_normal(2.0).unwrap();
    assert_eq!(half.with_joint_torques(&jacobian, &[1.0]), Err(BadLimit::NoRoom { room: 2, needed: 3 }));
    let error = limits.with_joint_torques(&jacobian, &[1.0]).unwrap_err();
    assert_eq!(error, BadLimit::NoRoom { room: 2, needed: 3 });
    assert_eq!(error.to_string(), "the limits of a finger need 3 rows, and its type has 2");
    assert!(FingerLimits::<f64, 2>::none().with_joint_torques(&(jacobian * f64::NAN), &[1.0]).is_err());
    assert!(FingerLimits::<f64, 2>::none().with_joint_torques(&jacobian, &[0.0]).is_err());
    assert_eq!(
        FingerLimits::<f64, 0>::none().with_least_normal(1.0),
        Err(BadLimit::NoRoom { room: 0, needed: 1 })
    );
}

/// A joint that can only give so much torque is as a limit of the normal force, if that is all it sees.
#[test]
fn joint_torques_limit_as_normal_forces_do() {
    let grasp = two(true, 0.5, 0.02);
    let weight = |newtons: f64| Wrench::on_fingertip(-Vector3::z() * newtons, Vector3::zeros());
    // A drive along x for each finger: its force is the normal force.
    let mut jacobian = SMatrix::<f64, 6, 1>::zeros();
    jacobian[0] = 1.0;
    let limits = [FingerLimits::<f64, 2>::none().with_joint_torques(&jacobian, &[10.0]).unwrap(); 2];
    let GripOutcome::Held(grip) = LeastGrip::new().solve(&grasp, &limits, &weight(9.99)) else { panic!() };
    assert!((grip.forces[0].normal - 9.99).abs() < 1e-5);
    assert!(matches!(LeastGrip::new().solve(&grasp, &limits, &weight(10.01)), GripOutcome::CannotHold(_)));
    // A joint 0.1 m below whose axis is along y carries all of it with a lever of 0.1 m.
    let mut jacobian = SMatrix::<f64, 6, 1>::zeros();
    (jacobian[0], jacobian[4]) = (0.1, 1.0);
    let limits = [FingerLimits::<f64, 2>::none().with_joint_torques(&jacobian, &[1.0]).unwrap(); 2];
    let GripOutcome::Held(grip) = LeastGrip::new().solve(&grasp, &limits, &weight(2.0)) else { panic!() };
    for (force, contact) in grip.forces.iter().zip(grasp.contacts()) {
        let torque = contact.unwrap().wrench(force).components().dot(&jacobian.column(0));
        assert!(torque.abs() <= 1.0 + 1e-9);
    }
}

/// In f32 as in f64, to what f32 can tell, on the same random grasps.
#[test]
fn single_precision_agrees() {
    let mut rng = Pcg64Mcg::seed_from_u64(31);
    let (mut both, mut disagree, mut undecided, mut worst) = (0, 0, 0, 0.0_f64);
    for _ in 0..2_000 {
        let touching = rng.random_range(2..=5);
        let places = places::<5>(&mut rng, touching);
        let (force, about) = (vector(&mut rng) * 3.0, vector(&mut rng) * 0.02);
        let wide = Grasp::new(places.map(|p| p.map(|p| p.contact::<f64>())));
        let single = Grasp::new(places.map(|p| p.map(|p| p.contact::<f32>())));
        let load = Wrench::<f64, TestHand>::from_force_at(&(wide.centre() + about), force);
        let narrowed = Wrench::on_fingertip(narrow::<f32>(load.force()), narrow(load.torque()));
        let limits = [FingerLimits::<f64, 1>::none(); 5];
        let ours = LeastGrip::new().solve(&wide, &limits, &load);
        let theirs = LeastGrip::new().solve(&single, &[FingerLimits::<f32, 1>::none(); 5], &narrowed);
        match (ours, theirs) {
            (GripOutcome::Held(a), GripOutcome::Held(b)) => {
                both += 1;
                let off = (a.cost - f64::from(b.cost)).abs() / a.cost;
                // What the gap says, and the rounding of places.
                worst = worst.max(off - f64::from(b.gap()));
                // The more the forces exceed the load, the more they depend on where the contacts are.
                let out_of_proportion = a.cost / force.norm();
                assert!(off < 0.01 + 2e-3 * out_of_proportion, "{off} {out_of_proportion}");
            }
            (GripOutcome::CannotHold(_), GripOutcome::CannotHold(_)) => {}
            (_, GripOutcome::Undecided) => undecided += 1,
            // Forces out of proportion: one holds with them, one does not.
            (GripOutcome::Held(a), _) if a.cost > 300.0 * force.norm() => {}
            _ => disagree += 1,
        }
    }
    println!("{both} held by both, {undecided} undecided in f32, {disagree} differ; costs by {worst:.1e}");
    assert!(both > 700 && disagree <= 2 && undecided <= 20);
}

fn finite_or_said<T: Real, F: Frame>(found: &GripOutcome<T, 3, F>) -> bool {
    match found {
        GripOutcome::Held(grip) => {
            grip.cost.is_number()
                && grip.least_cost.is_number()
                && grip.forces.iter().all(ContactForce::is_finite)
                && grip.imbalance.is_finite()
        }
        GripOutcome::CannotHold(why) => {
            !(why.velocity.iter().chain(why.turning.iter()).any(|x| x.to_f64().is_nan())
                || why.excess.to_f64().is_nan()
                || why.needs.to_f64().is_nan())
        }
        GripOutcome::NotFinite | GripOutcome::Undecided => true,
    }
}

/// Numbers of all sizes, with what is no number among them.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![-10.0..10.0_f64, any::<f64>(), Just(0.0), Just(1.0), Just(f64::MIN_POSITIVE), Just(5e-324)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3_000))]

    #[test]
    fn any_bits_give_numbers_or_a_reason(numbers in prop::collection::vec(number(), 36)) {
        let vector = |i: usize| Vector3::new(numbers[i], numbers[i + 1], numbers[i + 2]);
        let contact = |i: usize| -> Option<GraspContact<f64, TestHand>> {
            GraspContact::soft(vector(i), vector(i + 3), numbers[i + 6].abs(), numbers[i + 7].abs()).ok()
        };
        let grasp = Grasp::new([contact(0), contact(8), contact(16)]);
        let mut limits = [FingerLimits::<f64, 2>::none(); 3];
        for (limits, i) in limits.iter_mut().zip(24..) {
            *limits = limits.with_greatest_normal(numbers[i]).unwrap_or(*limits);
            *limits = limits.with_least_normal(numbers[i + 3]).unwrap_or(*limits);
        }
        let load = Wrench::on_fingertip(vector(30), vector(33));
        let mut least = LeastGrip::new();
        for _ in 0..2 {
            let found = least.solve(&grasp, &limits, &load);
            prop_assert!(finite_or_said(&found), "{found:?}");
        }
        let _ = grasp.freedoms();
        let _ = grasp.force_closure();
        let reach = grasp.reach(&limits, &load, &Wrench::on_fingertip(vector(0), vector(3)));
        prop_assert!(!matches!(reach, Reach::Times(times) if times.is_nan()));
        // One in eight, since it takes some hundred programs.
        let metric = Metric::Total { length: numbers[7].abs() };
        if numbers[35].to_bits() % 8 == 3 && let Some(ball) = grasp.ball(metric) {
            prop_assert!(!(ball.found.is_nan() || ball.certified.is_nan()));
        }
    }
}
