//! Covariance and worst case of a contact through a skin.

use fingertip_contact::{CompliantContact, CompliantSoftFinger, Contact, ContactCovariance, SoftFinger};
use fingertip_test_support::Worst;
use fingertip_wrench::Wrench;
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::common;
use crate::skin::*;
use crate::uncertainty::{noisy, wrench_covariance};
use crate::wrenches::Random;

/// Position, normal and tangential force and spin torque of a contact through a skin under noise, and its
/// height.
#[test]
fn covariance_matches_monte_carlo() {
    let surface = common::ellipsoid::<f64>();
    let law = hertz::<f64>();
    let mut random = Random::new(109);
    for model in &Model::both(law, 0.9) {
        // 2 N, so that the noise of 1 mN is small.
        let wrench = wrench_through(&mut random, &surface, &law, 0.9, model.spin());
        let wrench = {
            let scale = 2.0 / wrench.force().norm();
            Wrench::on_fingertip(wrench.force() * scale, wrench.torque() * scale)
        };
        let covariance = wrench_covariance(&mut random);
        let factor = covariance.cholesky().unwrap().l();
        let truth = model.found(&wrench, &surface);
        let jacobian = model.jacobian(&truth, &wrench, &surface);
        let predicted = ContactCovariance::new(&jacobian, &covariance);
        let only = ContactCovariance::position_only(&jacobian, &covariance);
        assert!((only - predicted.position()).norm() <= 1e-13 * only.norm());
        let ellipse = predicted.ellipse(0.95).unwrap();
        let [e1, e2] = predicted.tangents();
        let (mut sums, mut height, mut inside) = (Matrix6::zeros(), 0.0, 0);
        let count = 25_000;
        for _ in 0..count {
            let found = model.found(&noisy(&mut random, &wrench, &factor), &surface);
            let contact = found.contact;
            let moved = contact.point - truth.contact.point;
            let slid = contact.tangential_force() - truth.contact.tangential_force();
            let numbers = Vector6::new(
                moved.dot(&e1),
                moved.dot(&e2),
                contact.normal_force() - truth.contact.normal_force(),
                slid.dot(&e1),
                slid.dot(&e2),
                contact.spin_torque - truth.contact.spin_torque,
            );
            sums += numbers * numbers.transpose();
            // Not along the normal, where the curvature of the surface is seen too.
            height += ((found.indentation.depth - truth.indentation.depth) * 0.9).powi(2);
            let [a, b] = [0, 1].map(|i| moved.dot(&ellipse.directions[i]) / ellipse.semi_axes[i]);
            inside += usize::from(a * a + b * b <= 1.0);
        }
        let (sampled, rows) = (sums / f64::from(count), if model.spin() < 0.1 { 5 } else { 6 });
        let deviations = predicted.local().diagonal().map(f64::sqrt);
        let mut worst = Worst::of([height / f64::from(count) / predicted.height_variance() - 1.0]);
        for i in 0..rows {
            for j in 0..rows {
                let off =
                    (sampled[(i, j)] - predicted.local()[(i, j)]).abs() / (deviations[i] * deviations[j]);
                assert!(off < 0.03, "{i} {j} {off}");
                worst.see(off);
            }
        }
        let coverage = inside as f64 / f64::from(count);
        println!(
            "through a skin, Monte Carlo deviates {:.2} %, 95 % ellipse holds {:.2} %",
            100.0 * worst.get(),
            100.0 * coverage
        );
        assert!(worst.get() < 0.03 && (0.94..=0.96).contains(&coverage), "{worst:?} {coverage}");
    }
}

/// The worst case over a box of errors is that of a corner, height included; where the skin gives way
/// without end there is no Jacobian.
#[test]
fn worst_cases_and_none() {
    let surface = common::ellipsoid::<f64>();
    let mut random = Random::new(113);
    let model =
        CompliantSoftFinger::new(SoftFinger::new(0.0).unwrap().without_friction_limit(), hertz::<f64>());
    let wrench = wrench_through(&mut random, &surface, &hertz::<f64>(), 1.0, 1.0);
    let found = model.resolve_indented(&wrench, &surface, None).unwrap();
    let jacobian = model.jacobian(&found, &surface).unwrap();
    let limits = Vector6::new(0.01, 0.02, 0.03, 1e-4, 2e-4, 3e-4);
    let corners = (0..64_u8).map(|corner| {
        let signs = Vector6::from_fn(|i, _| if corner >> i & 1 == 1 { 1.0 } else { -1.0 });
        (jacobian.point() * limits.component_mul(&signs)).norm()
    });
    let worst = jacobian.worst_case(&limits).distance;
    assert!((worst / corners.fold(0.0, f64::max) - 1.0).abs() < 1e-12);
    // At no force Hertz's skin gives way without end.
    let lifted = CompliantContact { contact: Contact { force: Vector3::zeros(), ..found.contact }, ..found };
    assert!(model.jacobian(&lifted, &surface).is_none());
    let nan = Contact { spin_torque: f64::NAN, ..found.contact };
    assert!(model.jacobian(&CompliantContact { contact: nan, ..found }, &surface).is_none());
}
