//! Certified root finding along a line, with bounded iterations.

use fingertip_wrench::Real;

/// More halvings than any interval of an `f64` allows.
const MOST_HALVINGS: usize = 120;

/// A root of `f` in `[low, high]`, at whose ends `f` has different signs (or is zero), as
/// [`bracketed_from`] the middle finds it. `f` returns the value and the derivative.
pub fn bracketed<T: Real>(low: T, high: T, f: impl Fn(T) -> (T, T)) -> T {
    let (at_low, _) = f(low);
    let (at_high, _) = f(high);
    if at_low == T::zero() {
        return low;
    }
    if at_high == T::zero() {
        return high;
    }
    let (below, above) = if at_low < T::zero() { (low, high) } else { (high, low) };
    bracketed_from((low + high) * T::literal(0.5), below, above, T::zero(), f)
}

/// A root of `f` between `below`, where it is negative, and `above`, where it is positive: Newton's
/// method from `start` between them, kept inside the bracket, bisecting whenever it does not halve its
/// step. Values up to `noise` cannot be told from zero.
#[inline]
pub fn bracketed_from<T: Real>(start: T, mut below: T, mut above: T, noise: T, f: impl Fn(T) -> (T, T)) -> T {
    let mut t = start;
    let mut step_before = (above - below).abs();
    for _ in 0..2 * MOST_HALVINGS {
        let (value, slope) = f(t);
        if value < T::zero() {
            below = t;
        } else {
            above = t;
        }
        let newton = value / slope;
        let candidate = t - newton;
        let inside = (candidate - below) * (candidate - above) < T::zero();
        let next = if inside && newton.abs() * (T::one() + T::one()) < step_before {
            step_before = newton.abs();
            candidate
        } else if value.abs() <= noise {
            return t;
        } else {
            step_before = (above - below).abs() * T::literal(0.5);
            below + (above - below) * T::literal(0.5)
        };
        if value.abs() <= noise || next == t {
            return next;
        }
        t = next;
    }
    t
}

