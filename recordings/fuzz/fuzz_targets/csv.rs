//! Recordings in CSV.
#![no_main]

use fingertip_recordings::RecordingReader;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(mut reader) = RecordingReader::new("fuzz.csv", bytes) else { return };
    let sensors = reader.layout().wrenches().to_vec();
    while let Ok(Some(row)) = reader.next_row() {
        for wrench in sensors.iter().filter_map(|sensor| row.wrench(sensor)) {
            assert!(wrench.is_finite());
        }
    }
});
