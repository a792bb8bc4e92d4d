//! The health of a sensor in sentences and tables.

use fingertip::wrench::ChannelFault;
use fingertip_recordings::health::{ChannelHealth, Finding, Health, Level, What};

use crate::summary::Findings;
use crate::table::{Table, count, number, number_or_dash, short};

/// Most lines of spectra that a table lists.
const LINES: usize = 20;
/// Most steps of zeros.
const STEPS: usize = 20;

/// Everything for the reader.
pub(super) fn findings(health: &Health, name: &str, notes: Vec<String>) -> Findings {
    let mut lead = vec![verdict(health), overview(health)];
    lead.extend(health.findings.iter().map(ToString::to_string).map(|said| format!("{said}.")));
    let mut tables = vec![noise(health), rest(health)];
    tables.extend(
        [stretches(health), steps(health), lines(health)].into_iter().filter(|table| !table.rows.is_empty()),
    );
    Findings { title: format!("Health of the sensor in {name}"), lead, tables, notes }
}

/// What a command says that looks at the health beside its work: what is worse than a note, without the times, which
/// commands say already, and the sentence once for channels that share it.
pub(crate) fn seen(health: &Health) -> Vec<String> {
    const MOST: usize = 6;
    let said_elsewhere = |finding: &&Finding| {
        !matches!(
            finding.what,
            What::Gaps | What::Repeats | What::Jitter | What::Drift | What::Settling | What::NotFinite
        )
    };
    let faults: Vec<&Finding> = health.faults().filter(said_elsewhere).collect();
    let mut lines: Vec<String> = faults.iter().take(MOST).map(|finding| finding.said.clone()).collect();
    if faults.len() > MOST {
        lines.push(format!("{} more: see `fingertip health`", faults.len() - MOST));
    }
    lines
}

/// The same of a table of loads, whose levels jump from load to load: only what is wrong with readings.
pub(crate) fn seen_in_loads(health: &Health) -> Vec<String> {
    let of_readings = |finding: &&Finding| {
        matches!(finding.what, What::Dead | What::Unmoved | What::Stuck | What::Clipped | What::Saturated)
    };
    health.faults().filter(of_readings).map(|finding| finding.said.clone()).collect()
}

fn verdict(health: &Health) -> String {
    let faults = health.faults().count();
    match health.level() {
        Level::Bad => format!("Verdict: bad. {} found.", things(faults)),
        Level::Suspect => format!("Verdict: suspect. {} found that somebody should look at.", things(faults)),
        _ => "Verdict: sound. No fault was found.".to_owned(),
    }
}

fn things(number: usize) -> String {
    if number == 1 { "One thing was".to_owned() } else { format!("{} things were", count(number as u64)) }
}

fn overview(health: &Health) -> String {
    let rate = &health.rate;
    let at = match (rate.rate, rate.jitter) {
        (Some(hertz), Some(jitter)) if jitter * hertz > 1e-6 => {
            format!(" at {} a second (the step scatters by {} ms)", short(hertz), short(1e3 * jitter))
        }
        (Some(hertz), _) => format!(" at {} a second, evenly", short(hertz)),
        _ => String::new(),
    };
    let rest = match health.rest {
        Some([from, to]) => format!(
            "The longest rest is from {} s to {} s; the sensor rests {:.0} % of the time.",
            short(from),
            short(to),
            100.0 * health.rest_share
        ),
        None => "It rests nowhere for long enough.".to_owned(),
    };
    format!("{} samples{at}. {rest}", count(health.samples))
}

fn unit_of(channel: &ChannelHealth) -> String {
    if channel.unit.is_empty() {
        channel.name.clone()
    } else {
        format!("{} / {}", channel.name, channel.unit)
    }
}

