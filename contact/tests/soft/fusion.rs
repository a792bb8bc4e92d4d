//! Wrench and array together.

use fingertip_contact::{ArrayContact, Fused, Fusion, Grip};
use fingertip_surfaces::Ellipsoid;
use fingertip_test_support::Worst;
use fingertip_wrench::Wrench;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::common;
use crate::wrenches::Random;

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

/// Contacts as the estimate supposes them: normal forces that the array measures with noise,
/// tangential forces anywhere in the disc of radius `spread · μ N`.
fn scene<const K: usize>(random: &mut Random, surface: &Ellipsoid<f64>, spread: f64) -> Scene<K> {
    let places: [_; K] = core::array::from_fn(|_| random.place(surface, 0.017));
    let (points, normals) = (places.map(|p| p.0), places.map(|p| p.1));
    let pressures: [f64; K] = core::array::from_fn(|_| random.uniform(1.0, 3.0));
    let deviation = 0.1;
    let (mut forces, mut readings) = ([Vector3::zeros(); K], Vec::new());
    let mut wrench: Wrench<f64> = Wrench::zero();
    for i in 0..K {
        let n = normals[i];
        let across = n.cross(&random.direction()).normalize();
        let other = n.cross(&across);
        let angle = random.uniform(0.0, core::f64::consts::TAU);
        let pressing = pressures[i] + deviation * random.normal();
        let size = MU * pressing * spread * random.uniform(0.0, 1.0).sqrt();
        forces[i] = (across * angle.cos() + other * angle.sin()) * size - n * pressing;
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
        sum += tangential.norm_squared() / (0.5 * MU * reading.normal_force).powi(2);
    }
    let r = rest.components();
    sum + r.dot(&(noise().try_inverse().unwrap() * r))
}

/// The surface's normal and the excess of the force over its friction cone.
fn excess(surface: &Ellipsoid<f64>, point: &Vector3<f64>, force: &Vector3<f64>) -> f64 {
    use fingertip_surfaces::ActiveSurface;
    let n = surface.normal(point);
    let pressing = -force.dot(&n);
    (force + n * pressing).norm() - MU * pressing
}

fn check<const K: usize>(spread: f64, internal: u8, expected: core::ops::Range<f64>) {
    let surface = common::ellipsoid::<f64>();
    let fusion = Fusion::new(noise(), MU).unwrap();
    let mut random = Random::new(80 + K as u64);
    let (mut squared, mut disagreement, mut array_error, mut error) = (0.0, 0.0, 0.0, 0.0);
    let (mut moved_squared, mut sliding, mut unsettled) = (0.0, 0, 0);
    let count = 1500;
    for _ in 0..count {
        let scene: Scene<K> = scene(&mut random, &surface, spread);
        let Fused { contacts, disagreement: d, internal_forces, settled } =
            fusion.estimate(&surface, &scene.wrench, &scene.readings).unwrap();
        unsettled += usize::from(!settled);
        assert_eq!(internal_forces, internal);
        disagreement += d;
        let found = (contacts.map(|c| c.point), contacts.map(|c| c.force));
        for (i, contact) in contacts.iter().enumerate() {
            let beyond = excess(&surface, &contact.point, &contact.force);
            assert!(beyond <= 1e-12, "{beyond:e} inside its cone {contact:?}");
            assert!(contact.grip == Grip::Sticks || beyond.abs() < 1e-9, "{beyond:e} {contact:?}");
            assert!((0.0..=1.0).contains(&contact.share_from_wrench));
            array_error +=
                (scene.forces[i] + scene.normals[i] * scene.readings[i].normal_force).norm_squared();
            error += (scene.forces[i] - contact.force).norm_squared();
            let off = scene.forces[i] - contact.force;
            squared += off.dot(&contact.force_covariance.try_inverse().unwrap().tr_mul(&off));
            let moved = scene.points[i] - contact.point;
            moved_squared += moved.norm_squared() / contact.point_covariance.trace();
            assert!(moved.norm() < 8.0 * 2e-4);
        }
        sliding += usize::from(contacts.iter().any(|c| c.grip != Grip::Sticks));
        // No small change that stays in the cones is better.
        let least = cost(&scene, &surface, &found.0, &found.1);
        for _ in 0..8 {
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
                if (0..K).any(|i| excess(&surface, &points[i], &forces[i]) > 0.0) {
                    continue;
                }
                let other = cost(&scene, &surface, &points, &forces);
                assert!(!settled || other > least - 1e-6 * (1.0 + least), "{other} < {least}");
            }
        }
    }
    let every = f64::from(count) * K as f64;
    let consistency = squared / (3.0 * every);
    println!(
        "fusion of {K}, forces to {spread} of the cone: force error {:.3} N (array alone {:.3} N), squared \
         error over covariance {consistency:.3} (points {:.3}), disagreement {:.2}, \
         {sliding} of {count} slide, {unsettled} unsettled",
        (error / every).sqrt(),
        (array_error / every).sqrt(),
        moved_squared / every,
        disagreement / f64::from(count),
    );
    assert!(error < array_error);
    assert_eq!(unsettled, 0);
    assert!(expected.contains(&consistency), "{consistency}");
    assert!((0.9..1.1).contains(&(moved_squared / every)));
    if spread == 1.0 {
        assert!((disagreement / f64::from(count) - 6.0).abs() < 0.5, "{disagreement}");
    }
}

