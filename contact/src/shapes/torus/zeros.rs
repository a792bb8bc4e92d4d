//! All zeros of a trigonometric polynomial of degree 4, told apart for certain.

use core::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

use fingertip_surfaces::numeric::vectors::{larger, smaller};
use fingertip_wrench::Real;

use super::eighths::{EDGE, Fourth, Signs, halves, on_eighths, signs};

/// Where the circle is cut first, in radians before the first axis: off the axes, where shapes and loads like to be symmetric.
/// It is the middle of the first eighth.
const MIDDLE_ANGLE: f64 = 0.490_062_274_022_122_8;

/// A polynomial of degree 4 in the angle has no more zeros.
pub(super) const MOST: usize = 8;

/// How often a cell is halved at most, of double precision and of single: where the polynomial is noise, as it is nearer
/// than the root of that to a double zero, halving tells nothing.
const DEPTH: [usize; 2] = [16, 8];

/// How many cells are halved at most.
const HALVINGS: usize = 64;

/// Steps to a zero, at least and at most: in a cell that was halved often it needs many.
const FEWEST: usize = 2;
const STEPS: usize = 24;

/// An interval of the tangent of half the angle from the middle of an eighth of the circle.
#[derive(Clone, Copy)]
struct Interval<T> {
    low: T,
    high: T,
}

/// One with a single zero, and where that may be.
#[derive(Clone, Copy)]
pub(super) struct Cell<T> {
    interval: Interval<T>,
    guess: T,
    rises: bool,
    /// Cosine and sine of the middle of the eighth.
    middle: [T; 2],
}

impl<T: Real> Cell<T> {
    /// None yet.
    pub(super) fn nowhere() -> Self {
        let zero = T::zero();
        Self { interval: Interval { low: zero, high: zero }, guess: zero, rises: false, middle: [zero; 2] }
    }

    /// Cosine and sine of the guess.
    #[inline(always)]
    pub(super) fn around(&self) -> [T; 2] {
        self.around_and_share().0
    }

    /// And the square of the cosine of half the angle from the middle.
    #[inline(always)]
    fn around_and_share(&self) -> ([T; 2], T) {
        let (u, [c0, s0]) = (self.guess, self.middle);
        let squared = u * u;
        let share = T::one() / (T::one() + squared);
        let (c, s) = ((T::one() - squared) * share, (u + u) * share);
        ([c * c0 - s * s0, s * c0 + c * s0], share)
    }
}

/// The polynomial and its derivative by the angle of this cosine and sine: the real part of a polynomial in
/// `z = cos θ + i sin θ`, and the imaginary part of `−z` times its derivative.
#[inline(always)]
fn value_and_slope<T: Real>([a0, a1, b1, a2, b2, a3, b3, a4, b4]: Fourth<T>, [c, s]: [T; 2]) -> (T, T) {
    let [two, three, four] = [2.0, 3.0, 4.0].map(T::literal);
    let (c2, s2) = (c * c - s * s, two * c * s);
    let (x4, y4) = (a4 * c2 + b4 * s2, a4 * s2 - b4 * c2);
    let (x3, y3) = (a3 * c2 + b3 * s2, a3 * s2 - b3 * c2);
    let value = a0 + ((a2 + x4) * c2 - (y4 - b2) * s2) + ((a1 + x3) * c - (y3 - b1) * s);
    let even = (two * a2 + four * x4) * s2 + (four * y4 - two * b2) * c2;
    let odd = (a1 + three * x3) * s + (three * y3 - b1) * c;
    (value, -(even + odd))
}

/// Moves the guesses to the zeros, until the last step is at most so fine. `None` where they do not settle.
///
/// By Newton's method, which is kept within the intervals: with all of them side by side, since none waits for another.
#[inline(always)]
pub(super) fn approach<T: Real>(polynomial: Fourth<T>, cells: &mut [Cell<T>], fine: T) -> Option<()> {
    let half = T::literal(0.5);
    for step in 1..=STEPS {
        let mut longest = T::zero();
        for cell in &mut *cells {
            let (around, share) = cell.around_and_share();
            let (value, slope) = value_and_slope(polynomial, around);
            let Interval { low, high } = cell.interval;
            let above = (value > T::zero()) == cell.rises;
            let (low, high) = if above { (low, cell.guess) } else { (cell.guess, high) };
            let next = cell.guess - value / (slope * (share + share));
            // False for a NaN, too.
            let next = if (next >= low) & (next <= high) { next } else { (low + high) * half };
            longest = larger(longest, (next - cell.guess).abs());
            cell.interval = Interval { low, high };
            cell.guess = next;
        }
        if step >= FEWEST && longest <= fine {
            return Some(());
        }
    }
    None
}

