//! Contacts and crossings against 220-bit arithmetic.

mod big;
mod quadrics;
mod superquadric;
mod torus;
