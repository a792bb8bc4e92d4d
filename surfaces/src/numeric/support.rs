//! The point of a convex solid closest to a line, from the solid's support function.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::roots::bisected;
use super::vectors::{any_perpendicular, foot, is_finite};
use crate::ClosestApproach;

/// How many directions are tried before the best is refined.
const DIRECTIONS: u8 = 32;

/// The distance between a line and a convex solid around the origin is the greatest
/// `n·p − h(n)` over the unit vectors `n` across the line, `p` being a point of the line and `h`
/// the support function. `support` returns `h(n)` and the point where it is reached; `h` may be
/// infinite.
pub(crate) fn closest_approach<T: Real>(
    line: &Line<T>,
    support: impl Fn(&Vector3<T>) -> (T, Vector3<T>),
) -> ClosestApproach<T> {
    let (p, _) = foot(line, &Vector3::zeros());
    let p = if is_finite(&p) { p } else { Vector3::zeros() };
    let first = any_perpendicular(&line.direction);
    let second = line.direction.cross(&first);
    let towards = |angle: T| {
        let (sin, cos) = (angle.sin(), angle.cos());
        (first * cos + second * sin, second * cos - first * sin)
    };
    let value = |angle: T| {
        let (n, _) = towards(angle);
        n.dot(&p) - support(&n).0
    };
    let step = T::two_pi() / T::literal(f64::from(DIRECTIONS));
    let (mut best, mut best_value) = (p.dot(&second).atan2(p.dot(&first)), -T::GREATEST);
    let start = best;
    for k in 0..DIRECTIONS {
        let angle = start + step * T::literal(f64::from(k));
        let found = value(angle);
        if found > best_value {
            (best, best_value) = (angle, found);
        }
    }
    let rises = |angle: T| {
        let (n, turn) = towards(angle);
        turn.dot(&(p - support(&n).1)) > T::zero()
    };
    let angle = bisected(best - step, best + step, rises);
    let (normal, _) = towards(angle);
    let (height, point) = support(&normal);
    let gap = (normal.dot(&p) - height).max(T::zero()).min(T::GREATEST);
    // Where a flat or an edge is parallel to the line's shadow, the support point is one of many;
    // the one closest lies straight under the line.
    let under = p - normal * gap + line.direction * point.dot(&line.direction);
    ClosestApproach { gap, point: if is_finite(&under) { under } else { point }, normal, active: true }
}
