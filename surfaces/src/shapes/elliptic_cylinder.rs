//! The elliptic cylinder, unbounded, open or closed.

use super::ellipsoid::elliptic_gauge;
use crate::smooth::flat_ends::Face;
use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::numeric::closest::{from_distance, to_convex};
use crate::numeric::ellipse::closest_point;
use crate::numeric::interval::{End, Inside};
use crate::numeric::twofold::Twofold;
use crate::numeric::vectors::{foot, hypotenuse, is_finite, length, unit_or, within_range};
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Corner, Crossing, Distance, Extent, Level, Shortcuts,
    SmoothSurface, Topology,
};

/// How an elliptic cylinder ends.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, CylinderEnds, EllipticCylinder};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // A line down the axis meets flat ends, and no open ones.
/// let line = Line { point: Vector3::new(0.0, 0.0, 0.05), direction: -Vector3::z() };
/// for (ends, expected) in [(CylinderEnds::Open(0.02), 0), (CylinderEnds::Capped(0.02), 2)] {
///     let mut met = 0;
///     EllipticCylinder::new([0.008, 0.005], ends)?.crossings(&line, |_| met += 1);
///     assert_eq!(met, expected);
/// }
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum CylinderEnds<T> {
    /// Nowhere.
    Unbounded,
    /// Only the side within this height \[m\] of the middle is active.
    Open(T),
    /// With flat ends at this height \[m\] over and under the middle.
    Capped(T),
}

/// A cylinder around the z axis, across which it is an ellipse with its axes along x and y;
/// [`Posed`](crate::Posed) puts it elsewhere.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, CylinderEnds, EllipticCylinder};
/// use nalgebra::Vector3;
///
/// // The pad of a human finger: broad, flat, along z.
/// let pad = EllipticCylinder::new([0.008, 0.005], CylinderEnds::Open(0.02))?;
/// assert!(pad.contains(&Vector3::new(0.0079, 0.0, 0.01)));
/// assert!(!pad.contains(&Vector3::new(0.0, 0.0051, 0.01)));
/// let normal = pad.normal(&Vector3::new(0.0, 0.005, 0.0));
/// assert!((normal - Vector3::y()).amax() < 1e-15_f64);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticCylinder<T: Real> {
    semi_axes: [T; 2],
    curvatures: [T; 2],
    /// The heights \[m\] to which an open side is active and at which flat ends close it, the greatest number where it is not
    /// so: lengths and no choice, so that columns of contacts are met one like the other.
    active_to: T,
    capped_at: T,
}

impl<T: Real> EllipticCylinder<T> {
    /// From the semi-axes along x and y \[m\] and the ends.
    ///
    /// # Errors
    /// [`BadShape`] unless the semi-axes are positive finite lengths, none more than `1/√ε` times
    /// the other, and the half length, if there is one, is a positive finite length.
    pub fn new(semi_axes: [T; 2], ends: CylinderEnds<T>) -> Result<Self, BadShape> {
        let shape = "elliptic cylinder";
        let [a, b] = semi_axes;
        BadShape::check_length(shape, "semi-axes", a)?;
        BadShape::check_length(shape, "semi-axes", b)?;
        BadShape::check(shape, "semi-axes", "of comparable size", a.min(b) / a.max(b) >= T::EPSILON.root())?;
        if let CylinderEnds::Open(half) | CylinderEnds::Capped(half) = ends {
            BadShape::check_length(shape, "half length", half)?;
        }
        let [active_to, capped_at] = match ends {
            CylinderEnds::Unbounded => [T::GREATEST; 2],
            CylinderEnds::Open(half) => [half, T::GREATEST],
            CylinderEnds::Capped(half) => [T::GREATEST, half],
        };
        Ok(Self { semi_axes, curvatures: [T::one() / a, T::one() / b], active_to, capped_at })
    }

    /// The semi-axes along x and y \[m\].
    #[inline]
    #[must_use]
    pub const fn semi_axes(&self) -> [T; 2] {
        self.semi_axes
    }

    /// Their reciprocals \[1/m\].
    #[inline]
    #[doc(hidden)]
    pub const fn curvatures(&self) -> [T; 2] {
        self.curvatures
    }

    /// How it ends.
    #[inline]
    #[must_use]
    pub fn ends(&self) -> CylinderEnds<T> {
        if self.capped_at < T::GREATEST {
            CylinderEnds::Capped(self.capped_at)
        } else if self.active_to < T::GREATEST {
            CylinderEnds::Open(self.active_to)
        } else {
            CylinderEnds::Unbounded
        }
    }

