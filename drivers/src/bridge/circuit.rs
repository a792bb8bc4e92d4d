//! How a bridge's output follows the change of its gauges.

use fingertip_wrench::Real;
use thiserror::Error;

/// A Poisson ratio that no material of a sensor has.
///
/// ```
/// use fingertip_drivers::bridge::BridgeCircuit;
///
/// let refused = BridgeCircuit::<f64>::full_poisson(0.7).unwrap_err();
/// assert_eq!(refused.to_string(), "a Poisson ratio lies between 0 and 0.5, not at 0.7");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("a Poisson ratio lies between 0 and 0.5, not at {found}")]
pub struct BadPoissonRatio {
    /// The number.
    pub found: f64,
}

/// Which gauges a bridge has, out of four resistors that are equal at rest.
///
/// With x = k·ε, the relative change of resistance of a gauge of factor k under the strain ε, every circuit
/// here gives
///
/// ```text
/// output / excitation = n·x / (d + m·x)       and so      x = d·r / (n − m·r)
/// ```
///
/// exactly, by the rule for voltage dividers (Wheatstone). `m` is zero where opposite changes in one divider
/// keep its current constant; such a bridge is linear.
///
/// ```
/// use fingertip_drivers::bridge::BridgeCircuit;
/// // A thousand µm/m on a quarter bridge with gauges of factor 2: 0.4995 mV/V, not 0.5.
/// let quarter = BridgeCircuit::<f64>::quarter();
/// let ratio = quarter.ratio(2.0 * 1000e-6);
/// assert!((ratio - 0.4995e-3).abs() < 1e-9);
/// assert!((quarter.change(ratio).unwrap_or(f64::NAN) - 2e-3).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeCircuit<T> {
    numerator: T,
    constant: T,
    slope: T,
}

impl<T: Real> BridgeCircuit<T> {
    /// Largest relative change of resistance that is taken for strain. Metal gauges break below 0.1;
    /// semiconductor gauges reach 0.15 in use. What is beyond it is an open or shorted gauge: an open one
    /// in a quarter bridge gives half the excitation.
    pub const GREATEST_CHANGE: f64 = 0.5;

    fn new(numerator: f64, constant: f64, slope: f64) -> Self {
        Self { numerator: T::literal(numerator), constant: T::literal(constant), slope: T::literal(slope) }
    }

    /// One gauge.
    #[must_use]
    pub fn quarter() -> Self {
        Self::new(1.0, 4.0, 2.0)
    }

    /// Two gauges in one divider with opposite strain: the two sides of a beam that bends.
    #[must_use]
    pub fn half_bending() -> Self {
        Self::new(1.0, 2.0, 0.0)
    }

    /// Two gauges in opposite arms with the same strain: both sides of a rod that is pulled.
    #[must_use]
    pub fn half_opposite() -> Self {
        Self::new(1.0, 2.0, 1.0)
    }

    /// Two gauges in one divider, one along the strain and one across it, for a material of this Poisson
    /// ratio.
    ///
    /// # Errors
    /// [`BadPoissonRatio`].
    pub fn half_poisson(poisson: f64) -> Result<Self, BadPoissonRatio> {
        let poisson = checked(poisson)?;
        Ok(Self::new(1.0 + poisson, 4.0, 2.0 * (1.0 - poisson)))
    }

    /// Four gauges, two and two with opposite strain: bending, torsion and shear.
    #[must_use]
    pub fn full() -> Self {
        Self::new(1.0, 1.0, 0.0)
    }

    /// Four gauges, two along the strain and two across it, for a material of this Poisson ratio.
    ///
    /// # Errors
    /// [`BadPoissonRatio`].
    pub fn full_poisson(poisson: f64) -> Result<Self, BadPoissonRatio> {
        let poisson = checked(poisson)?;
        Ok(Self::new(1.0 + poisson, 2.0, 1.0 - poisson))
    }

