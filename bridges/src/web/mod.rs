//! One page with what a fingertip feels, over HTTP, and its samples, over a WebSocket.
//!
//! Every address carries a token: one to watch, one to command too. The first connection with the token of commands
//! holds them until it ends; another one only watches. A page of another origin is refused, even if it
//! knows a token. What strangers send costs little: heads, messages, connections and the time for each are limited.
//!
//! A connection to `/samples?token=…` gets text messages in JSON: `hello`, `status` when it changes, and `samples` as
//! they come; with `&pace=60`, those of each sixtieth of a second together. To command, it sends
//! `{"do":"tare"}` or `{"do":"reset"}`.

mod client;
mod guard;
mod http;
mod json;
mod page;
mod tokens;

use alloc::sync::Arc;
use core::net::SocketAddr;
use core::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use core::time::Duration;
use std::io;
use std::net::{Shutdown, TcpListener, TcpStream};
use std::thread::{self, JoinHandle};
use std::time::Instant;

use thiserror::Error;

use crate::Hub;
use guard::Guard;
pub use tokens::{Tokens, TokensError};

/// Connections at one time, pages and streams together.
const CONNECTIONS: usize = 16;
/// How long a sending may take before the reader is given up.
const SENDING: Duration = Duration::from_secs(2);

/// Why there is no page.
///
/// ```
/// use fingertip_bridges::web::{Options, Server, Tokens};
/// use fingertip_bridges::{About, Hub};
///
/// // Something else listens there.
/// let other = std::net::TcpListener::bind("127.0.0.1:0")?;
/// let listen = other.local_addr()?;
/// let options = Options { listen, tokens: Tokens::random()?, commands: false, view: String::new() };
/// let told = Server::start(&Hub::new(About::default()), options).unwrap_err().to_string();
/// assert!(told.starts_with(&format!("cannot listen on {listen}: ")), "{told}");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WebError {
    /// The address cannot be listened on.
    #[error("cannot listen on {address}: {source}; give another address or port, or port 0 for any free one")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// Why not.
        source: io::Error,
    },
    /// The system gives no thread.
    #[error("no thread for the page: {0}")]
    Thread(io::Error),
    /// No tokens.
    #[error(transparent)]
    Tokens(#[from] TokensError),
}

/// How the page is served.
///
/// ```
/// use fingertip_bridges::web::{Options, Server, Tokens};
/// use fingertip_bridges::{About, Hub};
///
/// // Anybody who has the token may watch, and nobody may command.
/// let (listen, tokens) = ("127.0.0.1:0".parse()?, Tokens::random()?);
/// let options = Options { listen, tokens, commands: false, view: String::new() };
/// assert_eq!(Server::start(&Hub::new(About::default()), options)?.commanding(), None);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Options {
    /// Where; port 0 is any free one.
    pub listen: SocketAddr,
    /// Who may watch and who may command.
    pub tokens: Tokens,
    /// Whether anybody may command; if not, who has the token of commands watches.
    pub commands: bool,
    /// The view of the surface, as a report has it: an element of HTML with its script; empty for none.
    pub view: String,
}

/// What has happened so far.
///
/// ```
/// use fingertip_bridges::web::{Options, Server, Tokens};
/// use fingertip_bridges::{About, Hub};
/// use std::io::{Read, Write};
/// use std::net::TcpStream;
///
/// let (listen, tokens) = ("127.0.0.1:0".parse()?, Tokens::random()?);
/// let options = Options { listen, tokens, commands: true, view: String::new() };
/// let server = Server::start(&Hub::new(About::default()), options)?;
/// // Somebody guesses a token.
/// let (mut stranger, mut answer) = (TcpStream::connect(server.address())?, String::new());
/// write!(stranger, "GET /?token=1234 HTTP/1.1\r\nHost: {}\r\n\r\n", server.address())?;
/// stranger.read_to_string(&mut answer)?;
/// assert!(answer.starts_with("HTTP/1.1 403"), "{answer}");
/// assert_eq!((server.counts().refused, server.counts().streams), (1, 0));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Streams of samples that were begun.
    pub streams: u64,
    /// Requests that were refused: a wrong token or origin, no room, no HTTP.
    pub refused: u64,
    /// Samples that readers missed, who were too slow.
    pub missed: u64,
    /// Readers that were given up, since they took nothing for two seconds.
    pub given_up: u64,
}

/// What threads of the server share.
#[derive(Debug)]
struct Shared {
    hub: Hub,
    guard: Guard,
    view: String,
    ends: AtomicBool,
    /// Whether a connection holds the commands.
    has_writer: AtomicBool,
    connections: AtomicUsize,
    streams: AtomicU64,
    refused: AtomicU64,
    missed: AtomicU64,
    given_up: AtomicU64,
}

