//! The two CAN frames of a reading, joined.

use embedded_can::{Frame, Id};
use fingertip_wrench::{Real, Wrench};

use super::decoder::{RobotousFault, wrench};
use super::wire::Reading;
use crate::sensors::axis_counts::AxisCounts;

/// What came over CAN so far.
///
/// ```
/// use embedded_can::{Frame, StandardId};
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::robotous::{CanAssembler, Reading, SimulatedFrame};
///
/// let [first, second] = [1, 2].map(|number| StandardId::new(number).unwrap());
/// let mut assembler = CanAssembler::new(AxisCounts::uniform(50.0, 2000.0)?, first, second);
/// let bytes = Reading::default().emit();
/// // The second half of one reading is dropped; the next one is whole.
/// for (id, half) in [(first, &bytes[..8]), (first, &bytes[..8]), (second, &bytes[8..])] {
///     assembler.push(&SimulatedFrame::new(id, half).unwrap());
/// }
/// assert_eq!((assembler.statistics().readings, assembler.statistics().halves), (1, 1));
/// # Ok::<(), fingertip_drivers::sensors::BadAxisCounts>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct CanStatistics {
    /// Readings whose two frames came.
    pub readings: u64,
    /// Frames of the sensor without the other half.
    pub halves: u64,
    /// Frames of the sensor that are none of a reading: of another length, or answers to other
    /// requests.
    pub others: u64,
}

/// Joins the two frames of each reading.
///
/// CAN itself checks frames with a CRC of 15 bits and repeats damaged ones, so a frame that comes is
/// sound, and frames come in order. What can go missing is a frame that a full receive buffer drops. A
/// half without its other half is dropped and counted. If the second frame of one reading and the
/// first of the next are both dropped, two halves that do not belong together are joined: the sensor sends
/// nothing by which to tell. Give the receive buffer room for an even number of frames.
///
/// ```
/// use embedded_can::{Frame, StandardId};
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::robotous::{CanAssembler, Reading, SimulatedFrame};
///
/// let [first, second] = [1, 2].map(|number| StandardId::new(number).unwrap());
/// let mut assembler = CanAssembler::new(AxisCounts::uniform(50.0, 2000.0)?, first, second);
/// let bytes = Reading { counts: [0, 0, -100, 0, 0, 0], ..Reading::default() }.emit();
/// let frames = [(first, &bytes[..8]), (second, &bytes[8..])]
///     .map(|(id, half)| SimulatedFrame::new(id, half).unwrap());
/// assert!(assembler.push_wrench::<f64>(&frames[0]).is_none());
/// let wrench = assembler.push_wrench::<f64>(&frames[1]).unwrap()?;
/// assert!((wrench.force().z + 2.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CanAssembler {
    counts: AxisCounts,
    first: Id,
    second: Id,
    held: Option<[u8; 8]>,
    statistics: CanStatistics,
}

impl CanAssembler {
    /// For a sensor that sends the first half of its readings under one identifier and the second under
    /// another, as it is set.
    #[must_use]
    pub fn new(counts: AxisCounts, first: impl Into<Id>, second: impl Into<Id>) -> Self {
        let (first, second) = (first.into(), second.into());
        Self { counts, first, second, held: None, statistics: CanStatistics::default() }
    }

    /// Takes a frame from the bus; the reading that it completes. Frames with other identifiers are
    /// passed over.
    pub fn push(&mut self, frame: &impl Frame) -> Option<Reading> {
        let is_first = frame.id() == self.first;
        if frame.is_remote_frame() || !(is_first || frame.id() == self.second) {
            return None;
        }
        let Ok(data) = <[u8; 8]>::try_from(frame.data()) else {
            self.statistics.others += 1;
            self.drop_half();
            return None;
        };
        if is_first {
            self.drop_half();
            self.held = Some(data);
            return None;
        }
        let Some(first) = self.held.take() else {
            self.statistics.halves += 1;
            return None;
        };
        let mut bytes = [0; Reading::LENGTH];
        for (place, byte) in bytes.iter_mut().zip(first.into_iter().chain(data)) {
            *place = byte;
        }
        let reading = Reading::parse(&bytes);
        match reading {
            Some(_) => self.statistics.readings += 1,
            None => self.statistics.others += 2,
        }
        reading
    }

