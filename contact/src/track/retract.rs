//! Back onto the surface.

use fingertip_surfaces::ActiveSurface;
use fingertip_surfaces::numeric::vectors::{is_finite, unit_or};
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

/// The place of the surface that a place beside it stands for, and the normal there: along `direction`, or the
/// nearest to that line where it misses. Of the crossings only those count that face the same way and are no
/// farther than `reach` \[m\]. Those beyond the active part count: by its own error a track may leave it.
///
/// `None` if there is none such.
#[inline]
pub(super) fn onto_surface<T: Real, S: ActiveSurface<T>>(
    surface: &S,
    beside: &Vector3<T>,
    direction: &Vector3<T>,
    reach: T,
) -> Option<(Vector3<T>, Vector3<T>)> {
    let line = Line { point: *beside, direction: unit_or(direction, Vector3::zeros) };
    let mut nearest = None;
    let mut least = reach;
    surface.crossings(&line, |crossing| {
        let away = crossing.along.abs();
        if away <= least && crossing.normal.dot(&line.direction) > T::zero() && is_finite(&crossing.point) {
            least = away;
            nearest = Some((crossing.point, crossing.normal));
        }
    });
    nearest.or_else(|| beside_the_line(surface, &line, reach))
}

/// Past an end or an edge.
#[cold]
fn beside_the_line<T: Real, S: ActiveSurface<T>>(
    surface: &S,
    line: &Line<T>,
    reach: T,
) -> Option<(Vector3<T>, Vector3<T>)> {
    let closest = surface.closest_approach(line)?;
    let away = closest.point - line.point;
    let near =
        is_finite(&closest.point) && away.amax() <= reach && closest.normal.dot(&line.direction) > T::zero();
    near.then_some((closest.point, closest.normal))
}
