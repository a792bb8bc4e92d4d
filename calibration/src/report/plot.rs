//! The plots of a report, as SVG.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Report, SampleReport};
use crate::page::{Counting, Placed, text_width};

const WIDTH: u32 = 480;
const HEIGHT: u32 = 300;
/// Room around what is drawn: at the edges, for the numbers across and for those upwards.
const MARGIN: u32 = 8;
const BELOW: u32 = 44;
const BESIDE: u32 = 64;
/// What is plotted: across, and downwards.
const PLOTTED: (u32, u32) = (WIDTH - 2 * MARGIN - BESIDE, HEIGHT - 2 * MARGIN - BELOW);
/// Letters of the ticks and of the names of samples.
const TICK: f64 = 14.0;
const NAME: f64 = 13.0;
/// Longer names of samples are cut.
const LONGEST_NAME: usize = 24;

/// Of the fit.
pub(super) const FITTED: RGBColor = RGBColor(9, 105, 218);
/// Of the loads that were left out of the fit.
pub(super) const LEFT_OUT: RGBColor = RGBColor(207, 34, 46);

impl Report {
    /// Error, % of full scale, over the applied load: points of the fit, and of the loads left out.
    #[must_use]
    pub fn error_over_load(&self, axis: usize) -> Option<String> {
        let report = self.axes.get(axis)?;
        let label = format!("{} / {}", report.axis, report.axis.unit());
        self.plot(axis, &label, |_, sample| sample.applied.get(axis).copied())
    }

    /// Error, % of full scale, in the order of the samples.
    #[must_use]
    pub fn error_over_samples(&self, axis: usize) -> Option<String> {
        self.plot(axis, "sample", |index, _| Some(index as f64 + 1.0))
    }

    fn plot(
        &self,
        axis: usize,
        label: &str,
        position: impl Fn(usize, &SampleReport) -> Option<f64>,
    ) -> Option<String> {
        let full_scale = self.axes.get(axis)?.full_scale;
        let (mut fitted, mut left_out) = (Vec::new(), Vec::new());
        for (index, sample) in self.details.iter().enumerate() {
            let (x, applied) = (position(index, sample)?, *sample.applied.get(axis)?);
            let percent = |value: f64| 100.0 * (value - applied) / full_scale;
            fitted.push((x, percent(*sample.measured.get(axis)?)));
            if let Some(value) = sample.left_out.as_ref().and_then(|load| load.get(axis)) {
                left_out.push((x, percent(*value)));
            }
        }
        let all = || fitted.iter().chain(&left_out);
        // A maximum passes over NaN.
        if fitted.is_empty() || !all().all(|(x, error)| x.is_finite() && error.is_finite()) {
            return None;
        }
        let least = all().map(|p| p.0).fold(f64::INFINITY, f64::min);
        let most = all().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
        let error = all().map(|p| p.1.abs()).fold(0.0, f64::max);
        let margin = if most > least { 0.05 * (most - least) } else { 1.0 };
        let error = if error > 0.0 { 1.1 * error } else { 1.0 };
        let mut svg = String::new();
        let outliers = self.outlier_places(axis, &position, full_scale);
        let chart = Chart { label, error, fitted: &fitted, left_out: &left_out, outliers: &outliers };
        chart.draw(&mut svg, (least - margin, most + margin)).ok()?;
        Some(svg)
    }

    /// Name and place of the samples that do not fit the others, which plots label.
    fn outlier_places(
        &self,
        axis: usize,
        position: &impl Fn(usize, &SampleReport) -> Option<f64>,
        full_scale: f64,
    ) -> Vec<(String, (f64, f64))> {
        let named = |name: &str| self.outliers.iter().any(|outlier| outlier.sample == name);
        let place = |(index, sample): (usize, &SampleReport)| {
            let error = sample.measured.get(axis)? - sample.applied.get(axis)?;
            Some((sample.name.clone(), (position(index, sample)?, 100.0 * error / full_scale)))
        };
        self.details.iter().enumerate().filter(|(_, sample)| named(&sample.name)).filter_map(place).collect()
    }
}

type Failure = Box<dyn core::error::Error>;

/// What a plot shows.
struct Chart<'a> {
    label: &'a str,
    /// Greatest error to show.
    error: f64,
    fitted: &'a [(f64, f64)],
    left_out: &'a [(f64, f64)],
    outliers: &'a [(String, (f64, f64))],
}

