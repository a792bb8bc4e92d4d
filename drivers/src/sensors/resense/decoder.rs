//! From bytes to wrenches, as far as they can be trusted.

use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::wire::Reading;
use crate::sensors::line::{LineDecoder, LineStatistics, finite_wrench};
use crate::{Sample, SourceError, SourceErrorKind};

/// What a reading can be: what is beyond it is taken for bytes that are out of step.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::line::LineSensor;
/// use fingertip_drivers::sensors::resense::{Limits, Reading, ResenseDecoder};
///
/// // A sensor for 100 N: 200 N can be no reading.
/// let limits = Limits { force: 130.0, torque: 3.0, temperature: [0.0, 60.0], temperature_step: 0.5 };
/// let bytes = Reading { force: [0.0, 0.0, -200.0], temperature: 25.0, ..Reading::default() }.emit();
/// let mut sensor = LineSensor::<_, f64, _>::new(&bytes[..], ResenseDecoder::new(limits));
/// assert!(sensor.next_sample().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Greatest magnitude of a force \[N\]: the sensor's range with its reserve.
    pub force: f32,
    /// Greatest magnitude of a torque \[N·m\].
    pub torque: f32,
    /// Least and greatest temperature \[°C\].
    pub temperature: [f32; 2],
    /// Greatest change of the temperature from one reading to the next \[K\].
    pub temperature_step: f32,
}

/// Why there is no wrench.
///
/// A byte was lost on the line:
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::line::LineSensor;
/// use fingertip_drivers::sensors::resense::{Limits, Reading, ResenseDecoder};
///
/// let limits = Limits { force: 130.0, torque: 3.0, temperature: [0.0, 60.0], temperature_step: 0.5 };
/// let reading = Reading { force: [0.1, 0.2, -2.0], temperature: 25.0, ..Reading::default() }.emit();
/// let bytes = [&reading[1..], &reading[..]].concat();
/// let mut sensor = LineSensor::<_, f64, _>::new(&bytes[..], ResenseDecoder::new(limits));
/// let told = "a reading is impossible: the line is out of step; restart when it has been silent";
/// assert_eq!(sensor.next_sample().unwrap_err().to_string(), told);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ResenseFault {
    /// A reading was impossible: the bytes are out of step, or damaged. Nothing more is given until the
    /// decoder is restarted.
    #[error("a reading is impossible: the line is out of step; restart when it has been silent")]
    OutOfStep,
}

impl SourceError for ResenseFault {
    fn kind(&self) -> SourceErrorKind {
        SourceErrorKind::Corrupt
    }
}

/// Decodes what the sensor sends. Samples have no time, and whole readings that are lost, repeated or swapped on
/// the way leave no trace: see the [module](super).
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::line::LineSensor;
/// use fingertip_drivers::sensors::resense::{Limits, Reading, ResenseDecoder};
///
/// let limits = Limits { force: 130.0, torque: 3.0, temperature: [0.0, 60.0], temperature_step: 0.5 };
/// let reading = |fz| Reading { force: [0.0, 0.0, fz], temperature: 25.0, ..Reading::default() }.emit();
/// // No more than 20 N and 0.5 N·m from one reading to the next: one that jumps is not believed.
/// let decoder = ResenseDecoder::new(limits).stepping_at_most(20.0, 0.5);
/// let bytes = [reading(-2.0), reading(-3.0), reading(-90.0)].concat();
/// let mut sensor = LineSensor::<_, f64, _>::new(&bytes[..], decoder);
/// assert_eq!(sensor.next_sample()?.unwrap().value.force().z, -2.0);
/// assert_eq!(sensor.next_sample()?.unwrap().value.force().z, -3.0);
/// assert!(sensor.next_sample().is_err());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ResenseDecoder {
    limits: Limits,
    /// Greatest change of force and torque from one reading to the next.
    steps: [f32; 2],
    last: Option<Reading>,
    /// Within limits, but not near the last one.
    refused: Option<Reading>,
    bytes: [u8; Reading::LENGTH],
    length: usize,
    out_of_step: bool,
    statistics: LineStatistics,
}

