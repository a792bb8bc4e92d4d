/*
 * fingertip: from the readings of a small force/torque sensor behind a fingertip to touch.
 *
 * Written by cbindgen from the package fingertip-c; do not edit. fingertip.hpp wraps it for C++17.
 *
 * Units are SI: N, N.m, m, rad, s. A wrench is the load that the environment applies to the fingertip; normals point out
 * of the fingertip; points and forces are in the sensor frame. CONVENTIONS.md of the project says more.
 *
 * Pointers: one that is not NULL points to as much memory as the call says, and texts end with a zero. NULL where it is
 * not allowed is FT_NULL. Structures belong to the caller; they may hold any numbers. A handle comes from this library,
 * which alone knows what is in it, and is freed through the variable that holds it, which is then NULL.
 *
 * Threads: there is no global state. A handle may be used by any thread, by one at a time; different handles by as many
 * at once as one likes. A `const` handle counts as used, too.
 *
 * Failures: every call that can fail returns an ft_status; if it is not FT_OK, nothing was written. The sentence is in
 * the ft_error that the caller hands over, or, of calls of a handle, in ft_tip_message and ft_hand_message. A sample that
 * is no contact is no failure. Nothing here throws, aborts or prints, but for what Rust writes to the standard error when
 * a fault of this library is caught (FT_INTERNAL).
 *
 * Time: calls that take a sample allocate nothing and do bounded work.
 */

#ifndef FINGERTIP_H
#define FINGERTIP_H

#include <stddef.h>
#include <stdint.h>

// Most fingers of a hand.
#define FT_MAX_FINGERS 6

// Most places of a tactile array that are told apart.
#define FT_MAX_PLACES 4

// Most joints of a finger.
#define FT_MAX_JOINTS 6

// Bytes of a message, its closing zero included.
#define FT_MESSAGE_BYTES 512

// The version of the layout of all structures and of what functions take: a program that was compiled with another
// one does not fit the library.
#define FT_ABI_VERSION 1

// How a call ended. Everything but FT_OK leaves what the call was to write as it was.
enum ft_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // It did what it says.
    FT_OK = 0,
    // A pointer is NULL that must not be.
    FT_NULL = 1,
    // A text is not UTF-8.
    FT_NOT_TEXT = 2,
    // A file cannot be read.
    FT_UNREADABLE = 3,
    // A scene is not as it must be: the message names the line, the key and the mend.
    FT_BAD_SCENE = 4,
    // A number is none, or out of its range.
    FT_BAD_NUMBER = 5,
    // More or fewer numbers than are taken.
    FT_WRONG_SIZE = 6,
    // A gauge reads at or beyond the range that its calibration states. The sample is left out.
    FT_SATURATED = 7,
    // A number of the reading is not finite, or the temperature or the dummy gauge is missing. The sample is left out.
    FT_INCOMPLETE = 8,
    // The scene has no [sensor] that turns readings into wrenches: use ft_sense_wrench.
    FT_NO_SENSOR = 9,
    // The scene has a [payload], and how the sensor moves was not told.
    FT_NO_MOTION = 10,
    // There was no rest, or too short a one.
    FT_NO_REST = 11,
    // Columns overlap that must not.
    FT_OVERLAP = 12,
    // The rest may have been none: the sensor moved or was touched.
    FT_DOUBTFUL = 13,
    // The reading lies beyond what the curved sensor was calibrated for. The sample is left out.
    FT_UNCALIBRATED = 14,
    // A fault of this library. The handle can be freed; what it would say is not to be trusted.
    FT_INTERNAL = 15,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum ft_status ft_status;
#else
typedef uint32_t ft_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How a sample fits to the track before it.
enum ft_continuity
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Another contact than before, or the first: what was known of the old one is forgotten.
    FT_TRACK_NEW = 0,
    // The same contact, a little farther.
    FT_TRACK_FOLLOWED = 1,
    // Too far away for the same contact: a sample gone wrong, or, if the next one is there too, a new contact.
    FT_TRACK_DOUBTED = 2,
    // No contact was seen, but the track still knows where it would be.
    FT_TRACK_BRIDGED = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum ft_continuity ft_continuity;
