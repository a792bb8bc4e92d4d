//! One fault: what is written where, and in place of what.

use std::fmt;
use std::ops::Range;

/// How a fault is switched on at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// An expression takes another value.
    Expression,
    /// A statement is left out.
    Statement,
}

/// A fault in one place of a source file.
#[derive(Clone, Debug)]
pub struct Fault {
    /// From the workspace's root.
    pub file: String,
    /// The bytes of the expression or statement.
    pub range: Range<usize>,
    pub form: Form,
    /// What is compiled in its place; empty for a statement.
    pub replacement: String,
    /// Such as "+ → -".
    pub change: String,
    pub line: usize,
    pub column: usize,
    /// The source line, without the blanks around it.
    pub source: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}: {}    {}", self.file, self.line, self.column, self.change, self.source)
    }
}
