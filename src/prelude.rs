//! What most programs name: `use fingertip::prelude::*;`.
//!
//! ```
//! use fingertip::prelude::*;
//!
//! let ball = Sphere::centred(13e-3)?;
//! let mut tip = Fingertip::builder().contact(ball, PointContact::new(0.1)?).build();
//! let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
//! assert!(tip.sense_wrench(push, 1e-3).resolution.contact().is_some());
//! # Ok::<(), Error>(())
//! ```

pub use fingertip_contact::{Contact, ContactModel, NoContact, PointContact, Resolution, SoftFinger};
#[cfg(feature = "friction")]
pub use fingertip_friction::{
    Coulomb, DropDetector, ForceNoise, FrictionModel, SlipDetector, SlipMargin, SlipVerdict, SoftFingerLimit,
};
pub use fingertip_surfaces::{ActiveSurface, Capsule, Cylinder, Ellipsoid, Plane, Sphere};
pub use fingertip_wrench::{
    ContactForce, GaussianElimination, LeastSquares, Real, SensorMatrix, Tare, TareAccumulator, Wrench,
    WrenchSolver,
};
pub use nalgebra::{SVector, Vector3, Vector6};

#[cfg(feature = "friction")]
pub use crate::TouchSensor;
pub use crate::{Error, Fingertip, GripStage, SlipStage, Step, Touch};
