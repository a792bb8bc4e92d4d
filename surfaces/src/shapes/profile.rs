//! The profile of a surface of revolution: the square of its radius as a spline.

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
    for piece in pieces(knots) {
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

pub(super) fn pieces<T: Real>(knots: &[Knot<T>]) -> impl Iterator<Item = Piece<T>> + '_ {
    knots.iter().zip(knots.iter().skip(1)).flat_map(|(this, next)| {
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

/// The knots below and above a height, or the first or the last two, and the place of the lower one.
fn interval<T: Real>(knots: &[Knot<T>], z: T) -> Option<(usize, &Knot<T>, &Knot<T>)> {
    let last = knots.len().checked_sub(2)?;
    let below = knots.iter().skip(1).position(|next| z <= next.z).unwrap_or(last);
    Some((below, knots.get(below)?, knots.get(below + 1)?))
}

/// Squared radius at a height and its slope, with twice the digits and the slopes that the points
/// have exactly; as if the first and the last piece went on beyond the ends.
pub(super) fn exactly_at<T: Real>(knots: &[Knot<T>], z: T) -> Option<[Twofold<T>; 2]> {
    let (_, this, next) = interval(knots, z)?;
    let slope = |rounded: T, rest: T| Twofold::difference(rounded, -rest);
    let middle = slope(this.middle_slope, this.rests[1]);
    let width = Twofold::difference(next.z, this.z);
    // In terms of the nearer knot, so that the value there is exact.
    let ahead = Twofold::difference(z, this.z);
    let from_this = (ahead.value() + ahead.value()) <= width.value();
    let (knot, way) = if from_this { (this, ahead) } else { (next, Twofold::difference(z, next.z)) };
    let at_knot = slope(knot.slope, knot.rests[0]);
    // Half the width from knot to middle, in the direction of the way.
    let turn = if from_this { middle.minus(at_knot) } else { at_knot.minus(middle) };
    let bend = turn.times(way).divided_by(width);
    let squared = Twofold::new(knot.radius).squared().plus(way.times(at_knot.plus(bend)));
    Some([squared, at_knot.plus(bend).plus(bend)])
}

/// The part of the side at a height, by the numbers of the nearer knot. Those at the ends go on.
pub(super) fn local_surface_at<T: Real>(knots: &[Knot<T>], z: T) -> Option<LocalSurface> {
    let (below, this, next) = interval(knots, z)?;
    let is_last = below + 2 == knots.len();
    let [low, high, at] = [this.z, next.z, z].map(Real::to_f64);
    let exact = |rounded: T, rest: T| rounded.to_f64() + rest.to_f64();
    let middle = exact(this.middle_slope, this.rests[1]);
    let half = low + (high - low) * 0.5;
    let from_this = at <= half;
    let knot = if from_this { this } else { next };
    let slope = exact(knot.slope, knot.rests[0]);
    Some(LocalSurface::Turned {
        origin: knot.z.to_f64(),
        radius: knot.radius.to_f64(),
        slope,
        turn: if from_this { [slope, middle] } else { [middle, slope] },
        width: [low, high],
        between: match (from_this, below) {
            (true, 0) => [f64::NEG_INFINITY, half],
            (true, _) => [low, half],
            (false, _) if is_last => [half, f64::INFINITY],
            (false, _) => [half, high],
        },
    })
}
