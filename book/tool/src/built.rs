//! The book as it was built: every link of every page leads to a file, and to a place in it, and nothing comes from
//! elsewhere.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// Where a page links to or takes something from.
const LINKS: [&str; 2] = [" href=\"", " src=\""];

/// Checks the book in a folder.
pub(crate) fn check(folder: &Path) -> Result<(), Failure> {
    let mut pages = Vec::new();
    gather(folder, &mut pages)?;
    if pages.is_empty() {
        return Err(Failure::Command(format!("{} has no page; build the book first", folder.display())));
    }
    let mut texts = HashMap::new();
    for page in pages {
        let text = std::fs::read_to_string(&page).map_err(Failure::file(&page))?;
        texts.insert(page, text);
    }
    let places: HashMap<&Path, HashSet<&str>> =
        texts.iter().map(|(page, text)| (page.as_path(), values(text, " id=\"").collect())).collect();
    let (mut checked, mut dead) = (0, 0);
    for (page, text) in &texts {
        for (kind, link) in LINKS.iter().flat_map(|kind| values(text, kind).map(move |link| (*kind, link))) {
            checked += 1;
            if let Some(why) = fault(page, kind, link, &places) {
                eprintln!(
                    "dead link in {}: {link}: {why}",
                    page.strip_prefix(folder).unwrap_or(page).display()
                );
                dead += 1;
            }
        }
    }
    println!("{checked} links of {} pages", texts.len());
    if dead > 0 { Err(Failure::DeadLinks(dead)) } else { Ok(()) }
}

/// All pages below a folder.
fn gather(folder: &Path, pages: &mut Vec<PathBuf>) -> Result<(), Failure> {
    for entry in std::fs::read_dir(folder).map_err(Failure::file(folder))? {
        let path = entry.map_err(Failure::file(folder))?.path();
        if path.is_dir() {
            gather(&path, pages)?;
        } else if path.extension().is_some_and(|ending| ending == "html") {
            pages.push(path);
        }
    }
    Ok(())
}

/// What stands between a key and the next quote.
fn values<'a>(text: &'a str, key: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(key).skip(1).filter_map(|rest| Some(rest.split_once('"')?.0))
}

/// Why a link leads nowhere.
fn fault(page: &Path, kind: &str, link: &str, places: &HashMap<&Path, HashSet<&str>>) -> Option<String> {
    if link.contains("://") {
        // A reader may be sent elsewhere; the page itself must not need it.
        return (kind == LINKS[1]).then(|| "it is taken from elsewhere".to_owned());
    }
    if link.starts_with("data:") || link.starts_with("javascript:") || link.starts_with("mailto:") {
        return None;
    }
    let (file, place) = link.split_once('#').unwrap_or((link, ""));
    let target = if file.is_empty() { page.to_owned() } else { page.parent()?.join(file) };
    let Ok(target) = target.canonicalize() else { return Some("no such file".to_owned()) };
    let place = place.replace("%20", " ");
    let own = page.canonicalize().is_ok_and(|page| page == target);
    let known = if own { places.get(page) } else { places.get(target.as_path()) };
    match known {
        Some(known) if !place.is_empty() && !known.contains(place.as_str()) => {
            Some(format!("no place #{place}"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn dead_links_and_foreign_sources_are_found() -> Result<(), std::io::Error> {
        let folder = tempfile::tempdir()?;
        let folder = folder.path().canonicalize()?;
        let write = |text: &str| std::fs::write(folder.join("a.html"), text);
        std::fs::write(folder.join("b.html"), "<h1 id=\"here\">b</h1>")?;
        for (text, is_sound) in [
            (
                "<a href=\"b.html#here\">b</a><a href=\"https://a.b\">c</a><p id=\"x\"></p><a href=\"#x\"></a>",
                true,
            ),
            ("<a href=\"b.html#there\">b</a>", false),
            ("<a href=\"c.html\">c</a>", false),
            ("<a href=\"#y\"></a>", false),
            ("<img src=\"https://a.b/c.png\">", false),
        ] {
            write(text)?;
            assert_eq!(check(&folder).is_ok(), is_sound, "{text}");
        }
        Ok(())
    }
}
