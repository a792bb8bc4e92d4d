//! Robotous' two CAN frames of a reading.

use embedded_can::{ExtendedId, Frame, Id, StandardId};
use fingertip_drivers::sensors::AxisCounts;
use fingertip_drivers::sensors::robotous::{CanAssembler, Reading};
use fingertip_wrench::Wrench;

/// A frame, remote or with data.
#[derive(Clone, Debug)]
struct Bytes {
    id: Id,
    data: Vec<u8>,
    remote: bool,
}

impl Frame for Bytes {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        Some(Self { id: id.into(), data: data.to_vec(), remote: false })
    }
    fn new_remote(id: impl Into<Id>, _: usize) -> Option<Self> {
        Some(Self { id: id.into(), data: Vec::new(), remote: true })
    }
    fn is_extended(&self) -> bool {
        matches!(self.id, Id::Extended(_))
    }
    fn is_remote_frame(&self) -> bool {
        self.remote
    }
    fn id(&self) -> Id {
        self.id
    }
    fn dlc(&self) -> usize {
        self.data.len()
    }
    fn data(&self) -> &[u8] {
        &self.data
    }
}

fn id(number: u16) -> StandardId {
    StandardId::new(number).unwrap()
}

fn assembler() -> CanAssembler {
    CanAssembler::new(AxisCounts::uniform(50.0, 2000.0).unwrap(), id(1), id(2))
}

fn frame(number: u16, data: &[u8]) -> Bytes {
    Bytes::new(id(number), data).unwrap()
}

/// Counts 50, −100, 25, 2000, −1000, 256: the fourth is split between the frames.
const FIRST: [u8; 8] = [0x0B, 0, 50, 0xFF, 0x9C, 0, 25, 0x07];
const SECOND: [u8; 8] = [0xD0, 0xFC, 0x18, 1, 0, 0, 0, 0];

#[test]
fn a_reading_is_split_after_eight_bytes() {
    let mut can = assembler();
    assert_eq!(can.push(&frame(1, &FIRST)), None);
    let reading = can.push(&frame(2, &SECOND)).unwrap();
    let expected = Reading { streamed: true, counts: [50, -100, 25, 2000, -1000, 256], overload: 0 };
    assert_eq!(reading, expected);
    can.push(&frame(1, &FIRST));
    let wrench: Wrench<f64> = can.push_wrench(&frame(2, &SECOND)).unwrap().unwrap();
    assert!((wrench.force().y + 2.0).abs() < 1e-15 && (wrench.torque().x - 1.0).abs() < 1e-15);
    assert_eq!((can.statistics().readings, can.statistics().halves, can.statistics().others), (2, 0, 0));
}

#[test]
fn frames_of_others_and_remote_frames_are_passed_over() {
    let mut can = assembler();
    can.push(&frame(1, &FIRST));
    assert_eq!(can.push(&frame(3, &SECOND)), None);
    // The same number is another identifier if it is extended.
    assert_eq!(can.push(&Bytes::new(ExtendedId::new(2).unwrap(), &SECOND).unwrap()), None);
    let remote = Bytes { remote: true, ..frame(2, &SECOND) };
    assert_eq!(can.push(&remote), None);
    let remote = Bytes { remote: true, ..frame(1, &FIRST) };
    assert_eq!(can.push(&remote), None);
    assert!(can.push(&frame(2, &SECOND)).is_some());
    assert_eq!((can.statistics().readings, can.statistics().halves, can.statistics().others), (1, 0, 0));
}

#[test]
fn what_is_no_reading_is_counted() {
    let mut can = assembler();
    // An answer to another request: two frames of none.
    let mut other = FIRST;
    other[0] = 0x0C;
    can.push(&frame(1, &other));
    assert_eq!(can.push(&frame(2, &SECOND)), None);
    assert_eq!((can.statistics().readings, can.statistics().halves, can.statistics().others), (0, 0, 2));
    // A frame of another length, and the half before it, which lost its other half.
    can.push(&frame(1, &FIRST));
    assert_eq!(can.push(&frame(2, &SECOND[..7])), None);
    assert_eq!((can.statistics().halves, can.statistics().others), (1, 3));
    // A second half alone, and two first halves one behind the other.
    assert_eq!(can.push(&frame(2, &SECOND)), None);
    assert_eq!(can.statistics().halves, 2);
    can.push(&frame(1, &FIRST));
    can.push(&frame(1, &FIRST));
    assert_eq!(can.statistics().halves, 3);
    assert!(can.push(&frame(2, &SECOND)).is_some());
    assert_eq!((can.statistics().readings, can.statistics().halves, can.statistics().others), (1, 3, 3));
}
