//! How long the Rust calls take that Python makes, for `benchmarks/calls.py`: in one process, on the same numbers.

use core::hint::black_box;
use std::time::Instant;

use fingertip::Touches;
use fingertip::friction::SlipVerdict;
use fingertip::wrench::Wrench;
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::errors;
use crate::numbers;
use crate::scene::PyScene;

/// Seconds for `count` calls of `Pipeline::sense` with one wrench, without Python.
#[pyfunction]
pub(crate) fn time_sense(scene: &PyScene, wrench: &Bound<'_, PyAny>, count: u32) -> PyResult<f64> {
    let mut pipeline = scene.scene().pipeline();
    let wrench = Wrench::from_components(&numbers::numbers(wrench, "wrench")?.into());
    let start = Instant::now();
    for _ in 0..count {
        black_box(pipeline.sense(black_box(wrench), 1e-3));
    }
    Ok(start.elapsed().as_secs_f64())
}

/// Seconds for `count` calls of `Pipeline::sense_all` on columns (6 × rows) into columns that are there, without Python.
#[pyfunction]
pub(crate) fn time_all(scene: &PyScene, columns: PyReadonlyArray2<'_, f64>, count: u32) -> PyResult<f64> {
    let mut pipeline = scene.scene().pipeline();
    let apart = || errors::bad("`columns` must be six rows in one piece");
    let rows = columns.shape().get(1).copied().unwrap_or(0).max(1);
    let parts: Vec<&[f64]> = columns.as_slice().map_err(|_| apart())?.chunks_exact(rows).collect();
    let given: [&[f64]; 6] = parts.try_into().map_err(|_| apart())?;
    let mut room = vec![0.0; 9 * rows];
    let mut slip = vec![SlipVerdict::NotPressing; rows];
    let parts: Vec<&mut [f64]> = room.chunks_exact_mut(rows).collect();
    let [x, y, z, normal, sx, sy, sz, margin, used]: [&mut [f64]; 9] =
        parts.try_into().map_err(|_| apart())?;
    let mut touches = Touches {
        point: [x, y, z],
        normal_force: normal,
        tangential_force: [sx, sy, sz],
        margin,
        utilisation: used,
        slip: &mut slip,
    };
    // The first call pays for the memory.
    pipeline.sense_all(given, 1e-3, touches.by_ref());
    let start = Instant::now();
    for _ in 0..count {
        pipeline.sense_all(black_box(given), 1e-3, touches.by_ref());
    }
    let elapsed = start.elapsed().as_secs_f64();
    black_box(&mut room);
    Ok(elapsed)
}
