//! Tables of loads in CSV.
#![no_main]

use fingertip_calibration::loads::{Columns, LoadReader, LoadTable};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let table = LoadTable::from_csv(bytes);
    if let Ok((table, _)) = &table {
        assert!(table.validate().is_ok());
        assert!(table.loads.iter().chain(table.signals.iter()).all(|number| number.is_finite()));
    }
    // Row by row the same numbers come.
    if let Ok(mut reader) = LoadReader::new(bytes) {
        let mut rows = 0;
        while let Ok(Some(row)) = reader.next_row() {
            assert!(row.loads.iter().chain(&row.signals).all(|number| number.is_finite()));
            if let Ok((table, _)) = &table {
                assert!(table.loads.row(rows).iter().eq(&row.loads));
                assert!(table.signals.row(rows).iter().eq(&row.signals));
            }
            rows += 1;
        }
        if let Ok((table, _)) = &table {
            assert_eq!(table.samples(), rows);
        }
    } else {
        assert!(table.is_err());
    }
    if let Ok(columns) = Columns::from_csv(bytes)
        && let Ok((axes, loads)) = columns.loads()
    {
        assert_eq!(loads.shape(), (columns.rows(), axes.len()));
        assert!(loads.iter().all(|load| load.is_finite()));
        let _ = columns.wrenches();
    }
});
