//! A soft contact to the last digit.

use core::mem::discriminant;

use fingertip_surfaces::LocalSurface;
use fingertip_surfaces::numeric::mixed_precision::is_refined_in_double;
use fingertip_surfaces::numeric::twofold::{Twofold, Wide};
use fingertip_surfaces::numeric::vectors::{larger, wide};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::mended::mended;
use super::patch::{Behind, Digits, Seen, Three, Way, cross, exactly, plus_times, rounded};
use super::placed::Patch;
use crate::model::flat;
use crate::{SoftContact, SoftFingerSurface};

/// Steps at most. From where rounding leaves a contact, two or three are enough, and one for each seam.
const STEPS: usize = 16;

/// At flatter angles of incidence, `32√ε` of double precision, in which the steps are taken, two solutions
/// are as good as one.
const FLATTEST: f64 = 4.768_371_582_031_25e-7;

/// What a surface is at a point ([`SoftFingerSurface::patch`]).
pub(crate) type PartAt<'a, T> = &'a dyn Fn(&Vector3<T>) -> Option<Patch>;

/// The solution of the soft-finger equations next to a contact that is off by rounding errors.
///
/// Rounding of the closed forms, and of Newton's last step, leaves a torque `r = m − c × f − τ n` and a
/// height above the surface. The contact answers to them with up to the reciprocal cosine of incidence
/// where the force meets the surface at a flat angle, and with the square of `τ/(R f·n)` where the surface
/// is straight one way and the spin torque large: at a spin torque of 1e4 `f R` that is more than single
/// precision has digits. The wrench itself is exact for all that its numbers say. So both are found with
/// twice the digits, from what the surface is to the last one ([`SoftFingerSurface::patch`]), and steps of
/// Newton's method take them away from a contact that is carried with twice the digits too: iterative
/// refinement. What is left is the rounding of the result. On a surface that does not tell what it is,
/// only what a flat angle does is undone ([`mended`]); so in single precision without the feature `mixed-precision`.
///
/// A contact at an edge or a tip keeps its place, since its normal is not the surface's there. One that
/// would move further than rounding explains is left as it is. The derivative of a dual number is that of
/// the contact before.
#[cold]
#[inline(never)]
pub(crate) fn refined<T: Real, S: SoftFingerSurface<T>>(
    wrench: &Wrench<T>,
    surface: &S,
    contact: &SoftContact<T>,
) -> SoftContact<T> {
    if !is_refined_in_double::<T>() {
        return mended(wrench, surface, contact);
    }
    match surface.patch(&contact.point) {
        Some(Patch { surface: LocalSurface::Facets, .. }) => *contact,
        Some(patch) => refined_on(wrench, &patch, &|point| surface.patch(point), contact),
        None => mended(wrench, surface, contact),
    }
}

/// The same on a surface that tells what it is. Compiled once for all of them: what differs is only what
/// they answer.
#[inline(never)]
fn refined_on<T: Real>(
    wrench: &Wrench<T>,
    patch: &Patch,
    patch_at: PartAt<'_, T>,
    contact: &SoftContact<T>,
) -> SoftContact<T> {
    let epsilon = T::EPSILON.to_f64();
    let (scale, load) = scaled(wrench);
    let [f, m] = load;
    let (point, normal) = (wide(&contact.point), wide(&contact.normal));
    let torque = contact.spin_torque.to_f64() * scale;
    let (strength, reach) = (f.norm(), point.amax());
    let incidence = -f.dot(&normal) / strength;
    let Seen { normal: start, curvatures, .. } = patch.seen::<f64>(point.into());
    let steepest = larger(curvatures[0].abs(), curvatures[1].abs());
    let spin = torque.abs();
    // Neither a flat angle nor spin torque nor a fold multiplies rounding by more than eight.
    let [answer, stiffness] = answers(curvatures, spin, strength, incidence);
    let steady = incidence >= flat() && spin <= strength * reach && answer * stiffness <= 8.0;
    // The normal of a place that is known to some units in the last place.
    let known = 64.0 * epsilon * (1.0 + steepest * reach);
    if steady || !(incidence >= FLATTEST) || !((Vector3::from(start) - normal).amax() <= known) {
        return *contact;
    }
    let allowed = |answers| rounding_moves(epsilon, reach, m.amax(), answers);
    let start = (point, torque);
    // Of a type that is narrow enough for it double precision has digits to spare.
    let spare = f64::EPSILON * (m.amax() + reach * stiffness) * answer <= 0.02 * epsilon * reach;
    let found = if spare {
        solve::<f64, T>(load, patch_at, start, Start::Rounded)
    } else {
        solve::<Twofold<f64>, T>(load, patch_at, start, Start::Rounded)
    };
    match found {
        // Nor does rounding lead over an edge, as from the side of a closed cylinder to its end.
        Some(end) if f.dot(&end.normal) < 0.0 && end.flat == is_flat(patch) => {
            // From a seam it leads as far as the part lets it on which the contact is.
            let there = answers(end.curvatures, end.spin.abs(), strength, -f.dot(&end.normal) / strength);
            let most = larger(allowed([answer, stiffness]), allowed(there));
            if (end.point - point).amax() <= most { end.renews(contact, scale) } else { *contact }
        }
        _ => *contact,
    }
}

