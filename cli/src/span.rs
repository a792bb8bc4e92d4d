//! What lies between two times of a recording.

use std::path::Path;

use clap::Args;

use crate::error::CliError;

/// `--start` and `--end`: a row at either edge is within.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct Span {
    /// Leave out what comes before so many seconds behind the first row; a rest that a scene states is taken as ever
    #[arg(long, value_name = "SECONDS")]
    pub(crate) start: Option<f64>,
    /// Leave out what comes later than so many seconds behind the first row
    #[arg(long, value_name = "SECONDS")]
    pub(crate) end: Option<f64>,
}

/// Where a row lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Place {
    #[default]
    Before,
    Within,
    Behind,
}

impl Span {
    pub(crate) fn check(&self) -> Result<(), CliError> {
        for (name, time) in [("--start", self.start), ("--end", self.end)] {
            if let Some(time) = time.filter(|time| !(*time >= 0.0 && time.is_finite())) {
                return Err(CliError::option(name, time, "must be a number of seconds behind the first row"));
            }
        }
        match (self.start, self.end) {
            (Some(start), Some(end)) if end < start => {
                Err(CliError::option("--end", end, "must not be before --start"))
            }
            _ => Ok(()),
        }
    }

    /// Refuses a part of a recording that tells no times.
    pub(crate) fn needs_time(&self, has_time: bool) -> Result<(), CliError> {
        let given = [("--start", self.start), ("--end", self.end)];
        match given.into_iter().find_map(|(name, time)| Some((name, time?))) {
            Some((name, time)) if !has_time => {
                Err(CliError::option(name, time, "needs a recording with a column of time (t_s), or --rate"))
            }
            _ => Ok(()),
        }
    }

    /// What the reader of the results should know.
    pub(crate) fn note(&self) -> Option<String> {
        let (start, end) = (self.start, self.end);
        let told = match (start, end) {
            (None, None) => return None,
            (Some(start), None) => format!("from {start} s"),
            (None, Some(end)) => format!("up to {end} s"),
            (Some(start), Some(end)) => format!("from {start} s to {end} s"),
        };
        Some(format!("only what was recorded {told} behind the first row"))
    }
}

/// Follows the times of the rows.
#[derive(Debug, Default)]
pub(crate) struct Window {
    span: Span,
    first: Option<f64>,
    place: Place,
}

impl Window {
    pub(crate) fn new(span: Span) -> Self {
        Self { span, ..Self::default() }
    }

    /// The time that ended it \[s\], if a row came behind it.
    pub(crate) fn end(&self) -> Option<f64> {
        self.span.end.filter(|_| self.place == Place::Behind)
    }

    /// Why nothing of the recording is left: it ends before the part that is wanted, has a gap there, or no rows at all.
    pub(crate) fn nothing_of(&self, recording: &Path) -> CliError {
        let gap = "has no row between itself and --end: the recording has a gap there";
        match (self.span.start.filter(|_| self.first.is_some()), self.end()) {
            (Some(start), Some(_)) => CliError::option("--start", start, gap),
            (Some(start), None) => {
                CliError::option("--start", start, "must be before the end of the recording")
            }
            _ => CliError::NoRows { path: recording.to_owned() },
        }
    }

    /// Where a row of this time \[s\] lies; one without a time lies where the row before did.
    #[inline]
    pub(crate) fn place(&mut self, time: f64) -> Place {
        if time.is_finite() {
            let first = *self.first.get_or_insert(time);
            let (passed, slack) = (time - first, rounding(time, first));
            self.place = if self.span.start.is_some_and(|start| passed < start - slack(start)) {
                Place::Before
            } else if self.span.end.is_some_and(|end| passed > end + slack(end)) {
                Place::Behind
            } else {
                Place::Within
            };
        } else if self.first.is_none() && self.span.start.is_none() {
            self.place = Place::Within;
        }
        self.place
    }
}