/// Intervals of the angle in which there may be two zeros, or none, for all that rounding leaves.
#[derive(Clone, Copy)]
pub(super) struct Doubts<T> {
    ends: [[T; 2]; MOST],
    count: usize,
}

impl<T: Real> Doubts<T> {
    pub(super) fn none() -> Self {
        Self { ends: [[T::zero(); 2]; MOST], count: 0 }
    }

    /// For whom does not ask where they are: the first one ends the search.
    pub(super) fn unwanted() -> Self {
        Self { count: MOST, ..Self::none() }
    }

    /// Their ends, in rising order.
    pub(super) fn ends(&self) -> impl Iterator<Item = T> {
        self.ends.iter().take(self.count).flatten().copied()
    }

    /// With another, behind those that there are; `None` if there are too many. Neighbours are one.
    fn push(&mut self, [low, high]: [T; 2]) -> Option<()> {
        match self.count.checked_sub(1).and_then(|last| self.ends.get_mut(last)) {
            Some([_, end]) if self.count < MOST && (low - *end).abs() <= T::EPSILON * T::literal(16.0) => {
                *end = high
            }
            _ => {
                *self.ends.get_mut(self.count)? = [low, high];
                self.count += 1;
            }
        }
        Some(())
    }
}

/// Looks for intervals with a single zero.
struct Isolation<'a, T: Real, C: Fn(T, [T; 2], T) -> bool> {
    noise: T,
    doubtful: T,
    is_clear: C,
    /// Cosine and sine of the middle of the eighth that is looked at.
    middle: [T; 2],
    eighth: usize,
    cells: &'a mut [Cell<T>; MOST],
    doubts: &'a mut Doubts<T>,
    count: usize,
    halvings: usize,
}

impl<T: Real, C: Fn(T, [T; 2], T) -> bool> Isolation<'_, T, C> {
    /// Those of an interval that was halved so often already; `None` where rounding may have a say in it.
    #[inline(always)]
    fn look(&mut self, coefficients: &Fourth<T>, interval: Interval<T>, halved: usize) -> Option<()> {
        match signs(coefficients, self.noise) {
            Signs::None if self.doubtful > self.noise && self.is_doubtful(coefficients, interval) => {
                self.look_at_halves(coefficients, interval, halved)
            }
            Signs::None => Some(()),
            Signs::One { from } => {
                // Where the control polygon crosses zero.
                let [x, y] = [*coefficients.get(from)?, *coefficients.get(from + 1)?];
                let share = (T::literal(from as f64) + x / (x - y)) * T::literal(0.125);
                let guess = interval.low + (interval.high - interval.low) * share;
                let rises = coefficients[8] > T::zero();
                *self.cells.get_mut(self.count)? = Cell { interval, guess, rises, middle: self.middle };
                self.count += 1;
                Some(())
            }
            Signs::Unknown => self.look_at_halves(coefficients, interval, halved),
        }
    }

    #[inline(never)]
    fn look_at_halves(
        &mut self,
        coefficients: &Fourth<T>,
        interval: Interval<T>,
        halved: usize,
    ) -> Option<()> {
        let Interval { low, high } = interval;
        let [double, single] = DEPTH;
        if halved >= if T::EPSILON.to_f64() > f64::EPSILON { single } else { double } {
            let middle = T::literal(MIDDLE_ANGLE + self.eighth as f64 * FRAC_PI_4);
            return self.doubts.push([low, high].map(|u| middle + u.arctangent() * T::literal(2.0)));
        }
        self.halvings += 1;
        if self.halvings > HALVINGS {
            return None;
        }
        let between = (low + high) * T::literal(0.5);
        let [first, second] = halves(coefficients);
        self.look(&first, Interval { low, high: between }, halved + 1)?;
        self.look(&second, Interval { low: between, high }, halved + 1)
    }

    #[cold]
    fn is_doubtful(&self, coefficients: &Fourth<T>, interval: Interval<T>) -> bool {
        let least = coefficients.iter().fold(T::GREATEST, |least, x| smaller(least, x.abs()));
        let Interval { low, high } = interval;
        let guess = (low + high) * T::literal(0.5);
        let cell = Cell { interval, guess, rises: false, middle: self.middle };
        least <= self.doubtful && !(self.is_clear)(least, cell.around(), high - low)
    }
}

