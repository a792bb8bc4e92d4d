//! Opens the sensor of an address.

use fingertip_drivers::sensors::AxisCounts;
use fingertip_drivers::sensors::ati_rdt::{CountsPerUnit, RdtClient};
use fingertip_drivers::sensors::bota_serial::BotaDecoder;
use fingertip_drivers::sensors::dynpick::{self, DynPickDecoder, Sensitivities};
use fingertip_drivers::sensors::optoforce::{self, OptoForceDecoder};
use fingertip_drivers::sensors::resense::{Limits, ResenseDecoder};
use fingertip_drivers::sensors::robotous::{Request, RobotousDecoder};
use fingertip_drivers::sensors::schunk_fts::{self, FtsClient};

use super::address::{Address, Protocol};
#[cfg(target_os = "linux")]
use super::can;
use super::line::{self, Line, WAIT};
use super::losses::Losses;
use super::timed::Timed;
use super::{Feed, SourceFeed, simulated};

/// Opens the sensor and lets it stream. No zero is set in any sensor.
pub(crate) fn open(address: &Address) -> Result<Box<dyn Feed>, String> {
    match address.protocol {
        Protocol::Ati => ati(address),
        Protocol::OnRobot => {
            rdt(address, CountsPerUnit::onrobot().map_err(text)?, address.positive("rate_Hz")?)
        }
        Protocol::Schunk => schunk(address),
        Protocol::Bota => {
            let rate = address.positive("rate_Hz")?;
            let feed = line::streaming(line::open(address, 460_800)?, BotaDecoder::new(), &[], |_| None)?;
            Ok(match rate {
                Some(rate) => Box::new(Timed::new(feed, rate)),
                None => feed,
            })
        }
        Protocol::Robotous => {
            let decoder = RobotousDecoder::new(robotous_counts(address)?);
            let line = line::open(address, 115_200)?;
            line::streaming(line, decoder, &Request::Stream.emit_serial(), |_| None)
        }
        #[cfg(target_os = "linux")]
        Protocol::RobotousCan => can::robotous(address, robotous_counts(address)?),
        #[cfg(not(target_os = "linux"))]
        Protocol::RobotousCan => Err("CAN can be spoken on Linux only (SocketCAN)".to_owned()),
        Protocol::DynPick => dynpick(address),
        Protocol::OptoForce => optoforce(address),
        Protocol::Resense => resense(address),
        Protocol::Simulated => simulated::open(address),
    }
}

/// Counts of the RFT60 unless others are stated.
fn robotous_counts(address: &Address) -> Result<AxisCounts, String> {
    counts(address)?.map_or_else(|| AxisCounts::uniform(50.0, 2000.0).map_err(text), Ok)
}

fn text(error: impl core::fmt::Display) -> String {
    error.to_string()
}

/// Counts per unit that the address states: both or none.
fn counts(address: &Address) -> Result<Option<AxisCounts>, String> {
    match (address.positive("counts_per_N")?, address.positive("counts_per_Nm")?) {
        (Some(force), Some(torque)) => AxisCounts::uniform(force, torque).map(Some).map_err(text),
        (None, None) => Ok(None),
        _ => Err("counts_per_N and counts_per_Nm belong together; state both".to_owned()),
    }
}

fn ati(address: &Address) -> Result<Box<dyn Feed>, String> {
    let rate = address.positive("rate_Hz")?;
    let stated = (address.positive("counts_per_N")?, address.positive("counts_per_Nm")?);
    match stated {
        (Some(force), Some(torque)) => rdt(address, CountsPerUnit::new(force, torque).map_err(text)?, rate),
        (None, None) => {
            let port: u16 = address.whole("http")?.unwrap_or(80);
            let page = format!("{}:{port}", address.host_only());
            let configuration =
                RdtClient::<f64>::configuration(page.as_str(), 10 * WAIT).map_err(|error| {
                    format!(
                        "cannot read the sensor's counts per newton from http://{page}/netftapi2.xml: {error}; state \
                         them in the address: ?counts_per_N=1e6&counts_per_Nm=1e6"
                    )
                })?;
            rdt(address, configuration.counts().map_err(text)?, rate.or(configuration.rate))
        }
        _ => Err("counts_per_N and counts_per_Nm belong together; state both".to_owned()),
    }
}

