//! Scores the slip detectors and the integrators of dynamic friction.
//!
//! `cargo run --release -p fingertip-benches --bin slip_report [-- FOLDER]`
//!
//! Prints the report as Markdown, and writes it with its plots as `slip.md` and `slip.html` into the
//! folder, by default `target/slip_report`, with `slip.csv` (one row per ramp and detector). With
//! `--cost` in place of the folder, it prints only what one update costs; with `--noises`, only false alarms and delays
//! by the kind of the noise (some minutes).

mod cost;
mod detectors;
mod integrators;
mod noises;
mod page;
mod ramps;
mod tribometer;

use core::error::Error;
use std::path::PathBuf;

type Failure = Box<dyn Error>;

fn main() -> Result<(), Failure> {
    let argument = std::env::args_os().nth(1);
    if argument.as_deref() == Some("--cost".as_ref()) {
        println!("{}", cost::table()?);
        return Ok(());
    }
    if argument.as_deref() == Some("--noises".as_ref()) {
        let mut page = page::Page::default();
        noises::report(&mut page)?;
        println!("{}", page.markdown());
        return Ok(());
    }
    let folder = argument.map_or_else(|| PathBuf::from("target/slip_report"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let mut page = page::Page::default();
    page.say("# Slip detectors and friction integrators, scored\n");
    let rows = detectors::report(&mut page)?;
    noises::report(&mut page)?;
    tribometer::report(&mut page)?;
    page.say(&cost::table()?);
    integrators::report(&mut page)?;
    println!("{}", page.markdown());
    std::fs::write(folder.join("slip.csv"), rows)?;
    page.write(&folder)?;
    println!("Wrote {}", folder.join("slip.html").display());
    Ok(())
}
