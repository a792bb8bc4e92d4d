//! A sensor on a CAN bus.

use core::marker::PhantomData;

use embedded_can::{Frame, Id, blocking};
use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::can::{CanAssembler, CanStatistics};
use super::decoder::RobotousFault;
use super::wire::Request;
use crate::polled::NbSource;
use crate::{Sample, Source, SourceError, SourceErrorKind};

/// Why there is no sample.
///
/// ```
/// use embedded_can::StandardId;
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::robotous::{
///     CanAssembler, CanSensor, CanSensorError, Request, Silent, SimulatedCan,
/// };
///
/// let [first, second, request] = [1, 2, 0x64].map(|number| StandardId::new(number).unwrap());
/// let mut bus = SimulatedCan::new(first, second, request, |_| [0; 6]);
/// bus.overload = 0b100;
/// let assembler = CanAssembler::new(AxisCounts::uniform(50.0, 2000.0)?, first, second);
/// let mut sensor = CanSensor::<_, f64>::new(bus, assembler, request);
/// // It was not asked to send.
/// let silent = CanSensorError::Bus(Silent);
/// assert!(silent.to_string().starts_with("the CAN bus failed: "));
/// assert_eq!(sensor.next_sample(), Err(silent));
/// sensor.request(Request::Single)?;
/// let told = sensor.next_sample().unwrap_err().to_string();
/// assert_eq!(told, "the sensor is overloaded (overload byte 0x04)");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CanSensorError<E: embedded_can::Error> {
    /// The bus failed: the kind is in words, and what the bus itself says is in its `Debug` form, since it need not have another.
    #[error("the CAN bus failed: {kind} ({error:?})", kind = .0.kind(), error = .0)]
    Bus(E),
    /// The sensor says that its reading is none.
    #[error(transparent)]
    Sensor(#[from] RobotousFault),
    /// A request does not fit into a frame of this bus.
    #[error("a request of eight bytes does not fit into a frame")]
    Frame,
}

impl<E: embedded_can::Error> SourceError for CanSensorError<E> {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Bus(_) => SourceErrorKind::Transport,
            Self::Sensor(fault) => fault.kind(),
            Self::Frame => SourceErrorKind::Unsupported,
        }
    }
}

/// A sensor on a bus that implements `embedded_can::blocking::Can` or `embedded_can::nb::Can`: a peripheral of a
/// microcontroller, or the socket of the crate `socketcan` on Linux. Samples have no time: the sensor sends none.
///
/// ```
/// # #[cfg(feature = "simulators")] {
/// use embedded_can::StandardId;
/// use fingertip_drivers::sensors::robotous::{CanAssembler, CanSensor, Request, SimulatedCan};
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::AxisCounts;
///
/// let [first, second, request] = [1, 2, 0x64].map(|number| StandardId::new(number).unwrap());
/// // In place of the bus: a sensor that feels 1 N along x, at 50 counts a newton.
/// let bus = SimulatedCan::new(first, second, request, |_| [50, 0, 0, 0, 0, 0]);
/// let counts = AxisCounts::uniform(50.0, 2000.0)?;
/// let mut sensor = CanSensor::new(bus, CanAssembler::new(counts, first, second), request);
/// sensor.request(Request::Stream)?;
/// let sample = sensor.next_sample()?.unwrap();
/// let force: f64 = sample.value.force().x;
/// assert_eq!(force, 1.0);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct CanSensor<C, T> {
    bus: C,
    assembler: CanAssembler,
    requests: Id,
    scalar: PhantomData<T>,
}

impl<C, T> CanSensor<C, T> {
    /// On a bus; `requests` is the identifier under which the sensor takes requests. Nothing is sent yet.
    #[must_use]
    pub fn new(bus: C, assembler: CanAssembler, requests: impl Into<Id>) -> Self {
        Self { bus, assembler, requests: requests.into(), scalar: PhantomData }
    }

    /// What came so far. A reading of which both frames were lost leaves no trace.
    #[must_use]
    pub const fn statistics(&self) -> &CanStatistics {
        self.assembler.statistics()
    }

    /// The bus.
    pub const fn bus_mut(&mut self) -> &mut C {
        &mut self.bus
    }

    /// Gives the bus back.
    #[must_use]
    pub fn release(self) -> C {
        self.bus
    }
}

