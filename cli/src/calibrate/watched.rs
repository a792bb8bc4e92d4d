//! Loads that are read, while another thread looks at what the readings tell of the sensor.

use std::path::Path;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;

use fingertip_calibration::file::SignalUnit;
use fingertip_calibration::loads::{LoadReader, LoadRow, LoadTable};
use fingertip_recordings::health::Health;

use super::files::{bad, of_reading, open};
use crate::error::CliError;
use crate::health::of_gauges;

/// Rows that are handed over at once.
const ROWS: usize = 4096;
/// Blocks that may wait.
const WAITING: usize = 4;

/// A table of known loads; columns that are not used go to `notes`. With what its readings tell of the sensor, or `None` if
/// the system gives no other thread to look.
pub(super) fn read(
    path: &Path,
    range: Option<[f64; 2]>,
    notes: &mut Vec<String>,
) -> Result<(LoadTable, Option<Health>), CliError> {
    let fault = |error: &dyn core::fmt::Display| bad(path, &error);
    let mut reader = LoadReader::new(open("table of loads", path)?).map_err(|error| fault(&error))?;
    let (gauges, unit) = (reader.gauges(), reader.signal_unit());
    let (table, health) = thread::scope(|scope| {
        let (blocks, given) = sync_channel::<Vec<f64>>(WAITING);
        let watch = move || watched(&given, gauges, unit, range);
        let watcher = thread::Builder::new().name("health".to_owned()).spawn_scoped(scope, watch).ok();
        let mut block = Vec::new();
        let each = |row: &LoadRow| {
            block.extend_from_slice(&row.signals);
            if block.len() >= ROWS * gauges {
                // Where nobody looks, nobody is told.
                let _ = blocks.send(core::mem::take(&mut block));
                block.reserve(ROWS * gauges);
            }
        };
        let table = LoadTable::from_reader_with(&mut reader, each);
        let _ = blocks.send(block);
        drop(blocks);
        (table, watcher.and_then(|watcher| watcher.join().ok()))
    });
    notes.extend(of_reading(path, &reader));
    Ok((table.map_err(|error| fault(&error))?, health))
}

fn watched(blocks: &Receiver<Vec<f64>>, gauges: usize, unit: SignalUnit, range: Option<[f64; 2]>) -> Health {
    let mut watch = of_gauges(gauges, unit, range);
    for block in blocks {
        block.chunks_exact(gauges.max(1)).for_each(|readings| watch.add(None, readings));
    }
    watch.finish()
}
