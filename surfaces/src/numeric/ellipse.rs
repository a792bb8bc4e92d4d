//! The point of an ellipse or ellipsoid closest to a given point.

use fingertip_wrench::Real;

use super::roots::first_of_convex;

/// The point of the ellipsoid with these semi-axes closest to `point`, both in its principal
/// frame, in two or three dimensions (Eberly, "Distance from a point to an ellipse, an ellipsoid,
/// or a hyperellipsoid").
///
/// The closest point is `xᵢ = rᵢ·yᵢ/(s + rᵢ)` with `rᵢ = (aᵢ/a_min)²` and `s` the largest root of
/// `Σ(rᵢ·zᵢ/(s + rᵢ))² = 1`, `zᵢ = yᵢ/aᵢ`: a falling convex function, so that Newton's method cannot
/// overstep the root. Total for finite points and positive semi-axes.
pub(crate) fn closest_point<T: Real, const N: usize>(semi_axes: &[T; N], point: &[T; N]) -> [T; N] {
    let least = semi_axes.iter().fold(T::GREATEST, |least, a| least.min(*a));
    let mut squared = [T::one(); N];
    let mut scaled = [T::zero(); N];
    for (((r, z), a), y) in squared.iter_mut().zip(&mut scaled).zip(semi_axes).zip(point) {
        let ratio = *a / least;
        *r = ratio * ratio;
        *z = y.abs() / *a;
    }
    let f = |s: T| {
        let (mut value, mut slope) = (-T::one(), T::zero());
        for (r, z) in squared.iter().zip(&scaled) {
            if *z > T::zero() {
                let term = *r * *z / (s + *r);
                value += term * term;
                slope -= (T::one() + T::one()) * term * term / (s + *r);
            }
        }
        (value, slope)
    };
    let low = -T::one();
    // Infinite there for a point off the plane across the shortest axis.
    let s = if f(low).0 <= T::zero() {
        // Near the middle, in the plane across the shortest axis: the closest point lies off it.
        low
    } else {
        // No term of the sum exceeds 1 at the root, so that none overflows from there on.
        let tightest = squared.iter().zip(&scaled).fold(low, |low, (r, z)| low.max(*r * (*z - T::one())));
        // There the sum is not yet below 1: Newton's method on a falling convex function rises to the root.
        first_of_convex(tightest, T::one(), f).unwrap_or(tightest)
    };
    let mut closest = [T::zero(); N];
    let mut left = T::one();
    for ((c, (r, y)), a) in closest.iter_mut().zip(squared.iter().zip(point)).zip(semi_axes) {
        if s + *r > T::zero() {
            *c = *y / (s / *r + T::one());
            left -= (*c / *a) * (*c / *a);
        }
    }
    if s <= low {
        // Put what is missing on the first of the shortest axes.
        if let Some(((c, r), a)) =
            closest.iter_mut().zip(&squared).zip(semi_axes).find(|((_, r), _)| **r <= T::one())
        {
            let _ = r;
            *c = *a * left.max(T::zero()).root();
        }
    }
    closest
}

#[cfg(test)]
mod tests {
    use super::closest_point;
    use proptest::prelude::*;

    proptest! {
        /// Nothing on the ellipse is closer, by brute force over its angle.
        #[test]
        fn nothing_is_closer(a in 0.1_f64..10.0, b in 0.1_f64..10.0, x in -12.0_f64..12.0, y in -12.0_f64..12.0) {
            let [u, v] = closest_point(&[a, b], &[x, y]);
            prop_assert!(((u / a).powi(2) + (v / b).powi(2) - 1.0).abs() < 1e-9);
            let found = (u - x).hypot(v - y);
            let best = (0..20_000)
                .map(|k| f64::from(k) * core::f64::consts::TAU / 20_000.0)
                .map(|t| (a * t.cos() - x).hypot(b * t.sin() - y))
                .fold(f64::INFINITY, f64::min);
            // The nearest sample is at most half a step aside.
            let step = 1.6e-4 * a.max(b);
            let aside = step * step * (1.0 / found + a.max(b) / a.min(b).powi(2));
            prop_assert!(found <= best + 1e-9 && best <= found + aside + 1e-9, "{found} {best}");
        }
    }

    #[test]
    fn points_on_the_axes_and_in_the_middle() {
        for (point, expected) in [
            ([0.0, 0.0, 0.0], 1.0),
            ([0.1, 0.0, 0.0], 0.99),
            ([3.0, 0.0, 0.0], 0.0),
            ([5.0, 0.0, 0.0], 2.0),
            ([0.0, 0.0, 4.0], 3.0),
        ] {
            let c = closest_point(&[3.0, 2.0, 1.0], &point);
            let distance: f64 = c.iter().zip(&point).map(|(a, b)| (a - b) * (a - b)).sum();
            let on: f64 = c.iter().zip([3.0, 2.0, 1.0]).map(|(c, a)| (c / a) * (c / a)).sum();
            assert!((on - 1.0).abs() < 1e-12);
            if expected != 0.99 {
                assert!((distance.sqrt() - expected).abs() < 1e-12, "{point:?} {c:?}");
            }
        }
    }
}
