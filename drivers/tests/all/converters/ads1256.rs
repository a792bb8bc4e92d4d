//! The ADS1256.

use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::spi::{Mock as SpiMock, Transaction as Spi};
use fingertip_drivers::converters::ads1256::{
    Ads1256, AsyncAds1256, Calibration, Configuration, Gain, Input, Pin, Rate, SimulatedAds1256,
};
use fingertip_drivers::converters::{
    ConverterFault, Level, Patience, SimulatedBench, SimulatedDelay, SimulatedLine, SimulatedSpi, Unwired,
    WireFaults,
};
use fingertip_drivers::polled::NbSource;
use fingertip_drivers::{AsyncSource, Source, SourceError, SourceErrorKind};
use nalgebra::SVector;

use super::block_on;

const PATIENCE: Patience = Patience { limit: 20_000, pause: 10 };
const INPUTS: [Input; 3] =
    [Input::SECOND, Input { positive: Pin::Ain7, negative: Pin::Common }, Input::FIRST];

/// A chip whose input tells the pins.
fn bench(faults: WireFaults) -> SimulatedBench<SimulatedAds1256> {
    let chip = SimulatedAds1256::new(|_, positive, negative| {
        f64::from(i32::from(positive) * 1000 - i32::from(negative)) * 2.0 / 64.0 / 8_388_607.0
    });
    SimulatedBench::new(chip, faults)
}

const EXPECTED: [i32; 3] = [1997, 6992, -1];

type Chip = Ads1256<
    SimulatedSpi<SimulatedAds1256>,
    SimulatedLine<SimulatedAds1256>,
    SimulatedDelay<SimulatedAds1256>,
    3,
>;

fn started(bench: &SimulatedBench<SimulatedAds1256>) -> Chip {
    let mut chip = Ads1256::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    chip.configure(&Configuration { rate: Rate::Hz30000, ..Configuration::new(INPUTS) }).unwrap();
    chip
}

#[test]
fn each_number_is_of_the_input_that_it_is_said_to_be_and_all_times_are_kept() {
    let bench = bench(WireFaults::default());
    let mut chip = started(&bench);
    let start = bench.now();
    for _ in 0..1000 {
        assert_eq!(chip.read().unwrap().counts, EXPECTED);
    }
    // 3000 inputs at 4374 a second at most (table 14), and within 1 % of what their settling takes.
    let rate = 3000.0 / ((bench.now() - start) as f64 * 1e-9);
    println!("{rate:.0} inputs a second on a bus of 10 MHz");
    assert!(rate > 3500.0 && rate < 4500.0);
    assert_eq!(bench.with(|chip| chip.hurried()), 0);
    bench.advance(50_000_000);
    chip.restart().unwrap();
    assert_eq!(chip.read().unwrap().counts, EXPECTED);
    chip.calibrate(Calibration::Own).unwrap();
    assert_eq!(chip.read().unwrap().counts, EXPECTED);
}

#[test]
fn one_input_is_converted_without_beginning_anew() {
    let mut number = 0;
    let chip = SimulatedAds1256::new(move |_, _, _| {
        number += 1;
        f64::from(number) * 2.0 / 8_388_607.0
    });
    let bench = SimulatedBench::new(chip, WireFaults::default());
    let mut chip: Ads1256<_, _, _, 1> = Ads1256::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    chip.configure(&Configuration { gain: Gain::X1, ..Configuration::new([Input::FIRST]) }).unwrap();
    let first = chip.read().unwrap().counts[0];
    for number in 1..200 {
        assert_eq!(chip.read().unwrap().counts, [first + number]);
    }
}

#[test]
fn the_other_faces_give_the_same_without_the_pin_as_well() {
    let one = bench(WireFaults::default());
    let mut awaited: AsyncAds1256<_, _, _, 3> =
        AsyncAds1256::new(one.spi(), one.ready(), one.delay(), PATIENCE);
    block_on(awaited.configure(&Configuration::new(INPUTS))).unwrap();
    let sample = block_on(AsyncSource::<f32, SVector<f32, 3>>::next_sample(&mut awaited)).unwrap().unwrap();
    assert_eq!(sample.value, nalgebra::Vector3::from(EXPECTED.map(|count| count as f32)));
    let two = bench(WireFaults::default());
    let mut polled: Ads1256<_, _, _, 3> = Ads1256::new(two.spi(), Unwired, two.delay(), PATIENCE);
    polled.configure(&Configuration::new(INPUTS)).unwrap();
    let (mut given, mut blocked) = (0, 0);
    for _ in 0..2000 {
        match NbSource::<f64, SVector<f64, 3>>::poll_sample(&mut polled) {
            Ok(sample) => {
                assert_eq!(sample.unwrap().value, nalgebra::Vector3::from(EXPECTED.map(f64::from)));
                given += 1;
            }
            Err(nb::Error::WouldBlock) => blocked += 1,
            Err(nb::Error::Other(error)) => panic!("{error}"),
        }
        two.advance(200_000);
    }
    assert!(given > 90 && blocked > 1500, "{given} {blocked}");
}

