//! Newton's method for the soft-finger equations on a smooth surface.

use fingertip_surfaces::numeric::vectors::{larger, tangents};
use fingertip_surfaces::{Extent, SmoothSurface};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::SoftContact;

/// The soft-finger problem in the units of the surface: lengths from the centre of its extent, in
/// its radius; force and torque such that the larger is near 1.
pub(crate) struct Problem<'a, T: Real, S> {
    surface: &'a S,
    centre: Vector3<T>,
    length: T,
    /// Radius of the extent, in its own units: from 1 to 2.
    pub(crate) reach: T,
    wrench_unit: T,
    pub(crate) force: Vector3<T>,
    pub(crate) torque: Vector3<T>,
    /// `f·m`, which every solution shares.
    pub(crate) power: T,
}

/// The surface at a point, in the units of the problem.
#[derive(Clone, Copy)]
pub(crate) struct Place<T: Real> {
    pub(crate) point: Vector3<T>,
    pub(crate) normal: Vector3<T>,
    /// Distance from the surface, to first order.
    pub(crate) height: T,
    /// Two unit vectors that span the tangent plane, `first × second = normal`.
    first: Vector3<T>,
    second: Vector3<T>,
    /// `H first/|g|`, `H second/|g|`.
    bend_first: Vector3<T>,
    bend_second: Vector3<T>,
}

impl<T: Real> Place<T> {
    /// The largest curvature, but for a factor of two.
    fn bend(&self) -> T {
        larger(self.bend_first.amax(), self.bend_second.amax())
    }
}

/// An approximate solution.
#[derive(Clone, Copy)]
pub(crate) struct State<T: Real> {
    pub(crate) place: Place<T>,
    pub(crate) spin: T,
    residual: Vector3<T>,
    merit: T,
    /// The residual is rounding, and so is the distance from the surface.
    pub(crate) converged: bool,
}

impl<'a, T: Real, S: SmoothSurface<T>> Problem<'a, T, S> {
    /// For a finite wrench whose force is not zero.
    pub(crate) fn new(surface: &'a S, force: &Vector3<T>, torque: &Vector3<T>) -> Self {
        let extent = surface.extent();
        Self::with_extent(surface, &extent, force, &(torque - extent.centre.cross(force)))
    }

    /// With units from a given extent, and the torque about its centre.
    pub(crate) fn with_extent(
        surface: &'a S,
        extent: &Extent<T>,
        force: &Vector3<T>,
        torque: &Vector3<T>,
    ) -> Self {
        let unit = extent.radius.normalising_factor();
        let lever = torque * unit;
        let wrench_unit = force.amax().max(lever.amax()).normalising_factor();
        let (force, torque) = (force * wrench_unit, lever * wrench_unit);
        let power = force.dot(&torque);
        Self {
            surface,
            centre: extent.centre,
            length: T::one() / unit,
            reach: extent.radius * unit,
            wrench_unit,
            force,
            torque,
            power,
        }
    }

    /// How far the sensor's origin is from that of the problem.
    pub(crate) fn arm(&self) -> T {
        self.centre.amax() / self.length
    }

    /// From the sensor frame.
    pub(crate) fn inward(&self, point: &Vector3<T>) -> Vector3<T> {
        (point - self.centre) / self.length
    }

    /// To the sensor frame.
    pub(crate) fn outward(&self, point: &Vector3<T>) -> Vector3<T> {
        self.centre + point * self.length
    }

    pub(crate) fn contact(&self, state: &State<T>) -> SoftContact<T> {
        SoftContact {
            point: self.outward(&state.place.point),
            normal: state.place.normal,
            spin_torque: state.spin * self.length / self.wrench_unit,
            active: true,
        }
    }

    #[inline]
    pub(crate) fn place(&self, point: Vector3<T>) -> Option<Place<T>> {
        let level = self.surface.level(&self.outward(&point));
        let (normal, steepness) = level.normal()?;
        let (first, second) = tangents(&normal);
        let bend = self.length / steepness;
        let place = Place {
            point,
            normal,
            height: level.value / (steepness * self.length),
            first,
            second,
            bend_first: level.hessian * first * bend,
            bend_second: level.hessian * second * bend,
        };
        (place.height + place.bend_first.sum() + place.bend_second.sum()).is_number().then_some(place)
    }

