//! The parts of the report, one file each.

mod calibration;
mod contact;
mod detectors;
mod integrators;
mod solvers;
mod stability;

use crate::Failure;
use crate::multiples::Part;
use crate::page::Page;
use crate::timing::Effort;

/// What writes one part.
type Section = fn(&mut Page, Effort) -> Result<Part, Failure>;

/// Fills the page, and returns the short parts.
pub(crate) fn all(page: &mut Page, effort: Effort) -> Result<Vec<Part>, Failure> {
    let sections: [Section; 6] = [
        solvers::report,
        contact::report,
        integrators::report,
        detectors::report,
        calibration::report,
        stability::report,
    ];
    sections.iter().map(|section| section(page, effort)).collect()
}
