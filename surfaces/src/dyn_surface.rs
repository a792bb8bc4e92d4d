//! A surface chosen at run time.

use alloc::boxed::Box;
use alloc::vec::Vec;

use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::{
    ActiveSurface, CappedCylinder, Capsule, ClosestApproach, Compound, Cone, Corner, Crossing, Cylinder,
    Disk, Ellipsoid, EllipticCylinder, Entry, Extent, ForceLine, Formula, Frustum, HalfSpace, Heightfield,
    Implicit, Knot, Level, LineInDouble, Mesh, Paraboloid, Plane, Posed, Rectangle, Revolution, RoundedBox,
    Shortcuts, SmoothSurface, Sphere, SphericalCap, Superquadric, Topology, Torus, Trimmed,
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
    /// [`Implicit`] by a [`Formula`], which scenes read; it is not stored as part of another shape.
    #[cfg_attr(feature = "serde", serde(skip))]
    Formula(Box<Implicit<T, Formula<T>>>),
    /// [`Posed`].
    Posed(Box<Posed<T, Self>>),
    /// [`Trimmed`] to a half-space.
    Trimmed(Box<Trimmed<Self, HalfSpace<T>>>),
    /// [`Compound`], of two parts or more ([`DynSurface::union`]); in files a list, `parts`.
    #[cfg_attr(feature = "serde", serde(with = "parts"))]
    Compound(Box<Compound<Self, Self>>),
}

impl<T: Real> DynSurface<T> {
    /// The union of any number of shapes: each of two halves is the union of its halves. `None` of no shape.
    ///
    /// ```
    /// use fingertip_surfaces::{ActiveSurface, DynSurface, Sphere};
    /// use nalgebra::Vector3;
    ///
    /// let ball = |x| Sphere::new(Vector3::new(x, 0.0, 0.0), 0.006).map(DynSurface::from);
    /// let row = DynSurface::union(vec![ball(-0.008)?, ball(0.0)?, ball(0.008)?]);
    /// assert!(row.is_some_and(|row| row.contains(&Vector3::new(0.013, 0.0, 0.0))));
    /// # Ok::<(), fingertip_surfaces::BadShape>(())
    /// ```
    #[must_use]
    pub fn union(mut parts: Vec<Self>) -> Option<Self> {
        if parts.len() < 2 {
            return parts.pop();
        }
        let rest = parts.split_off(parts.len() / 2);
        let (first, second) = (Self::union(parts)?, Self::union(rest)?);
        Some(Self::Compound(Box::new(Compound::new(first, second))))
    }
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
            $crate::DynSurface::Formula($shape) => $call,
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

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        each_surface!(self, shape => shape.shortcuts().entry_in_double(line, near))
    }

    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        each_surface!(self, shape => shape.shortcuts().posed_entry_in_double(line, near))
    }

    fn is_moved(&self) -> bool {
        each_surface!(self, shape => shape.shortcuts().is_moved())
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

/// In files, the parts of a union in one list.
#[cfg(feature = "serde")]
mod parts {
    use alloc::vec::Vec;

    use fingertip_wrench::Real;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    use super::{Box, Compound, DynSurface};

    type Union<T> = Compound<DynSurface<T>, DynSurface<T>>;

    #[derive(Serialize)]
    struct Written<'a, T> {
        parts: Vec<&'a T>,
    }

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Read<T> {
        parts: Vec<T>,
    }

    fn collect<'a, T: Real>(union: &'a Union<T>, parts: &mut Vec<&'a DynSurface<T>>) {
        let (first, second) = union.parts();
        for part in [first, second] {
            match part {
                DynSurface::Compound(inner) => collect(inner, parts),
                other => parts.push(other),
            }
        }
    }

    pub(super) fn serialize<T: Real + Serialize, S: Serializer>(
        union: &Union<T>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let mut parts = Vec::new();
        collect(union, &mut parts);
        Written { parts }.serialize(serializer)
    }

    pub(super) fn deserialize<'de, T: Real + Deserialize<'de>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Box<Union<T>>, D::Error> {
        let Read { parts } = Read::<DynSurface<T>>::deserialize(deserializer)?;
        let enough = parts.len() >= 2;
        match DynSurface::union(parts) {
            Some(DynSurface::Compound(union)) if enough => Ok(union),
            _ => Err(Error::custom("a compound needs two `parts` or more")),
        }
    }
}
