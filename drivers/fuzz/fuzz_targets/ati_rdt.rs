//! Datagrams and requests of ATI's raw data transfer.
#![no_main]

use fingertip_drivers::sensors::ati_rdt::{CountsPerUnit, Receiver, Record, Request, records};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(request) = Request::parse(bytes) {
        assert_eq!(request.emit(), bytes);
    }
    let Ok(counts) = CountsPerUnit::<f64>::million() else { return };
    let mut receiver = Receiver::new(counts);
    if let Ok(packets) = records(bytes) {
        let again: Vec<u8> = packets.flat_map(|packet| Record::parse(&packet).emit()).collect();
        assert_eq!(again, bytes);
    }
    for packet in records(bytes).into_iter().flatten() {
        let _ = receiver.accept(&Record::parse(&packet));
    }
});
