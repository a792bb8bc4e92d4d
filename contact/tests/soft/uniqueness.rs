//! How many contacts a wrench can have (`docs/theory/contact.md#uniqueness`), by a search that shares nothing
//! with ours: plain Newton on the four equations in `(c, K)` from anywhere.

use fingertip_contact::SoftFingerSurface;
use fingertip_surfaces::{ActiveSurface, SmoothSurface};
use fingertip_test_support::Worst;
use fingertip_wrench::Wrench;
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

use crate::common;
use crate::wrenches::{Case, Random};

/// `G = (K/2 g + c × f − m, S)`.
fn equations<S: SmoothSurface<f64>>(
    surface: &S,
    wrench: &Wrench<f64>,
    c: &Vector3<f64>,
    k: f64,
) -> (Vector4<f64>, Matrix4<f64>) {
    let level = surface.level(c);
    let force = wrench.force();
    let rest = level.gradient * (k / 2.0) + c.cross(&force) - wrench.torque();
    let block: Matrix3<f64> = level.hessian * (k / 2.0) - force.cross_matrix();
    let mut jacobian = Matrix4::zeros();
    jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&block);
    jacobian.fixed_view_mut::<3, 1>(0, 3).copy_from(&(level.gradient / 2.0));
    jacobian.fixed_view_mut::<1, 3>(3, 0).copy_from(&level.gradient.transpose());
    (Vector4::new(rest.x, rest.y, rest.z, level.value), jacobian)
}

/// A solution from a start, and whether it presses.
pub(crate) fn newton<S: SmoothSurface<f64>>(
    surface: &S,
    wrench: &Wrench<f64>,
    start: Vector3<f64>,
    random: &mut Random,
) -> Option<(Vector3<f64>, bool)> {
    let extent = surface.extent();
    let load = wrench.force().norm() * extent.radius + wrench.torque().norm();
    let mut c = start;
    let mut k = load / surface.level(&c).gradient.norm() * random.uniform(-4.0, 4.0);
    for _ in 0..80 {
        let (value, jacobian) = equations(surface, wrench, &c, k);
        let step = jacobian.lu().solve(&value)?;
        let length = step.xyz().norm();
        let damping = (0.3 * extent.radius / length).min(1.0);
        c -= step.xyz() * damping;
        k -= step.w * damping;
        if !(c - extent.centre).norm().is_finite() || (c - extent.centre).norm() > 3.0 * extent.radius {
            return None;
        }
        if length < 1e-13 * extent.radius {
            let level = surface.level(&c);
            let (rest, _) = equations(surface, wrench, &c, k);
            let solved = rest.xyz().norm() < 1e-12 * load
                && rest.w.abs() < 1e-12 * level.gradient.norm() * extent.radius;
            return solved.then(|| (c, wrench.force().dot(&level.gradient) < 0.0));
        }
    }
    None
}

/// On a closed convex surface with `f·m ≠ 0` exactly one contact presses and exactly one pulls.
fn one_of_each<S: SoftFingerSurface<f64> + SmoothSurface<f64>>(name: &str, surface: &S, size: f64) {
    let mut random = Random::new(71);
    let (mut ends, mut pulling_found) = (0, 0);
    let problems = 150;
    for _ in 0..problems {
        let case = Case::random(&mut random, surface, size, [1e-3, 10.0], 1.0);
        let mut ours = Vec::new();
        let _ = surface.soft_contacts(&case.wrench, None, |contact| ours.push(contact.point));
        assert_eq!(ours.len(), 1, "{name} {case:?}");
        let mut pulls: Option<Vector3<f64>> = None;
        for _ in 0..40 {
            let start = random.place(surface, size).0;
            let Some((point, pressing)) = newton(surface, &case.wrench, start, &mut random) else { continue };
            ends += 1;
            if pressing {
                assert!((point - ours[0]).norm() < 1e-9 * size, "{name} {point} {ours:?} {case:?}");
            } else {
                let known = pulls.get_or_insert(point);
                assert!((point - *known).norm() < 1e-9 * size, "{name} {point} {known} {case:?}");
            }
        }
        pulling_found += usize::from(pulls.is_some());
    }
    println!(
        "{name:12} {problems} problems × 40 starts, {ends} ends: one contact that presses, one that pulls"
    );
    assert!(ends > problems * 10, "{name}: only {ends} starts ended");
    assert!(pulling_found * 10 > problems * 9, "{name}: {pulling_found}");
}

