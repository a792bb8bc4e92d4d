//! As much of HTTP as one page and a WebSocket take.

use core::sync::atomic::Ordering;
use core::time::Duration;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Instant;

use tungstenite::handshake::derive_accept_key;

use super::guard::{Denied, Right};
use super::{Shared, client, page, tokens};

/// The longest head of a request.
const HEAD: usize = 8192;
const HEADERS: usize = 64;
/// How long a head may take.
const PATIENCE: Duration = Duration::from_secs(3);

/// What is asked, as far as it matters.
#[derive(Debug, Default, PartialEq)]
struct Request {
    path: String,
    token: String,
    /// Messages a second at most.
    pace: Option<f64>,
    host: String,
    origin: Option<String>,
    /// The key of a WebSocket.
    key: Option<String>,
}

/// What a head is.
#[derive(Debug, PartialEq)]
enum Head {
    /// So many bytes of it.
    Whole(Request, usize),
    Unfinished,
    /// No HTTP, or another method or version than is spoken here.
    Bad(&'static str),
}

fn parse(bytes: &[u8]) -> Head {
    let mut headers = [httparse::EMPTY_HEADER; HEADERS];
    let mut head = httparse::Request::new(&mut headers);
    let length = match head.parse(bytes) {
        Ok(httparse::Status::Complete(length)) => length,
        Ok(httparse::Status::Partial) => return Head::Unfinished,
        Err(_) => return Head::Bad("400 Bad Request"),
    };
    if head.method != Some("GET") {
        return Head::Bad("405 Method Not Allowed");
    }
    let target = head.path.unwrap_or_default();
    let (path, query) = target.split_once('?').unwrap_or((target, ""));
    let mut request = Request { path: path.to_owned(), ..Request::default() };
    for (key, value) in query.split('&').filter_map(|pair| pair.split_once('=')) {
        match key {
            "token" => request.token = value.to_owned(),
            "pace" => request.pace = value.parse().ok().filter(|pace: &f64| (1.0..=1000.0).contains(pace)),
            _ => {}
        }
    }
    let (mut upgrades, mut version, mut hosts) = (false, false, 0);
    for header in head.headers.iter() {
        let Ok(value) = core::str::from_utf8(header.value) else { continue };
        let value = value.trim();
        match header.name.to_ascii_lowercase().as_str() {
            "host" => {
                request.host = value.to_owned();
                hosts += 1;
            }
            "origin" => request.origin = Some(value.to_owned()),
            "upgrade" => upgrades = value.eq_ignore_ascii_case("websocket"),
            "sec-websocket-version" => version = value == "13",
            "sec-websocket-key" => request.key = Some(value.to_owned()),
            _ => {}
        }
    }
    if hosts > 1 {
        return Head::Bad("400 Bad Request");
    }
    if !(upgrades && version) {
        request.key = None;
    }
    Head::Whole(request, length)
}

/// Reads the head of a request; what came behind it is given, too.
fn read(stream: &mut TcpStream) -> Result<(Request, Vec<u8>), &'static str> {
    let begun = Instant::now();
    let (mut bytes, mut part) = (Vec::new(), [0; 1024]);
    loop {
        let left = PATIENCE.saturating_sub(begun.elapsed());
        // A read waits for as long as is left for the whole head, however slowly it drips.
        if left.is_zero() || stream.set_read_timeout(Some(left)).is_err() {
            return Err("408 Request Timeout");
        }
        let count = match stream.read(&mut part) {
            Ok(0) => return Err("400 Bad Request"),
            Ok(count) => count,
            Err(_) => return Err("408 Request Timeout"),
        };
        bytes.extend(part.iter().take(count));
        match parse(&bytes) {
            Head::Whole(request, length) => return Ok((request, bytes.split_off(length.min(bytes.len())))),
            Head::Unfinished if bytes.len() >= HEAD => return Err("431 Request Header Fields Too Large"),
            Head::Unfinished => {}
            Head::Bad(status) => return Err(status),
        }
    }
}

fn answer(stream: &mut TcpStream, status: &str, kind: &str, rules: &str, body: &str) {
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {}\r\nConnection: close\r\n\
         Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
         Content-Security-Policy: {rules}\r\n\r\n",
        body.len()
    );
    // Whoever has gone gets no answer.
    let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(body.as_bytes()));
}

