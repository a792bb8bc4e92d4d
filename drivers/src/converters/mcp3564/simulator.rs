//! A chip that is not there.

use alloc::boxed::Box;
use alloc::collections::VecDeque;
use core::fmt;

use super::configuration::Gain;
use super::wire::{Data, FastCommand, Register, Request, Status, checksum};
use crate::converters::SimulatedDevice;

/// An MCP3564 of device address 1 with its clock of 4.9152 MHz, to be put on a
/// [`SimulatedBench`](crate::converters::SimulatedBench).
///
/// It obeys fast commands, keeps and locks registers, goes through its list and marks what is new. Not
/// simulated: settling of the filter, offset calibration, delays in the list, formats other than that with
/// channel numbers.
///
/// The supply dips. Then the chip converts nothing until it is configured, and the driver asks why:
///
/// ```
/// use fingertip_drivers::converters::mcp3564::{Channel, Configuration, Mcp3564, SimulatedMcp3564};
/// use fingertip_drivers::converters::{
///     ConverterError, ConverterFault, Patience, SimulatedBench, WireFaults,
/// };
///
/// let bench = SimulatedBench::new(SimulatedMcp3564::new(false, |_, _| 0.25), WireFaults::default());
/// let mut converter = Mcp3564::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::new([Channel::PairA]))?;
/// bench.with(|chip| chip.power_cycle());
/// assert_eq!(converter.read(), Err(ConverterError::Fault(ConverterFault::Reset)));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub struct SimulatedMcp3564 {
    /// Input over the reference, at a time \[s\] and of the channel of that number.
    input: Box<dyn FnMut(f64, u8) -> f64 + Send>,
    registers: [u32; 16],
    /// Whether the list runs down.
    down: bool,
    converts: bool,
    data: Data,
    new: bool,
    was_off: bool,
    /// What the registers were when they were locked.
    locked: Option<[u32; 16]>,
    at: Option<u8>,
    now: u64,
    next: u64,
    conversions: u64,
    /// What is sent in the rest of the transaction.
    answer: VecDeque<u8>,
    command: Option<Request>,
    /// Bytes of a register that is being written.
    written: u32,
    writing: usize,
    begun: bool,
}

impl fmt::Debug for SimulatedMcp3564 {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("SimulatedMcp3564").field("registers", &self.registers).finish_non_exhaustive()
    }
}

impl SimulatedMcp3564 {
    const DEVICE: u8 = 1;
    const OPEN: u32 = 0xA5;

    /// A chip that has just been powered, with its input over the reference as a function of time \[s\] and
    /// channel number. `down`: the list runs from the highest channel to the lowest.
    pub fn new(down: bool, input: impl FnMut(f64, u8) -> f64 + Send + 'static) -> Self {
        let mut chip = Self {
            input: Box::new(input),
            registers: [0; 16],
            down,
            converts: false,
            data: Data { channel: 0, counts: 0 },
            new: false,
            was_off: false,
            locked: None,
            at: None,
            now: 0,
            next: u64::MAX,
            conversions: 0,
            answer: VecDeque::new(),
            command: None,
            written: 0,
            writing: 0,
            begun: false,
        };
        chip.power_cycle();
        chip
    }

    /// Switches the supply off and on.
    pub fn power_cycle(&mut self) {
        self.reset();
        self.was_off = true;
    }

    /// Flips bits of a register behind the driver's back.
    pub fn disturb(&mut self, address: u8, bits: u32) {
        if let Some(register) = self.registers.get_mut(usize::from(address)) {
            *register ^= bits;
        }
    }

    fn reset(&mut self) {
        self.registers =
            [0, 0xC0, 0x0C, 0x8B, 0, 0x73, 0x01, 0, 0, 0, 0x80_0000, 0x90_0000, 0x50, Self::OPEN, 0x0F, 0];
        (self.converts, self.new, self.locked, self.at, self.next) = (false, false, None, None, u64::MAX);
    }

    fn register(&self, address: u8) -> u32 {
        self.registers.get(usize::from(address)).copied().unwrap_or(0)
    }

    fn status(&self) -> u8 {
        let damaged = self.locked.is_some_and(|locked| locked != self.registers);
        Status::address_bits(Self::DEVICE)
            | u8::from(!self.new) << 2
            | u8::from(!damaged) << 1
            | u8::from(!self.was_off)
    }

    fn period(&self) -> u64 {
        const RATIOS: [u64; 16] =
            [32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 20480, 24576, 40960, 49152, 81920, 98304];
        let ratio =
            RATIOS.get((self.register(Register::CONFIG1) >> 2 & 0xF) as usize).copied().unwrap_or(256);
        4 * ratio * 1_000_000_000 / 4_915_200
    }

