//! Where pointers become values, and panics end.
//!
//! What is relied on, and stands at the head of the header: a pointer that is not NULL points to as much memory as the
//! call says, for as long as it takes; a handle is one that this library made and that was not freed; and no two calls
//! use one handle at the same time. Nothing is relied on beyond that: structures may lie at any address, and numbers
//! may be any.

use core::ffi::{CStr, c_char};
use core::panic::AssertUnwindSafe;
use std::panic::catch_unwind;

use nalgebra::Vector3;

use crate::fault::{Fault, ft_status};
use crate::message::ft_error;

/// A handle that keeps why its last call failed.
pub(crate) trait Keeps {
    fn kept(&mut self) -> &mut ft_error;
}

/// A call of a handle.
///
/// A panic is caught, since it must not unwind into C. What it interrupts is numbers only, never memory: so the handle
/// stays safe to use and to free, and the status says that its numbers are not to be trusted.
#[inline(always)]
pub(crate) fn on<H: Keeps>(handle: *mut H, call: impl FnOnce(&mut H) -> Result<(), Fault>) -> ft_status {
    // SAFETY: NULL, or a handle that nobody else uses now: the rules of the header.
    let Some(handle) = (unsafe { handle.as_mut() }) else { return ft_status::FT_NULL };
    let ended = catch_unwind(AssertUnwindSafe(|| call(handle)));
    match ended {
        Ok(Ok(())) => ft_status::FT_OK,
        Ok(Err(fault)) => keep(handle, &fault),
        Err(panic) => {
            discard(panic);
            keep(handle, &Fault::Panicked)
        }
    }
}

#[cold]
fn keep<H: Keeps>(handle: &mut H, fault: &Fault) -> ft_status {
    *handle.kept() = fault.told();
    fault.status()
}

/// A call without a handle, whose failure is told in `error` unless that is NULL.
pub(crate) fn told(error: *mut ft_error, call: impl FnOnce() -> Result<(), Fault>) -> ft_status {
    let ended = catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| {
        discard(panic);
        Err(Fault::Panicked)
    });
    let Err(fault) = ended else { return ft_status::FT_OK };
    if !error.is_null() {
        // SAFETY: the caller's structure, at any address.
        unsafe { error.write_unaligned(fault.told()) };
    }
    fault.status()
}

/// To drop what a panic carries may panic again.
fn discard(panic: Box<dyn core::any::Any + Send>) {
    core::mem::forget(panic);
}

/// What a pointer points to.
#[inline(always)]
pub(crate) fn read<V: Copy>(pointer: *const V, name: &'static str) -> Result<V, Fault> {
    if pointer.is_null() {
        return Err(Fault::Null(name));
    }
    // SAFETY: not NULL, so the caller's memory of this size, which any bits make a value of: the structures that are
    // read hold numbers and pointers alone.
    Ok(unsafe { pointer.read_unaligned() })
}

/// A number that need not lie where numbers lie.
#[repr(C, packed)]
#[derive(Clone, Copy)]
struct Anywhere(f64);

/// Numbers that the caller has just written, one by one: a wide load would wait until all of its stores have reached the
/// cache, which takes as long as a third of a sample. Volatile loads are not made wide.
#[inline(always)]
pub(crate) fn read_numbers<const N: usize>(
    pointer: *const [f64; N],
    name: &'static str,
) -> Result<[f64; N], Fault> {
    if pointer.is_null() {
        return Err(Fault::Null(name));
    }
    let first = pointer.cast::<Anywhere>();
    // SAFETY: not NULL, so `N` numbers of the caller, at any address.
    Ok(core::array::from_fn(|index| unsafe { first.add(index).read_volatile() }.0))
}

/// A number that was just computed: as in [`read_numbers`].
#[inline(always)]
pub(crate) fn fresh(number: &f64) -> f64 {
    // SAFETY: a reference.
    unsafe { core::ptr::from_ref(number).read_volatile() }
}

/// The same of three numbers.
#[inline(always)]
pub(crate) fn fresh_vector(vector: &Vector3<f64>) -> [f64; 3] {
    [fresh(&vector.x), fresh(&vector.y), fresh(&vector.z)]
}

/// A place to write to.
#[derive(Debug)]
pub(crate) struct Place<V>(*mut V);

/// Where a call is to write.
#[inline(always)]
pub(crate) fn place<V>(pointer: *mut V, name: &'static str) -> Result<Place<V>, Fault> {
    if pointer.is_null() { Err(Fault::Null(name)) } else { Ok(Place(pointer)) }
}

impl<V> Place<V> {
    #[inline(always)]
    pub(crate) fn put(self, value: V) {
        // SAFETY: not NULL, so the caller's memory of this size; what lies there before is never read.
        unsafe { self.0.write_unaligned(value) };
    }
}

impl<V> Place<V> {
    /// For [`put!`].
    #[inline(always)]
    pub(crate) const fn pointer(&self) -> *mut V {
        self.0
    }
}

