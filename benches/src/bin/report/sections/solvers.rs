//! Signals to wrench: error against run time, condition by condition, and which solver to pick.

use core::hint::black_box;

use faer::linalg::solvers::{PartialPivLu, Solve};
use fingertip_wrench::{
    BicchiDario, Decoupled, GaussianElimination, Inverse, LeastSquares, Real, Refined, SensorMatrix, Wrench,
    WrenchSolver,
};
use nalgebra::{Matrix6, Vector6};
use rand_pcg::Pcg64Mcg;

use super::Part;
use crate::Failure;
use crate::page::Page;
use crate::plots::{Diagram, Series};
use crate::stability::big::Big;
use crate::stability::solvers::support::{
    cast, generator, normal, of_condition, random_vector, sensor, wide,
};
use crate::stability::solvers::{differences, exact, paper};
use crate::table::{Table, shown};
use crate::timing::{Effort, Timed, median, time};

const SIGNALS: usize = 32;

/// One solver in one precision on one sensor.
struct Figure {
    solver: &'static str,
    scalar: &'static str,
    condition: f64,
    /// Median and greatest error, relative to the load.
    error: f64,
    worst: f64,
    /// Median error from signals that are off by one part in one of themselves.
    amplification: f64,
    timed: Timed,
}

/// The inputs that all solvers share: signals with their exact loads.
struct Inputs<T: Real> {
    sensor: SensorMatrix<T, 6>,
    signals: Vec<Vector6<T>>,
    exact: Vec<Vec<Big>>,
    condition: f64,
}

fn inputs<T: Real>(
    sensor: SensorMatrix<T, 6>,
    condition: f64,
    random: &mut Pcg64Mcg,
) -> Result<Inputs<T>, Failure> {
    let matrix = wide(sensor.normalised());
    let signals: Vec<Vector6<T>> =
        (0..SIGNALS).map(|_| cast(&(matrix * random_vector::<6>(random)))).collect();
    let exact = signals
        .iter()
        .map(|signals| exact(&sensor, signals).ok_or("a singular sensor"))
        .collect::<Result<_, _>>()?;
    Ok(Inputs { sensor, signals, exact, condition })
}

impl<T: Real> Inputs<T> {
    /// Times and scores `solve`, which gives wrenches.
    fn measure(
        &self,
        effort: Effort,
        (solver, scalar): (&'static str, &'static str),
        solve: impl Fn(&Vector6<T>) -> Wrench<T>,
    ) -> Figure {
        let mut errors: Vec<f64> = self
            .signals
            .iter()
            .zip(&self.exact)
            .map(|(signals, exact)| {
                let size = exact.iter().map(|x| x.to_f64().abs()).fold(0.0, f64::max);
                differences(&self.sensor, &solve(signals), exact).amax() / size
            })
            .collect();
        let worst = errors.iter().copied().fold(0.0, f64::max);
        let timed = time(effort, SIGNALS, || {
            for signals in &self.signals {
                black_box(solve(black_box(signals)));
            }
        });
        // An error of zero has no place on a logarithmic axis.
        let floor = T::EPSILON.to_f64() / 16.0;
        Figure {
            solver,
            scalar,
            condition: self.condition,
            error: median(&mut errors).max(floor),
            worst: worst.max(floor),
            amplification: self.amplification(),
            timed,
        }
    }

    /// What noise of the size of the signals does to the load, in the median: times the relative
    /// noise it is the relative error.
    fn amplification(&self) -> f64 {
        let mut random = generator(77);
        let Some(inverse) = wide(self.sensor.normalised()).try_inverse() else { return f64::NAN };
        let mut ratios: Vec<f64> = self
            .signals
            .iter()
            .zip(&self.exact)
            .map(|(signals, exact)| {
                let scale = wide(signals).amax();
                let noise = Vector6::from_fn(|_, _| scale * normal(&mut random));
                let size = exact.iter().map(|x| x.to_f64().abs()).fold(0.0, f64::max);
                (inverse * noise).amax() / size
            })
            .collect();
        median(&mut ratios)
    }
}

/// Ours and nalgebra's.
fn common<T: Real>(inputs: &Inputs<T>, effort: Effort, scalar: &'static str, figures: &mut Vec<Figure>) {
    let sensor = &inputs.sensor;
    macro_rules! ours {
        ($name:literal, $solver:expr) => {
            if let Ok(solver) = $solver {
                figures.push(inputs.measure(effort, ($name, scalar), |s| solver.solve(s)));
            }
        };
    }
    ours!("Gauss", GaussianElimination::new(sensor));
    ours!("Gauss refined", Refined::new(sensor));
    ours!("Inverse", Inverse::new(sensor));
    ours!("LeastSquares", LeastSquares::new(sensor));
    let factors = sensor.normalised().lu();
    let nominal = *sensor.nominal();
    figures.push(inputs.measure(effort, ("nalgebra LU", scalar), |signals| {
        let load = factors.solve(signals).unwrap_or_else(Vector6::zeros);
        Wrench::from_components(&load.component_mul(&nominal))
    }));
}

