//! One contact that is followed on the surface.

use fingertip_surfaces::ActiveSurface;
use fingertip_surfaces::numeric::vectors::{larger, smaller};
use fingertip_wrench::{Line, Real};
use nalgebra::{Vector2, Vector3};

use super::Sighting;
use super::fold::Fold;
use super::plane::{PlaneState, Weighed};
use super::retract::{beside_the_line, onto_surface};
use super::symmetric::Symmetric;

/// A place of the surface with its tangent plane, and what is known in that plane in units of the tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Track<T: Real> {
    pub(super) point: Vector3<T>,
    pub(super) normal: Vector3<T>,
    /// Carried along without turning about the normal.
    pub(super) tangents: [Vector3<T>; 2],
    pub(super) state: PlaneState<T>,
}

/// A sighting in its own tangents, in units of the tracker.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<T: Real> {
    point: Vector3<T>,
    normal: Vector3<T>,
    tangents: [Vector3<T>; 2],
    noise: Symmetric<T>,
}

impl<T: Real> Seen<T> {
    /// `shorter` is the reciprocal of the unit of length \[1/m\].
    ///
    /// Inlined, and each number by itself: or what is usual would go through the memory that this is asked in.
    #[inline(always)]
    pub(super) fn new(sighting: &Sighting<T>, shorter: T) -> Self {
        let tangents = sighting.tangents();
        let noise = sighting.along(&tangents, shorter * shorter).at_least([T::zero(); 2]);
        Self { point: sighting.point, normal: sighting.normal, tangents, noise }
    }

    /// Sum of the variances \[units\].
    pub(super) fn variance(&self) -> T {
        self.noise.trace()
    }
}

/// What a sighting says to a track.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compared<T: Real> {
    /// What is known by then, and how far the contact has moved since the sample before, if it goes on as it did
    /// \[units\].
    state: PlaneState<T>,
    moved: Vector2<T>,
    weighed: Weighed<T>,
    /// From where the track expected the contact to where it was seen, along the tangents \[units\].
    pub(super) innovation: Vector2<T>,
    /// The direction along which the track is brought back onto the surface.
    along: Vector3<T>,
}

impl<T: Real> Compared<T> {
    #[inline(always)]
    pub(super) const fn surprise(&self) -> T {
        self.weighed.surprise
    }

    /// Sum of the variances of the sighting \[units\].
    #[inline(always)]
    pub(super) fn variance(&self) -> T {
        self.weighed.noise.trace()
    }
}

impl<T: Real> Track<T> {
    /// The first sighting.
    pub(super) fn start(seen: &Seen<T>) -> Self {
        let Seen { point, normal, tangents, noise } = *seen;
        Self { point, normal, tangents, state: PlaneState::first(noise) }
    }

    /// What a sighting says after a time \[units\]. `None` on another side of the body, or where both are certain.
    #[inline(always)]
    pub(super) fn compare(&self, sighting: &Sighting<T>, time: T, shorter: T) -> Option<Compared<T>> {
        let noise = |tangents: &_| sighting.along(tangents, shorter * shorter);
        self.weigh(&sighting.point, &sighting.normal, noise, time, shorter)
    }

    /// The same of one in its own tangents.
    pub(super) fn compare_seen(&self, seen: &Seen<T>, time: T, shorter: T) -> Option<Compared<T>> {
        let noise = |[e1, e2]: &[Vector3<T>; 2]| {
            let first = &seen.tangents[0];
            seen.noise.turned(&Vector2::new(e1.dot(first), e2.dot(first)))
        };
        self.weigh(&seen.point, &seen.normal, noise, time, shorter)
    }

    #[inline(always)]
    fn weigh(
        &self,
        point: &Vector3<T>,
        normal: &Vector3<T>,
        noise: impl FnOnce(&[Vector3<T>; 2]) -> Symmetric<T>,
        time: T,
        shorter: T,
    ) -> Option<Compared<T>> {
        let fold = Fold::new(&self.normal, normal)?;
        let noise = noise(&fold.carried(&self.tangents));
        let (state, moved) = self.state.wait(time);
        let innovation = fold.along(&self.tangents)(&(point - self.point)) * shorter - moved;
        let weighed = state.weigh(&innovation, noise)?;
        Some(Compared { state, moved, weighed, innovation, along: fold.direction() })
    }

    /// Takes a sighting that was compared. `None` if a number is none then.
    #[inline(always)]
    pub(super) fn take<S: ActiveSurface<T>>(
        &mut self,
        surface: &S,
        compared: &Compared<T>,
        unit: T,
    ) -> Option<()> {
        let (state, corrected, sound) = compared.state.with(&compared.weighed);
        self.state = state;
        if !sound {
            // No more is left of the position than either of the two says. Rounding may leave less than no noise.
            let (before, noise) = (&compared.state, &compared.weighed.noise);
            let least = |known, said| larger(smaller(known, said), T::zero());
            self.state.mend(
                [least(before.positions.xx, noise.xx), least(before.positions.yy, noise.yy)],
                [before.velocities.xx, before.velocities.yy],
            )?;
        }
        self.shift(surface, &(compared.moved + corrected), &compared.along, unit);
        Some(())
    }

    /// Without a sighting: moves as far as is expected \[units\].
    #[inline(never)]
    pub(super) fn move_on<S: ActiveSurface<T>>(
        &mut self,
        surface: &S,
        (state, moved): (PlaneState<T>, Vector2<T>),
        unit: T,
    ) {
        let along = self.normal;
        self.state = state;
        self.shift(surface, &moved, &along, unit);
    }

    /// Moves in the tangent plane \[units\] and back onto the surface along a unit vector. Where that leads nowhere
    /// it stays.
    #[inline(always)]
    fn shift<S: ActiveSurface<T>>(&mut self, surface: &S, by: &Vector2<T>, along: &Vector3<T>, unit: T) {
        let [e1, e2] = &self.tangents;
        let way = e1 * (by.x * unit) + e2 * (by.y * unit);
        let beside = self.point + way;
        // From one facet to another no farther than twice the way; the rest is rounding.
        let size = |v: &Vector3<T>| v.x.abs() + v.y.abs() + v.z.abs();
        let reach = size(&way) * T::literal(2.0) + size(&beside) * (T::EPSILON * T::literal(256.0));
        let line = Line { point: beside, direction: *along };
        match onto_surface(surface, &line, reach) {
            Some((point, normal)) => self.settle(point, normal),
            None => self.settle_beside(surface, line, reach),
        }
    }

    /// Past an end or an edge.
    #[cold]
    #[inline(never)]
    fn settle_beside<S: ActiveSurface<T>>(&mut self, surface: &S, line: Line<T>, reach: T) {
        if let Some((point, normal)) = beside_the_line(surface, line, reach) {
            self.settle(point, normal);
        }
    }

    /// Moves to a place of the surface, and carries the tangents along.
    #[inline(always)]
    fn settle(&mut self, point: Vector3<T>, normal: Vector3<T>) {
        let Some(fold) = Fold::new(&normal, &self.normal) else { return };
        // Across the normal however it was rounded before; of unit length but for rounding, which must not add up.
        let first = fold.flat(&self.tangents[0]);
        let first = first * (T::literal(1.5) - first.norm_squared() * T::literal(0.5));
        self.tangents = [first, normal.cross(&first)];
        (self.point, self.normal) = (point, normal);
    }
}
