//! The same cone program by another's solver: `clarabel`, built here from the contacts and not from our grasp map.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use fingertip_hand::{FingerLimits, Grasp};
use fingertip_wrench::Wrench;
use nalgebra::{DMatrix, Vector3, Vector6};

use crate::support::TestHand;

/// What the oracle says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Oracle {
    Held { cost: f64, steps: u32 },
    CannotHold { steps: u32 },
    Unclear,
}

/// What the oracle says of how many times a disturbance can be borne.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum OracleReach {
    Times(f64),
    Unlimited,
    NotHeld,
    Unclear,
}

/// A joint: what a wrench on the fingertip is as torque, and the greatest torque.
pub(crate) type Joint = (Vector6<f64>, f64);

/// The least cost.
pub(crate) fn solve<const N: usize, const ROWS: usize>(
    grasp: &Grasp<f64, N, TestHand>,
    limits: &[FingerLimits<f64, ROWS>; N],
    load: &Wrench<f64, TestHand>,
) -> Oracle {
    solve_with_joints(grasp, limits, &[const { Vec::new() }; N], load)
}

/// The least cost where joints are limited, too.
pub(crate) fn solve_with_joints<const N: usize, const ROWS: usize>(
    grasp: &Grasp<f64, N, TestHand>,
    limits: &[FingerLimits<f64, ROWS>; N],
    joints: &[Vec<Joint>; N],
    load: &Wrench<f64, TestHand>,
) -> Oracle {
    match program(grasp, limits, joints, load, None) {
        (SolverStatus::Solved, cost, steps) => Oracle::Held { cost, steps },
        (SolverStatus::PrimalInfeasible, _, steps) => Oracle::CannotHold { steps },
        _ => Oracle::Unclear,
    }
}

/// The greatest multiple of a disturbance, one more unknown of the program.
pub(crate) fn reach<const N: usize, const ROWS: usize>(
    grasp: &Grasp<f64, N, TestHand>,
    limits: &[FingerLimits<f64, ROWS>; N],
    load: &Wrench<f64, TestHand>,
    disturbance: &Wrench<f64, TestHand>,
) -> OracleReach {
    match program(grasp, limits, &[const { Vec::new() }; N], load, Some(disturbance)) {
        (SolverStatus::Solved, value, _) => OracleReach::Times(-value),
        (SolverStatus::PrimalInfeasible, ..) => OracleReach::NotHeld,
        (SolverStatus::DualInfeasible, ..) => OracleReach::Unlimited,
        _ => OracleReach::Unclear,
    }
}

