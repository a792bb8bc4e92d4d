//! What the registers are to hold.

use super::wire::Register;

/// Gain of a channel (`GAIN1`, `GAIN2`): the range is ±1.2 V divided by it.
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Configuration, Gain};
///
/// // ±37.5 mV at gain 32.
/// let configuration = Configuration::<4>::default().gain(Gain::X32);
/// assert_eq!(configuration.full_scale(0, Configuration::<4>::REFERENCE), Some(0.0375));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum Gain {
    #[default]
    X1 = 0,
    X2,
    X4,
    X8,
    X16,
    X32,
    X64,
    X128,
}

impl Gain {
    /// The factor.
    #[must_use]
    pub fn factor(self) -> f64 {
        f64::from(1_u32 << self as u32)
    }
}

/// What a channel converts (`CHn_CFG.MUX`).
///
/// ```
/// use fingertip_drivers::converters::ads131m::{ChannelSetup, Configuration, Gain, Input};
///
/// // Channel 1 shows its own offset; the register CH1_CFG is 0x0E.
/// let mut configuration = Configuration::<2>::default();
/// configuration.channels[1] = ChannelSetup { input: Input::Shorted, ..ChannelSetup::with_gain(Gain::X1) };
/// assert!(configuration.registers().any(|register| register == (0x0E, 1)));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Input {
    /// Its pins.
    #[default]
    Pins = 0,
    /// Its inputs tied together: for its own offset.
    Shorted,
    /// The positive test signal, 160 mV divided by the gain (Internal Test Signals).
    PositiveTest,
    /// The negative test signal.
    NegativeTest,
}

/// How many modulator samples make one conversion (`CLOCK.OSR`).
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Configuration, Oversampling};
///
/// let slow = Configuration::<4> { oversampling: Oversampling::X4096, ..Configuration::default() };
/// assert_eq!((slow.oversampling.ratio(), slow.data_rate(8.192e6)), (4096, 1000.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum Oversampling {
    X128 = 0,
    X256,
    X512,
    #[default]
    X1024,
    X2048,
    X4096,
    X8192,
    X16384,
}

impl Oversampling {
    /// The ratio.
    #[must_use]
    pub const fn ratio(self) -> u32 {
        128 << self as u32
    }
}

/// Power mode (`CLOCK.PWR`), which sets what the clock is divided by for the modulator.
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Configuration, Power};
///
/// // As many conversions from half the clock, with less noise from more power.
/// let low = Configuration::<4> { power: Power::Low, ..Configuration::default() };
/// assert_eq!(low.data_rate(4.096e6), 1000.0);
/// assert_eq!(Configuration::<4>::default().data_rate(4.096e6), 2000.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Power {
    /// By 8; clock up to 2.048 MHz.
    VeryLow = 0,
    /// By 4; clock up to 4.096 MHz.
    Low,
    /// By 2; clock up to 8.192 MHz.
    #[default]
    HighResolution,
}

impl Power {
    /// Clocks for each modulator sample.
    #[must_use]
    pub const fn divider(self) -> u32 {
        8 >> self as u32
    }
}

/// One channel.
///
/// ```
/// use fingertip_drivers::converters::ads131m::{ChannelSetup, Configuration, Gain};
///
/// // A fingertip with three bridges, at a chip with four channels.
/// let mut configuration = Configuration::<4>::default().gain(Gain::X64);
/// configuration.channels[3] = ChannelSetup::off();
/// assert_eq!(configuration.enabled(), 0b0111);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelSetup {
    /// Whether it converts; it gives zeros if not.
    pub enabled: bool,
    /// Its gain.
    pub gain: Gain,
    /// What it converts.
    pub input: Input,
    /// What the device takes off, in counts of 24 bits (`OCAL`).
    pub offset: i32,
    /// What the device multiplies with, 0x80_0000 being 1 (`GCAL`).
    pub gain_correction: u32,
}