    /// `det J` of `docs/theory/contact.md#general-surfaces`, in these units and without its negative factor:
    /// `τ²κ + (f·n)²`. Its sign is the index of the solution; zero is a fold, where two solutions merge.
    pub(crate) fn determinant(&self, state: &State<T>) -> T {
        let (place, pressing) = (&state.place, self.force.dot(&state.place.normal));
        let (w11, w22) = (place.first.dot(&place.bend_first), place.second.dot(&place.bend_second));
        let w12 = place.first.dot(&place.bend_second);
        state.spin * state.spin * (w11 * w22 - w12 * w12) + pressing * pressing
    }

    #[inline]
    pub(crate) fn state(&self, place: Place<T>, spin: T, torque: &Vector3<T>) -> State<T> {
        let residual = place.normal * spin + place.point.cross(&self.force) - torque;
        let merit = residual.norm_squared() + place.height * place.height;
        State { place, spin, residual, merit, converged: false }
    }

    /// The Newton step in point and spin torque.
    ///
    /// The four equations `τ n + c × f = m`, `S(c) = 0` of Bicchi, Salisbury & Brock, taken apart
    /// along the normal and the tangent plane: `n·dc = −S/|g|`, then two equations in the plane
    /// with the matrix `τ W + (f·n) J₂`, then `dτ` from the normal one. The determinant is that of
    /// `docs/theory/contact.md#general-surfaces`. Second derivatives enter as `dn = (I − nnᵀ) H dc/|g|`.
    #[inline]
    fn step(&self, state: &State<T>) -> Option<(Vector3<T>, T)> {
        let place = &state.place;
        let (e1, e2, n) = (place.first, place.second, place.normal);
        let (tau, f) = (state.spin, &self.force);
        let drop = -place.height;
        // H is symmetric: e·H n = n·H e.
        let bend_normal = (place.bend_first.dot(&n), place.bend_second.dot(&n));
        let turned = n.cross(f) * drop + state.residual;
        let r1 = -(e1.dot(&turned) + tau * bend_normal.0 * drop);
        let r2 = -(e2.dot(&turned) + tau * bend_normal.1 * drop);
        let pressing = f.dot(&n);
        let (w11, w22) = (tau * e1.dot(&place.bend_first), tau * e2.dot(&place.bend_second));
        let w12 = tau * e1.dot(&place.bend_second);
        let determinant = w11 * w22 - w12 * w12 + pressing * pressing;
        let a1 = (w22 * r1 - (w12 + pressing) * r2) / determinant;
        let a2 = (w11 * r2 - (w12 - pressing) * r1) / determinant;
        let shift = e1 * a1 + e2 * a2 + n * drop;
        let twist = -n.dot(&(state.residual + shift.cross(f)));
        (shift.sum() + twist).is_number().then_some((shift, twist))
    }

    /// Damped Newton from a start, for the torque `torque` instead of the problem's own; at most
    /// `bound` steps. Each step is halved until the residual falls, or the next step would. However
    /// short the last one was, it ends only where the equations hold.
    pub(crate) fn newton(
        &self,
        start: Place<T>,
        spin: T,
        torque: &Vector3<T>,
        bound: u32,
    ) -> Option<State<T>> {
        let half = T::literal(0.5);
        let fine = T::EPSILON.root();
        let mut state = self.state(start, spin, torque);
        let mut before = T::GREATEST;
        for _ in 0..bound {
            let (mut shift, mut twist) = self.step(&state)?;
            let mut size = shift.amax();
            if size > half {
                let shorter = half / size;
                shift *= shorter;
                twist *= shorter;
                size = half;
            }
            let small = size <= fine;
            // Near its end the step shrinks to `C·size²`; the last two tell `C`. So one step more
            // than needed is saved where Newton's method converges as it should.
            let quadratic = size <= before * before * T::literal(4.0) && before < T::one();
            let last = small && (quadratic || size <= fine * T::literal(0.01) || size + size >= before);
            before = size;
            let height = state.place.height.abs();
            let mut tries = 6;
            state = loop {
                let next = self
                    .place(state.place.point + shift)
                    .map(|place| self.state(place, state.spin + twist, torque));
                match next {
                    Some(next)
                        if small || next.merit < state.merit || self.brings_nearer(&state, &next, &shift) =>
                    {
                        break next;
                    }
                    _ if tries == 0 => return self.settled(state),
                    _ => {
                        tries -= 1;
                        shift *= half;
                        twist *= half;
                    }
                }
            };
            if last && self.has_ended(&state, size, height) {
                state.converged = true;
                return Some(state);
            }
        }
        self.settled(state).or(Some(state))
    }

