//! The terms of a curved sensor.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// What loads depend on beside the signals themselves: products of signals, and bumps over the space of signals
/// (`docs/theory/calibration.md#curved-sensors`). All vanish to second order where the signals are zero.
///
/// ```
/// use fingertip_calibration::curve::Terms;
///
/// // v1², v1·v2² and no bumps, of a sensor with two gauges.
/// let terms = Terms { products: vec![vec![0, 0], vec![0, 1, 1]], ..Terms::default() };
/// assert_eq!(terms.values(&[3.0, 2.0]), [9.0, 12.0]);
/// assert_eq!(terms.names(), ["v1·v1", "v1·v2·v2"]);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Terms {
    /// The gauges of each product, two or three, counted from 0.
    #[serde(default)]
    pub products: Vec<Vec<usize>>,
    /// The widths of all bumps, one for each gauge \[signal\]; empty without bumps.
    #[serde(default)]
    pub widths: Vec<f64>,
    /// The signals at which the bumps are highest.
    #[serde(default)]
    pub centres: Vec<Vec<f64>>,
}

impl Terms {
    /// All products of two signals of so many gauges: (0,0), (0,1), … (0,N−1), (1,1), ….
    #[must_use]
    pub fn pairs(gauges: usize) -> Self {
        let products = (0..gauges).flat_map(|i| (i..gauges).map(move |j| vec![i, j])).collect();
        Self { products, ..Self::default() }
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.products.len() + self.centres.len()
    }

    /// Whether there are none: the sensor is straight.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What the terms are at signals, products before bumps. A gauge or a width that is missing counts as NaN.
    #[must_use]
    pub fn values(&self, signals: &[f64]) -> Vec<f64> {
        let of = |gauge: &usize| signals.get(*gauge).copied().unwrap_or(f64::NAN);
        let products = self.products.iter().map(|gauges| gauges.iter().map(of).product());
        products.chain(self.centres.iter().map(|centre| self.bump(centre, signals))).collect()
    }

    /// How each term changes with the signals: terms × gauges.
    #[must_use]
    pub fn slopes(&self, signals: &[f64]) -> DMatrix<f64> {
        let mut slopes = DMatrix::zeros(self.len(), signals.len());
        for (row, gauges) in self.products.iter().enumerate() {
            for (place, varied) in gauges.iter().enumerate() {
                let others = gauges.iter().enumerate().filter(|(other, _)| *other != place);
                let slope: f64 = others.filter_map(|(_, gauge)| signals.get(*gauge)).product();
                if *varied < signals.len() {
                    slopes[(row, *varied)] += slope;
                }
            }
        }
        let none = vec![0.0; signals.len()];
        for (row, centre) in self.centres.iter().enumerate() {
            let slope = self.fall(centre, signals) - self.fall(centre, &none);
            slopes.set_row(self.products.len() + row, &slope.transpose());
        }
        slopes
    }

