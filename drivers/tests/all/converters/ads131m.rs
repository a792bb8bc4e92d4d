//! The ADS131M.

use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::digital::{Mock as PinMock, State, Transaction as Pin};
use embedded_hal_mock::eh1::spi::{Mock as SpiMock, Transaction as Spi};
use fingertip_drivers::converters::ads131m::{
    Ads131m, Answer, AsyncAds131m, ChannelSetup, Configuration, Gain, Input, Oversampling, Register, Request,
    SimulatedAds131m,
};
use fingertip_drivers::converters::{
    ConverterError, ConverterFault, Level, Patience, SimulatedBench, SimulatedDelay, SimulatedLine,
    SimulatedSpi, Unwired, WireFaults,
};
use fingertip_drivers::polled::NbSource;
use fingertip_drivers::{AsyncSource, Source, SourceError, SourceErrorKind};
use nalgebra::SVector;

use super::block_on;

type Bench = SimulatedBench<SimulatedAds131m<8>>;
type Chip = Ads131m<
    SimulatedSpi<SimulatedAds131m<8>>,
    SimulatedLine<SimulatedAds131m<8>>,
    SimulatedDelay<SimulatedAds131m<8>>,
    8,
>;

const PATIENCE: Patience = Patience { limit: 3000, pause: 10 };

/// Counts from which the number of the conversion and of the channel can be read.
fn counts(number: i32) -> [i32; 8] {
    core::array::from_fn(|channel| {
        let sign = if channel % 2 == 0 { 1 } else { -1 };
        sign * (number * 8 + channel as i32)
    })
}

/// A chip at 16 kHz whose input tells the number of the conversion.
fn bench(faults: WireFaults) -> Bench {
    let mut number = 0;
    let input = move |_| {
        number += 1;
        counts(number % 1_000_000).map(|count| SimulatedAds131m::<8>::volts(count, Gain::X32))
    };
    SimulatedBench::new(SimulatedAds131m::new(input), faults)
}

fn configuration() -> Configuration<8> {
    let fast = Configuration {
        oversampling: Oversampling::X256,
        watch_registers: true,
        lock: true,
        ..Configuration::default()
    };
    fast.gain(Gain::X32)
}

fn started(bench: &Bench) -> Chip {
    let mut chip = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    chip.configure(&configuration()).unwrap();
    chip
}

#[test]
fn conversions_come_in_order_without_a_gap() {
    let bench = bench(WireFaults::default());
    let mut chip = started(&bench);
    let first = chip.read().unwrap().counts[0] / 8;
    for number in 1..20_000 {
        let conversion = chip.read().unwrap();
        assert_eq!(conversion.counts, counts((first + number) % 1_000_000));
    }
    let statistics = *chip.statistics();
    assert_eq!((statistics.conversions, statistics.stale, statistics.corrupt), (20_000, 0, 0));
    // After a pause the two that are held are old, and not given.
    bench.advance(1_000_000_000);
    chip.restart();
    let before = bench.with(|chip| fingertip_drivers::converters::SimulatedDevice::conversions(chip));
    let number = chip.read().unwrap().counts[0] / 8;
    assert!(i64::from(number) > before as i64);
}

#[test]
fn both_faces_send_the_same_and_give_the_same() {
    let (one, two) = (bench(WireFaults::default()), bench(WireFaults::default()));
    let mut blocking = started(&one);
    let mut awaited: AsyncAds131m<_, _, _, 8> =
        AsyncAds131m::new(two.spi(), two.ready(), two.delay(), PATIENCE);
    block_on(awaited.configure(&configuration())).unwrap();
    let first =
        |source: &mut Chip| Source::<f32, SVector<f32, 8>>::next_sample(source).unwrap().unwrap().value;
    let mut last = [0.0; 2];
    for number in 0..500 {
        let a = first(&mut blocking);
        let b =
            block_on(AsyncSource::<f32, SVector<f32, 8>>::next_sample(&mut awaited)).unwrap().unwrap().value;
        // The tasks' clock ticks otherwise, so that the first one may be another.
        if number > 0 {
            assert_eq!((a[0] - last[0], b[0] - last[1]), (8.0, 8.0));
        }
        last = [a[0], b[0]];
    }
    assert_eq!(blocking.statistics(), awaited.statistics());
}

