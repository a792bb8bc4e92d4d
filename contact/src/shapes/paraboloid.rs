//! The paraboloid.

#[cfg(feature = "batch")]
use core::hint::select_unpredictable;

#[cfg(feature = "batch")]
use fingertip_surfaces::Entry;
use fingertip_surfaces::numeric::vectors::{larger, largest, taming_factor};
use fingertip_surfaces::{ForceLine, Paraboloid, SmoothSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Vector2, Vector3};

use crate::model::flat;
use crate::soft_finger::closed_form::{is_pure_force_of, soft_finger, told};
use crate::{GeometrySensitivity, Search, SoftContact};

/// The soft-finger contact of a force and torque on `x²/a + y²/b + 2z = 0`.
///
/// With complex numbers, `r = √(a/b)` and `Z = x/r + iy` (`docs/theory/contact.md#paraboloid`, where `Z`, `Φ` and `M` are in
/// units of `√b`, of which an inexact root would come into all numbers),
///
/// ```text
/// F = f_z + i m_z/(rb),   Φ = f_x/r + i f_y,   M = m_x + i m_y/r
/// H² = F² + 2i Φ̄ M/b,   Re H < 0
/// Z = 2i M/(H + F) = b (H − F)/Φ̄,   z = −|Z|²/2b,   K = r b Im H
/// ```
///
/// `K` being the spin torque over the length of the gradient `(x/a, y/b, 1)`, and `Re H` the force along that. Of the two
/// quotients the one is taken in which nothing cancels: a force along the axis is an ordinary case, and so is a spin torque of
/// zero.
struct OnParaboloid<T: Real> {
    /// `r`, `b`.
    ratio: T,
    radius: T,
    /// `Φ`.
    tangential: Vector2<T>,
    /// `2i M`.
    turning: Vector2<T>,
    /// `F`.
    at_top: Vector2<T>,
    /// `H`.
    found: Vector2<T>,
    /// `|H|⁴`.
    fourth: T,
    /// The line of action passes by or touches.
    misses: bool,
}

impl<T: Real> OnParaboloid<T> {
    /// `power` is `f·m`.
    #[inline(always)]
    fn new([a, b]: [T; 2], f: &Vector3<T>, m: &Vector3<T>, power: T) -> Self {
        let (two, half) = (T::literal(2.0), T::literal(0.5));
        let ratio = (a / b).root();
        let (narrow, bend) = (T::one() / ratio, T::one() / b);
        let across = narrow * bend;
        let tangential = Vector2::new(f.x * narrow, f.y);
        let turning = Vector2::new(-m.y * narrow, m.x) * two;
        let at_top = Vector2::new(f.z, m.z * across);
        // Re and Im of `H²`.
        let real = at_top.x * at_top.x - at_top.y * at_top.y + tangential.dot(&turning) * bend;
        let imaginary = power * across * two;
        let fourth = real * real + imaginary * imaginary;
        let longer = ((fourth.root() + real.abs()) * half).root();
        let shorter = imaginary.abs() * half / longer;
        let misses = !(real > T::zero());
        // Without a branch, which no one could predict.
        let (along, spin) = if misses { (shorter, longer) } else { (longer, shorter) };
        let found = Vector2::new(-along, spin.copysign(-imaginary));
        Self { ratio, radius: b, tangential, turning, at_top, found, fourth, misses }
    }

    /// The contact for this `H`, its normal as long as the gradient.
    #[inline(always)]
    fn contact(&self, found: &Vector2<T>) -> SoftContact<T> {
        let (ratio, radius) = (self.ratio, self.radius);
        let away = found.dot(&self.at_top) < T::zero();
        // Numerator, and the conjugate of the denominator.
        let (over, under) = if away {
            ((found - self.at_top) * radius, self.tangential)
        } else {
            let sum = found + self.at_top;
            (self.turning, Vector2::new(sum.x, -sum.y))
        };
        let inverse = T::one() / under.norm_squared();
        let x = (over.x * under.x - over.y * under.y) * inverse;
        let y = (over.x * under.y + over.y * under.x) * inverse;
        let (u, v) = (x / radius, y / radius);
        SoftContact {
            point: Vector3::new(x * ratio, y, (x * u + y * v) * T::literal(-0.5)),
            normal: Vector3::new(u / ratio, v, T::one()),
            spin_torque: found.y * (ratio * radius),
            active: true,
        }
    }
}

/// With a normal of length 1, if the gradient is as long as the root of this.
#[inline(always)]
fn levelled<T: Real>(contact: &SoftContact<T>, squared: T) -> SoftContact<T> {
    let steepness = squared.root();
    let normal = contact.normal * (T::one() / steepness);
    SoftContact { normal, spin_torque: contact.spin_torque * steepness, ..*contact }
}

fn is_active<T: Real>(shape: &Paraboloid<T>, z: T) -> bool {
    shape.depth().is_none_or(|depth| -z <= depth)
}

