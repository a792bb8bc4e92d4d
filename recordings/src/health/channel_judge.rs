//! What is wrong with single channels.

use fingertip_wrench::ChannelFault;

use super::finding::{Finding, Level, What, digits};
use super::lines::SpectralLine;
use super::report::{ChannelHealth, Health};

/// So many times the noise of its neighbours is too much for a gauge, and for a component of the wrench.
const NOISIER: f64 = 3.0;
const NOISIER_AXIS: f64 = 6.0;
/// Noise below this many steps hides in them: between two steps even none makes half a one.
const COARSE: f64 = 0.55;
/// A line that makes this share of the variance is said.
const HUM: f64 = 0.1;
/// A drift of so many deviations of one reading is said, and one that is suspect.
const DRIFT: [f64; 2] = [2.0, 6.0];
/// Loads that move the neighbours so many deviations move every gauge.
const LOADED: f64 = 100.0;

pub(super) fn findings(health: &Health) -> Vec<Finding> {
    let mut found = Vec::new();
    for channel in &health.channels {
        if channel.is_derived {
            found.extend(drift(channel, health));
            continue;
        }
        found.extend(broken(channel, health));
        let dead = dead(channel, health);
        let is_dead = dead.is_some();
        found.extend(dead);
        if !is_dead {
            found.extend(unmoved(channel, health));
            let stays = stays(channel);
            // What stays where it is says nothing of the converter.
            found.extend(if stays.is_none() { coarse(channel) } else { None });
            found.extend(stays);
            found.extend(noisy(channel, health));
            found.extend(drift(channel, health));
        }
    }
    found.extend(hums(health));
    found
}

fn finding(channel: &ChannelHealth, what: What, level: Level, size: f64, said: String) -> Finding {
    Finding { what, level, channels: vec![channel.name.clone()], at: None, size: Some(size), said }
}

fn with_unit(value: f64, channel: &ChannelHealth) -> String {
    format!("{} {}", digits(value), channel.unit).trim_end().to_owned()
}

fn broken(channel: &ChannelHealth, health: &Health) -> Option<Finding> {
    let count = channel.not_finite;
    let said = format!("{}: {count} of {} readings are missing or no numbers", channel.name, health.samples);
    (count > 0).then(|| finding(channel, What::NotFinite, Level::Bad, count as f64, said))
}

/// How far a channel ranges.
fn spread(channel: &ChannelHealth) -> f64 {
    channel.range.map_or(0.0, |[low, high]| high - low)
}

/// A channel that never changes, beside ones that do by more than a step.
fn dead(channel: &ChannelHealth, health: &Health) -> Option<Finding> {
    let [value, _] = channel.range?;
    if spread(channel) > 0.0 {
        return None;
    }
    let is_beside = |other: &&ChannelHealth| {
        other.sensor == channel.sensor && other.kind.is_of_wrench() == channel.kind.is_of_wrench()
    };
    let moves =
        |other: &ChannelHealth| spread(other) > 3.0 * other.step.unwrap_or(0.0) && spread(other) > 0.0;
    let beside: Vec<&ChannelHealth> = health.channels.iter().filter(is_beside).collect();
    let value = with_unit(value, channel);
    if beside.iter().any(|other| moves(other)) {
        let said = format!("{} is dead: it reads {value} all the time while others change", channel.name);
        return Some(finding(channel, What::Dead, Level::Bad, 0.0, said));
    }
    let alone = beside.iter().all(|other| spread(other) <= 0.0);
    let said = if alone {
        format!("{} reads {value} all the time, and so does every other channel beside it", channel.name)
    } else {
        format!(
            "{} reads {value} all the time, the others change by a step or two: it is dead, or its step is too coarse for a \
             rest; load it to tell",
            channel.name
        )
    };
    Some(finding(channel, What::Dead, if alone { Level::Suspect } else { Level::Note }, 0.0, said))
}

