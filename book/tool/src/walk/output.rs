//! What a tutorial says comes out beside what came out.

/// Spaces that group digits, which a page shows as spaces.
const UNBROKEN: [char; 3] = ['\u{a0}', '\u{2009}', '\u{202f}'];

/// Whether the text is as expected, where `…` stands for anything within a line, and alone in a line for any lines.
///
/// # Errors
/// Both, with the first line that differs.
pub(super) fn compare(expected: &str, printed: &str) -> Result<(), String> {
    let printed = &printed.replace(UNBROKEN, " ");
    let wanted: Vec<&str> = expected.trim_end().lines().map(str::trim_end).collect();
    let found: Vec<&str> = printed.trim_end().lines().map(str::trim_end).collect();
    if lines_fit(&wanted, &found) {
        return Ok(());
    }
    let missing = wanted.iter().find(|line| **line != "…" && !found.iter().any(|other| fits(line, other)));
    let missing = missing
        .map_or_else(|| "its lines come in another way".to_owned(), |line| format!("no line is {line:?}"));
    Err(format!("the output is another: {missing}. It was:\n{}", printed.trim_end()))
}

fn lines_fit(wanted: &[&str], found: &[&str]) -> bool {
    match (wanted, found) {
        ([], []) => true,
        (["…", rest @ ..], _) => {
            (0..=found.len()).any(|skipped| lines_fit(rest, found.get(skipped..).unwrap_or_default()))
        }
        ([line, rest @ ..], [other, others @ ..]) => fits(line, other) && lines_fit(rest, others),
        _ => false,
    }
}

fn fits(wanted: &str, found: &str) -> bool {
    let mut parts = wanted.split('…');
    let Some(mut rest) = parts.next().and_then(|first| found.strip_prefix(first)) else { return false };
    let parts: Vec<&str> = parts.collect();
    let Some((last, middle)) = parts.split_last() else { return rest.is_empty() };
    for part in middle {
        let Some((_, behind)) = rest.split_once(part) else { return false };
        rest = behind;
    }
    rest.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::compare;

    #[test]
    fn dots_stand_for_anything_and_nothing_else_does() {
        assert!(compare("a 1\nb\n", "a 1\nb\n\n").is_ok());
        assert!(compare("a … c\n", "a b c\n").is_ok());
        assert!(compare("…\nb 2\n", "x\ny\nb 2\n").is_ok());
        assert!(compare("a\n…\n", "a\n").is_ok());
        assert!(compare("3 001", "3\u{202f}001").is_ok());
        for (wanted, found) in
            [("a 1", "a 2"), ("a\nb", "a"), ("a", "a\nb"), ("a … c", "a b d"), ("…\nz", "a\nb")]
        {
            assert!(compare(wanted, found).is_err(), "{wanted:?} {found:?}");
        }
    }
}
