//! The core under all faces: bytes in, samples out, without I/O.

use core::marker::PhantomData;

use fingertip_wrench::{Real, Wrench};

use super::decoder::LineDecoder;
use crate::Sample;

/// Bytes that were read and not yet decoded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pump<T, D> {
    decoder: D,
    buffer: [u8; 256],
    next: usize,
    length: usize,
    /// Bytes since the last frame.
    fruitless: usize,
    scalar: PhantomData<T>,
}

/// What the bytes at hand give.
pub(super) enum Step<T: Real, F> {
    Sample(Sample<T, Wrench<T>>),
    Fault(F),
    /// So many bytes and no frame.
    NoFrame(usize),
    /// Read some bytes and say how many.
    Empty,
}

impl<T: Real, D: LineDecoder<T>> Pump<T, D> {
    pub(super) const fn new(decoder: D) -> Self {
        Self { decoder, buffer: [0; 256], next: 0, length: 0, fruitless: 0, scalar: PhantomData }
    }

    pub(super) const fn decoder(&self) -> &D {
        &self.decoder
    }

    /// Drops the bytes at hand; a frame begins with the next one.
    pub(super) fn restart(&mut self) {
        (self.next, self.length, self.fruitless) = (0, 0, 0);
        self.decoder.restart();
    }

    pub(super) fn step(&mut self) -> Step<T, D::Fault> {
        while let Some(byte) = self.buffer.get(self.next..self.length).and_then(<[u8]>::first) {
            self.next += 1;
            self.fruitless += 1;
            match self.decoder.push(*byte) {
                Some(Ok(sample)) => {
                    self.fruitless = 0;
                    return Step::Sample(sample);
                }
                Some(Err(fault)) => {
                    self.fruitless = 0;
                    return Step::Fault(fault);
                }
                None if self.fruitless >= D::PATIENCE => {
                    return Step::NoFrame(core::mem::take(&mut self.fruitless));
                }
                None => {}
            }
        }
        Step::Empty
    }

    /// Where to read to, once a step says that all is decoded.
    pub(super) const fn buffer(&mut self) -> &mut [u8] {
        (self.next, self.length) = (0, 0);
        &mut self.buffer
    }

    /// Says how many bytes were read.
    pub(super) fn filled(&mut self, length: usize) {
        (self.next, self.length) = (0, length.min(self.buffer.len()));
    }
}

/// The methods of a sensor that has a line and a pump.
macro_rules! pumping {
    ($name:ident) => {
        impl<L, T: Real, D: LineDecoder<T>> $name<L, T, D> {
            /// On an open line.
            #[must_use]
            pub const fn new(line: L, decoder: D) -> Self {
                Self { line, pump: Pump::new(decoder) }
            }

            /// What decodes the bytes; it knows how the line has behaved.
            #[must_use]
            pub const fn decoder(&self) -> &D {
                self.pump.decoder()
            }

            /// Drops the bytes that were read and not yet used: a frame begins with the next one that is
            /// read. For a line that has fallen silent, or before a request is sent.
            pub fn restart(&mut self) {
                self.pump.restart();
            }

            /// The line, to send the sensor a request.
            #[must_use]
            pub const fn line_mut(&mut self) -> &mut L {
                &mut self.line
            }
        }
    };
}

pub(super) use pumping;
