//! Several HX711 on one clock line.

use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::digital::{Mock as PinMock, State, Transaction as Pin};
use fingertip_drivers::converters::hx711::{AsyncHx711, Hx711, Mode, SimulatedHx711s};
use fingertip_drivers::converters::{ConverterFault, Level, Patience, SimulatedBench, WireFaults};
use fingertip_drivers::polled::NbSource;
use fingertip_drivers::{AsyncSource, Source, SourceError, SourceErrorKind};
use nalgebra::{SVector, Vector3};

use super::block_on;

const PATIENCE: Patience = Patience { limit: 200_000, pause: 50 };

fn bench(faults: WireFaults) -> SimulatedBench<SimulatedHx711s<3>> {
    // Millivolts per volt, more at input B.
    SimulatedBench::new(SimulatedHx711s::new(|_| [(1e-3, 8e-3), (-2e-3, -15e-3), (3.9e-3, 5e-3)]), faults)
}

fn expected(mode: Mode) -> Vector3<f64> {
    let ratios = if mode == Mode::B32 { [8e-3, -15e-3, 5e-3] } else { [1e-3, -2e-3, 3.9e-3] };
    Vector3::from(ratios.map(|ratio| (ratio / mode.full_scale() * 8_388_608.0).round()))
}

#[test]
fn gains_and_inputs_are_set_by_the_pulses_and_nothing_unsettled_is_given() {
    let bench = bench(WireFaults::default());
    let mut chips = Hx711::new(bench.clock(), bench.data(), bench.delay(), Mode::B32, PATIENCE);
    assert_eq!(chips.read(), Err(ConverterFault::NotConfigured.into()));
    chips.start().unwrap();
    for mode in [Mode::B32, Mode::A128, Mode::A64, Mode::B32] {
        chips.set_mode(mode);
        for _ in 0..20 {
            let sample = Source::<f64, SVector<f64, 3>>::next_sample(&mut chips).unwrap().unwrap();
            assert_eq!(sample.value, expected(mode), "{mode:?}");
        }
    }
    // Powered down and up again, they begin with input A at 128 and come back to what was asked for.
    chips.power_down().unwrap();
    assert_eq!(chips.read(), Err(ConverterFault::NotConfigured.into()));
    let resets = bench.with(|chips| chips.resets());
    chips.start().unwrap();
    assert!(bench.with(|chips| chips.resets()) > resets);
    assert_eq!(
        Source::<f64, SVector<f64, 3>>::next_sample(&mut chips).unwrap().unwrap().value,
        expected(Mode::B32)
    );
}

#[test]
fn the_other_faces_give_the_same() {
    let bench = bench(WireFaults::default());
    let mut chips =
        AsyncHx711::new(bench.clock(), bench.data(), bench.delay(), bench.delay(), Mode::A64, PATIENCE);
    block_on(chips.start()).unwrap();
    let sample = block_on(AsyncSource::<f32, SVector<f32, 3>>::next_sample(&mut chips)).unwrap().unwrap();
    assert_eq!(sample.value, expected(Mode::A64).cast::<f32>());
    let (clock, data, (delay, _)) = chips.release();
    let mut polled = Hx711::new(clock, data, delay, Mode::A128, PATIENCE);
    polled.start().unwrap();
    let (mut given, mut blocked) = (0, 0);
    for _ in 0..3000 {
        match NbSource::<f64, SVector<f64, 3>>::poll_sample(&mut polled) {
            Ok(sample) => {
                assert_eq!(sample.unwrap().value, expected(Mode::A128));
                given += 1;
            }
            Err(nb::Error::WouldBlock) => blocked += 1,
            Err(nb::Error::Other(error)) => panic!("{error}"),
        }
        bench.advance(1_000_000);
    }
    // Three seconds at 80 Hz, less what was thrown away.
    assert!(given > 220 && given <= 240 && blocked > 2500, "{given} {blocked}");
}

