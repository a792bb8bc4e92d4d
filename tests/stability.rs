//! Every routine under every stress case keeps its bound. The report of the benches runs the same
//! table with more trials and shows it: `cargo run --release -p fingertip-benches --bin report`.
#![cfg(feature = "friction")]

extern crate alloc;

#[path = "stability/mod.rs"]
mod cases;

#[test]
fn no_case_loses_more_digits_than_its_conditioning() {
    let rows = cases::all(4);
    let mut bad = 0;
    for row in &rows {
        if !row.good() {
            bad += 1;
            println!(
                "{} | {} | {}: worst {:.2e} of its bound, {} failures, {} NaN in {} trials: {}",
                row.routine, row.case, row.scalar, row.worst, row.failures, row.nan, row.trials, row.note
            );
        }
    }
    println!("{} rows", rows.len());
    assert!(bad == 0, "{bad} of {} rows broke their bound", rows.len());
    // So many as were counted: no routine, case or precision may go missing.
    assert_eq!(rows.len(), 1287, "the matrix is whole");
}
