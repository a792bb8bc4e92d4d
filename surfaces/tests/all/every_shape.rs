//! One of every shape, made of round numbers, so that edges, axes and tangents lie on round numbers too.

use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::*;
use fingertip_wrench::{Line, Real, RigidTransform};
use nalgebra::Vector3;

pub(crate) fn l<T: Real>(x: f64) -> T {
    T::literal(x)
}

pub(crate) fn v<T: Real>(x: f64, y: f64, z: f64) -> Vector3<T> {
    Vector3::new(l(x), l(y), l(z))
}

/// What is told of a line that misses.
pub(crate) fn approach<T: Real>(surface: &impl ActiveSurface<T>, line: &Line<T>) -> ClosestApproach<T> {
    surface.closest_approach(line).unwrap()
}

/// All crossings, in ascending order.
pub(crate) fn crossings<T: Real>(surface: &impl ActiveSurface<T>, line: &Line<T>) -> Vec<Crossing<T>> {
    let mut found = Vec::new();
    surface.crossings(line, |c| found.push(c));
    found.sort_by(|a, b| a.along.partial_cmp(&b.along).unwrap());
    found
}

pub(crate) struct Shape<T: Real> {
    pub(crate) name: &'static str,
    pub(crate) surface: DynSurface<T>,
    /// It has an inside that every line leaves again, and `contains` knows it.
    pub(crate) closed: bool,
    /// Within a metre or two of the origin.
    pub(crate) bounded: bool,
    /// A line that misses lies straight over the nearest place, along its normal.
    pub(crate) told_by_normal: bool,
}

const CLOSED: [bool; 3] = [true, true, true];
const FLAT: [bool; 3] = [false, false, true];

