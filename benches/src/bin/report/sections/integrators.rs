//! Friction integrators: error against what a second of motion costs, over the step.

use core::hint::black_box;

use fingertip_friction::{Bristle, Drive, Exponential, Implicit, Integrator, LuGre, ReturnMap};
use nalgebra::Vector1;

use super::Part;
use crate::Failure;
use crate::page::Page;
use crate::plots::{Diagram, Series};
use crate::table::{Table, shown};
use crate::timing::{Effort, time};

#[path = "../../../../../friction/tests/support/stick_slip.rs"]
mod reference;

/// Where the reference is compared, and how long the motion lasts \[s\].
const INTERVAL: f64 = 0.01;
const DURATION: f64 = 0.5;
/// F_s over σ₀, of the parameters of 1995.
const GREATEST: f64 = 1.5e-5;
/// What is drawn of something that diverged.
const DIVERGED: f64 = 1e4;

/// To and fro at up to 0.1 m/s.
fn velocity(time: f64) -> f64 {
    0.1 * (100.0 * time).sin()
}

fn steady(v: f64) -> f64 {
    1.0 + 0.5 * (-(v * 1e3) * (v * 1e3)).exp()
}

/// One integrator over all steps: step, error, nanoseconds per step.
struct Course {
    name: &'static str,
    points: Vec<(f64, f64, f64)>,
}

/// Follows the motion with `steps` to an interval; `advance(time, h)` gives the deflection.
fn follow(reference: &[f64], steps: u32, mut advance: impl FnMut(f64, f64) -> f64) -> f64 {
    let h = INTERVAL / f64::from(steps);
    let mut worst = 0.0_f64;
    for (index, exact) in reference.iter().enumerate().skip(1) {
        let mut deflection = 0.0;
        for step in 0..steps {
            deflection = advance(INTERVAL * (index - 1) as f64 + h * f64::from(step), h);
        }
        let error = (deflection - exact).abs() / GREATEST;
        if !error.is_finite() {
            return f64::INFINITY;
        }
        worst = worst.max(error);
    }
    worst
}

fn bristle<M: Integrator>(
    name: &'static str,
    at: f64,
    reference: &[f64],
    counts: &[u32],
    effort: Effort,
) -> Result<Course, Failure> {
    let law = LuGre::reference()?;
    let mut points = Vec::new();
    let velocities: Vec<Vector1<f64>> =
        (0..256).map(|k| Vector1::new(velocity(1e-4 * f64::from(k)))).collect();
    for steps in counts {
        let mut state = Bristle::<f64, _, 1, M>::with_method(law);
        let error = follow(reference, *steps, |time, h| {
            state.step(&Vector1::new(velocity(time + at * h)), h);
            state.deflection()[0]
        });
        let h = INTERVAL / f64::from(*steps);
        let cost = time(effort, velocities.len(), || {
            for v in &velocities {
                black_box(state.step(black_box(v), h));
            }
        });
        points.push((h, error, cost.median));
    }
    Ok(Course { name, points })
}

fn euler(reference: &[f64], counts: &[u32], effort: Effort) -> Course {
    let mut points = Vec::new();
    let velocities: Vec<f64> = (0..256).map(|k| velocity(1e-4 * f64::from(k))).collect();
    for steps in counts {
        let step = |z: f64, v: f64, h: f64| z + h * (v - 1e5 * v.abs() * z / steady(v));
        let mut z = 0.0;
        let error = follow(reference, *steps, |time, h| {
            z = step(z, velocity(time), h);
            z
        });
        let h = INTERVAL / f64::from(*steps);
        let cost = time(effort, velocities.len(), || {
            let mut z = 0.0;
            for v in &velocities {
                z = step(z, *black_box(v), h.min(1e-5));
            }
            black_box(z);
        });
        points.push((h, error, cost.median));
    }
    Course { name: "explicit Euler", points }
}

/// The stick-slip of a mass on a spring: greatest error of the position \[m\], and nanoseconds per step.
fn stick_slip(reference: &[f64], h: f64, effort: Effort, passive: bool) -> Result<(f64, f64), Failure> {
    let every = (0.1 / h).round() as u64;
    let law = LuGre::reference()?;
    let mut state = Bristle::<f64, _, 1>::new(law);
    let (mut x, mut v, mut z, mut worst) = (0.0, 0.0, 0.0, 0.0_f64);
    let mut step = |time: f64, x: &mut f64, v: &mut f64| {
        if passive {
            let pull = 2.0 * (0.1 * (time + h) - *x);
            let drive = Drive { mass: Vector1::new(1.0), force: Vector1::new(pull), stiffness: 2.0 };
            *v = state.step_body(&Vector1::new(*v), &drive, h).velocity[0];
            *x += h * *v;
        } else {
            let rate = *v - 1e5 * v.abs() * z / steady(*v);
            let force = 2.0 * (0.1 * time - *x) - (1e5 * z + 1e5_f64.sqrt() * rate + 0.4 * *v);
            *x += h * *v;
            *v += h * force;
            z += h * rate;
        }
    };
    'motion: for (index, exact) in reference.iter().enumerate().skip(1) {
        for inner in 0..every {
            step(h * ((index as u64 - 1) * every + inner) as f64, &mut x, &mut v);
        }
        worst = if x.is_finite() { worst.max((x - exact).abs()) } else { f64::INFINITY };
        if worst.is_infinite() {
            break 'motion;
        }
    }
    let cost = time(effort, 256, || {
        let (mut x, mut v) = (0.0, 0.0);
        for k in 0..256 {
            step(black_box(h * f64::from(k)), &mut x, &mut v);
        }
        black_box((x, v));
    });
    Ok((worst, cost.median))
}

