//! The matrix of stress cases (theory 12 and more) and every routine, in `f32` and `f64`: run small
//! by the test `stability` and large by the report of the benches, which shares these files.
//!
//! Bounds: what a backward stable routine keeps, a small multiple of the rounding unit times the
//! conditioning of the case. References: arithmetic of 220 bits, or an invariant of the law.

#[path = "../../surfaces/tests/oracle/big.rs"]
#[allow(dead_code, clippy::unwrap_used, reason = "an oracle of finite numbers")]
pub(crate) mod big;
pub(crate) mod contacts;
mod detectors;
mod fits;
mod friction;
pub(crate) mod levels;
mod lines;
pub(crate) mod matrix;
pub(crate) mod shapes;
pub(crate) mod soft;
pub(crate) mod solve;
pub(crate) mod solvers;

use matrix::Row;

/// All rows. Random cases are drawn `trials` times each.
pub(crate) fn all(trials: usize) -> Vec<Row> {
    let mut rows = Vec::new();
    solvers::rows::<f32>(trials, &mut rows);
    solvers::rows::<f64>(trials, &mut rows);
    lines::rows::<f32>(trials, &mut rows);
    lines::rows::<f64>(trials, &mut rows);
    contacts::rows::<f32>(trials, &mut rows);
    contacts::rows::<f64>(trials, &mut rows);
    soft::rows::<f32>(trials, &mut rows);
    soft::rows::<f64>(trials, &mut rows);
    friction::rows::<f32>(trials, &mut rows);
    friction::rows::<f64>(trials, &mut rows);
    detectors::rows::<f32>(trials, &mut rows);
    detectors::rows::<f64>(trials, &mut rows);
    fits::rows(trials, &mut rows);
    rows
}
