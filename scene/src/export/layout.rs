//! Lines that are no wider than those of people.

/// No line is wider, if it can be broken.
const WIDTH: usize = 110;

/// The items, long lines broken where a call, a list or a type has arguments.
pub(super) fn laid_out(items: &str) -> String {
    let mut text = String::new();
    for line in items.lines() {
        let code = line.trim_start();
        if code.starts_with("//") {
            text.push_str(line);
            text.push('\n');
        } else {
            lay(code, line.len() - code.len(), &mut text);
        }
    }
    text
}

fn lay(code: &str, indent: usize, text: &mut String) {
    let margin = " ".repeat(if code.is_empty() { 0 } else { indent });
    let parts = if indent + code.chars().count() <= WIDTH { None } else { widest_arguments(code) };
    let Some((before, arguments, after)) = parts else {
        text.push_str(&format!("{margin}{code}\n"));
        return;
    };
    text.push_str(&format!("{margin}{before}\n"));
    for argument in arguments {
        lay(&format!("{},", argument.trim()), indent + 4, text);
    }
    text.push_str(&format!("{margin}{after}\n"));
}

/// The longest list of arguments that is within no other, with what stands before and behind it.
fn widest_arguments(code: &str) -> Option<(&str, Vec<&str>, &str)> {
    let mut open: Vec<(usize, bool)> = Vec::new();
    let mut widest: Option<(usize, usize)> = None;
    let mut before = ' ';
    for (at, sign) in code.char_indices() {
        match sign {
            '(' | '[' | '<' => {
                // Parentheses around a term are none of a call.
                let takes = sign == '[' || before.is_alphanumeric() || matches!(before, '_' | ':');
                open.push((at, takes));
            }
            ')' | ']' | '>' if before != '-' && before != '=' => {
                let (start, takes) = open.pop()?;
                let longer = widest.is_none_or(|(from, to)| at - start > to - from);
                if open.is_empty() && takes && longer && at > start + 1 {
                    widest = Some((start, at));
                }
            }
            _ => {}
        }
        before = sign;
    }
    let (start, end) = widest?;
    Some((code.get(..=start)?, split(code.get(start + 1..end)?), code.get(end..)?))
}

/// At the commas that are within no other list.
fn split(arguments: &str) -> Vec<&str> {
    let (mut depth, mut from, mut parts) = (0_usize, 0, Vec::new());
    for (at, sign) in arguments.char_indices() {
        match sign {
            '(' | '[' | '<' => depth += 1,
            ')' | ']' | '>' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                parts.extend(arguments.get(from..at));
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.extend(arguments.get(from..));
    parts
}

/// A sentence as lines of a comment, those behind the first further in.
pub(super) fn comment(sentence: &str, indent: usize, hanging: usize) -> String {
    let mut text = String::new();
    let mut line = format!("//{}", " ".repeat(indent));
    let mut is_empty = true;
    // The first word keeps the spaces behind it: a column.
    for word in sentence.split_inclusive(' ') {
        if !is_empty && line.chars().count() + word.trim_end().chars().count() > WIDTH {
            text.push_str(line.trim_end());
            text.push('\n');
            line = format!("//{}", " ".repeat(indent + hanging));
        }
        line.push_str(word);
        is_empty = false;
    }
    text.push_str(line.trim_end());
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::{WIDTH, comment, laid_out};

    /// A call with so many arguments of nine letters and a comma, four spaces in.
    fn call(arguments: usize, last: usize) -> String {
        let arguments: String = (0..arguments).map(|_| "argument9, ").collect();
        format!("    sensor({arguments}{});", "x".repeat(last))
    }

    #[test]
    fn a_line_stays_whole_up_to_the_width() {
        // Four of margin, `sensor(`, eight times eleven, the last argument, and `);`.
        let fits = call(8, WIDTH - 4 - 7 - 88 - 2);
        assert_eq!(fits.chars().count(), WIDTH);
        assert_eq!(laid_out(&fits), format!("{fits}\n"));
        let wide = call(8, WIDTH - 4 - 7 - 88 - 1);
        let broken = laid_out(&wide);
        let lines: Vec<&str> = broken.lines().collect();
        assert_eq!(
            (lines[0], lines[1], lines[9].len(), lines[10]),
            ("    sensor(", "        argument9,", 19, "    );")
        );
        assert_eq!(lines.len(), 11);
    }

    /// What is inside is broken where it is too wide itself, and what a comment says is none of a call.
    #[test]
    fn the_widest_list_is_broken_and_comments_are_not() {
        let inner = format!("inner({}x)", "argument9, ".repeat(11));
        let broken = laid_out(&format!("outer(a, {inner}, [1, 2])?;"));
        let lines: Vec<&str> = broken.lines().map(str::trim_end).collect();
        assert_eq!(lines[..4], ["outer(", "    a,", "    inner(", "        argument9,"]);
        assert_eq!(lines[lines.len() - 4..], ["        x,", "    ),", "    [1, 2],", ")?;"]);
        assert!(lines.iter().all(|line| line.chars().count() <= WIDTH));
        let said = format!("// {inner}");
        assert_eq!(laid_out(&said), format!("{said}\n"));
    }

    /// An arrow ends no list: of types, behind a function's arguments, or behind a closure's.
    #[test]
    fn arrows_are_no_brackets() {
        for (before, after) in
            [("pub fn tip(", ") -> Result<Tip, Error> {"), ("let tip = made(", ").map(|x| x => x);")]
        {
            let broken = laid_out(&format!("{before}{}x{after}", "argument9, ".repeat(11)));
            let lines: Vec<&str> = broken.lines().collect();
            assert_eq!((lines[0], lines[1], lines[13]), (before, "    argument9,", after), "{broken}");
            assert_eq!(lines.len(), 14);
        }
    }

    #[test]
    fn a_comment_is_broken_between_words_up_to_the_width() {
        // `// ` and ten words of nine letters with a space behind each but the last.
        let sentence = ["wordofnin"; 10].join(" ");
        assert_eq!(comment(&sentence, 1, 2), format!("// {sentence}\n"));
        let fits = format!("{sentence}{}", "x".repeat(WIDTH - 3 - sentence.len()));
        assert_eq!(comment(&fits, 1, 2), format!("// {fits}\n"));
        let wide = comment(&format!("{fits}x"), 1, 2);
        let lines: Vec<&str> = wide.lines().collect();
        assert_eq!(lines[0], format!("// {}", ["wordofnin"; 9].join(" ")));
        assert!(lines[1].starts_with("//   wordofninx") && lines.len() == 2, "{wide}");
    }
}