#else
typedef uint32_t ft_continuity;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Whether a sample is a contact, and if not, why not.
enum ft_resolution
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // It is a contact.
    FT_CONTACT = 0,
    // A number of the wrench is NaN or infinite.
    FT_NOT_FINITE = 1,
    // The force is smaller than the least one of the scene; or the scene waits for a rest to know it.
    FT_BELOW_THRESHOLD = 2,
    // The line of the force passes the surface by.
    FT_MISSES = 3,
    // The force would pull the fingertip where its line meets it.
    FT_ONLY_PULLING = 4,
    // The force presses at so flat an angle that friction could not hold it.
    FT_BEYOND_FRICTION = 5,
    // The force presses on a part of the shape that is not the active surface.
    FT_OUTSIDE_ACTIVE_REGION = 6,
    // There is a torque but no force.
    FT_PURE_COUPLE = 7,
    // Two grazing contacts explain the wrench.
    FT_AMBIGUOUS = 8,
    // The search ended at its bound without an answer.
    FT_UNRESOLVED = 9,
    // No single contact gives such a wrench.
    FT_NOT_ONE_CONTACT = 10,
    // A reason that this version of the interface has no name for.
    FT_OTHER_REASON = 11,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum ft_resolution ft_resolution;
#else
typedef uint32_t ft_resolution;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What the slip detector says.
enum ft_slip
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The normal force is too small to tell, or the scene has no detector.
    FT_NOT_PRESSING = 0,
    // The contact holds, as far as the detector sees.
    FT_HOLDING = 1,
    // Slip is near.
    FT_WARNING = 2,
    // The contact slips.
    FT_SLIPPING = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum ft_slip ft_slip;
#else
typedef uint32_t ft_slip;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What commands rest on.
enum ft_hand_state
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The least grip for the load, with the factor of safety.
    FT_HAND_HOLDING = 0,
    // No forces within friction and limits hold the load, even without the factor of safety. The commands are those of before.
    FT_HAND_CANNOT_HOLD = 1,
    // A number is not finite, no plausible contact is left, or no answer was found. The commands are those of before.
    FT_HAND_BLIND = 2,
    // A finger feels what cannot be, so that what the others are to bear is not known, and no load was given. The commands
    // are those of before.
    FT_HAND_DOUBTFUL = 3,
    // The load can be held, but not with the factor of safety: the least grip without it, squeezed more as far as limits allow.
    FT_HAND_WITHOUT_SAFETY = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum ft_hand_state ft_hand_state;
#else
typedef uint32_t ft_hand_state;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What there is of a reach.
enum ft_reach_state
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // So many times the disturbance, and no more.
    FT_REACH_TIMES = 0,
    // As much as one likes: no limit of a finger matters.
    FT_REACH_UNLIMITED = 1,
    // Neither the load alone nor any multiple of the disturbance beside it can be held.
    FT_REACH_NOT_HELD = 2,
    // A number is not finite, a finger feels what cannot be and no load was given, or it could not be told.
    FT_REACH_UNKNOWN = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum ft_reach_state ft_reach_state;
#else
typedef uint32_t ft_reach_state;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A hand: what it commanded last, what slip has taught it, and what it has learnt of the object. Made by ft_hand_create,
// freed by ft_hand_free.
typedef struct ft_hand ft_hand;

// A fingertip: a scene that runs. Made by ft_tip_from_scene and its like, freed by ft_tip_free.
typedef struct ft_tip ft_tip;

// A ball on a force/torque sensor, in numbers: what most fingertips are. Everything else takes a scene. The names are
// those of the keys of a scene. ft_ball_defaults has values to begin with.
typedef struct ft_ball {
    // Radius in m.
    double radius_m;
    // Centre in the sensor frame, in m.
    double centre_m[3];
    // 0 if the sensor reports the load on the fingertip, 1 if it reports the load on what the fingertip touches.
    uint32_t reaction;
    // 0 for a point contact, 1 for a soft finger, which bears a spin torque.
    uint32_t soft_finger;
    // Smaller forces are no contact, in N.
    double least_force_n;
    // Friction coefficient; 0 for none.
    double static_coefficient;
    // Of a soft finger with friction: its greatest spin torque over its greatest tangential force, in m.
    double torque_arm_m;
    // Six rows of `gauges` numbers, one behind the other: Fx, Fy, Fz in N and Tx, Ty, Tz in N·m for a signal of 1. NULL
    // for a sensor that reports wrenches.
    const double *load_per_signal;
    // How many gauges there are, from 6 to 16; 0 for a sensor that reports wrenches.
    size_t gauges;
} ft_ball;

// Why a call failed. The caller owns it.
typedef struct ft_error {
    // What kind of failure.
    ft_status status;
    // A sentence that names what the caller wrote and how to mend it: UTF-8, closed by a zero, shortened to fit.
    char message[FT_MESSAGE_BYTES];
} ft_error;

