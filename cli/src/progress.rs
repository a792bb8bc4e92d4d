//! How far a long run has come.

use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};

use crate::verbosity::is_quiet;

/// Shorter files are done before a bar could be read.
const WORTH_A_BAR: u64 = 16 << 20;

/// A bar on the standard error, if that is a terminal and the recording is long: of `length` bytes, if that is known.
pub(crate) fn bar(length: Option<u64>) -> ProgressBar {
    let worth_it = |length: &u64| *length > WORTH_A_BAR && !is_quiet();
    let Some(length) = length.filter(worth_it) else { return ProgressBar::hidden() };
    let bar = ProgressBar::new(length).with_finish(ProgressFinish::AndClear);
    let style = "{wide_bar} {bytes} of {total_bytes}, {bytes_per_sec}, {eta} left";
    match ProgressStyle::with_template(style) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

#[cfg(test)]
mod tests {
    use super::{WORTH_A_BAR, bar};
    use std::io::Read as _;

    #[test]
    fn a_bar_is_as_long_as_a_file_that_is_worth_one() {
        assert_eq!((bar(None).length(), bar(Some(WORTH_A_BAR)).length()), (None, None));
        let long = bar(Some(WORTH_A_BAR + 1));
        let mut bytes = [0; 1000];
        long.wrap_read(std::io::repeat(0)).read_exact(&mut bytes).unwrap();
        assert_eq!((long.length(), long.position()), (Some(WORTH_A_BAR + 1), 1000));
    }
}
