//! What a block of a tutorial is, said to its reader: the name of the file to write, and what is printed. The labels behind
//! the language (`file=PATH`, `output`), which the walker reads, do not show on a page.

/// A page with a line above each block that has such a label.
pub(crate) fn labelled(content: &str) -> String {
    let mut text = String::with_capacity(content.len());
    let mut is_open = false;
    for line in content.split_inclusive('\n') {
        if let Some(info) = line.trim_end().strip_prefix("```") {
            if !is_open && let Some(said) = info.split(',').skip(1).find_map(said) {
                text.push_str(&format!("<p class=\"block\">{said}</p>\n\n"));
            }
            is_open = !is_open;
        }
        text.push_str(line);
    }
    text
}

fn said(label: &str) -> Option<String> {
    match label.trim() {
        "output" => Some("It prints:".to_owned()),
        other => other.strip_prefix("file=").map(|path| format!("File <code>{path}</code>:")),
    }
}

#[cfg(test)]
mod tests {
    use super::labelled;

    #[test]
    fn files_and_what_is_printed_are_named_and_nothing_else_is_touched() {
        let text = "a\n\n```toml,file=a/b.toml\nx = 1\n```\n\n```sh,run\nls\n```\n\n```text,output\n…\n```\n\n```text\n,output\n```\n";
        let expected = text
            .replace("```toml", "<p class=\"block\">File <code>a/b.toml</code>:</p>\n\n```toml")
            .replace("```text,output", "<p class=\"block\">It prints:</p>\n\n```text,output");
        assert_eq!(labelled(text), expected);
    }
}
