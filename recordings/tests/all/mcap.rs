//! MCAP files: written, read, damaged.

use std::io::{Cursor, Read};

use fingertip_recordings::mcap::{
    CdrError, CdrReader, CdrWriter, Header, McapError, McapReader, McapWriter, Recorded, RecordedContact,
    RecordedSignals,
};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};

fn wrench(number: u32) -> Wrench<f64> {
    let x = f64::from(number);
    Wrench::on_fingertip(Vector3::new(x, -x, 0.1 * x), Vector3::new(1e-3 * x, 0.0, -1.0))
}

fn file(samples: u32) -> Vec<u8> {
    let mut writer = McapWriter::new(Cursor::new(Vec::new())).unwrap();
    let wrenches = writer.wrenches("/tip/wrench", "tip").unwrap();
    let signals = writer.signals("/tip/signals", "tip").unwrap();
    let contacts = writer.contacts("/tip/contact", "tip").unwrap();
    for number in 0..samples {
        let time = 1000.0 + f64::from(number) * 1e-3;
        writer.write_wrench(wrenches, time, &wrench(number)).unwrap();
        let values = (0..6).map(|gauge| f64::from(number) + 0.1 * f64::from(gauge)).collect();
        writer.write_signals(signals, time, RecordedSignals { unit: "V".to_owned(), values }).unwrap();
        if number % 10 == 0 {
            let contact = RecordedContact {
                name: "index".to_owned(),
                position: Vector3::new(0.001, 0.002, 0.009),
                normal: Vector3::z(),
                wrench: wrench(number),
            };
            writer.write_contact(contacts, time, contact).unwrap();
        }
    }
    assert!(matches!(writer.write_wrench(signals, 0.0, &wrench(0)), Err(McapError::WrongTopic { .. })));
    assert!(matches!(writer.write_wrench(wrenches, f64::NAN, &wrench(0)), Err(McapError::Time { .. })));
    writer.write_wrench(wrenches, 2000.0, &(wrench(1) * f64::NAN)).unwrap();
    writer.finish().unwrap().into_inner()
}

#[test]
fn all_that_is_written_is_read() {
    let file = file(2000);
    let mut reader = McapReader::new(file.as_slice()).unwrap();
    let (mut wrenches, mut signals, mut contacts) = (0, 0, 0);
    while let Some(entry) = reader.next_entry().unwrap() {
        assert_eq!(entry.frame, "tip");
        match entry.recorded {
            Recorded::Wrench(found) if entry.time < 1999.0 => {
                assert_eq!(found, wrench(wrenches));
                assert!((entry.time - 1000.0 - f64::from(wrenches) * 1e-3).abs() < 1e-9);
                wrenches += 1;
            }
            Recorded::Wrench(found) => assert!(!found.is_finite()),
            Recorded::Signals(found) => {
                assert_eq!(
                    (found.unit.as_str(), found.values[0], found.values.len()),
                    ("V", f64::from(signals), 6)
                );
                signals += 1;
            }
            Recorded::Contact(found) => {
                assert_eq!(
                    (found.name.as_str(), found.position.z, found.wrench),
                    ("index", 0.009, wrench(10 * contacts))
                );
                contacts += 1;
            }
            _ => panic!("another message"),
        }
    }
    assert_eq!((wrenches, signals, contacts), (2000, 2000, 200));
}

/// The time of a message is also the file's own, in nanoseconds, by which players sort.
#[test]
fn a_message_is_logged_at_its_time() {
    let mut writer = McapWriter::new(Cursor::new(Vec::new())).unwrap();
    let topic = writer.wrenches("/tip/wrench", "tip").unwrap();
    // The last is rounded up to a whole second.
    for time in [12.5, 1_700_000_000.25, 7.999_999_999_9] {
        writer.write_wrench(topic, time, &wrench(1)).unwrap();
    }
    let file = writer.finish().unwrap().into_inner();
    for (nanoseconds, number) in
        [12_500_000_000_u64, 1_700_000_000_250_000_000, 8_000_000_000].into_iter().zip(0_u32..)
    {
        // In sequence; logged and published.
        let head =
            [&number.to_le_bytes()[..], &nanoseconds.to_le_bytes(), &nanoseconds.to_le_bytes()].concat();
        assert!(file.windows(20).any(|bytes| bytes == head), "{nanoseconds}");
    }
}

/// The time of a stamp is the number that is nearest to it, as reading its decimals gives.
#[test]
fn the_time_of_a_stamp_is_the_nearest_number() {
    for seconds in [0, 1, 4, 9_007_198, 9_007_200, 1_763_800_000, i32::MAX] {
        let some = [0, 1, 3, 100_000_000, 123_456_789, 350_000_001, 999_999_999];
        for nanoseconds in some.into_iter().chain((0..1000).map(|k| k * 999_983)) {
            let header = Header { seconds, nanoseconds, frame: String::new() };
            let exact: f64 = format!("{seconds}.{nanoseconds:09}").parse().unwrap();
            // Above 2^53 ns it is rounded twice.
            let allowed = if seconds < 9_007_199 { 0.0 } else { 2.4e-7 };
            assert!((header.time() - exact).abs() <= allowed, "{seconds}.{nanoseconds:09} {}", header.time());
        }
    }
}

