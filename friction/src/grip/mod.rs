//! How hard to grip.

mod controller;

pub use controller::{GripController, GripSettings};
