//! The shape and pose of the fingertip's surface, from touches.

mod cylinder;
mod ellipsoid;
mod pose;
mod touches;

pub use cylinder::{fit_cylinder, fit_cylinder_along};
pub use ellipsoid::{EllipsoidParameters, PosedEllipsoid, fit_aligned_ellipsoid, fit_ellipsoid};
pub use pose::fit_pose;
pub use touches::{
    Fitted, GeometryError, PlaneParameters, Touch, fit_meeting_point, fit_plane, fit_sphere, least_radius,
};
