//! Finds frames in a stream of bytes.

/// How the frames of a device look: `LENGTH` bytes that are an `F`.
///
/// ```
/// use fingertip_drivers::sensors::line::{Deframer, FrameFormat};
///
/// /// A header, a number, and the number inverted.
/// const FORMAT: FrameFormat<u8, 3> = FrameFormat {
///     may_begin: |start| start.first().is_none_or(|first| *first == 0x55),
///     frame: |[_, number, check]| (*check == !*number).then_some(*number),
/// };
///
/// let mut deframer = Deframer::new(FORMAT);
/// let found: Vec<u8> =
///     [1, 0x55, 7, !7, 0x55, 8, 8].into_iter().filter_map(|byte| deframer.push(byte)).collect();
/// assert_eq!(found, [7]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FrameFormat<F, const LENGTH: usize> {
    /// Whether a frame can begin with these bytes (at most `LENGTH`): its header, as far as it is
    /// there. The more is asked here, the sooner noise is dropped; a format without a header says
    /// `true`.
    pub may_begin: fn(&[u8]) -> bool,
    /// The frame, if all that can be checked about it is right: above all its checksum.
    pub frame: fn(&[u8; LENGTH]) -> Option<F>,
}

/// How a line has behaved so far. What was lost on the way is not among it: only formats that number their
/// frames let one count that, and their decoders say how many are missing.
///
/// ```
/// use fingertip_drivers::sensors::bota_serial::{FORMAT, Frame};
/// use fingertip_drivers::sensors::line::Deframer;
///
/// let mut damaged = Frame::default().emit();
/// damaged[20] ^= 1;
/// let mut deframer = Deframer::new(FORMAT);
/// for byte in damaged.into_iter().chain(Frame::default().emit()) {
///     deframer.push(byte);
/// }
/// let statistics = deframer.statistics();
/// assert_eq!((statistics.frames, statistics.failed, statistics.skipped), (1, 1, 37));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LineStatistics {
    /// Frames that were sound.
    pub frames: u64,
    /// What began like a frame and was none: damaged frames, and bytes inside one that look like a
    /// header.
    pub failed: u64,
    /// Bytes that belong to no frame.
    pub skipped: u64,
}

/// Collects bytes and gives the frames among them.
///
/// What looks like a header can stand inside a frame too, so a frame counts only if its checksum
/// fits; if it does not, one byte is dropped and the search goes on behind it. So a damaged frame
/// never takes a sound one with it that begins inside its bytes.
///
/// ```
/// use fingertip_drivers::sensors::bota_serial::{FORMAT, Frame};
/// use fingertip_drivers::sensors::line::Deframer;
///
/// // The end of one frame, and another.
/// let frame = Frame { microseconds: 1000, ..Frame::default() };
/// let bytes = [&frame.emit()[30..], &frame.emit()].concat();
/// let mut deframer = Deframer::new(FORMAT);
/// let found: Vec<_> = bytes.into_iter().filter_map(|byte| deframer.push(byte)).collect();
/// assert_eq!((found, deframer.waiting()), (vec![frame], 0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Deframer<F, const LENGTH: usize> {
    format: FrameFormat<F, LENGTH>,
    bytes: [u8; LENGTH],
    length: usize,
    statistics: LineStatistics,
}

impl<F, const LENGTH: usize> Deframer<F, LENGTH> {
    /// Nothing seen yet.
    #[must_use]
    pub const fn new(format: FrameFormat<F, LENGTH>) -> Self {
        let statistics = LineStatistics { frames: 0, failed: 0, skipped: 0 };
        Self { format, bytes: [0; LENGTH], length: 0, statistics }
    }

    /// Takes the next byte; a frame if it completes one.
    #[inline]
    pub fn push(&mut self, byte: u8) -> Option<F> {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        }
        if !(self.format.may_begin)(self.held()) {
            self.drop_to_header();
        }
        if self.length < LENGTH {
            return None;
        }
        let frame = (self.format.frame)(&self.bytes);
        if frame.is_some() {
            self.length = 0;
            self.statistics.frames += 1;
        } else {
            self.statistics.failed += 1;
            self.drop_to_header();
        }
        frame
    }

    fn held(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }

    /// Drops bytes from the front: at least one, and up to where a frame may begin.
    fn drop_to_header(&mut self) {
        let held = self.held();
        let starts = 1..self.length;
        let dropped = starts
            .into_iter()
            .find(|start| (self.format.may_begin)(held.get(*start..).unwrap_or_default()))
            .unwrap_or(self.length);
        self.statistics.skipped += dropped as u64;
        self.bytes.copy_within(dropped..self.length, 0);
        self.length -= dropped;
    }

    /// Forgets the bytes that wait for the rest of their frame, and counts them as skipped: for a
    /// line that is known to have fallen silent between frames.
    pub fn clear(&mut self) {
        self.statistics.skipped += self.length as u64;
        self.length = 0;
    }

    /// How the line has behaved so far.
    #[must_use]
    pub const fn statistics(&self) -> LineStatistics {
        self.statistics
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

    /// Two bytes of header, four of which one is their sum.
    const SUM: FrameFormat<[u8; 3], 6> = FrameFormat {
        may_begin: |start| start.iter().zip([1, 2]).all(|(byte, header)| *byte == header),
        frame: |bytes| {
            let [1, 2, a, b, c, sum] = *bytes else { return None };
            (sum == a.wrapping_add(b).wrapping_add(c)).then_some([a, b, c])
        },
    };

    /// What the stream holds by trying every place, with all of it at hand; and how many places begin like a frame,
    /// outside of those that are one, and are none.
    fn searched(stream: &[u8]) -> (Vec<[u8; 3]>, u64) {
        let (mut found, mut failed, mut at) = (Vec::new(), 0, 0);
        while let Some(bytes) = stream.get(at..at + 6) {
            match (SUM.frame)(bytes.try_into().unwrap()) {
                Some(frame) => {
                    found.push(frame);
                    at += 6;
                }
                None => {
                    failed += u64::from(bytes.starts_with(&[1, 2]));
                    at += 1;
                }
            }
        }
        (found, failed)
    }

    proptest! {
        #[test]
        fn a_stream_gives_what_a_search_of_all_of_it_gives(
            // Few different bytes, so that headers and frames come by chance and overlap.
            noise in prop::collection::vec(0_u8..4, 0..400),
        ) {
            let mut deframer = Deframer::new(SUM);
            let found: Vec<[u8; 3]> = noise.iter().filter_map(|byte| deframer.push(*byte)).collect();
            let statistics = deframer.statistics();
            let accounted = statistics.skipped + deframer.waiting() as u64 + 6 * statistics.frames;
            prop_assert_eq!(accounted, noise.len() as u64);
            prop_assert_eq!(statistics.frames, found.len() as u64);
            prop_assert_eq!((found, statistics.failed), searched(&noise));
        }
    }

    #[test]
    fn a_line_that_fell_silent_can_be_begun_anew() {
        let mut deframer = Deframer::new(SUM);
        assert!([1, 2, 3].iter().all(|byte| deframer.push(*byte).is_none()));
        deframer.clear();
        assert_eq!((deframer.waiting(), deframer.statistics().skipped), (0, 3));
        let frames: Vec<[u8; 3]> =
            [1, 2, 3, 4, 5, 12].iter().filter_map(|byte| deframer.push(*byte)).collect();
        assert_eq!(frames, [[3, 4, 5]]);
    }
}
