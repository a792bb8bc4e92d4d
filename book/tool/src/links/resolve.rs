//! One page with its links mended.

use core::ops::Range;
use std::collections::{HashMap, HashSet};

use std::path::{Path, PathBuf};

use pulldown_cmark::{Event, LinkType, Tag};

use super::anchors::parser;

/// The pages of the book.
pub(super) struct Chapters {
    /// Path in the book, by the real path of the file.
    pub(super) of_file: HashMap<PathBuf, String>,
    /// By path in the book.
    pub(super) anchors: HashMap<String, HashSet<String>>,
    /// Where the project is.
    pub(super) project: PathBuf,
    /// Address of its files, if it is known.
    pub(super) repository: Option<String>,
}

/// What becomes of a link.
enum Mended {
    Stays,
    /// Another destination.
    Leads(String),
    /// No link, but the path of a file of the project.
    Names(String),
    Dead(String),
}

/// The text of the page `path`, of which the file is `place`.
pub(super) fn mended(
    text: &str,
    path: &str,
    place: &Path,
    chapters: &Chapters,
    dead: &mut dyn FnMut(String),
) -> String {
    let mut result = String::with_capacity(text.len());
    let mut copied = 0;
    for (range, destination, is_image) in links(text) {
        if range.start < copied {
            continue;
        }
        let Some(whole) = text.get(range.clone()) else { continue };
        let piece = match chapters.resolve(&destination, path, place, is_image) {
            Mended::Stays => continue,
            Mended::Leads(other) => whole.replacen(&format!("]({destination}"), &format!("]({other}"), 1),
            Mended::Names(file) => {
                let words = whole
                    .strip_prefix('[')
                    .and_then(|rest| rest.rsplit_once("]("))
                    .map_or("", |parts| parts.0);
                let bare = words.replace('`', "");
                if file.ends_with(bare.as_str()) && !bare.is_empty() {
                    format!("`{file}`")
                } else {
                    format!("{words} (`{file}`)")
                }
            }
            Mended::Dead(why) => {
                dead(why);
                continue;
            }
        };
        result.push_str(text.get(copied..range.start).unwrap_or_default());
        result.push_str(&piece);
        copied = range.end;
    }
    result.push_str(text.get(copied..).unwrap_or_default());
    result
}

/// Links and images that stand in the text, with their destinations.
fn links(text: &str) -> Vec<(Range<usize>, String, bool)> {
    parser(text)
        .into_offset_iter()
        .filter_map(|(event, range)| match event {
            Event::Start(Tag::Link { link_type: LinkType::Inline, dest_url, .. }) => {
                Some((range, dest_url.to_string(), false))
            }
            Event::Start(Tag::Image { link_type: LinkType::Inline, dest_url, .. }) => {
                Some((range, dest_url.to_string(), true))
            }
            _ => None,
        })
        .collect()
}

impl Chapters {
    fn resolve(&self, destination: &str, path: &str, place: &Path, is_image: bool) -> Mended {
        if destination.contains("://") || destination.starts_with("mailto:") {
            return Mended::Stays;
        }
        let (file, anchor) = destination.split_once('#').unwrap_or((destination, ""));
        let here = |page: &str| {
            anchor.is_empty() || self.anchors.get(page).is_some_and(|anchors| anchors.contains(anchor))
        };
        if file.is_empty() {
            return if here(path) {
                Mended::Stays
            } else {
                Mended::Dead(format!("no heading for #{anchor}"))
            };
        }
        // From where the file is in the project first, then from where it is in the book.
        let real = place.canonicalize().ok();
        let found = [real.as_deref(), Some(place)]
            .into_iter()
            .flatten()
            .filter_map(|from| from.parent()?.join(file).canonicalize().ok())
            .next();
        let Some(found) = found else { return Mended::Dead(format!("{destination} leads nowhere")) };
        if let Some(page) = self.of_file.get(&found) {
            if !here(page) {
                return Mended::Dead(format!("{page} has no heading for #{anchor}"));
            }
            let end = if anchor.is_empty() { String::new() } else { format!("#{anchor}") };
            return Mended::Leads(format!("{}{page}{end}", up(path)));
        }
        if is_image
            || found.starts_with(place.parent().and_then(|p| p.canonicalize().ok()).unwrap_or_default())
                && !file.ends_with(".md")
        {
            return Mended::Stays;
        }
        let Ok(inside) = found.strip_prefix(&self.project) else {
            return Mended::Dead(format!("{destination} leads out of the project"));
        };
        let inside = inside.display().to_string();
        match &self.repository {
            Some(address) => Mended::Leads(format!("{}/{inside}", address.trim_end_matches('/'))),
            None => Mended::Names(inside),
        }
    }
}

/// From a page to the folder of the book's pages.
fn up(path: &str) -> String {
    "../".repeat(path.matches('/').count())
}

#[cfg(test)]
mod tests {
    use std::collections::{HashMap, HashSet};
    use std::path::Path;

    use super::{Chapters, mended};

    #[test]
    fn links_lead_to_pages_name_files_or_are_dead() -> Result<(), std::io::Error> {
        let folder = tempfile::tempdir()?;
        let project = folder.path().canonicalize()?;
        for file in ["docs/a.md", "docs/b.md", "lib.rs", "book/c.md"] {
            let place = project.join(file);
            std::fs::create_dir_all(place.parent().unwrap_or(Path::new("")))?;
            std::fs::write(place, "")?;
        }
        let chapters = Chapters {
            of_file: HashMap::from([
                (project.join("docs/a.md"), "theory/a.md".to_owned()),
                (project.join("docs/b.md"), "theory/b.md".to_owned()),
            ]),
            anchors: HashMap::from([("theory/b.md".to_owned(), HashSet::from(["here".to_owned()]))]),
            project: project.clone(),
            repository: None,
        };
        let mend = |text: &str| {
            let mut dead = Vec::new();
            let place = project.join("docs/a.md");
            let text = mended(text, "theory/a.md", &place, &chapters, &mut |what| dead.push(what));
            (text, dead)
        };
        assert_eq!(mend("see [b](b.md#here) now"), ("see [b](../theory/b.md#here) now".to_owned(), vec![]));
        assert_eq!(mend("[`lib.rs`](../lib.rs)").0, "`lib.rs`");
        assert_eq!(mend("[the code](../lib.rs)").0, "the code (`lib.rs`)");
        assert_eq!(
            mend("[web](https://a.b/c) `[x](y)`"),
            ("[web](https://a.b/c) `[x](y)`".to_owned(), vec![])
        );
        assert_eq!(mend("[b](b.md#there)").1.len(), 1);
        assert_eq!(mend("[b](gone.md)").1.len(), 1);
        assert_eq!(mend("[up](#up)").1.len(), 1);
        Ok(())
    }
}
