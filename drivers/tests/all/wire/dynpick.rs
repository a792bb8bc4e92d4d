//! DynPick's text: a digit that counts, six numbers of four hexadecimal digits, a line end.

use fingertip_drivers::sensors::AxisCounts;
use fingertip_drivers::sensors::dynpick::{
    DynPickDecoder, DynPickFault, REQUEST, REQUEST_SENSITIVITIES, REQUEST_ZERO, Reading, Sensitivities,
    SensitivitiesError,
};

use super::{Decoded, components, decoded};

#[test]
fn requests_are_single_letters() {
    assert_eq!([REQUEST, REQUEST_SENSITIVITIES, REQUEST_ZERO], *b"RpO");
}

#[test]
fn a_reading_is_what_is_above_8192_over_the_sensitivity() {
    // 0x2000 is 8192, 0x2064 a hundred more, 0x1F9C a hundred less.
    let bytes = b"72000206420001F9C2000207D\r\n";
    let expected = Reading { tick: 7, raw: [8192, 8292, 8192, 8092, 8192, 8317] };
    assert_eq!(Reading::parse(bytes), Some(expected));
    assert_eq!(expected.emit(), *bytes);
    let counts = AxisCounts::new([1.0, 50.0, 1.0, 1000.0, 1.0, -500.0]).unwrap();
    let sample = decoded(&mut DynPickDecoder::new(counts), bytes).unwrap().unwrap();
    for (found, expected) in components(&sample).into_iter().zip([0.0, 2.0, 0.0, -0.1, 0.0, -0.25_f64]) {
        assert!((found - expected).abs() <= 2.0 * f64::EPSILON * expected.abs());
    }
    assert_eq!(sample.time, None);
}

#[test]
fn either_end_of_the_converter_is_an_overload_and_beyond_it_is_no_reading() {
    let counts = AxisCounts::uniform(1.0, 1.0).unwrap();
    let take = |bytes: &[u8]| decoded(&mut DynPickDecoder::new(counts), bytes);
    for axis in 0..6 {
        for (digits, given) in [("0000", false), ("0001", true), ("3FFE", true), ("3FFF", false)] {
            let numbers: String = (0..6).map(|other| if other == axis { digits } else { "2000" }).collect();
            let result: Decoded<_> = take(format!("0{numbers}\r\n").as_bytes()).unwrap();
            assert_eq!(result.is_ok(), given, "{digits}");
            if !given {
                assert_eq!(result, Err(DynPickFault::Saturated { axis }));
            }
        }
        let numbers: String = (0..6).map(|other| if other == axis { "4000" } else { "2000" }).collect();
        assert!(take(format!("0{numbers}\r\n").as_bytes()).is_none());
    }
}

#[test]
fn each_byte_must_be_of_its_kind() {
    let sound = *b"0200020002000200020002000\r\n";
    assert!(Reading::parse(&sound).is_some());
    for at in 0..27 {
        let mut bytes = sound;
        bytes[at] = b'g';
        assert_eq!(Reading::parse(&bytes), None, "{at}");
    }
    let mut bytes = sound;
    bytes[0] = b'a';
    assert_eq!(Reading::parse(&bytes), None, "the count is decimal");
    bytes.copy_from_slice(b"9200020002000200020002000\r\n");
    assert_eq!(Reading::parse(&bytes).unwrap().tick, 9);
}

#[test]
fn the_digit_that_counts_tells_what_is_missing() {
    let counts = AxisCounts::uniform(1.0, 1.0).unwrap();
    let mut decoder = DynPickDecoder::new(counts);
    let mut missing = Vec::new();
    for tick in [8, 9, 0, 1, 3, 3, 0, 5] {
        decoded(&mut decoder, format!("{tick}200020002000200020002000\r\n").as_bytes()).unwrap().unwrap();
        missing.push(decoder.missing());
    }
    // The same digit again is nine that are missing; from 3 to 0 six are, from 0 to 5 four.
    assert_eq!(missing, [0, 0, 0, 0, 1, 10, 16, 20]);
}

#[test]
fn sensitivities_are_six_decimal_numbers() {
    let answer = b"010.00,020.00,040.00,1000.0,2000.0,4000.0\r\n";
    let counts = Sensitivities::parse(answer).unwrap().counts();
    assert_eq!(counts, AxisCounts::new([10.0, 20.0, 40.0, 1000.0, 2000.0, 4000.0]).unwrap());
    assert!(Sensitivities::parse(b"\0 10,20,40,1000,2000,4000 \0").is_ok());
    for (answer, found) in [(&b""[..], 1), (b"1,2,3,4,5", 5), (b"1,2,3,4,5,6,7", 7)] {
        assert_eq!(Sensitivities::parse(answer), Err(SensitivitiesError::Count { found }));
    }
    for index in 0..6 {
        let numbers: Vec<&str> = (0..6).map(|other| if other == index { "x" } else { "1" }).collect();
        let parsed = Sensitivities::parse(numbers.join(",").as_bytes());
        assert_eq!(parsed, Err(SensitivitiesError::Number { index }));
    }
}
