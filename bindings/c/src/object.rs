//! What a hand holds: its weight, and what else touches it.

use fingertip::hand::{OtherContact, UncertainWrench};
use nalgebra::{Matrix6, Vector3};

use crate::border::{on, place, read, read_numbers};
use crate::fault::{Fault, ft_status};
use crate::hand::ft_hand;
use crate::load::ft_wrench;

/// A wrench, and how sure it is: both about the origin of the hand's frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_uncertain_wrench {
    /// The wrench.
    pub wrench: ft_wrench,
    /// Its covariance, force before torque, in N², N·N·m and N²·m²: symmetric and positive definite.
    pub covariance: [[f64; 6]; 6],
}

impl ft_uncertain_wrench {
    fn given(&self) -> UncertainWrench<f64> {
        UncertainWrench {
            wrench: self.wrench.wrench(),
            covariance: Matrix6::from(self.covariance).transpose(),
        }
    }
}

fn three(gravity: *const f64) -> Result<Vector3<f64>, Fault> {
    read_numbers(gravity.cast::<[f64; 3]>(), "gravity").map(Vector3::from)
}

/// What is known of the object that a hand holds.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_object {
    /// 1 if the mass is known.
    pub has_mass: u32,
    /// 1 if the centre of mass is known, too, which takes two orientations.
    pub has_centre: u32,
    /// In kg.
    pub mass: f64,
    /// Its standard deviation in kg.
    pub mass_deviation: f64,
    /// In the frame of the hand, in m.
    pub centre: [f64; 3],
    /// Its covariance in m².
    pub centre_covariance: [[f64; 3]; 3],
}

/// What else touches the object, such as a table or another hand.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_other {
    /// 1 if the weight is known, so that the rest below says something.
    pub is_known: u32,
    /// 1 if something touches: that is said in error no more often than was asked for.
    pub touches: u32,
    /// 1 if the wrench has a line along which its force acts.
    pub has_line: u32,
    /// Zero.
    pub reserved: u32,
    /// What they do to the object.
    pub load: ft_uncertain_wrench,
    /// Chi-square with six degrees of freedom if nothing touches.
    pub statistic: f64,
    /// The point of the line next to the origin of the hand's frame, in m.
    pub point: [f64; 3],
    /// Its direction, of length one.
    pub direction: [f64; 3],
    /// Torque along the line over force, in m: zero of one contact without friction torque, which lies on the line.
    pub pitch: f64,
}

/// Takes in what the fingers feel together while nothing else touches the object, as ft_object_wrench gives it, with
/// the three numbers of gravity in the frame of the hand in m/s², less the acceleration of the object where that is known.
/// Samples count as independent: give them as far apart as their errors last. FT_BAD_NUMBER, and nothing learnt, unless the
/// numbers are finite and the covariance is positive definite. Allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_weigh(
    hand: *mut ft_hand,
    load: *const ft_uncertain_wrench,
    gravity: *const f64,
) -> ft_status {
    on(hand, |hand| {
        let (load, gravity) = (read(load, "load")?, three(gravity)?);
        match hand.weight.observe(&load.given(), &gravity) {
            true => Ok(()),
            false => Err(Fault::Number {
                name: "load",
                requirement: "finite, as gravity, with a covariance that is positive definite",
            }),
        }
    })
}

/// What was learnt of the object. Allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_object(hand: *mut ft_hand, object: *mut ft_object) -> ft_status {
    on(hand, |hand| {
        let place = place(object, "object")?;
        let mut told = ft_object {
            has_mass: 0,
            has_centre: 0,
            mass: 0.0,
            mass_deviation: 0.0,
            centre: [0.0; 3],
            centre_covariance: [[0.0; 3]; 3],
        };
        if let Some((mass, deviation)) = hand.weight.mass() {
            (told.has_mass, told.mass, told.mass_deviation) = (1, mass, deviation);
        }
        if let Some(found) = hand.weight.estimate() {
            (told.has_centre, told.centre) = (1, found.centre.into());
            told.centre_covariance = found.centre_covariance.into();
        }
        place.put(told);
        Ok(())
    })
}

/// What else touches the object, from what the fingers feel together now and the weight that ft_hand_weigh has learnt.
/// `false_alarm` is the probability with which `touches` may be said where nothing does, such as 0.001. Allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_other(
    hand: *mut ft_hand,
    load: *const ft_uncertain_wrench,
    gravity: *const f64,
    false_alarm: f64,
    other: *mut ft_other,
) -> ft_status {
    on(hand, |hand| {
        let place = place(other, "other")?;
        let (load, gravity) = (read(load, "load")?, three(gravity)?);
        if !(false_alarm > 0.0 && false_alarm < 1.0) {
            return Err(Fault::Number { name: "false_alarm", requirement: "between 0 and 1" });
        }
        let nothing = ft_wrench { force: [0.0; 3], torque: [0.0; 3] };
        let mut told = ft_other {
            is_known: 0,
            touches: 0,
            has_line: 0,
            reserved: 0,
            load: ft_uncertain_wrench { wrench: nothing, covariance: [[0.0; 6]; 6] },
            statistic: 0.0,
            point: [0.0; 3],
            direction: [0.0; 3],
            pitch: 0.0,
        };
        if let Some(found) = OtherContact::new(&load.given(), &hand.weight, &gravity) {
            told.is_known = 1;
            told.touches = u32::from(found.touches(false_alarm));
            told.load.wrench = ft_wrench::of(&found.load.wrench);
            told.load.covariance = found.load.covariance.transpose().into();
            told.statistic = found.statistic;
            if let Ok(line) = found.line {
                (told.has_line, told.pitch) = (1, line.pitch);
                (told.point, told.direction) = (line.line.point.into(), line.line.direction.into());
            }
        }
        place.put(told);
        Ok(())
    })
}