#[test]
fn a_reset_a_multiplexer_that_does_not_obey_and_stuck_lines_are_noticed() {
    for faults in [
        WireFaults { stuck_data: Some(Level::Low), ..WireFaults::default() },
        WireFaults { stuck_data: Some(Level::High), ..WireFaults::default() },
    ] {
        let bench = bench(WireFaults::default());
        let mut chip = started(&bench);
        chip.read().unwrap();
        bench.set_faults(faults);
        assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
        assert!(chip.configure(&Configuration::new(INPUTS)).is_err());
        bench.set_faults(WireFaults::default());
        chip.configure(&Configuration::new(INPUTS)).unwrap();
        assert_eq!(chip.read().unwrap().counts, EXPECTED);
    }
    let bench = bench(WireFaults::default());
    let mut chip = started(&bench);
    bench.with(SimulatedAds1256::reset);
    assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
    assert_eq!(chip.read(), Err(ConverterFault::NotConfigured.into()));
    chip.configure(&Configuration::new(INPUTS)).unwrap();
    bench.set_faults(WireFaults { stuck_ready: Some(Level::High), ..WireFaults::default() });
    assert_eq!(chip.read().unwrap_err().kind(), SourceErrorKind::Timeout);
    bench.set_faults(WireFaults { stuck_ready: Some(Level::Low), ..WireFaults::default() });
    for _ in 0..20 {
        assert_eq!(chip.read().unwrap().counts, EXPECTED);
    }
    assert!(chip.statistics().stale > 20);
    // What is sent to it gets damaged: a multiplexer that stands elsewhere, or a command that is another, is an
    // error and not a number of another input.
    bench.set_faults(WireFaults {
        request_flip: 0.02,
        answer_flip: 0.02,
        lost_ready: 0.02,
        seed: 8,
        ..WireFaults::default()
    });
    let (mut given, mut refused) = (0, 0);
    for _ in 0..4000 {
        match chip.read() {
            Ok(conversion) => {
                given += 1;
                assert_eq!(conversion.counts, EXPECTED);
            }
            Err(_) => {
                refused += 1;
                while chip
                    .configure(&Configuration { rate: Rate::Hz30000, ..Configuration::new(INPUTS) })
                    .is_err()
                {}
            }
        }
    }
    println!("{given} given, {refused} refused");
    assert!(given > 3000 && refused > 20);
}

#[test]
fn an_end_of_the_range_is_an_error() {
    let bench = SimulatedBench::new(
        SimulatedAds1256::new(|_, positive, _| if positive == 2 { 9.0 } else { 0.0 }),
        WireFaults::default(),
    );
    let mut chip: Ads1256<_, _, _, 3> = Ads1256::new(bench.spi(), bench.ready(), bench.delay(), PATIENCE);
    chip.configure(&Configuration::new(INPUTS)).unwrap();
    let error = Source::<f64, SVector<f64, 3>>::next_sample(&mut chip).unwrap_err();
    assert_eq!(
        (error, error.kind()),
        (ConverterFault::Saturated { channel: 0 }.into(), SourceErrorKind::Overload)
    );
}

