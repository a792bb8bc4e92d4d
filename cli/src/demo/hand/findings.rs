//! The session of the hand in words and tables.

use fingertip_simulation::hand::HandSegment;

use super::{Moment, Outcome};
use crate::summary::Findings;
use crate::table::{Table, count, number, number_or_dash};

const GRAMS: f64 = 1e3;
const MILLIMETRES: f64 = 1e3;

pub(super) fn of(outcome: &Outcome) -> Findings {
    let duration = outcome.moments.last().map_or(0.0, |last| last.time);
    let lead = vec![
        format!(
            "Three simulated fingertips (the sensor of Bicchi & Dario 1987) held a jar for {} s: they lifted and tilted \
             it, 100 g were poured in, it was pushed, put down, lifted again and handed over. From their volts alone a \
             controller commanded the least forces that hold, a thousand times a second.",
            number(duration)
        ),
        masses(outcome),
        held(outcome),
    ];
    Findings {
        title: "A simulated hand".to_owned(),
        lead,
        tables: vec![segments(outcome)],
        notes: vec![
            "the friction that is left is that of the contact that has least, as it truly is".to_owned(),
            "a mass comes of the mean load, with the calibration's own errors in its deviation; while something else \
             touches the jar there is none"
                .to_owned(),
            format!(
                "noise, gluing and calibration are those of seed {}; another one: --seed N",
                outcome.seed
            ),
        ],
    }
}

/// The masses at the end of each weighing.
fn masses(outcome: &Outcome) -> String {
    let ends = outcome.weighings().filter_map(<[_]>::last).map(|mass| {
        format!(
            "{} ± {} g for {} g",
            number(mass.found * GRAMS),
            number(mass.deviation * GRAMS),
            number(mass.truth * GRAMS)
        )
    });
    format!("It weighed {}.", ends.collect::<Vec<_>>().join(", "))
}

fn held(outcome: &Outcome) -> String {
    let slipped = outcome.moments.iter().filter(|moment| moment.slip.1).count();
    let moved = outcome.moments.iter().filter_map(|moment| moment.moved).fold(0.0, f64::max);
    let slips = match slipped {
        0 => "No contact slipped".to_owned(),
        samples => format!("A contact slipped in {} samples", count(samples as u64)),
    };
    format!("{slips}; in the hand the jar moved by {} mm at most.", number(moved * MILLIMETRES))
}

fn name(segment: &HandSegment) -> &'static str {
    match segment {
        HandSegment::Open { .. } => "open",
        HandSegment::Hold { .. } => "hold",
        HandSegment::Move { by, .. } if by.z > 0.0 => "lift",
        HandSegment::Move { .. } => "put down",
        HandSegment::Turn { .. } => "tilt",
        HandSegment::Pour { .. } => "pour in",
        HandSegment::Push { .. } => "push",
        HandSegment::HandOver { .. } => "hand over",
        _ => "other",
    }
}

fn segments(outcome: &Outcome) -> Table {
    let head = [
        "segment",
        "from [s]",
        "greatest normal force [N]",
        "friction left [%]",
        "moved [mm]",
        "least grip known [%]",
    ];
    let mut table = Table::new("What was done", head);
    for (index, (segment, start)) in outcome.phases.iter().enumerate() {
        let during: Vec<&Moment> = outcome.moments.iter().filter(|moment| moment.phase == index).collect();
        if during.is_empty() {
            continue;
        }
        let force = during.iter().flat_map(|moment| moment.felt).fold(0.0, f64::max);
        let left = during.iter().filter_map(|moment| moment.left).map(|(_, truth)| 100.0 * truth);
        let moved = during.iter().filter_map(|moment| moment.moved).map(|moved| MILLIMETRES * moved);
        let holding = during.iter().filter(|moment| moment.holding).count();
        table.row([
            name(segment).to_owned(),
            number(*start),
            number(force),
            number_or_dash(left.reduce(f64::min)),
            number_or_dash(moved.reduce(f64::max)),
            number(100.0 * holding as f64 / during.len() as f64),
        ]);
    }
    table
}
