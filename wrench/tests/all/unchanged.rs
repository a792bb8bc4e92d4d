//! What solvers, their bounds, frames and lines of action answer is held bit for bit.

use core::fmt::Debug;

use fingertip_test_support::Unchanged;
use fingertip_wrench::*;
use nalgebra::{Matrix6, SMatrix, SVector, Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn unchanged(file: &str) -> Unchanged {
    Unchanged::new(env!("CARGO_MANIFEST_DIR"), &format!("tests/unchanged/{file}.txt"))
}

/// Draws by sums and products alone, so that the numbers are the same on every system.
struct Draw(Pcg64Mcg);

impl Draw {
    fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    fn signed(&mut self) -> f64 {
        2.0 * self.0.random::<f64>() - 1.0
    }

    /// From 1 down to 4^-most.
    fn small(&mut self, most: u32) -> f64 {
        (0..self.0.random_range(0..=most)).fold(1.0, |value, _| value * 0.25)
    }

    /// A sensor: of any entries, of some that are tiny, of axes that are nearly one, with loads of all sizes.
    fn sensor<T: Real, const N: usize>(&mut self, kind: usize) -> Option<SensorMatrix<T, N>> {
        let mut c = SMatrix::<f64, N, 6>::from_fn(|_, _| self.signed());
        match kind % 4 {
            1 => c = c.map(|x| x * self.small(12)),
            2 => {
                let (close, apart) = (kind / 4 % 5, self.small(20));
                let blend = c.column(close) * (1.0 - apart) + c.column(5) * apart;
                c.set_column(5, &blend);
            }
            3 => c = c.map(|x| if x.abs() < 0.4 { 0.0 } else { x }),
            _ => {}
        }
        let scale = [1.0, 1e-6, 1e9][kind / 3 % 3];
        let nominal = Vector6::from_fn(|_, _| 10.0 * self.small(8));
        SensorMatrix::new((c * scale).map(T::literal), nominal.map(T::literal)).ok()
    }

    fn signals<T: Real, const N: usize>(&mut self, sensor: &SensorMatrix<T, N>) -> SVector<T, N> {
        let load = Vector6::from_fn(|i, _| sensor.nominal()[i] * T::literal(self.signed() * self.small(6)));
        let exact = sensor.normalised() * load.zip_map(sensor.nominal(), |x, nominal| x / nominal);
        exact.map(|x| x * T::literal(1.0 + 1e-3 * self.signed()))
    }
}

/// Everything that is told of a solver, or why it could not be had.
fn of_solver<T: Real, const N: usize, S: WrenchSolver<T, N>, E: Debug>(
    sensor: &SensorMatrix<T, N>,
    solver: Result<S, E>,
    signals: &SVector<T, N>,
) -> String {
    let solver = match solver {
        Ok(solver) => solver,
        Err(error) => return format!("{error:?}"),
    };
    let wrench = solver.solve(signals);
    let noise = SVector::repeat(sensor.normalised().amax() * T::literal(1e-3));
    let uncertain = Uncertainty::of_signals(noise).with_relative_matrix_error(sensor, T::literal(1e-3));
    let bound = [Uncertainty::none(), uncertain].map(|uncertainty| {
        ErrorBound::new(sensor, &solver, &uncertainty).map(|bound| bound.at(signals, &wrench))
    });
    let covariance = WrenchCovariance::from_noise(sensor, &solver, &noise).and_then(|covariance| {
        let more = covariance.with_matrix_deviations(sensor, &SMatrix::repeat(T::literal(1e-3)))?;
        Ok(more.at(&wrench))
    });
    format!("{wrench:?} {bound:?} {covariance:?}")
}

/// Sensors whose combinations see little but their own loads, and some that see more.
fn decoupled<T: Real, K: Combination<N>, const N: usize>(
    unchanged: &mut Unchanged,
    name: &str,
    draw: &mut Draw,
) {
    let combined = SMatrix::<f64, 6, N>::from_fn(|i, j| K::MATRIX[i][j]);
    let apart = (combined * combined.transpose()).try_inverse().unwrap_or_else(Matrix6::zeros);
    let answers = (0..100).map(|k| {
        let kept = Matrix6::from_fn(|i, j| match (i == j, K::KEPT[i][j]) {
            (true, _) => 1.0 + 0.5 * draw.signed(),
            (_, true) => 0.3 * draw.signed(),
            _ => 0.05 * draw.signed() * draw.small(6) * [1.0, 0.0, 6.0][k % 3],
        });
        let c = combined.transpose() * apart * kept;
        let nominal = Vector6::from_fn(|_, _| T::literal(10.0 * draw.small(4)));
        let sensor = SensorMatrix::<T, N>::new(c.map(T::literal), nominal);
        sensor.map_or_else(
            |error| format!("{error:?}"),
            |sensor| {
                let signals = draw.signals(&sensor);
                let solver = Decoupled::<T, K, N>::new(&sensor);
                let neglected = solver.as_ref().ok().map(|solver| *solver.neglected());
                format!("{neglected:?} {}", of_solver(&sensor, solver, &signals))
            },
        )
    });
    unchanged.note(name, answers);
}

fn solvers_of<T: Real>(unchanged: &mut Unchanged, kind: &str) {
    let mut draw = Draw::new(81);
    let six: Vec<_> = (0..150)
        .filter_map(|kind| {
            let sensor = draw.sensor::<T, 6>(kind)?;
            let signals = draw.signals(&sensor);
            Some((sensor, signals))
        })
        .collect();
    let mut note = |name: &str, of: &dyn Fn(&SensorMatrix<T, 6>, &SVector<T, 6>) -> String| {
        unchanged.note(&format!("{name} {kind}"), six.iter().map(|(sensor, signals)| of(sensor, signals)));
    };
    note("gaussian", &|sensor, signals| of_solver(sensor, GaussianElimination::new(sensor), signals));
    note("inverse", &|sensor, signals| {
        let inverse = Inverse::new(sensor);
        let growth = inverse.as_ref().ok().map(Inverse::residual_growth);
        format!("{growth:?} {}", of_solver(sensor, inverse, signals))
    });
    note("refined", &|sensor, signals| of_solver(sensor, Refined::new(sensor), signals));
    note("conditioning", &|sensor, _| {
        let told = Conditioning::of(sensor);
        let bounds = [1e-9, 1e-3].map(|x| told.relative_error_bound(T::literal(x), T::literal(x)));
        format!("{told:?} {:?} {bounds:?}", told.condition_number())
    });
    let eight: Vec<_> = (0..100)
        .filter_map(|kind| {
            let sensor = draw.sensor::<T, 8>(kind)?;
            let signals = draw.signals(&sensor);
            Some((sensor, signals))
        })
        .collect();
    let noise = SVector::<T, 8>::from_fn(|i, _| T::literal(1e-3 * (1.0 + i as f64)));
    unchanged.note(
        &format!("least squares {kind}"),
        eight.iter().map(|(sensor, signals)| {
            let weighted = of_solver(sensor, LeastSquares::weighted(sensor, &noise), signals);
            let plain = LeastSquares::new(sensor);
            let told = plain.as_ref().ok().map(|solver| {
                let gauge = |g: usize| {
                    let repaired = (solver.repaired(signals, g), solver.solve_without(signals, g));
                    (solver.redundancy(g), solver.predicted(signals, g), repaired)
                };
                let mut broken = *signals;
                broken[3] *= T::literal(1.7);
                let check = ConsistencyCheck::new(solver, &(noise * signals.amax()), 1e-3);
                let verdicts = check.map(|check| {
                    let of = [*signals, broken].map(|signals| check.verdict(solver, &signals));
                    (of, *check.residual_limit())
                });
                ([0, 3, 7].map(gauge), solver.residual(signals), verdicts)
            });
            format!("{weighted} {} {told:?}", of_solver(sensor, plain, signals))
        }),
    );
    decoupled::<T, BicchiDario, 6>(unchanged, &format!("bicchi-dario {kind}"), &mut draw);
    decoupled::<T, ThreeRosettes, 6>(unchanged, &format!("three rosettes {kind}"), &mut draw);
    decoupled::<T, FourRosettes, 8>(unchanged, &format!("four rosettes {kind}"), &mut draw);
    let load = |i: u8, j: u8| {
        Vector6::from_fn(|k, _| T::literal(0.01 * (1.0 + (usize::from(i * 7 + j * 3) + k) as f64)))
    };
    let pairs = (0..6_u8).flat_map(|i| (i..6).map(move |j| ProductTerm::of_two(i, j, load(i, j))));
    let centre = SVector::from_fn(|i, _| T::literal(0.1 * i as f64));
    let curved =
        CurvedInverse::new(SMatrix::from_fn(|_, _| T::literal(draw.signed())), pairs.collect::<Vec<_>>())
            .and_then(|curved| {
                curved
                    .with_radial(SVector::repeat(T::literal(1.5)), [RadialTerm { centre, load: load(1, 2) }])
            })
            .unwrap_or_else(|error| panic!("{error}"));
    unchanged.note(
        &format!("curved {kind}"),
        six.iter().map(|(_, signals)| (curved.solve(signals), curved.jacobian(signals))),
    );
}

#[test]
fn solvers() {
    let mut unchanged = unchanged("solvers");
    solvers_of::<f64>(&mut unchanged, "f64");
    solvers_of::<f32>(&mut unchanged, "f32");
    unchanged.check();
}

fn loads_of<T: Real>(unchanged: &mut Unchanged, kind: &str) {
    let mut draw = Draw::new(83);
    let answers = (0..400).map(|k| {
        let mut vector = |size: f64| Vector3::from_fn(|_, _| T::literal(draw.signed() * size));
        let scale = [1.0, 1e-15, 1e15, 1e-3][k % 4];
        let (force, torque) = (vector(scale), vector(scale * [0.01, 30.0][k / 4 % 2]));
        let wrench: Wrench<T> = Wrench::on_fingertip(force, torque);
        let (axis, place, normal) = (vector(1.0), vector(0.1), vector(1.0));
        let pose = RigidTransform::<T>::from_axis_angle(axis, place);
        let moved = pose.as_ref().ok().map(|pose| wrench.expressed_in(pose));
        let frame = ContactFrame::new(place, normal).map(|frame| {
            let load = frame.decompose(&wrench);
            let back: Wrench<T> = frame.compose(&load);
            (frame.normal(), frame.tangents(), load, back)
        });
        let payload = Payload::new(T::literal(0.3), place).map(|payload| {
            let gravity = normal * T::literal(9.81);
            let motion = Motion { gravity, angular_velocity: axis, angular_acceleration: normal };
            (payload.weight(&gravity), payload.load(&motion))
        });
        (wrench.line_of_action(), wrench.torque_about(&place), moved, frame, payload)
    });
    unchanged.note(&format!("loads {kind}"), answers);
}

#[test]
fn loads() {
    let mut unchanged = unchanged("loads");
    loads_of::<f64>(&mut unchanged, "f64");
    loads_of::<f32>(&mut unchanged, "f32");
    let mut draw = Draw::new(87);
    unchanged.note(
        "singular values",
        (0..60).map(|k| {
            let tall = SMatrix::<f64, 8, 6>::from_fn(|_, _| draw.signed() * draw.small(10));
            let square = Matrix6::from_fn(|i, j| if k % 2 == 0 { draw.signed() } else { tall[(i, j)] });
            (singular_values(&square), singular_values(&tall))
        }),
    );
    unchanged.check();
}
