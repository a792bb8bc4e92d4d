//! The shapes that everything is tried on.

use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::{
    CappedCylinder, Capsule, Compound, Cone, Cylinder, CylinderEnds, Disk, DynSurface, Ellipsoid,
    EllipticCylinder, Frustum, HalfSpace, Heightfield, Implicit, Knot, Mesh, Offset, Paraboloid, Plane,
    Posed, Rectangle, Revolution, RoundedBox, Sphere, SphericalCap, Superquadric, Torus, Trimmed,
};
use fingertip_wrench::{Real, RigidTransform};
use nalgebra::Vector3;

use crate::pillow::Pillow;

pub(crate) fn sphere<T: Real>() -> Sphere<T> {
    Sphere::new(Vector3::new(T::literal(0.001), T::literal(-0.002), T::literal(0.003)), T::literal(0.013))
        .unwrap()
}

pub(crate) fn ellipsoid<T: Real>() -> Ellipsoid<T> {
    Ellipsoid::new(Vector3::new(T::literal(0.008), T::literal(0.011), T::literal(0.017))).unwrap()
}

pub(crate) fn plane<T: Real>() -> Plane<T> {
    let number = T::literal;
    Plane::new(
        Vector3::new(number(0.001), number(0.002), number(0.005)),
        Vector3::new(number(0.1), number(0.3), number(1.0)),
    )
    .unwrap()
}

pub(crate) fn cylinder<T: Real>() -> Cylinder<T> {
    let number = T::literal;
    Cylinder::new(
        Vector3::new(number(0.001), number(0.002), number(-0.001)),
        Vector3::new(number(0.2), number(-0.4), number(1.0)),
        number(0.009),
    )
    .unwrap()
}

pub(crate) fn elliptic_cylinder<T: Real>() -> EllipticCylinder<T> {
    EllipticCylinder::new([T::literal(0.007), T::literal(0.012)], CylinderEnds::Unbounded).unwrap()
}

/// A surface of revolution that is straight.
pub(crate) fn tube<T: Real>() -> Revolution<T, [Knot<T>; 3]> {
    Revolution::from_profile([0.0, 0.006, 0.012].map(|z| [T::literal(z), T::literal(0.008)])).unwrap()
}

pub(crate) fn cone<T: Real>() -> Cone<T> {
    let number = T::literal;
    Cone::new(
        Vector3::new(number(0.001), number(-0.001), number(0.004)),
        Vector3::new(number(0.1), number(0.2), number(-1.0)),
        number(0.5),
    )
    .unwrap()
}

pub(crate) fn capsule<T: Real>() -> Capsule<T> {
    let number = T::literal;
    Capsule::new(
        Vector3::zeros(),
        Vector3::new(number(0.3), number(0.1), number(1.0)),
        number(0.007),
        number(0.006),
    )
    .unwrap()
}

pub(crate) fn torus<T: Real>() -> Torus<T> {
    Torus::new(T::literal(0.010), T::literal(0.0035)).unwrap()
}

pub(crate) fn superquadric<T: Real>() -> Superquadric<T> {
    let number = T::literal;
    Superquadric::new(Vector3::new(number(0.008), number(0.010), number(0.013)), [number(0.7), number(0.8)])
        .unwrap()
}

pub(crate) fn rounded_box<T: Real>() -> RoundedBox<T> {
    let number = T::literal;
    RoundedBox::new(Vector3::new(number(0.008), number(0.010), number(0.013)), number(0.004)).unwrap()
}

pub(crate) fn paraboloid<T: Real>() -> Paraboloid<T> {
    Paraboloid::new([T::literal(0.010), T::literal(0.015)]).unwrap()
}

pub(crate) fn pillow<T: Real>() -> Implicit<T, Pillow> {
    Implicit::new(Pillow).unwrap()
}

fn vector<T: Real>(x: f64, y: f64, z: f64) -> Vector3<T> {
    Vector3::new(T::literal(x), T::literal(y), T::literal(z))
}

pub(crate) fn disk<T: Real>() -> Disk<T> {
    Disk::new(vector(0.001, 0.002, 0.005), vector(0.1, 0.3, 1.0), T::literal(0.012)).unwrap()
}

pub(crate) fn rectangle<T: Real>() -> Rectangle<T> {
    Rectangle::new(vector(0.001, 0.002, 0.005), vector(0.012, 0.0, 0.0), vector(0.0, 0.006, 0.008)).unwrap()
}

pub(crate) fn spherical_cap<T: Real>() -> SphericalCap<T> {
    SphericalCap::new(sphere(), vector(0.2, 0.1, 1.0), T::literal(-0.2)).unwrap()
}

