//! Where samples come from.

use core::fmt::Debug;

/// What kind of thing went wrong, common to all sources.
///
/// ```
/// use fingertip_drivers::{SourceError, SourceErrorKind};
///
/// /// Whether it is worth trying again, whatever the source is.
/// fn may_pass(error: &impl SourceError) -> bool {
///     matches!(error.kind(), SourceErrorKind::Timeout | SourceErrorKind::Corrupt)
/// }
///
/// use fingertip_drivers::converters::ConverterFault;
/// assert!(may_pass(&ConverterFault::Timeout));
/// assert!(!may_pass(&ConverterFault::Saturated { channel: 0 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SourceErrorKind {
    /// The bus, socket or file failed.
    Transport,
    /// No sample came in time.
    Timeout,
    /// A sample came whose checksum, framing or text is wrong.
    Corrupt,
    /// The device says that its reading is beyond its range.
    Overload,
    /// The device reports a fault of its own.
    DeviceFault,
    /// The device or file does not have what is asked of it.
    Unsupported,
    /// Anything else.
    Other,
}

/// An error of a source: whatever it is, it can say its kind, so that generic code can decide
/// whether to try again.
///
/// For a source of one's own:
///
/// ```
/// use fingertip_drivers::{SourceError, SourceErrorKind};
///
/// #[derive(Debug)]
/// enum GloveError {
///     Unplugged,
///     BadLine { number: u64 },
/// }
///
/// impl SourceError for GloveError {
///     fn kind(&self) -> SourceErrorKind {
///         match self {
///             Self::Unplugged => SourceErrorKind::Transport,
///             Self::BadLine { .. } => SourceErrorKind::Corrupt,
///         }
///     }
/// }
///
/// assert_eq!(GloveError::Unplugged.kind(), SourceErrorKind::Transport);
/// assert_eq!(GloveError::BadLine { number: 7 }.kind(), SourceErrorKind::Corrupt);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not say what kind of error it is",
    note = "an error of your own source implements `SourceError::kind`"
)]
pub trait SourceError: Debug {
    /// What kind of error this is.
    fn kind(&self) -> SourceErrorKind;
}

impl SourceError for core::convert::Infallible {
    fn kind(&self) -> SourceErrorKind {
        match *self {}
    }
}

/// One sample and when it was taken.
///
/// ```
/// use fingertip_drivers::Sample;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector6;
///
/// let wrench: Wrench<f64> = Wrench::from_components(&Vector6::new(0.0, 0.0, -2.0, 0.0, 0.0, 0.0));
/// let (first, second) =
///     (Sample { time: Some(0.5), value: wrench }, Sample { time: Some(0.501), value: wrench });
/// let period = second.time.zip(first.time).map(|(end, start)| end - start);
/// assert!(period.is_some_and(|period: f64| (period - 1e-3).abs() < 1e-12));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<T, V> {
    /// Time of the sample \[s\] on the clock of the device, the file or the script; `None` where
    /// there is none. Never the time at which a library function happened to run.
    pub time: Option<T>,
    /// What was sampled.
    pub value: V,
}

/// Gives samples of `V`, one at a time: the raw signals of `N` channels (an `SVector<T, N>`: converters, recordings
/// of volts, the simulated fingertip) or wrenches (a [`Wrench`](fingertip_wrench::Wrench): force/torque sensors and
/// recordings of them).
///
/// # For users
/// `while let Some(sample) = source.next_sample()? { … }`. A sample that comes is sound: a source
/// answers a corrupt one with an error, never with old or made-up numbers. After an error the next
/// call tries the next sample. Wrenches are the load on the fingertip \[N, N·m\] in the sensor frame; channels are in
/// the unit that the source documents (volts or counts), without tare.
///
/// # For implementers
/// `next_sample` shall return every sample once, in the order in which they were taken, and
/// `Ok(None)` only when there will never be another one.
///
/// ```
/// use core::convert::Infallible;
/// use fingertip_drivers::{Sample, Source};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector6;
///
/// /// Presses harder and harder, by 1 N a second, for so many samples.
/// struct Press {
///     left: u32,
///     time: f64,
/// }
///
/// impl Source<f64, Wrench<f64>> for Press {
///     type Error = Infallible;
///
///     fn next_sample(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, Infallible> {
///         let Some(left) = self.left.checked_sub(1) else { return Ok(None) };
///         let value = Wrench::from_components(&Vector6::new(0.0, 0.0, -self.time, 0.0, 0.0, 0.0));
///         let sample = Sample { time: Some(self.time), value };
///         (self.left, self.time) = (left, self.time + 0.5);
///         Ok(Some(sample))
///     }
/// }
///
/// let (mut press, mut forces) = (Press { left: 3, time: 0.0 }, Vec::new());
/// while let Some(sample) = press.next_sample()? {
///     forces.push(sample.value.force().z);
/// }
/// assert_eq!(forces, [0.0, -0.5, -1.0]);
/// # Ok::<(), Infallible>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` gives no `{V}` with times of `{T}`",
    note = "a sensor of your own implements `Source`; one that does not wait is an `NbSource`, one in tasks an `AsyncSource`"
)]
pub trait Source<T, V> {
    /// What can go wrong.
    type Error: SourceError;

    /// The next sample, or `None` at the end.
    ///
    /// # Errors
    /// Whatever keeps the source from giving a sound sample.
    fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, Self::Error>;
}

impl<T, V, S: Source<T, V> + ?Sized> Source<T, V> for &mut S {
    type Error = S::Error;

    #[inline]
    fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, Self::Error> {
        (**self).next_sample()
    }
}
