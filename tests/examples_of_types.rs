//! Every public type has an example in its own documentation that compiles and can fail.
//!
//! A plain walk through the text, from each library's `lib.rs`. A type is public if it is in public modules, or
//! if a `pub use` names it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests, which may fail so")]

extern crate alloc;

use alloc::collections::BTreeSet;
use core::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The libraries in Rust, by their folders; the facade is the workspace's own.
const LIBRARIES: [&str; 13] = [
    "",
    "bridges",
    "calibration",
    "cli",
    "contact",
    "drivers",
    "friction",
    "hand",
    "recordings",
    "scene",
    "simulation",
    "surfaces",
    "wrench",
];

/// A type that is `pub` and what stands before it.
struct Type {
    file: PathBuf,
    line: usize,
    name: String,
    documentation: Vec<String>,
}

impl Type {
    /// What its example lacks.
    fn lacks(&self) -> Option<&'static str> {
        let mut lack = "has no example";
        let mut lines = self.documentation.iter().map(|line| line.trim());
        while let Some(fence) = lines.by_ref().find(|line| line.starts_with("```")) {
            let code: Vec<_> = lines.by_ref().take_while(|line| *line != "```").collect();
            match fence.trim_start_matches('`') {
                // It needs a device: it compiles, and nobody can run it.
                "no_run" => return None,
                "" | "rust" if code.iter().any(|line| line.contains("assert")) => return None,
                "" | "rust" => lack = "has an example that asserts nothing",
                _ => {}
            }
        }
        Some(lack)
    }
}

/// The word at the beginning of a text.
fn word(text: &str) -> &str {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default()
}

/// What is declared behind one of the keywords.
fn declared<'a>(line: &'a str, keywords: &[&str]) -> Option<&'a str> {
    keywords.iter().find_map(|keyword| line.strip_prefix(keyword)?.strip_prefix(' '))
}

/// If a text within the program begins in this line and goes on: what the line is like in which it ends. Whatever
/// such a text declares, it does not declare here.
fn end_of_text(line: &str) -> Option<fn(&str) -> bool> {
    let odd = |line: &str| {
        let quotes = line.replace(r"\\", "").replace(r#"\""#, "").replace(r#"'"'"#, "");
        quotes.matches('"').count() % 2 == 1
    };
    let raw = line.rsplit_once("r#\"").is_some_and(|(_, text)| !text.contains("\"#"));
    let comment = line.trim_start().starts_with("//");
    match (raw, comment) {
        (true, _) => Some(|line| line.contains("\"#")),
        (false, false) if odd(line) => Some(odd),
        _ => None,
    }
}

/// What a text declares, without what is for tests or hidden.
#[derive(Default)]
struct Declared {
    types: Vec<Type>,
    /// Modules in other files, and whether they are public.
    modules: Modules,
    /// What public uses name; of a module used whole, the star as well.
    used: BTreeSet<String>,
}

/// What a text declares. A type that a macro makes has the documentation that stands where the macro is called.
fn scan(file: &Path, text: &str) -> Declared {
    let mut all = Declared::default();
    let (mut documentation, mut attributes) = (Vec::new(), String::new());
    // The macro whose rules are read; those that make types; whether one is called.
    let (mut rules, mut makers, mut called) = (String::new(), Vec::new(), false);
    let mut lines = text.lines().enumerate();
    while let Some((index, whole)) = lines.next() {
        if let Some(end) = end_of_text(whole) {
            lines.by_ref().find(|(_, line)| end(line));
            continue;
        }
        let line = whole.trim_start();
        let indent = &whole[..whole.len() - line.len()];
        if let Some(comment) = line.strip_prefix("///") {
            documentation.push(comment.to_owned());
            continue;
        }
        if line.starts_with("#[") {
            attributes.push_str(line);
            // Over several lines, it ends where its indentation does.
            if line.ends_with(['(', '[']) {
                let end = |line: &str| line.strip_prefix(indent).is_some_and(|line| line == ")]");
                let parts = lines.by_ref().map(|(_, line)| line).take_while(|line| !end(line));
                attributes.extend(parts);
            }
            continue;
        }
        if line.starts_with("//") {
            continue;
        }
        let left_out = attributes.contains("cfg(test)") || attributes.contains("doc(hidden)");
        let visible = line.strip_prefix("pub(crate) ").or_else(|| line.strip_prefix("pub(super) "));
        let item = visible.or_else(|| line.strip_prefix("pub ")).unwrap_or(line);
        if let Some(name) = line.strip_prefix("macro_rules! ") {
            name.trim_end_matches(" {").clone_into(&mut rules);
        } else if let Some((name, "")) = line.split_once("! {") {
            called = makers.iter().any(|maker| maker == name);
            documentation.clear();
        } else if let Some(name) = declared(item, &["mod"]) {
            if left_out && name.ends_with('{') {
                let end = format!("{indent}}}");
                lines.by_ref().find(|(_, line)| *line == end);
            } else if !left_out && name.ends_with(';') {
                all.modules.push((word(name).to_owned(), line.starts_with("pub ")));
            }
        } else if !left_out && line.starts_with("pub use ") {
            let mut used = line.to_owned();
            while !used.ends_with(';') {
                used.push_str(lines.next().unwrap().1);
            }
            // What is used comes last in its path; a star is all of the module before it.
            let parts = used["pub use ".len()..].split([' ', '{', '}', ',', ';']);
            let names = parts.filter(|part| !part.ends_with("::"));
            all.used.extend(names.map(|name| match name.rsplit_once("::") {
                Some((path, "*")) => format!("{}::*", path.rsplit("::").next().unwrap_or_default()),
                Some((_, name)) => name.to_owned(),
                None => name.to_owned(),
            }));
        } else if !left_out {
            let kinds = ["struct", "enum", "union", "trait", "unsafe trait"];
            let public = line.strip_prefix("pub ").and_then(|item| declared(item, &kinds));
            match public {
                Some(name) if name.starts_with('$') => makers.push(rules.clone()),
                Some(_) | None if called || public.is_some() => all.types.push(Type {
                    file: file.to_owned(),
                    line: index + 1,
                    name: word(public.unwrap_or(line)).to_owned(),
                    documentation: core::mem::take(&mut documentation),
                }),
                _ => {}
            }
            called = false;
        }
        documentation.clear();
        attributes.clear();
    }
    all
}

/// The modules that a file is in, from the outermost, and whether they are public.
type Modules = Vec<(String, bool)>;

/// What a file in `modules` declares, and those below it, which are in `folder`.
fn walk(file: &Path, folder: &Path, modules: &Modules, found: &mut Vec<(Type, Modules)>) -> BTreeSet<String> {
    let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let all = scan(file, &text);
    found.extend(all.types.into_iter().map(|found| (found, modules.clone())));
    let mut used = all.used;
    for module in all.modules {
        let below = folder.join(&module.0);
        let alone = below.with_extension("rs");
        let file = if alone.exists() { alone } else { below.join("mod.rs") };
        let modules = modules.iter().cloned().chain([module]).collect();
        used.append(&mut walk(&file, &below, &modules, found));
    }
    used
}

/// The public types of a library.
fn types_of(library: &str) -> Vec<Type> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(library).join("src");
    let mut found = Vec::new();
    let used = walk(&folder.join("lib.rs"), &folder, &Vec::new(), &mut found);
    found.retain(|(found, modules)| {
        let public = modules.iter().fold(true, |public, (module, visible)| {
            public && *visible || used.contains(module) || used.contains(&format!("{module}::*"))
        });
        public || used.contains(&found.name)
    });
    found.into_iter().map(|(found, _)| found).collect()
}

