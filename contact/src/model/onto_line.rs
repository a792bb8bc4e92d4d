//! What rounding did to a contact that the force meets at a flat angle, undone.

use fingertip_surfaces::numeric::mixed_precision::{is_asked_again, is_refined_in_double};
use fingertip_surfaces::numeric::twofold::Twofold;
use fingertip_surfaces::numeric::vectors::{larger, largest, wide};
use fingertip_surfaces::{ActiveSurface, LineInDouble, Shortcuts};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use super::point_contact::flat_on;

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
    if incidence < flat_on(&surface.shortcuts()) {
        let (point, normal) = onto_line(wrench, surface, (point, normal), incidence);
        return Place::at(point, normal);
    }
    Place::at(point, normal)
}

/// The square of an incidence below which a place is known to less than half of the digits, `√ε/2`.
fn flattest<T: Real>() -> T {
    T::literal(0.25) * T::EPSILON
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
    match by_more_digits(wrench, surface, &point, incidence) {
        MoreDigits::Enters(point, normal) => (point, normal),
        // The line is a tangent but for rounding: it touches where it was found, and steps could only lead away.
        MoreDigits::Misses => (point, normal),
        MoreDigits::Unknown => mended(&scaled(wrench), surface, (point, normal), incidence),
    }
}

/// Force and torque times a factor that makes the force 1 or more.
#[inline(never)]
fn scaled<T: Real>(wrench: &Wrench<T>) -> [Vector3<T>; 2] {
    let scale = reach(&wrench.force()).normalising_factor();
    [wrench.force() * scale, wrench.torque() * scale]
}

/// The steps of [`onto_line`].
#[inline(never)]
fn mended<T: Real, S: ActiveSurface<T>>(
    [f, m]: &[Vector3<T>; 2],
    surface: &S,
    (point, normal): (Vector3<T>, Vector3<T>),
    incidence: T,
) -> (Vector3<T>, Vector3<T>) {
    if incidence * incidence < flattest() {
        return (point, normal);
    }
    let (mut place, mut outward, mut before) = (point, normal, T::GREATEST);
    // The line is no farther away than that: the force is 1 or more in its own unit.
    let size = reach(&point) + reach(m);
    let rounding = T::literal(64.0) * T::EPSILON * size / incidence;
    // Along an axis the direction across it is as badly known as the line is flat.
    let allowed = larger(rounding, (rounding / incidence).min(size * T::literal(1e-3)));
    // Kept from being unrolled: it is code for few samples.
    for _ in 0..core::hint::black_box(STEPS) {
        let off = off_line(f, m, &place);
        let outside = outside_by(surface, &place);
        let step = off - f * ((outside + outward.dot(&off)) / outward.dot(f));
        let size = reach(&step);
        // False for a NaN, too.
        if !(size <= allowed && size <= before * T::literal(0.75)) {
            break;
        }
        before = size;
        place += step;
        let turned = normal_at(surface, &place);
        // Beside an edge, or where a surface is thin, a point may belong to another side.
        if !(turned.dot(f) < T::zero() && (turned - outward).norm_squared() < T::literal(0.1)) {
            break;
        }
        outward = turned;
    }
    (place, outward)
}

/// From rounding alone one round is enough.
const ROUNDS: usize = 3;

