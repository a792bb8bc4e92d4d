//! LuGre friction as a stiff differential equation, solved by Radau's method: the reference of the
//! tests and of the slip report, which shares no code with the crate.

use differential_equations::prelude::{IVP, ImplicitRungeKutta, Matrix, ODE};

/// The parameters of Canudas de Wit et al. 1995.
const STIFFNESS: f64 = 1e5;
const VISCOUS: f64 = 0.4;
/// The deflection in units of 10 µm evens the tolerances.
const UNIT: f64 = 1e-5;

/// The bell of the Stribeck curve, and g.
fn stribeck(v: f64) -> (f64, f64) {
    let bell = 0.5 * (-(v / 1e-3) * (v / 1e-3)).exp();
    (bell, 1.0 + bell)
}

/// The benchmark of `docs/theory/friction.md#a-body-held-by-friction`: a mass of 1 kg pulled through a spring
/// of 2 N/m whose end moves at 0.1 m/s. States: position, velocity, deflection.
struct StickSlip;

impl ODE<f64, [f64; 3]> for StickSlip {
    fn diff(&self, t: f64, y: &[f64; 3], dydt: &mut [f64; 3]) {
        let (v, z) = (y[1], y[2] * UNIT);
        let rate = v - STIFFNESS * v.abs() * z / stribeck(v).1;
        dydt[0] = v;
        dydt[1] = 2.0 * (0.1 * t - y[0]) - (STIFFNESS * z + STIFFNESS.sqrt() * rate + VISCOUS * v);
        dydt[2] = rate / UNIT;
    }

    fn jacobian(&self, _t: f64, y: &[f64; 3], j: &mut Matrix<f64>) {
        let (v, z) = (y[1], y[2] * UNIT);
        let (bell, g) = stribeck(v);
        let slope = -2.0 * v / 1e-6 * bell;
        let of_v = 1.0 - STIFFNESS * z * (v.signum() / g - v.abs() * slope / (g * g));
        let of_z = -STIFFNESS * v.abs() / g;
        let damping = STIFFNESS.sqrt();
        for row in 0..3 {
            for column in 0..3 {
                j[(row, column)] = 0.0;
            }
        }
        j[(0, 1)] = 1.0;
        j[(1, 0)] = -2.0;
        j[(1, 1)] = -damping * of_v - VISCOUS;
        j[(1, 2)] = -(STIFFNESS + damping * of_z) * UNIT;
        j[(2, 1)] = of_v / UNIT;
        j[(2, 2)] = of_z;
    }
}

/// The positions \[m\] of the benchmark every 0.1 s for 20 s.
pub(crate) fn stick_slip() -> Result<Vec<f64>, String> {
    let solution = IVP::ode(&StickSlip, 0.0, 20.0, [0.0, 0.0, 0.0])
        .even(0.1)
        .method(ImplicitRungeKutta::radau5().rtol(1e-9).atol(1e-11).h0(1e-7).max_steps(10_000_000))
        .solve()
        .map_err(|fault| format!("{fault:?}"))?;
    Ok(solution.iter().map(|(_, y)| y[0]).collect())
}

/// The same bristle moved by a prescribed velocity. State: deflection.
struct Moved<V>(V);

impl<V: Fn(f64) -> f64> ODE<f64, [f64; 1]> for Moved<V> {
    fn diff(&self, t: f64, y: &[f64; 1], dydt: &mut [f64; 1]) {
        let v = (self.0)(t);
        dydt[0] = (v - STIFFNESS * v.abs() * y[0] * UNIT / stribeck(v).1) / UNIT;
    }

    fn jacobian(&self, t: f64, _y: &[f64; 1], j: &mut Matrix<f64>) {
        let v = (self.0)(t);
        j[(0, 0)] = -STIFFNESS * v.abs() / stribeck(v).1;
    }
}

/// The deflections \[m\] of the bristle under a prescribed velocity, at even times.
pub(crate) fn moved(velocity: impl Fn(f64) -> f64, end: f64, interval: f64) -> Result<Vec<f64>, String> {
    let solution = IVP::ode(&Moved(velocity), 0.0, end, [0.0])
        .even(interval)
        .method(ImplicitRungeKutta::radau5().rtol(1e-9).atol(1e-11).h0(1e-9).max_steps(10_000_000))
        .solve()
        .map_err(|fault| format!("{fault:?}"))?;
    Ok(solution.iter().map(|(_, y)| y[0] * UNIT).collect())
}