#[test]
fn the_bytes_on_the_bus_are_those_of_the_data_sheet() {
    let (t6, t11, sync) = (6511, 521, 3125);
    let send = |bytes: &[u8]| {
        vec![
            Spi::transaction_start(),
            Spi::write_vec(bytes.to_vec()),
            Spi::delay(t11),
            Spi::transaction_end(),
        ]
    };
    let registers = |answer: &[u8]| {
        let number = answer.len() as u8 - 1;
        vec![
            Spi::transaction_start(),
            Spi::write_vec(vec![0x10, number]),
            Spi::delay(t6),
            Spi::read_vec(answer.to_vec()),
            Spi::delay(t11),
            Spi::transaction_end(),
        ]
    };
    let cycle = |mux: u8, data: [u8; 3], again: [u8; 3]| {
        vec![
            Spi::transaction_start(),
            Spi::write_vec(vec![0x51, 0, mux]),
            Spi::delay(t11),
            Spi::write_vec(vec![0xFC]),
            Spi::delay(sync),
            Spi::write_vec(vec![0x00]),
            Spi::delay(t11),
            Spi::write_vec(vec![0x01]),
            Spi::delay(t6),
            Spi::read_vec(data.to_vec()),
            Spi::delay(t11),
            Spi::write_vec(vec![0x01]),
            Spi::delay(t6),
            Spi::read_vec(again.to_vec()),
            Spi::delay(t11),
            Spi::transaction_end(),
        ]
    };
    let mut bus = Vec::new();
    bus.extend(send(&[0x0F]));
    bus.extend(send(&[0xFE]));
    bus.extend(registers(&[0x31]));
    bus.extend(registers(&[0x30]));
    bus.extend(send(&[0x50, 3, 0x02, 0x01, 0x06, 0xA1]));
    bus.extend(registers(&[0x33, 0x01, 0x06, 0xA1]));
    bus.extend(send(&[0xF0]));
    bus.extend(registers(&[0x32]));
    bus.extend(send(&[0x51, 0, 0x01]));
    bus.extend(send(&[0xFC]));
    bus.extend(send(&[0x00]));
    bus.extend(registers(&[0x33, 0x01, 0x06, 0xA1]));
    bus.extend(registers(&[0x32, 0x01, 0x06, 0xA1]));
    bus.extend(cycle(0x23, [0xFF, 0xFF, 0xFE], [0xFF, 0xFF, 0xFE]));
    bus.extend(registers(&[0x32, 0x23, 0x06, 0xA1]));
    bus.extend(cycle(0x01, [0x12, 0x34, 0x56], [0x12, 0x34, 0x56]));
    // One that differs when it is read again costs its cycle.
    bus.extend(registers(&[0x32, 0x01, 0x06, 0xA1]));
    bus.extend(cycle(0x23, [0x01, 0, 0], [0x01, 0, 1]));
    bus.extend(registers(&[0x32, 0x23, 0x06, 0xA1]));
    bus.extend(cycle(0x01, [0x12, 0x34, 0x56], [0x12, 0x34, 0x56]));
    // The multiplexer did not obey.
    bus.extend(registers(&[0x32, 0x23, 0x06, 0xA1]));
    let spi = SpiMock::new(&bus);
    let mut chip: Ads1256<_, _, _, 2> = Ads1256::new(spi.clone(), Unwired, NoopDelay::new(), PATIENCE);
    chip.configure(&Configuration::new([Input::FIRST, Input::SECOND])).unwrap();
    assert_eq!(chip.read().unwrap().counts, [-2, 0x12_3456]);
    assert_eq!(chip.read(), Err(ConverterFault::Answer { expected: 0x1_0000, found: 0x1_0001 }.into()));
    assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
    let statistics = *chip.statistics();
    assert_eq!((statistics.conversions, statistics.stale, statistics.saturated), (1, 1, 0));
    assert_eq!((statistics.corrupt, statistics.resets, statistics.timeouts), (1, 1, 0));
    let (mut spi, ..) = chip.release();
    spi.done();
}

#[test]
fn a_call_that_is_dropped_anywhere_does_no_harm() {
    use core::future::Future;
    use core::pin::pin;
    use core::task::{Context, Waker};
    /// A bus whose transactions take two looks: one before and one after.
    struct Slow(SimulatedSpi<SimulatedAds1256>);
    impl embedded_hal::spi::ErrorType for Slow {
        type Error = core::convert::Infallible;
    }
    impl embedded_hal_async::spi::SpiDevice for Slow {
        async fn transaction(
            &mut self,
            operations: &mut [embedded_hal::spi::Operation<'_, u8>],
        ) -> Result<(), Self::Error> {
            pause().await;
            embedded_hal::spi::SpiDevice::transaction(&mut self.0, operations)?;
            pause().await;
            Ok(())
        }
    }
    async fn pause() {
        let mut asked = false;
        core::future::poll_fn(|_| {
            if core::mem::replace(&mut asked, true) {
                core::task::Poll::Ready(())
            } else {
                core::task::Poll::Pending
            }
        })
        .await;
    }
    let bench = bench(WireFaults::default());
    let mut chip: AsyncAds1256<_, _, _, 3> =
        AsyncAds1256::new(Slow(bench.spi()), bench.ready(), bench.delay(), PATIENCE);
    block_on(chip.configure(&Configuration { rate: Rate::Hz30000, ..Configuration::new(INPUTS) })).unwrap();
    for looks in 0..400 {
        {
            let mut reading = pin!(chip.read());
            for _ in 0..looks {
                if reading.as_mut().poll(&mut Context::from_waker(Waker::noop())).is_ready() {
                    break;
                }
            }
        }
        assert_eq!(block_on(chip.read()).unwrap().counts, EXPECTED, "{looks} looks");
    }
}
