//! Reports that are made by hand, for tests of what is said of them.

use super::noise::Noise;
use super::report::{ChannelHealth, Health, Rate};
use super::{Finding, Kind, Level, WatchedChannel, What, channel_judge, sensor_judge};

/// A sound channel: noise of 1, no step, a range of 8 about 100.
pub(super) fn sound(name: &str, kind: Kind) -> ChannelHealth {
    ChannelHealth {
        range: Some([96.0, 104.0]),
        noise: Some(Noise { deviation: 1.0, independent: 1.0, mean: 100.0, allan: Vec::new() }),
        quiet_noise: Some(1.0),
        ..ChannelHealth::of(&WatchedChannel::new(name, "V", kind))
    }
}

pub(super) fn of(channels: Vec<ChannelHealth>) -> Health {
    Health {
        samples: 10_000,
        rate: Rate { rate: Some(1000.0), ..Rate::default() },
        rest: Some([1.0, 9.0]),
        rest_share: 1.0,
        channels,
        steps: Vec::new(),
        couplings: Vec::new(),
        findings: Vec::new(),
    }
}

pub(super) fn four(kind: Kind) -> Health {
    of(["a", "b", "c", "d"].map(|name| sound(name, kind)).to_vec())
}

/// What is said of four sound channels after a change.
pub(super) fn said(kind: Kind, change: impl FnOnce(&mut Health)) -> Vec<(What, Level, Vec<String>)> {
    let mut health = four(kind);
    change(&mut health);
    let found = channel_judge::findings(&health).into_iter().chain(sensor_judge::findings(&health));
    found.map(|finding: Finding| (finding.what, finding.level, finding.channels)).collect()
}

pub(super) fn only(what: What, level: Level, names: &[&str]) -> Vec<(What, Level, Vec<String>)> {
    vec![(what, level, names.iter().map(ToString::to_string).collect())]
}

pub(super) fn noise(channel: &mut ChannelHealth, deviation: f64) {
    channel.noise.as_mut().unwrap().deviation = deviation;
    channel.quiet_noise = Some(deviation);
}
