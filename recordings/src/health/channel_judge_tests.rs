//! Judgements of channels on both sides of every limit that the theory states.

use fingertip_wrench::ChannelFault;

use super::drift::Drift;
use super::held::HeldStretch;
use super::lines::SpectralLine;
use super::made::{four, noise, only, said};
use super::report::{Excursion, Health};
use super::{Kind, Level, What, channel_judge};

#[test]
fn what_is_sound_has_nothing_said_of_it() {
    for kind in [Kind::Signal, Kind::Dummy, Kind::Force, Kind::Torque] {
        assert_eq!(said(kind, |_| ()), []);
    }
}

#[test]
fn missing_readings_are_said_from_the_first() {
    assert_eq!(
        said(Kind::Signal, |h| h.channels[1].not_finite = 1),
        only(What::NotFinite, Level::Bad, &["b"])
    );
    assert_eq!(said(Kind::Signal, |h| (h.channels[1].not_finite, h.channels[1].is_derived) = (1, true)), []);
}

#[test]
fn what_never_changes_is_dead_if_others_beside_it_do() {
    let still = |h: &mut Health, i: usize| h.channels[i].range = Some([2.5, 2.5]);
    assert_eq!(said(Kind::Signal, |h| still(h, 1)), only(What::Dead, Level::Bad, &["b"]));
    assert_eq!(said(Kind::Signal, |h| h.channels[1].range = None), []);
    // Of another sensor, or of another kind, says nothing of it: it is alone then.
    assert_eq!(
        said(Kind::Signal, |h| {
            still(h, 1);
            h.channels[1].sensor = "other".to_owned();
        }),
        only(What::Dead, Level::Suspect, &["b"])
    );
    assert_eq!(
        said(Kind::Signal, |h| {
            still(h, 1);
            h.channels[1].kind = Kind::Torque;
        }),
        only(What::Dead, Level::Suspect, &["b"])
    );
    // A gauge and the dummy beside it are read by one device.
    assert_eq!(
        said(Kind::Signal, |h| {
            still(h, 1);
            h.channels[1].kind = Kind::Dummy;
        }),
        only(What::Dead, Level::Bad, &["b"])
    );
    // Where the others change by three steps at most, it may rest between two.
    for (range, level) in [(3.0, Level::Note), (3.1, Level::Bad)] {
        let found = said(Kind::Signal, |h| {
            for channel in &mut h.channels {
                (channel.range, channel.step, channel.noise) = (Some([0.0, range]), Some(1.0), None);
            }
            still(h, 1);
        });
        assert_eq!(found, only(What::Dead, level, &["b"]), "{range}");
    }
    // What is dead has no noise that would be too coarse or too much.
    let found = said(Kind::Signal, |h| {
        still(h, 1);
        h.channels[1].step = Some(50.0);
        noise(&mut h.channels[1], 10.0);
    });
    assert_eq!(found, only(What::Dead, Level::Bad, &["b"]));
    let all = said(Kind::Signal, |h| (0..4).for_each(|i| still(h, i)));
    assert_eq!(all.len(), 4);
    assert!(all.iter().all(|(what, level, _)| (*what, *level) == (What::Dead, Level::Suspect)));
}

