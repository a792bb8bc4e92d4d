//! The integrators of dynamic friction over the step length, with explicit Euler as the bad example.

use core::fmt::Write as _;

use fingertip_friction::{Bristle, Drive, Exponential, Implicit, Integrator, LuGre, ReturnMap};
use nalgebra::Vector1;

use crate::Failure;
use crate::page::{Page, Scale, Series};

#[path = "../../../../friction/tests/support/stick_slip.rs"]
mod reference;

/// Where the reference of the prescribed motion is compared \[s\].
const INTERVAL: f64 = 0.01;
const DURATION: f64 = 0.5;
/// F_s over σ₀, of the parameters of 1995.
const GREATEST: f64 = 1.5e-5;

/// To and fro at up to 0.1 m/s.
fn velocity(time: f64) -> f64 {
    0.1 * (100.0 * time).sin()
}

/// g at a velocity.
fn steady(v: f64) -> f64 {
    1.0 + 0.5 * (-(v * 1e3) * (v * 1e3)).exp()
}

/// The greatest error of the elastic force over F_s, with `steps` to an interval.
fn prescribed(reference: &[f64], steps: u32, mut advance: impl FnMut(f64, f64) -> f64) -> f64 {
    let h = INTERVAL / f64::from(steps);
    let mut worst = 0.0_f64;
    for (index, exact) in reference.iter().enumerate().skip(1) {
        let mut deflection = f64::NAN;
        for step in 0..steps {
            deflection = advance(INTERVAL * (index - 1) as f64 + h * f64::from(step), h);
        }
        let error = (deflection - exact).abs() / GREATEST;
        worst = if error > worst || error.is_nan() { error } else { worst };
        if worst.is_nan() {
            return f64::INFINITY;
        }
    }
    worst
}

fn bristle<M: Integrator>(reference: &[f64], steps: u32, at: f64) -> Result<f64, Failure> {
    let mut bristle = Bristle::<f64, _, 1, M>::with_method(LuGre::reference()?);
    Ok(prescribed(reference, steps, |time, h| {
        bristle.step(&Vector1::new(velocity(time + at * h)), h);
        bristle.deflection()[0]
    }))
}

/// `z ← z + h(v − σ₀|v|z/g)`.
fn explicit(reference: &[f64], steps: u32) -> f64 {
    let mut z = 0.0;
    prescribed(reference, steps, |time, h| {
        let v = velocity(time);
        z += h * (v - 1e5 * v.abs() * z / steady(v));
        z
    })
}

/// Positions of the stick-slip benchmark every 0.1 s, by a step of position, velocity and memory.
fn benchmark(reference: &[f64], h: f64, mut step: impl FnMut(f64, &mut f64, &mut f64)) -> f64 {
    let every = (0.1 / h).round() as u64;
    let (mut x, mut v, mut worst) = (0.0, 0.0, 0.0_f64);
    for (index, exact) in reference.iter().enumerate().skip(1) {
        for inner in 0..every {
            let time = h * ((index as u64 - 1) * every + inner) as f64;
            step(time, &mut x, &mut v);
        }
        let error = (x - exact).abs();
        if !error.is_finite() {
            return f64::INFINITY;
        }
        worst = worst.max(error);
    }
    worst
}

fn passive(reference: &[f64], h: f64) -> Result<f64, Failure> {
    let mut bristle = Bristle::<f64, _, 1>::new(LuGre::reference()?);
    Ok(benchmark(reference, h, |time, x, v| {
        let pull = 2.0 * (0.1 * (time + h) - *x);
        let drive = Drive { mass: Vector1::new(1.0), force: Vector1::new(pull), stiffness: 2.0 };
        *v = bristle.step_body(&Vector1::new(*v), &drive, h).velocity[0];
        *x += h * *v;
    }))
}

fn explicit_body(reference: &[f64], h: f64) -> f64 {
    let mut z = 0.0;
    benchmark(reference, h, |time, x, v| {
        let rate = *v - 1e5 * v.abs() * z / steady(*v);
        let force = 2.0 * (0.1 * time - *x) - (1e5 * z + 1e5_f64.sqrt() * rate + 0.4 * *v);
        *x += h * *v;
        *v += h * force;
        z += h * rate;
    })
}

