//! One stream of samples, in a thread of its own.

use core::sync::atomic::Ordering;
use core::time::Duration;
use std::io::ErrorKind;
use std::net::TcpStream;
use std::time::Instant;

use serde_json::{Value, json};
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Bytes, Error, Message, WebSocket};

use super::{Shared, json as text};
use crate::{Command, Sample, Subscription};

/// The longest message that is taken: commands have twenty bytes.
const LONGEST: usize = 1024;
/// The most samples of one message.
const MOST: usize = 1024;
/// How long it waits for samples before it looks whether something was asked.
const NAP: Duration = Duration::from_millis(50);
/// How often it is asked whether the client is still there, and how long it may take to say so.
const PING: Duration = Duration::from_secs(5);
const SILENCE: Duration = Duration::from_secs(20);
/// Messages of a client that are read at a time, so that who only talks is served, too.
const READ: usize = 16;

/// The commands, as long as a connection holds them.
struct Commands<'a>(&'a Shared);

impl<'a> Commands<'a> {
    fn take(shared: &'a Shared) -> Option<Self> {
        (!shared.has_writer.swap(true, Ordering::Relaxed)).then(|| Self(shared))
    }
}

impl Drop for Commands<'_> {
    fn drop(&mut self) {
        self.0.has_writer.store(false, Ordering::Relaxed);
    }
}

/// Serves until the client goes, is too slow for two seconds, or there is no more.
pub(super) fn serve(
    stream: TcpStream,
    early: Vec<u8>,
    shared: &Shared,
    may_command: bool,
    pace: Option<f64>,
) {
    let config = WebSocketConfig::default()
        .max_message_size(Some(LONGEST))
        .max_frame_size(Some(LONGEST))
        .read_buffer_size(LONGEST)
        .write_buffer_size(0);
    let mut socket = WebSocket::from_partially_read(stream, early, Role::Server, Some(config));
    let commands = if may_command { Commands::take(shared) } else { None };
    if let Err(error) = talk(&mut socket, shared, commands.as_ref(), pace) {
        let given_up = matches!(&error, Error::Io(io) if matches!(io.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut));
        shared.given_up.fetch_add(u64::from(given_up), Ordering::Relaxed);
        // Politely, where that is still possible.
        let _ = socket.close(None);
        let _ = socket.flush();
    }
}

fn talk(
    socket: &mut WebSocket<TcpStream>,
    shared: &Shared,
    commands: Option<&Commands<'_>>,
    pace: Option<f64>,
) -> Result<(), Error> {
    let period = pace.map_or(Duration::ZERO, |pace| Duration::from_secs_f64(1.0 / pace));
    let mut reader = shared.hub.subscribe();
    let mut samples = Vec::new();
    let (mut sent, mut pinged, mut heard) = (Instant::now(), Instant::now(), Instant::now());
    socket.send(Message::text(text::hello(shared.hub.about(), commands.is_some())))?;
    while !shared.ends.load(Ordering::Relaxed) {
        std::thread::sleep(period.saturating_sub(sent.elapsed()));
        sent = Instant::now();
        samples.clear();
        let (closed, missed) = gather(&mut reader, &mut samples, socket)?;
        if !samples.is_empty() {
            shared.missed.fetch_add(missed, Ordering::Relaxed);
            socket.send(Message::text(text::samples(&samples, missed)))?;
        } else if closed {
            return socket.close(None);
        }
        if pinged.elapsed() > PING {
            pinged = Instant::now();
            socket.send(Message::Ping(Bytes::new()))?;
        }
        if listen(socket, shared, commands)? {
            heard = Instant::now();
        } else if heard.elapsed() > SILENCE {
            return Err(Error::Io(ErrorKind::TimedOut.into()));
        }
    }
    socket.close(None)
}

/// All samples that are there, or the first that comes; whether there will be no more, and how many were missed.
fn gather(
    reader: &mut Subscription,
    samples: &mut Vec<Sample>,
    socket: &mut WebSocket<TcpStream>,
) -> Result<(bool, u64), Error> {
    let (mut patience, mut missed) = (NAP, 0);
    loop {
        let before = samples.len();
        let mut news = reader.wait(samples, patience);
        if let Some(status) = news.status.take() {
            socket.send(Message::text(text::status(&status)))?;
        }
        missed += news.missed;
        if samples.len() == before || samples.len() >= MOST {
            return Ok((news.closed, missed));
        }
        patience = Duration::ZERO;
    }
}

/// Takes what the client has sent, without waiting for it; whether there was anything.
fn listen(
    socket: &mut WebSocket<TcpStream>,
    shared: &Shared,
    commands: Option<&Commands<'_>>,
) -> Result<bool, Error> {
    socket.get_ref().set_nonblocking(true)?;
    let (mut answers, mut any) = (Vec::new(), false);
    let mut heard = Ok(());
    for _ in 0..READ {
        match socket.read() {
            Ok(message) => {
                any = true;
                if let Message::Text(asked) = message {
                    answers.push(obey(&asked, shared, commands));
                }
            }
            Err(Error::Io(error)) if error.kind() == ErrorKind::WouldBlock => break,
            Err(error) => {
                heard = Err(error);
                break;
            }
        }
    }
    socket.get_ref().set_nonblocking(false)?;
    heard?;
    answers.into_iter().try_for_each(|answer| socket.send(Message::text(answer)))?;
    Ok(any)
}

fn obey(asked: &str, shared: &Shared, commands: Option<&Commands<'_>>) -> String {
    let wanted: Option<Value> = serde_json::from_str(asked).ok();
    let wanted = wanted.as_ref().and_then(|value| value.get("do")).and_then(Value::as_str);
    let command = match wanted {
        Some("tare") => Command::Tare,
        Some("reset") => Command::Reset,
        _ => return json!({"refused": "send {\"do\":\"tare\"} or {\"do\":\"reset\"}"}).to_string(),
    };
    if commands.is_none() {
        let why =
            "this connection only watches: its token is not that of commands, or another one holds them";
        return json!({"refused": why}).to_string();
    }
    shared.hub.ask(command);
    json!({"did": wanted}).to_string()
}
