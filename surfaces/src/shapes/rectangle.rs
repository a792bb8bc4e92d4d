//! The plane, bounded by a rectangle.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::Vector3;

use crate::numeric::vectors::{hypotenuse, length};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Extent, Level, Plane, Shortcuts, SmoothSurface,
    Topology,
};

/// A plane of which only a rectangle is active.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Rectangle};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // A pad of 20 mm by 10 mm, 30 mm up; x × y makes its normal point up.
/// let pad = Rectangle::new(Vector3::new(0.0, 0.0, 0.03), Vector3::x() * 0.01, Vector3::y() * 0.005)?;
/// assert_eq!(pad.plane().outward(), Vector3::z());
/// for (y, active) in [(0.004, true), (0.006, false)] {
///     let line = Line { point: Vector3::new(0.009, y, 0.05), direction: -Vector3::z() };
///     pad.crossings(&line, |crossing| assert_eq!((crossing.point.z, crossing.active), (0.03, active)));
/// }
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle<T: Real> {
    plane: Plane<T>,
    /// Unit vectors along the edges.
    along: [Vector3<T>; 2],
    half_lengths: [T; 2],
}

impl<T: Real> Rectangle<T> {
    /// From its centre \[m\] and the vectors from there to the middles of two neighbouring edges
    /// \[m\]. The outward normal is `first × second`.
    ///
    /// # Errors
    /// [`BadShape`] unless all is finite, the two are perpendicular (to `√ε`) and their lengths
    /// positive finite lengths.
    pub fn new(centre: Vector3<T>, first: Vector3<T>, second: Vector3<T>) -> Result<Self, BadShape> {
        let shape = "rectangle";
        let a = BadShape::check_direction(shape, "first half edge", first)?;
        let b = BadShape::check_direction(shape, "second half edge", second)?;
        BadShape::check(
            shape,
            "second half edge",
            "perpendicular to the first",
            a.dot(&b).abs() <= T::EPSILON.root(),
        )?;
        let b = BadShape::check_direction(shape, "second half edge", b - a * a.dot(&b))?;
        Ok(Self {
            plane: Plane::new(centre, a.cross(&b)).map_err(|bad| BadShape { shape, ..bad })?,
            along: [a, b],
            half_lengths: [
                BadShape::check_length(shape, "first half edge", length(&first))?,
                BadShape::check_length(shape, "second half edge", length(&second))?,
            ],
        })
    }

    /// The plane in which the rectangle lies; its point is the centre.
    #[inline]
    #[must_use]
    pub const fn plane(&self) -> &Plane<T> {
        &self.plane
    }

    /// From the centre to the middles of two neighbouring edges \[m\].
    #[inline]
    #[must_use]
    pub fn half_edges(&self) -> [Vector3<T>; 2] {
        let ([a, b], [m, n]) = (self.along, self.half_lengths);
        [a * m, b * n]
    }

    #[inline]
    fn is_active(&self, point: &Vector3<T>) -> bool {
        let from_centre = point - self.plane.point();
        let ([a, b], [m, n]) = (&self.along, self.half_lengths);
        from_centre.dot(a).abs() <= m && from_centre.dot(b).abs() <= n
    }
}

impl<T: Real> ActiveSurface<T> for Rectangle<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.plane.crossings(line, |c| visit(Crossing { active: self.is_active(&c.point), ..c }));
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        self.plane.closest_to_part(line, |point| self.is_active(point))
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.plane.normal(point)
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        self.plane.contains(point)
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Rectangle<T> {
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        self.plane.surface_residual(point)
    }
}

impl<T: Real> SmoothSurface<T> for Rectangle<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.plane().level(point)
    }

    fn extent(&self) -> Extent<T> {
        let [first, second] = self.half_edges();
        Extent { centre: self.plane().point(), radius: hypotenuse(length(&first), length(&second)) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

stored! {
    Rectangle<T>, [T: Real],
    |rectangle| {
        #[serde(default = "Vector3::zeros")]
        centre_m: Vector3<T> = rectangle.plane.point(),
        first_half_edge_m: Vector3<T> = rectangle.half_edges()[0],
        second_half_edge_m: Vector3<T> = rectangle.half_edges()[1],
    },
    Rectangle::new(centre_m, first_half_edge_m, second_half_edge_m)
}
