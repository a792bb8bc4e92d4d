//! MCAP files whose every byte is written here, after the specification of the format.

use std::io::Cursor;

use fingertip_recordings::mcap::{Compression, Entry, McapError, McapReader, Recorded, recover};
use fingertip_test_support::mcap::{
    channel, data_end, definitions, file, message, record, schema, string, wrench,
};
use fingertip_wrench::Wrench;

/// The CRC-32 of zlib, bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 };
        }
    }
    !crc
}

/// A chunk with this checksum.
fn chunk_with(records: &[u8], checksum: u32, compression: &str) -> Vec<u8> {
    let length = (records.len() as u64).to_le_bytes();
    let head = [&[0; 16][..], &length, &checksum.to_le_bytes(), &string(compression), &length].concat();
    record(6, &[&head[..], records].concat())
}

fn chunk(records: &[u8]) -> Vec<u8> {
    chunk_with(records, crc(records), "")
}

fn entries(file: &[u8]) -> Result<Vec<Entry>, McapError> {
    let mut reader = McapReader::new(file)?;
    let mut entries = Vec::new();
    while let Some(entry) = reader.next_entry()? {
        entries.push(entry);
    }
    Ok(entries)
}

fn expected() -> Entry {
    let recorded = Recorded::Wrench(Wrench::from_components(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0].into()));
    Entry { topic: "/tip".to_owned(), time: 3.25, frame: "tip".to_owned(), recorded }
}

#[test]
fn a_message_is_read_in_a_chunk_and_outside_of_one() {
    // The check value that the catalogue of CRCs gives.
    assert_eq!(crc(b"123456789"), 0xCBF4_3926);
    let message = message(1, 0, &wrench());
    let header = record(1, &[string("ros2"), string("by hand")].concat());
    let outside = file(&[header.clone(), definitions(), message.clone(), data_end()]);
    assert_eq!(entries(&outside).unwrap(), [expected()]);
    let records = [definitions(), message.clone(), message.clone()].concat();
    // A record that is not known is passed over, within a chunk and without.
    let inside = file(&[header, chunk(&records), record(0x80, &[1; 9]), chunk(&message), data_end()]);
    assert_eq!(entries(&inside).unwrap(), [expected(), expected(), expected()]);
    // A checksum of zero is none.
    let unchecked = file(&[chunk_with(&records, 0, ""), data_end()]);
    assert_eq!(entries(&unchecked).unwrap().len(), 2);
    // A chunk may be empty; what follows on the end of the data is not read.
    let empty = file(&[chunk(&[]), chunk(&records), data_end(), vec![5, 1]]);
    assert_eq!(entries(&empty).unwrap().len(), 2);
}

#[test]
fn of_a_sound_file_nothing_is_lost() {
    let records = [definitions(), message(1, 0, &wrench()), message(1, 1, &wrench())].concat();
    let whole = file(&[chunk(&records), data_end()]);
    let (recovered, _) = recover(whole.as_slice(), Cursor::new(Vec::new()), Compression::None).unwrap();
    assert_eq!((recovered.messages, recovered.damaged_records, recovered.damaged_chunks), (2, 0, 0));
    assert!(!recovered.cut);
}

/// Found by fuzzing: a chunk that ends in a record which says to be a chunk was opened anew for ever.
#[test]
fn no_chunk_and_no_end_stand_in_a_chunk() {
    for nested in [record(6, &[]), chunk(&message(1, 0, &wrench())), data_end()] {
        let ending = chunk(&[definitions(), message(1, 0, &wrench()), nested.clone()].concat());
        let beginning = chunk(&[nested, message(1, 0, &wrench())].concat());
        let whole = file(&[ending, beginning, data_end()]);
        assert_eq!(entries(&whole).unwrap(), [expected(), expected()]);
        let (recovered, _) =
            recover(Cursor::new(&whole), Cursor::new(Vec::new()), Compression::None).unwrap();
        assert_eq!(recovered.messages, 2);
    }
}

