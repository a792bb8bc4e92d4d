//! From a grasp to the cone program.

use fingertip_wrench::{Frame, Real};
use nalgebra::Vector6;

use crate::grip::block::Block;
use crate::grip::iterate::Each;
use crate::grip::program::Program;
use crate::{FingerLimits, Grasp};

/// The program of a grasp, in units near 1.
pub(crate) struct Assembled<T: Real, const N: usize, const ROWS: usize> {
    pub(crate) program: Program<T, N, ROWS>,
    /// The greatest sum of normal forces, if all fingers that touch have a limit.
    pub(crate) most: Option<T>,
}

/// `None` if a number leaves the range of the scalar type.
pub(crate) fn assemble<T: Real, const N: usize, const ROWS: usize, F: Frame>(
    grasp: &Grasp<T, N, F>,
    limits: &[FingerLimits<T, ROWS>; N],
    wrench: &Vector6<T>,
    per_newton: T,
) -> Option<Assembled<T, N, ROWS>> {
    let mut blocks: Each<_, N> = Each::all(None);
    let mut dearest = T::zero();
    let mut most = Some(T::zero());
    for (contact, limits) in grasp.contacts().iter().zip(limits) {
        if contact.is_some() {
            dearest = dearest.max(limits.cost());
            most = most.and_then(|sum| limits.greatest_normal().map(|greatest| sum + greatest * per_newton));
        }
    }
    let cost_factor = dearest.normalising_factor();
    let numbers = |values: &[T]| values.iter().all(|x| x.is_number());
    let mut finite = numbers(wrench.as_slice());
    let maps = grasp.blocks().zip(grasp.contacts()).zip(limits);
    for (block, ((map, contact), limits)) in blocks.fingers.iter_mut().zip(maps) {
        let (Some(map), Some(contact)) = (map, contact) else { continue };
        let rows = limits.rows(contact, per_newton);
        finite = finite
            && numbers(map.as_slice())
            && rows.iter().flatten().all(|row| row.bound.is_number() && numbers(row.normal.as_slice()));
        *block = Some(Block { map, cost: limits.cost() * cost_factor, rows });
    }
    finite.then_some(Assembled { program: Program { blocks, wrench: *wrench, cost_factor }, most })
}
