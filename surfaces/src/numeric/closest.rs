//! The point of a convex solid closest to a line that misses it.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::roots::bisected;
use super::vectors::{foot, is_finite};
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
    from_distance(&(centre + origin + line.direction * along), at(along))
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

/// How many points of the line are tried before the best is refined.
const TRIALS: u8 = 64;

/// As [`to_convex`], for solids that are not convex: the line is sampled within reach, and the
/// nearest sample refined where the slope of the distance changes sign.
///
/// The distance changes by no more than the line goes on, and no place is farther from a sample than
/// `reach/64`: so the gap is too large by less than that, if a nearer approach hides between two
/// samples. Otherwise, as for a line with a single nearest place, it is exact but for rounding.
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
    let step = (reach + reach) / T::literal(f64::from(TRIALS));
    let (mut best, mut least) = (T::zero(), T::GREATEST);
    for k in 0..=TRIALS {
        let along = step * T::literal(f64::from(k)) - reach;
        let found = at(along).distance;
        if found < least {
            (best, least) = (along, found);
        }
    }
    let along = bisected(best - step, best + step, |t| at(t).normal.dot(&line.direction) < T::zero());
    from_distance(&point_at(along), at(along))
}