    /// Takes a frame from the bus; the wrench of the reading that it completes.
    pub fn push_wrench<T: Real>(&mut self, frame: &impl Frame) -> Option<Result<Wrench<T>, RobotousFault>> {
        self.push(frame).map(|reading| wrench(&self.counts, &reading))
    }

    fn drop_half(&mut self) {
        self.statistics.halves += u64::from(self.held.take().is_some());
    }

    /// What came so far.
    #[must_use]
    pub const fn statistics(&self) -> &CanStatistics {
        &self.statistics
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_can::StandardId;
    use proptest::prelude::*;

    #[derive(Clone, Debug)]
    struct Classic(Id, Vec<u8>);

    impl Frame for Classic {
        fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
            (data.len() <= 8).then(|| Self(id.into(), data.to_vec()))
        }
        fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
            None
        }
        fn is_extended(&self) -> bool {
            matches!(self.0, Id::Extended(_))
        }
        fn is_remote_frame(&self) -> bool {
            false
        }
        fn id(&self) -> Id {
            self.0
        }
        fn dlc(&self) -> usize {
            self.1.len()
        }
        fn data(&self) -> &[u8] {
            &self.1
        }
    }

    fn id(number: u16) -> StandardId {
        StandardId::new(number).unwrap()
    }

    fn assembler() -> CanAssembler {
        CanAssembler::new(AxisCounts::uniform(50.0, 2000.0).unwrap(), id(1), id(2))
    }

    fn halves(number: i16) -> [Classic; 2] {
        let bytes = Reading { streamed: true, counts: [number, 0, 0, 0, 0, number], overload: 0 }.emit();
        [Classic::new(id(1), &bytes[..8]).unwrap(), Classic::new(id(2), &bytes[8..]).unwrap()]
    }

    #[test]
    fn halves_are_joined_and_single_ones_dropped() {
        let mut can = assembler();
        let ([a, b], [c, d]) = (halves(100), halves(200));
        assert!(can.push(&b).is_none() && can.push(&a).is_none() && can.push(&c).is_none());
        assert!(can.push(&Classic(id(7).into(), vec![0; 8])).is_none());
        let wrench: Wrench<f64> = can.push_wrench(&d).unwrap().unwrap();
        assert_eq!((wrench.force().x, wrench.torque().z), (4.0, 0.1));
        assert!(can.push(&Classic(id(1).into(), vec![0; 3])).is_none());
        assert_eq!(*can.statistics(), CanStatistics { readings: 1, halves: 2, others: 1 });
        let overloaded = Reading { streamed: true, overload: 0x20, ..Reading::default() }.emit();
        can.push(&Classic(id(1).into(), overloaded[..8].to_vec()));
        let fault = can.push_wrench::<f64>(&Classic(id(2).into(), overloaded[8..].to_vec()));
        assert_eq!(fault, Some(Err(RobotousFault::Overload { bits: 0x20 })));
    }

    proptest! {
        /// Single losses only: two in a row are what the format cannot tell.
        #[test]
        fn with_single_frames_lost_nothing_wrong_is_joined(lost in prop::collection::vec(0_usize..8, 1..100)) {
            let mut can = assembler();
            let (mut since_loss, mut given) = (0, 0);
            for (number, lost) in lost.iter().enumerate() {
                for (half, frame) in halves(number as i16).iter().enumerate() {
                    since_loss += 1;
                    if *lost == half && since_loss > 2 {
                        since_loss = 0;
                    } else if let Some(reading) = can.push(frame) {
                        prop_assert_eq!(reading.counts[0], reading.counts[5]);
                        given += 1;
                    }
                }
            }
            prop_assert_eq!(can.statistics().readings, given);
        }

        #[test]
        fn any_frames_are_taken(frames in prop::collection::vec((1_u16..4, prop::collection::vec(any::<u8>(), 0..9)), 0..50)) {
            let mut can = assembler();
            for (number, data) in frames {
                can.push(&Classic(id(number).into(), data));
            }
        }
    }
}
