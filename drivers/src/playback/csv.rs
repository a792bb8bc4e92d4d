//! A recording as a source of samples.

use std::io::Read;

use fingertip_recordings::{
    HeaderProblem, Quality, RecordingError, RecordingReader, SignalColumns, WrenchColumns,
};
use fingertip_wrench::Wrench;
use nalgebra::SVector;

use crate::{Sample, Source};

/// The wrenches of one sensor of a recording, as a [`Source`].
///
/// Rows without a sound wrench are passed over: ask [`quality`](Self::quality) how many there were.
/// Read row by row to see each.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::playback::WrenchPlayback;
/// use fingertip_recordings::RecordingReader;
///
/// let file = "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,-1,0,0,0\n0,0,nan,0,0,0\n0,0,-3,0,0,0\n";
/// let mut playback = WrenchPlayback::new(RecordingReader::new("example.csv", file.as_bytes())?, "")?;
/// let mut forces = Vec::new();
/// while let Some(sample) = playback.next_sample()? {
///     forces.push(sample.value.force().z);
/// }
/// assert_eq!(forces, [-1.0, -3.0]);
/// assert_eq!(playback.quality().not_finite_cells.first_lines(), [3]);
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
#[derive(Debug)]
pub struct WrenchPlayback<R> {
    reader: RecordingReader<R>,
    sensor: WrenchColumns,
}

/// The signals of one sensor with `N` gauges of a recording, as a [`Source`]; without the
/// dummy gauge. Rows are passed over as by [`WrenchPlayback`].
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::playback::SignalPlayback;
/// use fingertip_recordings::RecordingReader;
///
/// let file = "s1_V,s2_V,s3_V\n0.1,0.2,0.3\n";
/// let mut playback =
///     SignalPlayback::<_, 3>::new(RecordingReader::new("example.csv", file.as_bytes())?, "")?;
/// assert_eq!(playback.next_sample()?.unwrap().value.as_slice(), [0.1, 0.2, 0.3]);
/// // It must have as many gauges as are asked for.
/// assert!(SignalPlayback::<_, 6>::new(RecordingReader::new("example.csv", file.as_bytes())?, "").is_err());
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
#[derive(Debug)]
pub struct SignalPlayback<R, const N: usize> {
    reader: RecordingReader<R>,
    sensor: SignalColumns,
}

impl<R: Read> WrenchPlayback<R> {
    /// Plays a sensor by its name; an empty name means the only one.
    ///
    /// # Errors
    /// [`RecordingError::Header`] if there is no such sensor, or several to choose from.
    pub fn new(reader: RecordingReader<R>, sensor: &str) -> Result<Self, RecordingError> {
        let layout = reader.layout();
        let found = layout.wrench(sensor).or_else(|problem| only(sensor, problem, || layout.only_wrench()));
        let sensor = found.cloned().map_err(|problem| reader.header_error(problem))?;
        Ok(Self { reader, sensor })
    }

    /// What was wrong so far.
    #[must_use]
    pub const fn quality(&self) -> &Quality {
        self.reader.quality()
    }
}

impl<R: Read, const N: usize> SignalPlayback<R, N> {
    /// Plays a sensor by its name; an empty name means the only one.
    ///
    /// # Errors
    /// [`RecordingError::Header`] if there is no such sensor, several to choose from, or one that has
    /// not `N` signals.
    pub fn new(reader: RecordingReader<R>, sensor: &str) -> Result<Self, RecordingError> {
        let layout = reader.layout();
        let found =
            layout.signals_of(sensor).or_else(|problem| only(sensor, problem, || layout.only_signals()));
        let found = found.and_then(|signals| signals.expecting(N));
        let sensor = found.cloned().map_err(|problem| reader.header_error(problem))?;
        Ok(Self { reader, sensor })
    }

    /// What was wrong so far.
    #[must_use]
    pub const fn quality(&self) -> &Quality {
        self.reader.quality()
    }
}

/// Without a name, the only sensor; with one, the problem that it is not there.
fn only<T>(
    sensor: &str,
    problem: HeaderProblem,
    only: impl FnOnce() -> Result<T, HeaderProblem>,
) -> Result<T, HeaderProblem> {
    if sensor.is_empty() { only() } else { Err(problem) }
}

impl<R: Read> Source<f64, Wrench<f64>> for WrenchPlayback<R> {
    type Error = RecordingError;

    fn next_sample(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, RecordingError> {
        while let Some(row) = self.reader.next_row()? {
            if let Some(value) = row.wrench(&self.sensor) {
                return Ok(Some(Sample { time: row.time(), value }));
            }
        }
        Ok(None)
    }
}

impl<R: Read, const N: usize> Source<f64, SVector<f64, N>> for SignalPlayback<R, N> {
    type Error = RecordingError;

    fn next_sample(&mut self) -> Result<Option<Sample<f64, SVector<f64, N>>>, RecordingError> {
        while let Some(row) = self.reader.next_row()? {
            if let Some(value) = row.signals(&self.sensor) {
                return Ok(Some(Sample { time: row.time(), value }));
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "t_s,a_v1_V,a_v2_V,b_v0,b_v1\n0,1,2,3,4\n0.1,5,6,,8\n";

    fn signals(sensor: &str) -> Result<SignalPlayback<&'static [u8], 2>, RecordingError> {
        SignalPlayback::new(RecordingReader::new("test.csv", FILE.as_bytes())?, sensor)
    }

    #[test]
    fn each_sensor_is_played_by_its_name() {
        for (sensor, expected) in [("A", vec![(0.0, 1.0), (0.1, 5.0)]), ("b", vec![(0.0, 3.0)])] {
            let mut playback = signals(sensor).unwrap();
            let mut seen = Vec::new();
            while let Some(sample) = playback.next_sample().unwrap() {
                seen.push((sample.time.unwrap(), sample.value.x));
            }
            assert_eq!(seen, expected);
        }
    }

    #[test]
    fn a_sensor_that_cannot_be_meant_is_an_error() {
        let said = |error: RecordingError| error.to_string();
        assert!(said(signals("").unwrap_err()).contains("choose one of: a, b"));
        assert!(said(signals("c").unwrap_err()).contains("no signals of a sensor “c”; there is: a, b"));
        let reader = || RecordingReader::new("test.csv", FILE.as_bytes()).unwrap();
        let six = SignalPlayback::<_, 6>::new(reader(), "a").unwrap_err();
        assert!(said(six).contains("there are 2 signals of sensor a, and 6 are needed"));
        assert!(said(WrenchPlayback::new(reader(), "").unwrap_err()).contains("no wrench"));
    }
}
