//! A chip that is not there.

use alloc::boxed::Box;
use core::fmt;

use embedded_hal::i2c::{self, ErrorKind, I2c, NoAcknowledgeSource, Operation};

use super::wire::{ADDRESS, CALIBRATE, CALIBRATION_ERROR, Control, Register};
use crate::converters::{Inner, Level, Reading, SimulatedBench, SimulatedDevice, SimulatedLine};

/// An NAU7802, to be put on a [`SimulatedBench`]. It powers up, converts at the rate of its registers, calibrates
/// its offset (which it has, 1000 counts) and says when it cannot. Not simulated: the filter, gain calibration.
///
/// ```
/// use fingertip_drivers::converters::nau7802::{Configuration, Nau7802, SimulatedNau7802};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
///
/// // A bridge that gives 5 mV/V is beyond the range at gain 128.
/// let bench = SimulatedBench::new(SimulatedNau7802::new(|_, _| 5e-3), WireFaults::default());
/// let mut converter = Nau7802::new(bench.i2c(), bench.data_ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::default())?;
/// assert_eq!(converter.read()?.saturated, [true]);
/// assert!(bench.with(|chip| chip.conversions()) > 0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub struct SimulatedNau7802 {
    /// Output of the bridge over the reference, at a time \[s\] and an input (0 or 1).
    input: Box<dyn FnMut(f64, usize) -> f64 + Send>,
    registers: [u8; Register::COUNT],
    pointer: u8,
    now: u64,
    powered_at: Option<u64>,
    next: u64,
    calibrated_at: Option<u64>,
    conversions: u64,
}

impl fmt::Debug for SimulatedNau7802 {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("SimulatedNau7802").field("registers", &self.registers).finish_non_exhaustive()
    }
}

impl SimulatedNau7802 {
    /// What the converter is off by until it is calibrated \[counts\].
    pub const OFFSET: i32 = 1000;

    /// A chip that has just been powered, with the output of the bridge over the reference as a function of
    /// time \[s\] and input (0 or 1).
    pub fn new(input: impl FnMut(f64, usize) -> f64 + Send + 'static) -> Self {
        let mut chip = Self {
            input: Box::new(input),
            registers: [0; Register::COUNT],
            pointer: 0,
            now: 0,
            powered_at: None,
            next: u64::MAX,
            calibrated_at: None,
            conversions: 0,
        };
        chip.reset();
        chip
    }

    /// Resets it, as a dip of the supply does.
    pub fn reset(&mut self) {
        self.registers = [0; Register::COUNT];
        for (address, value) in
            [(Register::GCAL1 + 1, 0x80), (Register::GCAL2 + 1, 0x80), (Register::REVISION, 0x0F)]
        {
            self.set(address, value);
        }
        (self.powered_at, self.next, self.calibrated_at) = (None, u64::MAX, None);
    }

    /// A register.
    #[must_use]
    pub fn register(&self, address: u8) -> u8 {
        self.registers.get(usize::from(address)).copied().unwrap_or(0)
    }

    /// How many conversions were made.
    #[must_use]
    pub const fn conversions(&self) -> u64 {
        self.conversions
    }

    fn set(&mut self, address: u8, value: u8) {
        if let Some(place) = self.registers.get_mut(usize::from(address)) {
            *place = value;
        }
    }

    fn period(&self) -> u64 {
        match self.register(Register::CTRL2) >> 4 & 7 {
            0 => 100_000_000,
            1 => 50_000_000,
            2 => 25_000_000,
            7 => 3_125_000,
            _ => 12_500_000,
        }
    }

    fn is_ready(&self) -> bool {
        self.register(Register::PU_CTRL) & Control::READY != 0
    }

    fn write(&mut self, address: u8, value: u8) {
        match address {
            Register::PU_CTRL if value & Control::RESET != 0 => {
                self.reset();
                self.set(address, Control::RESET);
            }
            Register::PU_CTRL => {
                let kept = self.register(address) & (Control::POWERED | Control::READY);
                self.set(address, value & !(Control::POWERED | Control::READY) | kept);
                if value & Control::DIGITAL_ON != 0 && self.powered_at.is_none() {
                    self.powered_at = Some(self.now + 200_000);
                }
                let runs = Control::START | Control::ANALOG_ON;
                if value & runs == runs && self.next == u64::MAX {
                    self.next = self.now + self.period();
                }
            }
            Register::CTRL2 => {
                self.set(address, value & !CALIBRATION_ERROR);
                if value & CALIBRATE != 0 {
                    self.calibrated_at = Some(self.now + 4 * self.period());
                }
            }
            Register::ADCO..Register::ADC | Register::REVISION => {}
            _ => self.set(address, value),
        }
    }

    fn read(&mut self, address: u8) -> u8 {
        if address == Register::ADCO + 2 {
            self.set(Register::PU_CTRL, self.register(Register::PU_CTRL) & !Control::READY);
        }
        self.register(address)
    }

    /// The converter's number at a time, without calibration and without an end.
    fn measured(&mut self, at: u64, shorted: bool) -> f64 {
        let input = usize::from(self.register(Register::CTRL2) >> 7);
        #[allow(clippy::cast_precision_loss, reason = "a time")]
        let ratio = if shorted { 0.0 } else { (self.input)(at as f64 * 1e-9, input) };
        let gain = f64::from(1_u32 << (self.register(Register::CTRL1) & 7));
        (ratio * gain * 2.0 * 8_388_608.0).round() + f64::from(Self::OFFSET)
    }

