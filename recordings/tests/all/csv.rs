//! The reader against files that are made to be known.

use fingertip_recordings::{
    ContactCells, Quality, ReaderOptions, RecordingError, RecordingReader, RecordingWriter, RenamedColumn,
    Schema, SignalUnit,
};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;
use proptest::prelude::*;

const WRENCH: &str = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";

fn first_wrench(header: &str, row: &str) -> Result<[f64; 6], RecordingError> {
    let file = format!("{header}\n{row}\n");
    let mut reader = RecordingReader::new("test.csv", file.as_bytes())?;
    let sensor = reader.layout().only_wrench().cloned().map_err(|problem| reader.header_error(problem))?;
    let row = reader.next_row()?.unwrap();
    Ok(row.wrench(&sensor).unwrap().components().into())
}

/// All rows: line, usable, and what stood in the marks.
fn quality_of(file: &str) -> Quality {
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    while reader.next_row().unwrap().is_some() {}
    *reader.quality()
}

#[test]
fn units_are_converted_by_their_names() {
    // (unit of force, in N), (unit of torque, in N·m): from the definitions of pound and inch.
    let pound = 0.453_592_37 * 9.806_65;
    let forces = [
        ("N", 1.0),
        ("mN", 1e-3),
        ("kN", 1e3),
        ("lbf", pound),
        ("gf", 9.806_65e-3),
        ("kgf", 9.806_65),
        ("ozf", pound / 16.0),
    ];
    let torques = [
        ("Nm", 1.0),
        ("Nmm", 1e-3),
        ("N-mm", 1e-3),
        ("mNm", 1e-3),
        ("Ncm", 1e-2),
        ("kNm", 1e3),
        ("lbf-in", pound * 0.0254),
        ("lbfin", pound * 0.0254),
        ("lbf_in", pound * 0.0254),
        ("lbf-ft", pound * 0.3048),
        ("ozf-in", pound / 16.0 * 0.0254),
        ("kgf-m", 9.806_65),
        ("kgfcm", 9.806_65e-2),
        ("gf_cm", 9.806_65e-5),
    ];
    for (force, newtons) in forces {
        for (torque, newton_metres) in torques {
            let header =
                format!("Fx_{force},Fy ({force}),FZ[{force}],Tx_{torque},my_{torque},torque_z_{torque}");
            let read = first_wrench(&header, "1,-2,3,-4,5,6").unwrap();
            let expected = [1.0, -2.0, 3.0, -4.0, 5.0, 6.0];
            for (axis, (read, expected)) in read.iter().zip(expected).enumerate() {
                let unit = if axis < 3 { newtons } else { newton_metres };
                assert!(
                    (read - expected * unit).abs() <= 4.0 * f64::EPSILON * read.abs(),
                    "{header}: {read}"
                );
            }
        }
    }
}

#[test]
fn signals_and_times_are_converted_by_their_names() {
    for (header, volts, seconds) in [
        ("t_ms,v1_mV,v2_mV,dummy_mV", 1e-3, 1e-3),
        ("time_us,V0_uV,V1_µV,dummy_uV", 1e-6, 1e-6),
        ("Timestamp (s),gauge1 [V],gauge2 [V],dummy [V]", 1.0, 1.0),
        ("t_min,ch1_counts,ch2_raw,dummy_adc", 1.0, 60.0),
        ("t_ns,s0,s1,dummy", 1.0, 1e-9),
    ] {
        let file = format!("{header}\n5,8,-2,4\n");
        let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
        let sensor = reader.layout().only_signals().unwrap().clone();
        let row = reader.next_row().unwrap().unwrap();
        assert_eq!(row.time(), Some(5.0 * seconds));
        assert_eq!(row.signals::<2>(&sensor).unwrap().as_slice(), [8.0 * volts, -2.0 * volts]);
        assert_eq!(row.dummy(&sensor), Some(4.0 * volts));
        assert_eq!(row.signals::<3>(&sensor), None);
        assert!(sensor.expecting(3).is_err() && sensor.expecting_dummy().is_ok());
        assert_eq!(sensor.expecting(2), Ok(&sensor));
    }
}