/// How far rounding of a few terms of the size of the torque moves a contact, as `answers` says, at this distance.
pub(super) fn rounding_moves(epsilon: f64, reach: f64, torque: f64, [answer, stiffness]: [f64; 2]) -> f64 {
    64.0 * epsilon * (reach + (torque + reach * stiffness) * answer)
}

/// How far a torque moves a contact at most, and what the torques of the equations are per length of which a place is
/// known: that of the force, and that of the normal's turn.
pub(super) fn answers(curvatures: [f64; 2], spin: f64, strength: f64, incidence: f64) -> [f64; 2] {
    let steepest = larger(curvatures[0].abs(), curvatures[1].abs());
    let [w1, w2] = curvatures.map(|k| spin * k);
    let pressing = strength * incidence;
    let determinant = w1 * w2 + pressing * pressing;
    let stiffness = strength + spin * steepest;
    [larger(spin * steepest, strength) / determinant.abs(), stiffness]
}

/// The same from a contact that is only near: for where rounding keeps Newton's method from settling, as next
/// to a tip. `None` unless the equations hold, and the force presses; and in single precision without the feature
/// `mixed-precision`.
#[cold]
#[inline(never)]
pub(crate) fn settled<T: Real>(
    wrench: &Wrench<T>,
    patch_at: PartAt<'_, T>,
    contact: &SoftContact<T>,
) -> Option<SoftContact<T>> {
    if !is_refined_in_double::<T>() {
        return None;
    }
    let (scale, load) = scaled(wrench);
    let start = (wide(&contact.point), contact.spin_torque.to_f64() * scale);
    let end = solve::<Twofold<f64>, T>(load, patch_at, start, Start::Near)?;
    (load[0].dot(&end.normal) < 0.0).then(|| end.renews(contact, scale))
}

/// A factor, and force and torque times that.
pub(super) fn scaled<T: Real>(wrench: &Wrench<T>) -> (f64, [Vector3<f64>; 2]) {
    let scale = wide(&wrench.force()).amax().normalising_factor();
    (scale, [wide(&wrench.force()) * scale, wide(&wrench.torque()) * scale])
}

/// What the steps lead to.
struct End {
    point: Vector3<f64>,
    normal: Vector3<f64>,
    spin: f64,
    curvatures: [f64; 2],
    flat: bool,
}

/// Whether the surface is a plane there.
fn is_flat(patch: &Patch) -> bool {
    matches!(patch.surface, LocalSurface::Plane { .. })
}

impl End {
    fn renews<T: Real>(&self, contact: &SoftContact<T>, scale: f64) -> SoftContact<T> {
        SoftContact {
            point: contact.point.zip_map(&self.point, renewed),
            normal: contact.normal.zip_map(&self.normal, renewed),
            spin_torque: renewed(contact.spin_torque, self.spin / scale),
            ..*contact
        }
    }
}

/// Another value, with the derivative that the one before has if it is a dual number.
pub(crate) fn renewed<T: Real>(before: T, now: f64) -> T {
    T::literal(now) + (before - T::literal(before.to_f64()))
}

