//! A reader that gives up on a line without an end, and ends every line.

use std::io::{self, Read};

/// Passes bytes on and fails once too many have passed since [`start_record`](Self::start_record).
///
/// Behind the last byte it adds a line end if there is none, so that every row ends with one: that
/// is how lines are counted.
pub(super) struct Bounded<R> {
    inner: R,
    since: u64,
    total: u64,
    reached: bool,
    ended: bool,
}

impl<R> Bounded<R> {
    /// The longest record, with room for what is read ahead.
    pub(super) const LIMIT: u64 = 1 << 20;

    pub(super) const fn new(inner: R) -> Self {
        Self { inner, since: 0, total: 0, reached: false, ended: true }
    }

    /// A record is complete: the next one starts.
    pub(super) const fn start_record(&mut self) {
        self.since = 0;
    }

    /// Whether the limit was the reason of the last failure.
    pub(super) const fn reached(&self) -> bool {
        self.reached
    }

    /// All bytes passed, without the end that was added.
    pub(super) const fn total(&self) -> u64 {
        self.total
    }
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.since > Self::LIMIT {
            self.reached = true;
            return Err(io::Error::other("line too long"));
        }
        // A signal may interrupt a read; it is no end of the file, and `csv` would take it for one.
        let count = loop {
            match self.inner.read(buffer) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                read => break read?,
            }
        };
        if count == 0
            && !self.ended
            && let Some(first) = buffer.first_mut()
        {
            *first = b'\n';
            self.ended = true;
            return Ok(1);
        }
        if let Some(last) = count.checked_sub(1).and_then(|last| buffer.get(last)) {
            self.ended = *last == b'\n';
        }
        let passed = u64::try_from(count).unwrap_or(u64::MAX);
        self.since = self.since.saturating_add(passed);
        self.total = self.total.saturating_add(passed);
        Ok(count)
    }
}