/// `epsilon` is that of the type in which the wrench was told.
///
/// # Errors
/// The pair of points that a pure force which misses would graze; [`Search::Complete`] of a force along the axis that pulls;
/// [`Search::Incomplete`] of a contact beyond the range of the type.
fn on_paraboloid<T: Real>(
    shape: &Paraboloid<T>,
    wrench: &Wrench<T>,
    epsilon: T,
) -> Result<SoftContact<T>, Search<T>> {
    let [a, b] = shape.radii();
    let unit = larger(a, b).normalising_factor();
    let length = unit.normalising_factor();
    let (f, m) = (wrench.force(), wrench.torque() * unit);
    let scale = taming_factor(larger(largest(&f), largest(&m)));
    let (f, m) = (f * scale, m * scale);
    // What is exactly zero shall stay so.
    let power = (wrench.force() * scale).dot(&(wrench.torque() * scale)) * unit;
    let solved = OnParaboloid::new([a * unit, b * unit], &f, &m, power);
    // As on the sphere: below it, and of a pure force for all that its numbers say, the sign of `f·m` is rounding.
    let least = (epsilon * T::literal(4.0)).whole_power(2) * f.norm_squared();
    let is_pure = || is_pure_force_of(&wrench.force(), &wrench.torque(), epsilon);
    let (along, spin) = (solved.found.x, solved.found.y);
    if solved.misses && (!(along * along > least) || is_pure()) {
        let place = |spin: T| solved.contact(&Vector2::new(T::zero(), spin)).point * length;
        return Err(Search::Grazing([place(spin), place(-spin)]));
    }
    let contact = solved.contact(&solved.found);
    let squared = contact.normal.norm_squared();
    if !squared.is_number() {
        let pulls = solved.tangential.norm_squared().is_zero();
        return Err(if pulls { Search::Complete } else { Search::Incomplete });
    }
    let contact = levelled(&contact, squared);
    let point = contact.point * length;
    let spin_torque = contact.spin_torque * length * scale.normalising_factor();
    Ok(SoftContact { point, spin_torque, active: is_active(shape, point.z), ..contact })
}

/// The same for a force that is tame and presses steeply, on a paraboloid of which the same holds.
#[inline(always)]
fn steeply_on_paraboloid<T: Real>(shape: &Paraboloid<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    let (f, m) = (push.force(), push.torque());
    let solved = OnParaboloid::new(shape.radii(), &f, &m, f.dot(&m));
    let contact = solved.contact(&solved.found);
    let squared = contact.normal.norm_squared();
    let in_range = (solved.fourth >= ForceLine::least_squared()) & (solved.fourth <= T::GREATEST);
    let pressing = solved.found.x * solved.found.x;
    let steep = pressing >= flat::<T>().whole_power(2) * (push.squared() * squared);
    let active = is_active(shape, contact.point.z);
    (in_range & steep).then(|| SoftContact { active, ..levelled(&contact, squared) })
}

soft_finger!(
    Paraboloid,
    |shape, wrench, _, visit| told(on_paraboloid(shape, wrench, T::EPSILON), visit),
    sole | shape,
    push | steeply_on_paraboloid(shape, push),
    double | shape,
    wrench | shape.in_double().map(|double| on_paraboloid(&double, wrench, T::EPSILON.to_f64())),
    sizes | shape,
    size,
    point | of_paraboloid(shape, point).get(size).copied()
);

/// The two radii of curvature at the vertex. With `S = z + (x²/a + y²/b)/2`:
/// `∂S/∂a = −x²/2a²`, `∂g/∂a = −x/a² e₁`.
fn of_paraboloid<T: Real>(shape: &Paraboloid<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
    let level = shape.level(point);
    let radii = shape.radii();
    [0, 1].map(|i| {
        let slope = -level.gradient[i] / radii[i];
        let mut turned = Vector3::zeros();
        turned[i] = slope;
        let value = slope * point[i] * T::literal(0.5);
        GeometrySensitivity::of_level(value, &turned, &level.gradient, &level.hessian)
    })
}

#[cfg(feature = "batch")]
crate::batch::each::entering!(Paraboloid, |paraboloid, push| Some(entry_of_paraboloid(paraboloid, push)));

/// Where the line of a force enters: with its foot `s` and the force `f`, the lesser root of
/// `a t² + 2 b t + c = 0` for the place `s + t f`, at which `a t + b`, the slope of the level function along it, is negative.
#[cfg(feature = "batch")]
#[inline(always)]
fn entry_of_paraboloid<T: Real>(shape: &Paraboloid<T>, push: &ForceLine<T>) -> Entry<T> {
    let ([ka, kb], f) = (shape.curvatures(), push.force());
    let s = f.cross(&push.torque()) * (T::one() / push.squared());
    let (ax, ay) = (f.x * ka, f.y * kb);
    let (a, b) = (f.x * ax + f.y * ay, s.x * ax + s.y * ay + f.z);
    let c = s.x * s.x * ka + s.y * s.y * kb + s.z + s.z;
    let root = (b * b - a * c).root();
    // Without cancellation.
    let (up, sum) = (b > T::zero(), b.abs() + root);
    let along = select_unpredictable(up, -sum, c) / select_unpredictable(up, a, sum);
    let point = s + f * along;
    let gradient = Vector3::new(point.x * ka, point.y * kb, T::one());
    let steepness = gradient.norm_squared();
    Entry {
        point,
        normal: gradient * (T::one() / steepness.root()),
        incidence_squared: root * root / (steepness * push.squared()),
        parts: None,
        active: -point.z <= shape.depth().unwrap_or(T::GREATEST),
    }
}