    /// The heights \[m\] to which an open side is active and at which flat ends close it, the greatest number where it is
    /// not so: what [`ends`](Self::ends) say, without a choice.
    #[inline]
    #[doc(hidden)]
    pub const fn heights(&self) -> [T; 2] {
        [self.active_to, self.capped_at]
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<EllipticCylinder<f64>> {
        let ends = match self.ends() {
            CylinderEnds::Unbounded => CylinderEnds::Unbounded,
            CylinderEnds::Open(half) => CylinderEnds::Open(half.to_f64()),
            CylinderEnds::Capped(half) => CylinderEnds::Capped(half.to_f64()),
        };
        EllipticCylinder::new(self.semi_axes.map(Real::to_f64), ends).ok()
    }

    #[inline]
    fn is_active(&self, height: T) -> bool {
        height.abs() <= self.active_to
    }

    /// Of a point scaled to the unit circle. Once where the smallest programs are asked for.
    #[cfg_attr(feature = "mixed-precision", inline)]
    #[cfg_attr(not(feature = "mixed-precision"), inline(never))]
    fn side_normal(&self, x: T, y: T) -> Vector3<T> {
        let [a, b] = self.curvatures;
        unit_or(&Vector3::new(x * a, y * b, T::zero()), Vector3::x)
    }

    /// The part of the line within the ellipse, `start` being its point with position zero.
    #[inline]
    fn inside_side(&self, line: &Line<T>, start: &Vector3<T>) -> Option<Inside<T>> {
        let [a, b] = self.curvatures;
        let (x, y) = (start.x * a, start.y * b);
        let (u, v) = (line.direction.x * a, line.direction.y * b);
        let squared = u * u + v * v;
        let parallel = T::EPSILON * a.max(b) * T::literal(4.0);
        if squared <= parallel * parallel {
            let end = |along| End { along, normal: Vector3::z(), active: false };
            return (x * x + y * y <= T::one())
                .then(|| Inside { entry: end(-T::GREATEST), exit: end(T::GREATEST) });
        }
        let foot = -(x * u + y * v) / squared;
        let (x, y) = (x + u * foot, y + v * foot);
        let remainder = T::one() - (x * x + y * y);
        if !(remainder >= T::zero()) {
            return None;
        }
        let half_chord = (remainder / squared).root();
        let end = |offset: T| {
            let along = foot + offset;
            let active = self.is_active(start.z + along * line.direction.z);
            End { along, normal: self.side_normal(x + u * offset, y + v * offset), active }
        };
        Some(Inside { entry: end(-half_chord), exit: end(half_chord) })
    }

    /// Distance from the side, as if unbounded.
    fn side_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let ([a, b], [ka, kb]) = (self.semi_axes, self.curvatures);
        let [x, y] = closest_point(&[a, b], &[point.x, point.y]);
        let distance = hypotenuse(point.x - x, point.y - y);
        let inside = {
            let (x, y) = (point.x * ka, point.y * kb);
            x * x + y * y < T::one()
        };
        let normal = self.side_normal(x * ka, y * kb);
        Distance { distance: if inside { -distance } else { distance }, normal }
    }

    fn distance(&self, point: &Vector3<T>) -> Distance<T> {
        let point = &within_range(point);
        let side = self.side_distance(point);
        let CylinderEnds::Capped(half) = self.ends() else { return side };
        let beyond = point.z.abs() - half;
        let end = Vector3::new(T::zero(), T::zero(), T::one().copysign(point.z));
        if side.distance <= T::zero() || beyond <= T::zero() {
            return if side.distance > beyond { side } else { Distance { distance: beyond, normal: end } };
        }
        let distance = hypotenuse(side.distance, beyond);
        Distance { distance, normal: (side.normal * side.distance + end * beyond) / distance }
    }
}

