//! The rigorous bound is sharp: errors of the stated size carry the contact as far as it says.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_test_support::Worst;
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

/// The polygon's corners are this much farther from the axis than its sides: what the bound loses where the
/// contact moves along the force.
const CORNER: f64 = 1.0824;

/// How far the contact moves from `measured` at most, and how far against the force, over errors of the
/// torque of the length `size` in 360 directions across the force. (Along it they change the pitch only.)
fn moved_by_torque<S: ActiveSurface<f64>>(surface: &S, measured: &Wrench<f64>, size: f64) -> [f64; 2] {
    let at = |wrench: &Wrench<f64>| {
        PointContact::new(0.0).unwrap().resolve(wrench, surface).contact().unwrap().point
    };
    let found = at(measured);
    let push = measured.force().normalize();
    let across = push.cross(&Vector3::new(0.3, -0.5, 0.8)).normalize();
    let other = push.cross(&across);
    let (mut far, mut back) = (Worst::new(), Worst::new());
    for degree in 0..360 {
        let (sin, cos) = f64::from(degree).to_radians().sin_cos();
        let error = (across * cos + other * sin) * size;
        let moved = at(&Wrench::on_fingertip(measured.force(), measured.torque() + error)) - found;
        far.see(moved.norm());
        back.see(moved.dot(&push).min(0.0));
    }
    [far.get(), back.get()]
}

/// Small errors of the torque alone, at incidences up to 65°. The region ends where they carry the contact
/// against the force, to a thousandth, and exceeds what they do otherwise by less than the polygon's corners.
fn torque_errors_attain_it<S: ActiveSurface<f64>>(
    name: &str,
    surface: &S,
    points: &[Vector3<f64>],
    far: f64,
) {
    for point in points {
        let normal = surface.normal(point);
        let aside = normal.cross(&Vector3::new(-0.2, 0.7, 0.4)).normalize();
        for tangent in [0.0, 0.5, 1.0, 2.0] {
            let measured = Wrench::from_force_at(point, (aside * tangent - normal) * 1.5);
            let size = 1e-8;
            let bound = ConvexBound::new(surface, &measured, &WorstErrors::of_wrench(0.0, size), far);
            let bound = bound.unwrap_or_else(|| panic!("{name} {tangent}"));
            let [attained, back] = moved_by_torque(surface, &measured, size);
            let ratio = bound.distance / attained;
            let corner = if tangent > 0.0 { CORNER } else { 1.001 };
            assert!((1.0..corner).contains(&ratio), "{name} {tangent}: {ratio} {bound:?}");
            assert!((bound.along[0] + back).abs() < 1e-3 * attained, "{name} {tangent}: {bound:?} {back:e}");
            // The line itself moves by the error over the force, exactly.
            let shift = size / measured.force().norm();
            assert!((bound.across / shift - 1.0).abs() < 1e-6, "{name}: {} {shift}", bound.across);
            assert!(!bound.past_silhouette);
        }
    }
}

#[test]
fn errors_of_the_torque_attain_it() {
    let ball = Sphere::new(Vector3::new(0.001, -0.002, 0.003), 0.013).unwrap();
    let on_ball =
        [Vector3::new(0.6, 0.0, 0.8), Vector3::new(-0.48, 0.64, -0.6)].map(|n| ball.centre() + n * 0.013);
    torque_errors_attain_it("sphere", &ball, &on_ball, 0.02);
    let plane = Plane::new(Vector3::new(0.001, 0.002, 0.005), Vector3::z()).unwrap();
    torque_errors_attain_it("plane", &plane, &[Vector3::new(0.004, -0.001, 0.005)], 0.03);
    let egg = Ellipsoid::new(Vector3::new(0.008, 0.011, 0.017)).unwrap();
    let on_egg = [Vector3::new(0.6, 0.0, 0.8), Vector3::new(-0.48, 0.64, -0.6)]
        .map(|n| n.component_mul(&egg.semi_axes()));
    torque_errors_attain_it("ellipsoid", &egg, &on_egg, 0.02);
    let tip = Capsule::new(Vector3::zeros(), Vector3::z(), 0.006, 0.007).unwrap();
    let on_tip = [Vector3::new(0.0, 0.0042, 0.0116), Vector3::new(0.007, 0.0, 0.002)];
    torque_errors_attain_it("capsule", &tip, &on_tip, 0.02);
}

/// An error of the force alone, across a force that presses squarely: the lever is the distance of the
/// contact, whatever greater reach was given.
#[test]
fn errors_of_the_force_attain_it() {
    let sphere = Sphere::centred(0.013).unwrap();
    let (size, pressing) = (1e-7, Vector3::new(0.0, 0.0, -1.5));
    let measured = Wrench::on_fingertip(pressing, Vector3::zeros());
    for reach in [0.0131, 0.02, 0.5] {
        let errors = WorstErrors::of_wrench(size, 0.0);
        let bound = ConvexBound::new(&sphere, &measured, &errors, reach).unwrap();
        // The true force f + δ at c has the measured torque, zero, about the origin if c moves by r δ/f.
        let moved = 0.013 * size / 1.5;
        let ratio = bound.distance / moved;
        let lever: f64 = if reach > 0.0131 { 1.0 } else { reach / 0.013 };
        assert!((ratio / lever - 1.0).abs() < 1e-3, "{reach}: {ratio}");
    }
}

/// A sphere that is smaller or larger by the stated error is met that much later or sooner.
#[test]
fn errors_of_the_shape_attain_it() {
    let (radius, wrong) = (0.013, 1e-8);
    let sphere = Sphere::centred(radius).unwrap();
    let model = PointContact::new(0.0).unwrap();
    for tangent in [0.0, 0.5, 1.0, 2.0] {
        let point = Vector3::z() * radius;
        let measured = Wrench::from_force_at(&point, Vector3::new(tangent, 0.0, -1.0));
        let none = WorstErrors::of_wrench(0.0, 0.0);
        for errors in [WorstErrors { radius: wrong, ..none }, WorstErrors { centre: wrong, ..none }] {
            let bound = ConvexBound::new(&sphere, &measured, &errors, 0.02).unwrap();
            let attained = [wrong, -wrong].map(|wrong| {
                let truth = Sphere::centred(radius + wrong).unwrap();
                (model.resolve(&measured, &truth).contact().unwrap().point - point).norm()
            });
            let ratio = bound.distance / Worst::of(attained).get();
            assert!((1.0..CORNER).contains(&ratio), "{tangent}: {ratio} {bound:?}");
            // Sooner is against the force.
            assert!((bound.along[0] + attained[0]).abs() < 1e-3 * wrong, "{bound:?} {attained:?}");
            assert!((1.0..CORNER).contains(&(bound.along[1] / attained[1])), "{bound:?} {attained:?}");
        }
    }
}
