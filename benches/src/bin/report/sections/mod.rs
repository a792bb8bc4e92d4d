//! The parts of the report, one file each.

mod calibration;
mod contact;
mod detectors;
mod integrators;
mod scenes;
mod solvers;
mod stability;

use crate::Failure;
use crate::multiples::Part;
use crate::page::Page;
use crate::timing::Effort;

/// What writes one part.
type Section = fn(&mut Page, Effort) -> Result<Part, Failure>;

/// What the pages of the book are called, and what writes them.
const SECTIONS: [(&str, Section); 7] = [
    ("solvers", solvers::report),
    ("contact", contact::report),
    ("integrators", integrators::report),
    ("detectors", detectors::report),
    ("calibration", calibration::report),
    ("stability", stability::report),
    ("scenes", scenes::report),
];

/// Fills the page, and returns the short parts with the names of their pages in the book.
pub(crate) fn all(page: &mut Page, effort: Effort) -> Result<Vec<(&'static str, Part)>, Failure> {
    SECTIONS.iter().map(|(name, section)| Ok((*name, section(page, effort)?))).collect()
}
