//! MCAP files.
#![no_main]

use fingertip_recordings::mcap::McapReader;
use libfuzzer_sys::fuzz_target;

fn read(bytes: &[u8]) {
    let Ok(mut reader) = McapReader::new(bytes) else { return };
    while let Ok(Some(_)) = reader.next_entry() {}
}

fuzz_target!(|bytes: &[u8]| {
    read(bytes);
    // Behind the eight bytes that every file begins with, which chance does not find.
    let mut file = b"\x89MCAP0\r\n".to_vec();
    file.extend_from_slice(bytes);
    read(&file);
});
