//! Known loads and the readings they gave.

use nalgebra::DMatrix;
use thiserror::Error;

use super::Names;
use crate::Axis;
use crate::file::SignalUnit;

/// Known loads and the readings that the sensor gave under them: what a calibration is fitted to.
///
/// Rows are samples. Loads are \[N, N·m\] about the origin of the sensor frame, what the
/// environment applies to the sensor.
///
/// ```
/// use fingertip_calibration::loads::LoadTable;
///
/// // Two mountings, each with a reading without load.
/// let text = "group,fz_N,v1_V\nmonday,0,0.10\nmonday,-10,1.10\ntuesday,0,0.30\ntuesday,-20,2.30\n";
/// let (table, ignored) = LoadTable::from_csv(text.as_bytes())?;
/// assert!(ignored.is_empty() && table.samples() == 4 && table.greatest_loads() == [20.0]);
/// // With the zero of each mounting taken off, 10 N are 1 V.
/// let tared = table.tared_by_group()?;
/// assert!((tared.signals[1] - 1.0).abs() < 1e-12 && (tared.signals[3] - 2.0).abs() < 1e-12);
/// # Ok::<(), fingertip_calibration::loads::LoadError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LoadTable {
    /// The components that `loads` has columns for.
    pub axes: Vec<Axis>,
    /// Samples × axes \[N, N·m\].
    pub loads: DMatrix<f64>,
    /// Samples × gauges.
    pub signals: DMatrix<f64>,
    /// Unit of the signals.
    pub signal_unit: SignalUnit,
    /// What to call each sample in reports.
    pub names: Names,
    /// Which load case (level) each sample belongs to: samples of one case are left out together.
    pub cases: Vec<usize>,
    /// Which session or mounting each sample belongs to: each group has its own zero.
    pub groups: Vec<usize>,
    /// What became of the zeros of the groups.
    pub zeros: Zeros,
    /// Time of each sample \[s\].
    pub times: Option<Vec<f64>>,
    /// Temperature of each sample \[°C\].
    pub temperatures: Option<Vec<f64>>,
    /// Orientation of the sensor, or of the flange it is on, in the base frame: quaternion x, y, z, w.
    pub orientations: Option<Vec<[f64; 4]>>,
    /// Weight of each sample: variance of a sample of weight 1 over its own.
    pub weights: Option<Vec<f64>>,
}

/// What became of the zeros of a table's groups. A zero that was taken from the readings themselves has their
/// noise, which the errors of a fit must know.
///
/// ```
/// use fingertip_calibration::loads::{LoadTable, Zeros};
///
/// let (table, _) = LoadTable::from_csv("fz_N,v1_V\n0,0.10\n-10,1.10\n".as_bytes())?;
/// assert_eq!(table.zeros, Zeros::Kept);
/// assert_eq!(table.tared_by_group()?.zeros, Zeros::OfRest);
/// // Without a reading at rest the mean can be taken off.
/// assert_eq!(table.centred_by_group().zeros, Zeros::OfMean);
/// # Ok::<(), fingertip_calibration::loads::LoadError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Zeros {
    /// The readings are as they were.
    #[default]
    Kept,
    /// Readings are less the mean of their group's readings at rest: [`LoadTable::tared_by_group`].
    OfRest,
    /// Loads and readings are less their mean over the group: [`LoadTable::centred_by_group`].
    OfMean,
}

/// Why there is no table of loads.
///
/// ```
/// use fingertip_calibration::loads::{LoadError, LoadTable};
///
/// let error = LoadTable::from_csv("fz_N,v1_V\n-5,0.5\n-10,one\n".as_bytes()).unwrap_err();
/// // It says where.
/// assert!(matches!(&error, LoadError::BadText { line: 3, column, .. } if column == "v1_V"));
/// assert!(error.to_string().contains("v1_V"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// Lists of different lengths.
    #[error("`{field}` has {found} entries for {expected} samples")]
    WrongLength {
        /// Which list.
        field: &'static str,
        /// Its length.
        found: usize,
        /// Number of samples.
        expected: usize,
    },
    /// A number is NaN, infinite or beyond [`GREATEST`](LoadTable::GREATEST), or a weight is negative.
    #[error(
        "{sample}, column `{column}`: not a finite number that a fit can carry (up to 1e100 in SI; weights not negative)"
    )]
    NotFinite {
        /// Which sample.
        sample: String,
        /// Which column.
        column: String,
    },
    /// No sample, no load column or no signal column.
    #[error("there are no {what}")]
    Empty {
        /// Samples, loads or signals.
        what: &'static str,
    },
    /// A group has no reading without load to take its zero from.
    #[error("group {group} has no sample without load to take its zero from")]
    NoZero {
        /// Which group.
        group: usize,
    },
    /// Some sessions have had their zeros taken off, others have not.
    #[error("some sessions have had their zeros taken off, others have not: join them first")]
    MixedZeros,
    /// The text is not a table of loads.
    #[error("line {line}{}: {message}", if column.is_empty() { String::new() } else { format!(", column `{column}`") })]
    BadText {
        /// Line of the file, counting from 1.
        line: u64,
        /// Which column, or empty.
        column: String,
        /// What is wrong.
        message: String,
    },
}

