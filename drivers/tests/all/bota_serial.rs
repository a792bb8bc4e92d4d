//! Bota's sensor driver against the simulated sensor.
#![cfg(all(feature = "bota-serial", feature = "simulators"))]

use fingertip_drivers::middleware::Watch;
use fingertip_drivers::sensors::bota_serial::{BotaDecoder, BotaFault, Frame};
use fingertip_drivers::sensors::line::{LineDecoder, LineError, LineFaults, LineSensor, SimulatedLine};
use fingertip_drivers::{Sample, Source, SourceError, SourceErrorKind};
use fingertip_wrench::Wrench;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Of a number of frames so many newtons: of all of them no more than a sensor measures.
const PER_FRAME: f64 = 1.0 / 64.0;

fn frame(number: u32) -> Frame {
    let x = number as f32 * PER_FRAME as f32;
    Frame {
        components: [x, -x, 1.0, 2.0, 3.0, -0.5 * x],
        // Wraps around on the way.
        microseconds: (u32::MAX - 5_000_000).wrapping_add(number * 1250),
        ..Frame::default()
    }
}

type Next = Result<Option<Sample<f64, Wrench<f64>>>, LineError<std::io::Error, BotaFault>>;

#[test]
fn a_bad_line_costs_the_damaged_frames_and_no_other() {
    let faults = LineFaults { bit_flip: 0.01, lost_byte: 0.01, lost_frame: 0.01, noise: 0.02, seed: 3 };
    let mut line = SimulatedLine::new(faults);
    let count = 200_000;
    for number in 0..count {
        line.send(&frame(number).emit());
    }
    let damaged = line.damaged();
    let mut sensor = LineSensor::new(line, BotaDecoder::new());
    let (mut given, mut last, mut start) = (0, -1.0, None);
    while let Some(sample) = {
        let next: Next = sensor.next_sample();
        next.unwrap()
    } {
        let (number, time) = (sample.value.force().x / PER_FRAME, sample.time.unwrap());
        assert_eq!(sample.value, frame_wrench(number));
        assert!(number > last);
        let start = *start.get_or_insert(number);
        assert!((time - (number - start) * 1.25e-3).abs() < 1e-9);
        (given, last) = (given + 1, number);
    }
    println!(
        "{count} frames, {damaged} damaged, {given} given, {} bytes skipped",
        LineDecoder::<f64>::statistics(sensor.decoder()).skipped
    );
    assert_eq!(given, u64::from(count) - damaged);
}

fn frame_wrench(number: f64) -> Wrench<f64> {
    let x = number * PER_FRAME;
    Wrench::from_components(&nalgebra::Vector6::new(x, -x, 1.0, 2.0, 3.0, -0.5 * x))
}

#[test]
fn what_the_sensor_says_of_itself_is_an_error() {
    let mut line = SimulatedLine::new(LineFaults::default());
    line.send(&Frame { status: Frame::OVERRANGE, ..frame(1) }.emit());
    line.send(&Frame { status: Frame::INVALID, ..frame(2) }.emit());
    line.send(&Frame { components: [f32::NAN; 6], ..frame(3) }.emit());
    line.send(&frame(4).emit());
    let mut sensor = LineSensor::new(line, BotaDecoder::new());
    for kind in [SourceErrorKind::Overload, SourceErrorKind::DeviceFault, SourceErrorKind::DeviceFault] {
        let next: Next = sensor.next_sample();
        assert_eq!(next.unwrap_err().kind(), kind);
    }
    let next: Next = sensor.next_sample();
    // Time runs on over the samples that were not given.
    assert!((next.unwrap().unwrap().time.unwrap() - 3.75e-3).abs() < 1e-12);
    let next: Next = sensor.next_sample();
    assert!(next.unwrap().is_none());
}

#[test]
fn a_wrong_baud_rate_and_a_silent_line_are_told() {
    let mut sensor = LineSensor::new(std::io::repeat(0x55), BotaDecoder::new());
    let next: Next = sensor.next_sample();
    assert!(matches!(next, Err(LineError::NoFrame { .. })));
    struct Silent;
    impl std::io::Read for Silent {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::TimedOut.into())
        }
    }
    let next: Next = LineSensor::new(Silent, BotaDecoder::new()).next_sample();
    assert_eq!(next.unwrap_err().kind(), SourceErrorKind::Timeout);
}