impl<C: blocking::Can, T> CanSensor<C, T> {
    /// Sends a request. Its answer, if it is a reading, is the next sample.
    ///
    /// # Errors
    /// [`CanSensorError::Bus`].
    pub fn request(&mut self, request: Request) -> Result<(), CanSensorError<C::Error>> {
        let frame = C::Frame::new(self.requests, &request.emit()).ok_or(CanSensorError::Frame)?;
        self.bus.transmit(&frame).map_err(CanSensorError::Bus)
    }
}

/// Waits as long as the bus does.
impl<C: blocking::Can, T: Real> Source<T, Wrench<T>> for CanSensor<C, T> {
    type Error = CanSensorError<C::Error>;

    fn next_sample(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        loop {
            let frame = self.bus.receive().map_err(CanSensorError::Bus)?;
            if let Some(wrench) = self.assembler.push_wrench(&frame) {
                return Ok(Some(Sample { time: None, value: wrench? }));
            }
        }
    }
}

/// For a bus that can both wait and be asked. Takes all frames that are there, up to the next reading.
impl<C, T: Real> NbSource<T, Wrench<T>> for CanSensor<C, T>
where
    C: blocking::Can + embedded_can::nb::Can<Error = <C as blocking::Can>::Error>,
{
    type Error = CanSensorError<<C as blocking::Can>::Error>;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        loop {
            let frame =
                embedded_can::nb::Can::receive(&mut self.bus).map_err(|e| e.map(CanSensorError::Bus))?;
            if let Some(wrench) = self.assembler.push_wrench(&frame) {
                let value = wrench.map_err(CanSensorError::Sensor)?;
                return Ok(Some(Sample { time: None, value }));
            }
        }
    }
}

#[cfg(feature = "simulators")]
#[cfg(test)]
mod tests {
    use super::super::SimulatedCan;
    use super::*;
    use crate::sensors::AxisCounts;
    use embedded_can::StandardId;

    fn sensor(
        loss: f64,
        load: impl FnMut(u64) -> [i16; 6],
    ) -> CanSensor<SimulatedCan<impl FnMut(u64) -> [i16; 6]>, f64> {
        let [first, second, request] = [1, 2, 0x64].map(|number| StandardId::new(number).unwrap());
        let bus = SimulatedCan::new(first, second, request, load).losing(loss, 5);
        let counts = AxisCounts::uniform(50.0, 2000.0).unwrap();
        CanSensor::new(bus, CanAssembler::new(counts, first, second), request)
    }

    #[test]
    fn it_streams_when_asked_and_sets_its_zero_only_on_request() {
        let mut sensor = sensor(0.0, |number| [50 * (number as i16 + 1), 0, 0, 0, 0, 2000]);
        assert_eq!(sensor.poll_sample().unwrap_err(), nb::Error::WouldBlock);
        assert!(matches!(sensor.next_sample(), Err(CanSensorError::Bus(_))), "nothing would ever come");
        sensor.request(Request::Single).unwrap();
        assert_eq!(sensor.next_sample().unwrap().unwrap().value.force().x, 1.0);
        assert_eq!(sensor.poll_sample().unwrap_err(), nb::Error::WouldBlock);
        sensor.request(Request::Stream).unwrap();
        for number in 2..20 {
            let value = sensor.poll_sample().unwrap().unwrap().value;
            assert_eq!((value.force().x, value.torque().z), (f64::from(number), 1.0));
        }
        sensor.request(Request::Bias { set: true }).unwrap();
        let value = sensor.next_sample().unwrap().unwrap().value;
        assert_eq!((value.force().x, value.torque().z), (1.0, 0.0));
        sensor.request(Request::Stop).unwrap();
        assert_eq!(sensor.poll_sample().unwrap_err(), nb::Error::WouldBlock);
        assert_eq!((sensor.statistics().readings, sensor.statistics().halves), (20, 0));
    }

    #[test]
    fn an_overload_is_a_fault_of_its_kind_and_lost_frames_are_counted() {
        let mut sensor = sensor(0.01, |number| [number as i16, 0, 0, 0, 0, number as i16]);
        sensor.bus_mut().overload = 4;
        sensor.request(Request::Stream).unwrap();
        assert_eq!(sensor.next_sample().unwrap_err().kind(), SourceErrorKind::Overload);
        sensor.bus_mut().overload = 0;
        for _ in 0..5000 {
            sensor.next_sample().unwrap();
        }
        let (statistics, lost) = (*sensor.statistics(), sensor.bus_mut().lost());
        // Each frame that is lost leaves its other half, unless both are or the halves of two readings join.
        assert!(statistics.halves > 50 && statistics.halves <= lost, "{statistics:?} {lost}");
        assert_eq!((lost - statistics.halves) % 2, 0);
    }
}
