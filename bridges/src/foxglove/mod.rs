//! The WebSocket of Foxglove: wrench, contact and touch as the messages that recordings hold, the fingertip as a
//! scene, and the services `tare` and `reset`.
//!
//! The protocol has no secret: whoever reaches the port can watch, and ask for a zero where there are services. So it
//! listens on loopback, unless it is told otherwise. A client that is too slow misses messages; `number` of a touch shows how many.

mod drawing;
mod recording;
mod services;

use alloc::sync::Arc;
use core::net::SocketAddr;
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use core::time::Duration;
use std::thread::{self, JoinHandle};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use fingertip_recordings::mcap::definitions;
use foxglove::messages::SceneUpdate;
use foxglove::websocket::Capability;
use foxglove::{
    Channel, ChannelBuilder, Context, FoxgloveError, PartialMetadata, RawChannel, Schema, WebSocketServer,
    WebSocketServerHandle,
};
use thiserror::Error;

pub use recording::{Encoded, SceneRecording};

use crate::{About, Hub, Sample, messages};

/// Messages that wait for a client: more than a second's at 1 kHz.
const BACKLOG: usize = 4096;
/// How long it waits for samples before it looks whether it is to end.
const NAP: Duration = Duration::from_millis(50);
/// How often the surface is sent, so that who comes late has it, too; and the contact on it.
const SURFACE: Duration = Duration::from_secs(1);
const DRAWN: Duration = Duration::from_millis(33);
/// What the topic of the scene is called.
const SCENE: &str = "/fingertip/scene";

/// Why there is no server.
///
/// ```
/// use fingertip_bridges::foxglove::Server;
/// use fingertip_bridges::{About, Hub};
///
/// // Something else listens there.
/// let other = std::net::TcpListener::bind("127.0.0.1:0")?;
/// let address = other.local_addr()?;
/// let told = Server::start(&Hub::new(About::default()), address, false).unwrap_err().to_string();
/// assert!(told.starts_with(&format!("cannot serve on {address}: ")), "{told}");
/// assert!(told.ends_with("give another address or port, or port 0 for any free one"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ServerError {
    /// The address cannot be listened on, or something else of the library.
    #[error("cannot serve on {address}: {source}; give another address or port, or port 0 for any free one")]
    Library {
        /// The address.
        address: SocketAddr,
        /// Why not.
        source: FoxgloveError,
    },
    /// The system gives no thread.
    #[error("no thread for the samples of Foxglove: {0}")]
    Thread(std::io::Error),
}

/// A server; it ends when it is dropped.
///
/// ```
/// use fingertip_bridges::foxglove::Server;
/// use fingertip_bridges::{About, Hub};
///
/// // Foxglove opens ws:// with this address; it may watch, and command nothing.
/// let server = Server::start(&Hub::new(About::default()), "127.0.0.1:0".parse()?, false)?;
/// assert_ne!(server.address().port(), 0);
/// assert_eq!(server.missed(), 0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Server {
    handle: Option<WebSocketServerHandle>,
    address: SocketAddr,
    ends: Arc<AtomicBool>,
    missed: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Serves what a hub has, with the services `tare` and `reset` if clients may command.
    ///
    /// # Errors
    /// [`ServerError`].
    pub fn start(hub: &Hub, listen: SocketAddr, commands: bool) -> Result<Self, ServerError> {
        let fault = |source| ServerError::Library { address: listen, source };
        let context = Context::new();
        let channels = Channels::new(&context, hub.about()).map_err(fault)?;
        let server = WebSocketServer::new()
            .context(&context)
            .name(format!("fingertip: {}", hub.about().source))
            .bind(listen.ip().to_string(), listen.port())
            .message_backlog_size(BACKLOG);
        let server = if commands {
            server
                .capabilities([Capability::Services])
                .supported_encodings(["json"])
                .services(services::services(hub))
        } else {
            server
        };
        let handle = server.start_blocking().map_err(fault)?;
        let address = SocketAddr::new(listen.ip(), handle.port());
        let (ends, missed) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU64::new(0)));
        let logging =
            Logging { channels, ends: Arc::clone(&ends), missed: Arc::clone(&missed), hub: hub.clone() };
        let thread = thread::Builder::new().name("foxglove".to_owned()).spawn(move || logging.run());
        let thread = Some(thread.map_err(ServerError::Thread)?);
        Ok(Self { handle: Some(handle), address, ends, missed, thread })
    }

    /// Where it listens.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Samples that this server missed itself. What its clients missed they see by the numbers of touches.
    #[must_use]
    pub fn missed(&self) -> u64 {
        self.missed.load(Ordering::Relaxed)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
        if let Some(handle) = self.handle.take() {
            // Its tasks end on their own.
            let _ = handle.stop();
        }
    }
}

