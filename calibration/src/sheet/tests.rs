use fingertip_test_support::drawn;
use proptest::prelude::*;

use super::{Anchor, Pen, Sheet, pdf, tables};
use crate::page::Table;

/// What is drawn lies where it was put, in SVG and on the page of the PDF, to a micrometre.
#[test]
fn both_files_are_to_scale() {
    proptest!(|(points in prop::collection::vec(prop::array::uniform2(0.0_f64..200.0), 4..9), radius in 0.05_f64..50.0)| {
        // Five points are a closed line of four in the eyes of the one who measures a PDF.
        prop_assume!(points.len() != 5);
        let mut sheet = Sheet::a4("A & B");
        sheet.polygon(Pen::Thick, "one", points.clone());
        sheet.circle(Pen::Dashed, "two", points[0], radius);
        sheet.named_line(Pen::Thin, "three", points[1], points[2]);
        let [x, y] = points[0];
        let round = [[x + radius, y], [x, y + radius], [x - radius, y], [x, y - radius]];
        let paper = drawn::svg(&sheet.to_svg());
        prop_assert_eq!(paper.size, [210.0, 297.0]);
        for (name, expected) in [("one", &points[..]), ("two", &round[..]), ("three", &points[1..3])] {
            for (found, expected) in paper.named(name).points.iter().zip(expected) {
                // Middle and radius of a circle are rounded to a tenth of a micrometre each.
                prop_assert!((found[0] - expected[0]).hypot(found[1] - expected[1]) < 2e-4, "{} {:?}", name, found);
            }
        }
        let pages = drawn::pdf(&pdf(&[sheet]));
        prop_assert!((pages[0].size[0] - 210.0).abs() < 1e-3 && (pages[0].size[1] - 297.0).abs() < 1e-3);
        for expected in [&points[..], &round[..], &points[1..3]] {
            prop_assert!(pages[0].nearest(expected) < 1e-3, "{:?}", expected);
        }
    });
}

/// A quarter of a circle in a PDF is a cubic: on the way, too, it is a circle.
#[test]
fn circles_are_round_on_the_page() {
    let mut sheet = Sheet::a4("");
    sheet.circle(Pen::Thin, "", [100.0, 100.0], 40.0);
    let text: String = pdf(&[sheet]).iter().map(|byte| char::from(*byte)).collect();
    let (_, path) = text.split_once(" m\n").unwrap();
    let start = text.split_once(" m\n").unwrap().0.lines().last().unwrap().to_owned();
    let numbers = |line: &str| -> Vec<f64> { line.split(' ').filter_map(|word| word.parse().ok()).collect() };
    let mut from = numbers(&start);
    let cubics: Vec<Vec<f64>> = path.lines().take_while(|line| line.ends_with(" c")).map(numbers).collect();
    assert_eq!(cubics.len(), 4);
    for cubic in cubics {
        for step in 0..=20 {
            let t = f64::from(step) / 20.0;
            let weights =
                [(1.0 - t).powi(3), 3.0 * t * (1.0 - t).powi(2), 3.0 * t * t * (1.0 - t), t.powi(3)];
            let at = |i: usize| {
                weights[0] * from[i]
                    + weights[1] * cubic[i]
                    + weights[2] * cubic[2 + i]
                    + weights[3] * cubic[4 + i]
            };
            let radius = (at(0) - 100.0).hypot(at(1) - 197.0);
            assert!((radius - 40.0).abs() < 0.02, "{radius} at {t}");
        }
        from = cubic[4..].to_vec();
    }
}

#[test]
fn texts_are_those_that_were_put_there() {
    let mut sheet = Sheet::a4("A & B");
    sheet.text([10.0, 20.0], 3.0, Anchor::Start, "Ø 12 (±0.1°) <&>");
    let svg = sheet.to_svg();
    assert!(
        svg.contains("<title>A &amp; B</title>") && svg.contains(">Ø 12 (±0.1°) &lt;&amp;&gt;</text>"),
        "{svg}"
    );
    assert!(
        sheet.to_figure().starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 210 297\"")
    );
    let bytes = pdf(&[sheet]);
    assert!(
        bytes.windows(11).any(|some| some == b"Helvetica\n/")
            || bytes.windows(9).any(|some| some == b"Helvetica")
    );
    assert!(bytes.windows(12).any(|some| some == b"PrintScaling"), "readers print it as it is");
    let pages = drawn::pdf(&bytes);
    // Letters of Windows are those of Latin there.
    assert_eq!(pages[0].texts, ["Ø 12 (±0.1°) <&>"]);
}

/// Where a text is attached is that point of it, by the widths of its letters.
#[test]
fn texts_are_attached_where_they_say() {
    let place = |anchor: Anchor| {
        let mut sheet = Sheet::a4("");
        sheet.text([100.0, 50.0], 10.0, anchor, "00");
        let text: String = pdf(&[sheet]).iter().map(|byte| char::from(*byte)).collect();
        let matrix = text.lines().find(|line| line.ends_with(" Tm")).unwrap().to_owned();
        let numbers: Vec<f64> = matrix.split(' ').filter_map(|word| word.parse().ok()).collect();
        assert_eq!(numbers[..4], [1.0, 0.0, 0.0, 1.0]);
        assert!((numbers[5] - 247.0).abs() < 1e-4);
        numbers[4]
    };
    // Two digits of ten millimetres are 11.12 mm wide.
    for (anchor, left) in [(Anchor::Start, 100.0), (Anchor::Middle, 94.44), (Anchor::End, 88.88)] {
        assert!((place(anchor) - left).abs() < 1e-4, "{anchor:?}");
    }
}

