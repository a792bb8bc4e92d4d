//! Every shared recording that fits a layout is read to its end; those that do not say why.
//!
//! The recordings are not part of this project: see `fingertip_test_support::recording`.

use std::path::Path;

use fingertip_recordings::{
    AssumedUnits, ForceUnit, HeaderProblem, Quality, ReaderOptions, RecordingError, RecordingReader,
    TorqueUnit,
};
use fingertip_test_support::recording;

/// Reads to the end; how many rows gave a wrench or signals of each sensor.
fn read(path: &Path, options: ReaderOptions) -> (Vec<u64>, Quality, RecordingReader<std::fs::File>) {
    let mut reader = RecordingReader::open_with(path, options).unwrap();
    let (wrenches, signals) = (reader.layout().wrenches().to_vec(), reader.layout().signals().to_vec());
    let mut given = vec![0; wrenches.len() + signals.len()];
    while let Some(row) = reader.next_row().unwrap() {
        for (count, sensor) in given.iter_mut().zip(&wrenches) {
            *count += u64::from(row.wrench(sensor).is_some());
        }
        for (count, sensor) in given.iter_mut().skip(wrenches.len()).zip(&signals) {
            *count += u64::from(match sensor.count() {
                6 => row.signals::<6>(sensor).is_some(),
                8 => row.signals::<8>(sensor).is_some(),
                count => panic!("a sensor with {count} signals"),
            });
        }
    }
    (given, *reader.quality(), reader)
}

#[test]
fn two_nano17_sensors_in_newton_millimetres() {
    let Some(path) = recording("nano17_three_finger/roll.csv") else { return };
    let (given, quality, reader) = read(&path, ReaderOptions::default());
    let names: Vec<&str> = reader.layout().wrenches().iter().map(|sensor| sensor.name()).collect();
    assert_eq!((names, given), (vec!["s1", "s2"], vec![1602, 1602]));
    assert_eq!(quality.rows, 1602);
    // The first torque of the file is 0.218252 N·mm.
    let mut reader = RecordingReader::open(&path).unwrap();
    let thumb = reader.layout().wrench("S1").unwrap().clone();
    let wrench = reader.next_row().unwrap().unwrap().wrench(&thumb).unwrap();
    assert!((wrench.torque().x - 0.218_252e-3).abs() < 1e-18);
    assert!((wrench.force().z - 0.012_455).abs() < 1e-18);
}

#[test]
fn volts_of_two_sensors_without_units() {
    let Some(path) = recording("ati_delta_raw_1khz/quiet_drives_off.csv") else { return };
    let (given, quality, reader) = read(&path, ReaderOptions::default());
    let names: Vec<&str> = reader.layout().signals().iter().map(|sensor| sensor.name()).collect();
    assert_eq!((names, given), (vec!["wallace", "gromit"], vec![14_012, 14_012]));
    assert_eq!((quality.rows, quality.gaps.count(), quality.unusable_rows.count()), (14_012, 0, 0));
}

#[test]
fn volts_beside_columns_of_something_else() {
    let Some(path) = recording("ati_delta_raw_1khz/heave_1hz_after_recal.csv") else { return };
    let (given, _, reader) = read(&path, ReaderOptions::default());
    assert_eq!(given, [24_022]);
    assert_eq!(reader.layout().ignored().collect::<Vec<_>>(), ["heave_mm", "pitch_deg"]);
}

#[test]
fn two_wrenches_told_apart_by_a_word_in_the_middle() {
    let Some(path) = recording("fareke_6axis_crosstalk/readings.csv") else { return };
    let (given, quality, reader) = read(&path, ReaderOptions::default());
    let names: Vec<&str> = reader.layout().wrenches().iter().map(|sensor| sensor.name()).collect();
    assert_eq!(names, ["meas", ""]);
    assert_eq!(quality.rows, 60);
    assert!(given.iter().all(|count| *count == 60 - quality.repeated_rows.count()));
}

#[test]
fn a_wrench_without_units_is_read_only_if_the_user_states_them() {
    let Some(path) = recording("ati_axia80_gravity/poses7.csv") else { return };
    let error = RecordingReader::open(&path).unwrap_err();
    let RecordingError::Header { problem: HeaderProblem::MissingUnit { column, example }, .. } = error else {
        panic!("{error}")
    };
    assert_eq!((column.as_str(), example.as_str()), ("Fx", "Fx_N"));
    let assumed_units =
        AssumedUnits { force: Some(ForceUnit::Newton), torque: Some(TorqueUnit::NewtonMetre) };
    let (given, ..) = read(&path, ReaderOptions { assumed_units, ..ReaderOptions::default() });
    assert_eq!(given, [7]);
}

#[test]
fn eight_signals_beside_a_wrench_without_units() {
    let Some(path) = recording("jonurce_fts8/samples_dec25.csv") else { return };
    let (given, quality, reader) = read(&path, ReaderOptions::default());
    assert_eq!(reader.layout().left_out().len(), 1);
    assert_eq!(given, [quality.rows - quality.unusable_rows.count()]);
    println!("{quality}");
}

#[test]
fn the_gaps_of_the_tribometer_are_those_its_readme_tells() {
    let Some(path) = recording("friction_tribometer/reciprocating.csv") else { return };
    // It has no wrench: friction and normal force of a tribometer. Named as a wrench it can be read.
    let text = std::fs::read_to_string(&path).unwrap();
    let header = "t_s,fx_N,fy_N,fz_N";
    let body = text.split_once('\n').unwrap().1;
    let error = RecordingReader::new("renamed.csv", format!("{header}\n{body}").as_bytes()).unwrap_err();
    assert!(error.to_string().contains("lacks tx, ty, tz"), "{error}");
    let whole: String = body.lines().map(|line| format!("{line},0,0,0\n")).collect();
    let file = format!("{header},tx_Nm,ty_Nm,tz_Nm\n{whole}");
    let mut reader = RecordingReader::new("renamed.csv", file.as_bytes()).unwrap();
    while reader.next_row().unwrap().is_some() {}
    assert_eq!(reader.quality().rows, 42_579);
    // 178 steps of 10 ms and one of 9 ms, where the usual one is 5 ms.
    assert_eq!(reader.quality().gaps.count(), 179);
}

#[test]
fn forces_alone_and_tables_of_numbers_are_no_recording() {
    for (file, said) in [
        ("fareke_3axis_raw/cells.csv", "lacks tx, ty, tz"),
        ("friction_tribometer/strokes.csv", "no column is a force"),
        ("ati_delta_raw_1khz/gromit_si660_60_matrix.csv", "no column is a force"),
    ] {
        let Some(path) = recording(file) else { continue };
        let error = RecordingReader::open(&path).unwrap_err();
        assert!(error.to_string().contains(said), "{error}");
    }
}
