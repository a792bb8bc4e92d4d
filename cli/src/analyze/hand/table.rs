//! The table of a grasp: one row per sample.

use std::io::Write;
use std::path::{Path, PathBuf};

use fingertip::hand::Reach;

use super::super::cells::Cells;
use super::beside::Answers;
use super::file::{HandScene, MOST};
use super::grasped::Grasped;
use crate::error::CliError;
use crate::observe::Status;
use crate::output::{Outputs, Whole};

/// The columns of each finger, behind its name.
const OF_FINGER: [&str; 7] = ["status", "x_m", "y_m", "z_m", "normal_N", "margin_N", "least_normal_N"];

/// The columns of the whole, behind those of the fingers.
const OF_GRASP: [&str; 11] = [
    "load_fx_N",
    "load_fy_N",
    "load_fz_N",
    "load_tx_Nm",
    "load_ty_Nm",
    "load_tz_Nm",
    "grip_N",
    "squeeze_N",
    "margin_N",
    "least_grip_N",
    "held",
];

/// The columns of what else touches the object: its wrench, and the line of its force.
const OF_OTHER: [&str; 13] = [
    "other_fx_N",
    "other_fy_N",
    "other_fz_N",
    "other_tx_Nm",
    "other_ty_Nm",
    "other_tz_Nm",
    "other_x_m",
    "other_y_m",
    "other_z_m",
    "other_dx",
    "other_dy",
    "other_dz",
    "other_pitch_m",
];

/// The columns of the quality.
const OF_QUALITY: [&str; 9] = [
    "closure",
    "ball_N",
    "ball_found_N",
    "weakest_fx_N",
    "weakest_fy_N",
    "weakest_fz_N",
    "weakest_tx_Nm",
    "weakest_ty_Nm",
    "weakest_tz_Nm",
];

/// Writes one row per sample; a cell without a value is empty, numbers have eight significant digits.
pub(super) struct GraspWriter {
    out: Whole,
    path: PathBuf,
    cells: Cells,
    /// How many columns there are of what else touches, of disturbances, and of the quality.
    beside: [usize; 3],
}

impl GraspWriter {
    pub(super) fn create(path: &Path, outputs: &Outputs, scene: &HandScene) -> Result<Self, CliError> {
        let out = outputs.create("grasp", path)?;
        let mut names = vec!["t_s".to_owned()];
        for finger in &scene.fingers {
            names.extend(OF_FINGER.iter().map(|column| format!("{}_{column}", finger.name)));
        }
        names.extend(OF_GRASP.iter().map(|column| (*column).to_owned()));
        let beside = &scene.beside;
        let other = if beside.knows_object() { &OF_OTHER[..] } else { &[] };
        let quality = if beside.asks_quality() { &OF_QUALITY[..] } else { &[] };
        names.extend(other.iter().map(|column| (*column).to_owned()));
        names.extend(beside.disturbances.iter().map(|(name, _)| format!("reach_{name}")));
        names.extend(quality.iter().map(|column| (*column).to_owned()));
        let beside = [other.len(), beside.disturbances.len(), quality.len()];
        let mut writer = Self { out, path: path.to_owned(), cells: Cells::default(), beside };
        writer.cells.put(names.join(",").as_bytes());
        writer.end_line()?;
        Ok(writer)
    }

    pub(super) fn write(
        &mut self,
        time: f64,
        statuses: &[Status],
        grasped: Option<&Grasped>,
    ) -> Result<(), CliError> {
        self.cells.put_time(time);
        for (index, status) in statuses.iter().enumerate().take(MOST) {
            self.word(status.word());
            let touch = grasped.and_then(|all| {
                let contact = (*all.contacts.get(index)?)?;
                let least = all.least.and_then(|(_, each)| each.get(index).copied());
                Some((contact.place(), all.forces.get(index)?.normal, *all.margins.get(index)?, least))
            });
            match touch {
                Some((place, normal, margin, least)) => {
                    place.iter().for_each(|x| self.number(Some(*x)));
                    [Some(normal), margin, least].into_iter().for_each(|x| self.number(x));
                }
                None => (1..OF_FINGER.len()).for_each(|_| self.number(None)),
            }
        }
        match grasped {
            Some(all) => {
                all.load.components().iter().for_each(|x| self.number(Some(*x)));
                let touches = all.touching() > 0;
                self.number(touches.then_some(all.grip));
                self.number(touches.then_some(all.squeeze));
                self.number(all.least_margin());
                self.number(all.least.map(|(sum, _)| sum));
                self.word(all.held);
            }
            None => OF_GRASP.iter().for_each(|_| self.number(None)),
        }
        match grasped {
            Some(all) => self.beside(&all.answers),
            None => (0..self.beside.iter().sum()).for_each(|_| self.number(None)),
        }
        self.end_line()
    }

    /// What the scene asks for beside; a cell for each of its columns.
    fn beside(&mut self, answers: &Answers) {
        let [other, _, quality] = self.beside;
        let mut numbers = [f64::NAN; OF_OTHER.len()];
        if let Some(found) = &answers.other {
            let line = found.line.map(|line| {
                let (point, direction) = (line.line.point, line.line.direction);
                [point.x, point.y, point.z, direction.x, direction.y, direction.z, line.pitch]
            });
            let wrench: [f64; 6] = found.wrench.components().into();
            for (to, from) in numbers.iter_mut().zip(wrench.into_iter().chain(line.into_iter().flatten())) {
                *to = from;
            }
        }
        numbers.iter().take(other).for_each(|x| self.number(Some(*x)));
        for reach in &answers.reaches {
            match reach {
                Reach::Times(times) => self.number(Some(*times)),
                Reach::Unlimited => self.word("inf"),
                Reach::NotHeld | Reach::Unknown => self.number(None),
            }
        }
        match answers.quality.filter(|_| quality > 0) {
            Some(found) => {
                self.word(found.closure.map_or("", |closed| if closed { "yes" } else { "no" }));
                [found.ball.certified, found.ball.found].into_iter().for_each(|x| self.number(Some(x)));
                found.ball.weakest.components().iter().for_each(|x| self.number(Some(*x)));
            }
            None => (0..quality).for_each(|_| self.number(None)),
        }
    }

    /// Writes what is left.
    pub(super) fn finish(mut self) -> Result<(), CliError> {
        self.flush()?;
        self.out.finish()
    }

    fn word(&mut self, word: &str) {
        self.cells.put_cell(word.as_bytes());
    }

    fn number(&mut self, value: Option<f64>) {
        self.cells.put_numbers(&[value.unwrap_or(f64::NAN)]);
    }

    fn end_line(&mut self) -> Result<(), CliError> {
        self.cells.put(b"\n");
        if self.cells.is_full() { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), CliError> {
        let written = self.out.write_all(self.cells.text());
        self.cells.clear();
        written.map_err(|source| CliError::write("grasp", &self.path, source))
    }
}
