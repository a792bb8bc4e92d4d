//! Which devices the command knows: those of the library, and the simulated fingertip in this process.

use core::fmt::Write;

use fingertip_drivers::devices::{Address, AddressError, Device, Link, devices};
use fingertip_simulation::DEVICE as SIMULATED;

use super::error::SensorError;
use super::{Feed, SourceFeed, simulated};

/// The devices of the library, and what this program opens itself.
fn known() -> Vec<&'static Device> {
    let known = devices().iter().copied();
    #[cfg(feature = "ros2")]
    let known = known.chain([&super::ros2::DEVICE]);
    known.chain([&SIMULATED]).collect()
}

/// An address on the command line.
pub(crate) fn address(text: &str) -> Result<Address, AddressError> {
    Address::parse(text, &known())
}

/// Whether it is the simulated fingertip in this process.
pub(crate) fn is_simulated(address: &Address) -> bool {
    address.device().name == SIMULATED.name
}

/// Opens the sensor and lets it stream. No zero is set in any sensor.
pub(crate) fn open(address: &Address) -> Result<Box<dyn Feed>, SensorError> {
    if is_simulated(address) {
        return simulated::open(address);
    }
    #[cfg(feature = "ros2")]
    if super::ros2::is(address) {
        return super::ros2::open(address);
    }
    let losses = |sensor: &fingertip_drivers::devices::OpenSensor| sensor.losses();
    Ok(Box::new(SourceFeed { source: fingertip_drivers::devices::open(address)?, losses }))
}

/// What addresses look like, for the help.
pub(crate) fn help() -> String {
    let mut text = String::from("Addresses of sensors: NAME://PLACE?KEY=VALUE&…\n");
    for device in known() {
        let Some(example) = device.example() else { continue };
        let _ = write!(text, "\n  {example}\n      {}", device.title);
        if let Link::Serial { baud } = device.link {
            let _ = write!(text, ", {baud} baud");
        }
        text.push('\n');
        for option in device.options {
            let needed = if option.needed { "needed: " } else { "" };
            let _ = writeln!(text, "      {}={}  {needed}{}", option.key, option.example, option.meaning);
        }
    }
    text += "\nSerial sensors take ?baud=, and speak over TCP with +tcp, such as bota+tcp://10.0.0.7:4000. Put an \
        address with ? or & in quotes. Where a sensor sends no time, samples have that of their arrival.";
    text
}

#[cfg(test)]
mod tests {
    use fingertip_drivers::devices::devices;

    use super::{address, help, is_simulated, open};

    #[test]
    fn the_help_says_how_each_device_is_addressed() {
        let help = help();
        for device in devices() {
            for option in device.options {
                assert!(help.contains(&format!("{}={}", option.key, option.example)), "{}", option.key);
            }
            let Some(example) = device.example() else { continue };
            assert!(help.contains(&format!("  {example}\n      {}", device.title)), "{example}");
            assert!(!is_simulated(&address(&example).unwrap()));
        }
        assert!(help.contains("such as bota+tcp://10.0.0.7:4000. Put an address with ? or & in quotes."));
        assert!(help.contains("  sim\n") && is_simulated(&address("sim?seed=3").unwrap()));
    }

    #[test]
    fn what_the_simulated_fingertip_cannot_be_is_named() {
        for (text, expected) in [
            ("sim?rate_Hz=-1", "rate_Hz=-1 must be above 0"),
            ("sim?seed=x", "seed=x is not a whole number"),
            ("bota:///no/such?rate_Hz=0", "rate_Hz=0 must be above 0"),
        ] {
            let error = open(&address(text).unwrap()).err().unwrap().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
        assert!(address("bota").unwrap_err().to_string().contains("bota:///dev/ttyUSB0"));
        let known = address("x").unwrap_err().to_string();
        assert!(known.contains("dynpick, optoforce, resense, ") && known.ends_with(", sim"), "{known}");
    }
}
