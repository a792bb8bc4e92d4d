//! The two faces.

use embedded_hal::digital::{ErrorType as PinErrorType, InputPin};
use embedded_hal::i2c::ErrorType as BusErrorType;
use fingertip_wrench::Real;
use nalgebra::SVector;

use super::wire::{
    ADDRESS, CALIBRATE, CALIBRATION_ERROR, Calibration, Configuration, Control, Input, Register,
};
use crate::converters::{
    Conversion, ConverterError, ConverterFault, ConverterStatistics, Patience, Reading, parts, ready_in_time,
    ready_in_time_async,
};
use crate::polled::NbSource;
use crate::{AsyncSource, Sample, Source};

type Failure<B, P> = ConverterError<<B as BusErrorType>::Error, <P as PinErrorType>::Error>;

/// Conversions until the output has settled.
const SETTLING: u8 = 4;

/// What both faces know.
#[derive(Clone, Copy, Debug)]
struct State {
    patience: Patience,
    configuration: Option<Configuration>,
    unsettled: u8,
    statistics: ConverterStatistics,
}

impl State {
    fn fault(&mut self, fault: ConverterFault) -> ConverterFault {
        self.statistics.note(&fault);
        if fault == ConverterFault::Reset {
            self.configuration = None;
        }
        fault
    }

    fn configuration(&self) -> Result<Configuration, ConverterFault> {
        self.configuration.ok_or(ConverterFault::NotConfigured)
    }

    /// Whether `PU_CTRL` says that there is a new conversion.
    fn is_new(&mut self, control: u8) -> Result<bool, ConverterFault> {
        if control & !Control::READY != self.configuration()?.running() {
            return Err(self.fault(ConverterFault::Reset));
        }
        let new = control & Control::READY != 0;
        self.statistics.stale += u64::from(!new);
        Ok(new)
    }

    /// Takes a reading: `None` while the output settles.
    fn accept(&mut self, bytes: [u8; 3]) -> Option<Conversion<1>> {
        if self.unsettled > 0 {
            self.unsettled -= 1;
            return None;
        }
        let conversion = Reading::parse(bytes).conversion();
        self.statistics.converted(&conversion);
        Some(conversion)
    }
}

