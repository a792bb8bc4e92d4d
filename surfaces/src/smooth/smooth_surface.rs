//! Surfaces that know their curvature.

use fingertip_wrench::Real;
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::ActiveSurface;

/// A function that vanishes on a surface and grows outward, with its derivatives at a point.
///
/// ```
/// use fingertip_surfaces::{SmoothSurface, Sphere};
/// use nalgebra::Vector3;
///
/// let level = Sphere::centred(0.01)?.level(&Vector3::new(0.0, 0.0, 0.01));
/// let (normal, _) = level.normal().unwrap();
/// assert_eq!(normal, Vector3::z());
/// // As the point moves to the side, the normal turns by the reciprocal of the radius.
/// let turned = level.shape_operator() * Vector3::x();
/// assert!((turned - Vector3::x() * 100.0).amax() < 1e-12_f64);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level<T: Real> {
    /// The value, in any unit; best if it grows about linearly across the surface, as a distance
    /// or a gauge does.
    pub value: T,
    /// Its gradient.
    pub gradient: Vector3<T>,
    /// Its Hessian, symmetric.
    pub hessian: Matrix3<T>,
}

impl<T: Real> Level<T> {
    /// The outward unit normal and the length of the gradient; `None` where the gradient vanishes
    /// or is not finite.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> Option<(Vector3<T>, T)> {
        let scale = self.gradient.amax().normalising_factor();
        let scaled = self.gradient * scale;
        let length = scaled.norm_squared().root();
        (length > T::zero() && length.is_number()).then(|| (scaled / length, length / scale))
    }

    /// The shape operator `W = (I − nnᵀ) H (I − nnᵀ)/|g|` \[1/m\]: the normal changes by `W dc` as
    /// the point moves by `dc` on the surface. Its eigenvalues are zero, along the normal, and the
    /// principal curvatures, positive where the surface is convex. Zero where the gradient
    /// vanishes.
    #[must_use]
    pub fn shape_operator(&self) -> Matrix3<T> {
        self.normal().map_or_else(Matrix3::zeros, |(normal, steepness)| {
            let flat = Matrix3::identity() - normal * normal.transpose();
            flat * self.hessian * flat / steepness
        })
    }

    /// Its matrix in two unit vectors across the gradient, of which this is the length.
    #[inline]
    pub(super) fn bend(&self, steepness: T, [e1, e2]: [&Vector3<T>; 2]) -> Matrix2<T> {
        let inverse = T::one() / steepness;
        let (w1, w2) = (self.hessian * e1, self.hessian * e2);
        let mixed = e1.dot(&w2) * inverse;
        Matrix2::new(e1.dot(&w1) * inverse, mixed, mixed, e2.dot(&w2) * inverse)
    }
}

/// What is known of a surface as a whole: it tells how many contacts there can be.
///
/// ```
/// use fingertip_surfaces::{SmoothSurface, Sphere, Topology, Torus};
///
/// assert_eq!(Sphere::centred(0.013)?.topology(), Topology::Convex);
/// // A ring has a hole.
/// assert_eq!(Torus::new(0.02, 0.003)?.topology(), Topology::Closed { euler_characteristic: 0 });
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Topology {
    /// The boundary of a convex body: at most one contact presses.
    Convex,
    /// Closed and not convex, with this Euler characteristic (2 for a dented ball, 0 for a ring).
    Closed {
        /// Vertices − edges + faces of any mesh of it.
        euler_characteristic: i8,
    },
    /// Nothing is known.
    Unknown,
}

/// A ball around the part of a surface that matters.
///
/// ```
/// use fingertip_surfaces::{Capsule, SmoothSurface};
/// use nalgebra::Vector3;
///
/// // A capsule of 5 mm around a segment of ±10 mm fits into a ball of 15 mm.
/// let extent = Capsule::new(Vector3::y(), Vector3::z(), 0.005, 0.01)?.extent();
/// assert_eq!(extent.centre, Vector3::y());
/// assert!((extent.radius - 0.015_f64).abs() < 1e-15);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent<T: Real> {
    /// Centre of the ball \[m\].
    pub centre: Vector3<T>,
    /// Its radius \[m\].
    pub radius: T,
}

/// A place where the normal turns though the point stays.
///
/// ```
/// use fingertip_surfaces::{CappedCylinder, Corner, SmoothSurface};
/// use nalgebra::Vector3;
///
/// // The rim of a cylinder of 5 mm, touched between its end and its side.
/// let tip = CappedCylinder::new(Vector3::zeros(), Vector3::z(), 0.005, 0.02)?;
/// let normal = Vector3::new(0.6, 0.0, 0.8);
/// let corner = tip.corner(&Vector3::new(0.005, 0.0, 0.02), &normal).unwrap();
/// let Corner::Edge { direction, bend } = corner else { unreachable!("a rim is no tip") };
/// assert!((f64::abs(direction.y) - 1.0).abs() < 1e-15);
/// assert!((bend - 0.6_f64 / 0.005).abs() < 1e-12); // the circle's curvature, as the normal sees it
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Corner<T: Real> {
    /// An edge.
    Edge {
        /// Unit vector along it.
        direction: Vector3<T>,
        /// How fast a normal turns towards that as the point moves along it \[1/m\]: `−n·c″` for the edge
        /// `c` as a function of its length. Positive where the edge is convex, zero where it is straight.
        bend: T,
    },
    /// A tip: all normals within a cone, at one point.
    Tip,
}