/// By how many deviations of a reading the means of the parts range.
fn moved(channel: &ChannelHealth) -> Option<f64> {
    let noise = channel.noise.as_ref()?.deviation;
    let means = || channel.course.iter().map(|part| part.mean);
    let range = means().fold(f64::NEG_INFINITY, f64::max) - means().fold(f64::INFINITY, f64::min);
    (noise > 0.0).then(|| range / noise)
}

/// A gauge that has noise but answers to no load.
fn unmoved(channel: &ChannelHealth, health: &Health) -> Option<Finding> {
    let own = moved(channel).filter(|_| !channel.kind.is_of_wrench())?;
    let near = || {
        health.channels.iter().filter(|other| other.is_neighbour_of(channel) && other.name != channel.name)
    };
    let all_loaded =
        near().count() >= 3 && near().all(|other| moved(other).is_some_and(|moved| moved > LOADED));
    let said = format!(
        "{} answers to no load: loads move each of its neighbours by more than {LOADED} times their noise, and it by {}",
        channel.name,
        digits(own)
    );
    (own < 3.0 && all_loaded).then(|| finding(channel, What::Unmoved, Level::Suspect, own, said))
}

/// Readings that are saturated, clipped or stuck.
fn stays(channel: &ChannelHealth) -> Option<Finding> {
    let longest = channel.stretches.iter().max_by_key(|stretch| stretch.readings)?;
    let (low, high) = (digits(longest.low), with_unit(longest.high, channel));
    let value =
        if longest.high > longest.low { format!("between {low} and {high}") } else { format!("at {high}") };
    let (name, count) = (&channel.name, channel.at_fault);
    let when = format!("the longest time from {} s to {} s", digits(longest.from), digits(longest.to));
    let (what, said) = match longest.fault {
        ChannelFault::SaturatedLow | ChannelFault::SaturatedHigh => {
            (What::Saturated, format!("{name} is saturated: {count} readings at or beyond its range, {when}"))
        }
        ChannelFault::PlateauLow | ChannelFault::PlateauHigh => {
            let end = if longest.fault == ChannelFault::PlateauHigh { "highest" } else { "lowest" };
            let why = converter_end(longest.low, longest.high, &channel.unit).unwrap_or_else(|| {
                "well inside of what its numbers can say: an amplifier at its limit, or a mechanical stop"
                    .to_owned()
            });
            (
                What::Clipped,
                format!("{name} is clipped: {count} readings stay {value}, its {end}, {when}; {why}"),
            )
        }
        _ => (
            What::Stuck,
            format!("{name} is stuck: {count} readings stay {value} while others change, {when}"),
        ),
    };
    let found = finding(channel, what, Level::Bad, count as f64, said);
    Some(Finding { at: Some(longest.from), ..found })
}

/// Whether counts end where a converter does.
fn converter_end(low: f64, high: f64, unit: &str) -> Option<String> {
    if unit != "counts" {
        return None;
    }
    let bits = (8..=24_u32).find(|bits| {
        let full = f64::from(1_u32 << bits);
        [full - 1.0, full / 2.0 - 1.0].iter().any(|end| (high - end).abs() <= 1.0)
            || (low + full / 2.0).abs() <= 1.0
    });
    if low.abs() <= 1.0 && high.abs() <= 1.0 {
        return Some("the end of a converter that counts from zero".to_owned());
    }
    bits.map(|bits| format!("the end of a converter of {bits} bits or one more"))
}

fn noisy(channel: &ChannelHealth, health: &Health) -> Option<Finding> {
    let noise_of =
        |channel: &ChannelHealth| channel.noise.as_ref().map(|noise| noise.deviation).or(channel.quiet_noise);
    let own = noise_of(channel)?;
    let near = |other: &&ChannelHealth| other.is_neighbour_of(channel) && other.name != channel.name;
    let mut others: Vec<f64> =
        health.channels.iter().filter(near).filter_map(noise_of).filter(|noise| *noise > 0.0).collect();
    if others.len() < 2 {
        return None;
    }
    let middle = others.len() / 2;
    let usual = *others.select_nth_unstable_by(middle, f64::total_cmp).1;
    // What a step hides is not compared.
    let usual = usual.max(channel.step.unwrap_or(0.0) / 12.0_f64.sqrt());
    let limit = if channel.kind.is_of_wrench() { NOISIER_AXIS } else { NOISIER };
    let said = format!(
        "{} is noisier than the others: {} beside {}; look at its wires, shield and amplifier",
        channel.name,
        with_unit(own, channel),
        with_unit(usual, channel)
    );
    (own > limit * usual).then(|| finding(channel, What::Noisy, Level::Suspect, own / usual, said))
}

