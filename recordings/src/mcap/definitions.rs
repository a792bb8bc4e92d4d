//! The definitions of the messages, as ROS 2 writes them into its files: the message first, then
//! every type in it.

/// A type of message.
///
/// ```
/// use fingertip_recordings::mcap::definitions;
///
/// let [wrench, ..] = definitions();
/// assert_eq!(wrench.name, "geometry_msgs/msg/WrenchStamped");
/// assert!(wrench.text.contains("geometry_msgs/Wrench wrench"));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Definition {
    /// Its name with its package.
    pub name: &'static str,
    /// Its fields, and those of the types in it.
    pub text: &'static str,
}

/// The types of wrench, contact and touch, for what sends the messages of a recording elsewhere.
#[must_use]
pub const fn definitions() -> [Definition; 3] {
    [WRENCH, CONTACT, TOUCH]
}

macro_rules! with_types {
    ($message:literal $(, $name:literal $text:literal)*) => {
        concat!(
            $message,
            $("\n================================================================================\nMSG: ", $name, "\n", $text,)*
        )
    };
}

macro_rules! with_header {
    ($message:literal $(, $name:literal $text:literal)*) => {
        with_types!(
            $message
            $(, $name $text)*,
            "std_msgs/Header" "builtin_interfaces/Time stamp\nstring frame_id\n",
            "builtin_interfaces/Time" "int32 sec\nuint32 nanosec\n"
        )
    };
}

pub(super) const WRENCH: Definition = Definition {
    name: "geometry_msgs/msg/WrenchStamped",
    text: with_header!(
        "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n",
        "geometry_msgs/Wrench" "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n",
        "geometry_msgs/Vector3" "float64 x\nfloat64 y\nfloat64 z\n"
    ),
};

pub(super) const SIGNALS: Definition = Definition {
    name: "fingertip_msgs/msg/Signals",
    text: with_header!("std_msgs/Header header\nstring unit\nfloat64[] values\n"),
};

pub(super) const CONTACT: Definition = Definition {
    name: "tactile_msgs/msg/TactileContact",
    text: with_header!(
        "std_msgs/Header header\nstring name\ngeometry_msgs/Point position\ngeometry_msgs/Vector3 normal\ngeometry_msgs/Wrench wrench\n",
        "geometry_msgs/Point" "float64 x\nfloat64 y\nfloat64 z\n",
        "geometry_msgs/Wrench" "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n",
        "geometry_msgs/Vector3" "float64 x\nfloat64 y\nfloat64 z\n"
    ),
};

/// As `bridges/ros/fingertip_msgs/msg/Touch.msg` has it.
pub(super) const TOUCH: Definition = Definition {
    name: "fingertip_msgs/msg/Touch",
    text: with_header!(
        "std_msgs/Header header\nuint64 number\nfloat64 time\nstring status\ngeometry_msgs/Wrench load\n\
        geometry_msgs/Point point\ngeometry_msgs/Vector3 normal\nfloat64 normal_force\n\
        geometry_msgs/Vector3 tangential_force\nfloat64 spin_torque\nfloat64 margin\nfloat64 utilisation\n\
        uint8 NO_VERDICT=0\nuint8 NOT_PRESSING=1\nuint8 HOLDING=2\nuint8 WARNING=3\nuint8 SLIPPING=4\nuint8 slip\n",
        "geometry_msgs/Point" "float64 x\nfloat64 y\nfloat64 z\n",
        "geometry_msgs/Wrench" "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n",
        "geometry_msgs/Vector3" "float64 x\nfloat64 y\nfloat64 z\n"
    ),
};
