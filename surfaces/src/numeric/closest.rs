//! The point of a convex solid closest to a line that misses it.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::roots::bisected;
use super::vectors::{foot, is_finite, larger, largest, unit_or};
use crate::{ClosestApproach, Distance};

/// By bisection of the slope of the distance along the line, which is convex. `distance` tells the
/// signed distance of a point, `reach` bounds the solid around `centre`.
///
/// `active` tells which points may touch.
pub(crate) fn to_convex<T: Real>(
    line: &Line<T>,
    centre: &Vector3<T>,
    reach: T,
    distance: impl Fn(&Vector3<T>) -> Distance<T>,
) -> ClosestApproach<T> {
    let (start, _) = foot(line, centre);
    let origin = if is_finite(&start) { start } else { Vector3::zeros() };
    let at = |along: T| distance(&(centre + origin + line.direction * along));
    let along = bisected(-reach, reach, |t| at(t).normal.dot(&line.direction) < T::zero());
    let mut found = at(along);
    let offset = origin + line.direction * along;
    let hair = (largest(&offset) + largest(centre)) * (T::EPSILON * T::literal(16.0));
    if found.distance <= hair {
        // It touches, at an edge perhaps, where each face has a normal: across the line is one between that of
        // the face that it comes to and that of the face that it leaves.
        let [before, after] = [along - hair, along + hair].map(|t| at(t).normal);
        let rises = larger(after.dot(&line.direction), T::zero());
        let falls = larger(-before.dot(&line.direction), T::zero());
        found.normal = unit_or(&(before * rises + after * falls), || found.normal);
    }
    from_distance(&(centre + offset), found)
}

/// The foot of a point on the surface, told its distance.
pub(crate) fn from_distance<T: Real>(point: &Vector3<T>, found: Distance<T>) -> ClosestApproach<T> {
    let on_surface = point - found.normal * found.distance;
    ClosestApproach {
        gap: found.distance.max(T::zero()).min(T::GREATEST),
        point: if is_finite(&on_surface) { on_surface } else { Vector3::zeros() },
        normal: found.normal,
        active: true,
    }
}

/// By how much the gap may be too large, as a part of the reach: one in so many.
const RESOLUTION: f64 = 256.0;

/// How many places are looked at first, spread over the reach.
const FIRST: u8 = 16;

/// As [`to_convex`], for solids that are not convex: the line is searched within reach, and the
/// nearest place refined where the slope of the distance changes sign.
///
/// The distance changes by no more than the line goes on. So after a place that is farther than the
/// nearest known one by `x`, nothing within the next `x + 2·reach/256` is nearer than that one by more
/// than `reach/256` (Piyavskii 1972, Shubert 1972): the search goes on from there. This bounds by how
/// much the gap is too large, if `distance` is one from the nearest point of the solid, and the number
/// of steps: by 256, and by some dozens unless the line runs along the surface. For a line with a single
/// nearest place the gap is exact but for rounding.
pub(crate) fn by_search<T: Real>(
    line: &Line<T>,
    centre: &Vector3<T>,
    reach: T,
    distance: impl Fn(&Vector3<T>) -> Distance<T>,
) -> ClosestApproach<T> {
    let (start, _) = foot(line, centre);
    let origin = if is_finite(&start) { start } else { Vector3::zeros() };
    let point_at = |along: T| centre + origin + line.direction * along;
    let at = |along: T| distance(&point_at(along));
    let stride = (reach + reach) / T::literal(f64::from(FIRST));
    let least_step = (reach + reach) / T::literal(RESOLUTION);
    let mut least = T::GREATEST;
    for k in 0..=FIRST {
        let found = at(stride * T::literal(f64::from(k)) - reach).distance;
        if found < least {
            least = found;
        }
    }
    // The nearest place, between those looked at before and after it.
    let mut nearest = (T::zero(), T::GREATEST, [-reach, reach]);
    let (mut before, mut along) = (-reach, -reach);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    for _ in 0..=RESOLUTION as u16 {
        let found = at(along).distance;
        let next = (along + least_step + larger(found - least, T::zero())).min(reach);
        if found < nearest.1 {
            nearest = (along, found, [before, next]);
        }
        if found < least {
            least = found;
        }
        if !(next > along) {
            break;
        }
        (before, along) = (along, next);
    }
    let (place, _, [low, high]) = nearest;
    let refined = bisected(low, high, |t| at(t).normal.dot(&line.direction) < T::zero());
    let (first, second) = (at(refined), at(place));
    if first.distance <= second.distance {
        from_distance(&point_at(refined), first)
    } else {
        from_distance(&point_at(place), second)
    }
}

#[cfg(test)]
mod tests {
    use super::by_search;
    use crate::Distance;
    use fingertip_wrench::Line;
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};

    /// Small balls far apart, of which many are nearly as near: as much as a shape can hide.
    #[test]
    fn no_place_is_missed_that_is_nearer_by_more_than_stated() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        let (mut tried, mut exact) = (0, 0);
        for _ in 0..2000 {
            let mut any = || Vector3::from_fn(|_, _| random.random_range(-0.5_f64..0.5));
            let balls: [_; 6] = core::array::from_fn(|_| any());
            let line = Line { point: any(), direction: any().normalize() };
            let radius = 0.01;
            let distance = |point: &Vector3<f64>| {
                let from = balls.map(|ball| point - ball);
                let nearest = from.iter().min_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap();
                Distance { distance: nearest.norm() - radius, normal: nearest.normalize() }
            };
            let least = balls.map(|ball| (ball - line.point).cross(&line.direction).norm() - radius);
            let least = least.into_iter().fold(f64::MAX, f64::min);
            if least > 0.0 {
                let found = by_search(&line, &Vector3::zeros(), 1.0, distance).gap;
                assert!(found >= least - 1e-14 && found <= least + 1.0 / 256.0, "{found} {least}");
                tried += 1;
                exact += i32::from(found <= least + 1e-14);
            }
        }
        assert!(exact * 10 > tried * 9, "{exact} of {tried}");
    }
}
