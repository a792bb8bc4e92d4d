//! Converters against simulators of their chips and against scripted transactions.
#![cfg(all(
    feature = "ads131m",
    feature = "ads1256",
    feature = "hx711",
    feature = "mcp3564",
    feature = "nau7802",
    feature = "simulators"
))]

mod ads1256;
mod ads131m;
mod hx711;
mod mcp3564;
mod nau7802;

use core::future::Future;
use core::pin::pin;
use core::task::{Context, Poll, Waker};

/// Runs a future that wakes itself.
fn block_on<F: Future>(future: F) -> F::Output {
    let mut future = pin!(future);
    loop {
        if let Poll::Ready(output) = future.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            return output;
        }
    }
}