    /// What rounding leaves of a torque and of a height at a solution.
    ///
    /// `τ n`, `c × f` and `m` are of the size of the first two, and each is the result of up to four
    /// roundings in what the equations are made of and four in how they are evaluated, in every one of
    /// two places, here and in the wrench. A point that is known to `ε|c|` knows its normal to `ε|c||W|`,
    /// which the torque sees times `τ`: most of it on a needle under a large spin torque.
    fn rounding(&self, state: &State<T>) -> (T, T) {
        let place = &state.place;
        let arm = place.point.amax() + self.arm();
        let turn = T::one() + place.bend() * arm;
        let hair = T::literal(16.0) * T::EPSILON;
        (hair * (arm * self.force.amax() + state.spin.abs() * turn), hair * arm)
    }

    /// `true` if a last step of this size, from this height, has left nothing but rounding. How well a
    /// level function rounds is its own affair: a height that falls no more, and that the bend of the
    /// surface along the step does not explain, is rounding too.
    fn has_ended(&self, state: &State<T>, size: T, before: T) -> bool {
        let (torque, height) = self.rounding(state);
        let left = state.place.height.abs();
        let noise = left + left >= before && left > state.place.bend() * size * size;
        state.residual.amax() <= torque && (left <= height || noise)
    }

    /// `true` if a contact solves the equations up to rounding.
    pub(crate) fn explains(&self, contact: &SoftContact<T>) -> bool {
        self.place(self.inward(&contact.point)).is_some_and(|place| {
            let spin = contact.spin_torque * self.wrench_unit / self.length;
            self.settled(self.state(place, spin, &self.torque)).is_some()
        })
    }

    /// A state whose residual is rounding: no step makes it smaller, however far steps lead. So it is
    /// where a large spin torque meets a surface that is straight one way, as a slender cone, and the
    /// contact answers to the rounding of the torque `τ n` with more than the step that counts as small.
    #[cold]
    fn settled(&self, state: State<T>) -> Option<State<T>> {
        let (torque, height) = self.rounding(&state);
        let settled = state.residual.amax() <= torque && state.place.height.abs() <= height;
        settled.then_some(State { converged: true, ..state })
    }

    /// The natural test of a step (Deuflhard 1974): the step that would follow with the same Jacobian
    /// is no more than half as long. Where the surface is sharply bent one way and straight the other,
    /// as near the tip of a cone under a large spin torque, the residual says nothing of how far off the
    /// contact is along the straight way, and may rise on the way to it.
    #[cold]
    fn brings_nearer(&self, state: &State<T>, next: &State<T>, shift: &Vector3<T>) -> bool {
        let place = Place { height: next.place.height, ..state.place };
        let mixed = State { place, residual: next.residual, ..*state };
        self.step(&mixed).is_some_and(|(left, _)| left.amax() * (T::one() + T::one()) < shift.amax())
    }

    /// A contact that is right but for rounding, after a few steps of Newton's method.
    pub(crate) fn polished(&self, contact: &SoftContact<T>) -> Option<SoftContact<T>> {
        let place = self.place(self.inward(&contact.point))?;
        let spin = contact.spin_torque * self.wrench_unit / self.length;
        let state = self.newton(place, spin, &self.torque, 6)?;
        (state.converged && self.presses(&state)).then(|| self.contact(&state))
    }

    /// The spin torque that the force's component along the wrench asks for at a place,
    /// `f·m/f·n`, if it presses there.
    #[inline]
    pub(crate) fn spin_at(&self, place: &Place<T>) -> Option<T> {
        let pressing = -self.force.dot(&place.normal);
        let spin = -self.power / pressing;
        (pressing > T::zero() && spin.is_number()).then_some(spin)
    }

    /// `true` if the force presses there, by more than rounding can turn round.
    #[inline]
    pub(crate) fn presses(&self, state: &State<T>) -> bool {
        // Along the solution f·m = τ f·n holds exactly: the sign of τ tells as well as f·n does,
        // and better where the force grazes.
        let hair = T::EPSILON * T::literal(16.0) * self.force.amax();
        if self.power.abs() > hair {
            (state.spin > T::zero()) != (self.power > T::zero())
        } else {
            // A pure force that misses solves the equations where it would only graze.
            self.force.dot(&state.place.normal) < -hair
        }
    }
}