/// With blanks around it a cell is read as without, in its unit; what means nothing is no number.
#[test]
fn unusual_cells_are_read_in_their_unit() {
    let file = "v1_mV,v2_mV\n 5 ,\t-8\nN/A,1\n2,None\n3,1e400\n4, 1e999 \n";
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let sensor = reader.layout().only_signals().unwrap().clone();
    let row = reader.next_row().unwrap().unwrap();
    assert_eq!(row.signals::<2>(&sensor).unwrap().as_slice(), [5e-3, -8e-3]);
    for _ in 0..4 {
        let row = reader.next_row().unwrap().unwrap();
        assert_eq!(row.signals::<2>(&sensor), None);
    }
    assert!(reader.next_row().unwrap().is_none());
    let quality = reader.quality();
    assert_eq!((quality.empty_cells.count(), quality.not_finite_cells.count()), (2, 2));
}

#[test]
fn a_file_as_windows_programs_write_it() {
    let file = "\u{feff}# made by hand\r\n\r\n\"t_s\";\"S1 Fx (N)\";S1_Fy_N;S1_Fz_N;S1_Tx_Nm;S1_Ty_Nm;S1_Tz_Nm;note\r\n\
                0.0;\"1\"; 2 ;3;4;5;6;\"a; b\"\r\n# pause\r\n0.1;+1;2e0;3.;.4;5;6;\r\n\r\n";
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let sensor = reader.layout().wrench("s1").unwrap().clone();
    assert_eq!(reader.layout().ignored().collect::<Vec<_>>(), ["note"]);
    let row = reader.next_row().unwrap().unwrap();
    assert_eq!(
        (row.line(), row.wrench(&sensor).unwrap().components().as_slice()),
        (4, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].as_slice())
    );
    let row = reader.next_row().unwrap().unwrap();
    assert_eq!(
        (row.line(), row.wrench(&sensor).unwrap().components().as_slice()),
        (6, [1.0, 2.0, 3.0, 0.4, 5.0, 6.0].as_slice())
    );
    assert!(reader.next_row().unwrap().is_none());
    assert!(reader.quality().is_clean());
}

#[test]
fn errors_name_file_line_column_and_remedy() {
    let said = |header: &str, rows: &str| -> String {
        let file = format!("{header}{rows}");
        let mut reader = match RecordingReader::new("test.csv", file.as_bytes()) {
            Ok(reader) => reader,
            Err(error) => return error.to_string(),
        };
        loop {
            match reader.next_row() {
                Ok(Some(_)) => {}
                Ok(None) => return String::new(),
                Err(error) => return error.to_string(),
            }
        }
    };
    for (header, rows, parts) in [
        ("", "", &["test.csv is empty"][..]),
        ("# only a comment\n", "", &["test.csv is empty"]),
        ("Fx,Fy,Fz,Tx,Ty,Tz\n", "", &["column Fx has no unit", "Fx_N"]),
        ("Fx_N,Fy_N,Fz_N,Tx,Ty_Nm,Tz_Nm\n", "", &["column Tx has no unit", "Tx_Nm"]),
        ("t,v1_V\n", "", &["column t has no unit", "t_s"]),
        ("S1_Fx_N,S1_Fy_N,S1_Tx_Nm\n", "", &["sensor s1 lacks fz, ty, tz"]),
        ("v1_V,v3_V\n", "", &["lack number 2"]),
        ("v2_V,v3_V\n", "", &["lack number 1"]),
        ("v1_V,v2_counts\n", "", &["v1_V and v2_counts", "different units"]),
        ("v1_V,V1_mV\n", "", &["v1_V and V1_mV mean the same"]),
        ("a,b\n", "", &["no column is a force", "a, b"]),
        (WRENCH, "0,1,2,3,4,5\n", &["line 2", "6 cells", "7 columns"]),
        (WRENCH, "0,1,2,3,4,5,6,7\n", &["line 2", "8 cells"]),
        (WRENCH, "0,1,2,3,4,5,6\n\n0.1,1,2,1_000,4,5,6\n", &["line 4", "column fz_N", "“1_000”"]),
        (WRENCH, "0,1,2,3,4,5,6\n1;2,1,2,3,4,5,6\n", &["line 3", "column t_s", "“1;2”"]),
    ] {
        let message = said(header, rows);
        for part in parts {
            assert!(message.contains(part), "“{message}” does not say “{part}”");
        }
    }
    let error = RecordingReader::open("no such file.csv").unwrap_err();
    assert!(error.to_string().starts_with("cannot open no such file.csv"), "{error}");
}

