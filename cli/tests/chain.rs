//! The whole chain: a simulated sensor is served, recorded, converted and analysed, by the command itself.
//! A program apart from the other tests, so that none of them takes the processor from a sensor that sends.
#![allow(clippy::unwrap_used, reason = "helpers of tests, which may fail so")]

mod common;

use core::time::Duration;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};

use common::{Contacts, Folder, scene, unused_port};

/// Nothing for 0.2 s, then 2 N at 30° from the top.
const SCRIPT: &str = "[[segments]]\ndo = 'rest'\nduration = 0.2\n\
    [[segments]]\ndo = 'press'\nat = { from_top = 0.5235987755982988, azimuth = 0.0 }\nforce = 2.0\nduration = 0.05\n\
    [[segments]]\ndo = 'hold'\nduration = 100.0\n";
/// The load of the hold: 2 N against the normal (cos 30°, sin 30°, 0), through the centre.
const HELD: [f64; 6] = [-1.732_050_807_568_877_2, -1.0, 0.0, 0.0, 0.0, 0.0];

/// A server that ends with the test.
struct Server {
    child: Child,
    address: String,
}

impl Server {
    fn start(folder: &Folder, arguments: &[&str]) -> Self {
        let mut all = vec!["simulate", "--duration", "300"];
        all.extend(arguments);
        let mut child = folder.command(&all).stdout(Stdio::piped()).spawn().unwrap();
        let lines = BufReader::new(child.stdout.as_mut().unwrap()).lines();
        let address =
            lines.map(Result::unwrap).find_map(|line| line.strip_prefix("Address: ").map(str::to_owned));
        Self { child, address: address.unwrap() }
    }
}

