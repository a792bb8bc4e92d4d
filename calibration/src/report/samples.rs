//! The samples of a report: what each was and what the sensor says.

use nalgebra::DMatrix;
use serde::ser::SerializeSeq as _;
use serde::{Serialize, Serializer};

use crate::loads::Names;

/// Every sample of a report. It is written to JSON as a list of [`SampleReport`].
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::report::Samples;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// let samples: Samples = calibrate(&table, &Options::default())?.report.details;
/// assert_eq!(samples.len(), 60);
/// // What was hung on, and what the sensor says, are apart by less than 20 mN throughout.
/// assert!((&samples.applied - &samples.measured).amax() < 0.02);
/// assert!(samples.get(60).is_none());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// What they are called.
    pub names: Names,
    /// The known loads, samples × axes \[N, N·m\].
    pub applied: DMatrix<f64>,
    /// What the calibrated sensor says.
    pub measured: DMatrix<f64>,
    /// What it would say if calibrated without the load case of the sample, if that was asked.
    pub left_out: Option<LeftOut>,
}

/// One sample, \[N, N·m\] in the order of the axes.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::report::SampleReport;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// let report = calibrate(&table, &Options::default())?.report;
/// // The first sample: −9.5 N on Fx, as fitted and as the other samples tell it.
/// let first: SampleReport = report.details.get(0).ok_or("none")?;
/// assert_eq!(first.applied, [-9.5, 0.0, 0.0]);
/// let left_out = first.left_out.ok_or("needed")?;
/// assert!((first.measured[0] + 9.5).abs() < 0.02 && (left_out[0] + 9.5).abs() < 0.02);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleReport {
    /// What it is called.
    pub name: String,
    /// The known load.
    pub applied: Vec<f64>,
    /// What the calibrated sensor says.
    pub measured: Vec<f64>,
    /// What it would say if calibrated without this load case.
    pub left_out: Option<Vec<f64>>,
}

impl Samples {
    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.applied.nrows()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One of them; `None` beyond the last.
    #[must_use]
    pub fn get(&self, sample: usize) -> Option<SampleReport> {
        let row = |matrix: &DMatrix<f64>| {
            (sample < matrix.nrows()).then(|| matrix.row(sample).iter().copied().collect::<Vec<f64>>())
        };
        Some(SampleReport {
            name: self.names.get(sample).into_owned(),
            applied: row(&self.applied)?,
            measured: row(&self.measured)?,
            left_out: self.left_out.as_ref().and_then(|left_out| left_out.load(sample)),
        })
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl Iterator<Item = SampleReport> + '_ {
        (0..self.len()).map_while(|sample| self.get(sample))
    }
}

/// As many axes as the first has; what a sample lacks of them is not finite.
impl FromIterator<SampleReport> for Samples {
    fn from_iter<I: IntoIterator<Item = SampleReport>>(samples: I) -> Self {
        let samples: Vec<SampleReport> = samples.into_iter().collect();
        let axes = samples.first().map_or(0, |first| first.applied.len());
        let matrix = |of: fn(&SampleReport) -> &Vec<f64>| {
            DMatrix::from_fn(samples.len(), axes, |i, j| of(&samples[i]).get(j).copied().unwrap_or(f64::NAN))
        };
        let (applied, measured) = (matrix(|sample| &sample.applied), matrix(|sample| &sample.measured));
        let mut left_out = LeftOut::new(samples.len(), axes);
        for (index, sample) in samples.iter().enumerate() {
            if let Some(load) = &sample.left_out {
                left_out.tell(index, load);
            }
        }
        let left_out = left_out.tells_any().then_some(left_out);
        Self { names: samples.into_iter().map(|sample| sample.name).collect(), applied, measured, left_out }
    }
}

impl Serialize for Samples {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(Some(self.len()))?;
        self.iter().try_for_each(|sample| list.serialize_element(&sample))?;
        list.end()
    }
}

