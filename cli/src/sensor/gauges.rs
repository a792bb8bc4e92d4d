//! Readings of gauges, from a recording or the simulated fingertip, through a calibration.

use std::path::Path;

use fingertip::wrench::Wrench;
use fingertip_drivers::middleware::Paced;
use fingertip_drivers::{Sample, Source};
use fingertip_recordings::{HeaderProblem, ReaderOptions, SignalUnit};
use fingertip_scene::Sensor;

use super::gauge_sources::{CsvGauges, GaugeFault, GaugeSource, McapGauges, SimulatedGauges};
use super::simulated::{self, Rounds};
use super::{Address, Feed, Losses, SourceFeed};
use crate::calibrated::{Calibration, Readings};
use crate::error::CliError;
use crate::gauge_rows::{GaugeRows, KnownTemperature};
use crate::input::Input;
use crate::recording_file::Kind;

/// Where the readings come from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum GaugesOf<'a> {
    /// Of a recording: of the sensor of this name, or the only one.
    Recording { path: &'a Path, sensor: Option<&'a str>, speed: f64 },
    /// The simulated fingertip.
    Simulated(&'a Address),
}

/// How they become wrenches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Calibrating<'a> {
    pub(crate) calibration: &'a Calibration<'a>,
    /// Seconds at the start in which nothing touches, which give the zero.
    pub(crate) rest: Option<f64>,
    /// Temperature of the sensor \[°C\], where there is no column of it.
    pub(crate) celsius: Option<f64>,
}

/// Plays readings through a calibration. The rest is not waited for. What is to be minded is added to `notes`.
pub(crate) fn calibrated(
    gauges: GaugesOf<'_>,
    how: &Calibrating<'_>,
    notes: &mut Vec<String>,
) -> Result<Box<dyn Feed>, CliError> {
    let calibration = how.calibration;
    let (source, readings, speed): (Box<dyn GaugeSource>, Readings, f64) = match gauges {
        GaugesOf::Recording { path, sensor, speed } => match Input::open(path)? {
            mut input if input.kind() == Kind::Csv => {
                let mut reader = input.rows(ReaderOptions::default())?;
                let column = || reader.watch("temperature_C").map(KnownTemperature::Column);
                let temperature = how.celsius.map(KnownTemperature::Constant).or_else(column);
                let header = |problem: HeaderProblem| CliError::Recording(reader.header_error(problem));
                let rows = GaugeRows::of(reader.layout(), sensor, calibration.gauges(), temperature)
                    .map_err(header)?;
                let readings = rows.readings();
                (Box::new(CsvGauges { reader, rows }), readings, speed)
            }
            input => {
                let (source, readings) = McapGauges::open(&input, sensor, how.celsius)?;
                (Box::new(source), readings, speed)
            }
        },
        GaugesOf::Simulated(address) => {
            let fault = |source| CliError::sensor(address, source);
            let rounds = Rounds::new(simulated::fresh(address).map_err(fault)?);
            let readings = Readings {
                unit: SignalUnit::Volt,
                has_dummy: true,
                has_rest: false,
                has_temperature: how.celsius.is_some(),
            };
            (Box::new(SimulatedGauges { rounds, celsius: how.celsius }), readings, 1.0)
        }
    };
    let calibrated = calibration.of(&Readings { has_rest: how.rest.is_some(), ..readings }, notes)?;
    let wrenches = CalibratedWrenches { source, calibrated, rest: how.rest, first: None, last: None };
    let losses = |_: &_| Losses { lost: Some(0), ..Losses::default() };
    Ok(Box::new(SourceFeed { source: Paced::new(wrenches, speed), losses }))
}

/// The wrenches of readings, behind the rest.
struct CalibratedWrenches {
    source: Box<dyn GaugeSource>,
    calibrated: Sensor<f64>,
    /// While it lasts \[s\].
    rest: Option<f64>,
    first: Option<f64>,
    /// When the last wrench was measured \[s\].
    last: Option<f64>,
}

impl Source<f64, Wrench<f64>> for CalibratedWrenches {
    type Error = GaugeFault;