#[test]
fn the_reader_goes_on_behind_a_bad_row() {
    let file = format!("{WRENCH}0,1,2,3,4,5,x\n0.1,1\n0.2,1,2,3,4,5,6\n");
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    assert!(matches!(reader.next_row(), Err(RecordingError::NotANumber { line: 2, .. })));
    assert!(matches!(reader.next_row(), Err(RecordingError::Ragged { line: 3, found: 2, expected: 7, .. })));
    assert_eq!(reader.next_row().unwrap().unwrap().line(), 4);
}

#[test]
fn a_line_without_an_end_takes_no_memory_without_an_end() {
    struct Endless(u64);
    impl std::io::Read for Endless {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            buffer.fill(b'7');
            self.0 += buffer.len() as u64;
            assert!(self.0 < 1 << 22, "reads on for ever");
            Ok(buffer.len())
        }
    }
    let error = RecordingReader::new("endless", Endless(0)).unwrap_err();
    assert!(matches!(error, RecordingError::TooLong { line: 0, .. }), "{error}");
    for start in ["0,1,2,", "0,1,\""] {
        let input = std::io::Read::chain(std::io::Cursor::new(format!("{WRENCH}{start}")), Endless(0));
        let mut reader = RecordingReader::new("endless", input).unwrap();
        assert!(matches!(reader.next_row(), Err(RecordingError::TooLong { line: 1, .. })));
    }
}

#[test]
fn faults_spoil_what_they_touch_and_nothing_else() {
    let file = "t_s,a_fx_N,a_fy_N,a_fz_N,a_tx_Nm,a_ty_Nm,a_tz_Nm,b_v1_V,b_v2_V\n\
                0.0,1,2,3,4,5,6,7,8\n0.1,1,2,,4,5,6,7,8.5\n0.2,1,2,3,4,5,6,nan,8\n,1,2,3,4,5,7,7,8\n";
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let (a, b) =
        (reader.layout().only_wrench().unwrap().clone(), reader.layout().only_signals().unwrap().clone());
    let mut given = Vec::new();
    while let Some(row) = reader.next_row().unwrap() {
        given.push((row.wrench(&a).is_some(), row.signals::<2>(&b).is_some(), row.is_usable()));
    }
    assert_eq!(given, [(true, true, true), (false, true, true), (true, false, true), (false, false, false)]);
    assert_eq!(
        reader.quality().to_string(),
        "4 rows; 3 unusable rows (first in line 3, 4, 5); 2 empty cells (first in line 3, 5); \
         1 cells that are not finite (first in line 4)"
    );
}

/// What is done to a row of a sound file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    Empty,
    NotFinite,
    Gap,
    Repeated,
    SameTime,
    Backward,
    Held,
}

fn fault() -> impl Strategy<Value = Fault> {
    prop_oneof![
        12 => Just(Fault::None),
        1 => Just(Fault::Empty),
        1 => Just(Fault::NotFinite),
        1 => Just(Fault::Gap),
        1 => Just(Fault::Repeated),
        1 => Just(Fault::SameTime),
        1 => Just(Fault::Backward),
        1 => Just(Fault::Held),
    ]
}

/// Numbers with every kind of exponent.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<f64>().prop_filter("finite", |x| x.is_finite()), -100.0_f64..100.0]
}

