//! Wrenches of a driver of ROS 2.

use core::net::{IpAddr, Ipv4Addr};

use fingertip_bridges::ros2::{Options, WrenchSource};
use fingertip_drivers::devices::{Device, DeviceOption, Link};

use super::{Address, Feed, Losses, SensorError, SourceFeed};

pub(super) const DEVICE: Device = Device {
    name: "ros2",
    title: "geometry_msgs/msg/WrenchStamped of any driver of ROS 2",
    link: Link::Program,
    place: Some("/ft_sensor/wrench"),
    options: &[
        DeviceOption::new("domain", "7", "without it ROS_DOMAIN_ID, or 0"),
        DeviceOption::new("interface", "10.0.0.3", "address of the network interface; without it loopback"),
    ],
    converter: None,
    simulator: None,
};

pub(super) fn is(address: &Address) -> bool {
    address.device().name == DEVICE.name
}

/// The domain of the environment.
pub(crate) fn ros_domain() -> Result<u16, String> {
    match std::env::var("ROS_DOMAIN_ID") {
        Ok(text) if !text.is_empty() => {
            text.parse().map_err(|_| format!("ROS_DOMAIN_ID is “{text}”; give a number from 0 to 232"))
        }
        _ => Ok(0),
    }
}

/// Subscribes. What is lost on the way DDS does not tell.
pub(super) fn open(address: &Address) -> Result<Box<dyn Feed>, SensorError> {
    let domain = match address.whole("domain")? {
        Some(domain) => domain,
        None => ros_domain().map_err(|why| SensorError::Source(why.into()))?,
    };
    let interface = match address.option("interface") {
        Some(text) => text.parse::<IpAddr>().map_err(|_| {
            SensorError::Source(format!("interface={text} is no address, such as 10.0.0.3").into())
        })?,
        None => Ipv4Addr::LOCALHOST.into(),
    };
    let options = Options { domain, interface, ..Options::default() };
    let source = WrenchSource::open(address.place(), &options);
    let source = source.map_err(|error| SensorError::Source(Box::new(error)))?;
    Ok(Box::new(SourceFeed { source, losses: |_: &WrenchSource| Losses::default() }))
}

#[cfg(test)]
mod tests {
    use super::super::{address, open};

    #[test]
    fn a_topic_that_is_none_is_named() {
        for (text, expected) in [
            ("ros2://", "is no name of ROS 2"),
            ("ros2:///a//b", "is no name of ROS 2"),
            ("ros2:///a?interface=x", "interface=x is no address"),
            ("ros2:///a?domain=x", "domain=x is not a whole number"),
            ("ros2:///a?domain=233", "domain 233 is none"),
            ("ros2:///a?interface=192.0.2.1", "no network interface here has the address 192.0.2.1"),
        ] {
            let error = open(&address(text).unwrap()).err().unwrap().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
