//! Contacts over time.

mod against_batch;
mod consistency;
mod course;
mod events;
mod hostile;
mod jumps;
mod meeting;
mod motion;
mod surfaces;
