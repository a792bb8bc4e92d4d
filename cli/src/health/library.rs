//! `health` for programs that have the command within them: the same look, the same summary, the same page.

use std::path::{Path, PathBuf};

use fingertip_recordings::health::Health;

use super::{HealthArguments, page, watched, words};
use crate::analyze::library::{Failure, Recorded};
use crate::output::Overwrite;
use crate::span::Span;

/// What a recording shows of its sensor.
///
/// ```
/// use fingertip_cli::library::{Recorded, health};
/// use std::fmt::Write as _;
///
/// // Two seconds at 1 kHz: one force flickers by 0.01 N, the others never move.
/// let mut text = String::from("t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n");
/// for i in 0..2000 {
///     writeln!(text, "{},{},0,-1,0,0,0", f64::from(i) * 1e-3, f64::from(i * 7919 % 101 - 50) * 2e-4)?;
/// }
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("rest.csv");
/// std::fs::write(&path, text)?;
/// let of = health(&Recorded { path, ..Recorded::default() }, None, None)?;
/// assert_eq!((of.health.samples, of.health.channels.len()), (2000, 6));
/// assert!(!of.health.findings.is_empty() && of.summary.contains("fz"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct HealthOf {
    /// Everything that was found, and the figures behind it.
    pub health: Health,
    /// What should be minded.
    pub notes: Vec<String>,
    /// The same in sentences and tables, as the command prints it.
    pub summary: String,
    /// The page that the command writes.
    pub html: String,
}

/// Looks at a sensor by a recording of it, as `fingertip health` does: noise, spectra, drift, jumps of zeros, channels
/// that are stuck, clipped, dead or share noise. With a calibration what is said of loads is said, too; `rate` is that of
/// samples without times \[1/s\].
///
/// # Errors
/// [`Failure`], in the sentence that the command says.
pub fn health(
    recorded: &Recorded,
    calibration: Option<&Path>,
    rate: Option<f64>,
) -> Result<HealthOf, Failure> {
    let arguments = HealthArguments {
        recordings: vec![recorded.path.clone()],
        calibration: calibration.map(PathBuf::from),
        celsius: recorded.celsius,
        sensor: recorded.sensor.clone(),
        topics: recorded.topics.clone(),
        span: Span { start: recorded.start, end: recorded.end },
        rate,
        html: None,
        json: None,
        overwrite: Overwrite::default(),
    };
    arguments.check()?;
    arguments.span.check()?;
    let mut notes = Vec::new();
    let (health, name) = watched(&recorded.path, &arguments, &mut notes)?;
    let findings = words::findings(&health, &name, notes);
    let html = page::of(&health, &findings);
    Ok(HealthOf { summary: findings.to_string(), notes: findings.notes, health, html })
}
