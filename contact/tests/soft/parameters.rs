//! How a contact moves with the sizes and the place of its shape.

use fingertip_contact::{GeometrySensitivity, SoftFingerSurface};
use fingertip_surfaces::{
    CappedCylinder, Capsule, Cone, Cylinder, CylinderEnds, Disk, Ellipsoid, EllipticCylinder, Frustum,
    HalfSpace, Offset, Paraboloid, Plane, Posed, RoundedBox, SmoothSurface, Sphere, SphericalCap,
    Superquadric, Torus, Trimmed,
};
use fingertip_test_support::Worst;
use fingertip_wrench::{Real, RigidTransform};
use nalgebra::{Vector3, Vector6};

use crate::common;
use crate::jacobians::*;
use crate::wrenches::Random;

/// A surface with one parameter switched on, at the value it has.
fn by_parameter<S, D, const P: usize>(
    name: &str,
    surface: &S,
    size: f64,
    sensitivities: impl Fn(&Vector3<f64>) -> [GeometrySensitivity<f64>; P],
    dual: impl Fn(usize) -> D,
) where
    S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    D: SoftFingerSurface<Dual> + SmoothSurface<Dual>,
{
    for model in [Model::Point, Model::Soft] {
        let mut random = Random::new(29);
        let mut worst = Worst::new();
        for _ in 0..200 {
            let case = case(&mut random, surface, size, model);
            let (contact, jacobian) = contact_and_jacobian(model, surface, &case);
            for (index, change) in sensitivities(&contact.point).iter().enumerate() {
                let found = dual_contact(model, &dual(index), &seeded(&case.wrench, None), &contact.point);
                let reference = local(&found, &jacobian.tangents());
                let ours = jacobian.answer_to(change);
                // A normal keeps its length.
                let lean = change.tilt.dot(&contact.normal).abs();
                assert!(lean <= 1e-12 * (1.0 + change.tilt.norm()), "{name} {lean:e}");
                let scale = Vector6::new(1.0, 1.0, 200.0, 200.0, 200.0, 2.0);
                let point = jacobian.point_answer_to(change) - found.point.map(|x| x.eps);
                let off = (ours - reference).component_div(&scale).norm().hypot(point.norm());
                assert!(off <= 1e-12, "{name} {off:e}");
                worst.see(off);
            }
        }
        let worst = worst.get();
        println!("{name:16} ∂/∂θ against dual numbers: {worst:.1e}");
        assert!(worst <= 1e-12, "{name} {worst:e}");
    }
}

/// What a surface says of all its sizes.
pub(crate) fn sizes<const P: usize>(
    surface: &impl SoftFingerSurface<f64>,
    point: &Vector3<f64>,
) -> [GeometrySensitivity<f64>; P] {
    assert_eq!(surface.sensitivity(P, point), None);
    core::array::from_fn(|size| surface.sensitivity(size, point).unwrap())
}

pub(crate) fn on(value: f64, switched: bool) -> Dual {
    Dual::new(value, f64::from(u8::from(switched)))
}

#[test]
fn parameters_of_the_sphere() {
    let surface = common::sphere::<f64>();
    let (centre, radius) = (surface.centre(), surface.radius());
    by_parameter(
        "sphere",
        &surface,
        0.017,
        |point| {
            let moved = GeometrySensitivity::rigid_motions(&surface, point, &Vector3::zeros());
            [surface.sensitivity(0, point).unwrap(), moved[0], moved[1], moved[2]]
        },
        |index| {
            let moved =
                Vector3::new(on(centre.x, index == 1), on(centre.y, index == 2), on(centre.z, index == 3));
            Sphere::new(moved, on(radius, index == 0)).unwrap()
        },
    );
}

#[test]
fn parameters_of_the_ellipsoid() {
    let surface = common::ellipsoid::<f64>();
    let axes = surface.semi_axes();
    by_parameter(
        "ellipsoid",
        &surface,
        0.017,
        |point| sizes::<3>(&surface, point),
        |index| {
            Ellipsoid::new(Vector3::new(
                on(axes.x, index == 0),
                on(axes.y, index == 1),
                on(axes.z, index == 2),
            ))
            .unwrap()
        },
    );
}

/// Sizes of a shape against the shape made from dual numbers.
macro_rules! by_sizes {
    ($name:ident, $size:literal, $sizes:expr, |$list:ident| $make:expr) => {
        #[test]
        fn $name() {
            fn make<T: Real>($list: [T; SIZES.len()]) -> impl SoftFingerSurface<T> + SmoothSurface<T> {
                $make.unwrap()
            }
            const SIZES: &[f64] = &$sizes;
            let surface = make(core::array::from_fn(|k| SIZES[k]));
            by_parameter(
                stringify!($name),
                &surface,
                $size,
                |point| sizes::<{ SIZES.len() }>(&surface, point),
                |index| make(core::array::from_fn(|k| on(SIZES[k], k == index))),
            );
        }
    };
}