    fn next_sample(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, GaugeFault> {
        while let Some(reading) = self.source.next()? {
            if let Some(rest) = self.rest {
                let time = reading.time.ok_or_else(|| {
                    GaugeFault::Unusable("it tells no times, by which to find the end of the rest".to_owned())
                })?;
                if time - *self.first.get_or_insert(time) < rest {
                    // A reading that cannot be used is passed over.
                    let _ = self.calibrated.rest(&reading.borrowed());
                    continue;
                }
                self.rest = None;
                let ended = self.calibrated.end_rest();
                ended.map_err(|error| {
                    GaugeFault::Unusable(format!("no zero from {rest} s at rest: {error}; rest longer"))
                })?;
                if let Some(doubt) = self.calibrated.doubt() {
                    return Err(GaugeFault::Doubtful(doubt.to_string()));
                }
            }
            let step = reading.time.zip(self.last).map_or(0.0, |(now, last)| now - last);
            let value = self.calibrated.wrench(&reading.borrowed(), step).map_err(GaugeFault::Reading)?;
            self.last = reading.time.or(self.last);
            return Ok(Some(Sample { time: reading.time, value }));
        }
        match self.rest {
            Some(rest) => Err(GaugeFault::Unusable(format!("it ends within the {rest} s of rest"))),
            None => Ok(None),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Cursor;
    use std::path::PathBuf;

    use fingertip_calibration::file::CalibrationFile;
    use fingertip_recordings::mcap::{McapWriter, RecordedSignals};
    use nalgebra::DMatrix;

    use super::super::testing::Folder;
    use super::super::{Feed, Next};
    use super::{Calibrating, GaugesOf, SignalUnit, calibrated};
    use crate::calibrated::Calibration;

    /// A sensor whose gauges are the components of the wrench times two, with a zero of 0.5 V.
    fn calibration(folder: &Folder) -> PathBuf {
        let path = folder.0.join("cal.toml");
        let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
        let file = CalibrationFile::new(matrix, vec![1.0; 6], vec![0.5; 6], SignalUnit::Volt).unwrap();
        CalibrationFile { range: Some([-10.0, 10.0]), ..file }.write(&path).unwrap();
        path
    }

    /// Time, gauges (all the same but the first) and dummy gauge: 0.25 s of rest, during which and after which all
    /// drift together; then 3 N along x, a reading beyond the range, and 3 N again.
    fn rows() -> Vec<(f64, f64, f64, f64)> {
        let drift = |number: usize| 0.01 * number as f64;
        (0..8)
            .map(|number| {
                let load = [0.0, 0.0, 0.0, 0.0, 0.0, 6.0, 11.0, 6.0][number];
                let other = 0.75 + drift(number);
                (number as f64 * 0.05, other + load, other, 0.1 + drift(number))
            })
            .collect()
    }

    fn forces(feed: &mut dyn Feed) -> Vec<Result<(f64, f64), String>> {
        let mut all = Vec::new();
        loop {
            match feed.next().unwrap() {
                Next::Reading(reading) => {
                    all.push(Ok((reading.wrench.force().x, reading.wrench.torque().z)));
                }
                Next::Fault(why) => all.push(Err(why)),
                Next::Silence => {}
                Next::End => return all,
            }
        }
    }

    #[test]
    fn gauges_of_a_recording_become_wrenches_by_their_calibration() {
        let folder = Folder::new("gauges-recording");
        let calibration = calibration(&folder);
        let mut text = "t_s,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V,dummy_V\n".to_owned();
        let mut writer = McapWriter::new(Cursor::new(Vec::new())).unwrap();
        let topics =
            ["/fingertip/signals", "/fingertip/dummy"].map(|name| writer.signals(name, "tip").unwrap());
        for (time, first, other, dummy) in rows() {
            text += &format!("{time},{first},{other},{other},{other},{other},{other},{dummy}\n");
            for (topic, values) in
                [(topics[0], vec![first, other, other, other, other, other]), (topics[1], vec![dummy])]
            {
                writer.write_signals(topic, time, RecordedSignals { unit: "V".to_owned(), values }).unwrap();
            }
        }
        let files = [folder.0.join("volts.csv"), folder.0.join("volts.mcap")];
        fs::write(&files[0], text).unwrap();
        fs::write(&files[1], writer.finish().unwrap().into_inner()).unwrap();
        for path in &files {
            let play = |rest, sensor| {
                let calibration = Calibration::read(&calibration).unwrap();
                let how = Calibrating { calibration: &calibration, rest, celsius: None };
                let mut notes = Vec::new();
                let gauges = GaugesOf::Recording { path, sensor, speed: 0.0 };
                calibrated(gauges, &how, &mut notes).map(|mut feed| (forces(&mut *feed), notes))
            };
            // The zero is that of the calibration, and the drift is taken for a load.
            let (all, notes) = play(None, None).unwrap();
            assert_eq!(all.len(), 8, "{path:?}");
            let (force, torque) = *all[5].as_ref().unwrap();
            assert!((force - 3.15).abs() < 1e-12 && (torque - 0.15).abs() < 1e-12, "{force} {torque}");
            assert!(all[6].as_ref().unwrap_err().contains("saturated"));
            assert!(notes[0].contains("dummy gauge is not used"), "{notes:?}");
            // From the rest, and less the drift that the dummy gauge shows. Five samples are too few to be sure.
            let (all, _) = play(Some(0.24), None).unwrap();
            assert!(all[0].as_ref().unwrap_err().contains("too few to tell a rest"), "{all:?}");
            let (force, torque) = *all.last().unwrap().as_ref().unwrap();
            assert!((force - 3.0).abs() < 1e-12 && torque.abs() < 1e-12, "{force} {torque}");
            let error = play(None, Some("other")).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains("signals"), "{error}");
        }
    }

    #[test]
    fn the_simulated_fingertip_is_played_through_a_calibration() {
        let folder = Folder::new("gauges-simulated");
        let calibration = calibration(&folder);
        let mut notes = Vec::new();
        let calibration = Calibration::read(&calibration).unwrap();
        let how = Calibrating { calibration: &calibration, rest: None, celsius: None };
        let address = super::super::address("sim").unwrap();
        let mut feed = calibrated(GaugesOf::Simulated(&address), &how, &mut notes).unwrap();
        let Next::Reading(reading) = feed.next().unwrap() else { unreachable!() };
        assert!(reading.wrench.is_finite() && reading.time == Some(0.0));
    }
}
