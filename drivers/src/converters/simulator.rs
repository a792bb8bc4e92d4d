//! A bench with a simulated converter on it: bus, pin and time, with faults.

mod delay;
mod line;

use alloc::sync::Arc;
use core::convert::Infallible;
use std::sync::{Mutex, MutexGuard, PoisonError};

use embedded_hal::spi::{self, Operation, SpiDevice};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub use self::delay::SimulatedDelay;
pub use self::line::SimulatedLine;

/// A line that is held at a level, whatever drives it.
///
/// ```
/// use fingertip_drivers::converters::mcp3564::{Channel, Configuration, Mcp3564, SimulatedMcp3564};
/// use fingertip_drivers::converters::{Level, Patience, SimulatedBench, WireFaults};
///
/// // The data line is shorted to ground.
/// let shorted = WireFaults { stuck_data: Some(Level::Low), ..WireFaults::default() };
/// let bench = SimulatedBench::new(SimulatedMcp3564::new(false, |_, _| 0.25), shorted);
/// let mut converter = Mcp3564::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
/// let refused = converter.configure(&Configuration::new([Channel::PairA])).unwrap_err();
/// assert!(refused.to_string().ends_with("is it this chip, wired and powered?"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// At ground.
    Low,
    /// At the supply.
    High,
}

/// What the wiring does: probabilities between 0 and 1.
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Ads131m, Configuration, SimulatedAds131m};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
///
/// // One "ready" in five does not come: conversions are missed, and those that come are right.
/// let faults = WireFaults { lost_ready: 0.2, seed: 3, ..WireFaults::default() };
/// let bench = SimulatedBench::new(SimulatedAds131m::new(|_| [0.15; 2]), faults);
/// let mut converter = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::<2>::default())?;
/// for _ in 0..100 {
///     assert_eq!(converter.read()?.counts, [1_048_576; 2]);
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WireFaults {
    /// One bit of what the device sends in a transaction is flipped.
    pub answer_flip: f64,
    /// One bit of what is sent to the device in a transaction is flipped.
    pub request_flip: f64,
    /// The "ready" of a conversion does not come: the pin stays high until the next one.
    pub lost_ready: f64,
    /// The device's data line is stuck.
    pub stuck_data: Option<Level>,
    /// The "ready" line is stuck.
    pub stuck_ready: Option<Level>,
    /// Seed of the chance.
    pub seed: u64,
}

/// A device that can be put on a [`SimulatedBench`]. One that is on SPI, with a "ready" line, says the rest, too.
///
/// A device of one's own, a shift register that gives back each byte one later:
///
/// ```
/// use embedded_hal::spi::SpiDevice;
/// use fingertip_drivers::converters::{SimulatedBench, SimulatedDevice, WireFaults};
///
/// struct Echo(u8);
///
/// impl SimulatedDevice for Echo {
///     fn advance(&mut self, _: u64) {}
///
///     fn shift(&mut self, byte: u8) -> u8 {
///         core::mem::replace(&mut self.0, byte)
///     }
/// }
///
/// let bench = SimulatedBench::new(Echo(0), WireFaults::default());
/// let mut bytes = [1, 2, 3];
/// bench.spi().transfer_in_place(&mut bytes)?;
/// assert_eq!(bytes, [0, 1, 2]);
/// # Ok::<(), core::convert::Infallible>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` simulates no converter",
    note = "a simulated device answers bytes with bytes and lets time pass: it implements `SimulatedDevice`"
)]
pub trait SimulatedDevice {
    /// Time goes on by so much \[ns\].
    fn advance(&mut self, nanoseconds: u64);

    /// A transaction on SPI begins.
    fn select(&mut self) {}
    /// A byte comes on SPI, and one goes at the same time; a line that nobody drives is high.
    fn shift(&mut self, _: u8) -> u8 {
        0xFF
    }
    /// The transaction ends.
    fn deselect(&mut self) {}
    /// Whether the device drives its "ready" line low.
    fn is_ready(&self) -> bool {
        false
    }
    /// How many conversions are done.
    fn conversions(&self) -> u64 {
        0
    }
}

