//! Tables of loads as CSV.

use std::io::Read;

use nalgebra::DMatrix;

use super::{LoadError, LoadTable};
use crate::Axis;
use crate::file::SignalUnit;

/// What a column of the header means.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// A load and the size of its unit in SI.
    Load(Axis, f64),
    /// A signal: number of the gauge from 0, its unit, and the unit's size.
    Signal(usize, SignalUnit, f64),
    Case,
    Group,
    Name,
    Time,
    Temperature,
    Weight,
    /// Part of the orientation: x, y, z, w.
    Quaternion(usize),
    Ignored,
}

impl LoadTable {
    /// Reads CSV with a header, and the names of the columns that it ignored.
    ///
    /// # The header
    /// Names carry their unit after the last underscore, as in recordings.
    ///
    /// | column | meaning |
    /// |---|---|
    /// | `fx_N` `fy_N` `fz_N` `tx_Nm` `ty_Nm` `tz_Nm` | the known load on the sensor about its origin; also `mx_…`; units as in [`crate::units`]: `mN`, `gf`, `lbf`, `Nmm`, `lbfin`, … |
    /// | `v1_V` … `vN_V` | the readings, numbered from 1; units `V`, `mV`, `count`, `mVpV` (mV/V), `strain`; a force or torque unit for a sensor that gives these already |
    /// | `case` | any text; samples with the same text are one load case, left out together in cross-validation (without this column: samples with the same load) |
    /// | `group` | any text; samples of one mounting, which share a zero |
    /// | `name` | what reports call the sample |
    /// | `t_s`, `temperature_C`, `weight` | time, temperature, weight |
    /// | `qx`, `qy`, `qz`, `qw` | orientation of the sensor (or its flange) in the base frame, for what hangs on it: see [`carrying`](Self::carrying) |
    ///
    /// An axis without column is taken as not measured, unless `axes` asks for it, which then is an
    /// error.
    ///
    /// # Errors
    /// [`LoadError`], naming line and column.
    pub fn from_csv(reader: impl Read) -> Result<(Self, Vec<String>), LoadError> {
        let mut reader = LoadReader::new(reader)?;
        let (mut loads, mut signals) = (Vec::new(), Vec::new());
        let (mut times, mut temperatures, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        let (mut names, mut cases, mut groups) = (Vec::new(), Vec::new(), Vec::new());
        let mut orientations = Vec::new();
        while let Some(row) = reader.next_row()? {
            loads.extend_from_slice(&row.loads);
            signals.extend_from_slice(&row.signals);
            times.extend(row.time);
            temperatures.extend(row.temperature);
            weights.extend(row.weight);
            orientations.extend(row.orientation);
            names.push(row.name.clone().unwrap_or_else(|| format!("line {}", row.line)));
            cases.extend(row.case.clone());
            groups.extend(row.group.clone());
        }
        let samples = names.len();
        let loads = DMatrix::from_row_slice(samples, reader.axes().len(), &loads);
        let signals = DMatrix::from_row_slice(samples, reader.gauges(), &signals);
        let mut table = Self::new(reader.axes(), loads, signals, reader.signal_unit())?;
        table.names = names;
        table.cases = if cases.is_empty() { same_loads(&table.loads) } else { numbered(&cases) };
        if !groups.is_empty() {
            table.groups = numbered(&groups);
        }
        let some = |list: Vec<f64>| (!list.is_empty()).then_some(list);
        (table.times, table.temperatures, table.weights) = (some(times), some(temperatures), some(weights));
        table.orientations = (!orientations.is_empty()).then_some(orientations);
        table.validate()?;
        Ok((table, reader.ignored()))
    }
}

/// Reads a table of loads row by row, in the memory of one row: the format of
/// [`LoadTable::from_csv`].
#[derive(Debug)]
pub struct LoadReader<R> {
    csv: csv::Reader<R>,
    record: csv::StringRecord,
    header: csv::StringRecord,
    columns: Vec<Column>,
    axes: Vec<Axis>,
    unit: SignalUnit,
    row: LoadRow,
}

/// One row of a table of loads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadRow {
    /// Line of the file, counting from 1.
    pub line: u64,
    /// The known load \[N, N·m\], in the order of the axes.
    pub loads: Vec<f64>,
    /// The readings.
    pub signals: Vec<f64>,
    /// Time \[s\].
    pub time: Option<f64>,
    /// Temperature \[°C\].
    pub temperature: Option<f64>,
    /// Weight.
    pub weight: Option<f64>,
    /// Quaternion x, y, z, w.
    pub orientation: Option<[f64; 4]>,
    /// What to call the sample.
    pub name: Option<String>,
    /// Its load case.
    pub case: Option<String>,
    /// Its group.
    pub group: Option<String>,
}

