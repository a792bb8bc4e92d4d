//! Which answers of a type are worked out in double precision.

use fingertip_wrench::Real;

/// Whether a type has fewer digits than double precision.
#[inline(always)]
fn is_narrow<T: Real>() -> bool {
    T::EPSILON.to_f64() > f64::EPSILON
}

/// Whether the answers of a type are asked again in double precision where its own rounding decides: of a narrower type,
/// with the feature `mixed-precision`. Not of numbers that carry more than a value, which that would lose.
///
/// Every such question is asked through here, so that single precision without the feature holds nothing of double. It is
/// known when a type is compiled.
#[inline(always)]
pub fn is_asked_again<T: Real>() -> bool {
    cfg!(feature = "mixed-precision") && is_narrow::<T>() && !T::CARRIES_MORE
}

/// Whether a contact is refined with numbers of double precision, or with twice the digits of its type: in double precision
/// itself always, in a narrower type with the feature `mixed-precision`.
#[inline(always)]
pub fn is_refined_in_double<T: Real>() -> bool {
    cfg!(feature = "mixed-precision") || !is_narrow::<T>()
}