impl ChannelSetup {
    /// A channel that converts its pins with a gain.
    #[must_use]
    pub const fn with_gain(gain: Gain) -> Self {
        Self { enabled: true, gain, input: Input::Pins, offset: 0, gain_correction: 0x80_0000 }
    }

    /// A channel that is off.
    #[must_use]
    pub const fn off() -> Self {
        Self { enabled: false, ..Self::with_gain(Gain::X1) }
    }
}

impl Default for ChannelSetup {
    fn default() -> Self {
        Self::with_gain(Gain::X1)
    }
}

/// The whole device.
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Configuration, Gain, Oversampling, Register};
///
/// let configuration =
///     Configuration::<8> { oversampling: Oversampling::X2048, lock: true, ..Configuration::default() }
///         .gain(Gain::X32);
/// assert_eq!(configuration.data_rate(8.192e6), 2000.0);
/// // All channels on, the fourth ratio, high resolution.
/// assert_eq!(configuration.registers().last(), Some((Register::CLOCK, 0xFF12)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration<const N: usize> {
    /// The channels.
    pub channels: [ChannelSetup; N],
    /// Oversampling.
    pub oversampling: Oversampling,
    /// Power mode.
    pub power: Power,
    /// Reference at the pin instead of the 1.2 V inside (`CLOCK.EXTREF_EN`; M06 and M08). The range is then
    /// ±0.96 times the reference, divided by the gain.
    pub external_reference: bool,
    /// Crystal oscillator off, for a clock at the pin (`CLOCK.XTAL_DIS`; M06 and M08).
    pub external_clock: bool,
    /// Inputs swapped about to take away the offset and its drift (Global Chop Mode), with a delay before
    /// each conversion of 2 to the power of this and one modulator periods, 0 to 15. It makes the data rate
    /// lower.
    pub chopping: Option<u8>,
    /// The device watches its registers (Register Map CRC), and a change of theirs is noticed.
    pub watch_registers: bool,
    /// The registers are locked in the end (LOCK).
    pub lock: bool,
}

impl<const N: usize> Default for Configuration<N> {
    /// As after a reset: all channels on with gain 1.
    fn default() -> Self {
        Self {
            channels: [ChannelSetup::default(); N],
            oversampling: Oversampling::default(),
            power: Power::default(),
            external_reference: false,
            external_clock: false,
            chopping: None,
            watch_registers: false,
            lock: false,
        }
    }
}

impl<const N: usize> Configuration<N> {
    /// The internal reference \[V\] (Voltage Reference).
    pub const REFERENCE: f64 = 1.2;

    /// `MODE`: commands checked, reset flag taken down, words of 24 bits, SPI time-out on.
    const MODE: u16 = 1 << 12 | 1 << 8 | 1 << 4;
    /// `MODE.REG_CRC_EN`.
    const WATCH: u16 = 1 << 13;

    /// The same gain on all channels.
    #[must_use]
    pub fn gain(mut self, gain: Gain) -> Self {
        for channel in &mut self.channels {
            channel.gain = gain;
        }
        self
    }

    /// Conversions a second for a clock \[Hz\], without chopping (Data Rate: clock over divider over OSR).
    #[must_use]
    pub fn data_rate(&self, clock: f64) -> f64 {
        clock / f64::from(self.power.divider() * self.oversampling.ratio())
    }

    /// Volts at the pins that make full scale, 2²³ counts, for the reference that is in use \[V\]
    /// (Configuration::REFERENCE for the one inside); `None` for a channel that there is not.
    #[must_use]
    pub fn full_scale(&self, channel: usize, reference: f64) -> Option<f64> {
        let share = if self.external_reference { 0.96 } else { 1.0 };
        self.channels.get(channel).map(|channel| reference * share / channel.gain.factor())
    }

    /// Bit `n`: channel `n` is on.
    #[must_use]
    pub fn enabled(&self) -> u8 {
        self.channels.iter().rev().fold(0, |mask, channel| mask << 1 | u8::from(channel.enabled))
    }

