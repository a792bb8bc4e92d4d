//! What `Scene::to_rust` writes of the examples and of every choice; `export` tests it.

#[rustfmt::skip]
pub(crate) mod auto_capsule;
#[rustfmt::skip]
pub(crate) mod capsule;
#[rustfmt::skip]
pub(crate) mod carries;
#[rustfmt::skip]
pub(crate) mod choices;
#[rustfmt::skip]
pub(crate) mod ellipsoid;
#[rustfmt::skip]
pub(crate) mod formula_pad;
#[rustfmt::skip]
pub(crate) mod gauges;
#[rustfmt::skip]
pub(crate) mod gripped_ball;
#[rustfmt::skip]
pub(crate) mod nano17_cylinder;
#[rustfmt::skip]
pub(crate) mod nano17_soft_finger;
#[rustfmt::skip]
pub(crate) mod nano17_soft_finger_f32;
#[rustfmt::skip]
pub(crate) mod paper_sphere;
#[rustfmt::skip]
pub(crate) mod paper_sphere_f32;
#[rustfmt::skip]
pub(crate) mod plane;
#[rustfmt::skip]
pub(crate) mod robot_link;
#[rustfmt::skip]
pub(crate) mod rubber_tip;
#[rustfmt::skip]
pub(crate) mod rubber_tip_f32;
#[rustfmt::skip]
pub(crate) mod tracked_ball;
#[rustfmt::skip]
pub(crate) mod tracked_ball_f32;
#[rustfmt::skip]
pub(crate) mod plane_eight_gauges_f32;
#[rustfmt::skip]
pub(crate) mod skinned;
#[rustfmt::skip]
pub(crate) mod plane_curved_f32;
#[rustfmt::skip]
pub(crate) mod skinned_curved;
#[rustfmt::skip]
pub(crate) mod skinned_six_gauges;
