//! What to do when a link is lost: stop for good, or connect anew.

use core::fmt::Debug;

use thiserror::Error;

use crate::{Sample, Source, SourceError, SourceErrorKind};

/// What to do when a link is lost. There is no default: whether a hand goes on after a gap is for its maker to
/// say.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::middleware::{OnLoss, Supervised, SupervisedError};
/// use fingertip_drivers::sensors::bota_serial::{BotaDecoder, Frame};
/// use fingertip_drivers::sensors::line::LineSensor;
/// use std::io::{self, Read};
///
/// /// A port that gives one frame and is lost then.
/// fn port() -> impl Read {
///     struct Gone;
///     impl Read for Gone {
///         fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
///             Err(io::ErrorKind::TimedOut.into())
///         }
///     }
///     io::Cursor::new(Frame::default().emit()).chain(Gone)
/// }
///
/// let connect = |_| Ok(LineSensor::<_, f64, _>::new(port(), BotaDecoder::new()));
/// let mut patient = Supervised::new(connect, OnLoss::Reconnect { attempts: 3 })?;
/// assert!(patient.next_sample().is_ok() && patient.next_sample().is_ok());
/// assert_eq!(patient.reconnections(), 1);
///
/// let mut strict = Supervised::new(connect, OnLoss::FailStop)?;
/// assert!(strict.next_sample().is_ok());
/// assert!(matches!(strict.next_sample(), Err(SupervisedError::Lost(_))));
/// assert!(matches!(strict.next_sample(), Err(SupervisedError::Stopped)));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnLoss {
    /// Give the error, and from then on nothing but errors, until [`Supervised::resume`] is called.
    FailStop,
    /// Connect anew and go on. The error is given only if that fails so many times in a row.
    Reconnect {
        /// How often it is tried for each loss, at least once.
        attempts: u32,
    },
}

/// Why a supervised source has no sample.
///
/// ```
/// use fingertip_drivers::converters::ConverterFault;
/// use fingertip_drivers::middleware::SupervisedError;
/// use fingertip_drivers::{SourceError, SourceErrorKind};
///
/// let lost = SupervisedError::Lost(ConverterFault::Reset);
/// let told = format!("the link is lost: {}", ConverterFault::Reset);
/// assert_eq!((lost.kind(), lost.to_string()), (SourceErrorKind::DeviceFault, told));
/// let stopped = SupervisedError::<ConverterFault>::Stopped;
/// assert_eq!(stopped.to_string(), "stopped since the link was lost; resume to go on");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SupervisedError<E> {
    /// The source says that something is wrong which has nothing to do with the link.
    #[error(transparent)]
    Source(E),
    /// The link is lost, by this error.
    #[error("the link is lost: {0}")]
    Lost(#[source] E),
    /// The link was lost before, and what to do is to stop.
    #[error("stopped since the link was lost; resume to go on")]
    Stopped,
}

impl<E: SourceError> SourceError for SupervisedError<E> {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Source(error) | Self::Lost(error) => error.kind(),
            Self::Stopped => SourceErrorKind::Transport,
        }
    }
}

/// A source that is connected, and connected anew or not when its link is lost: when it gives an error of the
/// kind [`Transport`](SourceErrorKind::Transport) or [`Timeout`](SourceErrorKind::Timeout). All other errors pass
/// through.
///
/// `connect` makes a source; it is given how many attempts since the loss have failed, so that it can pause
/// before it tries again as it sees fit. A source that is lost before it gives anything is an attempt that
/// failed. A source that is lost is dropped before a new one is
/// made. Nothing is set in the device by connecting, its zero least of all.
///
/// Samples of a new source begin anew with their times and their counts: compare
/// [`reconnections`](Self::reconnections) to notice that there was a gap.
///
/// ```no_run
/// use core::time::Duration;
/// use fingertip_drivers::middleware::{OnLoss, Supervised};
/// use fingertip_drivers::sensors::schunk_fts::{FtsClient, UDP_PORT};
///
/// let timeout = Duration::from_millis(100);
/// let connect = |attempt| {
///     std::thread::sleep(timeout * attempt);
///     FtsClient::connect("192.168.0.100:82", ("0.0.0.0", UDP_PORT), timeout)
/// };
/// let source = Supervised::new(connect, OnLoss::Reconnect { attempts: 10 })?;
/// # drop(source);
/// # Ok::<(), fingertip_drivers::middleware::SupervisedError<fingertip_drivers::sensors::schunk_fts::FtsClientError>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Supervised<S, C> {
    connect: C,
    source: Option<S>,
    on_loss: OnLoss,
    stopped: bool,
    reconnections: u64,
    losses: u64,
}

