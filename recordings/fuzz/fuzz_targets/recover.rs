//! Damaged MCAP files, of which what is whole is written anew.
#![no_main]

use std::io::Cursor;

use fingertip_recordings::mcap::{Compression, McapReader, Recovered, recover};
use libfuzzer_sys::fuzz_target;

fn recovered(bytes: &[u8], compression: Compression) -> Option<(Recovered, Vec<u8>)> {
    let (found, copy) = recover(bytes, Cursor::new(Vec::new()), compression).ok()?;
    Some((found, copy.into_inner()))
}

fn check(bytes: &[u8], compression: Compression) {
    let Some((found, copy)) = recovered(bytes, compression) else { return };
    assert_eq!(found.topics.values().sum::<u64>(), found.messages);
    // The copy is whole, and holds the same messages.
    let Some((again, _)) = recovered(&copy, Compression::None) else { panic!("the copy is not read") };
    assert!(!again.cut && again.damaged_chunks + again.damaged_records == 0, "{again:?}");
    assert_eq!((again.messages, &again.topics), (found.messages, &found.topics));
    let Ok(mut reader) = McapReader::new(copy.as_slice()) else { panic!("the copy is no MCAP file") };
    while !matches!(reader.next_entry(), Ok(None)) {}
    assert_eq!(reader.messages(), found.messages);
}

fuzz_target!(|bytes: &[u8]| {
    let compression = match bytes.len() % 3 {
        0 => Compression::None,
        1 => Compression::Lz4,
        _ => Compression::Zstd,
    };
    check(bytes, compression);
    // Behind the eight bytes that every file begins with, and the definition of a channel: chance finds neither.
    let channel: &[u8] = b"\x04\x19\0\0\0\0\0\0\0\x01\0\0\0\x01\0\0\0t\x08\0\0\0x-custom\0\0\0\0";
    check(&[b"\x89MCAP0\r\n", channel, bytes].concat(), compression);
});
