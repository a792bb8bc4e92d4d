//! The two faces.

use embedded_hal::digital::{ErrorType as PinErrorType, InputPin};
use embedded_hal::spi::ErrorType as BusErrorType;
use fingertip_wrench::Real;
use nalgebra::SVector;

use super::configuration::Configuration;
use super::scan::Scan;
use super::wire::{Data, FastCommand, Register, Request, Status, parse_answer, tells_reset};
use crate::Sample;
use crate::converters::{
    Conversion, ConverterError, ConverterFault, ConverterStatistics, Patience, parts, ready_in_time,
    ready_in_time_async, sources,
};
use crate::polled::NbSource;

type Failure<S, P> = ConverterError<<S as BusErrorType>::Error, <P as PinErrorType>::Error>;

/// Command, four bytes of data, CRC.
const LONGEST: usize = 7;
/// `LOCK` while it is open, and a value that locks.
const OPEN: u8 = 0xA5;
const LOCKED: u8 = 0x00;

/// What both faces know.
#[derive(Clone, Copy, Debug)]
struct State<const N: usize> {
    patience: Patience,
    device: u8,
    scan: Option<Scan<N>>,
    statistics: ConverterStatistics,
}

impl<const N: usize> State<N> {
    fn fault(&mut self, fault: ConverterFault) -> ConverterFault {
        self.statistics.note(&fault);
        match fault {
            ConverterFault::Reset => self.scan = None,
            _ => self.give_up(),
        }
        fault
    }

    fn give_up(&mut self) {
        let lost = self.scan.as_mut().map_or(0, Scan::restart);
        self.statistics.incomplete += lost as u64;
    }

    fn ready_to_read(&self) -> Result<(), ConverterFault> {
        self.scan.as_ref().map(|_| ()).ok_or(ConverterFault::NotConfigured)
    }

    /// Takes a reading of `ADCDATA`: whether it was new, and the sample if it completes one. A fault is not counted yet.
    #[allow(clippy::type_complexity, reason = "two answers that belong together")]
    fn accept(
        &mut self,
        status: Status,
        bytes: [u8; 4],
    ) -> Result<(bool, Option<Conversion<N>>), ConverterFault> {
        if status.was_off() || status.registers_damaged() {
            return Err(ConverterFault::Reset);
        }
        if !status.is_new() {
            self.statistics.stale += 1;
            return Ok((false, None));
        }
        let data = Data::parse(bytes)?;
        let scan = self.scan.as_mut().ok_or(ConverterFault::NotConfigured)?;
        let (counts, lost) = scan.push(data);
        self.statistics.incomplete += lost as u64;
        let conversion = counts.map(|counts| Conversion::clipped(counts, -(1 << 23), (1 << 23) - 1));
        if let Some(conversion) = &conversion {
            self.statistics.converted(conversion);
        }
        Ok((true, conversion))
    }
}

