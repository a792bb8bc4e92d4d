//! What a shape must be able to tell.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::ForceLine;
use crate::numeric::vectors::in_range;

/// Where a line passes through a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<T: Real> {
    /// Signed distance from the line's point, along its direction \[m\].
    pub along: T,
    /// The point itself \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// `false` where the point belongs to the shape but not to the part that may touch: beyond
    /// the rim of a disk, past the end of an open cylinder.
    pub active: bool,
}

/// Where a force enters a surface that its line enters only once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry<T: Real> {
    /// The point of the surface \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// The square of the cosine of incidence, `(f·n)²/|f|²`. Closed forms know it before they know
    /// the normal; unless it is positive the line misses, and the other fields mean nothing.
    pub incidence_squared: T,
    /// What the force's parts along the normal and along the surface measure, where a closed form knows
    /// that before it knows the normal. `None` says nothing.
    pub parts: Option<ForceParts<T>>,
    /// `false` where the point belongs to the shape but not to the part that may touch.
    pub active: bool,
}

/// Magnitudes of a force's parts at a tangent plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceParts<T: Real> {
    /// Normal force \[N\], positive when pressing.
    pub normal: T,
    /// Magnitude of the tangential force \[N\].
    pub tangential: T,
}

impl<T: Real> Entry<T> {
    /// The line misses.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        Self {
            point: Vector3::zeros(),
            normal: Vector3::zeros(),
            incidence_squared: T::zero(),
            parts: None,
            active: false,
        }
    }

    /// The crossing at which a line of this unit direction enters; none if it lies beyond the range of
    /// the type.
    #[inline(always)]
    pub fn at(crossing: &Crossing<T>, direction: &Vector3<T>) -> Self {
        let Crossing { point, normal, active, .. } = *crossing;
        let incidence = -normal.dot(direction);
        Self { point, normal, incidence_squared: incidence * incidence.abs(), parts: None, active }
            .within_range()
    }

    /// The same; none if it lies beyond the range of the type. That is said within the answer, since to
    /// take an answer back costs more than to find it.
    #[inline(always)]
    pub(crate) fn within_range(self) -> Self {
        let incidence_squared = if in_range(&self.point) { self.incidence_squared } else { T::zero() };
        Self { incidence_squared, ..self }
    }
}

/// The point of a surface closest to a line that misses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestApproach<T: Real> {
    /// Distance between line and surface \[m\]; zero or more.
    pub gap: T,
    /// The closest point of the surface \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// `false` where the point is not part of the active region.
    pub active: bool,
}

/// The part of the fingertip that may touch: a surface with an outside.
///
/// # For users
/// Coordinates are those of the sensor frame \[m\]. All calls are total: they return no NaN for a
/// finite line with unit direction.
///
/// # For implementers
/// Three methods, each short for most shapes:
///
/// * [`crossings`](Self::crossings) shall report *every* point where the line passes through the
///   surface, in any order, those outside the active region too (marked `active: false`). A
///   tangent line may report its point of tangency once, twice or not at all.
/// * [`closest_approach`](Self::closest_approach) is asked only for lines that `crossings`
///   reported nothing for, but shall answer sensibly for any.
/// * [`normal`](Self::normal) is the outward unit normal at a point on (or within rounding of) the
///   surface.
///
/// A shape with an equation `f(x) = 0` gets all three from [`Implicit`](crate::Implicit). The
/// module [`testing`](crate::testing) checks an implementation.
pub trait ActiveSurface<T: Real> {
    /// `true` promises that the surface bounds a convex body and may touch everywhere: a line that
    /// passes through it enters once, at an active point, and leaves once, and
    /// [`crossings`](Self::crossings) reports where it enters first. Point contact then compiles without
    /// what other shapes need, such as a choice between entries. The default promises nothing.
    const CLOSED_CONVEX: bool = false;

    /// Calls `visit` for every point where the line passes through the surface.
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>));

    /// The point of the surface closest to a line that misses it.
    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T>;

    /// The outward unit normal at a point of the surface.
    fn normal(&self, point: &Vector3<T>) -> Vector3<T>;

    /// Where a force enters, for shapes that no line enters twice: a shortcut past
    /// [`crossings`](Self::crossings) that point contact takes first.
    ///
    /// `None`, as the default answers, says nothing. An answer with a positive square of the
    /// incidence shall be finite and agree, but for rounding, with the one crossing that has a normal
    /// against the force; one without says that there is none, but for rounding.
    #[inline]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let _ = push;
        None
    }

    /// How far a point that should be on the surface is outside it by rounding \[m\], to first order
    /// and with twice the digits of the type.
    ///
    /// Point contact asks for it where a force meets the surface at a flat angle, and such errors
    /// grow. The default, zero, takes crossings at their word.
    #[inline]
    fn outside_by(&self, point: &Vector3<T>) -> T {
        let _ = point;
        T::zero()
    }

    /// `true` if the point is inside the fingertip.
    ///
    /// The default looks along a fixed line at the crossing nearest to the point: the normal there
    /// tells on which side the point is. Shapes with an equation answer faster.
    fn contains(&self, point: &Vector3<T>) -> bool {
        let direction = Vector3::new(T::literal(0.48), T::literal(0.6), T::literal(0.64));
        let nearest = nearest_crossing(self, &Line { point: *point, direction });
        nearest.is_some_and(|c| c.along * c.normal.dot(&direction) > T::zero())
    }
}

/// The crossing of a line that is nearest to its point.
#[doc(hidden)]
pub fn nearest_crossing<T: Real, S: ActiveSurface<T> + ?Sized>(
    surface: &S,
    line: &Line<T>,
) -> Option<Crossing<T>> {
    let mut nearest: Option<Crossing<T>> = None;
    surface.crossings(line, |crossing| {
        if nearest.is_none_or(|n| crossing.along.abs() < n.along.abs()) {
            nearest = Some(crossing);
        }
    });
    nearest
}

impl<T: Real, S: ActiveSurface<T>> ActiveSurface<T> for &S {
    const CLOSED_CONVEX: bool = S::CLOSED_CONVEX;

    #[inline]
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>)) {
        (**self).crossings(line, visit);
    }

    #[inline]
    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
        (**self).closest_approach(line)
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        (**self).normal(point)
    }

    #[inline]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        (**self).sole_entry(push)
    }

    #[inline]
    fn outside_by(&self, point: &Vector3<T>) -> T {
        (**self).outside_by(point)
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        (**self).contains(point)
    }
}
