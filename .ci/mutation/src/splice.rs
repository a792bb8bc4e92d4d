//! Writes a file with all its faults in it, each behind a switch.
//!
//! Only one fault is switched on at a time, so what replaces an expression is the plain source; the
//! faults inside an expression stand in the branch that keeps it.

use std::ops::Range;

use crate::fault::{Fault, Form};

/// A file with switches, and where each fault came to stand.
pub struct Spliced {
    pub text: String,
    /// Number of the fault, and the bytes of all that belongs to its place.
    pub places: Vec<(u32, Range<usize>)>,
}

/// `faults` with their numbers, all of the one file that `text` holds.
pub fn splice(text: &str, faults: &[(u32, &Fault)]) -> Spliced {
    let mut ordered = faults.to_vec();
    // What contains another comes before it.
    ordered.sort_by_key(|(_, fault)| (fault.range.start, std::cmp::Reverse(fault.range.end)));
    let mut writer = Writer { source: text, out: String::with_capacity(2 * text.len()), places: Vec::new() };
    writer.write(0..text.len(), &ordered);
    Spliced { text: writer.out, places: writer.places }
}

struct Writer<'a> {
    source: &'a str,
    out: String,
    places: Vec<(u32, Range<usize>)>,
}

impl Writer<'_> {
    fn write(&mut self, range: Range<usize>, mut faults: &[(u32, &Fault)]) {
        let mut written = range.start;
        while let Some((_, first)) = faults.first() {
            let place = first.range.clone();
            let here = faults.iter().take_while(|(_, fault)| fault.range == place).count();
            let within = faults.iter().take_while(|(_, fault)| fault.range.start < place.end).count();
            self.out.push_str(&self.source[written..place.start]);
            self.switch(place.clone(), &faults[..here], &faults[here..within]);
            written = place.end;
            faults = &faults[within..];
        }
        self.out.push_str(&self.source[written..range.end]);
    }

    fn switch(&mut self, place: Range<usize>, here: &[(u32, &Fault)], inside: &[(u32, &Fault)]) {
        let start = self.out.len();
        if here.iter().all(|(_, fault)| fault.form == Form::Statement) {
            for (number, _) in here {
                self.out.push_str(&format!("if !crate::__mutation::active({number}) {{ "));
            }
            self.write(place, inside);
            self.out.push_str(&" }".repeat(here.len()));
        } else {
            self.out.push('(');
            for (number, fault) in here {
                let replacement = &fault.replacement;
                self.out
                    .push_str(&format!("if crate::__mutation::active({number}) {{ {replacement} }} else "));
            }
            self.out.push_str("{ ");
            self.write(place, inside);
            self.out.push_str(" })");
        }
        let end = self.out.len();
        self.places.extend(here.iter().map(|(number, _)| (*number, start..end)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::find::faults;

    #[test]
    fn switches_nest_and_keep_what_is_not_faulty() {
        let text = "fn f(a: i32, b: i32) -> i32 {\n    if a < b { return -a; }\n    a + b * 2\n}\n";
        let found = faults("x.rs", text).unwrap();
        let changes: Vec<&str> = found.iter().map(|fault| fault.change.as_str()).collect();
        assert_eq!(changes, ["condition → false", "< → <=", "< → >", "- removed", "+ → -", "* → /"]);
        let numbered: Vec<(u32, &Fault)> = (1..).zip(&found).collect();
        let spliced = splice(text, &numbered);
        assert!(syn::parse_file(&spliced.text).is_ok(), "{}", spliced.text);
        assert!(spliced.text.contains("{ a - b * 2 } else { a + (if crate::__mutation::active(6) { b / 2 }"));
        for (number, place) in &spliced.places {
            assert!(spliced.text[place.clone()].contains(&format!("active({number})")));
        }
    }
}
