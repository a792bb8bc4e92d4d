//! Three fingertips lift a jar: what it weighs, how firmly to grip, what happens when one slips, and what
//! that teaches of its friction.
//!
//! `cargo run --example three_fingers --features hand`

use fingertip::friction::{ForceNoise, SlipVerdict};
use fingertip::hand::{
    FingerLimits, FingerSample, FingerState, Grasp, GraspContact, Hand, HandController, HandLoad,
    HandSettings, HandState, LearntFriction, Metric, ObjectWeight, OtherContact, Reach, UncertainWrench,
};
use fingertip::nalgebra::{Matrix6, Vector3};
use fingertip::wrench::{ContactForce, Wrench};

/// Samples of 1 ms.
const STEP: f64 = 1e-3;

fn main() -> Result<(), Box<dyn core::error::Error>> {
    // The jar: 300 g, its middle 2 cm below the fingers. Three soft fingertips around it.
    let (mass, centre, gravity) = (0.3, Vector3::new(0.005, 0.0, -0.02), Vector3::new(0.0, 0.0, -9.81));
    let mut contacts = [None; 3];
    for (contact, angle) in contacts.iter_mut().zip([0.0, 2.1, 4.2_f64]) {
        let outward = Vector3::new(angle.cos(), angle.sin(), 0.0);
        *contact = Some(GraspContact::<f64, Hand>::soft(outward * 0.04, -outward, 0.6, 2e-3)?);
    }
    let grasp = Grasp::new(contacts);
    println!("force closure: {:?}", grasp.force_closure());

    let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.3)?.with_greatest_normal(15.0)?;
    // Friction is known to be 0.6, until a slip tells better: one skin slips within 5 % of the same ratio.
    let belief = LearntFriction::new(ForceNoise::isotropic(0.02)?, 0.05, 0.01)?;
    let mut hand = HandController::with_beliefs(HandSettings::default(), [limits; 3], [belief; 3])?;
    let mut weight = ObjectWeight::new();
    let noise = Matrix6::from_diagonal(&[4e-4, 4e-4, 4e-4, 4e-8, 4e-8, 4e-8].into());

    for sample in 0..500 {
        // Lifting takes the weight over in 0.1 s; afterwards the hand tilts. The finger 1 slips once.
        let share = (f64::from(sample) / 100.0).min(1.0);
        let tilt = 0.5 * (f64::from(sample - 150).max(0.0) / 350.0);
        let gravity = Vector3::new(gravity.z * tilt.sin(), 0.0, gravity.z * tilt.cos());
        let load = Wrench::<f64, Hand>::from_force_at(&centre, gravity * (mass * share));
        if sample > 120 {
            weight.observe(&UncertainWrench { wrench: load, covariance: noise }, &gravity);
        }
        // What the fingers feel: about what they were told to, with a third of the weight each.
        let mut fingers = [FingerState::Free; 3];
        let present = hand.present();
        for (finger, (index, (contact, normal))) in
            fingers.iter_mut().zip(contacts.iter().zip(present).enumerate())
        {
            let Some(contact) = contact else { continue };
            let force = ContactForce::new(normal, gravity * (mass * share / 3.0), 0.0);
            let slips = index == 1 && sample == 300;
            let slip = if slips { SlipVerdict::Slipping } else { SlipVerdict::Holding };
            *finger = FingerSample { contact: *contact, force, slip }.into();
        }
        let command = hand.command(&fingers, &HandLoad::FromFingers, STEP);
        if sample % 100 == 99 || (299..303).contains(&sample) {
            let [a, b, c] = command.normal;
            let holding = matches!(command.state, HandState::Holding);
            println!("{sample:3} ms: press with {a:.2}, {b:.2}, {c:.2} N, holding: {holding}");
        }
    }
    for (finger, belief) in hand.beliefs().iter().enumerate() {
        if let Some(learnt) = belief.estimate() {
            println!("finger {finger} has a friction of {:.2} ± {:.2}", learnt.coefficient, learnt.deviation);
        }
    }
    if let Some(found) = weight.estimate() {
        println!("it weighs {:.1} g ± {:.1} g", found.mass * 1e3, found.mass_deviation * 1e3);
        println!("its middle is at {:.1} mm below the fingers", -found.centre.z * 1e3);
    }
    // It is put down: the edge of a table, 3 cm beside the middle, bears 1 N of it.
    let jar = Wrench::<f64, Hand>::from_force_at(&centre, gravity * mass);
    let table = Wrench::from_force_at(&Vector3::new(0.03, 0.0, -0.08), Vector3::z());
    let felt = UncertainWrench { wrench: jar + table, covariance: noise };
    if let Some(other) = OtherContact::new(&felt, &weight, &gravity)
        && let (true, Ok(axis)) = (other.touches(1e-3), other.line)
    {
        println!("something bears {:.2} N of it at x = {:.1} mm", axis.force, axis.line.point.x * 1e3);
    }
    // With motors that give 0.3 N·m at a lever of 4 cm, and whatever pulls.
    let mut jointed = [FingerLimits::<f64, 4>::none(); 3];
    for (limits, contact) in jointed.iter_mut().zip(contacts.iter().flatten()) {
        let [x, y, z] = (contact.normal() * 0.04).into();
        *limits = limits.with_joint(&[x, y, z, 0.0, 0.0, 0.0].into(), 0.3)?;
    }
    if let Reach::Times(times) = grasp.reach(&jointed, &jar, &jar) {
        println!("{times:.1} more of such jars could be borne");
    }
    if let Some(ball) = grasp.ball(Metric::Total { length: 0.04 }) {
        println!("1 N of grip resists any {:.2} N, but not every {:.2} N", ball.certified, ball.found);
    }
    Ok(())
}
