//! Resense's seven floats, little-endian: newtons, millinewton metres, degrees.

use fingertip_drivers::sensors::line::LineDecoder;
use fingertip_drivers::sensors::resense::{Limits, Reading, ResenseDecoder, ResenseFault};

use super::{Decoded, components, decoded};

const LIMITS: Limits = Limits { force: 10.0, torque: 0.5, temperature: [0.0, 50.0], temperature_step: 1.0 };

/// A reading whose seven numbers are these.
fn bytes(numbers: [f32; 7]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

#[test]
fn a_reading_has_its_fields_in_their_places() {
    // 1, −2, 0.5 N; 100, −200, 400 mN·m; 25 °C.
    let wire = [
        0, 0, 0x80, 0x3F, 0, 0, 0, 0xC0, 0, 0, 0, 0x3F, 0, 0, 0xC8, 0x42, 0, 0, 0x48, 0xC3, 0, 0, 0xC8, 0x43,
        0, 0, 0xC8, 0x41,
    ];
    let expected = Reading {
        force: [1.0, -2.0, 0.5],
        torque_millinewton_metres: [100.0, -200.0, 400.0],
        temperature: 25.0,
    };
    assert_eq!(Reading::parse(&wire), expected);
    assert_eq!(expected.emit(), wire);
    let mut decoder = ResenseDecoder::new(LIMITS);
    assert_eq!(decoder.temperature(), None);
    let sample = decoded(&mut decoder, &wire).unwrap().unwrap();
    for (found, expected) in components(&sample).into_iter().zip([1.0, -2.0, 0.5, 0.1, -0.2, 0.4_f64]) {
        assert!((found - expected).abs() <= f64::EPSILON * expected.abs());
    }
    assert_eq!((sample.time, decoder.temperature()), (None, Some(25.0)));
}

#[test]
fn each_number_has_its_limit() {
    let sound = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 25.0];
    // At the limit, and the next number beyond it.
    let limits = [10.0, 10.0, 10.0, 500.0, 500.0, 500.0_f32];
    for (at, limit) in limits.into_iter().enumerate() {
        for sign in [1.0, -1.0] {
            let (mut inside, mut beyond) = (sound, sound);
            (inside[at], beyond[at]) = (sign * limit, sign * limit.next_up());
            assert!(decoded(&mut ResenseDecoder::new(LIMITS), &bytes(inside)).unwrap().is_ok());
            let result: Decoded<_> = decoded(&mut ResenseDecoder::new(LIMITS), &bytes(beyond)).unwrap();
            assert_eq!(result, Err(ResenseFault::OutOfStep));
        }
    }
    for (temperature, given) in
        [(0.0, true), (50.0, true), (-1e-6, false), (50.0_f32.next_up(), false), (f32::NAN, false)]
    {
        let mut numbers = sound;
        numbers[6] = temperature;
        let result = decoded(&mut ResenseDecoder::new(LIMITS), &bytes(numbers)).unwrap();
        assert_eq!(result.is_ok(), given, "{temperature}");
    }
    for at in 0..7 {
        let mut numbers = sound;
        numbers[at] = f32::NAN;
        assert!(decoded(&mut ResenseDecoder::new(LIMITS), &bytes(numbers)).unwrap().is_err());
    }
}

#[test]
fn the_temperature_may_not_jump() {
    for (next, given) in [(26.0, true), (24.0, true), (26.0_f32.next_up(), false), (23.99, false)] {
        let mut decoder = ResenseDecoder::new(LIMITS);
        let reading = |temperature| bytes([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, temperature]);
        assert!(decoded(&mut decoder, &reading(25.0)).unwrap().is_ok());
        assert_eq!(decoded(&mut decoder, &reading(next)).unwrap().is_ok(), given, "{next}");
        // Not even if it does twice, since readings out of step bear each other out.
        LineDecoder::<f64>::restart(&mut decoder);
        assert_eq!(decoded(&mut decoder, &reading(next)).unwrap().is_ok(), given, "{next}");
    }
}

#[test]
fn a_component_may_change_by_a_step_and_by_more_only_if_the_next_agrees() {
    // 1 N and 0.125 N·m, which is 125 mN·m.
    let mut decoder = ResenseDecoder::new(LIMITS).stepping_at_most(1.0, 0.125);
    let reading = |force: f32, torque: f32| bytes([0.0, force, 0.0, 0.0, torque, 0.0, 25.0]);
    let mut given = |force, torque| {
        let given = decoded(&mut decoder, &reading(force, torque)).unwrap().is_ok();
        if !given {
            LineDecoder::<f64>::restart(&mut decoder);
        }
        given
    };
    assert!(given(0.0, 0.0) && given(1.0, 125.0) && given(0.0, 0.0));
    assert!(!given(1.5, 0.0) && given(0.0, 0.0) && !given(0.0, -126.0) && given(0.0, 0.0));
    // The first beyond is refused; the second that is near it is given, one that is not near is refused.
    assert!(!given(5.0, 0.0) && given(5.5, 0.0));
    assert!(!given(0.0, 0.0) && !given(3.0, 0.0) && !given(-3.0, 0.0) && given(-3.5, 0.0));
}

#[test]
fn what_is_refused_and_what_is_left_over_is_counted() {
    let mut decoder = ResenseDecoder::new(LIMITS);
    let sound = bytes([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 25.0]);
    let wrong = bytes([99.0, 0.0, 0.0, 0.0, 0.0, 0.0, 25.0]);
    assert!(decoded(&mut decoder, &sound).unwrap().is_ok());
    assert!(decoded(&mut decoder, &wrong).unwrap().is_err());
    assert!(decoded(&mut decoder, &sound).unwrap().is_err(), "nothing more until it is restarted");
    assert!(sound[..5].iter().all(|byte| LineDecoder::<f64>::push(&mut decoder, *byte).is_none()));
    LineDecoder::<f64>::restart(&mut decoder);
    assert!(decoded(&mut decoder, &sound).unwrap().is_ok());
    let statistics = LineDecoder::<f64>::statistics(&decoder);
    assert_eq!((statistics.frames, statistics.failed, statistics.skipped), (2, 2, 28 + 28 + 5));
}
