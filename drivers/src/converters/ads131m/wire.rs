//! The bytes of a frame.

use crc::{CRC_16_IBM_3740, Crc};

use crate::converters::{ConverterFault, sign_extended};

/// CRC-16/IBM-3740: the CCITT polynomial with seed 0xFFFF, not reflected.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// Bytes of a word.
const WORD: usize = 3;
/// Bytes of the longest frame: eight channels, answer and CRC.
pub(super) const LONGEST: usize = 10 * WORD;

/// Addresses of registers.
///
/// ```
/// use fingertip_drivers::converters::ads131m::Register;
///
/// // The configuration of channel 2.
/// assert_eq!(Register::CH0_CFG + 2 * Register::PER_CHANNEL, 0x13);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Register;

#[allow(missing_docs, reason = "named as in the data sheet, and listed in the module")]
impl Register {
    pub const ID: u8 = 0x00;
    pub const STATUS: u8 = 0x01;
    pub const MODE: u8 = 0x02;
    pub const CLOCK: u8 = 0x03;
    pub const GAIN1: u8 = 0x04;
    pub const GAIN2: u8 = 0x05;
    pub const CFG: u8 = 0x06;
    pub const CH0_CFG: u8 = 0x09;
    pub const REGMAP_CRC: u8 = 0x3E;
    /// Registers of each channel.
    pub const PER_CHANNEL: u8 = 5;
    /// How many there are.
    pub const COUNT: usize = 64;
}

/// The register `STATUS`, which answers NULL.
///
/// ```
/// use fingertip_drivers::converters::ads131m::Status;
///
/// // Just reset, with data of all four channels.
/// let status = Status(0x050F);
/// assert!(status.has(Status::RESET) && !status.has(Status::LOCK));
/// assert_eq!(status.fresh(), 0b1111);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status(pub u16);

impl Status {
    /// Registers are locked.
    pub const LOCK: u16 = 1 << 15;
    /// The converters were resynchronised.
    pub const RESYNC: u16 = 1 << 14;
    /// The CRC of the registers has changed.
    pub const REGISTERS: u16 = 1 << 13;
    /// The last command was damaged.
    pub const REJECTED: u16 = 1 << 12;
    /// The device has been reset.
    pub const RESET: u16 = 1 << 10;

    /// Whether a flag is up.
    #[must_use]
    pub const fn has(self, flag: u16) -> bool {
        self.0 & flag != 0
    }

    /// Bit `n`: channel `n` has new data.
    #[must_use]
    pub const fn fresh(self) -> u8 {
        self.0.to_be_bytes()[1]
    }
}

/// What is sent to the device.
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Register, Request};
///
/// let mut frame = [0; 18]; // six words, of a chip with four channels
/// Request::Write { address: Register::CLOCK, value: 0x0F0E }.emit(&mut frame);
/// assert_eq!(frame[..6], [0x61, 0x80, 0, 0x0F, 0x0E, 0]);
/// assert_eq!(Request::Read { address: Register::ID }.word(), 0xA000);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Request {
    /// Nothing: only data are read.
    Null,
    /// Reset.
    Reset,
    /// Stop converting.
    Standby,
    /// Go on converting.
    Wakeup,
    /// Take no commands but NULL, RREG and UNLOCK.
    Lock,
    /// Take all commands.
    Unlock,
    /// Read a register.
    Read {
        /// Its address, up to 0x3F.
        address: u8,
    },
    /// Write a register.
    Write {
        /// Its address, up to 0x3F.
        address: u8,
        /// What is written.
        value: u16,
    },
}

impl Request {
    const READ: u16 = 0b101 << 13;
    const WRITE: u16 = 0b011 << 13;
    const WRITTEN: u16 = 0b010 << 13;

    /// The command.
    #[must_use]
    pub const fn word(self) -> u16 {
        match self {
            Self::Null => 0x0000,
            Self::Reset => 0x0011,
            Self::Standby => 0x0022,
            Self::Wakeup => 0x0033,
            Self::Lock => 0x0555,
            Self::Unlock => 0x0655,
            Self::Read { address } => Self::READ | ((address as u16 & 0x3F) << 7),
            Self::Write { address, .. } => Self::WRITE | ((address as u16 & 0x3F) << 7),
        }
    }

    /// What the device answers in the next frame; `None` if it is not known beforehand.
    #[must_use]
    pub const fn acknowledgement(self, channels: u8) -> Option<u16> {
        match self {
            Self::Null | Self::Read { .. } => None,
            Self::Reset => Some(0xFF20 | channels as u16),
            Self::Write { .. } => Some(self.word() & 0x1FFF | Self::WRITTEN),
            other => Some(other.word()),
        }
    }

