//! What the comments of the code say of the fields of a struct, and sections of pages.

use std::path::Path;

use crate::failure::Failure;

/// The text of a file of the project.
pub(super) fn read(path: &str) -> Result<String, Failure> {
    let place = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    std::fs::read_to_string(&place).map_err(Failure::file(&place))
}

/// Names of the public fields of a struct as they stand in files, and what is said of them.
pub(super) fn fields(path: &str, name: &str) -> Result<Vec<(String, String)>, Failure> {
    let text = read(path)?;
    let missing = || Failure::Command(format!("{path} has no struct {name}; mend `reference/files.rs`"));
    let (_, rest) = text.split_once(&format!("pub struct {name} {{\n")).ok_or_else(missing)?;
    let (body, _) = rest.split_once("\n}").ok_or_else(missing)?;
    let (mut says, mut renamed) = (String::new(), None);
    let mut found = Vec::new();
    for line in body.lines().map(str::trim) {
        if let Some(comment) = line.strip_prefix("///") {
            says.push_str(if says.is_empty() { "" } else { " " });
            says.push_str(comment.trim());
        } else if let Some((_, after)) = line.split_once("rename = \"") {
            renamed = after.split_once('"').map(|(name, _)| name.to_owned());
        } else if let Some(field) = line.strip_prefix("pub ").or_else(|| line.strip_prefix("pub(super) "))
            && let Some((field, _)) = field.split_once(':')
        {
            found.push((
                renamed.take().unwrap_or_else(|| field.to_owned()),
                plain(&core::mem::take(&mut says)),
            ));
        }
    }
    if found.is_empty() { Err(missing()) } else { Ok(found) }
}

/// A comment without links to items of the code.
fn plain(comment: &str) -> String {
    let mut text = String::new();
    let mut rest = comment;
    while let Some((before, after)) = rest.split_once("[`") {
        let Some((item, behind)) = after.split_once("`]") else { break };
        text.push_str(before);
        text.push_str(&format!("`{item}`"));
        rest = match behind.strip_prefix('(').and_then(|link| link.split_once(')')) {
            Some((_, behind)) => behind,
            None => behind,
        };
    }
    text.push_str(rest);
    text
}

/// What stands in a page between a heading and the next of its rank, without the heading.
pub(super) fn section(path: &str, heading: &str) -> Result<String, Failure> {
    let text = read(path)?;
    let missing =
        || Failure::Command(format!("{path} has no heading {heading:?}; mend `reference/files.rs`"));
    let (_, rest) = text.split_once(&format!("{heading}\n")).ok_or_else(missing)?;
    let rank = heading.chars().take_while(|letter| *letter == '#').count();
    let next = format!("\n{} ", "#".repeat(rank));
    Ok(rest.split_once(next.as_str()).map_or(rest, |(section, _)| section).trim().to_owned())
}

/// What stands in the comments of a file between a heading and the next, without the slashes.
pub(super) fn comment_section(path: &str, heading: &str) -> Result<String, Failure> {
    let text = read(path)?;
    let missing =
        || Failure::Command(format!("{path} has no comment {heading:?}; mend `reference/files.rs`"));
    let (_, rest) = text.split_once(&format!("/// # {heading}\n")).ok_or_else(missing)?;
    let lines = rest
        .lines()
        .map_while(|line| line.trim().strip_prefix("///"))
        .map(|line| line.strip_prefix(' ').unwrap_or(line));
    let section: Vec<String> = lines.take_while(|line| !line.starts_with("# ")).map(plain).collect();
    Ok(section.join("\n").trim().to_owned())
}

/// The TOML of the example in the comments of a file.
pub(super) fn example(path: &str) -> Result<String, Failure> {
    let text = read(path)?;
    let missing = || Failure::Command(format!("{path} has no example in TOML; mend `reference/files.rs`"));
    let (_, rest) = text.split_once("r#\"\n").ok_or_else(missing)?;
    let (example, _) = rest.split_once("\"#").ok_or_else(missing)?;
    let lines: Vec<&str> =
        example.lines().filter_map(|line| line.trim().strip_prefix("///")).map(str::trim).collect();
    Ok(lines.join("\n").trim().to_owned())
}
