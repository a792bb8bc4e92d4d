//! HX711s on one clock line, after their data sheet.

use embedded_hal::digital::{InputPin, OutputPin};
use fingertip_drivers::converters::hx711::SimulatedHx711s;
use fingertip_drivers::converters::{Level, SimulatedBench, WireFaults};

type Bench = SimulatedBench<SimulatedHx711s<2>>;

fn bench(input: impl FnMut(f64) -> [(f64, f64); 2] + Send + 'static) -> Bench {
    SimulatedBench::new(SimulatedHx711s::new(input), WireFaults::default())
}

fn still() -> Bench {
    bench(|_| [(1e-3, 8e-3), (-2e-3, -6e-3)])
}

/// Clocks so many pulses of 2 µs, and gives the bits of both chips.
fn pulses(bench: &Bench, count: u32) -> [u32; 2] {
    let (mut clock, mut data) = (bench.clock(), bench.data());
    let mut words = [0; 2];
    for _ in 0..count {
        clock.set_high().unwrap();
        bench.advance(1000);
        for (word, pin) in words.iter_mut().zip(&mut data) {
            *word = *word << 1 | u32::from(pin.is_high().unwrap());
        }
        clock.set_low().unwrap();
        bench.advance(1000);
    }
    words
}

fn ready(bench: &Bench) -> [bool; 2] {
    bench.data().map(|mut pin| pin.is_low().unwrap())
}

/// 24 bits of a share of the supply, at a gain: half of the supply over the gain is full scale.
fn word(share: f64, gain: f64) -> u32 {
    ((share * gain * 2.0 * 8_388_608.0).round() as i32).cast_unsigned() & 0xFF_FFFF
}

/// Reads with so many pulses; the words of 24 bits.
fn read(bench: &Bench, count: u32) -> [u32; 2] {
    pulses(bench, count).map(|bits| bits >> (count - 24))
}

#[test]
fn it_settles_for_three_conversions_and_each_chip_has_its_own_rate() {
    let bench = still();
    bench.advance(49_499_999);
    assert_eq!((ready(&bench), bench.with(|chips| chips.conversions())), ([false, false], 0));
    // The second is quicker by 1 %: four periods of 12.375 ms.
    bench.advance(1);
    assert_eq!(ready(&bench), [false, true]);
    bench.advance(500_000);
    assert_eq!((ready(&bench), bench.with(|chips| chips.conversions())), ([true, true], 1));
    assert_eq!(read(&bench, 25), [word(1e-3, 128.0), word(-2e-3, 128.0)]);
    // Until the next one the lines are high.
    assert_eq!(ready(&bench), [false, false]);
    bench.advance(12_500_000);
    assert_eq!((ready(&bench), bench.with(|chips| chips.conversions())), ([true, true], 2));
}

#[test]
fn a_level_that_stays_is_no_pulse() {
    let bench = still();
    bench.advance(60_000_000);
    let mut clock = bench.clock();
    for _ in 0..3 {
        clock.set_low().unwrap();
        bench.advance(1000);
    }
    let mut words = [0; 2];
    for _ in 0..25 {
        clock.set_high().unwrap();
        clock.set_high().unwrap();
        bench.advance(1000);
        for (word, pin) in words.iter_mut().zip(&mut bench.data()) {
            *word = *word << 1 | u32::from(pin.is_high().unwrap());
        }
        clock.set_low().unwrap();
        clock.set_low().unwrap();
        bench.advance(1000);
    }
    assert_eq!(words.map(|bits| bits >> 1), [word(1e-3, 128.0), word(-2e-3, 128.0)]);
}

#[test]
fn the_pulses_say_what_the_next_conversion_is_of() {
    let bench = still();
    bench.advance(60_000_000);
    let mut expected = [word(1e-3, 128.0), word(-2e-3, 128.0)];
    for (count, next) in [
        (25, [word(1e-3, 128.0), word(-2e-3, 128.0)]),
        (26, [word(8e-3, 32.0), word(-6e-3, 32.0)]),
        (26, [word(8e-3, 32.0), word(-6e-3, 32.0)]),
        (27, [word(1e-3, 64.0), word(-2e-3, 64.0)]),
        (25, [word(1e-3, 128.0), word(-2e-3, 128.0)]),
    ] {
        assert_eq!(read(&bench, count), expected);
        // Long enough to settle, should it have to; behind 24 bits the lines are high.
        bench.advance(12_600_000);
        let changed = next != expected;
        assert_eq!(ready(&bench), [!changed; 2]);
        bench.advance(38_000_000);
        assert_eq!(ready(&bench), [true; 2]);
        expected = next;
    }
    assert_eq!(pulses(&bench, 27).map(|bits| bits & 7), [7, 7]);
}

