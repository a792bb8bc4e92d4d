//! Answers that are to stay as they are, bit for bit.

use alloc::collections::BTreeMap;
use core::fmt::{Debug, Write};
use std::path::PathBuf;

/// Answers that are to stay as they are, bit for bit: a file holds how many there are of each kind, and a checksum
/// over all their digits.
///
/// An oracle says that an answer is right to within its error; this says that it is the very answer of before. So a
/// change that was not meant is seen even where it hides below the error bounds: a mending that no longer sets in, a
/// search that takes another way, a threshold that has moved. It says nothing of right and wrong, and stands beside
/// an oracle, never for it.
///
/// With `FINGERTIP_ACCEPT=1` the file is written anew. With `FINGERTIP_ANSWERS=FOLDER` the answers themselves are
/// written there, one file a name, so that those of two revisions can be compared by `diff`.
///
/// Only sums, products, quotients and square roots have the same bits everywhere; sines and powers are the system's.
/// Tests that use this are for one system, therefore.
#[derive(Debug)]
pub struct Unchanged {
    file: PathBuf,
    text: String,
}

impl Unchanged {
    /// Answers held in `file`, a path from the folder `root` of the crate that is tested.
    #[must_use]
    pub fn new(root: &str, file: &str) -> Self {
        Self { file: PathBuf::from(root).join(file), text: String::new() }
    }

    /// Notes the answers of one kind of problem, in their order. A number is known by the digits that its `Debug`
    /// prints, which are those of one number and no other.
    pub fn note<A: Debug>(&mut self, name: &str, answers: impl IntoIterator<Item = A>) {
        let mut kinds = BTreeMap::<String, u32>::new();
        let (mut all, mut sum) = (String::new(), FNV_OFFSET);
        for answer in answers {
            let start = all.len();
            writeln!(all, "{answer:?}").expect("writing to a string");
            let answer = &all[start..];
            sum = answer.bytes().fold(sum, |sum, byte| (sum ^ u64::from(byte)).wrapping_mul(FNV_PRIME));
            *kinds.entry(kind(answer).to_owned()).or_default() += 1;
        }
        if let Some(folder) = std::env::var_os("FINGERTIP_ANSWERS") {
            let path = PathBuf::from(folder).join(name.replace([' ', ':', '/'], "_"));
            let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
            let written = folder.and_then(|()| std::fs::write(&path, &all));
            written.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        }
        write!(self.text, "{name}: {sum:016x}").expect("writing to a string");
        for (kind, count) in kinds {
            write!(self.text, ", {count} {kind}").expect("writing to a string");
        }
        self.text.push('\n');
    }

    /// Compares with the file.
    ///
    /// # Panics
    /// If a line of the file is another, or the file is not there.
    #[track_caller]
    pub fn check(self) {
        let path = self.file.display();
        if std::env::var_os("FINGERTIP_ACCEPT").is_some() {
            std::fs::write(&self.file, self.text).unwrap_or_else(|error| panic!("{path}: {error}"));
            return;
        }
        let held = std::fs::read_to_string(&self.file).unwrap_or_else(|error| panic!("{path}: {error}"));
        let others: Vec<_> =
            self.text.lines().filter(|line| !held.lines().any(|other| other == *line)).collect();
        assert!(
            others.is_empty() && held.lines().count() == self.text.lines().count(),
            "answers have changed; if that is meant, FINGERTIP_ACCEPT=1 writes {path} anew:\n{}",
            others.join("\n")
        );
    }
}

/// The hash of Fowler, Noll and Vo, 64 bits, in the form 1a.
const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0100_0000_01b3;

/// The last name before the first brace or number: `Misses` of `NoContact(Misses { closest: … })`.
fn kind(answer: &str) -> &str {
    let names = answer.split(['{', ' ', ')', '[', ',', '\n']).next().unwrap_or_default();
    let last = names.rsplit('(').find(|name| name.starts_with(char::is_alphabetic));
    last.unwrap_or("answers")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noted(answers: &[Option<f64>]) -> String {
        let mut unchanged = Unchanged::new("", "");
        unchanged.note("name", answers);
        unchanged.text
    }

    #[test]
    fn one_bit_is_seen_and_kinds_are_counted() {
        let held = noted(&[Some(1.0), Some(0.1), None]);
        assert!(held.starts_with("name: ") && held.ends_with(", 1 None, 2 Some\n"), "{held}");
        assert_eq!(held, noted(&[Some(1.0), Some(0.1), None]));
        assert_ne!(held, noted(&[Some(1.0), Some(0.1_f64.next_up()), None]));
        assert_ne!(held, noted(&[Some(0.1), Some(1.0), None]));
        assert_ne!(noted(&[Some(0.0)]), noted(&[Some(-0.0)]));
    }

    #[test]
    fn names_are_the_innermost_before_the_numbers() {
        assert_eq!(kind("NoContact(Misses { closest: None })\n"), "Misses");
        assert_eq!(kind("Contact(Contact { point: 1.0 })\n"), "Contact");
        assert_eq!(kind("NoContact(Ambiguous)\n"), "Ambiguous");
        assert_eq!(kind("[1.0, 2.0]\n"), "answers");
        assert_eq!(kind("1.0\n"), "answers");
    }
}
