//! Covariance against Monte Carlo, bounds against the worst that can be done.

use fingertip_contact::{
    Contact, ContactCovariance, ContactJacobian, ContactModel, GeometryUncertainty, PaperBounds,
    PointContact, SoftFinger, SoftFingerSurface,
};
use fingertip_surfaces::{DynSurface, SmoothSurface, Sphere, shape_operator_by_differences};
use fingertip_test_support::Worst;
use fingertip_wrench::Wrench;
use nalgebra::{Matrix2, Matrix3, Matrix6, Vector3, Vector6};

use crate::common;
use crate::wrenches::{Case, Random};

pub(crate) fn noisy(random: &mut Random, wrench: &Wrench<f64>, factor: &Matrix6<f64>) -> Wrench<f64> {
    let noise = Vector6::from_fn(|_, _| random.normal());
    Wrench::from_components(&(wrench.components() + factor * noise))
}

/// A covariance with correlations, of about 1 mN and 10 µN·m.
pub(crate) fn wrench_covariance(random: &mut Random) -> Matrix6<f64> {
    let scale = Vector6::new(1e-3, 1e-3, 1e-3, 1e-5, 1e-5, 1e-5);
    let mix = Matrix6::from_fn(|_, _| random.uniform(-0.5, 0.5)) + Matrix6::identity();
    let factor = Matrix6::from_diagonal(&scale) * mix;
    factor * factor.transpose()
}

/// Spread of the sampled local numbers relative to the prediction, and the share of samples in
/// the 95 % ellipse.
pub(crate) fn monte_carlo<S: SoftFingerSurface<f64> + SmoothSurface<f64>>(
    surface: &S,
    soft: bool,
    seed: u64,
) -> (f64, f64) {
    let mut random = Random::new(seed);
    let case = loop {
        let spins = if soft { [0.1, 0.5] } else { [1e-12, 1e-11] };
        let case = Case::random(&mut random, surface, 0.017, spins, 2.0);
        // Where the noise, of some hundredths of a millimetre, sees no edge and no fold, and no apex.
        let bend = surface.shape_operator(&case.point);
        let curvature = (bend.trace().powi(2) - bend.norm_squared()) / 2.0;
        let pressing = case.wrench.force().dot(&case.normal).powi(2);
        let steady = case.spin.powi(2) * curvature + pressing > 0.3 * pressing && bend.norm() < 500.0;
        let aside = case.normal.cross(&random.direction()).normalize() * 5e-4;
        let other = case.normal.cross(&aside);
        let smooth = [aside, -aside, other, -other]
            .iter()
            .all(|step| surface.normal(&(case.point + step)).dot(&case.normal) > 0.9);
        if case.incidence > 0.6 && steady && smooth {
            break case;
        }
    };
    let covariance = wrench_covariance(&mut random);
    let factor = covariance.cholesky().unwrap().l();
    let resolve = |wrench: &Wrench<f64>| -> Contact<f64> {
        let near = Some(&case.point);
        *if soft {
            SoftFinger::new(0.0).unwrap().without_friction_limit().resolve_near(wrench, surface, near)
        } else {
            PointContact::new(0.0).unwrap().resolve_near(wrench, surface, near)
        }
        .contact()
        .unwrap()
    };
    let truth = resolve(&case.wrench);
    let bend = surface.shape_operator(&truth.point);
    let jacobian = if soft {
        ContactJacobian::of_soft_finger(&truth, &bend)
    } else {
        ContactJacobian::of_point_contact(&truth, &case.wrench, &bend)
    }
    .unwrap();
    let predicted = ContactCovariance::new(&jacobian, &covariance);
    let ellipse = predicted.ellipse(0.95).unwrap();
    let [e1, e2] = predicted.tangents();
    let (mut sums, mut inside) = (Matrix6::zeros(), 0);
    let mut forces = Matrix2::zeros();
    let tangential = |c: &Contact<f64>| c.tangential_force().norm();
    let count = 40_000;
    for _ in 0..count {
        let contact = resolve(&noisy(&mut random, &case.wrench, &factor));
        let moved = contact.point - truth.point;
        let slid = contact.tangential_force() - truth.tangential_force();
        let local = Vector6::new(
            moved.dot(&e1),
            moved.dot(&e2),
            contact.normal_force() - truth.normal_force(),
            slid.dot(&e1),
            slid.dot(&e2),
            contact.spin_torque - truth.spin_torque,
        );
        sums += local * local.transpose();
        let pair = nalgebra::Vector2::new(local[2], tangential(&contact) - tangential(&truth));
        forces += pair * pair.transpose();
        let [a, b] = [0, 1].map(|i| moved.dot(&ellipse.directions[i]) / ellipse.semi_axes[i]);
        inside += usize::from(a * a + b * b <= 1.0);
    }
    let sampled = sums / f64::from(count);
    let deviations = predicted.local().diagonal().map(f64::sqrt);
    let mut worst = Worst::new();
    for i in 0..6 {
        for j in 0..6 {
            let scale = deviations[i] * deviations[j];
            if scale > 0.0 {
                worst.see((sampled[(i, j)] - predicted.local()[(i, j)]) / scale);
            }
        }
    }
    let pair = predicted.normal_and_tangential(&truth);
    let difference = (forces / f64::from(count) - pair).component_div(&Matrix2::new(
        pair.m11,
        (pair.m11 * pair.m22).sqrt(),
        (pair.m11 * pair.m22).sqrt(),
        pair.m22,
    ));
    let rank_two = predicted.point() * truth.normal;
    assert!(rank_two.norm() <= 1e-15 * predicted.point().norm());
    let position = ContactCovariance::position_only(&jacobian, &covariance);
    assert!((position - predicted.position()).norm() <= 1e-14 * position.norm());
    let straight = if soft {
        ContactCovariance::soft_finger_position(&truth, surface, &covariance)
    } else {
        ContactCovariance::point_contact_position(&truth, &case.wrench, &covariance)
    };
    assert!((position - straight.unwrap()).norm() <= 1e-13 * position.norm());
    difference.iter().for_each(|x| worst.see(*x));
    (worst.get(), inside as f64 / f64::from(count))
}

