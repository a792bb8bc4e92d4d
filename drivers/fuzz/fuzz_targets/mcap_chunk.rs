//! MCAP files whose chunks have the right checksums, so that what is in them is read.
#![no_main]

use std::io::Cursor;

use crc::{CRC_32_ISO_HDLC, Crc};
use fingertip_drivers::Source;
use fingertip_drivers::playback::McapPlayback;
use fingertip_recordings::mcap::McapReader;
use libfuzzer_sys::fuzz_target;

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
const NAMES: [&str; 3] =
    ["geometry_msgs/msg/WrenchStamped", "fingertip_msgs/msg/Signals", "tactile_msgs/msg/TactileContact"];

fn record(opcode: u8, contents: &[u8]) -> Vec<u8> {
    [&[opcode][..], &(contents.len() as u64).to_le_bytes(), contents].concat()
}

fn string(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

/// A schema and a channel for each type of message, with numbers from 1.
fn definitions() -> Vec<u8> {
    let mut records = Vec::new();
    for (number, name) in (1_u16..).zip(NAMES) {
        let id = number.to_le_bytes();
        records.extend(record(3, &[&id[..], &string(name), &string("ros2msg"), &string("")].concat()));
        let channel = [&id[..], &id, &string(&format!("/{number}")), &string("cdr"), &[0; 4]].concat();
        records.extend(record(4, &channel));
    }
    records
}

fn read(records: &[u8]) {
    let length = (records.len() as u64).to_le_bytes();
    let head = [&[0; 16][..], &length, &CRC.checksum(records).to_le_bytes(), &[0; 4], &length].concat();
    let chunk = record(6, &[&head[..], records].concat());
    let file = [&b"\x89MCAP0\r\n"[..], &chunk, &record(15, &[0; 4])].concat();
    let Ok(mut reader) = McapReader::new(file.as_slice()) else { panic!("the file begins as it must") };
    // A message that is damaged costs only itself, so there are as many results as records at most.
    let results = (0..=file.len()).take_while(|_| !matches!(reader.next_entry(), Ok(None))).count();
    assert!(results <= file.len() / 9);
    let Ok(mut playback) = McapPlayback::new(Cursor::new(&file), "") else { return };
    while let Ok(Some(sample)) = playback.next_sample() {
        assert!(sample.value.is_finite());
    }
}

fuzz_target!(|bytes: &[u8]| {
    // Any records.
    read(bytes);
    // Behind definitions: any records, and messages of each type with any contents.
    read(&[&definitions()[..], bytes].concat());
    let Some((number, contents)) = bytes.split_first() else { return };
    let head = [&(u16::from(number % 4)).to_le_bytes()[..], &[0; 20]].concat();
    let message = record(5, &[&head[..], contents].concat());
    let plain = record(5, &[&head[..], &[0, 1, 0, 0], contents].concat());
    read(&[&definitions()[..], &message, &plain].concat());
});
