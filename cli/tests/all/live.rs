//! `fingertip live`, in a pseudo-terminal.
#![cfg(unix)]

use core::time::Duration;
use std::fs::OpenOptions;
use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use serialport::{SerialPort, TTYPort};

use crate::common::{Folder, scene};

/// Longer than a busy machine takes.
const PATIENCE: Duration = Duration::from_secs(100);

/// What stands on a screen of 80 by 24.
struct Screen {
    cells: Vec<Vec<char>>,
    at: (usize, usize),
    /// What came of a sequence whose end is still to come.
    sequence: Option<String>,
}

impl Screen {
    fn new() -> Self {
        Self { cells: vec![vec![' '; 80]; 24], at: (0, 0), sequence: None }
    }

    /// Takes what a program writes: letters, and jumps to a row and a column. Of colours there is nothing to be seen.
    fn write(&mut self, text: &str) {
        for letter in text.chars() {
            if let Some(mut sequence) = self.sequence.take() {
                sequence.push(letter);
                match sequence.strip_prefix('[').and_then(|jump| jump.strip_suffix('H')) {
                    Some(jump) => {
                        let (row, column) = jump.split_once(';').unwrap_or(("1", "1"));
                        self.at = (row.parse::<usize>().unwrap() - 1, column.parse::<usize>().unwrap() - 1);
                    }
                    None if letter.is_ascii_alphabetic() => {}
                    None => self.sequence = Some(sequence),
                }
            } else if letter == '\u{1b}' {
                self.sequence = Some(String::new());
            } else if let Some(cell) = self.cells.get_mut(self.at.0).and_then(|row| row.get_mut(self.at.1)) {
                *cell = letter;
                self.at.1 += 1;
            }
        }
    }

    fn text(&self) -> String {
        self.cells.iter().map(|row| row.iter().collect::<String>() + "\n").collect()
    }
}

/// The command in a terminal, and what it has shown so far.
struct Terminal {
    line: TTYPort,
    child: Child,
    screen: Screen,
    /// Bytes of a letter whose rest is still to come.
    rest: Vec<u8>,
}

impl Terminal {
    fn start(folder: &Folder, arguments: &[&str]) -> Self {
        let (mut line, other) = TTYPort::pair().unwrap();
        line.set_timeout(Duration::from_millis(50)).unwrap();
        let path = other.name().unwrap();
        let size = Command::new("stty").args(["-F", &path, "cols", "80", "rows", "24"]).status().unwrap();
        assert!(size.success());
        let tty = OpenOptions::new().read(true).write(true).open(&path).unwrap();
        let mut command = folder.command(&[&["live"], arguments].concat());
        command.stdin(tty.try_clone().unwrap()).stdout(tty).stderr(Stdio::piped());
        let child = command.spawn().unwrap();
        Self { line, child, screen: Screen::new(), rest: Vec::new() }
    }

    fn read(&mut self) {
        let mut bytes = [0; 4096];
        let Ok(length) = self.line.read(&mut bytes) else { return };
        self.rest.extend_from_slice(&bytes[..length]);
        let whole = match core::str::from_utf8(&self.rest) {
            Ok(text) => text.len(),
            Err(error) => error.valid_up_to(),
        };
        let rest = self.rest.split_off(whole);
        self.screen.write(core::str::from_utf8(&self.rest).unwrap());
        self.rest = rest;
    }

    /// Waits for something to be shown.
    fn until(&mut self, expected: &str) {
        let start = Instant::now();
        while !self.screen.text().contains(expected) {
            assert!(start.elapsed() < PATIENCE, "{expected:?} does not come:\n{}", self.screen.text());
            self.read();
        }
    }

    fn press(&mut self, keys: &[u8]) {
        self.line.write_all(keys).unwrap();
    }

    /// Waits for the end, and gives the exit code and the errors.
    fn finish(mut self) -> (Option<i32>, String) {
        let start = Instant::now();
        let status = loop {
            // What nobody reads would hold the program up.
            self.read();
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
    terminal.until("fx     3.25 N");
    // Any other key does nothing, and a picture that is held can be let go.
    terminal.press(b"x ");
    terminal.until(" held  touch.csv");
    terminal.press(b" ");
    terminal.until("the recording is over");
    terminal.press(b"q");
    assert_eq!(terminal.finish().0, Some(0));
    // A zero of the first 0.15 s.
    let mut terminal = Terminal::start(&folder, &["--replay", "touch.csv", "--speed", "0", "--tare", "0.15"]);
    terminal.until("fx     2.25 N");
    terminal.press(b"q");
    assert_eq!(terminal.finish().0, Some(0));
}

#[test]
fn the_simulation_comes_with_its_scene() {
    let folder = Folder::new();
    let mut terminal = Terminal::start(&folder, &["sim?rate_Hz=200"]);
    terminal.until("Contact (y right, z up)");
    terminal.until(" of µ 0.4");
    terminal.press(b"rt");
    terminal.until("taking the zero");
    terminal.until(" live  sim");
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

/// What of a scene and of its sensor does not count live is said, where the end of the picture leaves it to be read.
#[test]
fn what_does_not_count_is_noted() {
    let folder = Folder::new();
    let gauges = std::fs::read_to_string(scene("gauges.toml")).unwrap();
    let payload = "[payload]\nmass_kg = 0.1\ncentre_of_mass_m = [0.0, 0.0, 0.0]\n";
    let weight =
        "note: the weight of [payload] is not taken off: nothing tells how a live sensor lies or moves\n"
            .to_owned();
    let array = "note: [fusion] is left out: no live sensor gives the readings of an array\n".to_owned();
    let fused = std::fs::read_to_string(scene("gripped_ball.toml")).unwrap();
    let warm = "note: the temperature is known, but the calibration has no terms for it\n".to_owned();
    for (scene, more, said) in [
        (gauges.clone(), &[][..], String::new()),
        (fused, &[], array),
        (format!("{gauges}\n{payload}"), &[], weight.clone()),
        (format!("{gauges}\n{payload}"), &["--celsius", "20"], weight + &warm),
    ] {
        folder.write("scene.toml", &scene);
        let arguments = [&["sim?rate_Hz=200", "--scene", "scene.toml"], more].concat();
        let mut terminal = Terminal::start(&folder, &arguments);
        terminal.until(" live  sim");
        terminal.press(b"q");
        assert_eq!(terminal.finish(), (Some(0), said));
    }
}

/// What a scene hardly means is said once, as by every command that goes by a scene.
#[test]
fn a_doubtful_scene_is_doubted() {
    let folder = Folder::new();
    let plain = std::fs::read_to_string(scene("paper_sphere.toml")).unwrap();
    folder.write("far.toml", &plain.replace("radius_m = 0.013", "radius_m = 13.0"));
    let mut terminal = Terminal::start(&folder, &["sim?rate_Hz=200", "--scene", "far.toml"]);
    terminal.until(" live  sim");
    terminal.press(b"q");
    let (code, said) = terminal.finish();
    let doubt = "warning: `radius_m` of [surface] is 13 m, longer than any fingertip";
    assert!(code == Some(0) && said.matches(doubt).count() == 1, "{code:?} {said}");
}
