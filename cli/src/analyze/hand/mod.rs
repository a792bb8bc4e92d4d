//! `fingertip analyze` with a hand scene: several sensors of one recording, which hold one object together.

mod beside;
mod file;
mod grasped;
mod limits;
mod page;
mod table;

use std::path::{Path, PathBuf};

use fingertip::hand::{FingerLimits, Hand, LeastGrip};
use fingertip::wrench::{RigidTransform, Sensor};
use fingertip_recordings::Row;
use fingertip_scene::Pipeline;

use super::args::AnalyzeArguments;
use super::files::{self, Files};
use super::know_noise;
use super::pose::PoseColumns;
use super::source::{Reading, Source};
use crate::error::CliError;
use crate::observe::Status;
use crate::opened::{Opened, Rows};
use crate::report;
use crate::several;
use crate::span::{Place, Window};
use beside::Asked;
use file::{FingerScene, HandScene, MOST};
use grasped::{Fingers, Grasped};
use limits::{JacobianColumns, ROWS};
use page::Seen;
use table::GraspWriter;

pub(super) use file::text_of;

/// The names of the fingers of a hand scene, of which this is the text.
pub(super) fn fingers(text: &str, path: &Path) -> Result<Vec<String>, CliError> {
    Ok(file::parse(text, path)?.fingers.into_iter().map(|finger| finger.name).collect())
}

/// With the text of the hand scene.
pub(super) fn run(arguments: &AnalyzeArguments, text: &str) -> Result<(), CliError> {
    refuse(arguments)?;
    arguments.span.check()?;
    let scene = file::parse(text, &arguments.scene)?;
    let fingers: Vec<&PathBuf> = scene.fingers.iter().map(|finger| &finger.path).collect();
    let all = Files::of(arguments, &fingers)?;
    scene.fingers.iter().try_for_each(|finger| files::spare(&all, &finger.scene))?;
    several::each(&arguments.recordings, &all, |recording, files| one(recording, &scene, arguments, files))
}

/// One of the recordings.
fn one(
    recording: &Path,
    scene: &HandScene,
    arguments: &AnalyzeArguments,
    files: &Files,
) -> Result<(), CliError> {
    let Files { output, report, outputs } = files;
    let mut notes = Vec::from_iter(arguments.span.note());
    let first = scene.fingers.first().map(|finger| files::of(&finger.scene)).unwrap_or_default();
    let Opened { rows: mut reader, bar, .. } = Opened::open(recording, &arguments.topics, first, &mut notes)?;
    let mut tips = Vec::with_capacity(scene.fingers.len());
    for finger in &scene.fingers {
        tips.push(Tip::new(finger, recording, arguments, &mut reader)?);
    }
    let Some(asked) = Asked::new(&scene.beside, &mut reader) else {
        let names = scene.beside.gravity_names().join(", ");
        return Err(lacks(
            &reader,
            &format!(
                "{names}, which are gravity in the hand; add them, or give `gravity_m_per_s2` in the place of `gravity_columns`"
            ),
        ));
    };
    let mut writer = GraspWriter::create(output, outputs, scene)?;
    let mut seen = Seen::new(scene);
    let mut window = Window::new(arguments.span);
    read(scene, &mut tips, asked, &mut reader, &mut window, &mut writer, &mut seen)?;
    bar.finish_and_clear();
    for (tip, finger) in tips.iter().zip(&scene.fingers) {
        tip.source.has_rested(&window, recording, seen.rows())?;
        notes.extend(tip.source.notes().iter().map(|note| format!("finger {}: {note}", finger.name)));
    }
    if seen.rows() == 0 {
        return Err(window.nothing_of(recording));
    }
    writer.finish()?;
    let findings = seen.findings(recording, notes);
    if let Some(path) = report {
        let page = report::of_design(&findings, seen.figures());
        outputs.write("report", path, &page)?;
    }
    outputs.say(&findings.to_string(), &[])
}

/// What a hand scene has no place for on the command line.
fn refuse(arguments: &AnalyzeArguments) -> Result<(), CliError> {
    let of_finger = "is said for each finger by a hand scene: put it into the scene of the finger";
    let path = |path: &PathBuf| path.display().to_string();
    let given = [
        (
            "--sensor",
            arguments.sensor.clone(),
            "is said for each finger by a hand scene: set `sensor` of [[finger]]",
        ),
        ("--calibration", arguments.calibration.as_ref().map(path), of_finger),
        ("--payload", arguments.payload.as_ref().map(path), of_finger),
        (
            "--json",
            arguments.json.then(String::new),
            "is not there for a hand scene yet: read the table that --output names",
        ),
    ];
    match given.into_iter().find_map(|(option, value, problem)| Some((option, value?, problem))) {
        Some((option, value, problem)) => Err(CliError::option(option, value, problem)),
        None => Ok(()),
    }
}

