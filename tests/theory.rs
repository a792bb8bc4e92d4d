//! The theory on board: every citation of `docs/theory/` in the workspace leads to a heading that exists.
#![allow(clippy::unwrap_used, reason = "helpers of tests, which may fail so")]

extern crate alloc;

use alloc::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Where the chapters are, as comments cite them.
const FOLDER: &str = "docs/theory/";

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files under a folder with one of the extensions, without what builds and version control keep.
fn files(folder: &Path, extensions: &[&str], found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_symlink() || name == "target" || name == ".git" {
            continue;
        }
        if path.is_dir() {
            files(&path, extensions, found);
        } else if path.extension().is_some_and(|e| extensions.iter().any(|known| e == *known)) {
            found.push(path);
        }
    }
}

fn texts() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    files(workspace(), &["rs", "md"], &mut found);
    found.sort();
    found.into_iter().map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

/// The anchor that GitHub gives a heading: lower case, blanks to hyphens; of the rest only letters, digits,
/// hyphens and underscores stay. Of a link only its text counts.
fn anchor(heading: &str) -> String {
    let mut text = String::new();
    let mut rest = heading;
    while let Some((before, after)) = rest.split_once("](") {
        text.push_str(before);
        rest = after.split_once(')').map_or("", |(_, after)| after);
    }
    text.push_str(rest);
    text.trim()
        .chars()
        .flat_map(char::to_lowercase)
        .filter_map(|c| match c {
            ' ' => Some('-'),
            c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
            _ => None,
        })
        .collect()
}

/// Lines of a Markdown text that are not code, with their numbers from 1.
fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut code = false;
    text.lines().enumerate().filter_map(move |(index, line)| {
        let fence = line.trim_start().starts_with("```");
        code ^= fence;
        (!code && !fence).then_some((index + 1, line))
    })
}

/// The anchors of a Markdown text; a heading that stands twice gets `-1`, `-2` … after it.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut seen = BTreeMap::<String, usize>::new();
    let mut all = BTreeSet::new();
    for (_, line) in prose(text) {
        let level = line.chars().take_while(|c| *c == '#').count();
        let Some(heading) = line.get(level..).and_then(|rest| rest.strip_prefix(' ')) else { continue };
        if !(1..=6).contains(&level) {
            continue;
        }
        let name = anchor(heading);
        let times = seen.entry(name.clone()).or_default();
        all.insert(if *times == 0 { name } else { format!("{name}-{times}") });
        *times += 1;
    }
    all
}

/// The anchors of each chapter, by the name of its file.
fn chapters() -> BTreeMap<String, BTreeSet<String>> {
    let mut found = Vec::new();
    files(&workspace().join(FOLDER), &["md"], &mut found);
    let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    found.iter().map(|path| (name(path), anchors(&fs::read_to_string(path).unwrap()))).collect()
}

/// What a text cites of the theory: line, chapter, anchor. A citation goes on as long as a path can.
fn citations(text: &str) -> Vec<(usize, String, Option<String>)> {
    let in_path = |c: char| c.is_alphanumeric() || "-_./#".contains(c);
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        for (start, _) in line.match_indices(FOLDER) {
            let rest = &line[start + FOLDER.len()..];
            let end = rest.find(|c| !in_path(c)).unwrap_or(rest.len());
            let cited = rest[..end].trim_end_matches('.');
            if !cited.contains(".md") {
                continue;
            }
            let (chapter, anchor) = cited.split_once('#').map_or((cited, None), |(c, a)| (c, Some(a)));
            found.push((index + 1, chapter.to_owned(), anchor.map(str::to_owned)));
        }
    }
    found
}

/// What is left of citations by number, as they were before the theory was on board.
fn numbered(text: &str) -> Vec<usize> {
    let marks = ["//", "*", "-"];
    let mut found = Vec::new();
    let lines: Vec<_> = text.lines().collect();
    for (index, line) in lines.iter().enumerate() {
        let lower = line.to_lowercase();
        for (start, word) in lower.match_indices("theory") {
            if lower[..start].chars().next_back().is_some_and(char::is_alphanumeric) {
                continue;
            }
            let rest = lower[start + word.len()..].trim_start();
            // The number may stand at the beginning of the next line.
            let next = lines.get(index + 1).map(|next| next.trim_start()).filter(|_| rest.is_empty());
            let rest = next.map_or(rest, |next| {
                let next = marks.iter().find_map(|mark| next.strip_prefix(mark)).unwrap_or(next);
                next.trim_start_matches(['/', '!']).trim_start()
            });
            let apart = rest.len() < lower.len() - start - word.len() || next.is_some();
            if apart && rest.starts_with(|c: char| c.is_ascii_digit()) {
                found.push(index + 1);
            }
        }
    }
    found
}

fn place(path: &Path, line: usize) -> String {
    format!("{}:{line}", path.strip_prefix(workspace()).unwrap_or(path).display())
}

