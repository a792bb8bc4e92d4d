//! What the registers are to hold.

/// An input in the list: its bit in `SCAN`, and its number in conversions.
///
/// ```
/// use fingertip_drivers::converters::mcp3564::{Channel, Configuration};
///
/// // Pin 0 against pin 1, and the thermometer inside: bits 8 and 12 of SCAN.
/// assert_eq!(Configuration::new([Channel::PairA, Channel::Temperature]).scan(), 0x1100);
/// ```
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

/// Gain (`CONFIG2.GAIN`).
///
/// ```
/// use fingertip_drivers::converters::mcp3564::Gain;
///
/// // With a reference of 3.3 V, full scale at gain 64 is 52 mV.
/// assert!((3.3 * Gain::X64.full_scale() - 0.0516).abs() < 0.0001);
/// assert_eq!(Gain::Third.full_scale(), 3.0);
/// ```
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
///
/// ```
/// use fingertip_drivers::converters::mcp3564::{Channel, Configuration, Oversampling};
///
/// let slow = Configuration { oversampling: Oversampling::X1024, ..Configuration::new([Channel::PairA]) };
/// assert_eq!((slow.oversampling.ratio(), slow.data_rate(4.9152e6)), (1024, 1200.0));
/// ```
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
///
/// ```
/// use fingertip_drivers::converters::mcp3564::{Channel, Clock, Configuration};
///
/// // The first of several chips, whose clock the others take: CONFIG0 holds it in bits 5 and 4.
/// let first = Configuration { clock: Clock::InternalPutOut, ..Configuration::new([Channel::PairA]) };
/// assert_eq!(first.registers()[0] >> 4 & 0b11, 0b11);
/// ```
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
///
/// ```
/// use fingertip_drivers::converters::mcp3564::{Channel, Configuration, Reference};
///
/// // An MCP3564R at whose pins the excitation is: the reference inside is off.
/// let ratiometric = Configuration { reference: Reference::PinsOfR, ..Configuration::new([Channel::PairA]) };
/// assert_eq!(ratiometric.registers()[0] >> 6, 0b01);
/// ```
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
///
/// ```
/// use fingertip_drivers::converters::mcp3564::{Channel, Configuration, Gain, Oversampling};
///
/// let two_bridges = Configuration {
///     gain: Gain::X64,
///     oversampling: Oversampling::X256,
///     ..Configuration::new([Channel::PairA, Channel::PairB])
/// };
/// // A sample of both takes two conversions.
/// assert_eq!(two_bridges.data_rate(4.9152e6) / 2.0, 2400.0);
/// ```
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

    #[test]
    fn registers_are_those_of_the_data_sheet() {
        let configuration = Configuration::new([Channel::PairA, Channel::Pin4]);
        assert_eq!(configuration.registers()[..9], [0xE2, 0x0C, 0x8B, 0xF4, 0x06, 0x01, 0, 0x01, 0x10]);
        assert_eq!(configuration.data_rate(4.9152e6), 4800.0);
        assert_eq!((Gain::Third.factor() * 3.0, Gain::X1.factor(), Gain::X64.factor()), (1.0, 1.0, 64.0));
    }
    #[test]
    fn corrections_are_on_if_they_are_other_than_none() {
        let plain = Configuration::new([Channel::PairA]);
        for (offset, gain_correction, enabled, bytes) in [
            (0, 0x80_0000, 0xF4, [0, 0, 0, 0x80, 0, 0]),
            (-2, 0x80_0000, 0xF6, [0xFF, 0xFF, 0xFE, 0x80, 0, 0]),
            (0, 0x80_0001, 0xF5, [0, 0, 0, 0x80, 0, 1]),
            (0x01_0203, 0x40_5060, 0xF7, [1, 2, 3, 0x40, 0x50, 0x60]),
        ] {
            let registers = Configuration { offset, gain_correction, ..plain }.registers();
            assert_eq!((registers[3], &registers[12..]), (enabled, &bytes[..]));
        }
        let chopping = Configuration { chopping: true, reference: Reference::PinsOfR, ..plain };
        assert_eq!((chopping.registers()[0], chopping.registers()[2]), (0x62, 0x8F));
        assert_eq!(chopping.data_rate(4.9152e6), 2400.0);
    }
}
