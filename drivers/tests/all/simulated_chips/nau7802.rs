//! The NAU7802 on its bus, after its data sheet.

use embedded_hal::digital::InputPin;
use embedded_hal::i2c::{ErrorKind, I2c, NoAcknowledgeSource};
use fingertip_drivers::converters::nau7802::{SimulatedI2c, SimulatedNau7802};
use fingertip_drivers::converters::{Level, SimulatedBench, SimulatedDevice, WireFaults};

type Bench = SimulatedBench<SimulatedNau7802>;

fn bench(input: impl FnMut(f64, usize) -> f64 + Send + 'static) -> (Bench, SimulatedI2c) {
    let bench = SimulatedBench::new(SimulatedNau7802::new(input), WireFaults::default());
    let bus = bench.i2c();
    (bench, bus)
}

fn write(bus: &mut SimulatedI2c, bytes: &[u8]) {
    bus.write(0x2A, bytes).unwrap();
}

fn read(bus: &mut SimulatedI2c, address: u8) -> u8 {
    let mut byte = [0];
    bus.write_read(0x2A, &[address], &mut byte).unwrap();
    byte[0]
}

fn result(bus: &mut SimulatedI2c) -> i32 {
    let mut bytes = [0; 3];
    bus.write_read(0x2A, &[0x12], &mut bytes).unwrap();
    i32::from_be_bytes([bytes[0], bytes[1], bytes[2], 0]) >> 8
}

/// Powered, with a gain of 1 and converting at a rate; from then on the bench's time is that of its device.
fn started(input: impl FnMut(f64, usize) -> f64 + Send + 'static, ctrl2: u8) -> (Bench, SimulatedI2c) {
    let (bench, mut bus) = bench(input);
    write(&mut bus, &[0x00, 0x06]);
    write(&mut bus, &[0x02, ctrl2]);
    write(&mut bus, &[0x00, 0x16]);
    (bench, bus)
}

/// Counts of a share of the reference at gain 1: half of the reference is full scale, and 1000 are added.
fn counts(share: f64) -> i32 {
    (share * 2.0 * 8_388_608.0).round() as i32 + 1000
}

#[test]
fn it_powers_up_in_200_microseconds_and_forgets_all_at_a_reset() {
    let (bench, mut bus) = bench(|_, _| 0.0);
    for address in 0..0x20 {
        let expected = match address {
            0x07 | 0x0E => 0x80,
            0x1F => 0x0F,
            _ => 0,
        };
        assert_eq!(read(&mut bus, address), expected, "{address:#x}");
        assert_eq!(bench.with(|chip| chip.register(address)), expected);
    }
    write(&mut bus, &[0x00, 0x02]);
    bench.with(|chip| chip.advance(199_000));
    assert_eq!(bench.with(|chip| chip.register(0)), 0x02);
    bench.with(|chip| chip.advance(1_000));
    assert_eq!(bench.with(|chip| chip.register(0)), 0x0A);
    // The flags are not written; a digital part that is on is not switched on again.
    write(&mut bus, &[0x00, 0x26]);
    assert_eq!(bench.with(|chip| chip.register(0)), 0x0E);
    write(&mut bus, &[0x01, 0x27, 0x30]);
    write(&mut bus, &[0x00, 0x01]);
    assert_eq!([0, 1, 2, 7].map(|address| read(&mut bus, address)), [1, 0, 0, 0x80]);
    bench.with(|chip| chip.advance(1_000_000_000));
    assert_eq!((read(&mut bus, 0), bench.with(|chip| chip.conversions())), (1, 0));
    // It is powered anew after that.
    write(&mut bus, &[0x00, 0x02]);
    bench.with(|chip| chip.advance(200_000));
    assert_eq!(read(&mut bus, 0), 0x0A);
    // What it measured and its revision are not written.
    write(&mut bus, &[0x12, 1, 2, 3]);
    write(&mut bus, &[0x1F, 1]);
    assert_eq!((result(&mut bus), read(&mut bus, 0x1F)), (0, 0x0F));
    write(&mut bus, &[0x15, 0x5A]);
    assert_eq!(read(&mut bus, 0x15), 0x5A);
}