macro_rules! face {
    (
        $(#[$documentation:meta])*
        $name:ident, $bus:path, $pin:path, $delay:path, $wait:ident, [$($async:tt)?], [$($await:tt)*]
    ) => {
        $(#[$documentation])*
        #[derive(Debug)]
        pub struct $name<S, P, D, const N: usize> {
            bus: S,
            ready: P,
            delay: D,
            state: State<N>,
        }

        impl<S: $bus, P: $pin, D: $delay, const N: usize> $name<S, P, D, N> {
            /// On a bus, with the pin IRQ (or [`Unwired`](crate::converters::Unwired)) and a delay. Nothing is
            /// sent yet.
            #[must_use]
            pub fn new(bus: S, ready: P, delay: D, patience: Patience) -> Self {
                let statistics = ConverterStatistics::default();
                Self { bus, ready, delay, state: State { patience, device: 1, scan: None, statistics } }
            }

            /// Throws away the cycle that is under way: after a pause in reading.
            pub fn restart(&mut self) {
                self.state.give_up();
            }

            /// Resets the device, writes its registers, reads them back and starts.
            ///
            /// # Errors
            /// [`ConverterFault::Answer`] if this is no such chip, or one of another address;
            /// [`ConverterFault::Register`] if a register does not hold what was written (a list that names an
            /// input twice is written all the same, and never completes a cycle); whatever the bus gives.
            pub $($async)? fn configure(&mut self, configuration: &Configuration<N>) -> Result<(), Failure<S, P>> {
                self.state.scan = None;
                self.state.device = configuration.device;
                // A locked device must be opened before it obeys.
                self.write(Register::LOCK, [OPEN]) $($await)* ?;
                self.command(FastCommand::Reset) $($await)* ?;
                self.delay.delay_us(10) $($await)*;
                let registers = configuration.registers();
                self.write(Register::CONFIG0, registers) $($await)* ?;
                let mut rest = registers.as_slice();
                for address in Register::CONFIG0..=Register::GAINCAL {
                    let (expected, next) = rest.split_at_checked(Register::length(address)).unwrap_or_default();
                    rest = next;
                    let found = match expected.len() {
                        1 => self.read_register::<1>(address) $($await)* ?.1.map(u32::from)[0],
                        _ => {
                            let [high, middle, low] = self.read_register::<3>(address) $($await)* ?.1;
                            u32::from_be_bytes([0, high, middle, low])
                        }
                    };
                    let expected = expected.iter().fold(0, |word, byte| word << 8 | u32::from(*byte));
                    // The upper half of IRQ are flags.
                    let mask = if address == Register::IRQ { 0x0F } else { u32::MAX };
                    if found & mask != expected {
                        return Err(self.state.fault(ConverterFault::Register { address, expected, found }).into());
                    }
                }
                if configuration.lock {
                    self.write(Register::LOCK, [LOCKED]) $($await)* ?;
                }
                self.command(FastCommand::Start) $($await)* ?;
                self.state.scan = Some(Scan::new(configuration.inputs));
                Ok(())
            }

            /// Sends a fast command: standby and start, for one.
            ///
            /// # Errors
            /// Those of the bus.
            pub $($async)? fn command(&mut self, command: FastCommand) -> Result<(), Failure<S, P>> {
                let byte = Request::Fast(command).emit(self.state.device);
                self.bus.write(&[byte]) $($await)* .map_err(ConverterError::Bus)
            }

            /// Reads a register of `L` bytes (see [`Register`]), and the status.
            ///
            /// # Errors
            /// Those of the bus and of the checksum.
            pub $($async)? fn read_register<const L: usize>(&mut self, address: u8) -> Result<(Status, [u8; L]), Failure<S, P>> {
                let answer = self.ask(address) $($await)* .map_err(ConverterError::Bus)?;
                Ok(answer.map_err(|fault| self.state.fault(fault))?)
            }

            /// The same, with a fault that is not counted yet.
            #[allow(clippy::type_complexity, reason = "what the bus gives, and what the device")]
            $($async)? fn ask<const L: usize>(
                &mut self,
                address: u8,
            ) -> Result<Result<(Status, [u8; L]), ConverterFault>, S::Error> {
                let mut buffer = [0; LONGEST];
                let bytes = buffer.get_mut(..L + 3).unwrap_or_default();
                if let Some(first) = bytes.first_mut() {
                    *first = Request::Read { address }.emit(self.state.device);
                }
                self.bus.transfer_in_place(bytes) $($await)* ?;
                Ok(parse_answer(bytes, self.state.device))
            }

            /// Counts what went wrong with a reading, or the reset that is behind it: a device that was reset converts
            /// nothing, and its answers have no CRC, so that it seems late or damaged. It is asked.
            $($async)? fn failed(&mut self, fault: ConverterFault) -> ConverterFault {
                let mut cause = fault;
                if matches!(fault, ConverterFault::Timeout | ConverterFault::Checksum { .. }) {
                    let mut bytes = [Request::Read { address: Register::CONFIG3 }.emit(self.state.device), 0, 0, 0];
                    let answered = self.bus.transfer_in_place(&mut bytes) $($await)* .is_ok();
                    if answered && tells_reset(bytes, self.state.device) {
                        cause = ConverterFault::Reset;
                    }
                }
                self.state.fault(cause)
            }

            $($async)? fn write<const L: usize>(&mut self, address: u8, values: [u8; L]) -> Result<(), Failure<S, P>> {
                use embedded_hal::spi::Operation;
                let command = [Request::Write { address }.emit(self.state.device)];
                let mut operations = [Operation::Write(&command), Operation::Write(&values)];
                self.bus.transaction(&mut operations) $($await)* .map_err(ConverterError::Bus)
            }

            /// The next cycle through all inputs.
            ///
            /// # Errors
            /// See [`ConverterFault`]. After an error the next call begins with the next cycle; after
            /// [`ConverterFault::Reset`] the device must be configured.
            pub $($async)? fn read(&mut self) -> Result<Conversion<N>, Failure<S, P>> {
                self.state.ready_to_read()?;
                match self.cycle() $($await)* {
                    Err(ConverterError::Fault(fault)) => Err(self.failed(fault) $($await)* .into()),
                    conversion => conversion,
                }
            }

            /// The same, with a fault that is not counted yet.
            $($async)? fn cycle(&mut self) -> Result<Conversion<N>, Failure<S, P>> {
                let patience = self.state.patience;
                // Each input may take as long as is waited for one; two cycles go by while it learns.
                let mut looks = patience.looks();
                let mut conversions = 4 * N + 4;
                loop {
                    let ready = $wait(&mut self.ready, &mut self.delay, patience) $($await)* ;
                    if !ready.map_err(ConverterError::Pin)? {
                        return Err(ConverterFault::Timeout.into());
                    }
                    let answer = self.ask(Register::ADCDATA) $($await)* .map_err(ConverterError::Bus)?;
                    let (status, bytes) = answer?;
                    let (new, conversion) = self.state.accept(status, bytes)?;
                    if let Some(conversion) = conversion {
                        return Ok(conversion);
                    }
                    if new {
                        looks = patience.looks();
                        conversions -= 1;
                    } else {
                        looks -= 1;
                        self.delay.delay_us(patience.pause.max(1)) $($await)*;
                    }
                    if looks == 0 || conversions == 0 {
                        return Err(ConverterFault::Timeout.into());
                    }
                }
            }
        }

        parts!($name, $bus, $pin, $delay, N);
    };
}

face! {
    /// An MCP3564 that goes through `N` inputs, blocking or polled.
    ///
    /// ```
    /// use fingertip_drivers::converters::mcp3564::{
    ///     Channel, Configuration, Gain, Mcp3564, SimulatedMcp3564,
    /// };
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    ///
    /// // Two bridges, whose numbers are 8 and 9.
    /// let chip = SimulatedMcp3564::new(false, |_, channel| if channel == 8 { 1e-3 } else { -2e-3 });
    /// let bench = SimulatedBench::new(chip, WireFaults::default());
    /// let mut converter = Mcp3564::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
    /// let inputs = [Channel::PairA, Channel::PairB];
    /// converter.configure(&Configuration { gain: Gain::X64, ..Configuration::new(inputs) })?;
    /// assert_eq!(converter.read()?.counts, [536_871, -1_073_742]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    Mcp3564, embedded_hal::spi::SpiDevice, InputPin, embedded_hal::delay::DelayNs, ready_in_time, [], []
}

face! {
    /// An MCP3564 that goes through `N` inputs, in a task.
    ///
    /// ```
    /// use fingertip_drivers::converters::mcp3564::{
    ///     AsyncMcp3564, Channel, Configuration, SimulatedMcp3564,
    /// };
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    /// # use fingertip_test_support::block_on;
    ///
    /// let bench = SimulatedBench::new(SimulatedMcp3564::new(false, |_, _| 0.25), WireFaults::default());
    /// let mut converter = AsyncMcp3564::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
    /// block_on(converter.configure(&Configuration::new([Channel::PairA])))?;
    /// assert_eq!(block_on(converter.read())?.counts, [2_097_152]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    AsyncMcp3564, embedded_hal_async::spi::SpiDevice, embedded_hal_async::digital::Wait,
    embedded_hal_async::delay::DelayNs, ready_in_time_async, [async], [.await]
}

sources!(Mcp3564, AsyncMcp3564);

impl<T: Real, S, P, D, const N: usize> NbSource<T, SVector<T, N>> for Mcp3564<S, P, D, N>
where
    S: embedded_hal::spi::SpiDevice,
    P: InputPin,
    D: embedded_hal::delay::DelayNs,
{
    type Error = Failure<S, P>;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        self.state.ready_to_read().map_err(ConverterError::from)?;
        if !self.ready.is_low().map_err(ConverterError::Pin)? {
            return Err(nb::Error::WouldBlock);
        }
        let answer = self.ask(Register::ADCDATA).map_err(ConverterError::Bus)?;
        let accepted = answer.and_then(|(status, bytes)| self.state.accept(status, bytes));
        let (_, conversion) = accepted.map_err(|fault| ConverterError::from(self.failed(fault)))?;
        let value = conversion.ok_or(nb::Error::WouldBlock)?.signals().map_err(ConverterError::from)?;
        Ok(Some(Sample { time: None, value }))
    }
}
