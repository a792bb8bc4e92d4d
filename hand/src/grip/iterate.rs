//! Where the interior-point iteration is.

use fingertip_wrench::Real;
use nalgebra::Vector6;

use crate::grip::interior::Interior;

/// One for each finger, and one for a disturbance that is to be as great as possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Each<A, const N: usize> {
    pub(crate) fingers: [A; N],
    pub(crate) extra: A,
}

impl<A, const N: usize> Each<A, N> {
    #[inline]
    pub(crate) fn iter(&self) -> impl Iterator<Item = &A> {
        self.fingers.iter().chain(core::iter::once(&self.extra))
    }

    #[inline]
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut A> {
        self.fingers.iter_mut().chain(core::iter::once(&mut self.extra))
    }

    /// Changes each with another. (A loop over a chain of iterators, zipped with others, would take longer than what is
    /// done in it.)
    #[inline(always)]
    pub(crate) fn change_with<B>(&mut self, other: &Each<B, N>, mut visit: impl FnMut(&mut A, &B)) {
        for (a, b) in self.fingers.iter_mut().zip(&other.fingers) {
            visit(a, b);
        }
        visit(&mut self.extra, &other.extra);
    }

    /// The same with two others.
    #[inline(always)]
    pub(crate) fn change_with_two<B, C>(
        &mut self,
        others: (&Each<B, N>, &Each<C, N>),
        mut visit: impl FnMut(&mut A, &B, &C),
    ) {
        let (second, third) = others;
        for ((a, b), c) in self.fingers.iter_mut().zip(&second.fingers).zip(&third.fingers) {
            visit(a, b, c);
        }
        visit(&mut self.extra, &second.extra, &third.extra);
    }

    /// The same with three others.
    #[inline(always)]
    pub(crate) fn change_with_three<B, C, D>(
        &mut self,
        others: (&Each<B, N>, &Each<C, N>, &Each<D, N>),
        mut visit: impl FnMut(&mut A, &B, &C, &D),
    ) {
        let (second, third, fourth) = others;
        let each = self.fingers.iter_mut().zip(&second.fingers);
        for ((a, b), (c, d)) in each.zip(third.fingers.iter().zip(&fourth.fingers)) {
            visit(a, b, c, d);
        }
        visit(&mut self.extra, &second.extra, &third.extra, &fourth.extra);
    }

    /// The same of two that are changed, with two others.
    #[inline(always)]
    pub(crate) fn change_both_with_two<B, C, D>(
        &mut self,
        second: &mut Each<B, N>,
        others: (&Each<C, N>, &Each<D, N>),
        mut visit: impl FnMut(&mut A, &mut B, &C, &D),
    ) {
        let (third, fourth) = others;
        let each = self.fingers.iter_mut().zip(&mut second.fingers);
        for ((a, b), (c, d)) in each.zip(third.fingers.iter().zip(&fourth.fingers)) {
            visit(a, b, c, d);
        }
        visit(&mut self.extra, &mut second.extra, &third.extra, &fourth.extra);
    }
}

impl<A: Copy, const N: usize> Each<A, N> {
    pub(crate) const fn all(value: A) -> Self {
        Self { fingers: [value; N], extra: value }
    }
}

/// An iterate of the homogeneous embedding: what is asked for is this over `tau`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Iterate<T: Real, const N: usize, const ROWS: usize> {
    pub(crate) blocks: Each<Interior<T, ROWS>, N>,
    pub(crate) twist: Vector6<T>,
    pub(crate) tau: T,
    pub(crate) kappa: T,
}

impl<T: Real, const N: usize, const ROWS: usize> Iterate<T, N, ROWS> {
    pub(crate) fn middle() -> Self {
        Self {
            blocks: Each::all(Interior::middle()),
            twist: Vector6::zeros(),
            tau: T::one(),
            kappa: T::one(),
        }
    }
}

impl<T: Real, const N: usize, const ROWS: usize> Iterate<T, N, ROWS> {
    /// Whether all is finite and inside, as rounding may have it otherwise.
    pub(crate) fn is_inside(&self) -> bool {
        self.tau > T::zero()
            && self.kappa > T::zero()
            && self.tau.is_number()
            && self.kappa.is_number()
            && self.twist.as_slice().iter().all(|x| x.is_number())
            && self.blocks.iter().all(Interior::is_inside)
    }

    /// Goes back towards an iterate inside, a sixteenth of the way, then by halves, where rounding has had a step lead
    /// outside; `false` if that does not help.
    pub(crate) fn return_inside(&mut self, before: &Self) -> bool {
        for back in [0.0625, 0.5, 0.5, 0.5, 0.5] {
            *self = self.between(before, T::literal(1.0 - back));
            if self.is_inside() {
                return true;
            }
        }
        false
    }

