//! Lengths and directions without over- or underflow.

pub use fingertip_wrench::tangents;
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

/// The largest magnitude of a component. Unlike `amax` it passes over a NaN, which costs nothing:
/// what is scaled by it stays NaN.
#[inline]
pub fn largest<T: Real>(v: &Vector3<T>) -> T {
    larger(larger(v.x.abs(), v.y.abs()), v.z.abs())
}

/// The larger of two numbers; the second if one is NaN.
#[inline]
pub fn larger<T: Real>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The smaller of two numbers; the second if one is NaN.
#[inline]
pub fn smaller<T: Real>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// `true` if products of up to eight such numbers stay within the range of the type, with all their
/// digits.
#[inline]
pub fn is_tame<T: Real>(x: T) -> bool {
    x > T::LEAST_NORMAL.root().root().root() && x < T::GREATEST.root().root().root()
}

/// A power of two that brings a number near 1, or just 1 if it is tame: to be used where products
/// must stay in range, and no more.
#[inline]
pub fn taming_factor<T: Real>(x: T) -> T {
    if is_tame(x) { T::one() } else { x.normalising_factor() }
}

/// Euclidean length, for components over the whole range of the type.
#[inline]
pub fn length<T: Real>(v: &Vector3<T>) -> T {
    let scale = v.amax().normalising_factor();
    (v * scale).norm_squared().root() / scale
}

/// The same, out of line: for code that few samples take, of which a microcontroller should hold little.
#[cold]
#[inline(never)]
pub fn rarely_length<T: Real>(v: &Vector3<T>) -> T {
    length(v)
}

/// `√(a² + b²)` for numbers over the whole range of the type.
#[inline]
pub fn hypotenuse<T: Real>(a: T, b: T) -> T {
    let scale = a.abs().max(b.abs()).normalising_factor();
    let (a, b) = (a * scale, b * scale);
    (a * a + b * b).root() / scale
}

/// Cosine and sine of half the angle of the vector `(x, y)`, which is up to π; 1 and 0 of a vector without direction.
///
/// With `c = |x|/r` the half nearer to the x axis is `√((1 + c)/2)`, of which nothing cancels, and the other
/// `|y|/(2r)` over that: each is off by a few rounding errors of itself, for no angle is formed.
#[inline]
pub fn half_angle<T: Real>(x: T, y: T) -> (T, T) {
    let length = hypotenuse(x, y);
    if !(length > T::zero() && length.is_number()) {
        return (T::one(), T::zero());
    }
    let half = T::literal(0.5);
    let near = (half + x.abs() / length * half).root();
    let far = y.abs() / length * half / near;
    if x >= T::zero() { (near, far.copysign(y)) } else { (far, near.copysign(y)) }
}

/// The unit vector along `v`; `fallback` if `v` is zero or not finite.
#[inline]
pub fn unit_or<T: Real>(v: &Vector3<T>, fallback: impl FnOnce() -> Vector3<T>) -> Vector3<T> {
    let scaled = v * v.amax().normalising_factor();
    let squared = scaled.norm_squared();
    if squared > T::zero() && squared.is_number() {
        let unit = scaled / squared.root();
        // A subnormal `v` could not be brought near 1: its squares have lost digits.
        if squared < T::literal(0.5) { unit / unit.norm_squared().root() } else { unit }
    } else {
        fallback()
    }
}

/// A unit vector across a unit vector.
#[inline]
pub fn any_perpendicular<T: Real>(direction: &Vector3<T>) -> Vector3<T> {
    tangents(direction).0
}

/// The line's point closest to `centre`, relative to `centre`, and its position along the line.
///
/// Off by a rounding error of the distance between `centre` and the line's own point: lines of action
/// have theirs nearby.
#[inline]
pub fn foot<T: Real>(line: &Line<T>, centre: &Vector3<T>) -> (Vector3<T>, T) {
    let from_centre = line.point - centre;
    let along = -from_centre.dot(&line.direction);
    (from_centre + line.direction * along, along)
}

/// In double precision.
#[inline]
pub fn wide<T: Real>(v: &Vector3<T>) -> Vector3<f64> {
    v.map(Real::to_f64)
}

/// An angle as files have it.
#[cfg(feature = "serde")]
pub fn to_degrees<T: Real>(radians: T) -> T {
    radians * T::literal(180.0) / T::pi()
}

/// And back.
#[cfg(feature = "serde")]
pub fn from_degrees<T: Real>(degrees: T) -> T {
    degrees / T::literal(180.0) * T::pi()
}

