//! Classes of a magnitude, each with a colour of its own.

use super::axis::Axis;
use super::svg::{Anchor, Svg};
use crate::table::short;

/// Up to seven classes between round bounds.
#[derive(Clone, Debug)]
pub(crate) struct Classes {
    /// Between the classes, rising.
    bounds: Vec<f64>,
}

impl Classes {
    /// How many colours there are: `q0` to `q6` of the style sheet.
    pub(crate) const COUNT: usize = 7;

    /// Classes that tell the given values apart: of equal width where the values are of one order,
    /// of equal ratio where they span more.
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.filter(|value| *value > 0.0 && value.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let at =
            |share: f64| sorted.get((share * (sorted.len().max(1) - 1) as f64).round() as usize).copied();
        let (Some(low), Some(high)) = (at(0.02), at(0.98)) else { return Self { bounds: Vec::new() } };
        let bounds: Vec<f64> = if high > 15.0 * low {
            let ratio = (high / low).powf(1.0 / Self::COUNT as f64);
            (1..Self::COUNT).map(|i| two_digits(low * ratio.powi(i as i32))).collect()
        } else {
            let ticks = Axis::linear("", low, high).ticks(Self::COUNT - 1);
            ticks.into_iter().map(|tick| tick.value).take(Self::COUNT - 1).collect()
        };
        Self { bounds }
    }

    /// Which colour a value has.
    pub(crate) fn class(&self, value: f64) -> usize {
        let rank = self.bounds.iter().filter(|bound| value >= **bound).count();
        // Few classes take colours from the whole range.
        rank * (Self::COUNT - 1) / self.bounds.len().max(1)
    }

    /// Draws the colours with their bounds.
    pub(crate) fn legend(&self, svg: &mut Svg, corner: (f64, f64), width: f64) {
        let classes = self.bounds.len() + 1;
        let step = width / classes as f64;
        for rank in 0..classes {
            let class = rank * (Self::COUNT - 1) / self.bounds.len().max(1);
            svg.rectangle(&format!("q{class}"), (corner.0 + step * rank as f64, corner.1), (step - 1.0, 8.0));
        }
        for (rank, bound) in self.bounds.iter().enumerate() {
            let x = corner.0 + step * (rank + 1) as f64 - 0.5;
            svg.label("tick", (x, corner.1 + 20.0), Anchor::Middle, &short(*bound));
        }
        svg.label("name", (2.0, corner.1 + 8.0), Anchor::Start, "f_n / N");
    }
}

fn two_digits(value: f64) -> f64 {
    let decade = 10.0_f64.powf(value.log10().floor() - 1.0);
    (value / decade).round() * decade
}

#[cfg(test)]
mod tests {
    use super::Classes;

    #[test]
    fn classes_rise_with_the_value_and_use_both_ends() {
        for values in [vec![1.0, 2.0, 3.0, 4.0], vec![0.1, 1.0, 10.0, 30.0], vec![5.0; 9]] {
            let classes = Classes::of(values.iter().copied());
            let ranks: Vec<usize> = values.iter().map(|value| classes.class(*value)).collect();
            assert!(ranks.is_sorted(), "{ranks:?}");
            assert!(ranks.iter().all(|rank| *rank < Classes::COUNT));
        }
        assert_eq!(Classes::of(core::iter::empty()).class(1.0), 0);
        let wide = Classes::of((1..1000).map(|i| f64::from(i) * 0.1));
        assert_eq!((wide.class(0.01), wide.class(1e6)), (0, Classes::COUNT - 1));
    }
}