/// Without a thread, and so without waiting: what does not go into the buffer of the connection is not sent.
pub(super) fn refuse_at_once(mut stream: TcpStream) {
    if stream.set_nonblocking(true).is_ok() {
        let body = "There are 16 connections already; close one of them.\n";
        answer(&mut stream, "503 Service Unavailable", "text/plain", "default-src 'none'", body);
    }
}

/// Answers one request; a WebSocket until it ends.
pub(super) fn serve(mut stream: TcpStream, shared: &Shared) {
    let refuse = |stream: &mut TcpStream, status: &str, body: &str| {
        shared.refused.fetch_add(1, Ordering::Relaxed);
        answer(stream, status, "text/plain", "default-src 'none'", body);
    };
    let (request, early) = match read(&mut stream) {
        Ok(read) => read,
        Err(status) => return refuse(&mut stream, status, "This is no request that is understood here.\n"),
    };
    if request.path == "/favicon.ico" {
        // Browsers ask by themselves, and without a token: that is nobody who was refused.
        return answer(&mut stream, "404 Not Found", "text/plain", "default-src 'none'", "There is none.\n");
    }
    let right = match shared.guard.admit(&request.token, &request.host, request.origin.as_deref()) {
        Ok(right) => right,
        Err(Denied::Token) => {
            let body =
                "The address has no token, or a wrong one: take it from the terminal of fingertip live.\n";
            return refuse(&mut stream, "403 Forbidden", body);
        }
        Err(Denied::Origin) => {
            let body = "This page or host is not that of fingertip live.\n";
            return refuse(&mut stream, "403 Forbidden", body);
        }
    };
    match (request.path.as_str(), request.key) {
        ("/samples", Some(key)) => {
            let accepted = format!(
                "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
                 Sec-WebSocket-Accept: {}\r\n\r\n",
                derive_accept_key(key.as_bytes())
            );
            if stream.write_all(accepted.as_bytes()).is_ok() {
                shared.streams.fetch_add(1, Ordering::Relaxed);
                client::serve(stream, early, shared, right == Right::Command, request.pace);
            }
        }
        ("/samples", None) => refuse(&mut stream, "426 Upgrade Required", "Samples come over a WebSocket.\n"),
        ("/", _) => match tokens::random() {
            Ok(nonce) => {
                let page = page::page(shared.hub.about(), &shared.view, &nonce);
                answer(&mut stream, "200 OK", "text/html", &page::rules(&nonce), &page);
            }
            Err(error) => refuse(&mut stream, "500 Internal Server Error", &format!("{error}\n")),
        },
        _ => refuse(&mut stream, "404 Not Found", "There is one page here, at /.\n"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Head, Request, parse};

    #[test]
    fn a_head_is_read_as_far_as_it_matters() {
        let text = "GET /samples?token=ab&pace=60 HTTP/1.1\r\nHost: 127.0.0.1:1\r\nORIGIN: http://a \r\n\
            Upgrade: WebSocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: k\r\n\r\nrest";
        let expected = Request {
            path: "/samples".to_owned(),
            token: "ab".to_owned(),
            pace: Some(60.0),
            host: "127.0.0.1:1".to_owned(),
            origin: Some("http://a".to_owned()),
            key: Some("k".to_owned()),
        };
        assert_eq!(parse(text.as_bytes()), Head::Whole(expected, text.len() - 4));
        for end in 0..text.len() - 5 {
            assert_eq!(parse(&text.as_bytes()[..end]), Head::Unfinished, "{end}");
        }
        let of = |text: &str| match parse(text.as_bytes()) {
            Head::Whole(request, _) => request,
            other => panic!("{other:?}"),
        };
        let old = of(&text.replace("13", "12"));
        assert_eq!(old.key, None);
        assert_eq!(of(&text.replace("pace=60", "pace=0.5")).pace, None);
        assert_eq!(of(&text.replace("pace=60", "pace=NaN")).pace, None);
        assert_eq!(parse(b"POST / HTTP/1.1\r\n\r\n"), Head::Bad("405 Method Not Allowed"));
        for bad in ["\u{0}\u{1}", "GET  / HTTP/9\r\n\r\n", "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"] {
            assert_eq!(parse(bad.as_bytes()), Head::Bad("400 Bad Request"), "{bad:?}");
        }
    }

    proptest::proptest! {
        #[test]
        fn any_bytes_are_a_head_or_none(text in "(GET )?[ -~]{0,40}( HTTP/1.1)?(\r\n[ -~]{0,20}){0,70}", raw in proptest::collection::vec(0_u8..=255, 0..200)) {
            let _ = (parse(text.as_bytes()), parse(&raw));
        }
    }
}
