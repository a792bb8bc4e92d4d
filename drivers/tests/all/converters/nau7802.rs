//! The NAU7802.

use embedded_hal::i2c::ErrorKind;
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::i2c::{Mock as I2cMock, Transaction as I2c};
use fingertip_drivers::converters::nau7802::{
    ADDRESS, AsyncNau7802, Calibration, Configuration, Gain, Input, Nau7802, Rate, Register, Regulator,
    SimulatedNau7802,
};
use fingertip_drivers::converters::{
    ConverterError, ConverterFault, Level, Patience, SimulatedBench, Unwired, WireFaults,
};
use fingertip_drivers::polled::NbSource;
use fingertip_drivers::{AsyncSource, Source, SourceError, SourceErrorKind};
use nalgebra::SVector;

use super::block_on;

const PATIENCE: Patience = Patience { limit: 200_000, pause: 100 };

fn bench(faults: WireFaults) -> SimulatedBench<SimulatedNau7802> {
    let chip = SimulatedNau7802::new(|_, input| if input == 0 { 2e-3 } else { -1e-3 });
    SimulatedBench::new(chip, faults)
}

fn configuration() -> Configuration {
    Configuration { rate: Rate::Hz320, regulator: Some(Regulator::V3_3), ..Configuration::default() }
}

fn expected(ratio: f64, gain: Gain) -> i32 {
    (ratio / gain.full_scale() * 8_388_608.0).round() as i32
}

#[test]
fn it_starts_calibrates_and_changes_inputs() {
    let bench = bench(WireFaults::default());
    let mut chip = Nau7802::new(bench.i2c(), bench.data_ready(), bench.delay(), PATIENCE);
    assert_eq!(chip.read(), Err(ConverterFault::NotConfigured.into()));
    chip.configure(&configuration()).unwrap();
    // Its own offset is off.
    for _ in 0..50 {
        assert_eq!(chip.read().unwrap().counts, [expected(2e-3, Gain::X128)]);
    }
    chip.select(Input::Second).unwrap();
    assert_eq!(chip.read().unwrap().counts, [expected(-1e-3, Gain::X128)]);
    chip.calibrate(Calibration::SystemOffset).unwrap();
    assert_eq!(chip.read().unwrap().counts, [0]);
    let error = chip.calibrate(Calibration::SystemGain).unwrap_err();
    assert_eq!((error, error.kind()), (ConverterFault::Calibration.into(), SourceErrorKind::DeviceFault));
    chip.configure(&Configuration { gain: Gain::X32, ..configuration() }).unwrap();
    let sample = Source::<f32, SVector<f32, 1>>::next_sample(&mut chip).unwrap().unwrap();
    assert_eq!(sample.value[0], expected(2e-3, Gain::X32) as f32);
    // Each conversion once: as many as were made, but for those in calibrations and those thrown away.
    let (given, made) = (chip.statistics().conversions, bench.with(|chip| chip.conversions()));
    assert!(given + 5 * 6 >= made && given < made, "{given} of {made}");
}

#[test]
fn the_other_faces_give_the_same_without_the_pin_as_well() {
    let one = bench(WireFaults::default());
    let mut awaited = AsyncNau7802::new(one.i2c(), one.data_ready(), one.delay(), PATIENCE);
    block_on(awaited.configure(&configuration())).unwrap();
    let sample = block_on(AsyncSource::<f64, SVector<f64, 1>>::next_sample(&mut awaited)).unwrap().unwrap();
    assert_eq!(sample.value[0], f64::from(expected(2e-3, Gain::X128)));
    let two = bench(WireFaults::default());
    let mut polled = Nau7802::new(two.i2c(), Unwired, two.delay(), PATIENCE);
    polled.configure(&configuration()).unwrap();
    let (mut given, mut blocked) = (0, 0);
    for _ in 0..2000 {
        match NbSource::<f64, SVector<f64, 1>>::poll_sample(&mut polled) {
            Ok(sample) => {
                assert_eq!(sample.unwrap().value[0], f64::from(expected(2e-3, Gain::X128)));
                given += 1;
            }
            Err(nb::Error::WouldBlock) => blocked += 1,
            Err(nb::Error::Other(error)) => panic!("{error}"),
        }
        two.advance(400_000);
    }
    assert!(given > 240 && blocked > 1500, "{given} {blocked}");
    assert_eq!(polled.statistics().conversions, given);
}

