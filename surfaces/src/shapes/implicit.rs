//! Shapes that are given by an equation.

use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix3, Vector3};

use crate::numeric::closest::by_search;
use crate::numeric::roots::all_of_lipschitz;
use crate::numeric::vectors::{foot, is_finite, length, unit_or};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Extent, Level, Shortcuts, SmoothSurface,
    Topology, hessian_by_differences,
};

/// Where an implicit surface lies and how steep its function is: what makes the search for
/// crossings certain to end and to miss none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImplicitBounds<T: Real> {
    /// Centre of a ball around the whole surface \[m\].
    pub centre: Vector3<T>,
    /// Radius of that ball \[m\].
    pub radius: T,
    /// No smaller than the length of the gradient anywhere in that ball \[value per m\].
    pub steepest: T,
}

/// A surface `f(x) = 0`, with `f < 0` inside.
///
/// ```
/// use fingertip_surfaces::{Implicit, ImplicitBounds, ImplicitSurface};
/// use nalgebra::Vector3;
///
/// /// `x⁴ + y⁴ + z⁴ = R⁴`, in metres.
/// struct Pillow;
///
/// impl ImplicitSurface<f64> for Pillow {
///     fn value(&self, p: &Vector3<f64>) -> f64 {
///         p.map(|x| (x / 0.01).powi(4)).sum() - 1.0
///     }
///     fn gradient(&self, p: &Vector3<f64>) -> Vector3<f64> {
///         p.map(|x| 4.0 * (x / 0.01).powi(3) / 0.01)
///     }
///     fn bounds(&self) -> ImplicitBounds<f64> {
///         ImplicitBounds { centre: Vector3::zeros(), radius: 0.0132, steepest: 1000.0 }
///     }
/// }
///
/// let pillow = Implicit::new(Pillow)?;
/// # let _ = pillow;
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
pub trait ImplicitSurface<T: Real> {
    /// Zero on the surface, negative inside; finite everywhere in the bounds.
    fn value(&self, point: &Vector3<T>) -> T;

    /// Gradient of the value.
    fn gradient(&self, point: &Vector3<T>) -> Vector3<T>;

    /// Where the surface lies, and how steep the value is there.
    fn bounds(&self) -> ImplicitBounds<T>;

    /// The value near the surface, right to its own last digits rather than to those of its terms, as a
    /// wider type has it: asked for where a force meets the surface at a flat angle, and rounding of the
    /// value grows. Zero, as the default answers, takes [`value`](Self::value) at its word.
    fn value_left(&self, point: &Vector3<T>) -> T {
        let _ = point;
        T::zero()
    }

    /// Second derivatives of the value. The default takes them from differences of the gradient.
    fn hessian(&self, point: &Vector3<T>) -> Matrix3<T> {
        let step = self.bounds().radius * T::EPSILON.cbrt();
        hessian_by_differences(point, step, |p| self.gradient(p))
    }

    /// What is known of the surface as a whole; the default assumes nothing. To say
    /// [`Topology::Convex`] of a convex surface makes a soft-finger contact a hundred times faster.
    fn topology(&self) -> Topology {
        Topology::Unknown
    }
}

/// An [`ImplicitSurface`] as an [`ActiveSurface`].
///
/// Crossings closer to each other than 10⁻⁶ of the bounds' radius may count as none; all others
/// are found, if `steepest` is what it says.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Implicit<S>(S);

impl<S> Implicit<S> {
    /// Wraps an implicit surface.
    ///
    /// # Errors
    /// [`BadShape`] unless its bounds are a finite centre, a positive finite radius and a positive
    /// finite steepness.
    pub fn new<T: Real>(surface: S) -> Result<Self, BadShape>
    where
        S: ImplicitSurface<T>,
    {
        let bounds = surface.bounds();
        BadShape::check_point("implicit surface", "centre", bounds.centre)?;
        BadShape::check_length("implicit surface", "radius", bounds.radius)?;
        let steep = bounds.steepest > T::zero() && bounds.steepest.is_number();
        BadShape::check("implicit surface", "steepness", "positive and finite", steep)?;
        Ok(Self(surface))
    }