#[test]
fn every_public_type_has_an_example() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut missing = String::new();
    for library in LIBRARIES {
        let types = types_of(library);
        assert!(types.len() > 4, "the types of {library:?} are found: {}", types.len());
        for found in types {
            let Some(lack) = found.lacks() else { continue };
            let file = found.file.strip_prefix(root).unwrap_or(&found.file);
            writeln!(missing, "{}:{}: {} {lack}", file.display(), found.line, found.name).unwrap();
        }
    }
    assert!(missing.is_empty(), "\n{missing}");
}

/// A library that is added is looked at too, unless it is published to nobody.
#[test]
fn every_library_is_in_the_list() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in fs::read_dir(root).unwrap() {
        let folder = entry.unwrap().path();
        let name = folder.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        if folder.join("src/lib.rs").exists() && !manifest.contains("publish = false") {
            assert!(LIBRARIES.contains(&name), "{name} is a library");
        }
    }
}

#[test]
fn types_are_found_as_they_are_written() {
    let text = r##"
mod inner;
const TEMPLATE: &str = r#"
mod nowhere;
pub struct Text;
"#;
const ANOTHER: &str = "
pub struct {NAME} {{ a: \"b\" }}
\\";
#[cfg(feature = "std")]
pub mod outer;
#[doc(hidden)]
pub mod hidden;
#[cfg(test)]
mod tests;
use inner::Unnamed;
pub use inner::{
    Deep, deep::{Deeper},
};
pub use inner::near::*;
pub use inner::{far, Another as Other};
#[doc(hidden)]
pub use inner::Secret;

/// With one.
///
/// ```
/// assert_eq!(Good.answer(), 42);
/// ```
#[derive(Clone)]
#[expect(
    clippy::thing,
    reason = "so"
)]
pub struct Good;

/// The example of another.
///
/// ```text
/// a picture
/// ```
pub enum Drawn<T> {
    A(T),
}
/// ```
/// let nothing = Idle::new();
/// ```
pub trait Idle {}
/// ```no_run
/// Wired::open("/dev/ttyUSB0");
/// ```
pub struct Wired;
pub(crate) struct Own;
struct Private;
#[doc(hidden)]
pub struct Hidden;

macro_rules! face {
    ($(#[$documentation:meta])* $name:ident) => {
        $(#[$documentation])*
        pub struct $name {
            bus: u8,
        }
    };
}

face! {
    /// Its documentation is here.
    ///
    /// ```
    /// assert!(Made::new().is_some());
    /// ```
    Made
}

face! {
    /// And here, without.
    MadeToo
}

#[cfg(test)]
mod inline {
    pub struct Helper;
}

pub unsafe trait Last {}
"##;
    let all = scan(Path::new("lib.rs"), text);
    let found: Vec<_> = all.types.iter().map(|found| (found.name.as_str(), found.lacks())).collect();
    let none = Some("has no example");
    let expected = [
        ("Good", None),
        ("Drawn", none),
        ("Idle", Some("has an example that asserts nothing")),
        ("Wired", None),
        ("Made", None),
        ("MadeToo", none),
        ("Last", none),
    ];
    assert_eq!(found, expected);
    assert_eq!(all.modules, [("inner".to_owned(), false), ("outer".to_owned(), true)]);
    let used: Vec<_> = all.used.iter().map(String::as_str).filter(|word| !word.is_empty()).collect();
    assert_eq!(used, ["Another", "Deep", "Deeper", "Other", "as", "far", "near::*"]);
}
