//! What lies between two times of a recording.

use std::path::Path;

use clap::Args;

use crate::error::CliError;

/// `--start` and `--end`.
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
        match self.span.start.filter(|_| self.first.is_some()) {
            Some(start) if self.end().is_some() => CliError::option(
                "--start",
                start,
                "has no row between itself and --end: the recording has a gap there",
            ),
            Some(start) => CliError::option("--start", start, "must be before the end of the recording"),
            None => CliError::NoRows { path: recording.to_owned() },
        }
    }

    /// Where a row of this time \[s\] lies; one without a time lies where the row before did.
    #[inline]
    pub(crate) fn place(&mut self, time: f64) -> Place {
        if time.is_finite() {
            let passed = time - *self.first.get_or_insert(time);
            self.place = if self.span.start.is_some_and(|start| passed < start) {
                Place::Before
            } else if self.span.end.is_some_and(|end| passed > end) {
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

#[cfg(test)]
mod tests {
    use super::{Place, Span, Window};

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
}
