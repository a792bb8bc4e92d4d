//! Parts of shapes: a contact on the rest is none, and is told as such, however it was found.

use fingertip_contact::{ContactModel, NoContact, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{ActiveSurface, Cone, Ellipsoid, Paraboloid, Posed, Trimmed};
use fingertip_wrench::{Real, RigidTransform};
use nalgebra::Vector3;

use crate::short_in_double::pose;
use crate::slanted_sides::number;
use crate::wrenches::{Case, Random};

/// On the whole shape, in double precision, that is moved to `pose`; `margin` tells how far within the active part a place
/// of it is \[m\].
fn tells_the_part<T: Real>(
    whole: &impl ActiveSurface<f64>,
    part: &impl SoftFingerSurface<T>,
    margin: impl Fn(&Vector3<f64>) -> f64,
    pose: &RigidTransform<f64>,
) {
    let reach = 0.02;
    let mut random = Random::new(91);
    let model = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
    let near = 2e-4 * reach;
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..600 {
        let (place, normal) = random.place(whole, reach);
        let (point, normal) = (pose.rotation() * place + pose.origin(), pose.rotation() * normal);
        let spin = random.sign() * random.log_uniform(1e-3, 0.3) * reach;
        let least = random.log_uniform(0.02, 0.9);
        let wrench = number::<T>(&Case::new(point, normal, random.force(&normal, least, 1.0), spin).wrench);
        if margin(&place).abs() < 2.0 * near {
            continue;
        }
        let (found, is_inside) = match model.resolve(&wrench, part) {
            Resolution::Contact(contact) => (contact.point, true),
            Resolution::NoContact(NoContact::OutsideActiveRegion { point }) => (point, false),
            other => panic!("{other:?} {wrench:?}"),
        };
        assert!((found.map(Real::to_f64) - point).norm() < near, "{found:?} {point:?}");
        assert_eq!(is_inside, margin(&place) > 0.0, "{place:?}");
        *(if is_inside { &mut inside } else { &mut outside }) += 1;
    }
    assert!(inside > 50 && outside > 50, "{inside} {outside}");
}

/// The shape as it is and in another place, with a part of its own and one that is cut out of it.
macro_rules! parts {
    ($name:ident, $whole:ident, $part:ident, $margin:expr) => {
        #[test]
        fn $name() {
            fn check<T: Real>() {
                let (whole, part) = ($whole::<f64>(), $part::<T>());
                let margin = $margin;
                let cut = |whole| {
                    Trimmed::new(whole, move |point: &Vector3<T>| margin(&point.map(Real::to_f64)) > 0.0)
                };
                let (here, there) = (RigidTransform::identity(), pose::<f64>());
                tells_the_part::<T>(&whole, &part, margin, &here);
                tells_the_part::<T>(&whole, &cut($whole()), margin, &here);
                tells_the_part::<T>(&whole, &Posed::new(part, pose()), margin, &there);
                tells_the_part::<T>(&whole, &Posed::new(cut($whole()), pose()), margin, &there);
            }
            check::<f32>();
            check::<f64>();
        }
    };
}

fn pad<T: Real>() -> Paraboloid<T> {
    Paraboloid::new([0.02, 0.03].map(T::literal)).unwrap()
}

fn shallow_pad<T: Real>() -> Paraboloid<T> {
    pad().with_depth(T::literal(0.003)).unwrap()
}

fn cone<T: Real>() -> Cone<T> {
    Cone::new(Vector3::new(0.0, 0.0, 0.009).map(T::literal), -Vector3::z(), T::literal(0.5)).unwrap()
}

fn short_cone<T: Real>() -> Cone<T> {
    cone().with_depth(T::literal(0.012)).unwrap()
}

fn tip<T: Real>() -> Ellipsoid<T> {
    Ellipsoid::new(Vector3::new(0.01, 0.012, 0.015).map(T::literal)).unwrap()
}

parts!(a_paraboloid_down_to_a_depth, pad, shallow_pad, |point: &Vector3<f64>| 0.003 + point.z);
parts!(a_cone_down_to_a_depth, cone, short_cone, |point: &Vector3<f64>| 0.012 - (0.009 - point.z));

#[test]
fn the_upper_half_of_an_ellipsoid() {
    let upper = Trimmed::new(tip::<f32>(), |point: &Vector3<f32>| point.z > 0.002);
    tells_the_part(&tip::<f64>(), &upper, |point| point.z - 0.002, &RigidTransform::identity());
}