#[test]
fn noise_is_compared_with_the_neighbours() {
    for (kind, times) in [(Kind::Signal, 3.0), (Kind::Dummy, 3.0), (Kind::Force, 6.0), (Kind::Torque, 6.0)] {
        assert_eq!(said(kind, |h| noise(&mut h.channels[2], times)), [], "{kind:?}");
        let louder = said(kind, |h| noise(&mut h.channels[2], times * 1.01));
        assert_eq!(louder, only(What::Noisy, Level::Suspect, &["c"]), "{kind:?}");
        // Where it never rested, its changes tell.
        let restless = said(kind, |h| {
            noise(&mut h.channels[2], times * 1.01);
            h.channels[2].noise = None;
        });
        assert_eq!(restless, only(What::Noisy, Level::Suspect, &["c"]), "{kind:?}");
    }
    // Two neighbours with noise are needed; those of other kinds and sensors are none.
    let apart = |count: usize| {
        said(Kind::Signal, |h| {
            noise(&mut h.channels[0], 100.0);
            h.channels.iter_mut().skip(1 + count).for_each(|channel| channel.sensor = "other".to_owned());
        })
    };
    assert_eq!((apart(1), apart(2)), (vec![], only(What::Noisy, Level::Suspect, &["a"])));
    let silent = said(Kind::Signal, |h| {
        noise(&mut h.channels[0], 100.0);
        noise(&mut h.channels[1], 0.0);
        noise(&mut h.channels[2], 0.0);
    });
    assert_eq!(silent, []);
    // Rounding to steps of 12 makes noise of 12/√12 = 3.46 whatever the neighbours have.
    for (own, found) in [(10.3, 0), (10.5, 1)] {
        let coarse = said(Kind::Signal, |h| {
            h.channels[0].step = Some(12.0);
            noise(&mut h.channels[0], own);
        });
        assert_eq!(coarse.len(), found, "{own}");
    }
    // The middle of the others counts: one that is silent or loud itself does not.
    let mixed = said(Kind::Signal, |h| {
        noise(&mut h.channels[0], 3.1);
        noise(&mut h.channels[1], 1e-3);
        noise(&mut h.channels[3], 1.2);
    });
    assert_eq!(mixed, only(What::Noisy, Level::Suspect, &["a"]));
}

#[test]
fn a_step_that_hides_the_noise_is_said() {
    for (deviation, found) in [(1.1, 1), (1.099, 1), (1.2, 0)] {
        let coarse = said(Kind::Signal, |h| {
            h.channels[0].step = Some(2.01);
            noise(&mut h.channels[0], deviation);
        });
        let expected = only(What::Coarse, Level::Note, &["a"]);
        assert_eq!(coarse, expected[..found], "{deviation}");
    }
    // Just 0.55 steps do.
    assert_eq!(
        said(Kind::Signal, |h| (h.channels[0].step, h.channels[0].noise.as_mut().unwrap().deviation) =
            (Some(2.0), 1.1)),
        []
    );
}

#[test]
fn a_gauge_that_loads_do_not_move_is_said() {
    let course = |means: [f64; 3]| {
        means.map(|mean| Excursion { time: 0.0, least: mean - 1.0, mean, greatest: mean + 1.0 }).to_vec()
    };
    let loaded = |kind, own: f64, others: f64, near: usize| {
        said(kind, |h| {
            for channel in &mut h.channels {
                channel.course = course([100.0, 100.0 - 0.4 * others, 100.0 + 0.6 * others]);
            }
            h.channels[3].course = course([100.0 + 0.7 * own, 100.0, 100.0 - 0.3 * own]);
            h.channels.drain(..3 - near);
        })
    };
    let unmoved = only(What::Unmoved, Level::Suspect, &["d"]);
    assert_eq!(loaded(Kind::Signal, 2.9, 101.0, 3), unmoved);
    assert_eq!(loaded(Kind::Signal, 3.1, 101.0, 3), []);
    assert_eq!(loaded(Kind::Signal, 2.9, 99.0, 3), []);
    assert_eq!(loaded(Kind::Signal, 2.9, 101.0, 2), []);
    // A course from 100 to 103 is three deviations to the last bit, and moved.
    let three = said(Kind::Signal, |h| {
        for channel in &mut h.channels {
            channel.course = course([100.0, 100.0, 400.0]);
        }
        h.channels[3].course = course([100.0, 103.0, 101.0]);
    });
    assert_eq!(three, []);
    // A load may well leave a component of the wrench where it is.
    assert_eq!(loaded(Kind::Force, 2.9, 101.0, 3), []);
    // Twice the noise, half the deviations.
    let loud = said(Kind::Signal, |h| {
        for channel in &mut h.channels {
            channel.course = course([100.0, 100.0, 300.0]);
            noise(channel, 2.0);
        }
        h.channels[0].course = course([100.0, 104.0, 103.0]);
    });
    assert_eq!(loud, []);
    // One of the neighbours is not moved either.
    let two = said(Kind::Signal, |h| {
        for (i, channel) in h.channels.iter_mut().enumerate() {
            channel.course = course([100.0, 100.0, if i < 2 { 101.0 } else { 400.0 }]);
        }
    });
    assert_eq!(two, []);
}

