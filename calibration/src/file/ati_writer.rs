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
    if scaled {
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
            // XML has no way to write other control characters.
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::super::{AtiCalibration, AtiError, CalibrationFile, SignalUnit};
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
        assert!((file.nominal[5] - 15.0 * pound_inch).abs() < 1e-15);
        // Forward and back: the load that one volt on gauge 1 tells of.
        let load = file.load(&[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]).unwrap();
        assert!((load - matrix.column(1)).amax() < 1e-14);
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
            ("Name=\"Tz\"", "Name=\"Tw\"", ["Axis Tz", "missing"]),
            ("Dz=\"0.5\"", "Dz=\"inf\"", ["BasicTransform", "Dz"]),
        ] {
            let broken = NEW.replacen(from, to, 1);
            assert_ne!(broken, NEW);
            let error = AtiCalibration::from_xml(&broken).unwrap_err().to_string();
            assert!(names.iter().all(|name| error.contains(name)), "{error}");
        }
        assert!(matches!(AtiCalibration::from_xml("<FTSensor"), Err(AtiError::NotXml(_))));
        assert!(matches!(AtiCalibration::from_xml("<a/>"), Err(AtiError::MissingElement { .. })));
        let turned = AtiCalibration::from_xml(&NEW.replace("Rz=\"0\"", "Rz=\"30\"")).unwrap();
        assert!(matches!(turned.to_calibration(), Err(AtiError::Turned)));
        let singular = AtiCalibration::from_xml(&NEW.replace("0 20 0", "20 0 0")).unwrap();
        assert!(matches!(singular.to_calibration(), Err(AtiError::Calibration(_))));
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
            prop_assert!((again.matrix - file.matrix).amax() < 1e-11);
            prop_assert_eq!(again.nominal, file.nominal);
        }
    }
}
