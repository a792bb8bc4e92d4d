//! `fingertip motion`: a calibration from a weight of known size in unknown directions.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use clap::Args;
use fingertip_calibration::file::{CalibrationFile, FileError, Quality, SignalUnit, Verdict};
use fingertip_calibration::loads::{Columns, LoadTable, Rest, signals_from_csv};
use fingertip_calibration::motion::{LeverArm, constant_force, lever_arms};
use nalgebra::{DMatrix, DVector, Vector3};

use crate::calibrate::files::{bad, open, read_loads};
use crate::error::CliError;
use crate::output::{Outputs, Overwrite};
use crate::standard::shown;

#[derive(Debug, Args)]
#[command(after_help = "Without arms, three components are found, up to one rotation of all of them; with \
    arms (columns arm_x_m, arm_y_m, arm_z_m: where the weight hangs, four at least that do not lie in a plane, \
    ten directions each), all six. --align settles what is left open.")]
pub(crate) struct MotionArguments {
    /// Readings under the weight in ten or more directions: CSV with v1_V …
    #[arg(value_name = "READINGS.csv")]
    readings: PathBuf,
    /// The weight
    #[arg(long, value_name = "NEWTONS")]
    force: f64,
    /// Readings under forces of known direction (columns fx_N, fy_N, fz_N; sizes do not matter): two at
    /// least for three components, one for six
    #[arg(long, value_name = "KNOWN.csv")]
    align: Option<PathBuf>,
    /// Greatest relative misfit that is a solution (six components): a few times the noise
    #[arg(long, value_name = "SHARE", default_value_t = 0.02)]
    tolerance: f64,
    /// How many starts the search makes (six components)
    #[arg(long, value_name = "N", default_value_t = 100)]
    starts: usize,
    /// Where to write the calibration; needs --align
    #[arg(short, long, value_name = "FILE", requires = "align")]
    output: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

/// What was found, and the gauges' sensitivities if nothing is left open.
struct Found {
    text: String,
    /// Gauges × axes per N and N·m, and nominal loads.
    sensitivities: DMatrix<f64>,
    nominal: Vec<f64>,
    zero: DVector<f64>,
    noise: f64,
}

pub(crate) fn run(arguments: &MotionArguments) -> Result<(), CliError> {
    let path = &arguments.readings;
    let inputs = [Some(path), arguments.align.as_ref()].into_iter().flatten();
    let outputs = Outputs::guard(arguments.overwrite, "output", inputs, &arguments.output)?;
    // It is read twice, which the standard input cannot be.
    let mut text = Vec::new();
    let mut file = open("table of readings", path)?;
    file.read_to_end(&mut text).map_err(|source| CliError::read("table of readings", path, source))?;
    let Rest { signals, unit, .. } = signals_from_csv(text.as_slice()).map_err(|error| bad(path, &error))?;
    let columns = Columns::from_csv(text.as_slice()).map_err(|error| bad(path, &error))?;
    let mut notes = Vec::new();
    let known = match &arguments.align {
        Some(path) => Some((path.as_path(), read_loads(path, &mut notes)?)),
        None => None,
    };
    if let Some((path, table)) = &known
        && (table.gauges() != signals.ncols() || table.signal_unit != unit)
    {
        return Err(bad(path, &"it has other gauges or units than the readings"));
    }
    let found = if columns.has("arm_x_m") {
        six_components(arguments, &columns, &signals, known.as_ref())?
    } else {
        three_components(arguments, &signals, known.as_ref())?
    };
    if let Some(output) = &arguments.output {
        let file = to_file(&found, unit, path, signals.nrows()).map_err(|message| bad(path, &message))?;
        outputs.write("calibration", output, &file)?;
    }
    outputs.say(&found.text, &notes)
}

type Known<'a> = (&'a Path, LoadTable);

fn three_components(
    arguments: &MotionArguments,
    signals: &DMatrix<f64>,
    known: Option<&Known<'_>>,
) -> Result<Found, CliError> {
    let path = &arguments.readings;
    let mut fit = constant_force(signals, arguments.force).map_err(|error| bad(path, &error))?;
    let mut text = format!(
        "Three components from {} directions of {} N: forces fit to {:.3} % (RMS)\n",
        signals.nrows(),
        arguments.force,
        100.0 * fit.misfit
    );
    if signals.ncols() > 3 {
        text.push_str(&format!(
            "what the gauges say beside three components: {:.3} % of the weakest of these\n",
            100.0 * fit.leakage
        ));
    }
    match known {
        None => {
            text.push_str("not observed: one rotation (or reflection) of all forces; settle it by --align\n")
        }
        Some((path, table)) => {
            let pairs = directions(table);
            fit = fit.aligned(&pairs).map_err(|error| bad(path, &error))?;
            let worst = pairs
                .iter()
                .filter_map(|(reading, force)| Some(fit.force(reading)?.angle(force).to_degrees()))
                .fold(0.0, f64::max);
            text.push_str(&format!(
                "aligned with {} known directions, to {worst:.2}° at worst\n",
                pairs.len()
            ));
        }
    }
    text.push_str(&format!("size of forces ± {:.4} % because of the fit\n", 100.0 * fit.size_deviation));
    text.push_str(&zero(&fit.zero, &fit.zero_deviation, fit.noise));
    let nominal = vec![arguments.force; 3];
    Ok(Found { text, sensitivities: fit.signals_from_force, nominal, zero: fit.zero, noise: fit.noise })
}