fn stretch(fault: ChannelFault, readings: u64, low: f64, high: f64) -> HeldStretch {
    HeldStretch { from: 2.0, to: 3.0, readings, low, high, fault }
}

#[test]
fn what_stays_is_said_by_its_longest_stretch() {
    let cases = [
        (ChannelFault::SaturatedLow, What::Saturated),
        (ChannelFault::SaturatedHigh, What::Saturated),
        (ChannelFault::PlateauLow, What::Clipped),
        (ChannelFault::PlateauHigh, What::Clipped),
    ];
    for (fault, what) in cases {
        let found = said(Kind::Signal, |h| {
            h.channels[0].stretches =
                vec![stretch(ChannelFault::SaturatedLow, 5, 0.0, 0.0), stretch(fault, 70, 4.0, 5.0)];
            // What stays where it is says nothing of the converter.
            h.channels[0].step = Some(100.0);
        });
        assert_eq!(found, only(what, Level::Bad, &["a"]));
    }
}

#[test]
fn the_end_of_a_converter_is_told_by_its_counts() {
    let words = |low: f64, high: f64, unit: &str| {
        let mut health = four(Kind::Signal);
        health.channels[0].unit = unit.to_owned();
        health.channels[0].stretches = vec![stretch(ChannelFault::PlateauHigh, 70, low, high)];
        health.channels[0].at_fault = 71;
        let found = channel_judge::findings(&health);
        assert_eq!((found.len(), found[0].at, found[0].size), (1, Some(2.0), Some(71.0)));
        found[0].said.clone()
    };
    for (low, high, bits) in [
        (4095.0, 4095.0, "12"),
        (4095.0, 4096.0, "12"),
        (2047.0, 2047.0, "11"),
        (-2048.0, -2047.0, "12"),
        (-2049.0, -2047.0, "12"),
        (8_388_607.0, 8_388_607.0, "23"),
        (16_777_215.0, 16_777_215.0, "24"),
        (127.0, 127.0, "8"),
        (-128.0, -128.0, "8"),
    ] {
        let said = words(low, high, "counts");
        assert!(said.contains(&format!("a converter of {bits} bits or one more")), "{low} {high}: {said}");
        assert!(words(low, high, "V").contains("an amplifier at its limit"));
    }
    for (low, high) in [(0.0, 0.0), (-1.0, 1.0), (1.0, 1.0)] {
        assert!(words(low, high, "counts").contains("counts from zero"), "{low} {high}");
    }
    for (low, high) in [(4093.0, 4093.0), (3000.0, 3000.0), (-2.0, 0.0), (0.0, 2.0), (-2050.0, -2046.0)] {
        let said = words(low, high, "counts");
        assert!(said.contains("well inside"), "{low} {high}: {said}");
    }
    assert!(words(4095.0, 4095.0, "V").contains("stay at 4095 V, its highest"));
    assert!(words(4094.0, 4095.0, "V").contains("stay between 4094 and 4095 V"));
    let mut health = four(Kind::Signal);
    health.channels[0].stretches = vec![stretch(ChannelFault::PlateauLow, 70, 1.0, 1.0)];
    assert!(channel_judge::findings(&health)[0].said.contains("its lowest"));
}

