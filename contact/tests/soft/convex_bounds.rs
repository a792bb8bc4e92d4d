//! The rigorous bound on convex shapes.

use fingertip_contact::{ContactModel, ConvexBound, PointContact, WorstErrors};
use fingertip_surfaces::{ActiveSurface, DynSurface};
use fingertip_test_support::Worst;
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use crate::common;
use crate::wrenches::Random;

/// The rigorous bound: how often it fails (never), and how much larger it is than the error.
fn convex_bound<S: ActiveSurface<f64>>(
    name: &str,
    surface: &S,
    [size, reach]: [f64; 2],
    count: usize,
    seed: u64,
) -> f64 {
    let mut random = Random::new(seed);
    let model = PointContact::new(0.0).unwrap().with_greatest_gap(1.0).unwrap();
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
        let model = PointContact::new(0.0_f32).unwrap().with_greatest_gap(1.0).unwrap();
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
    let model = PointContact::new(0.0).unwrap().with_greatest_gap(1.0).unwrap();
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
