//! Text of others, for terminals.

use alloc::borrow::Cow;

/// The text with what would steer a terminal, or turn the order of letters, written as `\u{…}`.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    if !text.chars().any(steers) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        if steers(letter) { shown.extend(letter.escape_unicode()) } else { shown.push(letter) }
    }
    Cow::Owned(shown)
}

fn steers(letter: char) -> bool {
    let turns = matches!(letter, '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}');
    turns || letter.is_control() && letter != '\n' && letter != '\t'
}

#[cfg(test)]
mod tests {
    use super::printable;

    #[test]
    fn what_steers_a_terminal_is_shown() {
        assert_eq!(printable("N·m\n\tµ\u{202f}1"), "N·m\n\tµ\u{202f}1");
        assert_eq!(
            printable("a\u{1b}]0;x\u{7}b\r\u{9b}c\u{202e}"),
            "a\\u{1b}]0;x\\u{7}b\\u{d}\\u{9b}c\\u{202e}"
        );
    }
}
