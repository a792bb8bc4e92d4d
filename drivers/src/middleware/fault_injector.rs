//! Breaks a source on purpose.

use fingertip_wrench::{Real, Wrench};
use nalgebra::SVector;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use thiserror::Error;

use crate::{Sample, Source, SourceError, SourceErrorKind};

/// What happens to samples: probabilities between 0 and 1, taken in this order; at most one happens
/// to a sample.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::middleware::{FaultInjector, SampleFaults};
/// use fingertip_drivers::playback::WrenchPlayback;
/// use fingertip_recordings::RecordingReader;
///
/// let rows: String = (0..100).map(|time| format!("{time},0,0,-1,0,0,0\n")).collect();
/// let file = format!("time_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n{rows}");
/// let playback = WrenchPlayback::new(RecordingReader::new("example.csv", file.as_bytes())?, "")?;
/// // Spikes of 50 N, or 50 N·m, in one sample in ten.
/// let faults = SampleFaults { spike: 0.1, spike_size: 50.0, ..SampleFaults::default() };
/// let (mut source, mut spikes) = (FaultInjector::new(playback, faults), 0);
/// while let Some(sample) = source.next_sample()? {
///     spikes += u64::from(sample.value.components().amax() > 40.0);
/// }
/// assert!(spikes > 0 && spikes == source.injections().spikes);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampleFaults {
    /// The sample is lost.
    pub loss: f64,
    /// It comes twice.
    pub duplication: f64,
    /// It comes behind the one after it.
    pub reorder: f64,
    /// An error comes in its place.
    pub error: f64,
    /// One component is not a number. No sound source does this; a pipeline must survive it.
    pub not_a_number: f64,
    /// One component is far off.
    pub spike: f64,
    /// The value freezes: this sample and the following ones have the value of the one before.
    pub freeze: f64,
    /// How many samples a freeze lasts.
    pub freeze_length: u32,
    /// What is added by a spike, in the unit of the component.
    pub spike_size: f64,
    /// Seed of the chance.
    pub seed: u64,
}

/// What was done so far.
///
/// ```
/// use fingertip_drivers::middleware::{FaultInjector, SampleFaults, Watched};
/// use fingertip_drivers::playback::WrenchPlayback;
/// use fingertip_recordings::RecordingReader;
///
/// let rows: String = (0..100).map(|time| format!("{time},0,0,-{time},0,0,0\n")).collect();
/// let file = format!("time_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n{rows}");
/// let playback = WrenchPlayback::new(RecordingReader::new("example.csv", file.as_bytes())?, "")?;
/// // A watch notices every sample that was frozen.
/// let faults = SampleFaults { freeze: 0.1, freeze_length: 3, ..SampleFaults::default() };
/// let mut watched = Watched::new(FaultInjector::new(playback, faults), None);
/// while watched.next_fresh(0.0)?.is_some() {}
/// let injections = *watched.source().injections();
/// assert!(injections.frozen > 0 && injections.frozen == watched.counts().repeated);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Injections {
    /// Samples lost.
    pub lost: u64,
    /// Samples given twice.
    pub duplicated: u64,
    /// Samples given behind their successor.
    pub reordered: u64,
    /// Errors given in place of a sample.
    pub errors: u64,
    /// Samples with a NaN.
    pub not_a_number: u64,
    /// Samples with a spike.
    pub spikes: u64,
    /// Samples whose value was frozen.
    pub frozen: u64,
}

/// An error of the source, or one that was injected.
///
/// ```
/// use fingertip_drivers::converters::ConverterFault;
/// use fingertip_drivers::middleware::InjectedError;
/// use fingertip_drivers::{SourceError, SourceErrorKind};
///
/// let injected = InjectedError::<ConverterFault>::Injected;
/// assert_eq!(injected.kind(), SourceErrorKind::Corrupt);
/// assert_eq!(injected.to_string(), "an injected fault: the sample is corrupt");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum InjectedError<E> {
    /// Of the source inside.
    #[error(transparent)]
    Source(E),
    /// Injected: as of a frame whose checksum is wrong.
    #[error("an injected fault: the sample is corrupt")]
    Injected,
}

impl<E: SourceError> SourceError for InjectedError<E> {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Source(error) => error.kind(),
            Self::Injected => SourceErrorKind::Corrupt,
        }
    }
}

/// What has components that can be broken.
trait Components<T>: Copy {
    fn component_mut(&mut self, index: usize, change: impl FnOnce(&mut T));
}

