//! A sheet as SVG.

use core::fmt::Write as _;

use maud::Escaper;

use super::{Anchor, Mark, Sheet};

impl Sheet {
    /// SVG that prints at its size: millimetres are millimetres.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let [width, height] = self.size;
        self.svg(&format!(" width=\"{width}mm\" height=\"{height}mm\""))
    }

    /// SVG that is as wide as the page that it stands on.
    #[must_use]
    pub fn to_figure(&self) -> String {
        self.svg("")
    }

    fn svg(&self, how: &str) -> String {
        let [width, height] = self.size;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\"{how} viewBox=\"0 0 {width} {height}\" role=\"img\" \
             fill=\"none\" stroke=\"#000\" stroke-linejoin=\"miter\" font-family=\"Helvetica, Arial, sans-serif\"><title>"
        );
        escape(&self.title, &mut svg);
        svg.push_str("</title>\n");
        for mark in &self.marks {
            mark_svg(mark, &mut svg);
            svg.push('\n');
        }
        svg.push_str("</svg>\n");
        svg
    }
}

/// Writing to a String cannot fail.
fn mark_svg(mark: &Mark, svg: &mut String) {
    match mark {
        Mark::Path { pen, name, closed, filled, points } => {
            svg.push_str("<path");
            id(name, svg);
            let _ = write!(svg, " stroke-width=\"{}\"", pen.width());
            if let Some([dash, gap]) = pen.dashes() {
                let _ = write!(svg, " stroke-dasharray=\"{dash} {gap}\"");
            }
            if *filled {
                svg.push_str(" fill=\"#000\"");
            }
            svg.push_str(" d=\"");
            for (place, [x, y]) in points.iter().enumerate() {
                let command = if place == 0 { 'M' } else { 'L' };
                let _ = write!(svg, "{command}{x:.4} {y:.4}");
            }
            svg.push_str(if *closed { "Z\"/>" } else { "\"/>" });
        }
        Mark::Circle { pen, name, centre: [x, y], radius } => {
            svg.push_str("<circle");
            id(name, svg);
            let _ = write!(
                svg,
                " stroke-width=\"{}\" cx=\"{x:.4}\" cy=\"{y:.4}\" r=\"{radius:.4}\"",
                pen.width()
            );
            if let Some([dash, gap]) = pen.dashes() {
                let _ = write!(svg, " stroke-dasharray=\"{dash} {gap}\"");
            }
            svg.push_str("/>");
        }
        Mark::Text { at: [x, y], size, anchor, text } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let _ = write!(
                svg,
                "<text x=\"{x:.4}\" y=\"{y:.4}\" font-size=\"{size}\" fill=\"#000\" stroke=\"none\" text-anchor=\"{anchor}\">"
            );
            escape(text, svg);
            svg.push_str("</text>");
        }
    }
}

fn id(name: &str, svg: &mut String) {
    if !name.is_empty() {
        svg.push_str(" id=\"");
        escape(name, svg);
        svg.push('"');
    }
}

fn escape(text: &str, svg: &mut String) {
    let _ = Escaper::new(svg).write_str(text);
}
