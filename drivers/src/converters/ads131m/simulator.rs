//! A chip that is not there.

use alloc::boxed::Box;
use alloc::collections::VecDeque;
use core::fmt;

use super::configuration::{Configuration, Gain};
use super::wire::{Answer, LONGEST, Register, Request, Status};
use crate::converters::SimulatedDevice;

/// An ADS131M with `N` channels, clocked at 8.192 MHz, to be put on a
/// [`SimulatedBench`](crate::converters::SimulatedBench).
///
/// It obeys commands with their checksums, keeps registers, locks them, converts at the data rate that they
/// set, holds two conversions, and gives the older one first. Not simulated: settling of the filter,
/// standby, chopping, phase, the register CRC's value.
///
/// A disturbance changes a register, and the driver notices:
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Ads131m, Configuration, Register, SimulatedAds131m};
/// use fingertip_drivers::converters::{
///     ConverterError, ConverterFault, Patience, SimulatedBench, WireFaults,
/// };
///
/// let bench = SimulatedBench::new(SimulatedAds131m::new(|_| [0.001; 2]), WireFaults::default());
/// let mut converter = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::<2> { watch_registers: true, ..Configuration::default() })?;
/// converter.read()?;
/// bench.with(|chip| chip.disturb(Register::GAIN1, 1));
/// assert_eq!(converter.read(), Err(ConverterError::Fault(ConverterFault::Reset)));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub struct SimulatedAds131m<const N: usize> {
    /// Volts at the inputs, at a time \[s\].
    input: Box<dyn FnMut(f64) -> [f64; N] + Send>,
    registers: [u16; Register::COUNT],
    status: u16,
    held: VecDeque<[i32; N]>,
    last: [i32; N],
    fresh: u8,
    /// What the next frame begins with, if not `STATUS`.
    response: Option<u16>,
    answer: [u8; LONGEST],
    request: [u8; LONGEST],
    shifted: usize,
    now: u64,
    next: u64,
    conversions: u64,
    rejected: u64,
}

impl<const N: usize> fmt::Debug for SimulatedAds131m<N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("SimulatedAds131m")
            .field("conversions", &self.conversions)
            .finish_non_exhaustive()
    }
}

impl<const N: usize> SimulatedAds131m<N> {
    const CLOCK: f64 = 8.192e6;

    /// A chip that has just been powered, with volts at its inputs as a function of time \[s\].
    pub fn new(input: impl FnMut(f64) -> [f64; N] + Send + 'static) -> Self {
        let mut chip = Self {
            input: Box::new(input),
            registers: [0; Register::COUNT],
            status: 0,
            held: VecDeque::new(),
            last: [0; N],
            fresh: 0,
            response: None,
            answer: [0; LONGEST],
            request: [0; LONGEST],
            shifted: 0,
            now: 0,
            next: 0,
            conversions: 0,
            rejected: 0,
        };
        chip.reset();
        chip
    }

    /// Resets it, as a dip of the supply does.
    pub fn reset(&mut self) {
        self.registers = [0; Register::COUNT];
        let reset = Configuration::<N>::default();
        for (address, value) in reset.registers() {
            self.set(address, value);
        }
        self.set(Register::MODE, 0x0510);
        self.set(Register::ID, 0x2000 | (N as u16) << 8);
        self.status = Status::RESET | 1 << 8;
        self.response = Request::Reset.acknowledgement(u8::try_from(N).unwrap_or(0));
        self.held.clear();
        self.restart();
    }

    /// Flips bits of a register behind the driver's back, as radiation or a disturbance does.
    pub fn disturb(&mut self, address: u8, bits: u16) {
        self.set(address, self.register(address) ^ bits);
        if self.register(Register::MODE) & 1 << 13 != 0 {
            self.status |= Status::REGISTERS;
        }
    }

    /// A register.
    #[must_use]
    pub fn register(&self, address: u8) -> u16 {
        self.registers.get(usize::from(address)).copied().unwrap_or(0)
    }

    /// How many commands had a wrong checksum.
    #[must_use]
    pub const fn rejected(&self) -> u64 {
        self.rejected
    }

    fn set(&mut self, address: u8, value: u16) {
        if let Some(place) = self.registers.get_mut(usize::from(address)) {
            *place = value;
        }
    }

    /// Nanoseconds from one conversion to the next.
    fn period(&self) -> u64 {
        let clock = self.register(Register::CLOCK);
        let divider = [8.0, 4.0, 2.0, 2.0].get(usize::from(clock & 3)).copied().unwrap_or(2.0);
        let ratio = f64::from(128_u32 << (clock >> 2 & 7));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive and small")]
        let period = (divider * ratio / Self::CLOCK * 1e9) as u64;
        period
    }

    fn restart(&mut self) {
        self.next = self.now + self.period();
    }