impl<T: Real> ActiveSurface<T> for EllipticCylinder<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>)) {
        let (start, along) = foot(line, &Vector3::zeros());
        let Some(mut inside) = self.inside_side(line, &start) else { return };
        if let CylinderEnds::Capped(half) = self.ends() {
            let (z, rise) = (start.z, line.direction.z);
            let Some(capped) = inside
                .below(half, z, rise, Vector3::z(), true)
                .and_then(|inside| inside.below(half, -z, -rise, -Vector3::z(), true))
            else {
                return;
            };
            inside = capped;
        }
        inside.report(line, &start, along, visit);
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let [a, b] = self.semi_axes;
        if let CylinderEnds::Capped(half) = self.ends() {
            let reach = hypotenuse(half, a.max(b));
            return Some(to_convex(line, &Vector3::zeros(), reach, |point| self.distance(point)));
        }
        let (start, _) = foot(line, &Vector3::zeros());
        let start = if is_finite(&start) { start } else { Vector3::zeros() };
        // The side that is parallel to the line, on the line's side of the axis.
        let across = Vector3::new(line.direction.y, -line.direction.x, T::zero());
        let least = T::EPSILON * T::literal(4.0);
        if across.norm_squared() <= least * least {
            let side = self.side_distance(&start);
            let found = from_distance(&start, side);
            // Within the side too it never meets it.
            let gap = side.distance.abs().min(T::GREATEST);
            return Some(ClosestApproach { gap, active: self.is_active(found.point.z), ..found });
        }
        let outward = unit_or(&across, Vector3::x);
        let normal = if outward.dot(&start) < T::zero() { -outward } else { outward };
        let (x, y) = (normal.x * a, normal.y * b);
        let height = hypotenuse(x, y);
        let side = Vector3::new(x / height * a, y / height * b, T::zero());
        // Where the line passes over that side.
        let along = (side - start).dot(&Vector3::new(line.direction.x, line.direction.y, T::zero()))
            / across.norm_squared();
        let z = start.z + along * line.direction.z;
        let z = if z.is_number() { z } else { T::zero() };
        Some(ClosestApproach {
            gap: (normal.dot(&start) - height).max(T::zero()).min(T::GREATEST),
            point: Vector3::new(side.x, side.y, z),
            normal,
            active: self.is_active(z),
        })
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        match self.ends() {
            CylinderEnds::Capped(_) => self.distance(point).normal,
            _ => self.side_normal(point.x * self.curvatures[0], point.y * self.curvatures[1]),
        }
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        let [a, b] = self.curvatures;
        let (x, y) = (point.x * a, point.y * b);
        let within = match self.ends() {
            CylinderEnds::Unbounded => true,
            CylinderEnds::Open(half) | CylinderEnds::Capped(half) => point.z.abs() < half,
        };
        within && x * x + y * y < T::one()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for EllipticCylinder<T> {
    /// Of the side, `(x²/a² + y²/b² − 1)` over the length of its gradient; or outside the end, if that is nearer.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let ([a, b], [ca, cb]) = (self.semi_axes, self.curvatures);
        let (x, y) = (Twofold::new(point.x).over(a), Twofold::new(point.y).over(b));
        let excess = x.squared().plus(y.squared()).minus(Twofold::new(T::one())).value();
        let side = excess / (hypotenuse(x.value() * ca, y.value() * cb) * T::literal(2.0));
        match self.ends() {
            CylinderEnds::Capped(half) if !((point.z.abs() - half).abs() > side.abs()) => {
                point.z.abs() - half
            }
            _ => side,
        }
    }

    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }
}

/// The level function is that of the side; flat ends are not part of it, but of the curvature.
impl<T: Real> SmoothSurface<T> for EllipticCylinder<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let [a, b] = self.semi_axes();
        elliptic_gauge(point, &Vector3::new(T::one() / a, T::one() / b, T::zero()))
    }

    fn extent(&self) -> Extent<T> {
        let [a, b] = self.semi_axes();
        let half = match self.ends() {
            CylinderEnds::Unbounded => T::zero(),
            CylinderEnds::Open(half) | CylinderEnds::Capped(half) => half,
        };
        // As far as the rims, which lie beyond both.
        Extent { centre: Vector3::zeros(), radius: hypotenuse(a.max(b), half) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let level = self.level(point);
        Face::of(&Vector3::z(), &level, &self.normal(point)).shape_operator(&level)
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        let level = self.level(point);
        Face::of(&Vector3::z(), &level, normal).bend(&level, tangents)
    }

    /// On the ellipse of an end: with `c = (a cos θ, b sin θ)`, `c″ = −c` and `c′ = (−y a/b, x b/a)`.
    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        let [a, b] = self.semi_axes();
        let along = Vector3::new(-point.y * a / b, point.x * b / a, T::zero());
        let steepness = length(&along);
        let bend = (normal.x * point.x + normal.y * point.y) / steepness / steepness;
        Some(Corner::Edge { direction: along / steepness, bend })
    }
}

stored! {
    EllipticCylinder<T>, [T: Real],
    |cylinder| {
        semi_axes_m: [T; 2] = cylinder.semi_axes,
        ends_m: CylinderEnds<T> = cylinder.ends(),
    },
    EllipticCylinder::new(semi_axes_m, ends_m)
}
