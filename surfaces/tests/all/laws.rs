//! Every shape obeys the laws, in both precisions; so does what knows only where a line crosses it.

use fingertip_surfaces::testing::SurfaceLaws;
use fingertip_surfaces::*;
use fingertip_wrench::{Line, Real, RigidTransform};
use nalgebra::Vector3;

fn v<T: Real>(x: f64, y: f64, z: f64) -> Vector3<T> {
    Vector3::new(T::literal(x), T::literal(y), T::literal(z))
}

fn l<T: Real>(x: f64) -> T {
    T::literal(x)
}

/// A shape that tells its crossings and nothing else.
struct OnlyCrossings<S>(S);

impl<T: Real, S: ActiveSurface<T>> ActiveSurface<T> for OnlyCrossings<S> {
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>)) {
        self.0.crossings(line, visit);
    }
}

/// Defines one test per scalar that checks the laws of a shape, and their scaling.
macro_rules! laws {
    ($name:ident, $laws:expr, |$scale:ident| $shape:expr) => {
        mod $name {
            use super::*;

            fn check<T: Real>() {
                let make = |$scale: T| $shape.ok();
                let laws: SurfaceLaws<T> = $laws;
                laws.check(&make(T::one()).unwrap()).unwrap();
                laws.with_lines(200).check(&OnlyCrossings(make(T::one()).unwrap())).unwrap();
                laws.check_scaling(make).unwrap();
            }

            #[test]
            fn f32() {
                check::<f32>();
            }

            #[test]
            fn f64() {
                check::<f64>();
            }
        }
    };
}

fn around<T: Real>(x: f64, y: f64, z: f64, radius: f64) -> SurfaceLaws<T> {
    SurfaceLaws::around(v(x, y, z), l(radius)).with_lines(1000)
}

