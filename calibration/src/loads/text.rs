//! Tables of loads as CSV.

use std::collections::HashMap;
use std::io::Read;

use nalgebra::DMatrix;

use super::{LoadError, LoadReader, LoadRow, LoadTable, Names};
use crate::Axis;

impl LoadTable {
    /// Reads CSV with a header, and the names of the columns that it ignored.
    ///
    /// # The header
    /// Columns are named as those of recordings, with a unit; columns with the name of another sensor in front are
    /// ignored.
    ///
    /// | column | meaning |
    /// |---|---|
    /// | `fx_N` `fy_N` `fz_N` `tx_Nm` `ty_Nm` `tz_Nm` | the known load on the sensor about its origin; also `mx_…`; in other units too: `mN`, `gf`, `lbf`, `Nmm`, `lbf-in`, … |
    /// | `v1_V` … `vN_V` | the readings, numbered from 1; units `V`, `mV`, `count`, `mVpV` (mV/V), `strain`; a force or torque unit for a sensor that gives these already |
    /// | `case` | any text; samples with the same text are one load case, left out together in cross-validation (without this column: samples with the same load) |
    /// | `group` | any text; samples of one mounting, which share a zero |
    /// | `name` | what reports call the sample |
    /// | `t_s` (or `t_ms` …), `temperature_C`, `weight` | time, temperature, weight |
    /// | `qx`, `qy`, `qz`, `qw` | orientation of the sensor (or its flange) in the base frame, along which the weight of what hangs on it is added to the loads (`calibrate --payload`) |
    ///
    /// An axis without column is taken as not measured, unless `axes` asks for it, which then is an
    /// error.
    ///
    /// # Errors
    /// [`LoadError`], naming line and column.
    pub fn from_csv(reader: impl Read) -> Result<(Self, Vec<String>), LoadError> {
        let mut reader = LoadReader::new(reader)?;
        let table = Self::from_reader(&mut reader)?;
        Ok((table, reader.ignored()))
    }

    /// Reads what a reader has still to give.
    ///
    /// # Errors
    /// [`LoadError`], naming line and column.
    pub fn from_reader(reader: &mut LoadReader<impl Read>) -> Result<Self, LoadError> {
        Self::from_reader_with(reader, |_| {})
    }

    /// As [`from_reader`](Self::from_reader); each row is shown as it is read, for those who do something else with it
    /// meanwhile.
    ///
    /// # Errors
    /// [`LoadError`], naming line and column.
    pub fn from_reader_with(
        reader: &mut LoadReader<impl Read>,
        mut each: impl FnMut(&LoadRow),
    ) -> Result<Self, LoadError> {
        let (mut loads, mut signals) = (Vec::new(), Vec::new());
        let (mut times, mut temperatures, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        let (mut names, mut lines) = (Vec::new(), Vec::new());
        let (mut cases, mut groups) = (Vec::new(), Vec::new());
        let mut orientations = Vec::new();
        while let Some(row) = reader.next_row()? {
            each(row);
            loads.extend_from_slice(&row.loads);
            signals.extend_from_slice(&row.signals);
            times.extend(row.time);
            temperatures.extend(row.temperature);
            weights.extend(row.weight);
            orientations.extend(row.orientation);
            match &row.name {
                Some(name) => names.push(name.clone()),
                None => lines.push(row.line),
            }
            cases.extend(row.case.clone());
            groups.extend(row.group.clone());
        }
        // Every row has a name, or none.
        let names = if names.is_empty() { Names::numbered("line", lines) } else { names.into() };
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
        Ok(table)
    }
}

fn numbered(texts: &[String]) -> Vec<usize> {
    let mut seen = HashMap::new();
    texts
        .iter()
        .map(|text| {
            let next = seen.len();
            *seen.entry(text).or_insert(next)
        })
        .collect()
}

/// Samples with the very same load are one case: numbers from 0.
pub(crate) fn same_loads(loads: &DMatrix<f64>) -> Vec<usize> {
    let mut order: Vec<([u64; Axis::ALL.len()], usize)> = (0..loads.nrows())
        .map(|i| {
            let mut bits = [0; Axis::ALL.len()];
            // Adding zero makes −0 and 0 the same bits.
            bits.iter_mut().zip(loads.row(i).iter()).for_each(|(bits, x)| *bits = (x + 0.0).to_bits());
            (bits, i)
        })
        .collect();
    order.sort_unstable();
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
    use super::{LoadReader, LoadTable};
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
        assert_eq!(table.names.iter().collect::<Vec<_>>(), ["up", "down", "again"]);
        assert_eq!(table.times, Some(vec![0.0, 1.0, 2.0]));
    }