impl<S, E: SourceError, C: FnMut(u32) -> Result<S, E>> Supervised<S, C> {
    /// Connects for the first time, with as many attempts as after a loss.
    ///
    /// # Errors
    /// [`SupervisedError::Lost`] with the last error of `connect`.
    pub fn new(connect: C, on_loss: OnLoss) -> Result<Self, SupervisedError<E>> {
        let mut supervised =
            Self { connect, source: None, on_loss, stopped: false, reconnections: 0, losses: 0 };
        supervised.connect(&mut 0)?;
        Ok(supervised)
    }

    /// How often it was connected anew.
    #[must_use]
    pub const fn reconnections(&self) -> u64 {
        self.reconnections
    }

    /// How often the link was lost.
    #[must_use]
    pub const fn losses(&self) -> u64 {
        self.losses
    }

    /// The source inside; `None` while there is none.
    #[must_use]
    pub const fn source(&self) -> Option<&S> {
        self.source.as_ref()
    }

    /// Connects anew after a stop.
    ///
    /// # Errors
    /// [`SupervisedError::Lost`] if that fails; it stays stopped then.
    pub fn resume(&mut self) -> Result<(), SupervisedError<E>> {
        self.source = None;
        self.connect(&mut 0)?;
        self.reconnections += 1;
        self.stopped = false;
        Ok(())
    }

    fn attempts(&self) -> u32 {
        match self.on_loss {
            OnLoss::FailStop => 1,
            OnLoss::Reconnect { attempts } => attempts.max(1),
        }
    }

    /// Connects, and counts the attempts that failed.
    fn connect(&mut self, tried: &mut u32) -> Result<(), SupervisedError<E>> {
        loop {
            match (self.connect)(*tried) {
                Ok(source) => {
                    self.source = Some(source);
                    return Ok(());
                }
                Err(error) => {
                    *tried += 1;
                    if *tried >= self.attempts() {
                        return Err(SupervisedError::Lost(error));
                    }
                }
            }
        }
    }
}

impl<T, V, S: Source<T, V>, C: FnMut(u32) -> Result<S, S::Error>> Source<T, V> for Supervised<S, C> {
    type Error = SupervisedError<S::Error>;