#[cfg(unix)]
impl Server {
    /// Ends it as Ctrl-C does, and gives its last words.
    fn finish(mut self) -> String {
        interrupt(&self.child);
        let mut said = String::new();
        self.child.stdout.take().unwrap().read_to_string(&mut said).unwrap();
        assert!(self.child.wait().unwrap().success());
        said
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Asks a program to end, as Ctrl-C does.
#[cfg(unix)]
fn interrupt(child: &Child) {
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
}

/// The number before a word of what was said.
fn number_before(said: &str, word: &str) -> f64 {
    let (before, _) = said.split_once(&format!(" {word}")).unwrap();
    before.rsplit([' ', ',', '\n']).next().unwrap().parse().unwrap()
}

/// Records what is served, however long a busy machine lets the sensor be silent.
fn record(folder: &Folder, server: &Server, arguments: &[&str]) -> String {
    folder.succeed(&[&["record", &server.address, "--silence", "60"], arguments].concat())
}

/// Serves a device, records some samples, and looks at them: all there, at rest first, then under the load to
/// within what the device can say.
fn recorded(device: &str, more: &[&str], tolerance: f64) -> String {
    let folder = Folder::new();
    folder.write("script.toml", SCRIPT);
    let mut arguments = vec!["--serve", device, "--script", "script.toml", "--rate", "1000", "--noise", "0"];
    arguments.extend(more);
    let server = Server::start(&folder, &arguments);
    let said = record(&folder, &server, &["-o", "out.csv", "--samples", "600"]);
    assert!(said.starts_with("600 samples in "), "{device}: {said}");
    let rows = Contacts::parse(&folder.read("out.csv"));
    assert_eq!(rows.len(), 600, "{device}");
    // The script begins anew with each client that asks.
    if !more.contains(&"pty") {
        record(&folder, &server, &["-o", "again.csv", "--samples", "5"]);
        let again = Contacts::parse(&folder.read("again.csv"));
        let forces = ["fx_N", "fy_N", "fz_N"].map(|name| again.numbers(name)[0]);
        assert!(forces.iter().all(|force| force.abs() <= tolerance), "{device}: {forces:?}");
    }
    let times = rows.numbers("t_s");
    assert_eq!(times[0], 0.0);
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{device}");
    for (name, held) in ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"].iter().zip(HELD) {
        let values = rows.numbers(name);
        let (first, last) = (values[0], values[599]);
        assert!(
            first.abs() <= tolerance && (last - held).abs() <= tolerance,
            "{device} {name}: {first} {last}"
        );
    }
    said
}

#[test]
fn what_is_served_over_ethernet_is_recorded() {
    let said = recorded("ati", &["--port", "0"], 1e-6);
    assert!(said.contains("Link: 0 lost, 0 late, 0 repeated, 0 damaged"), "{said}");
    let port = unused_port().to_string();
    let said = recorded("schunk", &["--udp-port", &port], 1e-6);
    assert!(said.contains("Link: 0 lost"), "{said}");
}

#[test]
fn what_is_served_over_serial_protocols_is_recorded() {
    // Half a count, and the single precision of those who send it.
    let devices =
        [("bota", 1e-6), ("robotous", 0.0101), ("dynpick", 0.0126), ("optoforce", 0.0051), ("resense", 1e-6)];
    let threads = devices.map(|(device, tolerance)| {
        std::thread::spawn(move || recorded(device, &["--over", "tcp"], tolerance))
    });
    let said = threads.map(|thread| thread.join().unwrap());
    assert!(
        said[1].contains("lost: not told") && said[1].contains("Times are those of arrival"),
        "{}",
        said[1]
    );
    assert!(said[0].contains("Link: 0 lost, 0 late, 0 repeated, 0 damaged"), "{}", said[0]);
    assert!(said[3].contains("Link: 0 lost, 0 late, 0 repeated, 0 damaged"), "{}", said[3]);
}

#[test]
#[cfg(unix)]
fn a_pseudo_terminal_is_a_serial_port() {
    for device in ["bota", "dynpick"] {
        recorded(device, &["--over", "pty"], 0.0126);
    }
}

#[test]
fn losses_are_counted_exactly() {
    let port = unused_port().to_string();
    for device in [&["--serve", "ati", "--port", "0"][..], &["--serve", "schunk", "--udp-port", &port]] {
        let folder = Folder::new();
        let faults = ["--loss", "0.1", "--duplicate", "0.05", "--reorder", "0.05", "--truncate", "0.02"];
        let server = Server::start(&folder, &[device, &faults].concat());
        let said = record(&folder, &server, &["-o", "out.csv", "--samples", "1000"]);
        let number = |word: &str| number_before(&said, word);
        let lost = number("lost");
        // 1000 samples are given of some 1200 sent. 12 % are lost or cut, 5 % come twice, 5 % of those whose next
        // one comes whole are late, 2 % are cut: four standard deviations about 144, 60, 51 and 24.
        assert!((98.0..190.0).contains(&lost) && (30.0..90.0).contains(&number("repeated")), "{said}");
        assert!((23.0..79.0).contains(&number("late")) && (5.0..43.0).contains(&number("damaged")), "{said}");
        // The sensor's count of records goes on over those that are lost: so does the time.
        let rows = Contacts::parse(&folder.read("out.csv"));
        let times = rows.numbers("t_s");
        let passed_over = (lost + number("late")) / 1000.0;
        assert!((times[999] - 0.999 - passed_over).abs() < 1e-9, "{} s: {said}", times[999]);
    }
    // Where the sensor sends no number, its times tell.
    let folder = Folder::new();
    let server = Server::start(&folder, &["--serve", "bota", "--over", "tcp", "--loss", "0.1"]);
    let said = record(&folder, &server, &["-o", "out.csv", "--samples", "1000"]);
    let lost = number_before(&said, "lost");
    let last = Contacts::parse(&folder.read("out.csv")).numbers("t_s")[999];
    // Four standard deviations about 111.
    assert!((66.0..156.0).contains(&lost) && (last - 0.999 - lost / 1000.0).abs() < 1e-6, "{last}: {said}");
}

/// The chance of each serial fault, and what of it comes through: nothing but what was sent.
#[test]
#[cfg(unix)]
fn damaged_frames_are_noticed_and_passed_over() {
    let folder = Folder::new();
    folder.write("script.toml", SCRIPT);
    let faults = ["--bit-flip", "0.1", "--lost-byte", "0.05", "--garbage", "0.1", "--loss", "0.05"];
    let serve = ["--serve", "bota", "--over", "tcp", "--script", "script.toml", "--noise", "0"];
    let server = Server::start(&folder, &[&serve[..], &faults].concat());
    let said = record(&folder, &server, &["-o", "out.csv", "--samples", "600"]);
    // Of some 750 frames 10 % have a flipped bit, 5 % lack a byte, and 10 % come behind bytes that mean nothing.
    assert!(number_before(&said, "damaged") + number_before(&said, "lost") > 80.0, "{said}");
    assert!(said.contains(" bytes skipped"), "{said}");
    let rows = Contacts::parse(&folder.read("out.csv"));
    let held = rows.numbers("t_s").iter().filter(|time| **time > 0.26).count();
    assert!(held > 200, "{held}");
    for (name, held) in ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"].iter().zip(HELD) {
        for (value, time) in rows.numbers(name).iter().zip(rows.numbers("t_s")) {
            // At rest, on the way, or under the load.
            let within = (held.min(0.0) - 1e-6..=held.max(0.0) + 1e-6).contains(value);
            assert!(within && (time < 0.26 || (value - held).abs() < 1e-6), "{name} at {time} s: {value}");
        }
    }
    let told = server.finish().replace('\u{202f}', "");
    // 18.8 % of the frames are lost, or have a flipped bit or lack a byte: four standard deviations of 1.4 %.
    let (samples, damaged) = (number_before(told.trim_start(), "samples"), number_before(&told, "damaged"));
    assert!(samples >= 600.0 && (0.13..0.25).contains(&(damaged / samples)), "{told}");
}

