//! A sensor on a CAN bus that are not there.

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use embedded_can::{ErrorKind, Frame, Id, blocking};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::wire::{Reading, Request};

/// A frame on the simulated bus.
///
/// ```
/// use embedded_can::{Frame, StandardId};
/// use fingertip_drivers::sensors::robotous::SimulatedFrame;
///
/// let id = StandardId::new(0x64).unwrap();
/// let frame = SimulatedFrame::new(id, &[1, 2, 3]).unwrap();
/// assert_eq!((frame.dlc(), frame.data(), frame.is_extended()), (3, &[1, 2, 3][..], false));
/// assert_eq!(SimulatedFrame::new(id, &[0; 9]), None);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SimulatedFrame {
    id: Id,
    data: Vec<u8>,
}

impl Frame for SimulatedFrame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        (data.len() <= 8).then(|| Self { id: id.into(), data: data.to_vec() })
    }

    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }

    fn is_extended(&self) -> bool {
        matches!(self.id, Id::Extended(_))
    }

    fn is_remote_frame(&self) -> bool {
        false
    }

    fn id(&self) -> Id {
        self.id
    }

    fn dlc(&self) -> usize {
        self.data.len()
    }

    fn data(&self) -> &[u8] {
        &self.data
    }
}

/// Nothing is under way on the bus and nothing will be: a blocking receive would never return.
///
/// ```
/// use embedded_can::{StandardId, blocking::Can};
/// use fingertip_drivers::sensors::robotous::{Silent, SimulatedCan};
///
/// let [first, second, request] = [1, 2, 0x64].map(|number| StandardId::new(number).unwrap());
/// let mut bus = SimulatedCan::new(first, second, request, |_| [0; 6]);
/// assert_eq!(bus.receive(), Err(Silent));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Silent;

impl embedded_can::Error for Silent {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

/// The bus, with a sensor on it that samples as often as it is listened to. `load` gives the counts of each sample
/// by its number.
///
/// A receiver that drops one frame in four:
///
/// ```
/// use embedded_can::StandardId;
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::robotous::{CanAssembler, CanSensor, Request, SimulatedCan};
///
/// let [first, second, request] = [1, 2, 0x64].map(|number| StandardId::new(number).unwrap());
/// let bus = SimulatedCan::new(first, second, request, |number| [number as i16; 6]).losing(0.25, 1);
/// let assembler = CanAssembler::new(AxisCounts::uniform(50.0, 2000.0)?, first, second);
/// let mut sensor = CanSensor::<_, f64>::new(bus, assembler, request);
/// sensor.request(Request::Stream)?;
/// for _ in 0..100 {
///     sensor.next_sample()?;
/// }
/// assert!(sensor.statistics().halves > 0);
/// assert!(sensor.bus_mut().lost() >= sensor.statistics().halves);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct SimulatedCan<L> {
    ids: [Id; 3],
    load: L,
    number: u64,
    streaming: bool,
    counts: [i16; 6],
    bias: [i16; 6],
    /// The overload byte of readings from now on.
    pub overload: u8,
    out: VecDeque<SimulatedFrame>,
    loss: f64,
    lost: u64,
    random: Pcg64Mcg,
}

impl<L: FnMut(u64) -> [i16; 6]> SimulatedCan<L> {
    /// A sensor at rest that sends its two frames, and takes requests, under these identifiers.
    pub fn new(first: impl Into<Id>, second: impl Into<Id>, requests: impl Into<Id>, load: L) -> Self {
        Self {
            ids: [first.into(), second.into(), requests.into()],
            load,
            number: 0,
            streaming: false,
            counts: [0; 6],
            bias: [0; 6],
            overload: 0,
            out: VecDeque::new(),
            loss: 0.0,
            lost: 0,
            random: Pcg64Mcg::seed_from_u64(0),
        }
    }

    /// Lets the receiver drop frames, each with a probability.
    #[must_use]
    pub fn losing(mut self, loss: f64, seed: u64) -> Self {
        (self.loss, self.random) = (loss, Pcg64Mcg::seed_from_u64(seed));
        self
    }

    /// How many frames were dropped.
    #[must_use]
    pub const fn lost(&self) -> u64 {
        self.lost
    }

    fn sample(&mut self) {
        self.counts = (self.load)(self.number);
        self.number += 1;
        let mut counts = self.counts;
        for (count, bias) in counts.iter_mut().zip(self.bias) {
            *count = count.saturating_sub(bias);
        }
        let reading = Reading { streamed: self.streaming, counts, overload: self.overload };
        for (id, half) in self.ids.into_iter().zip(reading.emit().as_chunks::<8>().0) {
            if self.random.random::<f64>() < self.loss {
                self.lost += 1;
            } else {
                self.out.extend(SimulatedFrame::new(id, half));
            }
        }
    }

    fn hear(&mut self, frame: &SimulatedFrame) {
        let [_, _, requests] = self.ids;
        let bytes = <&[u8; Request::LENGTH]>::try_from(frame.data()).ok().filter(|_| frame.id() == requests);
        match bytes.and_then(Request::parse) {
            Some(Request::Single) => self.sample(),
            Some(Request::Stream) => self.streaming = true,
            Some(Request::Stop) => self.streaming = false,
            Some(Request::Bias { set }) => self.bias = if set { self.counts } else { [0; 6] },
            None => {}
        }
    }

    fn next(&mut self) -> Option<SimulatedFrame> {
        while self.out.is_empty() && self.streaming {
            self.sample();
        }
        self.out.pop_front()
    }
}

impl<L: FnMut(u64) -> [i16; 6]> blocking::Can for SimulatedCan<L> {
    type Frame = SimulatedFrame;
    type Error = Silent;

    fn transmit(&mut self, frame: &SimulatedFrame) -> Result<(), Silent> {
        self.hear(frame);
        Ok(())
    }

    fn receive(&mut self) -> Result<SimulatedFrame, Silent> {
        self.next().ok_or(Silent)
    }
}

impl<L: FnMut(u64) -> [i16; 6]> embedded_can::nb::Can for SimulatedCan<L> {
    type Frame = SimulatedFrame;
    type Error = Silent;

    fn transmit(&mut self, frame: &SimulatedFrame) -> nb::Result<Option<SimulatedFrame>, Silent> {
        self.hear(frame);
        Ok(None)
    }

    fn receive(&mut self) -> nb::Result<SimulatedFrame, Silent> {
        self.next().ok_or(nb::Error::WouldBlock)
    }
}
