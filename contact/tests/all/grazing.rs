//! The rigorous bound on the sphere, at every incidence and past tangency.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_test_support::Worst;
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn direction(random: &mut Pcg64Mcg) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
        if v.norm() <= 1.0 && v.norm() > 0.1 {
            return v.normalize();
        }
    }
}

struct Trials {
    met: usize,
    missed: usize,
    grazing: usize,
    worst: Worst,
    /// Bound over error, of every tenth.
    ratios: Vec<f64>,
}

/// A true contact on a true sphere, measured with errors within the stated ones: the contact found
/// on the assumed sphere is never farther from the true one than the bound.
fn bound_holds<T: Real>(trials: usize) -> Trials {
    let mut random = Pcg64Mcg::seed_from_u64(23);
    let model = PointContact::new(T::zero()).unwrap();
    let mut seen = Trials { met: 0, missed: 0, grazing: 0, worst: Worst::new(), ratios: Vec::new() };
    for trial in 0..trials {
        let radius = 10_f64.powf(random.random_range(-3.0..0.0));
        let centre = direction(&mut random) * radius * random.random_range(0.0..3.0);
        let size = |random: &mut Pcg64Mcg| 10_f64.powf(random.random_range(-9.0..-1.0));
        let exact = random.random_bool(0.3);
        let (radius_error, centre_error) =
            if exact { (0.0, 0.0) } else { (radius * size(&mut random), radius * size(&mut random)) };
        let (force_error, torque_error) = (size(&mut random), radius * size(&mut random));
        // The truth.
        let true_radius = radius + radius_error * random.random_range(-1.0..1.0);
        let true_centre = centre + direction(&mut random) * centre_error * random.random_range(0.0..1.0);
        let normal = direction(&mut random);
        let contact = true_centre + normal * true_radius;
        let across = normal.cross(&direction(&mut random)).normalize();
        let cosine = if random.random_bool(0.5) {
            10_f64.powf(random.random_range(-8.0..0.0))
        } else {
            random.random_range(0.0..1.0)
        };
        let force = across * (1.0 - cosine * cosine).sqrt() - normal * cosine;
        let torque = contact.cross(&force);
        // The measurement: the worst errors of those stated, in a random direction.
        let measured_force = force + direction(&mut random) * force_error;
        let measured_torque = torque + direction(&mut random) * torque_error;
        let wrench = Wrench::on_fingertip(measured_force.map(T::literal), measured_torque.map(T::literal));
        let sphere = Sphere::new(centre.map(T::literal), T::literal(radius)).unwrap();
        // Giving it to the type rounds it: half a unit in the last place of each component.
        let rounding = T::EPSILON.to_f64();
        let errors = WorstErrors {
            force: T::literal(force_error + rounding * 2.0),
            torque: T::literal(torque_error + rounding * measured_torque.norm() * 2.0),
            radius: T::literal(radius_error + rounding * radius),
            centre: T::literal(centre_error + rounding * centre.norm() * 2.0),
        };
        let Some(bound) = ContactBound::on_sphere(&sphere, &wrench, &errors) else { continue };
        let found = match model.resolve(&wrench, &sphere) {
            Resolution::Contact(contact) => {
                seen.met += 1;
                contact.point
            }
            Resolution::NoContact(NoContact::Misses {
                closest: Some(ClosestApproach { point: closest, .. }),
            }) => {
                seen.missed += 1;
                closest
            }
            other => panic!("{other:?}"),
        };
        seen.grazing += usize::from(bound.grazing);
        let ratio = (found.map(Real::to_f64) - contact).norm() / bound.distance.to_f64();
        assert!(ratio <= 1.0, "{ratio}: {wrench:?} {sphere:?} {errors:?} {bound:?} {contact:?} {found:?}");
        seen.worst.see(ratio);
        if trial % 10 == 0 {
            seen.ratios.push(1.0 / ratio);
        }
    }
    seen
}

