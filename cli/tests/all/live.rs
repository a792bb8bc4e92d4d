//! `fingertip live`, in a pseudo-terminal.
#![cfg(unix)]

use core::time::Duration;
use std::fs::OpenOptions;
use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use serialport::{SerialPort, TTYPort};

use crate::common::Folder;

/// Longer than a busy machine takes.
const PATIENCE: Duration = Duration::from_secs(100);

/// The command in a terminal of 80 by 24, and what it has shown so far.
struct Terminal {
    screen: TTYPort,
    child: Child,
    shown: String,
}

impl Terminal {
    fn start(folder: &Folder, arguments: &[&str]) -> Self {
        let (mut screen, line) = TTYPort::pair().unwrap();
        screen.set_timeout(Duration::from_millis(50)).unwrap();
        let path = line.name().unwrap();
        let size = Command::new("stty").args(["-F", &path, "cols", "80", "rows", "24"]).status().unwrap();
        assert!(size.success());
        let tty = OpenOptions::new().read(true).write(true).open(&path).unwrap();
        let mut command = folder.command(&[&["live"], arguments].concat());
        command.stdin(tty.try_clone().unwrap()).stdout(tty).stderr(Stdio::piped());
        let child = command.spawn().unwrap();
        Self { screen, child, shown: String::new() }
    }

    /// Waits for something to be shown, and forgets what came before it.
    fn until(&mut self, expected: &str) {
        let start = Instant::now();
        let mut bytes = [0; 4096];
        while !self.shown.contains(expected) {
            assert!(start.elapsed() < PATIENCE, "{expected:?} does not come:\n{}", self.shown);
            if let Ok(length) = self.screen.read(&mut bytes) {
                self.shown.push_str(&String::from_utf8_lossy(&bytes[..length]));
            }
        }
        self.shown.clear();
    }

    fn press(&mut self, keys: &[u8]) {
        self.screen.write_all(keys).unwrap();
    }

    /// Waits for the end, and gives the exit code and the errors.
    fn finish(mut self) -> (Option<i32>, String) {
        let start = Instant::now();
        let mut bytes = [0; 4096];
        let status = loop {
            // What nobody reads would hold the program up.
            let _ = self.screen.read(&mut bytes);
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(start.elapsed() < PATIENCE, "it does not end");
        };
        let mut said = String::new();
        self.child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        (status.code(), said)
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

const ROWS: &str =
    "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,1,0,0,0,0,0\n0.1,1,0,0,0,0,0\n0.2,3.25,0,0,0,0,0\n";

#[test]
fn a_recording_is_shown_until_somebody_has_seen_enough() {
    let folder = Folder::new();
    folder.write("touch.csv", ROWS);
    for keys in [&b"q"[..], b"\x1b", b"\x03"] {
        let mut terminal = Terminal::start(&folder, &["--replay", "touch.csv", "--speed", "10"]);
        terminal.until("the recording is over");
        terminal.press(keys);
        assert_eq!(terminal.finish(), (Some(0), String::new()), "{keys:?}");
    }
    let mut terminal = Terminal::start(&folder, &["--replay", "touch.csv", "--speed", "0"]);
    terminal.until("3.25 N");
    // Any other key does nothing, and a picture that is held can be let go.
    terminal.press(b"x ");
    terminal.until("held");
    terminal.press(b" ");
    terminal.until("over");
    terminal.press(b"q");
    assert_eq!(terminal.finish().0, Some(0));
    // A zero of the first 0.15 s.
    let mut terminal = Terminal::start(&folder, &["--replay", "touch.csv", "--speed", "0", "--tare", "0.15"]);
    terminal.until("2.25 N");
    terminal.press(b"q");
    assert_eq!(terminal.finish().0, Some(0));
}

#[test]
fn the_simulation_comes_with_its_scene() {
    let folder = Folder::new();
    let mut terminal = Terminal::start(&folder, &["sim?rate_Hz=200"]);
    terminal.until("Contact (y right, z up)");
    terminal.press(b"rt");
    terminal.until("taking the zero");
    terminal.until("live");
    terminal.press(b"q");
    assert_eq!(terminal.finish(), (Some(0), String::new()));
}

#[test]
fn what_is_wrong_is_said_before_the_terminal_is_taken() {
    let folder = Folder::new();
    folder.write("touch.csv", ROWS);
    for (arguments, expected) in [
        (&["--frames=0"][..], "--frames 0 must be above 0"),
        (&["--frames=1001"], "up to 1000"),
        (&["--tare=0"], "--tare 0 must be a number of seconds above 0"),
        (&["--tare=inf"], "--tare inf must be"),
        (&["--replay", "none.csv"], "none.csv"),
        (&["--scene", "none.toml"], "none.toml"),
        (&["ati://127.0.0.1:9", "--calibration", "cal.toml"], "this sensor gives wrenches"),
        (&["--calibration", "none.toml"], "none.toml"),
        (&["bota:///no/such"], "cannot open /no/such"),
    ] {
        let (code, said) = Terminal::start(&folder, arguments).finish();
        assert!(
            code == Some(1) && said.starts_with("error: ") && said.contains(expected),
            "{arguments:?}: {said}"
        );
    }
}
