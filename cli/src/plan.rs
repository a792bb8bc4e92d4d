//! `fingertip plan`: which loads to apply, and how many are enough.

use std::path::PathBuf;

use clap::Args;
use fingertip_calibration::experiment::plan_after;
use fingertip_calibration::fit::FitError;
use nalgebra::DMatrix;

use crate::calibrate::files::{bad, read_columns};
use crate::error::CliError;
use crate::output::{print, read_once};
use crate::table::{Table, number};

#[derive(Debug, Args)]
pub(crate) struct PlanArguments {
    /// The loads that can be applied: CSV with fx_N … tz_Nm, and a name for each if wanted
    #[arg(value_name = "LOADS.csv")]
    candidates: PathBuf,
    /// Loads that were applied already, with the same columns
    #[arg(long, value_name = "DONE.csv")]
    done: Option<PathBuf>,
    /// Enough is when the calibration adds at most so many times the error of one reading, at every load
    #[arg(long, value_name = "RATIO", default_value_t = 0.5)]
    accuracy: f64,
    /// The readings will be tared, so that no zero is to be found
    #[arg(long)]
    no_bias: bool,
    /// Full scale of each axis in N and N·m, separated by commas; the greatest loads without it
    #[arg(long, value_delimiter = ',', value_name = "LOADS")]
    full_scale: Option<Vec<f64>>,
    /// Give up beyond so many loads
    #[arg(long, value_name = "N", default_value_t = 500)]
    most: usize,
}

/// Full scale of each axis: as it is stated, or the greatest loads.
fn full_scale(
    arguments: &PlanArguments,
    axes: usize,
    candidates: &DMatrix<f64>,
) -> Result<Vec<f64>, CliError> {
    match &arguments.full_scale {
        Some(list) if list.len() == axes && list.iter().all(|x| *x > 0.0) => Ok(list.clone()),
        Some(_) => {
            let message = format!("--full-scale needs one positive number for each of {axes} axes");
            Err(bad(&arguments.candidates, &message))
        }
        None => {
            let sizes = candidates.column_iter().map(|column| column.amax());
            Ok(sizes.map(|size| if size > 0.0 { size } else { 1.0 }).collect())
        }
    }
}

pub(crate) fn run(arguments: &PlanArguments) -> Result<(), CliError> {
    let path = &arguments.candidates;
    read_once(core::iter::once(path).chain(&arguments.done).map(PathBuf::as_path))?;
    let columns = read_columns("list of loads", path)?;
    let (axes, candidates) = columns.loads().map_err(|error| bad(path, &error))?;
    let full_scale = full_scale(arguments, axes.len(), &candidates)?;
    let normalised = |mut loads: DMatrix<f64>| {
        for (mut column, size) in loads.column_iter_mut().zip(&full_scale) {
            column /= *size;
        }
        loads
    };
    let done = match &arguments.done {
        None => DMatrix::zeros(0, axes.len()),
        Some(path) => {
            let (other, loads) =
                read_columns("list of loads", path)?.loads().map_err(|error| bad(path, &error))?;
            if other != axes {
                return Err(bad(path, &"it has other axes than the loads that can be applied"));
            }
            normalised(loads)
        }
    };
    let (bias, most) = (!arguments.no_bias, arguments.most);
    let plan = plan_after(&done, &normalised(candidates.clone()), bias, arguments.accuracy, most).map_err(
        |error| {
            let message = match error {
                FitError::Unobserved(mut unobserved) => {
                    unobserved.names = axes.iter().map(ToString::to_string).collect();
                    unobserved.names.extend(bias.then(|| "constant".to_owned()));
                    unobserved.to_string()
                }
                FitError::TooFewSamples { .. } => format!(
                    "{most} of these loads are not enough for an accuracy of {}; see --most",
                    arguments.accuracy
                ),
                other => other.to_string(),
            };
            bad(path, &message)
        },
    )?;
    let names = columns.has("name").then(|| columns.texts("name")).transpose();
    let names = names.map_err(|error| bad(path, &error))?;
    let mut table = Table::new("Loads in the order in which to apply them", ["", "load", "error after"]);
    for (step, (candidate, deviation)) in plan.order.iter().zip(&plan.deviation).enumerate() {
        let name = match &names {
            Some(names) => names[*candidate].to_owned(),
            None => {
                let parts = axes.iter().enumerate().filter(|(j, _)| candidates[(*candidate, *j)] != 0.0);
                let parts: Vec<String> = parts
                    .map(|(j, axis)| {
                        format!("{axis} {} {}", number(candidates[(*candidate, j)]), axis.unit())
                    })
                    .collect();
                if parts.is_empty() { "no load".to_owned() } else { parts.join(", ") }
            }
        };
        let error = if deviation.is_finite() { number(*deviation) } else { "open".to_owned() };
        table.row([(step + 1).to_string(), name, error]);
    }
    let text = format!(
        "{} loads{} are enough: the calibration then adds at most {} times the error of one reading\n\n{table}",
        plan.order.len(),
        if done.nrows() > 0 {
            format!(" beside the {} that were applied", done.nrows())
        } else {
            String::new()
        },
        arguments.accuracy
    );
    let note = "error after: what the calibration adds at the worst load, in errors of one reading; open while \
                the loads do not determine the sensor";
    print(&format!("{text}note: {note}\n"))
}