fn check<T: Real>(trials: usize) {
    let mut seen = bound_holds::<T>(trials);
    seen.ratios.sort_by(f64::total_cmp);
    let median = seen.ratios[seen.ratios.len() / 2];
    println!(
        "bound: {} met, {} missed, {} grazing, greatest error/bound {:.4}, median bound/error {median:.2}",
        seen.met,
        seen.missed,
        seen.grazing,
        seen.worst.get()
    );
    assert!(median <= 5.0, "{median}");
    assert!(seen.met + seen.missed > trials * 9 / 10);
    assert!(seen.missed > trials / 100 && seen.grazing > trials / 100);
    // A bound that is never nearly reached would be no achievement.
    assert!(seen.worst.get() > 0.9);
}

#[test]
fn error_is_within_the_bound_in_a_million_trials() {
    check::<f64>(1_000_000);
}

#[test]
fn error_is_within_the_bound_in_single_precision() {
    check::<f32>(200_000);
}

/// Moving a line outward through tangency moves the contact continuously: as the root of the step.
#[test]
fn continuous_through_tangency() {
    fn check<T: Real>() {
        let sphere = Sphere::centred(T::one()).unwrap();
        let model = PointContact::new(T::zero()).unwrap();
        let point_at = |x: f64| {
            let line = Vector3::new(T::literal(x), T::literal(0.3), T::zero());
            let force = Vector3::new(T::zero(), T::zero(), -T::one());
            match model.resolve(&Wrench::from_force_at(&line, force), &sphere) {
                Resolution::Contact(contact) => contact.point,
                Resolution::NoContact(NoContact::Misses {
                    closest: Some(ClosestApproach { point: closest, .. }),
                }) => closest,
                other => panic!("{other:?}"),
            }
        };
        let tangent = (1.0_f64 - 0.09).sqrt();
        for step in [1e-2, 1e-4, 1e-6, 1e-8_f64] {
            let jump = (point_at(tangent - step) - point_at(tangent + step)).norm().to_f64();
            let allowed = (4.0 * step + 16.0 * T::EPSILON.to_f64()).sqrt() + step;
            assert!(jump <= allowed, "{step}: {jump} > {allowed}");
        }
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn bound_follows_its_laws() {
    let sphere = Sphere::centred(0.013_f64).unwrap();
    let wrench = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.3, 0.0, -1.0));
    let errors = WorstErrors::of_wrench(0.01, 0.0001);
    let bound = ContactBound::on_sphere(&sphere, &wrench, &errors).unwrap();
    assert!(!bound.grazing);
    // Scaling force and errors alike changes nothing.
    let strong =
        ContactBound::on_sphere(&sphere, &(wrench * 1e100), &WorstErrors::of_wrench(0.01e100, 0.0001e100))
            .unwrap();
    assert!((strong.distance / bound.distance - 1.0).abs() < 1e-12);
    // The first-order bound is near it where the errors are small.
    let contact = *PointContact::new(0.0).unwrap().resolve(&wrench, &sphere).contact().unwrap();
    let small = WorstErrors::of_wrench(1e-6, 1e-8);
    let rigorous = ContactBound::on_sphere(&sphere, &wrench, &small).unwrap().distance;
    let linear = contact.first_order_bound(1e-6, 1e-8).unwrap();
    assert!(rigorous < 2.0 * linear && linear < 2.0 * rigorous, "{rigorous} {linear}");
    // An error as large as the force leaves nothing to be said.
    assert!(ContactBound::on_sphere(&sphere, &wrench, &WorstErrors::of_wrench(2.0, 0.0)).is_none());
    // Nor does one as large as the radius leave a sphere.
    let of_radius = |radius| ContactBound::on_sphere(&sphere, &wrench, &WorstErrors { radius, ..small });
    assert!(of_radius(0.012).is_some() && of_radius(0.013).is_none() && of_radius(0.014).is_none());
}

