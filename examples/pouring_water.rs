//! Water is poured into a cup that two fingertips hold: how hard must they press?
//!
//! `cargo run --release --example pouring_water`
//!
//! A closed loop. The cup hangs on LuGre friction between two of the paper's fingertips; the load
//! of one becomes gauge signals, these get noise and the steps of a converter, and the pipeline
//! turns them into a contact, a slip margin and a slip verdict, from which the controller commands
//! the grip. It starts with a friction coefficient that is too high, and learns the true one from
//! the first slip. Fixed grips are run beside it.

use fingertip::Fingertip;
use fingertip::contact::PointContact;
use fingertip::friction::{
    Bristle, Coulomb, Drive, DropDetector, ForceNoise, GripController, GripSettings, LuGre, SlipVerdict,
    StaticFriction, Stribeck,
};
use fingertip::nalgebra::{Vector1, Vector3};
use fingertip::wrench::{GaussianElimination, Wrench};
use fingertip_simulation::Design;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

type Failure = Box<dyn core::error::Error>;

/// Samples per second of the loop, and steps of the mechanics per sample.
const RATE: f64 = 1000.0;
const SUBSTEPS: usize = 10;
const DURATION: f64 = 8.0;
const GRAVITY: f64 = 9.81;
/// The truth, which the controller does not know.
const STATIC: f64 = 0.55;
const KINETIC: f64 = 0.45;

/// 100 g of cup, and 300 g of water from 1 s to 6 s.
fn mass(time: f64) -> f64 {
    0.1 + 0.3 * ((time - 1.0) / 5.0).clamp(0.0, 1.0)
}

/// What the fingers carry \[N\]: in the first half second the table lets go of the cup.
fn weight(time: f64) -> f64 {
    mass(time) * GRAVITY * (time / 0.5).min(1.0)
}

/// How the grip is commanded.
enum Strategy {
    /// Always the same normal force \[N\].
    Fixed(f64),
    /// By the controller, from this first guess of the friction coefficient.
    Controlled(f64),
}

struct Outcome {
    mean_grip: f64,
    greatest_grip: f64,
    /// How far the cup slid \[m\].
    slid: f64,
    slips: usize,
    coefficient: Option<f64>,
}

fn hold(strategy: &Strategy) -> Result<Outcome, Failure> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let design = Design::default();
    // 2500 V per unit of strain: quarter bridge, gauge factor 2, 5 V, amplified a thousand times.
    let sensor = design.layout()?.sensor_matrix(2500.0, design.nominal_loads())?;
    // What 0.1 mV of noise on the gauges and the converter make of it.
    let noise = ForceNoise { normal: 0.02, tangential: 0.005 };
    let mut fingertip = Fingertip::builder()
        .solver(GaussianElimination::new(&sensor)?)
        .contact(design.sphere()?, PointContact::new(0.1)?)
        .slip_detector(DropDetector::new(noise)?)
        .build();
    let mut learnt = StaticFriction::<f64, 64>::new(noise, 0.05, 0.01)?;
    let mut grip = GripController::new(GripSettings {
        safety: 1.3,
        least: 1.0,
        greatest: 15.0,
        rise: 200.0,
        fall: 2.0,
        slip_boost: 1.3,
    })?;

    // Per newton of normal force; two fingers carry the cup.
    let law = LuGre::new(1e5, 1e5_f64.sqrt(), 0.4, Stribeck::new(KINETIC, STATIC, 1e-3)?)?;
    let mut friction = Bristle::<f64, _, 1>::new(law);
    let (mut velocity, mut slid) = (Vector1::new(0.0), 0.0);
    let (mut trusted, first) = match *strategy {
        Strategy::Fixed(force) => (1.0, force),
        Strategy::Controlled(guess) => (guess, 1.3 * 0.5 * mass(0.0) * GRAVITY / guess),
    };
    grip.start_at(first);
    let first = if matches!(strategy, Strategy::Fixed(_)) { first } else { grip.present() };
    let (mut command, mut pressing) = (first, first);
    let (mut sum, mut greatest, mut slips, mut carried) = (0.0, 0.0_f64, 0, 0.0);

    let samples = (DURATION * RATE) as usize;
    for index in 0..samples {
        let time = index as f64 / RATE;
        let h = 1.0 / (RATE * SUBSTEPS as f64);
        for _ in 0..SUBSTEPS {
            // The finger's drive follows the command with a time constant of 5 ms.
            pressing += (command - pressing) * h / 5e-3;
            friction.set_load(2.0 * pressing);
            let drive =
                Drive { mass: Vector1::new(mass(time)), force: Vector1::new(weight(time)), stiffness: 0.0 };
            let end = friction.step_body(&velocity, &drive, h);
            velocity = end.velocity;
            carried = end.friction[0] * 0.5;
            slid += velocity[0] * h;
        }

        // What one fingertip feels at its top: the cup presses inwards and pulls down.
        let load = Wrench::from_force_at(
            &Vector3::new(design.sphere_radius, 0.0, 0.0),
            Vector3::new(-pressing, 0.0, -carried),
        );
        // 0.1 mV of noise, and a step of 0.15 mV (16 conversions of 12 bits, averaged).
        let step = 5.0 / 32768.0;
        let volts = sensor.signals(&load).map(|v| {
            let noise: f64 = StandardNormal.sample(&mut rng);
            ((v + 0.1e-3 * noise) / step).round() * step
        });
        let touch = fingertip.sense(&volts, 1.0 / RATE);
        if let Some(force) = touch.force {
            learnt.observe(&force);
            if touch.slip == SlipVerdict::Slipping {
                slips += 1;
                if let Some(estimate) = learnt.onset() {
                    // What is undercut once in a hundred slips.
                    trusted = estimate.quantile(0.01);
                }
            }
            if matches!(strategy, Strategy::Controlled(_)) {
                command = grip.command(&Coulomb::new(trusted)?, &force, touch.slip, 1.0 / RATE);
            }
        }
        sum += pressing;
        greatest = greatest.max(pressing);
    }
    Ok(Outcome {
        mean_grip: sum / samples as f64,
        greatest_grip: greatest,
        slid,
        slips,
        coefficient: learnt.estimate().map(|estimate| estimate.coefficient),
    })
}

fn main() -> Result<(), Failure> {
    println!("A cup of 100 g takes 300 g of water; true static friction {STATIC}, kinetic {KINETIC}.\n");
    println!("| grip                            | mean N | greatest N | slid mm | slips seen | learnt mu |");
    println!("|---------------------------------|--------|------------|---------|------------|-----------|");
    for (name, strategy) in [
        ("fixed, enough for the empty cup", Strategy::Fixed(1.5)),
        ("fixed, enough for the full cup", Strategy::Fixed(5.0)),
        ("fixed, to be sure", Strategy::Fixed(10.0)),
        ("controlled, first guess 0.55", Strategy::Controlled(0.55)),
        ("controlled, first guess 0.9", Strategy::Controlled(0.9)),
    ] {
        let outcome = hold(&strategy)?;
        let learnt = outcome.coefficient.map_or_else(|| "-".into(), |mu| format!("{mu:.3}"));
        // Beyond the height of a cup it is on the floor.
        let slid = if outcome.slid > 0.1 { "dropped".into() } else { format!("{:.3}", outcome.slid * 1e3) };
        println!(
            "| {name:<31} | {:>6.2} | {:>10.2} | {slid:>7} | {:>10} | {learnt:>9} |",
            outcome.mean_grip, outcome.greatest_grip, outcome.slips
        );
    }
    Ok(())
}
