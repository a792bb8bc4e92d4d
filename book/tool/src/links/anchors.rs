//! The anchors of a page: what mdBook makes of its headings.

use std::collections::{HashMap, HashSet};

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

/// How pages are read, here and by mdBook.
pub(super) fn parser(text: &str) -> Parser<'_> {
    Parser::new_ext(
        text,
        Options::ENABLE_TABLES
            | Options::ENABLE_FOOTNOTES
            | Options::ENABLE_STRIKETHROUGH
            | Options::ENABLE_TASKLISTS
            | Options::ENABLE_HEADING_ATTRIBUTES,
    )
}

/// All places of a page to which a link can lead.
pub(super) fn anchors_of(text: &str) -> HashSet<String> {
    let mut anchors = HashSet::new();
    let mut times: HashMap<String, usize> = HashMap::new();
    let mut heading: Option<(Option<String>, String)> = None;
    for event in parser(text) {
        match event {
            Event::Start(Tag::Heading { id, .. }) => {
                heading = Some((id.map(|id| id.to_string()), String::new()))
            }
            Event::End(TagEnd::Heading(_)) => {
                if let Some((id, title)) = heading.take() {
                    let id = id.unwrap_or_else(|| {
                        let id = identifier(&title);
                        let count = times.entry(id.clone()).or_default();
                        *count += 1;
                        if *count > 1 { format!("{id}-{}", *count - 1) } else { id }
                    });
                    anchors.insert(id);
                }
            }
            Event::Text(part) | Event::Code(part) => {
                if let Some((_, title)) = &mut heading {
                    title.push_str(&part);
                }
            }
            Event::Html(part) | Event::InlineHtml(part) => {
                anchors.extend(
                    part.split("id=\"").skip(1).filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())),
                );
            }
            _ => {}
        }
    }
    anchors
}

/// As mdBook does: letters and digits small, white space as hyphens, all else but `_` and `-` dropped.
fn identifier(title: &str) -> String {
    title
        .trim()
        .chars()
        .filter_map(|letter| match letter {
            letter if letter.is_alphanumeric() || letter == '_' || letter == '-' => {
                Some(letter.to_ascii_lowercase())
            }
            letter if letter.is_whitespace() => Some('-'),
            _ => None,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::anchors_of;

    #[test]
    fn headings_have_the_anchors_of_mdbook() {
        let found = anchors_of(
            "# What it is\n\n## `Auto`: one, or both?\n\n## Again\n\n## Again\n\n<a id=\"here\"></a>\n",
        );
        for anchor in ["what-it-is", "auto-one-or-both", "again", "again-1", "here"] {
            assert!(found.contains(anchor), "{anchor}: {found:?}");
        }
        assert_eq!(found.len(), 5);
    }
}
