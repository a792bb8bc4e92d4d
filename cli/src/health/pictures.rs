//! The pictures of a sensor's health: its course, noise by averaging time, and spectra.

use fingertip_recordings::health::{ChannelHealth, Health, Kind};

use crate::observe::Point;
use crate::report::{Axis, Chart, Figure};

/// Classes of curves; those of more channels begin anew.
const CLASSES: [&str; 8] = ["a", "b", "c", "d", "e", "f", "g", "h"];
/// Points of a drawn spectrum.
const POINTS: usize = 300;

/// Channels of one sensor and one kind, which share axes.
fn groups(health: &Health) -> Vec<Vec<&ChannelHealth>> {
    let mut groups: Vec<Vec<&ChannelHealth>> = Vec::new();
    for channel in health.channels.iter().filter(|channel| channel.kind != Kind::Dummy) {
        let beside = |group: &&mut Vec<&ChannelHealth>| {
            group.first().is_some_and(|first| first.sensor == channel.sensor && first.kind == channel.kind)
        };
        match groups.iter_mut().find(beside) {
            Some(group) => group.push(channel),
            None => groups.push(vec![channel]),
        }
    }
    groups
}

pub(super) fn of(health: &Health) -> Vec<Figure> {
    let mut figures = Vec::new();
    for group in groups(health) {
        figures
            .extend([course(health, &group), allan(health, &group), spectrum(&group)].into_iter().flatten());
    }
    figures
}

fn title(what: &str, group: &[&ChannelHealth]) -> String {
    let Some(first) = group.first() else { return what.to_owned() };
    let of = match first.kind {
        Kind::Signal => "gauges",
        Kind::Dummy => "dummy gauge",
        Kind::Force => "forces",
        Kind::Torque => "torques",
    };
    if first.sensor.is_empty() {
        format!("{what}, {of}")
    } else {
        format!("{what}, {of} of {}", first.sensor)
    }
}

fn class(number: usize) -> &'static str {
    CLASSES.get(number % CLASSES.len()).copied().unwrap_or("e")
}

fn keys(group: &[&ChannelHealth]) -> Vec<(&'static str, String)> {
    group.iter().enumerate().map(|(number, channel)| (class(number), channel.name.clone())).collect()
}

fn unit<'a>(group: &[&'a ChannelHealth]) -> &'a str {
    group.first().map_or("", |first| first.unit.as_str())
}

fn named(what: &str, unit: &str) -> String {
    if unit.is_empty() { what.to_owned() } else { format!("{what} / {unit}") }
}

fn bounds(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let mut values = values.filter(|value| value.is_finite());
    let first = values.next()?;
    Some(values.fold((first, first), |(low, high), value| (low.min(value), high.max(value))))
}

/// Every channel less its middle: how it went.
fn course(health: &Health, group: &[&ChannelHealth]) -> Option<Figure> {
    let middle = |channel: &ChannelHealth| {
        let mean =
            channel.course.iter().map(|part| part.mean).sum::<f64>() / channel.course.len().max(1) as f64;
        channel.noise.as_ref().map_or(mean, |noise| noise.mean)
    };
    let of = |channel: &ChannelHealth| -> Vec<Vec<Point>> {
        let zero = middle(channel);
        // Lowest and highest of each part, so that what is short is seen.
        let part = |part: &fingertip_recordings::health::Excursion| {
            [part.least, part.greatest].map(|value| Point { time: part.time, value: value - zero })
        };
        vec![channel.course.iter().flat_map(part).collect()]
    };
    let curves: Vec<Vec<Vec<Point>>> = group.iter().map(|channel| of(channel)).collect();
    let points = || curves.iter().flatten().flatten();
    let (low, high) = bounds(points().map(|point| point.value))?;
    let (from, to) = bounds(points().map(|point| point.time))?;
    let name = title("Course", group);
    let timed = health.rate.rate.is_some();
    let x = Axis::linear(if timed { "time / s" } else { "sample" }, from, to);
    let mut chart = Chart::new(&name, x, Axis::rounded(&named("reading", unit(group)), low, high));
    for (number, curve) in curves.iter().enumerate() {
        chart.curve(class(number), curve);
    }
    chart.marks("mark", health.steps.iter().map(|step| step.time));
    let rest = health.rest.map(|[from, to]| format!(" Rest: {from:.2} s to {to:.2} s.")).unwrap_or_default();
    Some(Figure {
        title: name,
        svg: chart.finish(),
        keys: keys(group),
        caption: format!("Each channel less its mean at rest; upright lines are steps of the zero.{rest}"),
        on_white: false,
    })
}

