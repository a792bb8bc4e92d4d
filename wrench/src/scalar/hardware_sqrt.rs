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
    let bits: u32;
    // SAFETY: the three instructions read and write registers only, those that are declared; they
    // have no operand in memory and cannot trap in the default floating-point environment. Every
    // target with the hard-float ABI has them. The value passes through a core register because
    // the floating-point register class needs a target feature that stable Rust cannot name.
    unsafe {
        core::arch::asm!(
            "vmov s0, {value}",
            "vsqrt.f32 s0, s0",
            "vmov {value}, s0",
            value = inout(reg) value.to_bits() => bits,
            out("s0") _,
            options(pure, nomem, nostack, preserves_flags)
        );
    }
    f32::from_bits(bits)
}

/// Square root of an `f32`, correctly rounded; NaN for a negative number.
#[cfg(not(all(target_arch = "arm", target_abi = "eabihf", not(feature = "std"))))]
#[inline]
pub(crate) fn sqrt_f32(value: f32) -> f32 {
    nalgebra::ComplexField::sqrt(value)
}
