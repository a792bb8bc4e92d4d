//! How long a conversation may take, however slowly it drips.

use core::time::Duration;
use std::io::{self, Read};
use std::net::TcpStream;
use std::time::Instant;

/// When a conversation must be over.
#[derive(Clone, Copy)]
pub(super) struct Deadline(Instant);

impl Deadline {
    /// So long from now.
    pub(super) fn within(time: Duration) -> Self {
        Self(Instant::now() + time)
    }

    /// What is left; an error once nothing is.
    pub(super) fn left(self) -> io::Result<Duration> {
        let left = self.0.saturating_duration_since(Instant::now());
        if left.is_zero() { Err(io::ErrorKind::TimedOut.into()) } else { Ok(left) }
    }

    /// Appends what comes next, if it comes in time, and says how many bytes that were; 0 at the end.
    pub(super) fn read(self, stream: &mut TcpStream, to: &mut Vec<u8>) -> io::Result<usize> {
        let mut piece = [0; 512];
        loop {
            stream.set_read_timeout(Some(self.left()?))?;
            match stream.read(&mut piece) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                read => {
                    let length = read?;
                    to.extend_from_slice(piece.get(..length).unwrap_or_default());
                    return Ok(length);
                }
            }
        }
    }
}
