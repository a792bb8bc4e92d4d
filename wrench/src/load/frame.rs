//! Named coordinate frames, checked by the compiler and free at run time.

use core::fmt::Debug;

/// A right-handed Cartesian frame, as a type.
///
/// A [`Wrench`](crate::Wrench) or a [`RigidTransform`](crate::RigidTransform) carries its frames
/// in its type, so that adding wrenches of different frames, or applying a transform the wrong
/// way round, does not compile.
///
/// ```
/// use fingertip_wrench::Frame;
///
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Palm;
/// impl Frame for Palm {
///     const NAME: &'static str = "palm";
/// }
/// // The palm is 0.1 m behind the sensor, so that a force to the side turns it.
/// use fingertip_wrench::{RigidTransform, Sensor, Wrench};
/// use nalgebra::Vector3;
/// let palm_from_sensor = RigidTransform::<f64, Palm, Sensor>::translation(Vector3::new(0.0, 0.0, 0.1));
/// let at_sensor = Wrench::on_fingertip(Vector3::x(), Vector3::zeros());
/// let at_palm: Wrench<f64, Palm> = at_sensor.expressed_in(&palm_from_sensor);
/// assert_eq!(at_palm.torque(), Vector3::new(0.0, 0.1, 0.0));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no coordinate frame",
    note = "`struct Palm;` with `impl Frame for Palm` and derived `Clone, Copy, Debug, PartialEq` is one"
)]
pub trait Frame: Copy + Debug + PartialEq + 'static {
    /// What reports and errors call the frame.
    const NAME: &'static str;
}

/// The frame of the force/torque sensor: the default of every type that names a frame. Surfaces
/// and contacts are expressed in it.
///
/// ```
/// use fingertip_wrench::{Frame, Sensor, Wrench};
/// use nalgebra::Vector3;
///
/// // A wrench that names no frame is in that of the sensor.
/// let wrench: Wrench<f64> = Wrench::from_force_at(&Vector3::z(), Vector3::x());
/// let same: Wrench<f64, Sensor> = wrench;
/// assert_eq!(same.torque(), Vector3::y()); // z × x
/// assert_eq!(Sensor::NAME, "sensor");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sensor;

impl Frame for Sensor {
    const NAME: &'static str = "sensor";
}
