//! A surface chosen at run time.

use alloc::boxed::Box;
use alloc::vec::Vec;

use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::active_surface::nearest_crossing;
use crate::combinators::{around_both, closest_of, is_inside_along};
use crate::{
    ActiveSurface, CappedCylinder, Capsule, ClosestApproach, Cone, Corner, Crossing, Cylinder, Disk,
    Ellipsoid, EllipticCylinder, Entry, Extent, ForceLine, Frustum, HalfSpace, Heightfield, Knot, Level,
    Mesh, Paraboloid, Plane, Posed, Rectangle, Revolution, RoundedBox, Shortcuts, SmoothSurface, Sphere,
    SphericalCap, Superquadric, Topology, Torus, Trimmed,
};

/// Any of the shapes: for files and programs that learn the shape at run time. On a hot path use
/// the shape's own type, which costs no branch.
///
/// In a file the key `shape` names the shape, the other keys are its parameters, with units:
///
/// ```
/// # #[cfg(feature = "serde")] {
/// use fingertip_surfaces::DynSurface;
///
/// let finger: DynSurface<f64> = toml::from_str(r#"
///     shape = "posed"
///     translation_m = [0.0, 0.0, 0.03]
///     rotation_deg = [0.0, 90.0, 0.0]
///     [surface]
///     shape = "capsule"
///     half_length_m = 0.01
///     radius_m = 0.007
/// "#).unwrap();
/// assert!(matches!(finger, DynSurface::Posed(_)));
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        tag = "shape",
        rename_all = "snake_case",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub enum DynSurface<T: Real> {
    /// [`Plane`].
    Plane(Plane<T>),
    /// [`Disk`].
    Disk(Disk<T>),
    /// [`Rectangle`].
    Rectangle(Rectangle<T>),
    /// [`SphericalCap`], of which the whole sphere is one: in a file it may be called `spherical_cap`, too.
    #[cfg_attr(feature = "serde", serde(alias = "spherical_cap"))]
    Sphere(SphericalCap<T>),
    /// [`Ellipsoid`].
    Ellipsoid(Ellipsoid<T>),
    /// [`Cylinder`].
    Cylinder(Cylinder<T>),
    /// [`CappedCylinder`].
    CappedCylinder(CappedCylinder<T>),
    /// [`EllipticCylinder`].
    EllipticCylinder(EllipticCylinder<T>),
    /// [`Capsule`].
    Capsule(Capsule<T>),
    /// [`Cone`].
    Cone(Cone<T>),
    /// [`Frustum`].
    Frustum(Frustum<T>),
    /// [`Torus`].
    Torus(Torus<T>),
    /// [`Superquadric`].
    Superquadric(Superquadric<T>),
    /// [`RoundedBox`].
    RoundedBox(RoundedBox<T>),
    /// [`Paraboloid`].
    Paraboloid(Paraboloid<T>),
    /// [`Revolution`].
    Revolution(Revolution<T, Vec<Knot<T>>>),
    /// [`Heightfield`].
    Heightfield(Heightfield<T>),
    /// [`Mesh`].
    Mesh(Mesh<T>),
    /// [`Posed`].
    Posed(Box<Posed<T, Self>>),
    /// [`Trimmed`] to a half-space.
    Trimmed(Box<Trimmed<Self, HalfSpace<T>>>),
    /// The union of any number of shapes, as [`Compound`](crate::Compound) is of two.
    Compound(Parts<T>),
}

/// The members of a union.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        deny_unknown_fields,
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub struct Parts<T: Real> {
    /// The shapes; one at least, or nothing is ever met.
    pub parts: Vec<DynSurface<T>>,
}

/// Calls a method of whichever shape it is.
#[doc(hidden)]
#[macro_export]
macro_rules! each_surface {
    ($surface:expr, $shape:ident => $call:expr) => {
        match $surface {
            $crate::DynSurface::Plane($shape) => $call,
            $crate::DynSurface::Disk($shape) => $call,
            $crate::DynSurface::Rectangle($shape) => $call,
            $crate::DynSurface::Sphere($shape) => $call,
            $crate::DynSurface::Ellipsoid($shape) => $call,
            $crate::DynSurface::Cylinder($shape) => $call,
            $crate::DynSurface::CappedCylinder($shape) => $call,
            $crate::DynSurface::EllipticCylinder($shape) => $call,
            $crate::DynSurface::Capsule($shape) => $call,
            $crate::DynSurface::Cone($shape) => $call,
            $crate::DynSurface::Frustum($shape) => $call,
            $crate::DynSurface::Torus($shape) => $call,
            $crate::DynSurface::Superquadric($shape) => $call,
            $crate::DynSurface::RoundedBox($shape) => $call,
            $crate::DynSurface::Paraboloid($shape) => $call,
            $crate::DynSurface::Revolution($shape) => $call,
            $crate::DynSurface::Heightfield($shape) => $call,
            $crate::DynSurface::Mesh($shape) => $call,
            $crate::DynSurface::Posed($shape) => $call,
            $crate::DynSurface::Trimmed($shape) => $call,
            $crate::DynSurface::Compound($shape) => $call,
        }
    };
}

