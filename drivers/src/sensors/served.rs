//! A simulated sensor at the end of a socket.

use alloc::borrow::ToOwned;
use alloc::sync::Arc;
use core::net::SocketAddr;
use core::sync::atomic::{AtomicBool, Ordering};
use std::io;
use std::thread::JoinHandle;

/// A simulated sensor that serves in a thread of its own, until it is dropped.
///
/// ```
/// use core::time::Duration;
/// use fingertip_drivers::sensors::FaultPlan;
/// use fingertip_drivers::sensors::ati_rdt::{RdtServer, SimulatedNetFt};
///
/// // At a free port; without a client it sends nothing.
/// let sensor = SimulatedNetFt::new(FaultPlan::default());
/// let server = RdtServer::start("127.0.0.1:0", sensor, Duration::from_millis(1), |_| [0; 6])?;
/// assert!(server.address().port() > 0);
/// assert_eq!(server.stop().unwrap().sent(), 0);
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct Served<Sensor> {
    address: SocketAddr,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Sensor>>,
}

impl<Sensor: Send + 'static> Served<Sensor> {
    /// Serves at an address by `run`, which shall return soon after what it is given becomes `true`.
    pub(crate) fn by(
        address: SocketAddr,
        name: &str,
        run: impl FnOnce(&AtomicBool) -> Sensor + Send + 'static,
    ) -> io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let thread = std::thread::Builder::new().name(name.to_owned()).spawn(move || run(&stopped))?;
        Ok(Self { address, stop, thread: Some(thread) })
    }
}

impl<Sensor> Served<Sensor> {
    /// Where it serves.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Stops serving and gives the sensor back; `None` if its thread died.
    #[must_use]
    pub fn stop(mut self) -> Option<Sensor> {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take()?.join().ok()
    }
}

impl<Sensor> Drop for Served<Sensor> {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A panic of the caller's load function has been reported by then.
            let _ = thread.join();
        }
    }
}
