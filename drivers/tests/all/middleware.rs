//! Middleware over sources: faults are injected as counted, and found as injected.
#![cfg(feature = "simulators")]

use core::convert::Infallible;
use core::error::Error;
use std::io;

use fingertip_drivers::bridge::{BridgeFault, BridgedError};
use fingertip_drivers::middleware::{
    FaultInjector, Recorder, SampleFaults, Solved, SupervisedError, Watched,
};
use fingertip_drivers::sensors::line::LineError;
use fingertip_drivers::{Sample, Source, SourceError, SourceErrorKind};
use fingertip_wrench::{Tare, Wrench, WrenchSolver};
use nalgebra::{SVector, Vector3};

/// Numbers its samples at 1 kHz, as wrenches and as signals.
#[derive(Clone, Debug, Default)]
struct Counting {
    number: u32,
    end: u32,
}

impl Counting {
    fn next(&mut self) -> Option<(f64, f64)> {
        self.number += 1;
        (self.number <= self.end).then(|| (f64::from(self.number), f64::from(self.number) * 1e-3))
    }
}

impl Source<f64, Wrench<f64>> for Counting {
    type Error = Infallible;

    fn next_sample(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, Infallible> {
        Ok(self.next().map(|(number, time)| {
            let value = Wrench::on_fingertip(Vector3::new(number, 1.0, 2.0), Vector3::new(3.0, 4.0, 5.0));
            Sample { time: Some(time), value }
        }))
    }
}

impl Source<f64, SVector<f64, 2>> for Counting {
    type Error = Infallible;

