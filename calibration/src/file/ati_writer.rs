//! Writing ATI's calibration files.

use core::fmt::Write as _;

use super::AtiCalibration;
use super::ati::AtiAxis;
use crate::Axis;

impl AtiCalibration {
    /// The text of a `.cal` file: the newer layout if [`user_axes`](Self::user_axes) is there, the
    /// older otherwise. Numbers are written with as many digits as it takes to read back the very
    /// same.
    #[must_use]
    pub fn to_xml(&self) -> String {
        let mut text = String::from("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n");
        let gauges = self.axes[0].values.len();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "<FTSensor Serial=\"{}\" BodyStyle=\"{}\" Family=\"{}\" NumGages=\"{gauges}\" CalFileVersion=\"{}\">",
            escape(&self.serial),
            escape(&self.body_style),
            escape(&self.family),
            escape(&self.file_version),
        );
        let _ = write!(
            text,
            "\t<Calibration PartNumber=\"{}\" CalDate=\"{}\" ForceUnits=\"{}\" TorqueUnits=\"{}\" DistUnits=\"{}\"",
            escape(&self.part_number),
            escape(&self.date),
            escape(&self.force_unit),
            escape(&self.torque_unit),
            escape(&self.distance_unit),
        );
        for (name, value) in &self.other {
            let _ = write!(text, " {name}=\"{}\"", escape(value));
        }
        text.push_str(">\n");
        for (axis, row) in Axis::ALL.into_iter().zip(&self.axes) {
            write_row(&mut text, "Axis", axis, row, true);
        }
        let ([dx, dy, dz], [rx, ry, rz]) = (self.translation, self.rotation);
        let _ = writeln!(
            text,
            "\t\t<BasicTransform Dx=\"{dx}\" Dy=\"{dy}\" Dz=\"{dz}\" Rx=\"{rx}\" Ry=\"{ry}\" Rz=\"{rz}\"/>"
        );
        if let Some(rows) = &self.user_axes {
            for (axis, row) in Axis::ALL.into_iter().zip(rows) {
                write_row(&mut text, "UserAxis", axis, row, false);
            }
        }
        text.push_str("\t</Calibration>\n</FTSensor>\n");
        text
    }
}

fn write_row(text: &mut String, tag: &str, axis: Axis, row: &AtiAxis, scaled: bool) {
    let values: String = row.values.iter().map(|value| format!(" {value}")).collect();
    let _ = write!(text, "\t\t<{tag} Name=\"{axis}\" values=\"{values} \" max=\"{}\"", row.max);
    if scaled || row.scale != 1.0 {
        let _ = write!(text, " scale=\"{}\"", row.scale);
    }
    text.push_str("/>\n");
}

