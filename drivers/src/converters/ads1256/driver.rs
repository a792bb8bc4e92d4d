//! The two faces.

use embedded_hal::digital::{ErrorType as PinErrorType, InputPin};
use embedded_hal::spi::{ErrorType as BusErrorType, Operation};
use fingertip_wrench::Real;
use nalgebra::SVector;

use super::wire::{Calibration, Command, Configuration, Input, Register};
use crate::Sample;
use crate::converters::{
    Conversion, ConverterError, ConverterFault, ConverterStatistics, Patience, Reading, parts, ready_in_time,
    ready_in_time_async, sources,
};
use crate::polled::NbSource;

type Failure<S, P> = ConverterError<<S as BusErrorType>::Error, <P as PinErrorType>::Error>;

/// Clocks from a command to the first bit that it reads (t6).
const T6: u32 = 50;
/// Clocks after a command (t11).
const T11: u32 = 4;
/// Clocks after SYNC (t11).
const T11_SYNC: u32 = 24;
/// `STATUS`: bit order, automatic calibration and buffer.
const SETTINGS: u8 = 0b1110;

/// What both faces know.
#[derive(Clone, Copy, Debug)]
struct State<const N: usize> {
    patience: Patience,
    configuration: Option<Configuration<N>>,
    counts: [i32; N],
    /// The input that is being converted.
    at: usize,
    /// A conversion of this cycle was not the same when it was read again.
    damaged: Option<ConverterFault>,
    /// A conversion is being taken. Still set at the next call if the one before was dropped while it was on the
    /// bus, and nobody knows how far it came.
    taking: bool,
    statistics: ConverterStatistics,
}

impl<const N: usize> State<N> {
    fn fault(&mut self, fault: ConverterFault) -> ConverterFault {
        self.statistics.note(&fault);
        if fault == ConverterFault::Reset {
            self.configuration = None;
        }
        fault
    }

    fn configuration(&self) -> Result<Configuration<N>, ConverterFault> {
        self.configuration.ok_or(ConverterFault::NotConfigured)
    }

    fn input(&self, configuration: &Configuration<N>) -> Input {
        configuration.inputs.get(self.at).copied().unwrap_or(Input::FIRST)
    }

    /// Whether the first four registers say that there is a conversion, of the input that is due.
    fn is_ready(&mut self, [status, mux, adcon, drate]: [u8; 4]) -> Result<bool, ConverterFault> {
        let configuration = self.configuration()?;
        let [settings, _, expected_adcon, expected_drate] = configuration.registers();
        let same = status & SETTINGS == settings && adcon == expected_adcon && drate == expected_drate;
        if !same || mux != self.input(&configuration).emit() {
            return Err(self.fault(ConverterFault::Reset));
        }
        let ready = status & 1 == 0;
        self.statistics.stale += u64::from(!ready);
        Ok(ready)
    }

    /// The input after this one.
    const fn after(&self) -> usize {
        if self.at + 1 < N { self.at + 1 } else { 0 }
    }