// What the last sample says beside its touch. Each group counts only where its flag is 1, and is zero else.
typedef struct ft_beside {
    // With [uncertainty], where it can be said: ellipse and the deviations.
    uint32_t has_spread;
    // With [tracking], where a contact is followed.
    uint32_t has_tracked;
    // With [tracking] that has a least_touch_N.
    uint32_t has_touching;
    // 1 while something touches, by all samples so far.
    uint32_t touching;
    // At the sample at which a touch is called.
    uint32_t has_touch;
    // At the sample at which a release is called.
    uint32_t has_release;
    // At the sample at which a blow is over.
    uint32_t has_impact;
    // With a friction that is known with a deviation.
    uint32_t has_slip_probability;
    // While a stick-slip motion goes on that the scene looks for.
    uint32_t has_stick_slip;
    // With [estimate], behind the first slip.
    uint32_t has_static_friction;
    // With [estimate], behind the first slide.
    uint32_t has_kinetic_friction;
    // With [grip].
    uint32_t has_grip_force;
    // How the sample fits to the track.
    ft_continuity continuity;
    // Zero.
    uint32_t reserved;
    // Semi-axes of the ellipse in which the contact lies, the longer first, in m.
    double ellipse_semi_axes[2];
    // Unit vectors along them.
    double ellipse_directions[2][3];
    // Standard deviation of the normal force in N.
    double normal_force_deviation;
    // Standard deviation of the spin torque in N·m.
    double spin_torque_deviation;
    // Where the contact is by all samples so far, in m.
    double tracked_point[3];
    // Outward unit normal there.
    double tracked_normal[3];
    // How fast it moves over the fingertip, in m/s.
    double tracked_velocity[3];
    // Two unit vectors in the tangent plane there, to which the next four refer.
    double tracked_tangents[2][3];
    // Covariance of the position in m².
    double tracked_position_covariance[2][2];
    // Covariance of the velocity in m²/s².
    double tracked_velocity_covariance[2][2];
    // From where the contact was expected to where the sample saw it, along the tangents of the sample before, in m.
    double tracked_innovation[2];
    // The same squared over its variance: chi squared of two degrees of freedom while the contact moves as the scene says.
    double tracked_surprise;
    // How long ago the touch that is called showed first, in s.
    double touch_age;
    // How long ago the release that is called showed first, in s.
    double release_age;
    // Greatest force of the blow, in N.
    double impact_peak;
    // Its force summed over its time, on the fingertip, in N·s.
    double impact_impulse[3];
    // From its first sign to where the force was least behind its peak, in s.
    double impact_duration;
    // The probability that the contact slips.
    double slip_probability;
    // Mean time between the drops of the stick-slip motion, in s.
    double stick_slip_period;
    // The static friction coefficient as it was learnt.
    double static_friction;
    // Its standard deviation.
    double static_friction_deviation;
    // The kinetic friction coefficient as it was learnt.
    double kinetic_friction;
    // Its standard deviation.
    double kinetic_friction_deviation;
    // The normal force to command next, in N.
    double grip_force;
} ft_beside;

// Columns of wrenches as the sensor reports them: forces in N, torques in N·m.
typedef struct ft_wrench_columns {
    // Force along x.
    const double *fx;
    // Force along y.
    const double *fy;
    // Force along z.
    const double *fz;
    // Torque about x.
    const double *tx;
    // Torque about y.
    const double *ty;
    // Torque about z.
    const double *tz;
} ft_wrench_columns;

// Where touches are written. A column that is NULL is left out.
typedef struct ft_touch_columns {
    // Where the environment touches, along x, in m; zero without contact, as all that follows.
    double *point_x;
    // The same along y.
    double *point_y;
    // The same along z.
    double *point_z;
    // Normal force in N.
    double *normal_force;
    // Tangential force on the fingertip along x, in N.
    double *tangential_x;
    // The same along y.
    double *tangential_y;
    // The same along z.
    double *tangential_z;
    // Distance to the friction limit in N; zero without friction.
    double *margin;
    // How much of the friction limit is used; zero without friction.
    double *utilisation;
    // What the slip detector says, a byte each: the numbers of ft_slip.
    uint8_t *slip;
} ft_touch_columns;

// A force and a torque about the origin of the sensor frame.
typedef struct ft_wrench {
    // Newton.
    double force[3];
    // Newton metre.
    double torque[3];
} ft_wrench;

// What a sample says: the contact on the fingertip, in the sensor frame. Without a contact all but the wrench,
// the resolution and the verdict is zero.
typedef struct ft_touch {
    // Contact, or why none.
    ft_resolution resolution;
    // What the slip detector says.
    ft_slip slip;
    // 1 if the scene has friction and there is a contact, so that margin and utilisation are known; 0 else.
    uint32_t has_margin;
    // How many other points of the surface would explain the wrench as well.
    uint32_t alternatives;
    // 1 if contacts were searched for, and the surface says too little of itself to know that none was missed; 0 else.
    uint32_t searched;
    // Zero.
    uint32_t reserved;
    // The load that the environment applies to the fingertip, without zero and payload.
    struct ft_wrench wrench;
    // Where the environment touches, in m.
    double point[3];
    // Outward unit normal of the fingertip there.
    double normal[3];
    // Normal force in N, positive when pressing.
    double normal_force;
    // Tangential force on the fingertip, in N.
    double tangential_force[3];
    // Spin torque on the fingertip about the outward normal, in N·m; zero for a point contact.
    double spin_torque;
    // Distance between the line of the force and the point, in m: zero unless the scene accepts a gap.
    double gap;
    // Distance to the friction limit in N, positive while the contact holds.
    double margin;
    // How much of the friction limit is used: 0 without tangential load, 1 at slip.
    double utilisation;
} ft_touch;

