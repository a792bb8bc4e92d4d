//! The rigorous bound is sharp: errors of the stated size carry the contact as far as it says.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_test_support::Worst;
use fingertip_wrench::{Line, Wrench};
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
    let tip = Capsule::new(Vector3::zeros(), Vector3::z(), 0.007, 0.006).unwrap();
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

/// The region of the theorem, written down again from its statement: where along the force the contact may be,
/// counted from the entry of the line of action, and whether the silhouette may be passed.
fn by_the_statement<S: ActiveSurface<f64>>(
    surface: &S,
    measured: &Wrench<f64>,
    errors: &WorstErrors<f64>,
    reach: f64,
) -> ([f64; 2], bool) {
    let axis = measured.line_of_action().unwrap().line;
    let (u, force) = (axis.direction, measured.force().norm());
    let epsilon = (errors.torque + reach * errors.force) / force;
    let (shape, sigma) = (errors.radius + errors.centre, errors.force / force);
    let chord = |offset: Vector3<f64>| {
        let (mut entry, mut exit) = (None, None);
        surface.crossings(&Line { point: axis.point + offset, direction: u }, |crossing| {
            let end = if crossing.normal.dot(&u) < 0.0 { &mut entry } else { &mut exit };
            *end = Some((crossing.point, crossing.normal));
        });
        entry.zip(exit)
    };
    let ((origin, _), _) = chord(Vector3::zeros()).unwrap();
    let (mut low, mut high) = (-reach - origin.dot(&u), reach - origin.dot(&u));
    let (mut latest, mut soonest, mut all) = (0.0_f64, f64::INFINITY, true);
    let mut see = |offset: Vector3<f64>, high: &mut f64| {
        let Some((entry, exit)) = chord(offset) else {
            all = false;
            return;
        };
        let slack =
            |n: Vector3<f64>| (shape + epsilon * n.cross(&u).norm() + n.dot(&offset)) / n.dot(&u).abs();
        let [a, e] = [entry, exit].map(|(point, _)| (point - origin).dot(&u));
        low = low.max(a - slack(entry.1));
        *high = high.min(e + slack(exit.1));
        latest = latest.max(a);
        soonest = soonest.min(e);
    };
    see(Vector3::zeros(), &mut high);
    let cosine = (1.0 - sigma * sigma).sqrt();
    // A sixteenth wider than the least that the third statement asks for.
    let inner = (epsilon + shape + high * sigma / cosine) * 1.0625;
    let (first, second) = numeric::vectors::tangents(&u);
    let outer = inner / (core::f64::consts::PI / 8.0).cos();
    for corner in 0..8 {
        let (sine, cosine) = (core::f64::consts::FRAC_PI_4 * f64::from(corner)).sin_cos();
        see((first * cosine + second * sine) * outer, &mut high);
    }
    let rise = epsilon / inner * latest + shape * (1.0 + (latest / inner).powi(2)).sqrt();
    let deep = rise + shape < soonest && latest + 2.0 * shape < soonest;
    let past = !(all && deep && (inner - shape - epsilon) * cosine > high * sigma);
    ([low, if past { high } else { high.min(rise) }], past)
}

/// With errors of all kinds and sizes, up to such that the silhouette may be passed and lines beside the contact
/// miss, the bound is what its statement says.
#[test]
fn it_says_what_the_theorem_states() {
    let ball = Sphere::new(Vector3::new(0.001, -0.002, 0.003), 0.013).unwrap();
    let egg = Ellipsoid::new(Vector3::new(0.008, 0.011, 0.017)).unwrap();
    let tip = Capsule::new(Vector3::zeros(), Vector3::z(), 0.007, 0.006).unwrap();
    let mut passed = [0; 2];
    let mut check = |surface: &DynSurface<f64>, far: f64, uncertain: f64| {
        for k in 1..=200 {
            let at = |step: f64| (f64::from(k) * step).sin();
            let through = Vector3::new(at(1.1), at(2.3), at(3.7)) * 0.007;
            let force = Vector3::new(at(1.7), at(2.9), at(0.6)).normalize() * 1.5;
            let measured = Wrench::from_force_at(&through, force);
            let size = 10_f64.powf(-3.5 + 2.5 * at(4.1));
            let errors = WorstErrors {
                force: size * (1.0 + at(0.3)),
                torque: 0.01 * size * (1.0 + at(0.7)),
                radius: 0.002 * size * (1.0 + at(0.9)) + uncertain * (1.0 + at(6.1)),
                centre: 0.002 * size * (1.0 + at(5.3)),
            };
            let found = PointContact::new(0.0).unwrap().resolve(&measured, surface);
            let Some(contact) = found.contact() else { continue };
            let bound = ConvexBound::new(surface, &measured, &errors, far);
            let bound = bound.unwrap_or_else(|| panic!("{measured:?} {errors:?}"));
            let (mut along, mut past) = by_the_statement(surface, &measured, &errors, far);
            let mut reach = far;
            let across = |reach: f64| (errors.torque + reach * errors.force) / 1.5;
            let distance =
                |along: [f64; 2], reach: f64| along[0].abs().max(along[1].abs()).hypot(across(reach));
            let nearer = contact.point.norm() + distance(along, reach);
            if nearer < 0.9 * far {
                let (again, again_past) = by_the_statement(surface, &measured, &errors, nearer);
                if distance(again, nearer) < distance(along, reach) {
                    (along, past, reach) = (again, again_past, nearer);
                }
            }
            let hair = 1e-6 * distance(along, reach) + 1e-15;
            let off = (bound.along[0] - along[0]).abs().max((bound.along[1] - along[1]).abs());
            assert!(off < hair, "{bound:?} {along:?} {measured:?} {errors:?}");
            assert!(
                (bound.across - across(reach)).abs() < hair && bound.past_silhouette == past,
                "{bound:?} {past}"
            );
            assert!((bound.distance - distance(along, reach)).abs() < hair, "{bound:?}");
            passed[usize::from(past)] += 1;
        }
    };
    // Of a shape that is known but for a quarter of its size, too.
    for uncertain in [0.0, 0.003] {
        check(&ball.into(), 0.02, uncertain);
        check(&egg.into(), 0.02, uncertain);
        check(&tip.into(), 0.02, uncertain);
    }
    assert!(passed.iter().all(|count| *count > 20), "{passed:?}");
}

