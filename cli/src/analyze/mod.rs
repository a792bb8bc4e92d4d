//! `fingertip analyze`: a recording and a scene to contacts, a summary and a report.

mod ahead;
pub(crate) mod args;
mod array;
mod cells;
pub mod columns;
mod contacts;
mod digits;
mod files;
mod hand;
mod json;
pub mod library;
pub(crate) mod object;
mod payload;
mod pose;
mod recorded;
mod sink;
mod source;
mod volts;
mod wrenches;

use core::ops::ControlFlow;
use std::path::Path;

use fingertip_recordings::Quality;
use fingertip_scene::{Pipeline, Scene};

use crate::error::CliError;
use crate::health::{WatchedRows, seen};
use crate::observe::{Observations, Status};
use crate::opened::{Opened, Rows};
use crate::report::{self, used::Given};
use crate::scene;
use crate::several;
use crate::span::{Place, Window};
use crate::summary::{self, Findings, Run};
use crate::table::number;
use args::AnalyzeArguments;
use array::{Array, Fused};
use contacts::ContactWriter;
use files::Files;
use sink::Sink;
use source::{Reading, Source};

pub(crate) fn run(arguments: &AnalyzeArguments) -> Result<(), CliError> {
    if let Some(text) = hand::text_of(&arguments.scene) {
        return hand::run(arguments, &text);
    }
    let all = Files::of(arguments, &[])?;
    let scene = scene::load(&arguments.scene)?;
    files::spare(&all, &scene)?;
    let scene = scene::with(scene, arguments.calibration.as_deref(), arguments.payload.as_deref())?;
    several::each(&arguments.recordings, &all, |recording, files| one(recording, &scene, arguments, files))
}

/// One of the recordings.
fn one(recording: &Path, scene: &Scene, arguments: &AnalyzeArguments, files: &Files) -> Result<(), CliError> {
    let Files { output, report, outputs } = files;
    let create = || {
        let places = scene.array_places().unwrap_or(0);
        ContactWriter::create(output, outputs, scene.tells(), places)
    };
    let Analysed { sink: contacts, source, observations, quality, findings } =
        analysed(scene, recording, arguments, create)?;
    contacts.finish()?;
    if let Some(path) = report {
        let given = Given {
            calibration: arguments.calibration.as_deref(),
            payload: arguments.payload.as_deref(),
            calibrated: source.is_calibrated(),
        };
        outputs.write("report", path, &report::of_recording(&findings, &observations, scene, &given))?;
    }
    if arguments.json {
        let told =
            json::Told { recording, scene, source: &source, observations: &observations, quality: &quality };
        return outputs.print(&told.line(&outputs.names()));
    }
    outputs.say(&findings.to_string(), &[])
}

/// A recording that was read to its end.
struct Analysed<S> {
    sink: S,
    source: Source,
    observations: Observations,
    quality: Quality,
    findings: Findings,
}

/// Reads a recording to its end. The sink is made when the recording is known to be one of this scene.
fn analysed<S: Sink>(
    scene: &Scene,
    recording: &Path,
    arguments: &AnalyzeArguments,
    sink: impl FnOnce() -> Result<S, CliError>,
) -> Result<Analysed<S>, CliError> {
    arguments.span.check()?;
    let mut notes = Vec::from_iter(arguments.span.note());
    let opened = Opened::open(recording, &arguments.topics, files::of(scene), &mut notes)?;
    let Opened { rows: mut reader, bar, .. } = opened;
    let mut source = Source::new(&mut reader, scene, recording, arguments, notes)?;
    let array = scene.array_places().map(|places| Array::new(places, &mut reader)).transpose()?;
    let mut sink = sink()?;
    let mut window = Window::new(arguments.span);
    let is_drawn = !arguments.no_report;
    let pass = Pass {
        scene,
        reader: &mut reader,
        source: &mut source,
        array,
        window: &mut window,
        is_drawn,
        sink: &mut sink,
    };
    let observations = pass.run()?;
    bar.finish_and_clear();
    let quality = *reader.quality();
    if observations.rows() == 0 {
        return Err(window.nothing_of(recording));
    }
    let findings = summary::of_recording(&Run {
        recording,
        scene,
        observations: &observations,
        quality: &quality,
        notes: source.notes(),
        sensor: source.sensor(),
    });
    Ok(Analysed { sink, source, observations, quality, findings })
}

/// Tells the pipeline how noisy the rest was.
#[cold]
fn know_noise(pipeline: &mut Pipeline<f64>, source: &mut Source, scene: &Scene) -> Result<(), CliError> {
    let unknown = || CliError::NoRest { rest: scene.rest().unwrap_or(0.0) };
    let noise = source.noise().ok_or_else(unknown)?;
    pipeline.know_noise(&noise).map_err(|_| unknown())?;
    let [force, torque] = [noise.fixed_rows::<3>(0).amax(), noise.fixed_rows::<3>(3).amax()].map(number);
    source.note(format!("the noisiest components of the rest have deviations of {force} N and {torque} N·m"));
    Ok(())
}

/// Everything that one pass over the recording needs.
struct Pass<'a, S> {
    scene: &'a Scene,
    reader: &'a mut Rows,
    source: &'a mut Source,
    array: Option<Array>,
    window: &'a mut Window,
    /// Whether a report is made of it.
    is_drawn: bool,
    sink: &'a mut S,
}

impl<S: Sink> Pass<'_, S> {
    fn run(self) -> Result<Observations, CliError> {
        let mut pipeline = self.scene.pipeline();
        let mut observations = Observations::of(*self.scene.projection(), self.is_drawn);
        let (sensor, calibrated) = (self.source.sensor(), self.source.is_calibrated());
        // The health of the sensor, as far as that costs little.
        let watched = WatchedRows::brief(self.reader.layout(), sensor, calibrated);
        let mut watched =
            watched.map_err(|problem| CliError::Recording(self.reader.header_error(problem)))?;
        watched.limit(sensor, self.scene.calibration().and_then(|file| file.range));
        let Self { scene, reader, source, mut array, window, sink, .. } = self;
        let mut fused = Fused::default();
        let health = ahead::read(reader, watched, |block| {
            for row in block.rows() {
                let (time, time_step) = source.clock(&row);
                if row.marks().gap {
                    pipeline.start_anew();
                }
                match window.place(time) {
                    Place::Behind => return Ok(ControlFlow::Break(())),
                    Place::Before => {
                        // It may be part of the rest.
                        let _ = source.read(&row, time)?;
                        continue;
                    }
                    Place::Within => {}
                }
                match source.read(&row, time)? {
                    Reading::Wrench(wrench) => {
                        if pipeline.awaits_noise() {
                            know_noise(&mut pipeline, source, scene)?;
                        }
                        let felt = pipeline.sense(wrench, time_step);
                        observations.add(time, &felt.touch);
                        observations.instants.add(time, felt);
                        if let Some(array) = &mut array {
                            array.fuse(&row, &pipeline, &mut fused);
                        }
                        sink.sample(time, pipeline.felt(), array.is_some().then_some(&fused))?;
                    }
                    Reading::Without(status) => {
                        observations.add_without_wrench(time, status);
                        sink.without_wrench(time, status)?;
                    }
                }
            }
            Ok(ControlFlow::Continue(()))
        })?;
        source.has_rested(window, Path::new(reader.file()), observations.count_of(Status::Rest))?;
        seen(&health).into_iter().for_each(|fault| source.note(fault));
        if let Some(note) = array.as_ref().and_then(Array::note) {
            source.note(note);
        }
        Ok(observations)
    }
}
