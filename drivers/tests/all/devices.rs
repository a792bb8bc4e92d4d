//! The list of devices: each entry's address, its simulator, its lines in the documentation.

use alloc::collections::BTreeSet;
use alloc::sync::Arc;
use core::net::{IpAddr, Ipv4Addr};
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::io::{Read, Write};
use std::net::{TcpListener, UdpSocket};

use fingertip_drivers::Source;
use fingertip_drivers::devices::{Address, Device, Link, OpenSensor, Serving, Simulator, devices, open};
use fingertip_drivers::sensors::line::{LineFaults, SimulatedSerial};
use fingertip_drivers::sensors::{FaultPlan, Pace};

/// What each simulated sensor feels, in counts without a remainder.
const LOAD: [f64; 6] = [1.0, -2.0, 3.0, 0.1, 0.25, -0.5];

fn named(name: &str) -> Option<&'static Device> {
    devices().iter().copied().find(|device| device.name == name)
}

/// An open sensor of an address gives the load.
fn feels_the_load(address: &str) {
    let mut sensor: OpenSensor = open(&Address::parse(address, devices()).unwrap()).unwrap();
    let wrench = (0..50).find_map(|_| sensor.next_sample().ok().flatten()).expect(address).value;
    for (found, expected) in wrench.components().iter().zip(LOAD) {
        assert!((found - expected).abs() < 0.02, "{address}: {wrench:?}");
    }
}

/// Serves a simulated sensor to one client over TCP, until the flag is set.
fn serve(listener: &TcpListener, mut sensor: SimulatedSerial, stop: &AtomicBool) {
    let (mut client, _) = listener.accept().unwrap();
    client.set_read_timeout(Some(Duration::from_millis(1))).unwrap();
    let mut pace = Pace::new(Duration::from_millis(2));
    let (mut heard, mut said) = ([0; 64], Vec::new());
    while !stop.load(Ordering::Relaxed) {
        let length = client.read(&mut heard).unwrap_or(0);
        sensor.write_all(&heard[..length]).unwrap();
        if pace.is_due() {
            sensor.sample(LOAD);
        }
        said.clear();
        sensor.read_to_end(&mut said).unwrap();
        let _ = client.write(&said);
    }
}

/// A port of this computer that nothing listens on.
fn free_port() -> u16 {
    UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap().port()
}

/// The simulator of an entry stands where the device would, and gives what it is loaded with.
#[test]
fn every_simulator_answers() {
    for device in devices() {
        match device.simulator {
            Some(Simulator::Serial(make)) => {
                let simulated = make(500.0);
                let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
                let place = listener.local_addr().unwrap();
                let stop = Arc::new(AtomicBool::new(false));
                let stopped = Arc::clone(&stop);
                let server = std::thread::spawn(move || {
                    let sensor = SimulatedSerial::new(simulated.device, LineFaults::default());
                    serve(&listener, sensor, &stopped);
                });
                feels_the_load(&format!("{}+tcp://{place}{}", device.name, simulated.options));
                stop.store(true, Ordering::Relaxed);
                server.join().unwrap();
            }
            Some(Simulator::Network(serve)) => {
                let simulator = serve(Serving {
                    listen: IpAddr::V4(Ipv4Addr::LOCALHOST),
                    port: Some(0),
                    http_port: 0,
                    udp_port: free_port(),
                    faults: FaultPlan::default(),
                    rate: 500.0,
                    load: Box::new(|_| LOAD),
                })
                .unwrap();
                feels_the_load(simulator.address());
                assert!(simulator.stop().unwrap().sent > 0);
            }
            // The sensor on a bus and the converters on a bench are played in tests of their own, which must be there.
            Some(Simulator::OnABus) => {
                assert!(file("src/sensors/robotous/can_sensor.rs").contains("SimulatedCan::new"));
            }
            Some(Simulator::OnABench) => {
                let test = file(&format!("tests/all/converters/{}.rs", device.name));
                assert!(test.contains("#[test]") && test.contains("Simulated"), "{}", device.name);
            }
            Some(other) => panic!("{} has a simulator that nothing tries: {other:?}", device.name),
            None => {
                assert_eq!(device.name, "onrobot", "it speaks as the Net F/T does; another needs its own")
            }
        }
    }
}

#[test]
fn every_address_parses_and_names_its_entry() {
    let mut names = BTreeSet::new();
    for device in devices() {
        assert!(names.insert(device.name), "two are called {}", device.name);
        let Some(example) = device.example() else {
            assert!(matches!(device.link, Link::Spi | Link::I2c | Link::Pins), "{}", device.name);
            continue;
        };
        let address = Address::parse(&example, devices()).unwrap();
        assert_eq!((address.device().name, Some(address.place())), (device.name, device.place));
        for option in device.all_options() {
            assert!(
                !option.meaning.is_empty() && !option.example.is_empty(),
                "{} {}",
                device.name,
                option.key
            );
            let text = format!("{}://there?{}={}", device.name, option.key, option.example);
            let address = Address::parse(&text, devices()).unwrap();
            assert_eq!(address.option(option.key), Some(option.example));
        }
    }
    assert!(named("ati").is_some() && named("ads131m").is_some());
}

fn file(path: &str) -> String {
    std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// The lines of the table in this package's README.
fn table() -> String {
    let mut table =
        String::from("| name | device | link | address | what it can say |\n|---|---|---|---|---|\n");
    for device in devices() {
        let link = match device.link {
            Link::Ethernet => "Ethernet".to_owned(),
            Link::Serial { baud } => format!("serial, {baud} baud"),
            Link::Can => "CAN".to_owned(),
            Link::Spi => "SPI".to_owned(),
            Link::I2c => "I²C".to_owned(),
            Link::Pins => "pins".to_owned(),
            other => panic!("{other:?}"),
        };
        let address = device.example().map_or_else(String::new, |example| format!("`{example}`"));
        let options: Vec<String> = device.options.iter().map(|option| format!("`{}`", option.key)).collect();
        let (name, title, options) = (device.name, device.title, options.join(", "));
        table += &format!("| `{name}` | {title} | {link} | {address} | {options} |\n");
    }
    table
}

/// With `FINGERTIP_ACCEPT=1` the table is written anew.
#[test]
fn the_documentation_has_a_line_for_each() {
    let readme = file("README.md");
    let (begin, end) = ("<!-- devices -->\n", "<!-- end of devices -->");
    let (before, rest) = readme.split_once(begin).unwrap();
    let (found, after) = rest.split_once(end).unwrap();
    if std::env::var_os("FINGERTIP_ACCEPT").is_some() {
        let path = format!("{}/README.md", env!("CARGO_MANIFEST_DIR"));
        std::fs::write(path, format!("{before}{begin}{}{end}{after}", table())).unwrap();
    } else {
        assert_eq!(found, table(), "FINGERTIP_ACCEPT=1 writes it anew");
    }
    // Who reads only the front page learns what there is.
    let front = file("../README.md");
    for device in devices() {
        let mut words = device.title.split([' ', ',']).filter(|word| word.len() > 3 && *word != "serial");
        let named = words.any(|word| front.contains(word)) || front.contains(&device.name.to_uppercase());
        assert!(named, "README.md does not name {}", device.title);
    }
}