pub(crate) fn capped_cylinder<T: Real>() -> CappedCylinder<T> {
    CappedCylinder::new(
        vector(0.001, 0.0, -0.001),
        vector(0.2, -0.4, 1.0),
        T::literal(0.009),
        T::literal(0.010),
    )
    .unwrap()
}

pub(crate) fn closed_elliptic_cylinder<T: Real>() -> EllipticCylinder<T> {
    let ends = CylinderEnds::Capped(T::literal(0.010));
    EllipticCylinder::new([T::literal(0.007), T::literal(0.012)], ends).unwrap()
}

pub(crate) fn frustum<T: Real>() -> Frustum<T> {
    let (base, axis) = (vector(0.001, 0.0, -0.008), vector(0.1, 0.2, 1.0));
    Frustum::new(base, axis, T::literal(0.010), T::literal(0.006), T::literal(0.016)).unwrap()
}

/// A closed cone.
pub(crate) fn spike<T: Real>() -> Frustum<T> {
    let (base, axis) = (vector(0.001, 0.0, -0.008), vector(0.1, 0.1, 1.0));
    Frustum::new(base, axis, T::literal(0.009), T::zero(), T::literal(0.016)).unwrap()
}

const GEL_TIP: [[f64; 2]; 5] =
    [[0.0, 0.0080], [0.004, 0.0080], [0.008, 0.0074], [0.012, 0.0052], [0.014, 0.0]];

pub(crate) fn gel_tip<T: Real>() -> Revolution<T, [Knot<T>; 5]> {
    Revolution::from_profile(GEL_TIP.map(|point| point.map(T::literal))).unwrap()
}

pub(crate) fn revolution<T: Real>() -> DynSurface<T> {
    DynSurface::Revolution(Revolution::from_points(&GEL_TIP.map(|point| point.map(T::literal))).unwrap())
}

pub(crate) fn heightfield<T: Real>() -> Heightfield<T> {
    let at = |k: usize| 0.002 * k as f64 - 0.008;
    let heights =
        (0..81).map(|k| T::literal(-(at(k % 9).powi(2) / 0.020 + at(k / 9).powi(2) / 0.030))).collect();
    Heightfield::new([T::literal(-0.008); 2], [T::literal(0.002); 2], 9, heights).unwrap()
}

/// A ball of few facets.
pub(crate) fn mesh<T: Real>() -> Mesh<T> {
    let (vertices, triangles) = ball_of_triangles::<T>(7, 9, None);
    let vertices: Vec<_> = vertices.iter().map(|v| v * T::literal(0.012)).collect();
    Mesh::new(&vertices, &triangles).unwrap()
}

fn pose<T: Real>() -> RigidTransform<T> {
    RigidTransform::from_axis_angle(vector(1.0, 0.4, -0.3), vector(0.001, 0.002, -0.002)).unwrap()
}

pub(crate) fn posed<T: Real>() -> DynSurface<T> {
    DynSurface::Posed(Box::new(Posed::new(capped_cylinder().into(), pose())))
}

pub(crate) fn trimmed<T: Real>() -> DynSurface<T> {
    let region = HalfSpace::new(vector(0.0, 0.0, 0.001), vector(0.0, 0.3, 1.0)).unwrap();
    DynSurface::Trimmed(Box::new(Trimmed::new(ellipsoid().into(), region)))
}

pub(crate) fn compound<T: Real>() -> Compound<CappedCylinder<T>, Sphere<T>> {
    let tip = capped_cylinder::<T>();
    Compound::new(
        tip,
        Sphere::new(tip.centre() + tip.axis() * T::literal(0.010), T::literal(0.0095)).unwrap(),
    )
}

pub(crate) fn grown_ellipsoid<T: Real>() -> Offset<T, Ellipsoid<T>> {
    Offset::new(ellipsoid(), T::literal(0.002)).unwrap()
}

/// A cylinder with round edges.
pub(crate) fn grown_cylinder<T: Real>() -> Offset<T, CappedCylinder<T>> {
    Offset::new(capped_cylinder(), T::literal(0.003)).unwrap()
}

/// A cylinder with a round end, held at an angle, as a file would have it.
pub(crate) fn dyn_surface<T: Real>() -> DynSurface<T> {
    let (tip, ball) = (capped_cylinder::<T>(), sphere::<T>());
    let ball =
        Sphere::new(tip.centre() + tip.axis() * T::literal(0.010), ball.radius() * T::literal(0.7)).unwrap();
    let whole = DynSurface::union(vec![tip.into(), ball.into()]).unwrap();
    DynSurface::Posed(Box::new(Posed::new(whole, pose())))
}

/// A shape of the very numbers that one in single precision has.
pub(crate) trait Widen {
    type Double;
    fn widened(&self) -> Self::Double;
}

