//! How gauges are wired: quarter, half and full bridges.

use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

use super::DesignError;

/// One Wheatstone bridge. Arms 0 and 2 lie opposite each other and add, arms 1 and 3 subtract; an
/// arm without a gauge is a fixed resistor.
///
/// ```text
///        ┌── arm 0 ──┬── arm 3 ──┐
///  +Vs ──┤        − Vout +       ├── ground      Vout/Vs = (R0·R2 − R1·R3)/((R0+R1)(R2+R3))
///        └ ...  arm 1    arm 2   ┘
/// ```
///
/// To first order the output is `Vs·K/4·(ε0 − ε1 + ε2 − ε3)` with the gauge factor `K`; what is
/// in the brackets is called the bridge's *strain* here.
///
/// ```
/// use fingertip_calibration::design::Bridge;
/// use fingertip_calibration::nalgebra::Vector6;
///
/// // Two gauges on opposite sides of a beam: bending stretches one and shortens the other, a pull stretches both.
/// let above = Vector6::new(2e-6, 0.0, 5e-6, 0.0, 0.0, 0.0);
/// let below = Vector6::new(2e-6, 0.0, -5e-6, 0.0, 0.0, 0.0);
/// let bridge = Bridge::half(0, 1);
/// let strain = bridge.response(&[above, below])?;
/// assert!(strain[0].abs() < 1e-15 && (strain[2] - 10e-6).abs() < 1e-15);
/// assert!(bridge.compensates_temperature() && !Bridge::quarter(0).compensates_temperature());
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bridge {
    /// First adding arm: a number of a gauge, from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arm0: Option<usize>,
    /// First subtracting arm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arm1: Option<usize>,
    /// Second adding arm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arm2: Option<usize>,
    /// Second subtracting arm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arm3: Option<usize>,
}

impl Bridge {
    /// One gauge and three resistors: the paper's wiring. Feels temperature.
    #[must_use]
    pub const fn quarter(gauge: usize) -> Self {
        Self { arm0: Some(gauge), arm1: None, arm2: None, arm3: None }
    }

    /// Two gauges: the second is subtracted from the first.
    #[must_use]
    pub const fn half(plus: usize, minus: usize) -> Self {
        Self { arm0: Some(plus), arm1: Some(minus), arm2: None, arm3: None }
    }

    /// Two gauges in opposite arms, which add.
    #[must_use]
    pub const fn half_opposite(first: usize, second: usize) -> Self {
        Self { arm0: Some(first), arm1: None, arm2: Some(second), arm3: None }
    }

    /// Four gauges.
    #[must_use]
    pub const fn full(plus: [usize; 2], minus: [usize; 2]) -> Self {
        Self { arm0: Some(plus[0]), arm1: Some(minus[0]), arm2: Some(plus[1]), arm3: Some(minus[1]) }
    }

    /// The arms in order.
    #[must_use]
    pub const fn arms(&self) -> [Option<usize>; 4] {
        [self.arm0, self.arm1, self.arm2, self.arm3]
    }

    /// `true` if a strain common to all its gauges, as temperature makes it, cancels: as many arms
    /// subtract as add.
    #[must_use]
    pub fn compensates_temperature(&self) -> bool {
        let [a, b, c, d] = self.arms().map(|arm| i32::from(arm.is_some()));
        a + c == b + d
    }

    /// The bridge's strain `ε0 − ε1 + ε2 − ε3` per unit load, from that of the gauges.
    ///
    /// # Errors
    /// [`DesignError::NoSuchPart`] if an arm names a gauge that is not there, and
    /// [`DesignError::WrongCount`] if no arm has a gauge.
    pub fn response(&self, gauges: &[Vector6<f64>]) -> Result<Vector6<f64>, DesignError> {
        self.validate(gauges.len())?;
        let mut sum = Vector6::zeros();
        for (arm, sign) in self.arms().into_iter().zip([1.0, -1.0, 1.0, -1.0]) {
            if let Some(strain) = arm.and_then(|gauge| gauges.get(gauge)) {
                sum += strain * sign;
            }
        }
        Ok(sum)
    }

    /// # Errors
    /// As [`response`](Self::response), for a sensor with this number of gauges.
    pub fn validate(&self, gauges: usize) -> Result<(), DesignError> {
        let used = self.arms().into_iter().flatten();
        if let Some(index) = used.clone().find(|index| *index >= gauges) {
            return Err(DesignError::NoSuchPart { what: "an arm of a bridge", index, count: gauges });
        }
        if used.count() == 0 {
            return Err(DesignError::WrongCount { what: "gauges in a bridge", found: 0, expected: 1 });
        }
        Ok(())
    }

    /// Output over supply, exactly: what the linear formula leaves out is a fraction of the order
    /// of the strain (for a quarter bridge `Kε/4 ÷ (1 + Kε/2)`). `strains` are those of the four
    /// arms; of an arm without a gauge it is ignored.
    #[must_use]
    pub fn exact_ratio(&self, strains: [f64; 4], gauge_factor: f64) -> f64 {
        let mut resistance = [1.0; 4];
        for ((value, arm), strain) in resistance.iter_mut().zip(self.arms()).zip(strains) {
            if arm.is_some() {
                *value += gauge_factor * strain;
            }
        }
        let [a, b, c, d] = resistance;
        (a * c - b * d) / ((a + b) * (c + d))
    }
}