laws!(plane, around(0.0, 0.0, 0.1, 1.0).without_inside(), |k| Plane::new(
    v(0.0, 0.0, 0.1) * k,
    v(1.0, -2.0, 3.0)
));
laws!(disk, around(0.0, 0.0, 0.1, 1.0).without_inside(), |k| Disk::new(
    v(0.0, 0.0, 0.1) * k,
    v(1.0, -2.0, 3.0),
    k
));
laws!(rectangle, around(0.0, 0.0, 0.1, 1.0).without_inside(), |k| {
    Rectangle::new(v(0.0, 0.0, 0.1) * k, v(0.5, 0.0, 0.0) * k, v(0.0, 0.3, 0.4) * k)
});
laws!(sphere, around(0.3, -0.2, 0.1, 1.0), |k| Sphere::new(v(0.3, -0.2, 0.1) * k, k));
laws!(spherical_cap, around(0.3, -0.2, 0.1, 1.0), |k| {
    SphericalCap::with_opening(Sphere::new(v(0.3, -0.2, 0.1) * k, k).unwrap(), v(1.0, 0.5, 0.0), k * l(0.54))
});
laws!(ellipsoid, around(0.0, 0.0, 0.0, 1.2), |k| Ellipsoid::new(v(1.2, 0.8, 0.5) * k));
laws!(flat_ellipsoid, around(0.0, 0.0, 0.0, 1.0), |k| Ellipsoid::new(v(1.0, 0.9, 0.1) * k));
laws!(cylinder, around(0.3, -0.2, 0.1, 2.0).without_inside(), |k| {
    Cylinder::new(v(0.3, -0.2, 0.1) * k, v(1.0, 2.0, 3.0), k).and_then(|c| c.with_half_length(k))
});
laws!(capped_cylinder, around(0.3, -0.2, 0.1, 1.5).with_edges(), |k| {
    CappedCylinder::new(v(0.3, -0.2, 0.1) * k, v(1.0, 2.0, 3.0), k * l(0.7), k)
});
laws!(open_elliptic_cylinder, around(0.0, 0.0, 0.0, 2.0).without_inside(), |k| {
    EllipticCylinder::new([k * l(1.0), k * l(0.4)], CylinderEnds::Open(k))
});
laws!(unbounded_elliptic_cylinder, around(0.0, 0.0, 0.0, 2.0).without_inside(), |k| {
    EllipticCylinder::new([k * l(1.0), k * l(0.4)], CylinderEnds::Unbounded)
});
laws!(capped_elliptic_cylinder, around(0.0, 0.0, 0.0, 1.5).with_edges(), |k| {
    EllipticCylinder::new([k * l(1.0), k * l(0.4)], CylinderEnds::Capped(k))
});
laws!(capsule, around(0.3, -0.2, 0.1, 1.5), |k| {
    Capsule::new(v(0.3, -0.2, 0.1) * k, v(1.0, 2.0, 3.0), k * l(0.5), k)
});
laws!(cone, around(0.5, 0.2, 0.7, 1.5).without_inside().with_edges(), |k| {
    Cone::new(v(0.3, -0.2, 0.1) * k, v(1.0, 2.0, 3.0), l(0.6)).and_then(|c| c.with_depth(k))
});
laws!(frustum, around(0.3, -0.2, 0.1, 1.5).with_edges(), |k| {
    Frustum::new(v(0.1, -0.6, -0.5) * k, v(1.0, 2.0, 3.0), k, k * l(0.4), k * l(1.5))
});
laws!(widening_frustum, around(0.3, -0.2, 0.1, 1.5).with_edges(), |k| {
    Frustum::new(v(0.1, -0.6, -0.5) * k, v(1.0, 2.0, 3.0), k * l(0.2), k, k * l(1.0))
});
laws!(closed_cone, around(0.3, -0.2, 0.1, 1.5).with_edges(), |k| {
    Frustum::new(v(0.1, -0.6, -0.5) * k, v(1.0, 2.0, 3.0), k, l(0.0), k * l(1.5))
});
laws!(torus, around(0.0, 0.0, 0.0, 1.3).with_roundings(l(128.0)), |k| Torus::new(k, k * l(0.3)));
laws!(fat_torus, around(0.0, 0.0, 0.0, 1.9).with_roundings(l(128.0)), |k| Torus::new(k, k * l(0.9)));
laws!(rounded_box, around(0.0, 0.0, 0.0, 1.3), |k| RoundedBox::new(v(1.0, 0.8, 0.4) * k, k * l(0.2)));
laws!(sharp_box, around(0.0, 0.0, 0.0, 1.3).with_edges(), |k| RoundedBox::new(
    v(1.0, 0.8, 0.4) * k,
    k * l(0.0)
));
laws!(round_superquadric, around(0.0, 0.0, 0.0, 1.3), |k| {
    Superquadric::new(v(1.0, 0.8, 0.5) * k, [l(0.7), l(1.2)])
});
laws!(boxy_superquadric, around(0.0, 0.0, 0.0, 1.5).with_roundings(l(256.0)).with_edges(), |k| {
    Superquadric::new(v(1.0, 0.8, 0.5) * k, [l(0.1), l(0.1)])
});
laws!(octahedral_superquadric, around(0.0, 0.0, 0.0, 1.0).with_edges(), |k| {
    Superquadric::new(v(1.0, 0.8, 0.5) * k, [l(2.0), l(2.0)])
});
laws!(paraboloid, around(0.0, 0.0, -0.5, 1.0).without_inside(), |k| {
    Paraboloid::new([k * l(1.0), k * l(0.6)]).and_then(|p| p.with_depth(k))
});
laws!(sphere_of_revolution, around(0.0, 0.0, 0.0, 1.0), |k| {
    Revolution::from_profile([
        [k * l(-1.0), l(0.0)],
        [k * l(-0.6), k * l(0.8)],
        [l(0.0), k],
        [k * l(0.8), k * l(0.6)],
        [k, l(0.0)],
    ])
});
laws!(gel_tip_of_revolution, around(0.0, 0.0, 0.007, 0.012).with_edges(), |k| {
    Revolution::from_profile([
        [k * l(0.000), k * l(0.0080)],
        [k * l(0.004), k * l(0.0080)],
        [k * l(0.008), k * l(0.0074)],
        [k * l(0.012), k * l(0.0052)],
        [k * l(0.014), k * l(0.0)],
    ])
});
laws!(posed_ellipsoid, around(0.3, 0.0, 1.0, 1.2), |k| {
    let pose = RigidTransform::from_axis_angle(v(1.0, 2.0, -1.0), v(0.3, 0.0, 1.0) * k).unwrap();
    Ellipsoid::new(v(1.2, 0.8, 0.5) * k).map(|e| Posed::new(e, pose))
});
laws!(trimmed_sphere, around(0.0, 0.0, 0.0, 1.0), |k| {
    let region = HalfSpace::new(v::<_>(0.0, 0.0, 0.2) * k, v(0.0, 0.0, 1.0)).unwrap();
    Sphere::centred(k).map(|s| Trimmed::new(s, region))
});
laws!(compound, around(0.0, 0.0, 0.3, 1.6).with_edges(), |k| {
    CappedCylinder::new(v(0.0, 0.0, 0.0) * k, v(0.0, 0.0, 1.0), k * l(0.5), k).and_then(|shaft| {
        Sphere::new(v(0.0, 0.0, 1.0) * k, k * l(0.8)).map(|ball| Compound::new(shaft, ball))
    })
});
laws!(seamless_compound, around(0.0, 0.0, 0.3, 1.6).with_edges(), |k| {
    CappedCylinder::new(v(0.0, 0.0, 0.0) * k, v(0.0, 0.0, 1.0), k * l(0.5), k).and_then(|shaft| {
        Sphere::new(v(0.0, 0.0, 1.0) * k, k * l(0.5)).map(|ball| Compound::new(shaft, ball))
    })
});
laws!(offset_ellipsoid, around(0.0, 0.0, 0.0, 1.4).with_roundings(l(256.0)), |k| {
    Ellipsoid::new(v(1.2, 0.8, 0.5) * k).and_then(|e| Offset::new(e, k * l(0.2)))
});
laws!(inset_ellipsoid, around(0.0, 0.0, 0.0, 1.4).with_roundings(l(256.0)), |k| {
    Ellipsoid::new(v(1.2, 0.9, 0.8) * k).and_then(|e| Offset::new(e, k * l(-0.1)))
});
laws!(offset_box, around(0.0, 0.0, 0.0, 1.5), |k| {
    RoundedBox::new(v(1.0, 0.8, 0.4) * k, k * l(0.0)).and_then(|e| Offset::new(e, k * l(0.2)))
});
laws!(offset_torus, around(0.0, 0.0, 0.0, 1.4).with_roundings(l(256.0)).lines_few(), |k| {
    Torus::new(k, k * l(0.3)).and_then(|t| Offset::new(t, k * l(0.05)))
});

