//! From records to wrenches, with an account of what went missing.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;
use thiserror::Error;

use super::wire::Record;
use crate::sensors::{Arrival, LinkStatistics, SequenceWatch};
use crate::{SourceError, SourceErrorKind};

/// How many counts a newton and a newton metre are.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::CountsPerUnit;
///
/// let wrench = CountsPerUnit::<f64>::million()?.wrench(&[0, 0, -2_000_000, 0, 13_000, 0]);
/// assert!((wrench.force().z + 2.0).abs() < 1e-12 && (wrench.torque().y - 0.013).abs() < 1e-12);
/// # Ok::<(), fingertip_drivers::sensors::ati_rdt::RdtError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountsPerUnit<T> {
    newtons_per_count: T,
    newton_metres_per_count: T,
}

/// Why a record gives no wrench, or a receiver cannot be made.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::{CountsPerUnit, Receiver, Record};
///
/// let mut receiver = Receiver::<f64>::new(CountsPerUnit::million()?);
/// let saturated = Record { rdt_sequence: 1, status: 0x8002_0000, ..Record::default() };
/// let told = "record 1: the sensor reports status 0x80020000; see the status word in its manual";
/// assert_eq!(receiver.accept(&saturated).unwrap_err().to_string(), told);
/// # Ok::<(), fingertip_drivers::sensors::ati_rdt::RdtError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RdtError {
    /// Counts per unit that are not positive and finite.
    #[error("the counts per {quantity} must be positive and finite")]
    BadCounts {
        /// Newton or newton metre.
        quantity: &'static str,
    },
    /// The sensor says that something is wrong: saturated gauges, a bad supply …
    #[error("record {sequence}: the sensor reports status {status:#010x}; see the status word in its manual")]
    Status {
        /// Number of the record.
        sequence: u32,
        /// The status word.
        status: u32,
    },
}

impl SourceError for RdtError {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::BadCounts { .. } => SourceErrorKind::Unsupported,
            Self::Status { .. } => SourceErrorKind::DeviceFault,
        }
    }
}

impl<T: Real> CountsPerUnit<T> {
    /// From counts per newton and per newton metre. A sensor set to other units has counts per
    /// those: divide by what one of them is in newtons or newton metres.
    ///
    /// # Errors
    /// [`RdtError::BadCounts`] unless both are positive and finite.
    pub fn new(per_newton: T, per_newton_metre: T) -> Result<Self, RdtError> {
        let inverse = |counts: T, quantity| {
            let inverse = T::one() / counts;
            if counts > T::zero() && counts.is_number() && inverse.is_number() {
                Ok(inverse)
            } else {
                Err(RdtError::BadCounts { quantity })
            }
        };
        Ok(Self {
            newtons_per_count: inverse(per_newton, "newton")?,
            newton_metres_per_count: inverse(per_newton_metre, "newton metre")?,
        })
    }

    /// The factory setting of most Net F/T and Axia sensors: a million counts per unit.
    ///
    /// # Errors
    /// None; the same form as [`new`](Self::new).
    pub fn million() -> Result<Self, RdtError> {
        Self::new(T::literal(1e6), T::literal(1e6))
    }

    /// OnRobot (OptoForce) sensors: 10 000 counts per newton, 100 000 per newton metre.
    ///
    /// # Errors
    /// None; the same form as [`new`](Self::new).
    pub fn onrobot() -> Result<Self, RdtError> {
        Self::new(T::literal(1e4), T::literal(1e5))
    }

    /// The numbers of a record in N and N·m, signs as the sensor has them.
    #[must_use]
    pub fn components(&self, counts: &[i32; 6]) -> (Vector3<T>, Vector3<T>) {
        let [fx, fy, fz, tx, ty, tz] = counts.map(|count| T::literal(f64::from(count)));
        (
            Vector3::new(fx, fy, fz) * self.newtons_per_count,
            Vector3::new(tx, ty, tz) * self.newton_metres_per_count,
        )
    }

    /// The load on the fingertip. ATI sensors report the load that is applied to their tool side,
    /// which is ours.
    #[must_use]
    pub fn wrench(&self, counts: &[i32; 6]) -> Wrench<T> {
        let (force, torque) = self.components(counts);
        Wrench::on_fingertip(force, torque)
    }
}

/// Takes records in the order in which they come and gives the wrenches of those that are news.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::{CountsPerUnit, Receiver, Record};
///
/// let mut receiver = Receiver::<f64>::new(CountsPerUnit::million()?);
/// // Record 3 is lost, and 2 comes twice.
/// let mut given = Vec::new();
/// for rdt_sequence in [1, 2, 2, 4] {
///     let record = Record { rdt_sequence, counts: [0, 0, -1_000_000, 0, 0, 0], ..Record::default() };
///     given.extend(receiver.accept(&record)?.map(|_| rdt_sequence));
/// }
/// assert_eq!(given, [1, 2, 4]);
/// assert_eq!((receiver.statistics().lost, receiver.statistics().duplicates), (1, 1));
/// # Ok::<(), fingertip_drivers::sensors::ati_rdt::RdtError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Receiver<T> {
    counts: CountsPerUnit<T>,
    watch: SequenceWatch,
}

impl<T: Real> Receiver<T> {
    /// For a sensor with these counts per unit.
    #[must_use]
    pub fn new(counts: CountsPerUnit<T>) -> Self {
        Self { counts, watch: SequenceWatch::default() }
    }

    /// Takes a record. `Ok(None)` for one that is late, repeated or of doubtful number: it is
    /// counted, and never given as if it were news.
    ///
    /// # Errors
    /// [`RdtError::Status`] if the sensor reports a fault in a record that is news.
    pub fn accept(&mut self, record: &Record) -> Result<Option<Wrench<T>>, RdtError> {
        let arrival: Arrival = self.watch.arrive(record.rdt_sequence);
        if !arrival.is_news() {
            return Ok(None);
        }
        if record.status != 0 {
            return Err(RdtError::Status { sequence: record.rdt_sequence, status: record.status });
        }
        Ok(Some(self.counts.wrench(&record.counts)))
    }

    /// Notes a datagram that is no record.
    pub const fn note_corrupt(&mut self) {
        self.watch.corrupt();
    }

    /// How the link has behaved so far.
    #[must_use]
    pub const fn statistics(&self) -> &LinkStatistics {
        self.watch.statistics()
    }

    /// How many records the sensor numbered between the first one and the newest one: times the
    /// period of its RDT rate, the time of the newest wrench.
    #[must_use]
    pub const fn index(&self) -> u64 {
        self.watch.index()
    }
}
