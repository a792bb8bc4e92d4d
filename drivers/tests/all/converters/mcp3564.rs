//! The MCP3564.

use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::spi::{Mock as SpiMock, Transaction as Spi};
use fingertip_drivers::converters::mcp3564::{
    AsyncMcp3564, Channel, Configuration, Data, FastCommand, Gain, Mcp3564, Oversampling, Register,
    SimulatedMcp3564,
};
use fingertip_drivers::converters::{
    ConverterError, ConverterFault, Level, Patience, SimulatedBench, Unwired, WireFaults,
};
use fingertip_drivers::polled::NbSource;
use fingertip_drivers::{AsyncSource, Source, SourceError, SourceErrorKind};
use nalgebra::SVector;

use super::block_on;

const PATIENCE: Patience = Patience { limit: 20_000, pause: 10 };
const INPUTS: [Channel; 5] =
    [Channel::PairC, Channel::PairA, Channel::PairB, Channel::PairD, Channel::Supply];

/// A chip whose input tells the number of the conversion and the channel.
fn bench(down: bool, faults: WireFaults) -> SimulatedBench<SimulatedMcp3564> {
    let mut number = 0_u32;
    let chip = SimulatedMcp3564::new(down, move |_, channel| {
        number += 1;
        f64::from(number % 50_000 * 16 + u32::from(channel)) / 8_388_608.0 / 8.0
    });
    SimulatedBench::new(chip, faults)
}

fn configuration() -> Configuration<5> {
    Configuration {
        gain: Gain::X8,
        oversampling: Oversampling::X1024,
        lock: true,
        ..Configuration::new(INPUTS)
    }
}

/// Number of the conversion of each input, if all are of the input that they should be and of one cycle.
fn cycle(counts: [i32; 5]) -> i32 {
    let mut numbers = counts.map(|count| count / 16);
    for (count, input) in counts.iter().zip(INPUTS) {
        assert_eq!(count % 16, input as i32, "{counts:?}");
    }
    numbers.sort_unstable();
    let first = numbers[0];
    assert!(numbers == [first, first + 1, first + 2, first + 3, first + 4] || first < 5, "{numbers:?}");
    first
}

#[test]
fn whole_cycles_come_in_order_whichever_way_the_list_runs() {
    for down in [false, true] {
        let bench = bench(down, WireFaults::default());
        let mut chip: Mcp3564<_, _, _, 5> = Mcp3564::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
        assert_eq!(chip.read(), Err(ConverterFault::NotConfigured.into()));
        chip.configure(&configuration()).unwrap();
        let first = cycle(chip.read().unwrap().counts);
        for number in 1..500 {
            assert_eq!(cycle(chip.read().unwrap().counts), first + 5 * number);
        }
        // The first cycle teaches the order.
        assert_eq!((chip.statistics().conversions, chip.statistics().incomplete), (500, 5));
        // After a pause the cycle that was under way is not mixed with a new one.
        for pause in 0..20 {
            bench.advance(777_777 * pause);
            cycle(chip.read().unwrap().counts);
        }
    }
}

#[test]
fn only_the_two_ends_of_the_range_are_saturated() {
    for (counts, saturated) in [
        (-8_388_608, true),
        (-8_388_607, false),
        (-1, false),
        (1, false),
        (8_388_606, false),
        (8_388_607, true),
    ] {
        // Gain 8.
        let chip = SimulatedMcp3564::new(false, move |_, _| f64::from(counts) / 8_388_608.0 / 8.0);
        let bench = SimulatedBench::new(chip, WireFaults::default());
        let mut chip: Mcp3564<_, _, _, 5> = Mcp3564::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
        chip.configure(&configuration()).unwrap();
        let conversion = chip.read().unwrap();
        assert_eq!((conversion.counts, conversion.saturated), ([counts; 5], [saturated; 5]));
        assert_eq!(chip.statistics().saturated, u64::from(saturated));
    }
}

