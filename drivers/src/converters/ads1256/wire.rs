//! Commands, registers and readings.

/// Addresses of registers.
///
/// ```
/// use fingertip_drivers::converters::ads1256::{Command, Register};
///
/// let write = Command::WriteRegisters { address: Register::DRATE };
/// assert_eq!(write.emit(), 0x53);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Register;

#[allow(missing_docs, reason = "named as in the data sheet, and listed in the module")]
impl Register {
    pub const STATUS: u8 = 0;
    pub const MUX: u8 = 1;
    pub const ADCON: u8 = 2;
    pub const DRATE: u8 = 3;
    pub const IO: u8 = 4;
    pub const OFC0: u8 = 5;
    pub const FSC0: u8 = 8;
    /// How many there are.
    pub const COUNT: usize = 11;
}

/// The first byte of a command.
///
/// ```
/// use fingertip_drivers::converters::ads1256::Command;
///
/// assert_eq!(Command::Sync.emit(), 0xFC);
/// assert_eq!(Command::parse(0x12), Some(Command::ReadRegisters { address: 2 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "named as in the data sheet, and listed in the module")]
pub enum Command {
    Wakeup,
    ReadData,
    StopContinuous,
    ReadRegisters { address: u8 },
    WriteRegisters { address: u8 },
    SelfCalibration,
    SystemOffset,
    SystemGain,
    Sync,
    Standby,
    Reset,
}

impl Command {
    /// The byte.
    #[must_use]
    pub const fn emit(self) -> u8 {
        match self {
            Self::Wakeup => 0x00,
            Self::ReadData => 0x01,
            Self::StopContinuous => 0x0F,
            Self::ReadRegisters { address } => 0x10 | address & 0xF,
            Self::WriteRegisters { address } => 0x50 | address & 0xF,
            Self::SelfCalibration => 0xF0,
            Self::SystemOffset => 0xF3,
            Self::SystemGain => 0xF4,
            Self::Sync => 0xFC,
            Self::Standby => 0xFD,
            Self::Reset => 0xFE,
        }
    }

    /// The command of a byte; `None` for one that is not known here.
    #[must_use]
    pub const fn parse(byte: u8) -> Option<Self> {
        Some(match byte {
            0x00 | 0xFF => Self::Wakeup,
            0x01 => Self::ReadData,
            0x0F => Self::StopContinuous,
            0x10..=0x1F => Self::ReadRegisters { address: byte & 0xF },
            0x50..=0x5F => Self::WriteRegisters { address: byte & 0xF },
            0xF0 => Self::SelfCalibration,
            0xF3 => Self::SystemOffset,
            0xF4 => Self::SystemGain,
            0xFC => Self::Sync,
            0xFD => Self::Standby,
            0xFE => Self::Reset,
            _ => return None,
        })
    }
}

/// A pin of the multiplexer.
///
/// ```
/// use fingertip_drivers::converters::ads1256::{Input, Pin};
///
/// // A single pin against the common one.
/// assert_eq!(Input { positive: Pin::Ain5, negative: Pin::Common }.emit(), 0x58);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum Pin {
    Ain0 = 0,
    Ain1,
    Ain2,
    Ain3,
    Ain4,
    Ain5,
    Ain6,
    Ain7,
    Common,
}

/// An input: one pin against another.
///
/// ```
/// use fingertip_drivers::converters::ads1256::{Input, Pin};
///
/// assert_eq!(Input::THIRD, Input { positive: Pin::Ain4, negative: Pin::Ain5 });
/// assert_eq!(Input::THIRD.emit(), 0x45);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input {
    /// Positive pin.
    pub positive: Pin,
    /// Negative pin.
    pub negative: Pin,
}

impl Input {
    /// Pins 0 and 1.
    pub const FIRST: Self = Self { positive: Pin::Ain0, negative: Pin::Ain1 };
    /// Pins 2 and 3.
    pub const SECOND: Self = Self { positive: Pin::Ain2, negative: Pin::Ain3 };
    /// Pins 4 and 5.
    pub const THIRD: Self = Self { positive: Pin::Ain4, negative: Pin::Ain5 };
    /// Pins 6 and 7.
    pub const FOURTH: Self = Self { positive: Pin::Ain6, negative: Pin::Ain7 };

    /// As `MUX` holds it.
    #[must_use]
    pub const fn emit(self) -> u8 {
        (self.positive as u8) << 4 | self.negative as u8
    }
}

/// Gain (`ADCON.PGA`).
///
/// ```
/// use fingertip_drivers::converters::ads1256::Gain;
///
/// // With a reference of 2.5 V, full scale at gain 64 is 78 mV.
/// assert_eq!(2.5 * Gain::X64.full_scale(), 0.078_125);
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
}

impl Gain {
    /// The factor.
    #[must_use]
    pub fn factor(self) -> f64 {
        f64::from(1_u32 << self as u32)
    }

    /// Volts per volt of reference that make full scale, 2²³ − 1 counts.
    #[must_use]
    pub fn full_scale(self) -> f64 {
        2.0 / self.factor()
    }
}

/// Conversions a second at a clock of 7.68 MHz (`DRATE`).
///
/// ```
/// use fingertip_drivers::converters::ads1256::Rate;
///
/// // Where another input comes after each conversion, four of them at 1000 Hz last 4.7 ms.
/// assert_eq!(4 * Rate::Hz1000.settling(), 4720);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum Rate {
    #[default]
    Hz30000 = 0xF0,
    Hz15000 = 0xE0,
    Hz7500 = 0xD0,
    Hz3750 = 0xC0,
    Hz2000 = 0xB0,
    Hz1000 = 0xA1,
    Hz500 = 0x92,
    Hz100 = 0x82,
    Hz60 = 0x72,
    Hz50 = 0x63,
    Hz30 = 0x53,
    Hz25 = 0x43,
    Hz15 = 0x33,
    Hz10 = 0x23,
    Hz5 = 0x13,
    Hz2_5 = 0x03,
}