/// Writes one field of the structure at a [`Place`].
macro_rules! put {
    ($place:ident.$field:ident = $value:expr) => {{
        let value = $value;
        // SAFETY: not NULL, so the caller's memory of the size of the structure, of which this is a field; what lies
        // there before is never read.
        unsafe { (&raw mut (*$place.pointer()).$field).write_unaligned(value) };
    }};
}
pub(crate) use put;

/// The first `count` values behind a pointer, in an array that has room for them.
#[inline(always)]
pub(crate) fn read_many<V: Copy, const N: usize>(
    pointer: *const V,
    count: usize,
    name: &'static str,
    fill: V,
) -> Result<[V; N], Fault> {
    if pointer.is_null() {
        return Err(Fault::Null(name));
    }
    let mut values = [fill; N];
    for (index, value) in values.iter_mut().enumerate().take(count) {
        // SAFETY: the caller's memory holds `count` values, and `index` is less.
        *value = unsafe { pointer.add(index).read_unaligned() };
    }
    Ok(values)
}

/// Writes values one behind the other: no more than the caller's memory holds.
#[inline(always)]
pub(crate) fn write_many<V: Copy>(pointer: *mut V, values: &[V]) {
    for (index, value) in values.iter().enumerate() {
        // SAFETY: callers pass as many values as the memory behind the pointer holds, and no NULL.
        unsafe { pointer.add(index).write_unaligned(*value) };
    }
}

/// A text.
pub(crate) fn text<'a>(pointer: *const c_char, name: &'static str) -> Result<&'a str, Fault> {
    if pointer.is_null() {
        return Err(Fault::Null(name));
    }
    // SAFETY: a text of the caller, closed by a zero, which stays as it is during the call; the reference does not
    // outlive that.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| Fault::NotText(name))
}

/// Hands a value out as a handle.
pub(crate) fn hand_out<H>(place: Place<*mut H>, value: H) {
    place.put(Box::into_raw(Box::new(value)));
}

/// Takes a handle back and forgets it: NULL, and a handle that was freed by this before, are left.
pub(crate) fn free<H>(handle: *mut *mut H) {
    if handle.is_null() {
        return;
    }
    // SAFETY: the caller's variable that holds the handle.
    let held = unsafe { handle.replace(core::ptr::null_mut()) };
    if held.is_null() {
        return;
    }
    let dropped = catch_unwind(AssertUnwindSafe(|| {
        // SAFETY: made by `hand_out` and not freed yet: freeing empties the variable.
        drop(unsafe { Box::from_raw(held) });
    }));
    if let Err(panic) = dropped {
        discard(panic);
    }
}

#[cfg(test)]
mod tests {
    use core::ffi::CStr;
    use core::ptr::null_mut;

    use super::{Keeps, free, on, told};
    use crate::fault::{Fault, ft_status};
    use crate::message::ft_error;

    /// What panics, too, when it is dropped.
    struct Explodes;

    impl Drop for Explodes {
        fn drop(&mut self) {
            panic!("dropped");
        }
    }

    struct Handle {
        kept: ft_error,
        number: i32,
        #[expect(dead_code, reason = "dropped only")]
        explodes: Option<Explodes>,
    }

    impl Keeps for Handle {
        fn kept(&mut self) -> &mut ft_error {
            &mut self.kept
        }
    }

    fn text(error: &ft_error) -> &str {
        // SAFETY: messages are closed by a zero.
        unsafe { CStr::from_ptr(error.message.as_ptr()) }.to_str().unwrap()
    }

    /// A panic that left a function of C would end the program of whoever called it.
    #[test]
    fn a_panic_ends_at_the_border_and_is_told() {
        let mut handle = Handle { kept: ft_error::none(), number: 1, explodes: None };
        let status = on(&raw mut handle, |handle| {
            handle.number = 2;
            panic!("a fault of the library")
        });
        assert_eq!(
            (status, handle.kept.status, handle.number),
            (ft_status::FT_INTERNAL, ft_status::FT_INTERNAL, 2)
        );
        assert!(text(&handle.kept).contains("fault of this library"), "{}", text(&handle.kept));
        // The handle can be used.
        assert_eq!(on(&raw mut handle, |_| Ok(())), ft_status::FT_OK);

        let status = on(&raw mut handle, |_| std::panic::panic_any(Explodes));
        assert_eq!(status, ft_status::FT_INTERNAL);
        let mut error = ft_error::none();
        let status = told(&raw mut error, || std::panic::panic_any(Explodes));
        assert_eq!((status, error.status), (ft_status::FT_INTERNAL, ft_status::FT_INTERNAL));
        assert_eq!(told(null_mut(), || panic!("a fault of the library")), ft_status::FT_INTERNAL);
        assert_eq!(told(null_mut(), || Err(Fault::Null("tip"))), ft_status::FT_NULL);

        let mut held = Box::into_raw(Box::new(Handle { explodes: Some(Explodes), ..handle }));
        free(&raw mut held);
        assert!(held.is_null());
        free(&raw mut held);
    }
}
