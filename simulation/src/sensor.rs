//! The sensor behind a fingertip: from a load to what its converter reports.

use fingertip_wrench::{SensorMatrix, Wrench};
use nalgebra::SVector;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use crate::error::{SimulationError, positive};
use crate::fingertip::Options;
use crate::imperfections::BuiltSensor;
use crate::thermal_drift::Temperature;

/// A sensor as it was built, with its warmth and its noise: what one fingertip has, and each of a hand.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedSensor {
    options: Options,
    built: BuiltSensor,
    nominal_matrix: SensorMatrix<f64, 6>,
    random: Pcg64Mcg,
    temperature: Temperature,
    samples: u64,
    dummy: f64,
}

/// What the sensor makes of one load.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Converted {
    /// When \[s\].
    pub(crate) time: f64,
    /// The six gauges and the dummy gauge \[V\].
    pub(crate) raw: SVector<f64, 7>,
    /// Warming since the start \[K\].
    pub(crate) temperature: f64,
    /// Whether a channel was at the end of the converter's range.
    pub(crate) saturated: bool,
}

impl SimulatedSensor {
    pub(crate) fn new(options: Options) -> Result<Self, SimulationError> {
        positive(options.sample_rate, "sample rate")?;
        let electronics = options.electronics.checked()?;
        let drift = options.thermal_drift.checked()?;
        let mut random = Pcg64Mcg::seed_from_u64(options.seed);
        let built =
            BuiltSensor::new(&options.design, &electronics, &drift, &options.imperfections, &mut random)?;
        let nominal_matrix =
            options.design.layout()?.sensor_matrix(electronics.gain(), options.design.nominal_loads())?;
        let temperature = Temperature::new(drift, options.sample_rate);
        Ok(Self { options, built, nominal_matrix, random, temperature, samples: 0, dummy: 0.0 })
    }

    pub(crate) const fn options(&self) -> &Options {
        &self.options
    }

    /// As a calibration found it.
    pub(crate) const fn calibrated_matrix(&self) -> &SensorMatrix<f64, 6> {
        &self.built.calibrated_matrix
    }

    /// Of the gauges where they really are.
    pub(crate) const fn true_matrix(&self) -> &SensorMatrix<f64, 6> {
        &self.built.true_matrix
    }

    /// Of the drawing.
    pub(crate) const fn nominal_matrix(&self) -> &SensorMatrix<f64, 6> {
        &self.nominal_matrix
    }

    /// The time of the next sample \[s\].
    pub(crate) fn time(&self) -> f64 {
        #[allow(clippy::cast_precision_loss, reason = "exact for 10^15 samples")]
        let samples = self.samples as f64;
        samples / self.options.sample_rate
    }

    /// The next sample, under a load about the centre of the sphere.
    pub(crate) fn convert(&mut self, wrench: &Wrench<f64>) -> Converted {
        let time = self.time();
        self.samples += 1;
        let temperature = self.temperature.next(time, &mut self.random);
        let (raw, saturated) = self.read(wrench, temperature);
        Converted { time, raw, temperature, saturated }
    }

    /// What the electronics make of a load and a temperature, and whether a channel saturates.
    fn read(&mut self, wrench: &Wrench<f64>, temperature: f64) -> (SVector<f64, 7>, bool) {
        let electronics = &self.options.electronics;
        let strains = self.built.strains * wrench.components();
        // The dummy gauge carries no load.
        let mut raw = strains.push(0.0);
        let mut any_saturated = false;
        for (channel, value) in raw.iter_mut().enumerate() {
            let of = |values: &[f64; 7]| values.get(channel).copied().unwrap_or_default();
            let strain = *value + of(&self.built.apparent_strain) * temperature;
            let bridge = electronics.bridge(strain) * of(&self.built.gains);
            let input = bridge + of(&self.built.unbalance) + of(&self.built.offset_drift) * temperature;
            let (volts, saturated) = electronics.sample(input, &mut self.random);
            *value = volts;
            any_saturated |= saturated;
        }
        // First-order average, started with the plain mean so that it is as good from the first.
        let settled = electronics.dummy_averaging * self.options.sample_rate;
        #[allow(clippy::cast_precision_loss, reason = "exact for 10^15 samples")]
        let weight = 1.0 / (self.samples as f64).min(settled).max(1.0);
        self.dummy += (raw[6] - self.dummy) * weight;
        raw[6] = self.dummy;
        (raw, any_saturated)
    }
}