/// It cannot be excluded that the contact grazes where the error that the tube is, seen along the surface, is a
/// tenth of the radius of the square of the cosine of incidence.
#[test]
fn grazing_is_said_from_where_it_begins() {
    let sphere = Sphere::centred(0.013_f64).unwrap();
    let (mut grazes, mut does_not) = (0, 0);
    for offset in [0.05, 0.3, 0.6, 0.85, 0.97_f64] {
        let wrench =
            Wrench::from_force_at(&Vector3::new(offset * 0.013, 0.0, 0.0), Vector3::new(0.0, 0.0, -1.0));
        for step in -60..0 {
            let torque = 0.013 * 10.0_f64.powf(0.1 * f64::from(step));
            let bound =
                ContactBound::on_sphere(&sphere, &wrench, &WorstErrors::of_wrench(0.0, torque)).unwrap();
            let threshold = 0.1 * 0.013 * (1.0 - offset * offset) / offset;
            if (torque / threshold - 1.0).abs() > 1e-6 {
                assert_eq!(bound.grazing, torque > threshold, "{offset} {torque}");
                (grazes, does_not) =
                    (grazes + i32::from(bound.grazing), does_not + i32::from(!bound.grazing));
            }
        }
    }
    assert!(grazes > 40 && does_not > 100, "{grazes} {does_not}");
}

/// Without errors the bound is that of rounding, and holds it, far from the origin and near it.
#[test]
fn rounding_alone_is_within_the_bound() {
    let mut random = Pcg64Mcg::seed_from_u64(77);
    let mut worst = 0.0_f64;
    for centre in [[0.3, 0.2, -0.3], [0.001, -0.002, 0.003]] {
        let single = Sphere::new(Vector3::from(centre.map(|x| x as f32)), 0.013_f32).unwrap();
        let radius = f64::from(single.radius());
        for _ in 0..3000 {
            let normal = direction(&mut random);
            let force = (direction(&mut random) * 0.9 - normal).map(|x| x as f32);
            let at = single.centre() + (normal * radius).map(|x| x as f32);
            let wrench = Wrench::on_fingertip(force, at.cross(&force));
            let Resolution::Contact(ours) = PointContact::new(0.0).unwrap().resolve(&wrench, &single) else {
                continue;
            };
            // The contact of the wrench to the last bit of its numbers.
            let double = Sphere::new(single.centre().cast::<f64>(), radius).unwrap();
            let exact = Wrench::on_fingertip(force.cast::<f64>(), wrench.torque().cast::<f64>());
            let Resolution::Contact(truth) = PointContact::new(0.0).unwrap().resolve(&exact, &double) else {
                continue;
            };
            let bound = ContactBound::on_sphere(&single, &wrench, &WorstErrors::of_wrench(0.0, 0.0)).unwrap();
            let ratio = (ours.point.cast::<f64>() - truth.point).norm() / f64::from(bound.distance);
            assert!(ratio <= 1.0, "{ratio} {bound:?} {wrench:?}");
            worst = worst.max(ratio);
        }
    }
    assert!(worst > 0.01, "{worst}");
}

/// Of a line that misses by what the errors allow, the true contact may be as far away as the bound says: the
/// gap and the tube across, the longest chord along.
#[test]
fn a_miss_has_the_bound_of_its_gap_and_its_errors() {
    let sphere = Sphere::centred(0.013_f64).unwrap();
    for (gap, torque) in [(1e-4, 2e-4), (5e-4, 1e-3), (1e-3, 1.5e-3)] {
        let wrench = Wrench::from_force_at(&Vector3::new(0.013 + gap, 0.0, 0.0), -Vector3::z());
        let bound = ContactBound::on_sphere(&sphere, &wrench, &WorstErrors::of_wrench(0.0, torque)).unwrap();
        // The line may pass anywhere within the torque's error of 1 N; the chord that it then cuts off is half as long.
        let nearest = 0.013 + gap - torque;
        let along = (0.013_f64.powi(2) - nearest.powi(2)).sqrt();
        let known = along.hypot(gap + torque);
        assert!((bound.distance / known - 1.0).abs() < 1e-9, "{bound:?} {known}");
    }
}
