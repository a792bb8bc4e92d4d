//! One contact that is followed on the surface.

use fingertip_surfaces::ActiveSurface;
use fingertip_surfaces::numeric::vectors::larger;
use fingertip_wrench::Real;
use nalgebra::{Matrix2, Vector2, Vector3};

use super::Sighting;
use super::fold::Fold;
use super::plane::{PlaneState, Weighed};
use super::retract::onto_surface;

/// A place of the surface with its tangent plane, and what is known in that plane in units of the tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Track<T: Real> {
    pub(super) point: Vector3<T>,
    pub(super) normal: Vector3<T>,
    /// Carried along without turning about the normal.
    pub(super) tangents: [Vector3<T>; 2],
    pub(super) state: PlaneState<T>,
}

/// What a sighting says to a track.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compared<T: Real> {
    weighed: Weighed<T>,
    /// From where the track expected the contact to where it was seen, along the tangents \[units\].
    pub(super) innovation: Vector2<T>,
    along: Vector3<T>,
}

impl<T: Real> Compared<T> {
    pub(super) const fn surprise(&self) -> T {
        self.weighed.surprise
    }
}

impl<T: Real> Track<T> {
    /// The first sighting; `shorter` is the reciprocal of the unit of length \[1/m\].
    pub(super) fn start(sighting: &Sighting<T>, shorter: T) -> Self {
        Self {
            point: sighting.point,
            normal: sighting.normal,
            tangents: sighting.tangents,
            state: PlaneState::first(&(sighting.covariance * (shorter * shorter))),
        }
    }

    /// What a sighting says, if the contact has moved so far \[units\] since the sample before. `None` on another
    /// side of the body, or where both are certain.
    #[inline(always)]
    pub(super) fn compare(
        &self,
        sighting: &Sighting<T>,
        moved: &Vector2<T>,
        shorter: T,
    ) -> Option<Compared<T>> {
        let fold = Fold::new(&self.normal, &sighting.normal)?;
        let seen = fold.flat(&(sighting.point - self.point)) * shorter;
        let [e1, e2] = &self.tangents;
        let innovation = Vector2::new(seen.dot(e1), seen.dot(e2)) - moved;
        // The covariance, turned from the tangents there to those here.
        let [t1, t2] = sighting.tangents.map(|t| fold.flat(&t) * shorter);
        let turn = Matrix2::new(e1.dot(&t1), e1.dot(&t2), e2.dot(&t1), e2.dot(&t2));
        let noise = turn * sighting.covariance * turn.transpose();
        let weighed = self.state.weigh(innovation, noise)?;
        Some(Compared { weighed, innovation, along: fold.along })
    }

    /// Takes a sighting that was compared, after the contact has moved so far \[units\].
    #[inline(always)]
    pub(super) fn take<S: ActiveSurface<T>>(
        &mut self,
        surface: &S,
        compared: &Compared<T>,
        moved: &Vector2<T>,
        unit: T,
    ) {
        let corrected = self.state.take(&compared.weighed);
        self.shift(surface, &(moved + corrected), &compared.along, unit);
    }

    /// Moves in the tangent plane \[units\] and back onto the surface along a direction. Where that leads nowhere
    /// it stays.
    #[inline(always)]
    pub(super) fn shift<S: ActiveSurface<T>>(
        &mut self,
        surface: &S,
        by: &Vector2<T>,
        along: &Vector3<T>,
        unit: T,
    ) {
        let [e1, e2] = &self.tangents;
        let way = (e1 * by.x + e2 * by.y) * unit;
        let beside = self.point + way;
        let size = larger(larger(beside.x.abs(), beside.y.abs()), beside.z.abs());
        // From one facet to another no farther than twice the way; the rest is rounding.
        let reach = (way.x.abs() + way.y.abs() + way.z.abs()) * T::literal(2.0)
            + size * T::EPSILON * T::literal(256.0);
        let Some((point, normal)) = onto_surface(surface, &beside, along, reach) else { return };
        let Some(fold) = Fold::new(&normal, &self.normal) else { return };
        let first = fold.flat(e1);
        // Of unit length and across the normal but for rounding, which must not add up.
        let first = first - normal * normal.dot(&first);
        let first = first * ((T::literal(3.0) - first.norm_squared()) * T::literal(0.5));
        self.tangents = [first, normal.cross(&first)];
        (self.point, self.normal) = (point, normal);
    }
}