/// A fingertip: from the rows to what it feels, and where it is.
struct Tip {
    source: Source,
    pipeline: Pipeline<f64>,
    /// The columns of its pose, where it is not fixed.
    pose: Option<PoseColumns>,
    /// The columns of its Jacobian; none where it is fixed.
    jacobian: JacobianColumns,
}

impl Tip {
    fn new(
        finger: &FingerScene,
        recording: &Path,
        arguments: &AnalyzeArguments,
        reader: &mut Rows,
    ) -> Result<Self, CliError> {
        let sensor = finger.sensor.clone().or_else(|| finger.scene.sensor_name().map(str::to_owned));
        let of_finger = AnalyzeArguments { sensor, scene: finger.path.clone(), ..arguments.clone() };
        let source = Source::new(reader, &finger.scene, recording, &of_finger, Vec::new())?;
        let pose = match &finger.pose_columns {
            Some(prefix) => Some(pose_columns(prefix, finger, reader)?),
            None => None,
        };
        let Some(jacobian) = finger.limits.columns(reader) else {
            let (names, name) = (finger.limits.names().join(", "), &finger.name);
            return Err(lacks(
                reader,
                &format!(
                    "{names}, which are the Jacobian of the finger {name:?}; add them, or give a fixed `jacobian` in the place of \
                 `jacobian_columns`"
                ),
            ));
        };
        Ok(Self { source, pipeline: finger.scene.pipeline(), pose, jacobian })
    }

    /// Its pose in a row; `None` if a number is missing or the quaternion is none.
    fn pose(&self, finger: &FingerScene, row: &Row<'_>) -> Option<RigidTransform<f64, Hand, Sensor>> {
        let Some(columns) = &self.pose else { return Some(finger.pose) };
        columns.read(row)
    }
}

fn pose_columns(prefix: &str, finger: &FingerScene, reader: &mut Rows) -> Result<PoseColumns, CliError> {
    PoseColumns::of(prefix, reader).ok_or_else(|| {
        let what = format!(
            "{}, which tell where the sensor of the finger {:?} is in the hand; add them, or give it a fixed pose by \
             `translation_m` and `rotation_deg` in the place of `pose_columns`",
            PoseColumns::names(prefix).join(", "),
            finger.name
        );
        lacks(reader, &what)
    })
}

/// That a recording lacks columns.
fn lacks(reader: &Rows, what: &str) -> CliError {
    CliError::Calibrate { path: reader.file().into(), message: format!("has no columns {what}") }
}

/// Reads a recording to its end.
fn read(
    scene: &HandScene,
    tips: &mut [Tip],
    mut asked: Asked<'_>,
    reader: &mut Rows,
    window: &mut Window,
    writer: &mut GraspWriter,
    seen: &mut Seen,
) -> Result<(), CliError> {
    let mut limits = [FingerLimits::<f64, ROWS>::none(); MOST];
    let mut program = LeastGrip::new();
    let mut statuses = vec![Status::UnusableRow; tips.len()];
    while let Some(row) = reader.next_row()? {
        let mut time = f64::NAN;
        let mut fingers = Fingers::none();
        let mut place = Place::Within;
        // Of all fingers, or of none: a load that lacks a finger's is no load.
        let mut whole = true;
        for (index, ((tip, finger), status)) in
            tips.iter_mut().zip(&scene.fingers).zip(&mut statuses).enumerate()
        {
            let (now, time_step) = tip.source.clock(&row);
            if index == 0 {
                time = now;
                place = window.place(now);
            }
            if row.marks().gap {
                tip.pipeline.start_anew();
            }
            let pose = tip.pose(finger, &row);
            match (finger.limits.at(&tip.jacobian, &row), limits.get_mut(index)) {
                (Some(now), Some(limits)) => *limits = now,
                // As one without a pose.
                _ => whole = false,
            }
            match (tip.source.read(&row, now)?, pose) {
                (Reading::Wrench(wrench), Some(pose)) if place == Place::Within => {
                    if tip.pipeline.awaits_noise() {
                        know_noise(&mut tip.pipeline, &mut tip.source, &finger.scene)?;
                    }
                    let felt = tip.pipeline.sense(wrench, time_step);
                    *status = Status::of(&felt.touch.resolution);
                    fingers.add(index, finger, scene.sensors_in, &pose, felt);
                }
                (Reading::Without(why), _) => (*status, whole) = (why, false),
                _ => (*status, whole) = (Status::UnusableRow, false),
            }
        }
        match place {
            Place::Before => continue,
            Place::Behind => break,
            Place::Within => {}
        }
        let beside = (&mut asked, &row, time);
        let grasped = whole.then(|| Grasped::of(fingers, &limits, scene, &mut program, beside));
        writer.write(time, &statuses, grasped.as_ref())?;
        seen.add(time, grasped.as_ref(), &scene.beside);
    }
    Ok(())
}
