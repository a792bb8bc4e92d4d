//! Soft fingers, skins, and how sure a contact is.

mod common;
mod compliant;
mod fusion;
mod golden;
mod jacobians;
mod shapes;
mod torus;
mod uncertainty;
