//! The tube with its dimensions.

use super::unrolled::Unrolled;
use super::{around, millimetres, signed};
use crate::page::Placed;
use crate::sheet::{Anchor, Pen, Sheet};

/// Scales that a workshop knows.
const SCALES: [f64; 10] = [20.0, 10.0, 5.0, 4.0, 3.0, 2.0, 1.0, 0.5, 0.2, 0.1];
/// Rings whose distance from the clamp is drawn; that of all stands in the table.
const RINGS: usize = 8;
const MARGIN: f64 = 15.0;
/// Letters of names \[mm\].
const LETTERS: f64 = 2.5;

/// The largest known scale at which a length \[m\] is no longer than `room` \[mm\]; the length in the last resort.
fn scale(length: f64, room: f64) -> f64 {
    let holds = |scale: &&f64| length * 1e3 * **scale <= room;
    SCALES.iter().find(holds).copied().unwrap_or(room / (length * 1e3))
}

/// "2:1", "1:5".
fn ratio(scale: f64) -> String {
    if scale >= 1.0 { format!("{scale:.0}:1") } else { format!("1:{:.0}", 1.0 / scale) }
}

/// The tube from the side, its section seen from the tip, and a gauge, with their dimensions in millimetres. `tip` is
/// the radius of the spherical fingertip about the origin \[m\], where it is known.
#[must_use]
pub fn drawing(unrolled: &Unrolled, tip: Option<f64>) -> Sheet {
    let mut sheet = Sheet::a4("The tube and its gauges");
    let lines = [
        format!(
            "Outer diameter Ø {} mm, inner Ø {} mm, wall {} mm. All dimensions are in millimetres.",
            millimetres(2.0 * unrolled.outer, 3),
            millimetres(2.0 * unrolled.inner, 3),
            millimetres(unrolled.outer - unrolled.inner, 3)
        ),
        "The origin of the loads is the centre of the fingertip; X runs along the tube, to the tip."
            .to_owned(),
    ];
    sheet.heading(MARGIN, 12.0, &lines);
    side(&mut sheet, unrolled, tip);
    section(&mut sheet, unrolled, [62.0, 225.0]);
    gauge(&mut sheet, unrolled, [160.0, 220.0]);
    sheet
}

/// From the side, the tip on the right.
fn side(sheet: &mut Sheet, unrolled: &Unrolled, tip: Option<f64>) {
    let least = unrolled.outlines.iter().map(|outline| outline.gauge.z).fold(0.0, f64::min);
    let end = least.min(0.0) - 2e-3;
    let reach = unrolled.clamped - end.min(-tip.unwrap_or(0.0));
    let widest = unrolled.outer.max(tip.unwrap_or(0.0));
    let scale = scale(reach, 125.0).min(scale(2.0 * widest, 60.0));
    let on = |length: f64| length * 1e3 * scale;
    let (left, middle) = (45.0, 75.0);
    let x = |z: f64| left + on(unrolled.clamped - z);
    let (outer, inner) = (on(unrolled.outer), on(unrolled.inner));
    let to = x(end);
    sheet.text(
        [MARGIN, middle - on(widest) - 6.0],
        3.0,
        Anchor::Start,
        &format!("From the side, {}", ratio(scale)),
    );
    sheet.polygon(
        Pen::Thick,
        "side",
        [[left, middle - outer], [to, middle - outer], [to, middle + outer], [left, middle + outer]],
    );
    for sign in [-1.0, 1.0] {
        sheet.line(Pen::Dashed, [left, middle + sign * inner], [to, middle + sign * inner]);
    }
    sheet.line(Pen::Dashed, [left - 4.0, middle], [to + 6.0, middle]);
    if let Some(tip) = tip {
        sheet.circle(Pen::Dashed, "tip", [x(0.0), middle], on(tip));
    }
    // The clamp: a wall with strokes behind it.
    let wall = outer + 5.0;
    sheet.line(Pen::Thick, [left, middle - wall], [left, middle + wall]);
    let strokes = (2.0 * wall / 3.0) as u32;
    for stroke in 0..=strokes {
        let y = middle - wall + 3.0 * f64::from(stroke);
        sheet.line(Pen::Thin, [left, y], [left - 2.5, y + 2.5]);
    }
    sheet.down(
        [left, middle - outer],
        [left, middle + outer],
        left - 10.0,
        &format!("Ø {}", millimetres(2.0 * unrolled.outer, 2)),
    );
    let mut rings: Vec<f64> = unrolled.outlines.iter().map(|outline| outline.gauge.z).collect();
    rings.push(0.0);
    rings.sort_by(|a, b| b.total_cmp(a));
    rings.dedup_by(|a, b| (*a - *b).abs() < 5e-6);
    let below = middle + on(widest).max(wall) + 8.0;
    for (number, z) in rings.iter().take(RINGS).enumerate() {
        let at = [x(*z), middle + outer];
        sheet.line(Pen::Thin, [at[0], middle - outer], at);
        let mut label = millimetres(unrolled.clamped - z, 2);
        if z.abs() < 5e-6 {
            label.push_str(" (origin)");
        }
        sheet.across([left, middle + outer], at, below + 6.0 * number as f64, &label);
    }
    if rings.len() > RINGS {
        let at = [left, below + 6.0 * RINGS as f64];
        sheet.text(
            at,
            LETTERS,
            Anchor::Start,
            &format!("and {} more rings, in the table", rings.len() - RINGS),
        );
    }
}

