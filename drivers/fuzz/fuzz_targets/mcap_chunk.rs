//! MCAP files whose chunks have the right checksums, so that what is in them is read; plain and packed.
#![no_main]

use std::io::{Cursor, Write};

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

/// A file of one chunk, which stands in the file as `stored` and has so many bytes and this checksum when it is unpacked.
fn file(packing: &str, stored: &[u8], unpacked: u64, checksum: u32) -> Vec<u8> {
    let head = [&[0; 16][..], &unpacked.to_le_bytes(), &checksum.to_le_bytes(), &string(packing)].concat();
    let chunk = record(6, &[&head[..], &(stored.len() as u64).to_le_bytes(), stored].concat());
    [&b"\x89MCAP0\r\n"[..], &chunk, &record(15, &[0; 4])].concat()
}

/// A file whose chunk holds these records, packed as the number says.
fn packed(records: &[u8], packing: u8) -> Vec<u8> {
    let (length, checksum) = (records.len() as u64, CRC.checksum(records));
    match packing % 3 {
        0 => file("", records, length, checksum),
        1 => {
            let mut encoder = lz4::EncoderBuilder::new().build(Vec::new()).expect("it has memory");
            encoder.write_all(records).expect("memory can be written");
            file("lz4", &encoder.finish().0, length, checksum)
        }
        _ => {
            let stored = zstd::bulk::compress(records, 1).expect("it has memory");
            file("zstd", &stored, length, checksum)
        }
    }
}

/// Reads a file whose chunk has so many bytes, once unpacked.
fn read_file(file: &[u8], unpacked: usize) {
    let Ok(mut reader) = McapReader::new(file) else { panic!("the file begins as it must") };
    // A message that is damaged costs only itself, so there are as many results as records at most, and an end.
    let most = (file.len() + unpacked) / 9;
    let results = (0..=most).take_while(|_| !matches!(reader.next_entry(), Ok(None))).count();
    assert!(results <= most);
}

fn read(records: &[u8], packing: u8) {
    let file = packed(records, packing);
    read_file(&file, records.len());
    let Ok(mut playback) = McapPlayback::new(Cursor::new(&file), "") else { return };
    while let Ok(Some(sample)) = playback.next_sample() {
        assert!(sample.value.is_finite());
    }
}

fuzz_target!(|bytes: &[u8]| {
    let Some((number, contents)) = bytes.split_first() else { return };
    // Any records.
    read(contents, number / 4);
    // Behind definitions: any records, and messages of each type with any contents.
    read(&[&definitions()[..], contents].concat(), number / 4);
    let head = [&(u16::from(number % 4)).to_le_bytes()[..], &[0; 20]].concat();
    let message = record(5, &[&head[..], contents].concat());
    let plain = record(5, &[&head[..], &[0, 1, 0, 0], contents].concat());
    read(&[&definitions()[..], &message, &plain].concat(), number / 4);
    // What is packed is any bytes, which say that they are this long; 0 is no checksum.
    let Some((length, stored)) = contents.split_first_chunk::<4>() else { return };
    let length = u32::from_le_bytes(*length);
    let packing = if number % 2 == 0 { "lz4" } else { "zstd" };
    read_file(&file(packing, stored, length.into(), 0), length as usize);
});
