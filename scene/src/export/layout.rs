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
