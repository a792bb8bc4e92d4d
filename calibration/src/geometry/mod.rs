//! The shape and pose of the fingertip's surface, from touches.

mod pose;
mod touches;

pub use pose::fit_pose;
pub use touches::{
    EllipsoidParameters, Fitted, GeometryError, PlaneParameters, Touch, fit_cylinder, fit_ellipsoid,
    fit_meeting_point, fit_plane, fit_sphere, least_radius,
};
