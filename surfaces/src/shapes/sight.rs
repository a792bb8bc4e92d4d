//! A line as seen from a solid of revolution, and the place of the solid that is nearest to it.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::profile::Piece;
use super::ring::RingLine;
use crate::numeric::vectors::{foot, hypotenuse, is_finite, larger, unit_or};

/// A place on the side of a solid of revolution.
#[derive(Clone, Copy)]
pub(super) struct Place<T: Real> {
    pub(super) point: Vector3<T>,
    /// `d(ρ²)/dz` there.
    pub(super) slope: T,
    /// Towards which end a flat end or a tip is met there: up, down, or none.
    end: T,
}

impl<T: Real> Place<T> {
    pub(super) fn on_side(x: T, y: T, z: T, slope: T) -> Self {
        Self { point: Vector3::new(x, y, z), slope, end: T::zero() }
    }

    /// Outward unit normal of the side.
    fn normal(&self) -> Vector3<T> {
        let up = -self.slope * T::literal(0.5);
        unit_or(&Vector3::new(self.point.x, self.point.y, up), || unit_or(&self.point, Vector3::z))
    }
}

/// A line turned about the axis of a solid of revolution until its direction is `(sine, 0, cosine)`, and
/// mirrored, if need be, so that it passes on the positive side of the axis.
///
/// Lengths are in units of about the size of the solid, heights count from its centre.
#[derive(Clone, Copy)]
pub(super) struct Sight<T: Real> {
    pub(super) sine: T,
    pub(super) cosine: T,
    /// Where the line passes in the plane across it, along `(−cosine, 0, sine)`.
    pub(super) ahead: T,
    /// The same along y, zero or more.
    pub(super) aside: T,
    /// As far as searches need to know it: from farther away the solid looks the same but for rounding.
    far: [T; 2],
    /// The x and the y axis of the turned frame.
    axes: [Vector3<T>; 2],
    centre: Vector3<T>,
    unit: T,
    /// The nearest place known, and its distance.
    nearest: Option<(T, Place<T>)>,
}

impl<T: Real> Sight<T> {
    /// Of a solid within `reach` of a point of the axis.
    pub(super) fn new(line: &Line<T>, centre: &Vector3<T>, reach: T) -> Self {
        let unit = reach.normalising_factor();
        let (from_centre, _) = foot(line, centre);
        let from_centre = if is_finite(&from_centre) { from_centre } else { Vector3::zeros() } * unit;
        let lies = |x: T| if x.abs() < T::EPSILON { T::zero() } else { x };
        // An angle that moves the line by less than rounding does is none.
        let sine = lies(hypotenuse(line.direction.x, line.direction.y));
        let cosine = lies(line.direction.z);
        let flat = |v: &Vector3<T>| Vector3::new(v.x, v.y, T::zero());
        let mut y = if sine.is_zero() {
            unit_or(&flat(&from_centre), Vector3::y)
        } else {
            let x = unit_or(&flat(&line.direction), Vector3::x);
            Vector3::new(-x.y, x.x, T::zero())
        };
        let x = Vector3::new(y.y, -y.x, T::zero());
        let ahead = from_centre.z * sine - from_centre.dot(&x) * cosine;
        let mut aside = from_centre.dot(&y);
        if aside < T::zero() {
            (y, aside) = (-y, -aside);
        }
        let most = T::one() / T::EPSILON;
        let nearer = T::one() / larger(T::one(), larger(ahead.abs(), aside) / most);
        let far = [ahead, aside];
        let [ahead, aside] = far.map(|x| x * nearer);
        Self { sine, cosine, ahead, aside, far, axes: [x, y], centre: *centre, unit, nearest: None }
    }

    /// A stretch of the profile in the units of this view.
    pub(super) fn seen(&self, piece: &Piece<T>) -> Piece<T> {
        let squared = |x: T| x * self.unit * self.unit;
        Piece {
            low: (piece.low - self.centre.z) * self.unit,
            high: (piece.high - self.centre.z) * self.unit,
            squared: squared(piece.squared),
            squared_above: squared(piece.squared_above),
            slope: piece.slope * self.unit,
            slope_above: piece.slope_above * self.unit,
            curvature: piece.curvature,
        }
    }

    /// From the line to a point across it: in the plane, along `(−cosine, 0, sine)` and along y.
    fn apart(&self, point: &Vector3<T>) -> [T; 2] {
        let [ahead, aside] = self.far;
        [ahead - (point.z * self.sine - point.x * self.cosine), aside - point.y]
    }

    /// Takes note of a place.
    pub(super) fn keep(&mut self, place: Place<T>) {
        let [ahead, aside] = self.apart(&place.point);
        let distance = hypotenuse(ahead, aside);
        if self.nearest.is_none_or(|(least, _)| distance < least) {
            self.nearest = Some((distance, place));
        }
    }

    /// Looks at the rim of the side at its upper (+1) or lower (−1) end, or the tip if the radius is zero.
    pub(super) fn rim(&mut self, z: T, radius: T, slope: T, end: T) {
        if !(radius > T::zero()) {
            return self.keep(Place { point: Vector3::new(T::zero(), T::zero(), z), slope, end });
        }
        let ahead = (self.ahead - z * self.sine) / radius;
        let start = Vector3::new(-ahead * self.cosine, self.aside / radius, ahead * self.sine);
        let seen = RingLine::new(start, Vector3::new(self.sine, T::zero(), self.cosine));
        // From farther away the ring is a point but for rounding.
        let near = start.amax() < T::one() / T::EPSILON;
        let (first, second) = if near { seen.nearest() } else { (T::zero(), None) };
        for t in [Some(first), second].into_iter().flatten() {
            let point = seen.at(t);
            let outward = unit_or(&Vector3::new(point.x, point.y, T::zero()), Vector3::x) * radius;
            self.keep(Place { point: Vector3::new(outward.x, outward.y, z), slope, end });
        }
    }

    /// The nearest place, its normal and its distance.
    pub(super) fn nearest(&self) -> Option<(T, Vector3<T>, Vector3<T>)> {
        let (distance, place) = self.nearest?;
        let normal = if place.end.is_zero() { place.normal() } else { self.normal_at_end(&place) };
        let back = |v: &Vector3<T>| {
            let [x, y] = self.axes;
            x * v.x + y * v.y + Vector3::z() * v.z
        };
        Some((distance / self.unit, self.centre + back(&place.point) / self.unit, back(&normal)))
    }

    /// Across the line, one between the normals of the side and of the flat end that meet on a rim; on a
    /// tip the one towards the line.
    fn normal_at_end(&self, place: &Place<T>) -> Vector3<T> {
        let (side, end) = (place.normal(), Vector3::new(T::zero(), T::zero(), place.end));
        let rises = side.x * self.sine + side.z * self.cosine;
        let falls = end.z * self.cosine;
        let is_rim = place.point.x != T::zero() || place.point.y != T::zero();
        if is_rim && rises * falls <= T::zero() && rises != falls {
            return unit_or(&(side * falls.abs() + end * rises.abs()), || side);
        }
        let across = |ahead: T, aside: T| Vector3::new(-ahead * self.cosine, aside, ahead * self.sine);
        let [ahead, aside] = self.apart(&place.point);
        let touches = hypotenuse(ahead, aside) <= T::EPSILON * T::literal(16.0);
        let away = if touches { across(end.z * self.sine, T::zero()) } else { across(ahead, aside) };
        unit_or(&away, || end)
    }
}