#[test]
fn polling_never_gives_a_conversion_twice_and_never_waits() {
    // With the pin, and without it: then the flags of the frame say what is new.
    let bench = bench(WireFaults::default());
    let mut chip = started(&bench);
    let mut unwired: Ads131m<_, _, _, 8> = {
        let (spi, _, delay) = started(&bench).release();
        Ads131m::new(spi, Unwired, delay, PATIENCE)
    };
    unwired.configure(&configuration()).unwrap();
    let mut last = -1.0;
    let (mut given, mut blocked) = (0, 0);
    for _ in 0..20_000 {
        let next = NbSource::<f64, SVector<f64, 8>>::poll_sample(&mut unwired);
        match next {
            Ok(sample) => {
                let number = sample.unwrap().value[0] / 8.0;
                assert!(last < 0.0 || number == last + 1.0);
                (given, last) = (given + 1, number);
            }
            Err(nb::Error::WouldBlock) => blocked += 1,
            Err(nb::Error::Other(error)) => panic!("{error}"),
        }
    }
    assert!(given > 5000 && blocked > 5000, "{given} {blocked}");
    chip.configure(&configuration()).unwrap();
    assert_eq!(NbSource::<f64, SVector<f64, 8>>::poll_sample(&mut chip), Err(nb::Error::WouldBlock));
    bench.advance(70_000);
    assert!(NbSource::<f64, SVector<f64, 8>>::poll_sample(&mut chip).is_ok());
}

#[test]
fn flipped_bits_cost_their_conversion_and_no_wrong_one_is_given() {
    let bench = bench(WireFaults::default());
    let mut chip = started(&bench);
    let mut last = chip.read().unwrap().counts[0] / 8;
    bench.set_faults(WireFaults {
        answer_flip: 0.02,
        request_flip: 0.02,
        lost_ready: 0.005,
        seed: 4,
        ..WireFaults::default()
    });
    let (mut given, mut corrupt) = (0, 0);
    for _ in 0..60_000 {
        match chip.read() {
            Ok(conversion) => {
                let number = conversion.counts[0] / 8;
                assert_eq!(conversion.counts, counts(number));
                assert!(number > last || number < 1000, "{number} after {last}");
                (given, last) = (given + 1, number);
            }
            Err(ConverterError::Fault(ConverterFault::Checksum { .. })) => corrupt += 1,
            Err(error) => panic!("{error}"),
        }
    }
    let statistics = *chip.statistics();
    println!("{given} given, {corrupt} corrupt, {statistics:?}, {} flips", bench.flips());
    // The CRC is of 16 bits, all of which but the lowest eight of its word are used: flips there are harmless.
    assert_eq!(statistics.corrupt, corrupt);
    assert!(corrupt > 1000 && given + corrupt == 60_000);
    // A refused NULL is harmless, and counted as often as the chip says so in a frame that comes whole. Of
    // thirty bytes of a frame the first five matter.
    let rejected = bench.with(|chip| chip.rejected());
    assert!(rejected > 150 && statistics.rejected <= rejected && statistics.rejected > rejected * 9 / 10);
}

#[test]
fn stuck_lines_and_a_silent_pin_end_in_an_error() {
    for (faults, kind) in [
        (WireFaults { stuck_data: Some(Level::Low), ..WireFaults::default() }, SourceErrorKind::Corrupt),
        (WireFaults { stuck_data: Some(Level::High), ..WireFaults::default() }, SourceErrorKind::Corrupt),
        (WireFaults { stuck_ready: Some(Level::High), ..WireFaults::default() }, SourceErrorKind::Timeout),
    ] {
        let bench = bench(WireFaults::default());
        let mut chip = started(&bench);
        chip.read().unwrap();
        bench.set_faults(faults);
        for _ in 0..5 {
            assert_eq!(chip.read().unwrap_err().kind(), kind);
        }
        // And it goes on when the wire does; what was held meanwhile is not given.
        bench.set_faults(WireFaults::default());
        let old = bench.with(|chip| fingertip_drivers::converters::SimulatedDevice::conversions(chip));
        let next = chip.read().unwrap().counts[0] / 8;
        assert!(kind == SourceErrorKind::Corrupt || i64::from(next) > old as i64, "{next} {old}");
    }
    // Ready that is stuck low costs time, and gives nothing twice.
    let bench = bench(WireFaults { stuck_ready: Some(Level::Low), ..WireFaults::default() });
    let mut chip = started(&bench);
    let first = chip.read().unwrap().counts[0] / 8;
    for number in 1..100 {
        assert_eq!(chip.read().unwrap().counts[0] / 8, first + number);
    }
    assert!(chip.statistics().stale > 100);
    // A task that waits for a pin that never comes is told so, too.
    bench.set_faults(WireFaults { stuck_ready: Some(Level::High), ..WireFaults::default() });
    let (spi, ready, delay) = chip.release();
    let mut awaited: AsyncAds131m<_, _, _, 8> = AsyncAds131m::new(spi, ready, delay, PATIENCE);
    block_on(awaited.configure(&configuration())).unwrap();
    let before = bench.now();
    assert_eq!(block_on(awaited.read()).unwrap_err().kind(), SourceErrorKind::Timeout);
    assert!(bench.now() - before < 4_000_000);
}