/// A sequence may fill a message to its end, and not go beyond it.
#[test]
fn a_sequence_ends_with_its_message_or_before() {
    let mut writer = CdrWriter::default();
    writer.f64_sequence(&[1.5, -2.0]);
    let bytes = writer.into_message();
    assert_eq!(CdrReader::new(&bytes).unwrap().f64_sequence(), Ok(vec![1.5, -2.0]));
    let cut = CdrReader::new(&bytes[..bytes.len() - 1]).unwrap().f64_sequence();
    assert!(matches!(cut, Err(CdrError::Short { .. })), "{cut:?}");
    // A count for which there would be bytes, if those before it were still there.
    let mut writer = CdrWriter::default();
    writer.string("fourteen bytes");
    writer.f64_sequence(&[1.5]);
    let mut bytes = writer.into_message();
    let count = 4 + 4 + 15 + 1;
    assert_eq!(bytes[count..count + 4], 1_u32.to_le_bytes());
    bytes[count] = 2;
    let mut reader = CdrReader::new(&bytes).unwrap();
    assert_eq!(reader.string(), Ok("fourteen bytes"));
    assert_eq!(reader.f64_sequence(), Err(CdrError::Short { at: count + 4 - 4 }));
}

#[test]
fn a_damaged_file_is_an_error_and_never_gives_wrong_wrenches() {
    let sound = file(50);
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
    let (mut errors, trials) = (0, 3000);
    for _ in 0..trials {
        let mut damaged = sound.clone();
        if random.random() {
            damaged.truncate(random.random_range(0..sound.len()));
        } else {
            let at = random.random_range(0..sound.len());
            damaged[at] ^= 1 << random.random_range(0..8);
        }
        let Ok(mut reader) = McapReader::new(damaged.as_slice()) else {
            errors += 1;
            continue;
        };
        loop {
            match reader.next_entry() {
                Ok(Some(entry)) => {
                    // The checksum of a chunk is checked before its messages are given.
                    if let Recorded::Wrench(found) = entry.recorded {
                        assert!(!found.is_finite() || found == wrench(found.force().x as u32));
                    }
                }
                Ok(None) => break,
                Err(_) => {
                    errors += 1;
                    break;
                }
            }
        }
    }
    println!("{errors} of {trials} damaged files are errors; the others are damaged where nothing is read");
    assert!(errors > trials / 2);
    for _ in 0..300 {
        let mut bytes = b"\x89MCAP0\r\n".to_vec();
        bytes.extend(
            (0..random.random_range(0..200)).map(|_| random.random::<u8>() >> random.random_range(0..8)),
        );
        if let Ok(mut reader) = McapReader::new(bytes.as_slice()) {
            while let Ok(Some(_)) = reader.next_entry() {}
        }
    }
}

/// Gives a byte or some at a time, as a pipe may, and counts them.
struct Trickle<'a>(&'a [u8], usize);

impl Read for Trickle<'_> {
    fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        self.1 += 1;
        let length = to.len().min(1 + self.1 % 7);
        self.0.read(&mut to[..length])
    }
}

#[test]
fn a_file_is_read_from_whatever_gives_its_bytes() {
    let file = file(300);
    let mut whole = McapReader::new(file.as_slice()).unwrap();
    let mut pieces = McapReader::new(Trickle(&file, 0)).unwrap();
    let mut entries = 0;
    loop {
        let (expected, found) = (whole.next_entry().unwrap(), pieces.next_entry().unwrap());
        // A wrench that is not finite equals nothing.
        assert_eq!(format!("{found:?}"), format!("{expected:?}"));
        if found.is_none() {
            break;
        }
        entries += 1;
    }
    assert_eq!(entries, 300 + 300 + 30 + 1);
}

#[test]
fn a_length_that_cannot_be_takes_no_memory() {
    for opcode in [0x03_u8, 0x04, 0x05, 0x06, 0x09, 0x0F] {
        for length in [1_u64 << 20, 1 << 40, u64::MAX] {
            let file = [&b"\x89MCAP0\r\n"[..], &[opcode], &length.to_le_bytes(), &[0; 100]].concat();
            let error = McapReader::new(file.as_slice()).unwrap().next_entry().unwrap_err();
            assert!(matches!(error, McapError::File(_) | McapError::Cut) && !error.is_transport(), "{error}");
        }
    }
}

#[test]
fn an_attachment_whose_length_is_wrong_is_passed_over() {
    // Found by fuzzing: a record of 67 bytes that says it holds an attachment longer than itself.
    let mut file = b"\x89MCAP0\r\n".to_vec();
    file.extend([0x09, 67, 0, 0, 0, 0, 0, 0, 0]);
    let mut attachment = [0_u8; 67];
    attachment[4] = 0x22;
    attachment[6] = 5;
    for length in [0_u8, 1, 3, 4, 20, 31, 32, 33, 66, 255] {
        attachment[16] = length;
        attachment[24] = length;
        let file = [&file[..], &attachment].concat();
        let mut reader = McapReader::new(file.as_slice()).unwrap();
        assert!(reader.next_entry().is_err(), "the file has no end");
    }
}
