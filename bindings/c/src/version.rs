//! Which library this is.

use core::ffi::c_char;

/// The version of the layout of all structures and of what functions take: a program that was compiled with another
/// one does not fit the library.
pub const FT_ABI_VERSION: u32 = 1;

/// The version of the ABI of the library that runs, to be compared with FT_ABI_VERSION of the header.
#[unsafe(no_mangle)]
pub extern "C" fn ft_abi_version() -> u32 {
    FT_ABI_VERSION
}

/// The version of the library, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn ft_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}
