//! A recording that is read ahead, on a thread of its own.

use core::ops::ControlFlow;
use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use fingertip_recordings::RowBlock;
use fingertip_recordings::health::Health;

use crate::error::CliError;
use crate::health::WatchedRows;
use crate::opened::Rows;

/// Rows of a block, and values of all of them, at most: some tens of kilobytes, however wide a recording is.
const ROWS: usize = 1024;
const VALUES: usize = 8192;
/// Blocks that are read ahead at most: memory does not grow with the recording.
const BLOCKS: usize = 3;
/// What the thread that reads needs for its calls is far less, of whatever format \[bytes\].
const STACK: usize = 512 << 10;

/// Reads a recording to its end, or until `each` has enough, and looks at the health of its sensor, while `each` works on
/// blocks of its rows in their order on this thread.
///
/// # Errors
/// The first one that reading row by row would meet: what `each` says of a row comes before what reading says of a later
/// one.
pub(super) fn read(
    reader: &mut Rows,
    watched: WatchedRows,
    mut each: impl FnMut(&RowBlock) -> Result<ControlFlow<()>, CliError>,
) -> Result<Health, CliError> {
    let (full, blocks) = sync_channel(BLOCKS);
    let (used, free) = sync_channel(BLOCKS + 2);
    thread::scope(|scope| {
        let file = reader.file().to_owned();
        let reading = thread::Builder::new()
            .stack_size(STACK)
            .spawn_scoped(scope, move || read_ahead(reader, watched, &full, &free))
            .map_err(|source| CliError::read("recording", Path::new(&file), source))?;
        let mut has_enough = false;
        for block in blocks {
            has_enough = each(&block)?.is_break();
            if has_enough {
                break;
            }
            // At the end nobody takes it.
            let _ = used.send(block);
        }
        match reading.join() {
            // What is wrong behind what was asked for does not matter.
            Ok((watched, read)) => (if has_enough { Ok(()) } else { read }).map(|()| watched.finish()),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}

/// How many rows of so many columns a block has.
fn rows_of_block(columns: usize) -> usize {
    ROWS.min(VALUES / columns.max(1)).max(1)
}

/// Sends blocks until the recording ends or nobody takes them.
fn read_ahead(
    reader: &mut Rows,
    mut watched: WatchedRows,
    full: &SyncSender<RowBlock>,
    free: &Receiver<RowBlock>,
) -> (WatchedRows, Result<(), CliError>) {
    let rows = rows_of_block(reader.layout().columns().len());
    loop {
        let mut block = free.try_recv().unwrap_or_default();
        let more = reader.read_block(&mut block, rows);
        block.rows().for_each(|row| watched.add(&row));
        // The rows before a bad one are worked on before it is told.
        let is_taken = block.is_empty() || full.send(block).is_ok();
        match more {
            Ok(true) if is_taken => {}
            more => return (watched, more.map(drop).map_err(CliError::from)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{VALUES, rows_of_block};

    #[test]
    fn a_block_is_as_large_however_wide_a_recording_is() {
        for (columns, rows) in [(0, 1024), (1, 1024), (8, 1024), (9, 910), (64, 128), (100_000, 1)] {
            assert_eq!(rows_of_block(columns), rows, "{columns} columns");
        }
        assert!((1..=VALUES).all(|columns| rows_of_block(columns) * columns <= VALUES));
    }
}
