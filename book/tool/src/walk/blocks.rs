//! The blocks of a tutorial.

use std::path::Path;

use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag, TagEnd};

use crate::failure::Failure;

/// What a reader does with a block.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Block {
    /// Writes it into this file.
    File(String, String),
    /// Types it.
    Run(String),
    /// Compares it with what was printed.
    Output(String),
    /// Looks at it.
    Shown,
}

/// All blocks with the lines in which they begin; `folder` is where files that they include are looked for.
pub(super) fn blocks(text: &str, folder: &Path) -> Result<Vec<(usize, Block)>, Failure> {
    let mut found = Vec::new();
    let mut open: Option<(usize, String, String)> = None;
    for (event, range) in Parser::new(text).into_offset_iter() {
        match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) => {
                let line = text.get(..range.start).map_or(0, |before| before.matches('\n').count()) + 1;
                open = Some((line, info.to_string(), String::new()));
            }
            Event::Text(part) => {
                if let Some((_, _, contents)) = &mut open {
                    contents.push_str(&part);
                }
            }
            Event::End(TagEnd::CodeBlock) => {
                if let Some((line, info, contents)) = open.take() {
                    let contents = included(&contents, folder)?;
                    let block = block(&info, contents).ok_or_else(|| {
                        Failure::Command(format!("line {line}: a block {info:?} has no label"))
                    })?;
                    found.push((line, block));
                }
            }
            _ => {}
        }
    }
    Ok(found)
}

/// By its labels, which stand behind the language, parted by commas.
fn block(info: &str, contents: String) -> Option<Block> {
    info.split(',').skip(1).find_map(|label| match label.trim() {
        "run" => Some(Block::Run(contents.clone())),
        "output" => Some(Block::Output(contents.clone())),
        "shown" => Some(Block::Shown),
        other => other.strip_prefix("file=").map(|path| Block::File(path.to_owned(), contents.clone())),
    })
}

/// With the whole files that mdBook would include.
fn included(contents: &str, folder: &Path) -> Result<String, Failure> {
    let mut text = String::new();
    let mut rest = contents;
    while let Some((before, after)) = rest.split_once("{{#include ") {
        let Some((path, behind)) = after.split_once("}}") else { break };
        let path = folder.join(path.trim());
        text.push_str(before);
        let file = std::fs::read_to_string(&path).map_err(Failure::file(&path))?;
        text.push_str(file.trim_end_matches('\n'));
        rest = behind;
    }
    text.push_str(rest);
    Ok(text)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{Block, blocks};

    #[test]
    fn labels_say_what_blocks_are() {
        let text = "a\n\n```sh,run\nls\n```\n\n```toml,file=a/b.toml\nx = 1\n```\n\n```text,output\n…\n```\n\n```sh,shown\nvi\n```\n";
        let found = blocks(text, Path::new("")).unwrap_or_default();
        assert_eq!(
            found,
            [
                (3, Block::Run("ls\n".to_owned())),
                (7, Block::File("a/b.toml".to_owned(), "x = 1\n".to_owned())),
                (11, Block::Output("…\n".to_owned())),
                (15, Block::Shown),
            ]
        );
        assert!(blocks("```sh\nls\n```\n", Path::new("")).is_err());
    }
}
