//! Point contacts in single precision at flat angles: those of double, of which none is lost.

use core::f64::consts::TAU;

use fingertip_contact::{Contact, ContactModel, PointContact};
use fingertip_surfaces::{ActiveSurface, CappedCylinder, Frustum, Posed, RoundedBox, Torus};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn wide(wrench: &Wrench<f32>) -> Wrench<f64> {
    Wrench::on_fingertip(wrench.force().cast(), wrench.torque().cast())
}

/// The contact next to a place.
fn contact<T: Real>(
    wrench: &Wrench<T>,
    surface: &impl ActiveSurface<T>,
    near: &Vector3<f64>,
) -> Option<Contact<T>> {
    let near = near.map(T::literal);
    PointContact::new(T::zero()).unwrap().resolve_near(wrench, surface, Some(&near)).contact().copied()
}

/// A shape in both precisions, about as large as this, with a place on it and the normal there.
struct Case<S, D> {
    single: S,
    double: D,
    size: f64,
    point: Vector3<f64>,
    normal: Vector3<f64>,
}

/// A face, an edge or a corner.
fn rounded_box(random: &mut Pcg64Mcg) -> Case<RoundedBox<f32>, RoundedBox<f64>> {
    let half = Vector3::from_fn(|_, _| random.random_range(0.008_f32..0.02));
    let rounding = half.min() * random.random_range(0.1_f32..0.9);
    let (single, double) =
        (RoundedBox::new(half, rounding), RoundedBox::new(half.cast(), f64::from(rounding)));
    let (half, rounding) = (half.cast::<f64>(), f64::from(rounding));
    let flat = random.random_range(0..3);
    let normal = Vector3::from_fn(|k, _| if k < flat { 0.0 } else { random.random_range(-1.0..1.0) });
    let normal = Vector3::from_fn(|k, _| normal[(k + flat) % 3]).normalize();
    let point = half.map(|half| half - rounding).zip_map(&normal, |core, n| {
        if n == 0.0 { core * random.random_range(-0.99..0.99) } else { core.copysign(n) }
    });
    Case {
        single: single.unwrap(),
        double: double.unwrap(),
        size: 0.02,
        point: point + normal * rounding,
        normal,
    }
}

fn torus(random: &mut Pcg64Mcg) -> Case<Torus<f32>, Torus<f64>> {
    let ring = random.random_range(0.008_f32..0.015);
    let tube = ring * random.random_range(0.05_f32..0.9);
    let (ring64, tube64) = (f64::from(ring), f64::from(tube));
    let [around, across] = [0; 2].map(|_| random.random_range(0.0..TAU));
    let outward = Vector3::new(around.cos(), around.sin(), 0.0);
    let normal = outward * across.cos() + Vector3::z() * across.sin();
    Case {
        single: Torus::new(ring, tube).unwrap(),
        double: Torus::new(ring64, tube64).unwrap(),
        size: 0.02,
        point: outward * ring64 + normal * tube64,
        normal,
    }
}

/// A force that meets the surface there at a flat angle.
fn scrape<S, D>(random: &mut Pcg64Mcg, case: &Case<S, D>) -> Wrench<f32> {
    let cosine = 10_f64.powf(random.random_range(-2.8..-0.6));
    let any = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
    let across = (any - case.normal * any.dot(&case.normal)).normalize();
    let force = across * (1.0 - cosine * cosine).sqrt() - case.normal * cosine;
    Wrench::from_force_at(&case.point.cast::<f32>(), force.cast::<f32>())
}

/// The least cosine of incidence at which rounding of a random wrench leaves a contact.
const LEAST: f64 = 2e-3;

/// Double precision's contact, if it presses by enough that both have one.
fn judge(
    exact: Option<Contact<f64>>,
    found: Option<Contact<f32>>,
    size: f64,
    case: &str,
    least: f64,
) -> usize {
    let Some(exact) = exact else { return 0 };
    let incidence = -exact.normal.dot(&exact.force) / exact.force.norm();
    if !(least..0.3).contains(&incidence) {
        return 0;
    }
    let found = found.unwrap_or_else(|| panic!("lost at {incidence}: {case}"));
    let off = (found.point.cast::<f64>() - exact.point).norm() / size;
    let turned = (found.normal.cast::<f64>() - exact.normal).norm();
    assert!(off <= 5e-7 && turned <= 5e-7, "{off:e} {turned:e} at {incidence}: {case} {found:?} {exact:?}");
    1
}

