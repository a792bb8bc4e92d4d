//! Writes down what passes through.

use crate::polled::NbSource;
use crate::{AsyncSource, Sample, Source};

/// A source whose samples are written down before they are given: to a CSV or MCAP file or a ring buffer, by a
/// closure.
///
/// A disk that is full does not stop the hand: if a sample cannot be written, it is given all the
/// same. The record ends there, so that it has no hole; the reason and the number of samples that
/// are missing at its end are kept for [`failure`](Self::failure) and [`unrecorded`](Self::unrecorded).
/// Ask for them.
///
/// ```
/// use fingertip_drivers::middleware::Recorder;
/// use fingertip_drivers::playback::WrenchPlayback;
/// use fingertip_recordings::{RecordingReader, RecordingWriter, Schema};
/// use fingertip_drivers::{Sample, Source};
/// use fingertip_wrench::Wrench;
///
/// let file = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0.5,0.0,0.0,-1.0,0.0,0.0,0.0\n";
/// let source = WrenchPlayback::new(RecordingReader::new("example.csv", file.as_bytes())?, "")?;
/// let mut copy = RecordingWriter::new(Vec::new(), &Schema::default().time().wrench(""))?;
/// let mut source = Recorder::new(source, |sample: &Sample<f64, Wrench<f64>>| {
///     copy.write_wrench(sample.time.unwrap_or(f64::NAN), &sample.value)
/// });
/// while let Some(_) = source.next_sample()? {}
/// assert!(source.failure().is_none());
/// assert_eq!(copy.finish()?, file.as_bytes());
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
#[derive(Debug)]
pub struct Recorder<S, R, E> {
    source: S,
    record: R,
    failure: Option<E>,
    unrecorded: u64,
}

impl<S, R, E> Recorder<S, R, E> {
    /// Around a source.
    #[must_use]
    pub const fn new(source: S, record: R) -> Self {
        Self { source, record, failure: None, unrecorded: 0 }
    }

    /// Why the record ended early, if it did.
    #[must_use]
    pub const fn failure(&self) -> Option<&E> {
        self.failure.as_ref()
    }

    /// How many samples were given that are not on record.
    #[must_use]
    pub const fn unrecorded(&self) -> u64 {
        self.unrecorded
    }

    /// The source and the record, to close it.
    #[must_use]
    pub fn into_parts(self) -> (S, R) {
        (self.source, self.record)
    }

    fn recorded<T, V>(&mut self, sample: Option<Sample<T, V>>) -> Option<Sample<T, V>>
    where
        R: FnMut(&Sample<T, V>) -> Result<(), E>,
    {
        if let Some(sample) = &sample {
            if self.failure.is_none() {
                self.failure = (self.record)(sample).err();
            }
            self.unrecorded += u64::from(self.failure.is_some());
        }
        sample
    }
}

impl<T, V, S, R, E> Source<T, V> for Recorder<S, R, E>
where
    S: Source<T, V>,
    R: FnMut(&Sample<T, V>) -> Result<(), E>,
{
    type Error = S::Error;

    fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, S::Error> {
        let sample = self.source.next_sample()?;
        Ok(self.recorded(sample))
    }
}

impl<T, V, S, R, E> NbSource<T, V> for Recorder<S, R, E>
where
    S: NbSource<T, V>,
    R: FnMut(&Sample<T, V>) -> Result<(), E>,
{
    type Error = S::Error;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, V>>, S::Error> {
        let sample = self.source.poll_sample()?;
        Ok(self.recorded(sample))
    }
}

impl<T, V, S, R, E> AsyncSource<T, V> for Recorder<S, R, E>
where
    S: AsyncSource<T, V>,
    R: FnMut(&Sample<T, V>) -> Result<(), E>,
{
    type Error = S::Error;

    async fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, S::Error> {
        let sample = self.source.next_sample().await?;
        Ok(self.recorded(sample))
    }
}
