//! The union of two shapes.

use crate::numeric::vectors::length;
use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::active_surface::nearest_crossing;
use crate::{
    ActiveSurface, ClosestApproach, Corner, Crossing, Extent, Level, LineInDouble, Shortcuts, SmoothSurface,
};

/// Two shapes, possibly overlapping, as one: what lies inside the other is no surface. Nest it for
/// more than two, halves of halves rather than one after the other: each level of nesting multiplies the work.
///
/// ```
/// use fingertip_surfaces::{CappedCylinder, Compound, Sphere};
/// use nalgebra::Vector3;
///
/// // A finger with a ball at its end.
/// let shaft = CappedCylinder::new(Vector3::zeros(), Vector3::z(), 0.006, 0.02)?;
/// let ball = Sphere::new(Vector3::new(0.0, 0.0, 0.02), 0.009)?;
/// let finger = Compound::new(shaft, ball);
/// # let _ = finger;
/// // The line along the axis passes where shaft and ball overlap, and crosses the surface twice.
/// use fingertip_surfaces::ActiveSurface;
/// use fingertip_wrench::Line;
/// let line = Line { point: Vector3::new(0.0, 0.0, 0.05), direction: -Vector3::z() };
/// let mut heights = Vec::new();
/// finger.crossings(&line, |crossing| heights.push(crossing.point.z));
/// heights.sort_by(f64::total_cmp);
/// assert!(heights.len() == 2 && (heights[0] + 0.02).abs() < 1e-15 && (heights[1] - 0.029).abs() < 1e-15);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Compound<A, B> {
    first: A,
    second: B,
}

impl<A, B> Compound<A, B> {
    /// The union of both.
    #[inline]
    #[must_use]
    pub const fn new(first: A, second: B) -> Self {
        Self { first, second }
    }

    /// Both parts.
    #[inline]
    #[must_use]
    pub const fn parts(&self) -> (&A, &B) {
        (&self.first, &self.second)
    }
}

/// `true` if the point at `along` on a line is inside a shape, told from the shape's own crossing
/// with the same line that is nearest: so two shapes that meet in a seam agree on which of them owns
/// it. A tie counts as inside if `tie`.
#[doc(hidden)]
pub fn is_inside_along<T: Real>(
    shape: &impl ActiveSurface<T>,
    line: &Line<T>,
    along: T,
    point: &Vector3<T>,
    tie: bool,
) -> bool {
    let mut nearest: Option<(T, bool)> = None;
    shape.crossings(line, |c| {
        let distance = (c.along - along).abs();
        let slope = c.normal.dot(&line.direction);
        // One where the line is tangent tells nothing: on both sides of it the line is outside, or inside.
        let tells = slope.abs() > T::EPSILON * T::literal(16.0);
        if tells && nearest.is_none_or(|(least, _)| distance < least) {
            let leaves = slope > T::zero();
            let inside = if c.along > along {
                leaves
            } else if c.along < along {
                !leaves
            } else {
                tie
            };
            nearest = Some((distance, inside));
        }
    });
    nearest.map_or_else(|| shape.contains(point), |(_, inside)| inside)
}

/// The nearer of two approaches.
fn closest_of<T: Real>(a: ClosestApproach<T>, b: ClosestApproach<T>) -> ClosestApproach<T> {
    if b.gap < a.gap { b } else { a }
}

impl<A, B> Compound<A, B> {
    /// `true` if the surface of the first part is nearer to a point along a normal, `false` if that of the
    /// second is. Without a normal each part is looked for along its own, which on an edge of it may lead
    /// past it.
    pub(crate) fn is_of_first<T: Real>(&self, point: &Vector3<T>, normal: Option<&Vector3<T>>) -> bool
    where
        A: ActiveSurface<T>,
        B: ActiveSurface<T>,
    {
        let along = |own: Vector3<T>| Line { point: *point, direction: normal.copied().unwrap_or(own) };
        let to_first = nearest_crossing(&self.first, &along(self.first.normal(point)));
        let to_second = nearest_crossing(&self.second, &along(self.second.normal(point)));
        match (to_first, to_second) {
            (Some(a), Some(b)) => !(b.along.abs() < a.along.abs()),
            (first, second) => first.is_some() || second.is_none(),
        }
    }
}

impl<T: Real, A: ActiveSurface<T>, B: ActiveSurface<T>> ActiveSurface<T> for Compound<A, B> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.first.crossings(line, |c| {
            if !is_inside_along(&self.second, line, c.along, &c.point, true) {
                visit(c);
            }
        });
        self.second.crossings(line, |c| {
            if !is_inside_along(&self.first, line, c.along, &c.point, false) {
                visit(c);
            }
        });
    }

    /// Not known unless that of both is.
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        Some(closest_of(self.first.closest_approach(line)?, self.second.closest_approach(line)?))
    }

    /// Of the part on whose surface the point is, told by which of the two a step along its normal
    /// leaves.
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        if self.is_of_first(point, None) { self.first.normal(point) } else { self.second.normal(point) }
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        self.first.contains(point) || self.second.contains(point)
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

/// The residual is that of the part on whose surface the point is. A line that enters each part once may
/// enter both: there is no sole entry.
impl<T: Real, A: ActiveSurface<T>, B: ActiveSurface<T>> Shortcuts<T> for Compound<A, B> {
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        if self.is_of_first(point, None) {
            self.first.shortcuts().surface_residual(point)
        } else {
            self.second.shortcuts().surface_residual(point)
        }
    }

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        if self.is_of_first(&near.map(T::literal), None) {
            self.first.shortcuts().entry_in_double(line, near)
        } else {
            self.second.shortcuts().entry_in_double(line, near)
        }
    }

    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        if self.is_of_first(&near.map(T::literal), None) {
            self.first.shortcuts().posed_entry_in_double(line, near)
        } else {
            self.second.shortcuts().posed_entry_in_double(line, near)
        }
    }
}

/// That of the part whose surface is nearer; on the seam, that of either.
impl<T: Real, A: SmoothSurface<T>, B: SmoothSurface<T>> SmoothSurface<T> for Compound<A, B> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let (first, second) = self.parts();
        if self.is_of_first(point, None) { first.level(point) } else { second.level(point) }
    }

    fn extent(&self) -> Extent<T> {
        let (first, second) = self.parts();
        around_both(&first.extent(), &second.extent())
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let (first, second) = self.parts();
        if self.is_of_first(point, None) { first.shape_operator(point) } else { second.shape_operator(point) }
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        let (first, second) = self.parts();
        if self.is_of_first(point, Some(normal)) {
            first.bend(point, normal, tangents)
        } else {
            second.bend(point, normal, tangents)
        }
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        let (first, second) = self.parts();
        if self.is_of_first(point, Some(normal)) {
            first.corner(point, normal)
        } else {
            second.corner(point, normal)
        }
    }
}

/// The least ball around two balls.
fn around_both<T: Real>(one: &Extent<T>, other: &Extent<T>) -> Extent<T> {
    let apart = other.centre - one.centre;
    let distance = length(&apart);
    if distance + other.radius <= one.radius {
        return *one;
    }
    if distance + one.radius <= other.radius {
        return *other;
    }
    let radius = (distance + one.radius + other.radius) * T::literal(0.5);
    Extent { centre: one.centre + apart * ((radius - one.radius) / distance), radius }
}