/// What turns strain into volts.
///
/// ```
/// use fingertip_calibration::design::Excitation;
///
/// // 5 V, a gauge factor of 2 and an amplifier of 500: 1250 V for each unit of strain, 1.25 mV for a millionth.
/// let excitation = Excitation { supply: 5.0, gauge_factor: 2.0, amplifier_gain: 500.0 };
/// assert!((excitation.gain() - 1250.0).abs() < 1e-9);
/// assert!(Excitation { supply: 0.0, ..excitation }.validate().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Excitation {
    /// Supply of the bridges \[V\].
    #[serde(rename = "supply_V")]
    pub supply: f64,
    /// Gauge factor K: about 2 for metal foil, 100 to 150 for silicon.
    pub gauge_factor: f64,
    /// Gain of the amplifier.
    pub amplifier_gain: f64,
}

impl Excitation {
    /// Volts per unit strain of a bridge: `Vs·K/4·gain`.
    #[must_use]
    pub fn gain(&self) -> f64 {
        self.supply * self.gauge_factor / 4.0 * self.amplifier_gain
    }

    /// # Errors
    /// [`DesignError::OutOfRange`] unless all are positive and finite.
    pub fn validate(&self) -> Result<(), DesignError> {
        DesignError::check_positive("bridge supply", self.supply)?;
        DesignError::check_positive("gauge factor", self.gauge_factor)?;
        DesignError::check_positive("amplifier gain", self.amplifier_gain)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Bridge;
    use nalgebra::Vector6;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn linear_formula_is_the_limit_of_the_exact_one(
            strains in proptest::array::uniform4(-1e-3..1e-3_f64), present in 1..16_u8,
        ) {
            let arm = |i: usize| (present >> i & 1 == 1).then_some(i);
            let bridge = Bridge { arm0: arm(0), arm1: arm(1), arm2: arm(2), arm3: arm(3) };
            let rows = strains.map(|strain| Vector6::new(strain, 0.0, 0.0, 0.0, 0.0, 0.0));
            let linear = 2.0 / 4.0 * bridge.response(&rows).unwrap()[0];
            let exact = bridge.exact_ratio(strains, 2.0);
            // Second order: at most K²ε²/4 for each of the four products.
            prop_assert!((exact - linear).abs() <= 4.0 * 1e-6, "{exact} {linear}");
            let tenth = bridge.exact_ratio(strains.map(|x| x * 1e-3), 2.0);
            prop_assert!((tenth - linear * 1e-3).abs() <= 4.1e-12);
        }
    }

    /// A quarter bridge of gauges of factor 2 gives half the strain times its supply.
    #[test]
    fn gain_is_that_of_a_bridge() {
        let excitation = super::Excitation { supply: 3.0, gauge_factor: 2.0, amplifier_gain: 400.0 };
        assert_eq!(excitation.gain(), 600.0);
        assert!(excitation.validate().is_ok());
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(super::Excitation { supply: bad, ..excitation }.validate().is_err());
            assert!(super::Excitation { gauge_factor: bad, ..excitation }.validate().is_err());
            assert!(super::Excitation { amplifier_gain: bad, ..excitation }.validate().is_err());
        }
    }

    #[test]
    fn quarter_bridge_has_its_known_curve() {
        let (k, strain) = (2.0, 5e-3);
        let ratio = Bridge::quarter(0).exact_ratio([strain, 9.0, 9.0, 9.0], k);
        assert!((ratio - k * strain / (4.0 + 2.0 * k * strain)).abs() < 1e-16);
    }

    #[test]
    fn full_bridge_in_pure_bending_is_four_times_as_large_and_exactly_linear() {
        let strain = 4e-3;
        let full = Bridge::full([0, 1], [2, 3]);
        let ratio = full.exact_ratio([strain, -strain, strain, -strain], 2.0);
        assert!((ratio - 2.0 * strain).abs() < 1e-16);
    }

    #[test]
    fn temperature_cancels_where_it_should() {
        assert!(!Bridge::quarter(0).compensates_temperature());
        assert!(!Bridge::half_opposite(0, 1).compensates_temperature());
        for bridge in [Bridge::half(0, 1), Bridge::full([0, 1], [2, 3])] {
            assert!(bridge.compensates_temperature());
            assert!(bridge.exact_ratio([2e-3; 4], 2.0).abs() < 1e-18);
        }
    }

    #[test]
    fn refuses_gauges_that_are_not_there() {
        let rows = [Vector6::zeros(); 2];
        assert!(Bridge::half(0, 2).response(&rows).is_err());
        let empty = Bridge { arm0: None, arm1: None, arm2: None, arm3: None };
        assert!(empty.response(&rows).is_err());
    }
}