/// What the steps begin with.
#[derive(Clone, Copy, PartialEq)]
enum Start {
    /// The solution but for rounding.
    Rounded,
    /// Only near.
    Near,
}

/// From a point and a spin torque, those of the solution.
///
/// From a solution that is rounded to the wrong side of an open seam the steps lead away: one on the neighbour is no
/// shorter than the one before, and the solution is left as it is.
///
/// Where the curvature jumps, whole steps may lead to and fro. So one that leaves a part of the surface ends
/// on the seam, and the next goes on from there with the curvature of the neighbour: since the determinant
/// has the same sign on both, it leads into it, and no part is met twice on the way to a contact that the
/// equations say linearly (Katzenelson 1965).
fn solve<W: Wide, T: Real>(
    [f, m]: [Vector3<f64>; 2],
    patch_at: PartAt<'_, T>,
    (start, torque): (Vector3<f64>, f64),
    kind: Start,
) -> Option<End> {
    let (mut point, mut spin): (Three<W>, W) = (exactly(&start), W::exactly(torque));
    let patch_at = |point: Vector3<f64>| patch_at(&point.map(T::literal));
    let mut patch = patch_at(start)?;
    let (mut before, mut crossed) = (f64::MAX, false);
    // Under a torque that is next to a normal of the side, even the rounding of twice the digits moves the contact.
    let most = if kind == Start::Near { 4096.0 } else { 16.0 };
    for taken in 0..STEPS {
        let seen = patch.seen(point);
        let arm = cross(point, exactly(&f));
        let left = plus_times(exactly(&m), arm, W::exactly(-1.0));
        let left = rounded(plus_times(left, seen.normal, W::exactly(0.0).minus(spin)));
        let (n, e1, outside) = (rounded(seen.normal), seen.around, seen.height.rounded());
        // Along the lines of curvature the matrix `τ EᵀWE + (f·n) J₂` is as the curvatures say, and the
        // straight way stays apart from the other.
        let e2 = n.cross(&e1);
        let turned = left + n.cross(&f) * outside;
        let (r1, r2, pressing) = (e1.dot(&turned), e2.dot(&turned), f.dot(&n));
        let [w1, w2] = seen.curvatures.map(|k| spin.rounded() * k);
        let determinant = w1 * w2 + pressing * pressing;
        let a1 = (w2 * r1 - pressing * r2) / determinant;
        let a2 = (w1 * r2 + pressing * r1) / determinant;
        let way = e1 * a1 + e2 * a2 - n * outside;
        let twist = n.dot(&(left - way.cross(&f)));
        let size = way.amax();
        if !size.is_finite() {
            return None;
        }
        let leads = patch.left_by(point, &way);
        let share = W::exactly(if let Way::Leaves(share, _) = leads { share } else { 1.0 });
        point = plus_times(point, exactly(&way), share);
        spin = spin.plus(W::exactly(twist).times(share));
        let fine = T::EPSILON.to_f64() * 0.03 * rounded(point).amax();
        // As far as digits of the result go; a step that grows no shorter is what rounding leaves.
        if size <= fine || (taken >= 4 && size <= most * fine && size + size >= before) {
            let Seen { normal, curvatures, .. } = patch.seen(point);
            let (point, normal, spin) = (rounded(point), rounded(normal), spin.rounded());
            return Some(End { point, normal, spin, curvatures, flat: is_flat(&patch) });
        }
        // A step on another part that is no shorter than the one that led there leads away.
        if crossed && kind == Start::Rounded && size + size > before {
            return None;
        }
        before = size;
        patch = match leads {
            Way::Stays => patch,
            Way::Open => {
                let here = patch_at(rounded(point))?;
                crossed = discriminant(&here.surface) != discriminant(&patch.surface);
                here
            }
            Way::Leaves(_, Behind::Part(neighbour)) => Patch { surface: neighbour, ..patch },
            Way::Leaves(_, Behind::Height(z)) => {
                let beyond = Vector3::new(0.0, 0.0, z);
                patch_at(patch.pose.map_or(beyond, |pose| pose.transform_point(&beyond)))?
            }
        };
    }
    None
}