#[test]
fn a_chunk_must_be_whole_and_packed_in_a_known_way() {
    let records = [definitions(), message(1, 0, &wrench())].concat();
    let error = |chunk: Vec<u8>| entries(&file(&[chunk, data_end()])).unwrap_err().to_string();
    let wrong = chunk_with(&records, crc(&records) ^ 1, "");
    assert!(error(wrong).to_lowercase().contains("crc"));
    assert!(error(chunk_with(&records, crc(&records), "brotli")).contains("brotli"));
    // What says that it is packed and is not.
    for packed in ["zstd", "lz4"] {
        assert!(entries(&file(&[chunk_with(&records, crc(&records), packed), data_end()])).is_err());
    }
    let mut longer = chunk(&records);
    // The length of the records, behind 9 bytes of the record and 32 of the chunk, is one less than there are.
    assert_eq!(longer[41..49], (records.len() as u64).to_le_bytes());
    longer[41..49].copy_from_slice(&(records.len() as u64 - 1).to_le_bytes());
    assert!(entries(&file(&[longer, data_end()])).is_err());
    // Each length within the chunk that is cut short.
    for length in [0, 23, 24, 27, 28, 31, 32, 39] {
        assert!(entries(&file(&[record(6, &chunk(&records)[9..9 + length]), data_end()])).is_err());
    }
    // A record in it that says more than the chunk has.
    let mut beyond = records.clone();
    beyond[1] = 0xFF;
    assert!(entries(&file(&[chunk(&beyond), data_end()])).is_err());
    let cut = [definitions(), vec![5, 0, 0]].concat();
    assert!(entries(&file(&[chunk(&cut), data_end()])).is_err());
}

#[test]
fn messages_that_are_not_known_are_passed_over_at_the_time_they_were_logged() {
    let (unknown, json) = (channel(2, 0, "/none", "cdr"), channel(3, 1, "/json", "json"));
    let records = [
        definitions(),
        unknown,
        json,
        message(2, 2_500_000_000, &[1, 2]),
        message(3, 4_000_000_000, &wrench()),
        data_end(),
    ];
    let found = entries(&file(&records)).unwrap();
    let seen: Vec<(&str, f64)> = found.iter().map(|entry| (entry.topic.as_str(), entry.time)).collect();
    assert_eq!(seen, [("/none", 2.5), ("/json", 4.0)]);
    assert!(found.iter().all(|entry| entry.recorded == Recorded::Other && entry.frame.is_empty()));
    // A channel that was never made.
    let error = entries(&file(&[definitions(), message(9, 0, &wrench()), data_end()])).unwrap_err();
    assert!(matches!(error, McapError::File(_)), "{error}");
}

#[test]
fn a_message_that_is_damaged_costs_itself_and_a_file_that_is_damaged_its_rest() {
    let mut short = wrench();
    short.pop();
    let file = file(&[definitions(), message(1, 0, &short), message(1, 0, &wrench()), data_end()]);
    let mut reader = McapReader::new(file.as_slice()).unwrap();
    let error = reader.next_entry().unwrap_err();
    assert!(matches!(&error, McapError::Message { topic, .. } if topic == "/tip"), "{error}");
    assert_eq!(reader.next_entry().unwrap(), Some(expected()));
    assert_eq!(reader.next_entry().unwrap(), None);
    // Without its end the file is an error, and then there is nothing more.
    let cut = &file[..file.len() - 13];
    let mut reader = McapReader::new(cut).unwrap();
    assert!(reader.next_entry().is_err() && reader.next_entry().is_ok());
    assert!(matches!(reader.next_entry(), Err(McapError::Cut)));
    assert_eq!(reader.next_entry().unwrap(), None);
}

/// The contents of a record, with four bytes of it changed.
fn changed(record: &[u8], at: usize, length: u32) -> Vec<u8> {
    let mut changed = record.to_vec();
    changed[9 + at..9 + at + 4].copy_from_slice(&length.to_le_bytes());
    changed
}

