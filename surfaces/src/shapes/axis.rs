//! What shapes around an axis share.

use core::hint::select_unpredictable;

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::numeric::twofold::{Twofold, difference, dot, dot_with, outside_ball};
use crate::numeric::vectors::{any_perpendicular, foot, unit_or, within_range};
use crate::{Crossing, Entry, ForceLine};

/// An oriented axis with an origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis<T: Real> {
    pub(super) origin: Vector3<T>,
    pub(super) direction: Vector3<T>,
}

/// A line seen from a point of an axis, its parts along and across the axis told apart.
#[derive(Clone, Copy)]
pub(super) struct Local<T: Real> {
    /// The point of the line closest to that of the axis, from which positions count.
    pub(super) start: Vector3<T>,
    pub(super) direction: Vector3<T>,
    /// Where that is on the line that was given.
    pub(super) along: T,
    /// The start's height, and the direction's.
    pub(super) height: T,
    pub(super) rise: T,
    /// What is left of both across the axis.
    pub(super) across: Vector3<T>,
    pub(super) drift: Vector3<T>,
    /// `(start × direction)·axis`: the distance from the axis that the line keeps, times `|drift|`.
    pub(super) aside: T,
    /// `|drift|²`.
    pub(super) squared: T,
    /// `across·drift`.
    pub(super) meets: T,
}

/// Where a line enters a solid around an axis, and the outward normal there.
///
/// Not an `Option`: what finds it shall have no branch, such that the compiler can take several lines
/// at a time.
#[derive(Clone, Copy)]
pub(super) struct LocalEntry<T: Real> {
    /// Unless it does, the rest means nothing.
    pub(super) enters: bool,
    pub(super) along: T,
    /// Of a cone, which may be active in part; of other solids zero.
    pub(super) height: T,
    pub(super) normal: Vector3<T>,
}

impl<T: Real> Local<T> {
    /// The same line, run through backwards.
    #[inline]
    pub(super) fn reversed(self) -> Self {
        Self {
            direction: -self.direction,
            along: -self.along,
            rise: -self.rise,
            drift: -self.drift,
            aside: -self.aside,
            meets: -self.meets,
            ..self
        }
    }

    /// Where it enters the cone whose radius, `radius` at the start, shrinks by `shrink` per unit length
    /// of the line; a quotient not yet divided, NaN if nowhere. Of both nappes, whichever: the caller
    /// shall look.
    ///
    /// `F(t) = |across + t·drift|² − (radius − t·shrink)² = a·t² + 2·b·t + c` is a quadratic, whose root
    /// with a falling value is wanted. Its discriminant is `|radius·drift + shrink·across|² − aside²`, and times `|drift|²`
    /// it is `(radius·|drift|² + shrink·across·drift)² − a·aside²`. The first form keeps its digits where the line is all but
    /// parallel to the axis and `drift` is mostly rounding, the second everywhere else.
    #[inline(always)]
    pub(super) fn enters_cone(&self, radius: T, shrink: T) -> [T; 2] {
        let (squared, meets) = (self.squared, self.meets);
        let distance_squared = self.across.norm_squared();
        let a = squared - shrink * shrink;
        let b = meets + radius * shrink;
        let c = distance_squared - radius * radius;
        let lean = radius * squared + shrink * meets;
        let apart = lean * lean - a * (self.aside * self.aside);
        let beside = (self.drift * radius + self.across * shrink).norm_squared() - self.aside * self.aside;
        let is_steep = squared * T::literal(4.0) <= shrink * shrink;
        let root = select_unpredictable(is_steep, beside, apart / squared).root();
        // Without cancellation.
        let sum = b.abs() + root;
        let falls = b > T::zero();
        [select_unpredictable(falls, -sum, c), select_unpredictable(falls, a, sum)]
    }

    /// The same for a cylinder, which no line enters that is parallel to it.
    #[inline(always)]
    pub(super) fn enters_cylinder(&self, radius: T) -> [T; 2] {
        let root = (radius * radius * self.squared - self.aside * self.aside).root();
        [-self.meets - root, self.squared]
    }