fn bad(line: u64, column: &str, message: String) -> LoadError {
    LoadError::BadText { line, column: column.to_owned(), message }
}

impl<R: Read> LoadReader<R> {
    /// Reads the header.
    ///
    /// # Errors
    /// [`LoadError::BadText`], naming the column.
    pub fn new(reader: R) -> Result<Self, LoadError> {
        let mut csv = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(reader);
        let header = csv.headers().map_err(|error| bad(1, "", error.to_string()))?.clone();
        let columns = header
            .iter()
            .map(|name| parse_name(name).map_err(|message| bad(1, name, message)))
            .collect::<Result<Vec<_>, _>>()?;
        let (axes, gauges, unit) = layout(&columns).map_err(|(column, message)| bad(1, &column, message))?;
        let parts: Vec<usize> = columns
            .iter()
            .filter_map(|column| if let Column::Quaternion(part) = column { Some(*part) } else { None })
            .collect();
        let whole = parts.len() == 4 && (0..4).all(|part| parts.contains(&part));
        if !(parts.is_empty() || whole) {
            return Err(bad(1, "qx", "an orientation takes qx, qy, qz and qw, each once".to_owned()));
        }
        let row = LoadRow {
            loads: vec![0.0; axes.len()],
            signals: vec![0.0; gauges],
            orientation: (!parts.is_empty()).then_some([0.0; 4]),
            ..LoadRow::default()
        };
        Ok(Self { csv, record: csv::StringRecord::new(), header, columns, axes, unit, row })
    }

    /// The axes that have loads.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// How many gauges there are.
    #[must_use]
    pub fn gauges(&self) -> usize {
        self.row.signals.len()
    }

    /// Unit of the readings.
    #[must_use]
    pub const fn signal_unit(&self) -> SignalUnit {
        self.unit
    }

    /// Names of the columns that are not used.
    #[must_use]
    pub fn ignored(&self) -> Vec<String> {
        let ignored = self.header.iter().zip(&self.columns).filter(|(_, column)| **column == Column::Ignored);
        ignored.map(|(name, _)| name.to_owned()).collect()
    }

    /// The next row; `None` at the end.
    ///
    /// # Errors
    /// [`LoadError::BadText`], naming line and column.
    pub fn next_row(&mut self) -> Result<Option<&LoadRow>, LoadError> {
        let more = self.csv.read_record(&mut self.record).map_err(|error| {
            let line = error.position().map_or(0, csv::Position::line);
            bad(line, "", error.to_string())
        })?;
        if !more {
            return Ok(None);
        }
        let line = self.record.position().map_or(0, csv::Position::line);
        let row = &mut self.row;
        row.line = line;
        for ((column, name), text) in self.columns.iter().zip(&self.header).zip(&self.record) {
            let number = || match text.parse::<f64>() {
                Ok(number) if number.is_finite() => Ok(number),
                Ok(_) => Err(bad(line, name, format!("{text:?} is not a finite number"))),
                Err(_) => Err(bad(line, name, format!("{text:?} is not a number"))),
            };
            match *column {
                Column::Load(axis, size) => {
                    if let Some(slot) = self.axes.iter().position(|a| *a == axis) {
                        row.loads[slot] = number()? * size;
                    }
                }
                Column::Signal(gauge, _, size) => row.signals[gauge] = number()? * size,
                Column::Time => row.time = Some(number()?),
                Column::Temperature => row.temperature = Some(number()?),
                Column::Weight => row.weight = Some(number()?),
                Column::Quaternion(part) => {
                    if let Some(orientation) = &mut row.orientation {
                        orientation[part] = number()?;
                    }
                }
                Column::Case => row.case = Some(text.to_owned()),
                Column::Group => row.group = Some(text.to_owned()),
                Column::Name => row.name = Some(text.to_owned()),
                Column::Ignored => {}
            }
        }
        Ok(Some(row))
    }
}

/// Readings without load.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// Samples × gauges.
    pub signals: DMatrix<f64>,
    /// Unit of the signals.
    pub unit: SignalUnit,
    /// Temperature of each sample \[°C\], if the file has them.
    pub temperatures: Option<Vec<f64>>,
}

