//! Scales and ticks.

use super::Counting;

/// How values become places along an axis.
///
/// ```
/// use fingertip_calibration::page::{Axis, Scale};
///
/// // From 0.1 N to 10 N: on a logarithmic axis 1 N is in the middle, on a linear one near the beginning.
/// let log = Axis::log("F / N", 0.1, 10.0);
/// assert_eq!(log.scale, Scale::Log);
/// assert!((log.place(1.0) - 0.5).abs() < 1e-12);
/// assert!((Axis::linear("F / N", 0.1, 10.0).place(1.0) - 0.9 / 9.9).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// As linear, with ticks at parts of the circle.
    Degrees,
    /// Decades; values that are not positive lie at the low end.
    Log,
}

/// The range of an axis and what it says.
///
/// ```
/// use fingertip_calibration::page::Axis;
///
/// let axis = Axis::linear("time / s", 0.0, 30.0);
/// let labels: Vec<String> = axis.ticks(3).into_iter().map(|tick| tick.label).collect();
/// assert_eq!((labels.join(" "), axis.place(15.0)), ("0 10 20 30".to_owned(), 0.5));
/// ```
#[derive(Clone, Debug)]
pub struct Axis {
    /// `quantity / unit`, or a quantity without one.
    pub label: String,
    /// Where it begins.
    pub low: f64,
    /// Where it ends.
    pub high: f64,
    /// How values become places.
    pub scale: Scale,
}

/// One mark along an axis.
///
/// ```
/// use fingertip_calibration::page::{Axis, Tick};
///
/// let ticks: Vec<Tick> = Axis::degrees("turn", 0.0, 180.0).ticks(4);
/// // At parts of the circle.
/// assert!(ticks.iter().any(|tick| tick.value == 90.0) && ticks.iter().all(|tick| tick.value % 15.0 == 0.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Where it is.
    pub value: f64,
    /// What stands beside it.
    pub label: String,
}

impl Axis {
    /// From `low` to `high`, widened where they coincide.
    #[must_use]
    pub fn linear(label: &str, low: f64, high: f64) -> Self {
        let (low, high) = if low.is_finite() && high.is_finite() { (low, high) } else { (0.0, 1.0) };
        let (low, high) = if high > low {
            (low, high)
        } else {
            let room = if low.abs() > 0.0 { 0.5 * low.abs() } else { 1.0 };
            (low - room, low + room)
        };
        Self { label: label.to_owned(), low, high, scale: Scale::Linear }
    }

    /// An angle in degrees.
    #[must_use]
    pub fn degrees(label: &str, low: f64, high: f64) -> Self {
        Self { scale: Scale::Degrees, ..Self::linear(label, low, high) }
    }

    /// As [`linear`](Self::linear), moved outward to the next ticks.
    #[must_use]
    pub fn rounded(label: &str, low: f64, high: f64) -> Self {
        let axis = Self::linear(label, low, high);
        let step = step(axis.high - axis.low, 5);
        Self { low: (axis.low / step).floor() * step, high: (axis.high / step).ceil() * step, ..axis }
    }

    /// A logarithmic axis over at least one decade of positive numbers.
    #[must_use]
    pub fn log(label: &str, low: f64, high: f64) -> Self {
        let good = low > 0.0 && high >= low && high.is_finite();
        let (low, high) = if good { (low, high) } else { (0.1, 1.0) };
        let middle = (low * high).sqrt();
        let (low, high) = (low.min(middle / 10.0_f64.sqrt()), high.max(middle * 10.0_f64.sqrt()));
        Self { label: label.to_owned(), low, high, scale: Scale::Log }
    }

    /// For the page's script: `label;low;high`, and `;log` for decades.
    #[must_use]
    pub fn in_words(&self) -> String {
        let decades = if self.scale == Scale::Log { ";log" } else { "" };
        let [low, high] = [self.low, self.high].map(|end| digits(self.counting().said(end)));
        format!("{};{low};{high}{decades}", self.title())
    }