    /// Addresses and values, in the order in which they are written: `MODE` first, so that from then on the
    /// device checks what it is sent, `CLOCK` last, since it starts the converters anew.
    pub fn registers(&self) -> impl Iterator<Item = (u8, u16)> + '_ {
        let mode = Self::MODE | if self.watch_registers { Self::WATCH } else { 0 };
        let gains = |from: usize| {
            let four = self.channels.iter().skip(from).take(4);
            four.rev().fold(0, |word, channel| word << 4 | channel.gain as u16)
        };
        let gain2 = (N > 4).then(|| (Register::GAIN2, gains(4)));
        let chop = self.chopping.map_or(0x0600, |delay| u16::from(delay & 0xF) << 9 | 1 << 8);
        let clock = u16::from(self.enabled()) << 8
            | u16::from(self.external_clock) << 7
            | u16::from(self.external_reference) << 6
            | (self.oversampling as u16) << 2
            | self.power as u16;
        let channels = (Register::CH0_CFG..).step_by(usize::from(Register::PER_CHANNEL)).zip(&self.channels);
        let channels = channels.flat_map(|(base, channel)| {
            let [_, o0, o1, o2] = channel.offset.to_be_bytes();
            let [_, g0, g1, g2] = channel.gain_correction.to_be_bytes();
            [
                (base, channel.input as u16),
                (base + 1, u16::from_be_bytes([o0, o1])),
                (base + 2, u16::from_be_bytes([o2, 0])),
                (base + 3, u16::from_be_bytes([g0, g1])),
                (base + 4, u16::from_be_bytes([g2, 0])),
            ]
        });
        [(Register::MODE, mode), (Register::GAIN1, gains(0))]
            .into_iter()
            .chain(gain2)
            .chain([(Register::CFG, chop)])
            .chain(channels)
            .chain([(Register::CLOCK, clock)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_after_reset_are_those_of_the_data_sheet() {
        let registers: Vec<_> = Configuration::<8>::default().registers().collect();
        let value = |address| registers.iter().find(|(at, _)| *at == address).map(|(_, value)| *value);
        assert_eq!(value(Register::CLOCK), Some(0xFF0E));
        assert_eq!((value(Register::GAIN1), value(Register::GAIN2)), (Some(0), Some(0)));
        assert_eq!((value(Register::CFG), value(0x0C), value(0x0D)), (Some(0x0600), Some(0x8000), Some(0)));
        // The last register of the last channel is 0x30.
        assert_eq!((value(0x30), value(0x31), registers.len()), (Some(0), None, 5 + 8 * 5));
        // On a chip of four channels: no GAIN2, and bits of four channels.
        let registers: Vec<_> = Configuration::<4>::default().registers().collect();
        assert!(registers.iter().all(|(address, _)| *address != Register::GAIN2));
        assert_eq!(registers.last(), Some(&(Register::CLOCK, 0x0F0E)));
    }

    #[test]
    fn fields_stand_in_their_places() {
        let mut configuration = Configuration::<8>::default().gain(Gain::X32);
        configuration.channels[2].enabled = false;
        configuration.channels[7].gain = Gain::X2;
        configuration.channels[1].offset = -2;
        configuration.channels[1].input = Input::PositiveTest;
        configuration.oversampling = Oversampling::X256;
        configuration.external_reference = true;
        configuration.chopping = Some(5);
        let registers: Vec<_> = configuration.registers().collect();
        let value =
            |address| registers.iter().find(|(at, _)| *at == address).map(|(_, value)| *value).unwrap();
        assert_eq!((value(Register::GAIN1), value(Register::GAIN2)), (0x5555, 0x1555));
        assert_eq!(value(Register::CLOCK), 0xFB00 | 1 << 6 | 1 << 2 | 2);
        assert_eq!((value(0x0E), value(0x0F), value(0x10)), (2, 0xFFFF, 0xFE00));
        assert_eq!(value(Register::CFG), 0x0B00);
        assert_eq!(configuration.data_rate(8.192e6), 16_000.0);
        assert_eq!(configuration.full_scale(0, 1.25), Some(0.0375));
    }
}
