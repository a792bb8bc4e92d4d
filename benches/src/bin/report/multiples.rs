//! The diagrams as small multiples on pages of the book, one a part: many in a screen, with one key for those of a part,
//! in colours that follow the theme of the page.

use core::fmt::Write;

use crate::pareto::front;
use crate::plots::{Diagram, Series, decades, tick};

/// A title, and what the page for people in a hurry says under it, as Markdown.
pub(crate) type Part = (String, String);

/// A part of the report with its diagrams.
pub(crate) type Group = (String, Vec<Diagram>);

const SIZE: (f64, f64) = (300.0, 220.0);
/// Left, right, top, bottom of the frame.
const FRAME: (f64, f64, f64, f64) = (42.0, 292.0, 8.0, 186.0);
/// How many colours the style sheet of the book has for series.
const COLOURS: usize = 9;

/// The comment at the top of each page.
const ORIGIN: &str = "<!-- Written by the report of the benches: cargo run --release -p fingertip-benches --bin report -- \
                      --book book/src/measures -->\n\n";

/// The pages of the book, by the names of their files: one a part, with what is said of it and its diagrams, and one that
/// leads to them. `measured` says where.
pub(crate) fn pages(
    measured: &str,
    groups: &[Group],
    parts: &[(&'static str, Part)],
) -> Vec<(String, String)> {
    let mut first = format!(
        "{ORIGIN}# Measures\n\n{measured} Times are medians of short batches. Written by `cargo run --release -p \
         fingertip-benches --bin report`, which also writes larger diagrams and all numbers. Errors are against arithmetic \
         of 220 bits, the truth from which an input was made, or a stiff solver. Where there is a dashed line, less is \
         better on both axes, and nothing lies below and left of it.\n\n"
    );
    let mut pages = Vec::new();
    for ((title, diagrams), (name, (_, said))) in groups.iter().zip(parts) {
        // Writing to a String cannot fail.
        let _ = writeln!(first, "- [{title}]({name}.md)");
        let mut text = format!("{ORIGIN}# {title}\n\n{measured} [How](README.md).\n\n");
        let methods = methods(diagrams);
        if !diagrams.is_empty() {
            text.push_str("<div class=\"multiples\">\n");
            for diagram in diagrams {
                text.push_str(&figure(diagram, &methods));
            }
            text.push_str("</div>\n");
            text.push_str(&key(diagrams, &methods));
        }
        let _ = write!(text, "\n{}\n", said.trim());
        pages.push((format!("{name}.md"), text));
    }
    pages.push(("README.md".to_owned(), first));
    pages
}

/// The name without the precision, which is drawn hollow or full.
fn method(series: &Series) -> String {
    series.name.trim_end_matches(" f32").trim_end_matches(" f64").to_owned()
}

fn methods(diagrams: &[Diagram]) -> Vec<String> {
    let mut names: Vec<String> = diagrams.iter().flat_map(|diagram| &diagram.series).map(method).collect();
    names.sort();
    names.dedup();
    names
}

/// The place of its method in the key, and its class in the style sheet.
fn class(series: &Series, methods: &[String]) -> (usize, String) {
    let name = method(series);
    let place = methods.iter().position(|other| *other == name).unwrap_or(0);
    (place, format!("m{}{}", place % COLOURS, if series.single { " hollow" } else { "" }))
}

/// A point of a method: a square where the colours begin anew.
fn mark(place: usize, class: &str, x: f64, y: f64) -> String {
    if place < COLOURS {
        format!("<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\"/>")
    } else {
        let (left, top) = (x - 3.0, y - 3.0);
        format!("<rect class=\"{class}\" x=\"{left:.1}\" y=\"{top:.1}\" width=\"6\" height=\"6\"/>")
    }
}

/// Which method has which colour and mark, once for all diagrams of a part.
fn key(diagrams: &[Diagram], methods: &[String]) -> String {
    let mut text = String::from("<p class=\"key\">");
    for (place, name) in methods.iter().enumerate() {
        let mark = if place < COLOURS { '●' } else { '■' };
        let (colour, name) = (place % COLOURS, escaped(name));
        let _ = write!(text, "<span class=\"method\"><span class=\"m{colour}\">{mark}</span> {name}</span> ");
    }
    if diagrams.iter().flat_map(|diagram| &diagram.series).any(|series| series.single) {
        text.push_str("— hollow: f32");
    }
    text.push_str("</p>\n");
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

fn figure(diagram: &Diagram, methods: &[String]) -> String {
    let all = || diagram.series.iter().flat_map(|series| series.points.iter());
    let (x, y) = (decades(all().map(|p| p.0)), decades(all().map(|p| p.1)));
    let (left, right, top, bottom) = FRAME;
    let share = |value: f64, low: f64, high: f64| (value / low).log10() / (high / low).log10();
    let across = |value: f64| left + (right - left) * share(value, x.start, x.end);
    let up = |value: f64| bottom - (bottom - top) * share(value, y.start, y.end);
    let mut svg = String::new();
    for value in ticks(x.start, x.end) {
        let at = across(value);
        // The last label ends where the picture does.
        let (middle, anchor) = if at > right - 1.0 { (SIZE.0 - 1.0, "end") } else { (at, "middle") };
        let _ = writeln!(
            svg,
            "<line class=\"grid\" x1=\"{at:.1}\" y1=\"{top}\" x2=\"{at:.1}\" y2=\"{bottom}\"/><text x=\"{middle:.1}\" \
             y=\"{:.0}\" text-anchor=\"{anchor}\">{}</text>",
            bottom + 14.0,
            tick(value)
        );
    }
    for value in ticks(y.start, y.end) {
        let at = up(value);
        let _ = writeln!(
            svg,
            "<line class=\"grid\" x1=\"{left}\" y1=\"{at:.1}\" x2=\"{right}\" y2=\"{at:.1}\"/><text x=\"{:.0}\" \
             y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            left - 4.0,
            at + 4.0,
            tick(value)
        );
    }
    let inside = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite() && p.0 > 0.0 && p.1 > 0.0;
    let place = |p: &(f64, f64)| format!("{:.1},{:.1}", across(p.0), up(p.1));
    if diagram.front {
        let points: Vec<(f64, f64)> = all().copied().filter(inside).collect();
        let mut stairs: Vec<(f64, f64)> = Vec::new();
        for (px, py) in front(&points).into_iter().filter_map(|index| points.get(index).copied()) {
            stairs.push((px, stairs.last().map_or(y.end, |last| last.1)));
            stairs.push((px, py));
        }
        stairs.extend(stairs.last().map(|last| (x.end, last.1)));
        let corners: Vec<String> = stairs.iter().map(place).collect();
        let _ = writeln!(svg, "<polyline class=\"front\" points=\"{}\"/>", corners.join(" "));
    }
    for series in &diagram.series {
        let (method, class) = class(series, methods);
        let points: Vec<&(f64, f64)> = series.points.iter().filter(|p| inside(p)).collect();
        if series.joined && points.len() > 1 {
            let corners: Vec<String> = points.iter().map(|p| place(p)).collect();
            let _ = writeln!(svg, "<polyline class=\"{class}\" points=\"{}\"/>", corners.join(" "));
        }
        for point in points {
            let _ = writeln!(svg, "{}", mark(method, &class, across(point.0), up(point.1)));
        }
    }
    format!(
        "<figure>\n<figcaption>{}</figcaption>\n<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} over \
         {}\">\n{svg}<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{}</text>\n</svg>\n<p>up: {}</p>\n</figure>\n",
        escaped(&diagram.title),
        SIZE.0,
        SIZE.1,
        escaped(diagram.y),
        escaped(diagram.x),
        f64::midpoint(left, right),
        SIZE.1 - 6.0,
        escaped(diagram.x),
        escaped(diagram.y),
    )
}

/// Decades between full decades, so many that their labels have room.
fn ticks(low: f64, high: f64) -> Vec<f64> {
    let (first, last) = (low.log10().round() as i32, high.log10().round() as i32);
    let step = usize::try_from((last - first).max(1)).unwrap_or(1).div_ceil(5);
    (first..=last).step_by(step).map(|power| 10_f64.powi(power)).collect()
}
