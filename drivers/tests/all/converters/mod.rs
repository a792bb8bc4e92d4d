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

use fingertip_test_support::block_on;