impl Rate {
    /// All of them.
    pub const ALL: [Self; 16] = [
        Self::Hz30000,
        Self::Hz15000,
        Self::Hz7500,
        Self::Hz3750,
        Self::Hz2000,
        Self::Hz1000,
        Self::Hz500,
        Self::Hz100,
        Self::Hz60,
        Self::Hz50,
        Self::Hz30,
        Self::Hz25,
        Self::Hz15,
        Self::Hz10,
        Self::Hz5,
        Self::Hz2_5,
    ];

    /// Settling time after SYNC \[µs\] at a clock of 7.68 MHz (Settling Time, table 13).
    #[must_use]
    pub const fn settling(self) -> u32 {
        match self {
            Self::Hz30000 => 210,
            Self::Hz15000 => 250,
            Self::Hz7500 => 310,
            Self::Hz3750 => 440,
            Self::Hz2000 => 680,
            Self::Hz1000 => 1180,
            Self::Hz500 => 2180,
            Self::Hz100 => 10_180,
            Self::Hz60 => 16_840,
            Self::Hz50 => 20_180,
            Self::Hz30 => 33_510,
            Self::Hz25 => 40_180,
            Self::Hz15 => 66_840,
            Self::Hz10 => 100_180,
            Self::Hz5 => 200_180,
            Self::Hz2_5 => 400_180,
        }
    }
}

/// What the device calibrates itself with.
///
/// ```
/// use fingertip_drivers::converters::ads1256::{
///     Ads1256, Calibration, Configuration, Input, SimulatedAds1256,
/// };
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
///
/// let bench = SimulatedBench::new(SimulatedAds1256::new(|_, _, _| 0.01), WireFaults::default());
/// let mut converter = Ads1256::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::new([Input::FIRST]))?;
/// // Again, once it is warm; it takes some conversions.
/// let before = bench.now();
/// converter.calibrate(Calibration::Own)?;
/// assert!(bench.now() - before > 1_000_000);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibration {
    /// Its own offset and gain (SELFCAL).
    Own,
    /// The input as it is now becomes zero (SYSOCAL). It hides what it takes off; collect a
    /// [`Tare`](fingertip_wrench::Tare) instead where you can.
    SystemOffset,
    /// The input as it is now becomes full scale (SYSGCAL).
    SystemGain,
}

impl Calibration {
    pub(super) const fn command(self) -> Command {
        match self {
            Self::Own => Command::SelfCalibration,
            Self::SystemOffset => Command::SystemOffset,
            Self::SystemGain => Command::SystemGain,
        }
    }
}

/// What the registers are to hold.
///
/// ```
/// use fingertip_drivers::converters::ads1256::{Configuration, Gain, Input, Rate};
///
/// let slow = Configuration { rate: Rate::Hz60, gain: Gain::X32, ..Configuration::new([Input::SECOND]) };
/// // STATUS with the buffer on, MUX, ADCON, DRATE.
/// assert_eq!(slow.registers(), [0b10, 0x23, 5, 0x72]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration<const N: usize> {
    /// The inputs that it goes through.
    pub inputs: [Input; N],
    /// Gain.
    pub gain: Gain,
    /// Rate.
    pub rate: Rate,
    /// Input buffer on: high impedance, for inputs up to 2 V below the supply.
    pub buffer: bool,
    /// Its clock \[Hz\], for the times.
    pub clock: u32,
}

impl<const N: usize> Configuration<N> {
    /// Of inputs, with gain 64, 1000 Hz, buffer and a clock of 7.68 MHz.
    #[must_use]
    pub const fn new(inputs: [Input; N]) -> Self {
        Self { inputs, gain: Gain::X64, rate: Rate::Hz1000, buffer: true, clock: 7_680_000 }
    }

    /// `STATUS` (without recognition and ready bit), `MUX` at the first input, `ADCON` (clock output off) and
    /// `DRATE`.
    #[must_use]
    pub fn registers(&self) -> [u8; 4] {
        let first = self.inputs.first().map_or(0x01, |input| input.emit());
        [u8::from(self.buffer) << 1, first, self.gain as u8, self.rate as u8]
    }

    /// Some clocks \[ns\], rounded up.
    #[must_use]
    pub fn clocks(&self, count: u32) -> u32 {
        let nanoseconds = (u64::from(count) * 1_000_000_000).div_ceil(u64::from(self.clock.max(1)));
        u32::try_from(nanoseconds).unwrap_or(u32::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn any_byte_is_a_command_or_none_and_is_written_as_it_was_read(command in any::<u8>()) {
            if let Some(known) = Command::parse(command).filter(|_| command != 0xFF) {
                prop_assert_eq!(known.emit(), command);
            }
        }
    }

    #[test]
    fn bytes_and_times_are_those_of_the_data_sheet() {
        let configuration =
            Configuration::new([Input::SECOND, Input { positive: Pin::Ain7, negative: Pin::Common }]);
        assert_eq!(configuration.registers(), [0x02, 0x23, 0x06, 0xA1]);
        assert_eq!(configuration.inputs[1].emit(), 0x78);
        // 50 clocks of 7.68 MHz are 6.51 µs.
        assert_eq!((configuration.clocks(50), configuration.clocks(4)), (6511, 521));
    }
}
