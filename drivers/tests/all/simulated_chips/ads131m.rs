//! The ADS131M04, after its data sheet: frames of six words of 24 bits.

use fingertip_drivers::converters::SimulatedDevice;
use fingertip_drivers::converters::ads131m::SimulatedAds131m;

use super::{crc16, exchange};

type Chip = SimulatedAds131m<4>;

/// Counts that a channel gives at gain 1 for volts: 1.2 V are 2²³.
fn counts(volts: f64) -> i32 {
    (volts / 1.2 * 8_388_608.0).round() as i32
}

/// A frame of words of 16 bits with a right CRC behind them: what the chip answers first, and its channels.
fn frame(chip: &mut Chip, words: &[u16]) -> (u16, [i32; 4]) {
    let mut bytes = [0; 18];
    for (place, word) in bytes.as_chunks_mut::<3>().0.iter_mut().zip(words) {
        [place[0], place[1]] = word.to_be_bytes();
    }
    let covered = 3 * words.len();
    let crc = crc16(0x1021, 0xFFFF, &bytes[..covered]);
    bytes[covered..covered + 2].copy_from_slice(&crc.to_be_bytes());
    answered(&exchange(chip, &bytes))
}

fn answered(answer: &[u8]) -> (u16, [i32; 4]) {
    assert_eq!(crc16(0x1021, 0xFFFF, &answer[..15]).to_be_bytes(), answer[15..17]);
    let channel = |at: usize| i32::from_be_bytes([answer[at], answer[at + 1], answer[at + 2], 0]) >> 8;
    (u16::from_be_bytes([answer[0], answer[1]]), [channel(3), channel(6), channel(9), channel(12)])
}

/// What the chip answers to a command, in the next frame.
fn ask(chip: &mut Chip, words: &[u16]) -> u16 {
    frame(chip, words);
    frame(chip, &[0]).0
}

fn write(address: u16, value: u16) -> [u16; 2] {
    [0x6000 | address << 7, value]
}

fn read(chip: &mut Chip, address: u16) -> u16 {
    ask(chip, &[0xA000 | address << 7])
}

fn still() -> Chip {
    Chip::new(|_| [0.1, -0.2, 0.3, 0.4])
}

#[test]
fn after_power_up_the_registers_are_those_of_the_data_sheet() {
    let mut chip = still();
    // The reset is acknowledged with the number of channels; then comes the status, with its reset flag.
    assert_eq!((frame(&mut chip, &[0]).0, frame(&mut chip, &[0]).0), (0xFF24, 0x0500));
    for (address, value) in [
        (0, 0x2400),
        (1, 0x0500),
        (2, 0x0510),
        (3, 0x0F0E),
        (4, 0),
        (6, 0x0600),
        (9, 0),
        (12, 0x8000),
        (63, 0),
    ] {
        assert_eq!(read(&mut chip, address), value, "{address:#x}");
        if address != 1 {
            assert_eq!(chip.register(address as u8), value);
        }
    }
}

#[test]
fn conversions_come_at_the_rate_of_the_clock_register() {
    // Power mode by 8, 4 and 2, and 128 times two to the power of the oversampling, at 8.192 MHz.
    for (clock, period) in
        [(0x0F0E, 250_000), (0x0F02, 31_250), (0x0F01, 62_500), (0x0F00, 125_000), (0x0F1E, 4_000_000)]
    {
        let mut chip = Chip::new(|time| [time, 0.0, 0.0, 0.0]);
        chip.advance(77_000);
        frame(&mut chip, &write(3, clock));
        frame(&mut chip, &[0]);
        let before = chip.conversions();
        chip.advance(period - 1);
        assert_eq!((chip.conversions() - before, chip.is_ready()), (0, false));
        chip.advance(1);
        assert_eq!((chip.conversions() - before, chip.is_ready()), (1, true));
        let time = (77_000 + period) as f64 * 1e-9;
        assert_eq!(frame(&mut chip, &[0]).1[0], counts(time));
        chip.advance(10 * period);
        assert_eq!(chip.conversions() - before, 11);
    }
    // A reset begins anew as well.
    let mut chip = still();
    chip.advance(200_000);
    chip.reset();
    chip.advance(249_999);
    assert_eq!(chip.conversions(), 0);
    chip.advance(1);
    assert_eq!(chip.conversions(), 1);
}

