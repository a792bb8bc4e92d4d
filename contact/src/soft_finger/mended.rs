//! What rounding did to a soft contact that the force meets at a flat angle, undone.

use fingertip_surfaces::ActiveSurface;
use fingertip_surfaces::numeric::twofold::Twofold;
use fingertip_surfaces::numeric::vectors::{larger, largest, tangents};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::SoftContact;
use crate::model::{flat, normal_at, outside_by, torque_left};

/// The solution of the soft-finger equations next to a contact that is off by rounding errors.
///
/// Rounding of the closed forms, and of Newton's last step, leaves a torque `r = m − c × f − τ n` and a
/// height `e` above the surface. Where the force is nearly square to the normal the contact answers to
/// them with up to the reciprocal cosine of incidence: a rounding error at a cosine of 0.05 is one of
/// twenty. Both are found here with twice the digits ([`Shortcuts::surface_residual`] for `e`), and steps
/// of Newton's method take them away, so that of the last step's own error that factor is all that is left.
/// The steps need not be exact: the curvature comes from differences of the normal.
///
/// A contact at an edge or a tip keeps its place, since its normal is not the surface's there; so does
/// one under a spin torque that outweighs the force: if the surface is round both ways it is steady
/// (`docs/theory/contact.md#general-surfaces`), and if not, the rounding of the wrench itself moves it
/// further than that of the formulas. A step that is longer than rounding explains is not taken.
#[cold]
#[inline(never)]
pub(crate) fn mended<T: Real, S: ActiveSurface<T>>(
    wrench: &Wrench<T>,
    surface: &S,
    contact: &SoftContact<T>,
) -> SoftContact<T> {
    mended_on(wrench, &|point| normal_at(surface, point), &|point| outside_by(surface, point), contact)
}

/// The same on a facet.
#[cfg(feature = "alloc")]
pub(crate) fn mended_on_facet<T: Real>(wrench: &Wrench<T>, contact: &SoftContact<T>) -> SoftContact<T> {
    let normal = contact.normal;
    SoftContact { normal, ..mended_on(wrench, &|_| normal, &|_| T::zero(), contact) }
}

/// More steps than that do not help: from where rounding leaves a contact next to tangency, seven do.
const STEPS: usize = 8;

/// The same. Compiled once for all surfaces: what differs is only what they answer.
#[inline(never)]
fn mended_on<T: Real>(
    wrench: &Wrench<T>,
    normal: &dyn Fn(&Vector3<T>) -> Vector3<T>,
    residual: &dyn Fn(&Vector3<T>) -> T,
    contact: &SoftContact<T>,
) -> SoftContact<T> {
    let scale = wrench.force().amax().normalising_factor();
    let scaled = Wrench::on_fingertip(wrench.force() * scale, wrench.torque() * scale);
    let mut mended = SoftContact { spin_torque: contact.spin_torque * scale, ..*contact };
    let mut before = T::GREATEST;
    for _ in 0..STEPS {
        let Some((better, size)) = one_step(&scaled, normal, residual, &mended) else { break };
        if !(size <= before * T::literal(0.75)) {
            break;
        }
        (mended, before) = (better, size);
        if size <= T::EPSILON * largest(&mended.point) {
            break;
        }
    }
    SoftContact { spin_torque: mended.spin_torque / scale, ..mended }
}

/// How the normal changes along a way of this length.
#[inline(never)]
fn bend<T: Real>(
    normal: &dyn Fn(&Vector3<T>) -> Vector3<T>,
    point: &Vector3<T>,
    way: &Vector3<T>,
    stride: T,
) -> Vector3<T> {
    (normal(&(point + way)) - normal(&(point - way))) / (stride + stride)
}

/// A component of the torque that is left about a point, `m − (y·fz − z·fy) − τ n`.
#[inline(never)]
fn left<T: Real>([m, y, fz, z, fy]: [T; 5], spin: T, n: T) -> T {
    torque_left(m, y, fz, z, fy).minus(Twofold::new(spin).times(Twofold::new(n))).value()
}

/// A step, and how long it is; `None` where there is none to be taken.
fn one_step<T: Real>(
    wrench: &Wrench<T>,
    normal: &dyn Fn(&Vector3<T>) -> Vector3<T>,
    residual: &dyn Fn(&Vector3<T>) -> T,
    contact: &SoftContact<T>,
) -> Option<(SoftContact<T>, T)> {
    let (f, m) = (wrench.force(), wrench.torque());
    let (c, n, spin) = (contact.point, contact.normal, contact.spin_torque);
    let (strength, pressing) = (f.norm_squared().root(), f.dot(&n));
    let incidence = -pressing / strength;
    // Down to `√ε/2`, where a place is known to half of the digits.
    if !(incidence < flat() && incidence >= T::literal(0.5) * T::EPSILON.root()) {
        return None;
    }
    let size = c.amax() + m.amax() / strength;
    if (normal(&c) - n).amax() > T::literal(64.0) * T::EPSILON {
        return None;
    }
    let (e1, e2) = tangents(&n);
    // At the cube root of ε the rounding of the normal and its third derivatives weigh about the same.
    let stride = size * T::EPSILON.cube_root();
    let (first, second) =
        (bend(normal, &c, &(e1 * stride), stride), bend(normal, &c, &(e2 * stride), stride));
    let steepest = larger(first.amax(), second.amax());
    if !(spin.abs() * steepest <= strength) {
        return None;
    }
    let (w11, w22) = (spin * e1.dot(&first), spin * e2.dot(&second));
    let w12 = spin * (e1.dot(&second) + e2.dot(&first)) * T::literal(0.5);

    let rest = Vector3::new(
        left([m.x, c.y, f.z, c.z, f.y], spin, n.x),
        left([m.y, c.z, f.x, c.x, f.z], spin, n.y),
        left([m.z, c.x, f.y, c.y, f.x], spin, n.z),
    );
    let outside = residual(&c);
    let turned = rest + n.cross(&f) * outside;
    let (r1, r2) = (e1.dot(&turned), e2.dot(&turned));
    let determinant = w11 * w22 - w12 * w12 + pressing * pressing;
    let a1 = (w22 * r1 - (w12 + pressing) * r2) / determinant;
    let a2 = (w11 * r2 - (w12 - pressing) * r1) / determinant;
    let step = e1 * a1 + e2 * a2 - n * outside;
    let allowed = T::literal(64.0) * T::EPSILON * size * (strength * strength / determinant.abs());
    if !(step.amax() <= allowed) {
        return None;
    }
    let twist = n.dot(&(rest - step.cross(&f)));
    let point = c + step;
    let turned = normal(&point);
    // The side that the force presses on.
    if !(turned.dot(&f) < T::zero()) {
        return None;
    }
    Some((SoftContact { point, normal: turned, spin_torque: spin + twist, ..*contact }, step.amax()))
}
