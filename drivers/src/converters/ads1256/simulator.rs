//! A chip that is not there.

use alloc::boxed::Box;
use alloc::collections::VecDeque;
use core::fmt;

use super::wire::{Command, Rate, Register};
use crate::converters::{Reading, SimulatedDevice};

/// What the next bytes of a command are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rest {
    /// The first byte of a command.
    None,
    /// The number of registers to read or to write, less one.
    Number { address: u8, write: bool },
    /// Values of registers.
    Values { address: u8, left: u8 },
}

/// An ADS1256 at 7.68 MHz, to be put on a [`SimulatedBench`](crate::converters::SimulatedBench).
///
/// It obeys commands, converts with the settling time of its rate, and counts what comes sooner than its
/// times (t6, t11) allow: then it answers with ones. Not simulated: calibration other than the time that it
/// takes, standby, continuous reading.
///
/// ```
/// use fingertip_drivers::converters::ads1256::SimulatedAds1256;
/// use fingertip_drivers::converters::{SimulatedBench, SimulatedDevice, WireFaults};
///
/// // A load that grows; after a reset the chip takes 30 000 conversions a second.
/// let bench = SimulatedBench::new(SimulatedAds1256::new(|time, _, _| 0.01 * time), WireFaults::default());
/// bench.advance(10_000_000);
/// assert!(bench.with(|chip| chip.conversions()) > 40);
/// assert_eq!(bench.with(|chip| chip.hurried()), 0);
/// ```
pub struct SimulatedAds1256 {
    /// Input over the reference, at a time \[s\] and between pins.
    input: Box<dyn FnMut(f64, u8, u8) -> f64 + Send>,
    registers: [u8; Register::COUNT],
    rest: Rest,
    answer: VecDeque<u8>,
    /// Before this it must not be asked for what it answers, or be sent a command.
    answer_from: u64,
    command_from: u64,
    hurried: u64,
    result: i32,
    ready: bool,
    next: u64,
    synchronising: bool,
    now: u64,
    conversions: u64,
}

impl fmt::Debug for SimulatedAds1256 {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("SimulatedAds1256").field("registers", &self.registers).finish_non_exhaustive()
    }
}

impl SimulatedAds1256 {
    /// A chip that has just been powered, with its input over the reference as a function of time \[s\],
    /// positive and negative pin (8: common).
    pub fn new(input: impl FnMut(f64, u8, u8) -> f64 + Send + 'static) -> Self {
        let mut chip = Self {
            input: Box::new(input),
            registers: [0; Register::COUNT],
            rest: Rest::None,
            answer: VecDeque::new(),
            answer_from: 0,
            command_from: 0,
            hurried: 0,
            result: 0,
            ready: false,
            next: 0,
            synchronising: false,
            now: 0,
            conversions: 0,
        };
        chip.reset();
        chip
    }

    /// Resets it, as a dip of the supply does.
    pub fn reset(&mut self) {
        self.registers = [0x30, 0x01, 0x20, 0xF0, 0xE0, 0, 0, 0, 0, 0, 0x40];
        self.rest = Rest::None;
        self.answer.clear();
        self.begin(2);
    }

    /// How often it was asked sooner than its times allow.
    #[must_use]
    pub const fn hurried(&self) -> u64 {
        self.hurried
    }

    fn register(&self, address: u8) -> u8 {
        let value = self.registers.get(usize::from(address)).copied().unwrap_or(0);
        if address == Register::STATUS { value & !1 | u8::from(!self.ready) } else { value }
    }

    fn settling(&self) -> u64 {
        let rate = Rate::ALL.into_iter().find(|rate| *rate as u8 == self.register(Register::DRATE));
        u64::from(rate.unwrap_or_default().settling()) * 1000
    }

    /// Begins a conversion, or a calibration as long as some of them.
    fn begin(&mut self, conversions: u64) {
        (self.ready, self.next) = (false, self.now + conversions * self.settling());
    }

    fn convert(&mut self) {
        let mux = self.register(Register::MUX);
        #[allow(clippy::cast_precision_loss, reason = "a time")]
        let ratio = (self.input)(self.next as f64 * 1e-9, mux >> 4, mux & 0xF);
        let gain = f64::from(1_u32 << (self.register(Register::ADCON) & 7).min(6));
        #[allow(clippy::cast_possible_truncation, reason = "clipped as the chip does")]
        let counts = (ratio * gain / 2.0 * 8_388_607.0).round().clamp(-8_388_608.0, 8_388_607.0) as i32;
        (self.result, self.ready) = (counts, true);
        self.conversions += 1;
    }

    fn obey(&mut self, command: Command) {
        let clocks = |count: u64| count * 1_000_000_000 / 7_680_000;
        match command {
            Command::ReadData => {
                self.answer.extend(Reading { counts: self.result }.emit());
                self.ready = false;
                self.answer_from = self.now + clocks(50);
            }
            Command::ReadRegisters { address } => self.rest = Rest::Number { address, write: false },
            Command::WriteRegisters { address } => self.rest = Rest::Number { address, write: true },
            Command::SelfCalibration | Command::SystemOffset | Command::SystemGain => self.begin(3),
            Command::Sync => {
                self.synchronising = true;
                self.command_from = self.now + clocks(24);
            }
            Command::Wakeup if self.synchronising => {
                self.synchronising = false;
                self.begin(1);
            }
            Command::Reset => self.reset(),
            Command::Wakeup | Command::StopContinuous | Command::Standby => {}
        }
    }
}

impl SimulatedDevice for SimulatedAds1256 {
    fn advance(&mut self, nanoseconds: u64) {
        self.now += nanoseconds;
        while self.next <= self.now {
            self.convert();
            self.next += self.settling();
        }
    }

    fn select(&mut self) {
        self.rest = Rest::None;
        self.answer.clear();
    }

    fn shift(&mut self, byte: u8) -> u8 {
        match self.rest {
            Rest::Number { address, write: true } => self.rest = Rest::Values { address, left: byte },
            Rest::Number { address, write: false } => {
                for address in address..=address.saturating_add(byte) {
                    self.answer.push_back(self.register(address));
                }
                self.rest = Rest::None;
                self.answer_from = self.now + 6510;
            }
            Rest::Values { address, left } => {
                if let Some(register) = self.registers.get_mut(usize::from(address)) {
                    let fixed = if address == Register::STATUS { 0xF1 } else { 0 };
                    *register = *register & fixed | byte & !fixed;
                }
                let next = address.saturating_add(1);
                self.rest =
                    if left == 0 { Rest::None } else { Rest::Values { address: next, left: left - 1 } };
            }
            Rest::None => {
                if let Some(answer) = self.answer.pop_front() {
                    if self.now < self.answer_from {
                        self.hurried += 1;
                        return 0xFF;
                    }
                    return answer;
                }
                if self.now < self.command_from {
                    self.hurried += 1;
                }
                if let Some(command) = Command::parse(byte) {
                    self.obey(command);
                }
            }
        }
        0xFF
    }

    fn deselect(&mut self) {}

    fn is_ready(&self) -> bool {
        self.ready
    }

    fn conversions(&self) -> u64 {
        self.conversions
    }
}