#[test]
fn a_million_frames_that_are_lost_repeated_swapped_and_damaged_give_nothing_wrong_and_all_losses_are_counted()
{
    let mut random = Pcg64Mcg::seed_from_u64(21);
    let mut line = SimulatedLine::new(LineFaults {
        bit_flip: 5e-4,
        lost_byte: 5e-4,
        noise: 1e-3,
        seed: 6,
        ..LineFaults::default()
    });
    let mut decoder = BotaDecoder::new();
    let mut watch = Watch::<f64, Wrench<f64>>::new(Some(1.25e-3));
    // Values that a float holds exactly, from which the number of the frame can be read.
    let (count, modulus) = (1_000_000_u32, 1 << 20);
    let (mut held, mut out) = (None::<u32>, Vec::new());
    let (mut lost, mut repeated, mut late) = (0_u64, 0_u64, 0_u64);
    let mut last = None::<u32>;
    for number in 0..count {
        out.clear();
        // The first and the last ones arrive, and begin and end the count.
        let chance = if number == 0 || number + 2 >= count { 1.0 } else { random.random::<f64>() };
        match chance {
            chance if chance < 0.01 => lost += 1,
            chance if chance < 0.02 => out.extend([number, number]),
            chance if chance < 0.03 && held.is_none() => {
                held = Some(number);
                continue;
            }
            _ => out.push(number),
        }
        if !out.is_empty() {
            out.extend(held.take());
        }
        for sent in &out {
            let calm = *sent == 0 || *sent + 2 >= count;
            let mut clean = SimulatedLine::new(LineFaults::default());
            let line = if calm { &mut clean } else { &mut line };
            let whole = line.send_seen(&frame(*sent).emit());
            let mut take = |sample| check(sample, modulus, &mut last, &mut watch);
            std::io::copy(line, &mut Feed(&mut decoder, &mut take)).unwrap();
            repeated +=
                u64::from(whole && *sent == number && out.iter().filter(|one| *one == sent).count() == 2);
            late += u64::from(whole && *sent != number);
        }
    }
    // Of a pair that arrives whole twice, the second is the repetition.
    let counts = *watch.counts();
    println!(
        "{counts:?}, {lost} lost, {} damaged, {late} late, {} not news, {repeated} whole of pairs",
        line.damaged(),
        decoder.not_news()
    );
    // Every number between the first and the last is given or missing, by the sensor's own clock.
    assert_eq!(counts.given + counts.missing, u64::from(count));
    assert_eq!((counts.backward, counts.repeated, decoder.restarts()), (0, 0, 0));
    // What is missing was lost, damaged or came late; nothing else. (A damaged frame may be one of a pair.)
    assert!(counts.missing <= lost + line.damaged() + late && counts.missing >= lost);
    assert!(decoder.not_news() <= late + repeated / 2 && decoder.not_news() > 15_000);
}

/// Takes what is sent down a line.
struct Feed<'a, F>(&'a mut BotaDecoder, F);

impl<F: FnMut(Sample<f64, Wrench<f64>>)> std::io::Write for Feed<'_, F> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        for byte in bytes {
            if let Some(sample) = LineDecoder::<f64>::push(self.0, *byte) {
                (self.1)(sample.unwrap());
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn check(
    sample: Sample<f64, Wrench<f64>>,
    modulus: u32,
    last: &mut Option<u32>,
    watch: &mut Watch<f64, Wrench<f64>>,
) {
    let number = sample.value.force().x / PER_FRAME;
    assert_eq!(sample.value, frame_wrench(number));
    let number = number as u32;
    assert!(number < modulus && last.is_none_or(|last| number > last), "{number} after {last:?}");
    assert!((sample.time.unwrap() - f64::from(number) * 1.25e-3).abs() < 1e-9);
    *last = Some(number);
    watch.arrive(sample, sample.time.unwrap());
}

#[test]
fn a_sensor_that_was_switched_off_and_on_is_heard_again() {
    let mut decoder = BotaDecoder::new();
    let mut give = |number: u32, microseconds: u32| {
        let bytes = Frame { microseconds, ..frame(number) }.emit();
        bytes.iter().find_map(|byte| LineDecoder::<f64>::push(&mut decoder, *byte)).is_some()
    };
    assert!((0..100).all(|number| give(number, 1_000_000 + 1250 * number)));
    let given = (0..100).filter(|number| give(*number, 1250 * number)).count();
    assert_eq!(given, 100 - BotaDecoder::RESTARTED as usize + 1);
    assert_eq!((decoder.restarts(), decoder.not_news()), (1, u64::from(BotaDecoder::RESTARTED)));
}

/// Numbers beyond every sensor are counted as faults, not believed, though their checksum fits.
#[test]
fn numbers_beyond_every_sensor_are_not_believed() {
    let mut decoder = BotaDecoder::new();
    let mut give = |component: usize, value: f32, microseconds: u32| {
        let mut frame = Frame { microseconds, ..Frame::default() };
        frame.components[component] = value;
        let bytes = frame.emit();
        let given = bytes.into_iter().filter_map(|byte| LineDecoder::<f64>::push(&mut decoder, byte));
        given.last().unwrap()
    };
    for (number, (component, value, believed)) in [
        (0, 9e4, true),
        (0, 2e5, false),
        (2, -1e36, false),
        (3, 9e3, true),
        (5, -2e4, false),
        (4, f32::NAN, false),
    ]
    .into_iter()
    .enumerate()
    {
        let given = give(component, value, 1000 * (number as u32 + 1));
        assert_eq!(given.is_ok(), believed, "{value}: {given:?}");
    }
}