/// What a browser, and the client of this library, is told of the sensor.
#[test]
fn the_page_of_an_ethernet_sensor_is_served() {
    let folder = Folder::new();
    let server = Server::start(&folder, &["--serve", "ati", "--port", "0", "--rate", "250"]);
    let (_, port) = server.address.split_once("?http=").unwrap();
    let ask = |pieces: &[&str]| {
        let mut stream = TcpStream::connect(("127.0.0.1", port.parse().unwrap())).unwrap();
        for piece in pieces {
            stream.write_all(piece.as_bytes()).unwrap();
        }
        let mut page = String::new();
        stream.read_to_string(&mut page).unwrap();
        page
    };
    let page = ask(&["GET /netft", "api2.xml HTTP/1.0\r\n", "\r\n"]);
    assert!(page.starts_with("HTTP/1.0 200") && page.contains("<cfgcpf>1000000"), "{page}");
    assert!(ask(&["GET / HTTP/1.0\r\n\r\n"]).starts_with("HTTP/1.0 404"));
}

#[test]
fn served_recorded_converted_and_analysed() {
    let folder = Folder::new();
    let script = SCRIPT.replace("duration = 0.2", "duration = 1.1");
    folder.write("script.toml", &script);
    let server = Server::start(
        &folder,
        &["--serve", "ati", "--port", "0", "--script", "script.toml", "--noise", "0.002"],
    );
    let said = record(&folder, &server, &["-o", "a.csv", "--duration", "1.6", "--scene", "sim"]);
    assert!(said.contains("1\u{202f}601 samples in 1.6 s") && said.contains("with a contact"), "{said}");
    // The contacts of the recording itself: 30° from the top of a sphere of 13 mm.
    let expected = [13e-3 * 0.866_025_403_784_438_6, 6.5e-3, 0.0];
    let rows = Contacts::parse(&folder.read("a.csv"));
    for (name, place) in ["contact_x_m", "contact_y_m", "contact_z_m"].iter().zip(expected) {
        let values = rows.numbers(name);
        assert!(values[0].is_nan() && (values[1600] - place).abs() < 1e-4, "{name}: {}", values[1600]);
    }
    // There and back again, without any loss.
    let said = folder.succeed(&["convert", "a.csv", "a.mcap"]);
    assert!(said.contains("1\u{202f}601 wrenches") && said.contains("Nothing was lost"), "{said}");
    let said = folder.succeed(&["convert", "a.mcap", "b.csv"]);
    assert!(said.contains("Nothing was lost"), "{said}");
    assert_eq!(folder.read("b.csv"), folder.read("a.csv"));
    // The same contacts once more, from the wrenches.
    let paper = scene("paper_sphere.toml");
    folder.succeed(&["analyze", "b.csv", "--scene", &paper, "--output", "c.csv", "--no-report"]);
    let contacts = Contacts::parse(&folder.read("c.csv"));
    assert_eq!(contacts.len(), 1601);
    assert_eq!((contacts.words("status")[0], contacts.words("status")[1600]), ("rest", "contact"));
    for (name, place) in ["x_m", "y_m", "z_m"].iter().zip(expected) {
        assert!((contacts.numbers(name)[1600] - place).abs() < 1e-4);
    }
    assert!((contacts.numbers("normal_N")[1600] - 2.0).abs() < 0.02);
}

