//! The report as Markdown and as a page.

use std::path::Path;

use plotters::prelude::{
    BLACK, BLUE, ChartBuilder, Circle, Color, EmptyElement, GREEN, IntoDrawingArea, IntoFont, IntoLogRange,
    LineSeries, MAGENTA, PathElement, RED, RGBColor, SVGBackend, SeriesLabelPosition, Text, WHITE,
};

use fingertip_calibration::page::{self, Figure};

use crate::Failure;

const COLOURS: [RGBColor; 5] = [RED, BLUE, GREEN, MAGENTA, BLACK];

/// The ranges of a plot; x is logarithmic, y where wanted.
pub(crate) struct Scale {
    pub(crate) x: core::ops::Range<f64>,
    pub(crate) y: core::ops::Range<f64>,
    pub(crate) logarithmic: bool,
}

/// A line of a plot: points with what to write beside them.
pub(crate) struct Series {
    pub(crate) name: &'static str,
    pub(crate) points: Vec<(f64, f64, Option<f64>)>,
}

/// Headings, paragraphs, tables and plots in the order in which they were said.
#[derive(Default)]
pub(crate) struct Page {
    markdown: String,
    plots: Vec<(String, String)>,
}

impl Page {
    /// Markdown, of which headings, tables and paragraphs of one line are understood.
    pub(crate) fn say(&mut self, markdown: &str) {
        self.markdown += markdown;
        self.markdown += "\n";
    }

    pub(crate) fn plot(
        &mut self,
        file: &str,
        title: &str,
        x: &str,
        y: &str,
        scale: Scale,
        series: &[Series],
    ) -> Result<(), Failure> {
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, (760, 440)).into_drawing_area();
            area.fill(&WHITE)?;
            // A macro, since the kind of axis is part of the chart's type.
            macro_rules! draw {
                ($range:expr) => {
                    let mut chart = ChartBuilder::on(&area)
                        .margin(12)
                        .margin_right(24)
                        .x_label_area_size(44)
                        .y_label_area_size(64)
                        .build_cartesian_2d(scale.x.clone().log_scale(), $range)?;
                    chart
                        .configure_mesh()
                        .light_line_style(WHITE)
                        .label_style(("sans-serif", 13))
                        .axis_desc_style(("sans-serif", 14))
                        .x_desc(x)
                        .y_desc(y)
                        .x_label_formatter(&|x| plain(*x))
                        .y_label_formatter(&|y| plain(*y))
                        .draw()?;
                    for (line, colour) in series.iter().zip(COLOURS) {
                        let points = || line.points.iter().map(|p| (p.0, p.1.min(scale.y.end)));
                        chart
                            .draw_series(LineSeries::new(points(), colour.stroke_width(2)))?
                            .label(line.name)
                            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour));
                        chart.draw_series(points().map(|p| Circle::new(p, 3, colour.filled())))?;
                        let label = ("sans-serif", 13).into_font().color(&BLACK);
                        chart.draw_series(line.points.iter().filter_map(|p| {
                            let text = p.2?.to_string();
                            Some(EmptyElement::at((p.0, p.1)) + Text::new(text, (7, -14), label.clone()))
                        }))?;
                    }
                    if series.len() > 1 {
                        chart
                            .configure_series_labels()
                            .position(SeriesLabelPosition::LowerRight)
                            .background_style(WHITE)
                            .border_style(BLACK)
                            .label_font(("sans-serif", 13))
                            .draw()?;
                    }
                };
            }
            if scale.logarithmic {
                draw!(scale.y.clone().log_scale());
            } else {
                draw!(scale.y.clone());
            }
            area.present()?;
        }
        self.say(&format!("\n![{title}]({file}.svg)\n"));
        self.plots.push((format!("{file}.svg"), svg));
        Ok(())
    }

    pub(crate) fn markdown(&self) -> &str {
        &self.markdown
    }

    /// Writes the page and its plots.
    pub(crate) fn write(&self, folder: &Path) -> Result<(), Failure> {
        std::fs::write(folder.join("slip.html"), self.html())?;
        std::fs::write(folder.join("slip.md"), &self.markdown)?;
        for (name, svg) in &self.plots {
            std::fs::write(folder.join(name), svg)?;
        }
        Ok(())
    }

    /// A plot with its title, for a line `![title](file)`.
    fn figure(&self, line: &str) -> Option<Figure> {
        let (title, rest) = line.strip_prefix("![")?.split_once("](")?;
        let (_, svg) = self.plots.iter().find(|(name, _)| Some(name.as_str()) == rest.strip_suffix(')'))?;
        Some(Figure { title: title.to_owned(), svg: svg.clone(), on_white: true, ..Figure::default() })
    }

    /// Markdown tables, headings, plots and paragraphs as a page.
    fn html(&self) -> String {
        let mut page = page::Page::new("Slip detectors");
        let mut rows: Vec<Vec<String>> = Vec::new();
        // The empty line at the end closes a table that the text ends with.
        for line in self.markdown.lines().chain([""]) {
            if let Some(cells) = line.strip_prefix("| ") {
                rows.push(
                    cells.trim_end_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect(),
                );
                continue;
            }
            if line.starts_with("|---") {
                continue;
            }
            if let Some((head, rows)) = rows.split_first() {
                page.table(&page::Table { title: "", head, rows, words: true });
            }
            rows.clear();
            if let Some(title) = line.strip_prefix("## ") {
                page.heading(title);
            } else if let Some(figure) = self.figure(line) {
                page.figure(&figure);
            } else if !line.is_empty() && !line.starts_with("# ") {
                page.paragraph(line);
            }
        }
        page.finish("")
    }
}

/// Short numbers as they are, long ones as powers.
fn plain(x: f64) -> String {
    if x == 0.0 || (1e-2..1e4).contains(&x.abs()) {
        format!("{}", (x * 1e6).round() / 1e6)
    } else {
        format!("{x:.0e}")
    }
}
