//! The drawing of the gauges and the landscape of the criterion.

use fingertip_calibration::design::{Criterion, DesignError, DesignSpace, Landscape};

use super::Outcome;
use crate::report::{Axis, Figure, contours, unrolled_tube};

/// Grid points of a landscape.
const GRID: [usize; 2] = [121, 91];

pub(super) fn of(outcome: &Outcome) -> Result<Vec<Figure>, DesignError> {
    let mut figures = vec![Figure {
        title: "Gauges on the unrolled tube".to_owned(),
        svg: unrolled_tube::draw(&outcome.layout, outcome.task.tube.length),
        keys: vec![("a", "turned by +Q".to_owned()), ("b", "turned by −Q".to_owned())],
        caption: "The tip is above; the solid line is the origin of the loads, the dashed one the clamped end. Angles run \
                  from the second axis towards the third. Gauges that cross are stacked."
            .to_owned(),
        on_white: false,
    }];
    let count = outcome.task.space.parameters().len();
    figures.push(landscape(outcome, [0, 1])?);
    if count == 3 {
        figures.push(landscape(outcome, [0, 2])?);
        figures.push(landscape(outcome, [1, 2])?);
    }
    Ok(figures)
}

fn landscape(outcome: &Outcome, axes: [usize; 2]) -> Result<Figure, DesignError> {
    let Outcome { task, found, .. } = outcome;
    let parameters = task.space.parameters();
    let best = found.best().ok_or(DesignError::Singular { reason: "nothing found" })?;
    let map = Landscape::new(&task.space, &task.criterion, &task.tube.loads, &best.values, axes, GRID)?;
    let [x, y] = axes.map(|axis| &parameters[axis]);
    let scaled = |values: &[f64], axis: usize| -> Vec<f64> {
        values.iter().map(|value| parameters[axis].display(*value)).collect()
    };
    let axis = |index: usize| {
        let parameter = &parameters[index];
        let label = format!("{} / {}", parameter.name, parameter.display_unit());
        Axis::linear(&label, parameter.display(parameter.lower), parameter.display(parameter.upper))
    };
    // In the unit in which it is told.
    let unit = match task.criterion {
        Criterion::ConditionNumber => 1.0,
        Criterion::ContactError(_) => task.noise * 1e3,
        _ => task.noise * 100.0,
    };
    let values: Vec<Vec<f64>> =
        map.values.iter().map(|row| row.iter().map(|value| value * unit).collect()).collect();
    let name = match task.criterion {
        Criterion::ConditionNumber => "Condition number".to_owned(),
        Criterion::ContactError(_) => "Contact position error / mm".to_owned(),
        ref other => format!("{} / % of nominal", other.name()),
    };
    let title = format!("{name} over {} and {}", x.name, y.name);
    let mark = |values: &[f64]| (x.display(values[axes[0]]), y.display(values[axes[1]]));
    let marks: Vec<_> = found.minima.iter().take(8).map(|minimum| mark(&minimum.values)).collect();
    let (svg, keys) = contours::draw(&contours::Contours {
        title: &title,
        x: axis(axes[0]),
        y: axis(axes[1]),
        xs: &scaled(&map.xs, axes[0]),
        ys: &scaled(&map.ys, axes[1]),
        values: &values,
        marks: &marks,
    });
    let caption = match (parameters.len() > 2, marks.len() > 1) {
        (false, _) => "The red cross is the best design.",
        (true, false) => "The red cross is the best design; the other parameters are held at it.",
        (true, true) => {
            "The red cross is the best design; the other parameters are held at it. The others are further local minima, \
             which lie elsewhere in those."
        }
    };
    Ok(Figure { title, svg, keys, caption: caption.to_owned(), on_white: false })
}
