//! The demo's result in words and tables.

use super::Outcome;
use crate::summary::Findings;
use crate::table::{Table, number};

const MILLIMETRES: f64 = 1e3;

pub(super) fn of(outcome: &Outcome) -> Findings {
    let Outcome { report, observations, rest, .. } = outcome;
    let found = report.slips_found();
    let false_alarms = report.false_alarms.len();
    let errors = report.presses.iter().map(|press| press.force_error);
    let force_error = 100.0 * errors.sum::<f64>() / report.presses.len().max(1) as f64;
    let lead = vec![
        format!(
            "A simulated fingertip (six strain gauges and a dummy gauge behind a sphere of 13 mm, as Bicchi & Dario built in 1987) \
             was pressed, rolled and dragged for {} s. Its volts went through the whole pipeline; this compares the outcome with the truth.",
            number(observations.duration())
        ),
        format!(
            "Over all presses the force is wrong by {} % on average. {} of {} slips were found within 20 ms, {} missed, {}.",
            number(force_error),
            found,
            report.slips.len(),
            report.slips.len() - found,
            match false_alarms {
                0 => "no false alarm".to_owned(),
                1 => "one false alarm".to_owned(),
                several => format!("{several} false alarms"),
            }
        ),
    ];
    Findings {
        title: "A simulated fingertip".to_owned(),
        lead,
        tables: vec![accuracy(outcome), slips(outcome)],
        notes: vec![
            format!(
                "tare and noise come from {} samples of rest: a force component has {} N of noise, forces below {} N are no contact",
                rest.samples,
                number(rest.force_noise),
                number(outcome.least_force)
            ),
            "errors of a press are those of the mean over 0.25 s; those of single samples are in the last column".to_owned(),
            format!("seed {} of the noise, the gluing and the calibration; another one: --seed N", outcome.seed),
        ],
    }
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
