//! The two faces.

use embedded_hal::digital::{ErrorType as PinErrorType, InputPin, OutputPin};
use embedded_hal::spi::ErrorType as BusErrorType;
use fingertip_wrench::Real;
use nalgebra::SVector;

use super::configuration::Configuration;
use super::state::Core;
use super::wire::{Answer, LONGEST, Request};
use crate::Sample;
use crate::converters::{
    Conversion, ConverterError, ConverterFault, Patience, parts, ready_in_time, ready_in_time_async, sources,
};
use crate::polled::NbSource;

type Failure<S, P> = ConverterError<<S as BusErrorType>::Error, <P as PinErrorType>::Error>;

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
            state: Core<N>,
        }

        impl<S: $bus, P: $pin, D: $delay, const N: usize> $name<S, P, D, N> {
            /// On a bus, with the pin DRDY (or [`Unwired`](crate::converters::Unwired)) and a delay. Nothing
            /// is sent yet.
            #[must_use]
            pub fn new(bus: S, ready: P, delay: D, patience: Patience) -> Self {
                Self { bus, ready, delay, state: Core::new(patience) }
            }

            /// Throws away what the device holds before the next conversion is given: after a pause in
            /// reading, when it would be old.
            pub const fn restart(&mut self) {
                self.state.restart();
            }

            /// Resets the device, writes all registers, reads them back and starts.
            ///
            /// # Errors
            /// [`ConverterFault::Answer`] if this is no such chip, [`ConverterFault::Register`] if a register
            /// does not hold what was written, and whatever the bus gives.
            pub $($async)? fn configure(&mut self, configuration: &Configuration<N>) -> Result<(), Failure<S, P>> {
                self.state.forget();
                // Whatever state it is in; these answers say nothing.
                for request in [Request::Unlock, Request::Reset] {
                    let mut buffer = [0; LONGEST];
                    let frame = buffer.get_mut(..Answer::<N>::LENGTH).unwrap_or_default();
                    request.emit(frame);
                    self.bus.transfer_in_place(frame) $($await)* .map_err(ConverterError::Bus)?;
                }
                // t_REGACQ is 5 µs.
                self.delay.delay_us(10) $($await)*;
                let answer = self.exchange(Request::Null) $($await)* ?;
                self.state.acknowledged(Request::Reset, answer.response)?;
                for (address, value) in configuration.registers() {
                    self.command(Request::Write { address, value }) $($await)* ?;
                }
                for (address, expected) in configuration.registers() {
                    let found = self.read_register(address) $($await)* ?;
                    if found != expected {
                        let (expected, found) = (u32::from(expected), u32::from(found));
                        return Err(self.state.fault(ConverterFault::Register { address, expected, found }).into());
                    }
                }
                if configuration.lock {
                    self.command(Request::Lock) $($await)* ?;
                }
                if configuration.watch_registers {
                    // Once through at the slowest clock of 0.3 MHz, twice over.
                    self.delay.delay_ms(8) $($await)*;
                }
                // Takes down the flags that writing has raised.
                self.exchange(Request::Null) $($await)* ?;
                self.state.configured(configuration);
                Ok(())
            }

            /// Reads a register (see [`Register`](super::Register)).
            ///
            /// # Errors
            /// Those of the bus and of the checksum.
            pub $($async)? fn read_register(&mut self, address: u8) -> Result<u16, Failure<S, P>> {
                self.exchange(Request::Read { address }) $($await)* ?;
                Ok(self.exchange(Request::Null) $($await)* ?.response)
            }

            /// Sends a command and waits for it to be acknowledged. A register that is written so, or a
            /// standby, is the caller's business: `configure` knows nothing of it. Conversions that come in
            /// these two frames are not given.
            ///
            /// # Errors
            /// [`ConverterFault::Answer`] if it is not acknowledged: damaged on the way, or locked.
            pub $($async)? fn command(&mut self, request: Request) -> Result<(), Failure<S, P>> {
                self.exchange(request) $($await)* ?;
                let answer = self.exchange(Request::Null) $($await)* ?;
                Ok(self.state.acknowledged(request, answer.response)?)
            }

            /// One frame there and back.
            $($async)? fn exchange(&mut self, request: Request) -> Result<Answer<N>, Failure<S, P>> {
                let mut buffer = [0; LONGEST];
                let frame = buffer.get_mut(..Answer::<N>::LENGTH).unwrap_or_default();
                request.emit(frame);
                self.bus.transfer_in_place(frame) $($await)* .map_err(ConverterError::Bus)?;
                Ok(Answer::parse(frame).map_err(|fault| self.state.fault(fault))?)
            }

            /// The next conversion of all channels.
            ///
            /// # Errors
            /// See [`ConverterFault`]. After an error the next call reads the next conversion, but after
            /// [`ConverterFault::Reset`] the device must be configured.
            pub $($async)? fn read(&mut self) -> Result<Conversion<N>, Failure<S, P>> {
                self.state.ready_to_read()?;
                let mut looks = self.state.patience.looks();
                loop {
                    let patience = self.state.patience;
                    if !self.state.drains()
                        && !$wait(&mut self.ready, &mut self.delay, patience) $($await)* .map_err(ConverterError::Pin)?
                    {
                        return Err(self.state.fault(ConverterFault::Timeout).into());
                    }
                    let drained = self.state.drains();
                    let answer = self.exchange(Request::Null) $($await)* ?;
                    if let Some(conversion) = self.state.accept(&answer)? {
                        return Ok(conversion);
                    }
                    if !drained {
                        // The pin says that there is something, and there is not.
                        looks -= 1;
                        if looks == 0 {
                            return Err(self.state.fault(ConverterFault::Timeout).into());
                        }
                        self.delay.delay_us(patience.pause.max(1)) $($await)*;
                    }
                }
            }

            /// Makes the converters begin anew, together with those of other chips on the same pin
            /// (Conversion Synchronization): SYNC/RESET low for half of the 2048 clocks that would be a
            /// reset. `clock` is that of the device \[Hz\].
            ///
            /// # Errors
            /// Those of the pin.
            pub $($async)? fn synchronise<R: OutputPin>(&mut self, pin: &mut R, clock: u32) -> Result<(), R::Error> {
                pin.set_low()?;
                self.delay.delay_ns(clocks(1024, clock)) $($await)*;
                pin.set_high()?;
                self.state.restart();
                Ok(())
            }

            /// Resets the device by its pin: SYNC/RESET low for 4096 clocks. Configure it after that.
            ///
            /// # Errors
            /// Those of the pin.
            pub $($async)? fn reset<R: OutputPin>(&mut self, pin: &mut R, clock: u32) -> Result<(), R::Error> {
                self.state.forget();
                pin.set_low()?;
                self.delay.delay_ns(clocks(4096, clock)) $($await)*;
                pin.set_high()?;
                self.delay.delay_us(10) $($await)*;
                Ok(())
            }
        }

        parts!($name, $bus, $pin, $delay, N);
    };
}