impl<T: Real> Components<T> for Wrench<T> {
    fn component_mut(&mut self, index: usize, change: impl FnOnce(&mut T)) {
        let mut components = self.components();
        components.get_mut(index % 6).map(change);
        *self = Self::from_components(&components);
    }
}

impl<T: Real, const N: usize> Components<T> for SVector<T, N> {
    fn component_mut(&mut self, index: usize, change: impl FnOnce(&mut T)) {
        self.as_mut_slice().get_mut(index % N.max(1)).map(change);
    }
}

/// A source with faults. `V` is what it gives: `Wrench<T>`, or `SVector<T, N>` for signals.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::middleware::{FaultInjector, SampleFaults};
/// use fingertip_drivers::playback::WrenchPlayback;
/// use fingertip_recordings::RecordingReader;
///
/// let rows: String = (0..100).map(|time| format!("{time},0,0,-1,0,0,0\n")).collect();
/// let file = format!("time_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n{rows}");
/// let playback = WrenchPlayback::new(RecordingReader::new("example.csv", file.as_bytes())?, "")?;
/// let faults = SampleFaults { loss: 0.2, ..SampleFaults::default() };
/// let (mut source, mut given) = (FaultInjector::new(playback, faults), 0);
/// while source.next_sample()?.is_some() {
///     given += 1;
/// }
/// assert_eq!(given + source.injections().lost, 100);
/// assert!(given < 100);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FaultInjector<S, T, V> {
    source: S,
    faults: SampleFaults,
    random: Pcg64Mcg,
    injections: Injections,
    /// Given before anything else is asked of the source.
    waiting: Option<Sample<T, V>>,
    last: Option<Sample<T, V>>,
    freeze: u32,
}

impl<S, T: Real, V: Copy> FaultInjector<S, T, V> {
    /// Around a source.
    #[must_use]
    pub fn new(source: S, faults: SampleFaults) -> Self {
        let random = Pcg64Mcg::seed_from_u64(faults.seed);
        Self {
            source,
            faults,
            random,
            injections: Injections::default(),
            waiting: None,
            last: None,
            freeze: 0,
        }
    }

    /// What was done so far.
    #[must_use]
    pub const fn injections(&self) -> &Injections {
        &self.injections
    }

    /// The source inside.
    #[must_use]
    pub const fn source(&self) -> &S {
        &self.source
    }
}

impl<T: Real, V: Copy + Components<T>, S: Source<T, V>> Source<T, V> for FaultInjector<S, T, V> {
    type Error = InjectedError<S::Error>;

    fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, Self::Error> {
        if let Some(sample) = self.waiting.take() {
            return Ok(Some(sample));
        }
        loop {
            let Some(mut sample) = self.source.next_sample().map_err(InjectedError::Source)? else {
                return Ok(None);
            };
            if let (true, Some(last)) = (self.freeze > 0, self.last) {
                self.freeze -= 1;
                self.injections.frozen += 1;
                return Ok(Some(Sample { value: last.value, ..sample }));
            }
            let chance: f64 = self.random.random();
            let axis: usize = self.random.random_range(0..64);
            let f = self.faults;
            let limits = [f.loss, f.duplication, f.reorder, f.error, f.not_a_number, f.spike, f.freeze];
            let mut sum = 0.0;
            let fault = limits.iter().position(|limit| {
                sum += limit;
                chance < sum
            });
            match fault {
                Some(0) => {
                    self.injections.lost += 1;
                    continue;
                }
                Some(1) => {
                    self.injections.duplicated += 1;
                    self.waiting = Some(sample);
                }
                Some(2) => {
                    if let Some(following) = self.source.next_sample().map_err(InjectedError::Source)? {
                        self.injections.reordered += 1;
                        self.waiting = Some(sample);
                        sample = following;
                    }
                }
                Some(3) => {
                    self.injections.errors += 1;
                    return Err(InjectedError::Injected);
                }
                Some(4) => {
                    self.injections.not_a_number += 1;
                    sample.value.component_mut(axis, |component| *component = T::literal(f64::NAN));
                    return Ok(Some(sample));
                }
                Some(5) => {
                    self.injections.spikes += 1;
                    let size = T::literal(f.spike_size);
                    sample.value.component_mut(axis, |component| *component += size);
                    return Ok(Some(sample));
                }
                Some(6) => {
                    if let Some(last) = self.last {
                        self.freeze = f.freeze_length.saturating_sub(1);
                        self.injections.frozen += 1;
                        return Ok(Some(Sample { value: last.value, ..sample }));
                    }
                }
                _ => {}
            }
            self.last = Some(sample);
            return Ok(Some(sample));
        }
    }
}