proptest! {
    #[test]
    fn injected_faults_are_counted_exactly(faults in prop::collection::vec(fault(), 1..200)) {
        // Eight sound rows first, so that the usual step is known.
        let (mut file, mut expected) = (WRENCH.to_owned(), Quality::default());
        let (mut time, mut value) = (0_u32, 1_u32);
        let mut counts = [0_u64; 7];
        let faults: Vec<Fault> = [Fault::None; 8].into_iter().chain(faults).collect();
        let mut whole_before = true;
        let mut steps: Vec<u32> = Vec::new();
        for mut fault in faults {
            if !whole_before && matches!(fault, Fault::Repeated | Fault::Held) {
                fault = Fault::None;
            }
            whole_before = !matches!(fault, Fault::Empty | Fault::NotFinite);
            let before = time;
            match fault {
                Fault::Repeated | Fault::SameTime => {}
                Fault::Backward => time -= 1,
                Fault::Gap => time += 5,
                _ => time += 2,
            }
            if time > before {
                // The oracle of gaps: the lower median of all steps forward.
                let step = time - before;
                let mut window: Vec<u32> = steps.clone();
                window.sort_unstable();
                if window.len() >= 3 && 2 * step > 3 * window[(window.len() - 1) / 2] {
                    counts[2] += 1;
                }
                steps.push(step);
            }
            if !matches!(fault, Fault::Repeated | Fault::Held) {
                value += 1;
            }
            match fault {
                Fault::Empty => counts[0] += 1,
                Fault::NotFinite => counts[1] += 1,
                Fault::Repeated => counts[3] += 1,
                Fault::SameTime | Fault::Backward => counts[4] += 1,
                Fault::Held => counts[5] += 1,
                Fault::None | Fault::Gap => {}
            }
            if !matches!(fault, Fault::None | Fault::Gap | Fault::Held) {
                counts[6] += 1;
            }
            let cell = match fault {
                Fault::Empty => " ",
                Fault::NotFinite => "-inf",
                _ => "3",
            };
            // Whole numbers of seconds, so that steps are exact.
            file += &format!("{time},{value},2,{cell},4,5,6\n");
            expected.rows += 1;
        }
        let quality = quality_of(&file);
        let found = [
            quality.empty_cells, quality.not_finite_cells, quality.gaps, quality.repeated_rows,
            quality.backward_times, quality.held_rows, quality.unusable_rows,
        ].map(|fault| fault.count());
        prop_assert_eq!((quality.rows, found), (expected.rows, counts));
    }

    #[test]
    fn what_is_written_is_read_back_exactly(
        rows in prop::collection::vec((prop::array::uniform6(number()), prop::array::uniform7(number())), 0..20),
    ) {
        let schema = Schema::default().time().wrench("S1").signals("", 6, SignalUnit::Volt).dummy("", SignalUnit::Volt);
        let mut writer = RecordingWriter::new(Vec::new(), &schema).unwrap();
        for (index, (wrench, volts)) in rows.iter().enumerate() {
            writer.write([index as f64].into_iter().chain(*wrench).chain(*volts)).unwrap();
        }
        prop_assert!(writer.write([1.0]).is_err());
        let file = writer.finish().unwrap();
        let mut reader = RecordingReader::new("test.csv", file.as_slice()).unwrap();
        let (s1, six) = (reader.layout().only_wrench().unwrap().clone(), reader.layout().only_signals().unwrap().clone());
        for (index, (wrench, volts)) in rows.iter().enumerate() {
            let row = reader.next_row().unwrap().unwrap();
            prop_assert_eq!(row.time(), Some(index as f64));
            prop_assert_eq!(<[f64; 6]>::from(row.wrench(&s1).unwrap().components()), *wrench);
            prop_assert_eq!(&<[f64; 6]>::from(row.signals::<6>(&six).unwrap())[..], &volts[..6]);
            prop_assert_eq!(row.dummy(&six), Some(volts[6]));
        }
        prop_assert!(reader.next_row().unwrap().is_none());
    }

    #[test]
    fn any_bytes_give_rows_or_errors_and_an_end(
        body in prop::collection::vec(prop_oneof![
            any::<u8>(), prop::sample::select(b"0123456789.,-+eE\n\r\"#;naif \xef\xbb\xbf".to_vec()),
        ], 0..400),
        with_header in any::<bool>(),
        gap_factor in any::<f64>(),
    ) {
        let mut file = if with_header { WRENCH.as_bytes().to_vec() } else { Vec::new() };
        file.extend(&body);
        let options = ReaderOptions { gap_factor, ..ReaderOptions::default() };
        let Ok(mut reader) = RecordingReader::with_options("test.csv", file.as_slice(), options) else {
            return Ok(());
        };
        let sensors = reader.layout().wrenches().to_vec();
        for _ in 0..=file.len() {
            match reader.next_row() {
                Ok(None) => return Ok(()),
                Ok(Some(row)) => for sensor in &sensors {
                    prop_assert!(row.wrench(sensor).is_none_or(|wrench| wrench.is_finite()));
                },
                Err(error) => prop_assert!(error.to_string().contains("test.csv")),
            }
        }
        prop_assert!(false, "more rows than bytes");
    }

    #[test]
    fn any_header_gives_a_layout_or_a_reason(header in "[a-zA-Z0-9_ ,()µ·.\\-]{0,80}") {
        let _ = RecordingReader::new("test.csv", header.as_bytes());
    }
}

