//! The faults of simulated lines and links, each alone: as often as stated, and what they are said to be.
#![cfg(all(feature = "ati-rdt", feature = "simulators"))]

use std::io::Read;

use fingertip_drivers::sensors::ati_rdt::{Command, FaultPlan, Request, SimulatedNetFt, records};
use fingertip_drivers::sensors::line::{LineFaults, SimulatedLine};

const COUNT: usize = 4000;

/// Whether so many of [`COUNT`] are a share, within five standard deviations.
fn is_share(count: usize, share: f64) {
    let expected = COUNT as f64 * share;
    let off = (count as f64 - expected).abs();
    assert!(off <= 5.0 * (expected * (1.0 - share)).sqrt(), "{count}, not {expected}");
}

const FRAME: [u8; 6] = [0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC];

/// What arrives of each frame, and how many were said to be damaged.
fn arrived(faults: LineFaults) -> (Vec<Vec<u8>>, usize) {
    let mut line = SimulatedLine::new(LineFaults { seed: 7, ..faults });
    let mut told = 0;
    let frames = (0..COUNT).map(|_| {
        told += u64::from(!line.send_seen(&FRAME));
        let mut bytes = Vec::new();
        line.read_to_end(&mut bytes).unwrap();
        bytes
    });
    let frames = frames.collect();
    assert_eq!((line.sent(), line.damaged()), (COUNT as u64, told));
    (frames, told as usize)
}

#[test]
fn a_line_flips_bits() {
    let (frames, told) = arrived(LineFaults { bit_flip: 0.25, ..LineFaults::default() });
    let mut seen = [0; 6];
    let mut damaged = 0;
    for frame in frames {
        assert_eq!(frame.len(), FRAME.len());
        let flipped: Vec<u8> = frame.iter().zip(FRAME).map(|(got, sent)| got ^ sent).collect();
        let bits: u32 = flipped.iter().map(|byte| byte.count_ones()).sum();
        assert!(bits <= 1);
        damaged += bits as usize;
        seen.iter_mut().zip(flipped).for_each(|(seen, flipped)| *seen |= flipped);
    }
    assert_eq!((damaged, seen), (told, [0xFF; 6]));
    is_share(told, 0.25);
}

#[test]
fn a_line_loses_bytes_and_frames() {
    let (frames, told) = arrived(LineFaults { lost_byte: 0.25, ..LineFaults::default() });
    let mut lost = [0; 6];
    for frame in &frames {
        match frame.len() {
            6 => assert_eq!(*frame, FRAME),
            5 => {
                let at = frame.iter().zip(FRAME).take_while(|(got, sent)| **got == *sent).count();
                assert_eq!(frame[at..], FRAME[at + 1..]);
                lost[at] += 1;
            }
            length => panic!("{length} bytes"),
        }
    }
    assert_eq!(lost.iter().sum::<usize>(), told);
    assert!(lost.iter().all(|count| *count > 0), "{lost:?}");
    is_share(told, 0.25);
    let (frames, told) = arrived(LineFaults { lost_frame: 0.25, ..LineFaults::default() });
    assert!(frames.iter().all(|frame| frame.is_empty() || *frame == FRAME));
    assert_eq!(frames.iter().filter(|frame| frame.is_empty()).count(), told);
    is_share(told, 0.25);
}

#[test]
fn faults_of_a_line_exclude_each_other() {
    let faults = LineFaults { bit_flip: 0.1, lost_byte: 0.2, lost_frame: 0.3, ..LineFaults::default() };
    let (frames, told) = arrived(faults);
    is_share(frames.iter().filter(|frame| frame.len() == 6 && **frame != FRAME).count(), 0.1);
    is_share(frames.iter().filter(|frame| frame.len() == 5).count(), 0.2);
    is_share(frames.iter().filter(|frame| frame.is_empty()).count(), 0.3);
    is_share(told, 0.6);
    // A frame without bytes cannot be damaged, and is counted all the same.
    let mut line = SimulatedLine::new(LineFaults { bit_flip: 0.5, lost_byte: 0.5, ..LineFaults::default() });
    (0..50).for_each(|_| line.send(&[]));
    let mut bytes = Vec::new();
    line.read_to_end(&mut bytes).unwrap();
    assert_eq!((bytes.len(), line.sent(), line.damaged()), (0, 50, 50));
}

