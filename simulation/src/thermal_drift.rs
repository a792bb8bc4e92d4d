//! The temperature and what the gauges make of it.

use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use crate::error::{SimulationError, not_negative, positive};

/// Slow warming of the finger, and the strain that it feigns.
///
/// Warming by 2 K with a time constant of 300 s: a metal finger that starts to handle things at
/// body temperature in still air. Draughts add a random walk of 2 mK per √s. A gauge whose alloy is
/// matched to aluminium feigns about 2 µm/m per kelvin; gauges of one lot differ by 5 % of
/// that. The amplifiers' offsets drift by 0.25 µV/K, each its own way: that is what the dummy gauge
/// cannot take off.
///
/// ```
/// use fingertip_simulation::{Options, Script, SimulatedFingertip, ThermalDrift};
///
/// let warms = |thermal_drift| {
///     let options = Options { thermal_drift, ..Options::default() };
///     let fingertip = SimulatedFingertip::new(&Script::default().rest(10.0), options)?;
///     let temperatures: Vec<f64> = fingertip.map(|sample| sample.truth.temperature).collect();
///     Ok::<_, fingertip_simulation::SimulationError>(temperatures[9_999] - temperatures[0])
/// };
/// assert_eq!(warms(ThermalDrift::none())?, 0.0);
/// // 2 K with a time constant of 300 s, and a draught.
/// assert!((warms(ThermalDrift::default())? - 0.066).abs() < 0.03);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermalDrift {
    /// Final warming \[K\].
    pub warming: f64,
    /// Time constant of the warming \[s\].
    pub time_constant: f64,
    /// Random walk of the temperature \[K/√s\].
    pub random_walk: f64,
    /// Feigned strain per kelvin, in common.
    pub apparent_strain: f64,
    /// Standard deviation of a gauge's own coefficient, as a share of the common one.
    pub spread: f64,
    /// Standard deviation of the drift of an amplifier's offset at its input \[V/K\].
    pub offset_drift: f64,
}

impl Default for ThermalDrift {
    fn default() -> Self {
        Self {
            warming: 2.0,
            time_constant: 300.0,
            random_walk: 2e-3,
            apparent_strain: 2e-6,
            spread: 0.05,
            offset_drift: 0.25e-6,
        }
    }
}

impl ThermalDrift {
    /// A temperature that stays.
    #[must_use]
    pub fn none() -> Self {
        Self { warming: 0.0, random_walk: 0.0, ..Self::default() }
    }

    pub(super) fn checked(self) -> Result<Self, SimulationError> {
        positive(self.time_constant, "time constant of the warming")?;
        not_negative(self.random_walk, "random walk of the temperature")?;
        not_negative(self.spread, "spread of the apparent strain")?;
        not_negative(self.offset_drift, "offset drift")?;
        for (value, parameter) in [(self.warming, "warming"), (self.apparent_strain, "apparent strain")] {
            if !value.is_finite() {
                return Err(SimulationError::BadParameter { parameter, requirement: "finite" });
            }
        }
        Ok(self)
    }
}

/// The temperature from sample to sample.
#[derive(Clone, Debug)]
pub(super) struct Temperature {
    drift: ThermalDrift,
    walk: f64,
    step: f64,
}

impl Temperature {
    pub(super) fn new(drift: ThermalDrift, sample_rate: f64) -> Self {
        Self { drift, walk: 0.0, step: drift.random_walk / sample_rate.sqrt() }
    }

    /// Change of the temperature since the start \[K\].
    pub(super) fn next(&mut self, time: f64, random: &mut Pcg64Mcg) -> f64 {
        let pace: f64 = StandardNormal.sample(random);
        self.walk += self.step * pace;
        -self.drift.warming * (-time / self.drift.time_constant).exp_m1() + self.walk
    }
}