/// What a fit says of each load case that it has not seen.
///
/// ```
/// use fingertip_calibration::report::LeftOut;
///
/// // Two samples of one axis \[N\]; only of the first is told.
/// let mut left_out = LeftOut::new(2, 1);
/// left_out.tell(0, &[1.5]);
/// assert_eq!((left_out.load(0), left_out.load(1)), (Some(vec![1.5]), None));
/// assert!(left_out.all().is_none());
/// left_out.tell(1, &[-2.0]);
/// assert_eq!(left_out.all().map(|loads| loads.sum()), Some(-0.5));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// Samples × axes \[N, N·m\]; a row of zeros where nothing is told.
    loads: DMatrix<f64>,
    is_told: Vec<bool>,
}

impl LeftOut {
    /// Of so many samples and axes, of which nothing is told yet.
    #[must_use]
    pub fn new(samples: usize, axes: usize) -> Self {
        Self { loads: DMatrix::zeros(samples, axes), is_told: vec![false; samples] }
    }

    /// Tells the load of a sample; one that there is not is passed over.
    pub fn tell<'a>(&mut self, sample: usize, load: impl IntoIterator<Item = &'a f64>) {
        let Some(is_told) = self.is_told.get_mut(sample) else { return };
        *is_told = true;
        for (slot, load) in self.loads.row_mut(sample).iter_mut().zip(load) {
            *slot = *load;
        }
    }

    /// What is told of a sample; `None` where the other cases do not determine it.
    #[must_use]
    pub fn load(&self, sample: usize) -> Option<Vec<f64>> {
        self.is_told.get(sample)?.then(|| self.loads.row(sample).iter().copied().collect())
    }

    /// The loads of all samples, samples × axes \[N, N·m\]; `None` if one is not told.
    #[must_use]
    pub fn all(&self) -> Option<&DMatrix<f64>> {
        self.is_told.iter().all(|is_told| *is_told).then_some(&self.loads)
    }

    /// Whether this sample is told of.
    pub(crate) fn tells(&self, sample: usize) -> bool {
        self.is_told.get(sample).copied().unwrap_or_default()
    }

    /// Samples × axes; zeros where nothing is told.
    pub(crate) const fn loads(&self) -> &DMatrix<f64> {
        &self.loads
    }

    /// The samples of which nothing is told.
    pub(crate) fn untold(&self) -> impl Iterator<Item = usize> + '_ {
        self.is_told.iter().enumerate().filter(|(_, is_told)| !**is_told).map(|(sample, _)| sample)
    }

    /// Whether any sample is told of.
    #[must_use]
    pub fn tells_any(&self) -> bool {
        self.is_told.contains(&true)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::{LeftOut, Samples};
    use crate::loads::Names;

    #[test]
    fn samples_are_written_one_by_one() {
        let mut left_out = LeftOut::new(2, 2);
        left_out.tell(1, &[7.0, 8.0]);
        left_out.tell(2, &[9.0, 9.0]);
        assert!(left_out.all().is_none() && left_out.tells_any());
        assert_eq!((left_out.load(0), left_out.untold().collect::<Vec<_>>()), (None, vec![0]));
        let samples = Samples {
            names: Names::numbered("line", [2, 3]),
            applied: DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 3.0, 4.0]),
            measured: DMatrix::from_row_slice(2, 2, &[1.5, 2.5, f64::NAN, 4.5]),
            left_out: Some(left_out.clone()),
        };
        assert_eq!(
            serde_json::to_string(&samples).unwrap(),
            "[{\"name\":\"line 2\",\"applied\":[1.0,2.0],\"measured\":[1.5,2.5],\"left_out\":null},\
             {\"name\":\"line 3\",\"applied\":[3.0,4.0],\"measured\":[null,4.5],\"left_out\":[7.0,8.0]}]"
        );
        assert!(samples.get(2).is_none() && samples.len() == 2 && !samples.is_empty());
        left_out.tell(0, &[5.0, 6.0]);
        assert_eq!(left_out.all().unwrap(), &DMatrix::from_row_slice(2, 2, &[5.0, 6.0, 7.0, 8.0]));
    }
}
