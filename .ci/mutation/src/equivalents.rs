//! Faults that were judged to change nothing that can be observed, each with its reason.

use std::path::Path;

use serde::Deserialize;

use crate::Failure;
use crate::fault::Fault;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    equivalent: Vec<Equivalent>,
}

/// Named by its source line, since numbers of lines change.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Equivalent {
    file: String,
    line: String,
    change: String,
    reason: String,
}

impl Equivalent {
    fn is(&self, fault: &Fault) -> bool {
        self.file == fault.file && self.line.trim() == fault.source && self.change == fault.change
    }
}

/// Reads all files `*.toml` in a folder, one a package.
pub fn read(folder: &Path) -> Result<Vec<Equivalent>, Failure> {
    let mut all = Vec::new();
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(all) };
    for entry in entries {
        let path = entry?.path();
        let text = std::fs::read_to_string(&path)?;
        let file: File = toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
        all.extend(file.equivalent);
    }
    Ok(all)
}

/// Takes the judged ones out, and says how many; an entry that fits no fault any more is an error.
pub fn take_out(faults: &mut Vec<Fault>, judged: &[Equivalent]) -> Result<usize, Failure> {
    let stale: Vec<String> = judged
        .iter()
        .filter(|entry| entry.reason.trim().is_empty() || !faults.iter().any(|fault| entry.is(fault)))
        .map(|entry| format!("{}: {}: {}", entry.file, entry.change, entry.line))
        .collect();
    if !stale.is_empty() {
        return Err(format!("entries without a reason or without a fault:\n{}", stale.join("\n")).into());
    }
    let before = faults.len();
    faults.retain(|fault| !judged.iter().any(|entry| entry.is(fault)));
    Ok(before - faults.len())
}