struct Channels {
    /// The library keeps channels only as long as this.
    _context: Arc<Context>,
    wrench: Arc<RawChannel>,
    /// With a scene.
    contact: Arc<RawChannel>,
    touch: Arc<RawChannel>,
    scene: Channel<SceneUpdate>,
}

impl Channels {
    fn new(context: &Arc<Context>, about: &About) -> Result<Self, FoxgloveError> {
        let [wrench, contact, touch] = definitions();
        let raw = |topic: &str, definition: fingertip_recordings::mcap::Definition| {
            ChannelBuilder::new(topic)
                .context(context)
                .message_encoding("cdr")
                .schema(Schema::new(definition.name, "ros2msg", definition.text.as_bytes()))
                .add_metadata("source", &about.source)
                .build_raw()
        };
        Ok(Self {
            _context: Arc::clone(context),
            wrench: raw("/fingertip/wrench", wrench)?,
            contact: raw("/fingertip/contact", contact)?,
            touch: raw("/fingertip/touch", touch)?,
            scene: ChannelBuilder::new(SCENE).context(context).build(),
        })
    }

    fn log(&self, sample: &Sample, about: &About) {
        let header = messages::header(sample, &about.frame);
        let stamp = u64::try_from(sample.stamp.as_nanos()).unwrap_or(u64::MAX);
        let when = || PartialMetadata { log_time: Some(stamp) };
        if self.wrench.has_sinks() {
            self.wrench.log_with_meta(&messages::wrench(sample, &header), when());
        }
        if let Some(contact) = sample.contact().filter(|_| self.contact.has_sinks()) {
            self.contact.log_with_meta(&messages::contact(contact, &header), when());
        }
        if self.touch.has_sinks()
            && let Some(touch) = messages::touch(sample, &header)
        {
            self.touch.log_with_meta(&touch, when());
        }
    }
}

struct Logging {
    channels: Channels,
    hub: Hub,
    ends: Arc<AtomicBool>,
    missed: Arc<AtomicU64>,
}

impl Logging {
    fn run(self) {
        let mut reader = self.hub.subscribe();
        let mut samples = Vec::new();
        let (mut surface, mut drawn) = (None::<Instant>, None::<Instant>);
        let is_due =
            |last: Option<Instant>, period: Duration| last.is_none_or(|last| last.elapsed() >= period);
        // What is there when the stream has ended is still sent.
        while !self.ends.load(Ordering::Relaxed) || (!samples.is_empty() && self.hub.is_closed()) {
            samples.clear();
            let news = reader.wait(&mut samples, NAP);
            self.missed.store(reader.missed(), Ordering::Relaxed);
            let about = self.hub.about();
            samples.iter().for_each(|sample| self.channels.log(sample, about));
            if is_due(surface, SURFACE) && self.channels.scene.has_sinks() {
                surface = Some(Instant::now());
                let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
                self.channels.scene.log(&drawing::surface(about, now));
            }
            if let Some(sample) = samples.last().filter(|_| is_due(drawn, DRAWN)) {
                drawn = Some(Instant::now());
                if about.has_scene && self.channels.scene.has_sinks() {
                    self.channels.scene.log(&drawing::contact(sample, about));
                }
            }
            if news.closed && samples.is_empty() {
                // Until it is dropped there is nothing to do.
                thread::sleep(NAP);
            }
        }
    }
}
