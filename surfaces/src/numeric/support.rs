//! The point of a convex solid closest to a line, from the solid's support function.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::roots::bisected;
use super::vectors::{any_perpendicular, foot, is_finite, unit_or};
use crate::ClosestApproach;

/// The distance between a line and a convex solid with the origin in it is the greatest `n·p − h(n)` over
/// the unit vectors `n` across the line, `p` being a point of the line and `h` the support function.
/// `support` returns `h(n)` and a point where it is reached; `h` may be infinite, and the point then one
/// far away in the direction in which the solid goes on.
///
/// The best `n` is within a quarter turn of the direction from the origin to the line, since `n·p` is
/// positive. And at any `n` within a quarter turn of the best, the support point `s` tells on which side
/// that is: it separates the line from the solid, so from `s`, and either `n` separates too, where
/// `n·p − h(n)` has one summit only, or the line passes beside `s` on the side of the best. So bisection
/// finds it for certain, however thin the solid.
pub(crate) fn closest_approach<T: Real>(
    line: &Line<T>,
    support: impl Fn(&Vector3<T>) -> (T, Vector3<T>),
) -> ClosestApproach<T> {
    let (p, _) = foot(line, &Vector3::zeros());
    let p = if is_finite(&p) { p } else { Vector3::zeros() };
    let second = unit_or(&line.direction.cross(&p), || any_perpendicular(&line.direction));
    let first = second.cross(&line.direction);
    // By the tangent of half the angle from the origin's direction, from −1 to 1: cosine and sine are
    // fractions of it, to a few rounding errors.
    let towards = |tangent: T| {
        let inverse = T::one() / (T::one() + tangent * tangent);
        let (sin, cos) =
            ((tangent + tangent) * inverse, (T::one() - tangent) * (T::one() + tangent) * inverse);
        (first * cos + second * sin, second * cos - first * sin)
    };
    let rises = |tangent: T| {
        let (n, turn) = towards(tangent);
        turn.dot(&(p - support(&n).1)) > T::zero()
    };
    let (normal, _) = towards(bisected(-T::one(), T::one(), rises));
    let (height, point) = support(&normal);
    let gap = (normal.dot(&p) - height).max(T::zero()).min(T::GREATEST);
    // Where a flat or an edge is parallel to the line's shadow, the support point is one of many;
    // the one closest lies straight under the line.
    let under = p - normal * gap + line.direction * point.dot(&line.direction);
    ClosestApproach { gap, point: if is_finite(&under) { under } else { point }, normal, active: true }
}

#[cfg(test)]
mod tests {
    use crate::{ActiveSurface, Crossing, Paraboloid, Superquadric};
    use fingertip_wrench::{Line, Real};
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    fn direction<T: Real>(random: &mut Pcg64Mcg) -> Vector3<T> {
        Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize().map(T::literal)
    }

    /// Of a line above a place of a convex solid, across the normal there, that place is the nearest.
    fn told_the_place_above<T: Real>(
        surface: &impl ActiveSurface<T>,
        inside: Vector3<T>,
        random: &mut Pcg64Mcg,
    ) {
        let mut place: Option<Crossing<T>> = None;
        surface.crossings(&Line { point: inside, direction: direction(random) }, |c| place = Some(c));
        let Some(Crossing { point, normal, .. }) = place.filter(|c| c.point.amax() < T::literal(4.0)) else {
            return;
        };
        let along = normal.cross(&direction(random)).normalize();
        let gap = T::literal(10_f64.powf(random.random_range(-6.0..0.0)));
        let aside = along * T::literal(random.random_range(-1.0..1.0));
        let line = Line { point: point + normal * gap + aside, direction: along };
        let found = surface.closest_approach(&line).unwrap();
        let off = (found.gap - gap).abs();
        assert!(off <= T::EPSILON * T::literal(64.0), "{gap:?} above {point:?}: {found:?}");
    }

    fn thin_solids_are_not_missed<T: Real>() {
        let mut random = Pcg64Mcg::seed_from_u64(6);
        for trial in 0..1500 {
            let thin = [0.003, 0.02, 0.1, 0.5][trial % 4];
            let semi_axes = Vector3::new(1.0, random.random_range(0.05..1.0), thin).map(T::literal);
            let mut exponent = || T::literal(random.random_range(0.3..1.7));
            let superquadric = Superquadric::new(semi_axes, [exponent(), exponent()]).unwrap();
            told_the_place_above(&superquadric, Vector3::zeros(), &mut random);
            let paraboloid = Paraboloid::new([semi_axes.y, T::literal(thin * 10.0)]).unwrap();
            told_the_place_above(&paraboloid, Vector3::z() * T::literal(-0.2), &mut random);
        }
    }

    #[test]
    fn thin_solids_are_not_missed_in_both_precisions() {
        thin_solids_are_not_missed::<f64>();
        thin_solids_are_not_missed::<f32>();
    }
}