/// How long some clocks last \[ns\].
fn clocks(count: u32, clock: u32) -> u32 {
    let nanoseconds = u64::from(count) * 1_000_000_000 / u64::from(clock.max(1));
    u32::try_from(nanoseconds).unwrap_or(u32::MAX)
}

face! {
    /// An ADS131M with `N` channels, blocking or polled.
    ///
    /// ```
    /// use fingertip_drivers::converters::ads131m::{Ads131m, Configuration, Gain, SimulatedAds131m};
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    ///
    /// // Four bridges, in volts.
    /// let chip = SimulatedAds131m::new(|_| [0.001, -0.002, 0.003, 0.0]);
    /// let bench = SimulatedBench::new(chip, WireFaults::default());
    /// let mut converter = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
    /// converter.configure(&Configuration::<4>::default().gain(Gain::X32))?;
    /// assert_eq!(converter.read()?.counts, [223_696, -447_392, 671_089, 0]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    Ads131m, embedded_hal::spi::SpiDevice, InputPin, embedded_hal::delay::DelayNs, ready_in_time, [], []
}

face! {
    /// An ADS131M with `N` channels, in a task. A call that is dropped while it waits for the pin loses
    /// nothing; one that is dropped while it is on the bus loses that conversion.
    ///
    /// ```
    /// use fingertip_drivers::converters::ads131m::{AsyncAds131m, Configuration, Gain, SimulatedAds131m};
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    /// # use fingertip_test_support::block_on;
    ///
    /// let bench = SimulatedBench::new(SimulatedAds131m::new(|_| [0.001, -0.002]), WireFaults::default());
    /// let mut converter = AsyncAds131m::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
    /// block_on(converter.configure(&Configuration::<2>::default().gain(Gain::X32)))?;
    /// assert_eq!(block_on(converter.read())?.counts, [223_696, -447_392]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    AsyncAds131m, embedded_hal_async::spi::SpiDevice, embedded_hal_async::digital::Wait,
    embedded_hal_async::delay::DelayNs, ready_in_time_async, [async], [.await]
}

impl<S, P, D, const N: usize> Ads131m<S, P, D, N>
where
    S: embedded_hal::spi::SpiDevice,
    P: InputPin,
    D: embedded_hal::delay::DelayNs,
{
    /// The next conversion if it is there.
    ///
    /// # Errors
    /// `WouldBlock` if it is not; otherwise as `read`.
    pub fn poll(&mut self) -> nb::Result<Conversion<N>, Failure<S, P>> {
        self.state.ready_to_read().map_err(ConverterError::from)?;
        loop {
            let drains = self.state.drains();
            if !drains && !self.ready.is_low().map_err(ConverterError::Pin)? {
                return Err(nb::Error::WouldBlock);
            }
            let answer = self.exchange(Request::Null)?;
            match self.state.accept(&answer).map_err(ConverterError::from)? {
                Some(conversion) => return Ok(conversion),
                None if drains => {}
                None => return Err(nb::Error::WouldBlock),
            }
        }
    }
}

sources!(Ads131m, AsyncAds131m);

impl<T: Real, S, P, D, const N: usize> NbSource<T, SVector<T, N>> for Ads131m<S, P, D, N>
where
    S: embedded_hal::spi::SpiDevice,
    P: InputPin,
    D: embedded_hal::delay::DelayNs,
{
    type Error = Failure<S, P>;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        let value = self.poll()?.signals().map_err(ConverterError::from)?;
        Ok(Some(Sample { time: None, value }))
    }
}
