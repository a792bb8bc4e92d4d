//! Every key of a scene file, with its meaning: sections that have no choice, and what every choice of a section shares.

use super::Need::{self, Optional, Required};
use super::{Key, Section};

keys!(KEYS, "Keys of whole sections, section by section.":
"" "": {
    Required "version", "the format, `2`; `1` is read, too";
    Optional "name", "what reports call the scene; the name of the file by default";
}
"input" "": {
    Required "convention", "whose load was recorded: `\"on_fingertip\"`, what the environment does to the fingertip, or `\"reaction\"`, what the fingertip does to the environment. The wrong one puts contacts on the far side";
    Optional "sensor", "prefix of the sensor's columns where a recording holds several (`\"S1\"` for `S1_Fx_N`); `--sensor` overrides it";
    Optional "sample_rate_Hz", "samples per second of a recording that has no column of time; ignored where there is one";
    Optional "rest_s", "the sensor is unloaded for so long at the start: the mean is the tare. Readings that drift, wander or jump meanwhile are warned of, and refused if their forces range over more than a hundred times `least_force_N`; a constant load cannot be told from none. Without it, or with 0, wrenches are taken as they are, and volts are tared with the calibration's zero";
    Optional "header", "`false` for a recording whose first line has numbers already; `[input.columns]` then says by numbers, counted from 1, which column is what: `{ time = 1, fx = 2, fy = 3, fz = -4, … }`";
    Optional "columns", "the section `[input.columns]`";
    Optional "units", "the section `[input.units]`";
}
"input.columns" "": {
    Optional "time", "what the recording calls the time, the components of the wrench, the signals of gauges, the dummy gauge and the temperature. A minus before the name turns the sign round";
    Optional "fx", "force along x";
    Optional "fy", "force along y";
    Optional "fz", "force along z";
    Optional "tx", "torque about x";
    Optional "ty", "torque about y";
    Optional "tz", "torque about z";
    Optional "v1", "signal of the first gauge, and so on to `v16`";
    Optional "dummy", "signal of the gauge that bears no load";
    Optional "temperature_C", "temperature of the sensor";
    Optional "ax", "what an accelerometer reads along x, and so `ay` and `az`: of an `[inertial_unit]`";
    Optional "wx", "what a gyroscope reads about x, and so `wy` and `wz`";
}
"input.units" "": {
    Optional "force", "unit of the forces, `\"N\"` by default";
    Optional "torque", "unit of the torques, `\"Nm\"` by default";
    Optional "time", "unit of the time, `\"s\"` by default";
    Optional "signal", "unit of the signals, `\"V\"` by default";
    Optional "acceleration", "unit of the accelerometer, `\"m/s2\"` by default; `\"g\"` is known, too";
    Optional "angular_velocity", "unit of the gyroscope, `\"rad/s\"` by default; `\"deg/s\"` is known, too";
}
"sensor" "": {
    Optional "calibration", "a file that `fingertip calibrate` wrote, straight or curved, with temperature or without, or an ATI `.cal`; relative to the scene. `--calibration` takes the place of the section";
    Optional "load_per_signal_N_Nm", "in place of a file: six rows, Fx to Tz, of newtons and newton metres per signal of each gauge; six to sixteen gauges";
    Optional "signal_unit", "required with the matrix: `\"V\"`, `\"mV/V\"`, `\"count\"` or `\"strain\"`";
    Optional "zero", "with the matrix: readings without load, 0 by default";
    Optional "range", "with the matrix: least and greatest reading; at or beyond them a gauge is saturated";
    Optional "temperature_C", "of the sensor, where the recording has no column of it and the calibration drifts";
}
"payload" "": {
    Optional "file", "what hangs on the sensor, as `fingertip calibrate --gravity` or `--inertial` writes it; relative to the scene. `--payload` takes the place of the section";
    Optional "mass_kg", "in place of a file: the mass";
    Optional "centre_of_mass_m", "in place of a file: the centre of mass in the sensor's frame, `[0, 0, 0]` by default";
    Optional "inertia_kg_m2", "three rows, about the centre of mass, along the axes of the sensor; that of the file, or 0, by default";
    Optional "gravity_m_per_s2", "in the frame in which orientations are given, `[0, 0, -9.80665]` by default";
}
"inertial_unit" "": {
    Optional "position_m", "where its accelerometer sits, in the sensor's frame; by default as the payload's file has it, or `[0, 0, 0]`";
    Optional "rotation_deg", "how its axes are turned against the sensor's: axis times angle; by default as the payload's file has it, or `[0, 0, 0]`";
    Optional "resting_rate_rad_per_s", "what its gyroscope reads at rest, along its axes; by default as the payload's file has it, or `[0, 0, 0]`";
    Optional "time_constant_s", "of the filter through which wrench and angular velocity go, since no gyroscope tells the angular acceleration; by default as the payload's file has it, or 0.01. What changes slowly comes late by twice as much";
    Optional "delay_s", "so much later than the wrench its readings come, negative if sooner; by default as the payload's file has it, or 0";
}
"filter" "": {
    Required "kind", "which filter: a choice below";
}
"surface" "": {
    Required "shape", "which shape: a choice below. The section may name the link of a robot instead, by `urdf`";
}
"surface" "urdf": {
    Required "urdf", "the description of the robot, relative to the scene; one in xacro is to be expanded first";
    Required "link", "the link that touches: its collision shapes (box, sphere, cylinder, capsule, mesh in `.stl`, `.obj` or `.dae`)";
    Optional "sensor_link", "in whose frame the wrenches are, `link` by default; only fixed joints may lie between. `[pose]` comes on top";
}
"map" "": {
    Optional "centre_m", "where the directions start by which points are drawn flat, in the surface's frame, `[0, 0, 0]` by default";
    Optional "pole", "the middle of the map, `[0, 0, 1]` by default";
}
"pose" "": {
    Optional "translation_m", "`t` of `p_sensor = R p_surface + t`, `[0, 0, 0]` by default";
    Optional "rotation_deg", "`R` of the same, as a rotation vector, axis times angle, `[0, 0, 0]` by default";
}
"contact" "": {
    Optional "model", "what a contact transmits: a choice below, `\"point\"` by default";
    Optional "least_force_N", "smaller forces are no contact, 0 by default; take three to five standard deviations of the force at rest";
    Optional "least_force_deviations", "in place of `least_force_N`: so many standard deviations of the noisiest force component in the rest (`rest_s`), which is measured";
    Optional "greatest_gap_m", "of point and auto: a line of action that misses the surface by no more than this still counts, 0 by default";
    Optional "greatest_friction_ratio", "a force whose tangential part exceeds so many times its normal part is no contact (`beyond_friction`). A point contact has no limit by default; a soft finger has 10, since a line of action that misses has noise along it that looks like a spin torque, which only a contact that next to nothing presses would explain";
    Optional "torque_arm_m", "of soft_finger and auto, with the ratio: by which a spin torque counts as a tangential force, no more than the radius of the patch";
    Optional "spin_noise_Nm", "of soft_finger and auto: a torque along the force of no more than this may be noise, 0 by default; take three standard deviations of the torque at rest. A line of action that misses is `ambiguous` then, with the two places between which the spin torque would choose";
    Optional "greatest_pitch_m", "of auto: a wrench whose torque along the force is more than this times the force is not of one contact";
    Optional "pitch_deviations", "of auto: by so many standard deviations, 3 by default";
    Optional "skin_share", "with a skin: its share of the indentation, between 0 and 1, the object taking the rest; 1 by default";
    Optional "skin", "the section `[contact.skin]`";
}
"contact.skin" "": {
    Required "law", "how the skin gives way: a choice below. Without the section the tip is hard. Of point and soft_finger";
}
"uncertainty" "": {
    Optional "force_noise_N", "standard deviation of a component of the force at rest; without both noises, that of each component is measured in the rest (`rest_s`)";
    Optional "torque_noise_Nm", "standard deviation of a component of the torque at rest";
    Optional "relative", "standard deviation of each component under load, as a share of it; 0 by default";
    Optional "offset_m", "of the surface's height: of a radius, of the shape; 0 by default";
    Optional "position_m", "of the surface's place, in each direction; 0 by default";
    Optional "attitude_deg", "of the surface's attitude, about each axis through its origin; 0 by default";
    Optional "calibration", "`false` leaves out what the fit of the calibration in `[sensor]` leaves uncertain, which otherwise counts where its file tells it; `true` insists on it. The weight of a `[payload]` is not counted";
    Optional "probability", "that the contact lies within the ellipse that is told, 0.95 by default";
}
"tracking" "": {
    Required "speed_m_per_s", "how fast the contact moves over the fingertip, about";
    Required "turns_within_s", "how soon it may turn round, about: the longer, the more samples are averaged, and the later a turn is followed";
    Optional "doubted_share", "the share of samples of the contact itself that are doubted for their noise, 0.001 by default; two in a row that agree are a new contact";
    Optional "least_touch_N", "the smallest force that is a touch; with it, touch, release and blow are told";
    Optional "samples_per_false_event", "so many samples lie between two false events, or more, in the mean; 1e6 by default";
    Optional "longest_impact_s", "so soon the force of a blow falls to half its peak, or it is a press, 0.05 by default";
}
"friction" "": {
    Optional "limit", "how much friction holds: a choice below, `\"coulomb\"` by default";
}
"slip" "": {
    Required "detector", "how slip is found: a choice below";
}
"fusion" "": {
    Optional "places", "how many places the array has, 1 to 4; 2 by default";
    Required "position_deviation_m", "standard deviation of a centroid along the surface";
    Required "normal_deviation_N", "standard deviation of a normal force";
    Optional "relative_deviation", "of a normal force under load, as a share of it; 0 by default";
    Optional "static_coefficient", "what holds tangential forces; that of `[friction]` by default";
}
"estimate" "": {
    Required "noise_N", "standard deviation of a force component at rest";
    Optional "scatter", "relative: how peaks of one surface scatter, 0.05 by default";
    Optional "wander", "relative: how much the surface may change from one slip to the next, 0.01 by default";
    Optional "memory_s", "over so long a slide is averaged, 0.1 s by default";
    Optional "slide_s", "for so long after a slip begins the tip is taken to slide, 0.05 s by default";
}
"grip" "": {
    Optional "safety", "factor on the least force that friction needs, 1.5 by default";
    Required "least_N", "the normal force to command stays above this";
    Required "greatest_N", "and below this";
    Required "rise_N_per_s", "it grows no faster";
    Required "fall_N_per_s", "it falls no faster";
    Optional "slip_boost", "factor on the command at each slip, 1.25 by default";
}
);

