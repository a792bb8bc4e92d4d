//! What shapes around an axis share.

use core::hint::select_unpredictable;

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::Crossing;
use crate::numeric::twofold::{Twofold, difference, dot};
use crate::numeric::vectors::{any_perpendicular, foot, unit_or, within_range};

/// An oriented axis with an origin, and a frame around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis<T: Real> {
    pub(super) origin: Vector3<T>,
    pub(super) direction: Vector3<T>,
    /// Across it.
    x: Vector3<T>,
    y: Vector3<T>,
}

/// A line seen from an axis, of which z is the direction.
#[derive(Clone, Copy)]
pub(super) struct Local<T: Real> {
    /// The point from which positions count.
    pub(super) start: Vector3<T>,
    pub(super) direction: Vector3<T>,
    /// Where that is on the line that was given.
    pub(super) along: T,
}

/// Where a line enters a solid around an axis, seen from there.
#[derive(Clone, Copy)]
pub(super) struct LocalEntry<T: Real> {
    pub(super) along: T,
    pub(super) point: Vector3<T>,
    pub(super) normal: Vector3<T>,
}

impl<T: Real> Local<T> {
    /// The same line, run through backwards.
    #[inline]
    pub(super) fn reversed(self) -> Self {
        Self { direction: -self.direction, along: -self.along, ..self }
    }

    /// Where it enters the cone on whose side the distance from the axis is `steepness` times
    /// `radius`, which shrinks by `shrink` per unit length of the line; NaN if nowhere. Of both
    /// nappes, whichever: the caller shall look.
    ///
    /// `F(t) = steepness²·|across + t·drift|² − (radius − t·shrink)²` is a quadratic, whose root with a
    /// falling value is wanted. With the part of `across` along `drift` and the one aside, its
    /// discriminant needs no difference of large numbers, not even where the line is parallel to
    /// the axis.
    #[inline(always)]
    pub(super) fn enters_cone(&self, steepness: T, radius: T, shrink: T) -> T {
        let (p, u) = (&self.start, &self.direction);
        let drift = (u.x * u.x + u.y * u.y).root();
        let (x, y, drift) = if drift > T::EPSILON * T::literal(4.0) {
            (u.x / drift, u.y / drift, drift * steepness)
        } else {
            (T::one(), T::zero(), T::zero())
        };
        let with = p.x * x + p.y * y;
        let (aside_x, aside_y) = ((p.x - x * with) * steepness, (p.y - y * with) * steepness);
        let (with, aside) = (with * steepness, aside_x * aside_x + aside_y * aside_y);
        // Positions count in units that make the greater of both one: exactly so for a cylinder.
        let unit = drift.max(shrink.abs());
        let (drift, shrink) = (drift / unit, shrink / unit);
        let a = (drift - shrink.abs()) * (drift + shrink.abs());
        let b = with * drift + radius * shrink;
        let lean = radius * drift + shrink * with;
        let root = (lean * lean - aside * a).root();
        // Without cancellation.
        let sum = b.abs() + root;
        let outside = with * with + aside - radius * radius;
        let falls = b > T::zero();
        select_unpredictable(falls, -sum, outside) / (select_unpredictable(falls, a, sum) * unit)
    }

    /// The same for a cylinder, from the point of the line closest to the axis.
    #[inline(always)]
    pub(super) fn enters_cylinder(&self, radius: T) -> T {
        let (p, u) = (&self.start, &self.direction);
        let inverse = T::one() / (u.x * u.x + u.y * u.y);
        let foot = -(p.x * u.x + p.y * u.y) * inverse;
        let (x, y) = (p.x + u.x * foot, p.y + u.y * foot);
        foot - ((radius * radius - (x * x + y * y)) * inverse).root()
    }

    #[inline]
    pub(super) fn at(&self, t: T) -> Vector3<T> {
        self.start + self.direction * t
    }
}

impl<T: Real> Axis<T> {
    /// With a unit vector as direction.
    pub(super) fn new(origin: Vector3<T>, direction: Vector3<T>) -> Self {
        let x = any_perpendicular(&direction);
        Self { origin, direction, x, y: direction.cross(&x) }
    }

    /// A line seen from the point at a height over the origin, positions counting from the point
    /// closest to the origin.
    #[inline(always)]
    pub(super) fn localise(&self, line: &Line<T>, height: T) -> Local<T> {
        let local = |v: &Vector3<T>| Vector3::new(v.dot(&self.x), v.dot(&self.y), v.dot(&self.direction));
        let (from_origin, along) = foot(line, &self.origin);
        let mut start = local(&from_origin);
        start.z -= height;
        Local { start, direction: local(&line.direction), along }
    }