#[derive(Debug)]
pub(crate) struct Inner<D> {
    pub(crate) device: D,
    pub(crate) faults: WireFaults,
    random: Pcg64Mcg,
    /// Time so far \[ns\].
    now: u64,
    /// The conversion for which it was drawn whether its "ready" comes.
    drawn: u64,
    silenced: bool,
    flips: u64,
}

impl<D: SimulatedDevice> Inner<D> {
    pub(crate) fn advance(&mut self, nanoseconds: u64) {
        self.now += nanoseconds;
        self.device.advance(nanoseconds);
    }

    /// Which bit of a transaction of so many bytes is flipped, if any.
    pub(crate) fn draw(&mut self, probability: f64, bytes: usize) -> Option<usize> {
        let hit = probability > 0.0 && bytes > 0 && self.random.random::<f64>() < probability;
        self.flips += u64::from(hit);
        hit.then(|| self.random.random_range(0..bytes * 8))
    }

    fn is_low(&mut self) -> bool {
        if let Some(level) = self.faults.stuck_ready {
            return level == Level::Low;
        }
        let conversion = self.device.conversions();
        if conversion != self.drawn {
            self.drawn = conversion;
            self.silenced =
                self.faults.lost_ready > 0.0 && self.random.random::<f64>() < self.faults.lost_ready;
        }
        self.device.is_ready() && !self.silenced
    }

    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) {
        let bytes = operations.iter().map(|operation| match operation {
            Operation::Read(read) => read.len(),
            Operation::Write(write) => write.len(),
            Operation::Transfer(read, write) => read.len().max(write.len()),
            Operation::TransferInPlace(both) => both.len(),
            Operation::DelayNs(_) => 0,
        });
        let bytes = bytes.sum();
        let (request_flip, answer_flip) =
            (self.draw(self.faults.request_flip, bytes), self.draw(self.faults.answer_flip, bytes));
        let mut at = 0;
        self.device.select();
        for operation in operations {
            match operation {
                Operation::Read(read) => {
                    for place in read.iter_mut() {
                        *place = self.byte(0, &mut at, request_flip, answer_flip);
                    }
                }
                Operation::Write(write) => {
                    for byte in *write {
                        self.byte(*byte, &mut at, request_flip, answer_flip);
                    }
                }
                Operation::Transfer(read, write) => {
                    for index in 0..read.len().max(write.len()) {
                        let sent = write.get(index).copied().unwrap_or(0);
                        let got = self.byte(sent, &mut at, request_flip, answer_flip);
                        if let Some(place) = read.get_mut(index) {
                            *place = got;
                        }
                    }
                }
                Operation::TransferInPlace(both) => {
                    for place in both.iter_mut() {
                        *place = self.byte(*place, &mut at, request_flip, answer_flip);
                    }
                }
                Operation::DelayNs(pause) => self.advance(u64::from(*pause)),
            }
        }
        self.device.deselect();
    }

    fn byte(
        &mut self,
        sent: u8,
        at: &mut usize,
        request_flip: Option<usize>,
        answer_flip: Option<usize>,
    ) -> u8 {
        let flip = |flip: Option<usize>| flip.filter(|bit| bit / 8 == *at).map_or(0, |bit| 1 << (bit % 8));
        let got = self.device.shift(sent ^ flip(request_flip)) ^ flip(answer_flip);
        *at += 1;
        // A clock of 10 MHz.
        self.advance(800);
        match self.faults.stuck_data {
            None => got,
            Some(Level::Low) => 0,
            Some(Level::High) => 0xFF,
        }
    }
}

