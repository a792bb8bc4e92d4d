//! How much a force speaks for a load.

use fingertip_wrench::Real;
use nalgebra::Vector3;

/// The likelihood of a force under a load of `size` deviations in an unknown direction, all directions alike, over that
/// of noise alone: its logarithm (`docs/theory/contact.md#contact-events`).
///
/// With `r` the magnitude of the force in deviations and `λ` that of the load, `ln(sinh(λr)/(λr)) − λ²/2`: the Gaussian
/// `exp(λ r·d − λ²/2)` averaged over the directions `d`. It depends on the magnitude alone and grows with it.
#[inline]
pub(super) fn for_load<T: Real>(magnitude: T, size: T) -> T {
    let half = T::literal(0.5);
    // Twice it is in the range of the type.
    let y = (magnitude * size).min(T::GREATEST * T::literal(0.25));
    let shape = if y < T::literal(1e-2) {
        // The next term of the series is y⁴/180.
        y * y * T::literal(1.0 / 6.0)
    } else {
        y + ((T::one() - (-(y + y)).exponential()) / (y + y)).logarithm()
    };
    shape - size * size * half
}

/// The magnitude of a force in deviations; `None` if a component is not finite.
#[inline]
pub(super) fn magnitude<T: Real>(force: &Vector3<T>, deviation: T) -> Option<T> {
    let scale = force.amax().normalising_factor();
    let scaled = force * scale;
    let length = scaled.norm_squared().root() / scale / deviation;
    if length.is_number() {
        return Some(length);
    }
    // Beyond the range of the type, though the force is not.
    (force.x.is_number() && force.y.is_number() && force.z.is_number()).then_some(T::GREATEST)
}

/// A sum of evidence that starts anew wherever nothing speaks for the change (Page 1954). With the logarithms of
/// likelihood ratios, false alarms are at least `e^h` samples apart in the mean at the threshold `h` (Lorden 1971).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Evidence<T: Real> {
    sum: T,
    /// Since when there is some [s].
    pub(super) since: T,
}

impl<T: Real> Evidence<T> {
    pub(super) fn none() -> Self {
        Self { sum: T::zero(), since: T::zero() }
    }

    /// Takes the evidence of a sample, bounded by the threshold: whether it is enough. `Some(false)` while there is some,
    /// `None` if nothing speaks for a change.
    #[inline]
    pub(super) fn add(&mut self, evidence: T, threshold: T, time: T) -> Option<bool> {
        let bounded = evidence.min(threshold).max(-threshold);
        if self.sum > T::zero() {
            self.since += time;
        } else {
            self.since = T::zero();
        }
        self.sum += bounded;
        if self.sum > T::zero() {
            return Some(self.sum >= threshold);
        }
        *self = Self::none();
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{for_load, magnitude};
    use nalgebra::Vector3;

    /// The average over the directions by the midpoint rule in the cosine, which is uniform on a sphere.
    fn by_quadrature(r: f64, size: f64) -> f64 {
        let parts = 20_000;
        let sum: f64 = (0..parts)
            .map(|k| {
                let cosine = (2.0 * f64::from(k) + 1.0) / f64::from(parts) - 1.0;
                (size * r * cosine - size * size / 2.0).exp()
            })
            .sum();
        (sum / f64::from(parts)).ln()
    }

    #[test]
    fn the_evidence_is_the_average_over_all_directions() {
        for r in [0.0, 1e-4, 1e-3, 0.1, 1.0, 3.0, 8.0] {
            for size in [0.05, 0.5, 2.0, 5.0] {
                let exact = by_quadrature(r, size);
                assert!((for_load(r, size) - exact).abs() < 1e-5 * (1.0 + exact.abs()), "{r} {size}");
                let narrow = f64::from(for_load(r as f32, size as f32));
                assert!((narrow - exact).abs() < 1e-4 * (1.0 + exact.abs()), "{r} {size} {narrow} {exact}");
            }
        }
        assert!(for_load(f64::MAX, 3.0) > 1e307 && for_load(f32::MAX, 3.0) > 1e37);
        assert!(for_load(f64::MAX, 3.0).is_finite() && for_load(f32::MAX, 3.0).is_finite());
    }

    #[test]
    fn magnitudes_keep_to_the_range() {
        assert_eq!(magnitude(&Vector3::new(3.0, 0.0, -4.0), 0.5), Some(10.0));
        assert_eq!(magnitude(&Vector3::repeat(f32::MAX), 0.5), Some(f32::MAX));
        assert_eq!(magnitude(&Vector3::new(0.0, f32::NAN, 0.0), 0.5), None);
        assert_eq!(magnitude(&Vector3::new(0.0, f32::INFINITY, 0.0), 0.5), None);
        assert_eq!(magnitude(&Vector3::<f32>::zeros(), 0.5), Some(0.0));
    }
}