impl<T: Real> ActiveSurface<T> for DynSurface<T> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        // By reference, so that nested shapes do not make ever new types of visitors.
        let visit: &mut dyn FnMut(Crossing<T>) = &mut visit;
        each_surface!(self, shape => shape.crossings(line, visit));
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        each_surface!(self, shape => shape.closest_approach(line))
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        each_surface!(self, shape => shape.normal(point))
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        each_surface!(self, shape => shape.contains(point))
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

/// Those of whichever shape it is, but for what is promised of a type.
impl<T: Real> Shortcuts<T> for DynSurface<T> {
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        each_surface!(self, shape => shape.shortcuts().sole_entry(push))
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        each_surface!(self, shape => shape.shortcuts().surface_residual(point))
    }
}

impl<T: Real> Parts<T> {
    /// The part whose surface is nearest to a point along a normal, or without one, along its own, which on
    /// an edge of it may lead past it; none if no line meets any.
    fn nearest(&self, point: &Vector3<T>, normal: Option<&Vector3<T>>) -> Option<&DynSurface<T>> {
        let mut best = (T::GREATEST, None);
        for part in &self.parts {
            let direction = normal.copied().unwrap_or_else(|| part.normal(point));
            if let Some(crossing) = nearest_crossing(part, &Line { point: *point, direction })
                && crossing.along.abs() < best.0
            {
                best = (crossing.along.abs(), Some(part));
            }
        }
        best.1
    }
}

impl<T: Real> ActiveSurface<T> for Parts<T> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        for (k, part) in self.parts.iter().enumerate() {
            part.crossings(line, |c| {
                // Of two that cross in the same place, the later one owns it.
                let mut others = self.parts.iter().enumerate().filter(|(other, _)| *other != k);
                if !others.any(|(other, s)| is_inside_along(s, line, c.along, &c.point, other > k)) {
                    visit(c);
                }
            });
        }
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let nothing = ClosestApproach {
            gap: T::GREATEST,
            point: Vector3::zeros(),
            normal: Vector3::z(),
            active: false,
        };
        self.parts.iter().try_fold(nothing, |best, part| Some(closest_of(best, part.closest_approach(line)?)))
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.nearest(point, None).map_or_else(Vector3::z, |part| part.normal(point))
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.parts.iter().any(|part| part.contains(point))
    }

    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

/// The residual of the part whose surface is nearest.
impl<T: Real> Shortcuts<T> for Parts<T> {
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        self.nearest(point, None).map_or_else(T::zero, |part| part.shortcuts().surface_residual(point))
    }
}

impl<T: Real> SmoothSurface<T> for DynSurface<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        each_surface!(self, shape => shape.level(point))
    }

    fn extent(&self) -> Extent<T> {
        each_surface!(self, shape => shape.extent())
    }

    fn topology(&self) -> Topology {
        each_surface!(self, shape => shape.topology())
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        each_surface!(self, shape => shape.shape_operator(point))
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        each_surface!(self, shape => shape.bend(point, normal, tangents))
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        each_surface!(self, shape => shape.corner(point, normal))
    }
}

/// That of the part whose surface is nearest; of no parts, a plane far away.
impl<T: Real> SmoothSurface<T> for Parts<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let nothing = || Level { value: T::GREATEST, gradient: Vector3::z(), hessian: Matrix3::zeros() };
        self.nearest(point, None).map_or_else(nothing, |part| part.level(point))
    }

    fn extent(&self) -> Extent<T> {
        let whole = self.parts.iter().map(SmoothSurface::extent).reduce(|a, b| around_both(&a, &b));
        whole.unwrap_or(Extent { centre: Vector3::zeros(), radius: T::zero() })
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        self.nearest(point, None).map_or_else(Matrix3::zeros, |part| part.shape_operator(point))
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        self.nearest(point, Some(normal))
            .map_or_else(Matrix2::zeros, |part| part.bend(point, normal, tangents))
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        self.nearest(point, Some(normal))?.corner(point, normal)
    }
}

impl<T: Real> From<Sphere<T>> for DynSurface<T> {
    fn from(sphere: Sphere<T>) -> Self {
        Self::Sphere(sphere.into())
    }
}

impl<T: Real> From<SphericalCap<T>> for DynSurface<T> {
    fn from(cap: SphericalCap<T>) -> Self {
        Self::Sphere(cap)
    }
}

macro_rules! from {
    ($($shape:ident),+ $(,)?) => {
        $(impl<T: Real> From<$shape<T>> for DynSurface<T> {
            fn from(shape: $shape<T>) -> Self {
                Self::$shape(shape)
            }
        })+
    };
}

from!(
    Plane,
    Disk,
    Rectangle,
    Ellipsoid,
    Cylinder,
    CappedCylinder,
    EllipticCylinder,
    Capsule,
    Cone,
    Frustum,
    Torus,
    Superquadric,
    RoundedBox,
    Paraboloid,
    Heightfield,
    Mesh,
);