#[test]
fn noise_comes_before_a_frame_and_damages_none() {
    let (frames, told) = arrived(LineFaults { noise: 0.25, ..LineFaults::default() });
    let noisy: Vec<&Vec<u8>> = frames.iter().filter(|frame| frame.len() > 6).collect();
    assert!(frames.iter().all(|frame| frame.ends_with(&FRAME)));
    assert!(noisy.iter().all(|frame| frame.len() < 6 + 40));
    assert!(noisy.iter().any(|frame| frame.len() > 6 + 30));
    // Not one byte over and over.
    assert!(noisy.iter().any(|frame| frame[0] != frame[1]));
    assert_eq!(told, 0);
    is_share(noisy.len(), 0.25);
}

/// Datagrams that arrive, by the number of their record; `None` for one that was cut.
fn datagrams(faults: FaultPlan) -> (Vec<Option<u32>>, SimulatedNetFt) {
    let mut sensor = SimulatedNetFt::new(FaultPlan { seed: 9, ..faults });
    sensor.request(&Request { command: Command::Stream, count: 0 }.emit());
    let mut numbers = Vec::new();
    for number in 0..COUNT {
        sensor.sample([number as i32; 6]);
        while let Some(datagram) = sensor.datagram() {
            assert!(datagram.len() <= 36);
            let whole = records(&datagram).ok().and_then(|mut records| records.next());
            numbers.push(whole.map(|record| record.counts()[0] as u32));
        }
    }
    assert_eq!(sensor.sent(), COUNT as u64);
    (numbers, sensor)
}

#[test]
fn a_link_loses_repeats_and_cuts_datagrams() {
    let (numbers, sensor) = datagrams(FaultPlan { loss: 0.25, ..FaultPlan::default() });
    let lost = COUNT - numbers.len();
    assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!(sensor.injected().lost, lost as u64);
    is_share(lost, 0.25);
    let (numbers, sensor) = datagrams(FaultPlan { duplication: 0.25, ..FaultPlan::default() });
    let repeated = numbers.windows(2).filter(|pair| pair[0] == pair[1]).count();
    assert_eq!((numbers.len(), sensor.injected().duplicates), (COUNT + repeated, repeated as u64));
    is_share(repeated, 0.25);
    let (numbers, sensor) = datagrams(FaultPlan { truncation: 0.25, ..FaultPlan::default() });
    let cut = numbers.iter().filter(|number| number.is_none()).count();
    assert_eq!((numbers.len(), sensor.injected().corrupt), (COUNT, cut as u64));
    is_share(cut, 0.25);
}

#[test]
fn a_link_swaps_datagrams_with_the_next() {
    let (numbers, sensor) = datagrams(FaultPlan { reorder: 0.25, ..FaultPlan::default() });
    let mut sorted = numbers.clone();
    sorted.sort_unstable();
    // Each once, but for one that may still be held back.
    assert!(sorted.iter().enumerate().all(|(at, number)| *number == Some(at as u32)));
    assert!(numbers.len() + 1 >= COUNT);
    let late = numbers.windows(2).filter(|pair| pair[0] > pair[1]).count();
    assert!(numbers.iter().enumerate().all(|(at, number)| number.unwrap().abs_diff(at as u32) <= 1));
    assert_eq!(sensor.injected().late, late as u64);
    // One that is drawn while another is held back goes on: a quarter of those that are not.
    is_share(late, 0.25 / 1.25);
}

#[test]
fn faults_of_a_link_exclude_each_other() {
    let faults = FaultPlan { loss: 0.1, duplication: 0.2, reorder: 0.0, truncation: 0.3, seed: 0 };
    let (numbers, sensor) = datagrams(faults);
    let injected = sensor.injected();
    is_share(injected.lost as usize, 0.1);
    is_share(injected.duplicates as usize, 0.2);
    is_share(injected.corrupt as usize, 0.3);
    assert_eq!((injected.late, injected.received), (0, 0));
    let arrived = COUNT as u64 - injected.lost + injected.duplicates;
    assert_eq!(numbers.len() as u64, arrived);
}