    fn convert(&mut self) {
        #[allow(clippy::cast_precision_loss, reason = "a time")]
        let volts = (self.input)(self.next as f64 * 1e-9);
        let enabled = self.register(Register::CLOCK) >> 8;
        let mut counts = [0; N];
        for (channel, (count, volts)) in counts.iter_mut().zip(volts).enumerate() {
            if enabled >> channel & 1 == 1 {
                *count = self.code(channel, volts);
            }
        }
        if self.held.len() == 2 {
            self.held.pop_front();
        }
        self.held.push_back(counts);
        #[allow(clippy::cast_possible_truncation, reason = "at most eight channels")]
        let enabled = enabled as u8;
        self.fresh = enabled;
        self.conversions += 1;
    }

    fn code(&self, channel: usize, volts: f64) -> i32 {
        let gains = self.register(if channel < 4 { Register::GAIN1 } else { Register::GAIN2 });
        let gain = f64::from(1_u32 << (gains >> (channel % 4 * 4) & 7));
        #[allow(clippy::cast_possible_truncation, reason = "at most eight channels")]
        let base = Register::CH0_CFG + Register::PER_CHANNEL * channel as u8;
        let range = Configuration::<N>::REFERENCE / gain;
        let volts = match self.register(base) & 3 {
            0 => volts,
            1 => 0.0,
            2 => 0.16 / gain,
            _ => -0.16 / gain,
        };
        let offset =
            i32::from(self.register(base + 1).cast_signed()) << 8 | i32::from(self.register(base + 2) >> 8);
        let gain = u32::from(self.register(base + 3)) << 8 | u32::from(self.register(base + 4) >> 8);
        let code = (volts / range * 8_388_608.0 - f64::from(offset)) * f64::from(gain) / 8_388_608.0;
        #[allow(clippy::cast_possible_truncation, reason = "clipped as the chip does")]
        let code = code.round().clamp(-8_388_608.0, 8_388_607.0) as i32;
        code
    }

    fn obey(&mut self, request: Request) {
        let locked = self.status & Status::LOCK != 0;
        match request {
            Request::Null => {}
            Request::Read { address } if address == Register::STATUS => self.response = Some(self.status()),
            Request::Read { address } => self.response = Some(self.register(address)),
            Request::Unlock => {
                self.status &= !Status::LOCK;
                self.response = Some(request.word());
            }
            // A locked device says what it says to NULL.
            _ if locked => {}
            Request::Reset => self.reset(),
            Request::Lock => {
                self.status |= Status::LOCK;
                self.response = Some(request.word());
            }
            Request::Write { address, value } => {
                if address > Register::STATUS && address < Register::REGMAP_CRC {
                    self.set(address, value);
                }
                match address {
                    Register::MODE => {
                        self.status =
                            self.status & !(Status::RESET | 0x0300) | value & (Status::RESET | 0x0300);
                    }
                    Register::CLOCK => self.restart(),
                    _ => {}
                }
                if self.register(Register::MODE) & 1 << 13 != 0 {
                    self.status |= Status::REGISTERS;
                }
                self.response = request.acknowledgement(0);
            }
            Request::Standby | Request::Wakeup => self.response = Some(request.word()),
        }
    }

    fn status(&self) -> u16 {
        self.status | u16::from(self.fresh)
    }
}

impl<const N: usize> SimulatedDevice for SimulatedAds131m<N> {
    fn advance(&mut self, nanoseconds: u64) {
        self.now += nanoseconds;
        while self.next <= self.now {
            self.convert();
            self.next += self.period().max(1);
        }
    }

    fn select(&mut self) {
        self.shifted = 0;
        let status = self.response.is_none();
        let response = self.response.take().unwrap_or_else(|| self.status());
        if status {
            self.status &= !(Status::REGISTERS | Status::REJECTED | Status::RESYNC);
        }
        if let Some(counts) = self.held.pop_front() {
            self.last = counts;
        }
        if self.held.is_empty() {
            self.fresh = 0;
        }
        Answer { response, counts: self.last }
            .emit(self.answer.get_mut(..Answer::<N>::LENGTH).unwrap_or_default());
    }

    fn shift(&mut self, byte: u8) -> u8 {
        if let Some(place) = self.request.get_mut(self.shifted) {
            *place = byte;
        }
        let answer = self.answer.get(self.shifted).copied().unwrap_or(0);
        self.shifted += 1;
        answer
    }

    fn deselect(&mut self) {
        let checked = self.register(Register::MODE) & 1 << 12 != 0;
        let request = self.request.get(..self.shifted.min(LONGEST)).unwrap_or_default();
        match Request::parse(request, checked) {
            Ok(request) => self.obey(request.unwrap_or(Request::Null)),
            Err(_) => {
                self.rejected += 1;
                self.status |= Status::REJECTED;
            }
        }
    }

    fn is_ready(&self) -> bool {
        !self.held.is_empty()
    }

    fn conversions(&self) -> u64 {
        self.conversions
    }
}

/// Volts that give counts, for tests.
impl<const N: usize> SimulatedAds131m<N> {
    /// Volts at the input that give so many counts with a gain.
    #[must_use]
    pub fn volts(counts: i32, gain: Gain) -> f64 {
        f64::from(counts) * Configuration::<N>::REFERENCE / gain.factor() / 8_388_608.0
    }
}
