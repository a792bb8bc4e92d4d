//! The design in words and tables.

use fingertip_calibration::design::{
    Criterion, DesignSpace, Parameter, ParameterUnit, Spread, THICKEST_WALL, TubeFailure,
};

use super::{CALIBRATION_LOADS, LOAD_ERROR, Outcome};
use crate::bench::Bench;
use crate::summary::Findings;
use crate::table::{Table, number, short};

/// Most minima that a table lists.
const LISTED: usize = 8;

pub(super) fn of(outcome: &Outcome, bench: &Bench) -> Findings {
    let Outcome { task, found, layout, strength, .. } = outcome;
    let (judged, noise) = (&outcome.compared[0].1, task.noise);
    let error = judged.contact_error.map_or(f64::NAN, |error| error * noise);
    let mut lead = vec![
        format!(
            "Condition number {}; rms contact error {} mm at {} N, from {} µm/m of noise alone.",
            number(judged.condition_number),
            number(error * 1e3),
            short(task.touch_force),
            short(noise * 1e6)
        ),
        format!(
            "A tube of {} mm mean radius with a wall of {} mm: it bears {} times the nominal loads, all at once; then {}.",
            short(layout.beam.radius * 1e3),
            number(layout.beam.thickness * 1e3),
            short(strength.safety()),
            match strength.failure() {
                TubeFailure::Yield => "it yields (von Mises)",
                TubeFailure::WallBuckling => "its wall buckles",
                TubeFailure::ColumnBuckling => "it buckles as a column",
            }
        ),
    ];
    lead.push(match outcome.file.find_decoupling() {
        Ok(Some(found)) if found.couplings() == 0 => {
            "Sums and differences of the signals give every load by itself; they stand in the layout file.".to_owned()
        }
        Ok(Some(found)) => format!(
            "Sums and differences of the signals give one load after another, with {} couplings; they stand in the layout file.",
            found.couplings()
        ),
        _ => "No small combination of the signals separates the loads: solve by elimination.".to_owned(),
    });
    let mut findings = Findings {
        title: format!(
            "A sensor for {} N and {} N·m",
            short(task.tube.loads.force[0]),
            short(task.tube.loads.torque[0])
        ),
        lead,
        tables: vec![
            gauges(outcome),
            accuracy(outcome),
            comparison(outcome),
            tolerances(outcome),
            strengths(outcome),
        ],
        notes: notes(outcome, bench),
    };
    findings.tables.insert(1, minima(outcome));
    if let Some(table) = sensitivities(outcome) {
        findings.tables.push(table);
    }
    findings.tables.extend(bench.tables());
    if found.failed > 0 {
        findings.notes.push(format!("{} starts found no sensor that can be built", found.failed));
    }
    findings
}

fn gauges(outcome: &Outcome) -> Table {
    let mut table = Table::new("Gauges", ["", "behind origin / mm", "around / °", "angle Q / °"]);
    for (number, gauge) in (1..).zip(&outcome.layout.gauges) {
        let turned = gauge.theta.to_degrees().rem_euclid(360.0);
        // The same direction between −90° and 90°.
        let q = (gauge.q.to_degrees() + 90.0).rem_euclid(180.0) - 90.0;
        let z = gauge.z * 1e3;
        // No "−0.00".
        let z = if z.abs() < 5e-3 { 0.0 } else { z };
        table.row([format!("{number}"), format!("{z:.2}"), format!("{turned:.2}"), format!("{q:.2}")]);
    }
    table
}

/// What a criterion's value is printed as, with its unit.
fn shown(outcome: &Outcome, value: f64) -> String {
    match outcome.task.criterion {
        Criterion::ConditionNumber => format!("{value:.4}"),
        Criterion::ContactError(_) => format!("{} mm", number(value * outcome.task.noise * 1e3)),
        _ => format!("{} %", number(value * outcome.task.noise * 100.0)),
    }
}

fn minima(outcome: &Outcome) -> Table {
    let Outcome { task, found, .. } = outcome;
    let parameters = task.space.parameters();
    let few = parameters.len() <= 4;
    let title = format!("Local minima of the {}", task.criterion.name());
    let mut table = Table::new(&title, ["", "value", "starts"]);
    if few {
        table.head.extend(parameters.iter().map(|p| format!("{} / {}", p.name, p.display_unit())));
    }
    for (rank, minimum) in (1..).zip(found.minima.iter().take(LISTED)) {
        let share = format!("{:.0} %", minimum.share * 100.0);
        let mut row = vec![format!("{rank}"), shown(outcome, minimum.criterion), share];
        if few {
            row.extend(
                parameters
                    .iter()
                    .zip(&minimum.values)
                    .map(|(p, value)| format!("{:.2}", p.display(*value) + 0.0)),
            );
        }
        table.rows.push(row);
    }
    table
}

fn sensitivities(outcome: &Outcome) -> Option<Table> {
    let best = outcome.found.best()?;
    let parameters = outcome.task.space.parameters();
    let title = format!("How the {} changes by a step", outcome.task.criterion.name());
    let mut table = Table::new(&title, ["", "step", "down", "up"]);
    for (parameter, change) in parameters.iter().zip(&best.sensitivities) {
        let step = format!("{} {}", short(parameter.display(parameter.tolerance)), parameter.display_unit());
        let of = |change: f64| format!("{:+.2} %", 100.0 * change / best.criterion);
        table.row([parameter.name.clone(), step, of(change.lower), of(change.higher)]);
    }
    Some(table)
}

