//! Sheets as pages of a PDF.

use pdf_writer::{Content, Name, Pdf, Rect, Ref, Str, TextStr};

use super::letters::{letter, width};
use super::{Anchor, Mark, Pen, Sheet};

/// Points of a PDF in a millimetre.
const POINTS: f64 = 72.0 / 25.4;
/// Where the points that lead a cubic lie on the way round a quarter of a circle; off by 0.03 % at most.
const QUARTER: f64 = 0.552_284_75;
/// The font, which every reader has.
const FONT: Name<'_> = Name(b"H");

/// One PDF of these sheets, each a page of its size. Readers that know the wish do not scale it when they print.
#[must_use]
pub fn pdf(sheets: &[Sheet]) -> Vec<u8> {
    let mut free = 0;
    let mut next = || {
        free += 1;
        Ref::new(free)
    };
    let (catalog, tree, font, info) = (next(), next(), next(), next());
    let pages: Vec<(Ref, Ref, &Sheet)> = sheets.iter().map(|sheet| (next(), next(), sheet)).collect();
    let mut pdf = Pdf::new();
    {
        let mut root = pdf.catalog(catalog);
        root.pages(tree);
        root.viewer_preferences().pair(Name(b"PrintScaling"), Name(b"None"));
    }
    if let Some(first) = sheets.first() {
        pdf.document_info(info).title(TextStr(first.title()));
    }
    let count = i32::try_from(pages.len()).unwrap_or(i32::MAX);
    pdf.pages(tree).kids(pages.iter().map(|(page, ..)| *page)).count(count);
    pdf.type1_font(font).base_font(Name(b"Helvetica")).encoding_predefined(Name(b"WinAnsiEncoding"));
    for (id, content, sheet) in pages {
        let [width, height] = sheet.size.map(|length| (length * POINTS) as f32);
        {
            let mut page = pdf.page(id);
            page.media_box(Rect::new(0.0, 0.0, width, height)).parent(tree).contents(content);
            page.resources().fonts().pair(FONT, font);
        }
        pdf.stream(content, &drawn(sheet));
    }
    pdf.finish()
}

/// What a page draws: in millimetres, from the lower left corner.
fn drawn(sheet: &Sheet) -> Vec<u8> {
    let height = sheet.size[1];
    let up = |[x, y]: [f64; 2]| (x as f32, (height - y) as f32);
    let mut content = Content::new();
    content.transform([POINTS as f32, 0.0, 0.0, POINTS as f32, 0.0, 0.0]);
    for mark in &sheet.marks {
        match mark {
            Mark::Path { pen, closed, filled, points, .. } => {
                take(*pen, &mut content);
                for (place, point) in points.iter().enumerate() {
                    let (x, y) = up(*point);
                    if place == 0 {
                        content.move_to(x, y)
                    } else {
                        content.line_to(x, y)
                    };
                }
                match (closed, filled) {
                    (_, true) => content.close_fill_nonzero_and_stroke(),
                    (true, false) => content.close_and_stroke(),
                    (false, false) => content.stroke(),
                };
            }
            Mark::Circle { pen, centre: [x, y], radius, .. } => {
                take(*pen, &mut content);
                let at = |across: f64, down: f64| up([x + across * radius, y + down * radius]);
                let (x, y) = at(1.0, 0.0);
                content.move_to(x, y);
                let quarters = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
                for (number, (c, s)) in quarters.into_iter().enumerate() {
                    let (c2, s2) = quarters[(number + 1) % 4];
                    let (x1, y1) = at(c + QUARTER * c2, s + QUARTER * s2);
                    let (x2, y2) = at(c2 + QUARTER * c, s2 + QUARTER * s);
                    let (x3, y3) = at(c2, s2);
                    content.cubic_to(x1, y1, x2, y2, x3, y3);
                }
                content.close_and_stroke();
            }
            Mark::Text { at, size, anchor, text } => {
                let back = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => 0.5,
                    Anchor::End => 1.0,
                };
                let (x, y) = up([at[0] - back * width(text, *size), at[1]]);
                let codes: Vec<u8> = text.chars().map(|c| letter(c).0).collect();
                content.begin_text().set_font(FONT, *size as f32).set_text_matrix([1.0, 0.0, 0.0, 1.0, x, y]);
                content.show(Str(&codes)).end_text();
            }
        }
    }
    content.finish().into_vec()
}

fn take(pen: Pen, content: &mut Content) {
    content.set_line_width(pen.width() as f32);
    let dashes = pen.dashes().map(|dashes| dashes.map(|length| length as f32));
    content.set_dash_pattern(dashes.into_iter().flatten(), 0.0);
}
