//! The MCP3564 at device address 1, after its data sheet.

use fingertip_drivers::converters::SimulatedDevice;
use fingertip_drivers::converters::mcp3564::SimulatedMcp3564;

use super::{crc16, exchange};

/// Reads a register of so many bytes: the status, and its value.
fn read(chip: &mut SimulatedMcp3564, address: u8, length: usize) -> (u8, u32) {
    let mut bytes = vec![0; 1 + length];
    bytes[0] = 0x41 | address << 2;
    let answer = exchange(chip, &bytes);
    (answer[0], answer[1..].iter().fold(0, |value, byte| value << 8 | u32::from(*byte)))
}

fn write(chip: &mut SimulatedMcp3564, address: u8, bytes: &[u8]) -> u8 {
    exchange(chip, &[&[0x42 | address << 2], bytes].concat())[0]
}

fn fast(chip: &mut SimulatedMcp3564, code: u8) -> u8 {
    exchange(chip, &[0x40 | code << 2])[0]
}

const START: u8 = 0b1010;
/// 4 times 256 clocks of 4.9152 MHz.
const PERIOD: u64 = 208_333;

fn steps() -> SimulatedMcp3564 {
    // A thousandth of the reference for each channel, and one for the first.
    SimulatedMcp3564::new(false, |_, channel| f64::from(channel + 1) * 1e-3)
}

fn counts(share: f64) -> u32 {
    ((share * 8_388_608.0).round() as i32).cast_unsigned() & 0x0FFF_FFFF
}

#[test]
fn after_power_up_registers_and_status_are_those_of_the_data_sheet() {
    let mut chip = steps();
    // Address bits, nothing new, nothing damaged; the supply was off until the interrupt register is read.
    assert_eq!(read(&mut chip, 1, 1), (0x16, 0xC0));
    assert_eq!(read(&mut chip, 5, 1), (0x16, 0x73));
    for (address, length, value) in [
        (1, 1, 0xC0),
        (2, 1, 0x0C),
        (3, 1, 0x8B),
        (4, 1, 0),
        (6, 1, 1),
        (7, 3, 0),
        (10, 3, 0x80_0000),
        (11, 3, 0x90_0000),
        (13, 1, 0xA5),
        (14, 2, 0x000F),
    ] {
        assert_eq!(read(&mut chip, address, length), (0x17, value), "{address}");
    }
    // What was not fetched of one answer is not of the next.
    exchange(&mut chip, &[0x41 | 11 << 2, 0]);
    assert_eq!(read(&mut chip, 10, 3), (0x17, 0x80_0000));
    exchange(&mut chip, &[0x41 | 11 << 2, 0]);
    assert_eq!(exchange(&mut chip, &[0x40 | START << 2, 0]), [0x17, 0]);
    chip.power_cycle();
    assert_eq!(fast(&mut chip, 0b1100), 0x16);
    // Another device is not answered.
    assert_eq!(exchange(&mut chip, &[0x81 | 1 << 2, 0]), [0xFF, 0]);
    // What is behind a register is zero.
    assert_eq!(read(&mut chip, 1, 2), (0x16, 0xC000));
}

#[test]
fn the_list_is_gone_through_upwards_or_downwards_at_the_rate() {
    for (down, order) in [(false, [0_u32, 2, 5, 0, 2]), (true, [5, 2, 0, 5, 2])] {
        let mut chip = SimulatedMcp3564::new(down, |_, channel| f64::from(channel + 1) * 1e-3);
        write(&mut chip, 7, &[0, 0, 0b10_0101]);
        chip.advance(10 * PERIOD);
        assert_eq!((chip.conversions(), chip.is_ready()), (0, false), "not started");
        fast(&mut chip, START);
        for channel in order {
            chip.advance(PERIOD - 1);
            assert!(!chip.is_ready());
            chip.advance(1);
            assert!(chip.is_ready());
            // New, then no longer.
            let expected = channel << 28 | counts(f64::from(channel + 1) * 1e-3);
            assert_eq!(read(&mut chip, 0, 4), (0x12, expected));
            assert_eq!(read(&mut chip, 0, 4), (0x16, expected));
        }
        assert_eq!(chip.conversions(), 5);
        // Stopped; and begun anew with the first of the list.
        fast(&mut chip, 0b1011);
        chip.advance(5 * PERIOD);
        assert_eq!(chip.conversions(), 5);
        fast(&mut chip, START);
        chip.advance(PERIOD);
        assert_eq!(read(&mut chip, 0, 4).1 >> 28, order[0]);
    }
    // Highest and lowest of sixteen; and an empty list.
    for (down, order) in [(false, [0, 15, 0]), (true, [15, 0, 15])] {
        let mut chip = SimulatedMcp3564::new(down, |_, _| 0.0);
        write(&mut chip, 7, &[0, 0x80, 0x01]);
        fast(&mut chip, START);
        for channel in order {
            chip.advance(PERIOD);
            assert_eq!(read(&mut chip, 0, 4).1 >> 28, channel);
        }
    }
    let mut chip = steps();
    fast(&mut chip, START);
    chip.advance(10 * PERIOD);
    assert_eq!((chip.conversions(), chip.is_ready()), (0, false));
}

