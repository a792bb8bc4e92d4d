//! A sensor that is not there, on a line with faults.

use alloc::collections::VecDeque;
use std::io::{self, Read};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::wire::Frame;

/// What the line does to frames: probabilities between 0 and 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineFaults {
    /// One bit of the frame is flipped.
    pub bit_flip: f64,
    /// One byte of the frame is lost.
    pub lost_byte: f64,
    /// Some bytes that mean nothing come before the frame.
    pub noise: f64,
    /// Seed of the chance.
    pub seed: u64,
}

/// Sends frames as the sensor does. It is the line, too: read from it.
#[derive(Clone, Debug)]
pub struct SimulatedBota {
    faults: LineFaults,
    random: Pcg64Mcg,
    line: VecDeque<u8>,
    sent: u64,
    damaged: u64,
}

impl SimulatedBota {
    /// A sensor at a line with faults.
    #[must_use]
    pub fn new(faults: LineFaults) -> Self {
        let random = Pcg64Mcg::seed_from_u64(faults.seed);
        Self { faults, random, line: VecDeque::new(), sent: 0, damaged: 0 }
    }

    /// The sensor sends a frame.
    pub fn send(&mut self, frame: &Frame) {
        let LineFaults { bit_flip, lost_byte, noise, .. } = self.faults;
        if self.random.random::<f64>() < noise {
            let count = self.random.random_range(1..40);
            for _ in 0..count {
                self.line.push_back(self.random.random());
            }
        }
        let mut bytes = frame.emit().to_vec();
        let (chance, at) = (self.random.random::<f64>(), self.random.random_range(0..Frame::LENGTH));
        if chance < bit_flip {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << self.random.random_range(0..8);
            }
        } else if chance < bit_flip + lost_byte {
            bytes.remove(at);
        }
        self.sent += 1;
        self.damaged += u64::from(chance < bit_flip + lost_byte);
        self.line.extend(bytes);
    }

    /// Frames sent, the damaged ones included.
    #[must_use]
    pub const fn sent(&self) -> u64 {
        self.sent
    }

    /// Frames damaged on the line.
    #[must_use]
    pub const fn damaged(&self) -> u64 {
        self.damaged
    }
}

impl Read for SimulatedBota {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.line.read(buffer)
    }
}