#[test]
fn contacts_are_read_as_they_were_written() {
    let wrench = Wrench::on_fingertip(Vector3::new(0.25, -0.5, -2.0), Vector3::new(0.0, 0.0, 1e-3));
    let contact = ContactCells {
        position: Vector3::new(1e-3, 2e-3, 13e-3),
        normal: Vector3::new(0.0, 0.6, 0.8),
        wrench,
    };
    let schema = Schema::default().time().wrench("").contact();
    let mut writer = RecordingWriter::new(Vec::new(), &schema).unwrap();
    for (time, contact) in [(0.0, None), (0.5, Some(contact))] {
        let cells = contact.map_or([f64::NAN; 12], |contact: ContactCells| contact.cells());
        let load = wrench.components();
        writer.write([time].into_iter().chain(load.iter().copied()).chain(cells)).unwrap();
    }
    let file = writer.finish().unwrap();
    let mut reader = RecordingReader::new("contacts.csv", file.as_slice()).unwrap();
    // The columns of a contact are those of no other sensor.
    let sensor = reader.layout().only_wrench().unwrap().clone();
    let columns = *reader.layout().contacts().unwrap();
    assert_eq!(reader.layout().ignored().count(), 0);
    let mut seen = Vec::new();
    while let Some(row) = reader.next_row().unwrap() {
        assert_eq!(row.wrench(&sensor), Some(wrench));
        seen.push(row.contact(&columns));
    }
    assert_eq!(seen, [None, Some(contact)]);
    // No contact is no fault of the file.
    assert!(reader.quality().is_clean());
    // Some of the columns alone mean nothing, and are none of a wrench.
    let part = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,contact_x_m,contact_load_x_N\n0,0,0,0,0,0,0,,\n";
    let reader = RecordingReader::new("part.csv", part.as_bytes()).unwrap();
    assert!(reader.layout().contacts().is_none() && reader.layout().only_wrench().is_ok());
    assert_eq!(reader.layout().ignored().collect::<Vec<_>>(), ["contact_x_m", "contact_load_x_N"]);
}

/// A file that was cut in its last line loses that line, and says so; what is wrong elsewhere is an error as before.
#[test]
fn a_cut_last_line_is_lost_alone() {
    let header = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm";
    let whole = format!("{header}\n0,1,2,3,4,5,6\n1,1,2,3,4,5,7\n");
    let read = |text: &str| {
        let mut reader = RecordingReader::new("a.csv", text.as_bytes()).unwrap();
        let mut rows = 0;
        while reader.next_row()?.is_some() {
            rows += 1;
        }
        let lines = reader.quality().cut_lines.first_lines().to_vec();
        // It is one line, however often it is asked for more.
        assert!(reader.next_row()?.is_none());
        assert_eq!(reader.quality().cut_lines.count(), lines.len() as u64);
        Ok::<_, RecordingError>((rows, lines))
    };
    assert_eq!(read(&whole).unwrap(), (2, vec![]));
    // Without the end of the line the last number may be short, but it is a number.
    assert_eq!(read(whole.trim_end()).unwrap(), (2, vec![]));
    let start = whole.len() - "1,1,2,3,4,5,7\n".len();
    for cut in start + 1..whole.len() - 2 {
        assert_eq!(read(&whole[..cut]).unwrap(), (1, vec![3]), "{:?}", &whole[..cut]);
    }
    for end in ["-", "1e", "+.", "x"] {
        let cut = format!("{}{end}", &whole[..whole.len() - 2]);
        assert_eq!(read(&cut).unwrap(), (1, vec![3]), "{cut:?}");
        assert!(matches!(read(&format!("{cut}\n")), Err(RecordingError::NotANumber { line: 3, .. })));
    }
    let bad = format!("{whole}2,x,2,3,4,5,6");
    assert!(matches!(read(&bad), Err(RecordingError::NotANumber { line: 4, .. })));
    let long = format!("{whole}2,1,2,3,4,5,6,7");
    assert!(matches!(read(&long), Err(RecordingError::Ragged { line: 4, .. })));
}

