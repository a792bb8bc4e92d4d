//! What a tactile array reads at each row, of a scene with `[fusion]`.

use fingertip_recordings::{NumberColumn, Row};
use fingertip_scene::{ArrayReading, FusedTouch, NoFusion, Pipeline};
use nalgebra::Vector3;

use crate::error::CliError;
use crate::opened::Rows;
use crate::table::count;

/// The places of an array in a recording: columns `array1_x_m` to `array1_z_m` and `array1_normal_N`, `array2_x_m` and so on.
pub(super) struct Array {
    places: Vec<[NumberColumn; 4]>,
    /// Rows that gave no estimate, and why the first of them.
    failed: u64,
    why: Option<NoFusion>,
}

/// The contacts of a row by the places of the array, `None` where one is not pressed.
#[derive(Default)]
pub(super) struct Fused {
    pub(super) touch: Option<FusedTouch<f64>>,
    /// For each place, which contact is its own.
    pub(super) places: Vec<Option<usize>>,
}

impl Array {
    /// The recording must have the columns of each place.
    pub(super) fn new(places: usize, reader: &mut Rows) -> Result<Self, CliError> {
        let mut found = Vec::new();
        for place in 1..=places {
            let names = ["x_m", "y_m", "z_m", "normal_N"].map(|part| format!("array{place}_{part}"));
            let columns = names.each_ref().map(|name| reader.watch(name));
            let [Some(x), Some(y), Some(z), Some(normal)] = columns else {
                let message = format!(
                    "has no columns {}, which tell where place {place} of the array is pressed and how hard; add them, set \
                     `places` of [fusion], or leave [fusion] out",
                    names.join(", ")
                );
                return Err(CliError::Calibrate { path: reader.file().into(), message });
            };
            found.push([x, y, z, normal]);
        }
        Ok(Self { places: found, failed: 0, why: None })
    }

    /// What the last sample of a pipeline and the array say together. A place is pressed if it has four numbers, of which the
    /// normal force is positive.
    pub(super) fn fuse(&mut self, row: &Row<'_>, pipeline: &Pipeline<f64>, fused: &mut Fused) {
        let mut readings = Vec::with_capacity(self.places.len());
        fused.places.clear();
        for columns in &self.places {
            let numbers = columns.each_ref().map(|column| row.number(column));
            let reading = match numbers {
                [Some(x), Some(y), Some(z), Some(normal_force)] if normal_force > 0.0 => {
                    Some(ArrayReading { centroid: Vector3::new(x, y, z), normal_force })
                }
                _ => None,
            };
            fused.places.push(reading.is_some().then_some(readings.len()));
            readings.extend(reading);
        }
        fused.touch = None;
        if readings.is_empty() {
            return;
        }
        match pipeline.fuse(&readings) {
            Ok(touch) => fused.touch = Some(touch),
            Err(why) => {
                self.failed += 1;
                self.why.get_or_insert(why);
            }
        }
    }

    /// What the reader of the results should know.
    pub(super) fn note(&self) -> Option<String> {
        let why = self.why.as_ref()?;
        Some(format!(
            "wrench and array could not be fused in {} rows, in the first of them since: {why}",
            count(self.failed)
        ))
    }
}