// How the sensor of a finger lies in the frame of the hand: where a point of the sensor frame is there.
typedef struct ft_pose {
    // Rows of the rotation: its columns are the axes of the sensor frame in that of the hand.
    double rotation[3][3];
    // The origin of the sensor frame in that of the hand, in m.
    double origin[3];
} ft_pose;

// What a finger feels, in the frame of the hand. All zero is a finger that touches nothing.
typedef struct ft_finger {
    // 0 if it touches nothing or is to be left out, 1 if it touches. 2 if it feels a force that no contact explains: what it
    // bears is not known then, and the rest below is not looked at.
    uint32_t touching;
    // What its slip detector says: a number of ft_slip.
    uint32_t slip;
    // Where it touches, in m.
    double point[3];
    // Outward normal of the fingertip there, into the object, of any length.
    double normal[3];
    // Friction coefficient: better a low quantile than the mean.
    double friction;
    // Of a soft finger: greatest spin torque over greatest tangential force, in m; 0 for a point contact.
    double torque_arm;
    // Normal force in N, positive when pressing.
    double normal_force;
    // Tangential force on the fingertip, in N.
    double tangential_force[3];
    // Spin torque on the fingertip about the outward normal, in N·m.
    double spin_torque;
} ft_finger;

// How far a contact is from slipping.
typedef struct ft_margin {
    // Distance to the friction limit in N, positive while the contact holds; zero of a finger that is left out.
    double newtons;
    // How much of the limit is used: 0 without tangential load, 1 at slip.
    double utilisation;
} ft_margin;

// What one place of a tactile array reads.
typedef struct ft_array_reading {
    // Centroid of the pressure in the sensor frame, in m.
    double centroid[3];
    // Sum of the pressure, in N.
    double normal_force;
} ft_array_reading;

// One contact of those that wrench and array tell together.
typedef struct ft_fused_contact {
    // Where, on the surface, in m.
    double point[3];
    // Outward unit normal there.
    double normal[3];
    // Force on the fingertip, in N.
    double force[3];
    // Covariance of the point in m2, row by row.
    double point_covariance[3][3];
    // Covariance of the force in N2, row by row.
    double force_covariance[3][3];
    // How much of the variance of the force the wrench removed: 1, nearly all is known from it; 0, nothing.
    double share_from_wrench;
    // 0 while friction holds more than is asked, 1 where it slides, 2 where it carries nothing.
    uint32_t grip;
    // Zero.
    uint32_t reserved;
} ft_fused_contact;

// What wrench and array say together.
typedef struct ft_fused {
    // How many contacts there are: one for each reading.
    uint32_t count;
    // Dimension of the forces that the wrench cannot see, since they cancel.
    uint32_t internal_forces;
    // 1 if the estimate came to rest.
    uint32_t settled;
    // Zero.
    uint32_t reserved;
    // How far the wrench is from what the array alone predicts: follows chi-squared with six degrees of freedom if all is
    // right. Much more, and a contact is missing.
    double disagreement;
    // The contacts in the order of the readings, zero behind the last.
    struct ft_fused_contact contacts[FT_MAX_PLACES];
} ft_fused;

// The least normal forces that hold a load within friction and limits.
typedef struct ft_grip {
    // Whether there are such forces.
    ft_hand_state state;
    // Zero.
    uint32_t reserved;
    // Normal force of each finger in N.
    double normal_force[FT_MAX_FINGERS];
    // Tangential force on each fingertip in N.
    double tangential_force[FT_MAX_FINGERS][3];
    // Spin torque on each fingertip in N·m.
    double spin_torque[FT_MAX_FINGERS];
    // The sum of cost times normal force, in N.
    double cost;
    // No forces that hold cost less, in N: how far `cost` can be off.
    double least_cost;
    // With FT_HAND_CANNOT_HOLD, the velocity by which the object will go, as in ft_hand_order.
    double velocity[3];
    // Its angular velocity, in rad/s.
    double turning[3];
} ft_grip;

