//! The square root as one instruction on microcontrollers.
//!
//! Without the standard library nalgebra calls a software routine for `sqrt` (58 instructions on
//! a Cortex-M4F, where `vsqrt.f32` is one). This is the only module of the library crates that
//! uses `unsafe`.

/// Square root of an `f32`, correctly rounded; NaN for a negative number.
#[cfg(all(target_arch = "arm", target_abi = "eabihf", not(feature = "std")))]
#[inline]
#[allow(unsafe_code)]
pub(crate) fn sqrt_f32(value: f32) -> f32 {
    let root;
    // SAFETY: `vsqrt.f32` reads and writes floating-point registers only; it has no operand in
    // memory and cannot trap in the default floating-point environment. Every target with the
    // hard-float ABI has the instruction.
    unsafe {
        core::arch::asm!(
            "vsqrt.f32 s0, s0",
            inout("s0") value => root,
            options(pure, nomem, nostack, preserves_flags)
        );
    }
    root
}

/// Square root of an `f32`, correctly rounded; NaN for a negative number.
#[cfg(not(all(target_arch = "arm", target_abi = "eabihf", not(feature = "std"))))]
#[inline]
pub(crate) fn sqrt_f32(value: f32) -> f32 {
    nalgebra::ComplexField::sqrt(value)
}