fn noise(health: &Health) -> Table {
    let mut table = Table::new(
        "Noise at rest",
        ["", "deviation", "of one reading alone", "least Allan", "at / s", "step", "noise / steps"],
    );
    for channel in &health.channels {
        let noise = channel.noise.as_ref();
        let least =
            noise.and_then(|noise| noise.allan.iter().min_by(|a, b| a.deviation.total_cmp(&b.deviation)));
        let seconds = least.zip(health.rate.rate).map(|(least, rate)| least.readings as f64 / rate);
        let deviation = noise.map(|noise| noise.deviation);
        let steps = deviation.zip(channel.step).map(|(noise, step)| noise / step);
        table.row([
            unit_of(channel),
            number_or_dash(deviation),
            number_or_dash(noise.map(|noise| noise.independent).or(channel.quiet_noise)),
            number_or_dash(least.map(|least| least.deviation)),
            number_or_dash(seconds),
            number_or_dash(channel.step),
            number_or_dash(steps),
        ]);
    }
    table
}

fn rest(health: &Health) -> Table {
    let mut table = Table::new(
        "Range and rest",
        ["", "lowest", "highest", "mean at rest", "moved at rest", "±", "readings at fault"],
    );
    for channel in &health.channels {
        let drift = channel.drift;
        table.row([
            unit_of(channel),
            number_or_dash(channel.range.map(|[low, _]| low)),
            number_or_dash(channel.range.map(|[_, high]| high)),
            number_or_dash(channel.noise.as_ref().map(|noise| noise.mean)),
            number_or_dash(drift.map(|drift| drift.moved)),
            number_or_dash(drift.map(|drift| drift.error)),
            count(channel.at_fault + channel.not_finite),
        ]);
    }
    table
}

fn stretches(health: &Health) -> Table {
    let mut table =
        Table::new("Readings at fault", ["", "from / s", "to / s", "readings", "lowest", "highest", "what"]);
    for channel in &health.channels {
        for stretch in channel.stretches.iter().take(STEPS) {
            let what = match stretch.fault {
                ChannelFault::NotFinite => "no number",
                ChannelFault::SaturatedLow | ChannelFault::SaturatedHigh => "saturated",
                ChannelFault::PlateauLow => "clipped below",
                ChannelFault::PlateauHigh => "clipped above",
                ChannelFault::Stuck => "stuck",
            };
            table.row([
                unit_of(channel),
                short(stretch.from),
                short(stretch.to),
                count(stretch.readings),
                number(stretch.low),
                number(stretch.high),
                what.to_owned(),
            ]);
        }
    }
    table
}

fn steps(health: &Health) -> Table {
    let mut table = Table::new("Steps of the zero", ["", "at / s", "by", "unit"]);
    for step in health.steps.iter().take(STEPS) {
        for (channel, size) in &step.channels {
            let Some(channel) = health.channels.get(*channel) else { continue };
            table.row([channel.name.clone(), short(step.time), number(*size), channel.unit.clone()]);
        }
    }
    table
}

fn lines(health: &Health) -> Table {
    let mut table =
        Table::new("Lines of the spectrum", ["", "at / Hz", "rms", "share of the noise", "source"]);
    let of = |channel| -> Vec<_> { lines_of(channel).collect() };
    let mut all: Vec<_> = health.channels.iter().flat_map(of).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, cells) in all.into_iter().take(LINES) {
        table.row(cells);
    }
    table
}

/// The share of each line in the variance, and the row that says it.
fn lines_of(channel: &ChannelHealth) -> impl Iterator<Item = (f64, [String; 5])> {
    let noise = channel.noise.as_ref().map_or(f64::NAN, |noise| noise.deviation);
    channel.lines.iter().map(move |line| {
        let share = (line.rms / noise).powi(2).min(1.0);
        let said = if share.is_finite() { format!("{:.1} %", 100.0 * share) } else { "–".to_owned() };
        (
            share,
            [unit_of(channel), format!("{:.2}", line.frequency), number(line.rms), said, line.name.clone()],
        )
    })
}