// Limits and habits of a hand. ft_hand_settings_defaults has values to begin with.
typedef struct ft_hand_settings {
    // Factor of safety on friction, at least 1.
    double safety;
    // How fast a normal force may rise, in N/s.
    double rise;
    // How fast it may fall, in N/s.
    double fall;
    // By what a finger's friction coefficient is multiplied when it slips, between 0 and 1.
    double at_slip;
    // Below what friction coefficient it is never taken, however often it slips.
    double least_friction;
    // A contact that asks for a greater friction ratio is implausible, and its force is not used.
    double greatest_ratio;
    // With what rate the factor that slips have taught goes back to one, in 1/s; 0 for never.
    double recovery;
    // Standard deviation of a component of the contact force, in N, with which each finger learns its friction at slips;
    // 0 for none that learns. What is learnt is relied on in place of the coefficient of the finger.
    double friction_noise;
    // How break-away scatters on one surface, as a share; where friction is learnt.
    double friction_scatter;
    // With what probability the friction may be less than what is relied on; where it is learnt.
    double friction_probability;
} ft_hand_settings;

// What a finger can give. All zero is a finger that can give any force.
typedef struct ft_finger_limits {
    // Least normal force in N while it touches; 0 for none.
    double least_normal_force;
    // Greatest normal force in N; 0 for none.
    double greatest_normal_force;
    // What a newton of it costs, next to the other fingers; 0 counts as 1.
    double cost;
} ft_finger_limits;

// Normal forces to command.
typedef struct ft_hand_order {
    // What they rest on.
    ft_hand_state state;
    // Bit i is 1 if finger i was not believed.
    uint32_t implausible;
    // For each finger, in N; zero of fingers that the hand has not.
    double normal_force[FT_MAX_FINGERS];
    // Friction coefficient of each finger as slips have taught it; zero before the first slip, and where none is learnt.
    double friction[FT_MAX_FINGERS];
    // Its standard deviation.
    double friction_deviation[FT_MAX_FINGERS];
    // With FT_HAND_CANNOT_HOLD, the motion by which the object will go, of which the direction alone has a meaning: its
    // velocity at the origin of the hand's frame, in m/s.
    double velocity[3];
    // Its angular velocity, in rad/s.
    double turning[3];
} ft_hand_order;

// How the sensor moves, in the sensor frame.
typedef struct ft_motion {
    // Gravity less the acceleration of the sensor's origin, in m/s².
    double gravity[3];
    // Radian per second.
    double angular_velocity[3];
    // Radian per second squared.
    double angular_acceleration[3];
} ft_motion;

// A reading of the gauges, and what was measured beside them. ft_reading_of makes one of gauges alone.
typedef struct ft_reading {
    // The gauges, in the unit of the calibration.
    const double *gauges;
    // How many there are.
    size_t count;
    // A gauge that no load strains, which shows what drifts with all of them; NaN if there is none.
    double dummy;
    // Temperature of the sensor in degrees Celsius; NaN if it is not known.
    double celsius;
    // How the sensor moves, which a scene with a [payload] needs; NULL if it is not known.
    const struct ft_motion *motion;
} ft_reading;

// A wrench, and how sure it is: both about the origin of the hand's frame.
typedef struct ft_uncertain_wrench {
    // The wrench.
    struct ft_wrench wrench;
    // Its covariance, force before torque, in N², N·N·m and N²·m²: symmetric and positive definite.
    double covariance[6][6];
} ft_uncertain_wrench;

// What is known of the object that a hand holds.
typedef struct ft_object {
    // 1 if the mass is known.
    uint32_t has_mass;
    // 1 if the centre of mass is known, too, which takes two orientations.
    uint32_t has_centre;
    // In kg.
    double mass;
    // Its standard deviation in kg.
    double mass_deviation;
    // In the frame of the hand, in m.
    double centre[3];
    // Its covariance in m².
    double centre_covariance[3][3];
} ft_object;

// What else touches the object, such as a table or another hand.
typedef struct ft_other {
    // 1 if the weight is known, so that the rest below says something.
    uint32_t is_known;
    // 1 if something touches: that is said in error no more often than was asked for.
    uint32_t touches;
    // 1 if the wrench has a line along which its force acts.
    uint32_t has_line;
    // Zero.
    uint32_t reserved;
    // What they do to the object.
    struct ft_uncertain_wrench load;
    // Chi-square with six degrees of freedom if nothing touches.
    double statistic;
    // The point of the line next to the origin of the hand's frame, in m.
    double point[3];
    // Its direction, of length one.
    double direction[3];
    // Torque along the line over force, in m: zero of one contact without friction torque, which lies on the line.
    double pitch;
} ft_other;

