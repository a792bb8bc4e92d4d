//! Bytes from converters.
#![no_main]

use crc::{CRC_16_IBM_3740, Crc};
use fingertip_drivers::converters::ads131m::{Answer, Request};
use fingertip_drivers::converters::ads1256;
use fingertip_drivers::converters::hx711::Shift;
use fingertip_drivers::converters::mcp3564::{Data, Request as ScanRequest};
use fingertip_drivers::converters::nau7802;
use libfuzzer_sys::fuzz_target;

/// That of an ADS131M, CRC-16/CCITT-FALSE by its other name.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

fuzz_target!(|bytes: &[u8]| {
    if let Ok(answer) = Answer::<8>::parse(bytes) {
        let mut again = [0; Answer::<8>::LENGTH];
        answer.emit(&mut again);
        assert_eq!(Answer::parse(&again), Ok(answer));
    }
    let _ = Answer::<4>::parse(bytes);
    // With a checksum that is right, which chance does not find.
    if let Some(covered) = bytes.get(..Answer::<4>::LENGTH - 3) {
        let [high, low] = CRC.checksum(covered).to_be_bytes();
        let frame = [covered, &[high, low, 0]].concat();
        let Ok(answer) = Answer::<4>::parse(&frame) else { panic!("{frame:?}") };
        assert!(answer.counts.iter().all(|count| (-8_388_608..8_388_608).contains(count)));
    }
    for checked in [false, true] {
        if let Ok(Some(request)) = Request::parse(bytes, checked) {
            let mut frame = [0; 30];
            request.emit(&mut frame);
            assert_eq!(Request::parse(&frame, true), Ok(Some(request)));
        }
    }
    if let Some(word) = bytes.first_chunk::<4>()
        && let Ok(data) = Data::parse(*word)
    {
        assert_eq!(data.emit(), *word);
    }
    if let Some(word) = bytes.first_chunk::<3>() {
        assert_eq!(ads1256::Reading::parse(*word).emit(), *word);
        assert_eq!(nau7802::Reading::parse(*word).emit(), *word);
    }
    let mut shift = Shift::<8>::new();
    for byte in bytes {
        if let (device, Some(request)) = ScanRequest::parse(*byte) {
            assert_eq!(request.emit(device), *byte);
        }
        shift.push(core::array::from_fn(|bit| byte >> bit & 1 == 1));
    }
    if let Ok(conversion) = shift.finish([true; 8]) {
        assert!(conversion.counts.iter().all(|count| (-8_388_608..8_388_608).contains(count)));
    }
});
