//! How steep a formula is.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::Term;
use crate::numeric::vectors::length;

/// Along each axis, into how many parts the cube around the ball is cut.
const CELLS: u8 = 8;

/// How steep a formula is where its value is small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Steepness<T: Real> {
    /// No smaller than the length of the gradient wherever the value lies within `below` \[value per m\].
    pub(crate) greatest: T,
    /// No larger than the magnitude of the value wherever the gradient has no bound.
    pub(crate) below: T,
}

impl<T: Real> Steepness<T> {
    /// Over a ball. `None` unless it is finite near the surface.
    ///
    /// The cube around the ball is cut into cells, and the formula taken over each. A cell over which the slope has
    /// no bound, as that of a distance has none at its centre, does no harm if the value is not zero there: then
    /// values beyond it need not be looked at.
    pub(crate) fn over_ball(
        formula: impl Fn([Term<T>; 3]) -> Term<T>,
        centre: &Vector3<T>,
        radius: T,
    ) -> Option<Self> {
        let mut below = T::GREATEST;
        each_cell(centre, radius, |cell| {
            let term = formula(Term::over(cell));
            if !length(&term.steepest()).is_number() {
                below = below.min(least_magnitude(&term));
            }
        });
        if !(below > T::zero()) {
            return None;
        }
        let mut greatest = T::zero();
        each_cell(centre, radius, |cell| {
            let term = formula(Term::over(cell));
            if least_magnitude(&term) < below {
                greatest = greatest.max(length(&term.steepest()));
            }
        });
        // Rounding of some thousand operations in single precision.
        let greatest = greatest * T::literal(1.001);
        (greatest > T::zero() && greatest.is_number())
            .then_some(Self { greatest, below: below * T::literal(0.999) })
    }
}

impl<T: Real> Steepness<T> {
    /// As somebody states it. `None` unless it is positive and finite, and no gradient in the middle of a cell exceeds it.
    pub(crate) fn stated(
        gradient: impl Fn(&Vector3<T>) -> Vector3<T>,
        centre: &Vector3<T>,
        radius: T,
        greatest: T,
    ) -> Option<Self> {
        let mut good = greatest > T::zero() && greatest.is_number();
        each_cell(centre, radius, |cell| {
            let middle = Vector3::from(cell.map(|[low, high]| (low + high) * T::literal(0.5)));
            let inside = length(&(middle - centre)) <= radius;
            good &= !(inside && length(&gradient(&middle)) > greatest);
        });
        good.then_some(Self { greatest, below: T::GREATEST })
    }
}

fn least_magnitude<T: Real>(term: &Term<T>) -> T {
    let [low, high] = term.range();
    low.max(-high).max(T::zero())
}

/// Calls `visit` with the bounds of every cell that reaches into the ball, and a little beyond.
fn each_cell<T: Real>(centre: &Vector3<T>, radius: T, mut visit: impl FnMut([[T; 2]; 3])) {
    let reach = radius * T::literal(1.001);
    let edge = |k: u8| reach * T::literal(f64::from(2 * k) / f64::from(CELLS) - 1.0);
    let mut visit_if_near = |cell: [[T; 2]; 3]| {
        let nearest = Vector3::from(cell.map(|[low, high]| low.max(-high).max(T::zero())));
        if length(&nearest) <= reach {
            let [x, y, z] = cell;
            visit([(x, centre.x), (y, centre.y), (z, centre.z)].map(|(ends, c)| ends.map(|end| end + c)));
        }
    };
    let ends = |k: u8| [edge(k), edge(k + 1)];
    for i in 0..CELLS {
        for j in 0..CELLS {
            for k in 0..CELLS {
                visit_if_near([ends(i), ends(j), ends(k)]);
            }
        }
    }
}