impl LoadTable {
    /// Beyond this \[SI\] a number is refused: a fit multiplies numbers and adds their squares over all samples, for
    /// which a double must have room. No load and no reading comes near.
    pub const GREATEST: f64 = 1e100;

    /// Whether a number is finite and no greater than [`GREATEST`](Self::GREATEST).
    pub(super) const fn carries(number: f64) -> bool {
        number.abs() <= Self::GREATEST
    }

    /// From loads (samples × axes) and signals (samples × gauges); every sample is its own case,
    /// all are of one group.
    ///
    /// # Errors
    /// [`LoadError`] for an empty table, rows that do not match, or a number that is not finite.
    pub fn new(
        axes: &[Axis],
        loads: DMatrix<f64>,
        signals: DMatrix<f64>,
        signal_unit: SignalUnit,
    ) -> Result<Self, LoadError> {
        let samples = loads.nrows();
        let table = Self {
            axes: axes.to_vec(),
            loads,
            signals,
            signal_unit,
            names: Names::numbered("sample", 1..=samples as u64),
            cases: (0..samples).collect(),
            groups: vec![0; samples],
            times: None,
            temperatures: None,
            orientations: None,
            weights: None,
            zeros: Zeros::Kept,
        };
        table.validate()?;
        Ok(table)
    }

    /// Checks lengths and that every number is finite and no greater than [`GREATEST`](Self::GREATEST). The fits call
    /// it. Orientations are for [`carrying`](Self::carrying) alone, which checks their numbers.
    ///
    /// # Errors
    /// [`LoadError`].
    pub fn validate(&self) -> Result<(), LoadError> {
        let samples = self.loads.nrows();
        for (what, count) in [
            ("samples", samples),
            ("load columns", self.axes.len()),
            ("signal columns", self.signals.ncols()),
        ] {
            if count == 0 {
                return Err(LoadError::Empty { what });
            }
        }
        if self.loads.ncols() != self.axes.len() {
            return Err(LoadError::WrongLength {
                field: "axes",
                found: self.axes.len(),
                expected: self.loads.ncols(),
            });
        }
        let length = |list: &Option<Vec<f64>>| list.as_ref().map_or(samples, Vec::len);
        for (field, found) in [
            ("signals", self.signals.nrows()),
            ("names", self.names.len()),
            ("cases", self.cases.len()),
            ("groups", self.groups.len()),
            ("times", length(&self.times)),
            ("temperatures", length(&self.temperatures)),
            ("weights", length(&self.weights)),
            ("orientations", self.orientations.as_ref().map_or(samples, Vec::len)),
        ] {
            if found != samples {
                return Err(LoadError::WrongLength { field, found, expected: samples });
            }
        }
        let carried = |numbers: &[f64]| numbers.iter().all(|number| Self::carries(*number));
        let lists = [&self.times, &self.temperatures, &self.weights];
        if carried(self.loads.as_slice())
            && carried(self.signals.as_slice())
            && lists.into_iter().flatten().all(|list| carried(list))
            && self.weights.iter().flatten().all(|weight| *weight >= 0.0)
        {
            return Ok(());
        }
        // Which one is none.
        for i in 0..samples {
            let not_finite =
                |column: String| LoadError::NotFinite { sample: self.names.get(i).into_owned(), column };
            for (j, axis) in self.axes.iter().enumerate() {
                if !Self::carries(self.loads[(i, j)]) {
                    return Err(not_finite(axis.name().to_owned()));
                }
            }
            for j in 0..self.gauges() {
                if !Self::carries(self.signals[(i, j)]) {
                    return Err(not_finite(format!("v{}", j + 1)));
                }
            }
            for (name, list) in
                [("t_s", &self.times), ("temperature_C", &self.temperatures), ("weight", &self.weights)]
            {
                if list
                    .as_ref()
                    .is_some_and(|list| !Self::carries(list[i]) || (name == "weight" && list[i] < 0.0))
                {
                    return Err(not_finite(name.to_owned()));
                }
            }
        }
        Ok(())
    }

