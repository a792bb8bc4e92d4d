//! Soft fingers, skins, and how sure a contact is.

mod common;
mod golden;
mod jacobians;
mod shapes;
mod torus;
mod uncertainty;
