//! What rounding did to a contact that the force meets at a flat angle, undone.

use fingertip_surfaces::numeric::mixed_precision::is_asked_again;
use fingertip_surfaces::numeric::twofold::Twofold;
use fingertip_surfaces::numeric::vectors::{largest, wide};
use fingertip_surfaces::{ActiveSurface, Shortcuts};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use super::flat;

/// Where the contact is.
pub(super) struct Place<T: Real> {
    pub(super) point: Vector3<T>,
    pub(super) normal: Vector3<T>,
    pub(super) gap: T,
    pub(super) alternatives: u8,
}

impl<T: Real> Place<T> {
    pub(super) fn at(point: Vector3<T>, normal: Vector3<T>) -> Self {
        Self { point, normal, gap: T::zero(), alternatives: 0 }
    }
}

/// The place of a crossing; where the force meets the surface at a flat angle, without the rounding
/// errors that grow there.
pub(super) fn entered<T: Real, S: ActiveSurface<T>>(
    wrench: &Wrench<T>,
    surface: &S,
    (point, normal): (Vector3<T>, Vector3<T>),
    incidence: T,
) -> Place<T> {
    if incidence < flat() {
        let (point, normal) = onto_line(wrench, surface, (point, normal), incidence);
        return Place::at(point, normal);
    }
    Place::at(point, normal)
}

/// More steps than that do not help: from where rounding leaves a crossing next to tangency, seven do.
const STEPS: usize = 8;

/// The point where the line of action meets the surface and the normal there, from ones that are off by rounding
/// errors of line and surface.
///
/// A point `x` with normal `n` is off the line by `r = f × (m − x × f)/|f|²`, and outside the surface
/// by `e`. To first order the two meet at `x + r − f·(e + n·r)/(n·f)`: whatever `r` and `e` are is
/// multiplied by the reciprocal cosine of incidence, which is why a rounding error of the foot point
/// is one of twenty at a cosine of 0.05. Both are found here with twice the digits
/// ([`Shortcuts::surface_residual`] for `e`), so that of the last step's own error that factor is all that is
/// left. The normal is that of the point where the steps end: it turns as much as they move it. A step that is
/// longer than rounding explains, as on a surface that is not smooth there, is not taken, nor one that is not much
/// shorter than the one before.
#[cold]
#[inline(never)]
fn onto_line<T: Real, S: ActiveSurface<T>>(
    wrench: &Wrench<T>,
    surface: &S,
    (point, normal): (Vector3<T>, Vector3<T>),
    incidence: T,
) -> (Vector3<T>, Vector3<T>) {
    if let Some(found) = in_double(wrench, surface, &point) {
        return found;
    }
    // Below √ε/2 the place is known to half of the digits.
    if incidence * incidence < T::literal(0.25) * T::EPSILON {
        return (point, normal);
    }
    let scale = reach(&wrench.force()).normalising_factor();
    let (f, m) = (wrench.force() * scale, wrench.torque() * scale);
    let (mut place, mut outward, mut before) = (point, normal, T::GREATEST);
    // The line is no farther away than that: the force is 1 or more in its own unit.
    let size = reach(&point) + reach(&m);
    let allowed = T::literal(64.0) * T::EPSILON * size / incidence;
    // Kept from being unrolled: it is code for few samples.
    for _ in 0..core::hint::black_box(STEPS) {
        let off = off_line(&f, &m, &place);
        let outside = surface.shortcuts().surface_residual(&place);
        let step = off - f * ((outside + outward.dot(&off)) / outward.dot(&f));
        let size = reach(&step);
        // False for a NaN, too.
        if !(size <= allowed && size <= before * T::literal(0.75)) {
            break;
        }
        before = size;
        place += step;
        let turned = surface.normal(&place);
        // Beside an edge, or where a surface is thin, a point may belong to another side.
        if !(turned.dot(&f) < T::zero() && (turned - outward).norm_squared() < T::literal(0.1)) {
            break;
        }
        outward = turned;
    }
    (place, outward)
}

/// Where the line of action enters near a point, in double precision for a type that is narrower, if the surface knows:
/// that the steps above end where they should, digits of a normal must follow from those of its point.
#[inline(always)]
pub(super) fn in_double<T: Real, S: ActiveSurface<T>>(
    wrench: &Wrench<T>,
    surface: &S,
    near: &Vector3<T>,
) -> Option<(Vector3<T>, Vector3<T>)> {
    if !is_asked_again::<T>() {
        return None;
    }
    // In range: the squares of all numbers of a narrower type are.
    let (f, m) = (wide(&wrench.force()), wide(&wrench.torque()));
    let squared = f.norm_squared();
    let line = Line { point: f.cross(&m) / squared, direction: f / squared.root() };
    let [point, normal] = surface.shortcuts().entry_in_double(&line, &wide(near))?;
    (normal.dot(&f) < 0.0).then(|| (point.map(T::literal), normal.map(T::literal)))
}

/// Kept out of line, as it is asked often for few samples.
#[inline(never)]
fn reach<T: Real>(vector: &Vector3<T>) -> T {
    largest(vector)
}

/// By how much a point is off the line of a force: `f × (m − x × f)/|f|²`.
#[inline(never)]
fn off_line<T: Real>(f: &Vector3<T>, m: &Vector3<T>, point: &Vector3<T>) -> Vector3<T> {
    let tx = torque_left(m.x, point.y, f.z, point.z, f.y);
    let ty = torque_left(m.y, point.z, f.x, point.x, f.z);
    let tz = torque_left(m.z, point.x, f.y, point.y, f.x);
    Vector3::new(across(f.y, tz, f.z, ty), across(f.z, tx, f.x, tz), across(f.x, ty, f.y, tx))
        / f.norm_squared()
}

/// A component of the torque that is left about a point, `m − (y·fz − z·fy)`.
#[inline(never)]
pub(crate) fn torque_left<T: Real>(m: T, y: T, fz: T, z: T, fy: T) -> Twofold<T> {
    let product = |a: T, b: T| Twofold::new(a).times(Twofold::new(b));
    Twofold::new(m).minus(product(y, fz)).plus(product(z, fy))
}

/// A component of the force times that torque, `fy·tz − fz·ty`.
#[inline(never)]
fn across<T: Real>(fy: T, tz: Twofold<T>, fz: T, ty: Twofold<T>) -> T {
    tz.times(Twofold::new(fy)).minus(ty.times(Twofold::new(fz))).value()
}