/// Records the simulation in the process itself, with volts, and interrupts it so many milliseconds after the file
/// is there. Gives the number of samples that it says it has written.
#[cfg(unix)]
fn interrupted(folder: &Folder, file: &str, milliseconds: u64) -> usize {
    let _ = std::fs::remove_file(folder.path(file));
    let mut command = folder.command(&["record", "sim", "-o", file]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    while !folder.has_begun(file) && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(Duration::from_millis(milliseconds));
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    let said = String::from_utf8(output.stdout).unwrap();
    let (samples, _) = said.split_once(" samples in").unwrap();
    samples.replace('\u{202f}', "").parse().unwrap()
}

#[test]
#[cfg(unix)]
fn an_interrupted_recording_is_whole() {
    let folder = Folder::new();
    for file in ["a.mcap", "a.csv"] {
        // Some samples, as fast as this machine is.
        let enough = |milliseconds: u32| interrupted(&folder, file, 1 << milliseconds) > 100;
        assert!((8..16).any(enough), "{file}");
    }
    let said = folder.succeed(&["convert", "a.mcap", "b.csv"]);
    assert!(said.contains("signals") && said.contains("wrenches"), "{said}");
    let (a, b) = (Contacts::parse(&folder.read("a.csv")), Contacts::parse(&folder.read("b.csv")));
    assert!(a.len() > 100 && b.len() > 100);
    let mut columns = ["v1_V", "dummy_V", "fx_N", "tz_Nm"].iter();
    assert!(columns.all(|column| a.numbers(column)[50] == b.numbers(column)[50]));
}

#[test]
fn a_zero_is_taken_off_only_on_request() {
    let folder = Folder::new();
    folder.write(
        "script.toml",
        &SCRIPT
            .replace(
                "'rest'\nduration = 0.2",
                "'press'\nat = { from_top = 0.0, azimuth = 0.0 }\nforce = 1.0\nduration = 0.05",
            )
            .replace("do = 'press'\nat = { from_top = 0.5", "do = 'roll'\nto = { from_top = 0.5")
            .replace("force = 2.0\n", ""),
    );
    let server = Server::start(
        &folder,
        &["--serve", "bota", "--over", "tcp", "--script", "script.toml", "--noise", "0"],
    );
    let last = |file: &str, more: &[&str]| {
        let said = record(&folder, &server, &[&["-o", file, "--samples", "100"], more].concat());
        (Contacts::parse(&folder.read(file)).numbers("fx_N")[99], said)
    };
    // The load stands at 1 N from the first tenth of a second on, turned by 30° by then.
    let (tared, said) = last("tared.csv", &["--tare", "0.3"]);
    assert!(said.contains("Zero taken off") && tared.abs() < 0.2, "{tared} {said}");
    let (plain, said) = last("plain.csv", &[]);
    assert!(!said.contains("Zero") && (plain + 0.866).abs() < 0.2, "{plain}");
}

/// A client that goes without having asked for anything makes room for the next.
#[test]
fn one_client_after_another_is_served() {
    let folder = Folder::new();
    folder.write("script.toml", SCRIPT);
    let server = Server::start(&folder, &["--serve", "dynpick", "--over", "tcp", "--script", "script.toml"]);
    let place = server.address.split("://").nth(1).unwrap().split('?').next().unwrap();
    for _ in 0..2 {
        drop(TcpStream::connect(place).unwrap());
        let said = record(&folder, &server, &["-o", "some.csv", "--samples", "20", "--force"]);
        assert!(said.starts_with("20 samples in "), "{said}");
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let folder = Folder::new();
    folder.write(
        "old.csv",
        "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,mood\n0.5,0,0,-1,0,0,0,3\n1.0,0,0,,0,0,0,4\n",
    );
    let cases: [(i32, &[&str], &str); 12] = [
        (2, &["record", "carrier-pigeon://coop"], "no protocol that is known"),
        (2, &["record", "bota"], "where is the sensor"),
        (1, &["record", "sim", "-o", "out.xyz"], "neither .csv nor .mcap"),
        (1, &["record", "sim", "-o", "old.csv", "--samples", "1"], "--overwrite"),
        (1, &["record", "bota:///no/such/port"], "/no/such/port"),
        (1, &["record", "optoforce:///dev/null"], "counts_per_N is needed"),
        (1, &["record", "ati://127.0.0.1?http=1"], "?counts_per_N="),
        (
            1,
            &["record", "ati://127.0.0.1:9?counts_per_N=1&counts_per_Nm=1", "--silence", "0.3"],
            "127.0.0.1:9",
        ),
        (1, &["simulate", "--serve", "ati", "--bit-flip", "0.1"], "--bit-flip"),
        (1, &["simulate", "--serve", "bota", "--rate", "0"], "--rate"),
        (1, &["convert", "old.csv", "new.csv"], "the same kind"),
        (1, &["live"], "needs a terminal"),
    ];
    for (code, arguments, expected) in cases {
        let error = folder.fail(code, arguments);
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
    assert!(folder.read("old.csv").contains("mood"));
    // What a format cannot hold is named.
    let said = folder.succeed(&["convert", "old.csv", "new.mcap"]);
    assert!(
        said.contains("1 wrenches") && said.contains("mood") && said.contains("1 samples of which"),
        "{said}"
    );
}
