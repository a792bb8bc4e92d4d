//! The decoders of serial sensors over lines with faults: a million frames each.
#![cfg(all(
    feature = "robotous",
    feature = "dynpick",
    feature = "optoforce",
    feature = "resense",
    feature = "simulators",
    feature = "embedded-io"
))]

use core::future::Future;
use core::pin::pin;
use core::task::{Context, Poll, Waker};

use fingertip_drivers::polled::NbSource;
use fingertip_drivers::sensors::AxisCounts;
use fingertip_drivers::sensors::dynpick::{self, DynPickDecoder, DynPickFault};
use fingertip_drivers::sensors::line::{
    AsyncLine, EmbeddedLine, LineDecoder, LineError, LineFaults, LineSensor, LineStatistics, SerialDevice,
    SimulatedLine, SimulatedSerial,
};
use fingertip_drivers::sensors::optoforce::{self, OptoForceDecoder, OptoForceFault};
use fingertip_drivers::sensors::resense::{self, Limits, ResenseDecoder, ResenseFault};
use fingertip_drivers::sensors::robotous::{self, RobotousDecoder, RobotousFault};
use fingertip_drivers::{AsyncSource, Source, SourceError, SourceErrorKind};
use fingertip_wrench::Wrench;

const FRAMES: u64 = 1_000_000;

/// 0.1 % corrupt, 1 % lost, and noise between frames.
const FAULTS: LineFaults =
    LineFaults { bit_flip: 5e-4, lost_byte: 5e-4, lost_frame: 0.01, noise: 0.001, seed: 5 };

fn ones() -> AxisCounts {
    AxisCounts::uniform(1.0, 1.0).unwrap()
}

/// Counts from which can be seen whether the six belong together.
fn counts(number: u64) -> [i16; 6] {
    let x = (number % 8000) as i16;
    [x, -x, 7, x / 2, -9, 8 - x]
}

struct Outcome {
    given: u64,
    wrong: u64,
    undamaged: u64,
    statistics: LineStatistics,
}

/// Sends frames over a bad line, a few at a time, and checks each wrench that comes out.
fn run<D: LineDecoder<f64>>(mut decoder: D, frame: impl Fn(u64) -> Vec<u8>) -> (Outcome, D) {
    let mut line = SimulatedLine::new(FAULTS);
    let (mut given, mut wrong, mut undamaged) = (0, 0, 0);
    for number in 0..FRAMES {
        undamaged += u64::from(line.send_seen(&frame(number)));
        let mut buffer = [0; 256];
        let length = std::io::Read::read(&mut line, &mut buffer).unwrap();
        for byte in &buffer[..length] {
            match decoder.push(*byte) {
                Some(Ok(sample)) => {
                    given += 1;
                    let expected = counts(sample.value.force().x as u64).map(f64::from);
                    wrong += u64::from(sample.value != Wrench::from_components(&expected.into()));
                }
                Some(Err(_)) => wrong += 1,
                None => {}
            }
        }
    }
    let statistics = decoder.statistics();
    (Outcome { given, wrong, undamaged, statistics }, decoder)
}

#[test]
fn robotous_gives_all_that_came_whole_and_nothing_wrong() {
    let frame = |number| {
        robotous::Reading { streamed: true, counts: counts(number), overload: 0 }.emit_serial().to_vec()
    };
    let (outcome, _) = run(RobotousDecoder::new(ones()), frame);
    println!("robotous: {} of {FRAMES} given, {:?}", outcome.given, outcome.statistics);
    // A sum over bytes notices one flipped bit; what noise looks like by chance is not in this seed.
    assert_eq!(outcome.wrong, 0);
    // Noise that looks like the start of a frame can cost the sound one behind it only if its bytes check.
    assert_eq!(outcome.given, outcome.undamaged);
}

#[test]
fn optoforce_gives_all_that_came_whole_and_counts_what_did_not() {
    let frame = |number: u64| {
        optoforce::Reading { count: number as u16, status: 0, counts: counts(number) }.emit().to_vec()
    };
    let (outcome, decoder) = run(OptoForceDecoder::new(ones()), frame);
    println!("optoforce: {} of {FRAMES} given, {:?}", outcome.given, outcome.statistics);
    assert_eq!((outcome.wrong, outcome.given), (0, outcome.undamaged));
    // The last ones may be missing without being noticed.
    assert!(FRAMES - outcome.given - decoder.missing() <= 3);
}

