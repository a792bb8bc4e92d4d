//! Every shape finds the contact that a wrench was made from.

use fingertip_contact::{Contact, ContactModel, NoContact, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{SmoothSurface, Sphere};
use fingertip_test_support::Worst;
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::big::{Big3, big3};
use crate::common::{self, Widen};
use crate::exact::{self, Exact};
use crate::wrenches::{Case, Random};

fn resolve<T: Real, S: SoftFingerSurface<T>>(
    surface: &S,
    wrench: &Wrench<f64>,
    near: Vector3<f64>,
) -> Resolution<T> {
    let number = |v: Vector3<f64>| v.map(T::literal);
    let wrench = Wrench::on_fingertip(number(wrench.force()), number(wrench.torque()));
    // On shapes that are not convex the contact nearest to the truth is asked for.
    SoftFinger::new(T::zero()).unwrap().without_friction_limit().resolve_near(
        &wrench,
        surface,
        Some(&number(near)),
    )
}

/// Error and spin error, relative, of a contact.
fn errors<T: Real>(
    contact: &Contact<T>,
    point: &Vector3<f64>,
    spin: f64,
    size: f64,
    wrench: &Wrench<f64>,
) -> [f64; 2] {
    let distance = (contact.point.map(Real::to_f64) - point).amax() / size;
    let scale = wrench.force().norm() * size + wrench.torque().norm();
    [distance, (contact.spin_torque.to_f64() - spin).abs() / scale]
}

struct Outcome {
    failures: usize,
    worst: [Worst; 2],
    /// The error of the point times the incidence: what is left if the conditioning is taken out.
    conditioned: Worst,
}

/// How much the rounding of a wrench moves a contact of its own accord, in units of `ε·size`: the
/// size of the torque, times the inverse of `τ EᵀWE + (f·n) J₂`, which takes torques to positions
/// (`docs/theory/contact.md#general-surfaces`). Where the surface is curved both ways a large spin torque
/// steadies the contact; where it is flat one way, rounding of a spin torque `τ` moves it by `τ²/(R f_n)²·ε`,
/// whatever the method.
pub(crate) fn conditioning<S: SmoothSurface<f64>>(surface: &S, case: &Case, size: f64) -> f64 {
    let bend = surface.shape_operator(&case.point);
    let normal_force = case.wrench.force().dot(&case.normal);
    let norm = case.spin.powi(2) * bend.norm_squared() + 2.0 * normal_force.powi(2);
    let minors = (bend.trace().powi(2) - bend.norm_squared()) / 2.0;
    // What is left of the curvature of a flat surface is rounding; that of a saddle is negative.
    let minors = if minors.abs() > 1e-10 * bend.norm_squared() { minors } else { 0.0 };
    let determinant = (case.spin.powi(2) * minors + normal_force.powi(2)).abs();
    let load = case.wrench.force().norm() + case.wrench.torque().norm() / size;
    load * norm.sqrt() / determinant
}

fn run<S: SoftFingerSurface<f64> + SmoothSurface<f64>>(
    name: &str,
    surface: &S,
    size: f64,
    count: usize,
    tolerance: f64,
) {
    let mut random = Random::new(17);
    let mut outcome = Outcome { failures: 0, worst: [Worst::new(); 2], conditioned: Worst::new() };
    for _ in 0..count {
        let magnitude = random.log_uniform(1e-6, 1e6);
        let case = Case::random(&mut random, surface, size, [1e-16, 1e4], magnitude);
        match resolve::<f64, _>(surface, &case.wrench, case.point) {
            Resolution::Contact(contact) => {
                let [point, spin] = errors(&contact, &case.point, case.spin, size, &case.wrench);
                let allowed = conditioning(surface, &case, size);
                outcome.worst[0].see(point);
                outcome.worst[1].see(spin);
                outcome.conditioned.see(point / allowed);
            }
            Resolution::NoContact(reason) => {
                if outcome.failures < 3 {
                    println!("{name}: {reason:?} {case:?}");
                }
                outcome.failures += 1;
            }
        }
    }
    let (worst, conditioned) = (outcome.worst.map(Worst::get), outcome.conditioned.get());
    println!(
        "{name:18} f64 n={count} failures {} error/size {:.1e} (spin {:.1e}), in units of its conditioning {:.1e}",
        outcome.failures, worst[0], worst[1], conditioned
    );
    assert_eq!(outcome.failures, 0, "{name}");
    assert!(conditioned <= 24.0 * f64::EPSILON, "{name}: {conditioned:e}");
    assert!(worst[0] <= tolerance && worst[1] <= tolerance.max(1e-13), "{name}: {worst:?}");
}

/// In f32 against the solution in f64 of the same, rounded, wrench on the same, rounded, shape.
fn run_single<S: SoftFingerSurface<f32>, D: SoftFingerSurface<f64> + SmoothSurface<f64>>(
    name: &str,
    single: &S,
    double: &D,
    size: f64,
    count: usize,
    tolerance: f64,
) {
    let mut random = Random::new(18);
    let (mut failures, mut worst, mut conditioned) = (0, Worst::new(), Worst::new());
    for _ in 0..count {
        let magnitude = random.log_uniform(1e-6, 1e6);
        let case = Case::random(&mut random, double, size, [1e-16, 1e4], magnitude);
        let rounded = |v: Vector3<f64>| v.map(|x| f64::from(x as f32));
        let wrench = Wrench::on_fingertip(rounded(case.wrench.force()), rounded(case.wrench.torque()));
        let Resolution::Contact(reference) = resolve::<f64, _>(double, &wrench, case.point) else { continue };
        match resolve::<f32, _>(single, &wrench, case.point) {
            Resolution::Contact(contact) => {
                let [point, _] = errors(&contact, &reference.point, reference.spin_torque, size, &wrench);
                worst.see(point);
                conditioned.see(point / conditioning(double, &case, size));
            }
            Resolution::NoContact(reason) => {
                if failures < 3 {
                    println!("{name}: {reason:?} {case:?}");
                }
                failures += 1;
            }
        }
    }
    let (worst, conditioned) = (worst.get(), conditioned.get());
    println!(
        "{name:18} f32 n={count} failures {failures} error/size {worst:.1e}, in units of its conditioning {conditioned:.1e}"
    );
    assert_eq!(failures, 0, "{name}");
    assert!(conditioned <= 8.0 * f64::from(f32::EPSILON), "{name}: {conditioned:e}");
    assert!(worst <= tolerance, "{name}: {worst:e}");
}

macro_rules! shape_test {
    ($name:ident, $size:literal, $count:literal, $tolerances:expr) => {
        #[test]
        fn $name() {
            let [double, single] = $tolerances;
            run(stringify!($name), &common::$name::<f64>(), $size, $count, double);
            run_single(
                stringify!($name),
                &common::$name::<f32>(),
                &common::$name::<f32>().widened(),
                $size,
                $count / 5,
                single,
            );
        }
    };
}

/// What a surface that is round both ways is held to, relative to its size: the error in `f64`, and in
/// `f32`. There a large spin torque steadies the contact, and a flat angle costs up to 1/0.05.
const ROUND: [f64; 2] = [1e-13, 1e-6];
shape_test!(sphere, 0.017, 100_000, ROUND);
shape_test!(ellipsoid, 0.017, 100_000, ROUND);
shape_test!(paraboloid, 0.02, 100_000, ROUND);
shape_test!(superquadric, 0.017, 100_000, ROUND);
shape_test!(pillow, 0.012, 100_000, ROUND);
shape_test!(gel_tip, 0.014, 100_000, ROUND);
shape_test!(grown_ellipsoid, 0.017, 20_000, ROUND);

/// What came of many wrenches on a surface that is straight one way, or like a saddle.
#[derive(Default)]
struct Straight {
    /// No contact where there is one: denied, or unresolved.
    failures: usize,
    /// Compared with 220 bits; at ends, edges and tips; and those of which 220 bits found none.
    compared: usize,
    elsewhere: usize,
    lost: usize,
    /// Greatest error relative to the size, or to the distance of a contact that is further away.
    worst: Worst,
}

/// On a surface that is straight one way a spin torque of 1e4 f R moves a contact by 1e8 times the
/// rounding of the wrench. But a wrench is what its numbers say: measured against the contact of that very
/// wrench on that very surface, the error is the method's.
fn straight<T: Real, S: SoftFingerSurface<T> + Exact>(
    surface: &S,
    smooth: &(impl SoftFingerSurface<f64> + SmoothSurface<f64>),
    size: f64,
    count: usize,
    most: usize,
    goal: f64,
) -> Straight {
    let (mut random, mut seen) = (Random::new(19), Straight::default());
    let model = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
    for _ in 0..count {
        let magnitude = random.log_uniform(1e-6, 1e6);
        let case = Case::random(&mut random, smooth, size, [1e-16, 1e4], magnitude);
        let [force, torque] = [case.wrench.force(), case.wrench.torque()].map(|v| v.map(T::literal));
        let wrench = Wrench::<T>::on_fingertip(force, torque);
        let [f, m] = [force, torque].map(|v| big3(v.map(Real::to_f64).into()));
        // Where two contacts merge in a fold either will do.
        let exact = |starts: &[Vector3<f64>]| -> Vec<Big3> {
            let smooth = |near| exact::contact(surface, smooth, &wrench, near, size);
            let on_smooth =
                || starts.iter().filter_map(smooth).filter(|point| surface.holds(point)).collect();
            surface.elsewhere(&f, &m).map_or_else(on_smooth, |point| vec![point])
        };
        let contact = match model.resolve_near(&wrench, surface, Some(&case.point.map(T::literal))) {
            Resolution::Contact(contact) => contact,
            // The rounding of the wrench may have moved the contact off the surface.
            Resolution::NoContact(reason) => {
                if !exact(&[case.point]).is_empty() {
                    println!("{reason:?} {case:?}");
                    seen.failures += 1;
                }
                continue;
            }
        };
        let found = contact.point.map(Real::to_f64);
        // Most are right whatever the rounding of the wrench has done.
        if (found - case.point).amax() <= goal / 2.0 * size || seen.compared == most {
            continue;
        }
        seen.compared += 1;
        let truths = exact(&[case.point, found]);
        let error = |truth: &Big3| {
            let far = truth.iter().map(|x| x.to_f64().abs()).fold(size, f64::max);
            exact::distance(&contact.point, truth) / far
        };
        let off = truths.iter().map(error).fold(f64::INFINITY, f64::min);
        seen.lost += usize::from(truths.is_empty());
        seen.elsewhere += usize::from(surface.elsewhere(&f, &m).is_some());
        if !truths.is_empty() {
            if off > goal {
                println!("{off:e} {case:?} {contact:?}");
            }
            seen.worst.see(off);
        }
    }
    seen
}

macro_rules! straight_test {
    ($name:ident, $size:literal) => {
        mod $name {
            use super::*;

            fn run(count: usize, most: usize) {
                let (single, double) = (common::$name::<f32>(), common::$name::<f64>());
                let widened = single.widened();
                let name = stringify!($name);
                for (scalar, goal, seen) in [
                    ("f64", 1e-13, straight::<f64, _>(&double, &double, $size, count, most, 1e-13)),
                    ("f32", 1e-6, straight::<f32, _>(&single, &widened, $size, count / 5, most / 2, 1e-6)),
                ] {
                    let Straight { failures, compared, elsewhere, lost, worst } = seen;
                    let worst = worst.get();
                    println!(
                        "{name:18} {scalar} failures {failures}, against 220 bits {compared} ({elsewhere} at ends, edges and tips, \
                         {lost} without an answer): error/size {worst:.1e}"
                    );
                    assert!(failures == 0 && worst <= goal, "{name} {scalar}: {failures} {worst:e}");
                    assert!(lost * 100 <= compared, "{name}: {lost}");
                }
            }

            #[test]
            fn within_the_bound() {
                run(100_000, 800);
            }

            #[test]
            #[ignore = "minutes long"]
            fn within_the_bound_to_the_last() {
                run(500_000, usize::MAX);
            }
        }
    };
}

straight_test!(plane, 0.017);
straight_test!(cylinder, 0.017);
straight_test!(elliptic_cylinder, 0.017);
straight_test!(closed_elliptic_cylinder, 0.013);
straight_test!(capped_cylinder, 0.013);
straight_test!(cone, 0.017);
straight_test!(frustum, 0.013);
straight_test!(spike, 0.013);
straight_test!(tube, 0.013);
straight_test!(capsule, 0.017);
straight_test!(rounded_box, 0.017);
straight_test!(torus, 0.0135);

#[test]
fn degenerate_wrenches_have_types() {
    let surface = common::sphere::<f64>();
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit();
    let reason = |force: [f64; 3], torque: [f64; 3]| {
        let wrench = Wrench::on_fingertip(Vector3::from(force), Vector3::from(torque));
        match model.resolve(&wrench, &surface) {
            Resolution::NoContact(reason) => reason,
            Resolution::Contact(contact) => panic!("{contact:?}"),
        }
    };
    assert!(
        matches!(reason([0.0; 3], [0.0, 0.3, 0.4]), NoContact::PureCouple { torque } if (torque - 0.5).abs() < 1e-15)
    );
    assert!(matches!(reason([0.0; 3], [0.0; 3]), NoContact::BelowThreshold { .. }));
    assert!(matches!(reason([f64::NAN, 0.0, 0.0], [0.0; 3]), NoContact::NotFinite));
    assert!(matches!(reason([1.0, 0.0, 0.0], [0.0, f64::INFINITY, 0.0]), NoContact::NotFinite));
    // Along z, 20 mm beside the centre of a sphere of 13 mm: f·m is exactly zero.
    let centre = surface.centre();
    let beside = Vector3::new(centre.x + 0.02, centre.y, 0.0);
    let force = Vector3::new(0.0, 0.0, -1.0);
    match reason(force.into(), beside.cross(&force).into()) {
        NoContact::Ambiguous { first, second } => {
            for point in [first, second] {
                let normal = (point - centre) / surface.radius();
                assert!((normal.norm() - 1.0).abs() < 1e-14 && normal.dot(&force).abs() < 1e-14);
                let q = beside.cross(&force) - point.cross(&force);
                assert!(q.cross(&normal).norm() < 1e-16, "the rest of the torque is spin");
            }
        }
        other => panic!("{other:?}"),
    }
    let strict = SoftFinger::new(2.0).unwrap();
    let weak = Wrench::on_fingertip(force, Vector3::zeros());
    assert!(matches!(
        strict.resolve(&weak, &surface),
        Resolution::NoContact(NoContact::BelowThreshold { force }) if force == 1.0
    ));
    assert!(SoftFinger::new(-1.0).is_err() && SoftFinger::new(f64::NAN).is_err());
}

/// A pure force whose line misses is ambiguous, and stays so when rounding its torque, or the pose of
/// the shape, leaves `f·m` not quite zero.
#[test]
fn a_pure_force_that_misses_grazes_two_points() {
    fn check<T: Real, S: SoftFingerSurface<T>>(name: &str, surface: &S, reach: f64) {
        let mut random = Random::new(23);
        for _ in 0..2000 {
            let force = random.direction();
            let aside = random.direction().cross(&force).normalize() * reach * random.uniform(1.5, 40.0);
            let number = |v: Vector3<f64>| v.map(T::literal);
            let wrench = Wrench::from_force_at(&number(aside), number(force));
            match SoftFinger::new(T::zero()).unwrap().without_friction_limit().resolve(&wrench, surface) {
                Resolution::NoContact(NoContact::Ambiguous { first, second }) => {
                    assert!((first - second).norm_squared().is_number(), "{name} {first} {second}");
                }
                other => panic!("{name} {wrench:?} {other:?}"),
            }
        }
    }
    check::<f64, _>("sphere", &Sphere::centred(0.013).unwrap(), 0.013);
    check::<f32, _>("sphere", &Sphere::centred(0.013).unwrap(), 0.013);
    check::<f64, _>("sphere aside", &common::sphere(), 0.017);
    check::<f32, _>("sphere aside", &common::sphere(), 0.017);
    check::<f64, _>("ellipsoid", &common::ellipsoid(), 0.017);
    check::<f32, _>("ellipsoid", &common::ellipsoid(), 0.017);
}

/// So it is over a dome: such a line lies in a plane beside a tangent plane.
#[test]
fn a_pure_force_over_a_dome_grazes_two_points() {
    fn check<T: Real>() {
        let mut random = Random::new(29);
        let surface = common::paraboloid::<T>();
        let [a, b] = surface.radii().map(Real::to_f64);
        for _ in 0..2000 {
            let [x, y] = [0; 2].map(|_| 0.012 * random.uniform(-1.0, 1.0));
            let below = Vector3::new(x, y, -(x * x / a + y * y / b) / 2.0);
            let normal = Vector3::new(x / a, y / b, 1.0).normalize();
            let force = random.direction().cross(&normal).normalize();
            let place = below + normal * (0.01 * random.log_uniform(0.1, 3.0));
            let number = |v: Vector3<f64>| v.map(T::literal);
            let wrench = Wrench::from_force_at(&number(place), number(force));
            match SoftFinger::new(T::zero()).unwrap().without_friction_limit().resolve(&wrench, &surface) {
                Resolution::NoContact(NoContact::Ambiguous { first, second }) => {
                    // The force lies in both tangent planes.
                    for point in [first, second] {
                        let level = surface.level(&point);
                        let (normal, _) = level.normal().unwrap();
                        let along = normal.dot(&wrench.force()).to_f64().abs();
                        assert!(along <= 1e4 * T::EPSILON.to_f64(), "{along:e} {point} {wrench:?}");
                        let size = T::literal(0.01) + point.amax();
                        assert!(level.value.abs() <= size * T::EPSILON * T::literal(64.0), "{point}");
                    }
                }
                other => panic!("{wrench:?} {other:?}"),
            }
        }
    }
    check::<f64>();
    check::<f32>();
}

/// A force along the axis has a contact where it presses, however it spins, and none where it pulls.
#[test]
fn a_force_along_the_axis_of_a_dome() {
    fn check<T: Real>() {
        let model = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
        let surface = common::paraboloid::<T>();
        let [a, b] = surface.radii().map(Real::to_f64);
        for (x, y, spin) in [(0.0, 0.0, 0.0), (0.004, 0.0, 0.0), (0.003, -0.006, 2e-3), (-0.005, 0.002, -0.1)]
        {
            let point = Vector3::new(x, y, -(x * x / a + y * y / b) / 2.0);
            let gradient = Vector3::new(x / a, y / b, 1.0);
            let load = |rise: f64| {
                let force = Vector3::new(0.0, 0.0, rise);
                let torque = point.cross(&force) + gradient * spin;
                Wrench::<T>::on_fingertip(force.map(T::literal), torque.map(T::literal))
            };
            let found = model.resolve(&load(-2.0), &surface).into_result().unwrap();
            let off = (found.point.map(Real::to_f64) - point).amax();
            assert!(off <= 16.0 * T::EPSILON.to_f64() * 0.01, "{off:e} {found:?}");
            let pulled = model.resolve(&load(2.0), &surface);
            assert!(matches!(pulled, Resolution::NoContact(_)), "{pulled:?}");
        }
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn extreme_numbers_give_no_nan() {
    fn check<T: Real, S: SoftFingerSurface<T>>(surface: &S, wrench: &Wrench<T>) {
        if let Resolution::Contact(c) =
            SoftFinger::new(T::zero()).unwrap().without_friction_limit().resolve(wrench, surface)
        {
            let sum = c.point.sum() + c.normal.sum() + c.incidence();
            assert!(sum.is_number(), "{c:?} {wrench:?}");
            assert!((c.normal.norm_squared() - T::one()).abs() < T::EPSILON * T::literal(64.0), "{c:?}");
        }
    }
    let mut random = Random::new(5);
    for round in 0..60_000 {
        let exponent = |random: &mut Random| 10_f64.powf(random.uniform(-44.0, 38.0)) as f32;
        let mut component =
            || random.sign() as f32 * exponent(&mut random) * f32::from(u8::from(round % 7 != 0));
        let force = Vector3::new(component(), component(), component());
        let torque = Vector3::new(component(), component(), component());
        let single = Wrench::on_fingertip(force, torque);
        check::<f32, _>(&common::sphere(), &single);
        check::<f32, _>(&common::ellipsoid(), &single);
        check::<f32, _>(&common::paraboloid(), &single);
        check::<f32, _>(&common::cylinder(), &single);
        check::<f32, _>(&common::plane(), &single);
        check::<f32, _>(&common::capsule(), &single);
        if round % 8 == 0 {
            check::<f32, _>(&common::cone(), &single);
            check::<f32, _>(&common::superquadric(), &single);
            check::<f32, _>(&common::pillow::<f32>(), &single);
            check::<f32, _>(&common::rounded_box(), &single);
        }
        if round % 64 == 0 {
            check::<f32, _>(&common::torus(), &single);
        }
    }
}
