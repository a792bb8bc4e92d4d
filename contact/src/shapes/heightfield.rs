//! Surfaces given by heights on a grid.

use fingertip_surfaces::Heightfield;
use fingertip_surfaces::numeric::quadratic::roots;
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::soft_finger::closed_form::is_pure_force;
use crate::{Search, SoftContact, SoftFingerSurface};

/// The soft finger on the bilinear surface that the heightfield *is*, cell by cell, as
/// [`Mesh`](fingertip_surfaces::Mesh) does it facet by facet: a contact lies inside a cell, with the normal of its
/// patch, or on a node that is the highest point of its surroundings in the direction of the normal.
/// The scan of a round pad answers as the pad up to the angle between neighbouring cells times the
/// lever arm of the spin torque. Nodes of the rim are not considered: the surface ends there.
///
/// The time is proportional to the number of cells.
impl<T: Real> SoftFingerSurface<T> for Heightfield<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let [columns, rows] = self.size();
        let force = wrench.force();
        // About the middle, so that no digits go into far-away origins.
        let middle = self.node(columns / 2, rows / 2);
        let torque = wrench.torque_about(&middle);
        // As the wrench was given, since moving it rounds.
        let power = force.dot(&wrench.torque());
        let node = |i: usize, j: usize| self.node(i, j) - middle;
        // The moment of the wrench about a line from one node to the next.
        let about = |a: &Vector3<T>, b: &Vector3<T>| torque.dot(&(b - a)) + force.dot(&a.cross(b));
        for j in 0..rows - 1 {
            for i in 0..columns - 1 {
                let corners = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
                let [a, b, c, d] = &corners;
                let sides = [about(a, b), about(d, c), about(a, d), about(b, c)];
                in_patch(&corners, sides, &force, &torque, &mut |contact| {
                    visit(SoftContact { point: contact.point + middle, ..contact });
                });
            }
        }
        if is_pure_force(&force, &wrench.torque()) {
            return Search::Complete;
        }
        let rising = power < T::zero();
        for j in 1..rows - 1 {
            for i in 1..columns - 1 {
                let here = node(i, j);
                let around = [node(i + 1, j), node(i, j + 1), node(i - 1, j), node(i, j - 1)];
                if !around.iter().all(|other| (about(&here, other) > T::zero()) != rising) {
                    continue;
                }
                let rest = torque - here.cross(&force);
                let scale = rest.amax().normalising_factor();
                let length = (rest * scale).norm_squared().root();
                let sign = if rising { T::one() } else { -T::one() };
                let normal = rest * (scale * sign / length);
                if normal.sum().is_number() && normal.z > T::zero() {
                    visit(SoftContact {
                        point: here + middle,
                        normal,
                        spin_torque: sign * (length / scale),
                        active: true,
                    });
                }
            }
        }
        Search::Complete
    }
}

/// The contacts on a bilinear patch `c(s, t)`. The moment of the wrench about the straight line of
/// the patch at `t`, `p = (m − c × f)·∂c/∂s`, does not change along that line, and that about the line
/// at `s` likewise: `m − c × f` is along the normal where both vanish, two quadratics, one in `t`, one
/// in `s`. `sides` are their values at the ends: of `p` at `t = 0, 1`, of `q` at `s = 0, 1`.
fn in_patch<T: Real>(
    [a, b, c, d]: &[Vector3<T>; 4],
    [bottom, top, left, right]: [T; 4],
    force: &Vector3<T>,
    torque: &Vector3<T>,
    visit: &mut dyn FnMut(SoftContact<T>),
) {
    let (along, across) = (b - a, d - a);
    let twist = a - b + c - d;
    let moment = |place: Vector3<T>, line: Vector3<T>| (torque - place.cross(force)).dot(&line);
    let ts = zeros(bottom, top, |t| moment(a + across * t, along + twist * t));
    if ts == [None; 2] {
        return;
    }
    let ss = zeros(left, right, |s| moment(a + along * s, across + twist * s));
    for t in ts.into_iter().flatten() {
        for s in ss.into_iter().flatten() {
            let point = a + along * s + across * t + twist * (s * t);
            let normal = (along + twist * t).cross(&(across + twist * s));
            let scale = normal.amax().normalising_factor();
            let normal = normal * (scale / (normal * scale).norm_squared().root());
            let spin_torque = moment(point, normal);
            if force.dot(&normal) < T::zero() && (point.sum() + spin_torque).is_number() {
                visit(SoftContact { point, normal, spin_torque, active: true });
            }
        }
    }
}

/// The zeros in [0, 1] of a quadratic with these values at the ends. If the ends differ in sign there
/// is one, whatever rounding does.
fn zeros<T: Real>(at_zero: T, at_one: T, f: impl Fn(T) -> T) -> [Option<T>; 2] {
    let half = T::literal(0.5);
    let two = T::one() + T::one();
    // f(x) = bend x² + 2 slope x + f(0), from the value in the middle.
    let bend = (at_zero + at_one - two * f(half)) * two;
    let slope = (at_one - at_zero - bend) * half;
    // Bernstein: between its control values a polynomial stays.
    let negative = at_zero < T::zero();
    if negative == (at_one < T::zero()) && negative == (at_zero + slope < T::zero()) {
        return [None; 2];
    }
    let found = roots(bend, slope, at_zero).unwrap_or([T::zero() / T::zero(); 2]);
    let inside = |x: T| (x >= T::zero() && x <= T::one()).then_some(x);
    if negative == (at_one < T::zero()) {
        let curved = bend.abs() > T::zero();
        return if curved { found.map(inside) } else { [None; 2] };
    }
    let [first, second] = found;
    let straight = at_zero / (at_zero - at_one);
    [inside(first).or(inside(second)).or_else(|| inside(straight)), None]
}