    /// Writes the frame: the rest of the buffer is filled with zeros. A buffer has at least three words.
    pub fn emit(self, frame: &mut [u8]) {
        frame.fill(0);
        let value = if let Self::Write { value, .. } = self { Some(value) } else { None };
        let (words, _) = frame.as_chunks_mut::<WORD>();
        let mut digest = CRC.digest();
        let mut places = words.iter_mut();
        for (word, place) in core::iter::once(self.word()).chain(value).zip(&mut places) {
            *place = aligned(word);
            digest.update(place);
        }
        if let Some(place) = places.next() {
            *place = aligned(digest.finalize());
        }
    }

    /// Reads a frame, `checked` with its CRC. `None` for a command that is not known here.
    ///
    /// # Errors
    /// [`ConverterFault::Checksum`].
    pub fn parse(frame: &[u8], checked: bool) -> Result<Option<Self>, ConverterFault> {
        let (words, _) = frame.as_chunks::<WORD>();
        let word =
            |index: usize| words.get(index).map_or(0, |[high, low, _]| u16::from_be_bytes([*high, *low]));
        let command = word(0);
        #[allow(clippy::cast_possible_truncation, reason = "six bits")]
        let address = (command >> 7 & 0x3F) as u8;
        let request = match command {
            0x0000 => Some(Self::Null),
            0x0011 => Some(Self::Reset),
            0x0022 => Some(Self::Standby),
            0x0033 => Some(Self::Wakeup),
            0x0555 => Some(Self::Lock),
            0x0655 => Some(Self::Unlock),
            _ if command & 0xE07F == Self::READ => Some(Self::Read { address }),
            _ if command & 0xE07F == Self::WRITE => Some(Self::Write { address, value: word(1) }),
            _ => None,
        };
        let covered = 1 + usize::from(command & 0xE000 == Self::WRITE);
        let expected = CRC.checksum(frame.get(..covered * WORD).unwrap_or(frame));
        if checked && expected != word(covered) {
            return Err(ConverterFault::Checksum { expected, found: word(covered) });
        }
        Ok(request)
    }
}

/// A number of 16 bits in a word.
const fn aligned(word: u16) -> [u8; WORD] {
    let [high, low] = word.to_be_bytes();
    [high, low, 0]
}

/// What the device sends in a frame.
///
/// ```
/// use fingertip_drivers::converters::ConverterFault;
/// use fingertip_drivers::converters::ads131m::Answer;
///
/// let mut frame = [0; Answer::<4>::LENGTH];
/// let answer = Answer { response: 0x050F, counts: [1, -2, 3, -4] };
/// answer.emit(&mut frame);
/// assert_eq!(Answer::<4>::parse(&frame), Ok(answer));
/// frame[5] ^= 1;
/// assert!(matches!(Answer::<4>::parse(&frame), Err(ConverterFault::Checksum { .. })));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer<const N: usize> {
    /// The answer to the last command.
    pub response: u16,
    /// Counts of the channels.
    pub counts: [i32; N],
}

impl<const N: usize> Answer<N> {
    /// Bytes of a frame.
    pub const LENGTH: usize = (N + 2) * WORD;

    /// Reads a frame whose checksum is right.
    ///
    /// # Errors
    /// [`ConverterFault::Checksum`], also for bytes that are not as many as a frame has.
    pub fn parse(frame: &[u8]) -> Result<Self, ConverterFault> {
        let (words, rest) = frame.as_chunks::<WORD>();
        let covered = frame.get(..Self::LENGTH - WORD).unwrap_or_default();
        let expected = CRC.checksum(covered);
        let [[r0, r1, _], data @ .., [c0, c1, _]] = words else {
            return Err(ConverterFault::Checksum { expected, found: !expected });
        };
        let found = u16::from_be_bytes([*c0, *c1]);
        if data.len() != N || !rest.is_empty() {
            return Err(ConverterFault::Checksum { expected, found: !expected });
        }
        if found != expected {
            return Err(ConverterFault::Checksum { expected, found });
        }
        let mut counts = [0; N];
        for (count, [high, middle, low]) in counts.iter_mut().zip(data) {
            *count = sign_extended(u32::from_be_bytes([0, *high, *middle, *low]), 24);
        }
        Ok(Self { response: u16::from_be_bytes([*r0, *r1]), counts })
    }

