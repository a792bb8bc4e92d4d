//! `fingertip` for C and C++: what stands in `include/fingertip.h`, which `cbindgen` writes of this crate.
//!
//! Names are those of C, so that one search finds a thing on both sides. Every function is entered through
//! `border`, where pointers become values and panics end.
#![allow(non_camel_case_types, reason = "the names of C")]
#![allow(unsafe_code, reason = "pointers come over the border; what is relied on stands beside each use")]
#![allow(
    clippy::missing_safety_doc,
    reason = "the rules for all pointers stand once, at the head of the header"
)]
#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "[sensor] and its like are sections of scenes, here and in the header"
)]

mod ball;
mod beside;
mod border;
mod columns;
mod create;
mod fault;
mod finger;
mod fuse;
mod grip;
mod hand;
mod joints;
mod load;
mod message;
mod object;
mod quality;
mod rest;
mod sense;
mod tip;
mod touch;
mod version;

pub use ball::{ft_ball, ft_ball_defaults, ft_tip_from_ball};
pub use beside::{ft_beside, ft_beside_last, ft_continuity};
pub use columns::{ft_sense_all, ft_touch_columns, ft_wrench_columns};
pub use create::{ft_tip_from_file, ft_tip_from_scene};
pub use fault::{ft_status, ft_status_text};
pub use finger::{
    FT_MAX_FINGERS, ft_finger, ft_finger_from_touch, ft_finger_limits, ft_margin, ft_object_wrench, ft_pose,
    ft_slip_margins,
};
pub use fuse::{FT_MAX_PLACES, ft_array_reading, ft_fuse, ft_fused, ft_fused_contact};
pub use grip::{ft_grip, ft_hand_least_grip};
pub use hand::{
    ft_hand, ft_hand_command, ft_hand_create, ft_hand_forget, ft_hand_free, ft_hand_message, ft_hand_order,
    ft_hand_settings, ft_hand_settings_defaults, ft_hand_state,
};
pub use joints::{FT_MAX_JOINTS, ft_hand_set_joints};
pub use load::{ft_motion, ft_reading, ft_reading_of, ft_wrench};
pub use message::{FT_MESSAGE_BYTES, ft_error};
pub use object::{ft_hand_object, ft_hand_other, ft_hand_weigh, ft_object, ft_other, ft_uncertain_wrench};
pub use quality::{ft_grasp_quality, ft_hand_reach, ft_quality, ft_reach, ft_reach_state};
pub use rest::{
    ft_end_rest, ft_rest, ft_rest_doubt, ft_rest_reading, ft_rest_wrench, ft_rest_wrench_moving, ft_set_zero,
    ft_set_zero_wrench, ft_zero_wrench,
};
pub use sense::{ft_sense, ft_sense_reading, ft_sense_wrench, ft_sense_wrench_moving};
pub use tip::{ft_tip, ft_tip_free, ft_tip_gauges, ft_tip_message, ft_tip_reset, ft_tip_start_anew};
pub use touch::{ft_resolution, ft_resolution_text, ft_slip, ft_touch};
pub use version::{FT_ABI_VERSION, ft_abi_version, ft_version};