/// Unknowns of a contact: force on the object along the normal and two tangents, spin torque over the arm. With a
/// disturbance its multiple comes last, and is what is maximised.
fn program<const N: usize, const ROWS: usize>(
    grasp: &Grasp<f64, N, TestHand>,
    limits: &[FingerLimits<f64, ROWS>; N],
    joints: &[Vec<Joint>; N],
    load: &Wrench<f64, TestHand>,
    disturbance: Option<&Wrench<f64, TestHand>>,
) -> (SolverStatus, f64, u32) {
    let touching = grasp.contacts().iter().zip(limits.iter().zip(joints));
    let contacts: Vec<_> =
        touching.filter_map(|(contact, of)| contact.map(|contact| (contact, of))).collect();
    let n = 4 * contacts.len() + usize::from(disturbance.is_some());
    // Units of its own: forces by the load, lengths by the greatest distance.
    let origin = contacts.iter().map(|(c, _)| c.place()).sum::<Vector3<f64>>() / contacts.len() as f64;
    let length = contacts.iter().map(|(c, _)| (c.place() - origin).norm()).fold(0.0, f64::max).max(1e-12);
    let about = |wrench: &Wrench<f64, TestHand>| {
        let torque = wrench.torque_about(&origin) / length;
        Vector6::from_iterator(wrench.force().iter().chain(torque.iter()).copied())
    };
    let wanted = about(load);
    let size = if wanted.norm() > 0.0 { wanted.norm() } else { 1.0 };
    let mut cost = vec![0.0; n];
    // Equilibrium, and the torques of joints.
    let mut equilibrium = DMatrix::<f64>::zeros(6, n);
    let (mut bounds, mut bound) = (Vec::new(), Vec::new());
    for (i, (contact, (finger, joints))) in contacts.iter().enumerate() {
        let normal = contact.normal();
        // Tangents in a way of its own.
        let other = if normal.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let first = normal.cross(&other).normalize();
        let second = normal.cross(&first);
        // The fourth unknown is the spin torque over the arm, or must be zero.
        let spin = Wrench::on_fingertip(Vector3::zeros(), normal * contact.arm());
        let units =
            [normal, first, second].map(|direction| Wrench::from_force_at(&contact.place(), direction));
        for (j, unit) in units.iter().chain([&spin]).enumerate() {
            equilibrium.fixed_view_mut::<6, 1>(0, 4 * i + j).copy_from(&about(unit));
        }
        for (limit, sign) in [(finger.greatest_normal(), 1.0), (finger.least_normal(), -1.0)] {
            if let Some(limit) = limit {
                let mut row = vec![0.0; n];
                row[4 * i] = sign;
                bounds.push(row);
                bound.push(sign * limit / size);
            }
        }
        for ((column, greatest), sign) in joints.iter().flat_map(|joint| [(joint, 1.0), (joint, -1.0)]) {
            let mut row = vec![0.0; n];
            for (j, unit) in units.iter().chain([&spin]).enumerate() {
                row[4 * i + j] = sign * unit.components().dot(column);
            }
            bounds.push(row);
            bound.push(greatest / size);
        }
        cost[4 * i] = if disturbance.is_some() { 0.0 } else { finger.cost() };
    }
    if let Some(disturbance) = disturbance {
        equilibrium.fixed_view_mut::<6, 1>(0, n - 1).copy_from(&about(disturbance));
        cost[n - 1] = -1.0;
        let mut row = vec![0.0; n];
        row[n - 1] = -1.0;
        bounds.push(row);
        bound.push(0.0);
    }
    let mut rows: Vec<Vec<f64>> = equilibrium.row_iter().map(|row| row.iter().copied().collect()).collect();
    let mut right: Vec<f64> = (wanted / -size).iter().copied().collect();
    let mut cones = vec![SupportedConeT::ZeroConeT(6)];
    if !bounds.is_empty() {
        cones.push(SupportedConeT::NonnegativeConeT(bounds.len()));
    }
    rows.extend(bounds);
    right.extend(bound);
    for (i, (contact, _)) in contacts.iter().enumerate() {
        for (j, factor) in [contact.friction(), 1.0, 1.0, 1.0].into_iter().enumerate() {
            let mut row = vec![0.0; n];
            row[4 * i + j] = -factor;
            rows.push(row);
            right.push(0.0);
        }
        cones.push(SupportedConeT::SecondOrderConeT(4));
    }
    let (status, value, steps) = answer(&cost, &rows, &right, &cones);
    (status, value * size, steps)
}

/// What the solver makes of `minimise cost·x, right − rows·x in the cones`.
fn answer(
    cost: &[f64],
    rows: &[Vec<f64>],
    right: &[f64],
    cones: &[SupportedConeT<f64>],
) -> (SolverStatus, f64, u32) {
    let settings = DefaultSettings::<f64> {
        verbose: false,
        tol_gap_abs: 1e-10,
        tol_gap_rel: 1e-10,
        tol_feas: 1e-10,
        ..DefaultSettings::default()
    };
    let (matrix, none) = (CscMatrix::from(rows), CscMatrix::zeros((cost.len(), cost.len())));
    let Ok(mut solver) = DefaultSolver::new(&none, cost, &matrix, right, cones, settings) else {
        return (SolverStatus::Unsolved, f64::NAN, 0);
    };
    solver.solve();
    let solution = &solver.solution;
    (solution.status, solution.obj_val, solution.iterations)
}
