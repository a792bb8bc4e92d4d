//! What is wrong with a recording as a whole: its times, its zeros, noise in common.

use super::coupling::Coupling;
use super::finding::{Finding, Level, What, digits};
use super::report::Health;
use super::zero_steps::{StepKind, ZeroStep};

/// Fewer samples tell nothing.
const FEWEST: u64 = 64;
/// Jitter above this share of the step is said.
const UNEVEN: f64 = 0.25;
/// Samples that hold the last values are said above these shares of all.
const HELD: [f64; 2] = [0.05, 0.2];
/// A load that is set down makes no step within one sample at this rate \[1/s\].
const FAST: f64 = 200.0;
/// Below this rate \[1/s\] even one that moves one channel alone may.
const SLOW: f64 = 50.0;
/// Correlated so, two channels are one.
const IDENTICAL: f64 = 0.98;
/// So many pairs of a sensor are not coupled one by one.
const COMMON: usize = 3;
/// Steps of zeros that are said one by one.
const STEPS: usize = 3;

fn finding(what: What, level: Level, said: String) -> Finding {
    Finding { what, level, channels: Vec::new(), at: None, size: None, said }
}

pub(super) fn findings(health: &Health) -> Vec<Finding> {
    let mut found = times(health);
    if health.samples < FEWEST {
        let said = format!(
            "{} samples are too few to tell the health of a sensor; record some seconds",
            health.samples
        );
        found.push(finding(What::TooShort, Level::Note, said));
    } else if health.rest.is_none() {
        let said = "the sensor rests nowhere for long enough: noise, drift and zero are best told from a recording of \
                    some seconds without load and motion"
            .to_owned();
        found.push(finding(What::NoRest, Level::Note, said));
    }
    found.extend(zero_steps(health));
    found.extend(couplings(health));
    found
}

fn times(health: &Health) -> Vec<Finding> {
    let rate = &health.rate;
    let mut found = Vec::new();
    if let Some(longest) = rate.longest_gap {
        let said = format!(
            "{} in time, the longest of {} s; about {} samples are missing",
            if rate.gaps == 1 { "1 gap".to_owned() } else { format!("{} gaps", rate.gaps) },
            digits(longest),
            rate.missing
        );
        found.push(Finding { size: Some(rate.missing), ..finding(What::Gaps, Level::Suspect, said) });
    }
    if rate.not_advancing > 0 {
        let said =
            format!("{} samples have a time that does not advance; they are left out", rate.not_advancing);
        found.push(Finding {
            size: Some(rate.not_advancing as f64),
            ..finding(What::Repeats, Level::Suspect, said)
        });
    }
    if let (Some(jitter), Some(rate)) = (rate.jitter, rate.rate)
        && jitter * rate > UNEVEN
    {
        let said = format!(
            "samples come unevenly: the step of {} s scatters by {} s; spectra and what is filtered suffer",
            digits(rate.recip()),
            digits(jitter)
        );
        found.push(Finding { size: Some(jitter * rate), ..finding(What::Jitter, Level::Note, said) });
    }
    let held = rate.held as f64 / health.samples.max(1) as f64;
    let [least, much] = HELD;
    let any_changes =
        health.channels.iter().any(|channel| channel.range.is_some_and(|[low, high]| high > low));
    if held > least && any_changes {
        let level = if held > much { Level::Suspect } else { Level::Note };
        let said = format!(
            "{:.0} % of the samples hold the last values in every channel: the sensor is read faster than it measures, or a \
             buffer is stale",
            100.0 * held
        );
        found.push(Finding { size: Some(held), ..finding(What::Held, level, said) });
    }
    found
}

/// The first steps of each kind one by one, the others counted.
fn zero_steps(health: &Health) -> Vec<Finding> {
    let mut found = Vec::new();
    for kind in [StepKind::Tare, StepKind::One, StepKind::Several] {
        let steps: Vec<Finding> = health
            .steps
            .iter()
            .filter(|step| step.kind == kind)
            .map(|step| zero_step(health, step))
            .collect();
        let more = steps.len().saturating_sub(STEPS);
        let last = steps.get(STEPS).map(|step| Finding {
            channels: Vec::new(),
            said: format!(
                "{more} more jumps of this kind, the next at {} s",
                digits(step.at.unwrap_or(f64::NAN))
            ),
            ..step.clone()
        });
        found.extend(steps.into_iter().take(STEPS).chain(last));
    }
    found
}

