//! The same cone program by another's solver: `clarabel`, built here from the contacts and not from our grasp map.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use fingertip_hand::{FingerLimits, Grasp};
use fingertip_wrench::Wrench;
use nalgebra::{DMatrix, Vector3};

use crate::support::TestHand;

/// What the oracle says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Oracle {
    Held { cost: f64, steps: u32 },
    CannotHold { steps: u32 },
    Unclear,
}

/// Unknowns of a contact: force on the object along the normal and two tangents, spin torque.
pub(crate) fn solve<const N: usize, const ROWS: usize>(
    grasp: &Grasp<f64, N, TestHand>,
    limits: &[FingerLimits<f64, ROWS>; N],
    load: &Wrench<f64, TestHand>,
) -> Oracle {
    let contacts: Vec<_> = grasp
        .contacts()
        .iter()
        .zip(limits)
        .filter_map(|(contact, limits)| contact.map(|contact| (contact, *limits)))
        .collect();
    let n = 4 * contacts.len();
    // Units of its own: forces by the load, lengths by the greatest distance.
    let origin = contacts.iter().map(|(c, _)| c.place()).sum::<Vector3<f64>>() / contacts.len() as f64;
    let length = contacts.iter().map(|(c, _)| (c.place() - origin).norm()).fold(0.0, f64::max).max(1e-12);
    let torque = load.torque_about(&origin);
    let size = (load.force().norm_squared() + torque.norm_squared() / (length * length)).sqrt();
    let mut cost = vec![0.0; n];
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut right = Vec::new();
    // Equilibrium.
    let mut equilibrium = DMatrix::<f64>::zeros(6, n);
    for (i, (contact, finger)) in contacts.iter().enumerate() {
        let normal = contact.normal();
        // Tangents in a way of its own.
        let other = if normal.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let first = normal.cross(&other).normalize();
        let second = normal.cross(&first);
        let place = contact.place() - origin;
        for (j, direction) in [normal, first, second].into_iter().enumerate() {
            let moment = place.cross(&direction) / length;
            for k in 0..3 {
                equilibrium[(k, 4 * i + j)] = direction[k];
                equilibrium[(3 + k, 4 * i + j)] = moment[k];
            }
        }
        for k in 0..3 {
            // The fourth unknown is the spin torque over the arm, or must be zero.
            equilibrium[(3 + k, 4 * i + 3)] = normal[k] * contact.arm() / length;
        }
        cost[4 * i] = finger.cost();
    }
    for k in 0..6 {
        rows.push(equilibrium.row(k).iter().copied().collect());
    }
    right.extend((load.force() / -size).iter());
    right.extend((torque / (-size * length)).iter());
    let mut cones = vec![SupportedConeT::ZeroConeT(6)];
    let mut bounds = 0;
    for (i, (_, finger)) in contacts.iter().enumerate() {
        for (bound, sign) in [(finger.greatest_normal(), 1.0), (finger.least_normal(), -1.0)] {
            if let Some(bound) = bound {
                let mut row = vec![0.0; n];
                row[4 * i] = sign;
                rows.push(row);
                right.push(sign * bound / size);
                bounds += 1;
            }
        }
    }
    if bounds > 0 {
        cones.push(SupportedConeT::NonnegativeConeT(bounds));
    }
    for (i, (contact, _)) in contacts.iter().enumerate() {
        for (j, factor) in [contact.friction(), 1.0, 1.0, 1.0].into_iter().enumerate() {
            let mut row = vec![0.0; n];
            row[4 * i + j] = -factor;
            rows.push(row);
            right.push(0.0);
        }
        cones.push(SupportedConeT::SecondOrderConeT(4));
    }
    let matrix = CscMatrix::from(&rows);
    let settings = DefaultSettings::<f64> {
        verbose: false,
        tol_gap_abs: 1e-10,
        tol_gap_rel: 1e-10,
        tol_feas: 1e-10,
        ..DefaultSettings::default()
    };
    let Ok(mut solver) =
        DefaultSolver::new(&CscMatrix::zeros((n, n)), &cost, &matrix, &right, &cones, settings)
    else {
        return Oracle::Unclear;
    };
    solver.solve();
    let solution = &solver.solution;
    match solution.status {
        SolverStatus::Solved => Oracle::Held { cost: solution.obj_val * size, steps: solution.iterations },
        SolverStatus::PrimalInfeasible => Oracle::CannotHold { steps: solution.iterations },
        _ => Oracle::Unclear,
    }
}