macro_rules! face {
    (
        $(#[$documentation:meta])*
        $name:ident, $bus:path, $pin:path, $delay:path, $wait:ident, [$($async:tt)?], [$($await:tt)*]
    ) => {
        $(#[$documentation])*
        #[derive(Debug)]
        pub struct $name<B, P, D> {
            bus: B,
            ready: P,
            delay: D,
            state: State,
        }

        impl<B: $bus, P: $pin, D: $delay> $name<B, P, D> {
            /// On a bus, with the pin DRDY (or [`Unwired`](crate::converters::Unwired)) and a delay. Nothing
            /// is sent yet.
            #[must_use]
            pub fn new(bus: B, ready: P, delay: D, patience: Patience) -> Self {
                let statistics = ConverterStatistics::default();
                Self { bus, ready, delay, state: State { patience, configuration: None, unsettled: 0, statistics } }
            }

            /// Resets the device, writes its registers, reads them back, starts it and lets it calibrate its
            /// own offset.
            ///
            /// # Errors
            /// [`ConverterFault::Answer`] if this is no such chip, [`ConverterFault::Register`] if a register
            /// does not hold what was written, [`ConverterFault::Calibration`], and whatever the bus gives.
            pub $($async)? fn configure(&mut self, configuration: &Configuration) -> Result<(), Failure<B, P>> {
                self.state.configuration = None;
                self.write(Register::PU_CTRL, Control::RESET) $($await)* ?;
                self.write(Register::PU_CTRL, Control::DIGITAL_ON) $($await)* ?;
                self.until(Register::PU_CTRL, Control::POWERED, Control::POWERED) $($await)* ?;
                let [revision] = self.read_registers(Register::REVISION) $($await)* ?;
                if revision & 0xF != 0xF {
                    return Err(self.state.fault(ConverterFault::Answer { expected: 0xF, found: u32::from(revision) }).into());
                }
                for (address, value) in configuration.registers() {
                    self.write(address, value) $($await)* ?;
                }
                let running = configuration.running();
                self.write(Register::PU_CTRL, running & !(Control::START | Control::POWERED)) $($await)* ?;
                if configuration.regulator.is_some() {
                    self.delay.delay_ms(250) $($await)*;
                }
                self.until(Register::PU_CTRL, Control::POWERED, Control::POWERED) $($await)* ?;
                self.write(Register::PU_CTRL, running & !Control::POWERED) $($await)* ?;
                for (address, expected) in configuration.registers() {
                    let [found] = self.read_registers(address) $($await)* ?;
                    if found != expected {
                        let (expected, found) = (u32::from(expected), u32::from(found));
                        return Err(self.state.fault(ConverterFault::Register { address, expected, found }).into());
                    }
                }
                self.state.configuration = Some(*configuration);
                self.calibrate(Calibration::Internal) $($await)*
            }

            /// Lets the device calibrate itself.
            ///
            /// # Errors
            /// [`ConverterFault::Calibration`] if it says that it could not, [`ConverterFault::Timeout`] if it
            /// does not end.
            pub $($async)? fn calibrate(&mut self, calibration: Calibration) -> Result<(), Failure<B, P>> {
                let control = self.state.configuration()?.control2();
                self.write(Register::CTRL2, control | CALIBRATE | calibration as u8) $($await)* ?;
                let control = self.until(Register::CTRL2, CALIBRATE, 0) $($await)* ?;
                if control & CALIBRATION_ERROR != 0 {
                    return Err(self.state.fault(ConverterFault::Calibration).into());
                }
                self.state.unsettled = SETTLING;
                Ok(())
            }

            /// Converts the other input from now on, after calibrating it.
            ///
            /// # Errors
            /// As [`calibrate`](Self::calibrate).
            pub $($async)? fn select(&mut self, input: Input) -> Result<(), Failure<B, P>> {
                let configuration = Configuration { input, ..self.state.configuration()? };
                self.state.configuration = Some(configuration);
                self.calibrate(Calibration::Internal) $($await)*
            }

            /// The next conversion.
            ///
            /// # Errors
            /// See [`ConverterFault`]. After [`ConverterFault::Reset`] the device must be configured.
            pub $($async)? fn read(&mut self) -> Result<Conversion<1>, Failure<B, P>> {
                self.state.configuration()?;
                let patience = self.state.patience;
                let mut looks = patience.looks();
                loop {
                    let ready = $wait(&mut self.ready, &mut self.delay, patience) $($await)* ;
                    if !ready.map_err(ConverterError::Pin)? {
                        return Err(self.state.fault(ConverterFault::Timeout).into());
                    }
                    if let Some(conversion) = self.take() $($await)* ? {
                        return Ok(conversion);
                    }
                    looks -= 1;
                    if looks == 0 {
                        return Err(self.state.fault(ConverterFault::Timeout).into());
                    }
                    self.delay.delay_us(patience.pause.max(1)) $($await)*;
                }
            }

            /// The conversion, if there is a new one and the output has settled.
            $($async)? fn take(&mut self) -> Result<Option<Conversion<1>>, Failure<B, P>> {
                let [control] = self.read_registers(Register::PU_CTRL) $($await)* ?;
                if !self.state.is_new(control)? {
                    return Ok(None);
                }
                let bytes = self.read_registers(Register::ADCO) $($await)* ?;
                Ok(self.state.accept(bytes))
            }

            /// Reads registers from an address on (see [`Register`]).
            ///
            /// # Errors
            /// Those of the bus.
            pub $($async)? fn read_registers<const K: usize>(&mut self, address: u8) -> Result<[u8; K], Failure<B, P>> {
                let mut bytes = [0; K];
                self.bus.write_read(ADDRESS, &[address], &mut bytes) $($await)* .map_err(ConverterError::Bus)?;
                Ok(bytes)
            }

            $($async)? fn write(&mut self, address: u8, value: u8) -> Result<(), Failure<B, P>> {
                self.bus.write(ADDRESS, &[address, value]) $($await)* .map_err(ConverterError::Bus)
            }

            /// Reads a register until some of its bits are as they shall be.
            $($async)? fn until(&mut self, address: u8, mask: u8, value: u8) -> Result<u8, Failure<B, P>> {
                let patience = self.state.patience;
                for _ in 0..patience.looks() {
                    let [found] = self.read_registers(address) $($await)* ?;
                    if found & mask == value {
                        return Ok(found);
                    }
                    self.delay.delay_us(patience.pause.max(1)) $($await)*;
                }
                Err(self.state.fault(ConverterFault::Timeout).into())
            }
        }

        parts!($name, $bus, $pin, $delay);
    };
}

face! {
    /// An NAU7802, blocking or polled.
    ///
    /// ```
    /// use fingertip_drivers::converters::nau7802::{Configuration, Nau7802, SimulatedNau7802};
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    ///
    /// // A bridge that gives 1 mV/V, at gain 128.
    /// let bench = SimulatedBench::new(SimulatedNau7802::new(|_, _| 1e-3), WireFaults::default());
    /// let mut converter = Nau7802::new(bench.i2c(), bench.data_ready(), bench.delay(), Patience::default());
    /// converter.configure(&Configuration::default())?;
    /// assert_eq!(converter.read()?.counts, [2_147_484]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    Nau7802, embedded_hal::i2c::I2c, InputPin, embedded_hal::delay::DelayNs, ready_in_time, [], []
}

face! {
    /// An NAU7802 in a task.
    ///
    /// ```
    /// use fingertip_drivers::converters::nau7802::{AsyncNau7802, Configuration, SimulatedNau7802};
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    /// # use fingertip_test_support::block_on;
    ///
    /// let bench = SimulatedBench::new(SimulatedNau7802::new(|_, _| 1e-3), WireFaults::default());
    /// let mut converter =
    ///     AsyncNau7802::new(bench.i2c(), bench.data_ready(), bench.delay(), Patience::default());
    /// block_on(converter.configure(&Configuration::default()))?;
    /// assert_eq!(block_on(converter.read())?.counts, [2_147_484]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    AsyncNau7802, embedded_hal_async::i2c::I2c, embedded_hal_async::digital::Wait,
    embedded_hal_async::delay::DelayNs, ready_in_time_async, [async], [.await]
}

impl<T: Real, B, P, D> Source<T, SVector<T, 1>> for Nau7802<B, P, D>
where
    B: embedded_hal::i2c::I2c,
    P: InputPin,
    D: embedded_hal::delay::DelayNs,
{
    type Error = Failure<B, P>;

    fn next_sample(&mut self) -> Result<Option<Sample<T, SVector<T, 1>>>, Self::Error> {
        let value = self.read()?.signals()?;
        Ok(Some(Sample { time: None, value }))
    }
}

impl<T: Real, B, P, D> NbSource<T, SVector<T, 1>> for Nau7802<B, P, D>
where
    B: embedded_hal::i2c::I2c,
    P: InputPin,
    D: embedded_hal::delay::DelayNs,
{
    type Error = Failure<B, P>;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, SVector<T, 1>>>, Self::Error> {
        self.state.configuration().map_err(ConverterError::from)?;
        if !self.ready.is_low().map_err(ConverterError::Pin)? {
            return Err(nb::Error::WouldBlock);
        }
        let conversion = self.take()?.ok_or(nb::Error::WouldBlock)?;
        let value = conversion.signals().map_err(ConverterError::from)?;
        Ok(Some(Sample { time: None, value }))
    }
}

impl<T: Real, B, P, D> AsyncSource<T, SVector<T, 1>> for AsyncNau7802<B, P, D>
where
    B: embedded_hal_async::i2c::I2c,
    P: embedded_hal_async::digital::Wait,
    D: embedded_hal_async::delay::DelayNs,
{
    type Error = Failure<B, P>;

    async fn next_sample(&mut self) -> Result<Option<Sample<T, SVector<T, 1>>>, Self::Error> {
        let value = self.read().await?.signals()?;
        Ok(Some(Sample { time: None, value }))
    }
}