fn named(health: &Health, number: usize) -> (&str, &str) {
    health.channels.get(number).map_or(("", ""), |channel| (&channel.name, &channel.unit))
}

fn zero_step(health: &Health, step: &ZeroStep) -> Finding {
    let sizes: Vec<String> = step
        .channels
        .iter()
        .map(|(number, size)| {
            let (name, unit) = named(health, *number);
            format!("{name} by {}{} {unit}", if *size > 0.0 { "+" } else { "" }, digits(*size))
                .trim_end()
                .to_owned()
        })
        .collect();
    let (sizes, time) = (sizes.join(", "), digits(step.time));
    let fast = health.rate.rate.is_some_and(|rate| rate >= FAST);
    let (what, level, said) = match step.kind {
        StepKind::Tare => (
            What::Tare,
            Level::Suspect,
            format!(
                "the sensor was tared at {time} s: {sizes}; loads before and behind have different zeros"
            ),
        ),
        StepKind::One => (
            What::ZeroStep,
            if health.rate.rate.is_none_or(|rate| rate < SLOW) { Level::Note } else { Level::Suspect },
            format!(
                "the zero of one channel jumped within a sample at {time} s: {sizes}; look at its bond, wires and amplifier"
            ),
        ),
        StepKind::Several => (
            What::ZeroStep,
            if fast { Level::Suspect } else { Level::Note },
            format!(
                "the level jumped within a sample at {time} s: {sizes}; the zero moved, or a load came all at once"
            ),
        ),
    };
    let channels = step.channels.iter().map(|(number, _)| named(health, *number).0.to_owned()).collect();
    let size = step.channels.iter().map(|(_, size)| size.abs()).fold(0.0, f64::max);
    Finding { channels, at: Some(step.time), size: Some(size), ..finding(what, level, said) }
}

fn couplings(health: &Health) -> Vec<Finding> {
    let mut found = Vec::new();
    let (same, shared): (Vec<&Coupling>, Vec<&Coupling>) =
        health.couplings.iter().partition(|coupling| coupling.correlation.abs() > IDENTICAL);
    let pair = |coupling: &Coupling, what, level, said: String| Finding {
        channels: [coupling.first, coupling.second].map(|number| named(health, number).0.to_owned()).to_vec(),
        size: Some(coupling.correlation),
        ..finding(what, level, said)
    };
    for coupling in same {
        let (first, second) = (named(health, coupling.first).0, named(health, coupling.second).0);
        let said = format!("{first} and {second} say the same: one input is read twice, or decoded wrongly");
        found.push(pair(coupling, What::Identical, Level::Bad, said));
    }
    let sensor = |coupling: &&Coupling| health.channels.get(coupling.first);
    for coupling in &shared {
        let Some(channel) = sensor(coupling) else { continue };
        let beside = |other: &&&Coupling| sensor(other).is_some_and(|other| other.is_neighbour_of(channel));
        let many = shared.iter().filter(beside).count();
        let is_common = many >= COMMON;
        let percent = 100.0 * coupling.correlation.abs();
        if !is_common {
            let (first, second) = (named(health, coupling.first).0, named(health, coupling.second).0);
            let said = format!(
                "{percent:.0} % of the noise of {first} and {second} is in common: one couples into the other; look at their \
                 wires and at the input's settling"
            );
            found.push(pair(coupling, What::CrossTalk, Level::Suspect, said));
        } else if shared.iter().find(beside).is_some_and(|strongest| core::ptr::eq(*strongest, *coupling)) {
            let said = format!(
                "several channels{} share noise, up to {percent:.0} % of it: the sensor shakes, or it comes by supply, \
                 reference or shield",
                if channel.sensor.is_empty() { String::new() } else { format!(" of {}", channel.sensor) }
            );
            let size = Some(coupling.correlation);
            found.push(Finding { size, ..finding(What::CommonNoise, Level::Note, said) });
        }
    }
    found
}
