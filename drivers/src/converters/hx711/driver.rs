//! The two faces.

use embedded_hal::digital::{ErrorType as PinErrorType, InputPin, OutputPin};
use fingertip_wrench::Real;
use nalgebra::SVector;

use super::wire::{Mode, Shift};
use crate::converters::{
    Conversion, ConverterError, ConverterFault, ConverterStatistics, Patience, ready_in_time,
    ready_in_time_async,
};
use crate::polled::NbSource;
use crate::{AsyncSource, Sample, Source};

type Failure<C, P> = ConverterError<<C as PinErrorType>::Error, <P as PinErrorType>::Error>;

/// Conversions until the output has settled.
const SETTLING: u8 = 4;
/// Half a pulse \[ns\]: 0.2 µs at least, 1 µs typical.
const HALF: u32 = 1000;

/// What both faces know.
#[derive(Clone, Copy, Debug)]
struct State {
    patience: Patience,
    mode: Mode,
    started: bool,
    /// Conversions that are still to be thrown away.
    unsettled: u8,
    statistics: ConverterStatistics,
}

impl State {
    const fn fault(&mut self, fault: ConverterFault) -> ConverterFault {
        self.statistics.note(&fault);
        fault
    }

    /// Takes a reading: `None` while the output settles.
    fn accept<const N: usize>(
        &mut self,
        reading: Result<Conversion<N>, ConverterFault>,
    ) -> Result<Option<Conversion<N>>, ConverterFault> {
        let conversion = reading.map_err(|fault| self.fault(fault))?;
        if self.unsettled > 0 {
            self.unsettled -= 1;
            return Ok(None);
        }
        self.statistics.converted(&conversion);
        Ok(Some(conversion))
    }

    /// After a reset the chips are at A128, and one reading sets another mode.
    fn after_reset(&mut self) {
        self.started = true;
        self.unsettled = SETTLING + u8::from(self.mode != Mode::A128);
    }

    fn set_mode(&mut self, mode: Mode) {
        if self.mode != mode {
            self.mode = mode;
            self.unsettled = SETTLING + 1;
        }
    }

    fn ready_to_read(&self) -> Result<(), ConverterFault> {
        if self.started { Ok(()) } else { Err(ConverterFault::NotConfigured) }
    }
}

/// Makes the pulses and takes the bits.
fn clock_out<C: OutputPin, P: InputPin, const N: usize>(
    clock: &mut C,
    data: &mut [P; N],
    pause: &mut impl embedded_hal::delay::DelayNs,
    pulses: u8,
) -> Result<Result<Conversion<N>, ConverterFault>, Failure<C, P>> {
    let mut shift = Shift::new();
    for _ in 0..pulses {
        clock.set_high().map_err(ConverterError::Bus)?;
        pause.delay_ns(HALF);
        let levels = levels(data);
        // Low in any case: a clock that stays high switches the chips off.
        clock.set_low().map_err(ConverterError::Bus)?;
        shift.push(levels.map_err(ConverterError::Pin)?);
        pause.delay_ns(HALF);
    }
    Ok(shift.finish(levels(data).map_err(ConverterError::Pin)?))
}

fn levels<P: InputPin, const N: usize>(data: &mut [P; N]) -> Result<[bool; N], P::Error> {
    let mut levels = [false; N];
    for (level, pin) in levels.iter_mut().zip(data) {
        *level = pin.is_high()?;
    }
    Ok(levels)
}

