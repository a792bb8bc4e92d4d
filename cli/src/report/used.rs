//! What a recording was taken with: the scene and the calibration, in words.

use std::path::Path;

use fingertip_calibration::file::CalibrationFile;
use fingertip_scene::Scene;

use crate::standard::name_of;
use crate::table::{Table, count, short};

/// What the command line gave beside the scene, and what came of it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Given<'a> {
    /// A calibration in the place of that of the scene.
    pub(crate) calibration: Option<&'a Path>,
    /// A payload in the place of that of the scene.
    pub(crate) payload: Option<&'a Path>,
    /// Whether the calibration of scene or command line turned readings into wrenches.
    pub(crate) calibrated: bool,
}

/// A line for each section of the scene, and what the calibration tells of itself. What is empty is left out.
pub(crate) fn table(scene: &Scene, given: &Given<'_>) -> Table {
    let mut table = Table::new("Scene and calibration", ["part", "what was used"]);
    let mut row = |part: &str, said: &str| {
        if !said.is_empty() {
            table.row([part.to_owned(), said.to_owned()]);
        }
    };
    for line in scene.meaning() {
        let (section, said) = line.split_once(' ').unwrap_or((&line, ""));
        // What the command line gave stands below in the place of these.
        let replaced = section == "sensor" && given.calibration.is_some()
            || section == "payload" && given.payload.is_some();
        if !replaced {
            row(section, said.trim_start());
        }
    }
    if let Some(path) = given.payload {
        row("payload", &name_of(path));
    }
    if let Some(file) = scene.calibration().filter(|_| given.calibrated) {
        row("calibration", &given.calibration.map(name_of).unwrap_or_default());
        let from = &file.provenance;
        row("calibrated sensor", &from.serial);
        row("calibrated on", &from.date);
        row("calibrated by", &from.method);
        row("calibrated with", &from.source);
        row("calibration quality", &quality(file));
    }
    table
}

fn quality(file: &CalibrationFile) -> String {
    let quality = &file.quality;
    let mut parts = vec![quality.verdict.name().to_owned()];
    parts.extend(quality.reasons.iter().cloned());
    parts.extend(quality.samples.map(|samples| format!("{} loads", count(samples))));
    parts.extend(quality.condition_number.map(|number| format!("condition number {}", short(number))));
    parts.join("; ")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use fingertip_calibration::file::{CalibrationFile, Provenance, SignalUnit, Verdict};
    use fingertip_scene::Scene;
    use nalgebra::DMatrix;

    use super::{Given, quality, table};

    const SCENE: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\n\
        radius_m = 0.013\n";

    #[test]
    fn every_section_has_its_row_and_what_is_empty_has_none() {
        let sensor = "[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = [[1,0,0,0,0,0], [0,1,0,0,0,0], \
            [0,0,1,0,0,0], [0,0,0,1,0,0], [0,0,0,0,1,0], [0,0,0,0,0,1]]\n";
        let sensor = sensor.replace('0', "0.0").replace('1', "1.0");
        let scene = Scene::from_text(&format!("{SCENE}{sensor}")).unwrap();
        let parts = |given: &Given<'_>| -> Vec<String> {
            table(&scene, given).rows.into_iter().map(|row| row[0].clone()).collect()
        };
        assert_eq!(parts(&Given::default()), ["input", "sensor", "surface"]);
        let calibrated = Given { calibrated: true, ..Given::default() };
        // A matrix in the scene has neither serial number nor date.
        assert_eq!(parts(&calibrated), ["input", "sensor", "surface", "calibration quality"]);
        let given = Given {
            calibration: Some(Path::new("a/tip.toml")),
            payload: Some(Path::new("p.toml")),
            ..calibrated
        };
        assert_eq!(parts(&given), ["input", "surface", "payload", "calibration", "calibration quality"]);
        let rows = table(&scene, &given).rows;
        assert_eq!(rows[1], ["surface", "sphere, a sphere, or a part of it around a pole; radius_m = 0.013"]);
        assert_eq!(
            rows[2..],
            [["payload", "p.toml"], ["calibration", "tip.toml"], ["calibration quality", "unchecked"]]
        );
    }

    #[test]
    fn the_quality_is_said_with_its_reasons() {
        let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
        let mut file = CalibrationFile::new(matrix, vec![1.0; 6], vec![0.0; 6], SignalUnit::Volt).unwrap();
        file.provenance = Provenance { serial: "FT1".to_owned(), ..Provenance::default() };
        file.quality.verdict = Verdict::Suspect;
        file.quality.reasons = vec!["two loads stand out".to_owned()];
        file.quality.samples = Some(1200);
        file.quality.condition_number = Some(3.5);
        assert_eq!(quality(&file), "suspect; two loads stand out; 1\u{202f}200 loads; condition number 3.5");
    }
}
