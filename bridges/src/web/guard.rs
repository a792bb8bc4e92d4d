//! Who may come in.

use core::net::{IpAddr, SocketAddr};

use super::tokens::Tokens;

/// What a token allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Right {
    Watch,
    Command,
}

/// Why somebody may not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Denied {
    /// No token, or a wrong one.
    Token,
    /// The page that asks is of another origin, or the name that it asks for is none of this computer.
    Origin,
}

/// Compares tokens, hosts and origins.
#[derive(Debug)]
pub(super) struct Guard {
    address: SocketAddr,
    tokens: Tokens,
    /// Whether anybody may command.
    commands: bool,
}

impl Guard {
    pub(super) const fn new(address: SocketAddr, tokens: Tokens, commands: bool) -> Self {
        Self { address, tokens, commands }
    }

    /// What a request may: by its token, by the host that it was sent to, and by the origin of the page that sent it.
    /// Programs send no origin, browsers always do for a WebSocket.
    pub(super) fn admit(&self, token: &str, host: &str, origin: Option<&str>) -> Result<Right, Denied> {
        // A page elsewhere may have a name that leads here: the name betrays it.
        if !self.is_own(host) {
            return Err(Denied::Origin);
        }
        if origin.is_some_and(|origin| origin.strip_prefix("http://") != Some(host)) {
            return Err(Denied::Origin);
        }
        // Both are compared, so that the time tells nothing.
        let (watch, command) = (same(token, self.tokens.watch()), same(token, self.tokens.command()));
        match (watch, command) {
            (_, true) if self.commands => Ok(Right::Command),
            (true, _) | (_, true) => Ok(Right::Watch),
            (false, false) => Err(Denied::Token),
        }
    }

    /// Whether a host with its port is this one: its own address, or a name of loopback; where it listens to
    /// all of them, any address, but no name.
    fn is_own(&self, host: &str) -> bool {
        let port = self.address.port();
        let (name, asked) = match host.rsplit_once(':') {
            Some((name, digits)) if !digits.ends_with(']') => (name, digits.parse().ok()),
            _ => (host, Some(80)),
        };
        if asked != Some(port) {
            return false;
        }
        let own = self.address.ip();
        if name.eq_ignore_ascii_case("localhost") {
            return own.is_loopback() || own.is_unspecified();
        }
        let bare = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
        bare.parse::<IpAddr>().is_ok_and(|asked| asked == own || own.is_unspecified())
    }
}

/// Whether two texts are the same, in a time that does not tell where they differ.
fn same(one: &str, other: &str) -> bool {
    one.len() == other.len() && one.bytes().zip(other.bytes()).fold(0, |sum, (a, b)| sum | (a ^ b)) == 0
}

#[cfg(test)]
mod tests {
    use super::{Denied, Guard, Right, Tokens};

    #[test]
    fn tokens_tell_watching_from_commanding() {
        let tokens = Tokens::random().unwrap();
        let guard = |commands| Guard::new("127.0.0.1:8137".parse().unwrap(), tokens.clone(), commands);
        let admit = |token: &str| guard(true).admit(token, "127.0.0.1:8137", None);
        assert_eq!(admit(tokens.watch()), Ok(Right::Watch));
        assert_eq!(admit(tokens.command()), Ok(Right::Command));
        for token in [tokens.watch(), tokens.command()] {
            assert_eq!(guard(false).admit(token, "127.0.0.1:8137", None), Ok(Right::Watch), "{token}");
        }
        let nearly = |place: usize| {
            let mut bytes = tokens.command().to_owned().into_bytes();
            bytes[place] = if bytes[place] == b'0' { b'1' } else { b'0' };
            String::from_utf8(bytes).unwrap()
        };
        for wrong in
            ["", "x", &tokens.command()[1..], &nearly(0), &nearly(31), &format!("{}0", tokens.watch())]
        {
            assert_eq!(admit(wrong), Err(Denied::Token), "{wrong}");
        }
    }

    #[test]
    fn pages_of_others_are_kept_out() {
        let tokens = Tokens::random().unwrap();
        let admit = |address: &str, host: &str, origin: Option<&str>| {
            Guard::new(address.parse().unwrap(), tokens.clone(), true)
                .admit(tokens.watch(), host, origin)
                .is_ok()
        };
        let own = "127.0.0.1:8137";
        for (host, origin) in [
            (own, None),
            (own, Some("http://127.0.0.1:8137")),
            ("localhost:8137", Some("http://localhost:8137")),
        ] {
            assert!(admit(own, host, origin), "{host} {origin:?}");
        }
        for (host, origin) in [
            (own, Some("http://127.0.0.1:8138")),
            (own, Some("https://127.0.0.1:8137")),
            (own, Some("http://localhost:8137")),
            (own, Some("null")),
            (own, Some("")),
            (own, Some("http://evil.example")),
            ("evil.example:8137", Some("http://evil.example:8137")),
            ("evil.example:8137", None),
            ("127.0.0.1:80", None),
            ("127.0.0.1", None),
            ("", None),
            ("[::1]:8137", None),
        ] {
            assert!(!admit(own, host, origin), "{host} {origin:?}");
        }
        assert!(admit("[::1]:80", "[::1]", None) && admit("[::1]:81", "[::1]:81", Some("http://[::1]:81")));
        assert!(admit("0.0.0.0:81", "10.0.0.7:81", None) && admit("0.0.0.0:81", "localhost:81", None));
        assert!(!admit("0.0.0.0:81", "evil.example:81", None) && !admit("10.0.0.7:81", "localhost:81", None));
    }
}