#[test]
fn each_rate_has_its_period() {
    for (rate, period) in
        [(0, 100_000_000), (1, 50_000_000), (2, 25_000_000), (3, 12_500_000), (7, 3_125_000)]
    {
        let (bench, mut bus) = started(|_, _| 0.1, rate << 4);
        let conversions = |bench: &Bench| bench.with(|chip| chip.conversions());
        bench.with(|chip| chip.advance(period - 1));
        assert_eq!((conversions(&bench), bench.with(|chip| chip.register(0))), (0, 0x1E));
        bench.with(|chip| chip.advance(1));
        assert_eq!((conversions(&bench), bench.with(|chip| chip.register(0))), (1, 0x3E));
        // Starting again does not begin anew; reading the last byte takes the flag down.
        write(&mut bus, &[0x00, 0x16]);
        read(&mut bus, 0x12);
        assert_eq!(read(&mut bus, 0) & 0x20, 0x20);
        assert_eq!(result(&mut bus), counts(0.1));
        assert_eq!(read(&mut bus, 0), 0x1E);
        bench.with(|chip| chip.advance(4 * period));
        assert_eq!(conversions(&bench), 5);
    }
    // Without its analogue part it does not run.
    let (bench, mut bus) = bench(|_, _| 0.1);
    write(&mut bus, &[0x00, 0x12]);
    bench.with(|chip| chip.advance(1_000_000_000));
    assert_eq!(bench.with(|chip| chip.conversions()), 0);
}

#[test]
fn counts_have_their_gain_offset_and_ends() {
    for gain in 0..8_u8 {
        let (bench, mut bus) = started(|_, input| if input == 0 { -1e-3 } else { 2e-3 }, 0x70);
        write(&mut bus, &[0x01, gain]);
        bench.with(|chip| chip.advance(7_000_000));
        let expected = |share: f64| counts(share * f64::from(1_u32 << gain));
        assert_eq!(result(&mut bus), expected(-1e-3));
        // The second input; each has an offset register of its own.
        write(&mut bus, &[0x02, 0xF0]);
        write(&mut bus, &[0x03, 0x00, 0x01, 0x02]);
        write(&mut bus, &[0x0A, 0xFF, 0xFE, 0xFD]);
        bench.with(|chip| chip.advance(7_000_000));
        assert_eq!(result(&mut bus), expected(2e-3) + 259);
        write(&mut bus, &[0x02, 0x70]);
        bench.with(|chip| chip.advance(7_000_000));
        assert_eq!(result(&mut bus), expected(-1e-3) - 258);
    }
    for (share, expected) in [(0.6, 8_388_607), (-0.6, -8_388_608)] {
        let (bench, mut bus) = started(move |_, _| share, 0x70);
        bench.with(|chip| chip.advance(7_000_000));
        assert_eq!(result(&mut bus), expected);
    }
    // The input is asked for the time of the conversion.
    let (bench, mut bus) = started(|time, _| time, 0x70);
    let begun = 6 * 22_500 + 3 * 22_500 + 3_125_000;
    bench.with(|chip| chip.advance(3_200_000));
    let found = result(&mut bus);
    assert!((found - counts(f64::from(begun) * 1e-9)).abs() < counts(100e-6), "{found}");
}

#[test]
fn it_calibrates_in_four_periods_or_says_that_it_cannot() {
    // Its own offset of 1000 counts, of a converter that is shorted; then the input as it is.
    for (mode, register) in [(0x74, 1000), (0x76, counts(1e-3))] {
        let (bench, mut bus) = started(|_, _| 1e-3, 0x70);
        bench.with(|chip| chip.advance(4_000_000));
        let before = bench.with(|chip| chip.conversions());
        write(&mut bus, &[0x02, mode]);
        bench.with(|chip| chip.advance(4 * 3_125_000 - 1));
        assert_eq!(bench.with(|chip| (chip.register(2), chip.conversions() - before)), (mode, 0));
        bench.with(|chip| chip.advance(1));
        assert_eq!(bench.with(|chip| chip.register(2)), mode & !4);
        let offset = [3, 4, 5].map(|address| read(&mut bus, address));
        assert_eq!(i32::from_be_bytes([0, offset[0], offset[1], offset[2]]), register);
        bench.with(|chip| chip.advance(4_000_000));
        assert_eq!(result(&mut bus), counts(1e-3) - register);
        assert!(bench.with(|chip| chip.conversions()) > before);
    }
    // The second input has the other register.
    let (bench, mut bus) = started(|_, _| 1e-3, 0xF4);
    bench.with(|chip| chip.advance(13_000_000));
    assert_eq!([3, 4, 5, 0x0A, 0x0B, 0x0C].map(|address| read(&mut bus, address)), [0, 0, 0, 0, 3, 0xE8]);
    // An input beyond the range, and the calibration of the gain.
    for (share, mode) in [(0.6, 0x76), (-0.6, 0x76), (1e-3, 0x77)] {
        let (bench, mut bus) = started(move |_, _| share, mode);
        bench.with(|chip| chip.advance(13_000_000));
        assert_eq!(read(&mut bus, 2), mode & !4 | 8);
        assert_eq!([3, 4, 5].map(|address| read(&mut bus, address)), [0; 3]);
        // The flag is taken down by writing.
        write(&mut bus, &[0x02, 0x78]);
        assert_eq!(read(&mut bus, 2), 0x70);
    }
}

