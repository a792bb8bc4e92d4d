//! Classes of a magnitude, each with a colour of its own.

use fingertip_calibration::page::{Anchor, Axis, Svg};

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
        let place = |rank: usize| corner.0 + step * (rank + 1) as f64 - 0.5;
        let bounds = self.bounds.iter().enumerate().map(|(rank, bound)| (place(rank), short(*bound)));
        svg.ticks_across(corner.1 + 20.0, &bounds.collect::<Vec<_>>());
        svg.label("name", (2.0, corner.1 + 8.0), Anchor::Start, "f_n / N");
    }
}

fn two_digits(value: f64) -> f64 {
    let decade = 10.0_f64.powf(value.log10().floor() - 1.0);
    (value / decade).round() * decade
}

#[cfg(test)]
mod tests {
    use super::{Classes, two_digits};
    use fingertip_calibration::page::Svg;
    use fingertip_test_support::read_back::{rectangles, texts, value};

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

    /// Bounds and colours as the legend shows them.
    fn legend(classes: &Classes) -> (Vec<f64>, Vec<String>) {
        let mut svg = Svg::new(300.0, 100.0, "");
        classes.legend(&mut svg, (20.0, 50.0), 210.0);
        let svg = svg.finish();
        let colours = rectangles(&svg);
        let width = 210.0 / colours.len() as f64;
        for (rank, (_, left, wide)) in colours.iter().enumerate() {
            assert!(
                (left - (20.0 + width * rank as f64)).abs() < 0.06 && (wide - (width - 1.0)).abs() < 0.06
            );
        }
        let ticks: Vec<_> = texts(&svg).into_iter().filter(|text| text.class == "tick").collect();
        // Each bound stands under the line between its two colours.
        for (rank, tick) in ticks.iter().enumerate() {
            assert!((tick.at.0 - (20.0 + width * (rank + 1) as f64 - 0.5)).abs() < 0.06, "{tick:?}");
        }
        let bounds = ticks.iter().map(|tick| value(&tick.text).unwrap()).collect();
        (bounds, colours.into_iter().map(|(class, ..)| class).collect())
    }

    /// Every value has the colour that stands between the bounds around it.
    fn check(classes: &Classes, values: impl Iterator<Item = f64>) {
        let (bounds, colours) = legend(classes);
        assert_eq!(colours.len(), bounds.len() + 1);
        // Bounds are as exact as their labels.
        let near = bounds.iter().flat_map(|bound| [0.999_999 * bound, 1.000_001 * bound]);
        for value in values.chain(near) {
            let rank = bounds.iter().filter(|bound| value >= **bound).count();
            assert_eq!(format!("q{}", classes.class(value)), colours[rank], "{value} between {bounds:?}");
        }
    }

    #[test]
    fn the_legend_tells_the_colour_of_every_value() {
        // Of one order: round bounds, evenly.
        let narrow = || (0..=100).map(|i| 2.0 + 0.1 * f64::from(i));
        let classes = Classes::of(narrow());
        check(&classes, narrow());
        assert_eq!(legend(&classes).0, [4.0, 6.0, 8.0, 10.0]);
        assert_eq!(legend(&classes).1, ["q0", "q1", "q3", "q4", "q6"]);
        // Wherever a range ends, neither of the classes beside its ends is wider than the others.
        for high in (1..=130).map(|i| 2.0 + 0.1 * f64::from(i)) {
            let bounds = Classes::of([2.0, high].into_iter()).bounds;
            let widest = 1.000_001 * (bounds[1] - bounds[0]);
            let rest = high - bounds[bounds.len() - 1];
            assert!(bounds[0] - 2.0 < widest && rest < widest, "{bounds:?} up to {high}");
        }
        // Over three decades: even ratios, to two digits; two in a hundred at either end do not count.
        let wide = || (0..=100).map(|i| 10.0_f64.powf(0.03 * f64::from(i)));
        let classes = Classes::of(wide());
        check(&classes, wide());
        let (bounds, colours) = legend(&classes);
        assert_eq!(colours, ["q0", "q1", "q2", "q3", "q4", "q5", "q6"]);
        let (low, high) = (10.0_f64.powf(0.06), 10.0_f64.powf(2.94));
        for (i, bound) in (1..).zip(&bounds) {
            let exact = low * (high / low).powf(f64::from(i) / 7.0);
            assert!((bound / exact - 1.0).abs() < 0.05, "{bound} for {exact}");
        }
        // Just below and above the ratio of fifteen at which they change.
        for (greatest, count) in [(14.9, 6), (15.5, 6)] {
            let classes = Classes::of([1.0, greatest].into_iter());
            let bounds = legend(&classes).0;
            let ratios = bounds.array_windows().map(|[a, b]| b / a);
            let even_ratio = ratios.clone().all(|ratio| (1.35..1.6).contains(&ratio));
            assert!(bounds.len() <= count && even_ratio == (greatest > 15.0), "{bounds:?}");
        }
        // What is not positive or not finite has no say.
        let odd = [f64::NAN, -3.0, 0.0, f64::INFINITY].into_iter();
        assert_eq!(legend(&Classes::of(odd.chain(narrow()))), legend(&Classes::of(narrow())));
    }

    #[test]
    fn two_digits_are_the_nearest() {
        for (value, expected) in [(123.4, 120.0), (0.067_89, 0.068), (9.96, 10.0), (1.0, 1.0), (99.4, 99.0)] {
            assert!((two_digits(value) / expected - 1.0).abs() < 1e-12, "{value}: {}", two_digits(value));
        }
    }
}