trait Few {
    fn lines_few(self) -> Self;
}

impl<T: Real> Few for SurfaceLaws<T> {
    fn lines_few(self) -> Self {
        self.with_lines(200)
    }
}

/// `x⁴ + y⁴ + z⁴ = R⁴`.
struct Pillow<T>(T);

impl<T: Real> ImplicitSurface<T> for Pillow<T> {
    fn formula(&self, [x, y, z]: [Term<T>; 3]) -> Term<T> {
        (x / self.0).powi(4) + (y / self.0).powi(4) + (z / self.0).powi(4) - T::one()
    }

    fn ball(&self) -> (Vector3<T>, T) {
        (Vector3::zeros(), self.0 * l(1.32))
    }
}

laws!(implicit_pillow, around(0.0, 0.0, 0.0, 1.3).with_roundings(l(256.0)).lines_few(), |k| Implicit::new(
    Pillow(k)
));

/// Beside a surface that tells its crossings alone, the normal is that where it is nearest, not that of a place farther on.
#[test]
fn normals_beside_a_surface_are_those_of_the_nearest_crossing() {
    let ball = OnlyCrossings(Sphere::centred(0.01_f64).unwrap());
    for k in 0..100 {
        let (turn, height) = (f64::from(k) * 2.4, f64::from(k) * 0.02 - 0.99);
        let across = (1.0 - height * height).sqrt();
        let outward = Vector3::new(across * turn.cos(), across * turn.sin(), height);
        for distance in [0.007, 0.0099, 0.0101, 0.012] {
            let found = ball.normal(&(outward * distance));
            assert!(found.dot(&outward) > 0.99, "{distance}: {found:?} {outward:?}");
        }
    }
}