fn rdt(address: &Address, counts: CountsPerUnit<f64>, rate: Option<f64>) -> Result<Box<dyn Feed>, String> {
    let host = address.host(RdtClient::<f64>::PORT);
    let client = RdtClient::connect(host.as_str(), counts, WAIT)
        .map_err(|error| format!("cannot reach {host}: {error}; check the address and the network"))?;
    let source = client.timed_by(rate.unwrap_or(0.0));
    Ok(Box::new(SourceFeed {
        source,
        losses: |client: &RdtClient<f64>| Losses::of_link(client.statistics()),
    }))
}

fn schunk(address: &Address) -> Result<Box<dyn Feed>, String> {
    let host = address.host(schunk_fts::TCP_PORT);
    let port: u16 = address.whole("udp")?.unwrap_or(schunk_fts::UDP_PORT);
    // The sensor sends to whoever told it to start: only from this machine if it is on this machine.
    let local = if address.host_only() == "127.0.0.1" { "127.0.0.1" } else { "0.0.0.0" };
    let client = FtsClient::connect(host.as_str(), (local, port), 10 * WAIT).map_err(|error| {
        format!("cannot start {host}, with samples to UDP port {port} here: {error}; check the address and the ports")
    })?;
    let source = client.timed_by(address.positive("rate_Hz")?.unwrap_or(0.0));
    Ok(Box::new(SourceFeed { source, losses: |client: &FtsClient| Losses::of_link(client.statistics()) }))
}

fn dynpick(address: &Address) -> Result<Box<dyn Feed>, String> {
    let mut line = line::open(address, 921_600)?;
    let counts = match counts(address)? {
        Some(counts) => counts,
        None => {
            let answer = ask(&mut *line, &[dynpick::REQUEST_SENSITIVITIES]);
            let answer = answer.map_err(|error| format!("cannot ask for the sensitivities: {error}"))?;
            Sensitivities::parse(&answer)
                .map_err(|error| {
                    format!(
                        "the sensor does not tell its sensitivities ({error}); state them from its data sheet: \
                         ?counts_per_N=24.9&counts_per_Nm=1664"
                    )
                })?
                .counts()
        }
    };
    let missing = |decoder: &DynPickDecoder| Some(decoder.missing());
    Ok(line::asked(line, DynPickDecoder::new(counts), vec![dynpick::REQUEST], missing))
}

/// Sends a request and reads one line of text, as far as it comes in time.
fn ask(line: &mut dyn Line, request: &[u8]) -> std::io::Result<Vec<u8>> {
    line.write_all(request)?;
    let mut answer = Vec::new();
    let mut byte = [0];
    while answer.len() < 200 && answer.last() != Some(&b'\n') {
        match line.read(&mut byte) {
            Ok(0) => break,
            Ok(_) => answer.extend(byte),
            Err(error)
                if matches!(error.kind(), std::io::ErrorKind::TimedOut | std::io::ErrorKind::WouldBlock) =>
            {
                break;
            }
            Err(error) => return Err(error),
        }
    }
    Ok(answer)
}