    /// Writes a frame into a buffer of [`LENGTH`](Self::LENGTH) bytes; counts beyond 24 bits are cut off.
    pub fn emit(&self, frame: &mut [u8]) {
        let (words, _) = frame.as_chunks_mut::<WORD>();
        let mut digest = CRC.digest();
        let counts = self.counts.iter().map(|count| {
            let [_, high, middle, low] = count.to_be_bytes();
            [high, middle, low]
        });
        let mut places = words.iter_mut();
        for (word, place) in core::iter::once(aligned(self.response)).chain(counts).zip(&mut places) {
            *place = word;
            digest.update(place);
        }
        if let Some(place) = places.next() {
            *place = aligned(digest.finalize());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_request() -> impl Strategy<Value = Request> {
        prop_oneof![
            Just(Request::Null),
            Just(Request::Reset),
            Just(Request::Standby),
            Just(Request::Wakeup),
            Just(Request::Lock),
            Just(Request::Unlock),
            (0_u8..64).prop_map(|address| Request::Read { address }),
            (0_u8..64, any::<u16>()).prop_map(|(address, value)| Request::Write { address, value }),
        ]
    }

    #[test]
    fn the_checksum_is_that_of_a_frame_read_from_a_real_chip() {
        // An ADS131M04 that answers LOCK and three zeros, as published by a user of one.
        let frame = [0x81, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xB4, 0x2D, 0];
        assert_eq!(Answer::<4>::parse(&frame), Ok(Answer { response: 0x8100, counts: [0; 4] }));
        assert_eq!(CRC.checksum(b"123456789"), 0x29B1);
    }

    #[test]
    fn words_are_those_of_the_data_sheet() {
        assert_eq!(Request::Read { address: Register::MODE }.word(), 0xA100);
        let write = Request::Write { address: Register::CLOCK, value: 0xFF0E };
        assert_eq!((write.word(), write.acknowledgement(8)), (0x6180, Some(0x4180)));
        assert_eq!(Request::Reset.acknowledgement(4), Some(0xFF24));
        let mut frame = [0xAA; 18];
        write.emit(&mut frame);
        assert_eq!(frame[..6], [0x61, 0x80, 0, 0xFF, 0x0E, 0]);
        assert_eq!(frame[9..], [0; 9]);
    }

    proptest! {
        #[test]
        fn an_answer_is_read_as_it_was_written(response in any::<u16>(), counts in prop::array::uniform8(-8_388_608..8_388_608)) {
            let answer = Answer { response, counts };
            let mut frame = [0; Answer::<8>::LENGTH];
            answer.emit(&mut frame);
            prop_assert_eq!(Answer::parse(&frame), Ok(answer));
        }

        #[test]
        fn a_request_is_read_as_it_was_written(request in any_request(), checked in any::<bool>()) {
            let mut frame = [0; Answer::<4>::LENGTH];
            request.emit(&mut frame);
            prop_assert_eq!(Request::parse(&frame, checked), Ok(Some(request)));
        }

        #[test]
        fn any_burst_of_up_to_sixteen_bits_is_noticed(
            counts in prop::array::uniform4(-8_388_608..8_388_608), at in 0_usize..6 * 24 - 24, burst in 1_u32..1 << 16,
        ) {
            let mut frame = [0; Answer::<4>::LENGTH];
            Answer { response: 0x050F, counts }.emit(&mut frame);
            for bit in (0..16).filter(|bit| burst >> bit & 1 == 1) {
                frame[(at + bit) / 8] ^= 0x80 >> ((at + bit) % 8);
            }
            prop_assert!(Answer::<4>::parse(&frame).is_err());
        }

        #[test]
        fn any_bytes_are_a_frame_or_none(bytes in prop::collection::vec(any::<u8>(), 0..40), checked in any::<bool>()) {
            if let Ok(answer) = Answer::<4>::parse(&bytes) {
                let mut again = [0; Answer::<4>::LENGTH];
                answer.emit(&mut again);
                prop_assert_eq!(Answer::<4>::parse(&again), Ok(answer));
            }
            let _ = Request::parse(&bytes, checked);
        }
    }

    #[test]
    fn a_frame_of_other_channels_is_none_though_its_checksum_is_right() {
        let mut frame = [0; Answer::<4>::LENGTH];
        Answer { response: 0x050F, counts: [1, -2, 3, -4] }.emit(&mut frame);
        let (words, checksum) = frame.split_at(frame.len() - WORD);
        assert!(Answer::<4>::parse(&frame).is_ok());
        // The checksum stands at the end of what it is of, with words or bytes too many between.
        for between in 1..=2 * WORD {
            let longer = [words, &[0; 2 * WORD][..between], checksum].concat();
            assert!(matches!(Answer::<4>::parse(&longer), Err(ConverterFault::Checksum { .. })), "{between}");
        }
        for behind in 1..=2 * WORD {
            let longer = [&frame, &[0; 2 * WORD][..behind]].concat();
            assert!(Answer::<4>::parse(&longer).is_err(), "{behind}");
        }
        for length in 0..frame.len() {
            assert!(Answer::<4>::parse(&frame[..length]).is_err(), "{length}");
        }
    }

    #[test]
    fn lines_that_are_stuck_give_no_frame() {
        assert!(Answer::<4>::parse(&[0; 18]).is_err() && Answer::<4>::parse(&[0xFF; 18]).is_err());
        assert!(Answer::<8>::parse(&[0; 30]).is_err() && Answer::<8>::parse(&[0xFF; 30]).is_err());
    }
}