/// Straight from the contact, with noise in proportion to the load, the covariance is the same at any
/// load; and there is none where a pure force grazes, nor of numbers that are none.
#[test]
fn position_covariance_of_any_load() {
    let surface = common::ellipsoid::<f64>();
    let mut random = Random::new(77);
    let covariance = wrench_covariance(&mut random);
    for _ in 0..200 {
        let case = Case::random(&mut random, &surface, 0.017, [1e-3, 10.0], 2.0);
        let contact = *SoftFinger::new(0.0)
            .unwrap()
            .without_friction_limit()
            .resolve(&case.wrench, &surface)
            .contact()
            .unwrap();
        let of = |contact: &Contact<f64>, scale: f64| {
            ContactCovariance::soft_finger_position(contact, &surface, &(covariance * scale.powi(2)))
        };
        let scaled = |scale: f64| Contact {
            force: contact.force * scale,
            spin_torque: contact.spin_torque * scale,
            ..contact
        };
        let usual = of(&contact, 1.0).unwrap();
        for exponent in [-400, -250, -3, 9, 250, 400] {
            let scale = 2.0_f64.powi(exponent);
            let extreme = of(&scaled(scale), scale).unwrap();
            assert!((extreme - usual).norm() <= 1e-13 * usual.norm(), "2^{exponent}: {extreme} {usual}");
        }
        let across = contact.normal.cross(&random.direction());
        let grazing = Contact { force: across - contact.normal * contact.normal.dot(&across), ..contact };
        let grazing = Contact { spin_torque: 0.0, ..grazing };
        // What rounding leaves of a pressing force is not noise of this size, but next to none.
        assert!(of(&grazing, 1.0).is_none_or(|c| c.amax() > 1e20 * usual.amax()));
        assert!(of(&scaled(0.0), 1.0).is_none());
        assert!(of(&scaled(f64::NAN), 1.0).is_none());
    }
}

#[test]
fn covariance_matches_monte_carlo() {
    macro_rules! check {
        ($($shape:ident),+) => {
            $(for soft in [false, true] {
                let (deviation, coverage) = monte_carlo(&DynSurface::from(common::$shape()), soft, 0);
                println!(
                    "{:18} soft {soft:5} Monte Carlo deviates {:.2} %, 95 % ellipse holds {:.2} %",
                    stringify!($shape),
                    100.0 * deviation,
                    100.0 * coverage
                );
                assert!(
                    deviation < 0.03 && (0.94..=0.96).contains(&coverage),
                    "{} {deviation} {coverage}",
                    stringify!($shape)
                );
            })+
        };
    }
    check!(
        sphere,
        ellipsoid,
        cylinder,
        plane,
        capsule,
        cone,
        frustum,
        elliptic_cylinder,
        paraboloid,
        torus,
        superquadric,
        rounded_box,
        revolution,
        posed
    );
}