#[test]
fn the_other_faces_give_the_same_without_the_pin_as_well() {
    let one = bench(false, WireFaults::default());
    let mut awaited: AsyncMcp3564<_, _, _, 5> =
        AsyncMcp3564::new(one.spi(), one.ready(), one.delay(), PATIENCE);
    block_on(awaited.configure(&configuration())).unwrap();
    let sample = block_on(AsyncSource::<f32, SVector<f32, 5>>::next_sample(&mut awaited)).unwrap().unwrap();
    cycle(core::array::from_fn(|channel| sample.value[channel] as i32));
    let two = bench(true, WireFaults::default());
    let mut polled: Mcp3564<_, _, _, 5> = Mcp3564::new(two.spi(), Unwired, two.delay(), PATIENCE);
    polled.configure(&configuration()).unwrap();
    let (mut given, mut blocked) = (0, 0);
    for _ in 0..5000 {
        match NbSource::<f64, SVector<f64, 5>>::poll_sample(&mut polled) {
            Ok(sample) => {
                let value = sample.unwrap().value;
                cycle(core::array::from_fn(|channel| value[channel] as i32));
                given += 1;
            }
            Err(nb::Error::WouldBlock) => blocked += 1,
            Err(nb::Error::Other(error)) => panic!("{error}"),
        }
        two.advance(100_000);
    }
    assert!(given > 100 && blocked > 3000, "{given} {blocked}");
}

#[test]
fn flipped_bits_and_lost_ready_cost_their_cycle_and_no_wrong_one_is_given() {
    let bench = bench(true, WireFaults::default());
    let mut chip: Mcp3564<_, _, _, 5> = Mcp3564::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    chip.configure(&Configuration { lock: false, ..configuration() }).unwrap();
    chip.read().unwrap();
    // Of what is sent to it only answers are protected, so those are damaged here.
    bench.set_faults(WireFaults { answer_flip: 0.01, lost_ready: 0.01, seed: 3, ..WireFaults::default() });
    let (mut given, mut corrupt, mut last) = (0, 0, 0);
    for _ in 0..9000 {
        match chip.read() {
            Ok(conversion) => {
                let first = cycle(conversion.counts);
                assert!(first > last || first < 10);
                (given, last) = (given + 1, first);
            }
            Err(ConverterError::Fault(ConverterFault::Checksum { .. })) => corrupt += 1,
            Err(error) => panic!("{error}"),
        }
    }
    let statistics = *chip.statistics();
    println!("{given} given, {corrupt} corrupt, {statistics:?}");
    assert!(given > 8000 && corrupt > 300 && statistics.incomplete > 1000);
    assert_eq!((statistics.corrupt, statistics.conversions), (corrupt, given + 1));
}

#[test]
fn stuck_lines_a_lost_supply_and_damaged_registers_are_noticed() {
    let bench = bench(false, WireFaults::default());
    let mut chip: Mcp3564<_, _, _, 5> = Mcp3564::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    chip.configure(&configuration()).unwrap();
    chip.read().unwrap();
    for (faults, kind) in [
        (WireFaults { stuck_data: Some(Level::Low), ..WireFaults::default() }, SourceErrorKind::Corrupt),
        (WireFaults { stuck_data: Some(Level::High), ..WireFaults::default() }, SourceErrorKind::Corrupt),
        (WireFaults { stuck_ready: Some(Level::High), ..WireFaults::default() }, SourceErrorKind::Timeout),
    ] {
        bench.set_faults(faults);
        assert_eq!(chip.read().unwrap_err().kind(), kind);
        bench.set_faults(WireFaults::default());
        cycle(chip.read().unwrap().counts);
    }
    bench.set_faults(WireFaults { stuck_ready: Some(Level::Low), ..WireFaults::default() });
    for _ in 0..20 {
        cycle(chip.read().unwrap().counts);
    }
    assert!(chip.statistics().stale > 20);
    bench.set_faults(WireFaults::default());
    bench.with(|chip| chip.disturb(Register::CONFIG2, 1 << 3));
    assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
    assert_eq!(chip.read(), Err(ConverterFault::NotConfigured.into()));
    chip.configure(&configuration()).unwrap();
    cycle(chip.read().unwrap().counts);
    bench.with(SimulatedMcp3564::power_cycle);
    // It converts nothing, and says why when it is asked.
    let (timeouts, resets) = (chip.statistics().timeouts, chip.statistics().resets);
    assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
    assert_eq!(chip.read(), Err(ConverterFault::NotConfigured.into()));
    assert_eq!((chip.statistics().timeouts, chip.statistics().resets), (timeouts, resets + 1));
    assert!(chip.configure(&Configuration { device: 2, ..configuration() }).is_err());
    chip.configure(&configuration()).unwrap();
    cycle(chip.read().unwrap().counts);
    chip.command(FastCommand::Standby).unwrap();
    chip.read().unwrap_err();
    chip.command(FastCommand::Start).unwrap();
    cycle(chip.read().unwrap().counts);
}