#[test]
fn rates_and_gains_are_those_of_the_registers() {
    let ratios =
        [32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 20480, 24576, 40960, 49152, 81920, 98304_u64];
    for (code, ratio) in (0_u8..).zip(ratios) {
        let mut chip = steps();
        write(&mut chip, 2, &[code << 2]);
        write(&mut chip, 7, &[0, 0, 1]);
        chip.advance(1000);
        fast(&mut chip, START);
        let period = ratio * 4_000_000_000 / 4_915_200;
        chip.advance(period - 1);
        assert_eq!(chip.conversions(), 0);
        chip.advance(1);
        assert_eq!(chip.conversions(), 1);
        chip.advance(3 * period);
        assert_eq!(chip.conversions(), 4);
    }
    for (code, gain) in
        [(0, 1.0 / 3.0), (1, 1.0), (2, 2.0), (3, 4.0), (4, 8.0), (5, 16.0), (6, 32.0), (7, 64.0)]
    {
        let mut chip = SimulatedMcp3564::new(false, |time, _| -0.01 - 10.0 * time);
        write(&mut chip, 3, &[0x83 | code << 3]);
        write(&mut chip, 7, &[0, 0, 2]);
        fast(&mut chip, START);
        chip.advance(PERIOD);
        let share = (-0.01 - 10.0 * PERIOD as f64 * 1e-9) * gain;
        assert_eq!(read(&mut chip, 0, 4).1, 1 << 28 | counts(share), "{gain}");
    }
    // 25 bits: clipped beyond twice the reference.
    for (share, expected) in [(3.0, 0x00FF_FFFF), (-3.0, 0x0F00_0000)] {
        let mut chip = SimulatedMcp3564::new(false, move |_, _| share);
        write(&mut chip, 7, &[0, 0, 1]);
        fast(&mut chip, START);
        chip.advance(PERIOD);
        assert_eq!(read(&mut chip, 0, 4).1, expected);
    }
}

#[test]
fn registers_are_written_one_behind_the_other_and_locked() {
    let mut chip = steps();
    read(&mut chip, 5, 1);
    assert_eq!(write(&mut chip, 6, &[0x23, 0x12, 0x34, 0x56, 0xAB]), 0x17);
    // The second register lacks nothing; of the third one byte is not enough.
    assert_eq!(
        (read(&mut chip, 6, 1).1, read(&mut chip, 7, 3).1, read(&mut chip, 8, 3).1),
        (0x23, 0x12_3456, 0)
    );
    write(&mut chip, 8, &[1, 2, 3]);
    assert_eq!(read(&mut chip, 8, 3).1, 0x01_0203);
    // Locked: nothing but the lock is written, and a change is told.
    write(&mut chip, 13, &[0]);
    write(&mut chip, 6, &[0x45]);
    assert_eq!(read(&mut chip, 6, 1), (0x17, 0x23));
    chip.disturb(6, 0x01);
    assert_eq!(read(&mut chip, 6, 1), (0x15, 0x22));
    write(&mut chip, 13, &[0xA5]);
    assert_eq!(read(&mut chip, 13, 1), (0x17, 0xA5));
    write(&mut chip, 6, &[0x45]);
    assert_eq!(read(&mut chip, 6, 1), (0x17, 0x45));
    // Reset by command: as after power-up, but that the supply was on.
    assert_eq!((fast(&mut chip, 0b1110), read(&mut chip, 6, 1)), (0x17, (0x17, 0x01)));
}

#[test]
fn the_checksum_follows_if_it_is_on() {
    let mut chip = steps();
    read(&mut chip, 5, 1);
    write(&mut chip, 4, &[0x04]);
    for (address, length) in [(2, 1), (10, 3), (0, 4)] {
        let mut bytes = vec![0; 3 + length];
        bytes[0] = 0x41 | address << 2;
        let answer = exchange(&mut chip, &bytes);
        let crc = crc16(0x8005, 0, &answer[..=length]);
        assert_eq!(answer[1 + length..], crc.to_be_bytes());
    }
    write(&mut chip, 4, &[0]);
    assert_eq!(exchange(&mut chip, &[0x41 | 2 << 2, 0, 0, 0]), [0x17, 0x0C, 0, 0]);
}