    /// Over losses of its link.
    fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, Self::Error> {
        let (mut tried, mut lost) = (0, false);
        loop {
            if self.stopped {
                return Err(SupervisedError::Stopped);
            }
            let Some(source) = &mut self.source else {
                self.connect(&mut tried)?;
                self.reconnections += 1;
                // From now on a loss is one of a source that was just made.
                lost = true;
                continue;
            };
            let error = match source.next_sample() {
                Ok(value) => return Ok(value),
                Err(error) => error,
            };
            if !matches!(error.kind(), SourceErrorKind::Transport | SourceErrorKind::Timeout) {
                return Err(SupervisedError::Source(error));
            }
            self.losses += 1;
            self.source = None;
            // A source that connects and is lost at once has failed as well: without a connection, as over UDP,
            // that is the only way to notice.
            tried += u32::from(lost);
            self.stopped = self.on_loss == OnLoss::FailStop;
            if self.stopped || tried >= self.attempts() {
                return Err(SupervisedError::Lost(error));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector1;

    /// Gives numbers, an error of a kind in place of some, and fails to connect for a while.
    #[derive(Debug)]
    struct Numbers {
        next: u32,
        lost_at: u32,
    }
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Failure(SourceErrorKind);
    impl SourceError for Failure {
        fn kind(&self) -> SourceErrorKind {
            self.0
        }
    }
    impl Source<f64, Vector1<f64>> for Numbers {
        type Error = Failure;

        fn next_sample(&mut self) -> Result<Option<Sample<f64, Vector1<f64>>>, Failure> {
            self.next += 1;
            match self.next {
                number if number == self.lost_at => Err(Failure(SourceErrorKind::Timeout)),
                13 => Err(Failure(SourceErrorKind::Corrupt)),
                40.. => Ok(None),
                number => Ok(Some(Sample { time: None, value: Vector1::new(f64::from(number)) })),
            }
        }
    }

    #[test]
    fn it_stops_for_good_until_it_is_told_to_go_on() {
        let connect = |_| Ok(Numbers { next: 0, lost_at: 20 });
        let mut source = Supervised::new(connect, OnLoss::FailStop).unwrap();
        for number in 1..20 {
            let next = source.next_sample();
            if number == 13 {
                // Not of the link: the next one is tried.
                assert_eq!(next, Err(SupervisedError::Source(Failure(SourceErrorKind::Corrupt))));
            } else {
                assert_eq!(next.unwrap().unwrap().value.x, f64::from(number));
            }
        }
        assert!(matches!(source.next_sample(), Err(SupervisedError::Lost(_))));
        for _ in 0..5 {
            assert_eq!(source.next_sample(), Err(SupervisedError::Stopped));
        }
        source.resume().unwrap();
        assert_eq!(source.next_sample().unwrap().unwrap().value.x, 1.0);
        assert_eq!((source.losses(), source.reconnections()), (1, 1));
    }

    /// A port is open once at a time.
    #[test]
    fn what_was_open_is_closed_before_it_is_opened_again() {
        use alloc::rc::Rc;
        use core::cell::Cell;
        struct Port(Rc<Cell<bool>>);
        impl Drop for Port {
            fn drop(&mut self) {
                self.0.set(false);
            }
        }
        impl Source<f64, Vector1<f64>> for Port {
            type Error = Failure;

            fn next_sample(&mut self) -> Result<Option<Sample<f64, Vector1<f64>>>, Failure> {
                Ok(None)
            }
        }
        let (open, broken) = (Rc::new(Cell::new(false)), Cell::new(false));
        let connect = |_| match open.replace(true) || broken.get() {
            true => Err(Failure(SourceErrorKind::Transport)),
            false => Ok(Port(Rc::clone(&open))),
        };
        let mut source = Supervised::new(connect, OnLoss::FailStop).unwrap();
        source.resume().unwrap();
        assert!(source.source().is_some() && open.get() && source.next_sample() == Ok(None));
        broken.set(true);
        assert!(matches!(source.resume(), Err(SupervisedError::Lost(_))) && source.source().is_none());
        assert_eq!(source.reconnections(), 1);
    }

    #[test]
    fn it_connects_anew_as_often_as_it_is_told() {
        let mut calls = 0;
        let attempts = core::cell::RefCell::new(Vec::new());
        let connect = |attempt| {
            calls += 1;
            attempts.borrow_mut().push(attempt);
            // Fails twice after the first loss.
            if matches!(calls, 2 | 3) {
                return Err(Failure(SourceErrorKind::Transport));
            }
            Ok(Numbers { next: 0, lost_at: if calls == 1 { 3 } else { u32::MAX } })
        };
        let mut source = Supervised::new(connect, OnLoss::Reconnect { attempts: 3 }).unwrap();
        let seen: Vec<f64> = (0..4).map(|_| source.next_sample().unwrap().unwrap().value.x).collect();
        assert_eq!(seen, [1.0, 2.0, 1.0, 2.0]);
        assert_eq!((source.losses(), source.reconnections()), (1, 1));
        assert_eq!(*attempts.borrow(), [0, 0, 1, 2]);
    }

    #[test]
    fn a_link_that_is_never_found_or_lost_at_once_is_an_error_and_no_endless_loop() {
        let never = |_| Err::<Numbers, _>(Failure(SourceErrorKind::Transport));
        assert!(Supervised::new(never, OnLoss::Reconnect { attempts: 100 }).is_err());
        let at_once = |_| Ok(Numbers { next: 0, lost_at: 1 });
        let mut source = Supervised::new(at_once, OnLoss::Reconnect { attempts: 5 }).unwrap();
        assert!(matches!(source.next_sample(), Err(SupervisedError::Lost(_))));
        assert_eq!(source.losses(), 6);
        // And it tries again when it is asked again.
        assert!(matches!(source.next_sample(), Err(SupervisedError::Lost(_))));
    }
}