impl Chart<'_> {
    fn draw(&self, svg: &mut String, (least, most): (f64, f64)) -> Result<(), Failure> {
        let describe = |error: DrawingAreaErrorKind<_>| -> Failure { format!("{error}").into() };
        let area = SVGBackend::with_string(svg, (WIDTH, HEIGHT)).into_drawing_area();
        area.fill(&WHITE).map_err(describe)?;
        let mut chart = ChartBuilder::on(&area)
            .margin(MARGIN)
            .x_label_area_size(BELOW)
            .y_label_area_size(BESIDE)
            .build_cartesian_2d(least..most, -self.error..self.error)
            .map_err(describe)?;
        let (across, up) = (Counting::of(least, most), Counting::of(-self.error, self.error));
        chart
            .configure_mesh()
            .disable_x_mesh()
            .max_light_lines(0)
            .bold_line_style(RGBColor(225, 228, 232))
            .axis_style(RGBColor(110, 118, 129))
            .label_style(("sans-serif", TICK))
            .axis_desc_style(("sans-serif", 15))
            .x_labels(7)
            .y_labels(7)
            .x_label_formatter(&|value| tick(across.said(*value)))
            .y_label_formatter(&|value| tick(up.said(*value)))
            .x_desc(across.title(self.label))
            .y_desc(up.title("error / % of full scale"))
            .draw()
            .map_err(describe)?;
        let zero = [(least, 0.0), (most, 0.0)];
        chart
            .draw_series(LineSeries::new(zero, RGBColor(110, 118, 129).stroke_width(1)))
            .map_err(describe)?;
        let hollow = |point: &(f64, f64)| Circle::new(*point, 5, LEFT_OUT.stroke_width(1));
        chart.draw_series(self.left_out.iter().map(hollow)).map_err(describe)?;
        let solid = |point: &(f64, f64)| Circle::new(*point, 3, FITTED.filled());
        chart.draw_series(self.fitted.iter().map(solid)).map_err(describe)?;
        let dots: Vec<[f64; 2]> =
            self.fitted.iter().chain(self.left_out).map(|dot| self.pixel(*dot, (least, most))).collect();
        let mut placed = Placed::default();
        for (name, at) in self.outliers {
            let name = shortened(name);
            let Some(beside) = Beside::find(&name, self.pixel(*at, (least, most)), &dots, &mut placed) else {
                continue;
            };
            let anchor = if beside.to_the_right { HPos::Left } else { HPos::Right };
            let style = TextStyle::from(("sans-serif", NAME).into_font()).pos(Pos::new(anchor, VPos::Center));
            let mark = EmptyElement::at(*at) + Text::new(name, beside.shift(), style);
            chart.draw_series(core::iter::once(mark)).map_err(describe)?;
        }
        area.present().map_err(describe)?;
        Ok(())
    }

    /// Where a point is drawn, from the upper left corner of what is plotted.
    fn pixel(&self, (x, y): (f64, f64), (least, most): (f64, f64)) -> [f64; 2] {
        [
            f64::from(PLOTTED.0) * (x - least) / (most - least),
            f64::from(PLOTTED.1) * 0.5 * (1.0 - y / self.error),
        ]
    }
}

/// Where a name stands beside its dot.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Beside {
    to_the_right: bool,
    /// How far below the dot the middle of the name is.
    down: f64,
}

impl Beside {
    /// From the dot to the name.
    const GAP: f64 = 9.0;
    /// Half of the side of a dot, and some room.
    const DOT: f64 = 5.0;

    /// The first place that has room, towards the middle of the plot if that is one, and clear of all dots if any is;
    /// `None` if names stand everywhere.
    fn find(name: &str, at: [f64; 2], dots: &[[f64; 2]], placed: &mut Placed) -> Option<Self> {
        let inward = at[0] < 0.5 * f64::from(PLOTTED.0);
        let all = [0.0, -NAME, NAME]
            .into_iter()
            .flat_map(|down| [inward, !inward].map(|to_the_right| Self { to_the_right, down }));
        let room: Vec<(Self, [f64; 4])> = all
            .map(|beside| (beside, beside.taken(name, at)))
            .filter(|(_, [left, right, top, bottom])| {
                *left >= 0.0
                    && *right <= f64::from(PLOTTED.0)
                    && *top >= 0.0
                    && *bottom <= f64::from(PLOTTED.1)
            })
            .filter(|(_, taken)| placed.is_free(*taken))
            .collect();
        let is_clear = |(_, [left, right, top, bottom]): &&(Self, [f64; 4])| {
            let covers = |[x, y]: &[f64; 2]| {
                left - Self::DOT < *x
                    && *x < right + Self::DOT
                    && top - Self::DOT < *y
                    && *y < bottom + Self::DOT
            };
            !dots.iter().any(|dot| *dot != at && covers(dot))
        };
        let (beside, taken) = room.iter().find(is_clear).or_else(|| room.first())?;
        placed.take(*taken).then_some(*beside)
    }

