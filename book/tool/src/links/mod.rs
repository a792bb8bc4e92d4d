//! Links: those to files of the project that are pages of the book lead to these pages, those to other files become
//! their paths (or links, where `repository` is set in `book.toml`), and a dead one stops the build.
//!
//! So the theory, the conventions and the like are pages of the book where they stand in the project, and their links
//! work in both places.

mod anchors;
mod resolve;

use std::collections::HashMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::failure::Failure;
use crate::labels::labelled;
use anchors::anchors_of;
use resolve::{Chapters, mended};

/// Reads a book from mdBook on the standard input, and writes it with its links mended and its blocks named.
pub(crate) fn preprocess() -> Result<(), Failure> {
    let mut text = String::new();
    let read = std::io::stdin().read_to_string(&mut text);
    read.map_err(|error| Failure::Book(error.to_string()))?;
    let unread = |error: serde_json::Error| Failure::Book(error.to_string());
    let (context, mut book): (Value, Value) = serde_json::from_str(&text).map_err(unread)?;
    let string = |pointer: &str| context.pointer(pointer).and_then(Value::as_str);
    let root = string("/root").ok_or_else(|| Failure::Book("it has no root".to_owned()))?;
    let sources = Path::new(root).join(string("/config/book/src").unwrap_or("src"));
    let project = real(&Path::new(root).join(".."))?;
    let repository = string("/config/preprocessor/fingertip/repository").map(str::to_owned);

    let mut pages = Vec::new();
    each_chapter(&mut book, &mut |chapter, content| pages.push((chapter.clone(), content.clone())));
    let mut chapters = Chapters { of_file: HashMap::new(), anchors: HashMap::new(), project, repository };
    for (chapter, content) in &pages {
        chapters.of_file.insert(real(&sources.join(&chapter.source))?, chapter.path.clone());
        chapters.anchors.insert(chapter.path.clone(), anchors_of(content));
    }
    let mut dead = Vec::new();
    each_chapter(&mut book, &mut |Chapter { path, source }, content| {
        let place = sources.join(source);
        *content = labelled(content);
        *content =
            mended(content, path, &place, &chapters, &mut |what| dead.push(format!("{source}: {what}")));
    });
    if !dead.is_empty() {
        for link in &dead {
            eprintln!("dead link in {link}");
        }
        return Err(Failure::DeadLinks(dead.len()));
    }
    println!("{book}");
    Ok(())
}

fn real(path: &Path) -> Result<PathBuf, Failure> {
    path.canonicalize().map_err(Failure::file(path))
}

/// A page: where it is in the book, and its file, which differ for a `README.md`.
#[derive(Clone)]
struct Chapter {
    path: String,
    source: String,
}

/// Calls `with` with each chapter and its text, wherever in the book it hangs.
fn each_chapter(value: &mut Value, with: &mut impl FnMut(&Chapter, &mut String)) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| each_chapter(item, with)),
        Value::Object(map) => {
            let string = |key| map.get(key).and_then(Value::as_str).map(str::to_owned);
            if let Some((path, source)) = string("path").zip(string("source_path"))
                && let Some(Value::String(content)) = map.get_mut("content")
            {
                with(&Chapter { path, source }, content);
            }
            map.values_mut().for_each(|item| each_chapter(item, with));
        }
        _ => {}
    }
}
