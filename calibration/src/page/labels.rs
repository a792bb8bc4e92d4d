//! Texts in drawings that do not run into each other.

/// How much wider than its letters' size over two a text is drawn, letter by letter: of digits and most small letters in
/// the fonts of screens. Six units for letters of eleven.
const LETTER: f64 = 0.55;
/// Room between two texts in a row, in letters' sizes.
const GAP: f64 = 0.4;

/// How wide a text is drawn, at most nearly, with letters of a size.
#[must_use]
pub fn text_width(text: &str, size: f64) -> f64 {
    LETTER * size * text.chars().count() as f64
}

/// Every how many of the texts in a row have room beside each other: 1 if all have. `spans` are where they begin and end, in
/// their order along the row, either way round; what is left between two of them is part of a letter of this size.
#[must_use]
pub fn thinned(spans: &[(f64, f64)], size: f64) -> usize {
    let apart = |a: &(f64, f64), b: &(f64, f64)| a.1 + GAP * size <= b.0 || b.1 + GAP * size <= a.0;
    let fits = |every: &usize| {
        let kept: Vec<_> = spans.iter().step_by(*every).collect();
        kept.array_windows().all(|[a, b]| apart(a, b))
    };
    (1..spans.len()).find(fits).unwrap_or(spans.len().max(1))
}

/// The texts of a drawing that stand at any places: the first to come has the place.
///
/// ```
/// use fingertip_calibration::page::Placed;
///
/// // Left, right, top and bottom of each text in the units of the drawing.
/// let mut placed = Placed::default();
/// assert!(placed.take([10.0, 50.0, 10.0, 20.0]));
/// // The next would stand over it; below it has room.
/// assert!(!placed.take([40.0, 90.0, 15.0, 25.0]));
/// assert!(placed.take([40.0, 90.0, 20.0, 30.0]));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Placed(Vec<[f64; 4]>);

impl Placed {
    /// Whether the box from `left` to `right`, `top` to `bottom` is free.
    #[must_use]
    pub fn is_free(&self, [left, right, top, bottom]: [f64; 4]) -> bool {
        let over =
            |[from, to, high, low]: &[f64; 4]| left < *to && *from < right && top < *low && *high < bottom;
        !self.0.iter().any(over)
    }

    /// Whether the box from `left` to `right`, `top` to `bottom` is free; if it is, it is taken from here on.
    pub fn take(&mut self, place: [f64; 4]) -> bool {
        let free = self.is_free(place);
        if free {
            self.0.push(place);
        }
        free
    }
}

#[cfg(test)]
mod tests {
    use super::{Placed, text_width, thinned};

    #[test]
    fn rows_keep_as_many_as_have_room() {
        assert!((text_width("−12.5", 10.0) - 27.5).abs() < 1e-12);
        let row = |step: f64, width: f64| -> Vec<(f64, f64)> {
            (0..10).map(|i| (step * f64::from(i), step * f64::from(i) + width)).collect()
        };
        for (step, width, every) in
            [(20.0, 16.0, 1), (20.0, 16.1, 2), (20.0, 36.0, 2), (10.0, 31.0, 4), (1.0, 99.0, 10)]
        {
            assert_eq!(thinned(&row(step, width), 10.0), every, "{step} {width}");
            // As upwards, where each is above the one before.
            let up: Vec<_> = row(step, width).iter().map(|(from, to)| (-to, -from)).collect();
            assert_eq!(thinned(&up, 10.0), every, "{step} {width}");
        }
        assert_eq!((thinned(&[], 10.0), thinned(&[(0.0, 9.0)], 10.0)), (1, 1));
    }

    #[test]
    fn a_place_is_taken_once() {
        let mut placed = Placed::default();
        assert!(placed.take([0.0, 10.0, 0.0, 10.0]));
        assert!(!placed.take([9.0, 12.0, 9.0, 12.0]) && !placed.take([2.0, 3.0, 2.0, 3.0]));
        assert!(placed.take([10.0, 12.0, 0.0, 10.0]) && placed.take([0.0, 10.0, 10.0, 11.0]));
        assert!(!placed.take([-5.0, 20.0, -5.0, 20.0]));
    }
}