    fn next_sample(&mut self) -> Result<Option<Sample<f64, SVector<f64, 2>>>, Infallible> {
        Ok(self
            .next()
            .map(|(number, time)| Sample { time: Some(time), value: SVector::from([number, -number]) }))
    }
}

#[test]
fn a_million_samples_with_faults_are_watched_as_they_were_broken() {
    let faults = SampleFaults {
        loss: 0.01,
        duplication: 0.01,
        error: 0.001,
        freeze: 0.0001,
        freeze_length: 20,
        seed: 9,
        ..SampleFaults::default()
    };
    let end = 1_000_000;
    let source = FaultInjector::new(Counting { number: 0, end }, faults);
    let mut watched = Watched::<_, f64, Wrench<f64>>::new(source, Some(1e-3));
    let (mut given, mut errors) = (0_u64, 0);
    loop {
        match watched.next_fresh(0.0) {
            Ok(Some(_)) => given += 1,
            Ok(None) => break,
            Err(error) => {
                assert_eq!(error.kind(), SourceErrorKind::Corrupt);
                errors += 1;
            }
        }
    }
    let (found, injected) = (watched.counts(), watched.source().injections());
    println!("{found:?}\n{injected:?}");
    assert_eq!((found.given, found.errors, injected.errors), (given, errors, errors));
    assert_eq!(given + injected.lost + injected.errors - injected.duplicated, u64::from(end));
    // What was lost or replaced by an error is missing, but for the first and last.
    assert!(injected.lost + injected.errors - found.missing <= 4);
    // A sample given twice has the value and the time of the one before; a frozen one only the value.
    assert_eq!(
        (found.repeated, found.backward),
        (injected.duplicated + injected.frozen, injected.duplicated)
    );
    assert!(found.longest_freeze >= 20);
    for count in [injected.lost, injected.duplicated] {
        assert!((9_000..11_000).contains(&count));
    }
}

#[test]
fn signals_can_be_reordered_spiked_and_made_not_a_number() {
    let faults = SampleFaults {
        reorder: 0.1,
        not_a_number: 0.1,
        spike: 0.1,
        spike_size: 1e6,
        seed: 4,
        ..SampleFaults::default()
    };
    let mut source = FaultInjector::new(Counting { number: 0, end: 10_000 }, faults);
    let (mut backward, mut not_a_number, mut spikes, mut last) = (0, 0, 0, 0.0);
    while let Some(Sample { time, value }) = Source::<f64, SVector<f64, 2>>::next_sample(&mut source).unwrap()
    {
        backward += u64::from(time.unwrap() < last);
        last = time.unwrap();
        not_a_number += u64::from(value.iter().any(|number| number.is_nan()));
        spikes += u64::from((value[0] + value[1] - 1e6).abs() < 1.0);
    }
    let injected = source.injections();
    assert!(injected.reordered > 500 && injected.not_a_number > 500 && injected.spikes > 500);
    assert_eq!(
        (backward, not_a_number, spikes),
        (injected.reordered, injected.not_a_number, injected.spikes)
    );
}

#[test]
fn each_component_of_a_wrench_can_be_spiked_and_made_not_a_number() {
    let faults =
        SampleFaults { not_a_number: 0.2, spike: 0.2, spike_size: 1e6, seed: 5, ..SampleFaults::default() };
    let mut source = FaultInjector::new(Counting { number: 0, end: 3000 }, faults);
    let (mut not_a_number, mut spikes) = ([0; 6], [0; 6]);
    let mut number = 0.0;
    while let Some(sample) = Source::<f64, Wrench<f64>>::next_sample(&mut source).unwrap() {
        number += 1.0;
        let sound = [number, 1.0, 2.0, 3.0, 4.0, 5.0];
        let components = sample.value.components();
        for (axis, (component, sound)) in components.iter().zip(sound).enumerate() {
            not_a_number[axis] += u64::from(component.is_nan());
            spikes[axis] += u64::from(*component == sound + 1e6);
            assert!(component.is_nan() || *component == sound || *component == sound + 1e6);
        }
    }
    let injected = source.injections();
    assert!(not_a_number.iter().chain(&spikes).all(|count| *count > 50), "{not_a_number:?} {spikes:?}");
    assert_eq!((not_a_number.iter().sum(), spikes.iter().sum()), (injected.not_a_number, injected.spikes));
}

#[test]
fn a_record_that_fails_does_not_stop_the_source() {
    let mut log = Vec::new();
    let mut source = Recorder::new(Counting { number: 0, end: 10 }, |sample: &Sample<f64, Wrench<f64>>| {
        if log.len() == 4 {
            return Err("the disk is full");
        }
        log.push(sample.value.force().x);
        Ok(())
    });
    let mut given = 0;
    while Source::<f64, Wrench<f64>>::next_sample(&mut source).unwrap().is_some() {
        given += 1;
    }
    assert_eq!((given, source.unrecorded(), source.failure()), (10, 6, Some(&"the disk is full")));
    assert_eq!(log, [1.0, 2.0, 3.0, 4.0]);
}

/// A sensor of two gauges: a push and a torque.
struct Halves;

impl WrenchSolver<f64, 2> for Halves {
    fn solve(&self, signals: &SVector<f64, 2>) -> Wrench<f64> {
        Wrench::on_fingertip(Vector3::x() * (signals[0] / 2.0), Vector3::y() * signals[1])
    }
}

#[test]
fn signals_are_solved_above_the_zero_that_was_set_last() {
    let zero = |a, b| Tare::new(SVector::from([a, b]));
    let mut source = Solved::new(Counting { number: 0, end: 3 }, zero(0.0, 0.0), Halves);
    let mut next = |zero: Option<Tare<f64, 2>>| {
        zero.into_iter().for_each(|zero| source.set_zero(zero));
        let sample = Source::<f64, Wrench<f64>>::next_sample(&mut source).unwrap();
        sample.map(|sample| (sample.time.unwrap(), sample.value.force().x, sample.value.torque().y))
    };
    assert_eq!(next(None), Some((1e-3, 0.5, -1.0)));
    assert_eq!(next(Some(zero(1.0, -4.0))), Some((2e-3, 0.5, 2.0)));
    assert_eq!(next(None), Some((3e-3, 1.0, 1.0)));
    assert_eq!(next(None), None);
    source.source_mut().end = 5;
    assert_eq!(source.source().number, 4);
    assert!(Source::<f64, Wrench<f64>>::next_sample(&mut source).unwrap().is_some());
}

/// What a user reads is a sentence however deep the error lies, and each part of it can be asked for.
#[test]
fn errors_within_errors_are_said_in_words() {
    let cut = || io::Error::new(io::ErrorKind::BrokenPipe, "the cable is out");
    let line = || LineError::<_, BridgeFault>::Line(cut());
    assert_eq!(line().to_string(), "serial line: the cable is out");
    let lost = SupervisedError::Lost(line());
    assert_eq!(lost.to_string(), "the link is lost: serial line: the cable is out");
    let within = lost.source().unwrap();
    assert_eq!(within.to_string(), "serial line: the cable is out");
    assert_eq!(within.source().unwrap().to_string(), "the cable is out");
    let through = SupervisedError::Source(BridgedError::Source(line()));
    assert_eq!(through.to_string(), "serial line: the cable is out");
    assert_eq!(through.source().unwrap().to_string(), "the cable is out");
    let device = SupervisedError::Source(LineError::<io::Error, _>::Device(BridgeFault::NoExcitation));
    assert_eq!(device.to_string(), "there is no excitation");
}
