//! Channels that are stuck, sample by sample: from which reading on, and within which tolerance.

use fingertip_wrench::{BadLimits, ChannelFault, ChannelLimits, ChannelMonitor};
use nalgebra::SVector;

type Monitor = ChannelMonitor<f64, 3>;

const TOLERANCE: f64 = 0.25;

fn monitor(run: u16) -> Monitor {
    ChannelMonitor::new(ChannelLimits::none(), SVector::repeat(TOLERANCE), run).expect("valid")
}

/// What is said of the second channel, which reads as given while the first moves at every reading.
fn said(run: u16, readings: &[f64]) -> Vec<Option<ChannelFault>> {
    let mut monitor = monitor(run);
    readings
        .iter()
        .enumerate()
        .map(|(i, reading)| monitor.update(&SVector::from([i as f64, *reading, -(i as f64)]))[1])
        .collect()
}

const STUCK: Option<ChannelFault> = Some(ChannelFault::Stuck);
const HIGH: Option<ChannelFault> = Some(ChannelFault::PlateauHigh);
const LOW: Option<ChannelFault> = Some(ChannelFault::PlateauLow);

#[test]
fn a_run_is_as_long_as_stated() {
    for run in 2..6_u16 {
        let found = said(run, &[7.0; 8]);
        let wanted: Vec<_> = (1..=8).map(|nth| if nth >= run { STUCK } else { None }).collect();
        assert_eq!(found, wanted, "run of {run}");
    }
}

#[test]
fn the_tolerance_is_no_motion_and_more_is() {
    // Of the reading that the run began with: a creep of less than the tolerance ends where it adds up.
    assert_eq!(said(3, &[1.0, 1.25, 1.0, 0.75, 1.25])[2..], [STUCK, LOW, HIGH]);
    assert_eq!(said(3, &[1.0, 1.25, 1.26, 1.26, 1.26]), [None, None, None, None, HIGH]);
    assert_eq!(said(3, &[1.0, 0.75, 0.74, 0.74, 0.74]), [None, None, None, None, LOW]);
    assert_eq!(said(3, &[1.0, 1.3, 1.0, 1.3, 1.0]), [None; 5]);
    // A run that is broken begins anew.
    assert_eq!(said(3, &[1.0, 1.0, 5.0, 1.0, 1.0, 1.0]), [None, None, None, None, None, LOW]);
}

#[test]
fn plateaus_are_extremes_to_within_the_tolerance() {
    let plateau = |before: f64, reading: f64| said(3, &[0.0, before, reading, reading, reading])[4];
    assert_eq!((plateau(-5.0, 5.0), plateau(5.0, -5.0), plateau(9.0, 5.0)), (HIGH, LOW, STUCK));
    assert_eq!((plateau(5.25, 5.0), plateau(5.5, 5.0)), (HIGH, STUCK));
    assert_eq!((plateau(-5.25, -5.0), plateau(-5.5, -5.0)), (LOW, STUCK));
}

#[test]
fn a_channel_that_is_no_number_moves_and_is_no_extreme() {
    let nan = f64::NAN;
    let broken = Some(ChannelFault::NotFinite);
    assert_eq!(said(3, &[5.0, nan, nan, nan, 5.0, 5.0, 5.0])[1..4], [broken; 3]);
    assert_eq!(said(3, &[5.0, nan, nan, nan, 5.0, 5.0, 5.0])[4..], [None, None, STUCK]);
    let infinite = f64::INFINITY;
    assert_eq!(said(3, &[0.0, infinite, -infinite, 5.0, 5.0, 5.0])[5], HIGH);
}

#[test]
fn readings_on_which_nothing_moves_do_not_count() {
    let mut monitor = monitor(4);
    let still = SVector::from([1.0, 2.0, 3.0]);
    let moved = |x: f64| SVector::from([1.0 + x, 2.0, 3.0]);
    (0..50).for_each(|_| assert_eq!(monitor.update(&still), [None; 3]));
    // Two readings that move the first channel, and one more.
    assert_eq!(monitor.update(&moved(1.0)), [None; 3]);
    assert_eq!(monitor.update(&moved(2.0)), [None; 3]);
    assert_eq!(monitor.update(&moved(2.0)), [None; 3]);
    assert_eq!(monitor.update(&moved(3.0)), [None, STUCK, STUCK]);
    // So long as nothing moves, a stuck channel stays one.
    assert_eq!(monitor.update(&moved(3.0)), [None, STUCK, STUCK]);
}

#[test]
fn a_known_limit_is_said_before_a_plateau() {
    let limits = ChannelLimits::new(SVector::repeat(-1.0), SVector::repeat(8.0)).expect("valid");
    let mut monitor = ChannelMonitor::new(limits, SVector::zeros(), 2).expect("valid");
    let mut found = [None; 3];
    for i in 0..5 {
        found = monitor.update(&SVector::from([f64::from(i), 8.0, -1.0]));
    }
    assert_eq!(found, [None, Some(ChannelFault::SaturatedHigh), Some(ChannelFault::SaturatedLow)]);
}

#[test]
fn without_limits_every_number_is_within() {
    let raw = SVector::from([f64::MAX, -f64::MAX, 0.0]);
    let none = ChannelLimits::<f64, 3>::none();
    assert_eq!([0, 1, 2, 3].map(|channel| none.fault(&raw, channel)), [None; 4]);
}

#[test]
fn limits_and_tolerances_that_are_none() {
    for (least, greatest) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (1.0, f64::NAN)] {
        for channel in 0..3 {
            let (mut from, mut to) = (SVector::<f64, 3>::repeat(0.0), SVector::repeat(5.0));
            (from[channel], to[channel]) = (least, greatest);
            assert_eq!(ChannelLimits::new(from, to), Err(BadLimits::Empty { channel }));
        }
    }
    let new = |tolerance: [f64; 3], run: u16| {
        ChannelMonitor::new(ChannelLimits::none(), SVector::from(tolerance), run).err()
    };
    assert_eq!([new([0.0; 3], 2), new([0.5, 0.0, 1e9], u16::MAX)], [None; 2]);
    for bad in [-1e-300, f64::NAN, f64::INFINITY] {
        assert_eq!(new([0.0, 0.0, bad], 2), Some(BadLimits::BadTolerance { channel: 2 }));
    }
    assert_eq!(new([0.0; 3], 1), Some(BadLimits::BadTolerance { channel: 0 }));
}