    /// Takes the conversion of the input that was due, read twice: the sample, if it completes a cycle.
    fn accept(&mut self, bytes: [u8; 3], again: [u8; 3]) -> Result<Option<Conversion<N>>, ConverterFault> {
        self.taking = false;
        if bytes != again {
            let word = |[high, middle, low]: [u8; 3]| u32::from_be_bytes([0, high, middle, low]);
            self.damaged = Some(ConverterFault::Answer { expected: word(bytes), found: word(again) });
        }
        if let Some(place) = self.counts.get_mut(self.at) {
            *place = Reading::parse(bytes).counts;
        }
        self.at = self.after();
        if self.at != 0 {
            return Ok(None);
        }
        if let Some(fault) = self.damaged.take() {
            return Err(self.fault(fault));
        }
        let conversion = Conversion::clipped(self.counts, -(1 << 23), (1 << 23) - 1);
        self.statistics.converted(&conversion);
        Ok(Some(conversion))
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
            /// On a bus, with the pin DRDY (or [`Unwired`](crate::converters::Unwired)) and a delay. Nothing
            /// is sent yet.
            #[must_use]
            pub fn new(bus: S, ready: P, delay: D, patience: Patience) -> Self {
                let statistics = ConverterStatistics::default();
                let state = State { patience, configuration: None, counts: [0; N], at: 0, damaged: None, taking: false, statistics };
                Self { bus, ready, delay, state }
            }

            /// Resets the device, writes its registers, reads them back, lets it calibrate itself and starts.
            ///
            /// # Errors
            /// [`ConverterFault::Register`] if a register does not hold what was written (another chip, or a
            /// line that is stuck), [`ConverterFault::Timeout`], and whatever the bus gives.
            pub $($async)? fn configure(&mut self, configuration: &Configuration<N>) -> Result<(), Failure<S, P>> {
                self.state.configuration = None;
                self.send(configuration, &[Command::StopContinuous.emit()]) $($await)* ?;
                self.send(configuration, &[Command::Reset.emit()]) $($await)* ?;
                self.until_ready(configuration) $($await)* ?;
                let [status, mux, adcon, drate] = configuration.registers();
                let write = Command::WriteRegisters { address: Register::STATUS }.emit();
                self.send(configuration, &[write, 3, status, mux, adcon, drate]) $($await)* ?;
                let found = self.read_registers::<4>(configuration, Register::STATUS) $($await)* ?;
                for ((address, expected), found) in (Register::STATUS..).zip([status, mux, adcon, drate]).zip(found) {
                    let found = if address == Register::STATUS { found & SETTINGS } else { found };
                    if found != expected {
                        let (expected, found) = (u32::from(expected), u32::from(found));
                        return Err(self.state.fault(ConverterFault::Register { address, expected, found }).into());
                    }
                }
                self.state.configuration = Some(*configuration);
                self.calibrate(Calibration::Own) $($await)*
            }

            /// Lets the device calibrate itself, with the input that is next; conversions begin anew with the
            /// first one.
            ///
            /// # Errors
            /// [`ConverterFault::Timeout`] if it does not end.
            pub $($async)? fn calibrate(&mut self, calibration: Calibration) -> Result<(), Failure<S, P>> {
                let configuration = self.state.configuration()?;
                self.send(&configuration, &[calibration.command().emit()]) $($await)* ?;
                self.until_ready(&configuration) $($await)* ?;
                self.restart() $($await)*
            }

            /// Begins a cycle anew: after a pause in reading, when what is there is old.
            ///
            /// # Errors
            /// Those of the bus.
            pub $($async)? fn restart(&mut self) -> Result<(), Failure<S, P>> {
                let configuration = self.state.configuration()?;
                (self.state.at, self.state.damaged, self.state.taking) = (0, None, false);
                let write = Command::WriteRegisters { address: Register::MUX }.emit();
                let mux = self.state.input(&configuration).emit();
                self.send(&configuration, &[write, 0, mux]) $($await)* ?;
                self.send(&configuration, &[Command::Sync.emit()]) $($await)* ?;
                self.delay.delay_ns(configuration.clocks(T11_SYNC)) $($await)*;
                self.send(&configuration, &[Command::Wakeup.emit()]) $($await)*
            }

            /// The next cycle through all inputs.
            ///
            /// # Errors
            /// See [`ConverterFault`]. After [`ConverterFault::Reset`] the device must be configured; after
            /// another error the cycle goes on where it was.
            pub $($async)? fn read(&mut self) -> Result<Conversion<N>, Failure<S, P>> {
                self.state.configuration()?;
                let patience = self.state.patience;
                let mut looks = patience.looks();
                loop {
                    let ready = $wait(&mut self.ready, &mut self.delay, patience) $($await)* ;
                    if !ready.map_err(ConverterError::Pin)? {
                        return Err(self.state.fault(ConverterFault::Timeout).into());
                    }
                    match self.step() $($await)* ? {
                        Some(Some(conversion)) => return Ok(conversion),
                        Some(None) => looks = patience.looks(),
                        None => {
                            looks -= 1;
                            if looks == 0 {
                                return Err(self.state.fault(ConverterFault::Timeout).into());
                            }
                            self.delay.delay_us(patience.pause.max(1)) $($await)*;
                        }
                    }
                }
            }

            /// Takes one conversion and begins the next: `None` if there is none, otherwise the sample if it
            /// completes one.
            #[allow(clippy::type_complexity, reason = "two steps of not yet")]
            $($async)? fn step(&mut self) -> Result<Option<Option<Conversion<N>>>, Failure<S, P>> {
                let configuration = self.state.configuration()?;
                if self.state.taking {
                    self.restart() $($await)* ?;
                    return Ok(None);
                }
                let registers = self.read_registers(&configuration, Register::STATUS) $($await)* ?;
                if !self.state.is_ready(registers)? {
                    return Ok(None);
                }
                let (mut bytes, mut again) = ([0; 3], [0; 3]);
                let (t6, t11, sync) =
                    (configuration.clocks(T6), configuration.clocks(T11), configuration.clocks(T11_SYNC));
                let read = [Command::ReadData.emit()];
                self.state.taking = true;
                let result = if N > 1 {
                    let next = configuration.inputs.get(self.state.after()).copied().unwrap_or(Input::FIRST);
                    let write = [Command::WriteRegisters { address: Register::MUX }.emit(), 0, next.emit()];
                    let (begin, end) = ([Command::Sync.emit()], [Command::Wakeup.emit()]);
                    let mut operations = [
                        Operation::Write(&write),
                        Operation::DelayNs(t11),
                        Operation::Write(&begin),
                        Operation::DelayNs(sync),
                        Operation::Write(&end),
                        Operation::DelayNs(t11),
                        Operation::Write(&read),
                        Operation::DelayNs(t6),
                        Operation::Read(&mut bytes),
                        Operation::DelayNs(t11),
                        Operation::Write(&read),
                        Operation::DelayNs(t6),
                        Operation::Read(&mut again),
                        Operation::DelayNs(t11),
                    ];
                    self.bus.transaction(&mut operations) $($await)*
                } else {
                    let mut operations = [
                        Operation::Write(&read),
                        Operation::DelayNs(t6),
                        Operation::Read(&mut bytes),
                        Operation::DelayNs(t11),
                        Operation::Write(&read),
                        Operation::DelayNs(t6),
                        Operation::Read(&mut again),
                        Operation::DelayNs(t11),
                    ];
                    self.bus.transaction(&mut operations) $($await)*
                };
                result.map_err(ConverterError::Bus)?;
                Ok(Some(self.state.accept(bytes, again)?))
            }

            /// Reads registers from an address on (see [`Register`]).
            $($async)? fn read_registers<const K: usize>(
                &mut self,
                configuration: &Configuration<N>,
                address: u8,
            ) -> Result<[u8; K], Failure<S, P>> {
                let mut bytes = [0; K];
                #[allow(clippy::cast_possible_truncation, reason = "at most eleven registers")]
                let command = [Command::ReadRegisters { address }.emit(), K.saturating_sub(1) as u8];
                let mut operations = [
                    Operation::Write(&command),
                    Operation::DelayNs(configuration.clocks(T6)),
                    Operation::Read(&mut bytes),
                    Operation::DelayNs(configuration.clocks(T11)),
                ];
                self.bus.transaction(&mut operations) $($await)* .map_err(ConverterError::Bus)?;
                Ok(bytes)
            }

            $($async)? fn send(&mut self, configuration: &Configuration<N>, bytes: &[u8]) -> Result<(), Failure<S, P>> {
                let mut operations = [Operation::Write(bytes), Operation::DelayNs(configuration.clocks(T11))];
                self.bus.transaction(&mut operations) $($await)* .map_err(ConverterError::Bus)
            }

            /// Waits for the end of a reset or a calibration, with the device left alone meanwhile as the data
            /// sheet demands if the pin is wired.
            $($async)? fn until_ready(&mut self, configuration: &Configuration<N>) -> Result<(), Failure<S, P>> {
                let patience = self.state.patience;
                for _ in 0..patience.looks() {
                    self.delay.delay_us(patience.pause.max(1)) $($await)*;
                    let ready = $wait(&mut self.ready, &mut self.delay, patience) $($await)* ;
                    if !ready.map_err(ConverterError::Pin)? {
                        break;
                    }
                    let [status] = self.read_registers(configuration, Register::STATUS) $($await)* ?;
                    if status & 1 == 0 {
                        return Ok(());
                    }
                }
                Err(self.state.fault(ConverterFault::Timeout).into())
            }
        }