/// The contacts of single and of double precision in another place, whose rotation is one to single precision only.
fn in_another_place(
    wrench: &Wrench<f32>,
    single: &(impl ActiveSurface<f32> + Copy),
    double: &impl ActiveSurface<f64>,
    near: &Vector3<f64>,
) -> (Option<Contact<f32>>, Option<Contact<f64>>) {
    let turn = Vector3::new(0.3, -0.5, 0.4);
    let pose = RigidTransform::from_axis_angle(turn, Vector3::new(0.01, 0.0, 0.02)).unwrap();
    let moved = wrench.expressed_in(&pose);
    let (rotation, origin) = (pose.rotation().cast::<f64>(), pose.origin().cast::<f64>());
    // The points that the transpose takes to the shape, and the normals that go with them.
    let forth = rotation.transpose().try_inverse().unwrap();
    let load = wide(&moved);
    let foot = load.force().cross(&load.torque()) / load.force().norm_squared();
    let inside = Wrench::from_force_at(&rotation.tr_mul(&(foot - origin)), rotation.tr_mul(&load.force()));
    let exact = contact(&inside, double, near).map(|contact| Contact {
        point: forth * contact.point + origin,
        normal: (rotation * contact.normal).normalize(),
        force: load.force(),
        ..contact
    });
    (contact(&moved, &Posed::new(*single, pose), &(rotation * near + origin)), exact)
}

/// How many of these forces press at a flat angle: in place, and in another.
fn flat_of<S: ActiveSurface<f32> + Copy, D: ActiveSurface<f64>>(
    draw: impl Fn(&mut Pcg64Mcg) -> Case<S, D>,
) -> [usize; 2] {
    let mut random = Pcg64Mcg::seed_from_u64(93);
    let mut flat = [0; 2];
    for k in 0..6000 {
        let case = draw(&mut random);
        let wrench = scrape(&mut random, &case);
        let (single, double, near) = (&case.single, &case.double, &case.point);
        let exact = contact(&wide(&wrench), double, near);
        flat[0] += judge(exact, contact(&wrench, single, near), case.size, &format!("{k} {wrench:?}"), LEAST);
        let (found, exact) = in_another_place(&wrench, single, double, near);
        flat[1] += judge(exact, found, 2.0 * case.size, &format!("{k} posed {wrench:?}"), LEAST);
    }
    flat
}

/// One was off by 1.8e-4 of the size, and one was not found: the lines meet the tube at a cosine of a thousandth.
#[test]
fn lines_that_all_but_miss_a_torus_enter_where_they_do() {
    for (radii, force, torque) in [
        (
            [1.725_421_7e-6_f32, 1.944_955_6e-7],
            [8.708_792e-13, -5.343_802_8e-14, -1.133_161_3e-12],
            [-2.123_578_8e-18, -4.954_213e-19, -1.608_690_9e-18],
        ),
        (
            [3.642_497_4e-6, 2.570_184_6e-7],
            [-21_534_940_000.0, -99_580_350_000.0, 91_496_850_000.0],
            [265_325.13, -251_552.4, -211_328.75],
        ),
    ] {
        let [ring, tube] = radii.map(f64::from);
        let wrench = Wrench::on_fingertip(Vector3::from(force), Vector3::from(torque));
        let single = Torus::new(radii[0], radii[1]).unwrap();
        let exact = contact(&wide(&wrench), &Torus::new(ring, tube).unwrap(), &Vector3::zeros());
        let found = contact(&wrench, &single, &Vector3::zeros());
        assert_eq!(judge(exact, found, ring + tube, &format!("{wrench:?}"), 1e-3), 1);
    }
}

#[test]
fn rounded_boxes_are_met_where_double_precision_says() {
    let flat = flat_of(rounded_box);
    assert!(flat.iter().all(|flat| *flat > 4500), "{flat:?}");
}