#[test]
fn a_chip_that_was_reset_or_disturbed_is_noticed_before_its_numbers_are_taken() {
    let bench = bench(WireFaults::default());
    let mut chip = started(&bench);
    chip.read().unwrap();
    bench.with(SimulatedAds131m::reset);
    assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
    assert_eq!(chip.read(), Err(ConverterFault::NotConfigured.into()));
    chip.configure(&configuration()).unwrap();
    chip.read().unwrap();
    // A bit of the gain register falls over.
    bench.with(|chip| chip.disturb(Register::GAIN1, 1));
    assert_eq!(chip.read().unwrap_err().kind(), SourceErrorKind::DeviceFault);
    assert_eq!(chip.statistics().resets, 2);
    // While it is locked nothing is written.
    chip.configure(&configuration()).unwrap();
    assert!(chip.command(Request::Write { address: Register::GAIN1, value: 0 }).is_err());
    chip.command(Request::Unlock).unwrap();
    chip.command(Request::Write { address: Register::GAIN1, value: 0x0001 }).unwrap();
    assert_eq!(chip.read_register(Register::GAIN1).unwrap(), 1);
    assert_eq!(chip.read_register(Register::ID).unwrap(), 0x2800);
}

#[test]
fn another_chip_is_refused() {
    let bench = SimulatedBench::new(SimulatedAds131m::<4>::new(|_| [0.0; 4]), WireFaults::default());
    let mut eight: Ads131m<_, _, _, 8> = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    assert!(eight.configure(&Configuration::default()).is_err());
    assert_eq!(eight.read(), Err(ConverterFault::NotConfigured.into()));
    let mut four: Ads131m<_, _, _, 4> = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    four.configure(&Configuration::default()).unwrap();
    assert_eq!(four.read().unwrap().counts, [0; 4]);
}

#[test]
fn clipped_channels_are_refused_and_those_that_are_off_are_not_asked() {
    let volts = |_| [0.1, -0.2, 0.5, 0.0, 2.0, -2.0, 9.0, 0.0];
    let bench = SimulatedBench::new(SimulatedAds131m::<8>::new(volts), WireFaults::default());
    let mut chip: Ads131m<_, _, _, 8> = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    let mut configuration = Configuration::<8>::default();
    configuration.channels[6] = ChannelSetup::off();
    configuration.channels[3] =
        ChannelSetup { input: Input::PositiveTest, ..ChannelSetup::with_gain(Gain::X2) };
    chip.configure(&configuration).unwrap();
    let conversion = chip.read().unwrap();
    assert_eq!(conversion.saturated, [false, false, false, false, true, true, false, false]);
    assert_eq!((conversion.counts[5], conversion.counts[6]), (-8_388_608, 0));
    // 160 mV over the gain against 1.2 V over the gain.
    assert_eq!(conversion.counts[3], (0.16 / 1.2 * 8_388_608.0_f64).round() as i32);
    let error = Source::<f64, SVector<f64, 8>>::next_sample(&mut chip).unwrap_err();
    assert_eq!(
        (error.kind(), error),
        (SourceErrorKind::Overload, ConverterFault::Saturated { channel: 4 }.into())
    );
    configuration.channels[4] = ChannelSetup::off();
    configuration.channels[5] =
        ChannelSetup { offset: -100, gain_correction: 0x40_0000, ..ChannelSetup::default() };
    chip.configure(&configuration).unwrap();
    let value = Source::<f64, SVector<f64, 8>>::next_sample(&mut chip).unwrap().unwrap().value;
    assert_eq!(value[0], (0.1 / 1.2 * 8_388_608.0_f64).round());
    // Halved and moved by the device itself: −2 V is no longer at the end of the range.
    assert_eq!(value[5], ((-2.0 / 1.2 * 8_388_608.0 + 100.0) / 2.0_f64).round());
}

