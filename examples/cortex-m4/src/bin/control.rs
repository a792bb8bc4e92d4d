//! A routine that can panic, and says with what: the tests for symbols must find that, or they
//! would find nothing.
#![no_std]
#![no_main]

#[panic_handler]
fn on_panic(info: &core::panic::PanicInfo<'_>) -> ! {
    let mut sink = Sink;
    let _ = core::fmt::write(&mut sink, format_args!("{info}"));
    loop {}
}

struct Sink;

impl core::fmt::Write for Sink {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        core::hint::black_box(text);
        Ok(())
    }
}

/// Divides in double precision and by an integer, and may go past the end.
#[unsafe(no_mangle)]
pub extern "C" fn scene(values: &[f64; 4], at: usize, divisor: u64) -> f64 {
    let index = (at as u64 / divisor) as usize;
    values[index] / values[0]
}
