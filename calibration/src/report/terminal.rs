//! A report for the terminal.

use core::fmt;

use super::Report;
use crate::file::Verdict;

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = match self.verdict {
            Verdict::Good => "GOOD",
            Verdict::Suspect => "SUSPECT",
            Verdict::Bad => "BAD",
            Verdict::Unchecked => "unchecked",
        };
        writeln!(f, "Calibration: {verdict}")?;
        for reason in &self.reasons {
            writeln!(f, "  because {reason}")?;
        }
        for note in &self.notes {
            writeln!(f, "  note: {note}")?;
        }
        write!(f, "{}: {} samples in {} load cases", self.method, self.samples, self.cases)?;
        if self.coefficients > 0 {
            write!(f, ", {} coefficients each", self.coefficients)?;
        }
        match self.condition_number {
            Some(number) => writeln!(f, "; condition number N_c = {number:.2}")?,
            None => writeln!(f, "; singular")?,
        }
        self.write_axes(f)?;
        self.write_contact(f)?;
        for excluded in &self.excluded {
            writeln!(f, "left out: {}: {}", excluded.sample, excluded.reason)?;
        }
        Ok(())
    }
}

impl Report {
    /// The errors axis by axis, and the cross-talk.
    fn write_axes(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "\nErrors, % of full scale (– where these loads do not tell):")?;
        write!(f, "{:>14}", "")?;
        for axis in &self.axes {
            write!(f, "{:>9}", axis.axis)?;
        }
        writeln!(f)?;
        write!(f, "{:>14}", "full scale")?;
        for axis in &self.axes {
            write!(f, "{:>9.4}", axis.full_scale)?;
        }
        writeln!(f, "   N, N·m")?;
        type Column = fn(&super::AxisReport) -> Option<f64>;
        let rows: [(&str, Column); 10] = [
            ("RMS", |a| Some(a.rms_percent)),
            ("greatest", |a| Some(a.greatest_percent)),
            ("left out RMS", |a| a.left_out_percent),
            ("left out max", |a| a.left_out_greatest_percent),
            ("one reading", |a| a.deviation_percent),
            ("linearity", |a| a.linearity_percent),
            ("hysteresis", |a| a.hysteresis_percent),
            ("repeatability", |a| a.repeatability_percent),
            ("zero return", |a| a.zero_return_percent),
            ("creep", |a| a.creep_percent),
        ];
        for (name, value) in rows {
            if self.axes.iter().any(|axis| value(axis).is_some()) {
                write!(f, "{name:>14}")?;
                for axis in &self.axes {
                    write_cell(f, value(axis))?;
                }
                writeln!(f)?;
            }
        }
        if self.cross_talk_percent.iter().flatten().any(Option::is_some) {
            writeln!(f, "\nCross-talk, % of full scale: false reading (row) under a load (column) alone:")?;
            for (axis, row) in self.axes.iter().zip(&self.cross_talk_percent) {
                write!(f, "{:>14}", axis.axis)?;
                for value in row {
                    write_cell(f, *value)?;
                }
                writeln!(f)?;
            }
        }
        Ok(())
    }

    /// Creep, what terms of higher order are worth, and what the errors make of lines of action and contact points.
    fn write_contact(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(creep) = &self.creep {
            writeln!(f, "\nCreep: {creep}")?;
        }
        if let Some(curve) = &self.curve {
            writeln!(f, "\nCurvature: {curve}")?;
        }
        if let Some(lines) = &self.lines {
            write!(
                f,
                "\nLines of action ({} pure forces): off by {:.3} mm in the median, {:.3} mm at most",
                lines.lines, lines.median_mm, lines.greatest_mm
            )?;
            match lines.expected_mm {
                Some(expected) => writeln!(f, "; {expected:.3} mm expected of the covariance")?,
                None => writeln!(f)?,
            }
        }
        if let Some(contacts) = &self.contacts {
            writeln!(
                f,
                "\nContact points on {} under {:.3} N, expected of the covariance ({} touches):\n  \
                 off by {:.3} mm because of the matrix, {:.3} mm because of the noise of one reading,\n  \
                 {:.3} mm in all (root mean square), {:.3} mm where it is worst",
                contacts.surface,
                contacts.force,
                contacts.touches,
                contacts.calibration_mm,
                contacts.reading_mm,
                contacts.together_mm,
                contacts.worst_mm
            )?;
        }
        Ok(())
    }
}

fn write_cell(f: &mut fmt::Formatter<'_>, value: Option<f64>) -> fmt::Result {
    match value {
        Some(value) => write!(f, "{value:>9.3}"),
        None => write!(f, "{:>9}", "–"),
    }
}
