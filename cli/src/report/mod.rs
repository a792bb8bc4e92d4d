//! `report.html`: one file that needs nothing else.

mod colours;
pub(crate) mod contours;
mod figures;
mod map;
mod solid;
pub(crate) mod unrolled_tube;
pub(crate) mod used;

pub(crate) use figures::Shown;
pub(crate) use fingertip_calibration::page::{Axis, Chart, Figure};

use fingertip_calibration::page::{self, Page};

use crate::observe::Observations;
use crate::summary::Findings;
use crate::table::Table;
use fingertip_scene::{Limit, Scene};
use used::Given;

/// The report of a recording.
pub(crate) fn of_recording(
    findings: &Findings,
    observations: &Observations,
    scene: &Scene,
    given: &Given<'_>,
) -> String {
    let coefficient = scene.limit().map(Limit::coefficient);
    let shown = Shown { surface: scene.surface(), coefficient, spin_torque: scene.tells().spin_torque };
    page(findings, figures::of(observations, shown), &[used::table(scene, given)], CURVES)
}

/// What a scene means, with a picture of its surface; and what in it is implausible.
pub(crate) fn of_scene(scene: &Scene) -> String {
    let findings = Findings {
        title: if scene.name().is_empty() { "Scene".to_owned() } else { scene.name().to_owned() },
        notes: scene.doubts(),
        ..Findings::default()
    };
    let figure = solid::of_scene(scene.surface(), scene.projection());
    let used = used::table(scene, &Given { calibrated: true, ..Given::default() });
    page(&findings, figure.into_iter().collect(), &[used], "")
}

/// The solid that turns, for a page that shows samples as they come.
#[cfg(feature = "web")]
pub(crate) fn live_view(scene: &Scene) -> String {
    solid::element(scene.surface(), scene.projection())
}

/// The surface for what draws it in its own way.
#[cfg(any(feature = "foxglove", feature = "ros2"))]
pub(crate) fn net(scene: &Scene) -> fingertip_bridges::Net {
    let (points, columns) = solid::net(scene.surface(), scene.projection());
    fingertip_bridges::Net { points, columns }
}

/// The report of a run with figures of its own before the usual ones.
pub(crate) fn with_figures(
    findings: &Findings,
    mut figures: Vec<Figure>,
    observations: &Observations,
    shown: Shown<'_>,
) -> String {
    figures.extend(figures::of(observations, shown));
    page(findings, figures, &[], CURVES)
}

/// The report of something else than a recording.
pub(crate) fn of_design(findings: &Findings, figures: Vec<Figure>) -> String {
    page(findings, figures, &[], CURVES)
}

fn shown(table: &Table) -> page::Table<'_> {
    let Table { title, head, rows } = table;
    page::Table { title, head, rows, words: false }
}

/// How curves are drawn.
const CURVES: &str = "Curves are thinned so that their peaks are kept; quantiles are right to 0.4 %. ";

/// `words` are tables that stand behind the figures; `of_figures` says at the foot how these are drawn.
fn page(findings: &Findings, figures: Vec<Figure>, words: &[Table], of_figures: &str) -> String {
    let mut page = Page::new(&findings.title);
    findings.lead.iter().for_each(|sentence| page.lead(sentence));
    page.tables(findings.tables.iter().map(shown));
    page.figures(figures);
    for table in words {
        page.table(&page::Table { words: true, ..shown(table) });
    }
    let notes: Vec<String> = findings.notes.iter().map(|note| format!("{note}.")).collect();
    page.list("To be minded", &notes);
    page.finish(&format!(
        "Forces and torques are loads on the fingertip, in the sensor frame. {of_figures}Made by fingertip {}.",
        env!("CARGO_PKG_VERSION")
    ))
}

#[cfg(test)]
mod tests {
    use super::{CURVES, Figure, Findings, page};
    use crate::table::Table;

    #[test]
    fn the_page_holds_everything_that_was_found() {
        let mut table = Table::new("T<1>", ["", "a & b"]);
        table.row(["first".to_owned(), "1 N".to_owned()]);
        let findings = Findings {
            title: "A < B".to_owned(),
            lead: vec!["Lead 1 N.".to_owned()],
            tables: vec![table],
            notes: vec!["mind > this".to_owned()],
        };
        let html =
            page(&findings, vec![Figure { title: "F&G".to_owned(), ..Figure::default() }], &[], CURVES);
        let places: Vec<usize> = [
            "<h1>A &lt; B</h1>",
            "Lead 1\u{a0}N.",
            "<h2>T&lt;1&gt;</h2>",
            "<td>1\u{a0}N</td>",
            "<h2>F&amp;G</h2>",
            "<h2>To be minded</h2><ul><li>mind &gt; this.</li></ul>",
            "<footer>Forces",
        ]
        .iter()
        .map(|part| html.find(part).unwrap_or_else(|| panic!("{part} is not in {html}")))
        .collect();
        assert!(places.is_sorted(), "{places:?}");
        assert!(!page(&Findings::default(), Vec::new(), &[], CURVES).contains("To be minded"));
    }
}
