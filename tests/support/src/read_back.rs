//! Reads a drawing of a page as its reader does: by the marks along its axes.
#![allow(clippy::unwrap_used, clippy::missing_panics_doc, reason = "helpers of tests, which may fail so")]

/// A path of a drawing: its class, and its pieces.
pub struct Path {
    /// Classes of the style sheet.
    pub class: String,
    /// The points of each.
    pub pieces: Vec<Vec<(f64, f64)>>,
}

/// A text of a drawing.
#[derive(Debug)]
pub struct Text {
    /// Class of the style sheet.
    pub class: String,
    /// Where it is attached.
    pub at: (f64, f64),
    /// Which end of it.
    pub anchor: String,
    /// What it says.
    pub text: String,
}

fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let start = tag.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
    &tag[start..start + tag[start..].find('"').unwrap()]
}

fn number(tag: &str, name: &str) -> f64 {
    attribute(tag, name).parse().unwrap()
}

fn tags<'a>(svg: &'a str, name: &str) -> Vec<&'a str> {
    svg.match_indices(&format!("<{name} ")).map(|(at, _)| &svg[at..]).collect()
}

/// The pieces of a path: `M`, `L`, behind the last point of one that is closed `Z`, and behind a single point `h0`.
fn pieces(d: &str) -> Vec<Vec<(f64, f64)>> {
    let point = |text: &str| {
        let (x, y) = text.split_once(' ').unwrap();
        (x.parse().unwrap(), y.parse().unwrap())
    };
    d.split('M')
        .skip(1)
        // Behind `m` a shape is drawn about the point.
        .map(|piece| {
            let corners = piece.split('m').next().unwrap().trim_end_matches("h0").trim_end_matches('Z');
            corners.split('L').map(point).collect::<Vec<_>>()
        })
        .inspect(|piece| {
            assert!(piece.len() > 1 || d.contains("h0") || d.contains('m'), "a point that is not seen: {d}")
        })
        .collect()
}

/// All paths of a drawing.
///
/// # Panics
/// If a path is not as our drawings write it; so do the others here.
#[must_use]
pub fn paths(svg: &str) -> Vec<Path> {
    tags(svg, "path")
        .into_iter()
        .map(|tag| Path { class: attribute(tag, "class").to_owned(), pieces: pieces(attribute(tag, "d")) })
        .collect()
}

/// The points of all paths of a class.
#[must_use]
pub fn points(svg: &str, class: &str) -> Vec<(f64, f64)> {
    paths(svg).into_iter().filter(|path| path.class == class).flat_map(|path| path.pieces.concat()).collect()
}

/// All texts of a drawing.
#[must_use]
pub fn texts(svg: &str) -> Vec<Text> {
    let text = |tag: &str| Text {
        class: attribute(tag, "class").to_owned(),
        at: (number(tag, "x"), number(tag, "y")),
        anchor: attribute(tag, "text-anchor").to_owned(),
        text: tag[tag.find('>').unwrap() + 1..tag.find("</text>").unwrap()].to_owned(),
    };
    tags(svg, "text").into_iter().map(text).collect()
}

/// Centre and radius of the circles of a class.
#[must_use]
pub fn circles(svg: &str, class: &str) -> Vec<((f64, f64), f64)> {
    tags(svg, "circle")
        .into_iter()
        .filter(|tag| attribute(tag, "class") == class)
        .map(|tag| ((number(tag, "cx"), number(tag, "cy")), number(tag, "r")))
        .collect()
}

/// Class, left edge and width of the rectangles.
#[must_use]
pub fn rectangles(svg: &str) -> Vec<(String, f64, f64)> {
    let rectangle = |tag: &str| (attribute(tag, "class").to_owned(), number(tag, "x"), number(tag, "width"));
    tags(svg, "rect").into_iter().map(rectangle).collect()
}

/// Width and height.
#[must_use]
pub fn size(svg: &str) -> (f64, f64) {
    let numbers: Vec<f64> =
        attribute(svg, "viewBox").split(' ').map(|number| number.parse().unwrap()).collect();
    (numbers[2], numbers[3])
}

