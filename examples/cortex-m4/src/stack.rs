//! How deep the stack grows, found by painting it.

use cortex_m::register::msp;

const PAINT: u32 = 0xdead_beef;
/// How much is painted [B].
const DEPTH: u32 = 16 * 1024;
/// What this routine itself may have below the pointer that it reads [B].
const MARGIN: u32 = 64;

/// Bytes of stack that some work uses, its own frame included; at most [`DEPTH`].
#[inline(never)]
pub(crate) fn used(work: impl FnOnce()) -> u32 {
    let top = msp::read() & !3;
    let (bottom, end) = (top - DEPTH, top - MARGIN);
    for address in (bottom..end).step_by(4) {
        // SAFETY: below the stack pointer and its margin nothing lives, and the memory map leaves
        // more room there than is painted.
        unsafe { (address as *mut u32).write_volatile(PAINT) };
    }
    work();
    let deepest = (bottom..end)
        .step_by(4)
        // SAFETY: as above; reads what was painted or what the work left.
        .find(|address| unsafe { (*address as *const u32).read_volatile() } != PAINT);
    top - deepest.unwrap_or(end)
}
