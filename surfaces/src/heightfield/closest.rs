//! The place of a heightfield that is nearest to a line that misses it.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::Heightfield;
use crate::numeric::quadratic::roots;
use crate::numeric::roots::bracketed_from;
use crate::numeric::vectors::{foot, is_finite, larger, length, smaller};

/// The nearest place known so far, seen along the line.
struct Nearest<T: Real> {
    /// A point of the line.
    from: Vector3<T>,
    direction: Vector3<T>,
    /// That brings the spacing of the grid near 1.
    unit: T,
    place: Vector3<T>,
    /// Its distance in these units.
    distance: T,
}

impl<T: Real> Nearest<T> {
    /// A way in units of about the spacing of the grid, without its part along the line.
    fn across(&self, way: &Vector3<T>) -> Vector3<T> {
        let way = way * self.unit;
        way - self.direction * way.dot(&self.direction)
    }

    fn keep(&mut self, place: Vector3<T>) {
        let squared = self.across(&(place - self.from)).norm_squared();
        if squared < self.distance * self.distance {
            (self.place, self.distance) = (place, squared.root());
        }
    }

    /// `true` if nothing within `reach` of a point can be nearer.
    fn is_beyond(&self, point: &Vector3<T>, reach: T) -> bool {
        let limit = self.distance + reach * self.unit;
        self.across(&(point - self.from)).norm_squared() > limit * limit
    }

    /// Looks at a straight edge, but for its ends.
    fn edge(&mut self, one: &Vector3<T>, other: &Vector3<T>) {
        let (start, way) = (self.across(&(one - self.from)), self.across(&(other - one)));
        let part = -start.dot(&way) / way.norm_squared();
        if part > T::zero() && part < T::one() {
            self.keep(one + (other - one) * part);
        }
    }
}

/// `corner + (s·dx, t·dy, s·b + t·c + s·t·e)`, s and t from 0 to 1.
struct Cell<T: Real> {
    corner: Vector3<T>,
    spacing: [T; 2],
    slopes: [T; 2],
    twist: T,
}

impl<T: Real> Cell<T> {
    fn at(&self, [s, t]: [T; 2]) -> Vector3<T> {
        let ([dx, dy], [b, c]) = (self.spacing, self.slopes);
        self.corner + Vector3::new(dx * s, dy * t, b * s + c * t + self.twist * s * t)
    }

    /// Looks at the places within, where the normal is across the line.
    ///
    /// They are on a straight line of the grid, along which the height is quadratic and the square of the
    /// distance, `|a + b·τ + c·τ²|²`, convex or concave between the two roots of its second derivative: none
    /// is missed.
    fn outline(&self, nearest: &mut Nearest<T>) {
        let u = nearest.direction;
        let ([dx, dy], [b, c]) = (self.spacing, self.slopes);
        // Of the normal's part along the line: by s, by t.
        let by = [u.y / dy, u.x / dx];
        let level = (u.z - b * by[1] - c * by[0]) / self.twist;
        // τ is the one of s and t that changes more along the outline.
        let by_t = by[0].abs() >= by[1].abs();
        let [slow, fast] = if by_t { by } else { [by[1], by[0]] };
        let (start, rate) = (level / slow, -fast / slow);
        let (mut low, mut high) = (T::zero(), T::one());
        let (from, to) = (-start / rate, (T::one() - start) / rate);
        if from.is_number() && to.is_number() {
            (low, high) = (larger(smaller(from, to), low), smaller(larger(from, to), high));
        } else if !(start >= T::zero() && start <= T::one()) {
            return;
        }
        if !(low < high) {
            return;
        }
        let half = (high - low) * T::literal(0.5);
        let middle = low + half;
        let place = |x: T| {
            let (tau, other) = (middle + x, start + rate * (middle + x));
            self.at(if by_t { [other, tau] } else { [tau, other] })
        };
        let other = start + rate * middle;
        let ([s, t], [s_rate, t_rate]) =
            if by_t { ([other, middle], [rate, T::one()]) } else { ([middle, other], [T::one(), rate]) };
        let rise = (b + self.twist * t) * s_rate + (c + self.twist * s) * t_rate;
        let first = Vector3::new(dx * s_rate, dy * t_rate, rise);
        let second = Vector3::new(T::zero(), T::zero(), self.twist * rate);
        let a = nearest.across(&(place(T::zero()) - nearest.from));
        let [b, c] = [first, second].map(|way| nearest.across(&way));
        let (two, three) = (T::literal(2.0), T::literal(3.0));
        // Half of the derivative of the square of the distance, from the constant on.
        let slope =
            [a.dot(&b), b.norm_squared() + two * a.dot(&c), three * b.dot(&c), two * c.norm_squared()];
        let bend = |x: T| slope[1] + x * (two * slope[2] + x * three * slope[3]);
        let slope_at = |x: T| {
            let value = slope[0] + x * (slope[1] + x * (slope[2] + x * slope[3]));
            (value, bend(x))
        };
        let widest = b.amax() + c.amax() * half;
        let noise = T::EPSILON * (a.amax() + widest * half) * widest;
        let turns = roots(three * slope[3], slope[2], slope[1]).unwrap_or([-half; 2]);
        let [one, other] = turns.map(|x| smaller(larger(x, -half), half));
        for (low, high) in [(-half, one), (one, other), (other, half)] {
            if slope_at(low).0 < T::zero() && slope_at(high).0 >= T::zero() {
                let start = low + (high - low) * T::literal(0.5);
                nearest.keep(place(bracketed_from(start, low, high, noise, slope_at)));
            }
        }
    }
}