/// Where the line of action enters near a point at which it is a tangent but for rounding: the half chord `t` of
/// `e + (n·d) t + κ t²/2 = 0` from a point of the line, along its direction `d`. The height `e` over the surface has
/// twice the digits, with which the point is off the line, too; the curvature `κ` comes from a difference of normals.
/// `None` where the line misses, or where the surface is not so. Single precision without the feature `mixed-precision`
/// does without it, for the smallest programs.
#[cold]
#[inline(never)]
fn through_chord<T: Real, S: ActiveSurface<T>>(
    load: &[Vector3<T>; 2],
    surface: &S,
    near: &Vector3<T>,
) -> Option<(Vector3<T>, Vector3<T>)> {
    let [f, m] = load;
    let direction = f / f.norm_squared().root();
    let (mut point, mut incidence) = (*near, T::zero());
    // From a far start, as of a line along a cylinder, one round leaves what rounding did to the curvature.
    for _ in 0..core::hint::black_box(ROUNDS) {
        let start = point + off_line(f, m, &point);
        let normal = normal_at(surface, &start);
        let outside = outside_by(surface, &start);
        let height = outside + normal.dot(&off_line(f, m, &start));
        let stride = (reach(&start) + reach(m)) * T::EPSILON.root();
        let slope = direction.dot(&normal);
        let bend = (direction.dot(&normal_at(surface, &(start + direction * stride))) - slope) / stride;
        incidence = (slope * slope - (bend + bend) * height).root();
        let falls = slope <= T::zero();
        let along = if falls { (height + height) / (incidence - slope) } else { -(incidence + slope) / bend };
        point = start + direction * along;
        // A surface that does not tell its height says the same everywhere. False for a NaN, too, as of a line that misses.
        let is_told = outside_by(surface, &(start + normal * stride)) > outside;
        if !(is_told && incidence > T::zero() && point.sum().is_number()) {
            return None;
        }
    }
    let normal = normal_at(surface, &point);
    let enters = normal.dot(f) < T::zero() && incidence * incidence >= flattest();
    enters.then(|| mended(load, surface, (point, normal), incidence))
}

/// What more digits than those of the type say of the line of action.
pub(super) enum MoreDigits<T: Real> {
    /// It enters at this point, where this is the normal.
    Enters(Vector3<T>, Vector3<T>),
    /// It does not.
    Misses,
    /// Nothing.
    Unknown,
}

/// Where the line of action enters near a point, in double precision for a type that is narrower, if the surface knows:
/// that the steps above end where they should, digits of a normal must follow from those of its point.
#[inline(always)]
fn in_double<T: Real, S: ActiveSurface<T>>(
    wrench: &Wrench<T>,
    surface: &S,
    near: &Vector3<T>,
) -> MoreDigits<T> {
    if !is_asked_again::<T>() {
        return MoreDigits::Unknown;
    }
    // In range: the squares of all numbers of a narrower type are.
    let (f, m) = (wide(&wrench.force()), wide(&wrench.torque()));
    let squared = f.norm_squared();
    let line = Line { point: f.cross(&m) / squared, direction: f / squared.root() };
    match surface.shortcuts().entry_in_double(&line, &wide(near)) {
        Some(LineInDouble::Enters { point, normal }) if normal.dot(&f) < 0.0 => {
            MoreDigits::Enters(point.map(T::literal), normal.map(T::literal))
        }
        Some(LineInDouble::Misses) => MoreDigits::Misses,
        _ => MoreDigits::Unknown,
    }
}

/// Where the line of action enters near a point, in double precision where that is told; if not, by the chord where the
/// line is all but a tangent, so that the steps do not lead there.
#[inline(always)]
pub(super) fn by_more_digits<T: Real, S: ActiveSurface<T>>(
    wrench: &Wrench<T>,
    surface: &S,
    near: &Vector3<T>,
    incidence: T,
) -> MoreDigits<T> {
    let told = in_double(wrench, surface, near);
    let grazes = incidence * incidence < T::literal(1024.0) * T::EPSILON;
    if !matches!(told, MoreDigits::Unknown) || !grazes || !is_refined_in_double::<T>() {
        return told;
    }
    through_chord(&scaled(wrench), surface, near)
        .map_or(MoreDigits::Unknown, |(point, normal)| MoreDigits::Enters(point, normal))
}

/// Kept out of line, as it is asked often for few samples.
#[inline(never)]
fn reach<T: Real>(vector: &Vector3<T>) -> T {
    largest(vector)
}

/// Kept out of line, as it is asked often for few samples: where one surface is compiled only, it would be copied to
/// every place that asks.
#[inline(never)]
pub(crate) fn normal_at<T: Real, S: ActiveSurface<T>>(surface: &S, point: &Vector3<T>) -> Vector3<T> {
    surface.normal(point)
}

/// Kept out of line, too.
#[inline(never)]
pub(crate) fn outside_by<T: Real, S: ActiveSurface<T>>(surface: &S, point: &Vector3<T>) -> T {
    surface.shortcuts().surface_residual(point)
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