fn accuracy(outcome: &Outcome) -> Table {
    let mut table = Table::new(
        "Accuracy to expect",
        ["", "at / N", "contact rms / mm", "95 % / mm", "force rms / %", "missed / %"],
    );
    for (name, force, accuracy) in &outcome.trials {
        table.row([
            (*name).to_owned(),
            short(*force),
            number(accuracy.position_rms * 1e3),
            number(accuracy.position_95 * 1e3),
            number(accuracy.force_rms * 100.0),
            short(accuracy.missed * 100.0),
        ]);
    }
    table
}

fn comparison(outcome: &Outcome) -> Table {
    let noise = outcome.task.noise;
    let title = format!("Beside others, at {} N", short(outcome.task.touch_force));
    let mut table = Table::new(&title, ["", "N_c", "contact / mm", "worst axis / µm/m", "log det"]);
    for (name, judged) in &outcome.compared {
        table.row([
            name.clone(),
            number(judged.condition_number),
            number(judged.contact_error.map_or(f64::NAN, |error| error * noise * 1e3)),
            number(judged.worst_sensitivity() * 1e6),
            number(judged.log_determinant),
        ]);
    }
    table
}

fn tolerances(outcome: &Outcome) -> Table {
    let mut table = Table::new("As it will be made", ["", "as designed", "mean", "99 % at most"]);
    let mut row = |name: &str, spread: &Spread, unit: f64| {
        let of = |value: f64| number(value * unit);
        table.row([name.to_owned(), of(spread.nominal), of(spread.mean), of(spread.quantile_99)]);
    };
    let report = &outcome.tolerance;
    row("condition number", &report.condition_number, 1.0);
    if let Some(spread) = &report.calibrated_error {
        row("contact error by noise, calibrated / mm", spread, outcome.task.noise * 1e3);
    }
    if let Some(spread) = &report.uncalibrated_error {
        row("contact error by placement, not calibrated / mm", spread, 1e3);
    }
    table
}

fn strengths(outcome: &Outcome) -> Table {
    let strength = &outcome.strength;
    let mut table = Table::new("Strength, all loads at once", ["", "value", "of the limit"]);
    let percent = |ratio: f64| format!("{:.1} %", ratio * 100.0);
    table.row(["stress / MPa".to_owned(), number(strength.stress * 1e-6), percent(strength.yield_ratio)]);
    table.row(["buckling of the wall".to_owned(), String::new(), percent(strength.wall_buckling_ratio)]);
    table.row(["buckling as a column".to_owned(), String::new(), percent(strength.column_buckling_ratio)]);
    table.row([
        "wall over radius".to_owned(),
        number(strength.wall_ratio),
        percent(strength.wall_ratio / THICKEST_WALL),
    ]);
    table
}

/// Parameters that would go further if they could.
fn at_bounds(outcome: &Outcome) -> Vec<String> {
    let Some(best) = outcome.found.best() else { return Vec::new() };
    let of = |(parameter, value): (&Parameter, &f64)| {
        let (lowest, near) = (*value - parameter.lower, 1e-3 * parameter.span());
        let bound = if parameter.periodic {
            return None;
        } else if lowest < near {
            ("least", parameter.lower)
        } else if parameter.span() - lowest < near {
            ("greatest", parameter.upper)
        } else {
            return None;
        };
        let moved = match (parameter.name.as_str(), parameter.unit) {
            ("R", _) => "--radius-mm moves it",
            (_, ParameterUnit::Metre) if bound.0 == "least" => {
                "gauges go no nearer to the origin of the loads"
            }
            (_, ParameterUnit::Metre) => {
                "gauges stay within 0.8 of the clamped length, since nearer to the clamp the strain is not that of a beam; \
                 --length-mm moves it"
            }
            _ => "it cannot be moved",
        };
        let (side, at) = (bound.0, short(parameter.display(bound.1)));
        Some(format!("{} is at its {side}, {at} {}: {moved}", parameter.name, parameter.display_unit()))
    };
    outcome.task.space.parameters().iter().zip(&best.values).filter_map(of).collect()
}

fn notes(outcome: &Outcome, bench: &Bench) -> Vec<String> {
    let Outcome { task, layout, strength, .. } = outcome;
    let x = task.arm() / layout.beam.radius;
    let bound = 2.0_f64.sqrt() * x.max(1.0 / x);
    let mut notes = vec![
        format!(
            "No gauges on a thin tube of this radius have a condition number below {} for these loads; {} mm is the best radius",
            number(bound),
            short(task.arm() * 1e3)
        ),
        "The condition number does not know how large the strains are: a tube that is thin and narrow strains more and \
         may locate contacts better although its condition number is higher; compare --criterion contact-error"
            .to_owned(),
        format!(
            "Touches are spread over the half of the tip around its pole, with friction ratios up to what was given; the \
             simulated calibration has {CALIBRATION_LOADS} loads known to {} % of full scale",
            short(LOAD_ERROR * 100.0)
        ),
        "Contact errors from noise fall as 1/force; those from misplacement do not depend on it".to_owned(),
    ];
    notes.extend(at_bounds(outcome));
    if strength.wall_ratio > THICKEST_WALL {
        notes.push("The wall is not thin against the radius: the strains are not accurate".to_owned());
    }
    if layout.beam.thickness < 0.1e-3 {
        notes.push(format!(
            "A wall of {} mm is hard to machine: give one with --wall-mm",
            number(layout.beam.thickness * 1e3)
        ));
    }
    notes.extend(bench.notes());
    notes
}