macro_rules! face {
    (
        $(#[$documentation:meta])*
        $name:ident <$($generic:ident),*>, $pin:path, [$($pause:tt)*], {$($bound:tt)*}, $wait:ident, $waiting:ident,
        {$($field:ident: $type:ident, $field_documentation:literal),*}, [$($async:tt)?], [$($await:tt)*]
    ) => {
        $(#[$documentation])*
        #[derive(Debug)]
        pub struct $name<$($generic),*, const N: usize> {
            clock: C,
            data: [P; N],
            $($field: $type,)*
            state: State,
        }

        impl<$($generic),*, const N: usize> $name<$($generic),*, N>
        where
            C: OutputPin, P: InputPin + $pin, $($bound)*
        {
            /// With the clock line, the data lines and delays. Nothing is done yet.
            #[must_use]
            pub fn new(clock: C, data: [P; N], $($field: $type,)* mode: Mode, patience: Patience) -> Self {
                let statistics = ConverterStatistics::default();
                let state = State { patience, mode, started: false, unsettled: 0, statistics };
                Self { clock, data, $($field,)* state }
            }

            /// The pins and delays.
            #[must_use]
            pub fn release(self) -> (C, [P; N], ($($type,)*)) {
                (self.clock, self.data, ($(self.$field,)*))
            }

            /// How it has behaved so far.
            #[must_use]
            pub const fn statistics(&self) -> &ConverterStatistics {
                &self.state.statistics
            }

            /// Resets the chips: clock high for 100 µs and low again. Conversions begin when they have
            /// settled.
            ///
            /// # Errors
            /// Those of the clock pin.
            pub $($async)? fn start(&mut self) -> Result<(), Failure<C, P>> {
                self.power_down() $($await)* ?;
                self.clock.set_low().map_err(ConverterError::Bus)?;
                self.state.after_reset();
                Ok(())
            }

            /// Switches the chips off, and the excitation with them if their regulator feeds it;
            /// `start` switches them on.
            ///
            /// # Errors
            /// Those of the clock pin.
            pub $($async)? fn power_down(&mut self) -> Result<(), Failure<C, P>> {
                self.state.started = false;
                // From low to high, wherever it was.
                self.clock.set_low().map_err(ConverterError::Bus)?;
                self.$waiting.delay_us(1) $($await)*;
                self.clock.set_high().map_err(ConverterError::Bus)?;
                self.$waiting.delay_us(100) $($await)*;
                Ok(())
            }

            /// Input and gain from now on. What is converted until then, and until the output has settled, is
            /// thrown away.
            pub fn set_mode(&mut self, mode: Mode) {
                self.state.set_mode(mode);
            }

            /// The next conversion of all chips. Their clocks differ, and so the moments of their conversions,
            /// by up to a period.
            ///
            /// # Errors
            /// See [`ConverterFault`](crate::converters::ConverterFault).
            pub $($async)? fn read(&mut self) -> Result<Conversion<N>, Failure<C, P>> {
                self.state.ready_to_read()?;
                let mut looks = self.state.patience.looks();
                loop {
                    let patience = self.state.patience;
                    for pin in &mut self.data {
                        let ready = $wait(pin, &mut self.$waiting, patience) $($await)* ;
                        if !ready.map_err(ConverterError::Pin)? {
                            return Err(self.state.fault(ConverterFault::Timeout).into());
                        }
                    }
                    if let Some(conversion) = self.poll_once()? {
                        return Ok(conversion);
                    }
                    looks -= 1;
                    if looks == 0 {
                        return Err(self.state.fault(ConverterFault::Timeout).into());
                    }
                    self.$waiting.delay_us(patience.pause.max(1)) $($await)*;
                }
            }

            /// A reading if all chips are ready; `None` if not, or if it was thrown away.
            fn poll_once(&mut self) -> Result<Option<Conversion<N>>, Failure<C, P>> {
                if levels(&mut self.data).map_err(ConverterError::Pin)?.iter().any(|high| *high) {
                    return Ok(None);
                }
                let pulses = self.state.mode.pulses();
                let reading = clock_out(&mut self.clock, &mut self.data, &mut self.$($pause)*, pulses)?;
                Ok(self.state.accept(reading)?)
            }
        }

    };
}

face! {
    /// `N` chips on one clock line, blocking or polled.
    ///
    /// ```
    /// use fingertip_drivers::converters::hx711::{Hx711, Mode, SimulatedHx711s};
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    ///
    /// // Two bridges, with 1 mV/V and −2 mV/V.
    /// let chips = SimulatedHx711s::new(|_| [(1e-3, 0.0), (-2e-3, 0.0)]);
    /// let bench = SimulatedBench::new(chips, WireFaults::default());
    /// let (clock, data, delay) = (bench.clock(), bench.data(), bench.delay());
    /// let mut chips = Hx711::new(clock, data, delay, Mode::A128, Patience::default());
    /// chips.start()?;
    /// assert_eq!(chips.read()?.counts, [2_147_484, -4_294_967]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    Hx711<C, P, D>, InputPin, [delay], { D: embedded_hal::delay::DelayNs }, ready_in_time, delay,
    { delay: D, "Delay." }, [], []
}

face! {
    /// `N` chips on one clock line, in a task. `pulses` makes the pulses and blocks for some 60 µs; `delay`
    /// is for the waits between.
    ///
    /// ```
    /// use fingertip_drivers::converters::hx711::{AsyncHx711, Mode, SimulatedHx711s};
    /// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
    /// # use fingertip_test_support::block_on;
    ///
    /// let bench = SimulatedBench::new(SimulatedHx711s::new(|_| [(1e-3, 0.0)]), WireFaults::default());
    /// let (clock, data, delay, pulses) = (bench.clock(), bench.data(), bench.delay(), bench.delay());
    /// let mut chip = AsyncHx711::new(clock, data, delay, pulses, Mode::A128, Patience::default());
    /// block_on(chip.start())?;
    /// assert_eq!(block_on(chip.read())?.counts, [2_147_484]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    AsyncHx711<C, P, D, B>, embedded_hal_async::digital::Wait, [pulses],
    { D: embedded_hal_async::delay::DelayNs, B: embedded_hal::delay::DelayNs }, ready_in_time_async, delay,
    { delay: D, "For waits.", pulses: B, "For pulses." }, [async], [.await]
}

impl<T: Real, C: OutputPin, P: InputPin, D: embedded_hal::delay::DelayNs, const N: usize>
    Source<T, SVector<T, N>> for Hx711<C, P, D, N>
{
    type Error = Failure<C, P>;

    fn next_sample(&mut self) -> Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        let value = self.read()?.signals()?;
        Ok(Some(Sample { time: None, value }))
    }
}

impl<T: Real, C: OutputPin, P: InputPin, D: embedded_hal::delay::DelayNs, const N: usize>
    NbSource<T, SVector<T, N>> for Hx711<C, P, D, N>
{
    type Error = Failure<C, P>;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        self.state.ready_to_read().map_err(ConverterError::from)?;
        let conversion = self.poll_once()?.ok_or(nb::Error::WouldBlock)?;
        let value = conversion.signals().map_err(ConverterError::from)?;
        Ok(Some(Sample { time: None, value }))
    }
}

impl<T, C, P, D, B, const N: usize> AsyncSource<T, SVector<T, N>> for AsyncHx711<C, P, D, B, N>
where
    T: Real,
    C: OutputPin,
    P: InputPin + embedded_hal_async::digital::Wait,
    D: embedded_hal_async::delay::DelayNs,
    B: embedded_hal::delay::DelayNs,
{
    type Error = Failure<C, P>;

    async fn next_sample(&mut self) -> Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        let value = self.read().await?.signals()?;
        Ok(Some(Sample { time: None, value }))
    }
}
