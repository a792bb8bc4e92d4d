//! Registers and readings.

/// Address on the bus, of seven bits.
pub const ADDRESS: u8 = 0x2A;

/// Addresses of registers.
///
/// ```
/// use fingertip_drivers::converters::nau7802::{Configuration, Gain, Register};
///
/// let registers = Configuration { gain: Gain::X16, ..Configuration::default() }.registers();
/// assert!(registers.contains(&(Register::CTRL1, 0b1000_0100)));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Register;

#[allow(missing_docs, reason = "named as in the data sheet, and listed in the module")]
impl Register {
    pub const PU_CTRL: u8 = 0x00;
    pub const CTRL1: u8 = 0x01;
    pub const CTRL2: u8 = 0x02;
    pub const OCAL1: u8 = 0x03;
    pub const GCAL1: u8 = 0x06;
    pub const OCAL2: u8 = 0x0A;
    pub const GCAL2: u8 = 0x0D;
    pub const ADCO: u8 = 0x12;
    pub const ADC: u8 = 0x15;
    pub const PGA: u8 = 0x1B;
    pub const POWER: u8 = 0x1C;
    pub const REVISION: u8 = 0x1F;
    /// How many there are.
    pub const COUNT: usize = 0x20;
}

/// Bits of `PU_CTRL`.
///
/// ```
/// use fingertip_drivers::converters::nau7802::{Configuration, Control};
///
/// let crystal = Configuration { crystal: true, ..Configuration::default() };
/// assert_eq!(crystal.running() & Control::CRYSTAL, Control::CRYSTAL);
/// assert_eq!(Configuration::default().running() & Control::CRYSTAL, 0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Control;

#[allow(missing_docs, reason = "named as in the data sheet")]
impl Control {
    pub const RESET: u8 = 1;
    pub const DIGITAL_ON: u8 = 1 << 1;
    pub const ANALOG_ON: u8 = 1 << 2;
    pub const POWERED: u8 = 1 << 3;
    pub const START: u8 = 1 << 4;
    pub const READY: u8 = 1 << 5;
    pub const CRYSTAL: u8 = 1 << 6;
    pub const REGULATOR: u8 = 1 << 7;
}

/// Bits of `CTRL2` that calibrate.
pub(super) const CALIBRATE: u8 = 1 << 2;
pub(super) const CALIBRATION_ERROR: u8 = 1 << 3;

/// Gain of the amplifier.
///
/// ```
/// use fingertip_drivers::converters::nau7802::Gain;
///
/// // ±7.8 mV/V.
/// assert_eq!(Gain::X64.full_scale(), 0.007_812_5);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum Gain {
    X1 = 0,
    X2,
    X4,
    X8,
    X16,
    X32,
    X64,
    #[default]
    X128,
}

impl Gain {
    /// The factor.
    #[must_use]
    pub fn factor(self) -> f64 {
        f64::from(1_u32 << self as u32)
    }

    /// Volts per volt of reference that make full scale, 2²³ counts.
    #[must_use]
    pub fn full_scale(self) -> f64 {
        0.5 / self.factor()
    }
}

/// Conversions a second.
///
/// ```
/// use fingertip_drivers::converters::nau7802::{Configuration, Rate};
///
/// assert_eq!(Rate::Hz320.hertz(), 320.0);
/// assert_eq!(Configuration { rate: Rate::Hz320, ..Configuration::default() }.control2(), 0b0111_0000);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum Rate {
    Hz10 = 0,
    Hz20 = 1,
    Hz40 = 2,
    #[default]
    Hz80 = 3,
    Hz320 = 7,
}

impl Rate {
    /// In hertz.
    #[must_use]
    pub const fn hertz(self) -> f64 {
        match self {
            Self::Hz10 => 10.0,
            Self::Hz20 => 20.0,
            Self::Hz40 => 40.0,
            Self::Hz80 => 80.0,
            Self::Hz320 => 320.0,
        }
    }
}

/// Voltage of the regulator for bridge and analogue part.
///
/// ```
/// use fingertip_drivers::converters::nau7802::{Configuration, Control, Regulator};
///
/// // The chip feeds bridge and analogue part with 3.0 V.
/// let fed = Configuration { regulator: Some(Regulator::V3_0), ..Configuration::default() };
/// assert!(fed.running() & Control::REGULATOR != 0);
/// assert_eq!(fed.registers()[0].1 >> 3 & 0b111, 0b101);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum Regulator {
    V4_5 = 0,
    V4_2,
    V3_9,
    V3_6,
    V3_3,
    V3_0,
    V2_7,
    V2_4,
}

