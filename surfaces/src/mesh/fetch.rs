//! Memory asked for ahead of its use, without waiting for it.

/// The line of a usual cache.
const LINE: usize = 64;

/// Asks for the line that a value begins in. Nothing where no safe instruction does that.
#[inline(always)]
pub(super) fn fetch<T>(value: &T) {
    #[cfg(all(target_arch = "x86_64", target_feature = "sse"))]
    safe_arch::prefetch_t0(value);
    #[cfg(not(all(target_arch = "x86_64", target_feature = "sse")))]
    let _ = value;
}

/// Asks for all lines that some numbers lie in. Where no instruction does that, they are read, and what is
/// read is not used; a processor of 32 bits has no cache that is worth it.
#[inline(always)]
pub(super) fn fetch_all<T: Copy>(numbers: &[T]) {
    for number in numbers.iter().step_by((LINE / size_of::<T>().max(1)).max(1)) {
        if cfg!(all(target_arch = "x86_64", target_feature = "sse")) {
            fetch(number);
        } else if cfg!(target_pointer_width = "64") {
            core::hint::black_box(*number);
        }
    }
}