/// The covariance is right where the forces are spread as the estimate supposes: over the whole
/// cone. (The cones themselves make the error a little less than it.)
#[test]
fn forces_all_over_their_cones() {
    check::<1>(1.0, 0, 0.93..1.07);
    check::<2>(1.0, 1, 0.85..1.07);
    check::<3>(1.0, 3, 0.85..1.07);
    check::<4>(1.0, 6, 0.85..1.07);
}

/// Where they are not, it is too large: it says what the readings allow, not what happened.
#[test]
fn forces_well_inside_the_cones() {
    check::<1>(0.3, 0, 0.8..1.07);
    check::<2>(0.3, 1, 0.3..1.0);
    check::<3>(0.3, 3, 0.2..1.0);
    check::<4>(0.3, 6, 0.1..1.0);
}

/// Contacts that have just been lost, of which the array still reports a little: some are lifted,
/// none pulls, and the iteration settles.
#[test]
fn a_lost_contact_is_lifted_or_light() {
    let surface = common::ellipsoid::<f64>();
    let fusion = Fusion::new(noise(), MU).unwrap();
    let mut random = Random::new(98);
    let (mut lifted, mut sliding, mut unsettled) = (0, 0, 0);
    for _ in 0..2000 {
        let mut scene: Scene<2> = scene(&mut random, &surface, 0.5);
        let lost = Wrench::from_force_at(&scene.points[0], scene.forces[0]);
        scene.wrench = scene.wrench - lost;
        scene.readings[0].normal_force = 0.1 * random.normal();
        let found = fusion.estimate(&surface, &scene.wrench, &scene.readings).unwrap();
        unsettled += usize::from(!found.settled);
        let first = &found.contacts[0];
        assert!(
            first.force.norm() < 0.6 && excess(&surface, &first.point, &first.force) < 1e-12,
            "{first:?}"
        );
        assert!(found.contacts[1].force.dot(&found.contacts[1].normal) < 0.0);
        lifted += usize::from(first.grip == Grip::Lifted);
        sliding += usize::from(first.grip == Grip::Slides);
    }
    println!("lost contacts: {lifted} lifted, {sliding} slide, {unsettled} unsettled of 2000");
    // Near the tip of a cone the step may go back and forth; that is said, and what is returned obeys
    // the cones all the same.
    assert!(lifted > 300 && unsettled < 160, "{lifted} {unsettled}");
}