// How good a grasp is, whatever its load.
typedef struct ft_quality {
    // In how many directions the contacts hold the object: 6 if in all.
    uint32_t rank;
    // 1 if any wrench can be borne by pressing hard enough, 0 if not, 2 if it could not be told.
    uint32_t force_closure;
    // The radius in N of the ball of wrenches that 1 N bears (Ferrari & Canny) is at least this: certified.
    double certified;
    // It is at most this, which a search found.
    double found;
    // The load of that size that is borne least: of unit length in the metric.
    struct ft_wrench weakest;
    // The 6 - rank motions that no contact resists, of which the direction alone has a meaning: velocities at the origin of
    // the hand's frame in m/s.
    double freedom_velocity[6][3];
    // Their angular velocities in rad/s.
    double freedom_turning[6][3];
} ft_quality;

// How far a load can grow before no forces hold it.
typedef struct ft_reach {
    // What there is of it.
    ft_reach_state state;
    // Zero.
    uint32_t reserved;
    // How many times the disturbance can be borne beside the load, with FT_REACH_TIMES.
    double times;
} ft_reach;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// A ball of 10 mm around the origin of a sensor that reports the load on the fingertip: point contact, from 0.1 N on,
// without friction.
struct ft_ball ft_ball_defaults(void);

// Makes a fingertip of numbers. As to `error`, see ft_tip_from_scene.
ft_status ft_tip_from_ball(const struct ft_ball *ball, struct ft_tip **tip, struct ft_error *error);

// What the last sample says beside its touch. Allocates nothing.
ft_status ft_beside_last(struct ft_tip *tip, struct ft_beside *beside);

// As ft_sense_wrench of `count` wrenches, one behind the other in time, `time_step` seconds apart. Allocates nothing.
//
// No column of the touches may overlap with another one; it may lie where a column of the wrenches does, from the same
// start on. Scenes of a point contact with Coulomb friction and the threshold detector run in vectors.
ft_status ft_sense_all(struct ft_tip *tip,
                       const struct ft_wrench_columns *wrenches,
                       size_t count,
                       double time_step,
                       const struct ft_touch_columns *touches);

// Makes a fingertip of the text of a scene (book/src/reference/scene.md has its keys). Files that it names are looked for
// in the working directory.
//
// `error` may be NULL. It tells why there is no fingertip, and of one that was made, with FT_OK, what in the scene can
// be and is hardly meant, such as a radius of 13 m; the message is empty if nothing is.
ft_status ft_tip_from_scene(const char *scene,
                            struct ft_tip **tip,
                            struct ft_error *error);

// Makes a fingertip of a scene in a file. Files that it names are looked for beside it. `calibration` is the path of
// a calibration to take in the place of the scene's [sensor], or NULL. As to `error`, see ft_tip_from_scene.
ft_status ft_tip_from_file(const char *scene,
                           const char *calibration,
                           struct ft_tip **tip,
                           struct ft_error *error);

// What a status means, in a sentence. Any number may be given, such as one that was stored.
const char *ft_status_text(uint32_t status);

// A finger of a touch, moved into the frame of the hand; the friction coefficient and, for a soft finger, the torque
// arm in m (0 for a point contact) are the caller's. A force below the threshold makes a finger that touches nothing, any
// other that is no contact one whose `touching` is 2. `error` may be NULL.
ft_status ft_finger_from_touch(const struct ft_touch *touch,
                               const struct ft_pose *hand_from_sensor,
                               double friction,
                               double torque_arm,
                               struct ft_finger *finger,
                               struct ft_error *error);

// What the contacts of the fingers feel together: what the object loads them with, its weight among it, if none of them is
// wrong. About the origin of the frame of the hand. `error` may be NULL.
ft_status ft_object_wrench(const struct ft_finger *fingers,
                           size_t count,
                           struct ft_wrench *wrench,
                           struct ft_error *error);

// How far each finger is from slipping: `margins` has room for `count` of them. `error` may be NULL.
ft_status ft_slip_margins(const struct ft_finger *fingers,
                          size_t count,
                          struct ft_margin *margins,
                          struct ft_error *error);

// The contacts that the wrench of the last sample and the readings of a tactile array tell together, of a scene with
// [fusion]: one for each reading, one to FT_MAX_PLACES. Nothing of it is carried to the next sample. Allocates nothing.
//
// FT_BAD_SCENE for a scene without [fusion], FT_NO_REST while it waits for the noise of a rest, FT_WRONG_SIZE for none or
// too many readings, FT_BAD_NUMBER for one that is not finite or not near the surface.
ft_status ft_fuse(struct ft_tip *tip,
                  const struct ft_array_reading *readings,
                  size_t count,
                  struct ft_fused *fused);

