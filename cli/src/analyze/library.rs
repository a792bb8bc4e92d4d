//! `analyze` for programs that have the command within them: the same pass, the same summary, the same page.

use core::fmt;
use std::io::Read;
use std::path::{Path, PathBuf};

use fingertip_recordings::{Quality, ReaderOptions, RecordingReader};
use fingertip_scene::{Felt, Scene};

use super::args::AnalyzeArguments;
use super::array::Fused;
use super::sink::Sink;
use super::{Analysed, analysed};
use crate::error::CliError;
pub use crate::health::{HealthOf, health};
use crate::observe::Status;
use crate::opened::Opened;
use crate::output::Overwrite;
use crate::report::{self, used::Given};
use crate::span::Span;

/// Why a recording could not be read or analysed, in the sentence that the command says.
///
/// ```
/// use fingertip_cli::library::{Failure, Recorded};
/// use fingertip_recordings::ReaderOptions;
///
/// let recorded = Recorded { path: "nowhere.csv".into(), ..Recorded::default() };
/// let failure: Option<Failure> = recorded.rows(ReaderOptions::default(), &mut Vec::new()).err();
/// // It says which file.
/// assert!(failure.is_some_and(|failure| failure.to_string().contains("nowhere.csv")));
/// ```
#[derive(Debug)]
pub struct Failure(CliError);

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl core::error::Error for Failure {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        self.0.source()
    }
}

impl From<CliError> for Failure {
    fn from(error: CliError) -> Self {
        Self(error)
    }
}

/// Which recording, and what of it.
///
/// ```
/// use fingertip_cli::library::Recorded;
/// use fingertip_recordings::ReaderOptions;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("push.csv");
/// std::fs::write(&path, "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,-1,0,0,0\n0.001,0,0,-2,0,0,0\n")?;
/// let mut notes = Vec::new();
/// let mut rows = Recorded { path, ..Recorded::default() }.rows(ReaderOptions::default(), &mut notes)?;
/// let sensor = rows.layout().only_wrench()?.clone();
/// let wrench = rows.next_row()?.and_then(|row| row.wrench(&sensor)).ok_or("no wrench")?;
/// assert_eq!(wrench.force().z, -1.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Recorded {
    /// CSV with units in the names of its columns, or MCAP.
    pub path: PathBuf,
    /// The sensor, by the prefix of its columns; the scene's, or the only one, if `None`.
    pub sensor: Option<String>,
    /// Of an MCAP file, these topics alone; all, if there are none.
    pub topics: Vec<String>,
    /// Temperature of the whole recording \[°C\], for a calibration that drifts with it.
    pub celsius: Option<f64>,
    /// What comes earlier behind the first row \[s\] is left out; a rest at the start is taken as ever.
    pub start: Option<f64>,
    /// What comes later behind the first row \[s\] is left out.
    pub end: Option<f64>,
}

impl Recorded {
    fn arguments(&self, scene: &Path) -> AnalyzeArguments {
        AnalyzeArguments {
            recordings: vec![self.path.clone()],
            scene: scene.to_owned(),
            calibration: None,
            payload: None,
            celsius: self.celsius,
            sensor: self.sensor.clone(),
            topics: self.topics.clone(),
            span: Span { start: self.start, end: self.end },
            output: PathBuf::new(),
            report: PathBuf::new(),
            no_report: false,
            json: false,
            overwrite: Overwrite::default(),
        }
    }

    /// Opens it, to be read row by row. What is to be known of a file that was converted goes to `notes`.
    ///
    /// # Errors
    /// [`Failure`], which names the file.
    pub fn rows(
        &self,
        options: ReaderOptions,
        notes: &mut Vec<String>,
    ) -> Result<RecordingReader<Box<dyn Read + Send>>, Failure> {
        Ok(Opened::open(&self.path, &self.topics, options, notes)?.rows)
    }
}

