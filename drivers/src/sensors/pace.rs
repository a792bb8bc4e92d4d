//! Steps of a period, as the clock goes on.

use core::time::Duration;
use std::thread;
use std::time::Instant;

/// Says when the next sample of a simulated sensor is due.
///
/// ```
/// use core::time::Duration;
/// use fingertip_drivers::sensors::Pace;
/// use std::time::Instant;
///
/// // Five samples, 2 ms apart: the first is due at once.
/// let (mut pace, start, mut samples) = (Pace::new(Duration::from_millis(2)), Instant::now(), 0);
/// while samples < 5 {
///     samples += u32::from(pace.is_due());
/// }
/// assert!(start.elapsed() >= Duration::from_millis(8));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    period: Duration,
    next: Instant,
}

/// A server that was stopped for so long goes on from now, and sends no burst.
const LONGEST_BURST: Duration = Duration::from_millis(100);
/// Longest nap, so that a client is heard.
const NAP: Duration = Duration::from_millis(1);

impl Pace {
    /// One step each period, the first one now.
    #[must_use]
    pub fn new(period: Duration) -> Self {
        Self { period, next: Instant::now() }
    }

    /// Begins anew: the next step is due now.
    pub fn restart(&mut self) {
        self.next = Instant::now();
    }

    /// Whether a step is due; if not, waits for it, a millisecond at most. Steps that are late are made up
    /// for, unless they are by more than 100 ms.
    pub fn is_due(&mut self) -> bool {
        let now = Instant::now();
        if now < self.next {
            thread::sleep((self.next - now).min(NAP));
            return false;
        }
        self.next += self.period;
        if now > self.next + LONGEST_BURST {
            self.next = now;
        }
        true
    }
}
