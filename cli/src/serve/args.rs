//! The command line of `fingertip simulate`.

use core::net::IpAddr;
use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use fingertip_drivers::devices::{Device, Simulator, devices};
use fingertip_drivers::sensors::FaultPlan;
use fingertip_drivers::sensors::line::LineFaults;

use crate::error::CliError;

/// The devices of the list that can be served.
fn served() -> impl Iterator<Item = &'static Device> {
    let can =
        |device: &&Device| matches!(device.simulator, Some(Simulator::Serial(_) | Simulator::Network(_)));
    devices().iter().copied().filter(can)
}

/// Chooses a device by its name.
fn device() -> impl TypedValueParser<Value = &'static Device> {
    let names = served().map(|device| PossibleValue::new(device.name).help(device.title));
    PossibleValuesParser::new(names)
        .try_map(|name| served().find(|device| device.name == name).ok_or("it cannot be served"))
}

/// What touches the fingertip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Scenario {
    /// The session of `fingertip demo`: presses, a roll, drags that slip; 26 s
    Session,
    /// Presses of 2 N at five points
    Press,
    /// Drags that slip, in four directions
    Slip,
    /// A contact that rolls over the tip under 3 N
    Roll,
    /// Nothing
    Rest,
}

/// What carries a serial protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Carrier {
    /// A pseudo-terminal, whose path is printed
    Pty,
    /// TCP
    Tcp,
}

#[derive(Debug, Args)]
#[command(
    after_help = "The wrench is that about the centre of a sphere of 13 mm: examples/scenes/paper_sphere.toml \
    is its scene. The scenario begins anew with each client, and is repeated.\n\nExample, in two terminals:\n  \
    fingertip simulate --serve ati\n  fingertip live --scene sim 'ati://127.0.0.1:49152?http=…'   (the address is printed)"
)]
pub(crate) struct SimulateArguments {
    /// The device whose protocol is served
    #[arg(long, value_parser = device(), value_name = "DEVICE")]
    pub(crate) serve: &'static Device,
    /// What touches the fingertip
    #[arg(long, value_enum, default_value_t = Scenario::Session, conflicts_with = "script")]
    pub(crate) scenario: Scenario,
    /// A scenario of your own: TOML with a list of [[segments]], each with `do` = rest, press, hold,
    /// squeeze, roll, drag or release
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) script: Option<PathBuf>,
    /// Samples per second
    #[arg(long, value_name = "HZ", default_value_t = 1000.0)]
    pub(crate) rate: f64,
    /// Standard deviation of the noise of each force component [N]; that of torques is 5 mm times this
    #[arg(long, value_name = "N", default_value_t = 0.01)]
    pub(crate) noise: f64,
    /// Seed of noise and faults
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// End after so many seconds; otherwise Ctrl-C ends it
    #[arg(long, value_name = "S")]
    pub(crate) duration: Option<f64>,
    /// The local address to serve on; another than loopback lets other computers in
    #[arg(long, value_name = "IP", default_value = "127.0.0.1")]
    pub(crate) listen: IpAddr,
    /// The port to serve on, 0 for any free one [default: 49152 for ati, otherwise 0]
    #[arg(long, value_name = "PORT")]
    pub(crate) port: Option<u16>,
    /// The port of the HTTP page of ati, 0 for any free one
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    pub(crate) http_port: u16,
    /// The port that schunk sends its samples to, at the client
    #[arg(long, value_name = "PORT", default_value_t = fingertip_drivers::sensors::schunk_fts::UDP_PORT)]
    pub(crate) udp_port: u16,
    /// What carries a serial protocol
    #[arg(long, value_enum, default_value_t = if cfg!(unix) { Carrier::Pty } else { Carrier::Tcp })]
    pub(crate) over: Carrier,
    #[command(flatten)]
    pub(crate) faults: FaultArguments,
}

/// Probabilities from 0 to 1.
#[derive(Clone, Copy, Debug, Args)]
#[command(next_help_heading = "Faults, each with its probability from 0 to 1")]
pub(crate) struct FaultArguments {
    /// A datagram or frame is lost
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    pub(crate) loss: f64,
    /// A datagram comes twice (ati, schunk)
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    pub(crate) duplicate: f64,
    /// A datagram comes behind the next one (ati, schunk)
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    pub(crate) reorder: f64,
    /// A datagram is cut short (ati, schunk)
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    pub(crate) truncate: f64,
    /// A bit of a frame is flipped (serial)
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    pub(crate) bit_flip: f64,
    /// A byte of a frame is lost (serial)
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    pub(crate) lost_byte: f64,
    /// Bytes that mean nothing come before a frame (serial)
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    pub(crate) garbage: f64,
}