#[test]
fn stuck_lines_and_ends_of_the_range_are_errors() {
    let bench = bench(WireFaults::default());
    let mut chips = Hx711::new(bench.clock(), bench.data(), bench.delay(), Mode::A128, PATIENCE);
    chips.start().unwrap();
    chips.read().unwrap();
    bench.set_faults(WireFaults { stuck_data: Some(Level::Low), ..WireFaults::default() });
    assert_eq!(chips.read(), Err(ConverterFault::Stuck { channel: 0 }.into()));
    bench.set_faults(WireFaults { stuck_data: Some(Level::High), ..WireFaults::default() });
    let before = bench.now();
    assert_eq!(chips.read().unwrap_err().kind(), SourceErrorKind::Timeout);
    assert!(bench.now() - before < 250_000_000);
    bench.set_faults(WireFaults::default());
    let conversion = chips.read().unwrap();
    assert_eq!(Vector3::from(conversion.counts.map(f64::from)), expected(Mode::A128));

    let wide =
        SimulatedBench::new(SimulatedHx711s::new(|_| [(1e-3, 0.0), (5e-3, 0.0)]), WireFaults::default());
    let mut chips = Hx711::new(wide.clock(), wide.data(), wide.delay(), Mode::A128, PATIENCE);
    chips.start().unwrap();
    let error = Source::<f64, SVector<f64, 2>>::next_sample(&mut chips).unwrap_err();
    assert_eq!(
        (error, error.kind()),
        (ConverterFault::Saturated { channel: 1 }.into(), SourceErrorKind::Overload)
    );
    assert_eq!(chips.statistics().saturated, 1);
}

#[test]
fn a_pulse_that_is_too_long_resets_the_chips_and_the_simulator_shows_what_that_looks_like() {
    // As the module says: nothing on the wires tells. The chips must settle again before they are ready.
    let bench = bench(WireFaults::default());
    let mut chips = Hx711::new(bench.clock(), bench.data(), bench.delay(), Mode::A64, PATIENCE);
    chips.start().unwrap();
    chips.read().unwrap();
    let resets = bench.with(|chips| chips.resets());
    let mut clock = bench.clock();
    use embedded_hal::digital::OutputPin;
    clock.set_high().unwrap();
    bench.advance(70_000);
    clock.set_low().unwrap();
    assert_eq!(bench.with(|chips| chips.resets()), resets + 1);
    // What comes next is input A at 128 in place of 64: `start` is needed, and then it is right again.
    assert_eq!(Vector3::from(chips.read().unwrap().counts.map(f64::from)), expected(Mode::A128));
    chips.start().unwrap();
    assert_eq!(Vector3::from(chips.read().unwrap().counts.map(f64::from)), expected(Mode::A64));
}

#[test]
fn the_pulses_are_those_of_the_data_sheet() {
    // Two chips: −2 and 0x5A5A5A, read with 27 pulses while the output settles (once after the start), and again.
    let words = [0xFF_FFFE_u32, 0x5A_5A5A];
    let reading = |pin: &mut Vec<Pin>, clock: &mut Vec<Pin>, word: u32, pulses: u32| {
        for pulse in 0..pulses {
            clock.extend([Pin::set(State::High), Pin::set(State::Low)]);
            let bit = pulse >= 24 || word >> (23 - pulse) & 1 == 1;
            pin.push(Pin::get(if bit { State::High } else { State::Low }));
        }
        pin.push(Pin::get(State::High));
    };
    let mut clock = vec![Pin::set(State::Low), Pin::set(State::High), Pin::set(State::Low)];
    let mut unused = Vec::new();
    let mut pins = [Vec::new(), Vec::new()];
    // Five to settle after a start in another mode than A128, and the one that is given.
    for _ in 0..6 {
        for (pin, word) in pins.iter_mut().zip(words) {
            // Waited for, looked at once more together.
            pin.extend([Pin::get(State::Low), Pin::get(State::Low)]);
            reading(pin, &mut unused, word, 27);
        }
        reading(&mut Vec::new(), &mut clock, 0, 27);
    }
    let [first, second] = pins.map(|pin| PinMock::new(&pin));
    let clock = PinMock::new(&clock);
    let mut chips =
        Hx711::new(clock.clone(), [first.clone(), second.clone()], NoopDelay::new(), Mode::A64, PATIENCE);
    chips.start().unwrap();
    assert_eq!(chips.read().unwrap().counts, [-2, 0x5A_5A5A]);
    for mut mock in [clock, first, second] {
        mock.done();
    }
}
