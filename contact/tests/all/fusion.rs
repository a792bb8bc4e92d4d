//! Fusion with an array, where one of the two knows next to nothing: the other is repeated.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::Wrench;
use nalgebra::{Matrix3, Matrix6, Vector3};

fn plane() -> Plane<f64> {
    Plane::new(Vector3::new(0.0, 0.0, 0.01), Vector3::new(0.3, -0.2, 1.0)).unwrap()
}

fn reading(place: Vector3<f64>) -> ArrayContact<f64> {
    let root = Matrix3::new(3.0, 0.0, 0.0, 1.0, 2.0, 0.0, -1.0, 0.5, 1.0) * 1e-4;
    ArrayContact {
        centroid: place - plane().outward() * (place - plane().point()).dot(&plane().outward()),
        centroid_covariance: root * root.transpose(),
        normal_force: 1.2,
        normal_deviation: 0.1,
    }
}

/// What is known of a place in a plane, of a covariance in space.
fn in_plane(covariance: &Matrix3<f64>) -> Matrix3<f64> {
    let n = plane().outward();
    let flat = Matrix3::identity() - n * n.transpose();
    flat * covariance * flat
}

#[test]
fn a_wrench_that_says_nothing_leaves_the_array() {
    let fusion = Fusion::new(Matrix6::identity() * 1e9, 0.5).unwrap();
    let readings = [reading(Vector3::new(0.002, 0.001, 0.0)), reading(Vector3::new(-0.003, 0.002, 0.0))];
    let wrench = Wrench::on_fingertip(Vector3::new(0.1, 0.2, -2.5), Vector3::zeros());
    let found = fusion.estimate(&plane(), &wrench, &readings).unwrap();
    assert!(found.settled && found.internal_forces == 1 && found.disagreement < 1e-6, "{found:?}");
    for (contact, reading) in found.contacts.iter().zip(&readings) {
        assert!((contact.point - reading.centroid).norm() < 1e-9, "{contact:?}");
        let expected = in_plane(&reading.centroid_covariance);
        assert!(
            (contact.point_covariance - expected).norm() < 1e-6 * expected.norm(),
            "{contact:?} {expected}"
        );
        let n = plane().outward();
        assert!((contact.normal - n).norm() < 1e-15 && (contact.force + n * 1.2).norm() < 1e-6);
        // Friction holds a disc of radius μN, of which half is the deviation along each axis.
        let across = Matrix3::identity() - n * n.transpose();
        let expected = n * n.transpose() * 0.01 + across * (0.5 * 1.2 / 2.0_f64).powi(2);
        assert!(
            (contact.force_covariance - expected).norm() < 1e-6 * expected.norm(),
            "{contact:?} {expected}"
        );
        assert!(contact.share_from_wrench < 1e-6 && contact.grip == Grip::Sticks);
    }
}

/// An exact wrench of one contact tells its force; its covariance is that of the wrench.
#[test]
fn an_exact_wrench_tells_the_force_of_one_contact() {
    let sigma = Matrix6::from_diagonal(&nalgebra::Vector6::new(1e-10, 2e-10, 3e-10, 1.0, 1.0, 1.0));
    let fusion = Fusion::new(sigma, 0.5).unwrap();
    let reading = reading(Vector3::new(0.002, 0.001, 0.0));
    let force = -plane().outward() * 1.1 + plane().outward().cross(&Vector3::x()) * 0.2;
    let wrench = Wrench::from_force_at(&reading.centroid, force);
    let found = fusion.estimate(&plane(), &wrench, &[reading]).unwrap();
    let [contact] = found.contacts;
    assert!((contact.force - force).norm() < 1e-7, "{contact:?}");
    let expected = Matrix3::from_diagonal(&Vector3::new(1e-10, 2e-10, 3e-10));
    assert!((contact.force_covariance - expected).norm() < 1e-6 * expected.norm(), "{contact:?}");
    assert!(contact.share_from_wrench > 1.0 - 1e-6 && found.internal_forces == 0);
    // The torque, known to 1 N·m, tells nothing of the place.
    let expected = in_plane(&reading.centroid_covariance);
    assert!((contact.point_covariance - expected).norm() < 1e-5 * expected.norm(), "{contact:?} {expected}");
}

#[test]
fn readings_that_cannot_be_are_refused() {
    let fusion = Fusion::new(Matrix6::identity(), 0.5).unwrap();
    let good = reading(Vector3::new(0.002, 0.001, 0.0));
    let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
    let refused = |reading| fusion.estimate(&plane(), &wrench, &[reading]).is_err();
    assert!(!refused(good));
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(refused(ArrayContact { centroid: Vector3::new(0.0, bad, 0.0), ..good }));
        assert!(refused(ArrayContact { centroid_covariance: Matrix3::identity() * bad, ..good }));
        assert!(refused(ArrayContact { normal_force: bad, ..good }));
        assert!(refused(ArrayContact { normal_deviation: bad, ..good }));
        let lost = Wrench::on_fingertip(Vector3::new(bad, 0.0, 0.0), Vector3::zeros());
        assert!(fusion.estimate(&plane(), &lost, &[good]).is_err());
    }
    for bad in [0.0, -0.1] {
        assert!(refused(ArrayContact { normal_deviation: bad, ..good }));
    }
    assert!(refused(ArrayContact { centroid_covariance: Matrix3::identity() * -1e-8, ..good }));
    assert!(fusion.estimate(&plane(), &wrench, &[good; 4]).is_ok());
    assert!(
        fusion.estimate(&plane(), &wrench, &[good; 5]).is_err()
            && fusion.estimate(&plane(), &wrench, &[]).is_err()
    );
    // Beside a small disk there is nothing to touch.
    let disk = Sphere::centred(0.001).unwrap();
    assert!(
        fusion.estimate(&disk, &wrench, &[ArrayContact { centroid: Vector3::x() * 0.01, ..good }]).is_ok()
    );
}
