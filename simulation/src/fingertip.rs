//! The simulated fingertip itself.

use core::convert::Infallible;

use fingertip_surfaces::Sphere;
use fingertip_wrench::{GaugesAndDummy, SensorMatrix, Wrench};
use nalgebra::{SVector, Vector6};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use crate::design::Design;
use crate::electronics::Electronics;
use crate::error::{SimulationError, positive};
use crate::imperfections::{BuiltSensor, Imperfections};
use crate::script::Script;
use crate::thermal_drift::{Temperature, ThermalDrift};
use crate::timeline::{Phase, Timeline, TrueContact};
use fingertip_drivers::{Sample, Source};

/// Everything that can be chosen about a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Samples per second: 1000.
    pub sample_rate: f64,
    /// The seed of all that is random.
    pub seed: u64,
    /// Geometry and material.
    pub design: Design,
    /// Bridges, amplifiers, converter.
    pub electronics: Electronics,
    /// Temperature.
    pub thermal_drift: ThermalDrift,
    /// Gluing and calibration.
    pub imperfections: Imperfections,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            sample_rate: 1000.0,
            seed: 1,
            design: Design::default(),
            electronics: Electronics::default(),
            thermal_drift: ThermalDrift::default(),
            imperfections: Imperfections::default(),
        }
    }
}

/// What the electronics read, and what was really so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulatedSample {
    /// Time \[s\].
    pub time: f64,
    /// The six gauges and the dummy gauge \[V\], as the converter reports them.
    pub raw: SVector<f64, 7>,
    /// What was really so.
    pub truth: Truth,
}

/// What was really so when a sample was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Truth {
    /// The load on the fingertip.
    pub wrench: Wrench<f64>,
    /// What touched, if anything.
    pub contact: Option<TrueContact>,
    /// Warming since the start \[K\].
    pub temperature: f64,
    /// Whether the object was sliding.
    pub slipping: bool,
    /// Index of the phase, see [`SimulatedFingertip::phases`].
    pub phase: usize,
    /// Whether a channel was at the end of the converter's range.
    pub saturated: bool,
}

impl SimulatedSample {
    /// The reading as the [`DummyGauge`](fingertip_wrench::DummyGauge) compensation takes it.
    #[must_use]
    pub fn reading(&self) -> GaugesAndDummy<f64, 6> {
        let [v1, v2, v3, v4, v5, v6, dummy] = self.raw.into();
        GaugesAndDummy { gauges: Vector6::new(v1, v2, v3, v4, v5, v6), dummy }
    }
}

/// Plays a [`Script`] on the paper's sensor: an iterator of [`SimulatedSample`]s, and a
/// [`Source`] of seven channels (six gauges and the dummy gauge).
#[derive(Clone, Debug)]
pub struct SimulatedFingertip {
    options: Options,
    sphere: Sphere<f64>,
    built: BuiltSensor,
    nominal_matrix: SensorMatrix<f64, 6>,
    timeline: Timeline,
    random: Pcg64Mcg,
    temperature: Temperature,
    samples: u64,
    phase: usize,
    dummy: f64,
}

impl SimulatedFingertip {
    /// Builds the sensor and works out the script.
    ///
    /// # Errors
    /// [`SimulationError`] for parameters out of range or a script that cannot be played.
    pub fn new(script: &Script, options: Options) -> Result<Self, SimulationError> {
        positive(options.sample_rate, "sample rate")?;
        let sphere = options.design.sphere()?;
        let electronics = options.electronics.checked()?;
        let drift = options.thermal_drift.checked()?;
        let timeline = Timeline::new(script, &options.design)?;
        let mut random = Pcg64Mcg::seed_from_u64(options.seed);
        let built =
            BuiltSensor::new(&options.design, &electronics, &drift, &options.imperfections, &mut random)?;
        let nominal_matrix =
            options.design.layout()?.sensor_matrix(electronics.gain(), options.design.nominal_loads())?;
        let temperature = Temperature::new(drift, options.sample_rate);
        Ok(Self {
            options,
            sphere,
            built,
            nominal_matrix,
            timeline,
            random,
            temperature,
            samples: 0,
            phase: 0,
            dummy: 0.0,
        })
    }

    /// The sensor matrix \[V\] as a calibration found it: what a user of the sensor has.
    #[must_use]
    pub const fn calibrated_matrix(&self) -> &SensorMatrix<f64, 6> {
        &self.built.calibrated_matrix
    }

    /// The sensor matrix \[V\] of the gauges where they really are.
    #[must_use]
    pub const fn true_matrix(&self) -> &SensorMatrix<f64, 6> {
        &self.built.true_matrix
    }

    /// The sensor matrix \[V\] of the drawing, as one has it before any calibration.
    #[must_use]
    pub const fn nominal_matrix(&self) -> &SensorMatrix<f64, 6> {
        &self.nominal_matrix
    }

    /// The fingertip's surface.
    #[must_use]
    pub const fn sphere(&self) -> Sphere<f64> {
        self.sphere
    }

    /// What was chosen.
    #[must_use]
    pub const fn options(&self) -> &Options {
        &self.options
    }

    /// The segments of the script with their times.
    #[must_use]
    pub fn phases(&self) -> &[Phase] {
        &self.timeline.phases
    }

    /// When it begins to slip, each time \[s\].
    #[must_use]
    pub fn slip_onsets(&self) -> &[f64] {
        &self.timeline.slip_onsets
    }

    /// How long the script takes \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.timeline.end()
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

impl Iterator for SimulatedFingertip {
    type Item = SimulatedSample;

    /// The next sample, or `None` at the end of the script.
    fn next(&mut self) -> Option<SimulatedSample> {
        #[allow(clippy::cast_precision_loss, reason = "exact for 10^15 samples")]
        let time = self.samples as f64 / self.options.sample_rate;
        let phase = loop {
            let phase = self.timeline.phases.get(self.phase)?;
            if time < phase.end {
                break phase;
            }
            self.phase += 1;
        };
        self.samples += 1;
        let (load, slipping) = phase.load(time);
        let contact = load.contact(self.options.design.sphere_radius);
        let wrench = contact.map_or_else(Wrench::zero, |contact| contact.wrench());
        let temperature = self.temperature.next(time, &mut self.random);
        let (raw, saturated) = self.read(&wrench, temperature);
        let truth = Truth { wrench, contact, temperature, slipping, phase: self.phase, saturated };
        Some(SimulatedSample { time, raw, truth })
    }
}

impl Source<f64, SVector<f64, 7>> for SimulatedFingertip {
    type Error = Infallible;

    fn next_sample(&mut self) -> Result<Option<Sample<f64, SVector<f64, 7>>>, Infallible> {
        Ok(self.next().map(|sample| Sample { time: Some(sample.time), value: sample.raw }))
    }
}