/// Every shape, `k` times as large as it is for 1.
pub(crate) fn every_shape<T: Real>(k: T) -> Vec<Shape<T>> {
    let o = Vector3::zeros;
    let z = Vector3::z;
    let skew = v(1.0, -2.0, 2.0);
    let pose = RigidTransform::from_axis_angle(v(0.3, -0.4, 0.5), v(0.5, 0.0, -0.5) * k).unwrap();
    let half_space = HalfSpace::new(v::<T>(0.0, 0.0, 0.5) * k, z()).unwrap();
    let ball = || Sphere::centred(k).unwrap();
    let profile = [[-1.0, 0.0], [-0.5, 1.0], [0.5, 1.0], [1.0, 0.5]];
    let waist = [[-1.0, 1.0], [0.0, 0.5], [1.0, 1.0]];
    let turned = |points: &[[f64; 2]]| {
        let points: Vec<_> = points.iter().map(|p| p.map(|x| l::<T>(x) * k)).collect();
        DynSurface::Revolution(Revolution::from_points(&points).unwrap())
    };
    let heights = [0.0, 0.5, 0.0, 0.25, 0.5, 0.5, 1.0, 0.5, 0.0, 0.25, 0.0, -0.5];
    let heights = heights.map(|h| l::<T>(h) * k).to_vec();
    let (vertices, triangles) = ball_of_triangles::<T>(4, 4, None);
    let vertices: Vec<_> = vertices.iter().map(|p| p * k).collect();
    let shaft = || Capsule::new(o(), z(), l::<T>(0.5) * k, k).unwrap();
    let tip = Sphere::new(z() * k, l::<T>(0.75) * k).unwrap();
    let shape = |name, surface, [closed, bounded, told_by_normal]: [bool; 3]| Shape {
        name,
        surface,
        closed,
        bounded,
        told_by_normal,
    };
    let half = l::<T>(0.5) * k;
    vec![
        shape("plane", Plane::new(z() * half, z()).unwrap().into(), FLAT),
        shape("disk", Disk::new(z() * half, skew, k).unwrap().into(), FLAT),
        shape(
            "rectangle",
            Rectangle::new(Vector3::y() * half, Vector3::x() * k, Vector3::y() * half).unwrap().into(),
            FLAT,
        ),
        shape("sphere", ball().into(), CLOSED),
        shape("spherical cap", SphericalCap::new(ball(), z(), l(0.5)).unwrap().into(), CLOSED),
        shape("ellipsoid", Ellipsoid::new(v(1.0, 0.5, 0.75) * k).unwrap().into(), CLOSED),
        shape("spheroid", Ellipsoid::new(v(0.5, 0.5, 1.0) * k).unwrap().into(), CLOSED),
        shape("cylinder", Cylinder::new(o(), z(), half).unwrap().into(), [false, false, true]),
        shape(
            "open cylinder",
            Cylinder::new(Vector3::x() * half, skew, half).unwrap().with_half_length(k).unwrap().into(),
            [false, false, true],
        ),
        shape("capped cylinder", CappedCylinder::new(o(), z(), half, k).unwrap().into(), CLOSED),
        shape(
            "elliptic cylinder",
            EllipticCylinder::new([k, half], CylinderEnds::Unbounded).unwrap().into(),
            [false, false, true],
        ),
        shape(
            "open elliptic cylinder",
            EllipticCylinder::new([half, k], CylinderEnds::Open(half)).unwrap().into(),
            [false, false, true],
        ),
        shape(
            "capped elliptic cylinder",
            EllipticCylinder::new([k, half], CylinderEnds::Capped(half)).unwrap().into(),
            CLOSED,
        ),
        shape("capsule", Capsule::new(o(), z(), half, half).unwrap().into(), CLOSED),
        shape("skew capsule", Capsule::new(Vector3::x() * half, skew, half, k).unwrap().into(), CLOSED),
        shape(
            "cone",
            Cone::new(v(0.125, 0.0625, 1.03125) * k, -z(), T::frac_pi_4()).unwrap().into(),
            [false, false, true],
        ),
        shape(
            "open cone",
            Cone::new(v(0.125, 0.0625, 0.03125) * k, skew, l(0.6)).unwrap().with_depth(k).unwrap().into(),
            [false, false, true],
        ),
        shape("frustum", Frustum::new(-z() * half, z(), k, half, k).unwrap().into(), CLOSED),
        shape("closed cone", Frustum::new(o(), z(), T::zero(), k, k).unwrap().into(), CLOSED),
        shape("torus", Torus::new(k, half).unwrap().into(), CLOSED),
        shape(
            "superquadric",
            Superquadric::new(v(1.0, 0.5, 1.0) * k, [l(0.5), l(1.0)]).unwrap().into(),
            CLOSED,
        ),
        shape("octahedron", Superquadric::new(v(1.0, 0.5, 1.0) * k, [l(2.0); 2]).unwrap().into(), CLOSED),
        shape("box", RoundedBox::new(v(1.0, 0.5, 0.5) * k, T::zero()).unwrap().into(), CLOSED),
        shape("rounded box", RoundedBox::new(v(1.0, 1.0, 0.5) * k, l::<T>(0.25) * k).unwrap().into(), CLOSED),
        shape("paraboloid", Paraboloid::new([k, half]).unwrap().into(), [false, false, true]),
        shape(
            "cut paraboloid",
            Paraboloid::new([half, k]).unwrap().with_depth(half).unwrap().into(),
            [false, false, true],
        ),
        shape("revolution", turned(&profile), CLOSED),
        shape("waist", turned(&waist), CLOSED),
        shape(
            "heightfield",
            Heightfield::new(
                [-1.25, -1.125].map(|x| l::<T>(x) * k),
                [1.25, 0.75].map(|x| l::<T>(x) * k),
                3,
                heights,
            )
            .unwrap()
            .into(),
            [false, true, false],
        ),
        shape("mesh", Mesh::new(&vertices, &triangles).unwrap().into(), [true, true, false]),
        shape("posed", DynSurface::Posed(Box::new(Posed::new(shaft().into(), pose))), CLOSED),
        shape(
            "trimmed",
            DynSurface::Trimmed(Box::new(Trimmed::new(
                Ellipsoid::new(v(0.5, 1.0, 1.0) * k).unwrap().into(),
                half_space,
            ))),
            CLOSED,
        ),
        shape("compound", DynSurface::union(vec![shaft().into(), tip.into()]).unwrap(), CLOSED),
    ]
}
