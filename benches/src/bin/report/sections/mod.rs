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

/// Fills the page with all parts, or with one, and returns the short parts with the names of their pages in the book.
pub(crate) fn all(
    page: &mut Page,
    effort: Effort,
    only: Option<&str>,
) -> Result<Vec<(&'static str, Part)>, Failure> {
    let wanted = |name: &str| only.is_none_or(|only| only == name);
    if !SECTIONS.iter().any(|(name, _)| wanted(name)) {
        return Err(format!("no such part; there are {}", SECTIONS.map(|(name, _)| name).join(", ")).into());
    }
    let wanted = SECTIONS.iter().filter(|(name, _)| wanted(name));
    wanted.map(|(name, section)| Ok((*name, section(page, effort)?))).collect()
}
