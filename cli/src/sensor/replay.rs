//! A recording as a source, at its own speed or another.

use std::path::Path;

use fingertip_drivers::middleware::Paced;
use fingertip_drivers::playback::{McapPlayback, WrenchPlayback};
use fingertip_recordings::ReaderOptions;

use super::{Feed, Losses, SourceFeed};
use crate::error::CliError;
use crate::input::Input;
use crate::recording_file::{Kind, mcap};

/// A file loses nothing.
fn whole() -> Losses {
    Losses { lost: Some(0), ..Losses::default() }
}

/// Plays the wrenches of a sensor (CSV) or topic (MCAP); an empty name means the only one. Speed 0 does
/// not wait.
pub(crate) fn open(path: &Path, sensor: &str, speed: f64) -> Result<Box<dyn Feed>, CliError> {
    let mut input = Input::open(path)?;
    if input.kind() == Kind::Mcap {
        let playback = McapPlayback::new(input.messages()?, sensor).map_err(|error| mcap(path, &error))?;
        return Ok(Box::new(SourceFeed { source: Paced::new(playback, speed), losses: |_: &_| whole() }));
    }
    let playback = WrenchPlayback::new(input.rows(ReaderOptions::default())?, sensor)?;
    Ok(Box::new(SourceFeed { source: Paced::new(playback, speed), losses: |_: &_| whole() }))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use fingertip::wrench::Wrench;
    use fingertip_recordings::mcap::McapWriter;
    use nalgebra::Vector6;

    use super::super::testing::Folder;
    use super::super::{Losses, Next};
    use super::open;

    #[test]
    fn recordings_of_either_kind_are_played() {
        let folder = Folder::new("replay");
        let wrench: Wrench<f64> = Wrench::from_components(&Vector6::new(1.0, 2.0, -3.0, 0.0, 0.25, 0.0));
        let mut writer = McapWriter::new(Cursor::new(Vec::new())).unwrap();
        let topic = writer.wrenches("/ft", "tip").unwrap();
        writer.write_wrench(topic, 0.5, &wrench).unwrap();
        let messages = writer.finish().unwrap().into_inner();
        let rows = b"t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0.5,1,2,-3,0,0.25,0\n".to_vec();
        for (name, contents) in [("a.csv", rows), ("a.mcap", messages)] {
            let path = folder.0.join(name);
            std::fs::write(&path, contents).unwrap();
            let mut feed = open(&path, "", 0.0).unwrap();
            let Next::Reading(reading) = feed.next().unwrap() else { panic!("{name}: no reading") };
            assert_eq!((reading.time, reading.wrench), (Some(0.5), wrench), "{name}");
            assert!(matches!(feed.next().unwrap(), Next::End), "{name}");
            let Losses { lost, late, .. } = feed.losses();
            assert_eq!((lost, late), (Some(0), 0), "{name}");
        }
    }
}