/// An interval for each zero, from the beginning of the eighth around the first axis on, and how many there are; `None`
/// where `noise`, which is what rounding does to the coefficients, may have a say in that: `doubts` are the places.
///
/// On each eighth of the circle `u = tan θ/2` makes a polynomial of degree 8 of the given one. An interval on which its
/// coefficients tell neither that there is no zero nor that there is one is halved.
///
/// `is_clear` is asked of intervals without a zero where the polynomial is below `doubtful`: by what the smallest
/// coefficient is, with cosine and sine of the angle in the middle and how wide it is.
#[inline(always)]
pub(super) fn isolated<T: Real>(
    polynomial: Fourth<T>,
    [noise, doubtful]: [T; 2],
    is_clear: impl Fn(T, [T; 2], T) -> bool,
    cells: &mut [Cell<T>; MOST],
    doubts: &mut Doubts<T>,
) -> Option<usize> {
    let (edge, h) = (T::literal(EDGE), T::literal(FRAC_1_SQRT_2));
    let whole = Interval { low: -edge, high: edge };
    let middle = [T::one(), T::zero()];
    let (count, halvings, eighth, before) = (0, 0, 0, doubts.count);
    let mut isolation =
        Isolation { noise, doubtful, is_clear, middle, eighth, cells, doubts, count, halvings };
    for coefficients in &on_eighths(polynomial) {
        isolation.look(coefficients, whole, 0)?;
        let [c, s] = isolation.middle;
        isolation.middle = [(c - s) * h, (c + s) * h];
        isolation.eighth += 1;
    }
    (isolation.doubts.count == before).then_some(isolation.count)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{PI, TAU};

    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    /// `(1 − cos(θ − α)) (1 − cos(θ − β))`, θ from the middle of the first eighth, touches zero at `α` and at `β`: no zeros can
    /// be told, and each of the two places is a doubt of its own, as narrow as halving makes it.
    #[test]
    fn each_double_zero_is_a_doubt_of_its_own() {
        let mut random = Pcg64Mcg::seed_from_u64(54);
        for _ in 0..200 {
            let first: f64 = random.random_range(0.0..TAU);
            let second = first + random.random_range(0.3..TAU - 0.3);
            let (sum, apart) = (first + second, first - second);
            let polynomial: Fourth<f64> = [
                1.0 + 0.5 * apart.cos(),
                -first.cos() - second.cos(),
                -first.sin() - second.sin(),
                0.5 * sum.cos(),
                0.5 * sum.sin(),
                0.0,
                0.0,
                0.0,
                0.0,
            ];
            let (mut cells, mut doubts) = ([Cell::nowhere(); MOST], Doubts::none());
            let count = isolated(polynomial, [1e-13, 0.0], |_, _, _| true, &mut cells, &mut doubts);
            assert_eq!(count, None, "{first} {second}");
            let ends: Vec<f64> = doubts.ends().collect();
            let [a, b, c, d] = *ends.as_slice() else { panic!("{first} {second}: {ends:?}") };
            assert!(a < b && b < c && c < d && b - a < 1e-3 && d - c < 1e-3, "{ends:?}");
            for zero in [first, second] {
                let is_in = |low: f64, high: f64| {
                    let off = (zero + MIDDLE_ANGLE - 0.5 * (low + high) + PI).rem_euclid(TAU) - PI;
                    off.abs() <= 0.5 * (high - low)
                };
                assert!(is_in(a, b) != is_in(c, d), "{zero}: {ends:?}");
            }
        }
    }
}