impl<T: Real> Heightfield<T> {
    /// The nearest of all heights, then of all edges and outlines of cells that may be nearer.
    pub(super) fn nearest_to(&self, line: &Line<T>) -> (Vector3<T>, T) {
        let middle = self.node(self.columns / 2, self.rows / 2);
        let (offset, _) = foot(line, &middle);
        let from = if is_finite(&offset) { middle + offset } else { middle };
        let [dx, dy] = self.spacing;
        let (half, unit) = (T::literal(0.5), larger(dx, dy).normalising_factor());
        let mut nearest =
            Nearest { from, direction: line.direction, unit, place: middle, distance: T::GREATEST };
        for row in 0..self.rows {
            for column in 0..self.columns {
                nearest.keep(self.node(column, row));
            }
        }
        for row in 1..self.rows {
            for column in 1..self.columns {
                let corners = [(1, 1), (0, 1), (1, 0), (0, 0)].map(|(i, j)| self.node(column - i, row - j));
                let [p, q, r, s] = corners;
                let centre = p + (s - p) * half;
                let reach =
                    corners.iter().fold(T::zero(), |most, corner| larger(most, (corner.z - centre.z).abs()));
                if nearest.is_beyond(&centre, reach + (dx + dy) * half) {
                    continue;
                }
                for (one, other) in [(p, q), (p, r), (q, s), (r, s)] {
                    nearest.edge(&one, &other);
                }
                let cell = Cell {
                    corner: p,
                    spacing: self.spacing,
                    slopes: [q.z - p.z, r.z - p.z],
                    twist: (s.z - q.z) - (r.z - p.z),
                };
                cell.outline(&mut nearest);
            }
        }
        let away = nearest.place - from;
        let gap = length(&(away - line.direction * away.dot(&line.direction)));
        (nearest.place, if gap.is_number() { gap } else { T::GREATEST })
    }
}

#[cfg(test)]
mod tests {
    use super::Heightfield;
    use crate::ActiveSurface;
    use fingertip_wrench::{Line, Real};
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Columns, rows.
    const SIZE: [usize; 2] = [5, 4];

    fn across(line: &Line<f64>, way: &Vector3<f64>) -> Vector3<f64> {
        way - line.direction * way.dot(&line.direction)
    }

