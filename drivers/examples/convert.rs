//! Converts a recording of wrenches from CSV to MCAP or back, by the endings of the names:
//! `cargo run --release -p fingertip-drivers --features mcap --example convert FROM TO`

use core::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;

use fingertip_drivers::WrenchSource;
use fingertip_drivers::recording::mcap::{McapPlayback, McapWriter};
use fingertip_drivers::recording::{RecordingReader, RecordingWriter, Schema, WrenchPlayback};

fn main() -> Result<(), Box<dyn Error>> {
    let mut names = std::env::args().skip(1);
    let (from, to) = names.next().zip(names.next()).ok_or("give the names of two files")?;
    let out = BufWriter::new(File::create(&to)?);
    let mut count = 0_u64;
    if to.ends_with(".mcap") {
        let mut source = WrenchPlayback::new(RecordingReader::open(&from)?, "")?;
        let mut writer = McapWriter::new(out)?;
        let topic = writer.wrenches("/fingertip/wrench", "fingertip_sensor")?;
        while let Some(sample) = source.next_wrench()? {
            writer.write_wrench(topic, sample.time.ok_or("the recording has no time")?, &sample.value)?;
            count += 1;
        }
        writer.finish()?;
    } else {
        let file = fs::read(&from)?;
        let mut source = McapPlayback::new(&file, "")?;
        let mut writer = RecordingWriter::new(out, &Schema::default().time().wrench(""))?;
        while let Some(sample) = source.next_wrench()? {
            writer.write_wrench(sample.time.unwrap_or(f64::NAN), &sample.value)?;
            count += 1;
        }
        writer.finish()?;
    }
    println!("{count} wrenches from {from} to {to}");
    Ok(())
}