#[test]
fn frames_are_named_above_the_header() {
    let schema = Schema::default().time().wrench("").wrench("left");
    let schema = schema.frame("", "tip").frame("left", "left wrist").frame("x", "two\nlines");
    let mut writer = RecordingWriter::new(Vec::new(), &schema).unwrap();
    writer.write([0.0; 13]).unwrap();
    let text = String::from_utf8(writer.finish().unwrap()).unwrap();
    assert!(text.starts_with("# frame_id: tip\n# frame_id of left: left wrist\nt_s,fx_N,"), "{text}");
    let reader = RecordingReader::new("a.csv", text.as_bytes()).unwrap();
    let frames = ["", "left", "x"].map(|sensor| reader.layout().frame(sensor).map(str::to_owned));
    assert_eq!(frames, [Some("tip".to_owned()), Some("left wrist".to_owned()), None]);
}

/// A row that cannot be used says nothing by its dummy gauge either, nor does a number that is not finite.
#[test]
fn the_dummy_of_a_row_that_cannot_be_used_is_none() {
    let file = "t_s,v1_V,dummy_V\n0,1,2\n0,2,3\n1,2,NaN\n2,2,4\n";
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let sensor = reader.layout().only_signals().cloned().unwrap();
    let mut dummies = Vec::new();
    while let Some(row) = reader.next_row().unwrap() {
        dummies.push((row.is_usable(), row.dummy(&sensor)));
    }
    assert_eq!(dummies, [(true, Some(2.0)), (false, None), (true, None), (true, Some(4.0))]);
}

/// Columns with names of their own, behind a mark of the byte order too, are taken for what the reader is told, with the
/// sign that it is told.
#[test]
fn renamed_columns_are_read_with_their_sign() {
    let renamed =
        |from: &str, to: &str, negative| RenamedColumn { from: from.into(), to: to.into(), negative };
    let options = |renamed| ReaderOptions { renamed, ..ReaderOptions::default() };
    let file = "\u{feff}clock,a,b,c,d,e, f \n0.5,1,2,3,4,5,6\n";
    let columns = vec![
        renamed("f", "fx_N", true),
        renamed("b", "fy_N", false),
        renamed("c", "fz_mN", true),
        renamed("d", "tx_Nm", false),
        renamed("e", "ty_Nmm", false),
        renamed("a", "tz_Nm", true),
        renamed("clock", "t_ms", false),
    ];
    let mut reader = RecordingReader::with_options("test.csv", file.as_bytes(), options(columns)).unwrap();
    let sensor = reader.layout().only_wrench().cloned().unwrap();
    let row = reader.next_row().unwrap().unwrap();
    let read: [f64; 6] = row.wrench(&sensor).unwrap().components().into();
    assert_eq!(read, [-6.0, 2.0, -0.003, 4.0, 0.005, -1.0]);
    assert_eq!(row.time(), Some(0.0005));
    let missing = options(vec![renamed("g", "fx_N", false)]);
    let error = RecordingReader::with_options("test.csv", file.as_bytes(), missing).unwrap_err().to_string();
    assert!(error.contains('g') && error.contains("clock"), "{error}");
}