/// faer's, of which each scalar is a type of its own.
macro_rules! faer {
    ($scalar:ty, $inputs:expr, $effort:expr, $name:literal, $figures:expr) => {{
        let matrix: Matrix6<$scalar> = *$inputs.sensor.normalised();
        let nominal = *$inputs.sensor.nominal();
        let matrix = faer::Mat::from_fn(6, 6, |i, j| matrix[(i, j)]);
        let factors = PartialPivLu::new(matrix.as_ref());
        $figures.push($inputs.measure($effort, ("faer LU", $name), |signals| {
            let right = faer::Mat::from_fn(6, 1, |i, _| signals[i]);
            let load = factors.solve(&right);
            Wrench::from_components(&Vector6::from_fn(|i, _| load[(i, 0)] * nominal[i]))
        }));
    }};
}

fn both(
    matrix: &Matrix6<f64>,
    condition: f64,
    effort: Effort,
    figures: &mut Vec<Figure>,
) -> Result<(), Failure> {
    let mut random = generator(condition.to_bits().into());
    let single = inputs::<f32>(sensor(matrix), condition, &mut random)?;
    common(&single, effort, "f32", figures);
    faer!(f32, single, effort, "f32", figures);
    let double = inputs::<f64>(sensor(matrix), condition, &mut random)?;
    common(&double, effort, "f64", figures);
    faer!(f64, double, effort, "f64", figures);
    Ok(())
}

/// The paper's sensor, which the decoupled solver is for.
fn decoupled<T: Real>(
    scalar: &'static str,
    effort: Effort,
    figures: &mut Vec<Figure>,
) -> Result<(), Failure> {
    for (name, machining) in [
        ("Decoupled, as drawn", 0.0),
        ("Decoupled, machined to 0.1 %", 1e-3),
        ("Decoupled, machined to 1 %", 1e-2),
    ] {
        let mut random = generator(5);
        let sensor = paper::<T>(machining, &mut random).ok_or("no sensor")?;
        let inputs = inputs(sensor, 4.8, &mut random)?;
        if machining == 0.0 {
            common(&inputs, effort, scalar, figures);
        }
        let solver = Decoupled::<T, BicchiDario, 6>::new(&inputs.sensor)?;
        figures.push(inputs.measure(effort, (name, scalar), |signals| solver.solve(signals)));
    }
    Ok(())
}

fn against_time(title: String, figures: &[&Figure]) -> Diagram {
    let series = figures
        .iter()
        .map(|figure| Series {
            name: format!("{} {}", figure.solver, figure.scalar),
            points: vec![(figure.timed.median, figure.error)],
            spread: vec![(figure.timed.lower_quartile, figure.timed.upper_quartile)],
            joined: false,
            single: figure.scalar == "f32",
        })
        .collect();
    Diagram { title, x: "time per solve, ns", y: "median relative error of the load", series, front: true }
}

fn against_condition(figures: &[Figure]) -> Diagram {
    let mut series: Vec<Series> = Vec::new();
    for figure in figures {
        let name = format!("{} {}", figure.solver, figure.scalar);
        let index = series.iter().position(|s| s.name == name).unwrap_or_else(|| {
            let single = figure.scalar == "f32";
            series.push(Series { name, joined: true, single, ..Series::default() });
            series.len() - 1
        });
        // Beyond one, nothing is right and nothing is worth drawing.
        series[index].points.push((figure.condition, figure.worst.min(10.0)));
    }
    Diagram {
        title: "Solvers: greatest error over the condition of the sensor matrix".to_owned(),
        x: "condition number",
        y: "greatest relative error of the load (cut off at 10)",
        series,
        front: false,
    }
}

fn data(figures: &[Figure]) -> Table {
    let head = [
        "solver",
        "scalar",
        "condition",
        "median relative error",
        "greatest relative error",
        "median ns",
        "lower quartile ns",
        "upper quartile ns",
        "least ns",
        "amplification of relative noise",
    ];
    let mut table = Table::new(&head);
    for f in figures {
        let t = &f.timed;
        table.row([
            f.solver.to_owned(),
            f.scalar.to_owned(),
            format!("{:e}", f.condition),
            format!("{:.3e}", f.error),
            format!("{:.3e}", f.worst),
            format!("{:.2}", t.median),
            format!("{:.2}", t.lower_quartile),
            format!("{:.2}", t.upper_quartile),
            format!("{:.2}", t.least),
            format!("{:.3e}", f.amplification),
        ]);
    }
    table
}

