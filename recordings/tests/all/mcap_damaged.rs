//! MCAP files that are packed, cut or damaged.

use std::io::Cursor;

use fingertip_recordings::mcap::{
    Compression, McapError, McapReader, McapWriter, Recorded, RecordedSignals, recover,
};
use proptest::prelude::*;

const ALL: [Compression; 3] = [Compression::None, Compression::Lz4, Compression::Zstd];

/// A file with so many messages: numbers that count up, which a packer does not make vanish.
fn file(messages: u32, compression: Compression) -> Vec<u8> {
    let mut writer = McapWriter::with_compression(Cursor::new(Vec::new()), compression).unwrap();
    let topic = writer.signals("/daq", "tip").unwrap();
    for k in 0..messages {
        let values = (0..40).map(|i| f64::from(k) * 1.37 + f64::from(i) * 0.618).collect();
        let signals = RecordedSignals { unit: "V".to_owned(), values };
        writer.write_signals(topic, f64::from(k) / 8.0, signals).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// Messages up to the end or the first error, in their order and whole.
fn read(file: &[u8]) -> (u32, Option<McapError>) {
    let mut reader = match McapReader::new(file) {
        Ok(reader) => reader,
        Err(error) => return (0, Some(error)),
    };
    let mut messages = 0;
    loop {
        match reader.next_entry() {
            Ok(Some(entry)) => {
                assert_eq!(entry.time, f64::from(messages) / 8.0);
                let Recorded::Signals(signals) = entry.recorded else { panic!("another message") };
                assert_eq!((signals.values.len(), signals.values[0]), (40, f64::from(messages) * 1.37));
                messages += 1;
            }
            Ok(None) => return (messages, None),
            Err(error) => {
                assert!(matches!(reader.next_entry(), Ok(None)), "more behind {error}");
                return (messages, Some(error));
            }
        }
    }
}

/// Where the first chunk of a file begins: it is the first record behind the header.
fn first_chunk(file: &[u8]) -> usize {
    let at = 8 + 9 + usize::try_from(u64::from_le_bytes(file[9..17].try_into().unwrap())).unwrap();
    assert_eq!(file[at], 6);
    at
}

#[test]
fn packed_files_are_read_as_plain_ones() {
    let sizes = ALL.map(|compression| {
        let file = file(5000, compression);
        let (messages, error) = read(&file);
        assert!(messages == 5000 && error.is_none(), "{compression:?}: {messages}, {error:?}");
        file.len()
    });
    let [plain, lz4, zstd] = sizes;
    assert!(lz4 < plain && zstd < plain, "{sizes:?}");
}

/// A file that was cut is read up to the last message that is whole, wherever it was cut; and written anew it is whole.
#[test]
fn cut_files_are_read_as_far_as_they_are_whole() {
    for compression in ALL {
        let whole = file(5000, compression);
        let mut last = 0;
        for share in 1..40 {
            let cut = &whole[..whole.len() * share / 40];
            let (messages, error) = read(cut);
            // The index at the end says nothing new.
            assert!(matches!(error, Some(McapError::Cut) | None), "{compression:?} {share}: {error:?}");
            assert!(messages >= last, "{compression:?} {share}: {messages} behind {last}");
            if compression == Compression::None {
                let expected = f64::from(u32::try_from(cut.len()).unwrap()) / 415.0 - 3.0;
                assert!(f64::from(messages) > expected.min(4990.0), "{share}: {messages} of {expected}");
            }
            last = messages;
            let (recovered, anew) = recover(cut, Cursor::new(Vec::new()), compression).unwrap();
            assert_eq!((recovered.messages, recovered.damaged_chunks), (u64::from(messages), 0));
            assert_eq!(recovered.cut, error.is_some());
            let (again, error) = read(anew.get_ref());
            assert!(again == messages && error.is_none(), "{compression:?} {share}: {again}, {error:?}");
        }
        assert!(last > 4000, "{compression:?}: {last}");
    }
}

/// A recorder that is killed has not come to write down how long its last chunk is.
#[test]
fn a_chunk_that_was_never_closed_is_read() {
    let whole = file(100, Compression::None);
    let at = first_chunk(&whole);
    let length = usize::try_from(u64::from_le_bytes(whole[at + 1..at + 9].try_into().unwrap())).unwrap();
    let mut killed = whole[..at + 9 + length].to_vec();
    killed[at + 1..at + 9].fill(0xFF);
    // Two times, the size and the checksum behind them; the length of the records behind that of the packer's name.
    killed[at + 9..at + 9 + 28].fill(0xFF);
    killed[at + 9 + 32..at + 9 + 40].fill(0xFF);
    let (messages, error) = read(&killed);
    assert!(messages == 100 && matches!(error, Some(McapError::Cut)), "{messages}, {error:?}");
    assert_eq!(
        recover(killed.as_slice(), Cursor::new(Vec::new()), Compression::Zstd).unwrap().0.messages,
        100
    );
}

/// A damaged chunk is an error for whoever reads, and passed over by whoever recovers.
#[test]
fn a_damaged_chunk_costs_itself_alone() {
    for compression in ALL {
        let mut file = file(12_000, compression);
        let middle = file.len() / 2;
        file[middle] ^= 1;
        let (messages, error) = read(&file);
        assert!(messages > 1000 && matches!(error, Some(McapError::File(_))), "{messages}, {error:?}");
        let (recovered, anew) = recover(file.as_slice(), Cursor::new(Vec::new()), compression).unwrap();
        assert_eq!((recovered.damaged_chunks, recovered.cut), (1, false));
        assert!(recovered.messages > u64::from(messages), "{recovered:?}");
        assert_eq!(recovered.topics["/daq"], recovered.messages);
        let mut reader = McapReader::new(anew.get_ref().as_slice()).unwrap();
        let mut found = 0;
        while reader.next_entry().unwrap().is_some() {
            found += 1;
        }
        assert_eq!(found, recovered.messages);
    }
}

/// Messages of types that are not known here are copied with their definitions, channels without a schema too.
#[test]
fn recovery_keeps_what_it_does_not_know() {
    use ::mcap::records::MessageHeader;

    let mut writer = ::mcap::WriteOptions::new().profile("mine").create(Cursor::new(Vec::new())).unwrap();
    let schema = writer.add_schema("my/Type", "jsonschema", b"{}").unwrap();
    let with = writer.add_channel(schema, "/with", "json", &[("k".into(), "v".into())].into()).unwrap();
    let without = writer.add_channel(0, "/without", "json", &[].into()).unwrap();
    for (channel_id, log_time) in [(with, 3), (without, 2), (with, 1)] {
        let header = MessageHeader { channel_id, sequence: 7, log_time, publish_time: 9 };
        writer.write_to_known_channel(&header, b"{\"a\":1}").unwrap();
    }
    writer.finish().unwrap();
    let original = writer.into_inner().into_inner();
    let (recovered, anew) = recover(original.as_slice(), Cursor::new(Vec::new()), Compression::Lz4).unwrap();
    assert_eq!(
        recovered.topics.into_iter().collect::<Vec<_>>(),
        [("/with".into(), 2), ("/without".into(), 1)]
    );
    let all = |file: &[u8]| -> Vec<_> {
        let messages = ::mcap::MessageStream::new(file).unwrap().map(Result::unwrap);
        let kept = |message: ::mcap::Message<'_>| {
            let channel = &message.channel;
            let schema = channel.schema.as_ref().map(|schema| (schema.name.clone(), schema.data.to_vec()));
            let head = (channel.topic.clone(), channel.metadata.clone(), schema, message.sequence);
            (head, message.log_time, message.publish_time, message.data.to_vec())
        };
        messages.map(kept).collect()
    };
    assert_eq!(all(anew.get_ref()), all(&original));
    // The header's contents begin with the length of the profile and its letters.
    assert_eq!(anew.get_ref()[17..25], *b"\x04\0\0\0mine");
}

/// A record that says to be longer than its chunk ends the chunk, and is said once.
#[test]
fn a_record_beyond_its_chunk_is_said_once() {
    let mut whole = file(100, Compression::None);
    let at = first_chunk(&whole);
    // No checksum; the length of the first record in it.
    whole[at + 33..at + 37].fill(0);
    whole[at + 50..at + 58].copy_from_slice(&(1_u64 << 40).to_le_bytes());
    let (messages, error) = read(&whole);
    assert!(messages == 0 && matches!(error, Some(McapError::File(_))), "{messages}, {error:?}");
}

/// A record that no memory holds is refused, and nothing is looked for behind it.
#[test]
fn a_record_without_end_is_said_once() {
    let mut whole = file(100, Compression::None);
    let at = first_chunk(&whole);
    whole[at] = 5;
    whole[at + 1..at + 9].copy_from_slice(&(1_u64 << 50).to_le_bytes());
    let (messages, error) = read(&whole);
    assert!(messages == 0 && matches!(error, Some(McapError::File(_))), "{messages}, {error:?}");
}

/// What the system says of a file that cannot be read is not taken for a file of another kind.
#[test]
fn a_refusal_by_the_system_is_told() {
    struct Refused;
    impl std::io::Read for Refused {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("unplugged"))
        }
    }
    let error = McapReader::new(Refused).err().unwrap();
    assert!(
        matches!(&error, McapError::File(::mcap::McapError::Io(cause)) if cause.to_string() == "unplugged"),
        "{error:?}"
    );
    let short = McapReader::new(&b"\x89MC"[..]).err().unwrap();
    assert!(matches!(short, McapError::File(_)), "{short:?}");
}