#[test]
fn dynpick_gives_all_that_came_whole_but_cannot_notice_a_digit_that_stays_one() {
    let frame = |number: u64| {
        let raw = counts(number).map(|count| (i32::from(count) + 8192) as u16);
        dynpick::Reading { tick: (number % 10) as u8, raw }.emit().to_vec()
    };
    let (outcome, decoder) = run(DynPickDecoder::new(ones()), frame);
    let damaged = FRAMES - outcome.undamaged;
    println!(
        "dynpick: {} of {FRAMES} given, {} wrong of {damaged} damaged or lost, missing {}, {:?}",
        outcome.given,
        outcome.wrong,
        decoder.missing(),
        outcome.statistics
    );
    // No checksum: some flipped bits turn a digit into another one. Only of the damaged, and few.
    assert!(outcome.wrong > 0 && outcome.wrong <= FRAMES / 2000);
    assert!(outcome.given >= outcome.undamaged - FRAMES / 1000);
}

#[test]
fn resense_gives_nothing_once_it_is_out_of_step_until_it_is_restarted() {
    let limits = Limits { force: 100.0, torque: 10.0, temperature: [-20.0, 80.0], temperature_step: 1.0 };
    let reading = |x: f32| resense::Reading {
        force: [x, -x, 7.25],
        torque_millinewton_metres: [10.0 * x, 20.5, -x],
        temperature: 30.5,
    };
    // Every loss of one to twelve bytes, wherever it happens.
    for (lost, at) in (1..=12).flat_map(|lost| (0..28).map(move |at| (lost, at))) {
        let mut stream: Vec<u8> = (0..6).flat_map(|_| reading(3.75).emit()).collect();
        stream.drain(56 + at..56 + at + lost);
        let mut decoder = ResenseDecoder::new(limits);
        let mut results = Vec::new();
        for byte in stream {
            results.extend(decoder.push(byte));
        }
        let right = |result: &Result<fingertip_drivers::Sample<f64, Wrench<f64>>, ResenseFault>| match result
        {
            Ok(sample) => sample.value.force().x == 3.75 && sample.value.torque().x == 0.0375,
            Err(_) => true,
        };
        assert!(results.iter().all(right), "{lost} bytes lost at {at}: {results:?}");
        assert!(results.last().unwrap().is_err());
        LineDecoder::<f64>::restart(&mut decoder);
        let after: Vec<_> = reading(1.0).emit().iter().filter_map(|byte| decoder.push(*byte)).collect();
        let sample: &fingertip_drivers::Sample<f64, _> = after[0].as_ref().unwrap();
        assert_eq!(sample.value.torque().z, -1e-3);
    }
    let mut decoder = ResenseDecoder::new(limits);
    let nan = resense::Reading { force: [f32::NAN; 3], ..reading(0.0) }.emit();
    let result: Option<Result<fingertip_drivers::Sample<f64, _>, _>> =
        nan.iter().find_map(|byte| decoder.push(*byte));
    assert_eq!(result.unwrap().unwrap_err().kind(), SourceErrorKind::Corrupt);
}

#[test]
fn what_the_sensors_say_of_themselves_is_an_error() {
    let mut line = SimulatedLine::new(LineFaults::default());
    for status in [0x0200, 0x2000, 0x0400] {
        line.send(&optoforce::Reading { status, ..optoforce::Reading::default() }.emit());
    }
    let mut sensor: LineSensor<_, f64, _> = LineSensor::new(line, OptoForceDecoder::new(ones()));
    let error = sensor.next_sample().unwrap_err();
    assert!(matches!(error, LineError::Device(OptoForceFault::Overload { status: 0x0200 })), "{error}");
    assert_eq!(sensor.next_sample().unwrap_err().kind(), SourceErrorKind::DeviceFault);
    assert_eq!(sensor.next_sample().unwrap_err().kind(), SourceErrorKind::DeviceFault);

    let mut line = SimulatedLine::new(LineFaults::default());
    line.send(&robotous::Reading { streamed: true, overload: 4, counts: [0; 6] }.emit_serial());
    let mut sensor: LineSensor<_, f64, _> = LineSensor::new(line, RobotousDecoder::rft60().unwrap());
    let error = sensor.next_sample().unwrap_err();
    assert!(matches!(error, LineError::Device(RobotousFault::Overload { bits: 4 })), "{error}");

    let mut line = SimulatedLine::new(LineFaults::default());
    line.send(&dynpick::Reading { tick: 0, raw: [8192, 16383, 8192, 8192, 8192, 8192] }.emit());
    let mut sensor: LineSensor<_, f64, _> = LineSensor::new(line, DynPickDecoder::new(ones()));
    let error = sensor.next_sample().unwrap_err();
    assert!(matches!(error, LineError::Device(DynPickFault::Saturated { axis: 1 })), "{error}");
}

