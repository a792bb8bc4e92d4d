//! What terms of higher order are worth.

use core::fmt;

use serde::Serialize;

use crate::curve::Chosen;

/// What terms of higher order are worth that were chosen by leaving out load cases.
///
/// ```
/// use fingertip_calibration::model::{Curvature, Direction, Options};
/// use fingertip_calibration::report::CurveReport;
/// use fingertip_calibration::{Axis, calibrate, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
///
/// // A gauge that bends: F = 10 N/V · v + 2 N/V² · v², from −1 V to 1 V.
/// let volts = DMatrix::from_fn(41, 1, |i, _| 0.05 * i as f64 - 1.0);
/// let newtons = volts.map(|v| 10.0 * v + 2.0 * v * v);
/// let table = LoadTable::new(&[Axis::Fz], newtons, volts, SignalUnit::Volt)?;
/// let options = Options {
///     direction: Direction::LoadsFromSignals,
///     curvature: Curvature::Chosen,
///     ..Options::default()
/// };
/// let curve: CurveReport = calibrate(&table, &options)?.report.curve.ok_or("none was looked for")?;
/// // The square explains what a straight line leaves.
/// assert!(curve.taken && curve.described.contains("v1·v1"));
/// assert!(curve.left_out_percent < 0.01 * curve.straight_percent);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CurveReport {
    /// Whether the calibration has them; otherwise it could.
    pub taken: bool,
    /// How many there are.
    pub terms: usize,
    /// Which, in words.
    pub described: String,
    /// RMS over all axes on load cases that neither the choice nor the fit has seen, % of full scale.
    pub left_out_percent: f64,
    /// The same without the terms.
    pub straight_percent: f64,
}

/// Terms are proposed if they make the error smaller by this factor.
const WORTH: f64 = 0.7;

impl CurveReport {
    pub(crate) fn new(chosen: &Chosen, taken: bool) -> Self {
        Self {
            taken,
            terms: chosen.terms.len(),
            described: chosen.terms.described(),
            left_out_percent: chosen.left_out_percent,
            straight_percent: chosen.straight_percent,
        }
    }

    /// Whether the terms make enough of a difference to speak of.
    pub(crate) fn is_worth_it(&self) -> bool {
        self.left_out_percent < WORTH * self.straight_percent
    }
}

impl fmt::Display for CurveReport {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { taken, terms, described, left_out_percent, straight_percent } = self;
        let count = if *terms == 1 { "1 term".to_owned() } else { format!("{terms} terms") };
        match (taken, terms) {
            (true, 0) => write!(
                formatter,
                "no term of higher order helps: {straight_percent:.2} % of full scale on load cases left out"
            ),
            (true, _) => write!(
                formatter,
                "{count} of higher order: {left_out_percent:.2} % of full scale on load cases left out instead of \
                 {straight_percent:.2} % ({described})"
            ),
            (false, _) => write!(
                formatter,
                "the sensor seems to be curved: {count} of higher order would make {left_out_percent:.2} % of full scale \
                 on load cases left out of {straight_percent:.2} %"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::CurveReport;

    #[test]
    fn it_says_what_is_and_what_could_be() {
        let report = CurveReport {
            taken: true,
            terms: 2,
            described: "v1·v1 and a bump".to_owned(),
            left_out_percent: 0.456,
            straight_percent: 3.0,
        };
        assert_eq!(
            report.to_string(),
            "2 terms of higher order: 0.46 % of full scale on load cases left out instead of 3.00 % (v1·v1 and a bump)"
        );
        let none = CurveReport { terms: 0, ..report.clone() };
        assert_eq!(
            none.to_string(),
            "no term of higher order helps: 3.00 % of full scale on load cases left out"
        );
        let could = CurveReport { taken: false, terms: 1, ..report.clone() };
        assert!(could.to_string().contains("1 term of higher order would make 0.46 %"), "{could}");
        assert!(report.is_worth_it());
        assert!(!CurveReport { left_out_percent: 2.2, ..report }.is_worth_it());
    }
}
