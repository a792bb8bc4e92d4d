//! How fast a recording is read, and written again:
//! `cargo run --release -p fingertip-drivers --example reading_speed FILE`

use core::error::Error;
use std::time::Instant;

use fingertip_recordings::{RecordingReader, RecordingWriter, Schema};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("give the name of a recording of wrenches")?;
    for write in [false, true] {
        let start = Instant::now();
        let mut reader = RecordingReader::open(&path)?;
        let sensors = reader.layout().wrenches().to_vec();
        let schema = sensors.iter().fold(Schema::default(), |schema, sensor| schema.wrench(sensor.name()));
        let mut writer = RecordingWriter::new(std::io::sink(), &schema)?;
        let (mut wrenches, mut force) = (0_u64, 0.0);
        while let Some(row) = reader.next_row()? {
            for sensor in &sensors {
                if let Some(wrench) = row.wrench(sensor) {
                    wrenches += 1;
                    force += wrench.force().z;
                }
            }
            if write {
                writer.write(sensors.iter().flat_map(|sensor| row.unchecked_components(sensor)))?;
            }
        }
        let (seconds, rows) = (start.elapsed().as_secs_f64(), reader.quality().rows as f64);
        println!(
            "{} {rows} rows, {wrenches} wrenches in {seconds:.3} s: {:.2} million rows/s, {:.0} MB/s (sum of fz: {force:.3} N)",
            if write { "read and written:" } else { "read:" },
            rows / seconds / 1e6,
            reader.bytes_read() as f64 / seconds / 1e6,
        );
    }
    Ok(())
}
