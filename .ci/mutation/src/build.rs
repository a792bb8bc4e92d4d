//! Compiles the tests of the copy, and finds out which faults do not compile.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde::Deserialize;

use crate::Failure;
use crate::tree::Places;
use crate::workspace::Package;

/// What a build comes to.
pub enum Built {
    /// Test programs: package folder, and executable.
    Programs(Vec<(PathBuf, PathBuf)>),
    /// Faults that do not compile.
    Refused(BTreeSet<u32>),
}

#[derive(Deserialize)]
struct Message {
    reason: String,
    #[serde(default)]
    manifest_path: PathBuf,
    executable: Option<PathBuf>,
    profile: Option<Profile>,
    message: Option<Diagnostic>,
}

#[derive(Deserialize)]
struct Profile {
    test: bool,
}

#[derive(Deserialize)]
struct Diagnostic {
    level: String,
    rendered: Option<String>,
    spans: Vec<Span>,
    #[serde(default)]
    children: Vec<Diagnostic>,
}

#[derive(Deserialize)]
struct Span {
    file_name: PathBuf,
    byte_start: usize,
    byte_end: usize,
}

/// `cargo test --no-run` in the copy.
pub fn tests(copy: &Path, packages: &[&Package], places: &Places) -> Result<Built, Failure> {
    let mut command = Command::new("cargo");
    command.args(["test", "--no-run", "--message-format=json", "--quiet"]);
    for package in packages {
        command.args(["-p", &package.name]);
        command.args(package.features().flat_map(|feature| ["--features".to_owned(), feature]));
    }
    let output = command.current_dir(copy).stderr(Stdio::piped()).output()?;
    let mut programs = Vec::new();
    let (mut refused, mut unexplained) = (BTreeSet::new(), Vec::new());
    for line in output.stdout.split(|byte| *byte == b'\n').filter(|line| !line.is_empty()) {
        let message: Message = serde_json::from_slice(line)?;
        match message.reason.as_str() {
            "compiler-artifact" if message.profile.is_some_and(|profile| profile.test) => {
                let folder = message.manifest_path.parent().map(Path::to_path_buf).unwrap_or_default();
                programs.extend(message.executable.map(|executable| (folder, executable)));
            }
            "compiler-message" => {
                if let Some(error) = message.message.filter(|message| message.level == "error") {
                    let found = faults_at(copy, &error, places);
                    if found.is_empty() {
                        unexplained.extend(error.rendered);
                    }
                    refused.extend(found);
                }
            }
            _ => {}
        }
    }
    if output.status.success() {
        Ok(Built::Programs(programs))
    } else if refused.is_empty() {
        let cargo = String::from_utf8_lossy(&output.stderr).into_owned();
        Err(format!("the copy does not compile:\n{}\n{cargo}", unexplained.join("\n")).into())
    } else {
        Ok(Built::Refused(refused))
    }
}

/// The innermost place that an error lies in.
fn faults_at(copy: &Path, error: &Diagnostic, places: &Places) -> BTreeSet<u32> {
    let spans = error.spans.iter().chain(error.children.iter().flat_map(|child| &child.spans));
    let mut found = BTreeSet::new();
    for span in spans {
        let Some(here) = places.get(&copy.join(&span.file_name)) else { continue };
        let around =
            here.iter().filter(|(_, place)| place.start <= span.byte_start && span.byte_end <= place.end);
        if let Some((_, innermost)) = around.min_by_key(|(_, place)| place.len()) {
            // All that stand in one place: which of them is at fault, the span does not always say.
            found.extend(here.iter().filter(|(_, place)| place == innermost).map(|(number, _)| *number));
        }
    }
    found
}
