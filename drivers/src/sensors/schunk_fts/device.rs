//! The entry of SCHUNK's sensors among the devices.

use super::{FtsClient, FtsServer, SimulatedFts, TCP_PORT, UDP_PORT};
use crate::devices::{
    Address, ConnectError, Device, DeviceOption, Entry, Link, Losses, NetworkSimulator, OpenSensor, REPLY,
    ServeError, Served, Serving, Simulator, source,
};

pub(crate) const ENTRY: Entry = Entry {
    device: Device {
        name: "schunk",
        title: "SCHUNK FTS",
        link: Link::Ethernet,
        place: Some("192.168.0.100"),
        options: &[
            DeviceOption::new("rate_Hz", "8000", "gives samples a time"),
            DeviceOption::new("udp", "54843", "local port that samples come to"),
        ],
        converter: None,
        simulator: Some(Simulator::Network(serve)),
    },
    open,
};

fn open(address: &Address) -> Result<OpenSensor, ConnectError> {
    let host = address.host(TCP_PORT);
    let port: u16 = address.whole("udp")?.unwrap_or(UDP_PORT);
    // The sensor sends to whoever told it to start: only from this machine if it is on this machine.
    let local = if address.host_only() == "127.0.0.1" { "127.0.0.1" } else { "0.0.0.0" };
    let client = FtsClient::connect(host.as_str(), (local, port), REPLY)
        .map_err(|source| ConnectError::Fts { host, port, source })?;
    let client = client.timed_by(address.positive("rate_Hz")?.unwrap_or(0.0));
    Ok(source(client, |client| Losses::of_link(client.statistics())))
}

fn serve(serving: Serving) -> Result<NetworkSimulator, ServeError> {
    let port = serving.port.unwrap_or(0);
    let (period, mut load) = (serving.period(), serving.load);
    let sensor = SimulatedFts::new(serving.faults);
    let server = FtsServer::start((serving.listen, port), serving.udp_port, sensor, period, move |number| {
        #[expect(clippy::cast_possible_truncation, reason = "the sensor sends single precision")]
        load(number).map(|component| component as f32)
    })
    .map_err(|source| ServeError::Port { transport: "TCP", port, source })?;
    let options = format!("?udp={}&rate_Hz={}", serving.udp_port, serving.rate);
    Ok(NetworkSimulator::new(server.address(), (ENTRY.device.name, options), move || {
        let sensor = server.stop()?;
        Some(Served { sent: sensor.sent(), injected: *sensor.injected() })
    }))
}
