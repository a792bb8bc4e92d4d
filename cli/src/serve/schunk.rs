//! SCHUNK FTS: commands over TCP, samples over UDP.

use core::time::Duration;
use std::thread;

use fingertip_drivers::sensors::schunk_fts::{FtsServer, SimulatedFts};

use super::args::SimulateArguments;
use super::load::Load;
use super::{End, NAP, Played, announce, cannot_bind, died, tally_datagrams};
use crate::error::CliError;

pub(super) fn serve(
    arguments: &SimulateArguments,
    period: Duration,
    load: Load,
    end: &End,
) -> Result<String, CliError> {
    let port = arguments.port.unwrap_or(0);
    let (mut played, samples) = Played::new(load.clone());
    let server = FtsServer::start(
        (arguments.listen, port),
        arguments.udp_port,
        SimulatedFts::new(arguments.faults.of_datagrams(arguments.seed)),
        period,
        move |number| {
            #[expect(clippy::cast_possible_truncation, reason = "the sensor sends single precision")]
            played.next(number).map(|component| component as f32)
        },
    )
    .map_err(cannot_bind("TCP", port))?;
    let address = server.address();
    announce(
        arguments,
        &load,
        &format!("schunk://{address}?udp={}&rate_Hz={}", arguments.udp_port, arguments.rate),
    )?;
    while !end.has_come() {
        thread::sleep(NAP);
    }
    let sensor = server.stop().ok_or_else(died)?;
    Ok(tally_datagrams(&samples, &sensor))
}