    /// The label, with what the numbers of the ticks are counted from and in.
    #[must_use]
    pub fn title(&self) -> String {
        self.counting().title(&self.label)
    }

    /// Decades need no help to be short.
    fn counting(&self) -> Counting {
        if self.scale == Scale::Log { Counting::PLAIN } else { Counting::of(self.low, self.high) }
    }

    /// Where a value lies: 0 at the low end, 1 at the high end, limited to a little beyond.
    #[must_use]
    pub fn place(&self, value: f64) -> f64 {
        let place = match self.scale {
            Scale::Linear | Scale::Degrees => (value - self.low) / (self.high - self.low),
            Scale::Log => (value.max(self.low * 1e-3) / self.low).ln() / (self.high / self.low).ln(),
        };
        place.clamp(-1.0, 2.0)
    }

    /// At most about `most` ticks at round values within the range.
    #[must_use]
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        match self.scale {
            Scale::Linear => self.linear_ticks(step(self.high - self.low, most), most),
            Scale::Degrees => {
                let range = self.high - self.low;
                let parts = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0];
                let fits = |part: &f64| *part * most as f64 >= range;
                let fine = range < most as f64;
                let part = parts.into_iter().filter(|_| !fine).find(fits);
                self.linear_ticks(part.unwrap_or_else(|| step(range, most)), most)
            }
            Scale::Log => self.log_ticks(most),
        }
    }

    /// The same, with their places in a drawing and what they say.
    #[must_use]
    pub fn placed_ticks(&self, most: usize, place: impl Fn(f64) -> f64) -> Vec<(f64, String)> {
        self.ticks(most).into_iter().map(|tick| (place(tick.value), tick.label)).collect()
    }

    fn linear_ticks(&self, step: f64, most: usize) -> Vec<Tick> {
        let slack = 1e-9 * step;
        let first = ((self.low - slack) / step).ceil();
        let counting = self.counting();
        (0..=2 * most)
            .map(|i| (first + i as f64) * step)
            .take_while(|value| *value <= self.high + slack)
            .map(|value| {
                // Minus zero, and what is left of zero by rounding.
                let value = if value.abs() < slack { 0.0 } else { value };
                Tick { value, label: counting.label(value, step) }
            })
            .collect()
    }

    fn log_ticks(&self, most: usize) -> Vec<Tick> {
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let within = |value: &f64| *value >= self.low * 0.999 && *value <= self.high * 1.001;
        let of = |leads: &[f64]| -> Vec<f64> {
            (first..=last)
                .flat_map(|exponent| leads.iter().map(move |lead| lead * 10.0_f64.powi(exponent)))
                .filter(within)
                .collect()
        };
        let fine = of(&[1.0, 2.0, 5.0]);
        let values = if fine.len() <= most { fine } else { of(&[1.0]) };
        // Of more decades every second, third and so on.
        let every = values.len().div_ceil(most + 2);
        values
            .into_iter()
            .step_by(every.max(1))
            .map(|value| Tick { value, label: of_decade(value) })
            .collect()
    }
}

/// The 1, 2 or 5 times a power of ten that cuts `range` into at most `most` pieces.
fn step(range: f64, most: usize) -> f64 {
    let rough = range / most.max(1) as f64;
    let decade = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|lead| lead * decade)
        .find(|step| *step >= rough * 0.999_999)
        .unwrap_or(rough);
    if step > 0.0 && step.is_finite() { step } else { 1.0 }
}

/// Six digits, which no drawing shows.
fn digits(value: f64) -> String {
    if value.abs() > 0.0 {
        let places = (5.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
        format!("{value:.places$}")
    } else {
        "0".to_owned()
    }
}

/// A 1, 2 or 5 with its power of ten.
fn of_decade(value: f64) -> String {
    if (1e-4..1e6).contains(&value) { format!("{value}") } else { format!("{value:.0e}").replace('-', "−") }
}

#[cfg(test)]
#[path = "axis_tests.rs"]
mod tests;