#[test]
fn the_pin_says_ready_and_is_turned_round_by_its_bit() {
    let (bench, mut bus) = started(|_, _| 0.0, 0x70);
    let mut pin = bench.data_ready();
    assert!(pin.is_low().unwrap());
    bench.with(|chip| chip.advance(3_200_000));
    assert!(pin.is_high().unwrap());
    write(&mut bus, &[0x01, 0x80]);
    assert!(pin.is_low().unwrap());
    result(&mut bus);
    assert!(pin.is_high().unwrap());
    for (level, high) in [(Level::Low, false), (Level::High, true)] {
        bench.set_faults(WireFaults { stuck_ready: Some(level), ..WireFaults::default() });
        assert_eq!(pin.is_high().unwrap(), high);
    }
}

#[test]
fn the_bus_takes_its_time_and_has_its_faults() {
    let (bench, mut bus) = bench(|_, _| 0.0);
    let start = bench.now();
    let mut three = [0; 3];
    bus.write_read(0x2A, &[0x06], &mut three).unwrap();
    // The address, a byte written and three read, of 22.5 µs each.
    assert_eq!((bench.now() - start, three), (5 * 22_500, [0, 0x80, 0]));
    let nobody = Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
    assert_eq!(bus.write(0x2B, &[0]), nobody);
    bench.set_faults(WireFaults { stuck_data: Some(Level::High), ..WireFaults::default() });
    assert_eq!(bus.write(0x2A, &[0]), nobody);
    bench.set_faults(WireFaults { stuck_data: Some(Level::Low), ..WireFaults::default() });
    assert_eq!(read(&mut bus, 0x1F), 0);
    // One bit of each answer, or of each request.
    let mut seen = [0_u32; 24];
    bench.set_faults(WireFaults { answer_flip: 1.0, seed: 1, ..WireFaults::default() });
    for _ in 0..480 {
        bus.write_read(0x2A, &[0x06], &mut three).unwrap();
        let flipped = u32::from_be_bytes([0, three[0], three[1] ^ 0x80, three[2]]);
        assert_eq!(flipped.count_ones(), 1);
        seen[flipped.trailing_zeros() as usize] += 1;
    }
    assert!(seen.iter().all(|count| (1..=60).contains(count)), "{seen:?}");
    for _ in 0..50 {
        bench.with(SimulatedNau7802::reset);
        bench.set_faults(WireFaults { request_flip: 1.0, seed: 1, ..WireFaults::default() });
        // Three bytes: the address of a register and its value, and that of the next.
        bus.write(0x2A, &[0x15, 0, 0]).unwrap();
        bench.set_faults(WireFaults::default());
        let bits: u32 = (0x10..0x20).map(|at| bench.with(|chip| chip.register(at)).count_ones()).sum();
        // The revision has four; one more, or none if it is the address that is wrong.
        assert!((4..=5).contains(&bits));
    }
    assert!(bench.flips() >= 480);
}

#[test]
fn any_bit_of_a_request_may_be_flipped() {
    let (bench, mut bus) = bench(|_, _| 0.0);
    let (mut values, mut strayed) = (0, 0);
    for round in 1..=400 {
        bench.set_faults(WireFaults::default());
        write(&mut bus, &[0x15, 0]);
        bench.set_faults(WireFaults { request_flip: 1.0, seed: round, ..WireFaults::default() });
        let before = bench.flips();
        write(&mut bus, &[0x15, 0x5A]);
        assert_eq!(bench.flips() - before, 1);
        match bench.with(|chip| chip.register(0x15)) {
            0 => strayed += 1,
            value => {
                assert_eq!((value ^ 0x5A).count_ones(), 1);
                values |= value ^ 0x5A;
            }
        }
    }
    // Half of the bits are those of the address.
    assert!(values == 0xFF && (150..250).contains(&strayed), "{values:#x} {strayed}");
}