impl FaultArguments {
    /// What happens to datagrams.
    pub(super) const fn of_datagrams(&self, seed: u64) -> FaultPlan {
        let Self { loss, duplicate: duplication, reorder, truncate: truncation, .. } = *self;
        FaultPlan { loss, duplication, reorder, truncation, seed }
    }

    /// What happens to frames.
    pub(super) const fn of_frames(&self, seed: u64) -> LineFaults {
        let Self { loss: lost_frame, bit_flip, lost_byte, garbage: noise, .. } = *self;
        LineFaults { bit_flip, lost_byte, lost_frame, noise, seed }
    }

    /// Refuses what is no probability, and faults that the device's link does not have.
    pub(super) fn check(&self, device: &Device) -> Result<(), CliError> {
        let datagrams =
            [("--duplicate", self.duplicate), ("--reorder", self.reorder), ("--truncate", self.truncate)];
        let serial =
            [("--bit-flip", self.bit_flip), ("--lost-byte", self.lost_byte), ("--garbage", self.garbage)];
        let foreign =
            if matches!(device.simulator, Some(Simulator::Network(_))) { &serial } else { &datagrams };
        for (name, chance) in [("--loss", self.loss)].iter().chain(&datagrams).chain(&serial) {
            if !(0.0..=1.0).contains(chance) {
                return Err(CliError::option(name, chance, "is no probability; give one from 0 to 1"));
            }
        }
        match foreign.iter().find(|(_, chance)| *chance > 0.0) {
            Some((name, chance)) => Err(CliError::option(
                name,
                chance,
                "is a fault that the link of this device does not have; see --help",
            )),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use fingertip_drivers::devices::Simulator;

    use super::{FaultArguments, served};

    const NONE: FaultArguments = FaultArguments {
        loss: 0.0,
        duplicate: 0.0,
        reorder: 0.0,
        truncate: 0.0,
        bit_flip: 0.0,
        lost_byte: 0.0,
        garbage: 0.0,
    };

    #[test]
    fn a_link_has_its_own_faults_each_with_a_probability() {
        type Set = fn(&mut FaultArguments) -> &mut f64;
        let all: [(&str, Set, bool, bool); 7] = [
            ("--loss", |faults| &mut faults.loss, true, true),
            ("--duplicate", |faults| &mut faults.duplicate, true, false),
            ("--reorder", |faults| &mut faults.reorder, true, false),
            ("--truncate", |faults| &mut faults.truncate, true, false),
            ("--bit-flip", |faults| &mut faults.bit_flip, false, true),
            ("--lost-byte", |faults| &mut faults.lost_byte, false, true),
            ("--garbage", |faults| &mut faults.garbage, false, true),
        ];
        for (name, set, of_datagrams, of_serial) in all {
            for device in served() {
                let check = |chance: f64| {
                    let mut faults = NONE;
                    *set(&mut faults) = chance;
                    faults.check(device)
                };
                let on_network = matches!(device.simulator, Some(Simulator::Network(_)));
                let has = if on_network { of_datagrams } else { of_serial };
                assert!(check(0.0).is_ok());
                for chance in [1e-9, 1.0] {
                    assert_eq!(check(chance).is_ok(), has, "{name} {chance} of {}", device.name);
                }
                for chance in [-1e-9, 1.000_001, f64::NAN] {
                    let error = check(chance).unwrap_err().to_string();
                    assert!(error.contains(name) && error.contains("is no probability"), "{error}");
                }
            }
        }
        let some = FaultArguments { loss: 0.1, duplicate: 0.2, reorder: 0.3, truncate: 0.4, ..NONE };
        let plan = some.of_datagrams(7);
        let parts = [plan.loss, plan.duplication, plan.reorder, plan.truncation];
        assert_eq!((parts, plan.seed), ([0.1, 0.2, 0.3, 0.4], 7));
        let some = FaultArguments { loss: 0.1, bit_flip: 0.2, lost_byte: 0.3, garbage: 0.4, ..NONE };
        let faults = some.of_frames(7);
        let parts = [faults.lost_frame, faults.bit_flip, faults.lost_byte, faults.noise];
        assert_eq!((parts, faults.seed), ([0.1, 0.2, 0.3, 0.4], 7));
    }
}