fn optoforce(address: &Address) -> Result<Box<dyn Feed>, String> {
    let report = "it stands in the sensor's sensitivity report";
    let counts = AxisCounts::uniform(
        address.needed("counts_per_N", report)?,
        address.needed("counts_per_Nm", report)?,
    )
    .map_err(text)?;
    let start = match address.whole::<u32>("rate_Hz")? {
        None => Vec::new(),
        Some(rate) => {
            let rate = match rate {
                1000 => optoforce::Rate::Hz1000,
                333 => optoforce::Rate::Hz333,
                100 => optoforce::Rate::Hz100,
                30 => optoforce::Rate::Hz30,
                10 => optoforce::Rate::Hz10,
                other => return Err(format!("rate_Hz={other}: the sensor has 1000, 333, 100, 30 and 10")),
            };
            let filter = optoforce::Filter::None;
            optoforce::Configuration { rate, filter, zero: false }.emit().to_vec()
        }
    };
    let line = line::open(address, 1_000_000)?;
    line::streaming(line, OptoForceDecoder::new(counts), &start, |decoder| Some(decoder.missing()))
}

fn resense(address: &Address) -> Result<Box<dyn Feed>, String> {
    let range = "readings beyond it show that the line is out of step; take the sensor's range with reserve";
    #[expect(clippy::cast_possible_truncation, reason = "a limit")]
    let limits = Limits {
        force: address.needed("greatest_N", range)? as f32,
        torque: address.needed("greatest_Nm", range)? as f32,
        temperature: [-40.0, 125.0],
        temperature_step: 5.0,
    };
    let decoder = ResenseDecoder::new(limits);
    let request = address.option("request").map(bytes).transpose()?;
    let line = line::open(address, 2_000_000)?;
    match request {
        Some(request) => Ok(line::asked(line, decoder, request, |_| None)),
        None => line::streaming(line, decoder, &[], |_| None),
    }
}

