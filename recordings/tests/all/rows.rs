//! Rows of a recording that say again what the row before said.

use fingertip_recordings::{RecordingError, RecordingReader, RowBlock};

/// Lines of the rows that are marked as repeated, held and backward.
fn marked(file: &str) -> [Vec<u64>; 3] {
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let mut lines = [const { Vec::new() }; 3];
    loop {
        match reader.next_row() {
            Ok(Some(row)) => {
                let marks = row.marks();
                for (lines, marked) in lines.iter_mut().zip([marks.repeated, marks.held, marks.backward]) {
                    lines.extend(marked.then(|| row.line()));
                }
                assert_eq!(row.is_usable(), !(marks.repeated || marks.backward || marks.bad_time));
            }
            Ok(None) => return lines,
            // Where it goes on is what is tested.
            Err(RecordingError::NotANumber { .. } | RecordingError::Ragged { .. }) => {}
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn without_time_a_row_is_repeated_if_all_its_numbers_are() {
    let file = "v1_V,v2_V,note\n1,2,a\n1,2,b\n1,3,b\n2,3,b\n2,3,b\n2,3,b\n3,2,b\n2,3,b\n";
    assert_eq!(marked(file), [vec![3, 6, 7], vec![], vec![]]);
}

#[test]
fn the_first_row_repeats_nothing_though_all_its_cells_are_missing() {
    let file = "v1_V,v2_V\n,\n,\n1,\n1,\n,1\n";
    assert_eq!(marked(file), [vec![3, 5], vec![], vec![]]);
}

#[test]
fn with_time_a_row_is_repeated_at_the_same_time_and_held_at_a_later_one() {
    let file = "t_s,v1_V\n0,1\n0,1\n1,1\n1,2\n2,2\n1,2\n";
    assert_eq!(marked(file), [vec![3], vec![4, 6], vec![5, 7]]);
}

/// What is held over a gap is held, and the step across the gap is known.
#[test]
fn a_gap_has_a_time_step_and_may_hold() {
    let steady: String = (0..20).map(|k| format!("{k},{}\n", k % 7)).collect();
    let file = format!("t_s,v1_V\n{steady}100,5\n101,6\n");
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let mut gaps = Vec::new();
    while let Some(row) = reader.next_row().unwrap() {
        if row.marks().gap {
            gaps.push((row.line(), row.marks().held, row.time_step()));
        }
    }
    assert_eq!(gaps, [(22, true, Some(81.0))]);
}

/// Columns of no sensor are watched by their names, several at a time.
#[test]
fn watched_columns_give_their_numbers() {
    let file = "t_s,v1_V,temperature_C,note,qx\n0,0.5,21.5,a,1\n1,0.6,,b,0.25\n";
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let celsius = reader.watch("TEMPERATURE_c").unwrap();
    let turn = reader.watch("qx").unwrap();
    assert!(reader.watch("qy").is_none());
    let mut rows = Vec::new();
    while let Some(row) = reader.next_row().unwrap() {
        rows.push((row.number(&celsius), row.number(&turn)));
    }
    assert_eq!(rows, [(Some(21.5), Some(1.0)), (None, Some(0.25))]);
}

/// The header says what parts columns, not what stands in the comments before it or in the rows behind.
#[test]
fn the_header_alone_says_what_parts_columns() {
    for (file, expected) in [
        ("# made by a, b and c\nt_s;v1_V\n0;1\n", [0.0, 1.0]),
        ("# a; b\n\n# c, d\nt_s\tv1_V\n2\t3\n", [2.0, 3.0]),
        ("t_s,v1_V,note\n4,5,x;y\n", [4.0, 5.0]),
    ] {
        let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
        let sensor = reader.layout().only_signals().unwrap().clone();
        let row = reader.next_row().unwrap().unwrap();
        assert_eq!([row.time().unwrap(), row.signals::<1>(&sensor).unwrap().x], expected, "{file}");
    }
}

#[test]
fn behind_a_row_that_cannot_be_read_nothing_is_known_to_be_repeated() {
    // The numbers of the row before the one before, or of the one before, come again.
    for bad in ["x,9", "9,x", "1,2,3"] {
        for again in ["1,2", "3,4", "9,4", "9,2"] {
            let file = format!("v1_V,v2_V\n1,2\n3,4\n{bad}\n{again}\n{again}\n");
            assert_eq!(marked(&file), [vec![6], vec![], vec![]], "{bad} then {again}");
        }
    }
    // Lines without a row are none.
    assert_eq!(marked("v1_V\n1\n\n# pause\n1\n"), [vec![5], vec![], vec![]]);
}

#[test]
fn the_last_row_needs_no_line_end() {
    for file in ["v1_V,v2_V\n1,2\n3,45", "v1_V,v2_V\n1,2\n3,45\n", "v1_V,v2_V\r\n1,2\r\n3,45\r\n"] {
        let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
        let sensor = reader.layout().only_signals().unwrap().clone();
        let mut rows = Vec::new();
        while let Some(row) = reader.next_row().unwrap() {
            rows.push((row.line(), row.signals::<2>(&sensor).unwrap().as_slice().to_vec()));
        }
        assert_eq!(rows, [(2, vec![1.0, 2.0]), (3, vec![3.0, 45.0])]);
        assert_eq!(reader.bytes_read(), file.len() as u64);
    }
}

/// One inertial unit without a name serves every sensor that has none of its own.
#[test]
fn a_sensor_without_an_inertial_unit_has_the_one_without_a_name() {
    let unit =
        |name: &str| format!("{name}ax_g,{name}ay_g,{name}az_g,{name}wx_dps,{name}wy_dps,{name}wz_dps");
    let header = format!("left_v1_V,right_v1_V,{},{}", unit(""), unit("right_"));
    let file = format!("{header}\n0,0,0,0,1,0,0,0,0,1,0,0,0,0\n");
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let units = ["left", "right"].map(|sensor| reader.watch_inertial_unit(sensor).unwrap());
    let row = reader.next_row().unwrap().unwrap();
    let [left, right] = units.map(|unit| row.inertial(&unit).unwrap().acceleration / 9.80665);
    assert_eq!((left.as_slice(), right.as_slice()), (&[0.0, 0.0, 1.0][..], &[0.0, 1.0, 0.0][..]));
}

/// A row that stands again, or lacks a number, is no reading of an inertial unit.
#[test]
fn an_inertial_unit_reads_only_what_is_usable() {
    let file = "time_s,v1_V,ax_g,ay_g,az_g,wx_dps,wy_dps,wz_dps\n\
                0.0,0,0,0,1,0,0,0\n0.0,0,0,0,1,0,0,0\n0.1,0,0,0,,0,0,0\n0.2,0,0,0,1,0,0,0\n";
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let unit = reader.watch_inertial_unit("").unwrap();
    let mut read = Vec::new();
    while let Some(row) = reader.next_row().unwrap() {
        read.push(row.inertial(&unit).is_some());
    }
    assert_eq!(read, [true, false, false, true]);
}

/// Gives a byte at a time, and says in between that it was interrupted.
struct Interrupted<'a>(&'a [u8], bool);

impl std::io::Read for Interrupted<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.1 = !self.1;
        if self.1 {
            return Err(std::io::ErrorKind::Interrupted.into());
        }
        let length = buffer.len().min(1);
        self.0.read(&mut buffer[..length])
    }
}

