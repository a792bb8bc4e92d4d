//! How good a grasp is.

use fingertip::hand::{Grasp, Metric, Reach};

use crate::border::{on, place, read, told};
use crate::fault::{Fault, ft_status};
use crate::finger::{fingers, ft_finger, load};
use crate::hand::ft_hand;
use crate::load::ft_wrench;
use crate::message::ft_error;

/// How good a grasp is, whatever its load.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_quality {
    /// In how many directions the contacts hold the object: 6 if in all.
    pub rank: u32,
    /// 1 if any wrench can be borne by pressing hard enough, 0 if not, 2 if it could not be told.
    pub force_closure: u32,
    /// The radius in N of the ball of wrenches that 1 N bears (Ferrari & Canny) is at least this: certified.
    pub certified: f64,
    /// It is at most this, which a search found.
    pub found: f64,
    /// The load of that size that is borne least: of unit length in the metric.
    pub weakest: ft_wrench,
    /// The 6 - rank motions that no contact resists, of which the direction alone has a meaning: velocities at the origin of
    /// the hand's frame in m/s.
    pub freedom_velocity: [[f64; 3]; 6],
    /// Their angular velocities in rad/s.
    pub freedom_turning: [[f64; 3]; 6],
}

/// What there is of a reach.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ft_reach_state {
    /// So many times the disturbance, and no more.
    FT_REACH_TIMES = 0,
    /// As much as one likes: no limit of a finger matters.
    FT_REACH_UNLIMITED = 1,
    /// Neither the load alone nor any multiple of the disturbance beside it can be held.
    FT_REACH_NOT_HELD = 2,
    /// A number is not finite, a finger feels what cannot be and no load was given, or it could not be told.
    FT_REACH_UNKNOWN = 3,
}

/// How far a load can grow before no forces hold it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_reach {
    /// What there is of it.
    pub state: ft_reach_state,
    /// Zero.
    pub reserved: u32,
    /// How many times the disturbance can be borne beside the load, with FT_REACH_TIMES.
    pub times: f64,
}

/// The quality of the grasp of these fingers. Torques about the mean of the contacts are divided by `length` in m to compare
/// them with forces; `each` is 0 if all normal forces together are 1 N, 1 if each is. It takes some hundred cone programs: for
/// planning, not for every sample. `error` may be NULL. Allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_grasp_quality(
    fingers: *const ft_finger,
    count: usize,
    length: f64,
    each: u32,
    quality: *mut ft_quality,
    error: *mut ft_error,
) -> ft_status {
    told(error, || {
        let place = place(quality, "quality")?;
        let (grasp, _) = Grasp::of_fingers(&self::fingers(fingers, count)?);
        let metric = match each {
            0 => Metric::Total { length },
            1 => Metric::Each { length },
            _ => return Err(Fault::Number { name: "each", requirement: "0 or 1" }),
        };
        let Some(ball) = grasp.ball(metric) else {
            return Err(Fault::Number { name: "length", requirement: "positive and finite" });
        };
        let mut told = ft_quality {
            rank: u32::try_from(grasp.rank()).unwrap_or_default(),
            force_closure: grasp.force_closure().map_or(2, u32::from),
            certified: ball.certified,
            found: ball.found,
            weakest: ft_wrench::of(&ball.weakest),
            freedom_velocity: [[0.0; 3]; 6],
            freedom_turning: [[0.0; 3]; 6],
        };
        let motions = told.freedom_velocity.iter_mut().zip(&mut told.freedom_turning);
        for ((velocity, turning), freedom) in motions.zip(grasp.freedoms().iter().flatten()) {
            (*velocity, *turning) = (freedom.velocity.into(), freedom.turning.into());
        }
        place.put(told);
        Ok(())
    })
}

/// How many times a disturbance can be added to a load before no forces within friction, the limits of the hand and its
/// joints hold it. `load` as in ft_hand_command. Without the hand's safety and without what slip has taught. Allocates
/// nothing. That there is no such number is FT_OK, and a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_reach(
    hand: *mut ft_hand,
    fingers: *const ft_finger,
    count: usize,
    load: *const ft_wrench,
    disturbance: *const ft_wrench,
    reach: *mut ft_reach,
) -> ft_status {
    on(hand, |hand| {
        let place = place(reach, "reach")?;
        hand.check(count)?;
        let fingers = self::fingers(fingers, count)?;
        let load = self::load(load)?.wrench(&fingers, hand.controller.settings().greatest_ratio);
        let disturbance = read(disturbance, "disturbance")?.wrench();
        let (grasp, _) = Grasp::of_fingers(&fingers);
        let found = load.map_or(Reach::Unknown, |load| grasp.reach(&hand.limits, &load, &disturbance));
        let (state, times) = match found {
            Reach::Times(times) => (ft_reach_state::FT_REACH_TIMES, times),
            Reach::Unlimited => (ft_reach_state::FT_REACH_UNLIMITED, 0.0),
            Reach::NotHeld => (ft_reach_state::FT_REACH_NOT_HELD, 0.0),
            Reach::Unknown => (ft_reach_state::FT_REACH_UNKNOWN, 0.0),
        };
        place.put(ft_reach { state, reserved: 0, times });
        Ok(())
    })
}