/// The cheapest solver whose own error is below a tenth of what the noise does; of those that are
/// within a tenth of its time, the most exact.
fn pick(figures: &[&Figure], noise: f64) -> String {
    let good = || {
        figures
            .iter()
            .filter(|f| !f.solver.starts_with("Decoupled") && !f.solver.ends_with("LU"))
            .filter(|f| f.worst < 0.1 * noise * f.amplification)
    };
    let least = good().map(|f| f.timed.median).fold(f64::INFINITY, f64::min);
    good().filter(|f| f.timed.median <= 1.1 * least).min_by(|a, b| a.worst.total_cmp(&b.worst)).map_or_else(
        || "none: the signals are better than the arithmetic".to_owned(),
        |f| {
            let caused = noise * f.amplification;
            if caused > 0.3 {
                return "none helps: the noise alone is above 30 % of the load".to_owned();
            }
            format!("{} {} ({} % from noise)", f.solver, f.scalar, shown(100.0 * caused))
        },
    )
}

/// Where numerical error stops to matter, and what to pick.
fn decisions(conditions: &[f64], figures: &[Figure]) -> Table {
    let head = [
        "condition",
        "Gauss f32 is enough above a noise of",
        "Gauss f64 is enough above",
        "12 bits of signal (2.4e-4)",
        "16 bits (1.5e-5)",
        "24 bits (6e-8)",
    ];
    let mut table = Table::new(&head);
    for condition in conditions {
        let these: Vec<&Figure> = figures.iter().filter(|f| f.condition == *condition).collect();
        let enough = |scalar: &str| {
            these
                .iter()
                .find(|f| f.solver == "Gauss" && f.scalar == scalar)
                .map_or_else(|| "refused".to_owned(), |f| shown(10.0 * f.worst / f.amplification))
        };
        table.row([
            format!("{condition:.0e}"),
            enough("f32"),
            enough("f64"),
            pick(&these, 2.0_f64.powi(-12)),
            pick(&these, 2.0_f64.powi(-16)),
            pick(&these, 2.0_f64.powi(-24)),
        ]);
    }
    table
}

pub(crate) fn report(page: &mut Page, effort: Effort) -> Result<Part, Failure> {
    page.heading("Signals to wrench: the solvers");
    page.say(
        "The same random sensor matrices and signals for all, prefactored; errors are relative to the \
         largest load component, against arithmetic of 220 bits that solves for the signals as the scalar \
         type has them. faer and nalgebra are there for comparison.",
    );
    let decades: Vec<i32> = if effort.quick { vec![0, 6, 12] } else { (0..=12).collect() };
    let conditions: Vec<f64> = decades.iter().map(|decade| 10_f64.powi(*decade)).collect();
    let mut figures = Vec::new();
    for condition in &conditions {
        let mut random = generator(7 + u128::from(condition.to_bits()));
        both(&of_condition::<6>(&mut random, *condition), *condition, effort, &mut figures)?;
    }
    let mut paper = Vec::new();
    decoupled::<f32>("f32", effort, &mut paper)?;
    decoupled::<f64>("f64", effort, &mut paper)?;
    let all: Vec<&Figure> = paper.iter().collect();
    let title = "The sensor of Bicchi & Dario 1987 (condition 4.8): error over run time";
    page.diagram("solvers_paper", &against_time(title.to_owned(), &all))?;
    for condition in [1.0, 1e6, 1e12] {
        let these: Vec<&Figure> = figures.iter().filter(|f| f.condition == condition).collect();
        let title = format!("Random sensors of condition {condition:.0e}: error over run time");
        page.diagram(&format!("solvers_{condition:e}"), &against_time(title, &these))?;
    }
    page.diagram("solvers_condition", &against_condition(&figures))?;
    page.subheading("Which solver to pick");
    page.say(
        "Noise of the signals is stated relative to the largest signal. Numerical error stops mattering where \
         it is below a tenth of the error that the noise causes; the cheapest solver of which that is true \
         is named, with the error that the noise causes. A solver that is refused says at construction that the matrix is singular to the type.",
    );
    let table = decisions(&conditions, &figures);
    page.table(&table);
    page.data("solver_decisions", &table);
    let mut everything = data(&figures);
    data(&paper).rows().iter().for_each(|row| everything.row(row.clone()));
    page.data("solvers", &everything);

    let mut short = Table::new(&["solver", "f32 ns", "f32 error", "f64 ns", "f64 error"]);
    let mut names: Vec<&str> = paper.iter().map(|f| f.solver).collect();
    names.dedup();
    names.truncate(names.len() / 2);
    for name in names {
        let cell = |scalar: &str| {
            paper
                .iter()
                .find(|f| f.solver == name && f.scalar == scalar)
                .map_or(("-".to_owned(), "-".to_owned()), |f| (shown(f.timed.median), shown(f.worst)))
        };
        let (single, double) = (cell("f32"), cell("f64"));
        short.row([name.to_owned(), single.0, single.1, double.0, double.1]);
    }
    let said = format!(
        "The sensor of Bicchi & Dario 1987; greatest relative error of the load.\n\n{}\nWhich solver to pick, \
         by the condition of the sensor matrix and the noise of its signals:\n\n{}",
        short.markdown(),
        table.markdown()
    );
    Ok(("Signals to wrench".to_owned(), said))
}