/// Which input is converted.
///
/// ```
/// use fingertip_drivers::converters::nau7802::{Configuration, Input, Nau7802, SimulatedNau7802};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
///
/// // Two bridges at one chip, one after the other.
/// let chip = SimulatedNau7802::new(|_, input| if input == 0 { 1e-3 } else { -2e-3 });
/// let bench = SimulatedBench::new(chip, WireFaults::default());
/// let mut converter = Nau7802::new(bench.i2c(), bench.data_ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::default())?;
/// converter.select(Input::Second)?;
/// assert_eq!(converter.read()?.counts, [-4_294_967]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Input {
    /// VIN1.
    #[default]
    First,
    /// VIN2.
    Second,
}

/// What the device calibrates itself with (`CTRL2.CALMOD`).
///
/// ```
/// use fingertip_drivers::converters::nau7802::{Calibration, Configuration, Nau7802, SimulatedNau7802};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
///
/// let bench = SimulatedBench::new(SimulatedNau7802::new(|_, _| 1e-3), WireFaults::default());
/// let mut converter = Nau7802::new(bench.i2c(), bench.data_ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::default())?;
/// // What is there now becomes zero.
/// converter.calibrate(Calibration::SystemOffset)?;
/// assert_eq!(converter.read()?.counts, [0]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibration {
    /// Its own offset, with its inputs shorted inside.
    Internal = 0,
    /// The input as it is now becomes zero: a tare in the device. It hides what it takes off; collect a
    /// [`Tare`](fingertip_wrench::Tare) instead where you can.
    SystemOffset = 2,
    /// The input as it is now becomes full scale.
    SystemGain = 3,
}

/// What the registers are to hold.
///
/// ```
/// use fingertip_drivers::converters::nau7802::{Configuration, Rate};
///
/// // Gain 128 and 80 Hz unless another is stated.
/// let slow = Configuration { rate: Rate::Hz10, ..Configuration::default() };
/// assert_eq!((slow.gain.factor(), slow.rate.hertz()), (128.0, 10.0));
/// assert_eq!(Configuration::default().rate.hertz(), 80.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Configuration {
    /// Gain.
    pub gain: Gain,
    /// Rate.
    pub rate: Rate,
    /// Regulator; `None` if AVDD is fed from outside.
    pub regulator: Option<Regulator>,
    /// Input.
    pub input: Input,
    /// A crystal stands at the pins instead of the oscillator inside.
    pub crystal: bool,
    /// A capacitor of 330 pF stands across input 2 for less noise; that input cannot be converted then.
    pub capacitor: bool,
}

impl Configuration {
    /// `PU_CTRL` while it converts, without the ready flag.
    #[must_use]
    pub const fn running(&self) -> u8 {
        Control::DIGITAL_ON
            | Control::ANALOG_ON
            | Control::POWERED
            | Control::START
            | if self.crystal { Control::CRYSTAL } else { 0 }
            | if self.regulator.is_some() { Control::REGULATOR } else { 0 }
    }

    /// `CTRL2` without calibration.
    #[must_use]
    pub const fn control2(&self) -> u8 {
        (self.input as u8) << 7 | (self.rate as u8) << 4
    }

    /// Addresses and values of all but `PU_CTRL`. The pin DRDY is low when ready.
    #[must_use]
    pub fn registers(&self) -> [(u8, u8); 5] {
        let voltage = self.regulator.map_or(0, |regulator| (regulator as u8) << 3);
        [
            (Register::CTRL1, 1 << 7 | voltage | self.gain as u8),
            (Register::CTRL2, self.control2()),
            (Register::ADC, 0x30),
            (Register::PGA, 0),
            (Register::POWER, u8::from(self.capacitor) << 7),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_stand_in_their_places() {
        let configuration = Configuration {
            rate: Rate::Hz320,
            regulator: Some(Regulator::V3_0),
            input: Input::Second,
            ..Configuration::default()
        };
        assert_eq!(configuration.running(), 0b1001_1110);
        // Pin low when ready, 3.0 V is 101, gain 128 is 111; input 2, 320 Hz is 111.
        assert_eq!(configuration.registers()[..2], [(1, 0b1010_1111), (2, 0b1111_0000)]);
    }
}
