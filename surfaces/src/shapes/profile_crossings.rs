//! Where a line crosses a surface of revolution: piece by piece of its profile, each a quadric.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::profile::{Profile, pieces};
use super::revolution::Revolution;
use crate::Crossing;
use crate::numeric::quadratic::roots;
use crate::numeric::vectors::foot;

impl<T: Real, K: Profile<T>> Revolution<T, K> {
    /// Compiled once, not once for each caller: a call through a pointer costs little beside what is done here.
    pub(super) fn each_crossing(&self, line: &Line<T>, visit: &mut dyn FnMut(Crossing<T>)) {
        let (centre, reach) = self.bounds();
        let (offset, along) = foot(line, &centre);
        let left = reach * reach - offset.norm_squared();
        if !(left > T::zero()) {
            return;
        }
        let (start, direction) = (centre + offset, line.direction);
        let reach = left.root();
        let mut report = |t: T, end: Option<Vector3<T>>| {
            let point = start + direction * t;
            let normal = end.unwrap_or_else(|| self.side_normal(point.x, point.y, point.z));
            visit(Crossing { along: along + t, point, normal, active: end.is_none() });
        };
        // How far outside the line is at a height, as seen from both pieces that meet there.
        let at_height = |z: T| (z - start.z) / direction.z;
        let excess_at = |t: T, squared: T| {
            let (x, y) = (start.x + direction.x * t, start.y + direction.y * t);
            x * x + y * y - squared
        };
        // Pieces hold their lower end, the last one both.
        let top = self.ends().map_or(start.z, |(_, top)| top.z);
        for piece in pieces(self.profile()) {
            let (low, high) = if direction.z == T::zero() {
                let holds = start.z < piece.high || start.z == top && piece.high == top;
                if !(piece.low <= start.z && holds) {
                    continue;
                }
                ((-reach, None), (reach, None))
            } else {
                let below = (at_height(piece.low), Some(piece.squared));
                let above = (at_height(piece.high), Some(piece.squared_above));
                let (first, last) = if direction.z > T::zero() { (below, above) } else { (above, below) };
                (
                    if first.0 >= -reach { first } else { (-reach, None) },
                    if last.0 <= reach { last } else { (reach, None) },
                )
            };
            if !(low.0 < high.0) {
                continue;
            }
            let outside = |(t, squared): (T, Option<T>)| {
                excess_at(t, squared.unwrap_or_else(|| piece.squared_at(start.z + direction.z * t)))
                    >= T::zero()
            };
            let middle = (low.0 + high.0) * T::literal(0.5);
            let m = start + direction * middle;
            let a = direction.x * direction.x + direction.y * direction.y
                - piece.curvature * direction.z * direction.z;
            let b =
                m.x * direction.x + m.y * direction.y - piece.slope_at(m.z) * direction.z * T::literal(0.5);
            let c = m.x * m.x + m.y * m.y - piece.squared_at(m.z);
            let ends = roots(a, b, c).map(|ends| ends.map(|t| t + middle));
            let within = |t: &T| *t > low.0 && *t < high.0;
            let starts_outside = outside(low);
            if starts_outside != outside(high) {
                // Exactly one: the root within, or what rounding left of it.
                let off = |t: &T| (*t - middle).abs();
                let nearer = |a: &T, b: &T| off(a).partial_cmp(&off(b)).unwrap_or(core::cmp::Ordering::Equal);
                let t = ends
                    .and_then(|ends| ends.into_iter().find(within))
                    .or(ends.and_then(|ends| ends.into_iter().filter(|t| t.is_number()).min_by(nearer)))
                    .unwrap_or(middle);
                report(t.max(low.0).min(high.0), None);
            } else if let Some([first, second]) = ends
                && (a > T::zero()) == starts_outside
                && within(&((first + second) * T::literal(0.5)))
            {
                // Both within, or one at a knot, where rounding may have put it beyond.
                report(first.max(low.0), None);
                report(second.min(high.0), None);
            }
        }
        if let (Some((bottom, top)), true) = (self.ends(), direction.z != T::zero()) {
            for (end, normal) in [(bottom, -Vector3::z()), (top, Vector3::z())] {
                let t = at_height(end.z);
                if t.abs() <= reach && excess_at(t, end.radius * end.radius) < T::zero() {
                    report(t, Some(normal));
                }
            }
        }
    }
}
