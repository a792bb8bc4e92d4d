//! Chips that are not there.

use alloc::boxed::Box;
use core::convert::Infallible;
use core::fmt;

use embedded_hal::digital::{self, OutputPin};

use super::wire::Mode;
use crate::converters::{Inner, Level, SimulatedBench, SimulatedDevice, SimulatedLine};

#[derive(Clone, Copy, Debug)]
struct Chip {
    /// Nanoseconds from one conversion to the next.
    period: u64,
    next: u64,
    /// Conversions that it still makes before it says that one is there.
    settling: u8,
    mode: Mode,
    /// The word that is there, if one is.
    word: Option<u32>,
    /// Pulses of the reading that is under way.
    pulses: u8,
    shifting: u32,
    output: bool,
}

/// `N` HX711 on one clock line, to be put on a [`SimulatedBench`]. Each has an oscillator of its own, quicker
/// by 1 % from chip to chip. They switch off and reset themselves if the clock is high for 60 µs, change
/// input and gain by the number of pulses, and settle.
///
/// The data lines are off, so that no chip is ready:
///
/// ```
/// use fingertip_drivers::converters::hx711::{Hx711, Mode, SimulatedHx711s};
/// use fingertip_drivers::converters::{Level, Patience, SimulatedBench, WireFaults};
///
/// let faults = WireFaults { stuck_data: Some(Level::High), ..WireFaults::default() };
/// let bench = SimulatedBench::new(SimulatedHx711s::new(|_| [(1e-3, 0.0), (1e-3, 0.0)]), faults);
/// let (clock, data, delay) = (bench.clock(), bench.data(), bench.delay());
/// let mut chips = Hx711::new(clock, data, delay, Mode::A128, Patience::default());
/// chips.start()?;
/// assert_eq!((chips.read().is_err(), chips.statistics().timeouts), (true, 1));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub struct SimulatedHx711s<const N: usize> {
    /// Output of the bridges over AVDD at the inputs A and B, at a time \[s\].
    input: Box<dyn FnMut(f64) -> [(f64, f64); N] + Send>,
    chips: [Chip; N],
    clock: bool,
    high_since: u64,
    now: u64,
    resets: u64,
    conversions: u64,
}

impl<const N: usize> fmt::Debug for SimulatedHx711s<N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("SimulatedHx711s").field("chips", &self.chips).finish_non_exhaustive()
    }
}

impl<const N: usize> SimulatedHx711s<N> {
    /// Chips at 80 Hz, with outputs over AVDD at inputs A and B as a function of time \[s\].
    pub fn new(input: impl FnMut(f64) -> [(f64, f64); N] + Send + 'static) -> Self {
        let chips = core::array::from_fn(|index| Chip {
            period: 12_500_000 - 125_000 * u64::try_from(index).unwrap_or(0).min(50),
            next: 0,
            settling: 0,
            mode: Mode::A128,
            word: None,
            pulses: 0,
            shifting: 0,
            output: true,
        });
        let mut simulated = Self {
            input: Box::new(input),
            chips,
            clock: false,
            high_since: 0,
            now: 0,
            resets: 0,
            conversions: 0,
        };
        simulated.reset();
        simulated
    }

    /// How often the chips were reset, the first time included.
    #[must_use]
    pub const fn resets(&self) -> u64 {
        self.resets
    }

    /// How many conversions the first chip has made.
    #[must_use]
    pub const fn conversions(&self) -> u64 {
        self.conversions
    }

    fn reset(&mut self) {
        self.resets += 1;
        for chip in &mut self.chips {
            *chip = Chip {
                next: self.now + chip.period,
                settling: 3,
                mode: Mode::A128,
                word: None,
                pulses: 0,
                output: true,
                ..*chip
            };
        }
    }

    fn is_off(&self) -> bool {
        self.clock && self.now - self.high_since > 60_000
    }

    fn set_clock(&mut self, high: bool, flips: impl FnMut() -> Option<usize>) {
        if self.clock && !high && self.is_off() {
            self.clock = false;
            self.reset();
            return;
        }
        let rises = high && !self.clock;
        self.clock = high;
        if rises {
            self.high_since = self.now;
            self.pulse(flips);
        }
    }

