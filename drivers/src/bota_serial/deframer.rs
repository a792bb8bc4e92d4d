//! Finds frames in a stream of bytes.

use super::wire::{Frame, FrameError};

/// Collects bytes and gives the frames among them.
///
/// A byte 0xAA can stand inside a frame too, so a frame counts only if its checksum fits; if it does
/// not, one byte is dropped and the search goes on behind it. So a damaged frame never takes a
/// sound one with it that begins inside its bytes.
#[derive(Clone, Copy, Debug)]
pub struct Deframer {
    bytes: [u8; Frame::LENGTH],
    length: usize,
    skipped: u64,
    failed: u64,
    frames: u64,
}

impl Default for Deframer {
    fn default() -> Self {
        Self::new()
    }
}

impl Deframer {
    /// Nothing seen yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { bytes: [0; Frame::LENGTH], length: 0, skipped: 0, failed: 0, frames: 0 }
    }

    /// Takes the next byte; a frame if it completes one.
    #[inline]
    pub fn push(&mut self, byte: u8) -> Option<Frame> {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        }
        if self.length == 1 && byte != Frame::HEADER {
            self.drop_to_header(1);
        }
        if self.length < Frame::LENGTH {
            return None;
        }
        match Frame::parse(&self.bytes) {
            Ok(frame) => {
                self.length = 0;
                self.frames += 1;
                Some(frame)
            }
            Err(error) => {
                self.failed += u64::from(matches!(error, FrameError::Checksum { .. }));
                self.drop_to_header(1);
                None
            }
        }
    }

    /// Drops bytes from the front: at least `least`, and up to the next header.
    fn drop_to_header(&mut self, least: usize) {
        let held = self.bytes.get(..self.length).unwrap_or_default();
        let found = held.iter().skip(least).position(|byte| *byte == Frame::HEADER);
        let dropped = found.map_or(self.length, |at| at + least);
        self.skipped += dropped as u64;
        self.bytes.copy_within(dropped..self.length, 0);
        self.length -= dropped;
    }

    /// Frames given so far.
    #[must_use]
    pub const fn frames(&self) -> u64 {
        self.frames
    }

    /// How often what looked like a frame had a wrong checksum: damaged frames, and bytes 0xAA in
    /// the middle of one.
    #[must_use]
    pub const fn failed(&self) -> u64 {
        self.failed
    }

    /// Bytes that belong to no frame.
    #[must_use]
    pub const fn skipped(&self) -> u64 {
        self.skipped
    }

    /// Bytes that wait for the rest of their frame.
    #[must_use]
    pub const fn waiting(&self) -> usize {
        self.length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn frame(number: u32) -> Frame {
        // 0xAA in many places, to be mistaken for a header.
        Frame { components: [f32::from_bits(0xAAAA_AAAA); 6], microseconds: number, ..Frame::default() }
    }

    /// What the stream holds by trying every place, with all of it at hand.
    fn searched(stream: &[u8]) -> Vec<Frame> {
        let (mut found, mut at) = (Vec::new(), 0);
        while let Some(bytes) = stream.get(at..at + Frame::LENGTH) {
            match Frame::parse(bytes) {
                Ok(frame) => {
                    found.push(frame);
                    at += Frame::LENGTH;
                }
                Err(_) => at += 1,
            }
        }
        found
    }

    proptest! {
        #[test]
        fn a_stream_gives_what_a_search_of_all_of_it_gives(
            pieces in prop::collection::vec(
                (prop::collection::vec(prop_oneof![any::<u8>(), Just(0xAA)], 0..60), any::<bool>()), 1..20,
            ),
        ) {
            let mut stream = Vec::new();
            for (index, (noise, sound)) in pieces.iter().enumerate() {
                stream.extend(noise);
                if *sound {
                    stream.extend(frame(index as u32).emit());
                }
            }
            let mut deframer = Deframer::default();
            let found: Vec<[u8; Frame::LENGTH]> =
                stream.iter().filter_map(|byte| deframer.push(*byte)).map(|frame| frame.emit()).collect();
            let expected: Vec<[u8; Frame::LENGTH]> = searched(&stream).iter().map(Frame::emit).collect();
            let accounted = deframer.skipped() + deframer.waiting() as u64 + (found.len() * Frame::LENGTH) as u64;
            prop_assert_eq!(accounted, stream.len() as u64);
            prop_assert_eq!(found, expected);
        }
    }
}
