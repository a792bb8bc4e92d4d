//! The session of the hand in pictures.

use super::{FINGERS, Mass, Moment, Outcome};
use crate::observe::Point;
use crate::report::{Axis, Chart, Figure};

const CLASSES: [&str; FINGERS] = ["a", "b", "c"];
/// Samples of one point of a curve.
const THINNED: usize = 4;

pub(super) fn of(outcome: &Outcome) -> Vec<Figure> {
    vec![forces(outcome), margins(outcome), mass(outcome), movement(outcome)]
}

/// A drawing over the time of the session, with lines upright where segments of the script begin.
fn over_time(title: &str, outcome: &Outcome, y: Axis) -> Chart {
    let end = outcome.moments.last().map_or(0.0, |end| end.time);
    let mut chart = Chart::new(title, Axis::linear("time / s", 0.0, end.max(1.0)), y);
    chart.marks("grid", outcome.phases.iter().map(|(_, start)| *start));
    chart
}

/// A curve of what moments have, broken where they have it not.
fn pieces(outcome: &Outcome, value: impl Fn(&Moment) -> Option<f64>) -> Vec<Vec<Point>> {
    let mut pieces = vec![Vec::new()];
    for moment in outcome.moments.iter().step_by(THINNED) {
        match (value(moment), pieces.last_mut()) {
            (Some(value), Some(piece)) => piece.push(Point { time: moment.time, value }),
            (None, Some(piece)) if !piece.is_empty() => pieces.push(Vec::new()),
            _ => {}
        }
    }
    pieces
}

fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

fn forces(outcome: &Outcome) -> Figure {
    let top = greatest(outcome.moments.iter().flat_map(|moment| moment.felt));
    let y = Axis::rounded("normal force / N", 0.0, top.max(1.0));
    let mut chart = over_time("Normal forces", outcome, y);
    for index in 0..FINGERS {
        let commanded = pieces(outcome, |moment| moment.commanded.and_then(|all| all.get(index).copied()));
        chart.curve("e wide", &commanded);
    }
    for (index, class) in CLASSES.into_iter().enumerate() {
        chart.curve(class, &pieces(outcome, |moment| moment.felt.get(index).copied()));
    }
    let mut keys: Vec<_> =
        CLASSES.into_iter().zip(1..).map(|(class, finger)| (class, format!("finger {finger}"))).collect();
    keys.push(("e", "commanded".to_owned()));
    Figure {
        title: "Normal forces".to_owned(),
        svg: chart.finish(),
        keys,
        caption: "As the sensors feel them, and as the controller wants them for the load of that sample. Lines upright \
                  are where a segment of the script begins."
            .to_owned(),
        on_white: false,
    }
}

fn margins(outcome: &Outcome) -> Figure {
    let percent = |share: f64| (100.0 * share).max(-20.0);
    let mut chart = over_time("Friction left", outcome, Axis::linear("friction left / %", -20.0, 100.0));
    chart.level("level", 0.0);
    chart.curve("a", &pieces(outcome, |moment| moment.left.map(|(felt, _)| percent(felt))));
    chart.curve("e wide", &pieces(outcome, |moment| moment.left.map(|(_, truth)| percent(truth))));
    let calls = outcome.moments.iter().filter(|moment| moment.slip.0).map(|moment| moment.time);
    chart.marks("mark", calls);
    Figure {
        title: "Friction left at the contact that has least".to_owned(),
        svg: chart.finish(),
        keys: vec![
            ("a", "felt, of the friction that is believed".to_owned()),
            ("e", "true".to_owned()),
            ("d", "slip called".to_owned()),
        ],
        caption: "At zero a contact slips. The hand believes in a friction of 0.5, and there is 0.6. A slip that is \
                  called where none is comes of a load that is taken off: it makes the grip firmer than it need be."
            .to_owned(),
        on_white: false,
    }
}

fn mass(outcome: &Outcome) -> Figure {
    const GRAMS: f64 = 1e3;
    let top = greatest(outcome.masses.iter().map(|mass| mass.truth)) * GRAMS;
    let mut chart = over_time("Mass", outcome, Axis::rounded("mass / g", 0.0, 1.2 * top));
    let values: [fn(&Mass) -> f64; 4] = [
        |mass| mass.truth,
        |mass| mass.found,
        |mass| mass.found - 2.0 * mass.deviation,
        |mass| mass.found + 2.0 * mass.deviation,
    ];
    for (class, value) in ["e", "a wide", "b", "b"].into_iter().zip(values) {
        let point = |mass: &Mass| Point { time: mass.time, value: value(mass) * GRAMS };
        let curve: Vec<Vec<Point>> = outcome.weighings().map(|one| one.iter().map(point).collect()).collect();
        chart.curve(class, &curve);
    }
    Figure {
        title: "What it weighs".to_owned(),
        svg: chart.finish(),
        keys: vec![
            ("e", "true".to_owned()),
            ("a", "found".to_owned()),
            ("b", "two standard deviations".to_owned()),
        ],
        caption:
            "From the beginning of a lift or the end of a pour on. Most of the deviation is the scale of the \
                  sensors' calibrations, so it does not shrink with time."
                .to_owned(),
        on_white: false,
    }
}

fn movement(outcome: &Outcome) -> Figure {
    const MILLIMETRES: f64 = 1e3;
    let top = greatest(outcome.moments.iter().filter_map(|moment| moment.moved)) * MILLIMETRES;
    let y = Axis::rounded("moved in the hand / mm", 0.0, top.max(0.1));
    let mut chart = over_time("Movement in the hand", outcome, y);
    chart.curve("a", &pieces(outcome, |moment| moment.moved.map(|moved| moved * MILLIMETRES)));
    Figure {
        title: "How far the object moves in the hand".to_owned(),
        svg: chart.finish(),
        keys: Vec::new(),
        caption:
            "The truth, from where it first left the table: the skins of the fingertips give under load."
                .to_owned(),
        on_white: false,
    }
}