#[test]
fn a_read_that_is_interrupted_goes_on() {
    let file = "t_s,v1_V\n0,1\n1,2\n";
    let mut reader = RecordingReader::new("test.csv", Interrupted(file.as_bytes(), false)).unwrap();
    let mut times = Vec::new();
    while let Some(row) = reader.next_row().unwrap() {
        times.extend(row.time());
    }
    assert_eq!(times, [0.0, 1.0]);
}

/// Line, time, step, marks and values of every row up to the first error, which is told behind them.
#[test]
fn rows_of_blocks_are_those_that_come_one_by_one() {
    let mut file = "t_s,v1_V,v2_V\n".to_owned();
    for i in 0..50_u32 {
        // Gaps, repeated rows, held ones, times that go back, cells without a number.
        let time = match i {
            20..30 => f64::from(i) * 0.1 + 3.0,
            30 => 5.9,
            _ => f64::from(i) * 0.1,
        };
        let value = if i % 7 == 3 { String::new() } else { format!("{}", i / 2 % 5) };
        file += &format!("{time},{value},{}\n", i % 4 / 2);
    }
    for end in ["", "9,x,1\n10,1,1\n", "9,1\n10,1,1\n"] {
        let whole = format!("{file}{end}");
        let shown = |row: &fingertip_recordings::Row<'_>| format!("{row:?}");
        let mut reader = RecordingReader::new("test.csv", whole.as_bytes()).unwrap();
        let (mut expected, mut error) = (Vec::new(), None);
        loop {
            match reader.next_row() {
                Ok(Some(row)) => expected.push(shown(&row)),
                Ok(None) => break,
                Err(found) => {
                    error = Some(found.to_string());
                    break;
                }
            }
        }
        assert!(expected.len() == 50 && error.is_some() != end.is_empty(), "{error:?}");
        for most in [0, 1, 2, 7, 49, 50, 51, 1000] {
            let mut blocks = RecordingReader::new("test.csv", whole.as_bytes()).unwrap();
            let (mut block, mut found) = (RowBlock::default(), Vec::new());
            let ended = loop {
                let more = blocks.read_block(&mut block, most);
                assert!(block.len() <= most.max(1));
                found.extend(block.rows().map(|row| shown(&row)));
                match more {
                    Ok(true) => {}
                    Ok(false) => break None,
                    Err(error) => break Some(error.to_string()),
                }
            };
            assert_eq!((&found, &ended), (&expected, &error), "blocks of {most}");
            assert_eq!(blocks.quality(), reader.quality());
        }
    }
}

/// A dot parts words behind a force or a torque, as topics of ROS are written.
#[test]
fn a_dot_parts_force_and_axis() {
    let file = "t_s,force.x_N,force.y_N,force.z_N,torque.x_Nm,torque.y_Nm,torque.z_Nm\n0,1,2,3,4,5,6\n";
    let mut reader = RecordingReader::new("test.csv", file.as_bytes()).unwrap();
    let sensor = reader.layout().only_wrench().unwrap().clone();
    let row = reader.next_row().unwrap().unwrap();
    assert_eq!(row.wrench(&sensor).unwrap().components().as_slice(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
}
