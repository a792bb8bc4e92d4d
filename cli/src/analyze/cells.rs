//! Text that is made of short pieces.

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
}