/// Readings and directions of the forces; a row at rest has none.
fn directions(table: &LoadTable) -> Vec<(DVector<f64>, Vector3<f64>)> {
    let force = |i: usize| {
        let mut force = Vector3::zeros();
        for (j, axis) in table.axes.iter().enumerate().filter(|(_, axis)| !axis.is_torque()) {
            force[axis.index()] = table.loads[(i, j)];
        }
        force
    };
    let loaded = (0..table.samples()).filter(|i| table.loads.row(*i).iter().any(|load| *load != 0.0));
    loaded.map(|i| (table.signals.row(i).transpose(), force(i))).collect()
}

fn six_components(
    arguments: &MotionArguments,
    columns: &Columns,
    signals: &DMatrix<f64>,
    known: Option<&Known<'_>>,
) -> Result<Found, CliError> {
    let path = &arguments.readings;
    let places = columns.vectors(["arm_x_m", "arm_y_m", "arm_z_m"]).map_err(|error| bad(path, &error))?;
    let mut rows: Vec<(Vector3<f64>, Vec<usize>)> = Vec::new();
    for (i, arm) in places.iter().enumerate() {
        match rows.iter_mut().find(|(known, _)| known == arm) {
            Some((_, list)) => list.push(i),
            None => rows.push((*arm, vec![i])),
        }
    }
    let arms: Vec<LeverArm> =
        rows.iter().map(|(arm, list)| LeverArm { arm: *arm, signals: signals.select_rows(list) }).collect();
    let mut fit = lever_arms(&arms, arguments.force, arguments.tolerance, arguments.starts, 1)
        .map_err(|error| bad(path, &error))?;
    let mut text = format!(
        "Six components from {} N on {} arms: relative residual {:.2e}, reached by {} of {} starts; forces fit to \
         {:.3} % at worst\n",
        arguments.force,
        arms.len(),
        fit.residual,
        fit.hits,
        fit.starts,
        100.0 * fit.misfit
    );
    match known {
        None => text.push_str("not observed: one sign of everything; settle it by --align\n"),
        Some((path, table)) => {
            let pairs = directions(table);
            let Some((reading, force)) = pairs.first() else {
                return Err(bad(path, &"it has no row"));
            };
            let message = "the force of its first row does not tell the sign";
            fit = fit.with_sign(reading, force).ok_or_else(|| bad(path, &message))?;
            text.push_str("sign settled by the first known direction\n");
        }
    }
    let longest = rows.iter().map(|(arm, _)| arm.norm()).fold(0.0, f64::max);
    let (force, torque) = (arguments.force, arguments.force * longest);
    let nominal = vec![force, force, force, torque, torque, torque];
    let errors = fit.deviations.column_iter().zip(fit.sensitivities.column_iter());
    let errors: Vec<String> =
        errors.map(|(s, c)| format!("{:.3}", 100.0 * s.norm() / c.norm().max(f64::MIN_POSITIVE))).collect();
    text.push_str(&format!("sensitivities to Fx … Tz ± {} %\n", errors.join(" ")));
    text.push_str(&zero(&fit.zero, &fit.zero_deviation, fit.noise));
    Ok(Found { text, sensitivities: fit.sensitivities, nominal, zero: fit.zero, noise: fit.noise })
}

fn zero(zero: &DVector<f64>, deviations: &DVector<f64>, noise: f64) -> String {
    let list = |list: &DVector<f64>| list.iter().map(|x| format!("{x:.5}")).collect::<Vec<_>>().join(" ");
    format!("zero {} (± {})\nnoise of one reading {noise:.2e}\n", list(zero), list(deviations))
}

fn to_file(found: &Found, unit: SignalUnit, source: &Path, samples: usize) -> Result<String, FileError> {
    let mut matrix = found.sensitivities.clone();
    for (mut column, nominal) in matrix.column_iter_mut().zip(&found.nominal) {
        column *= *nominal;
    }
    let zero = found.zero.as_slice().to_vec();
    let mut file = CalibrationFile::new(matrix, found.nominal.clone(), zero, unit)?;
    file.noise = found.noise.is_finite().then(|| vec![found.noise; file.gauges()]);
    file.provenance.method = "shape from motion".to_owned();
    file.provenance.source = shown(source);
    file.quality = Quality {
        verdict: Verdict::Unchecked,
        reasons: vec!["from a weight in unknown directions: check it on known loads".to_owned()],
        samples: Some(samples as u64),
        ..Quality::default()
    };
    file.to_toml()
}