/// A line that misses by more than the errors explain is of no contact; by less, it is of one at the silhouette.
#[test]
fn a_miss_is_explained_or_not() {
    let ball = Sphere::<f64>::centred(0.013).unwrap();
    let force = Vector3::new(0.0, 0.0, -1.5);
    for (kind, errors) in [
        WorstErrors::of_wrench(0.0, 1.5e-3),
        WorstErrors { radius: 1e-3, ..WorstErrors::of_wrench(0.0, 0.0) },
        WorstErrors { centre: 1e-3, ..WorstErrors::of_wrench(0.0, 0.0) },
        WorstErrors { radius: 4e-4, centre: 3e-4, ..WorstErrors::of_wrench(0.0, 4.5e-4) },
    ]
    .into_iter()
    .enumerate()
    {
        for (gap, explained) in
            [(9e-4, true), (9.99e-4, true), (1.001e-3, false), (1.1e-3, false), (0.1, false)]
        {
            let measured = Wrench::from_force_at(&Vector3::new(0.013 + gap, 0.0, 0.0), force);
            let bound = ConvexBound::new(&ball, &measured, &errors, 0.02);
            assert_eq!(bound.is_some(), explained, "{kind} {gap} {bound:?}");
            if let Some(bound) = bound {
                assert!(bound.past_silhouette && bound.distance >= gap, "{bound:?}");
                // The contact that is reported lies the gap beside the line, and the true one may lie on its other side.
                let along = bound.along[0].abs().max(bound.along[1].abs());
                let furthest = along.hypot(bound.across + gap);
                assert!((bound.distance / furthest - 1.0).abs() < 1e-12, "{bound:?} {furthest}");
            }
        }
    }
}

/// Reaches and errors that cannot be have no bound, each alone.
#[test]
fn what_cannot_be_has_no_bound() {
    let sphere = Sphere::centred(0.013).unwrap();
    let measured = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.5), Vector3::zeros());
    let bound = |errors: &WorstErrors<f64>, reach| ConvexBound::new(&sphere, &measured, errors, reach);
    let errors = WorstErrors::of_wrench(1e-3, 1e-5);
    assert!(bound(&errors, 0.013).is_some());
    for reach in [-0.013, -1e-300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(bound(&errors, reach).is_none(), "{reach}");
    }
    for bad in [-1e-6, f64::NAN, f64::INFINITY] {
        assert!(bound(&WorstErrors::of_wrench(bad, 1e-5), 0.013).is_none(), "{bad}");
        assert!(bound(&WorstErrors::of_wrench(1e-3, bad), 0.013).is_none(), "{bad}");
    }
    assert!(bound(&WorstErrors::of_wrench(1.5, 1e-5), 0.013).is_none());
}

/// Without errors the bound is that of rounding, and holds it: far from the origin, where the reach is hardly
/// more than the distance of the line.
#[test]
fn rounding_is_within_the_bound() {
    let (far, near) = ([0.1, 0.02, -0.03].map(|x| x as f32), [0.001_f32, -0.002, 0.003]);
    for centre in [far, near].map(Vector3::from) {
        let single = Sphere::new(centre, 0.013_f32).unwrap();
        let double = Sphere::new(centre.map(f64::from), f64::from(single.radius())).unwrap();
        let mut largest = 0.0_f64;
        for k in 1..=2000 {
            let at = |step: f64| (f64::from(k) * step).sin() as f32;
            let normal = Vector3::new(at(1.1), at(2.3), at(3.7)).normalize();
            let force = (Vector3::new(at(1.7), at(2.9), at(0.6)) * 0.3 - normal) * (1.0 + 0.5 * at(4.3));
            let measured = Wrench::from_force_at(&(centre + normal * 0.013), force);
            let exact = Wrench::on_fingertip(force.map(f64::from), measured.torque().map(f64::from));
            let Some(contact) = PointContact::new(0.0).unwrap().resolve(&exact, &double).contact().copied()
            else {
                continue;
            };
            let ours = PointContact::new(0.0).unwrap().resolve(&measured, &single);
            let ours = ours.contact().unwrap().point.map(f64::from);
            let errors = WorstErrors::of_wrench(0.0, 0.0);
            let reach = (contact.point.norm() * 1.001) as f32;
            let bound = ConvexBound::new(&single, &measured, &errors, reach).unwrap();
            let off = (contact.point - ours).norm() / f64::from(bound.distance);
            assert!(off <= 1.0, "{off} {bound:?} {measured:?}");
            let across = (contact.point - ours).cross(&exact.force().normalize()).norm();
            assert!(across <= f64::from(bound.across), "{across:e} {bound:?}");
            largest = largest.max(off);
        }
        assert!(largest > 0.01, "{largest}");
    }
}