/// The vector, or one that is nearer by so much that its length does not leave the range.
#[inline]
pub fn within_range<T: Real>(v: &Vector3<T>) -> Vector3<T> {
    let far = T::GREATEST * T::literal(0.0625);
    v.map(|x| x.max(-far).min(far))
}

/// `false` for a point beyond the range of the type, as where a line is parallel to a surface but for
/// a rounding error; cheaper than [`is_finite`]. No shape of this crate shall report one; a user's might.
#[inline]
pub fn in_range<T: Real>(point: &Vector3<T>) -> bool {
    (point.x + point.y + point.z).is_number()
}

/// `true` if no component is NaN or infinite.
#[inline]
pub fn is_finite<T: Real>(v: &Vector3<T>) -> bool {
    v.x.is_number() & v.y.is_number() & v.z.is_number()
}

#[cfg(test)]
mod tests {
    use super::{half_angle, hypotenuse, length, tangents, unit_or};
    use nalgebra::Vector3;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn unit_vectors_are_unit_for_any_bits(bits in any::<[u32; 3]>()) {
            let v = Vector3::from(bits.map(f32::from_bits));
            let unit = unit_or(&v, Vector3::x);
            let norm = unit.map(f64::from).norm();
            prop_assert!((norm - 1.0).abs() < 4.0 * f64::from(f32::EPSILON), "{v:?} -> {unit:?}");
        }

        #[test]
        fn tangents_are_a_frame(x in -1.0..1.0, y in -1.0..1.0, z in -1.0..1.0) {
            let ends = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, -0.0], [1e-9, 0.0, -1.0]];
            for v in ends.into_iter().chain([[x, y, z]]) {
                let direction = unit_or(&Vector3::<f64>::from(v), Vector3::x);
                let (first, second) = tangents(&direction);
                for across in [first, second] {
                    prop_assert!((across.norm() - 1.0).abs() < 8.0 * f64::EPSILON);
                    prop_assert!(across.dot(&direction).abs() < 8.0 * f64::EPSILON);
                }
                prop_assert!((first.cross(&second) - direction).norm() < 16.0 * f64::EPSILON);
            }
        }

        #[test]
        fn halves_of_angles_agree_with_double_precision(
            x in -1.0_f32..1.0, y in -1.0_f32..1.0, powers in any::<[i8; 2]>()
        ) {
            let [x, y] = [x * 2_f32.powi(powers[0].into()), y * 2_f32.powi(powers[1].into())];
            let half = f64::from(y).atan2(x.into()) * 0.5;
            let (cos, sin) = half_angle(x, y);
            for (found, exact) in [(cos, half.cos()), (sin, half.sin())] {
                // Double precision itself loses the digits of the cosine of a right angle; so do subnormal ratios.
                let allowed = 6.0 * f64::from(f32::EPSILON) * exact.abs() + 4e-16;
                prop_assert!((f64::from(found) - exact).abs() <= allowed, "{x} {y}: {cos} {sin}");
            }
        }

        #[test]
        fn lengths_agree_with_double_precision(bits in any::<[u32; 3]>()) {
            let v = Vector3::from(bits.map(f32::from_bits));
            prop_assume!(v.iter().all(|x| x.is_finite()));
            let exact = v.map(f64::from).norm();
            prop_assume!(exact < f64::from(f32::MAX));
            let allowed = exact * 3e-7 + f64::from(f32::MIN_POSITIVE) * 1e-6;
            prop_assert!((f64::from(length(&v)) - exact).abs() <= allowed);
            let plane = f64::from(v.x).hypot(f64::from(v.y));
            prop_assert!((f64::from(hypotenuse(v.x, v.y)) - plane).abs() <= plane * 3e-7 + 1e-44);
        }
    }

    #[test]
    fn halves_of_right_angles_and_of_none() {
        assert_eq!(half_angle(2.0, 0.0), (1.0, 0.0));
        assert_eq!(half_angle(-2.0, 0.0), (0.0, 1.0));
        assert_eq!(half_angle(-2.0, -0.0), (0.0, -1.0));
        let eighth = 0.5_f32.sqrt();
        assert_eq!(half_angle(0.0, 3.0_f32), (eighth, eighth));
        assert_eq!(half_angle(0.0, -1e-45_f32), (eighth, -eighth));
        for nothing in [[0.0, 0.0], [f32::NAN, 1.0], [1.0, f32::INFINITY]] {
            assert_eq!(half_angle(nothing[0], nothing[1]), (1.0, 0.0));
        }
    }
}