/// What each section is for.
pub(super) const SECTIONS: &[Section] = &[
    section("", Required, "above all sections"),
    section("input", Required, "what was recorded, and by whom"),
    section("input.columns", Optional, "for recordings whose columns have names of their own"),
    section("input.units", Optional, "the units of those columns"),
    section(
        "sensor",
        Optional,
        "for readings of gauges (columns `v1_V` and so on): what turns them into wrenches",
    ),
    section(
        "payload",
        Optional,
        "what hangs on the sensor and is no contact; the recording must tell how the sensor lies, in columns `qx`, `qy`, `qz`, `qw`, or how it moves: `[inertial_unit]`",
    ),
    section(
        "inertial_unit",
        Optional,
        "an accelerometer and a gyroscope on the sensor, in columns such as `ax_m_per_s2`, `wx_rad_per_s`: by their readings weight and inertia of the `[payload]` are taken off in motion. May be empty where the payload's file has it all",
    ),
    section(
        "filter",
        Optional,
        "of the wrench, before the contact is looked for; needs `sample_rate_Hz`. It makes contacts late by what `fingertip scene check` says",
    ),
    section("surface", Required, "the shape of the fingertip, in a frame of its own"),
    section("pose", Optional, "how the surface's frame lies in the sensor frame"),
    section(
        "map",
        Optional,
        "how points of the surface are drawn flat, for shapes other than plane, sphere and cylinder: by their direction from a centre, in an equal-area projection around a pole. Of a concave shape points that lie behind one another fall together",
    ),
    section("contact", Optional, "what a contact transmits, and from which force on it is one"),
    section("contact.skin", Optional, "a compliant skin over the shape"),
    section(
        "uncertainty",
        Optional,
        "how sure each contact is, by standard deviations. Without it, nothing is said of that",
    ),
    section(
        "tracking",
        Optional,
        "follows the contact over time; needs `[uncertainty]`, whose noise says how much a sample counts. Without it, nothing is carried from sample to sample but the last contact. The point is that of the undeformed surface. What is uncertain of the geometry is the same in each sample, so it is not averaged",
    ),
    section("friction", Optional, "how much friction holds. Without it, no margin is given"),
    section("slip", Optional, "finds slip. Without it, slip is not looked for"),
    section(
        "fusion",
        Optional,
        "joins a tactile array in the skin with the wrench, so that up to four contacts are told at once; needs `[uncertainty]`, whose noise says how much the wrench counts. A recording has four columns for each place of the array: `array1_x_m`, `array1_y_m`, `array1_z_m` (the centroid of the pressure, in the sensor frame) and `array1_normal_N`, then `array2_...`; a place with 0 N is not pressed",
    ),
    section("estimate", Optional, "learns the friction from slips; needs `[slip]`"),
    section("grip", Optional, "the normal force to command; needs `[friction]`"),
];

const fn section(name: &'static str, need: Need, says: &'static str) -> Section {
    Section { name, need, says }
}
