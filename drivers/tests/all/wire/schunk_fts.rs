//! SCHUNK's messages, little-endian: FF FF, counter, length, then samples, a command or an answer.

use fingertip_drivers::sensors::schunk_fts::{
    Command, CommandAnswer, FtsReceiver, FtsSample, FtsWireError, Packet, TCP_PORT, UDP_PORT, emit_packet,
};

/// Status 1 and 1, −2, 0.5 N, 0.25, −0.125, 8 N·m.
const SAMPLE: [u8; 28] = [
    1, 0, 0, 0, 0, 0, 0x80, 0x3F, 0, 0, 0, 0xC0, 0, 0, 0, 0x3F, 0, 0, 0x80, 0x3E, 0, 0, 0, 0xBE, 0, 0, 0,
    0x41,
];
const COMPONENTS: [f32; 6] = [1.0, -2.0, 0.5, 0.25, -0.125, 8.0];

fn datagram(head: [u8; 7], samples: usize) -> Vec<u8> {
    head.into_iter().chain([SAMPLE; 3].into_iter().take(samples).flatten()).collect()
}

#[test]
fn a_datagram_has_its_fields_in_their_places() {
    assert_eq!((TCP_PORT, UDP_PORT), (82, 54_843));
    // Counter 0x1234, 29 bytes behind the length, identifier 0x56.
    let bytes = datagram([0xFF, 0xFF, 0x34, 0x12, 29, 0, 0x56], 1);
    let packet = Packet::new_checked(&bytes).unwrap();
    assert_eq!((packet.counter(), packet.id()), (0x1234, 0x56));
    let sample = FtsSample { status: 1, components: COMPONENTS };
    assert_eq!(packet.samples().collect::<Vec<_>>(), [sample]);
    let mut emitted = [0; 35];
    assert_eq!(emit_packet(0x1234, 0x56, &[sample], &mut emitted), Some(35));
    assert_eq!(emitted[..], bytes);
    let wrench = FtsReceiver::default().accept::<f64>(&packet).unwrap().next().unwrap().unwrap();
    assert_eq!(<[f64; 6]>::from(wrench.components()), COMPONENTS.map(f64::from));
    let bytes = datagram([0xFF, 0xFF, 0, 0, 85, 0, 0], 3);
    assert_eq!(Packet::new_checked(&bytes).unwrap().samples().len(), 3);
}

#[test]
fn a_status_word_is_little_endian_and_only_ready_gives_numbers() {
    let mut sample = SAMPLE;
    sample[..4].copy_from_slice(&[0x78, 0x56, 0x34, 0x12]);
    assert_eq!(FtsSample::parse(&sample).status, 0x1234_5678);
    for status in [0_u32, 1, 2, 3, 1 << 8 | 1, 1 << 31 | 1] {
        let mut bytes = datagram([0xFF, 0xFF, 0, 0, 29, 0, 0], 1);
        bytes[7..11].copy_from_slice(&status.to_le_bytes());
        let mut receiver = FtsReceiver::default();
        let result = receiver.accept::<f64>(&Packet::new_checked(&bytes).unwrap()).unwrap().next().unwrap();
        assert_eq!(result.is_ok(), status == 1, "{status:#x}");
        assert!(result.is_ok() || result.unwrap_err().status == status);
    }
    // A number that is none.
    let mut bytes = datagram([0xFF, 0xFF, 0, 0, 29, 0, 0], 1);
    bytes[31..35].copy_from_slice(&f32::NAN.to_le_bytes());
    let mut receiver = FtsReceiver::default();
    let result = receiver.accept::<f64>(&Packet::new_checked(&bytes).unwrap()).unwrap().next().unwrap();
    assert!(result.is_err());
}

