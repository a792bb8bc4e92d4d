//! The ADS1256 at 7.68 MHz, after its data sheet.

use fingertip_drivers::converters::SimulatedDevice;
use fingertip_drivers::converters::ads1256::{Rate, SimulatedAds1256};

/// Sends bytes, waits as long as a read must (t6), and reads.
fn ask(chip: &mut SimulatedAds1256, command: &[u8], length: usize) -> Vec<u8> {
    chip.select();
    command.iter().for_each(|byte| assert_eq!(chip.shift(*byte), 0xFF));
    chip.advance(6511);
    let answer = (0..length).map(|_| chip.shift(0)).collect();
    chip.deselect();
    chip.advance(4000);
    answer
}

fn registers(chip: &mut SimulatedAds1256) -> Vec<u8> {
    ask(chip, &[0x10, 10], 11)
}

/// 1000 Hz and a gain of 1.
fn made(input: impl FnMut(f64, u8, u8) -> f64 + Send + 'static) -> SimulatedAds1256 {
    let mut chip = SimulatedAds1256::new(input);
    ask(&mut chip, &[0x50, 3, 0x00, 0x45, 0x00, 0xA1], 0);
    chip
}

/// Begins a conversion.
fn sync(chip: &mut SimulatedAds1256) {
    ask(chip, &[0xFC], 0);
    ask(chip, &[0x00], 0);
}

#[test]
fn after_a_reset_the_registers_are_those_of_the_data_sheet() {
    let after = [0x31, 0x01, 0x20, 0xF0, 0xE0, 0, 0, 0, 0, 0, 0x40];
    let mut chip = SimulatedAds1256::new(|_, _, _| 0.0);
    assert_eq!(registers(&mut chip), after);
    // Written in a row; of the status only the settings.
    ask(&mut chip, &[0x50, 3, 0xFF, 0x23, 0x06, 0xA1], 0);
    assert_eq!(registers(&mut chip)[1..5], [0x23, 0x06, 0xA1, 0xE0]);
    assert_eq!(registers(&mut chip)[0] & !1, 0x3E);
    ask(&mut chip, &[0x5A, 0, 0x77], 0);
    assert_eq!(ask(&mut chip, &[0x1A, 0], 1), [0x77]);
    ask(&mut chip, &[0xFE], 0);
    assert_eq!(registers(&mut chip), after);
    assert_eq!(chip.hurried(), 0);
}

#[test]
fn a_conversion_takes_the_settling_time_of_its_rate() {
    for rate in Rate::ALL {
        let mut chip = made(|_, _, _| 0.25);
        ask(&mut chip, &[0x53, 0, rate as u8], 0);
        ask(&mut chip, &[0xFC], 0);
        let before = chip.conversions();
        chip.select();
        chip.shift(0x00);
        let settling = u64::from(rate.settling()) * 1000;
        chip.advance(settling - 1);
        assert_eq!((chip.conversions() - before, chip.is_ready()), (0, false), "{rate:?}");
        chip.advance(1);
        assert_eq!((chip.conversions() - before, chip.is_ready()), (1, true));
        chip.advance(2 * settling);
        assert_eq!(chip.conversions() - before, 3);
    }
    // A calibration takes three of them, a reset two.
    for (command, settlings) in [(0xF0, 3), (0xF3, 3), (0xF4, 3)] {
        let mut chip = made(|_, _, _| 0.25);
        let before = chip.conversions();
        chip.select();
        chip.shift(command);
        chip.advance(settlings * 1_180_000 - 1);
        assert_eq!(chip.conversions() - before, 0);
        chip.advance(1);
        assert_eq!(chip.conversions() - before, 1);
    }
    let mut chip = SimulatedAds1256::new(|_, _, _| 0.25);
    chip.advance(2 * 210_000 - 1);
    assert_eq!(chip.conversions(), 0);
    chip.advance(1);
    assert_eq!(chip.conversions(), 1);
    // Waking up without a synchronisation before it begins nothing.
    let mut chip = made(|_, _, _| 0.25);
    sync(&mut chip);
    chip.advance(1_000_000);
    chip.select();
    chip.shift(0x00);
    chip.advance(180_000);
    assert!(chip.is_ready());
}

#[test]
fn a_conversion_is_of_the_pins_with_the_gain() {
    for (gain, adcon) in [(1.0, 0x20), (2.0, 1), (8.0, 3), (64.0, 6), (64.0, 7)] {
        let mut chip = made(|time, positive, negative| {
            assert_eq!((positive, negative), (4, 5));
            -1e-3 - time
        });
        ask(&mut chip, &[0x52, 0, adcon], 0);
        ask(&mut chip, &[0xFC], 0);
        chip.select();
        let begun = 5 * (6511 + 4000);
        chip.shift(0x00);
        chip.advance(1_180_000);
        let status = ask(&mut chip, &[0x10, 0], 1)[0];
        assert_eq!(status & 1, 0, "there is a conversion");
        let answer = ask(&mut chip, &[0x01], 3);
        let counts = i32::from_be_bytes([answer[0], answer[1], answer[2], 0]) >> 8;
        // Full scale is twice the reference over the gain. The time is known to some settings of registers.
        let share = |time: f64| ((-1e-3 - time) * gain / 2.0 * 8_388_607.0).round().max(-8_388_608.0) as i32;
        let (late, soon) = (share((begun + 1_180_000) as f64 * 1e-9), share(1_180_000.0 * 1e-9));
        assert!((late..=soon).contains(&counts) && counts < 0, "{late} {counts} {soon}");
        // It was read, and is no longer new.
        assert!(!chip.is_ready());
        assert_eq!(ask(&mut chip, &[0x10, 0], 1)[0] & 1, 1);
    }
    for (ratio, expected) in [(9.0, [0x7F, 0xFF, 0xFF]), (-9.0, [0x80, 0, 0]), (2.0, [0x7F, 0xFF, 0xFF])] {
        let mut chip = made(move |_, _, _| ratio);
        sync(&mut chip);
        chip.advance(1_180_000);
        assert_eq!(ask(&mut chip, &[0x01], 3), expected);
    }
}

#[test]
fn what_comes_too_soon_is_counted_and_answered_with_ones() {
    let mut chip = made(|_, _, _| 0.0);
    sync(&mut chip);
    chip.advance(1_200_000);
    assert_eq!(chip.hurried(), 0);
    // 50 clocks of 7.68 MHz before the answer to a read, of data and of registers.
    for command in [&[0x01][..], &[0x11, 0]] {
        for (wait, soon) in [(6509, 1), (6510, 0)] {
            let before = chip.hurried();
            chip.select();
            for byte in command {
                chip.shift(*byte);
            }
            chip.advance(wait);
            let answer = chip.shift(0);
            assert_eq!((chip.hurried() - before, answer == 0xFF), (soon, soon == 1), "{command:?} {wait}");
        }
    }
    // 24 clocks behind a synchronisation.
    for (wait, soon) in [(3124, 1), (3125, 0)] {
        chip.advance(10_000);
        let before = chip.hurried();
        chip.select();
        chip.shift(0xFC);
        chip.advance(wait);
        chip.shift(0x00);
        assert_eq!(chip.hurried() - before, soon, "{wait}");
    }
    // A transaction that begins drops what was left of the one before.
    chip.select();
    chip.shift(0x01);
    chip.advance(7000);
    chip.select();
    assert_eq!(chip.shift(0x10), 0xFF);
    chip.select();
    chip.shift(0x12);
    chip.select();
    assert_eq!(ask(&mut chip, &[0x12, 0], 1), [0x00]);
}