    /// The surface that was wrapped.
    #[inline]
    #[must_use]
    pub const fn inner(&self) -> &S {
        &self.0
    }

    fn unit_gradient<T: Real>(&self, point: &Vector3<T>) -> Vector3<T>
    where
        S: ImplicitSurface<T>,
    {
        let centre = self.0.bounds().centre;
        unit_or(&self.0.gradient(point), || unit_or(&(point - centre), Vector3::z))
    }

    /// Distance to a nearby point of the surface that lies straight under `point`: steps along the
    /// gradient onto the surface alternate with steps across it towards `point`.
    fn distance<T: Real>(&self, point: &Vector3<T>) -> Distance<T>
    where
        S: ImplicitSurface<T>,
    {
        let bounds = self.0.bounds();
        let mut foot = *point;
        for _ in 0..64 {
            for _ in 0..3 {
                let gradient = self.0.gradient(&foot);
                let step = gradient * (self.0.value(&foot) / gradient.norm_squared());
                let longest = bounds.radius * T::literal(0.25);
                let size = length(&step);
                if is_finite(&step) {
                    foot -= if size > longest { step * (longest / size) } else { step };
                }
            }
            let normal = self.unit_gradient(&foot);
            let away = point - foot;
            let sideways = away - normal * away.dot(&normal);
            if !(length(&sideways) > bounds.radius * T::EPSILON) {
                break;
            }
            foot += sideways * (bounds.radius / (bounds.radius + length(&away)));
        }
        let normal = self.unit_gradient(&foot);
        Distance { distance: (point - foot).dot(&normal), normal }
    }
}

impl<T: Real, S: ImplicitSurface<T>> ActiveSurface<T> for Implicit<S> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let bounds = self.0.bounds();
        let (offset, along) = foot(line, &bounds.centre);
        let scaled = offset / bounds.radius;
        let squared = T::literal(1.001) - scaled.norm_squared();
        if !(squared > T::zero()) {
            return;
        }
        let reach = squared.root() * bounds.radius;
        let start = bounds.centre + offset;
        let value = |t: T| {
            let point = start + line.direction * t;
            let value = self.0.value(&point);
            (if value.is_number() { value } else { T::one() }, self.0.gradient(&point).dot(&line.direction))
        };
        all_of_lipschitz(-reach, reach, bounds.steepest, value, |t| {
            let point = start + line.direction * t;
            visit(Crossing { along: along + t, point, normal: self.unit_gradient(&point), active: true });
        });
    }

    /// By a bounded search: of the points of the line within the bounds, the one nearest to the surface.
    /// The point of the surface under a point of the line is one straight under it, not certainly the
    /// nearest: on a surface with hollows, and only there, the gap may be one to a farther part. A nearer one
    /// is ruled out as far as the steepness tells, and no farther: a point of the line within the bounds
    /// is no nearer to the surface than its value over `steepest`. To rule out more, as far as to a part x of
    /// the gap, takes values all over the tube around the line, of the order of 1/x of them times the cube
    /// of `steepest` over the gradient: too many for one call.
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let bounds = self.0.bounds();
        Some(by_search(line, &bounds.centre, bounds.radius, |point| self.distance(point)))
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.unit_gradient(point)
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        let bounds = self.0.bounds();
        length(&(point - bounds.centre)) <= bounds.radius && self.0.value(point) < T::zero()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real, S: ImplicitSurface<T>> Shortcuts<T> for Implicit<S> {
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let left = self.0.value_left(point);
        if left.is_zero() { left } else { left / length(&self.0.gradient(point)) }
    }
}

impl<T: Real, S: ImplicitSurface<T>> SmoothSurface<T> for Implicit<S> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let inner = self.inner();
        Level { value: inner.value(point), gradient: inner.gradient(point), hessian: inner.hessian(point) }
    }

    fn extent(&self) -> Extent<T> {
        let bounds = self.inner().bounds();
        Extent { centre: bounds.centre, radius: bounds.radius }
    }

    fn topology(&self) -> Topology {
        self.inner().topology()
    }
}
