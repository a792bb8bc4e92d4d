//! `contacts.csv`: one row per sample.

use std::io::Write;
use std::path::{Path, PathBuf};

use fingertip::contact::{Continuity, Happened, NoContact, Resolution, Tracked};
use fingertip::friction::SlipVerdict;
use fingertip_scene::{Felt, Tells};

use super::array::Fused;
use super::cells::Cells;
use super::columns::{CONTACT_COLUMNS, FUSED_COLUMNS, FUSED_DISAGREEMENT};
use crate::error::CliError;
use crate::observe::Status;
use crate::output::{Outputs, Whole};

/// Cells behind the wrench.
const CONTACT_CELLS: usize = 11;
/// Commas of cells that have no value.
const COMMAS: [u8; 64] = [b','; 64];

/// Writes one row per sample.
///
/// Numbers are written with eight significant digits, which no force sensor comes near; times in nanoseconds.
pub(super) struct ContactWriter {
    out: Whole,
    path: PathBuf,
    cells: Cells,
    tells: Tells,
    /// Cells behind those of every scene.
    more: usize,
}

impl ContactWriter {
    /// `-` is the standard output.
    pub(super) fn create(
        path: &Path,
        outputs: &Outputs,
        tells: Tells,
        places: usize,
    ) -> Result<Self, CliError> {
        let out = outputs.create("contacts", path)?;
        let mut cells = Cells::default();
        let (mut names, mut more) = (Vec::new(), 0);
        for columns in CONTACT_COLUMNS.iter().filter(|columns| (columns.asked)(&tells)) {
            names.extend_from_slice(columns.names);
            more += if columns.of.is_empty() { 0 } else { columns.names.len() };
        }
        cells.put(names.join(",").as_bytes());
        for place in 1..=places {
            for (column, _) in FUSED_COLUMNS {
                cells.put(format!(",fused{place}_{column}").as_bytes());
            }
            more += FUSED_COLUMNS.len();
        }
        if places > 0 {
            cells.put(format!(",{}", FUSED_DISAGREEMENT.0).as_bytes());
            more += 1;
        }
        cells.put(b"\n");
        Ok(Self { out, path: path.to_owned(), cells, tells, more })
    }

    #[inline]
    pub(super) fn write(
        &mut self,
        time: f64,
        felt: &Felt<f64>,
        fused: Option<&Fused>,
    ) -> Result<(), CliError> {
        let touch = &felt.touch;
        self.cells.put_time(time);
        self.word(Status::of(&touch.resolution).word());
        self.cells(&touch.wrench.components().into());
        match (&touch.resolution, &touch.force) {
            (Resolution::Contact(contact), Some(force)) => {
                let ([x, y, z], [nx, ny, nz]) = (contact.point.into(), contact.normal.into());
                let ratio = force.friction_ratio().unwrap_or(f64::NAN);
                let margin = touch.grip.flatten().map_or(f64::NAN, |margin| margin.newtons);
                let (normal, tangential) = (force.normal, force.tangential_magnitude());
                self.cells(&[x, y, z, nx, ny, nz, normal, tangential, ratio, margin, contact.gap]);
            }
            (Resolution::NoContact(NoContact::Misses { closest: Some(closest) }), _) => {
                self.empty(CONTACT_CELLS - 1);
                self.cell(closest.gap);
            }
            _ => self.empty(CONTACT_CELLS),
        }
        self.word(touch.slip.map_or("", SlipVerdict::word));
        self.more(felt);
        if let Some(fused) = fused {
            self.fused(fused);
        }
        self.end_row()
    }