/// Noise by the time of averaging.
fn allan(health: &Health, group: &[&ChannelHealth]) -> Option<Figure> {
    let pace = health.rate.rate.map_or(1.0, f64::recip);
    let of = |channel: &ChannelHealth| -> Vec<Point> {
        let points =
            channel.noise.iter().flat_map(|noise| &noise.allan).filter(|point| point.deviation > 0.0);
        points.map(|point| Point { time: point.readings as f64 * pace, value: point.deviation }).collect()
    };
    let curves: Vec<Vec<Point>> = group.iter().map(|channel| of(channel)).collect();
    let points = || curves.iter().flatten();
    let (low, high) = bounds(points().map(|point| point.value))?;
    let (from, to) = bounds(points().map(|point| point.time))?;
    let name = title("Allan deviation", group);
    let x = Axis::log(
        if health.rate.rate.is_some() { "averaged over / s" } else { "averaged over / readings" },
        from,
        to,
    );
    let mut chart = Chart::new(&name, x, Axis::log(&named("deviation", unit(group)), low, high));
    for (number, curve) in curves.iter().enumerate() {
        chart.curve(class(number), core::slice::from_ref(curve));
    }
    Some(Figure { title: name, svg: chart.finish(), keys: keys(group), ..Figure::default() })
}

/// Amplitude by frequency; of several frequencies that share a place, the largest.
fn spectrum(group: &[&ChannelHealth]) -> Option<Figure> {
    let of = |channel: &ChannelHealth| -> Vec<Point> {
        let every = channel.spectrum.len().div_ceil(POINTS).max(1);
        let largest = |part: &[(f64, f64)]| {
            part.iter()
                .max_by(|a, b| a.1.total_cmp(&b.1))
                .map(|(time, value)| Point { time: *time, value: *value })
        };
        channel.spectrum.chunks(every).filter_map(largest).filter(|point| point.value > 0.0).collect()
    };
    let curves: Vec<Vec<Point>> = group.iter().map(|channel| of(channel)).collect();
    let points = || curves.iter().flatten();
    let (low, high) = bounds(points().map(|point| point.value))?;
    let (_, to) = bounds(points().map(|point| point.time))?;
    let name = title("Spectrum", group);
    let y = Axis::log(&named("density", &format!("{} per root Hz", unit(group))), low, high);
    let mut chart = Chart::new(&name, Axis::linear("frequency / Hz", 0.0, to), y);
    for (number, curve) in curves.iter().enumerate() {
        chart.curve(class(number), core::slice::from_ref(curve));
    }
    let strongest = group.iter().flat_map(|channel| channel.lines.first().map(|line| (channel, line)));
    let strongest = strongest.max_by(|(_, a), (_, b)| a.rms.total_cmp(&b.rms));
    let caption = strongest.map_or_else(
        || "No line stands out of the noise.".to_owned(),
        |(channel, line)| {
            let named = if line.name.is_empty() { String::new() } else { format!(" ({})", line.name) };
            format!("The strongest line is at {:.1} Hz{named}, in {}.", line.frequency, channel.name)
        },
    );
    Some(Figure { title: name, svg: chart.finish(), keys: keys(group), caption, on_white: false })
}