    fn next_channel(&self) -> Option<u8> {
        let list = self.register(Register::SCAN) & 0xFFFF;
        let is_listed = |channel: &u8| list >> channel & 1 == 1;
        if self.down {
            let after = self.at.and_then(|at| (0..at).rev().find(is_listed));
            after.or_else(|| (0..16).rev().find(is_listed))
        } else {
            let after = self.at.and_then(|at| (at + 1..16).find(is_listed));
            after.or_else(|| (0..16).find(is_listed))
        }
    }

    fn convert(&mut self) {
        let Some(channel) = self.next_channel() else { return };
        self.at = Some(channel);
        #[allow(clippy::cast_precision_loss, reason = "a time")]
        let ratio = (self.input)(self.next as f64 * 1e-9, channel);
        let gain = [Gain::Third, Gain::X1, Gain::X2, Gain::X4, Gain::X8, Gain::X16, Gain::X32, Gain::X64];
        let gain =
            gain.get((self.register(Register::CONFIG2) >> 3 & 7) as usize).map_or(1.0, |gain| gain.factor());
        #[allow(clippy::cast_possible_truncation, reason = "clipped as the chip does")]
        let counts = (ratio * gain * 8_388_608.0).round().clamp(-16_777_216.0, 16_777_215.0) as i32;
        self.data = Data { channel, counts };
        self.new = true;
        self.conversions += 1;
    }

    fn fast(&mut self, command: FastCommand) {
        match command {
            FastCommand::Start => {
                self.converts = true;
                (self.at, self.new, self.next) = (None, false, self.now + self.period());
            }
            FastCommand::Standby | FastCommand::ConverterOff | FastCommand::AllOff => {
                (self.converts, self.next) = (false, u64::MAX);
            }
            FastCommand::Reset => self.reset(),
        }
    }

    fn begin(&mut self, byte: u8) -> u8 {
        let status = self.status();
        let (device, request) = Request::parse(byte);
        if device != Self::DEVICE {
            return 0xFF;
        }
        self.command = request;
        match request {
            Some(Request::Fast(command)) => self.fast(command),
            Some(Request::Read { address }) => {
                let data = if address == Register::ADCDATA {
                    self.new = false;
                    self.data.emit()
                } else if address == Register::IRQ {
                    self.was_off = false;
                    (self.register(address) & 0xF | 0x70).to_be_bytes()
                } else {
                    self.register(address).to_be_bytes()
                };
                let data = data.get(4 - Register::length(address)..).unwrap_or_default();
                let mut whole = alloc::vec![status];
                whole.extend_from_slice(data);
                let crc = checksum(&whole);
                self.answer.extend(data);
                if self.register(Register::CONFIG3) & 1 << 2 != 0 {
                    self.answer.extend(crc);
                }
            }
            Some(Request::Write { .. }) | None => {}
        }
        status
    }

    fn write(&mut self, byte: u8) {
        let Some(Request::Write { address }) = self.command else { return };
        self.written = self.written << 8 | u32::from(byte);
        self.writing += 1;
        if self.writing < Register::length(address) {
            return;
        }
        let value = core::mem::take(&mut self.written);
        self.writing = 0;
        self.command = Some(Request::Write { address: (address + 1) & 0xF });
        let open = self.register(Register::LOCK) == Self::OPEN;
        let writable = address == Register::LOCK || (open && address != Register::ADCDATA);
        if let Some(register) = self.registers.get_mut(usize::from(address)).filter(|_| writable) {
            *register = value;
        }
        if address == Register::LOCK {
            self.locked = (value != Self::OPEN).then_some(self.registers);
        }
    }
}

impl SimulatedDevice for SimulatedMcp3564 {
    fn advance(&mut self, nanoseconds: u64) {
        self.now += nanoseconds;
        while self.converts && self.next <= self.now {
            self.convert();
            self.next += self.period();
        }
    }

    fn select(&mut self) {
        self.answer.clear();
        (self.begun, self.command, self.written, self.writing) = (false, None, 0, 0);
    }

    fn shift(&mut self, byte: u8) -> u8 {
        if !self.begun {
            self.begun = true;
            return self.begin(byte);
        }
        self.write(byte);
        self.answer.pop_front().unwrap_or(0)
    }

    fn deselect(&mut self) {}

    fn is_ready(&self) -> bool {
        self.new
    }

    fn conversions(&self) -> u64 {
        self.conversions
    }
}
