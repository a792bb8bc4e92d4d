//! What was found of a sensor's creep.

use core::fmt;

use serde::Serialize;

use super::AxisReport;
use crate::creep::{Creep, CreepFit};

/// Figures of load cycles of one axis, % of full scale; `None` where the table of loads does not tell.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // 12 cycles: 20 s without load, 20 s with 10 N and less; a gauge of 0.1 V/N of which a solid with 8 s adds 4 %.
/// # let newtons = DMatrix::from_fn(480, 1, |second, _| {
/// #     if second % 40 < 20 { 0.0 } else { 10.0 - 0.5 * (second / 40) as f64 }
/// # });
/// # let mut lasting = 0.0;
/// # let volts = newtons.map(|newtons| {
/// #     let signal = 0.1 * newtons;
/// #     lasting += (signal - lasting) * (1.0 - (-1.0_f64 / 8.0).exp());
/// #     signal + 0.04 * lasting
/// # });
/// # let mut table = LoadTable::new(&[Axis::Fz], newtons, volts, SignalUnit::Volt)?;
/// # table.times = Some((0..480).map(f64::from).collect());
/// use fingertip_calibration::report::CycleFigures;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// // A gauge that creeps by 4 %: held loads seem to grow, until that is taken off.
/// let creep = calibrate(&table, &Options { creep: true, ..Options::default() })?.report.creep.ok_or("none")?;
/// let (before, after): (CycleFigures, CycleFigures) = (creep.before[0], creep.after[0]);
/// assert!(after.zero_return_percent.ok_or("none")? < 0.5 * before.zero_return_percent.ok_or("none")?);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CycleFigures {
    /// Greatest difference between rising and falling load.
    pub hysteresis_percent: Option<f64>,
    /// Greatest change of the reading without load after loading.
    pub zero_return_percent: Option<f64>,
    /// Greatest change of the reading while a load is held.
    pub creep_percent: Option<f64>,
}

impl From<&AxisReport> for CycleFigures {
    fn from(axis: &AxisReport) -> Self {
        let AxisReport { hysteresis_percent, zero_return_percent, creep_percent, .. } = *axis;
        Self { hysteresis_percent, zero_return_percent, creep_percent }
    }
}

/// What was found of a sensor's creep, and what its compensation leaves.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // 12 cycles: 20 s without load, 20 s with 10 N and less; a gauge of 0.1 V/N of which a solid with 8 s adds 4 %.
/// # let newtons = DMatrix::from_fn(480, 1, |second, _| {
/// #     if second % 40 < 20 { 0.0 } else { 10.0 - 0.5 * (second / 40) as f64 }
/// # });
/// # let mut lasting = 0.0;
/// # let volts = newtons.map(|newtons| {
/// #     let signal = 0.1 * newtons;
/// #     lasting += (signal - lasting) * (1.0 - (-1.0_f64 / 8.0).exp());
/// #     signal + 0.04 * lasting
/// # });
/// # let mut table = LoadTable::new(&[Axis::Fz], newtons, volts, SignalUnit::Volt)?;
/// # table.times = Some((0..480).map(f64::from).collect());
/// use fingertip_calibration::report::CreepReport;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// // A gauge that creeps by 4 % within 8 s.
/// let options = Options { creep: true, ..Options::default() };
/// let report: CreepReport = calibrate(&table, &options)?.report.creep.ok_or("none")?;
/// assert!(report.cycles == 12 && report.with_percent < 0.3 * report.without_percent);
/// assert!(report.creep.times_s.iter().any(|seconds| (seconds / 8.0 - 1.0).abs() < 0.3));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CreepReport {
    /// Over which times it creeps, and the share of each gauge; none if no compensation helps.
    pub creep: Creep,
    /// Standard deviation of each share.
    pub deviations: Vec<Vec<f64>>,
    /// How many load cycles told it.
    pub cycles: usize,
    /// What loads leave of the readings of cycles left out of the fit, RMS, % of the span of a gauge.
    pub without_percent: f64,
    /// The same with the compensation.
    pub with_percent: f64,
    /// Figures of the readings as they were, axis by axis: beside those of the
    /// [`axes`](super::Report::axes), which are without creep.
    pub before: Vec<CycleFigures>,
    /// The figures that are left.
    #[serde(skip)]
    pub after: Vec<CycleFigures>,
}