/// The section seen from the tip: Y to the right, Z upwards, angles against the clock.
fn section(sheet: &mut Sheet, unrolled: &Unrolled, [x, y]: [f64; 2]) {
    let scale = scale(2.0 * unrolled.outer, 50.0);
    let on = |length: f64| length * 1e3 * scale;
    let (outer, inner) = (on(unrolled.outer), on(unrolled.inner));
    sheet.text(
        [MARGIN, y - 44.0],
        3.0,
        Anchor::Start,
        &format!("Section seen from the tip, {}", ratio(scale)),
    );
    sheet.circle(Pen::Thick, "outside", [x, y], outer);
    sheet.circle(Pen::Thick, "inside", [x, y], inner);
    for (across, up, name) in [(1.0, 0.0, "Y"), (0.0, 1.0, "Z")] {
        let end = [x + across * 0.6 * inner, y - up * 0.6 * inner];
        sheet.line(Pen::Thin, [x, y], end);
        sheet.text([end[0] + 1.0, end[1] - 1.0], LETTERS, Anchor::Start, name);
    }
    let mut places: Vec<(f64, Vec<String>)> = Vec::new();
    for (number, outline) in (1..).zip(&unrolled.outlines) {
        let theta = around(outline.gauge.theta);
        match places.iter_mut().find(|(known, _)| (known - theta).abs() < 5e-3) {
            Some((_, numbers)) => numbers.push(number.to_string()),
            None => places.push((theta, vec![number.to_string()])),
        }
    }
    let mut placed = Placed::default();
    for (theta, numbers) in places {
        let (sin, cos) = theta.to_radians().sin_cos();
        let at = |radius: f64| [x + radius * cos, y - radius * sin];
        sheet.line(Pen::Thick, at(outer), at(outer + 3.0));
        let label = format!("{}: {}°", numbers.join(", "), signed(theta, 1));
        let [lx, ly] = at(outer + 5.0);
        let (anchor, from) = match cos {
            c if c > 0.3 => (Anchor::Start, 0.0),
            c if c < -0.3 => (Anchor::End, -1.0),
            _ => (Anchor::Middle, -0.5),
        };
        let wide = 0.55 * LETTERS * label.chars().count() as f64;
        let (ly, left) = (ly + 0.9 + if sin < -0.3 { 1.5 } else { 0.0 }, lx + from * wide);
        if placed.take([left, left + wide, ly - 2.0, ly + 0.5]) {
            sheet.text([lx, ly], LETTERS, anchor, &label);
        }
    }
}

/// A gauge with the dimensions of its grid and its carrier.
fn gauge(sheet: &mut Sheet, unrolled: &Unrolled, [x, y]: [f64; 2]) {
    let foil = &unrolled.foil;
    let scale = scale(foil.carrier[0].max(foil.carrier[1]), 40.0);
    let on = |length: f64| 0.5 * length * 1e3 * scale;
    let corners = |[along, across]: [f64; 2]| {
        let (h, w) = (on(along), on(across));
        [[x - w, y - h], [x + w, y - h], [x + w, y + h], [x - w, y + h]]
    };
    sheet.text(
        [x - 45.0, y - 39.0],
        3.0,
        Anchor::Start,
        &format!("Gauge, {}; it feels strain along the line", ratio(scale)),
    );
    let (carrier, grid) = (corners(foil.carrier), corners(foil.grid));
    sheet.polygon(Pen::Thick, "carrier", carrier);
    sheet.polygon(Pen::Thin, "grid", grid);
    sheet.line(Pen::Dashed, [x, y - on(foil.carrier[0]) - 4.0], [x, y + on(foil.carrier[0]) + 4.0]);
    let low = y + on(foil.carrier[0]);
    sheet.across(grid[3], grid[2], low + 7.0, &millimetres(foil.grid[1], 2));
    sheet.across(carrier[3], carrier[2], low + 14.0, &millimetres(foil.carrier[1], 2));
    let left = x - on(foil.carrier[1]);
    sheet.down(grid[0], grid[3], left - 6.0, &millimetres(foil.grid[0], 2));
    sheet.down(carrier[1], carrier[2], x + on(foil.carrier[1]) + 7.0, &millimetres(foil.carrier[0], 2));
}
