//! Covariance against Monte Carlo, bounds against the worst that can be done.

use fingertip_contact::{
    Contact, ContactCovariance, ContactJacobian, ContactModel, ConvexBound, GeometryUncertainty, PaperBounds,
    PointContact, SensorUncertainty, SoftFinger, SoftFingerSurface, WorstErrors, WrenchNoise,
};
use fingertip_surfaces::{ActiveSurface, DynSurface, SmoothSurface, Sphere, shape_operator_by_differences};
use fingertip_test_support::Worst;
use fingertip_wrench::{GaussianElimination, SensorMatrix, Wrench, WrenchSolver};
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
fn monte_carlo<S: SoftFingerSurface<f64> + SmoothSurface<f64>>(
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
            SoftFinger::new(0.0).unwrap().resolve_near(wrench, surface, near)
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
        let contact = *SoftFinger::new(0.0).unwrap().resolve(&case.wrench, &surface).contact().unwrap();
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
        *SoftFinger::new(0.0).unwrap().resolve(&case.wrench, sphere).contact().unwrap()
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

/// From gauges with noise and a matrix with errors to the wrench.
#[test]
fn gauges_to_wrench_match_monte_carlo() {
    let mut random = Random::new(7);
    let matrix = Matrix6::from_fn(|i, j| if i == j { 2.0 } else { 0.0 } + random.uniform(-0.4, 0.4));
    let nominal = Vector6::new(10.0, 10.0, 10.0, 0.1, 0.1, 0.1);
    let sensor = SensorMatrix::new(matrix, nominal).unwrap();
    let solver = GaussianElimination::new(&sensor).unwrap();
    let wrench = Wrench::from_components(&Vector6::new(2.0, -3.0, 5.0, 0.02, 0.01, -0.03));
    let noise = Vector6::new(1e-3, 2e-3, 1e-3, 3e-3, 1e-3, 2e-3);
    // Relative errors of 1e-3 in the sensitivities, correlated within each row.
    let rows = core::array::from_fn(|_| {
        let scale = Matrix6::from_diagonal(&nominal.map(|n| 2e-3 / n));
        let mix = Matrix6::from_fn(|_, _| random.uniform(-0.5, 0.5)) + Matrix6::identity();
        scale * mix * mix.transpose() * scale
    });
    let uncertainty =
        SensorUncertainty::independent(&solver, &noise).unwrap().with_calibration(rows).unwrap();
    let predicted = uncertainty.wrench_covariance(&wrench);
    let factors = rows.map(|row: Matrix6<f64>| row.cholesky().unwrap().l());
    let mut sums = Matrix6::zeros();
    let count = 60_000;
    for _ in 0..count {
        let mut signals = sensor.signals(&wrench);
        for gauge in 0..6 {
            let wrong = factors[gauge] * Vector6::from_fn(|_, _| random.normal());
            signals[gauge] += noise[gauge] * random.normal() - wrong.dot(&wrench.components());
        }
        let error = solver.solve(&signals).components() - wrench.components();
        sums += error * error.transpose();
    }
    let deviations = predicted.diagonal().map(f64::sqrt);
    let difference =
        (sums / f64::from(count) - predicted).component_div(&(deviations * deviations.transpose()));
    assert!(Worst::of(difference.iter().copied()).get() < 0.03, "{difference}");
    let sheet = WrenchNoise { floor: Vector6::repeat(0.1), relative: 0.01 };
    assert!((sheet.covariance(&wrench)[(2, 2)] - (0.01 + 0.05_f64.powi(2))).abs() < 1e-15);
    let nan = Vector6::repeat(f64::NAN);
    assert!(SensorUncertainty::independent(&solver, &nan).is_err());
}

/// All the way: gauges with noise and a matrix with errors, the wrench solved from them, a soft finger
/// under it, its normal and tangential force.
#[test]
fn gauges_to_normal_and_tangential_force_match_monte_carlo() {
    let surface = common::ellipsoid::<f64>();
    let mut random = Random::new(9);
    let matrix = Matrix6::from_fn(|i, j| if i == j { 2.0 } else { 0.0 } + random.uniform(-0.4, 0.4));
    let nominal = Vector6::new(10.0, 10.0, 10.0, 0.1, 0.1, 0.1);
    let sensor = SensorMatrix::new(matrix, nominal).unwrap();
    let solver = GaussianElimination::new(&sensor).unwrap();
    // Noise of some 2 mN, and relative errors of 5e-4 in the sensitivities, correlated within each gauge.
    let noise = Vector6::new(2e-4, 4e-4, 2e-4, 6e-4, 2e-4, 4e-4);
    let rows = core::array::from_fn(|_| {
        let scale = Matrix6::from_diagonal(&nominal.map(|n| 1e-3 / n));
        let mix = Matrix6::from_fn(|_, _| random.uniform(-0.5, 0.5)) + Matrix6::identity();
        scale * mix * mix.transpose() * scale
    });
    let factors = rows.map(|row: Matrix6<f64>| row.cholesky().unwrap().l());
    let uncertainty =
        SensorUncertainty::independent(&solver, &noise).unwrap().with_calibration(rows).unwrap();
    for soft in [false, true] {
        let case = loop {
            let spins = if soft { [0.1, 0.5] } else { [1e-12, 1e-11] };
            let case = Case::random(&mut random, &surface, 0.017, spins, 5.0);
            if (0.7..0.9).contains(&case.incidence) {
                break case;
            }
        };
        let resolve = |wrench: &Wrench<f64>| -> Contact<f64> {
            *if soft {
                SoftFinger::new(0.0).unwrap().resolve(wrench, &surface)
            } else {
                PointContact::new(0.0).unwrap().resolve(wrench, &surface)
            }
            .contact()
            .unwrap()
        };
        let truth = resolve(&case.wrench);
        let jacobian = if soft {
            ContactJacobian::of_soft_finger_on(&truth, &surface)
        } else {
            let bend = surface.shape_operator(&truth.point);
            ContactJacobian::of_point_contact(&truth, &case.wrench, &bend)
        }
        .unwrap();
        let of_wrench = uncertainty.wrench_covariance(&case.wrench);
        let predicted = ContactCovariance::new(&jacobian, &of_wrench);
        let ellipse = predicted.ellipse(0.95).unwrap();
        let (mut forces, mut points, mut inside) = (Matrix2::zeros(), Matrix3::zeros(), 0);
        let count = 40_000;
        for _ in 0..count {
            let mut signals = sensor.signals(&case.wrench);
            for gauge in 0..6 {
                let wrong = factors[gauge] * Vector6::from_fn(|_, _| random.normal());
                signals[gauge] += noise[gauge] * random.normal() - wrong.dot(&case.wrench.components());
            }
            let contact = resolve(&solver.solve(&signals));
            let pair = nalgebra::Vector2::new(
                contact.normal_force() - truth.normal_force(),
                contact.tangential_force().norm() - truth.tangential_force().norm(),
            );
            forces += pair * pair.transpose();
            let moved = contact.point - truth.point;
            points += moved * moved.transpose();
            let [a, b] = [0, 1].map(|i| moved.dot(&ellipse.directions[i]) / ellipse.semi_axes[i]);
            inside += usize::from(a * a + b * b <= 1.0);
        }
        let (forces, points) = (forces / f64::from(count), points / f64::from(count));
        let expected = predicted.normal_and_tangential(&truth);
        let deviations = expected.diagonal().map(f64::sqrt);
        let of_forces = (forces - expected).component_div(&(deviations * deviations.transpose()));
        let of_forces = Worst::of(of_forces.iter().copied()).get();
        let of_points = (points - predicted.point()).norm() / predicted.point().norm();
        let coverage = inside as f64 / f64::from(count);
        println!(
            "gauges to forces, soft {soft}: sd of normal {:.1} mN, tangential {:.1} mN; Monte Carlo deviates \
             {:.2} %, of the point {:.2} %, 95 % ellipse holds {:.2} %",
            deviations[0] * 1e3,
            deviations[1] * 1e3,
            100.0 * of_forces,
            100.0 * of_points,
            100.0 * coverage
        );
        assert!(of_forces < 0.03 && of_points < 0.03 && (0.94..=0.96).contains(&coverage));
    }
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
        let contact = *SoftFinger::new(0.0).unwrap().resolve(&case.wrench, &surface).contact().unwrap();
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

/// The rigorous bound: how often it fails (never), and how much larger it is than the error.
fn convex_bound<S: ActiveSurface<f64>>(
    name: &str,
    surface: &S,
    [size, reach]: [f64; 2],
    count: usize,
    seed: u64,
) -> f64 {
    let mut random = Random::new(seed);
    let model = PointContact::new(0.0).unwrap().accepting_gap(1.0).unwrap();
    let (mut ratios, mut silent, mut past, mut none) = (Vec::new(), 0, 0, 0);
    let mut tightest = Worst::new();
    for _ in 0..count {
        let (point, normal) = random.place(surface, size);
        assert!(point.norm() <= reach, "{name}");
        // All incidences, and often grazing.
        let force = if random.sign() > 0.0 {
            random.force(&normal, 0.0, 1.0)
        } else {
            let across = random.direction().cross(&normal).normalize();
            (across - normal * random.log_uniform(1e-6, 1.0)).normalize()
        };
        let truth: Wrench<f64> = Wrench::from_force_at(&point, force);
        let relative = random.log_uniform(1e-8, 0.1);
        // Errors of the full length allowed, in the worst of some random directions or none.
        let (force_error, torque_error) =
            (relative * random.uniform(0.0, 1.0), relative * size * random.uniform(0.0, 1.0));
        let measured = Wrench::on_fingertip(
            truth.force() + random.direction() * force_error,
            truth.torque() + random.direction() * torque_error,
        );
        let errors = WorstErrors::of_wrench(force_error, torque_error);
        // The errors may have made a pull of it, or a contact where the surface is not active.
        let Some(contact) = model.resolve(&measured, surface).contact().copied() else {
            none += 1;
            continue;
        };
        let Some(bound) = ConvexBound::new(surface, &measured, &errors, reach) else {
            silent += 1;
            continue;
        };
        let error = (contact.point - point).norm();
        assert!(error <= bound.distance, "{name}: {error:e} > {bound:?} at {truth:?}, measured {measured:?}");
        let along = (point - contact.point).dot(&measured.force().normalize());
        assert!(bound.along[0] <= along && along <= bound.along[1], "{name} {along} {bound:?}");
        past += usize::from(bound.past_silhouette);
        tightest.see(error / bound.distance);
        ratios.push(bound.distance / error);
    }
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    println!(
        "{name:16} rigorous bound n={count}: 0 violated, median bound/error {median:.2}, tightest {:.2}, grazing {past}, silent {silent}, no contact {none}",
        1.0 / tightest.get()
    );
    assert!(silent * 1000 < count && none * 4 < count, "{name}: silent {silent}, no contact {none}");
    assert!(median <= 5.0, "{name} {median}");
    median
}

fn all_convex_bounds(count: usize, of_slow_shapes: usize) {
    // Through `DynSurface`, which is compiled once. How far from the origin a contact can be: of a bounded shape its size, of an unbounded one what
    // `Random::place` goes to.
    convex_bound("sphere", &DynSurface::from(common::sphere()), [0.017, 0.017], count, 41);
    convex_bound("ellipsoid", &DynSurface::from(common::ellipsoid()), [0.017, 0.017], count, 42);
    convex_bound("cylinder", &DynSurface::from(common::cylinder()), [0.017, 0.031], count, 43);
    convex_bound("capsule", &DynSurface::from(common::capsule()), [0.017, 0.0131], count, 44);
    convex_bound(
        "rounded box",
        &DynSurface::from(common::rounded_box()),
        [0.017, 0.0183],
        of_slow_shapes,
        45,
    );
    convex_bound(
        "superquadric",
        &DynSurface::from(common::superquadric()),
        [0.017, 0.0184],
        of_slow_shapes,
        46,
    );
    convex_bound("plane", &DynSurface::from(common::plane()), [0.017, 0.031], count, 141);
    convex_bound("disk", &DynSurface::from(common::disk()), [0.017, 0.031], count, 142);
    convex_bound("rectangle", &DynSurface::from(common::rectangle()), [0.017, 0.031], count, 143);
    convex_bound("spherical cap", &DynSurface::from(common::spherical_cap()), [0.017, 0.017], count, 144);
    convex_bound("cone", &DynSurface::from(common::cone()), [0.017, 0.031], count, 145);
    convex_bound("frustum", &DynSurface::from(common::frustum()), [0.014, 0.0146], count, 146);
    convex_bound("capped cylinder", &DynSurface::from(common::capped_cylinder()), [0.014, 0.015], count, 147);
    convex_bound("elliptic cyl.", &DynSurface::from(common::elliptic_cylinder()), [0.017, 0.031], count, 148);
    convex_bound(
        "closed ell. cyl.",
        &DynSurface::from(common::closed_elliptic_cylinder()),
        [0.014, 0.0157],
        count,
        149,
    );
    convex_bound("paraboloid", &DynSurface::from(common::paraboloid()), [0.017, 0.031], count, 150);
    convex_bound("gel tip", &common::revolution(), [0.014, 0.0141], of_slow_shapes, 151);
    convex_bound("grown ellipsoid", &common::grown_ellipsoid::<f64>(), [0.019, 0.019], of_slow_shapes, 152);
    convex_bound("grown cylinder", &common::grown_cylinder::<f64>(), [0.017, 0.018], of_slow_shapes, 153);
    convex_bound("mesh", &DynSurface::from(common::mesh()), [0.012, 0.0121], of_slow_shapes, 154);
    convex_bound("posed", &common::posed(), [0.014, 0.018], count, 155);
    convex_bound("trimmed", &common::trimmed(), [0.017, 0.017], count, 156);
    convex_bound("implicit", &common::pillow::<f64>(), [0.012, 0.0121], of_slow_shapes, 157);
}

#[test]
fn convex_bound_is_never_violated() {
    all_convex_bounds(2000, 300);
}

#[test]
#[ignore = "a million trials for each of 23 shapes: half an hour in release"]
fn convex_bound_is_never_violated_in_a_million() {
    all_convex_bounds(1_000_000, 1_000_000);
}

/// In single precision, whose rounding of wrench and shape counts as errors of these; that of the answer is
/// the bound's own affair.
#[test]
fn convex_bound_holds_in_single_precision() {
    fn check<S: ActiveSurface<f32>, D: ActiveSurface<f64>>(
        name: &str,
        single: &S,
        exact: &D,
        size: f64,
        reach: f32,
    ) {
        let mut random = Random::new(48);
        let model = PointContact::new(0.0_f32).unwrap().accepting_gap(1.0).unwrap();
        let (mut none, mut ratios) = (0, Vec::new());
        let (count, rounding) = (5000, f64::from(f32::EPSILON));
        for _ in 0..count {
            let (point, normal) = random.place(exact, size);
            let force = if random.sign() > 0.0 {
                random.force(&normal, 0.0, 1.0)
            } else {
                let across = random.direction().cross(&normal).normalize();
                (across - normal * random.log_uniform(1e-6, 1.0)).normalize()
            };
            let relative = random.log_uniform(1e-8, 0.1);
            let (force, torque): (Vector3<f64>, _) = (
                force + random.direction() * relative,
                point.cross(&force) + random.direction() * (relative * size),
            );
            let measured = Wrench::on_fingertip(force.cast::<f32>(), torque.cast::<f32>());
            let errors = WorstErrors {
                force: (relative + 2.0 * rounding) as f32,
                torque: (relative * size + 2.0 * rounding * torque.norm()) as f32,
                radius: (2.0 * rounding * size) as f32,
                centre: 0.0,
            };
            let Some(contact) = model.resolve(&measured, single).contact().copied() else {
                none += 1;
                continue;
            };
            let Some(bound) = ConvexBound::new(single, &measured, &errors, reach) else {
                none += 1;
                continue;
            };
            let error = (contact.point.cast::<f64>() - point).norm();
            assert!(
                error <= f64::from(bound.distance),
                "{name}: {error:e} {bound:?} {measured:?} {errors:?}"
            );
            // Of errors that are not rounding themselves.
            if relative > 1e-4 {
                ratios.push(f64::from(bound.distance) / error);
            }
        }
        ratios.sort_by(f64::total_cmp);
        let median = ratios[ratios.len() / 2];
        println!(
            "f32 {name:16} rigorous bound n={count}: 0 violated, median bound/error {median:.2}, none {none}"
        );
        assert!(median <= 5.0 && none * 4 < count, "{name} {median} {none}");
    }
    macro_rules! check {
        ($($shape:ident $size:literal $reach:literal),+) => {
            $(check(
                stringify!($shape),
                &DynSurface::from(common::$shape::<f32>()),
                &DynSurface::from(common::$shape::<f64>()),
                $size,
                $reach,
            );)+
        };
    }
    check!(
        sphere 0.017 0.0171,
        ellipsoid 0.017 0.0171,
        plane 0.017 0.031,
        capsule 0.017 0.0132,
        frustum 0.014 0.0147,
        cone 0.017 0.031,
        mesh 0.012 0.0122
    );
}

/// With an uncertain shape: the truth is an ellipsoid that lies within the tolerance.
#[test]
fn convex_bound_holds_for_an_uncertain_shape() {
    let mut random = Random::new(47);
    let model_shape = common::ellipsoid::<f64>();
    let model = PointContact::new(0.0).unwrap().accepting_gap(1.0).unwrap();
    let mut ratios = Vec::new();
    for _ in 0..20_000 {
        let tolerance = random.log_uniform(1e-7, 3e-4);
        let axes = model_shape.semi_axes().map(|a| a + tolerance * random.uniform(-1.0, 1.0));
        let truth_shape = fingertip_surfaces::Ellipsoid::new(axes).unwrap();
        let (point, normal) = random.place(&truth_shape, 0.017);
        let force = random.force(&normal, 0.0, 1.0);
        let measured = Wrench::from_force_at(&point, force);
        // Support functions differ by at most the change of the semi-axes.
        let errors = WorstErrors { force: 1e-9, torque: 1e-11, radius: tolerance, centre: 0.0 };
        let Some(bound) = ConvexBound::new(&model_shape, &measured, &errors, 0.03) else { continue };
        let contact = *model.resolve(&measured, &model_shape).contact().unwrap();
        let error = (contact.point - point).norm();
        assert!(error <= bound.distance, "{error} {bound:?}");
        ratios.push(bound.distance / error);
    }
    ratios.sort_by(f64::total_cmp);
    println!("uncertain ellipsoid: n={}, median bound/error {:.2}", ratios.len(), ratios[ratios.len() / 2]);
    assert!(ratios.len() > 19_900);
}

#[test]
fn a_convex_bound_refuses_what_it_cannot_answer() {
    let surface = common::sphere::<f64>();
    let press = Wrench::from_force_at(&surface.centre(), Vector3::new(0.0, 0.0, -1.0));
    let errors = |force, torque| WorstErrors::of_wrench(force, torque);
    assert!(ConvexBound::new(&surface, &press, &errors(1.0, 0.0), 0.02).is_none());
    assert!(ConvexBound::new(&surface, &press, &errors(f64::NAN, 0.0), 0.02).is_none());
    assert!(ConvexBound::new(&surface, &press, &errors(-0.1, 0.0), 0.02).is_none());
    let far = Wrench::from_force_at(&Vector3::new(0.1, 0.0, 0.0), Vector3::new(0.0, 0.0, -1.0));
    assert!(ConvexBound::new(&surface, &far, &errors(0.001, 1e-5), 0.02).is_none());
    // Pulled, a plane is only left.
    // No contact within a reach this short explains the wrench.
    assert!(ConvexBound::new(&surface, &press, &errors(0.001, 1e-5), 0.008).is_none());
    let plane = common::plane::<f64>();
    let pull = Wrench::from_force_at(&surface.centre(), Vector3::new(0.0, 0.0, 1.0));
    assert!(ConvexBound::new(&plane, &pull, &errors(0.001, 1e-5), 0.02).is_none());
    assert!(ConvexBound::new(&plane, &press, &errors(0.001, 1e-5), 0.02).is_some());
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
        assert!((0..3).all(|i| components[i] <= allowed[i] * (1.0 + 1e-5)), "{components} {allowed}");
        // (7) and (8), for a force through the centre: sharp to first order.
        let (components, distance) = corners(&Wrench::on_fingertip(force, Vector3::zeros()));
        let sharp = bounds.central_contact_sharp(&force);
        assert!((components - sharp).norm() < 1e-5 * bounds.central_distance());
        assert!((0..3).all(|i| sharp[i] <= bounds.central_contact(&force)[i]));
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