/// Reads the signals alone of a CSV with the header of [`LoadTable::from_csv`], and their temperatures.
/// Columns of loads are ignored.
///
/// # Errors
/// [`LoadError`], naming line and column.
pub fn signals_from_csv(reader: impl Read) -> Result<Rest, LoadError> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(reader);
    let header = reader.headers().map_err(|error| bad(1, "", error.to_string()))?.clone();
    let mut columns = Vec::new();
    for name in &header {
        // A load in an unknown unit does not matter here.
        columns.push(match parse_name(name) {
            Ok(Column::Load(..)) => Column::Ignored,
            Ok(column) => column,
            Err(_) if name.starts_with(['f', 't', 'm', 'F', 'T', 'M']) => Column::Ignored,
            Err(message) => return Err(bad(1, name, message)),
        });
    }
    let (_, gauges, unit) = signal_layout(&columns).map_err(|(column, message)| bad(1, &column, message))?;
    let (mut signals, mut temperatures) = (Vec::new(), Vec::new());
    let mut samples = 0;
    for record in reader.records() {
        let record = record
            .map_err(|error| bad(error.position().map_or(0, csv::Position::line), "", error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let start = signals.len();
        signals.resize(start + gauges, 0.0);
        for ((column, name), text) in columns.iter().zip(&header).zip(&record) {
            let number = || {
                let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
                number.ok_or_else(|| bad(line, name, format!("{text:?} is not a finite number")))
            };
            match *column {
                Column::Signal(gauge, _, size) => signals[start + gauge] = number()? * size,
                Column::Temperature => temperatures.push(number()?),
                _ => {}
            }
        }
        samples += 1;
    }
    let signals = DMatrix::from_row_slice(samples, gauges, &signals);
    Ok(Rest { signals, unit, temperatures: (!temperatures.is_empty()).then_some(temperatures) })
}

fn parse_name(name: &str) -> Result<Column, String> {
    match name {
        "case" | "level" => return Ok(Column::Case),
        "group" => return Ok(Column::Group),
        "name" => return Ok(Column::Name),
        "t_s" => return Ok(Column::Time),
        "temperature_C" => return Ok(Column::Temperature),
        "weight" => return Ok(Column::Weight),
        "qx" => return Ok(Column::Quaternion(0)),
        "qy" => return Ok(Column::Quaternion(1)),
        "qz" => return Ok(Column::Quaternion(2)),
        "qw" => return Ok(Column::Quaternion(3)),
        _ => {}
    }
    let (stem, unit) = name.rsplit_once('_').unwrap_or((name, ""));
    if let Some(axis) = Axis::from_name(stem) {
        let size = axis.unit_size(unit).ok_or_else(|| {
            let quantity = if axis.is_torque() { "torque" } else { "force" };
            format!("{unit:?} is not a unit of {quantity}; write such as `fx_N` or `tx_Nm`")
        })?;
        return Ok(Column::Load(axis, size));
    }
    let number = stem.strip_prefix('v').and_then(|digits| digits.parse::<usize>().ok());
    let Some(number) = number else { return Ok(Column::Ignored) };
    if number == 0 || number > 1000 {
        return Err("gauges are numbered from 1".to_owned());
    }
    let (unit, size) = match unit {
        "V" => (SignalUnit::Volt, 1.0),
        "mV" => (SignalUnit::Volt, 1e-3),
        "count" | "counts" => (SignalUnit::Count, 1.0),
        "mVpV" | "mV/V" => (SignalUnit::MillivoltPerVolt, 1.0),
        "strain" => (SignalUnit::Strain, 1.0),
        _ => match Axis::Fx.unit_size(unit).or_else(|| Axis::Tx.unit_size(unit)) {
            Some(size) => (SignalUnit::Wrench, size),
            None => {
                return Err(format!("{unit:?} is not a unit of signals; write such as `v1_V`, `v1_count`"));
            }
        },
    };
    Ok(Column::Signal(number - 1, unit, size))
}

type Layout = Result<(Vec<Axis>, usize, SignalUnit), (String, String)>;

/// Axes in order, number of gauges, unit; or the column that is wrong and why.
fn layout(columns: &[Column]) -> Layout {
    let found = signal_layout(columns)?;
    if found.0.is_empty() {
        return Err(("fx_N".to_owned(), "there is no column of loads".to_owned()));
    }
    Ok(found)
}

/// As [`layout`], whether or not there are loads.
fn signal_layout(columns: &[Column]) -> Layout {
    let mut axes = Vec::new();
    let mut gauges = Vec::new();
    let mut unit = None;
    for column in columns {
        match *column {
            Column::Load(axis, _) if axes.contains(&axis) => {
                return Err((axis.name().to_owned(), "stands twice".to_owned()));
            }
            Column::Load(axis, _) => axes.push(axis),
            Column::Signal(gauge, of, _) => {
                if gauges.contains(&gauge) {
                    return Err((format!("v{}", gauge + 1), "stands twice".to_owned()));
                }
                if unit.is_some_and(|unit| unit != of) {
                    return Err((format!("v{}", gauge + 1), "is in another unit than v1".to_owned()));
                }
                unit = Some(of);
                gauges.push(gauge);
            }
            _ => {}
        }
    }
    axes.sort_unstable();
    if let Some(missing) = (0..gauges.len()).find(|gauge| !gauges.contains(gauge)) {
        return Err((format!("v{}", missing + 1), "is missing".to_owned()));
    }
    match unit {
        None => Err(("v1_V".to_owned(), "there is no column of signals".to_owned())),
        Some(unit) => Ok((axes, gauges.len(), unit)),
    }
}

fn numbered(texts: &[String]) -> Vec<usize> {
    let mut seen: Vec<&String> = Vec::new();
    texts
        .iter()
        .map(|text| {
            seen.iter().position(|other| *other == text).unwrap_or_else(|| {
                seen.push(text);
                seen.len() - 1
            })
        })
        .collect()
}

/// Samples with the very same load are one case.
fn same_loads(loads: &DMatrix<f64>) -> Vec<usize> {
    let mut order: Vec<(Vec<u64>, usize)> = (0..loads.nrows())
        // Adding zero makes −0 and 0 the same bits.
        .map(|i| (loads.row(i).iter().map(|x| (x + 0.0).to_bits()).collect(), i))
        .collect();
    order.sort();
    let mut cases = vec![0; loads.nrows()];
    let mut case = 0;
    for (i, (key, sample)) in order.iter().enumerate() {
        if i > 0 && order[i - 1].0 != *key {
            case += 1;
        }
        cases[*sample] = case;
    }
    cases
}

#[cfg(test)]
mod tests {
    use super::LoadTable;
    use crate::Axis;
    use crate::file::SignalUnit;

    #[test]
    fn header_is_understood() {
        let text = "# a rig\nname,case,group,fz_lbf,fx_gf,mx_Nmm,v2_mV,v1_mV,t_s,note\n\
                    up,1,a,1,1000,5,20,10,0,hello\n\
                    down,2,a,0,0,0,40,30,1,world\n\
                    again,1,b,-1,0,-5,60,50,2,\n";
        let (table, ignored) = LoadTable::from_csv(text.as_bytes()).unwrap();
        assert_eq!(ignored, ["note"]);
        assert_eq!(table.axes, [Axis::Fx, Axis::Fz, Axis::Tx]);
        assert!((table.loads[(0, 0)] - 9.80665).abs() < 1e-15);
        assert!((table.loads[(0, 1)] - 4.448_221_615_260_5).abs() < 1e-15);
        assert!((table.loads[(2, 2)] + 0.005).abs() < 1e-18);
        assert!((table.signals[(2, 1)] - 0.06).abs() < 1e-18);
        assert_eq!((table.signal_unit, table.samples(), table.gauges()), (SignalUnit::Volt, 3, 2));
        assert_eq!((table.cases, table.groups), (vec![0, 1, 0], vec![0, 0, 1]));
        assert_eq!(table.names, ["up", "down", "again"]);
        assert_eq!(table.times, Some(vec![0.0, 1.0, 2.0]));
    }

    #[test]
    fn without_cases_the_same_load_is_one() {
        let text = "fx_N,fy_N,v1_count\n1,0,5\n0,1,6\n1,-0,7\n";
        let (table, _) = LoadTable::from_csv(text.as_bytes()).unwrap();
        assert_eq!(table.cases[0], table.cases[2]);
        assert_ne!(table.cases[0], table.cases[1]);
        assert_eq!(table.names[2], "line 4");
    }

    #[test]
    fn errors_name_line_and_column() {
        for (text, names) in [
            ("fx_furlong,v1_V\n1,2\n", ["line 1", "fx_furlong"]),
            ("fx,v1_V\n1,2\n", ["line 1", "fx"]),
            ("fx_N,v1_V\n1,x\n", ["line 2", "v1_V"]),
            ("fx_N,v1_V\n1,2\nnan,3\n", ["line 3", "fx_N"]),
            ("fx_N,v1_V\n1,2,3\n", ["line 2", "2"]),
            ("fx_N,v2_V\n1,2\n", ["v1", "missing"]),
            ("fx_N,v1_V,v2_count\n1,2,3\n", ["v2", "another unit"]),
            ("fx_N,fx_N,v1_V\n1,2,3\n", ["fx", "twice"]),
            ("fx_N\n1\n", ["v1", "signals"]),
            ("v1_V\n1\n", ["fx_N", "loads"]),
            ("fx_N,v1_V,weight\n1,2,-3\n", ["line 2", "weight"]),
            ("fx_N,v0_V\n1,2\n", ["line 1", "v0_V"]),
        ] {
            let error = LoadTable::from_csv(text.as_bytes()).unwrap_err().to_string();
            assert!(names.iter().all(|name| error.contains(name)), "{text}: {error}");
        }
        assert!(LoadTable::from_csv("fx_N,v1_V\n".as_bytes()).is_err());
    }
}