    /// The box of a name here: left, right, top, bottom.
    fn taken(self, name: &str, [x, y]: [f64; 2]) -> [f64; 4] {
        let long = text_width(name, NAME);
        let left = if self.to_the_right { x + Self::GAP } else { x - Self::GAP - long };
        [left, left + long, y + self.down - 0.5 * NAME, y + self.down + 0.5 * NAME]
    }

    /// From the dot to the near end of the name, in its middle.
    const fn shift(self) -> (i32, i32) {
        let across = if self.to_the_right { Self::GAP } else { -Self::GAP };
        (across as i32, self.down as i32)
    }
}

/// A name that leaves room for others.
fn shortened(name: &str) -> String {
    match name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

/// A number as short as it can be; no zero has a sign.
fn tick(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == 0.0 { "0".to_owned() } else { format!("{rounded}").replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::{Beside, Chart, NAME, PLOTTED};
    use crate::page::{Placed, text_width};

    const WIDE: f64 = PLOTTED.0 as f64;
    const HIGH: f64 = PLOTTED.1 as f64;

    #[test]
    fn corners_of_the_plot_are_where_they_are_drawn() {
        let chart = Chart { label: "", error: 4.0, fitted: &[], left_out: &[], outliers: &[] };
        let corners = [
            ((10.0, 4.0), [0.0, 0.0]),
            ((30.0, -4.0), [WIDE, HIGH]),
            ((15.0, 2.0), [0.25 * WIDE, 0.25 * HIGH]),
        ];
        for (point, pixel) in corners {
            assert_eq!(chart.pixel(point, (10.0, 30.0)), pixel);
        }
    }

    fn found(at: [f64; 2], dots: &[[f64; 2]], placed: &mut Placed) -> Option<(bool, f64)> {
        Beside::find("a name", at, dots, placed).map(|beside| (beside.to_the_right, beside.down))
    }

    /// Names stand towards the middle, and turn where a dot, another name or the edge is in their way.
    #[test]
    fn names_keep_clear_of_dots_names_and_edges() {
        let new = Placed::default;
        let (left, right) = ([100.0, 100.0], [WIDE - 100.0, 100.0]);
        // The dot itself is in nobody's way.
        assert_eq!(found(left, &[left], &mut new()), Some((true, 0.0)));
        assert_eq!(found(right, &[right], &mut new()), Some((false, 0.0)));
        let beside = |right: f64, down: f64| [100.0 + right, 100.0 + down];
        let long = text_width("a name", NAME);
        for at in [beside(20.0, 4.0), beside(9.0 + long + 4.0, 0.0), beside(5.0, 0.0), beside(20.0, -11.0)] {
            assert_eq!(found(left, &[left, at], &mut new()), Some((false, 0.0)), "{at:?}");
        }
        for at in [beside(9.0 + long + 6.0, 0.0), beside(3.0, 0.0), beside(20.0, 12.0), beside(20.0, -12.0)] {
            assert_eq!(found(left, &[left, at], &mut new()), Some((true, 0.0)), "{at:?}");
        }
        // Of both sides: above, then below.
        let mut dots = vec![beside(20.0, 6.0), beside(-20.0, 6.0)];
        assert_eq!(found(left, &dots, &mut new()), Some((true, -NAME)));
        dots.extend([beside(20.0, -20.0), beside(-20.0, -20.0)]);
        dots.remove(0);
        assert_eq!(found(left, &[beside(20.0, -10.0), beside(-20.0, -10.0)], &mut new()), Some((true, NAME)));
        // Dots everywhere: over some of them rather than not at all.
        let everywhere: Vec<_> =
            (0..400).map(|i| beside(f64::from(i % 20 - 10) * 9.0, f64::from(i / 20 - 10) * 9.0)).collect();
        assert_eq!(found(left, &everywhere, &mut new()), Some((true, 0.0)));
        // Names in the way of names, until there is no room.
        let mut placed = new();
        let places: Vec<_> = (0..7).map_while(|_| found(left, &[], &mut placed)).collect();
        let all = [0.0, -NAME, NAME].map(|down| [(true, down), (false, down)]);
        assert_eq!(places, all.as_flattened());
        // At the edges.
        assert_eq!(found([5.0, 3.0], &[], &mut new()), Some((true, NAME)));
        assert_eq!(found([WIDE - 5.0, HIGH - 3.0], &[], &mut new()), Some((false, -NAME)));
    }
}
