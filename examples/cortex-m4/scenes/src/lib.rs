//! Five scenes, from the least that a fingertip may need to everything, in single precision, and a
//! recorded session for each: played on a microcontroller, on a host and in benchmarks.
#![no_std]

mod alone;
/// What `fingertip export --scalar f32` writes of a scene to copy: it has to compile where there is neither a standard
/// library nor a heap.
#[rustfmt::skip]
#[path = "../../../../scene/tests/all/exported/nano17_soft_finger_f32.rs"]
pub mod exported_cylinder;
/// Another one, with a slip detector.
#[rustfmt::skip]
#[path = "../../../../scene/tests/all/exported/paper_sphere_f32.rs"]
pub mod exported_sphere;
mod felt;
mod grips;
mod scene_a;
mod scene_b;
mod scene_c;
mod scene_d;
mod scene_e;
#[rustfmt::skip]
mod session;

use fingertip::friction::ForceNoise;
use fingertip::wrench::{SensorMatrix, Tare, TareAccumulator};
use nalgebra::{SMatrix, SVector, Vector6};

pub use felt::{Felt, Spread, Words, fold};
pub use grips::{FINGERS, GripLoad, Grips, Outcome as GripOutcome};
pub use scene_a::SceneA;
pub use scene_b::SceneB;
pub use scene_c::{Estimate, SceneC};
pub use scene_d::{Assessment, SceneD};
pub use scene_e::{Followed, SceneE};

/// How many samples each session has.
pub const SAMPLES: usize = session::A.len();
/// How many samples at its start are at rest, for the tare.
const AT_REST: usize = 30;
/// Time between samples \[s\].
pub const STEP: f32 = 1e-3;
/// Forces below this are no contact \[N\].
const LEAST_FORCE: f32 = 0.1;
/// The friction coefficient that the scenes assume.
const FRICTION: f32 = 0.6;

/// One reading of `N` gauges \[V\].
pub type Volts<const N: usize> = SVector<f32, N>;

/// A fingertip with all its stages, and what it has to play.
pub trait Scene<const N: usize>: Sized {
    /// Short name.
    const NAME: &'static str;
    /// What it tells of a sample.
    type Answer: Words;

    /// The recorded session: sums of sixteen conversions of 12 bits over 5 V.
    fn session() -> &'static [[u16; N]];

    /// The sensor, as calibrated \[V\].
    fn sensor() -> Option<SensorMatrix<f32, N>>;

    /// Takes the tare from the start of the session and puts the stages together. `None` never
    /// happens: the parameters are constants.
    fn new() -> Option<Self>;

    /// One sample: this is what is timed, counted and weighed.
    fn sense(&mut self, volts: &SVector<f32, N>) -> Self::Answer;

    /// One sample of the session \[V\]. Exact: the sums are integers, a step a power of two times 5.
    fn volts(sums: &[u16; N]) -> SVector<f32, N> {
        SVector::from_fn(|gauge, _| f32::from(sums[gauge]) * (5.0 / 65_536.0))
    }

    /// The tare from the samples at rest.
    fn tare() -> Option<Tare<f32, N>> {
        let mut rest = TareAccumulator::default();
        for sums in Self::session().iter().take(AT_REST) {
            rest.add(&Self::volts(sums));
        }
        rest.finish().ok()
    }
}

/// The noise of the contact force that the detectors reckon with.
fn noise() -> Option<ForceNoise<f32>> {
    ForceNoise::isotropic(0.02).ok()
}

fn sensor<const N: usize>(rows: &[[f32; 6]; N]) -> Option<SensorMatrix<f32, N>> {
    let matrix = SMatrix::from_fn(|gauge, load| rows[gauge][load]);
    SensorMatrix::new(matrix, Vector6::from(session::NOMINAL)).ok()
}
