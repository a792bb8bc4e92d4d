//! A source of signals that becomes a source of wrenches.

use fingertip_wrench::{Compensation, Real, Wrench, WrenchSolver};
use nalgebra::SVector;

use crate::polled::NbSource;
use crate::{AsyncSource, Sample, Source};

/// Wrenches from the signals of `N` gauges: tare (or another compensation) and solver around any source of
/// signals, so that a converter with a calibration is a force/torque sensor like any other.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::middleware::Solved;
/// use fingertip_drivers::playback::SignalPlayback;
/// use fingertip_recordings::RecordingReader;
/// use fingertip_wrench::{GaussianElimination, SensorMatrix, Tare};
/// use nalgebra::{Matrix6, Vector6};
///
/// let file = "s1_V,s2_V,s3_V,s4_V,s5_V,s6_V\n0.5,0.5,2.5,0.5,0.5,0.5\n";
/// let signals = SignalPlayback::<_, 6>::new(RecordingReader::new("example.csv", file.as_bytes())?, "")?;
/// // Gauges that give the components of the wrench, a volt a newton, and half a volt at rest.
/// let solver = GaussianElimination::new(&SensorMatrix::new(Matrix6::identity(), Vector6::repeat(1.0))?)?;
/// let mut sensor = Solved::new(signals, Tare::new(Vector6::repeat(0.5)), solver);
/// assert_eq!(sensor.next_sample()?.unwrap().value.force().z, 2.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Solved<S, Z, W, const N: usize> {
    source: S,
    zero: Z,
    solver: W,
}

impl<S, Z, W, const N: usize> Solved<S, Z, W, N> {
    /// Around a source. Signals must be in the unit that the solver's sensor matrix was made for.
    #[must_use]
    pub const fn new(source: S, zero: Z, solver: W) -> Self {
        Self { source, zero, solver }
    }

    /// The source inside.
    #[must_use]
    pub const fn source(&self) -> &S {
        &self.source
    }

    /// The source inside, to configure or to restart it.
    #[must_use]
    pub const fn source_mut(&mut self) -> &mut S {
        &mut self.source
    }

    /// Sets a new zero.
    pub fn set_zero(&mut self, zero: Z) {
        self.zero = zero;
    }

    fn solved<T: Real>(&self, sample: Option<Sample<T, SVector<T, N>>>) -> Option<Sample<T, Wrench<T>>>
    where
        Z: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
        W: WrenchSolver<T, N>,
    {
        sample.map(|Sample { time, value }| Sample {
            time,
            value: self.solver.solve(&self.zero.compensate(&value)),
        })
    }
}

impl<T: Real, S, Z, W, const N: usize> Source<T, Wrench<T>> for Solved<S, Z, W, N>
where
    S: Source<T, SVector<T, N>>,
    Z: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
    W: WrenchSolver<T, N>,
{
    type Error = S::Error;

    fn next_sample(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, S::Error> {
        let sample = self.source.next_sample()?;
        Ok(self.solved(sample))
    }
}

impl<T: Real, S, Z, W, const N: usize> NbSource<T, Wrench<T>> for Solved<S, Z, W, N>
where
    S: NbSource<T, SVector<T, N>>,
    Z: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
    W: WrenchSolver<T, N>,
{
    type Error = S::Error;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, Wrench<T>>>, S::Error> {
        let sample = self.source.poll_sample()?;
        Ok(self.solved(sample))
    }
}

impl<T: Real, S, Z, W, const N: usize> AsyncSource<T, Wrench<T>> for Solved<S, Z, W, N>
where
    S: AsyncSource<T, SVector<T, N>>,
    Z: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
    W: WrenchSolver<T, N>,
{
    type Error = S::Error;

    async fn next_sample(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, S::Error> {
        let sample = self.source.next_sample().await?;
        Ok(self.solved(sample))
    }
}