#[test]
fn two_conversions_are_held_and_the_older_one_comes_first() {
    let mut chip = Chip::new(|time| [time, 0.0, 0.0, 0.0]);
    frame(&mut chip, &[0]);
    chip.advance(750_000);
    let at = |periods: f64| counts(periods * 250e-6);
    let given = |chip: &mut Chip| {
        let (status, channels) = frame(chip, &[0]);
        (status, channels[0])
    };
    // Of three the first is lost; behind the last nothing is fresh.
    assert_eq!(given(&mut chip), (0x050F, at(2.0)));
    assert!(chip.is_ready());
    assert_eq!(given(&mut chip), (0x050F, at(3.0)));
    assert!(!chip.is_ready());
    assert_eq!(given(&mut chip), (0x0500, at(3.0)));
    // A reset forgets what is held.
    chip.advance(250_000);
    chip.reset();
    assert!(!chip.is_ready());
}

#[test]
fn each_channel_has_its_gain_input_offset_and_correction() {
    let mut chip = still();
    let mut convert = |writes: &[(u16, u16)]| {
        for (address, value) in writes {
            assert_eq!(ask(&mut chip, &write(*address, *value)), 0x4000 | address << 7);
        }
        chip.advance(250_000);
        frame(&mut chip, &[0]).1
    };
    assert_eq!(convert(&[]), [0.1, -0.2, 0.3, 0.4].map(counts));
    // Gains 8, 4, 2 and 1, the first channel's in the lowest bits.
    assert_eq!(convert(&[(4, 0x0123)]), [0.8, -0.8, 0.6, 0.4].map(counts));
    // Beyond the range it clips.
    assert_eq!(
        convert(&[(4, 0x3033)]),
        [0.8, -1.6, 0.3, 3.2].map(|v| counts(v).clamp(-8_388_608, 8_388_607))
    );
    // The first two shorted and at the positive test signal, the third at the negative one; 160 mV over the gain.
    let inputs = [(4, 0), (9, 1), (14, 2), (19, 3)];
    assert_eq!(convert(&inputs), [0.0, 0.16, -0.16, 0.4].map(counts));
    // Offsets of 0x000102 and −0x000102 taken off, then half of it.
    let plain = convert(&[(9, 0), (14, 0), (19, 0)]);
    let offsets = [(10, 0x0001), (11, 0x0200), (15, 0xFFFE), (16, 0xFE00)];
    assert_eq!(convert(&offsets), [plain[0] - 258, plain[1] + 258, plain[2], plain[3]]);
    let halved = convert(&[(12, 0x4000), (13, 0x0000)]);
    assert!(
        (2 * halved[0] - (plain[0] - 258)).abs() <= 1 && halved[1..] == [plain[1] + 258, plain[2], plain[3]]
    );
    // 0x800001 over 0x800000.
    let most = (f64::from(plain[2]) * (8_388_609.0 / 8_388_608.0)).round() as i32;
    assert_eq!(convert(&[(23, 0x0100)])[2], most);
    // The second and the fourth off.
    let on = convert(&[(3, 0x050E)]);
    assert_eq!((on[1], on[3], on[2]), (0, 0, most));
    assert_eq!(chip.register(3), 0x050E);
}

#[test]
fn a_chip_with_eight_channels_has_a_second_register_of_gains() {
    let mut chip = SimulatedAds131m::<8>::new(|_| [0.01; 8]);
    for (address, value) in [(4, 0x0010_u16), (5, 0x2003)] {
        let mut bytes = [0; 30];
        let [high, low] = (0x6000_u16 | address << 7).to_be_bytes();
        [bytes[0], bytes[1]] = [high, low];
        [bytes[3], bytes[4]] = value.to_be_bytes();
        exchange(&mut chip, &bytes);
    }
    chip.advance(250_000);
    let answer = exchange(&mut chip, &[0; 30]);
    let found: Vec<i32> =
        answer[3..27].chunks(3).map(|word| i32::from_be_bytes([word[0], word[1], word[2], 0]) >> 8).collect();
    assert_eq!(found, [1.0, 2.0, 1.0, 1.0, 8.0, 1.0, 1.0, 4.0].map(|gain| counts(0.01 * gain)));
}