    /// Its point at a position, across the axis.
    #[inline(always)]
    pub(super) fn across_at(&self, t: T) -> Vector3<T> {
        self.across + self.drift * t
    }
}

impl<T: Real> Axis<T> {
    /// With a unit vector as direction.
    pub(super) fn new(origin: Vector3<T>, direction: Vector3<T>) -> Self {
        Self { origin, direction }
    }

    /// A line seen from a point of the axis.
    #[inline]
    pub(super) fn localise(&self, line: &Line<T>, from: &Vector3<T>) -> Local<T> {
        let (start, along) = foot(line, from);
        self.tell_apart(start, line.direction, along)
    }

    /// The line of a force, whose own point is the one closest to that of the axis.
    #[inline(always)]
    pub(super) fn localise_push(&self, push: &ForceLine<T>, from: &Vector3<T>) -> Local<T> {
        let (force, inverse) = (push.force(), T::one() / push.squared());
        let start = force.cross(&push.torque_about(from)) * inverse;
        self.tell_apart(start, force * (inverse * push.squared().root()), T::zero())
    }

    /// `start` is square to `direction`, a unit vector.
    #[inline(always)]
    fn tell_apart(&self, start: Vector3<T>, direction: Vector3<T>, along: T) -> Local<T> {
        let (height, rise) = (start.dot(&self.direction), direction.dot(&self.direction));
        // Known sooner than what is left across the axis, and as long.
        let turned = direction.cross(&self.direction);
        let (across, drift) = (start - self.direction * height, direction - self.direction * rise);
        let (aside, squared) = (start.dot(&turned), turned.norm_squared());
        Local {
            start,
            direction,
            along,
            height,
            rise,
            across,
            drift,
            aside,
            squared,
            meets: start.dot(&direction) - height * rise,
        }
    }

    /// The crossing in the sensor frame; `from` and `line` as in [`localise`](Self::localise).
    #[inline(always)]
    pub(super) fn crossing(
        &self,
        line: &Local<T>,
        from: &Vector3<T>,
        entry: &LocalEntry<T>,
        active: bool,
    ) -> Crossing<T> {
        Crossing {
            along: line.along + entry.along,
            point: from + (line.start + line.direction * entry.along),
            normal: entry.normal,
            active,
        }
    }

    /// What a force along the line does there; none if the line does not enter.
    #[inline(always)]
    pub(super) fn entered(
        &self,
        line: &Local<T>,
        from: &Vector3<T>,
        entry: &LocalEntry<T>,
        active: bool,
    ) -> Entry<T> {
        let found = Entry::at(&self.crossing(line, from, entry, active), &line.direction);
        let incidence_squared = select_unpredictable(entry.enters, found.incidence_squared, T::zero());
        Entry { incidence_squared, ..found }
    }

    /// Both ends of what is inside a convex solid, from what tells where a line enters it. One that is `CLOSED`
    /// is left only after it was entered: what rounding finds else, at an edge, is none.
    #[inline]
    pub(super) fn both_ends<const CLOSED: bool>(
        &self,
        line: &Local<T>,
        from: &Vector3<T>,
        entry: impl Fn(&Local<T>) -> LocalEntry<T>,
        mut visit: impl FnMut(LocalEntry<T>, Crossing<T>),
    ) {
        let reversed = line.reversed();
        let end = entry(line);
        if end.enters {
            visit(end, self.crossing(line, from, &end, true));
        } else if CLOSED {
            return;
        }
        let end = entry(&reversed);
        if end.enters {
            let crossing = self.crossing(&reversed, from, &end, true);
            visit(end, Crossing { along: -crossing.along, ..crossing });
        }
    }

    /// Height of a vector along the axis, and its part across.
    #[inline]
    pub(super) fn split(&self, v: &Vector3<T>) -> (T, Vector3<T>) {
        let height = v.dot(&self.direction);
        // Once more, so that what is left is across even where most has cancelled.
        (height, self.part_across(&(v - self.direction * height)))
    }

