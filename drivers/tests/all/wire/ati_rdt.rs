//! RDT over UDP, big-endian: requests of 8 bytes, records of 36.

use fingertip_drivers::sensors::ati_rdt::{
    Command, CountsPerUnit, RdtError, Receiver, Record, RecordPacket, Request, WireError, records,
};
use fingertip_drivers::{SourceError, SourceErrorKind};
use fingertip_wrench::Wrench;

/// Sequence 0x01020304, sample 0x05060708, status 0x80000102, counts 1, −1, 256, −65536, 2³¹ − 1, −2³¹.
const RECORD: [u8; 36] = [
    0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08, 0x80, 0x00, 0x01, 0x02, 0, 0, 0, 1, 0xFF, 0xFF, 0xFF,
    0xFF, 0, 0, 1, 0, 0xFF, 0xFF, 0, 0, 0x7F, 0xFF, 0xFF, 0xFF, 0x80, 0, 0, 0,
];

#[test]
fn each_request_has_its_code_and_its_count() {
    for (code, command) in
        [(0, Command::Stop), (2, Command::Stream), (3, Command::StreamBuffered), (0x42, Command::Bias)]
    {
        let bytes = [0x12, 0x34, 0, code, 0x01, 0x02, 0x03, 0x04];
        let request = Request { command, count: 0x0102_0304 };
        assert_eq!(Request::parse(&bytes), Ok(request));
        assert_eq!(request.emit(), bytes);
    }
    for code in [1_u16, 4, 0x41, 0x43, 0x0200, 0x4200] {
        let [high, low] = [(code >> 8) as u8, code as u8];
        let bytes = [0x12, 0x34, high, low, 0, 0, 0, 0];
        assert_eq!(Request::parse(&bytes), Err(WireError::Command { code }));
    }
}

#[test]
fn a_request_without_its_header_or_of_another_length_is_none() {
    for (h0, h1) in [(0x12, 0x35), (0x13, 0x34), (0x34, 0x12), (0, 0), (0xFF, 0xFF)] {
        let found = u16::from(h0) * 256 + u16::from(h1);
        assert_eq!(Request::parse(&[h0, h1, 0, 2, 0, 0, 0, 0]), Err(WireError::Header { found }));
    }
    let bytes = [0x12, 0x34, 0, 2, 0, 0, 0, 0, 0];
    for found in [0, 1, 7, 9] {
        assert_eq!(Request::parse(&bytes[..found]), Err(WireError::Length { expected: 8, found }));
    }
}

#[test]
fn a_record_has_its_fields_in_their_places() {
    let counts = [1, -1, 256, -65_536, i32::MAX, i32::MIN];
    let record = Record { rdt_sequence: 0x0102_0304, ft_sequence: 0x0506_0708, status: 0x8000_0102, counts };
    let packet = RecordPacket::new_checked(&RECORD).unwrap();
    assert_eq!(
        (packet.rdt_sequence(), packet.ft_sequence(), packet.status(), packet.counts()),
        (record.rdt_sequence, record.ft_sequence, record.status, counts)
    );
    assert_eq!(Record::parse(&packet), record);
    assert_eq!(record.emit(), RECORD);
    for found in [0, 35] {
        let short = RecordPacket::new_checked(&RECORD[..found]);
        assert_eq!(short, Err(WireError::Length { expected: 36, found }));
    }
}

#[test]
fn a_datagram_is_one_whole_record_or_more() {
    let mut second = RECORD;
    second[3] = 5;
    let datagram = [RECORD, second].concat();
    let numbers: Vec<u32> = records(&datagram).unwrap().map(|record| record.rdt_sequence()).collect();
    assert_eq!(numbers, [0x0102_0304, 0x0102_0305]);
    for found in [0, 1, 35, 37, 71] {
        let wrong = records(&datagram[..found]).map(|records| records.len());
        assert_eq!(wrong, Err(WireError::Length { expected: 36, found }));
    }
}

#[test]
fn counts_become_newtons_and_newton_metres() {
    let wrench = |counts: CountsPerUnit<f64>, of| -> [f64; 6] { counts.wrench(&of).components().into() };
    let ati =
        wrench(CountsPerUnit::million().unwrap(), [1_000_000, -2_000_000, 500_000, 250_000, -1_000_000, 0]);
    for (found, expected) in ati.into_iter().zip([1.0, -2.0, 0.5, 0.25, -1.0, 0.0]) {
        // One product of a rounded inverse.
        assert!((found - expected).abs() <= f64::EPSILON * expected.abs());
    }
    let onrobot = wrench(CountsPerUnit::onrobot().unwrap(), [10_000, 0, -20_000, 100_000, 0, -50_000]);
    for (found, expected) in onrobot.into_iter().zip([1.0, 0.0, -2.0, 1.0, 0.0, -0.5]) {
        assert!((found - expected).abs() <= f64::EPSILON * expected.abs());
    }
    // One whose inverse is infinite is refused, too.
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-310] {
        assert_eq!(CountsPerUnit::new(bad, 1.0), Err(RdtError::BadCounts { quantity: "newton" }));
        assert_eq!(CountsPerUnit::new(1.0, bad), Err(RdtError::BadCounts { quantity: "newton metre" }));
    }
}

#[test]
fn a_status_that_is_not_zero_is_a_fault_of_a_record_that_is_news() {
    let mut receiver = Receiver::<f64>::new(CountsPerUnit::new(1.0, 1.0).unwrap());
    let sound = Record { rdt_sequence: 1, counts: [1, 2, 3, 4, 5, 6], ..Record::default() };
    let expected = Wrench::from_components(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0].into());
    assert_eq!(receiver.accept(&sound), Ok(Some(expected)));
    for bit in 0..32 {
        let (sequence, status) = (bit + 2, 1 << bit);
        let fault = receiver.accept(&Record { rdt_sequence: sequence, status, ..sound }).unwrap_err();
        assert_eq!(fault, RdtError::Status { sequence, status });
        assert_eq!(fault.kind(), SourceErrorKind::DeviceFault);
    }
    // It is not news, and so says nothing.
    assert_eq!(receiver.accept(&Record { rdt_sequence: 33, status: 1, ..sound }), Ok(None));
    assert_eq!(receiver.index(), 32);
}