impl CreepReport {
    /// Of a fit, and of all axes before and after what it found was taken off.
    pub(crate) fn new(fit: CreepFit, before: &[AxisReport], after: &[AxisReport]) -> Self {
        let [without_percent, with_percent] = fit.left_out_percent;
        let [before, after] = [before, after].map(|axes| axes.iter().map(CycleFigures::from).collect());
        let CreepFit { creep, deviations, cycles, .. } = fit;
        Self { creep, deviations, cycles, without_percent, with_percent, before, after }
    }

    /// The greatest of all axes, before and after.
    fn greatest(&self, figure: impl Fn(&CycleFigures) -> Option<f64>) -> Option<[f64; 2]> {
        let of = |axes: &[CycleFigures]| axes.iter().filter_map(&figure).reduce(f64::max);
        Some([of(&self.before)?, of(&self.after)?])
    }
}

impl fmt::Display for CreepReport {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { creep, cycles, without_percent, with_percent, .. } = self;
        if creep.times_s.is_empty() {
            return write!(
                formatter,
                "no creep that could be taken off: loads leave {without_percent:.3} % of a gauge's span on load cycles left \
                 out ({cycles} cycles)"
            );
        }
        for (index, (time, shares)) in creep.times_s.iter().zip(&creep.shares).enumerate() {
            let largest = shares
                .iter()
                .fold(0.0, |most: f64, share| if share.abs() > most.abs() { *share } else { most });
            let comma = if index > 0 { "; " } else { "" };
            write!(formatter, "{comma}{:.2} % within {time:.3} s", 100.0 * largest)?;
        }
        write!(
            formatter,
            " taken off the gauge that creeps most: {with_percent:.3} % of a gauge's span left on load cycles left out \
             instead of {without_percent:.3} % ({cycles} cycles)"
        )?;
        let figures = [
            ("hysteresis", self.greatest(|figures| figures.hysteresis_percent)),
            ("zero return", self.greatest(|figures| figures.zero_return_percent)),
            ("creep", self.greatest(|figures| figures.creep_percent)),
        ];
        let known: Vec<String> = figures
            .into_iter()
            .filter_map(|(name, figure)| {
                figure.map(|[before, after]| format!("{name} {before:.3} → {after:.3}"))
            })
            .collect();
        if known.is_empty() { Ok(()) } else { write!(formatter, "\n% of full scale: {}", known.join(", ")) }
    }
}

#[cfg(test)]
mod tests {
    use super::{CreepReport, CycleFigures};
    use crate::creep::{Creep, CreepFit};

    #[test]
    fn it_says_what_is_taken_off_and_what_is_left() {
        let creep = Creep { times_s: vec![3.0, 24.56], shares: vec![vec![0.01, -0.02], vec![0.004, 0.003]] };
        let fit = CreepFit { creep, deviations: Vec::new(), cycles: 7, left_out_percent: [0.5, 0.05] };
        let mut report = CreepReport::new(fit.clone(), &[], &[]);
        assert_eq!(
            report.to_string(),
            "-2.00 % within 3.000 s; 0.40 % within 24.560 s taken off the gauge that creeps most: 0.050 % of a gauge's span \
             left on load cycles left out instead of 0.500 % (7 cycles)"
        );
        let figures = |size: f64| CycleFigures {
            hysteresis_percent: Some(size),
            zero_return_percent: None,
            creep_percent: Some(2.0 * size),
        };
        (report.before, report.after) = (vec![figures(0.3), figures(0.5)], vec![figures(0.1), figures(0.02)]);
        let text = report.to_string();
        assert!(text.ends_with("\n% of full scale: hysteresis 0.500 → 0.100, creep 1.000 → 0.200"), "{text}");
        let none = CreepReport::new(CreepFit { creep: Creep::default(), ..fit }, &[], &[]);
        assert_eq!(
            none.to_string(),
            "no creep that could be taken off: loads leave 0.500 % of a gauge's span on load cycles left out (7 cycles)"
        );
    }
}
