//! Commands, registers and readings.

use crc::{CRC_16_UMTS, Crc};

use crate::converter::{ConverterFault, sign_extended};

/// CRC-16/UMTS: polynomial 0x8005, seed 0, not reflected.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_UMTS);

/// Addresses of registers.
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

/// The CRC that follows status and data.
#[cfg(any(test, feature = "simulation"))]
pub(super) fn checksum(status_and_data: &[u8]) -> [u8; 2] {
    CRC.checksum(status_and_data).to_be_bytes()
}

/// An input in the list: its bit in `SCAN`, and its number in conversions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "pairs of pins, single pins against ground, and what is inside")]
pub enum Channel {
    Pin0 = 0,
    Pin1,
    Pin2,
    Pin3,
    Pin4,
    Pin5,
    Pin6,
    Pin7,
    /// Pin 0 against pin 1.
    PairA,
    /// Pin 2 against pin 3.
    PairB,
    /// Pin 4 against pin 5.
    PairC,
    /// Pin 6 against pin 7.
    PairD,
    Temperature,
    Supply,
    CommonMode,
    Offset,
}

/// A conversion as it stands in `ADCDATA` (`DATA_FORMAT` 11).
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

/// Gain (`CONFIG2.GAIN`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum Gain {
    Third = 0,
    #[default]
    X1,
    X2,
    X4,
    X8,
    X16,
    X32,
    X64,
}

impl Gain {
    /// The factor.
    #[must_use]
    pub fn factor(self) -> f64 {
        if self == Self::Third { 1.0 / 3.0 } else { f64::from((1_u32 << self as u32) >> 1) }
    }

    /// Volts per volt of reference that make full scale, 2²³ counts.
    #[must_use]
    pub fn full_scale(self) -> f64 {
        1.0 / self.factor()
    }
}

/// Oversampling (`CONFIG1.OSR`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum Oversampling {
    X32 = 0,
    X64,
    X128,
    #[default]
    X256,
    X512,
    X1024,
    X2048,
    X4096,
    X8192,
    X16384,
    X20480,
    X24576,
    X40960,
    X49152,
    X81920,
    X98304,
}

impl Oversampling {
    /// The ratio.
    #[must_use]
    pub fn ratio(self) -> u32 {
        const RATIOS: [u32; 16] =
            [32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 20480, 24576, 40960, 49152, 81920, 98304];
        RATIOS.get(self as usize).copied().unwrap_or(256)
    }
}

/// Where the clock comes from (`CONFIG0.CLK_SEL`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Clock {
    /// From the pin.
    Pin = 0b00,
    /// From the oscillator inside.
    #[default]
    Internal = 0b10,
    /// From the oscillator inside, and it is put out at the pin.
    InternalPutOut = 0b11,
}

/// Where the reference comes from (`CONFIG0[7:6]`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reference {
    /// From the pins, on a type without R.
    #[default]
    Pins,
    /// From the pins, on an R type.
    PinsOfR,
    /// From inside (2.4 V), on an R type.
    Internal,
}

/// What the registers are to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration<const N: usize> {
    /// The inputs, each once, in the order in which a sample gives them.
    pub inputs: [Channel; N],
    /// Gain of pins and pairs.
    pub gain: Gain,
    /// Oversampling.
    pub oversampling: Oversampling,
    /// Clock.
    pub clock: Clock,
    /// Reference.
    pub reference: Reference,
    /// The inputs are swapped about to take away the offset (`CONFIG2.AZ_MUX`); it halves the rate.
    pub chopping: bool,
    /// What the device takes off, in counts of 24 bits; 0 for nothing.
    pub offset: i32,
    /// What the device multiplies with, 0x80_0000 being 1.
    pub gain_correction: u32,
    /// The registers are locked in the end, and watched by the device.
    pub lock: bool,
    /// Device address, 0 to 3: 1 unless ordered otherwise.
    pub device: u8,
}

impl<const N: usize> Configuration<N> {
    /// Of inputs, with the rest as after a reset but for the clock, which is the one inside.
    #[must_use]
    pub const fn new(inputs: [Channel; N]) -> Self {
        Self {
            inputs,
            gain: Gain::X1,
            oversampling: Oversampling::X256,
            clock: Clock::Internal,
            reference: Reference::Pins,
            chopping: false,
            offset: 0,
            gain_correction: 0x80_0000,
            lock: false,
            device: 1,
        }
    }

    /// Conversions a second for a clock \[Hz\] (4.9152 MHz inside), of one input; a sample takes `N` of them.
    #[must_use]
    pub fn data_rate(&self, clock: f64) -> f64 {
        clock / f64::from(4 * self.oversampling.ratio()) / if self.chopping { 2.0 } else { 1.0 }
    }

    /// The inputs as bits of `SCAN`.
    #[must_use]
    pub fn scan(&self) -> u16 {
        self.inputs.iter().fold(0, |mask, channel| mask | 1 << *channel as u16)
    }

    /// Bytes of the registers from `CONFIG0` to `GAINCAL`, the converter in standby.
    #[must_use]
    pub fn registers(&self) -> [u8; 18] {
        let reference = if self.reference == Reference::PinsOfR { 0b01 } else { 0b11 };
        let calibrated = u8::from(self.offset != 0) << 1 | u8::from(self.gain_correction != 0x80_0000);
        let [scan_high, scan_low] = self.scan().to_be_bytes();
        let [_, o0, o1, o2] = self.offset.to_be_bytes();
        let [_, g0, g1, g2] = self.gain_correction.to_be_bytes();
        [
            reference << 6 | (self.clock as u8) << 4 | 0b10,
            (self.oversampling as u8) << 2,
            0b10 << 6 | (self.gain as u8) << 3 | u8::from(self.chopping) << 2 | 0b11,
            // Continuous, channel numbers, CRC of 16 bits.
            0b11 << 6 | 0b11 << 4 | 1 << 2 | calibrated,
            0b0110,
            0x01,
            0,
            scan_high,
            scan_low,
            0,
            0,
            0,
            o0,
            o1,
            o2,
            g0,
            g1,
            g2,
        ]
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
        let configuration = Configuration::new([Channel::PairA, Channel::Pin4]);
        assert_eq!(configuration.registers()[..9], [0xE2, 0x0C, 0x8B, 0xF4, 0x06, 0x01, 0, 0x01, 0x10]);
        assert_eq!(configuration.data_rate(4.9152e6), 4800.0);
        assert_eq!((Gain::Third.factor() * 3.0, Gain::X1.factor(), Gain::X64.factor()), (1.0, 1.0, 64.0));
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
