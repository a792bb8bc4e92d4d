//! Commands, registers and readings.

use crc::{CRC_16_UMTS, Crc};

use crate::converters::{ConverterFault, sign_extended};

/// CRC-16/UMTS: polynomial 0x8005, seed 0, not reflected.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_UMTS);

/// Addresses of registers.
///
/// ```
/// use fingertip_drivers::converters::mcp3564::Register;
///
/// assert_eq!((Register::length(Register::CONFIG0), Register::length(Register::SCAN)), (1, 3));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Register;

#[allow(missing_docs, reason = "named as in the data sheet, and listed in the module")]
impl Register {
    pub const ADCDATA: u8 = 0x0;
    pub const CONFIG0: u8 = 0x1;
    pub const CONFIG1: u8 = 0x2;
    pub const CONFIG2: u8 = 0x3;
    pub const CONFIG3: u8 = 0x4;
    pub const IRQ: u8 = 0x5;
    pub const MUX: u8 = 0x6;
    pub const SCAN: u8 = 0x7;
    pub const TIMER: u8 = 0x8;
    pub const OFFSETCAL: u8 = 0x9;
    pub const GAINCAL: u8 = 0xA;
    pub const LOCK: u8 = 0xD;
    pub const CRCCFG: u8 = 0xF;

    /// Bytes of a register; those of `ADCDATA` in the format that is used here.
    #[must_use]
    pub const fn length(address: u8) -> usize {
        match address {
            0x0 => 4,
            0x7..=0xB => 3,
            0xE | 0xF => 2,
            _ => 1,
        }
    }
}

/// Commands of one byte.
///
/// ```
/// use fingertip_drivers::converters::mcp3564::{FastCommand, Request};
///
/// // For device address 1.
/// assert_eq!(Request::Fast(FastCommand::Start).emit(1), 0b0110_1000);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum FastCommand {
    Start = 0b1010,
    Standby = 0b1011,
    ConverterOff = 0b1100,
    AllOff = 0b1101,
    Reset = 0b1110,
}

/// The first byte of what is sent.
///
/// ```
/// use fingertip_drivers::converters::mcp3564::{Register, Request};
///
/// let read = Request::Read { address: Register::ADCDATA };
/// assert_eq!(read.emit(1), 0b0100_0001);
/// assert_eq!(Request::parse(0b0100_0001), (1, Some(read)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// A fast command.
    Fast(FastCommand),
    /// Read one register.
    Read {
        /// Its address, up to 0xF.
        address: u8,
    },
    /// Write registers from this one on.
    Write {
        /// Its address, up to 0xF.
        address: u8,
    },
}

impl Request {
    /// The byte, for a device address (0 to 3).
    #[must_use]
    pub const fn emit(self, device: u8) -> u8 {
        let (code, kind) = match self {
            Self::Fast(command) => (command as u8, 0b00),
            Self::Read { address } => (address & 0xF, 0b01),
            Self::Write { address } => (address & 0xF, 0b10),
        };
        (device & 3) << 6 | code << 2 | kind
    }

    /// The device address and what is asked of it; `None` for what is not known here.
    #[must_use]
    pub const fn parse(byte: u8) -> (u8, Option<Self>) {
        let code = byte >> 2 & 0xF;
        let request = match byte & 3 {
            0b00 => match code {
                0b1010 => Some(Self::Fast(FastCommand::Start)),
                0b1011 => Some(Self::Fast(FastCommand::Standby)),
                0b1100 => Some(Self::Fast(FastCommand::ConverterOff)),
                0b1101 => Some(Self::Fast(FastCommand::AllOff)),
                0b1110 => Some(Self::Fast(FastCommand::Reset)),
                _ => None,
            },
            0b01 => Some(Self::Read { address: code }),
            0b10 => Some(Self::Write { address: code }),
            _ => None,
        };
        (byte >> 6, request)
    }
}

/// The byte with which the device answers every command.
///
/// ```
/// use fingertip_drivers::converters::mcp3564::Status;
///
/// // Of device address 1: flags are up when their bits are down.
/// let status = Status(0b0001_0011);
/// assert!(status.is_of(1) && status.is_new());
/// assert!(!status.registers_damaged() && !status.was_off());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status(pub u8);