    fn pulse(&mut self, mut flips: impl FnMut() -> Option<usize>) {
        for chip in &mut self.chips {
            if chip.pulses == 0 {
                // The first pulse takes the word, if there is one.
                let Some(word) = chip.word.take() else { continue };
                chip.shifting = word ^ flips().map_or(0, |bit| 1 << (bit % 24));
            }
            chip.pulses = chip.pulses.saturating_add(1);
            chip.output = chip.pulses > Mode::BITS || chip.shifting >> (Mode::BITS - chip.pulses) & 1 == 1;
        }
    }

    fn convert(&mut self) {
        let now = self.now;
        // What a chip does with a conversion that ends while it is read is not in the data sheet: here it
        // keeps it back until the clock has been still for 20 µs.
        let busy = now - self.high_since < 20_000;
        for index in 0..N {
            while let Some(chip) =
                self.chips.get_mut(index).filter(|chip| chip.next <= now && !(busy && chip.pulses > 0))
            {
                #[allow(clippy::cast_precision_loss, reason = "a time")]
                let time = chip.next as f64 * 1e-9;
                chip.next += chip.period;
                // The pulses of the last reading say what this conversion is of.
                if chip.pulses > 0 {
                    let mode = Mode::of_pulses(chip.pulses).unwrap_or_default();
                    if mode != chip.mode {
                        chip.mode = mode;
                        chip.settling = 3;
                    }
                    chip.pulses = 0;
                }
                if chip.settling > 0 {
                    chip.settling -= 1;
                    continue;
                }
                let mode = chip.mode;
                self.conversions += u64::from(index == 0);
                let (a, b) = (self.input)(time).get(index).copied().unwrap_or_default();
                let ratio = if mode == Mode::B32 { b } else { a };
                #[allow(clippy::cast_possible_truncation, reason = "clipped as the chip does")]
                let code =
                    (ratio / mode.full_scale() * 8_388_608.0).round().clamp(-8_388_608.0, 8_388_607.0) as i32;
                if let Some(chip) = self.chips.get_mut(index) {
                    chip.word = Some(code.cast_unsigned() & 0xFF_FFFF);
                    chip.output = false;
                }
            }
        }
    }
}

impl<const N: usize> SimulatedDevice for SimulatedHx711s<N> {
    fn advance(&mut self, nanoseconds: u64) {
        self.now += nanoseconds;
        if !self.is_off() {
            self.convert();
        }
    }
}

impl<const N: usize> SimulatedBench<SimulatedHx711s<N>> {
    /// The clock line.
    #[must_use]
    pub fn clock(&self) -> SimulatedClock<N> {
        SimulatedClock(self.clone())
    }

    /// The data lines.
    #[must_use]
    pub fn data(&self) -> [SimulatedLine<SimulatedHx711s<N>>; N] {
        let is_high = |bench: &mut Inner<SimulatedHx711s<N>>, chip: usize| match bench.faults.stuck_data {
            Some(level) => level == Level::High,
            None => bench.device.is_off() || bench.device.chips.get(chip).is_none_or(|chip| chip.output),
        };
        core::array::from_fn(|chip| SimulatedLine::new(self.clone(), is_high, chip))
    }
}

/// The clock line of simulated chips.
///
/// ```
/// use embedded_hal::digital::OutputPin;
/// use fingertip_drivers::converters::hx711::SimulatedHx711s;
/// use fingertip_drivers::converters::{SimulatedBench, WireFaults};
///
/// let bench = SimulatedBench::new(SimulatedHx711s::new(|_| [(1e-3, 0.0)]), WireFaults::default());
/// let before = bench.with(|chips| chips.resets());
/// // High for 60 µs switches the chips off; low again resets them.
/// let mut clock = bench.clock();
/// clock.set_high()?;
/// bench.advance(70_000);
/// clock.set_low()?;
/// assert_eq!(bench.with(|chips| chips.resets()), before + 1);
/// # Ok::<(), core::convert::Infallible>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedClock<const N: usize>(SimulatedBench<SimulatedHx711s<N>>);

impl<const N: usize> SimulatedClock<N> {
    fn set(&self, high: bool) {
        let bench = &mut *self.0.lock();
        let probability = bench.faults.answer_flip;
        let mut flips = [None; N];
        if high {
            for flip in &mut flips {
                *flip = bench.draw(probability / 25.0, 3);
            }
        }
        let mut drawn = flips.into_iter();
        bench.device.set_clock(high, || drawn.next().flatten());
    }
}

impl<const N: usize> digital::ErrorType for SimulatedClock<N> {
    type Error = Infallible;
}

impl<const N: usize> OutputPin for SimulatedClock<N> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.set(true);
        Ok(())
    }
}