    fn offset_register(&self) -> u8 {
        if self.register(Register::CTRL2) >> 7 == 0 { Register::OCAL1 } else { Register::OCAL2 }
    }

    fn calibrate(&mut self) {
        self.calibrated_at = None;
        let control = self.register(Register::CTRL2);
        let measured = self.measured(self.now, control & 3 == 0);
        let fails = measured.abs() >= 8_388_607.0 || control & 3 == 3;
        self.set(Register::CTRL2, control & !CALIBRATE | if fails { CALIBRATION_ERROR } else { 0 });
        if !fails {
            #[allow(clippy::cast_possible_truncation, reason = "within 24 bits")]
            let bytes = Reading { counts: measured as i32 }.emit();
            for (address, byte) in (self.offset_register()..).zip(bytes) {
                self.set(address, byte);
            }
        }
    }

    fn convert(&mut self) {
        let base = self.offset_register();
        let offset = Reading::parse([self.register(base), self.register(base + 1), self.register(base + 2)]);
        let value = self.measured(self.next, false) - f64::from(offset.counts);
        #[allow(clippy::cast_possible_truncation, reason = "clipped as the chip does")]
        let counts = value.clamp(-8_388_608.0, 8_388_607.0) as i32;
        for (address, byte) in (Register::ADCO..).zip(Reading { counts }.emit()) {
            self.set(address, byte);
        }
        self.set(Register::PU_CTRL, self.register(Register::PU_CTRL) | Control::READY);
        self.conversions += 1;
    }
}

impl SimulatedDevice for SimulatedNau7802 {
    fn advance(&mut self, nanoseconds: u64) {
        self.now += nanoseconds;
        if self.powered_at.is_some_and(|at| at <= self.now) {
            self.set(Register::PU_CTRL, self.register(Register::PU_CTRL) | Control::POWERED);
        }
        while self.next <= self.now {
            if self.calibrated_at.is_none() {
                self.convert();
            }
            self.next += self.period();
        }
        if self.calibrated_at.is_some_and(|at| at <= self.now) {
            self.calibrate();
        }
    }
}

impl SimulatedBench<SimulatedNau7802> {
    /// The bus.
    #[must_use]
    pub fn i2c(&self) -> SimulatedI2c {
        SimulatedI2c(self.clone())
    }

    /// The pin DRDY.
    #[must_use]
    pub fn data_ready(&self) -> SimulatedLine<SimulatedNau7802> {
        let is_high = |bench: &mut Inner<SimulatedNau7802>, _: usize| match bench.faults.stuck_ready {
            Some(level) => level == Level::High,
            // CTRL1.CRP turns it round.
            None => bench.device.is_ready() != (bench.device.register(Register::CTRL1) & 1 << 7 != 0),
        };
        SimulatedLine::new(self.clone(), is_high, 0)
    }
}

/// The bus of a simulated chip, blocking and for tasks. A data line that is stuck low gives zeros; one that is
/// stuck high gives no acknowledgement.
///
/// ```
/// use embedded_hal::i2c::I2c;
/// use fingertip_drivers::converters::nau7802::{ADDRESS, Register, SimulatedNau7802};
/// use fingertip_drivers::converters::{SimulatedBench, WireFaults};
///
/// let bench = SimulatedBench::new(SimulatedNau7802::new(|_, _| 1e-3), WireFaults::default());
/// let mut revision = [0];
/// bench.i2c().write_read(ADDRESS, &[Register::REVISION], &mut revision)?;
/// assert_eq!(revision, [0x0F]);
/// // Nobody is at another address.
/// assert!(bench.i2c().write(ADDRESS + 1, &[0]).is_err());
/// # Ok::<(), embedded_hal::i2c::ErrorKind>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedI2c(SimulatedBench<SimulatedNau7802>);

impl SimulatedI2c {
    fn run(&self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        let bench = &mut *self.0.lock();
        // A byte with its acknowledgement lasts 22.5 µs at 400 kHz.
        bench.advance(22_500);
        if address != ADDRESS || bench.faults.stuck_data == Some(Level::High) {
            return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
        }
        for operation in operations {
            match operation {
                Operation::Write(bytes) => {
                    let flip = bench.draw(bench.faults.request_flip, bytes.len());
                    for (index, byte) in bytes.iter().enumerate() {
                        bench.advance(22_500);
                        let byte = byte ^ flip.filter(|bit| bit / 8 == index).map_or(0, |bit| 1 << (bit % 8));
                        if index == 0 {
                            bench.device.pointer = byte;
                        } else {
                            let pointer = bench.device.pointer;
                            bench.device.write(pointer, byte);
                            bench.device.pointer = pointer.wrapping_add(1);
                        }
                    }
                }
                Operation::Read(bytes) => {
                    let flip = bench.draw(bench.faults.answer_flip, bytes.len());
                    for (index, place) in bytes.iter_mut().enumerate() {
                        let pointer = bench.device.pointer;
                        let byte = bench.device.read(pointer);
                        bench.device.pointer = pointer.wrapping_add(1);
                        let flipped =
                            byte ^ flip.filter(|bit| bit / 8 == index).map_or(0, |bit| 1 << (bit % 8));
                        *place = if bench.faults.stuck_data.is_some() { 0 } else { flipped };
                        bench.advance(22_500);
                    }
                }
            }
        }
        Ok(())
    }
}

impl i2c::ErrorType for SimulatedI2c {
    type Error = ErrorKind;
}

impl I2c for SimulatedI2c {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        self.run(address, operations)
    }
}

impl embedded_hal_async::i2c::I2c for SimulatedI2c {
    async fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        self.run(address, operations)
    }
}
