//! The definitions of the messages, as ROS 2 writes them into its files: the message first, then
//! every type in it.

/// A type of message.
#[derive(Clone, Copy, Debug)]
pub(super) struct Definition {
    /// Its name with its package.
    pub(super) name: &'static str,
    /// Its fields, and those of the types in it.
    pub(super) text: &'static str,
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
