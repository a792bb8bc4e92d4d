//! Walks through tutorials as their readers do: from an empty folder, block by block.
//!
//! Every fenced block of a tutorial says by a label behind its language what it is:
//!
//! | label | the reader |
//! |---|---|
//! | `file=PATH` | writes a file |
//! | `run` | types commands |
//! | `output` | sees this, by the commands before; `…` stands for anything, and alone in a line for any lines |
//! | `shown` | only looks: it must not be run, as what opens a window or wants a device |
//!
//! A block without a label is refused, so that none is passed over in silence.

mod blocks;
mod output;
mod session;

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::failure::Failure;
use crate::pages::sources;
use blocks::{Block, blocks};
use session::Session;

/// Walks through the tutorials, or through all.
pub(crate) fn walk(tutorials: &[PathBuf], keep: bool) -> Result<(), Failure> {
    let all = if tutorials.is_empty() { listed()? } else { tutorials.to_vec() };
    let mut failed = 0;
    for path in &all {
        let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        let begun = Instant::now();
        match walk_through(path, &name, keep) {
            Ok(steps) => println!("{name}: {steps} blocks, {:.0} s", begun.elapsed().as_secs_f64()),
            Err(failure) => {
                failed += 1;
                eprintln!("{name}: {failure}");
            }
        }
    }
    if failed > 0 { Err(Failure::Tutorials(failed)) } else { Ok(()) }
}

/// All tutorials, by their names.
fn listed() -> Result<Vec<PathBuf>, Failure> {
    let folder = sources().join("tutorials");
    let files = std::fs::read_dir(&folder).map_err(Failure::file(&folder))?;
    let mut paths: Vec<PathBuf> = files
        .filter_map(|file| Some(file.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "md"))
        .filter(|path| path.file_stem().is_some_and(|stem| stem != "README"))
        .collect();
    paths.sort();
    if paths.is_empty() {
        return Err(Failure::Command(format!("{} has no tutorial", folder.display())));
    }
    Ok(paths)
}

fn walk_through(path: &Path, name: &str, keep: bool) -> Result<usize, Failure> {
    let text = std::fs::read_to_string(path).map_err(Failure::file(path))?;
    let blocks = blocks(&text, path.parent().unwrap_or(Path::new("")))?;
    if !blocks.iter().any(|(_, block)| matches!(block, Block::Run(_))) {
        return Err(Failure::Command("it has no block to run".to_owned()));
    }
    let folder = tempfile::Builder::new().prefix(&format!("{name}-")).tempdir();
    let folder = folder.map_err(Failure::file(path))?;
    let mut session = Session::new(folder.path())?;
    let mut printed = None;
    for (line, block) in &blocks {
        let place = |what: String| Failure::Command(format!("line {line}: {what}"));
        match block {
            Block::File(file, contents) => session.write(file, contents)?,
            Block::Run(commands) => printed = Some(session.run(commands).map_err(place)?),
            Block::Output(expected) => {
                let printed = printed.as_ref().ok_or_else(|| place("nothing was run before".to_owned()))?;
                output::compare(expected, printed).map_err(place)?;
            }
            Block::Shown => {}
        }
    }
    if keep {
        println!("{name}: {}", folder.keep().display());
    }
    Ok(blocks.len())
}
