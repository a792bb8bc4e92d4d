//! Wrench and array together.

use fingertip_surfaces::{ArrayContact, Ellipsoid, Fused, Fusion};
use fingertip_wrench::Wrench;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::common::{self, Random};

struct Scene<const K: usize> {
    points: [Vector3<f64>; K],
    normals: [Vector3<f64>; K],
    forces: [Vector3<f64>; K],
    wrench: Wrench<f64>,
    readings: [ArrayContact<f64>; K],
}

const MU: f64 = 0.5;

fn noise() -> Matrix6<f64> {
    Matrix6::from_diagonal(&Vector6::new(1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8))
}

/// Contacts whose forces follow the prior of the estimate: normal forces of which the array has
/// noise, tangential forces of deviation `spread · μ N`.
fn scene<const K: usize>(random: &mut Random, surface: &Ellipsoid<f64>, spread: f64) -> Scene<K> {
    let places: [_; K] = core::array::from_fn(|_| random.place(surface, 0.017));
    let (points, normals) = (places.map(|p| p.0), places.map(|p| p.1));
    let pressures: [f64; K] = core::array::from_fn(|_| random.uniform(1.0, 3.0));
    let deviation = 0.1;
    let (mut forces, mut readings) = ([Vector3::zeros(); K], Vec::new());
    let mut wrench: Wrench<f64> = Wrench::zero();
    for i in 0..K {
        let n = normals[i];
        let across = Vector3::from_fn(|_, _| random.normal());
        let tangential: Vector3<f64> = (across - n * across.dot(&n)) * (MU * pressures[i] * spread);
        let pressing = pressures[i] + deviation * random.normal();
        // What friction holds, and no more.
        let held = (MU * pressing / tangential.norm()).min(1.0);
        forces[i] = tangential * held - n * pressing;
        wrench = wrench + Wrench::from_force_at(&points[i], forces[i]);
        let blur = Vector3::from_fn(|_, _| random.normal()) * 2e-4;
        readings.push(ArrayContact {
            centroid: points[i] + blur - n * blur.dot(&n),
            centroid_covariance: Matrix3::identity() * 4e-8,
            normal_force: pressures[i],
            normal_deviation: deviation,
        });
    }
    let scatter = noise().diagonal().map(f64::sqrt);
    let off = Vector6::from_fn(|i, _| scatter[i] * random.normal());
    let wrench = Wrench::from_components(&(wrench.components() + off));
    Scene { points, normals, forces, wrench, readings: readings.try_into().unwrap() }
}

/// The negative logarithm of the posterior, computed without the estimator.
fn cost<const K: usize>(
    scene: &Scene<K>,
    surface: &Ellipsoid<f64>,
    points: &[Vector3<f64>; K],
    forces: &[Vector3<f64>; K],
) -> f64 {
    use fingertip_surfaces::ActiveSurface;
    let mut rest = scene.wrench;
    let mut sum = 0.0;
    for i in 0..K {
        rest = rest - Wrench::from_force_at(&points[i], forces[i]);
        let reading = &scene.readings[i];
        // The frame of the array: on the surface under the reported centroid.
        let outward = surface.normal(&reading.centroid);
        let line = fingertip_wrench::Line { point: reading.centroid, direction: outward };
        let mut origin: Option<(f64, Vector3<f64>, Vector3<f64>)> = None;
        surface.crossings(&line, |c| {
            if origin.is_none_or(|o| c.along.abs() < o.0) {
                origin = Some((c.along.abs(), c.point, c.normal));
            }
        });
        let (_, origin, normal) = origin.unwrap();
        let shift = points[i] - origin;
        let shift = shift - normal * shift.dot(&normal);
        sum += shift.norm_squared() / 4e-8;
        let pressing = -forces[i].dot(&normal);
        let tangential = forces[i] + normal * pressing;
        sum += ((pressing - reading.normal_force) / reading.normal_deviation).powi(2);
        sum += tangential.norm_squared() / (MU * reading.normal_force).powi(2);
    }
    let r = rest.components();
    sum + r.dot(&(noise().try_inverse().unwrap() * r))
}

