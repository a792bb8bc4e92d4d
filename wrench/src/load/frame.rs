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
/// ```
pub trait Frame: Copy + Debug + PartialEq + 'static {
    /// What reports and errors call the frame.
    const NAME: &'static str;
}

/// The frame of the force/torque sensor: the default of every type that names a frame. Surfaces
/// and contacts are expressed in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sensor;

impl Frame for Sensor {
    const NAME: &'static str = "sensor";
}