/// An array that sees a pressure where the wrench says the object pulls: no force, or one that slides;
/// never one that pulls.
#[test]
fn no_contact_pulls() {
    let surface = common::ellipsoid::<f64>();
    let fusion = Fusion::new(noise(), MU).unwrap();
    let mut random = Random::new(97);
    let (mut lifted, mut unsettled) = (0, 0);
    for _ in 0..800 {
        let mut scene: Scene<3> = scene(&mut random, &surface, 1.0);
        scene.wrench = Wrench::on_fingertip(random.direction() * 4.0, random.direction() * 0.05);
        for reading in &mut scene.readings {
            reading.normal_force *= random.uniform(0.0, 0.3);
        }
        let found = fusion.estimate(&surface, &scene.wrench, &scene.readings).unwrap();
        unsettled += usize::from(!found.settled);
        for contact in &found.contacts {
            assert!(excess(&surface, &contact.point, &contact.force) < 1e-9, "{contact:?}");
            lifted += usize::from(contact.grip == Grip::Lifted);
            assert!(contact.grip != Grip::Lifted || contact.force == Vector3::zeros());
        }
    }
    println!("impossible wrenches: {lifted} of 2400 contacts lifted, {unsettled} of 800 unsettled");
    assert!(lifted > 100, "{lifted}");
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

/// In single precision the same estimate, to a hundredth of what it is uncertain by; and what comes out
/// owns nothing, as it can be copied.
#[test]
fn single_precision_is_enough() {
    fn is_plain<T: Copy>() {}
    is_plain::<Fusion<f32>>();
    is_plain::<Fused<f32, 4>>();
    let (surface, single) = (common::ellipsoid::<f64>(), common::ellipsoid::<f32>());
    let (exact, narrow) =
        (Fusion::new(noise(), MU).unwrap(), Fusion::new(noise().cast::<f32>(), 0.5).unwrap());
    let mut random = Random::new(99);
    let (mut worst, mut unsettled, mut differ) = (Worst::new(), 0, 0);
    for _ in 0..500 {
        let scene: Scene<3> = scene(&mut random, &surface, 1.0);
        let readings = scene.readings.map(|reading| ArrayContact {
            centroid: reading.centroid.cast::<f32>(),
            centroid_covariance: reading.centroid_covariance.cast::<f32>(),
            normal_force: reading.normal_force as f32,
            normal_deviation: reading.normal_deviation as f32,
        });
        let wrench = Wrench::from_components(&scene.wrench.components().cast::<f32>());
        let found = narrow.estimate(&single, &wrench, &readings).unwrap();
        let truth = exact.estimate(&surface, &scene.wrench, &scene.readings).unwrap();
        assert_eq!(found.internal_forces, truth.internal_forces);
        unsettled += usize::from(!found.settled);
        for (ours, exact) in found.contacts.iter().zip(&truth.contacts) {
            differ += usize::from(ours.grip != exact.grip);
            let force =
                (ours.force.cast::<f64>() - exact.force).norm() / exact.force_covariance.trace().sqrt();
            let point =
                (ours.point.cast::<f64>() - exact.point).norm() / exact.point_covariance.trace().sqrt();
            worst.see(force);
            worst.see(point);
        }
    }
    let worst = worst.get();
    println!(
        "fusion in f32: off by {worst:.1e} standard deviations, {unsettled} of 500 unsettled, {differ} grips differ"
    );
    assert!(worst < 0.01 && unsettled == 0, "{worst} {unsettled}");
}

/// Readings from 10⁻⁹ N to 10³⁰ N beside each other, of which rounding leaves nothing but the greatest: what is not known of a
/// contact is never less than nothing.
#[test]
fn no_variance_is_below_zero_however_far_apart_readings_are() {
    let (mut random, surface) =
        (Random::new(71), Ellipsoid::new(Vector3::new(0.0095, 0.011, 0.013)).unwrap());
    let fusion = Fusion::new(noise(), 0.6).unwrap();
    let mut told = 0;
    for _ in 0..4000 {
        let readings: [ArrayContact<f64>; 3] = core::array::from_fn(|_| {
            let normal_force = random.log_uniform(1e-9, 1e30);
            let centroid_covariance = Matrix3::identity() * 1e-6;
            let normal_deviation = 0.05 + 0.1 * normal_force;
            let centroid = random.place(&surface, 0.017).0;
            ArrayContact { centroid, centroid_covariance, normal_force, normal_deviation }
        });
        let wrench = Wrench::from_force_at(&random.place(&surface, 0.017).0, random.direction());
        let Ok(fused) = fusion.estimate(&surface, &wrench, &readings) else { continue };
        told += 1;
        for contact in fused.contacts {
            for covariance in [contact.point_covariance, contact.force_covariance] {
                assert!(covariance.diagonal().min() >= 0.0, "{covariance} of {readings:?}");
                assert!((covariance - covariance.transpose()).amax() <= 1e-12 * covariance.amax());
            }
        }
    }
    assert!(told > 1000, "{told}");
}
