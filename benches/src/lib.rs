//! Benchmarks of the fingertip workspace.