#[test]
fn uncertain_geometry_matches_monte_carlo() {
    let sphere = common::sphere::<f64>();
    let mut random = Random::new(2);
    let case = Case::random(&mut random, &sphere, 0.017, [0.05, 0.2], 2.0);
    let resolve = |sphere: &Sphere<f64>| {
        *SoftFinger::new(0.0)
            .unwrap()
            .without_friction_limit()
            .resolve(&case.wrench, sphere)
            .contact()
            .unwrap()
    };
    let truth = resolve(&sphere);
    let jacobian = ContactJacobian::of_soft_finger(&truth, &sphere.shape_operator(&truth.point)).unwrap();
    let geometry = GeometryUncertainty {
        offset: 1e-10,
        position: Matrix3::new(4e-10, 1e-10, 0.0, 1e-10, 2e-10, 0.0, 0.0, 0.0, 1e-10),
        ..GeometryUncertainty::none()
    };
    let predicted = ContactCovariance::new(&jacobian, &Matrix6::zeros()).with_geometry(&jacobian, &geometry);
    let factor = geometry.position.cholesky().unwrap().l();
    let [e1, e2] = predicted.tangents();
    let (mut sums, mut height) = (Matrix2::zeros(), 0.0);
    let count = 60_000;
    for _ in 0..count {
        let moved = factor * Vector3::from_fn(|_, _| random.normal());
        let other = Sphere::new(sphere.centre() + moved, sphere.radius() + 1e-5 * random.normal()).unwrap();
        let change = resolve(&other).point - truth.point;
        let local = nalgebra::Vector2::new(change.dot(&e1), change.dot(&e2));
        sums += local * local.transpose();
        height += change.dot(&truth.normal).powi(2);
    }
    let sampled = sums / f64::from(count);
    assert!((sampled - predicted.position()).norm() < 0.03 * predicted.position().norm());
    assert!((height / f64::from(count) / predicted.height_variance() - 1.0).abs() < 0.03);
}

#[test]
fn curvature_from_differences_of_the_normal() {
    let surface = common::ellipsoid::<f64>();
    let mut random = Random::new(12);
    for _ in 0..500 {
        let (point, _) = random.place(&surface, 0.017);
        let exact = surface.shape_operator(&point);
        let found = shape_operator_by_differences(&surface, &point, 1e-7);
        assert!((exact - found).norm() < 1e-6 * exact.norm());
    }
}

#[test]
fn worst_cases_are_attained_and_not_exceeded() {
    let surface = common::ellipsoid::<f64>();
    let mut random = Random::new(13);
    for _ in 0..200 {
        let case = Case::random(&mut random, &surface, 0.017, [1e-3, 1.0], 2.0);
        let contact = *SoftFinger::new(0.0)
            .unwrap()
            .without_friction_limit()
            .resolve(&case.wrench, &surface)
            .contact()
            .unwrap();
        let bend = surface.shape_operator(&contact.point);
        let jacobian = ContactJacobian::of_soft_finger(&contact, &bend).unwrap();
        let limits = Vector6::from_fn(|i, _| random.uniform(0.1, 1.0) * if i < 3 { 0.01 } else { 1e-4 });
        let worst = jacobian.worst_case(&limits);
        let (mut distance, mut components) = (Worst::new(), [Worst::new(); 3]);
        for corner in 0..64_u8 {
            let signs = Vector6::from_fn(|i, _| if corner >> i & 1 == 1 { 1.0 } else { -1.0 });
            let moved = jacobian.point() * limits.component_mul(&signs);
            distance.see(moved.norm());
            components.iter_mut().zip(&moved).for_each(|(worst, error)| worst.see(*error));
        }
        assert!((worst.distance / distance.get() - 1.0).abs() < 1e-12);
        assert!(
            (worst.components - Vector3::from(components.map(Worst::get))).norm() < 1e-12 * worst.distance
        );
        let cheap = worst.components.norm();
        assert!(worst.distance <= cheap * (1.0 + 1e-12));
    }
}