fn tilted<T: Real>() -> Vector3<T> {
    Vector3::new(T::literal(0.3), T::literal(0.1), T::one())
}

by_sizes!(sizes_of_the_cone, 0.017, [0.5], |s| {
    Cone::new(Vector3::new(T::literal(0.001), T::literal(-0.002), T::literal(0.003)), -tilted(), s[0])
});
by_sizes!(sizes_of_the_capsule, 0.017, [0.006, 0.007], |s| Capsule::new(
    Vector3::zeros(),
    tilted(),
    s[1],
    s[0]
));
by_sizes!(sizes_of_the_elliptic_cylinder, 0.017, [0.007, 0.012], |s| EllipticCylinder::new(
    s,
    CylinderEnds::Unbounded
));
by_sizes!(sizes_of_the_torus, 0.0135, [0.010, 0.0035], |s| Torus::new(s[0], s[1]));
by_sizes!(sizes_of_the_plane, 0.017, [0.005], |s| {
    let normal = tilted::<T>().normalize();
    Plane::new(normal * s[0], normal)
});
by_sizes!(sizes_of_the_superquadric, 0.017, [0.008, 0.010, 0.013], |s| Superquadric::new(
    Vector3::from(s),
    [T::literal(0.7), T::literal(0.8)]
));
by_sizes!(sizes_of_the_paraboloid, 0.02, [0.010, 0.015], |s| Paraboloid::new(s));
by_sizes!(sizes_of_the_rounded_box, 0.017, [0.008, 0.010, 0.013, 0.004], |s| RoundedBox::new(
    Vector3::new(s[0], s[1], s[2]),
    s[3]
));

// On the side and on the ends alike.
by_sizes!(sizes_of_the_capped_cylinder, 0.013, [0.007, 0.011], |s| CappedCylinder::new(
    Vector3::zeros(),
    tilted(),
    s[0],
    s[1]
));
by_sizes!(sizes_of_the_closed_elliptic_cylinder, 0.014, [0.007, 0.012], |s| EllipticCylinder::new(
    s,
    CylinderEnds::Capped(T::literal(0.010))
));
by_sizes!(sizes_of_the_frustum, 0.013, [0.016, 0.009, 0.005], |s| Frustum::new(
    Vector3::new(T::literal(0.001), T::zero(), T::literal(-0.008)),
    tilted(),
    s[1],
    s[2],
    s[0]
));
by_sizes!(sizes_of_the_cylinder, 0.017, [0.009], |s| Cylinder::new(Vector3::zeros(), tilted(), s[0]));
by_sizes!(sizes_of_the_spherical_cap, 0.017, [0.013], |s| Sphere::centred(s[0])
    .and_then(|sphere| SphericalCap::new(sphere, tilted(), T::literal(-0.2))));
by_sizes!(sizes_of_the_disk, 0.013, [0.005], |s| Disk::new(
    tilted::<T>().normalize() * s[0],
    tilted(),
    T::literal(0.012)
));
by_sizes!(sizes_of_the_grown_ellipsoid, 0.019, [0.002], |s| Offset::new(common::ellipsoid::<T>(), s[0]));
by_sizes!(sizes_of_a_posed_and_trimmed_cone, 0.015, [0.5], |s| {
    let pose = RigidTransform::from_axis_angle(tilted(), tilted::<T>() * T::literal(0.002)).unwrap();
    let half_space = HalfSpace::new(tilted::<T>() * T::literal(-0.02), tilted());
    Cone::new(Vector3::zeros(), -tilted(), s[0])
        .and_then(|cone| half_space.map(|region| Posed::new(Trimmed::new(cone, region), pose)))
});

/// Turning a cylinder about an axis through the origin turns its axis and its centre.
#[test]
fn attitude_of_the_cylinder() {
    let surface = common::cylinder::<f64>();
    by_parameter(
        "cylinder",
        &surface,
        0.017,
        |point| {
            let moved = GeometrySensitivity::rigid_motions(&surface, point, &Vector3::zeros());
            [moved[3], moved[4], moved[5], surface.sensitivity(0, point).unwrap()]
        },
        |index| {
            let turned = |v: Vector3<f64>| {
                let rate = [Vector3::x(), Vector3::y(), Vector3::z()]
                    .get(index)
                    .map_or(Vector3::zeros(), |axis: &Vector3<f64>| axis.cross(&v));
                v.zip_map(&rate, Dual::new)
            };
            Cylinder::new(turned(surface.centre()), turned(surface.axis()), on(surface.radius(), index == 3))
                .unwrap()
        },
    );
}
