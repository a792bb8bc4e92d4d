//! Shapes that are given by an equation.

use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix3, Vector3};

use super::steepness::Steepness;
use crate::numeric::closest::by_search;
use crate::numeric::roots::all_of_lipschitz;
use crate::numeric::vectors::{foot, is_finite, length, unit_or};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Extent, Level, Shortcuts, SmoothSurface,
    Term, Topology, hessian_by_differences,
};

/// A surface `f(x) = 0`, with `f < 0` inside.
///
/// ```
/// use fingertip_surfaces::{Implicit, ImplicitSurface, Term};
/// use nalgebra::Vector3;
///
/// /// `x⁴ + y⁴ + z⁴ = R⁴`, in metres.
/// struct Pillow;
///
/// impl ImplicitSurface<f64> for Pillow {
///     fn formula(&self, [x, y, z]: [Term<f64>; 3]) -> Term<f64> {
///         (x / 0.01).powi(4) + (y / 0.01).powi(4) + (z / 0.01).powi(4) - 1.0
///     }
///     fn ball(&self) -> (Vector3<f64>, f64) {
///         (Vector3::zeros(), 0.0132)
///     }
/// }
///
/// let pillow = Implicit::new(Pillow)?;
/// # let _ = pillow;
/// // The corner of a pillow is farther out than the middle of its face: 10 mm · 3^(1/4) = 13.16 mm.
/// use fingertip_surfaces::ActiveSurface;
/// let diagonal = Vector3::repeat(1.0).normalize();
/// assert!(pillow.contains(&(diagonal * 0.0131)) && !pillow.contains(&(diagonal * 0.0132)));
/// assert!(!pillow.contains(&Vector3::new(0.0, 0.0, 0.0101)));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no implicit surface of `{T}`",
    note = "a shape by its equation implements `ImplicitSurface::formula` and `ball`, and is wrapped in `Implicit`"
)]
pub trait ImplicitSurface<T: Real> {
    /// Zero on the surface, negative inside; finite everywhere in the ball.
    ///
    /// Written with [`Term`]s, it tells how steep the value is over a box too: what makes the search for crossings
    /// certain to miss none.
    fn formula(&self, point: [Term<T>; 3]) -> Term<T>;

    /// Centre and radius \[m\] of a ball around the whole surface.
    fn ball(&self) -> (Vector3<T>, T);

    /// The formula at a point. Give it for speed.
    fn value(&self, point: &Vector3<T>) -> T {
        self.formula(Term::at((*point).into())).value()
    }

    /// Gradient of the value. The default differentiates the formula. Give it for speed.
    fn gradient(&self, point: &Vector3<T>) -> Vector3<T> {
        self.formula(Term::at((*point).into())).gradient()
    }

    /// A length that no gradient in the ball exceeds \[value per m\], if it is known better than from the formula:
    /// the search is faster, the smaller it is. [`Implicit::new`] refuses one that it sees exceeded. The default
    /// knows none.
    fn steepest(&self) -> Option<T> {
        None
    }

    /// The value near the surface, right to its own last digits rather than to those of its terms, as a
    /// wider type has it: asked for where a force meets the surface at a flat angle, and rounding of the
    /// value grows by the reciprocal cosine of incidence. Zero, as the default answers, takes [`value`](Self::value) at its
    /// word: at a cosine of a thousandth a contact may then be off by some hundred units in the last place of the size.
    fn value_left(&self, point: &Vector3<T>) -> T {
        let _ = point;
        T::zero()
    }

