//! The shape and pose of the fingertip's surface, from touches.

mod cylinder;
mod ellipsoid;
mod error;
mod fitted;
mod noise;
mod pivots;
mod pose;
mod torques;
mod touches;

pub use cylinder::{fit_cylinder, fit_cylinder_along};
pub use ellipsoid::{EllipsoidParameters, PosedEllipsoid, fit_aligned_ellipsoid, fit_ellipsoid};
pub use error::GeometryError;
pub use fitted::Fitted;
pub use noise::WrenchNoise;
pub use pivots::{PlaneParameters, fit_meeting_point, fit_plane};
pub use pose::fit_pose;
pub use touches::{ShapeTouch, fit_sphere, least_radius};