    /// What they are called: "v1·v2", "bump 1".
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let product = |gauges: &Vec<usize>| {
            let factors: Vec<String> = gauges.iter().map(|gauge| format!("v{}", gauge + 1)).collect();
            factors.join("·")
        };
        let bumps = (1..=self.centres.len()).map(|number| format!("bump {number}"));
        self.products.iter().map(product).chain(bumps).collect()
    }

    /// In words: "v1·v1, v1·v2·v2 and 3 bumps"; of more than eight products, how many there are.
    #[must_use]
    pub fn described(&self) -> String {
        let counted = |count: usize, what: &str| (count > 0).then(|| format!("{count} {what}"));
        let few = self.products.len() <= 8;
        let of = |factors: usize| self.products.iter().filter(|gauges| gauges.len() == factors).count();
        let products = match few {
            true => Some(self.names()[..self.products.len()].join(", ")).filter(|names| !names.is_empty()),
            false => counted(of(2), "products of two signals"),
        };
        let triple = if few { None } else { counted(of(3), "of three") };
        let bumps = if self.centres.len() == 1 { "bump" } else { "bumps" };
        let parts: Vec<String> =
            [products, triple, counted(self.centres.len(), bumps)].into_iter().flatten().collect();
        if parts.is_empty() { "none".to_owned() } else { parts.join(" and ") }
    }

    /// The inverse multiquadric about a centre, less its value and its slope without load.
    fn bump(&self, centre: &[f64], signals: &[f64]) -> f64 {
        let none = vec![0.0; signals.len()];
        let slope = self.fall(centre, &none);
        let along: f64 = slope.iter().zip(signals).map(|(slope, signal)| slope * signal).sum();
        self.height(centre, signals) - self.height(centre, &none) - along
    }

    fn height(&self, centre: &[f64], signals: &[f64]) -> f64 {
        let square: f64 = (0..signals.len()).map(|i| self.away(centre, signals, i).powi(2)).sum();
        1.0 / (1.0 + square).sqrt()
    }

    /// Gradient of the height.
    fn fall(&self, centre: &[f64], signals: &[f64]) -> DVector<f64> {
        let cube = self.height(centre, signals).powi(3);
        DVector::from_fn(signals.len(), |i, _| -cube * self.away(centre, signals, i) / self.width(i))
    }

    fn width(&self, gauge: usize) -> f64 {
        self.widths.get(gauge).copied().unwrap_or(f64::NAN)
    }

    /// Distance from the centre along one gauge, in widths.
    fn away(&self, centre: &[f64], signals: &[f64], gauge: usize) -> f64 {
        let middle = centre.get(gauge).copied().unwrap_or(f64::NAN);
        (signals[gauge] - middle) / self.width(gauge)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::Terms;

    fn terms() -> Terms {
        Terms {
            products: vec![vec![0, 0], vec![0, 2], vec![1, 1, 2], vec![0, 1, 2], vec![2, 2, 2]],
            widths: vec![1.0, 2.0, 0.5],
            centres: vec![vec![0.3, -0.4, 0.1], vec![-1.0, 0.5, 0.2]],
        }
    }

    proptest! {
        /// Against differences.
        #[test]
        fn slopes_are_those_of_the_values(signals in proptest::array::uniform3(-2.0..2.0_f64)) {
            let slopes = terms().slopes(&signals);
            for gauge in 0..3 {
                let at = |step: f64| {
                    let mut signals = signals;
                    signals[gauge] += step;
                    terms().values(&signals)
                };
                for (row, (above, below)) in at(1e-5).iter().zip(at(-1e-5)).enumerate() {
                    let slope = (above - below) / 2e-5;
                    prop_assert!((slopes[(row, gauge)] - slope).abs() < 1e-7, "{row} {gauge}");
                }
            }
        }
    }

    /// So that a tare keeps its meaning, and the matrix that of small loads.
    #[test]
    fn all_vanish_to_second_order_without_load() {
        let (values, slopes) = (terms().values(&[0.0; 3]), terms().slopes(&[0.0; 3]));
        assert_eq!(values, [0.0; 7]);
        assert!(slopes.iter().all(|slope| *slope == 0.0), "{slopes}");
        // Half as far, a quarter as much.
        let along = |share: f64| terms().values(&[share * 0.01, share * -0.02, share * 0.01])[5];
        assert!((along(1.0) / along(0.5) - 4.0).abs() < 0.1, "{} {}", along(1.0), along(0.5));
    }

    #[test]
    fn pairs_are_all_products_of_two() {
        let signals = [2.0, 3.0, 5.0];
        assert_eq!(Terms::pairs(3).values(&signals), crate::linear::pairs(&signals).as_slice());
        assert_eq!(Terms::pairs(3).names(), ["v1·v1", "v1·v2", "v1·v3", "v2·v2", "v2·v3", "v3·v3"]);
    }

    #[test]
    fn they_are_called_by_their_gauges() {
        assert_eq!(Terms::default().described(), "none");
        assert_eq!(terms().described(), "v1·v1, v1·v3, v2·v2·v3, v1·v2·v3, v3·v3·v3 and 2 bumps");
        let one = Terms { products: Vec::new(), centres: vec![vec![0.0; 3]], ..terms() };
        assert_eq!((one.described(), one.names()), ("1 bump".to_owned(), vec!["bump 1".to_owned()]));
        let many = Terms {
            products: [Terms::pairs(4).products, vec![vec![0, 1, 2]; 3]].concat(),
            ..Terms::default()
        };
        assert_eq!(many.described(), "10 products of two signals and 3 of three");
        // Eight are named, nine are counted.
        let first = |count: usize| Terms { products: vec![vec![0, 0]; count], ..Terms::default() };
        assert_eq!(first(8).described(), ["v1·v1"; 8].join(", "));
        assert_eq!(first(9).described(), "9 products of two signals");
        assert!(!one.is_empty() && Terms::default().is_empty());
    }

    #[test]
    fn what_is_missing_is_no_number_and_no_panic() {
        assert!(terms().values(&[1.0])[1].is_nan());
        let narrow = Terms { widths: vec![1.0], ..terms() };
        assert!(narrow.values(&[1.0, 2.0, 3.0])[5].is_nan());
        assert!(terms().values(&[f64::MAX; 3]).iter().any(|value| !value.is_finite()));
    }
}