#[test]
fn every_citation_leads_to_a_heading() {
    let chapters = chapters();
    assert!(chapters.len() > 5, "the chapters are there: {:?}", chapters.keys());
    let (mut broken, mut count) = (Vec::new(), 0);
    for (path, text) in texts() {
        // The examples of this file lead nowhere.
        if path.ends_with("tests/theory.rs") {
            continue;
        }
        for (line, chapter, anchor) in citations(&text) {
            count += 1;
            let place = place(&path, line);
            match (chapters.get(&chapter), anchor) {
                (None, _) => broken.push(format!("{place}: there is no chapter {chapter}")),
                (Some(known), Some(anchor)) if !known.contains(&anchor) => {
                    broken.push(format!("{place}: {chapter} has no heading #{anchor}"));
                }
                (Some(_), None) if path.extension().is_some_and(|e| e == "rs") => {
                    broken.push(format!("{place}: which heading of {chapter}?"));
                }
                _ => {}
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    assert!(count > 80, "comments cite the theory: {count}");
}

#[test]
fn no_citation_is_by_number() {
    let mut left = Vec::new();
    for (path, text) in texts() {
        if !path.ends_with("tests/theory.rs") {
            left.extend(numbered(&text).into_iter().map(|line| place(&path, line)));
        }
    }
    assert!(left.is_empty(), "cited by number, which names no file:\n{}", left.join("\n"));
}

#[test]
fn links_between_chapters_resolve() {
    let folder = workspace().join(FOLDER);
    let mut broken = Vec::new();
    for (path, text) in texts().into_iter().filter(|(path, _)| path.starts_with(&folder)) {
        for (line, prose) in prose(&text) {
            for (start, _) in prose.match_indices("](") {
                let Some((target, _)) = prose[start + 2..].split_once(')') else { continue };
                if target.contains("://") || target.starts_with("mailto:") {
                    continue;
                }
                let (file, anchor) = target.split_once('#').map_or((target, None), |(f, a)| (f, Some(a)));
                let file = if file.is_empty() { path.clone() } else { path.with_file_name(file) };
                let place = place(&path, line);
                if !file.exists() {
                    broken.push(format!("{place}: there is no {target}"));
                } else if let Some(anchor) = anchor
                    && !anchors(&fs::read_to_string(&file).unwrap()).contains(anchor)
                {
                    broken.push(format!("{place}: no heading {target}"));
                }
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

/// The files that a chapter names as tests of its formulas, and the tests that it names beside them.
#[test]
fn tests_that_the_theory_names_exist() {
    let folder = workspace().join(FOLDER);
    let texts = texts();
    let mut broken = Vec::new();
    for (path, text) in texts.iter().filter(|(path, _)| path.starts_with(&folder)) {
        for (line, prose) in prose(text) {
            for span in prose.split('`').skip(1).step_by(2) {
                let is_file = span.contains('/') && span.ends_with(".rs") && !span.contains('…');
                let is_test =
                    span.matches('_').count() > 2 && span.chars().all(|c| c.is_lowercase() || c == '_');
                if is_file && !workspace().join(span).exists() {
                    broken.push(format!("{}: there is no {span}", place(path, line)));
                }
                let name = format!("fn {span}(");
                let begun = format!("fn {span}<");
                let made = format!("{span}:");
                let known = |text: &str| [&name, &begun, &made].iter().any(|form| text.contains(*form));
                if is_test && !texts.iter().any(|(_, text)| known(text)) {
                    broken.push(format!("{}: there is no test {span}", place(path, line)));
                }
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn anchors_are_those_of_github() {
    for (heading, expected) in [
        ("Central quadrics", "central-quadrics"),
        ("Coulomb's cone", "coulombs-cone"),
        ("What six numbers cannot tell", "what-six-numbers-cannot-tell"),
        ("Edges, tips, meshes and grids", "edges-tips-meshes-and-grids"),
        ("Load-dependent limit", "load-dependent-limit"),
        ("α-β tracker", "α-β-tracker"),
        ("`Auto` and the [pitch](contact.md#pitch-test)", "auto-and-the-pitch"),
        ("A - B", "a---b"),
        ("snake_case stays", "snake_case-stays"),
        ("  Blanks around  ", "blanks-around"),
    ] {
        assert_eq!(anchor(heading), expected);
    }
    let text = "# One\n```\n# not a heading\n```\n## Two\n## Two\n#neither\n";
    let expected = ["one", "two", "two-1"].map(str::to_owned);
    assert_eq!(anchors(text), expected.into_iter().collect());
}

#[test]
fn citations_are_found_as_they_are_written() {
    let text =
        "// (`docs/theory/contact.md#grazing`; others)\n//! docs/theory/wrench.md.\n// docs/theory/ alone\n";
    let found = citations(text);
    assert_eq!(found, [(1, "contact.md".into(), Some("grazing".into())), (2, "wrench.md".into(), None)]);
    let old =
        format!("/// ({0} 3.4)\n/// so ({0}\n/// 8), Hertz's {0} of 1881\n//! {1} 12\n", "theory", "Theory");
    assert_eq!(numbered(&old), [1, 2, 4]);
}