#[test]
fn commands_are_acknowledged_and_a_locked_chip_takes_none() {
    let mut chip = still();
    for word in [0x0022, 0x0033, 0x0555] {
        assert_eq!(ask(&mut chip, &[word]), word);
    }
    // It is locked: registers are read and not written, and it is not reset.
    assert_eq!(frame(&mut chip, &[0]).0, 0x8500);
    assert_eq!(ask(&mut chip, &write(4, 0x1111)), 0x8500);
    assert_eq!(ask(&mut chip, &[0x0011]), 0x8500);
    assert_eq!((read(&mut chip, 4), read(&mut chip, 3)), (0, 0x0F0E));
    assert_eq!(ask(&mut chip, &[0x0655]), 0x0655);
    assert_eq!(frame(&mut chip, &[0]).0, 0x0500);
    assert_eq!(ask(&mut chip, &write(4, 0x1111)), 0x4200);
    assert_eq!(read(&mut chip, 4), 0x1111);
    // Status and identity are not written.
    assert_eq!(ask(&mut chip, &write(0, 0xFFFF)), 0x4000);
    assert_eq!(ask(&mut chip, &write(1, 0xFFFF)), 0x4080);
    ask(&mut chip, &write(0x3E, 0xFFFF));
    assert_eq!((read(&mut chip, 0), read(&mut chip, 1), read(&mut chip, 0x3E)), (0x2400, 0x0500, 0));
    // A reset, and a word that is no command.
    assert_eq!(ask(&mut chip, &[0x0011]), 0xFF24);
    assert_eq!(read(&mut chip, 4), 0);
    assert_eq!(ask(&mut chip, &[0x0001]), 0x0500);
}

#[test]
fn a_wrong_checksum_is_refused_if_it_is_asked_for() {
    let mut chip = still();
    let mut wrong = [0; 18];
    [wrong[0], wrong[1], wrong[3]] = [0x62, 0x00, 0x11];
    exchange(&mut chip, &wrong);
    assert_eq!((frame(&mut chip, &[0]).0, chip.rejected(), chip.register(4)), (0x4200, 0, 0x1100));
    // Checked from now on, the reset flag taken down.
    assert_eq!(ask(&mut chip, &write(2, 0x1110)), 0x4100);
    wrong[3] = 0x22;
    exchange(&mut chip, &wrong);
    assert_eq!((chip.rejected(), chip.register(4)), (1, 0x1100));
    // The flag is up until the status is read.
    assert_eq!((frame(&mut chip, &[0]).0, frame(&mut chip, &[0]).0), (0x1100, 0x0100));
    ask(&mut chip, &write(4, 0x0022));
    assert_eq!((chip.rejected(), chip.register(4)), (1, 0x0022));
}

#[test]
fn registers_that_change_are_told_if_they_are_watched() {
    let mut chip = still();
    ask(&mut chip, &write(2, 0x0110));
    chip.disturb(4, 0x0001);
    assert_eq!((chip.register(4), frame(&mut chip, &[0]).0), (1, 0x0100));
    // Watched from now on: writing raises the flag, too.
    ask(&mut chip, &write(2, 0x2110));
    assert_eq!((frame(&mut chip, &[0]).0, frame(&mut chip, &[0]).0), (0x2100, 0x0100));
    chip.disturb(4, 0x0011);
    assert_eq!(
        (chip.register(4), frame(&mut chip, &[0]).0, frame(&mut chip, &[0]).0),
        (0x10, 0x2100, 0x0100)
    );
}

#[test]
fn words_that_were_not_sent_are_zeros() {
    let mut chip = still();
    for value in [0x0712, 0x0510] {
        frame(&mut chip, &write(4, 0x1234));
        assert_eq!(read(&mut chip, 4), 0x1234);
        exchange(&mut chip, &[0x62, 0, 0]);
        assert_eq!(read(&mut chip, 4), 0);
        assert_eq!(chip.rejected(), 0);
        frame(&mut chip, &write(2, value));
    }
    // With a checksum, the one of the request before is none of this one.
    frame(&mut chip, &write(2, 0x1510));
    frame(&mut chip, &write(4, 0x1234));
    exchange(&mut chip, &[0x62, 0, 0]);
    assert_eq!((chip.register(4), chip.rejected()), (0x1234, 1));
}
