//! Drawings to scale: lines, circles and texts on a sheet in millimetres, written as SVG and as pages of a PDF.
//!
//! Both are written from one list of marks, so that what is measured in the one is measured in the other. Places count
//! from the upper left corner, to the right and downwards. Numbers carry a tenth of a micrometre.
//!
//! ```
//! use fingertip_calibration::sheet::{Anchor, Pen, Sheet, pdf};
//!
//! let mut sheet = Sheet::a4("A square");
//! sheet.polygon(Pen::Thick, "square", [[20.0, 20.0], [40.0, 20.0], [40.0, 40.0], [20.0, 40.0]]);
//! sheet.text([30.0, 45.0], 3.0, Anchor::Middle, "20 mm");
//! assert!(sheet.to_svg().contains(r#"width="210mm" height="297mm""#));
//! assert!(pdf(&[sheet]).starts_with(b"%PDF-"));
//! ```

mod dimension;
mod letters;
mod pages;
mod svg;
mod table;
#[cfg(test)]
pub(crate) mod tests;

pub use pages::pdf;
pub use table::tables;

pub use crate::page::Anchor;

/// How a line is drawn.
///
/// ```
/// use fingertip_calibration::sheet::{Pen, Sheet};
///
/// let mut sheet = Sheet::a4("A hidden edge");
/// sheet.line(Pen::Thick, [10.0, 10.0], [60.0, 10.0]);
/// assert!(!sheet.to_svg().contains("stroke-dasharray"));
/// sheet.line(Pen::Dashed, [10.0, 20.0], [60.0, 20.0]);
/// assert!(sheet.to_svg().contains("stroke-dasharray"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pen {
    /// Outlines.
    Thick,
    /// What is measured, helps or stands behind.
    Thin,
    /// What is hidden or is only a place.
    Dashed,
}

impl Pen {
    /// Width of the line \[mm\].
    const fn width(self) -> f64 {
        match self {
            Self::Thick => 0.25,
            Self::Thin | Self::Dashed => 0.1,
        }
    }

    /// Lengths of a dash and of the gap behind it \[mm\].
    const fn dashes(self) -> Option<[f64; 2]> {
        match self {
            Self::Dashed => Some([1.5, 0.8]),
            Self::Thick | Self::Thin => None,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Mark {
    Path { pen: Pen, name: String, closed: bool, filled: bool, points: Vec<[f64; 2]> },
    Circle { pen: Pen, name: String, centre: [f64; 2], radius: f64 },
    Text { at: [f64; 2], size: f64, anchor: Anchor, text: String },
}

/// A sheet of paper with what is drawn on it.
///
/// ```
/// use fingertip_calibration::sheet::{Pen, Sheet, pdf};
///
/// // A strip of 250 mm needs an A4 sheet that lies; places are millimetres from the upper left corner.
/// let mut sheet = Sheet::holding("A strip", [250.0, 60.0]);
/// assert_eq!(sheet.size(), [297.0, 210.0]);
/// sheet.polygon(Pen::Thick, "strip", [[20.0, 20.0], [270.0, 20.0], [270.0, 80.0], [20.0, 80.0]]);
/// assert!(sheet.to_svg().contains(r#"id="strip""#));
/// assert!(pdf(&[sheet]).starts_with(b"%PDF"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    title: String,
    size: [f64; 2],
    marks: Vec<Mark>,
}

/// Width and height of the sheets that printers have \[mm\]: A4 upright and lying, A3 lying.
const SIZES: [[f64; 2]; 3] = [[210.0, 297.0], [297.0, 210.0], [420.0, 297.0]];

impl Sheet {
    /// A sheet of A4, upright.
    #[must_use]
    pub fn a4(title: &str) -> Self {
        Self::holding(title, [0.0; 2])
    }

    /// The smallest sheet that a printer has and that holds this width and height \[mm\]; one of that very size where
    /// none does.
    #[must_use]
    pub fn holding(title: &str, [width, height]: [f64; 2]) -> Self {
        let holds = |size: &&[f64; 2]| width <= size[0] && height <= size[1];
        let size = SIZES.iter().find(holds).copied().unwrap_or([width.ceil(), height.ceil()]);
        Self { title: title.to_owned(), size, marks: Vec::new() }
    }

    /// Its heading.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Width and height \[mm\].
    #[must_use]
    pub const fn size(&self) -> [f64; 2] {
        self.size
    }

    /// A line.
    pub fn line(&mut self, pen: Pen, from: [f64; 2], to: [f64; 2]) {
        self.path(pen, "", false, false, vec![from, to]);
    }

    /// A line with a name, by which a program finds it in the SVG (`id`).
    pub fn named_line(&mut self, pen: Pen, name: &str, from: [f64; 2], to: [f64; 2]) {
        self.path(pen, name, false, false, vec![from, to]);
    }

    /// A line from point to point.
    pub fn curve(&mut self, pen: Pen, points: impl IntoIterator<Item = [f64; 2]>) {
        self.path(pen, "", false, false, points.into_iter().collect());
    }

    /// A closed line with a name, by which a program finds it in the SVG (`id`); nothing for none.
    pub fn polygon(&mut self, pen: Pen, name: &str, corners: impl IntoIterator<Item = [f64; 2]>) {
        self.path(pen, name, true, false, corners.into_iter().collect());
    }

    /// A closed shape filled with black: the head of an arrow, the bar of a ruler.
    pub fn filled(&mut self, corners: impl IntoIterator<Item = [f64; 2]>) {
        self.path(Pen::Thin, "", true, true, corners.into_iter().collect());
    }

    fn path(&mut self, pen: Pen, name: &str, closed: bool, filled: bool, points: Vec<[f64; 2]>) {
        self.marks.push(Mark::Path { pen, name: name.to_owned(), closed, filled, points });
    }

    /// A circle; its name is as that of a [`polygon`](Self::polygon).
    pub fn circle(&mut self, pen: Pen, name: &str, centre: [f64; 2], radius: f64) {
        self.marks.push(Mark::Circle { pen, name: name.to_owned(), centre, radius });
    }

    /// A line of text on this baseline, with letters of this size \[mm\].
    pub fn text(&mut self, at: [f64; 2], size: f64, anchor: Anchor, text: &str) {
        self.marks.push(Mark::Text { at, size, anchor, text: text.to_owned() });
    }

    /// The heading in large letters, and lines of text below it; gives the place below.
    pub fn heading(&mut self, left: f64, top: f64, lines: &[String]) -> f64 {
        let title = self.title.clone();
        self.text([left, top + 5.0], 5.0, Anchor::Start, &title);
        let mut below = top + 11.0;
        for line in lines {
            self.text([left, below], 3.0, Anchor::Start, line);
            below += 4.5;
        }
        below
    }
}