#[test]
fn convex_surfaces_have_one_contact() {
    one_of_each("sphere", &common::sphere::<f64>(), 0.017);
    one_of_each("ellipsoid", &common::ellipsoid::<f64>(), 0.017);
    one_of_each("pillow", &common::pillow::<f64>(), 0.012);
    one_of_each("superquadric", &common::superquadric::<f64>(), 0.017);
}

/// `det J = −½ [(K²/4)|g|⁴ κ + (f·g)²]`, `κ = gᵀ adj(H) g/|g|⁴`: for any level function.
fn determinant<S: SmoothSurface<f64> + ActiveSurface<f64>>(name: &str, surface: &S, size: f64) {
    let mut random = Random::new(72);
    let mut worst = Worst::new();
    for _ in 0..2000 {
        let (point, _) = random.place(surface, size);
        let level = surface.level(&point);
        let (g, h) = (level.gradient, level.hessian);
        let force = random.direction();
        let k = random.uniform(-2.0, 2.0) * size / g.norm();
        let wrench = Wrench::on_fingertip(force, random.direction());
        let (_, jacobian) = equations(surface, &wrench, &point, k);
        let minor = |i: usize, j: usize| {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            let (c, d) = ((j + 1) % 3, (j + 2) % 3);
            h[(a, c)] * h[(b, d)] - h[(a, d)] * h[(b, c)]
        };
        let adjugate = Matrix3::from_fn(minor);
        let bent = k * k / 4.0 * g.dot(&(adjugate * g));
        let expected = -0.5 * (bent + force.dot(&g).powi(2));
        let scale = g.norm_squared() * (1.0 + (k * h.norm()).powi(2));
        worst.see((jacobian.determinant() - expected) / scale);
    }
    let worst = worst.get();
    println!("{name:12} det J as in docs/theory/contact.md#general-surfaces to {worst:.1e}");
    assert!(worst < 1e-14, "{name} {worst:e}");
}

#[test]
fn determinant_of_the_jacobian() {
    determinant("sphere", &common::sphere::<f64>(), 0.017);
    determinant("ellipsoid", &common::ellipsoid::<f64>(), 0.017);
    determinant("cylinder", &common::cylinder::<f64>(), 0.017);
    determinant("cone", &common::cone::<f64>(), 0.017);
    determinant("paraboloid", &common::paraboloid::<f64>(), 0.02);
    determinant("pillow", &common::pillow::<f64>(), 0.012);
    determinant("superquadric", &common::superquadric::<f64>(), 0.017);
    determinant("torus", &common::torus::<f64>(), 0.0135);
}

/// On a saddle two contacts merge where `|τ|√(−κ) = |f·n|`: past it both are gone.
#[test]
fn contacts_merge_in_a_fold() {
    let torus = fingertip_surfaces::Torus::new(1.0, 0.35).unwrap();
    let (mut random, mut folds) = (Random::new(73), 0);
    for _ in 0..2000 {
        // On the inner side, with the spin torque of the fold there.
        let angle = random.uniform(0.0, core::f64::consts::TAU);
        let inward = Vector3::new(-angle.cos(), -angle.sin(), random.uniform(-0.5, 0.5)).normalize();
        let centre = Vector3::new(angle.cos(), angle.sin(), 0.0);
        let point = centre + inward * 0.35;
        let bend = torus.shape_operator(&point);
        let curvature = (bend.trace().powi(2) - bend.norm_squared()) / 2.0;
        let force = random.force(&inward, 0.5, 1.0);
        let fold = -force.dot(&inward) / (-curvature).sqrt();
        let count = |spin: f64| {
            let case = Case::new(point, inward, force, spin);
            let mut near = 0;
            let _ = torus.soft_contacts(&case.wrench, None, |c| {
                near += usize::from((c.point - point).norm() < 0.05);
            });
            near
        };
        // On either side of the fold the contact has a partner close by.
        if count(fold * 0.999) == 2 && count(fold * 1.001) == 2 {
            folds += 1;
        }
    }
    println!("folds of the torus: {folds} of 2000 have both contacts within 0.05 R on either side");
    assert!(folds > 1500, "{folds}");
}
