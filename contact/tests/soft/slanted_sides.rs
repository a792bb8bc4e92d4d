//! The closed form of straight sides: of cones, frusta and cylinders with flat ends, elliptic ones too.

use fingertip_contact::{ContactModel, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{
    CappedCylinder, Cone, CylinderEnds, EllipticCylinder, ForceLine, Frustum, SmoothSurface,
};
use fingertip_test_support::Worst;
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::exact::{self, Exact, distance};
use crate::wrenches::{Case, Random};

/// A contact that presses steeply, with a spin torque of up to so much of force times size.
fn steep(random: &mut Random, surface: &impl SmoothSurface<f64>, size: f64, spin: f64) -> Case {
    let (point, normal) = random.place(surface, size);
    let magnitude = random.log_uniform(1e-3, 1e3);
    let force = random.force(&normal, 0.35, magnitude);
    let spin = random.uniform(-1.0, 1.0) * spin * magnitude * size;
    Case::new(point, normal, force, spin)
}

pub(crate) fn number<T: Real>(wrench: &Wrench<f64>) -> Wrench<T> {
    Wrench::on_fingertip(wrench.force().map(T::literal), wrench.torque().map(T::literal))
}

struct Told {
    tried: u32,
    answered: u32,
    worst: Worst,
}

/// How many contacts the short way tells, and how far they are from those of 220 bits.
fn short_way<T: Real, S: SoftFingerSurface<T> + Exact>(
    surface: &S,
    smooth: &impl SmoothSurface<f64>,
    size: f64,
    random: &mut Random,
    told: &mut Told,
) {
    for _ in 0..40 {
        let case = steep(random, smooth, size, 0.03);
        told.tried += 1;
        let wrench = number::<T>(&case.wrench);
        let push = ForceLine::new(&wrench, T::zero()).unwrap();
        let Some(contact) = surface.sole_soft_contact(&push) else { continue };
        let elsewhere = surface.elsewhere(&exact::wide(&wrench.force()), &exact::wide(&wrench.torque()));
        let truth = elsewhere.or_else(|| exact::contact(surface, smooth, &wrench, &case.point, size));
        let truth = truth.unwrap_or_else(|| panic!("no contact but {contact:?}: {case:?}"));
        told.answered += 1;
        told.worst.see(distance(&contact.point, &truth) / (size + case.point.norm()));
        assert!(
            (contact.normal.map(Real::to_f64).norm() - 1.0).abs() < 8.0 * T::EPSILON.to_f64(),
            "{contact:?}"
        );
        assert!(contact.normal.dot(&wrench.force()) < T::zero());
    }
}

/// From needles to plates.
fn cones<T: Real>(tolerance: f64) {
    let mut random = Random::new(29);
    for half_angle in [0.01, 0.1, 0.3, 0.6, 1.0, 1.4, 1.55] {
        let mut told = Told { tried: 0, answered: 0, worst: Worst::new() };
        for _ in 0..10 {
            // About the origin, where places are drawn.
            let axis = random.direction();
            let apex = axis * -0.6;
            let narrow =
                Cone::new(apex.map(T::literal), axis.map(T::literal), T::literal(half_angle)).unwrap();
            let same = Cone::new(
                narrow.apex().map(Real::to_f64),
                narrow.axis().map(Real::to_f64),
                narrow.half_angle().to_f64(),
            );
            short_way(&narrow, &same.unwrap(), 1.0, &mut random, &mut told);
        }
        let Told { tried, answered, worst } = told;
        println!("half angle {half_angle}: {answered} of {tried}, {:.1e}", worst.get());
        // On a needle even a small spin torque rules.
        let most = if half_angle < 0.05 { 0 } else { tried * 9 / 10 };
        assert!(answered >= most, "{half_angle}: {answered} of {tried}");
        assert!(worst.get() < tolerance, "{half_angle}: {:e}", worst.get());
    }
}

#[test]
fn cones_of_any_angle_take_the_short_way() {
    cones::<f64>(2e-14);
    cones::<f32>(2e-6);
}

/// Steep presses under spin torques as great as a blunt side takes by the short way: of a torque that is all but along
/// the side's normals rounding takes the digits, so that it is not to answer.
fn twisted<T: Real>() {
    let mut random = Random::new(47);
    let (mut told, mut steeply) = (Told { tried: 0, answered: 0, worst: Worst::new() }, 0);
    for half_angle in [0.6, 1.0, 1.4, 1.5, 1.53, 1.55, 1.56] {
        for _ in 0..120 {
            let axis = random.direction();
            let cone = Cone::new((axis * -0.6).map(T::literal), axis.map(T::literal), T::literal(half_angle))
                .unwrap();
            let [apex, axis] = [cone.apex(), cone.axis()].map(|v| v.map(Real::to_f64));
            let same = Cone::new(apex, axis, cone.half_angle().to_f64()).unwrap();
            let (sine, cosine) = cone.half_angle().to_f64().sin_cos();
            let outward = axis.cross(&random.direction()).normalize();
            let depth = random.uniform(0.3, 1.5);
            let point = apex + (axis * cosine + outward * sine) * depth;
            let normal = outward * cosine - axis * sine;
            let force = random.force(&normal, 0.5, 1.0);
            // As much as bends the pressing force to where the angle is called flat, and less.
            let share = ((force.dot(&normal) / 0.3).powi(2) - 1.0).sqrt() / 3.0_f64.sqrt();
            let most = share * depth * sine / cosine;
            let spin = random.sign() * random.log_uniform(0.02, 1.0) * most;
            let case = Case::new(point, normal, force, spin);
            let wrench = number::<T>(&case.wrench);
            told.tried += 1;
            steeply += u32::from(spin.abs() > 0.1 * most);
            let push = ForceLine::new(&wrench, T::zero()).unwrap();
            let Some(contact) = cone.sole_soft_contact(&push) else { continue };
            let truth = exact::contact(&cone, &same, &wrench, &point, 1.0).unwrap();
            told.answered += 1;
            told.worst.see(distance(&contact.point, &truth) / (1.0 + point.norm()));
        }
    }
    let Told { tried, answered, worst } = told;
    println!("{answered} of {tried}, {steeply} twisted most, {:.1} ε", worst.get() / T::EPSILON.to_f64());
    assert!(answered >= tried / 4, "{answered} of {tried}");
    assert!(worst.get() < 6.0 * T::EPSILON.to_f64(), "{:e}", worst.get());
}

#[test]
fn a_torque_along_the_normals_of_a_blunt_side_takes_no_digits() {
    twisted::<f64>();
    twisted::<f32>();
}

fn frusta<T: Real>(tolerance: f64) {
    let mut random = Random::new(31);
    for [base, top] in [[0.4, 0.399], [0.4, 0.4], [0.3, 0.5], [0.5, 0.0], [0.0, 0.4], [0.9, 0.2]] {
        let mut told = Told { tried: 0, answered: 0, worst: Worst::new() };
        for _ in 0..10 {
            let axis = random.direction();
            let solid = Frustum::new(
                (axis * -0.5).map(T::literal),
                axis.map(T::literal),
                T::literal(base),
                T::literal(top),
                T::one(),
            );
            let solid = solid.unwrap();
            let same = Frustum::new(
                solid.base_centre().map(Real::to_f64),
                solid.axis().map(Real::to_f64),
                solid.base_radius().to_f64(),
                solid.top_radius().to_f64(),
                1.0,
            );
            short_way(&solid, &same.unwrap(), 1.0, &mut random, &mut told);
        }
        let Told { tried, answered, worst } = told;
        println!("radii {base} and {top}: {answered} of {tried}, {:.1e}", worst.get());
        assert!(answered >= tried * 7 / 10, "{base} {top}: {answered} of {tried}");
        assert!(worst.get() < tolerance, "{base} {top}: {:e}", worst.get());
    }
}

#[test]
fn frusta_take_the_short_way() {
    frusta::<f64>(2e-14);
    frusta::<f32>(2e-6);
}

fn elliptic_cylinders<T: Real>(tolerance: f64) {
    let mut random = Random::new(41);
    for [a, b] in [[0.6, 0.5], [0.5, 0.5], [0.3, 0.8], [0.9, 0.09]] {
        for half in [None, Some(0.4)] {
            let mut told = Told { tried: 0, answered: 0, worst: Worst::new() };
            let ends = half.map_or(CylinderEnds::Unbounded, |half| CylinderEnds::Capped(T::literal(half)));
            let narrow = EllipticCylinder::new([a, b].map(T::literal), ends).unwrap();
            let same = EllipticCylinder::new(
                narrow.semi_axes().map(Real::to_f64),
                half.map_or(CylinderEnds::Unbounded, |half| CylinderEnds::Capped(T::literal(half).to_f64())),
            );
            for _ in 0..10 {
                short_way(&narrow, &same.unwrap(), 1.0, &mut random, &mut told);
            }
            let Told { tried, answered, worst } = told;
            println!("semi-axes {a} and {b}, {half:?}: {answered} of {tried}, {:.1e}", worst.get());
            assert!(answered >= tried * 6 / 10, "{a} {b} {half:?}: {answered} of {tried}");
            assert!(worst.get() < tolerance, "{a} {b} {half:?}: {:e}", worst.get());
        }
    }
}

#[test]
fn elliptic_cylinders_take_the_short_way() {
    elliptic_cylinders::<f64>(2e-14);
    elliptic_cylinders::<f32>(2e-6);
}

/// What the short way says is what the long way says, beyond the ranges where the exact contact is known, too: a
/// torque arm closes the short way, and this one is too long to have a say.
#[test]
fn the_short_way_and_the_long_way_agree() {
    let mut random = Random::new(37);
    let long = SoftFinger::new(0.0).unwrap().with_torque_arm(1e12).unwrap();
    let mut told = [0; 2];
    for round in 0..6000 {
        let unit = random.log_uniform(1e-6, 1e3);
        let axis = random.direction();
        let solid = Frustum::new(axis * (-0.5 * unit), axis, 0.5 * unit, 0.2 * unit, unit).unwrap();
        let cone = Cone::new(axis * (-0.6 * unit), axis, random.uniform(0.1, 1.4)).unwrap();
        let capped = CappedCylinder::new(axis * (0.1 * unit), axis, 0.4 * unit, 0.5 * unit).unwrap();
        let ends = [CylinderEnds::Unbounded, CylinderEnds::Capped(0.5 * unit)][round % 2];
        let elliptic = EllipticCylinder::new([0.4 * unit, random.uniform(0.2, 0.8) * unit], ends).unwrap();
        macro_rules! agree {
            ($surface:expr) => {{
                let spin = random.log_uniform(1e-6, 1.0);
                let mut case = Case::random(&mut random, $surface, unit, [spin, spin * 1.01], unit);
                if round % 2 == 0 {
                    // Any wrench at all: it may have its contact behind the apex, and none then.
                    let force = random.direction() * unit;
                    let torque = random.direction() * (unit * unit * random.log_uniform(1e-3, 10.0));
                    case.wrench = Wrench::on_fingertip(force, torque);
                }
                let push = ForceLine::new(&case.wrench, 0.0).unwrap();
                if let Some(contact) = $surface.sole_soft_contact(&push) {
                    told[0] += 1;
                    let other = long.resolve(&case.wrench, $surface);
                    let other = other.contact().unwrap_or_else(|| panic!("{contact:?} {other:?} {case:?}"));
                    let far = unit + contact.point.norm();
                    let off = (contact.point - other.point).norm();
                    assert!(off < 1e-13 * far, "{off:e} {contact:?} {other:?} {case:?}");
                    assert!((contact.normal - other.normal).norm() < 1e-12, "{contact:?} {other:?} {case:?}");
                }
                told[1] += 1;
            }};
        }
        agree!(&solid);
        agree!(&cone);
        agree!(&capped);
        agree!(&elliptic);
    }
    println!("{told:?}");
    assert!(told[0] > told[1] / 3, "{told:?}");
}

/// A force parallel to a side, where the general closed form divides by zero, presses on the opposite one.
#[test]
fn a_force_along_the_side_is_no_special_case() {
    let cone = Cone::new(Vector3::new(0.01, -0.02, 0.03), Vector3::z(), 0.5).unwrap();
    let (sine, cosine) = 0.5_f64.sin_cos();
    for depth in [1e-3, 0.02, 3.0] {
        let point = cone.apex() + Vector3::new(sine, 0.0, cosine) * depth;
        // Along the side at the other side of the axis.
        let force = Vector3::new(-sine, 0.0, cosine);
        let normal = Vector3::new(cosine, 0.0, -sine);
        for spin in [0.0, 0.1 * depth * sine, -0.3 * depth * sine] {
            let wrench = Wrench::on_fingertip(force, point.cross(&force) + normal * spin);
            let push = ForceLine::new(&wrench, 0.0).unwrap();
            let contact = cone.sole_soft_contact(&push).unwrap();
            assert!((contact.point - point).norm() < 1e-14 * (depth + 0.1), "{contact:?}");
            assert!((contact.normal - normal).norm() < 1e-14 * (1.0 + 0.1 / depth), "{contact:?}");
            assert!((contact.spin_torque - spin).abs() < 1e-14 * (depth + 0.1), "{contact:?}");
        }
    }
}

/// Tiny, huge, through the tip, without a torque, not a number: no answer, or a finite one.
#[test]
fn extremes() {
    fn all<T: Real>() {
        let [zero, one] = [T::zero(), T::one()];
        let cone = Cone::new(Vector3::zeros(), Vector3::z(), T::literal(0.6)).unwrap();
        let solid = Frustum::new(Vector3::zeros(), Vector3::z(), one, T::literal(0.5), one).unwrap();
        let elliptic = EllipticCylinder::new([T::literal(0.3), one], CylinderEnds::Capped(one)).unwrap();
        let endless = EllipticCylinder::new([T::literal(0.3), one], CylinderEnds::Unbounded).unwrap();
        let extremes = [
            zero,
            one,
            -one,
            T::LEAST_NORMAL,
            T::LEAST_NORMAL * T::EPSILON,
            T::GREATEST,
            zero / zero,
            one / zero,
        ];
        for force in extremes {
            for across in extremes {
                for torque in extremes {
                    for along in extremes {
                        let force = Vector3::new(across, zero, force);
                        let wrench = Wrench::on_fingertip(force, Vector3::new(zero, torque, along));
                        let Some(push) = ForceLine::new(&wrench, zero) else { continue };
                        let told = [
                            cone.sole_soft_contact(&push),
                            solid.sole_soft_contact(&push),
                            elliptic.sole_soft_contact(&push),
                            endless.sole_soft_contact(&push),
                        ];
                        for contact in told.into_iter().flatten() {
                            let sum = contact.point.sum() + contact.normal.sum() + contact.spin_torque;
                            assert!(sum.is_number(), "{wrench:?} {contact:?}");
                            assert!(contact.normal.dot(&force) < zero, "{wrench:?} {contact:?}");
                        }
                    }
                }
            }
        }
    }
    all::<f32>();
    all::<f64>();
}