#[test]
fn what_is_no_message_says_why() {
    for found in 0..6 {
        let short = Packet::new_checked(&[0xFF; 6][..found]);
        assert_eq!(short, Err(FtsWireError::Short { found }));
    }
    for head in [[0xFE, 0xFF], [0xFF, 0xFE]] {
        let bytes = datagram([head[0], head[1], 0, 0, 29, 0, 0], 1);
        assert_eq!(Packet::new_checked(&bytes), Err(FtsWireError::Header));
        assert_eq!(Command::parse(&[head[0], head[1], 0, 0, 1, 0, 0x40]), Err(FtsWireError::Header));
    }
    for (low, high, stated) in [(28, 0, 28), (30, 0, 30), (29, 1, 285)] {
        let bytes = datagram([0xFF, 0xFF, 0, 0, low, high, 0], 1);
        assert_eq!(Packet::new_checked(&bytes), Err(FtsWireError::Length { stated, found: 29 }));
    }
    // No sample at all, and not a whole one.
    for found in [0, 1, 28, 30] {
        let mut bytes = datagram([0xFF, 0xFF, 0, 0, found as u8, 0, 0], 2);
        bytes.truncate(6 + found);
        assert_eq!(Packet::new_checked(&bytes), Err(FtsWireError::Payload { found }));
    }
}

#[test]
fn each_command_and_answer_has_its_code() {
    for (command, code) in [
        (Command::Tare, 0x12),
        (Command::ResetTare, 0x13),
        (Command::StartUdp, 0x40),
        (Command::StopUdp, 0x41),
    ] {
        let bytes = [0xFF, 0xFF, 0x34, 0x12, 1, 0, code];
        assert_eq!(command.emit(0x1234), bytes);
        assert_eq!(Command::parse(&bytes), Ok((0x1234, command)));
        let bytes = [0xFF, 0xFF, 0x34, 0x12, 2, 0, code, 9];
        let answer = CommandAnswer { command, error: 9 };
        assert_eq!(answer.emit(0x1234), bytes);
        assert_eq!(CommandAnswer::parse(&bytes), Ok((0x1234, answer)));
    }
    for code in [0, 0x11, 0x14, 0x3F, 0x42] {
        let unknown = Err(FtsWireError::Command { code });
        assert_eq!(Command::parse(&[0xFF, 0xFF, 0, 0, 1, 0, code]).map(|_| ()), unknown);
        assert_eq!(CommandAnswer::parse(&[0xFF, 0xFF, 0, 0, 2, 0, code, 0]).map(|_| ()), unknown);
    }
    let answer = [0xFF, 0xFF, 0, 0, 2, 0, 0x40, 0];
    assert_eq!(Command::parse(&answer), Err(FtsWireError::Payload { found: 2 }));
    let command = [0xFF, 0xFF, 0, 0, 1, 0, 0x40];
    assert_eq!(CommandAnswer::parse(&command), Err(FtsWireError::Payload { found: 1 }));
}

#[test]
fn the_counter_is_followed_over_its_wrap_around_in_both_directions() {
    let mut receiver = FtsReceiver::default();
    let mut given = |counter: u16| {
        let [low, high] = counter.to_le_bytes();
        let bytes = datagram([0xFF, 0xFF, low, high, 29, 0, 0], 1);
        let given = receiver.accept::<f64>(&Packet::new_checked(&bytes).unwrap()).is_some();
        (given, receiver.index())
    };
    let arrivals = [
        (0xFFFE, (true, 0)),
        (0, (true, 2)),
        (0xFFFF, (false, 2)),
        (0xFFFF, (false, 2)),
        // 32 767 ahead is news, though most are lost.
        (0x7FFF, (true, 2 + 0x7FFF)),
        // 32 768 ahead looks behind, and is none of the last sixty-four.
        (0xFFFF, (false, 2 + 0x7FFF)),
        (0x8000, (true, 3 + 0x7FFF)),
    ];
    for (counter, expected) in arrivals {
        assert_eq!(given(counter), expected, "{counter:#x}");
    }
    let statistics = *receiver.statistics();
    assert_eq!((statistics.received, statistics.duplicates, statistics.late), (7, 1, 1));
    assert_eq!((statistics.lost, statistics.doubtful), (0x7FFE, 1));
}
