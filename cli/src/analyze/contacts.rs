//! `contacts.csv`: one row per sample.

use std::io::Write;
use std::path::{Path, PathBuf};

use fingertip::contact::{NoContact, Resolution};
use fingertip::friction::SlipVerdict;
use fingertip_scene::{Felt, Tells};

use crate::error::CliError;
use crate::observe::Status;
use crate::output::{Outputs, Whole};

/// The columns; units are in the names. Where a sample has no value, the cell is empty.
const HEADER: &str = "t_s,status,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,x_m,y_m,z_m,nx,ny,nz,\
                      normal_N,tangential_N,ratio,margin_N,gap_m,slip";
/// Whether a scene asks for some columns.
type IsTold = fn(&Tells) -> bool;
/// What a scene that asks for more has behind it, in this order.
const MORE: [(IsTold, &[&str]); 5] = [
    (|tells| tells.spin_torque, &["spin_Nm"]),
    (
        |tells| tells.spread,
        &["ellipse_a_m", "ellipse_b_m", "ellipse_x", "ellipse_y", "ellipse_z", "normal_deviation_N"],
    ),
    (|tells| tells.slip_probability, &["slip_probability"]),
    (|tells| tells.friction, &["mu_static", "mu_static_deviation", "mu_kinetic", "mu_kinetic_deviation"]),
    (|tells| tells.grip_force, &["grip_N"]),
];
/// Cells behind the wrench.
const CONTACT_CELLS: usize = 11;
/// Bytes that are collected before they are written.
const BUFFER: usize = 1 << 16;

/// Writes one row per sample.
///
/// Numbers are written in single precision with as many digits as that needs (7 to 9), which no
/// force sensor comes near; times in nanoseconds.
pub(super) struct ContactWriter {
    out: Whole,
    path: PathBuf,
    buffer: Vec<u8>,
    tells: Tells,
    /// Cells behind those of every scene.
    more: usize,
}

impl ContactWriter {
    /// `-` is the standard output.
    pub(super) fn create(path: &Path, outputs: &Outputs, tells: Tells) -> Result<Self, CliError> {
        let out = outputs.create("contacts", path)?;
        let mut buffer = Vec::with_capacity(BUFFER);
        buffer.extend_from_slice(HEADER.as_bytes());
        let mut more = 0;
        for column in MORE.iter().filter(|(of, _)| of(&tells)).flat_map(|(_, columns)| *columns) {
            buffer.extend_from_slice(format!(",{column}").as_bytes());
            more += 1;
        }
        buffer.push(b'\n');
        Ok(Self { out, path: path.to_owned(), buffer, tells, more })
    }

    #[inline]
    pub(super) fn write(&mut self, time: f64, felt: &Felt<f64>) -> Result<(), CliError> {
        let touch = &felt.touch;
        self.time(time);
        self.word(Status::of(&touch.resolution).word());
        self.cells(touch.wrench.force().as_ref());
        self.cells(touch.wrench.torque().as_ref());
        match (&touch.resolution, &touch.force) {
            (Resolution::Contact(contact), Some(force)) => {
                self.cells(contact.point.as_ref());
                self.cells(contact.normal.as_ref());
                self.cell(force.normal);
                self.cell(force.tangential_magnitude());
                self.cell(force.friction_ratio().unwrap_or(f64::NAN));
                self.cell(touch.grip.flatten().map_or(f64::NAN, |margin| margin.newtons));
                self.cell(contact.gap);
            }
            (Resolution::NoContact(NoContact::Misses { closest: Some(closest) }), _) => {
                self.empty(CONTACT_CELLS - 1);
                self.cell(closest.gap);
            }
            _ => self.empty(CONTACT_CELLS),
        }
        self.word(match touch.slip {
            None => "",
            Some(SlipVerdict::NotPressing) => "not_pressing",
            Some(SlipVerdict::Holding) => "holding",
            Some(SlipVerdict::Warning) => "warning",
            Some(SlipVerdict::Slipping) => "slipping",
        });
        self.more(felt);
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
                    spread.ellipse.semi_axes.iter().for_each(|axis| self.cell(*axis));
                    self.cells(spread.ellipse.directions[0].as_ref());
                    self.cell(spread.normal_force);
                }
                None => self.empty(6),
            }
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

    pub(super) fn write_without_wrench(&mut self, time: f64, status: Status) -> Result<(), CliError> {
        self.time(time);
        self.word(status.word());
        self.empty(6 + CONTACT_CELLS + 1 + self.more);
        self.end_row()
    }

    #[inline]
    fn time(&mut self, time: f64) {
        if time.is_finite() {
            let rounded = (time * 1e9).round() / 1e9;
            // Long times have no nanoseconds to round to.
            let rounded = if rounded.is_finite() { rounded } else { time };
            self.buffer.extend_from_slice(zmij::Buffer::new().format_finite(rounded).as_bytes());
        }
    }

    #[inline]
    fn cells(&mut self, values: &[f64; 3]) {
        values.iter().for_each(|value| self.cell(*value));
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "single precision is what the file holds")]
    fn cell(&mut self, value: f64) {
        self.buffer.push(b',');
        let single = value as f32;
        if single.is_finite() {
            self.buffer.extend_from_slice(zmij::Buffer::new().format_finite(single).as_bytes());
        }
    }

    #[inline]
    fn empty(&mut self, cells: usize) {
        self.buffer.extend(core::iter::repeat_n(b',', cells));
    }

    #[inline]
    fn word(&mut self, word: &str) {
        self.buffer.push(b',');
        self.buffer.extend_from_slice(word.as_bytes());
    }

    #[inline]
    fn end_row(&mut self) -> Result<(), CliError> {
        self.buffer.push(b'\n');
        if self.buffer.len() >= BUFFER { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), CliError> {
        let written = self.out.write_all(&self.buffer).and_then(|()| self.out.flush());
        self.buffer.clear();
        written.map_err(|source| CliError::write("contacts", &self.path, source))
    }

    /// Writes what is left.
    pub(super) fn finish(mut self) -> Result<(), CliError> {
        self.flush()?;
        self.out.finish()
    }
}