/// A surface with a level function that is twice differentiable (almost) everywhere.
///
/// # For users
/// What soft-finger contacts, curvature-dependent stiffness and the covariance of a contact are
/// computed from.
///
/// # For implementers
/// [`level`](Self::level) shall be finite in the extent. Where second derivatives are hard to
/// come by, [`hessian_by_differences`] takes them from the gradient: contacts lose no accuracy by
/// it, only time.
///
/// ```
/// use fingertip_surfaces::{BadShape, Ellipsoid, SmoothSurface};
/// use nalgebra::Vector3;
///
/// /// The radius of the roundest curve through a point of a surface.
/// fn least_radius(surface: &impl SmoothSurface<f64>, point: &Vector3<f64>) -> f64 {
///     surface.shape_operator(point).symmetric_eigenvalues().max().recip()
/// }
///
/// // At its end an ellipsoid is curved by c/a² and c/b².
/// let tip = Ellipsoid::new(Vector3::new(0.008, 0.010, 0.016))?;
/// assert!((least_radius(&tip, &Vector3::new(0.0, 0.0, 0.016)) - 0.004).abs() < 1e-15);
/// # Ok::<(), BadShape>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not know its curvature in `{T}`",
    note = "a shape of your own implements `SmoothSurface::level` and `extent` beside `ActiveSurface`"
)]
pub trait SmoothSurface<T: Real>: ActiveSurface<T> {
    /// The level function and its derivatives at a point near the surface.
    fn level(&self, point: &Vector3<T>) -> Level<T>;

    /// Where the surface is. For an unbounded surface, a ball around the part in use.
    fn extent(&self) -> Extent<T>;

    /// What is known of the surface as a whole.
    fn topology(&self) -> Topology {
        Topology::Unknown
    }

    /// The shape operator at a point of the surface, [`Level::shape_operator`].
    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        self.level(point).shape_operator()
    }

    /// The shape operator in the tangent plane at a point of the surface: its matrix \[1/m\] in two
    /// unit vectors that span the plane across the normal there. All that a covariance needs.
    ///
    /// NaN on an edge or a tip, where the normal turns though the point stays: that is told by a normal
    /// that is not the one of the level function. See [`corner`](Self::corner).
    #[inline]
    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        let level = self.level(point);
        let steepness = level.gradient.dot(normal);
        if !agree(&level.gradient, &(normal * steepness), steepness) {
            return Matrix2::repeat(T::zero() / T::zero());
        }
        level.bend(steepness, tangents)
    }

    /// What edge or tip a contact with this normal is on; asked where [`bend`](Self::bend) is NaN. The
    /// default knows of none.
    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        let _ = (point, normal);
        None
    }
}

/// `true` if two vectors of this length are the same but for what rounding may have done to a normal: it
/// turns as rounding moves its point, on a slender cone by far more than a unit in the last place.
#[inline]
pub(crate) fn agree<T: Real>(one: &Vector3<T>, other: &Vector3<T>, length: T) -> bool {
    (one - other).amax() <= T::EPSILON.root().root() * length
}

impl<T: Real, S: SmoothSurface<T>> SmoothSurface<T> for &S {
    #[inline]
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        (**self).level(point)
    }

    #[inline]
    fn extent(&self) -> Extent<T> {
        (**self).extent()
    }

    #[inline]
    fn topology(&self) -> Topology {
        (**self).topology()
    }

    #[inline]
    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        (**self).shape_operator(point)
    }

    #[inline]
    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        (**self).bend(point, normal, tangents)
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        (**self).corner(point, normal)
    }
}

/// The Hessian from central differences of the gradient over `step` \[m\] (best near `ε^(1/3)` of
/// the size of the surface), made symmetric.
pub fn hessian_by_differences<T: Real>(
    point: &Vector3<T>,
    step: T,
    gradient: impl Fn(&Vector3<T>) -> Vector3<T>,
) -> Matrix3<T> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let columns = axes.map(|axis| {
        let (ahead, behind) = (point + axis * step, point - axis * step);
        (gradient(&ahead) - gradient(&behind)) / (step + step)
    });
    let hessian = Matrix3::from_columns(&columns);
    (hessian + hessian.transpose()) * T::literal(0.5)
}

/// The shape operator \[1/m\] of any surface at one of its points, from central differences of
/// [`ActiveSurface::normal`] over `step` \[m\] along the tangent plane. Exact to `(step·curvature)²`
/// where the normal is smooth over the step; a surface of flat facets answers with the curvature
/// averaged over the step.
pub fn shape_operator_by_differences<T: Real, S: ActiveSurface<T>>(
    surface: &S,
    point: &Vector3<T>,
    step: T,
) -> Matrix3<T> {
    let normal = surface.normal(point);
    let slope = hessian_by_differences(point, step, |p| {
        let offset = p - point;
        surface.normal(&(point + offset - normal * offset.dot(&normal)))
    });
    let flat = Matrix3::identity() - normal * normal.transpose();
    let operator = flat * slope * flat;
    if operator.iter().all(|x| x.is_number()) { operator } else { Matrix3::zeros() }
}
