//! `fingertip object`: an object by the touches of a fingertip whose pose is known.

mod found;
mod touched;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use fingertip::wrench::{Frame, RigidTransform, Sensor};
use fingertip_calibration::object::{ObjectPoint, PoseNoise, to_ply};
use fingertip_scene::Scene;

use super::args::AnalyzeArguments;
use super::files;
use super::know_noise;
use super::pose::PoseColumns;
use super::source::{Reading, Source};
use crate::calibrate::files::bad;
use crate::error::CliError;
use crate::opened::Opened;
use crate::output::{Outputs, Overwrite};
use crate::scene;
use crate::span::{Place, Span, Window};
use touched::Touched;

#[derive(Clone, Debug, Args)]
#[command(
    after_help = "The recordings have the load on the sensor as those of `analyze`, and where the sensor is in the frame \
    of the object: pose_x_m, pose_y_m, pose_z_m, and the quaternion pose_qw … pose_qz, which turns the sensor's axes into the \
    object's. Of several recordings all touches are of one object."
)]
pub(crate) struct ObjectArguments {
    /// Recordings: CSV with units in the column names, or MCAP (.mcap)
    #[arg(value_name = "FILE", required = true)]
    recordings: Vec<PathBuf>,
    /// The scene of the fingertip; what is fitted wants its [uncertainty], or its [tracking]
    #[arg(long, value_name = "SCENE.toml")]
    scene: PathBuf,
    /// The shape to find
    #[arg(long, value_enum, value_name = "SHAPE")]
    fit: Option<ObjectShape>,
    /// How far off the poses are: standard deviations of the position along each axis, and of the turn about each
    #[arg(long, value_delimiter = ',', value_name = "M,RAD", default_value = "0.0002,0.002")]
    pose_noise: Vec<f64>,
    /// What stands before x_m … qz in the names of the columns of the pose
    #[arg(long, value_name = "PREFIX", default_value = "pose")]
    pose: String,
    /// Samples of one contact between which the fingertip moves no farther than this are one touch, their mean
    #[arg(long, value_name = "METRES", default_value_t = 5e-4)]
    apart: f64,
    /// The calibration, for recordings of volts; in the place of [sensor] of the scene
    #[arg(long, value_name = "CAL")]
    calibration: Option<PathBuf>,
    /// What hangs on the sensor, as `calibrate --gravity` wrote it; in the place of [payload] of the scene
    #[arg(long, value_name = "PAYLOAD.toml")]
    payload: Option<PathBuf>,
    /// Temperature of the recordings, for a calibration that drifts with it
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true)]
    celsius: Option<f64>,
    /// Which sensor of the recordings: the prefix of its columns
    #[arg(long, value_name = "PREFIX")]
    sensor: Option<String>,
    /// Of an MCAP file, this topic alone; several times for several
    #[arg(long = "topic", value_name = "TOPIC")]
    topics: Vec<String>,
    #[command(flatten)]
    span: Span,
    /// Where to write the points, with normals (PLY)
    #[arg(short, long, value_name = "POINTS.ply")]
    output: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

/// The frame of the object.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Object;

impl Frame for Object {
    const NAME: &'static str = "object";
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ObjectShape {
    /// A flat side
    Plane,
    /// A ball, or a bowl from within
    Sphere,
    /// A rod, or a bore from within
    Cylinder,
}

impl ObjectArguments {
    /// What it has in common with `analyze`.
    fn of_analyze(&self) -> AnalyzeArguments {
        AnalyzeArguments {
            recordings: self.recordings.clone(),
            scene: self.scene.clone(),
            calibration: self.calibration.clone(),
            payload: self.payload.clone(),
            celsius: self.celsius,
            sensor: self.sensor.clone(),
            topics: self.topics.clone(),
            span: self.span,
            output: self.output.clone().unwrap_or_default(),
            report: PathBuf::new(),
            no_report: true,
            json: false,
            overwrite: self.overwrite,
        }
    }

