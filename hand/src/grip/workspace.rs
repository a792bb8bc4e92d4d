//! What the steps of the interior-point method share.

use fingertip_wrench::Real;

use crate::grip::block::Block;
use crate::grip::iterate::Each;
use crate::grip::scaled::Scaled;

/// What a step works with: kept from step to step, so that nothing is moved.
pub(crate) struct Workspace<T: Real, const N: usize, const ROWS: usize> {
    pub(super) scaled: Each<Option<Scaled<T, ROWS>>, N>,
}

impl<T: Real, const N: usize, const ROWS: usize> Workspace<T, N, ROWS> {
    pub(crate) fn new(blocks: &Each<Option<Block<T, ROWS>>, N>) -> Self {
        let mut scaled: Each<_, N> = Each::all(None);
        scaled.change_with(blocks, |scaled, block| {
            if block.is_some() {
                *scaled = Some(Scaled::none());
            }
        });
        Self { scaled }
    }
}
