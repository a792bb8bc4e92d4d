//! The short way in double precision of a narrower type, where its own short way does not answer.

use fingertip_contact::{ContactModel, NoContact, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{ActiveSurface, Cone, ForceLine, Frustum, Posed, RoundedBox, Trimmed};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::slanted_sides::number;
use crate::wrenches::{Case, Random};

fn wide(wrench: &Wrench<f32>) -> Wrench<f64> {
    Wrench::on_fingertip(wrench.force().map(f64::from), wrench.torque().map(f64::from))
}

/// What of 4 000 contacts with a spin torque, at cosines of incidence above this, is left to double precision.
fn left<S: SoftFingerSurface<f32>>(
    shape: &S,
    double: &impl ActiveSurface<f64>,
    size: f64,
    least: f64,
    seed: u64,
) -> Vec<Wrench<f32>> {
    let mut random = Random::new(seed);
    let mut left = Vec::new();
    for _ in 0..4000 {
        let (point, normal) = random.place(double, size);
        let spin = random.sign() * random.log_uniform(1e-3, 0.3) * size;
        let wrench = number::<f32>(&Case::new(point, normal, random.force(&normal, least, 1.0), spin).wrench);
        let push = ForceLine::new(&wrench, ForceLine::least_squared()).unwrap();
        if shape.sole_soft_contact(&push).is_none() {
            left.push(wrench);
        }
    }
    left
}

/// How many of them are told: each is where double precision has it, which goes the long way there, and is what single
/// precision tells.
fn agree<S, D>(shape: &S, double: &D, size: f64, left: &[Wrench<f32>]) -> usize
where
    S: SoftFingerSurface<f32>,
    D: SoftFingerSurface<f64>,
{
    let model = SoftFinger::new(0.0_f32).unwrap().without_friction_limit();
    let exactly = SoftFinger::new(0.0).unwrap().without_friction_limit();
    let mut told = 0;
    for wrench in left {
        let Some(found) = shape.sole_soft_contact_in_double(&wide(wrench)) else { continue };
        let truth = exactly.resolve(&wide(wrench), double).into_result().unwrap();
        let off = (found.point - truth.point).norm() / size;
        let turned = (found.normal - truth.normal).norm();
        let spun = (found.spin_torque - truth.spin_torque).abs() / (size * wrench.force().norm() as f64);
        assert!(
            off < 1e-9 && turned < 1e-7 && spun < 1e-9,
            "{off:e} {turned:e} {spun:e} {wrench:?} {truth:?}"
        );
        let contact = model.resolve(wrench, shape).into_result().unwrap();
        let [point, normal] = [found.point, found.normal].map(|v| v.map(|x| x as f32));
        assert_eq!((contact.point, contact.normal), (point, normal), "{wrench:?}");
        assert_eq!(contact.spin_torque, found.spin_torque as f32, "{wrench:?}");
        told += 1;
    }
    told
}

/// From x to y, y to z and z to x, which no type rounds.
pub(crate) fn pose<T: Real>() -> RigidTransform<T> {
    let (zero, one) = (T::zero(), T::one());
    let turned = Matrix3::new(zero, zero, one, one, zero, zero, zero, one, zero);
    let origin = Vector3::new(0.0625, -0.03125, 0.125).map(T::literal);
    RigidTransform::from_parts(Rotation3::from_matrix_unchecked(turned), origin)
}

fn cone() -> (Cone<f32>, Cone<f64>) {
    let cone = Cone::new(Vector3::new(0.001_f32, 0.002, 0.009), Vector3::new(0.1, 0.2, -1.0), 0.5).unwrap();
    let cone = cone.with_depth(0.02).unwrap();
    (cone, cone.in_double().unwrap())
}

fn boxed() -> (RoundedBox<f32>, RoundedBox<f64>) {
    let shape = RoundedBox::new(Vector3::new(0.008_f32, 0.006, 0.004), 0.0005).unwrap();
    (shape, shape.in_double().unwrap())
}

#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not ask")]
fn cones_and_frusta() {
    let (cone, double) = cone();
    let left = left(&cone, &double, 0.02, 0.01, 81);
    let told = agree(&cone, &double, 0.02, &left);
    assert!(told * 4 >= left.len() * 3, "{told} of {}", left.len());

    let frustum =
        Frustum::new(Vector3::new(0.0, 0.001, -0.006_f32), Vector3::new(0.1, 0.1, 1.0), 0.012, 0.008, 0.003);
    let frustum = frustum.unwrap();
    let double = frustum.in_double().unwrap();
    let left = self::left(&frustum, &double, 0.012, 0.35, 82);
    let told = agree(&frustum, &double, 0.012, &left);
    assert!(told * 4 >= left.len(), "{told} of {}", left.len());
}

#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not ask")]
fn rounded_boxes() {
    let (shape, double) = boxed();
    let left = left(&shape, &double, 0.01, 0.35, 83);
    let told = agree(&shape, &double, 0.01, &left);
    assert!(told * 2 >= left.len(), "{told} of {}", left.len());
}

/// A pose moves what the shape tells, and a part tells what it has of it.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not ask")]
fn poses_and_parts() {
    let (shape, double) = boxed();
    let posed = (Posed::new(shape, pose()), Posed::new(double, pose()));
    let left = left(&posed.0, &posed.1, 0.1, 0.35, 84);
    let told = agree(&posed.0, &posed.1, 0.1, &left);
    assert!(told * 2 >= left.len(), "{told} of {}", left.len());

    let (part, whole) = (Trimmed::new(shape, |point: &Vector3<f32>| point.x > 0.002), shape);
    let model = SoftFinger::new(0.0_f32).unwrap().without_friction_limit();
    let (mut inside, mut outside) = (0, 0);
    for wrench in &[85, 87].map(|seed| self::left(&shape, &double, 0.01, 0.35, seed)).concat() {
        let Some(found) = whole.sole_soft_contact_in_double(&wide(wrench)) else { continue };
        if (found.point.x - 0.002).abs() < 1e-6 {
            continue;
        }
        match model.resolve(wrench, &part) {
            Resolution::Contact(contact) => {
                assert!(found.point.x > 0.002 && (contact.point.map(f64::from) - found.point).norm() < 1e-8);
                inside += 1;
            }
            Resolution::NoContact(NoContact::OutsideActiveRegion { point }) => {
                assert!(found.point.x < 0.002 && (point.map(f64::from) - found.point).norm() < 1e-8);
                outside += 1;
            }
            other => panic!("{other:?}"),
        }
    }
    assert!(inside > 40 && outside > 40, "{inside} {outside}");
}

/// What friction can't hold is none, nor what the noise of the torque may turn round: as double precision says of them.
#[test]
fn limits_are_those_of_the_long_way() {
    let (cone, double) = cone();
    let wrenches = left(&cone, &double, 0.02, 0.01, 86);
    let (single, exactly) = (SoftFinger::new(0.0_f32).unwrap(), SoftFinger::new(0.0).unwrap());
    let friction =
        (single.with_greatest_friction(1.5).unwrap(), exactly.with_greatest_friction(1.5).unwrap());
    let noise = (single.with_torque_noise(2e-3).unwrap(), exactly.with_torque_noise(2e-3).unwrap());
    let mut seen = [0; 3];
    for (narrow, wide_model) in [friction, noise] {
        for wrench in &wrenches {
            let (told, truth) = (narrow.resolve(wrench, &cone), wide_model.resolve(&wide(wrench), &double));
            match (told, truth) {
                (Resolution::Contact(_), Resolution::Contact(_)) => seen[0] += 1,
                (Resolution::NoContact(told), Resolution::NoContact(NoContact::BeyondFriction { .. })) => {
                    assert!(matches!(told, NoContact::BeyondFriction { .. }), "{told:?}");
                    seen[1] += 1;
                }
                (Resolution::NoContact(told), Resolution::NoContact(NoContact::Ambiguous { .. })) => {
                    assert!(matches!(told, NoContact::Ambiguous { .. }), "{told:?}");
                    seen[2] += 1;
                }
                (told, truth) => panic!("{wrench:?} {told:?} {truth:?}"),
            }
        }
    }
    assert!(seen.iter().all(|seen| *seen > 20), "{seen:?}");
}