#[test]
fn sheets_are_as_large_as_they_must_be() {
    for (needed, size) in [
        ([210.0, 297.0], [210.0, 297.0]),
        ([210.1, 200.0], [297.0, 210.0]),
        ([100.0, 297.1], [100.0, 298.0]),
        ([297.1, 290.0], [420.0, 297.0]),
        ([500.3, 100.0], [501.0, 100.0]),
    ] {
        assert_eq!(Sheet::holding("", needed).size(), size, "{needed:?}");
    }
}

/// Tables go on until all rows stand, with their head on each sheet, and no column runs out of it.
#[test]
fn tables_have_all_their_rows() {
    let head = ["", "a", "b"].map(str::to_owned);
    for count in [0, 1, 53, 54, 55, 56, 57, 58, 59, 60, 200] {
        let rows = |name: &str, count: usize| -> Vec<Vec<String>> {
            (0..count).map(|i| vec![format!("{name} {i}"), "1.5".to_owned(), "x".repeat(i % 150)]).collect()
        };
        let (first, second) = (rows("row", count), rows("line", 3));
        let all = [
            Table { title: "", head: &head, rows: &first, words: false },
            Table { title: "Second", head: &head, rows: &second, words: false },
        ];
        let sheets = tables("T", &["above".to_owned()], &all);
        let pages = drawn::pdf(&pdf(&sheets));
        assert_eq!(pages.len(), sheets.len());
        let texts = || pages.iter().flat_map(|page| &page.texts);
        let names: Vec<&String> = texts().filter(|text| text.contains(' ') && !text.contains(',')).collect();
        let expected: Vec<String> = first.iter().chain(&second).map(|row| row[0].clone()).collect();
        assert!(names.into_iter().eq(&expected), "{count}");
        assert!(pages.iter().skip(1).all(|page| page.texts[0] == "T, continued"));
        // A head on each sheet, and one more where both tables stand on one.
        let heads = texts().filter(|text| *text == "a").count();
        assert!(heads == pages.len() || heads == pages.len() + 1, "{count}: {heads}");
        assert_eq!(texts().filter(|text| *text == "Second").count(), 1);
        for page in &pages {
            assert!(
                !matches!(page.texts.last().map(String::as_str), Some("b" | "Second")) || count == 0,
                "{count}"
            );
            let reach = page.lines.iter().flat_map(|line| &line.points).map(|[x, _]| *x).fold(0.0, f64::max);
            assert!(reach <= 195.0 + 1e-3, "{reach}");
        }
        for text in sheets.iter().flat_map(|sheet| &sheet.marks) {
            if let super::Mark::Text { at, .. } = text {
                assert!(at[1] <= 283.0, "{count}: {at:?}");
            }
        }
    }
}

/// A dimension stands between its arrows where it has room, and beyond them where it has not; arrows then point inwards.
#[test]
fn dimensions_that_are_narrow_stand_beside() {
    for (left, right, inside) in [(50.0, 80.0, true), (50.0, 53.0, false), (53.0, 50.0, false)] {
        let mut sheet = Sheet::a4("");
        sheet.across([left, 40.0], [right, 40.0], 60.0, "12.34");
        let (least, most) = (f64::min(left, right), f64::max(left, right));
        let text = sheet.marks.iter().find_map(|mark| match mark {
            super::Mark::Text { at, anchor, .. } => Some((*at, *anchor)),
            _ => None,
        });
        let ([x, y], anchor) = text.unwrap();
        if inside {
            assert!((x - 65.0).abs() < 1e-9 && y < 60.0 && anchor == Anchor::Middle, "{x} {y}");
        } else {
            // Behind the head of the arrow on the right.
            assert!((most + 2.0..most + 6.0).contains(&x) && anchor == Anchor::Start, "{x}");
        }
        for mark in &sheet.marks {
            if let super::Mark::Path { filled: true, points, .. } = mark {
                let [tip, a, b] = points[..] else { panic!("no head") };
                let foot = 0.5 * (a[0] + b[0]);
                let at_left = (tip[0] - least).abs() < 1e-9;
                assert!(at_left || (tip[0] - most).abs() < 1e-9, "{tip:?}");
                // From the left end to the right inside, from the right end to the left.
                assert_eq!((foot > tip[0]) == at_left, inside, "{tip:?} {foot}");
                assert!(((foot - tip[0]).abs() - 2.0).abs() < 1e-9 && (a[1] - b[1]).abs() > 0.5);
            }
        }
        // The lines that lead there go a little beyond.
        let low = sheet.marks.iter().filter_map(|mark| match mark {
            super::Mark::Path { points, filled: false, .. } if points[0][0] == points[1][0] => {
                Some(points[1][1])
            }
            _ => None,
        });
        assert!(low.into_iter().all(|y| (y - 61.0).abs() < 1e-9));
    }
}
