//! Covariances against closed forms: on a plane every derivative is known by hand.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::Wrench;
use nalgebra::{Matrix2, Matrix2x6, Matrix3, Matrix6, Vector2, Vector3, Vector6};

fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

/// A full covariance, of about 1 mN and 10 µN·m.
fn noise() -> Matrix6<f64> {
    let scale = Matrix6::from_diagonal(&Vector6::new(1e-3, 2e-3, 1e-3, 1e-5, 2e-5, 3e-5));
    let root = Matrix6::from_fn(|i, j| ((5 * i + 3 * j) % 7) as f64 - 2.5 + 0.3 * j as f64);
    scale * root * root.transpose() * scale
}

const HEIGHT: f64 = 0.01;

/// A point contact on the plane `z = h`, as the plane has it.
fn on_plane(force: Vector3<f64>) -> (Contact<f64>, ContactJacobian<f64>) {
    let plane = Plane::new(v(0.0, 0.0, HEIGHT), Vector3::z()).unwrap();
    let wrench = Wrench::from_force_at(&v(0.003, -0.004, HEIGHT), force);
    let contact = *PointContact::new(0.0).unwrap().resolve(&wrench, &plane).contact().unwrap();
    let jacobian = ContactJacobian::of_point_contact(&contact, &wrench, &Matrix3::zeros()).unwrap();
    (contact, jacobian)
}

fn close(found: &Matrix2<f64>, exact: &Matrix2<f64>) -> bool {
    (found - exact).norm() <= 1e-12 * exact.norm()
}

/// `x = (h f_x − m_y)/f_z` and `y = (h f_y + m_x)/f_z` where the line meets the plane, with `m − p f` for `m`:
/// the pitch `p = f·m/|f|²`, zero here, is left out, but changes. The normal does not turn, so the noise of
/// the force is that of its parts.
#[test]
fn on_a_plane_all_parts_are_known() {
    let force = v(0.3, -0.2, -1.5);
    let (contact, jacobian) = on_plane(force);
    let sigma = noise();
    let covariance = ContactCovariance::new(&jacobian, &sigma);
    let [e1, e2] = covariance.tangents();
    let in_plane = Matrix2::new(e1.x, e1.y, e2.x, e2.y);
    let c = contact.point;
    #[rustfmt::skip]
    let by_wrench = Matrix2x6::new(
        HEIGHT, 0.0, -c.x, 0.0, -1.0, 0.0,
        0.0, HEIGHT, -c.y, 1.0, 0.0, 0.0,
    ) / force.z;
    let torque = c.cross(&force);
    let pitch = Vector6::new(torque.x, torque.y, torque.z, force.x, force.y, force.z) / force.norm_squared();
    let by_wrench = by_wrench - by_wrench.fixed_columns::<3>(3) * force * pitch.transpose();
    let position = in_plane * (by_wrench * sigma * by_wrench.transpose()) * in_plane.transpose();
    assert!(close(&covariance.position(), &position));
    let of_force = in_plane * sigma.fixed_view::<2, 2>(0, 0) * in_plane.transpose();
    assert!(close(&covariance.tangential_force(), &of_force));
    assert!((covariance.normal_force_variance() / sigma[(2, 2)] - 1.0).abs() < 1e-12);
    assert_eq!((covariance.spin_variance(), covariance.height_variance()), (0.0, 0.0));

    // In the sensor's frame it lies in the plane.
    let point = covariance.point();
    let exact = by_wrench * sigma * by_wrench.transpose();
    assert!(close(&point.fixed_view::<2, 2>(0, 0).into_owned(), &exact));
    assert_eq!((point * Vector3::z()).norm(), 0.0);

    // Of the magnitude of the tangential force, the noise along it counts.
    let along = force.xy().normalize();
    let of_parts = covariance.normal_and_tangential(&contact);
    let across = -(sigma.fixed_view::<1, 2>(2, 0) * along)[0];
    let tangential = (along.transpose() * sigma.fixed_view::<2, 2>(0, 0) * along)[0];
    assert!(close(&of_parts, &Matrix2::new(sigma[(2, 2)], across, across, tangential)), "{of_parts}");
}

/// Where there is no tangential force the greater of its two variances stands in for that of its magnitude.
#[test]
fn without_tangential_force_the_greater_variance_counts() {
    let (contact, jacobian) = on_plane(v(0.0, 0.0, -1.5));
    for deviations in [[1.0, 3.0], [3.0, 1.0]] {
        let sigma = Matrix6::from_diagonal(&Vector6::new(
            deviations[0] * deviations[0],
            deviations[1] * deviations[1],
            4.0,
            0.0,
            0.0,
            0.0,
        ));
        let covariance = ContactCovariance::new(&jacobian, &sigma);
        let found = covariance.normal_and_tangential(&contact);
        assert!(close(&found, &Matrix2::new(4.0, 0.0, 0.0, 9.0)), "{found}");
    }
}

