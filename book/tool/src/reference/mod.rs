//! The pages of the reference, each from what the code itself reads.

mod commands;
mod files;
mod scene;
mod source;

pub(crate) use commands::program;

use crate::failure::Failure;
use crate::pages::Made;

/// What stands on top of each page.
const NOTE: &str = "<!-- Written by `fingertip-book reference`; change what it is made of. -->\n\n";

/// All pages.
pub(crate) fn pages() -> Result<Vec<Made>, Failure> {
    let made = |path, text: String| Made { path, text: format!("{NOTE}{text}") };
    Ok(vec![
        made("reference/scene.md", scene::page()),
        made("reference/choices.md", scene::choices()),
        made("reference/files.md", files::page()?),
        made("reference/contacts.md", files::contacts()),
        made("reference/commands.md", commands::page()?),
        made("reference/exit-codes.md", commands::exit_codes()),
    ])
}

/// Text that may stand in a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// With a capital in front and a full stop behind.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map_or_else(String::new, |first| first.to_uppercase().collect());
    format!("{first}{}.", letters.as_str())
}