// The least grip for the fingers as they are given: without the hand's safety and without what slip has taught, and
// no command changes. `load` as in ft_hand_command. Allocates nothing. That no forces hold is FT_OK, and a state.
ft_status ft_hand_least_grip(struct ft_hand *hand,
                             const struct ft_finger *fingers,
                             size_t count,
                             const struct ft_wrench *load,
                             struct ft_grip *grip);

// A safety of 1.3, 200 N/s up and 2 N/s down, friction taken as 0.8 times as large at each slip and never below 0.1,
// without recovery, and no contact beyond a friction ratio of 3. No friction is learnt; where it is, with a scatter of 0.05
// and so that one slip in a hundred has less.
struct ft_hand_settings ft_hand_settings_defaults(void);

// Makes a hand of 1 to FT_MAX_FINGERS fingers; it begins with the least normal forces of their limits. `limits` has
// `count` of them, or is NULL for none; `error` may be NULL.
ft_status ft_hand_create(const struct ft_hand_settings *settings,
                         const struct ft_finger_limits *limits,
                         size_t count,
                         struct ft_hand **hand,
                         struct ft_error *error);

// Frees a hand and sets the variable that held it to NULL: to do so twice does no harm. NULL is left.
void ft_hand_free(struct ft_hand **hand);

// Why the last call of this hand failed that did; as ft_tip_message.
const char *ft_hand_message(const struct ft_hand *hand);

// The normal forces to command for the next sample, which rise at once when a finger slips. `load` is what the object
// loads the fingers with, where that is known without them, as from its mass or a sensor in the wrist: a finger that feels
// what cannot be is left out then. NULL for what the fingers feel: while one feels what cannot be, commands stay. `time_step` is the time since the call before,
// in s. Allocates nothing. That no forces hold is FT_OK, and a state of the order.
ft_status ft_hand_command(struct ft_hand *hand,
                          const struct ft_finger *fingers,
                          size_t count,
                          const struct ft_wrench *load,
                          double time_step,
                          struct ft_hand_order *order);

// Forgets what slip has taught of the friction and what the object weighs, as when another one is grasped. Commands and
// limits stay.
ft_status ft_hand_forget(struct ft_hand *hand);

// Says what the joints of a finger can give from now on, as in each sample where they turn; `count` 0 for no limits.
// `jacobian` has six numbers of each joint, one joint behind the other: the motion of the fingertip as a rigid body for a
// unit rate of the joint, its velocity at the origin of the hand's frame in m/s and its angular velocity in rad/s. `greatest`
// has the torque of each in N·m either way, or the force of a linear drive in N. Commands and the least grip keep to it.
// Allocates nothing.
ft_status ft_hand_set_joints(struct ft_hand *hand,
                             size_t finger,
                             const double *jacobian,
                             const double *greatest,
                             size_t count);

// A reading of gauges alone.
struct ft_reading ft_reading_of(const double *gauges, size_t count);

// Takes in what the fingers feel together while nothing else touches the object, as ft_object_wrench gives it, with
// the three numbers of gravity in the frame of the hand in m/s², less the acceleration of the object where that is known.
// Samples count as independent: give them as far apart as their errors last. FT_BAD_NUMBER, and nothing learnt, unless the
// numbers are finite and the covariance is positive definite. Allocates nothing.
ft_status ft_hand_weigh(struct ft_hand *hand,
                        const struct ft_uncertain_wrench *load,
                        const double *gravity);

// What was learnt of the object. Allocates nothing.
ft_status ft_hand_object(struct ft_hand *hand, struct ft_object *object);

// What else touches the object, from what the fingers feel together now and the weight that ft_hand_weigh has learnt.
// `false_alarm` is the probability with which `touches` may be said where nothing does, such as 0.001. Allocates nothing.
ft_status ft_hand_other(struct ft_hand *hand,
                        const struct ft_uncertain_wrench *load,
                        const double *gravity,
                        double false_alarm,
                        struct ft_other *other);

// The quality of the grasp of these fingers. Torques about the mean of the contacts are divided by `length` in m to compare
// them with forces; `each` is 0 if all normal forces together are 1 N, 1 if each is. It takes some hundred cone programs: for
// planning, not for every sample. `error` may be NULL. Allocates nothing.
ft_status ft_grasp_quality(const struct ft_finger *fingers,
                           size_t count,
                           double length,
                           uint32_t each,
                           struct ft_quality *quality,
                           struct ft_error *error);

// How many times a disturbance can be added to a load before no forces within friction, the limits of the hand and its
// joints hold it. `load` as in ft_hand_command. Without the hand's safety and without what slip has taught. Allocates
// nothing. That there is no such number is FT_OK, and a state.
ft_status ft_hand_reach(struct ft_hand *hand,
                        const struct ft_finger *fingers,
                        size_t count,
                        const struct ft_wrench *load,
                        const struct ft_wrench *disturbance,
                        struct ft_reach *reach);

