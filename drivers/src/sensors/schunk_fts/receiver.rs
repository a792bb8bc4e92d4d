//! From datagrams to wrenches, with an account of what went missing.

use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::wire::{FtsSample, Packet};
use crate::sensors::line::finite_wrench;
use crate::sensors::{LinkStatistics, SequenceWatch};
use crate::{SourceError, SourceErrorKind};

/// What the sensor says is wrong with a sample.
///
/// ```
/// use fingertip_drivers::sensors::schunk_fts::{FtsReceiver, FtsSample, Packet, emit_packet};
///
/// let mut datagram = [0; 7 + FtsSample::LENGTH];
/// let invalid = FtsSample { status: FtsSample::READY | FtsSample::INVALID, ..FtsSample::default() };
/// emit_packet(0, 0, &[invalid], &mut datagram);
/// let packet = Packet::new_checked(&datagram)?;
/// let fault = FtsReceiver::default().accept::<f64>(&packet).unwrap().next().unwrap().unwrap_err();
/// let told = "the sensor gives no valid numbers (status 0x00000003, where 1 is ready and nothing else)";
/// assert_eq!(fault.to_string(), told);
/// # Ok::<(), fingertip_drivers::sensors::schunk_fts::FtsWireError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the sensor gives no valid numbers (status {status:#010x}, where 1 is ready and nothing else)")]
pub struct FtsFault {
    /// The status bits.
    pub status: u32,
}

impl SourceError for FtsFault {
    fn kind(&self) -> SourceErrorKind {
        SourceErrorKind::DeviceFault
    }
}

/// Takes datagrams in the order in which they come and gives the wrenches of those that are news.
///
/// ```
/// use fingertip_drivers::sensors::schunk_fts::{FtsReceiver, FtsSample, Packet, emit_packet};
///
/// let (mut receiver, mut given) = (FtsReceiver::default(), 0);
/// // Datagram 3 is lost, and 2 comes twice.
/// for counter in [1, 2, 2, 4] {
///     let mut datagram = [0; 7 + FtsSample::LENGTH];
///     emit_packet(
///         counter,
///         0,
///         &[FtsSample { status: FtsSample::READY, ..FtsSample::default() }],
///         &mut datagram,
///     );
///     given +=
///         receiver.accept::<f64>(&Packet::new_checked(&datagram)?).map_or(0, |wrenches| wrenches.len());
/// }
/// assert_eq!(given, 3);
/// assert_eq!((receiver.statistics().lost, receiver.statistics().duplicates), (1, 1));
/// # Ok::<(), fingertip_drivers::sensors::schunk_fts::FtsWireError>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct FtsReceiver {
    watch: SequenceWatch,
    /// The newest number, unwrapped to 32 bits.
    newest: Option<u32>,
}

impl FtsReceiver {
    /// Takes a datagram. `None` for one that is late, repeated or of doubtful number: it is counted, and
    /// never given as if it were news. The counter has 16 bits: after a pause of more than 32 767
    /// datagrams, news can look late.
    pub fn accept<'p, T: Real>(
        &mut self,
        packet: &Packet<'p>,
    ) -> Option<impl ExactSizeIterator<Item = Result<Wrench<T>, FtsFault>> + use<'p, T>> {
        let number = self.unwrap(packet.counter());
        let arrival = self.watch.arrive(number);
        if arrival.is_news() {
            self.newest = Some(number);
        }
        arrival.is_news().then(|| packet.samples().map(|sample| Self::wrench(&sample)))
    }

    fn unwrap(&self, counter: u16) -> u32 {
        // What comes before the first one wraps, which does no harm.
        let newest = self.newest.unwrap_or(u32::from(counter));
        #[allow(clippy::cast_possible_truncation, reason = "the low bits are wanted")]
        let ahead = counter.wrapping_sub(newest as u16).cast_signed();
        newest.wrapping_add_signed(i32::from(ahead))
    }

    pub(super) fn wrench<T: Real>(sample: &FtsSample) -> Result<Wrench<T>, FtsFault> {
        let fault = FtsFault { status: sample.status };
        if sample.status != FtsSample::READY {
            return Err(fault);
        }
        finite_wrench(sample.components.map(f64::from)).ok_or(fault)
    }

    /// Notes a datagram that is none.
    pub const fn note_corrupt(&mut self) {
        self.watch.corrupt();
    }

    /// How the link has behaved so far; numbers are of datagrams.
    #[must_use]
    pub const fn statistics(&self) -> &LinkStatistics {
        self.watch.statistics()
    }

    /// How many datagrams the sensor numbered between the first one and the newest one: times their
    /// period, the time of the newest.
    #[must_use]
    pub const fn index(&self) -> u64 {
        self.watch.index()
    }
}
