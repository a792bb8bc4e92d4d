//! The profile of a surface of revolution: the square of its radius as a spline.

use core::marker::PhantomData;

use fingertip_wrench::Real;

use crate::numeric::twofold::Twofold;
use crate::{BadShape, LocalSurface};

/// One point of a profile, and how the curve goes on from there to the next.
///
/// ```
/// use fingertip_surfaces::Revolution;
///
/// // A cone of millimetres, with a round end.
/// let tip = Revolution::from_profile([[0.0, 0.004_f64], [0.008, 0.003], [0.010, 0.0]])?;
/// let points = tip.knots().iter().map(|knot| knot.point()).collect::<Vec<_>>();
/// assert_eq!(points, [[0.0, 0.004], [0.008, 0.003], [0.010, 0.0]]);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot<T: Real> {
    pub(super) z: T,
    pub(super) radius: T,
    /// `d(ρ²)/dz` here, and half-way to the next knot.
    slope: T,
    middle_slope: T,
    /// What rounding took from both, for a type narrower than `f64`.
    rests: [T; 2],
}

impl<T: Real> Knot<T> {
    pub(super) fn at([z, radius]: [T; 2]) -> Self {
        Self { z, radius, slope: T::zero(), middle_slope: T::zero(), rests: [T::zero(); 2] }
    }

    /// Takes what rounding took from the slopes from those of the same knot in double precision.
    pub(super) fn complete(&mut self, exact: &Knot<f64>) {
        self.rests = [
            T::literal(exact.slope - self.slope.to_f64()),
            T::literal(exact.middle_slope - self.middle_slope.to_f64()),
        ];
    }

    /// Height and radius \[m\].
    #[inline]
    #[must_use]
    pub const fn point(&self) -> [T; 2] {
        [self.z, self.radius]
    }

    fn slopes(&self) -> [Twofold<T>; 2] {
        [
            Twofold::difference(self.slope, -self.rests[0]),
            Twofold::difference(self.middle_slope, -self.rests[1]),
        ]
    }

    /// The same in double precision, with what rounding took from the slopes.
    fn in_double(&self) -> Knot<f64> {
        let [slope, middle_slope] = [(self.slope, self.rests[0]), (self.middle_slope, self.rests[1])]
            .map(|(rounded, rest)| rounded.to_f64() + rest.to_f64());
        let [z, radius] = self.point().map(Real::to_f64);
        Knot { z, radius, slope, middle_slope, rests: [0.0; 2] }
    }
}

/// The points of a profile from bottom to top, however they are kept: an array, a slice, a vector of [`Knot`]s.
///
/// ```
/// use fingertip_surfaces::{Profile, Revolution};
///
/// fn height(profile: &impl Profile<f64>) -> f64 {
///     profile.knots().last().map_or(0.0, |knot| knot.point()[0])
/// }
///
/// let tip = Revolution::from_profile([[0.0, 0.004], [0.008, 0.003], [0.010, 0.0]])?;
/// assert_eq!(height(&tip.knots()), 0.010);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no profile of `{T}`",
    note = "the points of a profile are kept as an array, a slice or a vector of `Knot`s"
)]
pub trait Profile<T: Real> {
    /// Its points.
    fn knots(&self) -> impl Iterator<Item = Knot<T>>;
}

impl<T: Real, K: AsRef<[Knot<T>]> + ?Sized> Profile<T> for K {
    #[inline]
    fn knots(&self) -> impl Iterator<Item = Knot<T>> {
        self.as_ref().iter().copied()
    }
}

/// A profile in double precision, each of its points widened when it is asked for: there may be no heap to keep them.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct ProfileInDouble<'a, T, K> {
    profile: &'a K,
    scalar: PhantomData<T>,
}

impl<'a, T: Real, K: Profile<T>> ProfileInDouble<'a, T, K> {
    pub(super) fn new(profile: &'a K) -> Self {
        Self { profile, scalar: PhantomData }
    }
}

impl<T: Real, K: Profile<T>> Profile<f64> for ProfileInDouble<'_, T, K> {
    fn knots(&self) -> impl Iterator<Item = Knot<f64>> {
        self.profile.knots().map(|knot| knot.in_double())
    }
}

/// A stretch of the profile on which `ρ²` is `squared + slope·d + curvature·d²`, `d` being the
/// height over its lower end.
#[derive(Clone, Copy)]
pub(super) struct Piece<T: Real> {
    pub(super) low: T,
    pub(super) high: T,
    pub(super) squared: T,
    pub(super) squared_above: T,
    pub(super) slope: T,
    pub(super) slope_above: T,
    pub(super) curvature: T,
}

