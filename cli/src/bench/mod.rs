//! `fingertip bench`: what one needs to glue and to wire a designed sensor, of a file with its layout.
//!
//! `fingertip design` writes the same of the layout that it finds; a layout that somebody wired in half or full bridges
//! comes in by its file.

pub(crate) mod args;
mod converters;
mod sheets;

use fingertip_calibration::design::LayoutFile;

use crate::calibrate::files::{bad, text};
use crate::error::CliError;
use crate::output::Outputs;
use crate::summary::Findings;
use crate::table::short;
use args::BenchArguments;
pub(crate) use sheets::Bench;

pub(crate) fn run(arguments: &BenchArguments) -> Result<(), CliError> {
    let path = &arguments.layout;
    let outputs = Outputs::guard(arguments.overwrite, "output", [path], arguments.files.paths())?;
    let text = text("layout", path)?;
    let file = LayoutFile::from_toml(&text).map_err(|error| bad(path, &error))?;
    let tip = arguments.tip_radius_mm.map(|radius| radius * 1e-3);
    let bench = Bench::new(&file, tip, &arguments.parts).map_err(|error| bad(path, &error))?;
    bench.write(&outputs, &arguments.files)?;
    let layout = file.layout();
    let findings = Findings {
        title: format!(
            "{} gauges on a tube of Ø {} mm, in {} bridges",
            layout.gauges.len(),
            short((2.0 * layout.beam.radius + layout.beam.thickness) * 1e3),
            layout.channels()
        ),
        tables: bench.tables(),
        notes: bench.notes(),
        ..Findings::default()
    };
    outputs.say(&findings.to_string(), &[])
}
