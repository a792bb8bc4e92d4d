//! Scales and ticks.

/// How values become places along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    Linear,
    /// As linear, with ticks at parts of the circle.
    Degrees,
    /// Decades; values that are not positive lie at the low end.
    Log,
}

/// The range of an axis and what it says.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    pub(crate) label: String,
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) scale: Scale,
}

/// One mark along an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: String,
}

impl Axis {
    /// From `low` to `high`, widened where they coincide.
    pub(crate) fn linear(label: &str, low: f64, high: f64) -> Self {
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
    pub(crate) fn degrees(label: &str, low: f64, high: f64) -> Self {
        Self { scale: Scale::Degrees, ..Self::linear(label, low, high) }
    }

    /// As [`linear`](Self::linear), moved outward to the next ticks.
    pub(crate) fn rounded(label: &str, low: f64, high: f64) -> Self {
        let axis = Self::linear(label, low, high);
        let step = step(axis.high - axis.low, 5);
        Self { low: (axis.low / step).floor() * step, high: (axis.high / step).ceil() * step, ..axis }
    }

    /// A logarithmic axis over at least one decade of positive numbers.
    pub(crate) fn log(label: &str, low: f64, high: f64) -> Self {
        let good = low > 0.0 && high >= low && high.is_finite();
        let (low, high) = if good { (low, high) } else { (0.1, 1.0) };
        let middle = (low * high).sqrt();
        let (low, high) = (low.min(middle / 10.0_f64.sqrt()), high.max(middle * 10.0_f64.sqrt()));
        Self { label: label.to_owned(), low, high, scale: Scale::Log }
    }

    /// Where a value lies: 0 at the low end, 1 at the high end, limited to a little beyond.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let place = match self.scale {
            Scale::Linear | Scale::Degrees => (value - self.low) / (self.high - self.low),
            Scale::Log => (value.max(self.low * 1e-3) / self.low).ln() / (self.high / self.low).ln(),
        };
        place.clamp(-1.0, 2.0)
    }

    /// At most about `most` ticks at round values within the range.
    pub(crate) fn ticks(&self, most: usize) -> Vec<Tick> {
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

    fn linear_ticks(&self, step: f64, most: usize) -> Vec<Tick> {
        let slack = 1e-9 * step;
        let first = ((self.low - slack) / step).ceil();
        let largest = self.low.abs().max(self.high.abs());
        (0..=2 * most)
            .map(|i| (first + i as f64) * step)
            .take_while(|value| *value <= self.high + slack)
            .map(|value| {
                // Minus zero, and what is left of zero by rounding.
                let value = if value.abs() < slack { 0.0 } else { value };
                Tick { value, label: tick_label(value, step, largest) }
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
        values.into_iter().map(|value| Tick { value, label: tick_label(value, value, value) }).collect()
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

fn tick_label(value: f64, step: f64, largest: f64) -> String {
    if largest >= 1e6 || step < 1e-4 {
        return if value.abs() > 0.0 { format!("{value:e}") } else { "0".to_owned() };
    }
    // A hair more than the step, so that 0.1 counts as one decimal.
    let decimals = (-(step * 1.000_001).log10()).ceil().max(0.0) as usize;
    let text = format!("{value:.decimals$}");
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::Axis;

    fn labels(axis: &Axis, most: usize) -> Vec<String> {
        axis.ticks(most).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(labels(&Axis::linear("", 0.0, 30.0), 6), ["0", "5", "10", "15", "20", "25", "30"]);
        assert_eq!(labels(&Axis::linear("", -0.34, 0.31), 5), ["−0.2", "0.0", "0.2"]);
        assert_eq!(labels(&Axis::linear("", 1e-7, 3e-7), 2), ["1e-7", "2e-7", "3e-7"]);
        assert_eq!(labels(&Axis::degrees("", -185.0, 185.0), 6), ["−180", "−90", "0", "90", "180"]);
        assert_eq!(labels(&Axis::degrees("", -5.0, 38.0), 6), ["0", "10", "20", "30"]);
        assert_eq!(labels(&Axis::degrees("", 0.0, 0.4), 4), ["0.0", "0.1", "0.2", "0.3", "0.4"]);
        assert_eq!(labels(&Axis::log("", 0.1, 30.0), 5), ["0.1", "1", "10"]);
        assert_eq!(labels(&Axis::log("", 1.0, 10.0), 5), ["1", "2", "5", "10"]);
        for (low, high) in [(0.0, 1e-12), (-1e9, 1e9), (5.0, 5.0), (f64::NAN, 1.0), (0.0, 1.07), (3.0, 3.1)] {
            let axis = Axis::linear("", low, high);
            let ticks = axis.ticks(5);
            assert!((1..=7).contains(&ticks.len()), "{low} to {high}: {ticks:?}");
            assert!(ticks.iter().all(|tick| (-0.01..=1.01).contains(&axis.place(tick.value))));
        }
    }

    #[test]
    fn rounding_outward_keeps_the_range_inside() {
        for (low, high) in [(-3.2, 17.9), (0.0, 0.013), (-5e-6, -1e-6)] {
            let axis = Axis::rounded("", low, high);
            assert!(axis.low <= low && axis.high >= high);
            assert!(axis.high - axis.low < 2.0 * (high - low));
        }
    }
}
