//! Two simulated fingertips lift a jar: how firmly they grip, how near they are to slipping, what it weighs.
//!
//! `cargo run --release -p fingertip-simulation --features hand --example hand_lifts_a_jar`

use fingertip_hand::{Grasp, ObjectWeight};
use fingertip_simulation::SimulationError;
use fingertip_simulation::hand::{
    FingerPlace, GrippingHand, GrippingSettings, HandOptions, HandScript, HeldObject, SimulatedHand,
};

fn main() -> Result<(), SimulationError> {
    // A jar of 6 cm and 200 g. Nothing touches for the first segment: it gives the zeros.
    let jar = HeldObject::cylinder(0.03, 0.05, 0.2)?;
    let script = HandScript::default().open(0.3).hold(0.4).lift(0.03, 0.5).hold(0.3);
    let mut hand = SimulatedHand::new(jar, FingerPlace::ring::<2>(0.05), &script, HandOptions::default())?;

    let mut weighing = None;
    let mut weight = ObjectWeight::new();
    GrippingHand::play(&mut hand, &GrippingSettings::default(), |sample, felt, gripping| {
        let Some(command) = felt.command else { return };
        // From a tenth of a second of the lift on, nothing but the hand bears it.
        if sample.time > 0.8 {
            let weighing = weighing.get_or_insert_with(|| gripping.weighing());
            weighing.add(&felt.wrenches, &sample.gravity);
            weight = ObjectWeight::new();
            weighing.observe(&mut weight, &sample.tips);
        }
        #[allow(clippy::cast_possible_truncation, reason = "milliseconds of a short script")]
        let millisecond = (sample.time * 1e3).round() as i32;
        if millisecond % 100 != 0 {
            return;
        }
        let (grasp, forces) = Grasp::of_fingers(&felt.fingers);
        let left = grasp.least_slip_margin(&forces).map_or(0.0, |margin| margin.newtons);
        let [first, second] = command.normal;
        print!("{:.1} s: press with {first:.2} and {second:.2} N, {left:.2} N from slipping", sample.time);
        match weight.mass() {
            Some((mass, deviation)) => println!(", {:.1} g ± {:.1} g", mass * 1e3, deviation * 1e3),
            None => println!(),
        }
    })?;
    Ok(())
}