/// A converter with its bus, its pin and its time. Its parts are handles on the same bench: give them to
/// a driver and keep one to set the input and to look.
///
/// ```
/// use fingertip_drivers::converters::nau7802::{Configuration, Nau7802, SimulatedNau7802};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
///
/// // The load changes after a second of the bench's time.
/// let chip = SimulatedNau7802::new(|time, _| if time < 1.0 { 0.0 } else { 1e-3 });
/// let bench = SimulatedBench::new(chip, WireFaults::default());
/// let mut converter = Nau7802::new(bench.i2c(), bench.data_ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::default())?;
/// assert_eq!(converter.read()?.counts, [0]);
/// bench.advance(1_000_000_000);
/// assert_eq!(converter.read()?.counts, [2_147_484]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct SimulatedBench<D> {
    inner: Arc<Mutex<Inner<D>>>,
}

impl<D> Clone for SimulatedBench<D> {
    fn clone(&self) -> Self {
        Self { inner: Arc::clone(&self.inner) }
    }
}

impl<D: SimulatedDevice> SimulatedBench<D> {
    /// Puts a device on a bench.
    #[must_use]
    pub fn new(device: D, faults: WireFaults) -> Self {
        let random = Pcg64Mcg::seed_from_u64(faults.seed);
        let inner = Inner { device, faults, random, now: 0, drawn: 0, silenced: false, flips: 0 };
        Self { inner: Arc::new(Mutex::new(inner)) }
    }

    pub(crate) fn lock(&self) -> MutexGuard<'_, Inner<D>> {
        // A panic of the caller's with the device in hand leaves it as it was then.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A delay: waiting makes the bench's time go on.
    #[must_use]
    pub fn delay(&self) -> SimulatedDelay<D> {
        SimulatedDelay(self.clone())
    }

    /// Changes what the wiring does.
    pub fn set_faults(&self, faults: WireFaults) {
        self.lock().faults = faults;
    }

    /// Lets time go on \[ns\].
    pub fn advance(&self, nanoseconds: u64) {
        self.lock().advance(nanoseconds);
    }

    /// The bench's time \[ns\].
    #[must_use]
    pub fn now(&self) -> u64 {
        self.lock().now
    }

    /// How many bits were flipped.
    #[must_use]
    pub fn flips(&self) -> u64 {
        self.lock().flips
    }

    /// Looks at the device or changes it.
    pub fn with<R>(&self, look: impl FnOnce(&mut D) -> R) -> R {
        look(&mut self.lock().device)
    }

    /// The SPI device.
    #[must_use]
    pub fn spi(&self) -> SimulatedSpi<D> {
        SimulatedSpi(self.clone())
    }

    /// The "ready" pin.
    #[must_use]
    pub fn ready(&self) -> SimulatedLine<D> {
        SimulatedLine::new(self.clone(), |bench, _| !bench.is_low(), 0)
    }
}

/// The SPI of a [`SimulatedBench`], blocking and for tasks.
///
/// ```
/// use embedded_hal::spi::Operation;
/// use embedded_hal::spi::SpiDevice;
/// use fingertip_drivers::converters::ads1256::{Command, Register, SimulatedAds1256};
/// use fingertip_drivers::converters::{SimulatedBench, WireFaults};
///
/// let bench = SimulatedBench::new(SimulatedAds1256::new(|_, _, _| 0.0), WireFaults::default());
/// // Read DRATE, with a pause (t6) before the answer: 30 000 Hz after a reset.
/// let (request, mut rate) = ([Command::ReadRegisters { address: Register::DRATE }.emit(), 0], [0]);
/// let mut operations = [Operation::Write(&request), Operation::DelayNs(7000), Operation::Read(&mut rate)];
/// bench.spi().transaction(&mut operations)?;
/// assert_eq!(rate, [0xF0]);
/// # Ok::<(), core::convert::Infallible>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedSpi<D>(SimulatedBench<D>);

impl<D> spi::ErrorType for SimulatedSpi<D> {
    type Error = Infallible;
}

impl<D: SimulatedDevice> SpiDevice for SimulatedSpi<D> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        self.0.lock().transaction(operations);
        Ok(())
    }
}

impl<D: SimulatedDevice> embedded_hal_async::spi::SpiDevice for SimulatedSpi<D> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        self.0.lock().transaction(operations);
        Ok(())
    }
}