/// Bytes from hexadecimal digits.
fn bytes(digits: &str) -> Result<Vec<u8>, String> {
    let wrong = || format!("request={digits} must be hexadecimal digits, two for each byte");
    if digits.is_empty() || !digits.len().is_multiple_of(2) {
        return Err(wrong());
    }
    (0..digits.len())
        .step_by(2)
        .map(|at| digits.get(at..at + 2).and_then(|pair| u8::from_str_radix(pair, 16).ok()).ok_or_else(wrong))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::io::{self, Read, Write};

    use super::super::address::Address;
    use super::super::line::{Line, asked, streaming};
    use super::super::{Feed, Next};
    use super::{DynPickDecoder, ask, bytes, counts, open};
    use fingertip_drivers::sensors::AxisCounts;

    /// A device that has so much to say, a few bytes at a time, and then keeps silent or fails.
    struct Told {
        says: Vec<u8>,
        then: io::ErrorKind,
    }

    impl Read for Told {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            if self.says.is_empty() {
                return Err(self.then.into());
            }
            let length = buffer.len().min(3).min(self.says.len());
            buffer[..length].copy_from_slice(&self.says[..length]);
            self.says.drain(..length);
            Ok(length)
        }
    }

    impl Write for Told {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.then == io::ErrorKind::BrokenPipe { Err(self.then.into()) } else { Ok(bytes.len()) }
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn told(says: &[u8], then: io::ErrorKind) -> Told {
        Told { says: says.to_vec(), then }
    }

    #[test]
    fn an_answer_is_a_line_of_text_or_as_much_as_comes() {
        use io::ErrorKind::{BrokenPipe, PermissionDenied, TimedOut, WouldBlock};
        let answer = |says: &[u8], then| ask(&mut told(says, then), b"p");
        assert_eq!(answer(b"24.9,24.9\nmore", PermissionDenied).unwrap(), b"24.9,24.9\n");
        for silent in [TimedOut, WouldBlock] {
            assert_eq!(answer(b"24.9", silent).unwrap(), b"24.9");
            assert_eq!(answer(b"", silent).unwrap(), b"");
        }
        // A device that never ends its line is cut short.
        assert_eq!(answer(&[b'7'; 500], PermissionDenied).unwrap(), [b'7'; 200]);
        assert_eq!(answer(b"24", PermissionDenied).unwrap_err().kind(), PermissionDenied);
        assert_eq!(answer(b"24", BrokenPipe).unwrap_err().kind(), BrokenPipe);
    }

    #[test]
    fn requests_that_are_not_answered_are_lost() {
        let decoder = || DynPickDecoder::new(AxisCounts::uniform(40.0, 1640.0).unwrap());
        let line = || Box::new(told(b"", io::ErrorKind::TimedOut)) as Box<dyn Line>;
        let mut feed = asked(line(), decoder(), b"R".to_vec(), |_| Some(1));
        assert_eq!(feed.losses().lost, Some(1));
        for expected in 1..5 {
            assert!(matches!(feed.next(), Ok(Next::Silence)));
            assert_eq!(feed.losses().lost, Some(expected));
        }
        let mut gone =
            asked(Box::new(told(b"", io::ErrorKind::BrokenPipe)), decoder(), b"R".to_vec(), |_| None);
        assert!(gone.next().unwrap_err().starts_with("cannot ask the sensor"));
        assert_eq!(gone.losses().lost, Some(0));
        // One that streams by itself tells what its decoder knows.
        let feed: Box<dyn Feed> = streaming(line(), decoder(), b"S", |_| Some(7)).unwrap();
        assert_eq!(feed.losses().lost, Some(7));
        let broken = streaming(Box::new(told(b"", io::ErrorKind::BrokenPipe)), decoder(), b"S", |_| None);
        assert!(broken.err().unwrap().starts_with("cannot tell the sensor to start"));
    }

    #[test]
    fn bytes_are_pairs_of_hexadecimal_digits() {
        assert_eq!(bytes("3A0a00ff"), Ok(vec![0x3a, 0x0a, 0x00, 0xff]));
        for wrong in ["", "3", "3A0", "3G", "ä", "+1"] {
            assert_eq!(
                bytes(wrong).is_ok(),
                // `from_str_radix` takes a sign.
                wrong == "+1",
                "{wrong}"
            );
        }
    }

    #[test]
    fn what_an_address_lacks_or_has_too_much_is_named() {
        for (address, expected) in [
            ("robotous:///dev/null?counts_per_N=5", "belong together"),
            ("ati://127.0.0.1:9?counts_per_N=5", "belong together"),
            ("dynpick:///no/such?counts_per_N=5&counts_per_Nm=7", "cannot open /no/such at 921600 baud"),
            ("dynpick:///no/such", "cannot open /no/such at 921600 baud"),
            ("robotous:///no/such", "cannot open /no/such at 115200 baud"),
            ("bota:///no/such?baud=9600", "cannot open /no/such at 9600 baud"),
            ("bota:///no/such?rate_Hz=0", "rate_Hz=0 must be above 0"),
            ("optoforce:///no/such?counts_per_N=5", "counts_per_Nm is needed"),
            ("optoforce:///no/such?counts_per_N=5&counts_per_Nm=5&rate_Hz=50", "1000, 333, 100, 30 and 10"),
            ("optoforce:///no/such?counts_per_N=5&counts_per_Nm=5&rate_Hz=333", "at 1000000 baud"),
            ("resense:///no/such?greatest_N=5", "greatest_Nm is needed"),
            ("resense:///no/such?greatest_N=5&greatest_Nm=1&request=3", "two for each byte"),
            ("resense:///no/such?greatest_N=5&greatest_Nm=1", "at 2000000 baud"),
            ("bota+tcp://127.0.0.1:1", "cannot connect to 127.0.0.1:1"),
            ("sim?rate_Hz=-1", "rate_Hz=-1 must be above 0"),
            ("sim?seed=x", "seed=x is not a whole number"),
        ] {
            let error = open(&address.parse::<Address>().unwrap()).err().unwrap();
            assert!(error.contains(expected), "{address}: {error}");
        }
        let both: Address = "robotous:///x?counts_per_N=5&counts_per_Nm=7".parse().unwrap();
        assert_eq!(counts(&both).unwrap(), Some(AxisCounts::uniform(5.0, 7.0).unwrap()));
    }
}