/// How far the difference of two times \[s\] may be from an edge \[s\] that its decimal digits are those of.
///
/// As binary numbers 1.3 − 1 is less than 0.3, and 5.4 − 5.1 more: a row at the edge would be left out or not by chance. With
/// u = ε/2, a time of a file is wrong by u|t|, and by 2u|t| more where its unit is another than the second; the difference by
/// u(|t| + |first|), and the edge by u·edge. So 2ε(|t| + |first| + edge) is beyond what rounding can do: 2 µs for times since
/// 1970, 3e-12 s in the first hour.
fn rounding(time: f64, first: f64) -> impl Fn(f64) -> f64 {
    move |edge| 2.0 * f64::EPSILON * (time.abs() + first.abs() + edge)
}

#[cfg(test)]
mod tests {
    use super::{Place, Span, Window, rounding};

    #[test]
    fn rows_lie_before_within_or_behind() {
        let places = |start, end, times: &[f64]| -> Vec<Place> {
            let mut window = Window::new(Span { start, end });
            times.iter().map(|time| window.place(*time)).collect()
        };
        use Place::{Before, Behind, Within};
        let times = [5.0, 6.0, f64::NAN, 7.0, 8.0, f64::NAN, 9.0];
        assert_eq!(places(None, None, &times), [Within; 7]);
        assert_eq!(
            places(Some(2.0), Some(3.0), &times),
            [Before, Before, Before, Within, Within, Within, Behind]
        );
        assert_eq!(places(Some(2.0), None, &[f64::NAN, 1.0, 3.0]), [Before, Before, Within]);
        assert_eq!(places(None, Some(1.0), &[f64::NAN, 1.0, 3.0]), [Within, Within, Behind]);
    }

    /// Rows at every hundredth of a second, from a start that is no sum of powers of two, in seconds or in milliseconds:
    /// the row whose digits are those of an edge is within, and that before it or behind it is not, however they are rounded.
    #[test]
    fn an_edge_is_met_by_the_row_whose_digits_it_has() {
        let hundredths = |count: i64| format!("{}.{:02}", count / 100, count % 100);
        let (mut less, mut more) = (0, 0);
        for first in [0_i64, 10, 510, 123_457, 176_000_000_011] {
            for in_milliseconds in [false, true] {
                let of = |count: i64| -> f64 {
                    if in_milliseconds {
                        (10 * (first + count)).to_string().parse::<f64>().unwrap() * 1e-3
                    } else {
                        hundredths(first + count).parse().unwrap()
                    }
                };
                for at in 1..300 {
                    let edge: f64 = hundredths(at).parse().unwrap();
                    let place = |start, end, time| {
                        let mut window = Window::new(Span { start, end });
                        window.place(of(0));
                        window.place(time)
                    };
                    for (start, end) in [(Some(edge), None), (None, Some(edge)), (Some(edge), Some(edge))] {
                        assert_eq!(place(start, end, of(at)), Place::Within, "{first} {edge}");
                    }
                    assert_eq!(place(Some(edge), None, of(at - 1)), Place::Before, "{first} {edge}");
                    assert_eq!(place(None, Some(edge), of(at + 1)), Place::Behind, "{first} {edge}");
                    less += u32::from(of(at) - of(0) < edge);
                    more += u32::from(of(at) - of(0) > edge);
                }
            }
        }
        assert!(less > 500 && more > 500, "binary numbers alone would miss many rows: {less} and {more}");
    }

    #[test]
    fn a_span_of_one_instant_is_one_and_none_ends_before_it_starts() {
        let checked = |start, end| {
            Span { start: Some(start), end: Some(end) }.check().map_err(|error| error.to_string())
        };
        assert_eq!((checked(1.0, 1.0), checked(0.0, 0.0)), (Ok(()), Ok(())));
        assert_eq!(checked(1.0, 0.5), Err("--end 0.5 must not be before --start".to_owned()));
        let no_time = "must be a number of seconds behind the first row";
        assert_eq!(checked(-1.0, 2.0), Err(format!("--start -1 {no_time}")));
        assert_eq!(checked(1.0, f64::INFINITY), Err(format!("--end inf {no_time}")));
    }

    #[test]
    fn what_rounding_can_do_is_little() {
        assert!(rounding(3600.0, 0.0)(10.0) < 4e-12 && rounding(1.76e9, 1.76e9)(10.0) < 2e-6);
        assert!(rounding(1.3, 1.0)(0.3) > 2.0 * f64::EPSILON && rounding(f64::MAX, f64::MAX)(0.0) > 0.0);
    }
}