/// What one row of a recording gives.
///
/// ```
/// use fingertip_cli::library::{Recorded, Sample, analyze};
/// # use fingertip_scene::Scene;
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("push.csv");
/// # std::fs::write(&path, "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,-1,0,0,0\n0.001,0,0,1,0,0,0\n")?;
/// # let scene = Scene::from_text(r#"
/// #     version = 2
/// #     [input]
/// #     convention = "on_fingertip"
/// #     [surface]
/// #     shape = "plane"
/// #     normal = [0.0, 0.0, 1.0]
/// #     point_m = [0.0, 0.0, 0.01]
/// # "#)?;
///
/// // A plane of which the outward normal is +z, pushed with −1 N and then pulled with 1 N along z.
/// let recorded = Recorded { path, ..Recorded::default() };
/// let (mut words, mut height) = (Vec::new(), f64::NAN);
/// analyze(&scene, "pad.toml".as_ref(), &recorded, &mut |_, sample| {
///     words.push(sample.status());
///     if let Sample::Felt(felt) = sample
///         && let Some(contact) = felt.contact()
///     {
///         height = contact.point.z;
///     }
/// })?;
/// assert_eq!(words, ["contact", "only_pulling"]);
/// assert!((height - 0.01).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Sample<'a> {
    /// What its wrench says.
    Felt(&'a Felt<f64>),
    /// No wrench; why, by the word that the command writes, such as `rest` or `unusable_row`.
    Without(&'static str),
}

impl Sample<'_> {
    /// `contact`, or why there is none, by the word that the command writes.
    #[must_use]
    pub fn status(&self) -> &'static str {
        match self {
            Self::Felt(felt) => Status::of(&felt.touch.resolution).word(),
            Self::Without(word) => word,
        }
    }
}

/// What a recording showed.
///
/// ```
/// use fingertip_cli::library::{Recorded, analyze};
/// # use fingertip_scene::Scene;
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("push.csv");
/// # std::fs::write(&path, "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,-1,0,0,0\n0.001,0,0,,0,0,0\n")?;
/// # let scene = Scene::from_text(r#"
/// #     version = 2
/// #     [input]
/// #     convention = "on_fingertip"
/// #     [surface]
/// #     shape = "plane"
/// #     normal = [0.0, 0.0, 1.0]
/// #     point_m = [0.0, 0.0, 0.01]
/// # "#)?;
///
/// // Two rows; of the second a cell is empty.
/// let recorded = Recorded { path, ..Recorded::default() };
/// let analysis = analyze(&scene, "pad.toml".as_ref(), &recorded, &mut |_, _| {})?;
/// assert_eq!((analysis.quality.rows, analysis.quality.empty_cells.count()), (2, 1));
/// assert!(analysis.summary.contains("contact") && analysis.html.starts_with("<!doctype html>"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Name of the sensor; empty if the recording gives none.
    pub sensor: String,
    /// What should be minded.
    pub notes: Vec<String>,
    /// The faults of the recording.
    pub quality: Quality,
    /// The result in sentences and tables, as the command prints it.
    pub summary: String,
    /// The page that the command writes.
    pub html: String,
}

/// Hands samples on to a function.
struct Each<'a>(&'a mut dyn FnMut(f64, Sample<'_>));

impl Sink for Each<'_> {
    fn sample(&mut self, time: f64, felt: &Felt<f64>, _: Option<&Fused>) -> Result<(), CliError> {
        (self.0)(time, Sample::Felt(felt));
        Ok(())
    }

    fn without_wrench(&mut self, time: f64, status: Status) -> Result<(), CliError> {
        (self.0)(time, Sample::Without(status.word()));
        Ok(())
    }
}

/// Contacts from a recording, as `fingertip analyze` finds them: units, signs, rest, calibration, payload and gaps
/// included. `each` takes the time of a row \[s\], NaN where it has none, and what it gives, for every row in its order;
/// `scene_file` is what messages call the scene.
///
/// # Errors
/// [`Failure`], in the sentence that the command says.
pub fn analyze(
    scene: &Scene,
    scene_file: &Path,
    recorded: &Recorded,
    each: &mut dyn FnMut(f64, Sample<'_>),
) -> Result<Analysis, Failure> {
    let arguments = recorded.arguments(scene_file);
    let Analysed { source, observations, quality, findings, .. } =
        analysed(scene, &recorded.path, &arguments, || Ok(Each(each)))?;
    let given = Given { calibration: None, payload: None, calibrated: source.is_calibrated() };
    Ok(Analysis {
        sensor: source.sensor().to_owned(),
        notes: source.notes().to_vec(),
        quality,
        summary: findings.to_string(),
        html: report::of_recording(&findings, &observations, scene, &given),
    })
}

/// The names of the fingers of a hand scene, in its order, once it is read and checked as `fingertip analyze` does, with
/// the scenes of the fingers. `file` is what messages call it; its folder is where the scenes are looked for.
///
/// # Errors
/// [`Failure`], in the sentence that the command says.
pub fn fingers(text: &str, file: &Path) -> Result<Vec<String>, Failure> {
    Ok(super::hand::fingers(text, file)?)
}
