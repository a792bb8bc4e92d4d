//! What the numbers along an axis are counted from and in, so that they are short wherever they lie.

/// Letters that the label of a tick may have, its sign included: what stands beside a drawing of the width of a phone.
const LONGEST: usize = 6;
/// Where numbers lie farther from zero than this many times their range, they are counted from a number among them.
const FAR: f64 = 100.0;
/// No tick needs more places behind the point.
const MOST_PLACES: usize = 4;

/// How the numbers of an axis are said: less an origin, in units of a power of ten. Most are said as they are; times since
/// 1970, a nanonewton or a teranewton would need more letters than have room.
///
/// ```
/// use fingertip_calibration::page::Counting;
///
/// let plain = Counting::of(0.0, 30.0);
/// assert_eq!((plain.label(25.0, 5.0), plain.title("time / s")), ("25".into(), "time / s".into()));
/// let unix = Counting::of(1_763_931_791.5, 1_763_931_799.0);
/// assert_eq!(unix.label(1_763_931_792.0, 2.0), "2");
/// assert_eq!(unix.title("time / s"), "time − 1763931790 / s");
/// let small = Counting::of(-2e-7, 3e-7);
/// assert_eq!((small.label(-2e-7, 1e-7), small.title("force / N")), ("−200".into(), "force / 10⁻⁹ N".into()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counting {
    origin: f64,
    /// Of ten: places of the origin behind the point, where it has such.
    places: usize,
    power: i32,
}

impl Counting {
    /// The numbers as they are.
    pub const PLAIN: Self = Self { origin: 0.0, places: 0, power: 0 };

    /// For numbers from `low` to `high`. What is not finite is said as it is.
    #[must_use]
    pub fn of(low: f64, high: f64) -> Self {
        let (largest, range) = (low.abs().max(high.abs()), high - low);
        if !(range > 0.0 && largest.is_finite()) || fits(low, high) {
            return Self::PLAIN;
        }
        let mut counting = Self::PLAIN;
        if largest > FAR * range {
            let decade = range.log10().ceil();
            let unit = 10_f64.powf(decade);
            let origin = (low / unit).floor() * unit;
            // A range below the spacing of numbers at the place has no origin that is nearer.
            if origin.is_finite() && (low - origin).abs() < largest {
                counting.origin = origin;
                counting.places = (-decade).clamp(0.0, 12.0) as usize;
            }
        }
        let left = (low - counting.origin).abs().max((high - counting.origin).abs());
        if !fits(low - counting.origin, high - counting.origin) {
            counting.power = 3 * ((left.log10() / 3.0).floor() as i32).max(-100);
        }
        counting
    }

    /// A number as the axis says it.
    #[must_use]
    pub fn said(&self, value: f64) -> f64 {
        // In two steps, since 10³⁰⁸ has no reciprocal.
        (value - self.origin) / 10_f64.powi(self.power)
    }

    /// The label of a tick, with as many places as ticks a `step` apart need.
    #[must_use]
    pub fn label(&self, value: f64, step: f64) -> String {
        let step = step.abs() / 10_f64.powi(self.power);
        let places = places(step).min(MOST_PLACES);
        let text = format!("{:.places$}", self.said(value));
        let text = if text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.')) {
            text.replace('-', "")
        } else {
            text
        };
        text.replace('-', "−")
    }

    /// The name of the axis, `quantity / unit` or a quantity without one, with what its numbers are counted from and in.
    #[must_use]
    pub fn title(&self, name: &str) -> String {
        let (quantity, unit) = name.split_once(" / ").unwrap_or((name, ""));
        let mut title = quantity.to_owned();
        if self.origin != 0.0 {
            let sign = if self.origin < 0.0 { '+' } else { '−' };
            title.push_str(&format!(" {sign} {:.*}", self.places, self.origin.abs()));
        }
        let power = (self.power != 0).then(|| power_of_ten(self.power));
        let unit: Vec<&str> =
            power.as_deref().into_iter().chain((!unit.is_empty()).then_some(unit)).collect();
        if unit.is_empty() { title } else { format!("{title} / {}", unit.join(" ")) }
    }
}