#[test]
fn a_reset_and_stuck_lines_are_noticed() {
    let bench = bench(WireFaults::default());
    let mut chip = Nau7802::new(bench.i2c(), bench.data_ready(), bench.delay(), PATIENCE);
    chip.configure(&configuration()).unwrap();
    chip.read().unwrap();
    bench.set_faults(WireFaults { stuck_ready: Some(Level::High), ..WireFaults::default() });
    assert_eq!(chip.read().unwrap_err().kind(), SourceErrorKind::Timeout);
    bench.set_faults(WireFaults { stuck_data: Some(Level::High), ..WireFaults::default() });
    assert!(matches!(chip.read(), Err(ConverterError::Bus(ErrorKind::NoAcknowledge(_)))));
    bench.set_faults(WireFaults::default());
    chip.read().unwrap();
    // Zeros look like a device that was reset, which is as good.
    bench.set_faults(WireFaults { stuck_data: Some(Level::Low), ..WireFaults::default() });
    assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
    assert_eq!(chip.configure(&configuration()).unwrap_err().kind(), SourceErrorKind::Timeout);
    bench.set_faults(WireFaults::default());
    chip.configure(&configuration()).unwrap();
    chip.read().unwrap();
    // With the pin not wired: a chip that was reset does not drive it as it did.
    let (i2c, _, delay) = chip.release();
    let mut chip = Nau7802::new(i2c, Unwired, delay, PATIENCE);
    chip.configure(&configuration()).unwrap();
    chip.read().unwrap();
    bench.with(SimulatedNau7802::reset);
    assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
    assert_eq!(chip.read(), Err(ConverterFault::NotConfigured.into()));
    assert_eq!(chip.statistics().resets, 1);
}

#[test]
fn an_end_of_the_range_is_an_error() {
    let bench = SimulatedBench::new(SimulatedNau7802::new(|_, _| 0.1), WireFaults::default());
    let mut chip = Nau7802::new(bench.i2c(), bench.data_ready(), bench.delay(), PATIENCE);
    chip.configure(&configuration()).unwrap();
    let error = Source::<f64, SVector<f64, 1>>::next_sample(&mut chip).unwrap_err();
    assert_eq!(error, ConverterFault::Saturated { channel: 0 }.into());
    // And it cannot be tared away.
    assert_eq!(chip.calibrate(Calibration::SystemOffset), Err(ConverterFault::Calibration.into()));
}

#[test]
fn the_bytes_on_the_bus_are_those_of_the_data_sheet() {
    let write = |address: u8, value: u8| I2c::write(ADDRESS, vec![address, value]);
    let read = |address: u8, bytes: &[u8]| I2c::write_read(ADDRESS, vec![address], bytes.to_vec());
    let registers =
        [(Register::CTRL1, 0x87), (Register::CTRL2, 0x30), (0x15, 0x30), (0x1B, 0x00), (0x1C, 0x00)];
    // Reset, digital part on, powered after the second look, revision.
    let mut bus = vec![write(0, 1), write(0, 2), read(0, &[0x02]), read(0, &[0x0A]), read(0x1F, &[0x0F])];
    bus.extend(registers.map(|(address, value)| write(address, value)));
    bus.extend([write(0, 0x06), read(0, &[0x0E]), write(0, 0x16)]);
    bus.extend(registers.map(|(address, value)| read(address, &[value])));
    bus.extend([write(2, 0x34), read(2, &[0x34]), read(2, &[0x30])]);
    for number in 0..5 {
        bus.extend([read(0, &[0x3E]), read(0x12, &[0xFF, 0xFF, number])]);
    }
    bus.extend([read(0, &[0x1E]), read(0, &[0x3E]), read(0x12, &[0x12, 0x34, 0x56]), read(0, &[0x00])]);
    let i2c = I2cMock::new(&bus);
    let mut chip = Nau7802::new(i2c.clone(), Unwired, NoopDelay::new(), PATIENCE);
    chip.configure(&Configuration::default()).unwrap();
    assert_eq!(chip.read().unwrap().counts, [-0x100 + 4]);
    // Not ready, and then ready.
    assert_eq!(chip.statistics().stale, 0);
    assert_eq!(chip.read().unwrap().counts, [0x12_3456]);
    assert_eq!(chip.statistics().stale, 1);
    assert_eq!(chip.read(), Err(ConverterFault::Reset.into()));
    let (mut i2c, ..) = chip.release();
    i2c.done();
}
