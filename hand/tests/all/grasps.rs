//! What a grasp makes of forces, against formulas written otherwise.

use fingertip_friction::SlipVerdict;
use fingertip_hand::{FingerContact, FingerSample, FingerState, Grasp, GraspContact, Hand, UncertainWrench};
use fingertip_wrench::{ContactForce, Real, RigidTransform, Sensor, Wrench};
use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::{TestHand, narrow, places, vector};

/// The grasp map by columns that are wrenches of unit forces, as a matrix of any size.
fn dense<const N: usize>(grasp: &Grasp<f64, N, TestHand>) -> DMatrix<f64> {
    let mut columns = Vec::new();
    for contact in grasp.contacts().iter().flatten() {
        let normal = contact.normal();
        let first = normal.cross(&if normal.z.abs() < 0.7 { Vector3::z() } else { Vector3::x() }).normalize();
        for direction in [normal, first, normal.cross(&first)] {
            let scale = if direction == normal { 1.0 } else { contact.friction() };
            let arm = contact.place() - grasp.centre();
            let torque = arm.cross(&direction) * (scale / grasp.length());
            columns.push(DVector::from_iterator(6, (direction * scale).iter().chain(torque.iter()).copied()));
        }
        if contact.arm() > 0.0 {
            let torque = normal * (contact.friction() * contact.arm() / grasp.length());
            columns.push(DVector::from_iterator(6, [0.0; 3].iter().chain(torque.iter()).copied()));
        }
    }
    DMatrix::from_columns(&columns)
}

fn random_forces<const N: usize>(
    rng: &mut Pcg64Mcg,
    grasp: &Grasp<f64, N, TestHand>,
) -> [ContactForce<f64>; N] {
    grasp.contacts().map(|contact| match contact {
        Some(contact) => {
            let force = vector(rng) * 3.0;
            let spin = if contact.arm() > 0.0 { rng.random_range(-1e-2..1e-2) } else { 0.0 };
            ContactForce::split(&force, &contact.normal(), spin)
        }
        None => ContactForce::zero(),
    })
}

#[test]
fn bearing_and_internal_forces_add_up_and_are_the_pseudo_inverse() {
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    for _ in 0..200 {
        let touching = rng.random_range(1..=5);
        let grasp = Grasp::new(places::<5>(&mut rng, touching).map(|p| p.map(|p| p.contact())));
        let forces = random_forces(&mut rng, &grasp);
        let parts = grasp.split(&forces);
        let whole = grasp.wrench(&forces);
        let (bearing, internal) = (grasp.wrench(&parts.bearing), grasp.wrench(&parts.internal));
        let size = whole.force().norm() + 1.0;
        assert!((bearing - whole).force().norm() < 1e-9 * size);
        assert!((bearing - whole).torque().norm() < 1e-9 * size);
        assert!(internal.force().norm() < 1e-9 * size && internal.torque().norm() < 1e-9 * size);
        for ((all, bearing), internal) in forces.iter().zip(&parts.bearing).zip(&parts.internal) {
            assert!((bearing.normal + internal.normal - all.normal).abs() < 1e-9 * size);
            let tangential =
                bearing.tangential.vector() + internal.tangential.vector() - all.tangential.vector();
            assert!(
                tangential.norm() < 1e-9 * size
                    && (bearing.spin + internal.spin - all.spin).abs() < 1e-9 * size
            );
        }
        // The length of the bearing part is that of the pseudo-inverse of a matrix that is built otherwise.
        let map = dense(&grasp);
        let about = whole.torque_about(&grasp.centre()) / grasp.length();
        let wrench = DVector::from_iterator(6, whole.force().iter().chain(about.iter()).copied());
        let gram = &map * map.transpose();
        let eigen = gram.symmetric_eigen();
        let most = eigen.eigenvalues.amax();
        let mut expected = 0.0;
        for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > 1e-12 * most {
                expected += direction.dot(&wrench).powi(2) / value;
            }
        }
        let mut found = 0.0;
        for (force, contact) in parts.bearing.iter().zip(grasp.contacts()) {
            let Some(contact) = contact else { continue };
            let spin =
                if contact.arm() > 0.0 { force.spin / (contact.friction() * contact.arm()) } else { 0.0 };
            found += force.normal.powi(2)
                + (force.tangential_magnitude() / contact.friction()).powi(2)
                + spin * spin;
        }
        assert!((found - expected).abs() < 1e-6 * expected + 1e-12, "{found} {expected}");
    }
}

#[test]
fn rank_is_that_of_the_map_and_freedoms_are_not_resisted() {
    let mut rng = Pcg64Mcg::seed_from_u64(6);
    let mut seen = [0; 7];
    for _ in 0..300 {
        let touching = rng.random_range(0..=4);
        let mut places = places::<4>(&mut rng, touching);
        if rng.random_range(0..3) == 0 {
            // All at one point.
            let point = places[0].map(|p| p.point);
            for place in places.iter_mut().flatten() {
                place.point = point.unwrap();
            }
        }
        let grasp = Grasp::new(places.map(|p| p.map(|p| p.contact())));
        let rank = if touching == 0 { 0 } else { dense(&grasp).rank(1e-7) };
        assert_eq!(grasp.rank(), rank, "{places:?}");
        seen[rank] += 1;
        let freedoms = grasp.freedoms();
        assert_eq!(freedoms.iter().flatten().count(), 6 - rank);
        for freedom in freedoms.iter().flatten() {
            for contact in grasp.contacts().iter().flatten() {
                let velocity = freedom.velocity + freedom.turning.cross(&contact.place());
                assert!(velocity.norm() < 1e-6, "no contact moves");
                if contact.arm() > 0.0 {
                    assert!(freedom.turning.dot(&contact.normal()).abs() * contact.arm() < 1e-6);
                }
            }
            assert!(!freedom.to_string().contains("NaN"));
        }
    }
    assert!(seen[0] > 10 && seen[3] > 10 && seen[5] > 10 && seen[6] > 50, "{seen:?}");
}

