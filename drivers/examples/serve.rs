//! Serves a simulated ATI sensor over RDT on the loopback interface, to try a client without hardware:
//! `cargo run --release -p fingertip-drivers --features ati-rdt,simulation --example serve [SECONDS]`

use core::error::Error;
use core::time::Duration;

use fingertip_drivers::ati_rdt::{FaultPlan, RdtClient, RdtServer, SimulatedNetFt};

fn main() -> Result<(), Box<dyn Error>> {
    let seconds: u64 = std::env::args().nth(1).map_or(Ok(60), |text| text.parse())?;
    let port = RdtClient::<f64>::PORT;
    // A fingertip that is pressed with 2 ± 0.5 N, at 1 kHz and a million counts per newton.
    let load = |number: u64| {
        let phase = (number % 1000) as f64 * (core::f64::consts::TAU / 1000.0);
        [0, 0, -2_000_000 - (5e5 * phase.sin()) as i32, 1000, -2000, 3000]
    };
    let sensor = SimulatedNetFt::new(FaultPlan::default());
    let server = RdtServer::start(("127.0.0.1", port), sensor, Duration::from_millis(1), load)?;
    println!("serving on {} for {seconds} s", server.address());
    std::thread::sleep(Duration::from_secs(seconds));
    Ok(())
}