fn check<const K: usize>(spread: f64, internal: u8) {
    let surface = common::ellipsoid::<f64>();
    let fusion = Fusion::new(noise(), MU).unwrap();
    let mut random = Random::new(80 + K as u64);
    let (mut squared, mut disagreement, mut array_error, mut error) = (0.0, 0.0, 0.0, 0.0);
    let (mut free, mut sliding, mut unsettled) = (0, 0, 0);
    let count = 400;
    for _ in 0..count {
        let scene: Scene<K> = scene(&mut random, &surface, spread);
        let Fused { contacts, disagreement: d, internal_forces, settled } =
            fusion.estimate(&surface, &scene.wrench, &scene.readings).unwrap();
        unsettled += usize::from(!settled);
        assert_eq!(internal_forces, internal);
        disagreement += d;
        let found = (contacts.map(|c| c.point), contacts.map(|c| c.force));
        for (i, contact) in contacts.iter().enumerate() {
            let pressing = -contact.held.dot(&contact.normal);
            let tangential = (contact.held + contact.normal * pressing).norm();
            assert!(tangential <= MU * pressing * (1.0 + 1e-6) + 1e-9, "inside its cone");
            assert!((0.0..=1.0).contains(&contact.share_from_wrench));
            array_error +=
                (scene.forces[i] + scene.normals[i] * scene.readings[i].normal_force).norm_squared();
            error += (scene.forces[i] - contact.force).norm_squared();
        }
        if contacts.iter().any(|c| c.held != c.force) {
            sliding += 1;
        }
        free += 1;
        for (i, contact) in contacts.iter().enumerate() {
            let off = scene.forces[i] - contact.force;
            squared += off.dot(&contact.force_covariance.try_inverse().unwrap().transpose().tr_mul(&off));
            let moved = scene.points[i] - contact.point;
            assert!(moved.norm() < 8.0 * 2e-4);
        }
        // No small change is better.
        let least = cost(&scene, &surface, &found.0, &found.1);
        for _ in 0..4 {
            for size in [1e-3, 1e-2] {
                let forces = found.1.map(|f| f + random.direction() * size * 0.1);
                let points = found.0.map(|p| {
                    use fingertip_surfaces::ActiveSurface;
                    let n = surface.normal(&p);
                    let step = random.direction() * size * 2e-4;
                    // Back onto the ellipsoid, to second order and then by its gauge.
                    let near = p + step - n * step.dot(&n);
                    near / near.component_div(&surface.semi_axes()).norm()
                });
                assert!(cost(&scene, &surface, &points, &forces) > least - 1e-6 * (1.0 + least));
            }
        }
    }
    let consistency = squared / (3.0 * K as f64 * f64::from(free.max(1)));
    println!(
        "fusion of {K}: force error {:.3} N (array alone {:.3} N), consistency {consistency:.3} (1 is right), \
         disagreement {:.2} (6 is right), {sliding} of {count} outside a cone",
        (error / f64::from(count) / K as f64).sqrt(),
        (array_error / f64::from(count) / K as f64).sqrt(),
        disagreement / f64::from(count),
    );
    println!("    unsettled: {unsettled} of {count}");
    assert!(error < array_error);
    // Where truths lie far outside their cones, bonds may come and go without end: said, not hidden.
    assert!(unsettled * 100 <= if spread > 0.5 { 400 } else { 0 });
    if spread > 0.5 {
        return;
    }
    assert!((disagreement / f64::from(count) - 6.0).abs() < 0.8 || spread < 0.9);
}

#[test]
fn forces_well_inside_the_cones() {
    check::<1>(0.25, 0);
    check::<2>(0.25, 1);
    check::<3>(0.25, 3);
    check::<4>(0.25, 6);
}

#[test]
fn forces_at_the_edge_of_their_cones() {
    check::<1>(1.0, 0);
    check::<2>(1.0, 1);
    check::<3>(1.0, 3);
    check::<4>(1.0, 6);
}

/// A squeeze between two contacts leaves the wrench as it is: the estimate keeps to the array.
#[test]
fn an_internal_force_is_not_seen() {
    let surface = common::ellipsoid::<f64>();
    let fusion = Fusion::new(noise(), MU).unwrap();
    let reading = |x: f64| ArrayContact {
        centroid: Vector3::new(x, 0.0, 0.0),
        centroid_covariance: Matrix3::identity() * 1e-8,
        normal_force: 2.0,
        normal_deviation: 0.2,
    };
    let readings = [reading(0.008), reading(-0.008)];
    let found = fusion.estimate(&surface, &Wrench::zero(), &readings).unwrap();
    assert_eq!(found.internal_forces, 1);
    let [one, other] = found.contacts;
    assert!((one.force + other.force).norm() < 1e-3 && (one.force.x + 2.0).abs() < 1e-2);
    // Along the line between them the variance of the difference is that of the array.
    assert!((one.force_covariance[(0, 0)] - 0.02).abs() < 1e-3, "{}", one.force_covariance);
    assert!(one.force_covariance[(1, 1)] < 0.51 * (MU * 2.0).powi(2));
}

#[test]
fn bad_readings_are_errors() {
    let surface = common::ellipsoid::<f64>();
    let fusion = Fusion::new(noise(), MU).unwrap();
    let good = ArrayContact {
        centroid: Vector3::new(0.008, 0.0, 0.0),
        centroid_covariance: Matrix3::identity() * 1e-8,
        normal_force: 2.0,
        normal_deviation: 0.2,
    };
    let estimate = |reading| fusion.estimate(&surface, &Wrench::zero(), &[reading]);
    assert!(estimate(good).is_ok());
    assert!(estimate(ArrayContact { normal_force: f64::NAN, ..good }).is_err());
    assert!(estimate(ArrayContact { normal_deviation: 0.0, ..good }).is_err());
    assert!(estimate(ArrayContact { centroid: Vector3::repeat(f64::INFINITY), ..good }).is_err());
    assert!(fusion.estimate(&surface, &Wrench::zero(), &[good; 5]).is_err());
    assert!(fusion.estimate::<_, 0>(&surface, &Wrench::zero(), &[]).is_err());
    let nan = Wrench::on_fingertip(Vector3::repeat(f64::NAN), Vector3::zeros());
    assert!(fusion.estimate(&surface, &nan, &[good]).is_err());
    assert!(Fusion::new(Matrix6::zeros(), 0.5).is_err() && Fusion::new(noise(), 0.0).is_err());
}
