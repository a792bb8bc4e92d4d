//! Text that is made of short pieces: words and numbers.

use super::digits;

/// Bytes that are collected before they are written: as many as a file takes without collecting them once more.
const BUFFER: usize = 1 << 16;

/// Text that is collected piece by piece: most are numbers of eight bytes and a few, for which a call that copies
/// bytes of any number costs more than the copy.
pub(super) struct Cells {
    /// As long as there is room.
    bytes: Vec<u8>,
    filled: usize,
}

impl Default for Cells {
    fn default() -> Self {
        Self { bytes: vec![0; 2 * BUFFER], filled: 0 }
    }
}

/// Copies text of `H` to `2 H` bytes as its first `H` and its last, which may overlap; both slices are as long as
/// the text.
#[inline]
fn copy_halves<const H: usize>(to: &mut [u8], text: &[u8]) {
    if let (Some(head), Some(first)) = (to.first_chunk_mut::<H>(), text.first_chunk::<H>()) {
        *head = *first;
    }
    if let (Some(tail), Some(last)) = (to.last_chunk_mut::<H>(), text.last_chunk::<H>()) {
        *tail = *last;
    }
}

/// Copies text to a place that is as long.
#[inline]
fn copy(to: &mut [u8], text: &[u8]) {
    match text.len() {
        0 => {}
        1..=3 => to.iter_mut().zip(text).for_each(|(to, byte)| *to = *byte),
        4..=7 => copy_halves::<4>(to, text),
        8..=16 => copy_halves::<8>(to, text),
        _ => to.copy_from_slice(text),
    }
}

impl Cells {
    /// Appends text.
    #[inline]
    pub(super) fn put(&mut self, text: &[u8]) {
        copy(self.room(text.len()), text);
    }

    /// Appends a comma and text.
    #[inline]
    pub(super) fn put_cell(&mut self, text: &[u8]) {
        if let Some((comma, to)) = self.room(1 + text.len()).split_first_mut() {
            *comma = b',';
            copy(to, text);
        }
    }

    /// Appends numbers of eight significant digits, with a comma before each; nothing behind it for what is not finite.
    #[inline]
    pub(super) fn put_numbers(&mut self, numbers: &[f64]) {
        let start = self.filled;
        // Each is written whole, of which only the first bytes count.
        let room = self.room(numbers.len() * digits::ROOM);
        let mut left = numbers.iter();
        let mut written = 0;
        for number in left.by_ref() {
            let to = room.get_mut(written..).and_then(|to| to.first_chunk_mut());
            let Some(length) = to.and_then(|to| digits::write_cell(*number, to)) else {
                self.filled = start + written;
                self.put_unusual(*number);
                return self.put_numbers(left.as_slice());
            };
            written += length;
        }
        self.filled = start + written;
    }

    /// What needs an exponent, or is infinite: as many digits as single precision needs, or double precision beyond its range.
    #[inline(never)]
    #[expect(clippy::cast_possible_truncation, reason = "numbers that it cannot hold are not written so")]
    fn put_unusual(&mut self, number: f64) {
        let mut buffer = zmij::Buffer::new();
        let single = number as f32;
        let text = if single.is_normal() {
            buffer.format_finite(single)
        } else if number.is_finite() {
            buffer.format_finite(number)
        } else {
            ""
        };
        self.put_cell(text.as_bytes());
    }

    /// Appends a time \[s\], rounded to nanoseconds; nothing for what is not finite.
    #[inline]
    pub(super) fn put_time(&mut self, time: f64) {
        let room = self.room(digits::ROOM);
        let written = room.first_chunk_mut().and_then(|to| digits::write_time(time, to));
        self.filled -= digits::ROOM - written.unwrap_or(0);
        if written.is_none() {
            self.put_unusual_time(time);
        }
    }

    /// Times that are too long to have nanoseconds, and those before the first.
    #[inline(never)]
    fn put_unusual_time(&mut self, time: f64) {
        if time.is_finite() {
            let rounded = (time * 1e9).round() / 1e9;
            let rounded = if rounded.is_finite() { rounded } else { time };
            self.put(zmij::Buffer::new().format_finite(rounded).as_bytes());
        }
    }