/// Where a falling function of `[low, high]` changes sign, by its sign alone.
pub fn bisected<T: Real>(mut low: T, mut high: T, is_before: impl Fn(T) -> bool) -> T {
    for _ in 0..MOST_HALVINGS {
        let middle = low + (high - low) * T::literal(0.5);
        if !(middle > low && middle < high) {
            break;
        }
        if is_before(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low + (high - low) * T::literal(0.5)
}

/// The first root of a convex function, coming from `start`, where it is positive and falls in the
/// direction `towards` (+1 or −1); `None` if it has none before it rises again.
///
/// Newton's method on a convex function never oversteps its first root, since the tangent lies
/// below the function; so an iterate that has passed the minimum without meeting a root proves
/// that there is none. `f` returns value and derivative (any subgradient).
pub fn first_of_convex<T: Real>(start: T, towards: T, f: impl Fn(T) -> (T, T)) -> Option<T> {
    let mut t = start;
    for _ in 0..MOST_HALVINGS {
        let (value, slope) = f(t);
        if !(value > T::zero()) {
            return value.is_number().then_some(t);
        }
        if !(slope * towards < T::zero()) {
            return None;
        }
        let next = t - value / slope;
        if !((next - t) * towards > T::zero()) {
            return Some(t);
        }
        t = next;
    }
    // Halving steps all along: a tangent line. The function is within rounding of zero here.
    Some(t)
}

/// Greatest depth of subdivision in [`all_of_lipschitz`].
const DEPTH: usize = 24;

/// Every root of a function in `[low, high]` that is farther than `(high − low)·2⁻²⁰` (or 256
/// rounding units, if that is more) from its neighbour, in ascending order. `f` returns value and
/// derivative, and `value` the value alone, which most places are asked for; it changes by at most
/// `steepest` per unit length, which lets whole intervals be ruled out: this is what certifies
/// that no root is missed (`docs/theory/surfaces.md#certified-roots`). Where two roots are closer than that,
/// the minimum between them is still looked for.
///
/// The work is bounded: at most a few thousand evaluations, for a line that stays tangent.
pub fn all_of_lipschitz<T: Real>(
    low: T,
    high: T,
    steepest: T,
    value: impl Fn(T) -> T,
    f: impl Fn(T) -> (T, T),
    mut found: impl FnMut(T),
) {
    let half = T::literal(0.5);
    // Not so fine that rounding of a slowly changing value looks like a change of sign.
    let finest = (high - low) * T::literal(1.0 / 1_048_576.0).max(T::EPSILON * T::literal(256.0));
    // What rounding may add to a value.
    let noise = steepest * (high - low) * T::EPSILON * T::literal(64.0);
    let mut budget = 6000_usize;
    // Intervals still to be searched, the leftmost on top. Each is at most half of the one below.
    let mut stack = [(T::zero(), T::zero()); DEPTH + 2];
    let mut depth = 1;
    stack[0] = (low, high);
    while depth > 0 {
        depth -= 1;
        let Some(&(a, b)) = stack.get(depth) else { return };
        let middle = a + (b - a) * half;
        let reach = (b - a) * half;
        budget = budget.saturating_sub(1);
        if !(value(middle).abs() <= steepest * reach + noise) {
            continue;
        }
        if b - a > finest && budget > 0 && depth + 2 <= stack.len() {
            if let Some(slot) = stack.get_mut(depth) {
                *slot = (middle, b);
            }
            if let Some(slot) = stack.get_mut(depth + 1) {
                *slot = (a, middle);
            }
            depth += 2;
            continue;
        }
        let ((at_a, slope_a), (at_b, slope_b)) = (f(a), f(b));
        if (at_a < T::zero()) != (at_b < T::zero()) {
            found(bracketed(a, b, &f));
        } else if (slope_a < T::zero()) != (slope_b < T::zero()) {
            // An extremum: two roots if it lies on the other side of zero.
            let falling = slope_a < T::zero();
            let extremum = bisected(a, b, |t| (f(t).1 < T::zero()) == falling);
            if (f(extremum).0 < T::zero()) != (at_a < T::zero()) {
                found(bracketed(a, extremum, &f));
                found(bracketed(extremum, b, &f));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{all_of_lipschitz, bracketed, first_of_convex};
    use core::cell::Cell;

    #[test]
    fn brackets_converge_to_the_last_bit() {
        let root = bracketed(0.0, 2.0, |t: f64| (t * t - 2.0, 2.0 * t));
        assert!((root - 2.0_f64.sqrt()).abs() <= f64::EPSILON);
        // A useless derivative degrades to bisection.
        let root = bracketed(0.0_f32, 3.0, |t| (t.powi(9) - 1.0, 0.0));
        assert!((root - 1.0).abs() <= f32::EPSILON);
        let infinite = bracketed(-1.0, 1.0, |t: f64| (t.cbrt(), f64::INFINITY));
        assert!(infinite.abs() < 1e-15);
    }

    #[test]
    fn convex_roots_and_their_absence() {
        let f = |offset: f64| move |t: f64| ((t * t + 1.0).sqrt() - offset, t / (t * t + 1.0).sqrt());
        let root = first_of_convex(-50.0, 1.0, f(2.0)).unwrap();
        assert!((root + 3.0_f64.sqrt()).abs() < 1e-15);
        let root = first_of_convex(50.0, -1.0, f(2.0)).unwrap();
        assert!((root - 3.0_f64.sqrt()).abs() < 1e-15);
        assert_eq!(first_of_convex(-50.0, 1.0, f(0.5)), None);
        assert_eq!(first_of_convex(-50.0, 1.0, f(1.0 - 1e-9)), None);
    }

    #[test]
    fn all_roots_of_a_wave_with_bounded_work() {
        let calls = Cell::new(0);
        let mut roots = [0.0; 8];
        let mut count = 0;
        all_of_lipschitz(
            0.5,
            20.0,
            1.0,
            |t: f64| {
                calls.set(calls.get() + 1);
                t.sin()
            },
            |t: f64| {
                calls.set(calls.get() + 1);
                (t.sin(), t.cos())
            },
            |t| {
                roots[count] = t;
                count += 1;
            },
        );
        assert_eq!(count, 6);
        for (k, root) in roots[..count].iter().enumerate() {
            assert!((root - (k as f64 + 1.0) * core::f64::consts::PI).abs() < 1e-14);
        }
        assert!(calls.get() < 1000, "{} evaluations", calls.get());
    }

    #[test]
    fn close_pairs_are_found_and_tangents_end() {
        for gap in [1e-3_f64, 1e-6, 1e-9, 0.0, -1e-9] {
            let calls = Cell::new(0);
            let mut count = 0;
            all_of_lipschitz(
                -1.0,
                1.3,
                4.0,
                |t: f64| {
                    calls.set(calls.get() + 1);
                    t * t - gap * gap.abs()
                },
                |t: f64| {
                    calls.set(calls.get() + 1);
                    (t * t - gap * gap.abs(), 2.0 * t)
                },
                |_| count += 1,
            );
            assert!(if gap > 0.0 { count == 2 } else { count <= 2 }, "{gap}: {count}");
            assert!(calls.get() < 12_000, "{gap}: {} evaluations", calls.get());
        }
    }
}