    /// Output per excitation for a relative change of resistance, of the gauge that is stretched.
    #[inline]
    #[must_use]
    pub fn ratio(&self, change: T) -> T {
        self.numerator * change / (self.constant + self.slope * change)
    }

    /// Relative change of resistance for an output per excitation; `None` where it is no number or beyond
    /// [`GREATEST_CHANGE`](Self::GREATEST_CHANGE).
    #[inline]
    #[must_use]
    pub fn change(&self, ratio: T) -> Option<T> {
        let change = self.constant * ratio / (self.numerator - self.slope * ratio);
        (change.abs() <= T::literal(Self::GREATEST_CHANGE)).then_some(change)
    }

    /// Derivative of [`change`](Self::change): d·n / (n − m·r)².
    #[inline]
    #[must_use]
    pub fn slope_of_change(&self, ratio: T) -> T {
        let rest = self.numerator - self.slope * ratio;
        self.constant * self.numerator / (rest * rest)
    }
}

fn checked(poisson: f64) -> Result<f64, BadPoissonRatio> {
    if (0.0..=0.5).contains(&poisson) { Ok(poisson) } else { Err(BadPoissonRatio { found: poisson }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The output of four resistors by the rule for dividers, which is all that is known of a bridge:
    /// plus input to a, b to minus; the other divider of c and d.
    fn divided(a: f64, b: f64, c: f64, d: f64) -> f64 {
        a / (a + b) - d / (c + d)
    }

    proptest! {
        #[test]
        fn circuits_are_those_of_four_resistors(x in -0.3_f64..0.3, poisson in 0.0_f64..0.5) {
            let (up, down, across) = (1.0 + x, 1.0 - x, 1.0 - poisson * x);
            let cases = [
                (BridgeCircuit::quarter(), divided(up, 1.0, 1.0, 1.0)),
                (BridgeCircuit::half_bending(), divided(up, down, 1.0, 1.0)),
                (BridgeCircuit::half_opposite(), divided(up, 1.0, up, 1.0)),
                (BridgeCircuit::half_poisson(poisson).unwrap(), divided(up, across, 1.0, 1.0)),
                (BridgeCircuit::full(), divided(up, down, up, down)),
                (BridgeCircuit::full_poisson(poisson).unwrap(), divided(up, across, up, across)),
            ];
            for (circuit, expected) in cases {
                let ratio = circuit.ratio(x);
                prop_assert!((ratio - expected).abs() <= 8.0 * f64::EPSILON, "{circuit:?}: {ratio} {expected}");
                let back = circuit.change(ratio).unwrap();
                prop_assert!((back - x).abs() <= 16.0 * f64::EPSILON);
                // The derivative against differences.
                let h = 1e-5;
                let difference = (circuit.change(ratio + h).unwrap() - circuit.change(ratio - h).unwrap()) / (2.0 * h);
                prop_assert!((circuit.slope_of_change(ratio) / difference - 1.0).abs() < 1e-7);
            }
        }

        #[test]
        fn any_ratio_gives_a_change_in_range_or_none(bits in any::<u64>(), narrow in any::<u32>()) {
            for circuit in [BridgeCircuit::quarter(), BridgeCircuit::half_opposite(), BridgeCircuit::full()] {
                if let Some(change) = circuit.change(f64::from_bits(bits)) {
                    prop_assert!(change.abs() <= 0.5);
                }
            }
            if let Some(change) = BridgeCircuit::quarter().change(f32::from_bits(narrow)) {
                prop_assert!(change.abs() <= 0.5);
            }
        }
    }

    #[test]
    fn open_and_shorted_gauges_are_no_strain() {
        let quarter = BridgeCircuit::<f64>::quarter();
        // An open gauge and a shorted one.
        for ratio in [0.5, -0.5, 0.499, f64::NAN, f64::INFINITY, -f64::INFINITY] {
            assert_eq!(quarter.change(ratio), None, "{ratio}");
        }
        for bad in [-0.1, 0.6, f64::NAN] {
            assert!(BridgeCircuit::<f64>::full_poisson(bad).is_err());
        }
    }
}
