//! The template: the unrolled tube at 1:1.

use core::f64::consts::FRAC_PI_2;

use super::unrolled::{Outline, Unrolled};
use super::{around, direction, millimetres, signed};
use crate::design::Placement;
use crate::page::{Placed, Table};
use crate::sheet::{Anchor, Pen, Sheet, tables};

/// Edges of the sheet that printers leave white, with room to spare \[mm\].
const MARGIN: f64 = 12.0;
/// Where the strip begins \[mm\].
const LEFT: f64 = 38.0;
const TOP: f64 = 62.0;
/// The strip goes on behind its seam, so that it can be glued to itself \[mm\].
const TAB: f64 = 8.0;
/// Length of the scales \[mm\].
const SCALE: f64 = 100.0;
/// Room right of the strip, for the names of the rings \[mm\].
const NAMES: f64 = 24.0;

/// Two standard deviations: 95 % of gauges that are glued with that care.
fn allowed(placement: Placement) -> (f64, f64) {
    (2.0 * placement.position, 2.0 * placement.angle.to_degrees())
}

/// The unrolled tube at 1:1 with the outlines of the gauges and two scales that check the printer. Gauges are found by the
/// names `gauge-1-carrier`, `gauge-1-grid`, `gauge-1-axis` and `gauge-1-place` (a circle, how far the middle of its
/// grid may be off) and so on; the edge of the strip is `strip`, and `angle-0`, `angle-90` and so on are the lines along the
/// tube at these angles.
#[must_use]
pub fn template(unrolled: &Unrolled, placement: Placement) -> Sheet {
    let (long, high) = (unrolled.length() * 1e3, (unrolled.clamped - unrolled.top) * 1e3);
    let least = [LEFT + SCALE + NAMES, TOP + SCALE + 8.0];
    let needed = [LEFT + long + TAB + NAMES, TOP + high + 12.0];
    let size = [least[0].max(needed[0]) + MARGIN, least[1].max(needed[1]) + MARGIN];
    let mut sheet = Sheet::holding("Template of the gauges, 1:1", size);
    let (place, angle) = allowed(placement);
    let lines = [
        "Print at 100 %, not fitted to the page. Both scales must measure 100.0 mm: 0.1 mm less or more moves no gauge by more".to_owned(),
        format!(
            "than {} mm. Seen from outside, the tip is above. Wrap it around the tube of Ø {} mm: the edges 0 and 0 meet, for paper",
            millimetres(1e-3 * unrolled.length(), 2),
            millimetres(2.0 * unrolled.outer, 2)
        ),
        format!(
            "of {} mm. A gauge may be off by {} mm and {}° (two standard deviations).",
            millimetres(2.0 * (unrolled.drawn - unrolled.outer), 2),
            millimetres(place, 2),
            signed(angle, 1)
        ),
    ];
    sheet.heading(MARGIN, 10.0, &lines);
    scales(&mut sheet);
    strip(&mut sheet, unrolled);
    gauges(&mut sheet, unrolled, place * 1e3);
    sheet
}

/// Where each gauge goes, and how far off it may be, as tables on sheets.
#[must_use]
pub fn placements(unrolled: &Unrolled, placement: Placement) -> Vec<Sheet> {
    let (place, angle) = allowed(placement);
    let lines = [
        format!(
            "Each gauge may be off by {} mm along and around, and by {}° in its angle (two standard deviations).",
            millimetres(place, 2),
            signed(angle, 1)
        ),
        "From the tube's axis (up, to the tip) the angle Q turns the gauge towards growing angles around (right).".to_owned(),
    ];
    let head = [
        "gauge",
        "behind origin / mm",
        "before clamp / mm",
        "around / °",
        "from the edge / mm",
        "angle Q / °",
    ];
    let row = |(number, outline): (usize, &Outline)| {
        let Outline { gauge, centre, .. } = outline;
        vec![
            number.to_string(),
            millimetres(gauge.z, 2),
            millimetres(unrolled.clamped - gauge.z, 2),
            signed(around(gauge.theta), 2),
            millimetres(centre[0], 2),
            signed(direction(gauge.q), 2),
        ]
    };
    let rows: Vec<Vec<String>> = (1..).zip(&unrolled.outlines).map(row).collect();
    let head = head.map(str::to_owned);
    tables("Where the gauges go", &lines, &[Table { head: &head, rows: &rows, ..Table::default() }])
}

/// A scale of 100 mm to the right, and one downwards: a printer may feed paper otherwise than it moves its head.
fn scales(sheet: &mut Sheet) {
    let (x, y) = (LEFT, 36.0);
    sheet.named_line(Pen::Thin, "scale-across", [x, y], [x + SCALE, y]);
    let (down_x, down_y) = (MARGIN + 8.0, TOP);
    sheet.named_line(Pen::Thin, "scale-down", [down_x, down_y], [down_x, down_y + SCALE]);
    for millimetre in 0..=100_u32 {
        let at = f64::from(millimetre);
        let tick = if millimetre % 10 == 0 {
            4.0
        } else if millimetre % 5 == 0 {
            2.5
        } else {
            1.5
        };
        sheet.line(Pen::Thin, [x + at, y], [x + at, y + tick]);
        sheet.line(Pen::Thin, [down_x, down_y + at], [down_x - tick, down_y + at]);
        if millimetre % 20 == 0 {
            let label = millimetre.to_string();
            sheet.text([x + at, y + 7.0], 2.5, Anchor::Middle, &label);
            sheet.text([down_x + 1.2, down_y + at + 0.9], 2.5, Anchor::Start, &label);
        }
    }
    sheet.text([x + SCALE + 3.0, y + 4.0], 2.5, Anchor::Start, "100 mm");
    sheet.text([down_x - 4.0, down_y + SCALE + 5.0], 2.5, Anchor::Start, "100 mm");
}