#[test]
fn tori_are_met_where_double_precision_says() {
    let flat = flat_of(torus);
    assert!(flat.iter().all(|flat| *flat > 4500), "{flat:?}");
}

/// On the side, anywhere along it, and the axis.
fn capped_cylinder(random: &mut Pcg64Mcg) -> (Vector3<f64>, Case<CappedCylinder<f32>, CappedCylinder<f64>>) {
    let vector = |random: &mut Pcg64Mcg| Vector3::from_fn(|_, _| random.random_range(-1.0_f32..1.0));
    let (centre, axis) = (vector(random) * 0.01, vector(random));
    let [radius, half] = [random.random_range(0.005_f32..0.01), random.random_range(0.005_f32..0.02)];
    let normal = axis.cross(&vector(random)).cast::<f64>().normalize();
    let height = f64::from(half) * random.random_range(-0.99..0.99);
    let single = CappedCylinder::new(centre, axis, radius, half).unwrap();
    let (centre, axis) = (centre.cast::<f64>(), single.axis().cast::<f64>());
    let double = CappedCylinder::new(centre, axis, f64::from(radius), f64::from(half)).unwrap();
    let point = centre + axis * height + normal * f64::from(radius);
    (axis, Case { single, double, size: 0.03, point, normal })
}

/// Two of three of such forces, all but along the axis, had a wrong contact where the residual was that of the base, which
/// rounding moves.
#[test]
fn lines_along_a_capped_cylinder_enter_where_they_do() {
    let mut random = Pcg64Mcg::seed_from_u64(95);
    let mut flat = 0;
    for k in 0..6000 {
        let (axis, case) = capped_cylinder(&mut random);
        let cosine = 10_f64.powf(random.random_range(-2.8..-2.0));
        let turn = random.random_range(-1.0..1.0) * cosine;
        let along = (axis + axis.cross(&case.normal) * turn).normalize();
        let force = along * (1.0 - cosine * cosine).sqrt() - case.normal * cosine;
        let wrench = Wrench::from_force_at(&case.point.cast::<f32>(), force.cast::<f32>());
        let exact = contact(&wide(&wrench), &case.double, &case.point);
        let found = contact(&wrench, &case.single, &case.point);
        flat += judge(exact, found, case.size, &format!("{k} {wrench:?}"), LEAST);
    }
    assert!(flat > 3000, "{flat}");
}

/// Of 250 000, one entered through the base of a large one at a flat angle beside the origin, and one grazed the side near
/// the tip: of those the first was off by 1.7e-6 of the size, and the second was not found.
#[test]
fn lines_that_all_but_miss_a_frustum_enter_where_they_do() {
    for (base, axis, [below, height], force, torque) in [
        (
            [0.0_f32, 0.0, 0.0],
            [0.648_826_1_f32, -0.747_375_2, 0.143_020_93],
            [93.422_32_f32, 279.848_57],
            [-5_620_618_000.0_f32, 2_160_163_300.0, 101_428_670_000.0],
            [-9_538_970_000.0_f32, -6_554_682_400.0, -388_999_700.0],
        ),
        (
            [-3.664_721_7, -3.347_575_2, -0.349_470_38],
            [0.428_505_54, -0.858_375_6, -0.282_089_26],
            [1.659_732_8, 0.957_397_2],
            [0.001_125_622_5, 0.002_963_420_2, -0.019_581_785],
            [0.083_346_16, -0.066_801_794, -0.005_318_487],
        ),
    ] {
        let [base, axis, force, torque] = [base, axis, force, torque].map(Vector3::from);
        let wrench = Wrench::on_fingertip(force, torque);
        let single = Frustum::new(base, axis, below, 0.0, height).unwrap();
        let double =
            Frustum::new(base.cast(), axis.cast(), f64::from(below), 0.0, f64::from(height)).unwrap();
        let exact = contact(&wide(&wrench), &double, &Vector3::zeros());
        let size = f64::from(below + height) + base.cast::<f64>().norm();
        let found = contact(&wrench, &single, &Vector3::zeros());
        assert_eq!(judge(exact, found, size, &format!("{wrench:?}"), 1e-4), 1);
    }
}
