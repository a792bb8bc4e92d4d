//! The entries of ATI's and OnRobot's sensors among the devices.

use super::page_server::serve_page;
use super::{Configuration, CountsPerUnit, RdtClient, RdtServer, SimulatedNetFt};
use crate::devices::{
    Address, ConnectError, Device, DeviceOption, Entry, Link, Losses, NetworkSimulator, OpenSensor, REPLY,
    ServeError, Served, Serving, Simulator, WAIT, counts_per_unit, source,
};

pub(crate) const NET_FT: Entry = Entry {
    device: Device {
        name: "ati",
        title: "ATI Net F/T, Axia",
        link: Link::Ethernet,
        place: Some("192.168.1.1"),
        options: &[
            DeviceOption::new("counts_per_N", "1e6", "without it the sensor's page is asked over HTTP"),
            DeviceOption::new("counts_per_Nm", "1e6", "as counts_per_N"),
            DeviceOption::new(
                "rate_Hz",
                "7000",
                "gives samples a time; without it that of the page, if it is asked",
            ),
            DeviceOption::new("http", "80", "port of the page"),
        ],
        converter: None,
        simulator: Some(Simulator::Network(serve)),
    },
    open,
};

pub(crate) const ONROBOT: Entry = Entry {
    device: Device {
        name: "onrobot",
        title: "OnRobot (OptoForce) EtherDAQ",
        link: Link::Ethernet,
        place: Some("192.168.1.1"),
        options: &[DeviceOption::new("rate_Hz", "500", "gives samples a time")],
        converter: None,
        simulator: None,
    },
    open: |address| connect(address, CountsPerUnit::onrobot()?, address.positive("rate_Hz")?),
};

/// Counts per newton and per newton metre, as most sensors are delivered.
const COUNTS: f64 = 1e6;

fn open(address: &Address) -> Result<OpenSensor, ConnectError> {
    let rate = address.positive("rate_Hz")?;
    if let Some([force, torque]) = counts_per_unit(address)? {
        return connect(address, CountsPerUnit::new(force, torque)?, rate);
    }
    let port: u16 = address.whole("http")?.unwrap_or(80);
    let page = format!("{}:{port}", address.host_only());
    let configuration = RdtClient::<f64>::configuration(page.as_str(), REPLY)
        .map_err(|source| ConnectError::Page { page, source })?;
    connect(address, configuration.counts()?, rate.or(configuration.rate))
}

fn connect(
    address: &Address,
    counts: CountsPerUnit<f64>,
    rate: Option<f64>,
) -> Result<OpenSensor, ConnectError> {
    let host = address.host(RdtClient::<f64>::PORT);
    let client = RdtClient::connect(host.as_str(), counts, WAIT)
        .map_err(|source| ConnectError::Rdt { host, source })?;
    Ok(source(client.timed_by(rate.unwrap_or(0.0)), |client| Losses::of_link(client.statistics())))
}

fn serve(serving: Serving) -> Result<NetworkSimulator, ServeError> {
    let configuration = Configuration {
        counts_per_newton: COUNTS,
        counts_per_newton_metre: COUNTS,
        rate: Some(serving.rate),
    };
    let page = serve_page((serving.listen, serving.http_port), configuration)
        .map_err(|source| ServeError::Page { port: serving.http_port, source })?;
    let port = serving.port.unwrap_or(RdtClient::<f64>::PORT);
    let (period, mut load) = (serving.period(), serving.load);
    let sensor = SimulatedNetFt::new(serving.faults);
    let server = RdtServer::start((serving.listen, port), sensor, period, move |number| {
        load(number).map(|component| rounded(component * COUNTS))
    })
    .map_err(|source| ServeError::Port { transport: "UDP", port, source })?;
    let options = format!("?http={}", page.address().port());
    Ok(NetworkSimulator::new(server.address(), ("ati", options), move || {
        drop(page);
        let sensor = server.stop()?;
        Some(Served { sent: sensor.sent(), injected: *sensor.injected() })
    }))
}

#[expect(clippy::cast_possible_truncation, reason = "saturates, as a converter does")]
fn rounded(counts: f64) -> i32 {
    counts.round() as i32
}
