//! Back onto the surface.

use fingertip_surfaces::{ActiveSurface, is_closed_convex};
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

/// The place of the surface that a place beside it stands for, and the normal there: where the line leaves the body.
/// Of the crossings only those count that face along the line and are no farther than `reach` \[m\]. Those beyond the
/// active part count: by its own error a track may leave it.
///
/// `None` if there is none such: then [`beside_the_line`] tells.
#[inline(always)]
pub(super) fn onto_surface<T: Real, S: ActiveSurface<T>>(
    surface: &S,
    line: &Line<T>,
    reach: T,
) -> Option<(Vector3<T>, Vector3<T>)> {
    let is_number = |point: &Vector3<T>| (point.x + point.y + point.z).is_number();
    let found = if is_closed_convex(&surface.shortcuts()) {
        // It leaves but once, and that is told last.
        let mut last = None;
        surface.crossings(line, |crossing| last = Some(crossing));
        last.filter(|crossing| crossing.along.abs() <= reach && is_number(&crossing.point))
    } else {
        let (mut nearest, mut least) = (None, reach);
        surface.crossings(line, |crossing| {
            let away = crossing.along.abs();
            let outwards = crossing.normal.dot(&line.direction) > T::zero();
            if away <= least && outwards && is_number(&crossing.point) {
                (nearest, least) = (Some(crossing), away);
            }
        });
        nearest
    };
    found.map(|crossing| (crossing.point, crossing.normal))
}

/// Past an end or an edge, the nearest place to the line that faces along it and is no farther than `reach` \[m\].
pub(super) fn beside_the_line<T: Real, S: ActiveSurface<T>>(
    surface: &S,
    line: Line<T>,
    reach: T,
) -> Option<(Vector3<T>, Vector3<T>)> {
    let closest = surface.closest_approach(&line)?;
    let away = closest.point - line.point;
    let outwards = closest.normal.dot(&line.direction) > T::zero();
    let near = closest.point.sum().is_number() && away.amax() <= reach && outwards;
    near.then_some((closest.point, closest.normal))
}