    fn noise(&self) -> Result<PoseNoise, CliError> {
        let noise = match self.pose_noise[..] {
            [position, turn] => PoseNoise::new(position, turn).ok(),
            _ => None,
        };
        let given = || self.pose_noise.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        noise.ok_or_else(|| {
            CliError::option("--pose-noise", given(), "must be two numbers above zero: metres, radians")
        })
    }
}

pub(crate) fn run(arguments: &ObjectArguments) -> Result<(), CliError> {
    arguments.span.check()?;
    let noise = arguments.noise()?;
    if !(arguments.apart >= 0.0 && arguments.apart.is_finite()) {
        return Err(CliError::option("--apart", arguments.apart, "must be a number of metres, zero or more"));
    }
    let options = [Some(&arguments.scene), arguments.calibration.as_ref(), arguments.payload.as_ref()];
    let inputs = arguments.recordings.iter().chain(options.into_iter().flatten());
    let outputs = Outputs::guard(arguments.overwrite, "output", inputs, &arguments.output)?;
    let scene = scene::load(&arguments.scene)?;
    outputs.spare(scene.files())?;
    let scene = scene::with(scene, arguments.calibration.as_deref(), arguments.payload.as_deref())?;
    let tells = scene.tells();
    if arguments.fit.is_some() && !(tells.spread || tells.tracked) {
        let problem = "needs how sure a contact is: give the scene an [uncertainty]";
        return Err(CliError::option("--fit", arguments.scene.display(), problem));
    }
    let mut touched = Touched::new(arguments.apart);
    let mut notes = Vec::new();
    for recording in &arguments.recordings {
        touch(recording, &scene, arguments, &mut touched, &mut notes)?;
    }
    let (samples, touches) = touched.finish();
    let first = arguments.recordings.first().map(PathBuf::as_path).unwrap_or_else(|| Path::new(""));
    if touches.is_empty() {
        return Err(bad(first, &"nothing was touched where the pose was known"));
    }
    let mut text = found::counted(samples, touches.len(), arguments.apart);
    if let Some(shape) = arguments.fit {
        let points: Vec<ObjectPoint> = touches;
        let lines = found::fitted(shape, &points, noise).map_err(|error| bad(first, &error))?;
        text.push_str(&lines);
        write(arguments, &outputs, &points)?;
    } else {
        write(arguments, &outputs, &touches)?;
    }
    outputs.say(&text, &notes)
}

fn write(arguments: &ObjectArguments, outputs: &Outputs, points: &[ObjectPoint]) -> Result<(), CliError> {
    arguments.output.as_ref().map_or(Ok(()), |path| outputs.write("points", path, &to_ply(points)))
}

/// Takes the touches of a recording.
fn touch(
    recording: &Path,
    scene: &Scene,
    arguments: &ObjectArguments,
    touched: &mut Touched,
    notes: &mut Vec<String>,
) -> Result<(), CliError> {
    let mut told = Vec::from_iter(arguments.span.note());
    let opened = Opened::open(recording, &arguments.topics, files::of(scene), &mut told)?;
    let Opened { rows: mut reader, bar, .. } = opened;
    let mut source = Source::new(&mut reader, scene, recording, &arguments.of_analyze(), told)?;
    let poses = PoseColumns::of(&arguments.pose, &mut reader).ok_or_else(|| {
        let names = PoseColumns::names(&arguments.pose).join(", ");
        bad(
            recording,
            &format!("has no columns {names}, which tell where the sensor is in the frame of the object"),
        )
    })?;
    let mut pipeline = scene.pipeline();
    let mut window = Window::new(arguments.span);
    while let Some(row) = reader.next_row()? {
        let (time, time_step) = source.clock(&row);
        if row.marks().gap {
            pipeline.start_anew();
        }
        let place = window.place(time);
        if place == Place::Behind {
            break;
        }
        let Reading::Wrench(wrench) = source.read(&row, time)? else {
            touched.release();
            continue;
        };
        if place == Place::Before {
            continue;
        }
        if pipeline.awaits_noise() {
            know_noise(&mut pipeline, &mut source, scene)?;
        }
        pipeline.sense(wrench, time_step);
        let pose: Option<RigidTransform<f64, Object, Sensor>> = poses.read(&row);
        touched.sample(&pipeline, pose.as_ref());
    }
    touched.release();
    bar.finish_and_clear();
    source.has_rested(&window, recording, source.rows())?;
    notes.extend(source.notes().iter().cloned());
    Ok(())
}