#[test]
fn freedoms_are_said_in_words() {
    let none = Grasp::<f64, 2, Hand>::new([None, None]);
    let words: Vec<_> = none.freedoms().iter().flatten().map(ToString::to_string).collect();
    assert_eq!(words[0], "sliding along (1.000, 0.000, 0.000)");
    assert_eq!(
        words[5],
        "turning about the line through (0.000, 0.000, 0.000) m along (0.000, 0.000, 1.000)"
    );
    let one = GraspContact::<f64, Hand>::point(Vector3::new(0.0, 0.1, 0.0), Vector3::z(), 0.5).unwrap();
    let words = Grasp::new([None, Some(one)]).freedoms().map(|f| f.map(|f| f.to_string()));
    assert!(words[0].as_ref().unwrap().starts_with("turning about the line through contact 1 along "));
    assert_eq!(words.iter().flatten().count(), 3);
}

/// The wrench of contact forces, and its law under a change of frame, in both precisions.
fn frames<T: Real>(tolerance: f64) {
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    for _ in 0..100 {
        let turn: RigidTransform<T, Hand, TestHand> =
            RigidTransform::from_axis_angle(narrow(vector(&mut rng) * 3.0), narrow(vector(&mut rng)))
                .unwrap();
        let here = Grasp::new(places::<3>(&mut rng, 3).map(|p| p.map(|p| p.contact::<T>())));
        let there = Grasp::new(here.contacts().map(|c| c.map(|c| c.expressed_in(&turn))));
        let forces = [(); 3].map(|()| {
            ContactForce::new(T::literal(rng.random_range(0.0..5.0)), Vector3::zeros(), T::literal(1e-3))
        });
        let off = here.wrench(&forces).expressed_in(&turn) - there.wrench(&forces);
        assert!(off.components().amax().to_f64() < tolerance, "{off:?}");
    }
}

#[test]
fn grasps_move_with_their_frame() {
    frames::<f64>(1e-13);
    frames::<f32>(1e-4);
}

/// Against samples: the covariance of transformed noise.
#[test]
fn covariance_moves_with_the_frame() {
    let mut rng = Pcg64Mcg::seed_from_u64(8);
    let root = Matrix6::from_fn(|_, _| rng.random_range(-1.0..1.0));
    let turn: RigidTransform<f64, Hand, Sensor> =
        RigidTransform::from_axis_angle(vector(&mut rng) * 2.0, vector(&mut rng)).unwrap();
    let contact = GraspContact::point(Vector3::zeros(), Vector3::z(), 0.5).unwrap();
    let spread = Matrix3::from_fn(|_, _| rng.random_range(-1.0..1.0));
    let load = UncertainWrench { wrench: Wrench::zero(), covariance: root * root.transpose() };
    let finger = FingerContact { contact, point_covariance: spread * spread.transpose(), load };
    let moved = finger.expressed_in(&turn);
    // Exactly: of each column of the root as an error.
    let mut sum = Matrix6::zeros();
    for column in root.column_iter() {
        let error =
            Wrench::<f64, Sensor>::from_components(&column.into_owned()).expressed_in(&turn).components();
        sum += error * error.transpose();
    }
    assert!((sum - moved.load.covariance).amax() < 1e-13 * sum.amax());
    let mut points = Matrix3::zeros();
    for column in spread.column_iter() {
        let error = turn.rotate(&column.into_owned());
        points += error * error.transpose();
    }
    assert!((points - moved.point_covariance).amax() < 1e-14);
    let felt = Vector6::from_fn(|i, _| 1.0 + i as f64);
    let other = UncertainWrench { wrench: Wrench::from_components(&felt), ..moved.load };
    let both = UncertainWrench::total(&[Some(other), None, Some(other)]);
    assert!((both.covariance - sum * 2.0).amax() < 1e-13 * sum.amax());
    assert_eq!(felt * 2.0, both.wrench.components());
}

/// A sensor in the object feels the reaction, in every part of it; told the other way twice it is what it was.
#[test]
fn what_is_felt_in_the_object_is_the_reaction() {
    let mut rng = Pcg64Mcg::seed_from_u64(55);
    for _ in 0..50 {
        let normal = vector(&mut rng).normalize();
        let contact =
            GraspContact::<f64, TestHand>::soft(vector(&mut rng) * 0.05, normal, 0.6, 3e-3).unwrap();
        let sideways = normal.cross(&vector(&mut rng));
        let force = ContactForce::new(rng.random_range(0.5..5.0), sideways, rng.random_range(-1e-2..1e-2));
        let sample = FingerSample { contact, force, slip: SlipVerdict::Warning };
        let other = sample.reversed();
        let sum = (sample.wrench() + other.wrench()).components();
        assert!(sum.amax() < 1e-15 * (1.0 + force.normal), "{sum}");
        assert!(other.force.normal == force.normal && other.slip == SlipVerdict::Warning);
        assert_eq!(FingerState::Touching(sample).reversed(), FingerState::Touching(other));
        let again = other.reversed();
        assert!(
            (again.wrench().components() - sample.wrench().components()).amax()
                < 1e-15 * (1.0 + force.normal)
        );
    }
    for none in [FingerState::<f64, TestHand>::Free, FingerState::Unexplained] {
        assert_eq!(none.reversed(), none);
    }
}