    /// Second derivatives of the value. The default takes them from differences of the gradient.
    fn hessian(&self, point: &Vector3<T>) -> Matrix3<T> {
        let step = self.ball().1 * T::EPSILON.cube_root();
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
/// All crossings are found but those closer to each other than 10⁻⁶ of the ball's radius, which may count as none.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Implicit, ImplicitSurface, Term};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// /// A paraboloid cut off by a ball: `max(z + (x² + y²)/R, x² + y² + z² − R²)`, in units of R = 10 mm.
/// struct Drop;
/// impl ImplicitSurface<f64> for Drop {
///     fn formula(&self, [x, y, z]: [Term<f64>; 3]) -> Term<f64> {
///         let (x, y, z) = (x / 0.01, y / 0.01, z / 0.01);
///         let across = x * x + y * y;
///         (z + across).max(across + z * z - 1.0)
///     }
///     fn ball(&self) -> (Vector3<f64>, f64) {
///         (Vector3::zeros(), 0.0101)
///     }
/// }
///
/// let tip = Implicit::new(Drop)?;
/// let line = Line { point: Vector3::new(0.005, 0.0, 0.05), direction: -Vector3::z() };
/// let mut heights = Vec::new();
/// tip.crossings(&line, |crossing| heights.push(crossing.point.z));
/// heights.sort_by(f64::total_cmp);
/// assert!(heights.len() == 2 && (heights[1] + 0.0025).abs() < 1e-12); // −0.5² · 10 mm
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Implicit<T: Real, S> {
    surface: S,
    centre: Vector3<T>,
    radius: T,
    steepness: Steepness<T>,
}

impl<T: Real, S> Implicit<T, S> {
    /// The surface that was wrapped.
    #[inline]
    #[must_use]
    pub const fn inner(&self) -> &S {
        &self.surface
    }

    /// No gradient near the surface is longer \[value per m\].
    #[inline]
    #[must_use]
    pub const fn steepest(&self) -> T {
        self.steepness.greatest
    }
}

impl<T: Real, S: ImplicitSurface<T>> Implicit<T, S> {
    /// Wraps an implicit surface, and finds how steep it is.
    ///
    /// # Errors
    /// [`BadShape`] unless its ball has a finite centre and a positive finite radius, and the steepness is positive and
    /// finite near the surface.
    pub fn new(surface: S) -> Result<Self, BadShape> {
        let (centre, radius) = surface.ball();
        BadShape::check_point("implicit surface", "centre", centre)?;
        BadShape::check_length("implicit surface", "radius", radius)?;
        let found = match surface.steepest() {
            None => Steepness::over_ball(|point| surface.formula(point), &centre, radius).ok_or(
                "known near the surface, where the formula divides by zero or takes the root of it: \
                 state the longest gradient, `steepest` (in a scene `steepest_per_m`)",
            ),
            Some(greatest) => Steepness::stated(|point| surface.gradient(point), &centre, radius, greatest)
                .ok_or("positive, finite and nowhere exceeded"),
        };
        let bad = |requirement| BadShape { shape: "implicit surface", parameter: "steepness", requirement };
        found.map_err(bad).map(|steepness| Self { surface, centre, radius, steepness })
    }

    fn unit_gradient(&self, point: &Vector3<T>) -> Vector3<T> {
        unit_or(&self.surface.gradient(point), || unit_or(&(point - self.centre), Vector3::z))
    }

    /// Distance to a nearby point of the surface that lies straight under `point`: steps along the
    /// gradient onto the surface alternate with steps across it towards `point`.
    fn distance(&self, point: &Vector3<T>) -> Distance<T> {
        let mut foot = *point;
        for _ in 0..64 {
            for _ in 0..3 {
                let gradient = self.surface.gradient(&foot);
                let step = gradient * (self.surface.value(&foot) / gradient.norm_squared());
                let longest = self.radius * T::literal(0.25);
                let size = length(&step);
                if is_finite(&step) {
                    foot -= if size > longest { step * (longest / size) } else { step };
                }
            }
            let normal = self.unit_gradient(&foot);
            let away = point - foot;
            let sideways = away - normal * away.dot(&normal);
            if !(length(&sideways) > self.radius * T::EPSILON) {
                break;
            }
            foot += sideways * (self.radius / (self.radius + length(&away)));
        }
        let normal = self.unit_gradient(&foot);
        Distance { distance: (point - foot).dot(&normal), normal }
    }
}

impl<T: Real, S: ImplicitSurface<T>> Implicit<T, S> {
    /// Compiled once, not once for each caller: a call through a pointer costs little beside what is done here.
    fn each_crossing(&self, line: &Line<T>, visit: &mut dyn FnMut(Crossing<T>)) {
        let (offset, along) = foot(line, &self.centre);
        let scaled = offset / self.radius;
        let squared = T::literal(1.001) - scaled.norm_squared();
        if !(squared > T::zero()) {
            return;
        }
        let reach = squared.root() * self.radius;
        let start = self.centre + offset;
        let place = |t: T| start + line.direction * t;
        let value = |t: T| {
            let (value, beyond) = (self.surface.value(&place(t)), self.steepness.below);
            if value.is_number() { value.max(-beyond).min(beyond) } else { T::one().min(beyond) }
        };
        let with_slope = |t: T| (value(t), self.surface.gradient(&place(t)).dot(&line.direction));
        all_of_lipschitz(-reach, reach, self.steepness.greatest, value, with_slope, |t| {
            let point = place(t);
            visit(Crossing { along: along + t, point, normal: self.unit_gradient(&point), active: true });
        });
    }
}

impl<T: Real, S: ImplicitSurface<T>> ActiveSurface<T> for Implicit<T, S> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.each_crossing(line, &mut visit);
    }

    /// By a bounded search: of the points of the line within the bounds, the one nearest to the surface.
    /// The point of the surface under a point of the line is one straight under it, not certainly the
    /// nearest: on a surface with hollows, and only there, the gap may be one to a farther part. A nearer one
    /// is ruled out as far as the steepness tells, and no farther: a point of the line within the bounds
    /// is no nearer to the surface than its value over [`steepest`](Self::steepest). To rule out more, as far as to a part x of
    /// the gap, takes values all over the tube around the line, of the order of 1/x of them times the cube
    /// of the steepness over the gradient: too many for one call.
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        Some(by_search(line, &self.centre, self.radius, |point| self.distance(point)))
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.unit_gradient(point)
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        length(&(point - self.centre)) <= self.radius && self.surface.value(point) < T::zero()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real, S: ImplicitSurface<T>> Shortcuts<T> for Implicit<T, S> {
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let left = self.surface.value_left(point);
        if left.is_zero() { left } else { left / length(&self.surface.gradient(point)) }
    }
}

impl<T: Real, S: ImplicitSurface<T>> SmoothSurface<T> for Implicit<T, S> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let inner = self.inner();
        Level { value: inner.value(point), gradient: inner.gradient(point), hessian: inner.hessian(point) }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.centre, radius: self.radius }
    }

    fn topology(&self) -> Topology {
        self.inner().topology()
    }
}

/// In files, the surface that is wrapped.
#[cfg(feature = "serde")]
mod files {
    use fingertip_wrench::Real;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    use super::{Implicit, ImplicitSurface};

    impl<T: Real, S: Serialize> Serialize for Implicit<T, S> {
        fn serialize<W: Serializer>(&self, serializer: W) -> Result<W::Ok, W::Error> {
            self.surface.serialize(serializer)
        }
    }

    impl<'de, T: Real, S: ImplicitSurface<T> + Deserialize<'de>> Deserialize<'de> for Implicit<T, S> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            Self::new(S::deserialize(deserializer)?).map_err(Error::custom)
        }
    }
}
