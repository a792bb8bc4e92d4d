//! How wide letters are, and the codes that they have in a PDF.

/// Widths of Helvetica's letters from the space to the tilde, in thousandths of their size (Adobe's metrics of the
/// fourteen fonts that every reader of PDF has).
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, // space to /
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, // 0 to ?
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778, // @ to O
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, // P to _
    333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, // ` to o
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584, // p to ~
];

/// Other letters: their codes in the encoding of Windows (`WinAnsiEncoding`), and their widths. A minus is drawn as a
/// dash of the same width.
const OTHERS: [(char, u8, u16); 13] = [
    ('−', 0x96, 556),
    ('–', 0x96, 556),
    ('°', 0xB0, 400),
    ('±', 0xB1, 584),
    ('²', 0xB2, 333),
    ('µ', 0xB5, 556),
    ('·', 0xB7, 278),
    ('×', 0xD7, 584),
    ('Ø', 0xD8, 778),
    ('“', 0x93, 333),
    ('”', 0x94, 333),
    ('½', 0xBD, 834),
    ('…', 0x85, 1000),
];

/// The code of a letter and its width in thousandths of its size; that of a question mark for one that the font lacks.
pub(super) fn letter(letter: char) -> (u8, u16) {
    let place = (letter as usize).wrapping_sub(0x20);
    match (WIDTHS.get(place), u8::try_from(letter)) {
        (Some(width), Ok(code)) => (code, *width),
        _ => match OTHERS.iter().find(|(known, ..)| *known == letter) {
            Some((_, code, width)) => (*code, *width),
            None => (b'?', 556),
        },
    }
}

/// How wide a text is \[mm\] with letters of a size \[mm\].
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(|c| f64::from(letter(c).1)).sum::<f64>() * 1e-3 * size
}

#[cfg(test)]
mod tests {
    use super::{letter, width};

    #[test]
    fn letters_have_their_codes_and_widths() {
        assert_eq!((letter(' '), letter('0'), letter('W')), ((0x20, 278), (0x30, 556), (0x57, 944)));
        assert_eq!((letter('@'), letter('i'), letter('~')), ((0x40, 1015), (0x69, 222), (0x7E, 584)));
        assert_eq!((letter('°'), letter('−'), letter('Ω')), ((0xB0, 400), (0x96, 556), (b'?', 556)));
        assert_eq!((letter('\n'), letter('\u{7f}')), ((b'?', 556), (b'?', 556)));
        // 5 and 6 as wide as each other, the point half.
        assert!((width("5.6", 10.0) - 13.9).abs() < 1e-12);
    }
}
