//! The `fingertip` command.

fn main() {}
