//! Quadratic equations without cancellation.

use fingertip_wrench::Real;

/// `a·d − b·c` to two rounding errors, however much cancels (Kahan's algorithm; Jeannerod, Louvet &
/// Muller 2013).
#[inline]
pub fn difference_of_products<T: Real>(a: T, d: T, b: T, c: T) -> T {
    let (p, p_error) = a.two_product(d);
    let (q, q_error) = b.two_product(c);
    (p - q) + (p_error - q_error)
}

/// The real roots of `a·t² + 2·b·t + c`, in ascending order.
///
/// The discriminant is formed exactly enough that nearly equal roots keep half their digits, and
/// the roots without cancellation: `q = −(b + sign(b)·√(b² − a·c))`, `q/a`, `c/q`. A root beyond
/// the range of the type is infinite or NaN; the caller shall test. A constant has none, unless it is zero.
#[inline]
pub fn roots<T: Real>(a: T, b: T, c: T) -> Option<[T; 2]> {
    let discriminant = difference_of_products(b, b, a, c);
    if !(discriminant >= T::zero()) || (a.is_zero() && b.is_zero() && !c.is_zero()) {
        return None;
    }
    let root = discriminant.root();
    let q = if b >= T::zero() { -(b + root) } else { root - b };
    let (first, second) = if q == T::zero() { (T::zero(), T::zero()) } else { (q / a, c / q) };
    Some(if first <= second { [first, second] } else { [second, first] })
}

#[cfg(test)]
mod tests {
    use super::{difference_of_products, roots};
    use proptest::prelude::*;

    proptest! {
        /// Products of 24-bit numbers are exact in double precision.
        #[test]
        fn difference_agrees_with_double_precision(
            a in -1.0_f32..1.0, b in -1.0_f32..1.0, c in -1.0_f32..1.0, nudge in 0_u32..4
        ) {
            let d = f32::from_bits((b * c / a).to_bits().wrapping_add(nudge));
            prop_assume!(d.is_finite() && d.abs() < 1e6 && a.abs() > 1e-6 && d.abs() > 1e-6);
            let exact = f64::from(a) * f64::from(d) - f64::from(b) * f64::from(c);
            let found = f64::from(difference_of_products(a, d, b, c));
            prop_assert!((found - exact).abs() <= 2.0 * f64::from(f32::EPSILON) * exact.abs(), "{found} {exact}");
        }

        #[test]
        fn roots_solve_the_equation(x in -10.0_f64..10.0, y in -10.0_f64..10.0, a in 0.1_f64..10.0) {
            let [low, high] = roots(a, -a * (x + y) / 2.0, a * x * y).unwrap_or([x.min(y), x.max(y)]);
            let allowed = 1e-6_f64.max(0.0);
            prop_assert!((low - x.min(y)).abs() < allowed && (high - x.max(y)).abs() < allowed);
        }
    }

    #[test]
    fn degenerate_coefficients() {
        assert_eq!(roots(1.0, 0.0, 0.0), Some([0.0, 0.0]));
        assert_eq!(roots(1.0, 0.0, 1.0), None);
        let [low, high] = roots(0.0, 1.0, 4.0).unwrap();
        assert!(low == f64::NEG_INFINITY && high == -2.0);
        assert_eq!(roots(f64::NAN, 0.0, 1.0), None);
    }
}