fn escape(value: &str) -> String {
    let mut escaped = String::with_capacity(value.len());
    for character in value.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '"' => escaped.push_str("&quot;"),
            // As they stand, a reader takes them for spaces.
            '\t' | '\n' | '\r' => {
                let _ = write!(escaped, "&#{};", u32::from(character));
            }
            // XML has no way to write other control characters.
            c if c < ' ' => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::super::{
        AtiCalibration, AtiError, CalibrationFile, Curve, FileError, SignalUnit, Temperature,
    };
    use crate::creep::Creep;
    use crate::testing::Largest as _;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    const NEW: &str = r#"<?xml version="1.0" encoding="utf-8"?><!-- a note -->
<FTSensor Serial="FT1" BodyStyle="Nano &amp; &quot;Co&quot;" Family="DAQ" NumGages="6" CalFileVersion="1.1">
<Calibration PartNumber="US-1-2" CalDate="1/2/2003" ForceUnits="lbf" TorqueUnits="lbf-in" DistUnits="in"
 OutputRange="20" OutputBipolar="True">
<Axis Name="Fx" values=" 10 0 0 0 0 0 " max="12" scale="10"/>
<Axis Name="Fy" values="0 20 0 0 0 0" max="12" scale="10"/>
<Axis Name="Fz" values="0 0 3 0 0 0" max="25" scale="1"/>
<Axis Name="Tx" values="0 0 0 4 0 0" max="15" scale="2"/>
<Axis Name="Ty" values="0 0 0 0 5 0" max="15" scale="1"/>
<Axis Name="Tz" values="0 0 0 0 0 6" max="15" scale="1"/>
<BasicTransform Dx="0" Dy="0" Dz="0.5" Rx="0" Ry="0" Rz="0"/>
</Calibration></FTSensor>"#;

    #[test]
    fn old_layout_is_transformed_to_the_users_origin() {
        let ati = AtiCalibration::from_xml(NEW).unwrap();
        let matrix = ati.loads_per_volt().unwrap();
        let pound = 4.448_221_615_260_5;
        let pound_inch = pound * 0.0254;
        assert!((matrix[(1, 1)] - 2.0 * pound).abs() < 1e-15);
        // One volt on gauge 1 is Fy = 2 lbf, which about a point 0.5 in further up is Tx = 1 lbf-in.
        assert!((matrix[(3, 1)] - pound_inch).abs() < 1e-16);
        assert!((matrix[(4, 0)] + 0.5 * pound_inch).abs() < 1e-16);
        let file = ati.to_calibration().unwrap();
        assert_eq!(file.range, Some([-10.0, 10.0]));
        let from = &file.provenance;
        assert_eq!((from.serial.as_str(), from.date.as_str()), ("FT1", "1/2/2003"));
        assert_eq!((from.method.as_str(), from.tool.as_str()), ("ATI Nano & \"Co\" US-1-2", crate::TOOL));
        assert_eq!(from.source, "ATI .cal file");
        assert!((file.nominal[5] - 15.0 * pound_inch).abs() < 1e-15);
        // Forward and back: the load that one volt on gauge 1 tells of.
        let load = file.load(&[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]).unwrap();
        assert!((load - matrix.column(1)).largest() < 1e-14);
    }

    #[test]
    fn both_layouts_round_trip() {
        let old = AtiCalibration::from_xml(NEW).unwrap();
        assert_eq!(old.body_style, "Nano & \"Co\"");
        assert_eq!(AtiCalibration::from_xml(&old.to_xml()).unwrap(), old);
        let mut new = old.clone();
        new.user_axes = Some(old.axes.clone().map(|mut axis| {
            axis.scale = 1.0;
            axis
        }));
        assert_eq!(AtiCalibration::from_xml(&new.to_xml()).unwrap(), new);
    }

    #[test]
    fn errors_name_element_and_attribute() {
        for (from, to, names) in [
            ("lbf-in", "parsec", ["Calibration", "TorqueUnits"]),
            ("0 20 0 0 0 0", "0 20 0 0 0", ["Axis Fy", "values"]),
            ("0 20 0 0 0 0", "0 NaN 0 0 0 0", ["Axis Fy", "values"]),
            ("max=\"25\"", "max=\"0\"", ["Axis Fz", "max"]),
            ("max=\"25\"", "", ["Axis Fz", "max"]),
            ("scale=\"2\"", "scale=\"x\"", ["Axis Tx", "scale"]),
            ("scale=\"2\"", "scale=\"0\"", ["Axis Tx", "scale"]),
            ("Name=\"Tz\"", "Name=\"Tw\"", ["Axis Tz", "missing"]),
            ("Dz=\"0.5\"", "Dz=\"inf\"", ["BasicTransform", "Dz"]),
        ] {
            let broken = NEW.replacen(from, to, 1);
            assert_ne!(broken, NEW);
            let error = AtiCalibration::from_xml(&broken).unwrap_err().to_string();
            assert!(names.iter().all(|name| error.contains(name)), "{error}");
        }
        let flat =
            AtiCalibration::from_xml(&NEW.replace("scale=\"2\"", "scale=\"0\"")).unwrap_err().to_string();
        assert!(flat.contains("must be positive"), "{flat}");
        assert!(matches!(AtiCalibration::from_xml("<FTSensor"), Err(AtiError::NotXml(_))));
        // Something else, though all that is asked for stands in it.
        let other = NEW.replace("FTSensor", "Sensor");
        assert!(matches!(
            AtiCalibration::from_xml(&other),
            Err(AtiError::MissingElement { element }) if element == "FTSensor"
        ));
        assert!(matches!(AtiCalibration::from_xml("<a/>"), Err(AtiError::MissingElement { .. })));
        let turned = AtiCalibration::from_xml(&NEW.replace("Rz=\"0\"", "Rz=\"30\"")).unwrap();
        assert!(matches!(turned.to_calibration(), Err(AtiError::Turned)));
        let singular = AtiCalibration::from_xml(&NEW.replace("0 20 0", "20 0 0")).unwrap();
        assert!(matches!(singular.to_calibration(), Err(AtiError::Calibration(_))));
    }

    /// Finite in the file's own units, but not in N and N·m: refused by name, not read as infinite.
    #[test]
    fn numbers_that_si_cannot_hold_are_refused_by_name() {
        for (from, to, element, attribute, value) in [
            ("0 20 0 0 0 0", "0 5e307 0 0 0 0", "Axis Fy", "`values`", 5e307),
            (" 10 0 0", " -5e307 0 0", "Axis Fx", "`values`", -5e307),
            ("max=\"25\"", "max=\"1e308\"", "Axis Fz", "`max`", 1e308),
            ("5 0\" max=\"15\"", "5 0\" max=\"5e-324\"", "Axis Ty", "`max`", 5e-324),
            ("scale=\"2\"", "scale=\"1e-308\"", "Axis Tx", "`values`", 4.0),
            ("Dz=\"0.5\"", "Dz=\"1e308\"", "BasicTransform", "`Dx, Dy, Dz`", 1e308),
        ] {
            let text = NEW.replace("scale=\"10\"", "scale=\"1\"");
            let broken = text.replacen(from, to, 1);
            assert_ne!(broken, text);
            let error = AtiCalibration::from_xml(&broken).unwrap_err();
            assert!(matches!(error, AtiError::BadAttribute { .. }), "{error:?}");
            let error = error.to_string();
            let named = [element, attribute, &value.to_string()].iter().all(|part| error.contains(*part));
            assert!(named, "{error}");
        }
        // A calibration whose inverse overflows cannot be written either.
        let mut file = AtiCalibration::from_xml(NEW).unwrap().to_calibration().unwrap();
        file.matrix = DMatrix::from_diagonal_element(6, 6, 1e-100);
        file.nominal = vec![1e300; 6];
        let error = AtiCalibration::from_calibration(&file).unwrap_err();
        assert!(matches!(error, FileError::NotFinite { .. }), "{error}");
    }

    #[test]
    fn texts_and_scales_of_both_layouts_round_trip() {
        let mut ati = AtiCalibration::from_xml(NEW).unwrap();
        ati.serial = "a\tb\nc\rd <&>\"' é\u{85}".to_owned();
        ati.other[0].1 = " 2 0 ".to_owned();
        let mut rows = ati.axes.clone();
        rows[3].scale = 7.5;
        ati.user_axes = Some(rows);
        assert_eq!(AtiCalibration::from_xml(&ati.to_xml()).unwrap(), ati);
        // What XML cannot say becomes a space.
        ati.serial = "a\u{1}b".to_owned();
        assert_eq!(AtiCalibration::from_xml(&ati.to_xml()).unwrap().serial, "a b");
        // Attributes of other namespaces are not the calibration's.
        let strange = NEW.replace("OutputRange=", "xmlns:o=\"urn:o\" o:OutputRange=\"3\" OutputRange=");
        let ati = AtiCalibration::from_xml(&strange).unwrap();
        assert_eq!(ati.other, AtiCalibration::from_xml(NEW).unwrap().other);
    }

    #[test]
    fn range_is_read_and_written() {
        let range = |range: &str, bipolar: &str| {
            let text = NEW.replace("OutputRange=\"20\"", &format!("OutputRange=\"{range}\""));
            let text = text.replace("OutputBipolar=\"True\"", &format!("OutputBipolar=\"{bipolar}\""));
            AtiCalibration::from_xml(&text).unwrap().to_calibration().unwrap().range
        };
        assert_eq!(range(" 20 ", "TRUE"), Some([-10.0, 10.0]));
        assert_eq!(range("20", "False"), Some([0.0, 20.0]));
        for nonsense in ["0", "-20", "x", "inf", "nan"] {
            assert_eq!(range(nonsense, "True"), None, "{nonsense}");
        }
        let mut file = AtiCalibration::from_xml(NEW).unwrap().to_calibration().unwrap();
        assert_eq!(file.quality.verdict, crate::file::Verdict::Unchecked);
        assert!(file.quality.reasons[0].contains("tare"));
        for ends in [[-5.0, 5.0], [0.0, 4.0]] {
            file.range = Some(ends);
            let ati = AtiCalibration::from_calibration(&file).unwrap();
            let again = AtiCalibration::from_xml(&ati.to_xml()).unwrap().to_calibration().unwrap();
            assert_eq!(again.range, Some(ends));
        }
    }

    #[test]
    fn what_a_cal_file_cannot_say_is_refused() {
        let plain = AtiCalibration::from_xml(NEW).unwrap().to_calibration().unwrap();
        let refused = |change: &dyn Fn(&mut CalibrationFile)| {
            let mut file = plain.clone();
            change(&mut file);
            AtiCalibration::from_calibration(&file).unwrap_err().to_string()
        };
        assert!(refused(&|file| file.quadratic = Some(DMatrix::zeros(6, 21))).contains("quadratic"));
        let curve = Curve { products: vec![vec![0, 1]], loads: DMatrix::zeros(6, 1), ..Curve::default() };
        assert!(refused(&|file| file.curve = Some(curve.clone())).contains("curve"));
        let creep = Creep { times_s: vec![3.0], shares: vec![vec![0.01; 6]] };
        assert!(refused(&|file| file.creep = Some(creep.clone())).contains("creep"));
        let drift = Temperature {
            reference_celsius: 22.5,
            range_celsius: [10.0, 40.0],
            zero_drift: vec![1e-3; 6],
            zero_curvature: vec![0.0; 6],
            gain_drift: vec![0.0; 6],
        };
        assert!(refused(&|file| file.temperature = Some(drift.clone())).contains("22.5"));
        assert!(refused(&|file| file.signal_unit = SignalUnit::Count).contains("signal_unit"));
        assert!(refused(&|file| file.matrix.fill_row(0, 0.0)).contains("inverse"));
        assert!(refused(&|file| file.nominal[2] = -1.0).contains("nominal[2]"));
        let three = DMatrix::identity(6, 3);
        let three = CalibrationFile::new(three, vec![1.0; 3], vec![0.0; 6], SignalUnit::Volt).unwrap();
        assert!(matches!(AtiCalibration::from_calibration(&three), Err(FileError::NotSixAxes { found: 3 })));
    }

    proptest! {
        #[test]
        fn our_calibration_survives_a_detour(entries in proptest::collection::vec(-1.0..1.0_f64, 36)) {
            let matrix = DMatrix::from_column_slice(6, 6, &entries) + DMatrix::identity(6, 6) * 3.0;
            let file = CalibrationFile::new(
                matrix, vec![10.0, 11.0, 12.0, 0.1, 0.2, 0.3], vec![0.0; 6], SignalUnit::Volt,
            ).unwrap();
            let ati = AtiCalibration::from_calibration(&file).unwrap();
            let again = AtiCalibration::from_xml(&ati.to_xml()).unwrap().to_calibration().unwrap();
            prop_assert!((again.matrix - file.matrix).largest() < 1e-11);
            prop_assert_eq!(again.nominal, file.nominal);
        }
    }
}