#[test]
fn a_chunk_that_swells_is_refused() {
    // 300 MB of zeros in 9 kB.
    let zeros = ::zstd::encode_all(std::io::Read::take(std::io::repeat(0), 300 << 20), 1).unwrap();
    let chunk = |stated: u64| {
        let length = u64::try_from(zeros.len()).unwrap();
        let head = [
            &[0; 16][..],
            &stated.to_le_bytes(),
            &[0; 4],
            &4_u32.to_le_bytes(),
            b"zstd",
            &length.to_le_bytes(),
        ];
        let chunk = [&head.concat()[..], &zeros].concat();
        let length = u64::try_from(chunk.len()).unwrap().to_le_bytes();
        [b"\x89MCAP0\r\n".as_slice(), &[6], &length, &chunk].concat()
    };
    for (stated, message) in [(300 << 20, "64 mib of what was packed"), (65 << 20, "64 mib"), (1 << 20, "")] {
        let (messages, error) = read(&chunk(stated));
        let error = error.unwrap().to_string();
        assert!(messages == 0 && error.to_lowercase().contains(message), "{error}");
    }
}

proptest! {
    /// Whatever is wrong with a file, it is read to its end without a panic, and so it is recovered.
    #[test]
    fn any_damage_is_an_error_or_none(
        which in 0_usize..3, at in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6), cut in any::<prop::sample::Index>(),
    ) {
        let mut file = file(60, ALL[which]);
        for (place, byte) in at {
            let place = place.index(file.len());
            file[place] = byte;
        }
        file.truncate(cut.index(file.len()) + 1);
        if let Ok(mut reader) = McapReader::new(file.as_slice()) {
            let mut calls = 0;
            while !matches!(reader.next_entry(), Ok(None)) {
                calls += 1;
                prop_assert!(calls < 10_000);
            }
        }
        let _ = recover(file.as_slice(), Cursor::new(Vec::new()), Compression::None);
    }
}