    /// A cell is made of straight segments, whose distances are known: dense samples of them, the least
    /// refined by thirds.
    fn least_of_segments(field: &Heightfield<f64>, line: &Line<f64>) -> f64 {
        const SAMPLES: usize = 24;
        let mut least = f64::MAX;
        for j in 1..SIZE[1] {
            for i in 1..SIZE[0] {
                let at = |part: f64| {
                    let [low, high] = [j - 1, j].map(|j| field.node(i - 1, j).lerp(&field.node(i, j), part));
                    let (start, way) = (across(line, &(low - line.point)), across(line, &(high - low)));
                    let t = (-start.dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
                    (start + way * t).norm()
                };
                let samples: Vec<_> = (0..=SAMPLES).map(|k| at(k as f64 / SAMPLES as f64)).collect();
                for k in 0..=SAMPLES {
                    let neighbours = [k.saturating_sub(1), (k + 1).min(SAMPLES)];
                    if neighbours.iter().any(|n| samples[*n] < samples[k]) || samples[k] > least + 0.2 {
                        continue;
                    }
                    let [mut low, mut high] = neighbours.map(|n| n as f64 / SAMPLES as f64);
                    for _ in 0..70 {
                        let [one, other] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                        if at(one) < at(other) { high = other } else { low = one }
                    }
                    least = least.min(at(0.5 * (low + high)));
                }
            }
        }
        least
    }

    fn nothing_is_nearer<T: Real>(size: f64) {
        let mut random = Pcg64Mcg::seed_from_u64(9);
        let (mut missing, mut as_near, mut within) = (0, 0, 0);
        for trial in 0..1500 {
            let roughness = if trial % 5 == 0 { 0.0 } else { random.random_range(0.1..2.0) };
            let rounded = |x: f64| T::literal(x * size);
            let heights = (0..SIZE[0] * SIZE[1]).map(|_| roughness * random.random_range(-0.5..0.5));
            let heights: Vec<_> = heights.map(rounded).collect();
            let wide = heights.iter().map(|h| h.to_f64() / size).collect();
            let field = Heightfield::new([-2.0, -1.5].map(rounded), [size, size].map(T::literal), 5, heights)
                .unwrap();
            let exact = Heightfield::new([-2.0, -1.5], [1.0; 2], 5, wide).unwrap();
            let mut any = |reach: f64| Vector3::from_fn(|_, _| random.random_range(-reach..reach));
            let (mut point, mut direction) = (any(2.0), any(1.0));
            match trial % 4 {
                // Near a place, across its normal.
                0 | 1 => {
                    let normal = exact.normal(&point);
                    point.z = exact.height(point.x, point.y).0;
                    point += normal * 10_f64.powf(any(1.0).x * 4.0 - 4.0);
                    direction = normal.cross(&direction);
                }
                2 => direction.z = 0.0,
                _ => {}
            }
            let direction = direction.normalize().map(T::literal);
            let given = Line { point: point.map(rounded), direction };
            let back = |v: &Vector3<T>| v.map(Real::to_f64);
            let line = Line { point: back(&given.point) / size, direction: back(&direction).normalize() };
            let mut crosses = false;
            exact.crossings(&line, |_| crosses = true);
            field.crossings(&given, |_| crosses = true);
            if crosses {
                continue;
            }
            missing += 1;
            let found = field.closest_approach(&given).unwrap();
            let (gap, place) = (found.gap.to_f64() / size, back(&found.point) / size);
            let allowed = 64.0 * T::EPSILON.to_f64();
            assert!(
                (across(&line, &(place - line.point)).norm() - gap).abs() <= allowed,
                "{trial}: {found:?}"
            );
            assert!((place.z - exact.height(place.x, place.y).0).abs() <= allowed, "{trial}: {found:?}");
            let least = least_of_segments(&exact, &line);
            assert!(gap <= least + allowed, "{trial}: {gap:e} told, {least:e} found");
            as_near += i32::from(gap >= least - allowed);
            let on_edge = |x: f64| (x - x.round()).abs() < 1e-6;
            within += i32::from(!on_edge(place.x) && !on_edge(place.y - 0.5));
        }
        println!("{missing} missing, {as_near} as near, {within} within a cell");
        assert!(as_near * 100 > missing * 99 && within > 20);
    }

    #[test]
    fn nothing_is_nearer_in_both_precisions() {
        nothing_is_nearer::<f64>(1.0);
        nothing_is_nearer::<f32>(1.0);
        nothing_is_nearer::<f64>(0.0009765625);
        nothing_is_nearer::<f32>(1024.0);
    }
}
