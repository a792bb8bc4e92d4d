//! The formats of files: recordings, loads, calibrations, payloads, layouts, contacts.

use core::fmt::Write;

use fingertip_cli::contact_columns::{CONTACT_COLUMNS, Columns, FUSED_COLUMNS, FUSED_DISAGREEMENT};

use super::cell;
use super::source::{comment_section, example, fields, section};
use crate::failure::Failure;

/// Tables of the fields of structs.
fn tables(path: &str, structs: &[(&str, &str)]) -> Result<String, Failure> {
    let mut text = String::new();
    for (name, heading) in structs {
        let _ = write!(text, "\n{heading}\n\n| field | meaning |\n|---|---|\n");
        for (field, says) in fields(path, name)? {
            let _ = writeln!(text, "| `{field}` | {} |", cell(&says));
        }
    }
    Ok(text)
}

/// All formats but those of scenes and contacts.
pub(super) fn page() -> Result<String, Failure> {
    let recordings = section("recordings/README.md", "# The schema")?;
    let recordings = recordings.split_once("\n```").map_or(recordings.as_str(), |(words, _)| words).trim();
    let loads = comment_section("calibration/src/loads/text.rs", "The header")?;
    let calibration = tables(
        "calibration/src/file/calibration_file.rs",
        &[
            ("CalibrationFile", "At the top:"),
            ("Provenance", "`[provenance]`, where the calibration comes from:"),
            ("Quality", "`[quality]`, how good it is:"),
        ],
    )?;
    let payload = tables(
        "calibration/src/file/payload_file.rs",
        &[
            ("PayloadFile", "At the top:"),
            ("InertialUnitFile", "`[inertial_unit]`, how the unit sits on the sensor that told it:"),
            ("PayloadQuality", "`[quality]`, how well it is known:"),
        ],
    )?;
    let layout = example("calibration/src/design/layout_file.rs")?;
    Ok(format!(
        "# Files\n\nAll files are text but MCAP. Calibrations, payloads, layouts and scenes are TOML with a `version`; \
         recordings and tables are CSV with the unit in the name of each column. Every file appears whole or not at \
         all.\n\n| file | written by | read by |\n|---|---|---|\n\
         | [scene](scene.md) | you, `scene init`, `geometry` | `analyze`, `live`, `record`, `export` |\n\
         | [recording](#recordings), `.csv` or `.mcap` | `record`, `convert`, you | `analyze`, `health`, `info`, `tare` |\n\
         | [table of loads](#tables-of-loads), `.csv` | you | `calibrate`, `check`, `refine` |\n\
         | [calibration](#calibrations), `.toml` | `calibrate`, `import`, `tare` | `[sensor]` of a scene, `--calibration` |\n\
         | [payload](#payloads), `.toml` | `calibrate --gravity`, `--inertial` | `[payload]` of a scene, `--payload` |\n\
         | [layout](#layouts), `.toml` | `design`, you | `bench`, the solvers, the simulated fingertip |\n\
         | [`contacts.csv`](contacts.md) | `analyze` | you |\n\n\
         ## Recordings\n\n{recordings}\n\nMCAP files hold messages of ROS 2 (`geometry_msgs/msg/WrenchStamped` and the \
         like), and are told from CSV by their first bytes.\n\n\
         ## Tables of loads\n\n{loads}\n\n\
         ## Calibrations\n\n`signals = matrix · (load / nominal)`: the matrix is normalised, an entry is the signal of a \
         gauge under the nominal load of an axis. Loads are those on the fingertip, in N and N·m, about the origin of the \
         sensor frame. A `checksum` is taken over the values, so that comments and layout may be changed by \
         hand.\n{calibration}\n\
         ## Payloads\n\nWhat hangs on the sensor and is no contact.\n{payload}\n\
         ## Layouts\n\nA sensor's gauges on their tube. By hand, without a checksum:\n\n```toml\n{layout}\n```\n"
    ))
}

/// The columns of `contacts.csv`.
pub(super) fn contacts() -> String {
    let mut text = String::from(
        "# `contacts.csv`\n\nOne row per row of the recording, in SI units and the sensor frame. Where there is no value, \
         the cell is empty. Numbers have eight significant digits, times are rounded to nanoseconds.\n\n\
         | column | of a scene with | meaning |\n|---|---|---|\n",
    );
    for Columns { of, names, says, .. } in CONTACT_COLUMNS {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        let of = if of.is_empty() || of.contains(' ') { (*of).to_owned() } else { format!("`{of}`") };
        let _ = writeln!(text, "| {} | {of} | {} |", names.join(", "), cell(says));
    }
    text.push_str("\nOf each place of a tactile array, with `fused1_`, `fused2_` and so on in front, for a scene with `[fusion]`:\n\n");
    text.push_str("| column | meaning |\n|---|---|\n");
    for (name, says) in FUSED_COLUMNS {
        let _ = writeln!(text, "| `{name}` | {says} |");
    }
    let (name, says) = FUSED_DISAGREEMENT;
    let _ = writeln!(text, "\nAnd once, `{name}`: {says}.");
    text
}
