//! The page of a sensor's health.

use fingertip_calibration::page::{Page, Table as PageTable};
use fingertip_recordings::health::{Health, Level};

use super::pictures;
use crate::summary::Findings;

/// Verdict, reasons, pictures, tables.
pub(super) fn of(health: &Health, findings: &Findings) -> String {
    let mut page = Page::new(&findings.title);
    findings.lead.iter().take(2).for_each(|sentence| page.lead(sentence));
    let of_level = |wanted: fn(Level) -> bool| -> Vec<String> {
        let chosen = health.findings.iter().filter(|finding| wanted(finding.level));
        chosen.map(|finding| format!("{}.", finding.said)).collect()
    };
    page.list("Readings are wrong", &of_level(|level| level == Level::Bad));
    page.list("Look at this", &of_level(|level| level == Level::Suspect));
    page.list("Good to know", &of_level(|level| level == Level::Note));
    page.figures(pictures::of(health));
    for table in &findings.tables {
        let words = table.head.last().is_some_and(|head| ["source", "unit", "what"].contains(&head.as_str()));
        page.table(&PageTable { title: &table.title, head: &table.head, rows: &table.rows, words });
    }
    page.list("To be minded", &findings.notes);
    page.finish(&format!(
        "Noise, drift and spectra are those of the longest rest. The Allan deviation of independent noise falls with the \
         root of the time; where it grows, averaging longer does not help. Made by fingertip {}.",
        env!("CARGO_PKG_VERSION")
    ))
}