/// (3)-(9): the corrected bounds hold, the sharp ones are attained, the table is right.
#[test]
fn the_bounds_of_the_first_paper() {
    let mut random = Random::new(53);
    let bounds = PaperBounds::new(0.013, 1e-6).unwrap();
    assert!(PaperBounds::new(0.0, 1e-6).is_err() && PaperBounds::new(0.013, f64::NAN).is_err());
    let sphere = Sphere::centred(0.013).unwrap();
    let point = |wrench: &Wrench<f64>| {
        PointContact::new(0.0).unwrap().resolve(wrench, &sphere).contact().unwrap().point
    };
    let corners = |wrench: &Wrench<f64>| {
        let truth = point(wrench);
        let (mut distance, mut components) = (Worst::new(), [Worst::new(); 3]);
        for corner in 0..64_u8 {
            let moved = wrench
                .components()
                .map_with_location(|i, _, x| x * if corner >> i & 1 == 1 { 1.0 + 1e-6 } else { 1.0 - 1e-6 });
            let error = point(&Wrench::from_components(&moved)) - truth;
            distance.see(error.norm());
            components.iter_mut().zip(&error).for_each(|(worst, error)| worst.see(*error));
        }
        (Vector3::from(components.map(Worst::get)), distance.get())
    };
    for _ in 0..500 {
        let normal = random.direction();
        let force = random.force(&normal, 0.1, 3.0);
        let wrench = Wrench::from_force_at(&(normal * 0.013), force);
        let (components, _) = corners(&wrench);
        let allowed = bounds.contact(&force, &wrench.torque());
        // (4) to (6) as they stand, with lengths in radii.
        let (f, m) = (force.map(f64::abs), wrench.torque().map(f64::abs) / 0.013);
        let b = Vector3::new(f.y * m.z + f.z * m.y, f.z * m.x + f.x * m.z, f.x * m.y + f.y * m.x);
        let (f2, c2) = (f.norm_squared(), force.cross(&wrench.torque()).norm_squared() / 0.013_f64.powi(2));
        let share = (f2 * f2 + 2.0 * b.norm_squared()) / (f2.powf(1.5) * (1.0 - c2 / (f2 * f2)).sqrt());
        let written = (b * 2.0 + f * share) * (bounds.central_distance() / f2);
        assert!((allowed - written).norm() < 1e-12 * written.norm(), "{allowed} {written}");
        assert!((0..3).all(|i| components[i] <= allowed[i] * (1.0 + 1e-5)), "{components} {allowed}");
        // (7) and (8), for a force through the centre: sharp to first order.
        let (components, distance) = corners(&Wrench::on_fingertip(force, Vector3::zeros()));
        let sharp = bounds.central_contact_sharp(&force);
        assert!((components - sharp).norm() < 1e-5 * bounds.central_distance());
        let central = bounds.central_contact(&force);
        assert!((0..3).all(|i| sharp[i] <= central[i]));
        // Without the factor that vanishes along an axis.
        let along = force.normalize().abs();
        assert!(
            (0..3).all(|i| (central[i] * (1.0 - along[i] * along[i]) - sharp[i]).abs() < 1e-12 * central[i])
        );
        let sharp = bounds.central_distance_sharp(&force);
        assert!((distance / sharp - 1.0).abs() < 1e-4, "{distance:e} {sharp:e}");
        assert!(sharp <= bounds.central_distance() / 2.0 * (1.0 + 1e-12));
    }
    assert_eq!(bounds.force(), 1e-6);
    let table = [
        (0.1_f64, 1.082_024_211_591_926_5, 0.552_493_781_056_044_5),
        (0.3, 1.606_123_340_793_895, 0.672_015_325_445_527_6),
        (0.5, 2.343_074_902_771_996, 0.809_016_994_374_947_5),
    ];
    for (tan, corrected, worst_frame) in table {
        let angle = tan.atan();
        assert!((bounds.obliquity(angle) - corrected).abs() < 1e-13, "{}", bounds.obliquity(angle));
        assert!((bounds.obliquity_sharp(angle) - tan).abs() < 1e-15);
        assert!((bounds.obliquity_worst_frame(angle) - worst_frame).abs() < 1e-14);
    }
}
