//! The recordings of others, where they are present: see `common` for where they are looked for.

mod ati_files;
mod axia_gravity;
mod certificates;
mod common;
mod fareke;
mod heave;
mod optical_sensor;