#[test]
fn lines_that_swing_alike_are_said_together() {
    let line = |frequency: f64, rms: f64| SpectralLine { frequency, rms, name: String::new() };
    let hums = |change: &dyn Fn(&mut Health)| {
        let found = said(Kind::Signal, |h| {
            for channel in &mut h.channels {
                channel.spectrum_at_rest = true;
                channel.lines = vec![line(100.0, 0.5)];
            }
            change(h);
        });
        assert!(found.iter().all(|(what, level, _)| (*what, *level) == (What::Hum, Level::Suspect)));
        found.into_iter().map(|(_, _, names)| names.concat()).collect::<Vec<_>>()
    };
    assert_eq!(hums(&|_| ()), ["abcd"]);
    // A tenth of the variance is none: 0.316².
    assert_eq!(hums(&|h| h.channels[1].lines[0].rms = 0.316), ["acd"]);
    assert_eq!(hums(&|h| h.channels[1].lines[0].rms = 0.317), ["abcd"]);
    assert_eq!(hums(&|h| noise(&mut h.channels[1], 2.0)), ["acd"]);
    assert_eq!(hums(&|h| h.channels[1].spectrum_at_rest = false), ["acd"]);
    assert_eq!(hums(&|h| h.channels[1].is_derived = true), ["acd"]);
    // Two hundredths and a fifth of a hertz apart are one line.
    assert_eq!(hums(&|h| h.channels[1].lines[0].frequency = 102.1), ["abcd"]);
    assert_eq!(hums(&|h| h.channels[1].lines[0].frequency = 97.9), ["abcd"]);
    assert_eq!(hums(&|h| h.channels[1].lines[0].frequency = 102.5), ["acd", "b"]);
    assert_eq!(hums(&|h| h.channels[1].lines[0].frequency = 97.5), ["acd", "b"]);
    assert_eq!(hums(&|h| h.channels.iter_mut().for_each(|c| c.lines[0].frequency = 0.1)), ["abcd"]);
    assert_eq!(hums(&|h| h.channels[1].sensor = "other".to_owned()), ["acd", "b"]);
    // The largest share is said.
    let mut health = four(Kind::Signal);
    for (i, channel) in health.channels.iter_mut().enumerate() {
        channel.spectrum_at_rest = true;
        channel.lines = vec![line(100.0, [0.5, 0.8, 0.6, 3.0][i])];
    }
    let found = channel_judge::findings(&health);
    assert_eq!((found.len(), found[0].size), (1, Some(1.0)));
    assert!(found[0].said.starts_with("a, b, c, d: up to 100 % of their noise swings at 100 Hz (no mains"));
    health.channels.truncate(2);
    health.channels[0].lines.clear();
    health.channels[1].lines[0].name = "mains, 50 Hz".to_owned();
    let found = channel_judge::findings(&health);
    assert!((found[0].size.unwrap() - 0.64).abs() < 1e-12);
    assert!(
        found[0].said.starts_with("b: 64 % of its noise swings at 100 Hz (mains, 50 Hz)"),
        "{}",
        found[0].said
    );
}

#[test]
fn a_drift_is_said_by_how_far_it_goes_beyond_the_noise() {
    let drifts = |moved: f64, error: f64, step: Option<f64>, settles_in| {
        said(Kind::Force, |h| {
            h.channels[0].step = step;
            noise(&mut h.channels[0], 1.0);
            h.channels[0].drift = Some(Drift { moved, error, settles_in, to_go: settles_in });
        })
    };
    let note = only(What::Drift, Level::Note, &["a"]);
    let suspect = only(What::Drift, Level::Suspect, &["a"]);
    assert_eq!(drifts(2.0, 0.1, None, None), []);
    assert_eq!(drifts(2.01, 0.1, None, None), note);
    assert_eq!(drifts(-2.01, 0.1, None, None), note);
    assert_eq!(drifts(6.0, 0.1, None, None), note);
    assert_eq!(drifts(-6.01, 0.1, None, None), suspect);
    // Six standard errors are not more than six.
    assert_eq!(drifts(6.0, 1.0, None, None), []);
    assert_eq!(drifts(6.01, 1.0, None, None), suspect);
    // Beside a step that is more than the noise, the step counts.
    assert_eq!(drifts(3.0, 0.1, Some(1.5), None), []);
    assert_eq!(drifts(3.01, 0.1, Some(1.5), None), note);
    assert_eq!(drifts(3.0, 9.0, None, Some(2.0)), only(What::Settling, Level::Note, &["a"]));
    // What is calculated from other channels drifts like any, and is noisy with them.
    let derived = said(Kind::Force, |h| {
        h.channels[0].is_derived = true;
        noise(&mut h.channels[0], 100.0);
        h.channels[0].drift = Some(Drift { moved: 700.0, error: 1.0, settles_in: None, to_go: None });
    });
    assert_eq!(derived, suspect);
    assert_eq!(
        said(Kind::Force, |h| {
            h.rest = None;
            h.channels[0].drift = Some(Drift { moved: 7.0, error: 0.1, settles_in: None, to_go: None });
        }),
        only(What::NoRest, Level::Note, &[])
    );
}
