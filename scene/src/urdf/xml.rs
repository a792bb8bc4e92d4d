//! XML, and what its elements hold.

use roxmltree::{Document, Node};

use super::UrdfFault;

/// Deeper than any description: the parser calls itself for each level, and a stack ends.
const DEEPEST: usize = 64;

pub(super) fn parse(text: &str) -> Result<Document<'_>, UrdfFault> {
    // Some tools write a byte order mark, which the parser does not expect.
    let text = text.trim_start_matches('\u{feff}');
    if depth(text) > DEEPEST {
        return Err(UrdfFault::TooDeep(DEEPEST));
    }
    Ok(Document::parse(text)?)
}

/// How deep elements lie in each other, at most.
fn depth(text: &str) -> usize {
    let (mut depth, mut deepest) = (0_usize, 0);
    let mut rest = text;
    while let Some((_, behind)) = rest.split_once('<') {
        // What is no element, and where it ends.
        let skipped = [("!--", "-->"), ("![CDATA[", "]]>"), ("?", "?>"), ("!", ">")]
            .into_iter()
            .find(|(start, _)| behind.starts_with(start));
        if let Some((_, end)) = skipped {
            rest = behind.split_once(end).map_or("", |(_, after)| after);
        } else if let Some(closed) = behind.strip_prefix('/') {
            depth = depth.saturating_sub(1);
            rest = closed;
        } else {
            let (mut quote, mut before, mut end) = (None, ' ', behind.len());
            for (at, letter) in behind.char_indices() {
                match (quote, letter) {
                    (None, '>') => {
                        end = at;
                        break;
                    }
                    (None, '"' | '\'') => quote = Some(letter),
                    (Some(open), _) if open == letter => quote = None,
                    _ => {}
                }
                before = letter;
            }
            if before != '/' {
                depth += 1;
                deepest = deepest.max(depth);
            }
            rest = behind.get(end..).unwrap_or_default();
        }
    }
    deepest
}

/// What is wrong with an element.
pub(super) fn wrong(node: Node<'_, '_>, message: String) -> UrdfFault {
    UrdfFault::Element { line: node.document().text_pos_at(node.range().start).row, message }
}

/// The first child of this name.
pub(super) fn child<'a, 'b>(node: Node<'a, 'b>, name: &str) -> Option<Node<'a, 'b>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// A text that must be there.
pub(super) fn text<'a>(node: Node<'a, '_>, key: &str) -> Result<&'a str, UrdfFault> {
    let element = node.tag_name().name();
    node.attribute(key)
        .map(str::trim)
        .ok_or_else(|| wrong(node, format!("<{element}> has no `{key}`; write one")))
}

/// As many finite numbers as are asked for.
pub(super) fn numbers<const N: usize>(node: Node<'_, '_>, key: &str) -> Result<[f64; N], UrdfFault> {
    let given = text(node, key)?;
    let parsed: Option<Vec<f64>> = given
        .split_ascii_whitespace()
        .map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()))
        .collect();
    parsed.and_then(|list| list.try_into().ok()).ok_or_else(|| {
        let (element, needed) = (node.tag_name().name(), if N == 1 { "a number" } else { "three numbers" });
        wrong(node, format!("`{key}` of <{element}> is {given:?}, which must be {needed}"))
    })
}

/// The same, or what stands for it where the key is missing.
pub(super) fn numbers_or<const N: usize>(
    node: Node<'_, '_>,
    key: &str,
    otherwise: [f64; N],
) -> Result<[f64; N], UrdfFault> {
    if node.has_attribute(key) { numbers(node, key) } else { Ok(otherwise) }
}

/// A number above zero.
pub(super) fn positive(node: Node<'_, '_>, key: &str) -> Result<f64, UrdfFault> {
    let [number] = numbers(node, key)?;
    if number > 0.0 {
        return Ok(number);
    }
    let element = node.tag_name().name();
    Err(wrong(node, format!("`{key}` of <{element}> is {number}, which must be positive")))
}

#[cfg(test)]
mod tests {
    use super::{DEEPEST, depth, parse};

    #[test]
    fn depth_is_that_of_elements() {
        for (text, expected) in [
            ("", 0),
            ("<a/>", 0),
            ("<a></a>", 1),
            ("<a><b/><c></c><d><e x='/>' y=\"<\"></e></d></a>", 3),
            ("<?xml version='1.0'?><!-- <a><b><c> --><a><![CDATA[<b><c>]]></a>", 1),
            ("<a x='>'><b>", 2),
            ("<a", 1),
        ] {
            assert_eq!(depth(text), expected, "{text}");
        }
        // As deep as one likes, it is refused and breaks nothing.
        for levels in [DEEPEST, DEEPEST + 1, 200_000] {
            let deep = "<a>".repeat(levels) + &"</a>".repeat(levels);
            assert_eq!(parse(&deep).is_ok(), levels <= DEEPEST, "{levels}");
        }
    }
}