/// A frame to the chip, and what comes back.
fn frame(request: Request, answer: Answer<4>) -> [Spi<u8>; 3] {
    let (mut out, mut back) = ([0; 18], [0; 18]);
    request.emit(&mut out);
    answer.emit(&mut back);
    [Spi::transaction_start(), Spi::transfer_in_place(out.to_vec(), back.to_vec()), Spi::transaction_end()]
}

#[test]
fn the_bytes_on_the_bus_are_those_of_the_data_sheet() {
    let configuration = Configuration::<4>::default();
    let status = |response| Answer { response, counts: [0; 4] };
    let mut bus = Vec::new();
    bus.extend(frame(Request::Unlock, status(0)));
    bus.extend(frame(Request::Reset, status(0x0655)));
    bus.extend(frame(Request::Null, status(0xFF24)));
    for (address, value) in configuration.registers() {
        let acknowledged = 0x4000 | u16::from(address) << 7;
        bus.extend(frame(Request::Write { address, value }, status(0x0500)));
        bus.extend(frame(Request::Null, status(acknowledged)));
    }
    for (address, value) in configuration.registers() {
        bus.extend(frame(Request::Read { address }, status(0x0100)));
        bus.extend(frame(Request::Null, status(value)));
    }
    bus.extend(frame(Request::Null, status(0x0100)));
    // Two old ones, one that is damaged, one that holds nothing new, and one.
    bus.extend(frame(Request::Null, status(0x010F)));
    bus.extend(frame(Request::Null, status(0x010F)));
    let mut damaged = frame(Request::Null, Answer { response: 0x010F, counts: [5; 4] });
    let mut out = [0; 18];
    Request::Null.emit(&mut out);
    damaged[1] = Spi::transfer_in_place(out.to_vec(), vec![0x01; 18]);
    bus.extend(damaged);
    bus.extend(frame(Request::Null, status(0x0100)));
    bus.extend(frame(Request::Null, Answer { response: 0x010F, counts: [1, -1, 0x7F_FFFE, -0x7F_FFFF] }));
    let spi = SpiMock::new(&bus);
    let pin = PinMock::new(&[
        Pin::get(State::High),
        Pin::get(State::Low),
        Pin::get(State::Low),
        Pin::get(State::Low),
    ]);
    let mut chip: Ads131m<_, _, _, 4> = Ads131m::new(spi.clone(), pin.clone(), NoopDelay::new(), PATIENCE);
    chip.configure(&configuration).unwrap();
    assert!(matches!(chip.read(), Err(ConverterError::Fault(ConverterFault::Checksum { .. }))));
    assert_eq!(chip.read().unwrap().counts, [1, -1, 0x7F_FFFE, -0x7F_FFFF]);
    assert_eq!((chip.statistics().stale, chip.statistics().corrupt), (1, 1));
    let (mut spi, mut pin, _) = chip.release();
    spi.done();
    pin.done();
}

#[test]
fn the_pin_is_low_for_half_and_for_twice_the_time_of_a_reset() {
    use embedded_hal_mock::eh1::delay::{CheckedDelay, Transaction as Delay};
    let mut pin = PinMock::new(&[
        Pin::set(State::Low),
        Pin::set(State::High),
        Pin::set(State::Low),
        Pin::set(State::High),
    ]);
    // 1024 and 4096 clocks of 8 MHz.
    let mut delay =
        CheckedDelay::new(&[Delay::delay_ns(128_000), Delay::delay_ns(512_000), Delay::delay_us(10)]);
    let spi = SpiMock::new(&[]);
    let mut chip: Ads131m<_, _, _, 8> = Ads131m::new(spi, Unwired, delay.clone(), PATIENCE);
    chip.synchronise(&mut pin, 8_000_000).unwrap();
    chip.reset(&mut pin, 8_000_000).unwrap();
    let (mut spi, _, _) = chip.release();
    spi.done();
    pin.done();
    delay.done();
}
