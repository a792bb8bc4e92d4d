//! The simulated fingertip itself.

use core::convert::Infallible;

use fingertip_surfaces::Sphere;
use fingertip_wrench::{GaugesAndDummy, SensorMatrix, Wrench};
use nalgebra::{SVector, Vector6};

use crate::design::Design;
use crate::electronics::Electronics;
use crate::error::{SimulationError, positive};
use crate::imperfections::Imperfections;
use crate::script::Script;
use crate::sensor::{Converted, SimulatedSensor};
use crate::thermal_drift::ThermalDrift;
use crate::timeline::{Phase, Timeline, TrueContact};
use fingertip_drivers::{Sample, Source};

/// Everything that can be chosen about a simulation.
///
/// ```
/// use fingertip_simulation::{Imperfections, Options, Script, SimulatedFingertip};
///
/// // As fast as the sensor can be read, and built as it was drawn.
/// let options = Options { sample_rate: 5000.0, imperfections: Imperfections::none(), ..Options::default() };
/// let fingertip = SimulatedFingertip::new(&Script::default().rest(0.1), options)?;
/// assert_eq!(fingertip.count(), 500);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
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
///
/// ```
/// use fingertip_simulation::{Options, Script, SimulatedFingertip, SurfacePoint};
///
/// let script = Script::default().rest(0.1).press(SurfacePoint::TOP, 5.0, 0.1).hold(0.1);
/// let samples: Vec<_> = SimulatedFingertip::new(&script, Options::default())?.collect();
/// let (before, after) = (samples[50], samples[250]);
/// // The gauges answer to the press; the dummy gauge, to nothing but the temperature.
/// let (rest, pressed) = (before.reading(), after.reading());
/// assert!((pressed.gauges - rest.gauges).amax() > 0.05);
/// assert!((pressed.dummy - rest.dummy).abs() < 0.01);
/// assert!((after.truth.wrench.force().norm() - 5.0).abs() < 1e-9);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
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
///
/// ```
/// use fingertip_simulation::{Options, Script, SimulatedFingertip, SurfacePoint};
///
/// let script = Script::default().press(SurfacePoint::TOP, 2.0, 0.1).drag(0.0, (0.5, 0.35), 0.1, 0.05);
/// let fingertip = SimulatedFingertip::new(&script, Options::default())?;
/// let slips = fingertip.filter(|sample| sample.truth.slipping);
/// let contact = slips.last().and_then(|sample| sample.truth.contact).ok_or("it slips")?;
/// let ratio = contact.contact_force().friction_ratio().ok_or("it presses")?;
/// assert!((ratio - 0.35).abs() < 1e-3); // what is left once it slides
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_simulation::{Options, SimulatedFingertip, standard_session};
///
/// // As a driver reads it: seven channels, sample by sample.
/// let mut fingertip = SimulatedFingertip::new(&standard_session(), Options::default())?;
/// let sample = fingertip.next_sample()?.ok_or("a sample")?;
/// assert_eq!((sample.time, sample.value.len()), (Some(0.0), 7));
/// // The same seed gives the same session.
/// let again = SimulatedFingertip::new(&standard_session(), Options::default())?.next().ok_or("a sample")?;
/// assert_eq!(again.raw, sample.value);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedFingertip {
    sensor: SimulatedSensor,
    sphere: Sphere<f64>,
    timeline: Timeline,
    phase: usize,
}

impl SimulatedFingertip {
    /// Builds the sensor and works out the script.
    ///
    /// # Errors
    /// [`SimulationError`] for parameters out of range or a script that cannot be played.
    pub fn new(script: &Script, options: Options) -> Result<Self, SimulationError> {
        positive(options.sample_rate, "sample rate")?;
        let sphere = options.design.sphere()?;
        let timeline = Timeline::new(script, &options.design)?;
        Ok(Self { sensor: SimulatedSensor::new(options)?, sphere, timeline, phase: 0 })
    }

    /// The sensor matrix \[V\] as a calibration found it: what a user of the sensor has.
    #[must_use]
    pub const fn calibrated_matrix(&self) -> &SensorMatrix<f64, 6> {
        self.sensor.calibrated_matrix()
    }

    /// The sensor matrix \[V\] of the gauges where they really are.
    #[must_use]
    pub const fn true_matrix(&self) -> &SensorMatrix<f64, 6> {
        self.sensor.true_matrix()
    }

    /// The sensor matrix \[V\] of the drawing, as one has it before any calibration.
    #[must_use]
    pub const fn nominal_matrix(&self) -> &SensorMatrix<f64, 6> {
        self.sensor.nominal_matrix()
    }

    /// The fingertip's surface.
    #[must_use]
    pub const fn sphere(&self) -> Sphere<f64> {
        self.sphere
    }

    /// What was chosen.
    #[must_use]
    pub const fn options(&self) -> &Options {
        self.sensor.options()
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
}

impl Iterator for SimulatedFingertip {
    type Item = SimulatedSample;

    /// The next sample, or `None` at the end of the script.
    fn next(&mut self) -> Option<SimulatedSample> {
        let time = self.sensor.time();
        let phase = loop {
            let phase = self.timeline.phases.get(self.phase)?;
            if time < phase.end {
                break phase;
            }
            self.phase += 1;
        };
        let (load, slipping) = phase.load(time);
        let contact = load.contact(self.sensor.options().design.sphere_radius);
        let wrench = contact.map_or_else(Wrench::zero, |contact| contact.wrench());
        let Converted { time, raw, temperature, saturated } = self.sensor.convert(&wrench);
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
