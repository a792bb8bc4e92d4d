//! Two tangent planes laid flat.

use fingertip_wrench::Real;
use nalgebra::{Vector2, Vector3};

/// The tangent plane at one place of a surface, folded flat into that at another.
///
/// With unit normals `n` here and `n'` there, a vector `w` becomes `w − (n + n') (n·w)/(1 + n·n')`
/// (`docs/theory/contact.md#tracking`). A tangent vector from there is turned as little as brings it into the
/// plane here, and keeps its length. A displacement from a point here to one there becomes the way along the
/// two planes: of facets that meet in an edge exactly, of a sphere of radius `R` with the angle `θ` between the
/// normals `2R tan(θ/2)`, which is the arc but for a share of `θ²/12`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fold<T: Real> {
    here: Vector3<T>,
    /// `n + n'`.
    along: Vector3<T>,
    scale: T,
}

impl<T: Real> Fold<T> {
    /// `None` where the planes look nearly opposite ways: more than 151° apart.
    #[inline(always)]
    pub(super) fn new(here: &Vector3<T>, there: &Vector3<T>) -> Option<Self> {
        let sum = T::one() + here.dot(there);
        (sum >= T::literal(0.125)).then(|| Self { here: *here, along: here + there, scale: T::one() / sum })
    }

    #[inline(always)]
    pub(super) fn flat(&self, w: &Vector3<T>) -> Vector3<T> {
        w - self.along * (self.here.dot(w) * self.scale)
    }

    /// [`flat`](Self::flat), told along two tangents of the plane here.
    #[inline(always)]
    pub(super) fn along(&self, [e1, e2]: &[Vector3<T>; 2]) -> impl Fn(&Vector3<T>) -> Vector2<T> {
        let (here, e1, e2) = (self.here, *e1, *e2);
        let (lean1, lean2) = (e1.dot(&self.along) * self.scale, e2.dot(&self.along) * self.scale);
        move |w| {
            let height = here.dot(w);
            Vector2::new(e1.dot(w) - lean1 * height, e2.dot(w) - lean2 * height)
        }
    }

    /// Tangents here, brought into the plane there.
    #[inline(always)]
    pub(super) fn carried(&self, tangents: &[Vector3<T>; 2]) -> [Vector3<T>; 2] {
        tangents.map(|e| e - self.along * (e.dot(&self.along) * self.scale))
    }

    /// The direction along which the one plane maps onto the other: of `n + n'`, of which the square is
    /// `2 (1 + n·n')`.
    #[inline(always)]
    pub(super) fn direction(&self) -> Vector3<T> {
        self.along * (self.scale * T::literal(0.5)).root()
    }
}

#[cfg(test)]
mod tests {
    use super::Fold;
    use nalgebra::{Rotation3, Unit, Vector3};
    use proptest::prelude::*;

    proptest! {
        /// Points on two facets: the displacement becomes the way over the edge.
        #[test]
        fn facets_unfold_to_their_length(
            angle in -2.5..2.5, before in 0.0..3.0, beyond in 0.0..3.0, along in -2.0..2.0,
        ) {
            let (normal, edge) = (Vector3::z(), Vector3::<f64>::y());
            let turn = Rotation3::from_axis_angle(&Unit::new_unchecked(edge), angle);
            let there = turn * normal;
            let fold = Fold::new(&normal, &there).unwrap();
            let way = Vector3::x() * before + turn * Vector3::x() * beyond + edge * along;
            let exact = Vector3::new(before + beyond, along, 0.0);
            prop_assert!((fold.flat(&way) - exact).norm() < 1e-13);
        }

        /// Tangents from there are turned about the line that both planes share, as a rotation does it.
        #[test]
        fn tangents_keep_length_and_turn_as_little_as_can_be(angle in -2.5..2.5, x in -1.0..1.0, y in -1.0..1.0) {
            let axis = Unit::new_normalize(Vector3::new(0.3, -0.8, 0.0_f64));
            let turn = Rotation3::from_axis_angle(&axis, angle);
            let tangent = Vector3::new(x, y, 0.0);
            let fold = Fold::new(&Vector3::z(), &(turn * Vector3::z())).unwrap();
            prop_assert!((fold.flat(&(turn * tangent)) - tangent).norm() < 1e-13);
            let axes = [Vector3::x(), Vector3::y()];
            prop_assert!((fold.along(&axes)(&(turn * tangent)) - tangent.xy()).norm() < 1e-13);
            let carried = fold.carried(&axes);
            prop_assert!((carried[0] - turn * axes[0]).norm() < 1e-13 && (carried[1] - turn * axes[1]).norm() < 1e-13);
            let direction = fold.direction();
            prop_assert!((direction.norm() - 1.0).abs() < 1e-13);
            prop_assert!((turn * tangent - tangent).cross(&direction).norm() < 1e-13);
        }
    }

    #[test]
    fn opposite_sides_are_not_neighbours() {
        assert!(Fold::new(&Vector3::z(), &-Vector3::<f64>::z()).is_none());
        assert!(Fold::new(&Vector3::z(), &Vector3::repeat(f64::NAN)).is_none());
        let beside = Vector3::new((151.0_f64).to_radians().sin(), 0.0, (151.0_f64).to_radians().cos());
        assert!(Fold::new(&Vector3::z(), &beside).is_some());
        let behind = Vector3::new((151.1_f64).to_radians().sin(), 0.0, (151.1_f64).to_radians().cos());
        assert!(Fold::new(&Vector3::z(), &behind).is_none());
    }
}
