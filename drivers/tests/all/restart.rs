//! What a decoder has heard before a restart, and how long a line may say nothing that makes sense.
#![cfg(all(
    feature = "bota-serial",
    feature = "dynpick",
    feature = "optoforce",
    feature = "resense",
    feature = "robotous"
))]

use fingertip_drivers::Source;
use fingertip_drivers::sensors::AxisCounts;
use fingertip_drivers::sensors::bota_serial::{BotaDecoder, Frame};
use fingertip_drivers::sensors::dynpick::{self, DynPickDecoder};
use fingertip_drivers::sensors::line::{LineDecoder, LineError, LineSensor};
use fingertip_drivers::sensors::optoforce::{self, OptoForceDecoder};
use fingertip_drivers::sensors::resense::{self, Limits, ResenseDecoder};
use fingertip_drivers::sensors::robotous::{self, RobotousDecoder};

/// Each byte of a frame may be the last one before the restart: the rest alone is no frame.
fn a_half_is_forgotten<D: LineDecoder<f64>>(decoder: impl Fn() -> D, frame: &[u8]) {
    for cut in 1..frame.len() {
        let (first, rest) = frame.split_at(cut);
        let mut decoder = decoder();
        assert!(first.iter().all(|byte| decoder.push(*byte).is_none()));
        decoder.restart();
        assert!(rest.iter().all(|byte| decoder.push(*byte).is_none()), "cut at {cut}");
        // Behind it, a whole one is found, if only after one more restart where frames have no header.
        decoder.restart();
        let (last, others) = frame.split_last().unwrap();
        assert!(others.iter().all(|byte| decoder.push(*byte).is_none()));
        assert!(matches!(decoder.push(*last), Some(Ok(_))), "cut at {cut}");
        assert_eq!(decoder.statistics().skipped, frame.len() as u64, "cut at {cut}");
    }
}

const LIMITS: Limits = Limits { force: 50.0, torque: 5.0, temperature: [0.0, 50.0], temperature_step: 1.0 };

fn counts() -> AxisCounts {
    AxisCounts::uniform(1.0, 1.0).unwrap()
}

#[test]
fn the_half_of_a_frame_is_forgotten_in_a_restart() {
    let frame = Frame { components: [1.5; 6], microseconds: 7, ..Frame::default() };
    a_half_is_forgotten(BotaDecoder::new, &frame.emit());
    a_half_is_forgotten(|| DynPickDecoder::new(counts()), b"7200120642001100120002001\r\n");
    let reading = optoforce::Reading { count: 3, status: 0, counts: [1, -2, 3, -4, 5, -6] };
    a_half_is_forgotten(|| OptoForceDecoder::new(counts()), &reading.emit());
    let reading = robotous::Reading { streamed: true, counts: [1, -2, 3, -4, 5, -6], overload: 0 };
    a_half_is_forgotten(|| RobotousDecoder::new(counts()), &reading.emit_serial());
    let torque_millinewton_metres = [4.0, 5.0, 6.0];
    let reading = resense::Reading { force: [1.0, 2.0, 3.0], torque_millinewton_metres, temperature: 25.0 };
    a_half_is_forgotten(|| ResenseDecoder::new(LIMITS), &reading.emit());
}

/// Gives one piece a time.
struct Pieces<'a>(alloc::collections::VecDeque<&'a [u8]>);

impl std::io::Read for Pieces<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let piece = self.0.pop_front().unwrap_or_default();
        buffer[..piece.len()].copy_from_slice(piece);
        Ok(piece.len())
    }
}

/// A sensor that is begun anew drops what it has read and not used, and the half of a frame that its decoder holds.
#[test]
fn a_sensor_that_is_begun_anew_drops_bytes_and_half_frames() {
    let frame = |microseconds| Frame { components: [1.5; 6], microseconds, ..Frame::default() }.emit();
    let [first, second, third, fourth] = [1_000_000, 2_000_000, 3_000_000, 4_000_000].map(frame);
    // One and a half, silence, and then the rest with two more.
    let before = [&first[..], &second[..20]].concat();
    let after = [&second[20..], &third[..], &fourth[..]].concat();
    let line = Pieces([&before[..], &[], &after[..]].into());
    let mut sensor = LineSensor::<_, f64, _>::new(line, BotaDecoder::new());
    let mut time = |restart: bool| {
        if restart {
            sensor.restart();
        }
        sensor.next_sample().unwrap().map(|sample| sample.time.unwrap())
    };
    assert_eq!((time(false), time(false)), (Some(0.0), None));
    // The half is forgotten, and the rest is no frame.
    assert_eq!(time(true), Some(2.0));
    // The fourth was read and not used.
    assert_eq!(time(true), None);
}

/// Bytes of zero are no frame of any of these: as many as its patience has, and the sensor says so.
fn says_that_nothing_comes<D: LineDecoder<f64>>(decoder: D)
where
    D::Fault: core::fmt::Display + core::fmt::Debug,
{
    let mut sensor = LineSensor::<_, f64, _>::new(std::io::repeat(0), decoder);
    for _ in 0..3 {
        match sensor.next_sample() {
            Err(LineError::NoFrame { bytes }) => assert_eq!(bytes, D::PATIENCE),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn a_line_without_frames_is_told_after_as_many_bytes_as_are_stated() {
    says_that_nothing_comes(BotaDecoder::new());
    says_that_nothing_comes(DynPickDecoder::new(counts()));
    says_that_nothing_comes(OptoForceDecoder::new(counts()));
    says_that_nothing_comes(RobotousDecoder::new(counts()));
}

/// Sound frames begin the count anew.
#[test]
fn a_frame_renews_the_patience() {
    let patience = <DynPickDecoder as LineDecoder<f64>>::PATIENCE;
    let sound = b"0200120642001100120002001\r\n";
    let mut bytes = vec![b'?'; patience - sound.len()];
    bytes.extend(sound);
    bytes.extend(vec![b'?'; patience - 1]);
    let mut sensor = LineSensor::<_, f64, _>::new(bytes.as_slice(), DynPickDecoder::new(counts()));
    assert!(matches!(sensor.next_sample(), Ok(Some(_))));
    assert!(matches!(sensor.next_sample(), Ok(None)), "the line ends before patience does");
    // A fault is a frame, too: the device is there.
    let mut bytes = vec![b'?'; patience - sound.len()];
    bytes.extend(b"0000020002000200020002000\r\n");
    bytes.extend(vec![b'?'; patience - 1]);
    let mut sensor = LineSensor::<_, f64, _>::new(bytes.as_slice(), DynPickDecoder::new(counts()));
    assert!(matches!(
        sensor.next_sample(),
        Err(LineError::Device(dynpick::DynPickFault::Saturated { axis: 0 }))
    ));
    assert!(matches!(sensor.next_sample(), Ok(None)));
}
