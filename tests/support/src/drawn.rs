//! Measures drawings to scale back, as a ruler on the paper would.

/// A line of a drawing \[mm\], from the upper left corner of the sheet.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its name, in SVG.
    pub name: String,
    /// Where it goes; a circle has the points where its quarters meet.
    pub points: Vec<[f64; 2]>,
}

/// A sheet of paper as it comes out of a printer.
#[derive(Clone, Debug, Default)]
pub struct Paper {
    /// Width and height \[mm\].
    pub size: [f64; 2],
    /// The lines.
    pub lines: Vec<Line>,
    /// The texts.
    pub texts: Vec<String>,
    /// What room each text of an SVG takes: left, top, right and bottom \[mm\], of letters half as wide as they are
    /// high, which few are not.
    pub rooms: Vec<[f64; 4]>,
}

impl Paper {
    /// The line of a name.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    pub fn named(&self, name: &str) -> &Line {
        self.lines.iter().find(|line| line.name == name).unwrap_or_else(|| panic!("no line is called {name}"))
    }

    /// How far the line that is nearest to these points, in any order of them, is from them: the greatest distance of a point
    /// from its own.
    #[must_use]
    pub fn nearest(&self, points: &[[f64; 2]]) -> f64 {
        let off = |line: &Line| {
            if line.points.len() != points.len() {
                return f64::INFINITY;
            }
            let far = |point: &[f64; 2]| {
                line.points
                    .iter()
                    .map(|p| (p[0] - point[0]).hypot(p[1] - point[1]))
                    .fold(f64::INFINITY, f64::min)
            };
            points.iter().map(far).fold(0.0, f64::max)
        };
        self.lines.iter().map(off).fold(f64::INFINITY, f64::min)
    }
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = tag.split_once(&format!(" {name}=\""))?;
    Some(rest.split_once('"')?.0)
}

/// Reads an SVG of which a unit must be a millimetre.
///
/// # Panics
/// If it is not to scale, or has what is not known here.
#[must_use]
pub fn svg(text: &str) -> Paper {
    let number = |text: &str| text.parse::<f64>().unwrap_or_else(|_| panic!("{text} is no number"));
    let open =
        text.split_once("<svg").map_or("", |(_, rest)| rest.split_once('>').map_or("", |(tag, _)| tag));
    let length =
        |name: &str| number(attribute(open, name).unwrap_or("").strip_suffix("mm").expect("millimetres"));
    let size = [length("width"), length("height")];
    let view: Vec<f64> = attribute(open, "viewBox").expect("a view").split(' ').map(number).collect();
    assert_eq!(view, [0.0, 0.0, size[0], size[1]], "a unit is a millimetre");
    let mut paper = Paper { size, ..Paper::default() };
    for tag in text.split('<').skip(2) {
        let name = attribute(tag, "id").unwrap_or("").to_owned();
        let value = |name: &str| number(attribute(tag, name).unwrap_or(""));
        if tag.starts_with("path") {
            let d = attribute(tag, "d").unwrap_or("").trim_start_matches('M').trim_end_matches('Z');
            let point =
                |pair: &str| pair.split_once(' ').map(|(x, y)| [number(x), number(y)]).expect("a point");
            paper.lines.push(Line { name, points: d.split('L').map(point).collect() });
        } else if tag.starts_with("circle") {
            let (x, y, r) = (value("cx"), value("cy"), value("r"));
            let points = vec![[x + r, y], [x, y + r], [x - r, y], [x, y - r]];
            paper.lines.push(Line { name, points });
        } else if let Some((_, text)) = tag.strip_prefix("text").and_then(|tag| tag.split_once('>')) {
            let (x, y, high) = (value("x"), value("y"), value("font-size"));
            let wide = 0.5 * high * text.chars().count() as f64;
            let left = match attribute(tag, "text-anchor") {
                Some("end") => x - wide,
                Some("middle") => x - 0.5 * wide,
                _ => x,
            };
            paper.rooms.push([left, y - 0.7 * high, left + wide, y]);
            paper.texts.push(text.to_owned());
        }
    }
    paper
}

/// Reads the pages of a PDF whose streams are not compressed.
///
/// # Panics
/// If it is no such PDF.
#[must_use]
pub fn pdf(bytes: &[u8]) -> Vec<Paper> {
    // Letters of Windows beyond those of ASCII become what they look like; one byte is one letter.
    let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
    assert!(text.starts_with("%PDF-") && text.trim_end().ends_with("%%EOF"), "no PDF");
    let boxes = text.split("/MediaBox").skip(1).map(|rest| {
        let inner = rest.split_once('[').and_then(|(_, rest)| rest.split_once(']')).expect("a box").0;
        let numbers: Vec<f64> = inner.split_whitespace().filter_map(|number| number.parse().ok()).collect();
        [numbers[2] - numbers[0], numbers[3] - numbers[1]]
    });
    let streams = text.split("\nstream\n").skip(1).filter_map(|rest| Some(rest.split_once("\nendstream")?.0));
    boxes.zip(streams).map(|(size, stream)| page(size, stream)).collect()
}

/// A string, in round brackets or as hexadecimal digits.
fn string(shown: &str) -> String {
    if let Some(digits) = shown.strip_prefix('<').and_then(|rest| rest.strip_suffix('>')) {
        let byte = |place: usize| u8::from_str_radix(digits.get(place..place + 2)?, 16).ok();
        return (0..digits.len()).step_by(2).filter_map(byte).map(char::from).collect();
    }
    shown.trim_start_matches('(').strip_suffix(')').unwrap_or(shown).replace('\\', "")
}

/// Interprets the operators of one page.
fn page(size: [f64; 2], stream: &str) -> Paper {
    const MILLIMETRE: f64 = 72.0 / 25.4;
    let mut paper = Paper { size: size.map(|length| length / MILLIMETRE), ..Paper::default() };
    let (mut scale, mut operands, mut points) = (1.0, Vec::<f64>::new(), Vec::<[f64; 2]>::new());
    for line in stream.lines() {
        if let Some(shown) = line.strip_suffix(" Tj") {
            paper.texts.push(string(shown));
            continue;
        }
        for token in line.split_whitespace() {
            if let Ok(number) = token.parse::<f64>() {
                operands.push(number);
                continue;
            }
            let at = |x: f64, y: f64| [x * scale / MILLIMETRE, (size[1] - y * scale) / MILLIMETRE];
            match (token, operands.as_slice()) {
                ("cm", [a, b, c, d, e, f]) => {
                    assert_eq!([*b, *c, *e, *f], [0.0; 4], "only scaled");
                    assert_eq!(a, d, "alike both ways");
                    scale *= a;
                }
                ("m" | "l", [x, y]) | ("c", [_, _, _, _, x, y]) => points.push(at(*x, *y)),
                ("S" | "s" | "b" | "B", _) => {
                    // A circle ends where it began.
                    if points.len() == 5 {
                        points.pop();
                    }
                    paper.lines.push(Line { name: String::new(), points: core::mem::take(&mut points) });
                }
                _ => {}
            }
            operands.clear();
        }
    }
    paper
}