    #[test]
    fn without_cases_the_same_load_is_one() {
        let text = "fx_N,fy_N,v1_count\n1,0,5\n0,1,6\n1,-0,7\n";
        let (table, _) = LoadTable::from_csv(text.as_bytes()).unwrap();
        assert_eq!(table.cases[0], table.cases[2]);
        assert_ne!(table.cases[0], table.cases[1]);
        assert_eq!(table.names.get(2), "line 4");
    }

    /// As recordings are: other separators, blank lines, lines that are cut or endless.
    #[test]
    fn tables_are_read_as_recordings_are() {
        let plain = LoadTable::from_csv("fx_N,v1_V\n1,2\n3,4\n".as_bytes()).unwrap().0;
        for text in [
            "fx_N;v1_V\r\n1;2\r\n\r\n3;4\r\n",
            "\u{feff}# by hand\n\nfx_N\tv1_V\n1\t2\n  \n3\t4",
            "fx_N,v1_V\n1,2\n3,4\n5",
            "fx_N,v1_V\n1,2\n3,4\n5,-",
        ] {
            let table = LoadTable::from_csv(text.as_bytes()).unwrap().0;
            assert_eq!(
                (table.loads, table.signals),
                (plain.loads.clone(), plain.signals.clone()),
                "{text:?}"
            );
        }
        let mut reader = LoadReader::new("fx_N,v1_V\n1,2\n3".as_bytes()).unwrap();
        assert_eq!(LoadTable::from_reader(&mut reader).unwrap().samples(), 1);
        assert_eq!(reader.cut_line(), Some(3));
        let endless = std::io::Read::take(std::io::repeat(b'7'), 1 << 30);
        let error = LoadTable::from_csv(std::io::Read::chain("fx_N,v1_V\n1,2\n".as_bytes(), endless));
        assert!(error.unwrap_err().to_string().contains("line 3: is longer than 1048576 bytes"));
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
            ("fx_N,v1001_V\n1,2\n", ["line 1", "v1001_V"]),
            // More than a fit can carry, whichever the unit.
            (
                "fx_N,v1_V\n1e308,2\n",
                ["line 2, column `fx_N`: \"1e308\" is not", "beyond 1e100 in SI. Mend the cell"],
            ),
            ("fx_N,v1_V\n1,-1.1e100\n", ["line 2", "v1_V"]),
            ("fx_kN,v1_V\n1e99,2\n", ["line 2", "fx_kN"]),
            ("fx_kN,v1_V\n1e308,2\n", ["line 2", "fx_kN"]),
            ("fx_N,v1_kN\n1,1e308\n", ["line 2", "v1_kN"]),
            ("fx_N,v1_V,t_s\n1,2,inf\n", ["line 2", "t_s"]),
            ("fx_N,v1_V,qx,qy,qz\n1,2,0,0,0\n", ["line 1", "qx"]),
            ("fx_N,v1_V,qx,qy,qz,qx\n1,2,0,0,0,0\n", ["line 1", "qx"]),
        ] {
            let error = LoadTable::from_csv(text.as_bytes()).unwrap_err().to_string();
            assert!(names.iter().all(|name| error.contains(name)), "{text}: {error}");
        }
        assert!(LoadTable::from_csv("fx_N,v1_V\n".as_bytes()).is_err());
    }
}
