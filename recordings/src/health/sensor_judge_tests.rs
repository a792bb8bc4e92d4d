//! Judgements of times, zeros and noise in common on both sides of every limit.

use super::made::{four, only, said};
use super::report::Rate;
use super::zero_steps::{StepKind, ZeroStep};
use super::{Coupling, Kind, Level, What, sensor_judge};

#[test]
fn times_are_judged() {
    let rate = |change: &dyn Fn(&mut Rate)| said(Kind::Signal, |h| change(&mut h.rate));
    assert_eq!(
        rate(&|r| (r.gaps, r.longest_gap, r.missing) = (2, Some(0.5), 9.0)),
        only(What::Gaps, Level::Suspect, &[])
    );
    assert_eq!(rate(&|r| r.not_advancing = 1), only(What::Repeats, Level::Suspect, &[]));
    // A quarter of the step is none.
    assert_eq!(rate(&|r| (r.rate, r.jitter) = (Some(1024.0), Some(0.25 / 1024.0))), []);
    assert_eq!(rate(&|r| r.jitter = Some(0.26e-3)), only(What::Jitter, Level::Note, &[]));
    assert_eq!(rate(&|r| r.held = 500), []);
    assert_eq!(rate(&|r| r.held = 501), only(What::Held, Level::Note, &[]));
    assert_eq!(rate(&|r| r.held = 2000), only(What::Held, Level::Note, &[]));
    assert_eq!(rate(&|r| r.held = 2001), only(What::Held, Level::Suspect, &[]));
    assert_eq!(
        said(Kind::Signal, |h| (h.samples, h.rest) = (63, None)),
        only(What::TooShort, Level::Note, &[])
    );
    assert_eq!(
        said(Kind::Signal, |h| (h.samples, h.rest) = (64, None)),
        only(What::NoRest, Level::Note, &[])
    );
    let mut health = four(Kind::Signal);
    health.rate.held = 2500;
    assert!(sensor_judge::findings(&health)[0].said.starts_with("25 % of the samples"));
    health.channels.iter_mut().for_each(|channel| channel.range = Some([1.0, 1.0]));
    assert!(sensor_judge::findings(&health).is_empty());
    health.samples = 0;
    assert_eq!(sensor_judge::findings(&health).len(), 1);
}

fn zero_step(kind: StepKind, time: f64, channels: &[(usize, f64)]) -> ZeroStep {
    ZeroStep { sample: 1, time, channels: channels.to_vec(), kind }
}

#[test]
fn steps_of_the_zero_are_judged_by_the_rate() {
    let step = |kind, rate: Option<f64>| {
        said(Kind::Signal, |h| {
            h.rate.rate = rate;
            h.steps = vec![zero_step(kind, 4.0, &[(1, -0.5), (2, 0.25)])];
        })
    };
    assert_eq!(step(StepKind::Tare, None), only(What::Tare, Level::Suspect, &["b", "c"]));
    let judged = |kind, rate| step(kind, rate)[0].1;
    for (kind, rate, level) in [
        (StepKind::One, None, Level::Note),
        (StepKind::One, Some(49.0), Level::Note),
        (StepKind::One, Some(50.0), Level::Suspect),
        (StepKind::Several, None, Level::Note),
        (StepKind::Several, Some(199.0), Level::Note),
        (StepKind::Several, Some(200.0), Level::Suspect),
    ] {
        assert_eq!(judged(kind, rate), level, "{kind:?} {rate:?}");
    }
    let mut health = four(Kind::Signal);
    health.steps = vec![zero_step(StepKind::One, 4.0, &[(1, -0.5), (2, 0.25)])];
    let found = &sensor_judge::findings(&health)[0];
    assert_eq!((found.at, found.size), (Some(4.0), Some(0.5)));
    assert!(found.said.contains("at 4 s: b by -0.5 V, c by +0.25 V;"), "{}", found.said);
    // Three of a kind are said one by one, and the others counted.
    for (count, said) in [(3, 3), (4, 4), (9, 4)] {
        let steps = (0..count).map(|i| zero_step(StepKind::One, f64::from(i), &[(0, 1.0)]));
        health.steps = steps.chain([zero_step(StepKind::Several, 50.0, &[(0, 1.0)])]).collect();
        let found = sensor_judge::findings(&health);
        assert_eq!(found.len(), said + 1);
        if count > 3 {
            let words = format!("{} more jumps of this kind, the next at 3 s", count - 3);
            assert!(found[3].said == words && found[3].channels.is_empty(), "{:?}", found[3]);
        }
    }
}

#[test]
fn noise_in_common_is_said_of_a_pair_or_of_all() {
    let couple = |pairs: &[(usize, usize, f64)]| {
        said(Kind::Signal, |h| {
            let coupling = |&(first, second, correlation)| Coupling { first, second, correlation };
            h.couplings = pairs.iter().map(coupling).collect();
            if h.couplings.len() > 3 {
                h.channels[3].sensor = "other".to_owned();
            }
        })
    };
    assert_eq!(couple(&[(0, 1, 0.98)]), only(What::CrossTalk, Level::Suspect, &["a", "b"]));
    assert_eq!(couple(&[(0, 1, -0.981)]), only(What::Identical, Level::Bad, &["a", "b"]));
    let two = couple(&[(0, 1, 0.5), (1, 2, -0.4)]);
    assert_eq!(two.iter().map(|(what, ..)| *what).collect::<Vec<_>>(), [What::CrossTalk; 2]);
    assert_eq!(couple(&[(0, 1, 0.5), (1, 2, -0.4), (0, 2, 0.3)]), only(What::CommonNoise, Level::Note, &[]));
    // Of another sensor it is another matter.
    let apart = couple(&[(0, 1, 0.5), (1, 2, -0.4), (0, 2, 0.3), (3, 3, 0.2)]);
    assert_eq!(
        apart.iter().map(|(what, ..)| *what).collect::<Vec<_>>(),
        [What::CommonNoise, What::CrossTalk]
    );
    let mut health = four(Kind::Signal);
    health.channels.iter_mut().for_each(|channel| channel.sensor = "left".to_owned());
    let coupling = |(first, second, correlation)| Coupling { first, second, correlation };
    health.couplings = [(0, 1, -0.5), (1, 2, 0.4), (0, 2, 0.3)].map(coupling).to_vec();
    let found = &sensor_judge::findings(&health)[0];
    assert!(
        found.said.starts_with("several channels of left share noise, up to 50 % of it"),
        "{}",
        found.said
    );
    assert_eq!(found.size, Some(-0.5));
}