        parts!($name, $bus, $pin, $delay, N);
    };
}

face! {
    /// An ADS1255 or ADS1256 that goes through `N` inputs, blocking or polled.
    ///
    /// ```
    /// use fingertip_drivers::converters::ads1256::{Ads1256, Configuration, Input, SimulatedAds1256};
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    ///
    /// // Two bridges, at pins 0 and 1, and 2 and 3.
    /// let chip = SimulatedAds1256::new(|_, positive, _| if positive == 0 { 0.01 } else { -0.02 });
    /// let bench = SimulatedBench::new(chip, WireFaults::default());
    /// let mut converter = Ads1256::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
    /// converter.configure(&Configuration::new([Input::FIRST, Input::SECOND]))?;
    /// // At gain 64 full scale is a 32nd of the reference.
    /// assert_eq!(converter.read()?.counts, [2_684_354, -5_368_708]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    Ads1256, embedded_hal::spi::SpiDevice, InputPin, embedded_hal::delay::DelayNs, ready_in_time, [], []
}

face! {
    /// An ADS1255 or ADS1256 that goes through `N` inputs, in a task. After a call that was dropped while it was
    /// on the bus, or an error of the bus, the cycle begins anew.
    ///
    /// ```
    /// use fingertip_drivers::converters::ads1256::{AsyncAds1256, Configuration, Input, SimulatedAds1256};
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    /// # use fingertip_test_support::block_on;
    ///
    /// let bench = SimulatedBench::new(SimulatedAds1256::new(|_, _, _| 0.01), WireFaults::default());
    /// let mut converter = AsyncAds1256::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
    /// block_on(converter.configure(&Configuration::new([Input::FIRST])))?;
    /// assert_eq!(block_on(converter.read())?.counts, [2_684_354]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    AsyncAds1256, embedded_hal_async::spi::SpiDevice, embedded_hal_async::digital::Wait,
    embedded_hal_async::delay::DelayNs, ready_in_time_async, [async], [.await]
}

sources!(Ads1256, AsyncAds1256);

impl<T: Real, S, P, D, const N: usize> NbSource<T, SVector<T, N>> for Ads1256<S, P, D, N>
where
    S: embedded_hal::spi::SpiDevice,
    P: InputPin,
    D: embedded_hal::delay::DelayNs,
{
    type Error = Failure<S, P>;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        self.state.configuration().map_err(ConverterError::from)?;
        if !self.ready.is_low().map_err(ConverterError::Pin)? {
            return Err(nb::Error::WouldBlock);
        }
        let conversion = self.step()?.flatten().ok_or(nb::Error::WouldBlock)?;
        let value = conversion.signals().map_err(ConverterError::from)?;
        Ok(Some(Sample { time: None, value }))
    }
}