    /// What the scene asks for beside.
    #[inline]
    fn more(&mut self, felt: &Felt<f64>) {
        let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
        if self.tells.spin_torque {
            self.cell(number(felt.contact().map(|contact| contact.spin_torque)));
        }
        if self.tells.spread {
            match &felt.spread {
                Some(spread) => {
                    self.cells(&spread.ellipse.semi_axes);
                    self.cells::<3>(spread.ellipse.directions[0].as_ref());
                    self.cell(spread.normal_force);
                }
                None => self.empty(6),
            }
        }
        if self.tells.tracked {
            self.tracked(felt.tracked.as_ref());
        }
        if self.tells.happened {
            self.happened(felt.happened.as_ref());
        }
        if self.tells.slip_probability {
            self.cell(number(felt.slip_probability));
        }
        if self.tells.friction {
            let learnt = felt.friction.map(|learnt| [learnt.at_rest, learnt.sliding]);
            for estimate in learnt.unwrap_or_default() {
                self.cell(number(estimate.map(|estimate| estimate.coefficient)));
                self.cell(number(estimate.map(|estimate| estimate.deviation)));
            }
        }
        if self.tells.grip_force {
            self.cell(number(felt.grip_force));
        }
    }

    /// What wrench and array say together, place by place.
    fn fused(&mut self, fused: &Fused) {
        for place in &fused.places {
            let contact =
                fused.touch.as_ref().zip(*place).and_then(|(touch, own)| touch.contacts.get(own)?.as_ref());
            let Some(contact) = contact else {
                self.empty(FUSED_COLUMNS.len());
                continue;
            };
            self.cells::<3>(contact.point.as_ref());
            self.cells::<3>(contact.force.as_ref());
            self.cell(contact.force_covariance.symmetric_eigenvalues().max().max(0.0).sqrt());
            self.cell(contact.share_from_wrench);
        }
        self.cell(fused.touch.as_ref().map_or(f64::NAN, |touch| touch.disagreement));
    }

    /// Where the contact is over time.
    fn tracked(&mut self, tracked: Option<&Tracked<f64>>) {
        let Some(tracked) = tracked else {
            self.word("");
            self.empty(8);
            return;
        };
        self.word(match tracked.continuity {
            Continuity::New => "new",
            Continuity::Followed => "followed",
            Continuity::Doubted => "doubted",
            Continuity::Bridged => "bridged",
        });
        self.cells::<3>(tracked.point.as_ref());
        self.cells::<3>(tracked.velocity.as_ref());
        self.cell(tracked.deviation());
        self.cell(tracked.surprise);
    }

    /// Touch, release, or none; and the blow that is over.
    fn happened(&mut self, happened: Option<&Happened<f64>>) {
        let (touch, release) = (happened.and_then(|h| h.touch), happened.and_then(|h| h.release));
        self.word(match (touch, release) {
            (Some(_), _) => "touch",
            (None, Some(_)) => "release",
            (None, None) => "",
        });
        self.cell(touch.or(release).unwrap_or(f64::NAN));
        match happened.and_then(|happened| happened.impact) {
            Some(impact) => {
                self.cell(impact.peak);
                self.cells::<3>(impact.impulse.as_ref());
            }
            None => self.empty(4),
        }
    }

    pub(super) fn write_without_wrench(&mut self, time: f64, status: Status) -> Result<(), CliError> {
        self.cells.put_time(time);
        self.word(status.word());
        self.empty(6 + CONTACT_CELLS + 1 + self.more);
        self.end_row()
    }

    #[inline]
    fn cells<const N: usize>(&mut self, values: &[f64; N]) {
        self.cells.put_numbers(values);
    }

    #[inline]
    fn cell(&mut self, value: f64) {
        self.cells.put_numbers(&[value]);
    }

    #[inline]
    fn empty(&mut self, cells: usize) {
        let mut left = cells;
        while left > 0 {
            let some = COMMAS.get(..left).unwrap_or(&COMMAS);
            self.cells.put(some);
            left -= some.len();
        }
    }

    #[inline]
    fn word(&mut self, word: &str) {
        self.cells.put_cell(word.as_bytes());
    }

    #[inline]
    fn end_row(&mut self) -> Result<(), CliError> {
        self.cells.put(b"\n");
        if self.cells.is_full() { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), CliError> {
        let written = self.out.write_all(self.cells.text()).and_then(|()| self.out.flush());
        self.cells.clear();
        written.map_err(|source| CliError::write("contacts", &self.path, source))
    }

    /// Writes what is left.
    pub(super) fn finish(mut self) -> Result<(), CliError> {
        self.flush()?;
        self.out.finish()
    }
}
