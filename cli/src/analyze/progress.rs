//! How far a long run has come.

use alloc::rc::Rc;
use core::cell::Cell;

use indicatif::{ProgressBar, ProgressStyle};

/// Shorter files are done before a bar could be read.
const WORTH_A_BAR: u64 = 16 << 20;

/// A bar on the standard error, if that is a terminal and the recording is long.
pub(super) struct Progress {
    bar: Option<ProgressBar>,
    read: Rc<Cell<u64>>,
}

impl Progress {
    /// For a recording of `length` bytes, if that is known, of which so many as `read` tells were read.
    pub(super) fn new(length: Option<u64>, read: Rc<Cell<u64>>) -> Self {
        let bar = length.filter(|length| *length > WORTH_A_BAR).map(|length| {
            let bar = ProgressBar::new(length);
            let style = "{wide_bar} {bytes} of {total_bytes}, {bytes_per_sec}, {eta} left";
            if let Ok(style) = ProgressStyle::with_template(style) {
                bar.set_style(style);
            }
            bar
        });
        Self { bar, read }
    }

    /// Shows how far it is.
    pub(super) fn show(&self) {
        if let Some(bar) = &self.bar {
            bar.set_position(self.read.get());
        }
    }

    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