fn wide(v: Vector3<f32>) -> Vector3<f64> {
    v.map(f64::from)
}

impl Widen for Sphere<f32> {
    type Double = Sphere<f64>;
    fn widened(&self) -> Sphere<f64> {
        Sphere::new(wide(self.centre()), self.radius().into()).unwrap()
    }
}

impl Widen for Ellipsoid<f32> {
    type Double = Ellipsoid<f64>;
    fn widened(&self) -> Ellipsoid<f64> {
        Ellipsoid::new(wide(self.semi_axes())).unwrap()
    }
}

impl Widen for Paraboloid<f32> {
    type Double = Paraboloid<f64>;
    fn widened(&self) -> Paraboloid<f64> {
        Paraboloid::new(self.radii().map(f64::from)).unwrap()
    }
}

impl Widen for Superquadric<f32> {
    type Double = Superquadric<f64>;
    fn widened(&self) -> Superquadric<f64> {
        Superquadric::new(wide(self.semi_axes()), self.exponents().map(f64::from)).unwrap()
    }
}

impl Widen for Implicit<f32, Pillow> {
    type Double = Implicit<f64, Pillow>;
    fn widened(&self) -> Implicit<f64, Pillow> {
        Implicit::new(*self.inner()).unwrap()
    }
}

impl Widen for Plane<f32> {
    type Double = Plane<f64>;
    fn widened(&self) -> Plane<f64> {
        Plane::new(wide(self.point()), wide(self.outward())).unwrap()
    }
}

impl Widen for Cylinder<f32> {
    type Double = Cylinder<f64>;
    fn widened(&self) -> Cylinder<f64> {
        Cylinder::new(wide(self.centre()), wide(self.axis()), self.radius().into()).unwrap()
    }
}

impl Widen for EllipticCylinder<f32> {
    type Double = EllipticCylinder<f64>;
    fn widened(&self) -> EllipticCylinder<f64> {
        let ends = match self.ends() {
            CylinderEnds::Unbounded => CylinderEnds::Unbounded,
            CylinderEnds::Open(half) => CylinderEnds::Open(half.into()),
            CylinderEnds::Capped(half) => CylinderEnds::Capped(half.into()),
        };
        EllipticCylinder::new(self.semi_axes().map(f64::from), ends).unwrap()
    }
}

impl Widen for Cone<f32> {
    type Double = Cone<f64>;
    fn widened(&self) -> Cone<f64> {
        Cone::new(wide(self.apex()), wide(self.axis()), self.half_angle().into()).unwrap()
    }
}

impl Widen for Capsule<f32> {
    type Double = Capsule<f64>;
    fn widened(&self) -> Capsule<f64> {
        let [half, radius] = [self.half_length(), self.radius()].map(f64::from);
        Capsule::new(wide(self.centre()), wide(self.axis()), radius, half).unwrap()
    }
}

impl Widen for RoundedBox<f32> {
    type Double = RoundedBox<f64>;
    fn widened(&self) -> RoundedBox<f64> {
        RoundedBox::new(wide(self.half_extents()), self.rounding().into()).unwrap()
    }
}

impl Widen for Torus<f32> {
    type Double = Torus<f64>;
    fn widened(&self) -> Torus<f64> {
        Torus::new(self.ring_radius().into(), self.tube_radius().into()).unwrap()
    }
}

impl Widen for CappedCylinder<f32> {
    type Double = CappedCylinder<f64>;
    fn widened(&self) -> CappedCylinder<f64> {
        let [radius, half] = [self.radius(), self.half_length()].map(f64::from);
        CappedCylinder::new(wide(self.centre()), wide(self.axis()), radius, half).unwrap()
    }
}

impl Widen for Frustum<f32> {
    type Double = Frustum<f64>;
    fn widened(&self) -> Frustum<f64> {
        let [height, base, top] = [self.height(), self.base_radius(), self.top_radius()].map(f64::from);
        Frustum::new(wide(self.base_centre()), wide(self.axis()), base, top, height).unwrap()
    }
}

impl<const N: usize> Widen for Revolution<f32, [Knot<f32>; N]> {
    type Double = Revolution<f64, [Knot<f64>; N]>;
    fn widened(&self) -> Revolution<f64, [Knot<f64>; N]> {
        let knots = core::array::from_fn(|k| self.knots()[k].point().map(f64::from));
        Revolution::from_profile(knots).unwrap()
    }
}

impl Widen for Offset<f32, Ellipsoid<f32>> {
    type Double = Offset<f64, Ellipsoid<f64>>;
    fn widened(&self) -> Offset<f64, Ellipsoid<f64>> {
        Offset::new(self.inner().widened(), self.distance().into()).unwrap()
    }
}