/// What a label says, a true minus included.
#[must_use]
pub fn value(label: &str) -> Option<f64> {
    label.replace('−', "-").trim_end_matches('°').parse().ok()
}

/// From places along an axis to values: the line through the first and the last mark.
#[derive(Clone, Copy)]
pub struct Ruler {
    zero: f64,
    slope: f64,
}

impl Ruler {
    /// Through marks (place, value), which must all lie on one line to within the rounding of places to 0.1.
    fn through(marks: &[(f64, f64)]) -> Self {
        let [(p0, v0), .., (p1, v1)] = *marks else { panic!("{} marks are no axis", marks.len()) };
        let slope = (v1 - v0) / (p1 - p0);
        let ruler = Self { zero: v0 - slope * p0, slope };
        for (place, value) in marks {
            assert!(
                (ruler.at(*place) - value).abs() < 0.11 * slope.abs(),
                "marks that are not in line: {marks:?}"
            );
        }
        ruler
    }

    /// The value at a place.
    #[must_use]
    pub fn at(self, place: f64) -> f64 {
        self.zero + self.slope * place
    }

    /// What the rounding of places hides: half of 0.1 at the place, and as much at the marks.
    #[must_use]
    pub fn error(self) -> f64 {
        0.15 * self.slope.abs()
    }
}

/// The rulers of a chart, across and up. Across, marks stand right over their labels; upwards, a label stands a few
/// units lower than its line, so that the lines of class `grid` from edge to edge tell the place.
#[must_use]
pub fn rulers(svg: &str) -> (Ruler, Ruler) {
    let all = texts(svg);
    let ticks = |anchor: &str| -> Vec<(f64, f64, f64)> {
        let chosen = all.iter().filter(|text| text.class == "tick" && text.anchor == anchor);
        chosen.map(|text| (text.at.0, text.at.1, value(&text.text).unwrap())).collect()
    };
    // The labels of the legend are in the middle too, but lower.
    let middle = ticks("middle");
    let highest = middle.iter().map(|tick| tick.1).fold(f64::INFINITY, f64::min);
    let across: Vec<(f64, f64)> =
        middle.iter().filter(|tick| tick.1 == highest).map(|tick| (tick.0, tick.2)).collect();
    let grid = paths(svg).into_iter().filter(|path| path.class == "grid").map(|path| path.pieces[0].clone());
    let lines: Vec<f64> = grid.filter(|line| line[0].1 == line[1].1).map(|line| line[0].1).collect();
    let labels = ticks("end");
    assert_eq!(lines.len(), labels.len(), "as many lines as labels");
    let up: Vec<(f64, f64)> = lines
        .iter()
        .zip(&labels)
        .map(|(line, (_, low, value))| {
            assert!((0.0..6.0).contains(&(low - line)), "a label {low} beside its line {line}");
            (*line, *value)
        })
        .collect();
    (Ruler::through(&across), Ruler::through(&up))
}

/// That every text lies within the drawing, at six units a letter, and no two overlap.
pub fn assert_readable(svg: &str) {
    let (width, height) = size(svg);
    let boxes: Vec<_> = texts(svg)
        .into_iter()
        .map(|text| {
            let long = 6.0 * text.text.chars().count() as f64;
            let left = text.at.0
                - match text.anchor.as_str() {
                    "start" => 0.0,
                    "middle" => 0.5 * long,
                    _ => long,
                };
            (text, left, left + long)
        })
        .collect();
    for (index, (text, left, right)) in boxes.iter().enumerate() {
        assert!(*left >= 0.0 && *right <= width && text.at.1 >= 8.0 && text.at.1 <= height, "{text:?}");
        for (other, from, to) in &boxes[index + 1..] {
            let beside = right <= from || to <= left || (text.at.1 - other.at.1).abs() >= 8.0;
            assert!(beside, "{text:?} over {other:?}");
        }
    }
}