    /// How many samples there are.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.loads.nrows()
    }

    /// How many gauges the sensor has.
    #[must_use]
    pub fn gauges(&self) -> usize {
        self.signals.ncols()
    }

    /// The greatest load of each axis \[N, N·m\]: the full scale, if the user names none. An axis
    /// that is never loaded gets 1, which [`crate::fit`] then calls unobserved.
    #[must_use]
    pub fn greatest_loads(&self) -> Vec<f64> {
        self.loads.column_iter().map(|column| column.amax()).map(|x| if x > 0.0 { x } else { 1.0 }).collect()
    }

    /// The samples for which `keep` says so, in order.
    #[must_use]
    pub fn select(&self, keep: impl Fn(usize) -> bool) -> Self {
        self.rows(&(0..self.samples()).filter(|i| keep(*i)).collect::<Vec<_>>())
    }

    /// These samples, which there must be.
    pub(crate) fn rows(&self, kept: &[usize]) -> Self {
        let pick =
            |list: &Option<Vec<f64>>| list.as_ref().map(|list| kept.iter().map(|i| list[*i]).collect());
        Self {
            axes: self.axes.clone(),
            loads: self.loads.select_rows(kept),
            signals: self.signals.select_rows(kept),
            signal_unit: self.signal_unit,
            names: self.names.select(kept),
            cases: kept.iter().map(|i| self.cases[*i]).collect(),
            groups: kept.iter().map(|i| self.groups[*i]).collect(),
            times: pick(&self.times),
            temperatures: pick(&self.temperatures),
            orientations: self.orientations.as_ref().map(|list| kept.iter().map(|i| list[*i]).collect()),
            zeros: self.zeros,
            weights: pick(&self.weights),
        }
    }

    /// Which samples have a reading at or beyond the ends of the converter's range, with the first
    /// gauge of each that has.
    #[must_use]
    pub fn saturated(&self, range: [f64; 2]) -> Vec<(usize, usize)> {
        let beyond = |value: &f64| !(*value > range[0] && *value < range[1]);
        self.signals
            .row_iter()
            .enumerate()
            .filter_map(|(i, row)| row.iter().position(beyond).map(|gauge| (i, gauge)))
            .collect()
    }

    /// The readings less the mean reading without load of their group: a tare per mounting.
    ///
    /// # Errors
    /// [`LoadError::NoZero`] if a group has no sample without load.
    pub fn tared_by_group(&self) -> Result<Self, LoadError> {
        let mut tared = Self { zeros: Zeros::OfRest, ..self.clone() };
        let mut groups = self.groups.clone();
        groups.sort_unstable();
        groups.dedup();
        for group in groups {
            let of_group: Vec<usize> = (0..self.samples()).filter(|i| self.groups[*i] == group).collect();
            let unloaded: Vec<usize> =
                of_group.iter().copied().filter(|i| self.loads.row(*i).amax() == 0.0).collect();
            if unloaded.is_empty() {
                return Err(LoadError::NoZero { group });
            }
            let zero = self.signals.select_rows(&unloaded).row_mean();
            for i in of_group {
                let mut row = tared.signals.row_mut(i);
                row -= &zero;
            }
        }
        Ok(tared)
    }
}

#[cfg(test)]
mod tests {
    use super::{LoadError, LoadTable};
    use crate::Axis;
    use crate::file::SignalUnit;
    use nalgebra::DMatrix;

    fn table() -> LoadTable {
        let loads =
            DMatrix::from_row_slice(4, 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
        let signals = DMatrix::from_row_slice(4, 2, &[1.0, 2.0, 3.0, 4.0, 10.0, 20.0, 11.0, 21.0]);
        let mut table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Count).unwrap();
        table.groups = vec![0, 0, 7, 7];
        table
    }

    #[test]
    fn each_group_has_its_own_zero() {
        let tared = table().tared_by_group().unwrap();
        assert_eq!(tared.signals.row(1), DMatrix::from_row_slice(1, 2, &[2.0, 2.0]).row(0));
        assert_eq!(tared.signals.row(3), DMatrix::from_row_slice(1, 2, &[1.0, 1.0]).row(0));
        let without = table().select(|i| i != 2);
        assert_eq!(without.tared_by_group(), Err(LoadError::NoZero { group: 7 }));
        assert_eq!(without.names.iter().collect::<Vec<_>>(), ["sample 1", "sample 2", "sample 4"]);
    }