    #[inline(always)]
    fn turned_back(&self, v: &Vector3<T>) -> Vector3<T> {
        self.x * v.x + self.y * v.y + self.direction * v.z
    }

    /// The crossing in the sensor frame; `height` and `line` as in [`localise`](Self::localise).
    #[inline(always)]
    pub(super) fn crossing(
        &self,
        line: &Local<T>,
        height: T,
        entry: &LocalEntry<T>,
        active: bool,
    ) -> Crossing<T> {
        let mut point = entry.point;
        point.z += height;
        Crossing {
            along: line.along + entry.along,
            point: self.origin + self.turned_back(&point),
            normal: self.turned_back(&entry.normal),
            active,
        }
    }

    /// Both ends of what is inside a convex solid, from what tells where a line enters it.
    #[inline]
    pub(super) fn both_ends(
        &self,
        line: &Local<T>,
        height: T,
        entry: impl Fn(&Local<T>) -> Option<LocalEntry<T>>,
        mut visit: impl FnMut(LocalEntry<T>, Crossing<T>),
    ) {
        let reversed = line.reversed();
        if let Some(end) = entry(line) {
            visit(end, self.crossing(line, height, &end, true));
        }
        if let Some(end) = entry(&reversed) {
            let crossing = self.crossing(&reversed, height, &end, true);
            visit(end, Crossing { along: -crossing.along, ..crossing });
        }
    }

    /// Height of a vector along the axis, and its part across.
    #[inline]
    pub(super) fn split(&self, v: &Vector3<T>) -> (T, Vector3<T>) {
        let height = v.dot(&self.direction);
        let across = v - self.direction * height;
        // Once more, so that what is left is across even where most has cancelled.
        (height, across - self.direction * across.dot(&self.direction))
    }

    /// As [`split`](Self::split), for a point of the sensor frame. One so far away that its distance
    /// leaves the range is treated as if it were nearer.
    #[inline]
    pub(super) fn split_point(&self, point: &Vector3<T>) -> (T, Vector3<T>) {
        self.split(&within_range(&(point - self.origin)))
    }

    /// The unit vector away from the axis; any across it for a point on the axis.
    #[inline]
    pub(super) fn outward(&self, across: &Vector3<T>) -> Vector3<T> {
        unit_or(across, || any_perpendicular(&self.direction))
    }

    /// How far a point is outside the ball around the point of the axis at a height, with twice the
    /// digits.
    pub(super) fn outside_ball_by(&self, point: &Vector3<T>, height: T, radius: T) -> T {
        let scale = radius.normalising_factor();
        let (radius, height) = (radius * scale, Twofold::new(height * scale));
        let [x, y, z] = difference(&(point * scale), &(self.origin * scale));
        let [ax, ay, az] = [self.direction.x, self.direction.y, self.direction.z].map(Twofold::new);
        let from_centre = [x.minus(ax.times(height)), y.minus(ay.times(height)), z.minus(az.times(height))];
        let excess = dot(from_centre, from_centre).minus(Twofold::new(radius).squared());
        excess.value() / (radius + radius) / scale
    }

    /// How far a point is outside the circular cylinder around the axis, with twice the digits.
    pub(super) fn outside_by(&self, point: &Vector3<T>, radius: T) -> T {
        self.outside_cone_by(point, radius, Twofold::new(T::zero()), T::one())
    }

    /// How far a point is outside the cone around the axis whose radius is `radius` at the origin and
    /// shrinks by `taper` per unit of height, with twice the digits; `cosine` is the side's normal's
    /// across the axis.
    pub(super) fn outside_cone_by(&self, point: &Vector3<T>, radius: T, taper: Twofold<T>, cosine: T) -> T {
        let scale = (point - self.origin).amax().normalising_factor();
        let from_origin = difference(&(point * scale), &(self.origin * scale));
        // The axis is a unit vector but for rounding: h/|a| = h·(3 − |a|²)/2.
        let axis = [self.direction.x, self.direction.y, self.direction.z].map(Twofold::new);
        let long = Twofold::new(T::literal(3.0)).minus(dot(axis, axis)).times(Twofold::new(T::literal(0.5)));
        let height = dot(from_origin, axis).times(long);
        let radius = Twofold::new(radius * scale).minus(taper.times(height));
        let excess = dot(from_origin, from_origin).minus(height.squared()).minus(radius.squared());
        let outside = excess.value() * cosine / (radius.value() + radius.value()) / scale;
        // At the apex there is no telling.
        if outside.is_number() { outside } else { T::zero() }
    }
}
