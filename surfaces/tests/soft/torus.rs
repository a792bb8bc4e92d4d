//! All solutions on a surface that is not convex.

use fingertip_surfaces::{Search, SmoothSurface, SoftContact, SoftFingerSurface, Torus};
use fingertip_wrench::Wrench;
use nalgebra::{Matrix3, Vector3};

use crate::common::{Case, Random};

fn all(torus: &Torus<f64>, wrench: &Wrench<f64>) -> (Vec<SoftContact<f64>>, Search<f64>) {
    let mut found = Vec::new();
    let search = torus.soft_contacts(wrench, None, |contact| found.push(contact));
    (found, search)
}

/// `τ²κ + (f·n)²`.
fn index(torus: &Torus<f64>, force: &Vector3<f64>, contact: &SoftContact<f64>) -> f64 {
    let bend = torus.shape_operator(&contact.point);
    // The Gaussian curvature: the sum of the principal minors, as one eigenvalue is zero.
    let minor = |i: usize, j: usize| bend[(i, i)] * bend[(j, j)] - bend[(i, j)] * bend[(j, i)];
    let curvature = minor(0, 1) + minor(1, 2) + minor(0, 2);
    contact.spin_torque.powi(2) * curvature + force.dot(&contact.normal).powi(2)
}

/// The true contact is among the solutions; all of them solve the equations; as many have a
/// positive as have a negative index, so their number is even.
#[test]
fn counts() {
    let torus = Torus::new(1.0, 0.35).unwrap();
    let mut random = Random::new(3);
    let mut counts = [0; 9];
    for _ in 0..1500 {
        let spin = random.log_uniform(1e-3, 3.0);
        let case = Case::random(&mut random, &torus, 1.4, [spin / 1.4, spin / 1.4 * 1.0001], 1.0);
        let (found, search) = all(&torus, &case.wrench);
        assert!(matches!(search, Search::Complete), "{case:?} {found:?}");
        counts[found.len().min(8)] += 1;
        let force = case.wrench.force();
        assert!(found.iter().any(|c| (c.point - case.point).norm() < 1e-7), "{case:?} {found:?}");
        let mut sum = 0.0;
        for contact in &found {
            let residual =
                contact.point.cross(&force) + contact.normal * contact.spin_torque - case.wrench.torque();
            assert!(residual.norm() < 1e-12 * (1.0 + case.wrench.torque().norm()), "{residual}");
            assert!(torus.level(&contact.point).value.abs() < 1e-13);
            assert!(force.dot(&contact.normal) < 0.0);
            sum += index(&torus, &force, contact).signum();
        }
        assert!(sum.abs() < 0.5 && found.len() % 2 == 0);
    }
    println!("torus R = 1, r = 0.35: solutions 0..8 in {counts:?} of 1500");
    assert!(counts[2] > counts[4] && counts[4] > 0 && counts[6] + counts[8] < counts[4]);
}

/// `det [[K/2 H − [f], g/2], [gᵀ, 0]] = −½ [(K²/4)|g|⁴ κ + (f·g)²]` (theory 3.4), here with the
/// signed distance as level function: `|g| = 1`, `K = 2τ`.
#[test]
fn determinant_of_the_jacobian() {
    let torus = Torus::new(1.0, 0.35).unwrap();
    let mut random = Random::new(4);
    for _ in 0..2000 {
        let (point, normal) = random.place(&torus, 1.4);
        let force = random.direction();
        let tau = random.uniform(-2.0, 2.0);
        let level = torus.level(&point);
        let block: Matrix3<f64> = level.hessian * tau - force.cross_matrix();
        let mut jacobian = nalgebra::Matrix4::zeros();
        jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&block);
        jacobian.fixed_view_mut::<3, 1>(0, 3).copy_from(&(normal * 0.5));
        jacobian.fixed_view_mut::<1, 3>(3, 0).copy_from(&normal.transpose());
        let contact = SoftContact { point, normal, spin_torque: tau, active: true };
        let expected = -0.5 * index(&torus, &force, &contact);
        let scale = 1.0 + tau * tau * 10.0;
        assert!(
            (jacobian.determinant() - expected).abs() < 1e-13 * scale,
            "{} {expected}",
            jacobian.determinant()
        );
    }
}