    #[test]
    fn saturation_and_nonsense_are_named() {
        assert_eq!(table().saturated([1.0, 20.0]), [(0, 0), (2, 1), (3, 1)]);
        let mut bad = table();
        bad.signals[(2, 1)] = f64::NAN;
        let error = bad.validate().unwrap_err();
        assert!(error.to_string().contains("sample 3") && error.to_string().contains("v2"), "{error}");
        bad = table();
        bad.weights = Some(vec![1.0; 3]);
        assert!(matches!(bad.validate(), Err(LoadError::WrongLength { field: "weights", .. })));
        assert_eq!(table().greatest_loads(), [1.0, 2.0, 1.0]);
    }

    /// Whatever cannot be carried is told by its sample and its column; what can be is never blamed for it.
    #[test]
    fn the_number_that_is_none_is_named() {
        let whole = || LoadTable {
            times: Some(vec![-0.5, 0.0, 0.5, 1.0]),
            temperatures: Some(vec![-10.0, 20.0, 21.0, 22.0]),
            weights: Some(vec![1.0, 0.0, 2.0, 1.0]),
            ..table()
        };
        assert_eq!(whole().validate(), Ok(()));
        type Put = fn(&mut LoadTable, usize, f64);
        let columns: [(&str, Put); 5] = [
            ("fy", |table, i, value| table.loads[(i, 1)] = value),
            ("v2", |table, i, value| table.signals[(i, 1)] = value),
            ("t_s", |table, i, value| table.times.as_mut().unwrap()[i] = value),
            ("temperature_C", |table, i, value| table.temperatures.as_mut().unwrap()[i] = value),
            ("weight", |table, i, value| table.weights.as_mut().unwrap()[i] = value),
        ];
        let most = LoadTable::GREATEST;
        for (name, put) in columns {
            for i in 0..4 {
                let tried = |value: f64| {
                    let mut table = whole();
                    put(&mut table, i, value);
                    table.validate()
                };
                let named = || {
                    Err(LoadError::NotFinite { sample: format!("sample {}", i + 1), column: name.to_owned() })
                };
                assert_eq!((tried(0.0), tried(most)), (Ok(()), Ok(())), "{name}");
                for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, most * 1.001, most * -1.001] {
                    assert_eq!(tried(bad), named(), "{name} {bad}");
                }
                assert_eq!(tried(-1.0), if name == "weight" { named() } else { Ok(()) });
            }
        }
    }

    #[test]
    fn lists_of_other_lengths_are_named() {
        let quaternion = [0.0, 0.0, 0.0, 1.0];
        let with = |change: fn(&mut LoadTable)| {
            let mut table = table();
            change(&mut table);
            match table.validate() {
                Err(LoadError::WrongLength { field, found, expected }) => (field, found, expected),
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(with(|table| table.axes.truncate(2)), ("axes", 2, 3));
        assert_eq!(with(|table| table.signals = DMatrix::zeros(3, 2)), ("signals", 3, 4));
        assert_eq!(with(|table| table.names = table.names.select(&[0, 1])), ("names", 2, 4));
        assert_eq!(with(|table| table.cases.push(4)), ("cases", 5, 4));
        assert_eq!(with(|table| table.groups.truncate(1)), ("groups", 1, 4));
        assert_eq!(with(|table| table.times = Some(vec![0.0; 5])), ("times", 5, 4));
        assert_eq!(with(|table| table.temperatures = Some(vec![])), ("temperatures", 0, 4));
        assert_eq!(
            with(|table| table.orientations = Some(vec![[0.0, 0.0, 0.0, 1.0]; 3])),
            ("orientations", 3, 4)
        );
        let turned = LoadTable { orientations: Some(vec![quaternion; 4]), ..table() };
        assert_eq!(turned.validate(), Ok(()));
        for (what, table) in [
            ("samples", table().select(|_| false)),
            ("load columns", LoadTable { axes: vec![], loads: DMatrix::zeros(4, 0), ..table() }),
            ("signal columns", LoadTable { signals: DMatrix::zeros(4, 0), ..table() }),
        ] {
            assert_eq!(table.validate(), Err(LoadError::Empty { what }));
        }
    }
}