/// The ellipse holds `1 − exp(−s²/2)` of a Gaussian at `s` deviations; its axes are the eigenvectors.
#[test]
fn the_ellipse_has_the_axes_of_the_covariance() {
    let (_, jacobian) = on_plane(v(0.3, -0.2, -1.5));
    for sigma in [noise(), Matrix6::from_diagonal(&Vector6::new(0.0, 0.0, 0.0, 4e-10, 1e-10, 0.0))] {
        let covariance = ContactCovariance::new(&jacobian, &sigma);
        for probability in [0.1, 0.5, 0.95] {
            let ellipse = covariance.ellipse(probability).unwrap();
            let size: f64 = (-2.0 * (1.0 - probability).ln()).sqrt();
            let [a, b] = ellipse.directions;
            assert!(ellipse.semi_axes[0] >= ellipse.semi_axes[1]);
            assert!((a.norm() - 1.0).abs() < 1e-14 && (b.norm() - 1.0).abs() < 1e-14);
            assert!(a.dot(&b).abs() < 1e-14 && a.z.abs() + b.z.abs() < 1e-14);
            let [e1, e2] = covariance.tangents();
            for (direction, axis) in ellipse.directions.iter().zip(ellipse.semi_axes) {
                let direction = Vector2::new(direction.dot(&e1), direction.dot(&e2));
                let stretched = covariance.position() * direction * (size * size);
                let off = stretched - direction * (axis * axis);
                assert!(off.norm() < 1e-13 * ellipse.semi_axes[0].powi(2), "{off} {ellipse:?}");
            }
        }
        for bad in [0.0, 1.0, -0.5, 1.5, f64::NAN] {
            assert!(covariance.ellipse(bad).is_none());
        }
    }
}

/// A plane that is uncertain in height, place and attitude moves the contact as its motion does.
#[test]
fn an_uncertain_plane_moves_the_contact() {
    let force = v(0.3, -0.2, -1.5);
    let (contact, jacobian) = on_plane(force);
    let nothing = ContactCovariance::new(&jacobian, &Matrix6::zeros());
    let pivot = v(0.001, 0.002, 0.005);
    // A plane that rises by 1 is met where the line is higher by 1; one that turns about x by 1 rises by
    // y − y₀ and tilts; along itself it does not move.
    let slide = force.xy() / force.z;
    let rise = contact.point.y - pivot.y;
    let [e1, e2] = nothing.tangents();
    let local = |xy: Vector2<f64>| Vector2::new(e1.x * xy.x + e1.y * xy.y, e2.x * xy.x + e2.y * xy.y);
    let square = |v: Vector2<f64>| v * v.transpose();
    let none = GeometryUncertainty::none();
    let of = |uncertain: &GeometryUncertainty<f64>| nothing.with_geometry(&jacobian, uncertain);
    let raised = of(&GeometryUncertainty { offset: 4e-10, ..none });
    assert!(close(&raised.position(), &(square(local(slide)) * 4e-10)));
    assert!((raised.height_variance() / 4e-10 - 1.0).abs() < 1e-12);
    let mut place = Matrix3::from_diagonal(&v(7e-10, 5e-10, 4e-10));
    let moved = of(&GeometryUncertainty { position: place, ..none });
    assert!((moved.position() - raised.position()).norm() < 1e-12 * raised.position().norm());
    assert!((moved.height_variance() / 4e-10 - 1.0).abs() < 1e-12);
    place[(2, 2)] = 0.0;
    assert!(of(&GeometryUncertainty { position: place, ..none }).local().norm() < 1e-25);
    let attitude = Matrix3::from_diagonal(&v(1e-6, 0.0, 0.0));
    let turned = of(&GeometryUncertainty { attitude, pivot, ..none });
    // The normal force is −f·n with n = (0, −1, 0) per radian about x.
    assert!(close(&turned.position(), &(square(local(slide * rise)) * 1e-6)));
    assert!((turned.normal_force_variance() / (force.y.powi(2) * 1e-6) - 1.0).abs() < 1e-12);
    let with_one = nothing.with_parameter(&jacobian, &GeometrySensitivity::offset(), 4e-10);
    assert_eq!(with_one, raised);
    assert_eq!(nothing.with_parameter(&jacobian, &GeometrySensitivity::none(), 1.0), nothing);
}

/// Where a tangent and the other hardly belong together, or hardly differ, and at any size, the axes of the
/// ellipse stay eigenvectors: `λ₁ + λ₂` and `λ₁ λ₂` are those of the covariance.
#[test]
fn the_ellipse_is_right_however_unequal_its_numbers() {
    // Pressed squarely, the covariance of the position is that of the torque, with every zero in it.
    let squarely = on_plane(v(0.0, 0.0, -1.5)).1;
    let askew = on_plane(v(0.3, -0.2, -1.5)).1;
    for (size, jacobian) in
        [1e-140, 1e-10, 1.0, 1e140].into_iter().flat_map(|size| [(size, squarely), (size, askew)])
    {
        for mixed in [0.0, 1e-200, 1e-12, 0.5, -0.9] {
            for apart in [1.0, 1.0 + 1e-12, 4.0, 0.25_f64] {
                let sigma = Matrix6::from_fn(|i, j| match (i, j) {
                    (3, 3) => size,
                    (4, 4) => size * apart,
                    (3, 4) | (4, 3) => size * mixed * apart.min(1.0),
                    _ => 0.0,
                });
                let covariance = ContactCovariance::new(&jacobian, &sigma);
                let p = covariance.position();
                let ellipse = covariance.ellipse(1.0 - (-0.5_f64).exp()).unwrap();
                let [one, other] = ellipse.semi_axes.map(|axis| axis * axis / size);
                let (trace, determinant) = ((p / size).trace(), (p / size).determinant());
                assert!(
                    (one + other - trace).abs() < 1e-13 * trace,
                    "{size:e} {mixed:e} {apart} {ellipse:?}"
                );
                assert!((one * other - determinant).abs() < 1e-13 * trace * trace, "{ellipse:?} {p}");
                let [e1, e2] = covariance.tangents();
                let a = ellipse.directions[0];
                let a = Vector2::new(a.dot(&e1), a.dot(&e2));
                assert!((p / size * a - a * one).norm() < 1e-13 * trace, "{size:e} {mixed:e} {apart}");
            }
        }
    }
}