fn coarse(channel: &ChannelHealth) -> Option<Finding> {
    let (noise, step) = (channel.noise.as_ref()?.deviation, channel.step?);
    let said = format!(
        "{}: a step of its converter, {}, is more than its noise of {}; more gain would show more",
        channel.name,
        with_unit(step, channel),
        with_unit(noise, channel)
    );
    (noise < COARSE * step).then(|| finding(channel, What::Coarse, Level::Note, noise / step, said))
}

/// Lines that make much of the noise; channels of a sensor that swing alike are said together.
fn hums(health: &Health) -> Vec<Finding> {
    let mut groups: Vec<(&str, &SpectralLine, f64, Vec<String>)> = Vec::new();
    for channel in health.channels.iter().filter(|channel| channel.spectrum_at_rest && !channel.is_derived) {
        let (Some(noise), Some(line)) = (channel.noise.as_ref(), channel.lines.first()) else { continue };
        let share = (line.rms / noise.deviation).powi(2).min(1.0);
        if !(share > HUM) {
            continue;
        }
        let alike = |group: &&mut (&str, &SpectralLine, f64, Vec<String>)| {
            group.0 == channel.sensor
                && (group.1.frequency - line.frequency).abs() < 0.02 * line.frequency + 0.2
        };
        match groups.iter_mut().find(alike) {
            Some((_, _, most, names)) => {
                *most = most.max(share);
                names.push(channel.name.clone());
            }
            None => groups.push((&channel.sensor, line, share, vec![channel.name.clone()])),
        }
    }
    let finding = |(_, line, share, channels): (&str, &SpectralLine, f64, Vec<String>)| {
        let source = if line.name.is_empty() { "no mains: a drive, a fan, a resonance" } else { &line.name };
        let (up_to, its) = if channels.len() > 1 { ("up to ", "their") } else { ("", "its") };
        let said = format!(
            "{}: {up_to}{:.0} % of {its} noise swings at {} Hz ({source})",
            channels.join(", "),
            100.0 * share,
            digits(line.frequency)
        );
        Finding { what: What::Hum, level: Level::Suspect, channels, at: None, size: Some(share), said }
    };
    groups.into_iter().map(finding).collect()
}

fn drift(channel: &ChannelHealth, health: &Health) -> Option<Finding> {
    let (noise, drift) = (channel.noise.as_ref()?.deviation, channel.drift?);
    let [from, to] = health.rest?;
    let over_noise = drift.moved.abs() / noise.max(channel.step.unwrap_or(0.0));
    let [said_from, suspect_from] = DRIFT;
    if !drift.is_significant() || !(over_noise > said_from) {
        return None;
    }
    let level = if over_noise > suspect_from { Level::Suspect } else { Level::Note };
    let moved = format!(
        "{} moved by {} ({} times its noise) while it rested from {} s to {} s",
        channel.name,
        with_unit(drift.moved, channel),
        digits(over_noise),
        digits(from),
        digits(to)
    );
    let (what, said) = match (drift.settles_in, drift.to_go) {
        (Some(time), Some(to_go)) => (
            What::Settling,
            format!(
                "{moved}: it settles with a time constant of about {} s and has {} to go; wait before the tare",
                digits(time),
                with_unit(to_go, channel)
            ),
        ),
        _ => (What::Drift, format!("{moved}: it drifts; tare more often, or let it warm up")),
    };
    Some(finding(channel, what, level, drift.moved, said))
}