    /// The part of a vector across the axis.
    #[inline]
    pub(super) fn part_across(&self, v: &Vector3<T>) -> Vector3<T> {
        v - self.direction * v.dot(&self.direction)
    }

    /// As [`split`](Self::split), for a point of the sensor frame. One so far away that its distance
    /// leaves the range is treated as if it were nearer.
    #[inline]
    pub(super) fn split_point(&self, point: &Vector3<T>) -> (T, Vector3<T>) {
        self.split(&within_range(&(point - self.origin)))
    }

    /// Shorter than any rounding error of a length, but not so short that its square underflows: to be
    /// added to what is across the axis, lest that be zero.
    pub(super) fn least_across(&self) -> Vector3<T> {
        any_perpendicular(&self.direction) * (T::LEAST_NORMAL / T::EPSILON).root()
    }

    /// The normal of a side at a point beside the axis, from its parts away from the axis and along it.
    #[inline(always)]
    pub(super) fn slanted(&self, across: &Vector3<T>, away: T, along: T) -> Vector3<T> {
        let scale = away / across.norm_squared().root();
        // Near the axis, rounding leaves a part along it, which would make the normal longer.
        let rest = across.dot(&self.direction) * scale;
        across * scale + self.direction * (along - rest)
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
        let (radius, height) = (radius * scale, Twofold::new(height * scale).times(self.per_length()));
        let [x, y, z] = difference(&(point * scale), &(self.origin * scale));
        let [ax, ay, az] = [self.direction.x, self.direction.y, self.direction.z].map(Twofold::new);
        let from_centre = [x.minus(ax.times(height)), y.minus(ay.times(height)), z.minus(az.times(height))];
        outside_ball(from_centre, radius) / scale
    }

    /// The reciprocal of the axis's length, which is a unit vector but for rounding: `1/|a| = (3 − |a|²)/2`.
    fn per_length(&self) -> Twofold<T> {
        let axis = [self.direction.x, self.direction.y, self.direction.z].map(Twofold::new);
        Twofold::new(T::literal(3.0)).minus(dot(axis, axis)).times(Twofold::new(T::literal(0.5)))
    }

    /// How far a vector reaches along the axis.
    pub(super) fn height_of(&self, v: [Twofold<T>; 3]) -> Twofold<T> {
        dot_with(v, &self.direction).times(self.per_length())
    }

    /// How far a point is outside the circular cylinder around the axis, with twice the digits.
    pub(super) fn outside_by(&self, point: &Vector3<T>, radius: T) -> T {
        self.outside_cone_by(point, radius, Twofold::new(T::zero()), T::one())
    }

    /// How far a point is outside its side, which is told, or outside the nearer of flat ends at these heights, whichever it is
    /// on; with twice the digits.
    pub(super) fn outside_side_or_end(&self, point: &Vector3<T>, side: T, [low, high]: [T; 2]) -> T {
        let height = self.height_of(difference(point, &self.origin));
        let over_high = height.minus(Twofold::new(high)).value();
        let end = over_high.max(Twofold::new(low).minus(height).value());
        if end.abs() < side.abs() { end } else { side }
    }

    /// How far a point is outside the cone around the axis whose radius is `radius` at the origin and
    /// shrinks by `taper` per unit of height, with twice the digits; `cosine` is the side's normal's
    /// across the axis.
    pub(super) fn outside_cone_by(&self, point: &Vector3<T>, radius: T, taper: Twofold<T>, cosine: T) -> T {
        let scale = (point - self.origin).amax().normalising_factor();
        let from_origin = difference(&(point * scale), &(self.origin * scale));
        let height = self.height_of(from_origin);
        let radius = Twofold::new(radius * scale).minus(taper.times(height));
        let excess = dot(from_origin, from_origin).minus(height.squared()).minus(radius.squared());
        let outside = excess.value() * cosine / (radius.value() + radius.value()) / scale;
        // At the apex there is no telling.
        if outside.is_number() { outside } else { T::zero() }
    }
}