/// Without the pin it is no silence that tells of the reset, but answers without a CRC.
#[test]
fn a_lost_supply_is_noticed_by_every_face() {
    let one = bench(false, WireFaults::default());
    let mut chip: Mcp3564<_, _, _, 5> = Mcp3564::new(one.spi(), Unwired, one.delay(), PATIENCE);
    let two = bench(false, WireFaults::default());
    let mut awaited: AsyncMcp3564<_, _, _, 5> =
        AsyncMcp3564::new(two.spi(), two.ready(), two.delay(), PATIENCE);
    for _ in 0..2 {
        chip.configure(&configuration()).unwrap();
        cycle(chip.read().unwrap().counts);
        one.with(SimulatedMcp3564::power_cycle);
        assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
        chip.configure(&configuration()).unwrap();
        one.with(SimulatedMcp3564::power_cycle);
        let polled = NbSource::<f64, SVector<f64, 5>>::poll_sample(&mut chip);
        assert_eq!(polled, Err(nb::Error::Other(ConverterFault::Reset.into())));
        block_on(awaited.configure(&configuration())).unwrap();
        two.with(SimulatedMcp3564::power_cycle);
        assert_eq!(block_on(awaited.read()), Err(ConverterFault::Reset.into()));
    }
    assert_eq!((chip.statistics().resets, chip.statistics().corrupt), (4, 0));
}

#[test]
fn a_count_beyond_the_range_is_an_error() {
    let chip =
        SimulatedMcp3564::new(false, |_, channel| if channel == Channel::PairB as u8 { 1.1 } else { -0.5 });
    let bench = SimulatedBench::new(chip, WireFaults::default());
    let mut chip: Mcp3564<_, _, _, 2> = Mcp3564::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    chip.configure(&Configuration::new([Channel::PairA, Channel::PairB])).unwrap();
    let error = Source::<f64, SVector<f64, 2>>::next_sample(&mut chip).unwrap_err();
    assert_eq!(error, ConverterFault::Saturated { channel: 1 }.into());
    // The number is there all the same, beyond 24 bits.
    assert_eq!(chip.read().unwrap().counts, [-4_194_304, 9_227_469]);
}

/// CRC-16 with 0x8005 and seed 0, bit by bit.
fn crc(bytes: &[u8]) -> [u8; 2] {
    let mut crc = 0_u16;
    for byte in bytes {
        crc ^= u16::from(*byte) << 8;
        for _ in 0..8 {
            crc = if crc & 0x8000 == 0 { crc << 1 } else { crc << 1 ^ 0x8005 };
        }
    }
    crc.to_be_bytes()
}

/// A register is asked for, and this is the whole answer.
fn answered(address: u8, answer: &[u8]) -> [Spi<u8>; 3] {
    let mut request = vec![0; answer.len()];
    request[0] = 0x41 | address << 2;
    [Spi::transaction_start(), Spi::transfer_in_place(request, answer.to_vec()), Spi::transaction_end()]
}

/// The answer has its CRC.
fn read(address: u8, status: u8, data: &[u8]) -> [Spi<u8>; 3] {
    let mut answer = vec![status];
    answer.extend(data);
    let checksum = crc(&answer);
    answer.extend(checksum);
    answered(address, &answer)
}

