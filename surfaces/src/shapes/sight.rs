//! A line as seen from a solid of revolution, and the place of the solid that is nearest to it.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::profile::Piece;
use super::ring::RingLine;
use crate::numeric::vectors::{foot, hypotenuse, is_finite, larger, unit_or};

/// A place on the side of a solid of revolution.
#[derive(Clone, Copy)]
struct Place<T: Real> {
    point: Vector3<T>,
    /// `d(ρ²)/dz` there.
    slope: T,
    /// Towards which end a flat end or a tip is met there: up, down, or none.
    end: T,
}

impl<T: Real> Place<T> {
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
    /// Heights of the rims, lower and upper.
    rims: [T; 2],
    /// The nearest place known, and where it lies in the plane across the line.
    nearest: Option<([T; 2], Place<T>)>,
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
        Self {
            sine,
            cosine,
            ahead,
            aside,
            far,
            axes: [x, y],
            centre: *centre,
            unit,
            rims: [-T::GREATEST, T::GREATEST],
            nearest: None,
        }
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

    /// Where a point lies in the plane across the line: along `(−cosine, 0, sine)` and along y.
    fn seen_at(&self, point: &Vector3<T>) -> [T; 2] {
        [point.z * self.sine - point.x * self.cosine, point.y]
    }

    /// In that plane, from a point to the line.
    fn apart(&self, point: &Vector3<T>) -> [T; 2] {
        let ([ahead, aside], [at, beside]) = (self.far, self.seen_at(point));
        [ahead - at, aside - beside]
    }

    /// Takes note of a place of the side, but for its rims, that have other normals and are looked at
    /// before.
    pub(super) fn keep_on_side(&mut self, x: T, y: T, z: T, slope: T) {
        let on_rim = |rim: &T| (z - *rim).abs() <= T::EPSILON * T::literal(8.0);
        if !self.rims.iter().any(on_rim) {
            self.keep(Place { point: Vector3::new(x, y, z), slope, end: T::zero() });
        }
    }

    /// Takes note of a place.
    fn keep(&mut self, place: Place<T>) {
        let here = self.seen_at(&place.point);
        // The difference of the squares of two distances, which far away would be lost in either.
        let nearer = self.nearest.is_none_or(|(known, _)| {
            let more = |from: T, to: T, line: T| (to - from) * (to - line + (from - line));
            let [ahead, aside] = self.far;
            more(known[0], here[0], ahead) + more(known[1], here[1], aside) < T::zero()
        });
        if nearer {
            self.nearest = Some((here, place));
        }
    }

    /// Looks at the rim of the side at its upper (+1) or lower (−1) end, or the tip if the radius is zero.
    pub(super) fn rim(&mut self, z: T, radius: T, slope: T, end: T) {
        if !(radius > T::zero()) {
            return self.keep(Place { point: Vector3::new(T::zero(), T::zero(), z), slope, end });
        }
        let [low, high] = self.rims;
        self.rims = if end < T::zero() { [z, high] } else { [low, z] };
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
        let (_, place) = self.nearest?;
        let [ahead, aside] = self.apart(&place.point);
        let distance = hypotenuse(ahead, aside);
        let normal = self.normal(&place);
        let back = |v: &Vector3<T>| {
            let [x, y] = self.axes;
            x * v.x + y * v.y + Vector3::z() * v.z
        };
        Some((distance / self.unit, self.centre + back(&place.point) / self.unit, back(&normal)))
    }

    /// Towards the line, if that is not so near that rounding turns it: however sharp the bend, that is where
    /// the normal points. Else that of the side; on a rim one across the line between those of the side
    /// and of the flat end that meet there, on a tip the one nearest to the axis.
    fn normal(&self, place: &Place<T>) -> Vector3<T> {
        let across = |ahead: T, aside: T| Vector3::new(-ahead * self.cosine, aside, ahead * self.sine);
        let [ahead, aside] = self.apart(&place.point);
        let (end, side) = (Vector3::new(T::zero(), T::zero(), place.end), place.normal());
        let near = if place.end.is_zero() { T::EPSILON.root() } else { T::EPSILON * T::literal(16.0) };
        let away = across(ahead, aside);
        // Of a line that passes inside it is the other way.
        if hypotenuse(ahead, aside) > near && away.dot(&(side + end)) > T::zero() {
            return unit_or(&away, || side);
        }
        if place.end.is_zero() {
            return side;
        }
        if place.point.x.is_zero() && place.point.y.is_zero() {
            return unit_or(&across(end.z * self.sine, T::zero()), || end);
        }
        let (rises, falls) = (side.x * self.sine + side.z * self.cosine, end.z * self.cosine);
        unit_or(&(side * falls.abs() + end * rises.abs()), || side)
    }
}
