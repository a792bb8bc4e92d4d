//! The matrix of stress cases (`docs/theory/README.md#stress-cases` and more) and every routine, in `f32` and
//! `f64`: run small by the test `stability` and large by the report of the benches, which shares these files.
//!
//! Bounds: what a backward stable routine keeps, a small multiple of the rounding unit times the
//! conditioning of the case. References: arithmetic of 220 bits, or an invariant of the law.

#![allow(clippy::expect_used, reason = "a case that cannot be made is a failure, not to be passed over")]

#[path = "../../contact/tests/oracle/big.rs"]
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
    let parts: [fn(usize, &mut Vec<Row>); 13] = [
        solvers::rows::<f32>,
        solvers::rows::<f64>,
        lines::rows::<f32>,
        lines::rows::<f64>,
        contacts::rows::<f32>,
        contacts::rows::<f64>,
        soft::rows::<f32>,
        soft::rows::<f64>,
        friction::rows::<f32>,
        friction::rows::<f64>,
        detectors::rows::<f32>,
        detectors::rows::<f64>,
        fits::rows,
    ];
    // Each draws from a stream of its own, so they may run beside each other.
    std::thread::scope(|scope| {
        let running = parts.map(|part| {
            scope.spawn(move || {
                let mut rows = Vec::new();
                part(trials, &mut rows);
                rows
            })
        });
        running
            .into_iter()
            .flat_map(|part| part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}