impl Status {
    /// What the upper five bits must be.
    #[must_use]
    pub const fn address_bits(device: u8) -> u8 {
        (device & 3) << 4 | (!device & 1) << 3
    }

    /// Whether these are the address bits of the device.
    #[must_use]
    pub const fn is_of(self, device: u8) -> bool {
        self.0 & 0xF8 == Self::address_bits(device)
    }

    /// There is a conversion that was not read yet.
    #[must_use]
    pub const fn is_new(self) -> bool {
        self.0 & 1 << 2 == 0
    }

    /// The registers have changed since they were locked.
    #[must_use]
    pub const fn registers_damaged(self) -> bool {
        self.0 & 1 << 1 == 0
    }

    /// The supply was off since this was asked last.
    #[must_use]
    pub const fn was_off(self) -> bool {
        self.0 & 1 == 0
    }
}

/// Reads what comes back for a register of `L` bytes: status, data, CRC.
///
/// # Errors
/// [`ConverterFault::Answer`] if the status is not that of the device, [`ConverterFault::Checksum`].
pub(super) fn parse_answer<const L: usize>(
    bytes: &[u8],
    device: u8,
) -> Result<(Status, [u8; L]), ConverterFault> {
    let short = ConverterFault::Answer {
        expected: 1 + L as u32 + 2,
        found: u32::try_from(bytes.len()).unwrap_or(u32::MAX),
    };
    let (status, rest) = bytes.split_first().ok_or(short)?;
    let (data, checksum) = rest.split_first_chunk::<L>().ok_or(short)?;
    let [high, low] = *checksum else { return Err(short) };
    let expected = CRC.checksum(bytes.get(..=L).unwrap_or_default());
    let found = u16::from_be_bytes([high, low]);
    if expected != found {
        return Err(ConverterFault::Checksum { expected, found });
    }
    let status = Status(*status);
    if !status.is_of(device) {
        let expected = u32::from(Status::address_bits(device));
        return Err(ConverterFault::Answer { expected, found: u32::from(status.0) });
    }
    Ok((status, *data))
}

/// Whether the device was reset, by its answer for `CONFIG3` and two bytes more. A device that was configured puts its CRC
/// there, and its registers are not what they were after a reset; one that was reset sends none, and the register is 0. A
/// line that is stuck has not the device's address in its status.
pub(super) fn tells_reset(bytes: [u8; 4], device: u8) -> bool {
    let [status, register, ..] = bytes;
    match parse_answer::<1>(&bytes, device) {
        Ok((status, _)) => status.was_off() || status.registers_damaged(),
        Err(_) => Status(status).is_of(device) && register == 0,
    }
}

/// The CRC that follows status and data.
#[cfg(any(test, feature = "simulators"))]
pub(super) fn checksum(status_and_data: &[u8]) -> [u8; 2] {
    CRC.checksum(status_and_data).to_be_bytes()
}

/// A conversion as it stands in `ADCDATA` (`DATA_FORMAT` 11).
///
/// ```
/// use fingertip_drivers::converters::mcp3564::Data;
///
/// // −2 at input 8, the sign over all bits that are left.
/// assert_eq!(Data::parse([0x8F, 0xFF, 0xFF, 0xFE]), Ok(Data { channel: 8, counts: -2 }));
/// assert!(Data::parse([0x8E, 0xFF, 0xFF, 0xFE]).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Data {
    /// Number of the input, 0 to 15.
    pub channel: u8,
    /// Counts of 25 bits.
    pub counts: i32,
}

impl Data {
    /// Reads four bytes.
    ///
    /// # Errors
    /// [`ConverterFault::Answer`] if the bits of the sign are not all the same.
    pub const fn parse(bytes: [u8; 4]) -> Result<Self, ConverterFault> {
        let word = u32::from_be_bytes(bytes);
        let counts = sign_extended(word, 28);
        let expected = (word & 0xF000_0000) | (sign_extended(word, 25).cast_unsigned() & 0x0FFF_FFFF);
        if expected != word {
            return Err(ConverterFault::Answer { expected, found: word });
        }
        #[allow(clippy::cast_possible_truncation, reason = "four bits")]
        let channel = (word >> 28) as u8;
        Ok(Self { channel, counts })
    }