/// The edge, the lines of the origin and of the angles, and the ring of each gauge.
fn strip(sheet: &mut Sheet, unrolled: &Unrolled) {
    let long = unrolled.length() * 1e3;
    let down = |z: f64| TOP + (z - unrolled.top) * 1e3;
    let (top, bottom, right) = (TOP, down(unrolled.clamped), LEFT + long);
    sheet.polygon(Pen::Thick, "strip", [[LEFT, top], [right, top], [right, bottom], [LEFT, bottom]]);
    let tab = right + TAB;
    sheet.curve(Pen::Dashed, [[right, top], [tab, top + 2.0], [tab, bottom - 2.0], [right, bottom]]);
    sheet.text([right + 0.5 * TAB, top + 5.0], 2.0, Anchor::Middle, "glue");
    for (x, label) in [(LEFT, "0"), (right, "0")] {
        sheet.text([x, bottom + 4.0], 2.5, Anchor::Middle, label);
    }
    sheet.text([LEFT + 0.5 * long, bottom + 4.0], 2.5, Anchor::Middle, "clamped from here on");
    for (quarters, axis) in [(0.0, "+Y"), (1.0, "+Z"), (2.0, "−Y"), (3.0, "−Z")] {
        let x = LEFT + unrolled.place(quarters * FRAC_PI_2) * 1e3;
        let name = format!("angle-{}", 90.0 * quarters);
        sheet.named_line(Pen::Thin, &name, [x, top - 1.5], [x, bottom]);
        sheet.text([x, top - 5.0], 2.2, Anchor::Middle, &format!("{}°", 90.0 * quarters));
        sheet.text([x, top - 2.2], 2.2, Anchor::Middle, axis);
    }
    let mut rings: Vec<f64> = unrolled.outlines.iter().map(|outline| outline.gauge.z).chain([0.0]).collect();
    rings.sort_by(f64::total_cmp);
    rings.dedup_by(|a, b| (*a - *b).abs() < 5e-6);
    let mut placed = Placed::default();
    for z in rings {
        let y = down(z);
        if y > bottom + 1e-9 {
            continue;
        }
        sheet.line(Pen::Thin, [LEFT, y], [tab + 1.0, y]);
        if placed.take([0.0, 1.0, y - 1.5, y + 1.5]) {
            let name = if z.abs() < 5e-6 { "origin".to_owned() } else { format!("{} mm", millimetres(z, 2)) };
            sheet.text([tab + 2.0, y + 0.8], 2.2, Anchor::Start, &name);
        }
    }
}

/// The outlines; what goes over an edge stands at the other, too.
fn gauges(sheet: &mut Sheet, unrolled: &Unrolled, allowed: f64) {
    let long = unrolled.length();
    let on = |[x, z]: [f64; 2]| [LEFT + x * 1e3, TOP + (z - unrolled.top) * 1e3];
    let mut placed = Placed::default();
    for (number, outline) in (1..).zip(&unrolled.outlines) {
        let name = |part: &str| format!("gauge-{number}-{part}");
        sheet.polygon(Pen::Thick, &name("carrier"), outline.carrier.map(on));
        sheet.polygon(Pen::Thin, &name("grid"), outline.grid.map(on));
        let [tail, head] = outline.axis.map(on);
        sheet.named_line(Pen::Thin, &name("axis"), tail, head);
        sheet.circle(Pen::Thin, &name("place"), on(outline.centre), allowed);
        for turns in [-1.0, 1.0] {
            let shifted = |corner: [f64; 2]| [corner[0] + turns * long, corner[1]];
            let copy = Outline { carrier: outline.carrier.map(shifted), ..*outline };
            if copy.reaches(0.0, long) {
                sheet.polygon(Pen::Dashed, "", copy.carrier.map(on));
            }
        }
        let label = format!("{number}: {}°", signed(direction(outline.gauge.q), 1));
        // Beyond the end that is nearer to the tip, or the other where another's stands.
        let (upper, lower) = if head[1] < tail[1] { (head, tail) } else { (tail, head) };
        let places = [[upper[0], upper[1] - 0.8], [lower[0], lower[1] + 2.4]];
        let half = 0.27 * 2.2 * label.chars().count() as f64;
        let free = |at: &[f64; 2]| placed.take([at[0] - half, at[0] + half, at[1] - 2.0, at[1] + 0.4]);
        let at = places.into_iter().find(free).unwrap_or([upper[0] + 2.0, upper[1] + 2.0]);
        sheet.text(at, 2.2, Anchor::Middle, &label);
    }
}