impl ResenseDecoder {
    /// Within limits. A reading begins with the first byte that it takes.
    #[must_use]
    pub const fn new(limits: Limits) -> Self {
        let statistics = LineStatistics { frames: 0, failed: 0, skipped: 0 };
        Self {
            limits,
            steps: [f32::INFINITY; 2],
            last: None,
            refused: None,
            bytes: [0; Reading::LENGTH],
            length: 0,
            out_of_step: false,
            statistics,
        }
    }

    /// Takes a reading for impossible, too, if a component changes by more than this \[N, N·m\] from the last
    /// one. Then what damage goes unnoticed is off by no more than that, but for the very first reading. A blow
    /// that is harder costs a reading and a restart: two in a row that agree are believed.
    #[must_use]
    pub const fn stepping_at_most(mut self, force: f32, torque: f32) -> Self {
        self.steps = [force, torque];
        self
    }

    /// Temperature of the last reading \[°C\].
    #[must_use]
    pub const fn temperature(&self) -> Option<f32> {
        match self.last {
            Some(Reading { temperature, .. }) => Some(temperature),
            None => None,
        }
    }

    fn is_within_limits(&self, reading: &Reading) -> bool {
        let Limits { force, torque, temperature: [coldest, hottest], .. } = self.limits;
        let within = |numbers: &[f32], limit: f32| numbers.iter().all(|number| number.abs() <= limit);
        within(&reading.force, force)
            && within(&reading.torque_millinewton_metres, torque * 1e3)
            && (coldest..=hottest).contains(&reading.temperature)
    }

    fn is_near(&self, reading: &Reading, other: &Reading) -> bool {
        let [force, torque] = self.steps;
        let near = |new: &[f32; 3], old: &[f32; 3], limit: f32| {
            new.iter().zip(old).all(|(new, old)| (new - old).abs() <= limit)
        };
        near(&reading.force, &other.force, force)
            && near(&reading.torque_millinewton_metres, &other.torque_millinewton_metres, torque * 1e3)
    }

    /// Whether a reading follows on the last one; or on the one that was refused for not doing so: then the two
    /// bear each other out, and the load has changed in a pause. The temperature must follow on the last good one
    /// in any case: readings that are out of step bear each other out, too, and it is what gives them away.
    fn is_possible(&mut self, reading: &Reading) -> bool {
        let step = self.last.map_or(0.0, |last| (reading.temperature - last.temperature).abs());
        if !self.is_within_limits(reading) || !(step <= self.limits.temperature_step) {
            return false;
        }
        let refused = self.refused.replace(*reading);
        let mut others = self.last.iter().chain(&refused);
        self.last.is_none() || others.any(|other| self.is_near(reading, other))
    }
}

impl<T: Real> LineDecoder<T> for ResenseDecoder {
    type Fault = ResenseFault;
    /// Some 18 readings.
    const PATIENCE: usize = 500;

    fn push(&mut self, byte: u8) -> Option<Result<Sample<T, Wrench<T>>, ResenseFault>> {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        }
        if self.length < Reading::LENGTH {
            return None;
        }
        self.length = 0;
        let reading = Reading::parse(&self.bytes);
        self.out_of_step = self.out_of_step || !self.is_possible(&reading);
        let [fx, fy, fz] = reading.force.map(f64::from);
        let [tx, ty, tz] = reading.torque_millinewton_metres.map(|torque| f64::from(torque) * 1e-3);
        let wrench = finite_wrench([fx, fy, fz, tx, ty, tz]).filter(|_| !self.out_of_step);
        Some(match wrench {
            Some(value) => {
                (self.last, self.refused) = (Some(reading), None);
                self.statistics.frames += 1;
                Ok(Sample { time: None, value })
            }
            None => {
                self.statistics.failed += 1;
                self.statistics.skipped += Reading::LENGTH as u64;
                Err(ResenseFault::OutOfStep)
            }
        })
    }

    fn restart(&mut self) {
        self.statistics.skipped += self.length as u64;
        (self.length, self.out_of_step) = (0, false);
    }

    fn statistics(&self) -> LineStatistics {
        self.statistics
    }
}
