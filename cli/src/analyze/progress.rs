//! How far a long run has come.

use indicatif::{ProgressBar, ProgressStyle};

/// Shorter files are done before a bar could be read.
const WORTH_A_BAR: u64 = 16 << 20;

/// A bar on the standard error, if that is a terminal and the recording is long.
pub(super) struct Progress(Option<ProgressBar>);

impl Progress {
    /// For a recording of `length` bytes, if that is known.
    pub(super) fn new(length: Option<u64>) -> Self {
        Self(length.filter(|length| *length > WORTH_A_BAR).map(|length| {
            let bar = ProgressBar::new(length);
            let style = "{wide_bar} {bytes} of {total_bytes}, {bytes_per_sec}, {eta} left";
            if let Ok(style) = ProgressStyle::with_template(style) {
                bar.set_style(style);
            }
            bar
        }))
    }

    /// So many bytes are read.
    pub(super) fn at(&self, bytes: u64) {
        if let Some(bar) = &self.0 {
            bar.set_position(bytes);
        }
    }

    pub(super) fn finish(&self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