fn shown(error: f64) -> String {
    if error < 1e6 { format!("{error:.1e}") } else { "diverges".into() }
}

/// What is drawn of it.
fn points(steps: &[f64], errors: &[f64]) -> Vec<(f64, f64, Option<f64>)> {
    steps.iter().zip(errors).map(|(h, error)| (*h, error.clamp(1e-12, 1e12), None)).collect()
}

/// Both experiments.
pub(crate) fn report(page: &mut Page) -> Result<(), Failure> {
    page.say("\n## Integrators of dynamic friction over the step\n");
    page.say(
        "LuGre friction with the parameters of 1995, against Radau's method at a relative tolerance of 1e-9. \
         Explicit Euler is the bad example: it needs a step below 2g/(σ0|v|), which is 2e-4 s at 0.1 m/s, and \
         diverges above, where the others stay bounded and passive. The return map is another law, without \
         memory of the rate: it differs from LuGre at every step.",
    );
    let reference = reference::moved(velocity, DURATION, INTERVAL)?;
    let counts = [10_000, 3000, 1000, 300, 100, 40, 20, 10, 5, 2, 1_u32];
    let steps: Vec<f64> = counts.iter().map(|count| INTERVAL / f64::from(*count)).collect();
    let over = |method: &dyn Fn(u32) -> Result<f64, Failure>| {
        counts.iter().map(|count| method(*count)).collect::<Result<Vec<f64>, _>>()
    };
    let exponential = over(&|count| bristle::<Exponential>(&reference, count, 0.5))?;
    let implicit = over(&|count| bristle::<Implicit>(&reference, count, 1.0))?;
    let map = over(&|count| bristle::<ReturnMap>(&reference, count, 1.0))?;
    let euler = over(&|count| Ok(explicit(&reference, count)))?;
    let mut text = String::from(
        "\n## Prescribed motion: greatest error of the elastic force over the break-away force\n\n\
         | step s | exponential, mid-point | implicit | return map | explicit Euler |\n|---|---|---|---|---|\n",
    );
    for (index, h) in steps.iter().enumerate() {
        let cell = |errors: &[f64]| errors.get(index).map_or_else(String::new, |error| shown(*error));
        writeln!(
            text,
            "| {h:.1e} | {} | {} | {} | {} |",
            cell(&exponential),
            cell(&implicit),
            cell(&map),
            cell(&euler)
        )?;
    }
    page.say(&text);
    page.plot(
        "integrators",
        "Prescribed motion, 0.1 m/s at 16 Hz: error over step",
        "step in seconds",
        "error over the break-away force (cut off at 1000)",
        Scale { x: 8e-7..1.3e-2, y: 1e-10..1e3, logarithmic: true },
        &[
            Series { name: "explicit Euler", points: points(&steps, &euler) },
            Series { name: "exponential, mid-point", points: points(&steps, &exponential) },
            Series { name: "implicit", points: points(&steps, &implicit) },
            Series { name: "return map", points: points(&steps, &map) },
        ],
    )?;

    let reference = reference::stick_slip()?;
    let mut text = String::from(
        "\n## Stick-slip of a mass on a spring, 20 s: greatest error of the position in metres\n\n\
         | step s | passive step | explicit Euler |\n|---|---|---|\n",
    );
    let steps = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2];
    let (mut own, mut euler) = (Vec::new(), Vec::new());
    for h in steps {
        own.push(passive(&reference, h)?);
        euler.push(explicit_body(&reference, h));
        let last = |errors: &[f64]| errors.last().map_or_else(String::new, |error| shown(*error));
        writeln!(text, "| {h:.0e} | {} | {} |", last(&own), last(&euler))?;
    }
    page.say(&text);
    page.plot(
        "stick_slip",
        "Stick-slip of a mass on a spring: error over step",
        "step in seconds",
        "error of the position in metres (cut off at 100)",
        Scale { x: 8e-7..1.3e-2, y: 1e-7..1e2, logarithmic: true },
        &[
            Series { name: "explicit Euler", points: points(&steps, &euler) },
            Series { name: "passive step", points: points(&steps, &own) },
        ],
    )
}