fn series(courses: &[Course], cost: bool) -> Vec<Series> {
    courses
        .iter()
        .map(|course| Series {
            name: course.name.to_owned(),
            points: course
                .points
                .iter()
                .map(|(h, error, ns)| {
                    // Microseconds of work for a second of motion.
                    (if cost { ns * 1e-3 / h } else { *h }, error.clamp(1e-12, DIVERGED))
                })
                .collect(),
            joined: true,
            ..Series::default()
        })
        .collect()
}

fn data(courses: &[Course], unit: &str) -> Table {
    let mut table = Table::new(&["integrator", "step s", unit, "ns per step", "µs per second of motion"]);
    for course in courses {
        for (h, error, ns) in &course.points {
            let error = if error.is_finite() { format!("{error:.3e}") } else { "diverges".to_owned() };
            table.row([
                course.name.to_owned(),
                format!("{h:.2e}"),
                error,
                format!("{ns:.2}"),
                format!("{:.1}", ns * 1e-3 / h),
            ]);
        }
    }
    table
}

/// A row for each integrator: its cost, and its error at three steps.
fn in_short(courses: &[Course], body: &[Course]) -> Table {
    let mut short = Table::new(&["integrator", "ns per step", "error at 1e-2 s", "at 1e-3 s", "at 1e-4 s"]);
    for course in courses.iter().chain(body) {
        let at = |h: f64| {
            let point = course.points.iter().find(|p| (p.0 / h - 1.0).abs() < 1e-6);
            point.map_or_else(|| "-".to_owned(), |p| shown(if p.1 < DIVERGED { p.1 } else { f64::INFINITY }))
        };
        let mut costs: Vec<f64> = course.points.iter().map(|p| p.2).collect();
        let motion =
            if course.points.len() == body[0].points.len() && body.iter().any(|b| core::ptr::eq(b, course)) {
                "stick-slip, m"
            } else {
                "prescribed"
            };
        let name = format!("{} ({motion})", course.name);
        short.row([name, shown(crate::timing::median(&mut costs)), at(1e-2), at(1e-3), at(1e-4)]);
    }
    short
}

pub(crate) fn report(page: &mut Page, effort: Effort) -> Result<Part, Failure> {
    page.heading("Dynamic friction: the integrators");
    page.say(
        "LuGre friction with the parameters of Canudas de Wit et al. 1995, moved to and fro at up to 0.1 m/s, \
         against Radau's method at a relative tolerance of 1e-9. Explicit Euler is the bad example: it \
         diverges above a step of about 2e-4 s, where the others stay bounded. The return map is another \
         law, without memory of the rate, and differs from LuGre at every step.",
    );
    let exact = reference::moved(velocity, DURATION, INTERVAL)?;
    let all = [1_u32, 2, 5, 10, 20, 40, 100, 300, 1000, 3000];
    let counts = &all[..effort.choose(7, 10)];
    let courses = [
        bristle::<Exponential>("exponential, mid-point", 0.5, &exact, counts, effort)?,
        bristle::<Implicit>("implicit", 1.0, &exact, counts, effort)?,
        bristle::<ReturnMap>("return map", 1.0, &exact, counts, effort)?,
        euler(&exact, counts, effort),
    ];
    let error = "greatest error of the elastic force over break-away";
    page.diagram(
        "integrators_cost",
        &Diagram {
            title: "Prescribed motion: error over the work for a second of motion".to_owned(),
            x: "work for one second of motion, µs",
            y: "error of the force over break-away (cut off at 1e4)",
            series: series(&courses, true),
            front: true,
        },
    )?;
    page.diagram(
        "integrators_step",
        &Diagram {
            title: "Prescribed motion: error over the step".to_owned(),
            x: "step, s",
            y: "error of the force over break-away (cut off at 1e4)",
            series: series(&courses, false),
            front: false,
        },
    )?;
    page.data("integrators", &data(&courses, error));

    let positions = reference::stick_slip()?;
    let steps = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
    let steps = &steps[..effort.choose(3, 5)];
    let body = [("passive step", true), ("explicit Euler", false)]
        .into_iter()
        .map(|(name, passive)| {
            let points = steps
                .iter()
                .map(|h| stick_slip(&positions, *h, effort, passive).map(|(error, ns)| (*h, error, ns)))
                .collect::<Result<_, _>>()?;
            Ok(Course { name, points })
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    page.diagram(
        "stick_slip_cost",
        &Diagram {
            title: "Stick-slip of a mass on a spring: error over the work for a second of motion".to_owned(),
            x: "work for one second of motion, µs",
            y: "greatest error of the position, m (cut off at 1e4)",
            series: series(&body, true),
            front: true,
        },
    )?;
    page.data("stick_slip", &data(&body, "greatest error of the position m"));

    let short = in_short(&courses, &body);
    Ok((
        "Dynamic friction".to_owned(),
        format!("Error of the force over break-away, or of the position.\n\n{}", short.markdown()),
    ))
}
