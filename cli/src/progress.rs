//! How far a long run has come.

use core::time::Duration;
use std::io::{self, IsTerminal as _};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};

use crate::verbosity::is_quiet;

/// Shorter files are done before a bar could be read.
const WORTH_A_BAR: u64 = 16 << 20;
/// What takes no longer is done before a word could be read.
const WORTH_A_WORD: Duration = Duration::from_millis(400);
/// How often the time that passed is drawn.
const TICK: Duration = Duration::from_millis(100);

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

/// Does what nothing tells the end of, such as a fit: on the standard error, if that is a terminal, stands `what` it does and
/// for how long, once that is long.
pub(crate) fn working<T>(what: &str, work: impl FnOnce() -> T) -> T {
    if is_quiet() || !io::stderr().is_terminal() {
        return work();
    }
    told_on(ProgressDrawTarget::stderr, what, WORTH_A_WORD, work)
}

fn told_on<T>(
    target: impl FnOnce() -> ProgressDrawTarget + Send,
    what: &str,
    after: Duration,
    work: impl FnOnce() -> T,
) -> T {
    let (working, ended) = channel::<()>();
    thread::scope(|scope| {
        let tell = move || tell(target, what, after, &ended);
        // Without a thread it goes on in silence.
        let _ = thread::Builder::new().name("progress".to_owned()).spawn_scoped(scope, tell);
        let done = work();
        drop(working);
        done
    })
}

/// Tells that work goes on until it has ended.
fn tell(target: impl FnOnce() -> ProgressDrawTarget, what: &str, after: Duration, ended: &Receiver<()>) {
    let start = Instant::now();
    let goes_on = |wait: Duration| ended.recv_timeout(wait) == Err(RecvTimeoutError::Timeout);
    if !goes_on(after) {
        return;
    }
    let spinner = ProgressBar::with_draw_target(None, target())
        .with_message(what.to_owned())
        .with_elapsed(start.elapsed())
        .with_finish(ProgressFinish::AndClear);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
        spinner.set_style(style);
    }
    spinner.tick();
    while goes_on(TICK) {
        spinner.tick();
    }
}

#[cfg(test)]
mod tests {
    use alloc::sync::Arc;
    use core::time::Duration;
    use std::io::{self, Read as _};
    use std::sync::Mutex;
    use std::thread::sleep;

    use indicatif::{ProgressDrawTarget, TermLike};

    use super::{WORTH_A_BAR, bar, told_on};

    #[test]
    fn a_bar_is_as_long_as_a_file_that_is_worth_one() {
        assert_eq!((bar(None).length(), bar(Some(WORTH_A_BAR)).length()), (None, None));
        let long = bar(Some(WORTH_A_BAR + 1));
        let mut bytes = [0; 1000];
        long.wrap_read(io::repeat(0)).read_exact(&mut bytes).unwrap();
        assert_eq!((long.length(), long.position()), (Some(WORTH_A_BAR + 1), 1000));
    }

    /// A terminal that keeps what is written to it.
    #[derive(Clone, Debug, Default)]
    struct Paper(Arc<Mutex<String>>);

    impl TermLike for Paper {
        fn width(&self) -> u16 {
            80
        }

        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn write_line(&self, text: &str) -> io::Result<()> {
            self.write_str(text)
        }

        fn write_str(&self, text: &str) -> io::Result<()> {
            self.0.lock().unwrap().push_str(text);
            Ok(())
        }

        fn clear_line(&self) -> io::Result<()> {
            Ok(())
        }

        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn long_work_is_told_and_short_work_is_not() {
        let said = |after: u64, lasts: u64| {
            let paper = Paper::default();
            let target = paper.clone();
            let answer = told_on(
                || ProgressDrawTarget::term_like(Box::new(target)),
                "fits",
                Duration::from_millis(after),
                || {
                    sleep(Duration::from_millis(lasts));
                    42
                },
            );
            assert_eq!(answer, 42);
            paper.0.lock().unwrap().clone()
        };
        assert!(said(1, 300).contains("fits, 0s"), "{}", said(1, 300));
        assert_eq!(said(600_000, 1), "");
    }
}