#[test]
fn a_conversion_is_of_its_time_and_clipped_at_its_ends() {
    let bench = bench(|time| [(time * 1e-3, 0.0), (1.0, -1.0)]);
    bench.advance(50_000_000);
    // 50 ms times a thousandth.
    assert_eq!(read(&bench, 26), [word(50e-6, 128.0), 0x7F_FFFF]);
    bench.advance(60_000_000);
    assert_eq!(read(&bench, 25)[1], 0x80_0000);
}

#[test]
fn a_clock_that_is_high_for_60_microseconds_switches_off() {
    let bench = still();
    let resets = || bench.with(|chips| chips.resets());
    let (mut clock, first) = (bench.clock(), resets());
    bench.advance(60_000_000);
    assert_eq!((ready(&bench), first), ([true, true], 1));
    // For 60 µs it is a pulse; the other 24 follow.
    clock.set_high().unwrap();
    bench.advance(60_000);
    clock.set_low().unwrap();
    assert_eq!(resets(), 1);
    pulses(&bench, 24);
    bench.advance(14_000_000);
    assert_eq!(ready(&bench), [true, true]);
    clock.set_high().unwrap();
    bench.advance(60_001);
    // Off: no conversions, and the lines are high.
    assert_eq!(ready(&bench), [false, false]);
    let before = bench.with(|chips| chips.conversions());
    bench.advance(100_000_000);
    assert_eq!((bench.with(|chips| chips.conversions()), resets()), (before, 1));
    clock.set_low().unwrap();
    assert_eq!(resets(), 2);
    // It begins anew: three conversions to settle.
    bench.advance(49_400_000);
    assert_eq!(ready(&bench), [false, false]);
    bench.advance(700_000);
    assert_eq!(ready(&bench), [true, true]);
    assert_eq!(read(&bench, 25), [word(1e-3, 128.0), word(-2e-3, 128.0)]);
}

#[test]
fn pulses_without_a_conversion_give_ones_and_faults_are_as_stated() {
    let bench = still();
    // Nothing there: the lines stay high.
    assert_eq!(pulses(&bench, 25), [0x1FF_FFFF; 2]);
    bench.advance(60_000_000);
    for (level, expected) in [(Level::Low, 0), (Level::High, 0x1FF_FFFF)] {
        bench.set_faults(WireFaults { stuck_data: Some(level), ..WireFaults::default() });
        assert_eq!(pulses(&bench, 25), [expected; 2]);
        bench.set_faults(WireFaults::default());
        bench.advance(13_000_000);
    }
    // One bit of each word of each chip at most, and any of them.
    bench.set_faults(WireFaults { answer_flip: 25.0, seed: 3, ..WireFaults::default() });
    let mut seen = 0;
    for _ in 0..300 {
        for (found, expected) in read(&bench, 25).into_iter().zip([word(1e-3, 128.0), word(-2e-3, 128.0)]) {
            let flipped = found ^ expected;
            assert_eq!(flipped.count_ones(), 1);
            seen |= flipped;
        }
        bench.advance(13_000_000);
    }
    assert_eq!(seen, 0xFF_FFFF);
}

#[test]
fn a_conversion_is_kept_back_until_the_clock_was_still_for_20_microseconds() {
    let bench = still();
    let conversions = || bench.with(|chips| chips.conversions());
    // The next conversion of the first chip ends at 62.5 ms, 10 µs behind the pulse.
    bench.advance(62_490_000);
    let mut clock = bench.clock();
    clock.set_high().unwrap();
    bench.advance(1000);
    clock.set_low().unwrap();
    bench.advance(18_999);
    assert_eq!(conversions(), 1);
    bench.advance(1);
    assert_eq!(conversions(), 2);
}
