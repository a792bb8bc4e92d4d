//! `fingertip analyze`: a recording and a scene to contacts, a summary and a report.

pub(crate) mod args;
mod contacts;
mod files;
mod payload;
mod progress;
mod recorded;
mod source;
mod volts;
mod wrenches;

use std::path::Path;

use fingertip::surfaces::ActiveSurface;
use fingertip::{Fingertip, Step};
use fingertip_recordings::Quality;

use crate::error::CliError;
use crate::observe::{Observations, Status};
use crate::output;
use crate::report;
use crate::scene::Scene;
use crate::shape::Shape;
use crate::summary::{self, Run};
use args::AnalyzeArguments;
use contacts::ContactWriter;
use source::{Reading, Source};

pub(crate) fn run(arguments: &AnalyzeArguments) -> Result<(), CliError> {
    let scene = Scene::load(&arguments.scene)?;
    let recording = arguments.recording.as_path();
    files::guard(arguments)?;
    let mut notes = Vec::new();
    let files::Opened { rows: mut reader, bar } = files::open(recording, &mut notes)?;
    let mut source = Source::new(&mut reader, &scene, arguments, notes)?;
    let mut contacts = ContactWriter::create(&arguments.output)?;
    let mut pass = Pass { scene: &scene, reader: &mut reader, source: &mut source, contacts: &mut contacts };
    // The one place where a shape is chosen: the loop inside is compiled for each.
    let observations = match scene.shape {
        Shape::Plane(plane) => pass.over(plane),
        Shape::Sphere(sphere) => pass.over(sphere),
        Shape::Cylinder(cylinder) => pass.over(cylinder),
        Shape::Other(ref other) => pass.over(other.as_ref().clone()),
    }?;
    bar.finish_and_clear();
    contacts.finish()?;

    let quality: Quality = *reader.quality();
    if observations.rows() == 0 {
        return Err(CliError::NoRows { path: recording.to_owned() });
    }
    let findings = summary::of_recording(&Run {
        recording,
        scene: &scene,
        observations: &observations,
        quality: &quality,
        notes: source.notes(),
        sensor: source.sensor(),
    });
    let report = (!arguments.no_report).then_some(arguments.report.as_path());
    if let Some(path) = report {
        output::write("report", path, &report::of_recording(&findings, &observations, &scene))?;
    }
    let to_stderr = arguments.output == Path::new("-");
    files::say(&findings, to_stderr, &[Some(arguments.output.as_path()), report])
}

/// Everything that one pass over the recording needs.
struct Pass<'a> {
    scene: &'a Scene,
    reader: &'a mut files::Rows,
    source: &'a mut Source,
    contacts: &'a mut ContactWriter,
}

impl Pass<'_> {
    fn over<S: ActiveSurface<f64>>(&mut self, surface: S) -> Result<Observations, CliError> {
        let mut fingertip = Fingertip::builder()
            .payload(self.source.payload())
            .contact(surface, self.scene.model)
            .friction_stage(self.scene.friction)
            .slip_stage(self.scene.slip)
            .build();
        let mut observations = Observations::new(self.scene.projection);
        let mut last_point = None;
        while let Some(row) = self.reader.next_row()? {
            let (time, time_step) = self.source.clock(&row);
            if row.marks().gap {
                fingertip.detector_mut().reset();
                last_point = None;
            }
            match self.source.read(&row, time)? {
                Reading::Wrench(wrench, motion) => {
                    let step = Step::of(time_step).with_last(last_point).with_motion(motion);
                    let touch = fingertip.sense_wrench(wrench, step);
                    last_point = touch.point();
                    observations.add(time, &touch);
                    self.contacts.write(time, &touch)?;
                }
                Reading::Without(status) => {
                    observations.add_without_wrench(time, status);
                    self.contacts.write_without_wrench(time, status)?;
                }
            }
        }
        if let Some(rest) = self.source.unfinished_rest() {
            return Err(CliError::RestTooLong {
                path: self.reader.file().into(),
                rest,
                rows: observations.count_of(Status::Rest),
            });
        }
        Ok(observations)
    }
}