// Takes the signals of the gauges while nothing touches: ft_end_rest makes their mean the zero.
ft_status ft_rest(struct ft_tip *tip, const double *gauges, size_t count);

// As ft_rest, with what was measured beside the gauges. If the first reading of a rest has a dummy gauge, all later
// ones need it, and what it shows to drift is taken off. A scene with a [payload] needs the motion.
ft_status ft_rest_reading(struct ft_tip *tip,
                          const struct ft_reading *reading);

// Takes a wrench as the sensor reports it while nothing touches: ft_end_rest makes their mean the zero.
ft_status ft_rest_wrench(struct ft_tip *tip,
                         const struct ft_wrench *wrench);

// As ft_rest_wrench, with how the sensor moves, which a scene with a [payload] needs.
ft_status ft_rest_wrench_moving(struct ft_tip *tip,
                                const struct ft_wrench *wrench,
                                const struct ft_motion *motion);

// The mean of the rest is the zero from now on, and its noise is known to a scene that asks for it. The next sample is
// the first. Fails with FT_NO_REST, and leaves the zero, if there were fewer than two readings. See ft_rest_doubt.
ft_status ft_end_rest(struct ft_tip *tip);

// Why the last rest may have been none: FT_DOUBTFUL and a sentence, or FT_OK. Allocates.
ft_status ft_rest_doubt(struct ft_tip *tip, struct ft_error *doubt);

// A reading that stands for no load, such as one that was stored. What a rest has taken so far is dropped.
ft_status ft_set_zero(struct ft_tip *tip,
                      const struct ft_reading *reading);

// A wrench, as the sensor reports it, that stands for no load. What a rest has taken so far is dropped.
ft_status ft_set_zero_wrench(struct ft_tip *tip,
                             const struct ft_wrench *wrench);

// The wrench that stands for no load, as the sensor reports it: that of the last rest of wrenches, or the one that was
// set.
ft_status ft_zero_wrench(struct ft_tip *tip,
                         struct ft_wrench *wrench);

// Takes a wrench as the sensor reports it, by the scene's convention, and the time since the one before in s; a time
// that is not positive counts as none. Allocates nothing. A wrench that is not finite is FT_OK, and no contact.
//
// A scene with a [payload] fails with FT_NO_MOTION: see ft_sense_wrench_moving.
ft_status ft_sense_wrench(struct ft_tip *tip,
                          const struct ft_wrench *wrench,
                          double time_step,
                          struct ft_touch *touch);

// As ft_sense_wrench, with how the sensor moves: the weight and the inertia of a [payload] are taken off. Of a scene
// without one, the motion does not matter.
ft_status ft_sense_wrench_moving(struct ft_tip *tip,
                                 const struct ft_wrench *wrench,
                                 const struct ft_motion *motion,
                                 double time_step,
                                 struct ft_touch *touch);

// Takes the signals of the gauges, in the unit of the calibration, as many as ft_tip_gauges says. Allocates nothing.
//
// A reading that fails with FT_SATURATED or FT_INCOMPLETE is left out; the time of the next one counts from the one
// before.
ft_status ft_sense(struct ft_tip *tip,
                   const double *gauges,
                   size_t count,
                   double time_step,
                   struct ft_touch *touch);

// As ft_sense, with what was measured beside the gauges: a dummy gauge, the temperature, the motion.
ft_status ft_sense_reading(struct ft_tip *tip,
                           const struct ft_reading *reading,
                           double time_step,
                           struct ft_touch *touch);

// Frees a fingertip and sets the variable that held it to NULL: to do so twice does no harm. NULL is left.
void ft_tip_free(struct ft_tip **tip);

// Why the last call of this fingertip failed that did: a sentence that stays until the next failure, empty before the
// first. NULL has the sentence of FT_NULL.
const char *ft_tip_message(const struct ft_tip *tip);

// How many gauges a reading has: 0 for a scene without [sensor], which takes wrenches, and for NULL.
size_t ft_tip_gauges(const struct ft_tip *tip);

// Forgets all samples and what was learnt of the friction: the next sample is the first. The zero stays.
ft_status ft_tip_reset(struct ft_tip *tip);

// Forgets the last contact and what the slip detector saw, as after a gap in the samples; what was learnt of the
// friction stays. A time step of more than half a second does so by itself.
ft_status ft_tip_start_anew(struct ft_tip *tip);

// What a resolution means, in a sentence. Any number may be given, such as one that was stored.
const char *ft_resolution_text(uint32_t resolution);

// The version of the ABI of the library that runs, to be compared with FT_ABI_VERSION of the header.
uint32_t ft_abi_version(void);

// The version of the library, such as "0.1.0".
const char *ft_version(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* FINGERTIP_H */