    /// The four bytes; counts beyond 25 bits are cut off.
    #[must_use]
    pub const fn emit(self) -> [u8; 4] {
        let counts = sign_extended(self.counts.cast_unsigned(), 25).cast_unsigned() & 0x0FFF_FFFF;
        ((self.channel as u32 & 0xF) << 28 | counts).to_be_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_checksum_is_that_of_readings_of_a_real_chip() {
        // Published by a user of an MCP3561R, with the bytes of the number in the order of a little-endian
        // memory; 13 is the status of device 1 with new data.
        for (number, crc) in
            [([0xFF, 0xEF, 0xC8], 0x90B5), ([0xFF, 0xEF, 0xCA], 0x10BA), ([0xFF, 0x7C, 0xEA], 0xFA73)]
        {
            let [high, low] = u16::to_be_bytes(crc);
            let [n0, n1, n2] = number;
            let (status, data) = parse_answer::<3>(&[0x13, n0, n1, n2, high, low], 1).unwrap();
            assert_eq!(data, number);
            assert!(status.is_new() && !status.was_off() && !status.registers_damaged());
        }
        assert_eq!(CRC.checksum(b"123456789"), 0xFEE8);
    }

    #[test]
    fn bytes_are_those_of_the_data_sheet() {
        assert_eq!(Request::Fast(FastCommand::Start).emit(1), 0x68);
        assert_eq!(Request::Fast(FastCommand::Reset).emit(1), 0x78);
        assert_eq!(
            (Request::Read { address: 0 }.emit(1), Request::Write { address: 1 }.emit(1)),
            (0x41, 0x46)
        );
        assert_eq!(Status::address_bits(1), 0b0001_0000);
    }

    #[test]
    fn a_reset_is_told_from_damage_and_from_a_stuck_line() {
        let whole = |status: u8, register: u8| {
            let [high, low] = checksum(&[status, register]);
            [status, register, high, low]
        };
        // Configured; its supply was off; its registers were damaged while they were locked.
        assert!(!tells_reset(whole(0x17, 0xF4), 1));
        assert!(tells_reset(whole(0x16, 0xF4), 1) && tells_reset(whole(0x15, 0xF4), 1));
        // After a reset there is no CRC: the register comes again, or nothing.
        for status in [0x16, 0x17] {
            assert!(tells_reset([status, 0, 0, 0], 1) && tells_reset([status, 0, 0xFF, 0xFF], 1));
        }
        // A damaged answer of a device that is well, another device, and stuck lines.
        assert!(!tells_reset([0x16, 0xF4, 1, 2], 1));
        assert!(!tells_reset([0x26, 0, 0, 0], 1));
        for device in 0..4 {
            assert!(!tells_reset([0; 4], device) && !tells_reset([0xFF; 4], device));
        }
    }

    proptest! {
        #[test]
        fn data_is_read_as_it_was_written(channel in 0_u8..16, counts in -(1_i32 << 24)..1 << 24) {
            let data = Data { channel, counts };
            prop_assert_eq!(Data::parse(data.emit()), Ok(data));
        }

        #[test]
        fn any_bytes_are_data_or_none(bytes in any::<[u8; 4]>(), answer in prop::collection::vec(any::<u8>(), 0..12), first in any::<u8>()) {
            if let Ok(data) = Data::parse(bytes) {
                prop_assert_eq!(data.emit(), bytes);
            }
            let _ = parse_answer::<4>(&answer, 1);
            if let (device, Some(request)) = Request::parse(first) {
                prop_assert_eq!(request.emit(device), first);
            }
        }

        #[test]
        fn any_burst_of_up_to_sixteen_bits_is_noticed(data in any::<[u8; 4]>(), at in 0_usize..40, burst in 1_u32..1 << 16) {
            let [d0, d1, d2, d3] = data;
            let mut bytes = [0x13, d0, d1, d2, d3, 0, 0];
            let [high, low] = checksum(&bytes[..5]);
            (bytes[5], bytes[6]) = (high, low);
            prop_assert!(parse_answer::<4>(&bytes, 1).is_ok());
            for bit in (0..16).filter(|bit| burst >> bit & 1 == 1) {
                bytes[(at + bit) / 8] ^= 0x80 >> ((at + bit) % 8);
            }
            prop_assert!(parse_answer::<4>(&bytes, 1).is_err());
        }
    }
}