    /// The point that is this share of the way from another here.
    pub(crate) fn between(&self, before: &Self, share: T) -> Self {
        let mut at = *self;
        let rest = T::one() - share;
        at.blocks.change_with(&before.blocks, |at, before| at.mix(before, share, rest));
        at.twist = at.twist * share + before.twist * rest;
        at.tau = at.tau * share + before.tau * rest;
        at.kappa = at.kappa * share + before.kappa * rest;
        at
    }

    /// Takes an iterate with `τ = 1` farther inside, the farther the more the problem has moved since.
    pub(crate) fn lift(&mut self, moved: T) {
        let up = (moved * T::literal(0.2)).min(T::literal(0.5));
        for inner in self.blocks.iter_mut() {
            inner.y.x += up;
            inner.z.x += up;
            for row in &mut inner.rows {
                row.slack += up;
                row.price += up;
            }
        }
        self.kappa += up;
    }

    /// The same direction with numbers near 1.
    pub(crate) fn rescale(&mut self, factor: T) {
        for inner in self.blocks.iter_mut() {
            inner.scale(factor);
        }
        self.twist *= factor;
        self.tau *= factor;
        self.kappa *= factor;
    }
}

#[cfg(test)]
mod tests {
    use super::Iterate;

    /// Each number has a say: none may be on the border, beyond it, infinite or no number.
    #[test]
    fn what_is_inside_is_inside_in_every_number() {
        type Change = fn(&mut Iterate<f64, 2, 1>, f64);
        let positive: [Change; 12] = [
            |i, x| i.tau = x,
            |i, x| i.kappa = x,
            |i, x| i.blocks.fingers[1].y.x = x,
            |i, x| i.blocks.fingers[0].z.x = x,
            |i, x| i.blocks.fingers[1].rows[0].slack = x,
            |i, x| i.blocks.fingers[0].rows[0].price = x,
            |i, x| i.blocks.extra.y.x = x,
            |i, x| i.blocks.extra.z.x = x,
            // A tail as long as the first number less one.
            |i, x| i.blocks.fingers[0].y.y = 1.0 - x,
            |i, x| i.blocks.fingers[1].z.w = x - 1.0,
            |i, x| i.blocks.extra.y.z = 1.0 - x,
            |i, x| i.blocks.extra.z.y = 1.0 - x,
        ];
        let middle = Iterate::<f64, 2, 1>::middle();
        assert!(middle.is_inside());
        for (place, change) in positive.iter().enumerate() {
            let inside = |x: f64| {
                let mut at = middle;
                change(&mut at, x);
                at.is_inside()
            };
            assert!(inside(0.5) && inside(1.0), "{place}");
            for bad in [0.0, -0.5, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert!(!inside(bad), "{place}: {bad}");
            }
        }
        for place in 0..6 {
            let twisted = |x: f64| {
                let mut at = middle;
                at.twist[place] = x;
                at.is_inside()
            };
            assert!(twisted(-3.0) && !twisted(f64::NAN) && !twisted(f64::INFINITY));
        }
    }

    #[test]
    fn a_step_that_led_outside_is_taken_back_as_far_as_need_be() {
        let before = Iterate::<f64, 2, 1>::middle();
        let outside = |first: f64| {
            let mut at = before;
            at.blocks.fingers[1].z.x = first;
            at.blocks.fingers[0].rows[0].price = 2.0;
            (at.tau, at.twist.x) = (3.0, 8.0);
            at
        };
        // A sixteenth is enough where it was rounding.
        let mut hardly = outside(-0.0625);
        assert!(hardly.return_inside(&before));
        assert_eq!((hardly.blocks.fingers[1].z.x, hardly.tau), (1.0 - 1.0625 * 0.9375, 2.875));
        let mut near = outside(-0.5);
        assert!(near.return_inside(&before));
        assert_eq!((near.blocks.fingers[1].z.x, near.blocks.fingers[0].rows[0].price), (0.296875, 1.46875));
        assert_eq!((near.tau, near.twist.x), (1.9375, 3.75));
        let mut far = outside(-2.0);
        assert!(far.return_inside(&before));
        assert_eq!((far.blocks.fingers[1].z.x, far.tau, far.twist.x), (0.296875, 1.46875, 1.875));
        assert!(!outside(-20.0).return_inside(&before) && !outside(f64::NAN).return_inside(&before));
    }
}
