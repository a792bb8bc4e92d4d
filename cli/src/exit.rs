//! What the exit codes of the command mean.

pub(crate) const DONE: u8 = 0;
pub(crate) const FAILED: u8 = 1;
pub(crate) const USAGE: u8 = 2;
/// What shells say of a program that Ctrl-C has ended.
pub(crate) const INTERRUPTED: u8 = 130;

/// Every exit code of the command, with its meaning.
pub const EXIT_CODES: [(u8, &str); 4] = [
    (DONE, "done"),
    (
        FAILED,
        "an input is bad, a calibration is bad or does not hold, a sensor ended, or an output cannot be written; one \
         sentence on the standard error says which and how to mend it",
    ),
    (USAGE, "wrong usage"),
    (INTERRUPTED, "interrupted by Ctrl-C; what was half written is taken away"),
];