/// Whether the ticks of such numbers are short, however finely they are cut.
fn fits(low: f64, high: f64) -> bool {
    let step = 10_f64.powf(((high - low) / 8.0).log10().floor());
    let (sign, largest) = (usize::from(low < 0.0), low.abs().max(high.abs()));
    let whole = largest.max(1.0).log10().floor() as usize + 1;
    let places = places(step);
    sign + whole + if places > 0 { 1 + places } else { 0 } <= LONGEST
}

/// Places behind the point that tell multiples of a step apart.
fn places(step: f64) -> usize {
    // A hair more than the step, so that 0.1 counts as one place.
    (-(step * 1.000_001).log10()).ceil().clamp(0.0, 400.0) as usize
}

/// `10⁻³`.
fn power_of_ten(power: i32) -> String {
    let raised = |letter: char| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(digit),
    };
    format!("10{}", power.to_string().chars().map(raised).collect::<String>())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Counting, power_of_ten};

    #[test]
    fn what_is_short_is_said_as_it_is() {
        for (low, high) in
            [(0.0, 30.0), (-0.34, 0.31), (1000.0, 1005.0), (0.0, 9999.0), (20.0, 20.5), (5.0, 5.0)]
        {
            assert_eq!(Counting::of(low, high), Counting::PLAIN, "{low} to {high}");
        }
        for (low, high) in [(f64::NAN, 1.0), (0.0, f64::INFINITY), (2.0, 1.0), (5e9, 5e9), (1e-7, 1e-7)] {
            assert_eq!(Counting::of(low, high), Counting::PLAIN, "{low} to {high}");
        }
        assert_eq!(Counting::PLAIN.label(-0.0, 0.5), "0.0");
        assert_eq!(Counting::PLAIN.label(-0.2, 0.2), "−0.2");
        assert_eq!(Counting::PLAIN.title("friction ratio"), "friction ratio");
    }

    #[test]
    fn titles_say_what_is_taken_off_and_counted_in() {
        let title = |low, high, name| Counting::of(low, high).title(name);
        assert_eq!(title(-1_000_000.5, -1_000_000.2, "x / m"), "x + 1000001 / m");
        assert_eq!(title(0.0, 3e7, "force / N"), "force / 10⁶ N");
        assert_eq!(title(0.0, 3e-4, "friction ratio"), "friction ratio / 10⁻⁶");
        assert_eq!(title(20.000_012, 20.000_014, "x"), "x − 20.00001 / 10⁻⁶");
        assert_eq!(title(-1e308, 1e308, "x / m"), "x / 10³⁰⁶ m");
        assert_eq!(power_of_ten(-1_234_567_890), "10⁻¹²³⁴⁵⁶⁷⁸⁹⁰");
    }

    proptest! {
        /// Labels are short, and title and label together say the value.
        #[test]
        fn labels_are_short_and_say_the_value(
            power in -12.0..12.0_f64, from in -3.0..3.0_f64, far in 0.0..5.0_f64, pieces in 2..8_u32,
        ) {
            let range = 10_f64.powf(power);
            let low = from * range * 10_f64.powf(far);
            let (counting, step) = (Counting::of(low, low + range), range / f64::from(pieces));
            // Ticks are at 1, 2 or 5 times a power of ten.
            let decade = 10_f64.powf(step.log10().floor());
            let step = [1.0, 2.0, 5.0, 10.0].map(|lead| lead * decade).into_iter().find(|x| *x >= step).unwrap();
            for index in 0..=pieces {
                let value = ((low / step).ceil() + f64::from(index)) * step;
                if value > low + range {
                    break;
                }
                let label = counting.label(value, step);
                prop_assert!(label.chars().count() <= 6, "{label} of {low} + {range}");
                let read: f64 = label.replace('−', "-").parse().unwrap();
                prop_assert!((read - counting.said(value)).abs() <= 1e-3 * counting.said(low + step).abs().max(
                    (counting.said(low + step) - counting.said(low)).abs()), "{label} of {value}");
                let back = read * 10_f64.powi(counting.power) + counting.origin;
                prop_assert!((back - value).abs() <= 0.01 * step + 1e-9 * value.abs(), "{label} of {value}: {back}");
            }
        }
    }
}
