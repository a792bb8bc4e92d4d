//! The demo's result in words and tables.

use super::Outcome;
use crate::summary::Findings;
use crate::table::{Table, number, short};

const MILLIMETRES: f64 = 1e3;

pub(super) fn of(outcome: &Outcome) -> Findings {
    let Outcome { observations, rest, .. } = outcome;
    let lead = vec![
        format!(
            "A simulated fingertip (six strain gauges and a dummy gauge behind a sphere of 13 mm, as Bicchi & Dario built \
             it in 1987) was pressed, rolled and dragged for {} s. Its volts went through the whole pipeline; here is how \
             far the outcome is from the truth.",
            number(observations.duration())
        ),
        accuracy_sentence(outcome),
        slip_sentence(outcome),
    ];
    Findings {
        title: "A simulated fingertip".to_owned(),
        lead,
        tables: vec![accuracy(outcome), slips(outcome)],
        notes: vec![
            format!(
                "tare and noise come from {} samples of rest: a force component has {} N of noise, forces below {} N are \
                 no contact",
                rest.samples,
                number(rest.force_noise),
                number(outcome.least_force)
            ),
            "errors of a press are those of its mean reading; those of single samples are in the last column"
                .to_owned(),
            format!(
                "the dashed line of the friction ratio, {}, is the least friction coefficient of the script: below it \
                 nothing slips",
                short(outcome.coefficient)
            ),
            format!(
                "noise, gluing and calibration are those of seed {}; another one: --seed N",
                outcome.seed
            ),
        ],
    }
}

/// The figures that the paper gives for its prototype, from this one.
fn accuracy_sentence(outcome: &Outcome) -> String {
    let levels = outcome.report.levels();
    let at = |force: f64| levels.iter().find(|level| (level.force - force).abs() < 1e-6 * force);
    match (at(1.0), at(10.0)) {
        (Some(one), Some(ten)) => format!(
            "At 1 N the force is wrong by {} % and the contact point by {} mm, at 10 N by {} % and {} mm.",
            number(100.0 * one.mean_force_error),
            number(MILLIMETRES * one.mean_position_error),
            number(100.0 * ten.mean_force_error),
            number(MILLIMETRES * ten.mean_position_error)
        ),
        _ => String::new(),
    }
}

fn slip_sentence(outcome: &Outcome) -> String {
    let (found, all) = (outcome.report.slips_found(), outcome.report.slips.len());
    let found = if found == all { format!("All {all} slips") } else { format!("{found} of {all} slips") };
    let alarms = match outcome.report.false_alarms.len() {
        0 => "no false alarm".to_owned(),
        1 => "one false alarm".to_owned(),
        several => format!("{several} false alarms"),
    };
    format!("{found} were found within 20 ms, with {alarms}.")
}

fn accuracy(outcome: &Outcome) -> Table {
    let mut table = Table::new(
        "Accuracy by load",
        ["load / N", "force error / %", "position error / mm", "worst / mm", "one sample / mm"],
    );
    for level in outcome.report.levels() {
        table.row([
            number(level.force),
            number(100.0 * level.mean_force_error),
            number(MILLIMETRES * level.mean_position_error),
            number(MILLIMETRES * level.greatest_position_error),
            number(MILLIMETRES * level.sample_position_error),
        ]);
    }
    table
}

fn slips(outcome: &Outcome) -> Table {
    let mut table = Table::new("Slips", ["began at / s", "found after / ms"]);
    for slip in &outcome.report.slips {
        let delay = slip.delay.map_or_else(|| "missed".to_owned(), |delay| format!("{:.0}", 1e3 * delay));
        table.row([format!("{:.3}", slip.onset), delay]);
    }
    for time in &outcome.report.false_alarms {
        table.row([format!("{time:.3}"), "false alarm".to_owned()]);
    }
    table
}