/// What is on the bus while a chip is configured.
fn configured(configuration: &Configuration<1>) -> Vec<Spi<u8>> {
    let write = |bytes: &[u8]| {
        let (command, values) = bytes.split_at(1);
        let mut all = vec![Spi::transaction_start(), Spi::write_vec(command.to_vec())];
        if !values.is_empty() {
            all.push(Spi::write_vec(values.to_vec()));
        }
        all.push(Spi::transaction_end());
        all
    };
    let registers = configuration.registers();
    let mut bus = write(&[0x76, 0xA5]);
    bus.extend(write(&[0x78]));
    let mut all = vec![0x46];
    all.extend(registers);
    bus.extend(write(&all));
    let mut at = 0;
    for (address, length) in (1..).zip([1, 1, 1, 1, 1, 1, 3, 3, 3, 3]) {
        bus.extend(read(address, 0x17, &registers[at..at + length]));
        at += length;
    }
    bus.extend(write(&[0x68]));
    bus
}

#[test]
fn the_bytes_on_the_bus_are_those_of_the_data_sheet() {
    let configuration = Configuration::new([Channel::PairA]);
    let mut bus = configured(&configuration);
    for counts in [1, 2] {
        bus.extend(read(0, 0x13, &Data { channel: 8, counts }.emit()));
    }
    bus.extend(read(0, 0x17, &Data { channel: 8, counts: 2 }.emit()));
    bus.extend(read(0, 0x13, &Data { channel: 8, counts: -3 }.emit()));
    bus.extend(read(0, 0x12, &Data { channel: 8, counts: -3 }.emit()));
    let spi = SpiMock::new(&bus);
    let mut chip: Mcp3564<_, _, _, 1> = Mcp3564::new(spi.clone(), Unwired, NoopDelay::new(), PATIENCE);
    chip.configure(&configuration).unwrap();
    assert_eq!(chip.read().unwrap().counts, [2]);
    assert_eq!(chip.read().unwrap().counts, [-3]);
    assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
    let (mut spi, ..) = chip.release();
    spi.done();
}

/// A damaged answer is followed by one question: what `CONFIG3` holds.
#[test]
fn the_question_whether_it_was_reset_is_one_register() {
    let configuration = Configuration::new([Channel::PairA]);
    let whole = [0x17, 0xF4, crc(&[0x17, 0xF4])[0], crc(&[0x17, 0xF4])[1]];
    for (answer, is_reset) in [([0x16, 0, 0, 0], true), (whole, false), ([0x16, 0xF4, 0, 0], false)] {
        let mut bus = configured(&configuration);
        bus.extend(answered(0, &[0x13, 0x80, 0, 0, 1, 0xAB, 0xCD]));
        bus.extend(answered(4, &answer));
        let spi = SpiMock::new(&bus);
        let mut chip: Mcp3564<_, _, _, 1> = Mcp3564::new(spi.clone(), Unwired, NoopDelay::new(), PATIENCE);
        chip.configure(&configuration).unwrap();
        let fault = chip.read().unwrap_err();
        if is_reset {
            assert_eq!(fault, ConverterFault::Reset.into());
        } else {
            let damaged =
                matches!(fault, ConverterError::Fault(ConverterFault::Checksum { found: 0xABCD, .. }));
            assert!(damaged, "{fault:?}");
        }
        let (mut spi, ..) = chip.release();
        spi.done();
    }
}

/// The data sheet's list of gains, and what of the reference is full scale at each.
#[test]
fn full_scale_is_the_reference_over_the_gain() {
    use Gain::{Third, X1, X2, X4, X8, X16, X32, X64};
    let expected = [3.0, 1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125, 0.015_625];
    for (gain, full_scale) in [Third, X1, X2, X4, X8, X16, X32, X64].into_iter().zip(expected) {
        assert!((gain.full_scale() - full_scale).abs() <= f64::EPSILON * full_scale, "{gain:?}");
        assert!((gain.factor() * full_scale - 1.0).abs() <= f64::EPSILON, "{gain:?}");
    }
}
