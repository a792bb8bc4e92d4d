//! A curved sensor as Rust constants.

use core::fmt::Write as _;

use super::{CalibrationFile, FileError, Scalar};

/// Stands for the third gauge of a product of two.
const NONE: usize = u8::MAX as usize;

impl CalibrationFile {
    /// Constants of a curved sensor, and the functions that make a solver of them; that of the region where it was
    /// calibrated, if the file has one.
    pub(super) fn curve_in_rust(&self, scalar: Scalar) -> Result<String, FileError> {
        let name = scalar.name();
        let inverse = crate::linear::pseudo_inverse(&self.matrix).ok_or(FileError::Singular)?;
        let (terms, loads) = self.terms();
        let list = |field: &str, values: Vec<f64>| -> Result<String, FileError> {
            let wide =
                || FileError::OutOfRange { field: field.to_owned(), requirement: "within the range of f32" };
            let numbers = values.into_iter().map(|value| scalar.literal(value).ok_or_else(wide));
            Ok(format!("[{}]", numbers.collect::<Result<Vec<_>, _>>()?.join(", ")))
        };
        let load = |column: usize| list("curve", loads.column(column).iter().copied().collect());
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "\n/// Load of one unit of each signal [N, N·m].\npub const LINEAR: [[{name}; GAUGES]; 6] = ["
        );
        for (axis, row) in inverse.row_iter().enumerate() {
            let row = row.iter().map(|share| self.nominal[axis] * share).collect();
            let _ = writeln!(text, "    {},", list("matrix", row)?);
        }
        let _ = writeln!(
            text,
            "];\n\n/// The gauges of each product of signals, {NONE} where there is no third, and the load of one unit of it.\n\
             pub const PRODUCTS: [([u8; 3], [{name}; 6]); {}] = [",
            terms.products.len()
        );
        for (column, gauges) in terms.products.iter().enumerate() {
            let [a, b, c] = core::array::from_fn(|place| gauges.get(place).copied().unwrap_or(NONE));
            let _ = writeln!(text, "    ([{a}, {b}, {c}], {}),", load(column)?);
        }
        let widths = if terms.widths.is_empty() { vec![1.0; self.gauges()] } else { terms.widths.clone() };
        let _ = writeln!(
            text,
            "];\n\n/// Widths of the bumps [signal].\npub const WIDTHS: [{name}; GAUGES] = {};\n\n\
             /// The signals at which each bump is highest, and the load of one unit of it.\n\
             pub const BUMPS: [([{name}; GAUGES], [{name}; 6]); {}] = [",
            list("curve.widths", widths)?,
            terms.centres.len()
        );
        for (index, centre) in terms.centres.iter().enumerate() {
            let _ = writeln!(
                text,
                "    ({}, {}),",
                list("curve.centres", centre.clone())?,
                load(terms.products.len() + index)?
            );
        }
        let _ = write!(
            text,
            "];\n\n/// A solver of as many terms.\n\
             pub type Curved = fingertip_wrench::CurvedInverse<\n    {name},\n    GAUGES,\n    \
                 [fingertip_wrench::ProductTerm<{name}>; PRODUCTS.len()],\n    \
                 [fingertip_wrench::RadialTerm<{name}, GAUGES>; BUMPS.len()],\n>;\n\n\
             /// The curved sensor of these constants: of the load itself with `sign` 1, of the opposite one with -1.\n\
             ///\n\
             /// # Errors\n\
             /// Never for the numbers above; only if they were edited into nonsense.\n\
             pub fn curved_sensor(sign: {name}) -> Result<Curved, fingertip_wrench::BadCurve> {{\n    \
                 let load = |load| nalgebra::Vector6::<{name}>::from(load) * sign;\n    \
                 let linear = nalgebra::SMatrix::<{name}, 6, GAUGES>::from_fn(|axis, gauge| LINEAR[axis][gauge] * sign);\n    \
                 let products = PRODUCTS.map(|([a, b, c], of)| fingertip_wrench::ProductTerm::of_three(a, b, c, load(of)));\n    \
                 let bumps = BUMPS.map(|(centre, of)| fingertip_wrench::RadialTerm {{\n        \
                     centre: nalgebra::SVector::from(centre),\n        \
                     load: load(of),\n    \
                 }});\n    \
                 fingertip_wrench::CurvedInverse::new(linear, products)?\n        \
                     .with_radial(nalgebra::SVector::from(WIDTHS), bumps)\n}}\n"
        );
        if let Some(region) = &self.region {
            let _ = writeln!(
                text,
                "\n/// The mean of the signals that the sensor was calibrated with.\npub const CENTRE: [{name}; GAUGES] = {};\n\n\
                 /// What makes distances of signals from there [1/signal].\npub const WHITENING: [[{name}; GAUGES]; GAUGES] = [",
                list("region.centre", region.centre.clone())?
            );
            for row in region.whitening.row_iter() {
                let _ = writeln!(text, "    {},", list("region.whitening", row.iter().copied().collect())?);
            }
            let _ = write!(
                text,
                "];\n\n/// Where the sensor was calibrated: beyond, it means little.\n\
                 ///\n\
                 /// # Errors\n\
                 /// Never for the numbers above; only if they were edited into nonsense.\n\
                 pub fn region() -> Result<fingertip_wrench::CalibratedRegion<{name}, GAUGES>, fingertip_wrench::BadRegion> {{\n    \
                     fingertip_wrench::CalibratedRegion::new(\n        \
                         nalgebra::SVector::from(CENTRE),\n        \
                         nalgebra::SMatrix::<{name}, GAUGES, GAUGES>::from_fn(|row, gauge| WHITENING[row][gauge]),\n    )\n}}\n"
            );
        }
        Ok(text)
    }
}
