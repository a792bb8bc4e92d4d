//! Across edges and facets, off the end, and on every side of a body.

use fingertip_contact::{
    ContactCovariance, ContactJacobian, ContactModel, Continuity, PointContact, Sighting, Tracker,
};
use fingertip_surfaces::testing::cube_of_triangles;
use fingertip_surfaces::{ActiveSurface, CappedCylinder, Mesh, Rectangle, RoundedBox, Sphere};
use fingertip_wrench::Wrench;
use nalgebra::{Matrix2, Matrix3, Matrix6, Vector3, Vector6};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// Samples of a contact with a deviation along each tangent.
struct Samples {
    random: Pcg64Mcg,
    deviation: f64,
}

impl Samples {
    fn of<S: ActiveSurface<f64>>(
        &mut self,
        surface: &S,
        point: Vector3<f64>,
        normal: Vector3<f64>,
    ) -> Sighting<f64> {
        let (e1, e2) = fingertip_wrench::tangents(&normal);
        let beside = point + e1 * self.number() + e2 * self.number();
        let closest = nearest(surface, beside, normal);
        self.sighting(closest.0, closest.1)
    }

    fn number(&mut self) -> f64 {
        let number: f64 = StandardNormal.sample(&mut self.random);
        number * self.deviation
    }

    fn sighting(&self, point: Vector3<f64>, normal: Vector3<f64>) -> Sighting<f64> {
        let (e1, e2) = fingertip_wrench::tangents(&normal);
        let covariance = Matrix2::identity() * self.deviation.powi(2);
        Sighting::new(point, normal, [e1, e2], covariance).unwrap()
    }
}

fn nearest<S: ActiveSurface<f64>>(
    surface: &S,
    beside: Vector3<f64>,
    normal: Vector3<f64>,
) -> (Vector3<f64>, Vector3<f64>) {
    let line = fingertip_wrench::Line { point: beside, direction: normal };
    let mut best: Option<(f64, Vector3<f64>, Vector3<f64>)> = None;
    surface.crossings(&line, |crossing| {
        let away = crossing.along.abs();
        if crossing.normal.dot(&normal) > 0.0 && best.is_none_or(|best| away < best.0) {
            best = Some((away, crossing.point, crossing.normal));
        }
    });
    best.map_or_else(
        || {
            let closest = surface.closest_approach(&line).unwrap();
            (closest.point, closest.normal)
        },
        |best| (best.1, best.2),
    )
}

fn cube(half: f64) -> Mesh<f64> {
    let (vertices, triangles) = cube_of_triangles(half);
    Mesh::new(&vertices, &triangles).unwrap()
}

/// Over the edge of a cube, at 10 mm/s and with samples of 0.3 mm: the track follows, as one contact, and goes on at the
/// same speed.
#[test]
fn an_edge_is_crossed_without_losing_the_contact() {
    let cube = cube(0.01);
    let (speed, slant) = (0.01, 0.3_f64);
    for seed in 0..20 {
        let mut samples = Samples { random: Pcg64Mcg::seed_from_u64(seed), deviation: 0.3e-3 };
        let mut tracker = Tracker::new(0.01, 0.1).unwrap();
        let (mut worst, mut lost) = (0.0_f64, 0);
        for k in 0..800 {
            // On top towards the edge at x = 10 mm, then down the side, slantwise all the way.
            let way = speed * f64::from(k) * 1e-3 - 4e-3;
            let at = |way: f64, aside: f64| {
                if way <= 0.0 {
                    (Vector3::new(0.01 + way, aside, 0.01), Vector3::z())
                } else {
                    (Vector3::new(0.01, aside, 0.01 - way), Vector3::x())
                }
            };
            let (point, _) = at(way, way * slant);
            // The noise, too, leads over the edge.
            let (seen, normal) = at(way + samples.number(), way * slant + samples.number());
            let sighting = samples.sighting(seen, normal);
            let tracked = tracker.follow(&cube, Some(&sighting), 1e-3).unwrap();
            lost += usize::from(k > 0 && tracked.continuity == Continuity::New);
            let inside = tracked.point.amax();
            assert!((inside - 0.01).abs() < 1e-12, "on the surface: {inside}");
            if k > 200 {
                worst = worst.max((tracked.point - point).norm());
            }
            if k == 799 {
                let exact = Vector3::new(0.0, slant, -1.0) * speed;
                let off = (tracked.velocity - exact).norm();
                assert!(off < 4.0 * tracked.velocity_covariance.trace().sqrt(), "{off}");
            }
        }
        assert_eq!(lost, 0, "{seed}");
        assert!(worst < 0.6e-3, "{seed}: {worst}");
    }
}

/// A contact that runs over the end of a plate stays at its rim, and comes back.
#[test]
fn at_the_rim_of_a_plate_it_stays_on_the_plate() {
    let plate = Rectangle::new(Vector3::zeros(), Vector3::x() * 0.01, Vector3::y() * 0.01).unwrap();
    let mut samples = Samples { random: Pcg64Mcg::seed_from_u64(3), deviation: 0.2e-3 };
    let mut tracker = Tracker::new(0.01, 0.1).unwrap();
    let normal = plate.normal(&Vector3::zeros());
    for k in 0..2000 {
        let x = (0.0095 + 0.001 * (f64::from(k) * 0.01).sin()).min(0.01);
        let point = Vector3::new(x, 0.0, 0.0);
        let sighting = samples.of(&plate, point, normal);
        let tracked = tracker.follow(&plate, Some(&sighting), 1e-3).unwrap();
        assert!(tracked.point.z.abs() < 1e-15);
        assert!((tracked.point - point).norm() < 1.5e-3, "{k} {}", tracked.point);
    }
}