#[test]
fn a_length_beyond_its_record_is_an_error_before_anything_is_allocated_for_it() {
    // Where lengths stand in a schema "S" with "ros2msg" and a channel "/t" with "cdr" and two strings.
    let (schema, channel) = (schema(1, "S"), channel(1, 1, "/t", "cdr"));
    let places = [
        (&schema, 2, 1, "the name of a schema"),
        (&schema, 7, 7, "the encoding of a schema"),
        (&schema, 18, 9, "the text of a schema"),
        (&channel, 4, 2, "the topic of a channel"),
        (&channel, 10, 3, "the encoding of a channel"),
        (&channel, 17, 16, "the metadata of a channel"),
        (&channel, 21, 3, "a key of metadata"),
        (&channel, 28, 5, "a value of metadata"),
    ];
    for (record, at, length, expected) in places {
        assert_eq!(record[9 + at..13 + at], u32::to_le_bytes(length), "{expected}");
        let left = record.len() - 9 - at - 4;
        for stated in [left as u32 + 1, 1 << 31, u32::MAX] {
            let damaged = changed(record, at, stated);
            for file in [file(core::slice::from_ref(&damaged)), file(&[chunk(&damaged)])] {
                let mut reader = McapReader::new(file.as_slice()).unwrap();
                let error = reader.next_entry().unwrap_err();
                let McapError::Length { what, stated: said, found } = error else { panic!("{error}") };
                assert_eq!((what, said, found), (expected, stated, left));
                assert_eq!(reader.next_entry().unwrap(), None, "nothing is read behind it");
            }
        }
    }
    // The schema of 13 bytes that asked for 4 GiB.
    let short = file(&[record(3, &[1, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 0, 0, 0])]);
    assert!(matches!(entries(&short), Err(McapError::Length { stated: u32::MAX, found: 7, .. })));
    // Records that end before their lengths.
    for (opcode, length) in [(3, 0), (3, 2), (3, 5), (4, 0), (4, 3), (4, 4), (4, 7)] {
        let error = entries(&file(&[record(opcode, &vec![0; length])])).unwrap_err();
        assert!(matches!(error, McapError::Length { .. }), "{opcode} {length}: {error}");
    }
}

/// A chunk that ends within a record, whose checksum is right or missing, costs what follows in it; what follows the chunk is
/// recovered.
#[test]
fn behind_a_chunk_that_ends_within_a_record_recovery_goes_on() {
    let ending = [definitions(), message(1, 0, &wrench()), vec![5, 0, 0]].concat();
    for cut in [chunk(&ending), chunk_with(&ending, 0, "")] {
        let whole = file(&[cut, chunk(&message(1, 1, &wrench())), data_end()]);
        let (recovered, anew) =
            recover(whole.as_slice(), Cursor::new(Vec::new()), Compression::None).unwrap();
        assert_eq!((recovered.messages, recovered.damaged_chunks, recovered.cut), (2, 1, false));
        assert_eq!(entries(anew.get_ref()).unwrap(), [expected(), expected()]);
    }
}

/// Messages of channels that nothing describes, channels of schemas that nothing does, and records whose lengths cannot be
/// are counted one by one; the rest is recovered.
#[test]
fn records_that_cannot_be_read_are_counted() {
    let damaged = changed(&channel(2, 1, "/t", "cdr"), 4, u32::MAX);
    let parts = [
        definitions(),
        message(9, 0, &wrench()),
        message(1, 0, &wrench()),
        channel(3, 8, "/u", "cdr"),
        message(3, 0, &wrench()),
        damaged,
        message(1, 1, &wrench()),
        data_end(),
    ];
    let (recovered, anew) =
        recover(file(&parts).as_slice(), Cursor::new(Vec::new()), Compression::None).unwrap();
    assert_eq!((recovered.messages, recovered.damaged_records, recovered.damaged_chunks), (2, 4, 0));
    assert!(!recovered.cut);
    assert_eq!(entries(anew.get_ref()).unwrap(), [expected(), expected()]);
}
