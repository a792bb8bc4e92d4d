//! MCAP files.
#![no_main]

use fingertip_drivers::recording::mcap::McapReader;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(mut reader) = McapReader::new(bytes) else { return };
    while let Ok(Some(_)) = reader.next_entry() {}
});
