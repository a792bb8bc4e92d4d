//! The superquadric.

use crate::uncertainty::geometry::stretched;
use fingertip_surfaces::numeric::vectors::{largest, length, tangents, unit_or, wide};
use fingertip_surfaces::{LocalSurface, SmoothSurface, Superquadric};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::soft_finger::closed_form::soft_finger;
use crate::soft_finger::double::{in_type, is_steady, narrow};
use crate::{Search, SoftContact, newton_soft_contacts};

/// Starts, and steps from each, of [`by_normals`].
const STARTS: usize = 4;
const STEPS: usize = 60;

/// The contact on a superquadric: by Newton's method in its point, and where that does not settle, in its normal.
fn search<T: Real>(
    shape: &Superquadric<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Search<T> {
    let ended = newton_soft_contacts(shape, wrench, last, &mut *visit);
    if matches!(ended, Search::Incomplete)
        && let Some(contact) = by_normals(shape, wrench)
    {
        visit(contact);
        return Search::Complete;
    }
    ended
}

/// The same, in double precision if the type is narrower and the force meets the surface at a flat angle or the spin
/// torque rules: where the surface is bent sharply one way and hardly the other, the digits of a place in single
/// precision do not tell its normal.
fn search_finely<T: Real>(
    shape: &Superquadric<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Search<T> {
    if T::EPSILON.to_f64() <= f64::EPSILON {
        return search(shape, wrench, last, visit);
    }
    let steady = is_steady(wrench, shape.semi_axes().min());
    let mut found = None;
    let ended = search(shape, wrench, last, &mut |contact| found = Some(contact));
    if let Some(contact) = found.filter(steady) {
        visit(contact);
        return ended;
    }
    let exponents = shape.exponents().map(Real::to_f64);
    let Ok(double) = Superquadric::new(wide(&shape.semi_axes()), exponents) else { return ended };
    let wrench = Wrench::on_fingertip(wide(&wrench.force()), wide(&wrench.torque()));
    let last = last.map(wide);
    in_type(search(&double, &wrench, last.as_ref(), &mut |contact| visit(narrow(&contact))))
}

/// The contact, by Newton's method in its normal `n`: the point is the gradient of the support function `h(n)`, and
/// `M = m − ∇h(n) × f` shall be along `n`.
///
/// With a turn `d` across `n` the point moves by `H d`, `H` being the Hessian of `h`, so that in the plane across `n`
/// `(τ + f·n J₂ H) d = M`, `τ = n·M`, `J₂` turning by a right angle. Its determinant `τ² + (f·n)² det H` is not small
/// where the surface is bent so sharply that its own curvature is infinite, and `H` zero: there Newton's method in
/// the point has no step to take (`docs/theory/contact.md#general-surfaces`). The support function of a superquadric is the gauge of the one with the reciprocal
/// semi-axes and the exponents `2 − e` (the dual norms). `None` unless the equations hold up to rounding, and the
/// force presses.
#[cold]
#[inline(never)]
fn by_normals<T: Real>(shape: &Superquadric<T>, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
    let unit = largest(&shape.semi_axes()).normalising_factor();
    let two = T::one() + T::one();
    let axes = shape.semi_axes() * unit;
    let polar = Superquadric::new(axes.map(|a| T::one() / a), shape.exponents().map(|e| two - e)).ok()?;
    let lever = wrench.torque() * unit;
    let scale = largest(&wrench.force()).max(largest(&lever)).normalising_factor();
    let (f, m) = (wrench.force() * scale, lever * scale);
    let power = f.dot(&m);
    // Of the torque, towards the side that presses.
    let by_torque = m * -power.signum();
    let starts = [by_torque, -f, by_torque - f * largest(&axes), f.cross(&m)];
    let size = length(&m) + length(&f) * largest(&axes);
    for start in starts.into_iter().take(STARTS) {
        let mut n = unit_or(&start, Vector3::z);
        let mut before = T::GREATEST;
        for _ in 0..STEPS {
            let level = polar.level(&n);
            let rest = m - level.gradient.cross(&f);
            let spin = n.dot(&rest);
            let aside = rest - n * spin;
            let left = length(&aside);
            let pressing = f.dot(&n);
            if left <= size * T::EPSILON * T::literal(16.0) && pressing < T::zero() {
                return Some(SoftContact {
                    point: level.gradient / unit,
                    normal: n,
                    spin_torque: spin / scale / unit,
                    active: true,
                });
            }
            let (e1, e2) = tangents(&n);
            let (h1, h2) = (level.hessian * e1, level.hessian * e2);
            let (h11, h12, h22) = (e1.dot(&h1), e1.dot(&h2), e2.dot(&h2));
            let (r1, r2) = (e1.dot(&aside), e2.dot(&aside));
            // (H d) × f across n: f·n times (e1·… = (H d)₂, e2·… = −(H d)₁).
            let (j11, j12) = (spin + pressing * h12, pressing * h22);
            let (j21, j22) = (-pressing * h11, spin - pressing * h12);
            let determinant = j11 * j22 - j12 * j21;
            let turn = (e1 * (j22 * r1 - j12 * r2) + e2 * (j11 * r2 - j21 * r1)) / determinant;
            let angle = length(&turn);
            if !angle.is_number() {
                break;
            }
            // Half a radian at most, and less where the last step did not help.
            let most = if left < before { T::literal(0.5) } else { T::literal(0.1) };
            before = left;
            n = unit_or(&(n + turn * (most / angle).min(T::one())), Vector3::z);
        }
    }
    None
}

soft_finger!(
    Superquadric,
    |shape, wrench, last, visit| search_finely(shape, wrench, last, &mut visit),
    patch | shape,
    _ | {
        // Of a shape in double precision there is no more to be had.
        let narrow = T::EPSILON.to_f64() > f64::EPSILON;
        let double =
            narrow.then(|| Superquadric::new(wide(&shape.semi_axes()), shape.exponents().map(Real::to_f64)));
        double.and_then(Result::ok).map(LocalSurface::Superquadric)
    },
    // The three semi-axes (its exponents are chosen, not measured). As for any level function of `x/a`:
    // `∂S/∂a_i = −g_i x_i/a_i`, `∂g/∂a_i = −(g_i + x_i H) e_i/a_i`.
    sizes | shape,
    size,
    point | (size < 3).then(|| stretched(&shape.level(point), point, size, shape.semi_axes()[size]))
);