/// A simulated device where its port would be, through 30 samples: the wrenches that come, each asked for by
/// `request` before its sample.
fn through<D: LineDecoder<f64>>(
    device: impl Into<SerialDevice>,
    faults: LineFaults,
    decoder: D,
    request: impl Fn(u32) -> Vec<u8>,
) -> Vec<Wrench<f64>>
where
    D::Fault: core::fmt::Display,
{
    let mut sensor = LineSensor::new(SimulatedSerial::new(device, faults), decoder);
    let mut wrenches = Vec::new();
    for number in 0..30 {
        std::io::Write::write_all(sensor.line_mut(), &request(number)).unwrap();
        sensor.line_mut().sample([f64::from(number), -2.0, 0.0, 0.5, 0.0, 1.0]);
        // The line is empty for the moment, if nothing came.
        if let Ok(Some(sample)) = sensor.next_sample() {
            wrenches.push(sample.value);
        }
    }
    wrenches
}

#[test]
fn each_device_is_simulated_at_the_other_end_of_its_line() {
    let counts = AxisCounts::uniform(100.0, 1000.0).unwrap();
    let sound = LineFaults::default();
    let limits = Limits { force: 50.0, torque: 5.0, temperature: [0.0, 50.0], temperature_step: 1.0 };
    let expected = |number: u32| -> Wrench<f64> {
        Wrench::from_components(&[f64::from(number), -2.0, 0.0, 0.5, 0.0, 1.0].into())
    };
    let is_all = |wrenches: Vec<Wrench<f64>>, first: u32| {
        let numbers = first..30;
        assert_eq!(wrenches.len(), numbers.len());
        for (wrench, number) in wrenches.iter().zip(numbers) {
            assert!((wrench.components() - expected(number).components()).norm() < 1e-9, "{wrench:?}");
        }
    };
    let once = |bytes: Vec<u8>, at| move |number| if number == at { bytes.clone() } else { Vec::new() };
    let stream = robotous::Request::Stream.emit_serial().to_vec();
    is_all(
        through(robotous::SimulatedRft::new(counts), sound, RobotousDecoder::new(counts), once(stream, 3)),
        3,
    );
    let asked = |_| vec![dynpick::REQUEST];
    is_all(through(dynpick::SimulatedDynPick::new(counts), sound, DynPickDecoder::new(counts), asked), 0);
    let optoforce = optoforce::SimulatedOptoForce::new(counts);
    is_all(through(optoforce, sound, OptoForceDecoder::new(counts), |_| Vec::new()), 0);
    // It stops, and begins again with the load of then as zero.
    let (filter, stop) = (optoforce::Filter::None, optoforce::Rate::Stop);
    let configure = |number| match number {
        10 => optoforce::Configuration { rate: stop, filter, zero: false }.emit().to_vec(),
        20 => optoforce::Configuration { rate: optoforce::Rate::Hz1000, filter, zero: true }.emit().to_vec(),
        _ => Vec::new(),
    };
    let wrenches = through(optoforce, sound, OptoForceDecoder::new(counts), configure);
    let forces: Vec<f64> = wrenches.iter().map(|wrench| wrench.force().x.round()).collect();
    let zeroed = (1..11).map(f64::from);
    assert_eq!(forces, (0..10).map(f64::from).chain(zeroed).collect::<Vec<_>>());
    let resense = || ResenseDecoder::new(limits);
    is_all(through(resense::SimulatedResense::streaming(), sound, resense(), |_| Vec::new()), 0);
    let device = resense::SimulatedResense::asked_by(b"Rd".to_vec());
    is_all(through(device.clone(), sound, resense(), |_| b"Rd".to_vec()), 0);
    // Where each reading is asked for, those that are lost are those that do not come.
    let lossy = LineFaults { lost_frame: 0.3, seed: 3, ..sound };
    let came = through(device, lossy, resense(), |_| b"Rd".to_vec());
    assert!((10..28).contains(&came.len()), "{}", came.len());
    assert!(came.iter().all(|wrench| wrench.force().y == -2.0));
}

/// Runs a future that never waits.
fn ready<F: Future>(future: F) -> F::Output {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(output) => output,
        Poll::Pending => panic!("it waits"),
    }
}

#[test]
fn all_faces_give_the_same() {
    let mut line = SimulatedLine::new(LineFaults { noise: 0.3, bit_flip: 0.1, ..FAULTS });
    for number in 0..2000 {
        line.send(
            &robotous::Reading {
                streamed: true,
                counts: counts(number),
                overload: (number % 100 == 7).into(),
            }
            .emit_serial(),
        );
    }
    let decoder = RobotousDecoder::new(ones());
    let (mut blocking, mut embedded, mut polled, mut awaited) = (
        LineSensor::<_, f64, _>::new(line.clone(), decoder),
        EmbeddedLine::<_, f64, _>::new(line.clone(), decoder),
        EmbeddedLine::<_, f64, _>::new(line.clone(), decoder),
        AsyncLine::<_, f64, _>::new(line, decoder),
    );
    let mut given = 0;
    loop {
        let expected = blocking.next_sample().map_err(|error| error.kind());
        assert_eq!(embedded.next_sample().map_err(|error| error.kind()), expected);
        assert_eq!(ready(awaited.next_sample()).map_err(|error| error.kind()), expected);
        let polled = polled.poll_sample();
        if expected == Ok(None) {
            // The line is still open for one that polls.
            assert!(matches!(polled, Err(nb::Error::WouldBlock)));
            break;
        }
        assert_eq!(
            polled.map_err(|error| error.map(|error| error.kind())),
            expected.map_err(nb::Error::Other)
        );
        given += 1;
    }
    assert!(given > 1700);
}