/// A server; it ends when it is dropped.
///
/// ```
/// use fingertip_bridges::web::{Options, Server, Tokens};
/// use fingertip_bridges::{About, Hub};
/// use std::io::{Read, Write};
/// use std::net::TcpStream;
///
/// let (listen, tokens) = ("127.0.0.1:0".parse()?, Tokens::random()?);
/// let options = Options { listen, tokens, commands: true, view: String::new() };
/// let server = Server::start(&Hub::new(About::default()), options)?;
/// // What a browser asks for that opens the address for those who watch.
/// let (address, page) = (server.address(), server.watching());
/// let path = page.strip_prefix(&format!("http://{address}")).unwrap();
/// let (mut browser, mut answer) = (TcpStream::connect(address)?, String::new());
/// write!(browser, "GET {path} HTTP/1.1\r\nHost: {address}\r\n\r\n")?;
/// browser.read_to_string(&mut answer)?;
/// assert!(answer.starts_with("HTTP/1.1 200 OK"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Server {
    shared: Arc<Shared>,
    address: SocketAddr,
    tokens: Tokens,
    commands: bool,
    thread: Option<JoinHandle<()>>,
}

/// How long readers have to take what is left when there is no more.
const REST: Duration = Duration::from_secs(1);

/// One connection of those that there is room for.
struct Place(Arc<Shared>);

impl Place {
    fn take(shared: &Arc<Shared>) -> Option<Self> {
        let place = |taken: usize| (taken < CONNECTIONS).then_some(taken + 1);
        shared.connections.fetch_update(Ordering::Relaxed, Ordering::Relaxed, place).ok()?;
        Some(Self(Arc::clone(shared)))
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.0.connections.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Server {
    /// Serves what a hub has.
    ///
    /// # Errors
    /// [`WebError`].
    pub fn start(hub: &Hub, options: Options) -> Result<Self, WebError> {
        let Options { listen, tokens, commands, view } = options;
        let fault = |source| WebError::Listen { address: listen, source };
        let listener = TcpListener::bind(listen).map_err(fault)?;
        let address = listener.local_addr().map_err(fault)?;
        let shared = Arc::new(Shared {
            hub: hub.clone(),
            guard: Guard::new(address, tokens.clone(), commands),
            view,
            ends: AtomicBool::new(false),
            has_writer: AtomicBool::new(false),
            connections: AtomicUsize::new(0),
            streams: AtomicU64::new(0),
            refused: AtomicU64::new(0),
            missed: AtomicU64::new(0),
            given_up: AtomicU64::new(0),
        });
        let accepting = Arc::clone(&shared);
        let thread = thread::Builder::new()
            .name("web".to_owned())
            .spawn(move || accept(&listener, &accepting))
            .map_err(WebError::Thread)?;
        Ok(Self { shared, address, tokens, commands, thread: Some(thread) })
    }

    /// Where it listens.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// The address of the page for those who watch.
    #[must_use]
    pub fn watching(&self) -> String {
        format!("http://{}/?token={}", self.address, self.tokens.watch())
    }

    /// The address of the page for who commands, too; `None` where nobody may.
    #[must_use]
    pub fn commanding(&self) -> Option<String> {
        self.commands.then(|| format!("http://{}/?token={}", self.address, self.tokens.command()))
    }

    /// What has happened so far.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let count = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        let Shared { streams, refused, missed, given_up, .. } = &*self.shared;
        Counts {
            streams: count(streams),
            refused: count(refused),
            missed: count(missed),
            given_up: count(given_up),
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let begun = Instant::now();
        while self.shared.hub.is_closed()
            && self.shared.connections.load(Ordering::Relaxed) > 0
            && begun.elapsed() < REST
        {
            thread::sleep(Duration::from_millis(5));
        }
        self.shared.ends.store(true, Ordering::Relaxed);
        // So that the listener hears of it.
        let _ = TcpStream::connect_timeout(&self.address, Duration::from_secs(1));
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn accept(listener: &TcpListener, shared: &Arc<Shared>) {
    while !shared.ends.load(Ordering::Relaxed) {
        let Ok((stream, _)) = listener.accept() else {
            // One that failed before it was accepted, or no descriptors: the next may fare better.
            thread::sleep(Duration::from_millis(20));
            continue;
        };
        let Some(place) = Place::take(shared) else {
            shared.refused.fetch_add(1, Ordering::Relaxed);
            http::refuse_at_once(stream);
            continue;
        };
        // Without a thread the connection is closed.
        let _ = thread::Builder::new().name("web client".to_owned()).spawn(move || {
            let _ = stream.set_nodelay(true);
            let _ = stream.set_write_timeout(Some(SENDING));
            let closing = stream.try_clone();
            http::serve(stream, &place.0);
            let _ = closing.map(|stream| stream.shutdown(Shutdown::Both));
            drop(place);
        });
    }
}