impl<T: Real> Piece<T> {
    #[inline]
    pub(super) fn squared_at(&self, z: T) -> T {
        let d = z - self.low;
        self.squared + d * (self.slope + d * self.curvature)
    }

    #[inline]
    pub(super) fn slope_at(&self, z: T) -> T {
        let d = z - self.low;
        self.slope + (d + d) * self.curvature
    }
}

/// Gives every knot its slopes: exact where `ρ²` is quadratic.
pub(super) fn fit<T: Real>(knots: &mut [Knot<T>]) -> Result<(), BadShape> {
    let shape = "surface of revolution";
    BadShape::check(shape, "profile", "at least two points", knots.len() >= 2)?;
    let last = knots.len() - 1;
    for (k, knot) in knots.iter().enumerate() {
        BadShape::check(shape, "profile", "finite", knot.z.is_number() && knot.radius.is_number())?;
        let at_end = k == 0 || k == last;
        let clear = knot.radius > T::zero() || (at_end && knot.radius >= T::zero());
        BadShape::check(shape, "profile", "clear of the axis but for its ends", clear)?;
    }
    let greatest = knots.iter().fold(T::zero(), |greatest, knot| greatest.max(knot.radius));
    BadShape::check(
        shape,
        "profile",
        "neither tiny nor huge",
        greatest >= T::LEAST_NORMAL.root() / T::EPSILON && greatest <= T::GREATEST.root() * T::EPSILON,
    )?;
    let two = T::one() + T::one();
    let mut before: Option<(T, T)> = None;
    for k in 0..last {
        let (Some(this), Some(next)) = (knots.get(k).copied(), knots.get(k + 1).copied()) else { break };
        let width = next.z - this.z;
        BadShape::check(shape, "profile", "ascending in z", width > T::zero())?;
        let rise = (next.radius - this.radius) * (next.radius + this.radius) / width;
        if let Some(knot) = knots.get_mut(k) {
            knot.slope = before.map_or(rise, |(width_before, rise_before)| {
                (width * rise_before + width_before * rise) / (width + width_before)
            });
            // Until the next slope is known.
            knot.middle_slope = rise;
        }
        before = Some((width, rise));
    }
    let rises = |knot: Option<&Knot<T>>| knot.map_or(T::zero(), |knot| knot.middle_slope);
    // The ends continue the parabola of their neighbours.
    let final_rise = rises(knots.get(last - 1));
    let final_slope = if last == 1 {
        final_rise
    } else {
        two * final_rise - knots.get(last - 1).map_or(T::zero(), |knot| knot.slope)
    };
    if last > 1 {
        let first_slope = two * rises(knots.first()) - knots.get(1).map_or(T::zero(), |knot| knot.slope);
        if let Some(knot) = knots.first_mut() {
            knot.slope = first_slope;
        }
    }
    if let Some(knot) = knots.get_mut(last) {
        knot.slope = final_slope;
        knot.middle_slope = final_slope;
    }
    for k in 0..last {
        let next_slope = knots.get(k + 1).map_or(T::zero(), |knot| knot.slope);
        if let Some(knot) = knots.get_mut(k) {
            knot.middle_slope = two * knot.middle_slope - (knot.slope + next_slope) / two;
        }
    }
    let tolerance = greatest * greatest * T::EPSILON * T::literal(16.0);
    for piece in pieces(&*knots) {
        let turn = piece.low - piece.slope / (two * piece.curvature);
        let least = if turn > piece.low && turn < piece.high { piece.squared_at(turn) } else { T::zero() };
        BadShape::check(
            shape,
            "profile",
            "smooth: the curve through its points must not touch the axis between them",
            least >= -tolerance && piece.squared_above >= -tolerance,
        )?;
    }
    Ok(())
}

pub(super) fn pieces<T: Real, K: Profile<T> + ?Sized>(profile: &K) -> impl Iterator<Item = Piece<T>> {
    profile.knots().zip(profile.knots().skip(1)).flat_map(|(this, next)| {
        let width = next.z - this.z;
        let half = width * T::literal(0.5);
        let middle = this.z + half;
        let squared = this.radius * this.radius;
        let squared_above = next.radius * next.radius;
        // From the ends inward, so that both values at the knots are exact.
        let squared_middle = squared + (this.slope + this.middle_slope) * half * T::literal(0.5);
        [
            Piece {
                low: this.z,
                high: middle,
                squared,
                squared_above: squared_middle,
                slope: this.slope,
                slope_above: this.middle_slope,
                curvature: (this.middle_slope - this.slope) / width,
            },
            Piece {
                low: middle,
                high: next.z,
                squared: squared_middle,
                squared_above,
                slope: this.middle_slope,
                slope_above: next.slope,
                curvature: (next.slope - this.middle_slope) / width,
            },
        ]
    })
}