#[test]
fn resense_over_a_million_readings_is_never_off_by_more_than_a_step() {
    use rand::{RngExt, SeedableRng};
    let limits = Limits { force: 100.0, torque: 10.0, temperature: [-20.0, 80.0], temperature_step: 0.1 };
    // A slow swing, so that each reading differs from all around it and by less than a step.
    let (force_step, torque_step) = (0.05, 0.005);
    let reading = |number: u64| {
        let phase = number as f32 * 1e-3;
        resense::Reading {
            force: [20.0 * phase.sin(), 15.0 * phase.cos(), -30.0 + phase.sin()],
            torque_millinewton_metres: [500.0 * phase.cos(), 300.0 * phase.sin(), 100.0],
            temperature: 30.5 + 1e-6 * number as f32,
        }
    };
    let mut outcomes = Vec::new();
    for steps in [None, Some((force_step, torque_step))] {
        let mut decoder = ResenseDecoder::new(limits);
        if let Some((force, torque)) = steps {
            decoder = decoder.stepping_at_most(force, torque);
        }
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(9);
        let mut line = SimulatedLine::new(LineFaults { noise: 0.0, lost_frame: 0.0, ..FAULTS });
        let (mut held, mut lost) = (None::<u64>, 0_u64);
        let (mut given, mut refused, mut beyond, mut sent_in_all, mut unanswered) =
            (0_u64, 0_u64, 0_u64, 0_u64, 0_u64);
        for number in 0..FRAMES {
            let mut out = Vec::new();
            match random.random::<f64>() {
                chance if chance < 0.01 => lost += 1,
                chance if chance < 0.02 => out.extend([number, number]),
                chance if chance < 0.03 && held.is_none() => {
                    held = Some(number);
                    continue;
                }
                _ => {
                    out.push(number);
                    out.extend(held.take());
                }
            }
            if out.is_empty() {
                unanswered += 1;
            }
            for sent in out {
                sent_in_all += 1;
                line.send(&reading(sent).emit());
                let mut buffer = [0; 64];
                let length = std::io::Read::read(&mut line, &mut buffer).unwrap();
                let (before, refused_before) = (given + refused, refused);
                for byte in &buffer[..length] {
                    match decoder.push(*byte) {
                        Some(Ok(sample)) => {
                            given += 1;
                            let sample: fingertip_drivers::Sample<f64, Wrench<f64>> = sample;
                            let truth = reading(sent);
                            let force =
                                sample.value.force() - nalgebra::Vector3::from(truth.force.map(f64::from));
                            let torque =
                                truth.torque_millinewton_metres.map(|torque| f64::from(torque) * 1e-3);
                            let torque = sample.value.torque() - nalgebra::Vector3::from(torque);
                            // Two steps: the one before may have been off by one.
                            let within = |error: nalgebra::Vector3<f64>, step: f32| {
                                error.iter().all(|error| error.abs() <= 2.0 * f64::from(step))
                            };
                            beyond += u64::from(!(within(force, force_step) && within(torque, torque_step)));
                        }
                        Some(Err(_)) => refused += 1,
                        None => {}
                    }
                }
                // Silence until the next one: a reading that is not whole, or refused, is gone.
                if length < 28 || refused > refused_before {
                    LineDecoder::<f64>::restart(&mut decoder);
                    unanswered += u64::from(given + refused == before);
                }
            }
        }
        println!(
            "steps {steps:?}: {sent_in_all} sent, {given} given, {refused} refused, {} damaged, {beyond} off by more than two steps, {unanswered} unanswered",
            line.damaged()
        );
        // Every reading that was sent is given, refused or not whole; every one that was not is noticed by asking.
        assert_eq!(given + refused + unanswered, sent_in_all + lost);
        outcomes.push((beyond, line.damaged()));
    }
    // Without a stated step some flipped bits pass, within the limits; with it none.
    let [(without, damaged), (with, _)] = outcomes[..] else { panic!("two runs") };
    assert!(without > 0 && without < damaged / 2, "{without} of {damaged}");
    assert_eq!(with, 0);
}