    /// Room for so many bytes.
    #[inline]
    fn room(&mut self, bytes: usize) -> &mut [u8] {
        let start = self.filled;
        self.filled += bytes;
        if self.filled > self.bytes.len() {
            self.grow(self.filled);
        }
        self.bytes.get_mut(start..self.filled).unwrap_or_default()
    }

    #[cold]
    fn grow(&mut self, end: usize) {
        self.bytes.resize(2 * end, 0);
    }

    /// Whether it is time to write.
    #[inline]
    pub(super) const fn is_full(&self) -> bool {
        self.filled >= BUFFER
    }

    /// What was collected.
    pub(super) fn text(&self) -> &[u8] {
        self.bytes.get(..self.filled).unwrap_or_default()
    }

    /// Forgets it.
    pub(super) const fn clear(&mut self) {
        self.filled = 0;
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::{BUFFER, Cells};

    #[test]
    fn pieces_of_every_length_are_put_together() {
        let (mut cells, mut expected) = (Cells::default(), Vec::new());
        for round in 0..8000_usize {
            let piece: Vec<u8> = (0..round % 41).map(|i| b'a' + ((i + round) % 26) as u8).collect();
            if round % 3 == 0 {
                cells.put_cell(&piece);
                expected.push(b',');
            } else {
                cells.put(&piece);
            }
            expected.extend_from_slice(&piece);
            assert_eq!(cells.is_full(), expected.len() >= BUFFER);
        }
        assert!(expected.len() > 2 * BUFFER && cells.text() == expected);
        cells.clear();
        assert!(cells.text().is_empty() && !cells.is_full());
        cells.put(b"again");
        assert_eq!(cells.text(), b"again");
    }

    #[test]
    fn numbers_of_every_size_can_be_read_again() {
        let mut cells = Cells::default();
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(9);
        let numbers: Vec<f64> = (0..40_000)
            .map(|i| {
                let decades = if i % 2 == 0 { -320..309 } else { -9..10 };
                random.random_range(-1.0..1.0) * 10.0_f64.powi(random.random_range(decades))
            })
            .chain([0.0, -0.0, f64::MAX, f64::MIN_POSITIVE, 5e-324, -3.5e38, 1e-7, 1e8])
            .collect();
        for number in &numbers {
            cells.put_numbers(&[*number]);
        }
        let text = core::str::from_utf8(cells.text()).unwrap();
        let read: Vec<&str> = text.strip_prefix(',').unwrap().split(',').collect();
        assert_eq!(read.len(), numbers.len());
        for (text, number) in read.iter().zip(&numbers) {
            let read: f64 = text.parse().unwrap();
            // Single precision rounds twice.
            let share = if text.contains('e') || number.abs() > 9e6 { 1.2e-7 } else { 5.1e-8 };
            assert!((read - number).abs() <= share * number.abs(), "{text} for {number}");
            assert_eq!(read.is_sign_negative(), number.is_sign_negative());
        }
        cells.clear();
        [f64::NAN, f64::INFINITY, -1.0, f64::NEG_INFINITY, 2.5].chunks(2).for_each(|x| cells.put_numbers(x));
        assert_eq!(cells.text(), b",,,-1.0,,2.5");
    }

    #[test]
    fn times_are_in_nanoseconds() {
        for (time, text) in
            [(0.1 + 0.2, "0.3"), (-1.0, "-1.0"), (1.234_567_890_6, "1.234567891"), (1e300, "1e+300")]
        {
            let mut cells = Cells::default();
            cells.put_time(time);
            cells.put_cell(b"behind");
            assert_eq!(core::str::from_utf8(cells.text()), Ok(&*format!("{text},behind")));
        }
        let mut cells = Cells::default();
        [f64::NAN, f64::INFINITY].iter().for_each(|time| cells.put_time(*time));
        assert!(cells.text().is_empty());
    }
}