/// The knots below and above a height, or the first or the last two, and whether they are these.
struct Interval<T: Real> {
    this: Knot<T>,
    next: Knot<T>,
    is_first: bool,
    is_last: bool,
}

impl<T: Real> Interval<T> {
    fn at<K: Profile<T> + ?Sized>(profile: &K, z: T) -> Option<Self> {
        let mut above = profile.knots();
        let (this, next) = (above.next()?, above.next()?);
        let mut found = Self { this, next, is_first: true, is_last: false };
        for beyond in above {
            if z <= found.next.z {
                return Some(found);
            }
            found = Self { this: found.next, next: beyond, is_first: false, is_last: false };
        }
        Some(Self { is_last: true, ..found })
    }
}

/// Squared radius at a height and its slope, with twice the digits and the slopes that the points
/// have exactly; as if the first and the last piece went on beyond the ends.
pub(super) fn exactly_at<T: Real>(profile: &impl Profile<T>, z: T) -> Option<[Twofold<T>; 2]> {
    let Interval { this, next, .. } = Interval::at(profile, z)?;
    let [at_this, middle] = this.slopes();
    let width = Twofold::difference(next.z, this.z);
    // In terms of the nearer knot, so that the value there is exact.
    let ahead = Twofold::difference(z, this.z);
    let from_this = (ahead.value() + ahead.value()) <= width.value();
    let (knot, way, at_knot) = if from_this {
        (this, ahead, at_this)
    } else {
        (next, Twofold::difference(z, next.z), next.slopes()[0])
    };
    // Half the width from knot to middle, in the direction of the way.
    let turn = if from_this { middle.minus(at_knot) } else { at_knot.minus(middle) };
    let bend = turn.times(way).divided_by(width);
    let squared = Twofold::new(knot.radius).squared().plus(way.times(at_knot.plus(bend)));
    Some([squared, at_knot.plus(bend).plus(bend)])
}

/// The part of the side at a height, by the numbers of the nearer knot. Those at the ends go on.
pub(super) fn local_surface_at<T: Real>(profile: &impl Profile<T>, z: T) -> Option<LocalSurface> {
    let Interval { this, next, is_first, is_last } = Interval::at(profile, z)?;
    let (this, next, at) = (this.in_double(), next.in_double(), z.to_f64());
    let (low, high, middle) = (this.z, next.z, this.middle_slope);
    let half = low + (high - low) * 0.5;
    let from_this = at <= half;
    let knot = if from_this { this } else { next };
    Some(LocalSurface::Turned {
        origin: knot.z,
        radius: knot.radius,
        slope: knot.slope,
        turn: if from_this { [knot.slope, middle] } else { [middle, knot.slope] },
        width: [low, high],
        between: match (from_this, is_first, is_last) {
            (true, true, _) => [f64::NEG_INFINITY, half],
            (true, ..) => [low, half],
            (false, _, true) => [half, f64::INFINITY],
            (false, ..) => [half, high],
        },
    })
}

#[cfg(test)]
mod tests {
    use super::{Knot, Profile, ProfileInDouble, pieces};
    use crate::Revolution;

    #[test]
    fn a_profile_in_double_precision_is_that_of_the_same_points() {
        let points = [[0.0_f32, 0.008], [0.004, 0.0083], [0.008, 0.0074], [0.012, 0.0052], [0.014, 0.0]];
        let narrow = Revolution::from_profile(points).unwrap();
        let wide = Revolution::from_profile(points.map(|point| point.map(f64::from))).unwrap();
        let widened = ProfileInDouble::new(narrow.profile());
        assert_eq!(
            widened.knots().map(|knot| knot.point()).collect::<Vec<_>>(),
            wide.knots().iter().map(Knot::point).collect::<Vec<_>>(),
        );
        let mut pairs = pieces(&widened).zip(pieces(wide.profile())).peekable();
        assert!(pairs.peek().is_some());
        for (piece, same) in pairs {
            assert_eq!((piece.low, piece.high), (same.low, same.high));
            // A slope has the digits of its two numbers in single precision.
            let [bend, straight] = [piece.curvature - same.curvature, piece.slope - same.slope];
            assert!(straight.abs() <= 4e-15 * 0.02, "{straight}");
            assert!(bend.abs() <= 4e-15 * 10.0, "{bend}");
            assert!((piece.squared - same.squared).abs() < 1e-18);
        }
    }
}
