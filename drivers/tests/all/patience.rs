//! What lets tests over sockets pass on a machine of any speed.
#![cfg(all(feature = "ati-rdt", feature = "schunk-fts", feature = "simulators"))]

use core::sync::atomic::{AtomicU32, Ordering};
use core::time::Duration;
use std::net::UdpSocket;

use fingertip_drivers::middleware::{Supervised, SupervisedError};
use fingertip_drivers::{Sample, Source, SourceError, SourceErrorKind};
use fingertip_wrench::Wrench;

/// How long to wait for what must come.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);
/// How long to wait for what does not come. What would have come is asked for again, by [`patiently`].
pub(crate) const SILENCE: Duration = Duration::from_millis(200);

/// A port where nobody listens, and nobody will: it is below those that systems give away by themselves.
pub(crate) fn unused_port() -> u16 {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    loop {
        let number = std::process::id().wrapping_mul(16).wrapping_add(NEXT.fetch_add(1, Ordering::Relaxed));
        let port = 20_000 + (number % 10_000) as u16;
        if UdpSocket::bind(("127.0.0.1", port)).is_ok() {
            return port;
        }
    }
}

/// The next sample of a source that stops where it is lost: it is resumed where only the machine was too slow.
pub(crate) fn patiently<S, C>(source: &mut Supervised<S, C>) -> Sample<f64, Wrench<f64>>
where
    S: Source<f64, Wrench<f64>>,
    C: FnMut(u32) -> Result<S, S::Error>,
{
    let mut last = None;
    for _ in 0..PATIENCE.as_millis() / SILENCE.as_millis() {
        match source.next_sample() {
            Ok(sample) => return sample.unwrap(),
            // Nothing else is tried again.
            Err(error) if !is_late(&error) => panic!("{error:?}"),
            Err(error) => last = Some((error, source.resume())),
        }
    }
    panic!("{last:?}");
}

/// Whether a source was stopped, now or before, since nothing came in time.
fn is_late<E: SourceError>(error: &SupervisedError<E>) -> bool {
    match error {
        SupervisedError::Lost(error) => error.kind() == SourceErrorKind::Timeout,
        error => matches!(error, SupervisedError::Stopped),
    }
}