/// Normal and tangents stay a frame, and the point on the surface, for as long as it goes on.
fn stays_in_frame<S: ActiveSurface<f64>>(surface: &S, start: Vector3<f64>) {
    let mut samples = Samples { random: Pcg64Mcg::seed_from_u64(9), deviation: 1e-3 };
    let mut tracker = Tracker::new(0.05, 0.05).unwrap();
    let mut normal = start.normalize();
    let mut point = nearest(surface, start, normal).0;
    for k in 0..20_000 {
        let turn = f64::from(k) * 1e-3;
        let towards = Vector3::new(turn.cos(), (2.0 * turn).sin(), (3.0 * turn).cos()) * 3e-5;
        (point, normal) = nearest(surface, point + towards, normal);
        let sighting = samples.of(surface, point, normal);
        let Some(tracked) = tracker.follow(surface, Some(&sighting), 1e-3) else { panic!("{k}") };
        let [e1, e2] = tracked.tangents;
        assert!((e1.norm() - 1.0).abs() < 1e-14 && e1.dot(&tracked.normal).abs() < 1e-14, "{k}");
        assert!((e1.cross(&e2) - tracked.normal).norm() < 1e-14);
        assert!(tracked.velocity.dot(&tracked.normal).abs() < 1e-14);
        let line = fingertip_wrench::Line { point: tracked.point, direction: tracked.normal };
        let mut off = f64::INFINITY;
        surface.crossings(&line, |crossing| off = off.min(crossing.along.abs()));
        let off = off.min(surface.closest_approach(&line).map_or(f64::INFINITY, |closest| closest.gap));
        assert!(off < 1e-12, "{k}: {off}");
    }
}

#[test]
fn the_frame_is_carried_along() {
    stays_in_frame(
        &Sphere::new(Vector3::new(0.001, 0.0, 0.0), 0.013).unwrap(),
        Vector3::new(0.0, 0.0, 0.013),
    );
    stays_in_frame(
        &RoundedBox::new(Vector3::new(0.008, 0.010, 0.013), 0.003).unwrap(),
        Vector3::new(0.0, 0.001, 0.013),
    );
    stays_in_frame(
        &CappedCylinder::new(Vector3::zeros(), Vector3::z(), 0.01, 0.01).unwrap(),
        Vector3::new(0.0, 0.001, 0.01),
    );
    stays_in_frame(&cube(0.01), Vector3::new(0.001, 0.002, 0.01));
}

proptest! {
    /// What a point contact tells in the tangents of the track is what its derivatives tell in their own.
    #[test]
    fn a_point_contact_counts_as_its_derivatives_say(
        entries in proptest::array::uniform32(-1.0..1.0_f64), lean in -0.8..0.8, aside in -0.8..0.8, pitch in -2e-3..2e-3,
    ) {
        let ball = Sphere::new(Vector3::zeros(), 0.013).unwrap();
        let scale = Vector6::new(1e-2, 1e-2, 1e-2, 1e-4, 1e-4, 1e-4);
        let root = Matrix6::from_fn(|i, j| entries[(6 * i + j) % 32] * scale[i]);
        let noise = root * root.transpose() + Matrix6::from_diagonal(&scale.component_mul(&scale)) * 0.1;
        let model = PointContact::new(0.05).unwrap();
        let [mut short, mut long] = [Tracker::new(0.01, 0.1).unwrap(); 2];
        for k in 0..50 {
            let angle = 0.001 * f64::from(k);
            let normal = Vector3::new(angle.sin(), 0.1, angle.cos()).normalize();
            let force = Vector3::new(lean, aside, -1.5);
            let place = normal * 0.013;
            let torque = place.cross(&force) + force * pitch;
            let wrench = Wrench::on_fingertip(force, torque);
            let found = *model.resolve(&wrench, &ball).contact().unwrap();
            let by_line = Sighting::of_point_contact(&found, &wrench, &noise).unwrap();
            let jacobian = ContactJacobian::of_point_contact(&found, &wrench, &Matrix3::zeros()).unwrap();
            let by_derivatives = Sighting::of(&found, &jacobian, &noise).unwrap();
            let whole = ContactCovariance::new(&jacobian, &noise).position();
            prop_assert!((by_line.covariance() - whole).amax() < 1e-12 * whole.amax());
            let now = short.follow(&ball, Some(&by_line), 1e-3).unwrap();
            let other = long.follow(&ball, Some(&by_derivatives), 1e-3).unwrap();
            prop_assert_eq!(now.continuity, other.continuity);
            prop_assert!((now.point - other.point).norm() < 1e-12);
            prop_assert!((now.velocity - other.velocity).norm() < 1e-10);
            let spread = other.position_covariance.amax();
            prop_assert!((now.position_covariance - other.position_covariance).amax() < 1e-9 * spread);
            prop_assert!((now.surprise - other.surprise).abs() < 1e-6 * (1.0 + other.surprise));
        }
    }
}
