//! What an iterate misses, by equations that were made to hold.

use nalgebra::{Matrix6x4, Vector4, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::{Missing, Program};
use crate::grip::block::{Block, Residual, Row};
use crate::grip::iterate::{Each, Iterate};

/// Three fingers, of which two touch, one with two half-spaces and one with one; and an iterate of any numbers that misses
/// none of their equations: wrench, bounds and duals are made so.
fn nothing_is_missing(rng: &mut Pcg64Mcg) -> (Program<f64, 3, 2>, Iterate<f64, 3, 2>) {
    let mut at = Iterate::middle();
    let mut any = || rng.random_range(0.5..1.5);
    (at.tau, at.kappa, at.twist) = (any(), any(), Vector6::from_fn(|_, _| any()));
    let mut program = Program { blocks: Each::all(None), wrench: Vector6::zeros(), cost_factor: 1.0 };
    for (finger, rows) in [(0, 2), (2, 1)] {
        let inner = &mut at.blocks.fingers[finger];
        let map = Matrix6x4::from_fn(|_, _| any());
        let mut block = Block { map, cost: any(), rows: [None; 2] };
        inner.y = Vector4::from_fn(|_, _| any());
        inner.z = Vector4::x() * (block.cost * at.tau) - map.transpose() * at.twist;
        for (row, pair) in block.rows.iter_mut().zip(&mut inner.rows).take(rows) {
            (pair.slack, pair.price) = (any(), any());
            let normal = Vector4::from_fn(|_, _| any());
            *row = Some(Row { normal, bound: (normal.dot(&inner.y) + pair.slack) / at.tau, opposite: false });
            inner.z += normal * pair.price;
        }
        program.wrench += map * inner.y / at.tau;
        program.blocks.fingers[finger] = Some(block);
    }
    (program, at)
}

#[test]
fn each_equation_counts() {
    let mut rng = Pcg64Mcg::seed_from_u64(51);
    type Change = fn(&mut Program<f64, 3, 2>, &mut Iterate<f64, 3, 2>);
    let primal: [Change; 5] = [
        |program, at| program.wrench[4] += 0.125 / at.tau,
        |program, at| program.wrench[0] -= 0.125 / at.tau,
        |_, at| at.blocks.fingers[0].rows[0].slack += 0.125,
        |_, at| at.blocks.fingers[0].rows[1].slack -= 0.125,
        |_, at| at.blocks.fingers[2].rows[0].slack += 0.125,
    ];
    let dual: [Change; 3] = [
        |_, at| at.blocks.fingers[0].z.x += 0.125,
        |_, at| at.blocks.fingers[2].z.w -= 0.125,
        |_, at| at.blocks.fingers[2].z.y += 0.125,
    ];
    for _ in 0..20 {
        let (program, at) = nothing_is_missing(&mut rng);
        let missed = |change: Option<&Change>| {
            let (mut program, mut at) = (program, at);
            change.into_iter().for_each(|change| change(&mut program, &mut at));
            let missing = program.missing(&at);
            // Whatever the gap, it is off by this at least.
            assert!(missing.off(at.tau) >= missing.primal.max(missing.dual) / at.tau);
            [missing.primal, missing.dual]
        };
        let close = |found: [f64; 2], expected: [f64; 2]| {
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-13)
        };
        assert!(close(missed(None), [0.0; 2]));
        assert!(primal.iter().all(|change| close(missed(Some(change)), [0.125, 0.0])));
        assert!(dual.iter().all(|change| close(missed(Some(change)), [0.0, 0.125])));
    }
}

/// The gap is a share of the greater of both costs, or of a thousandth of the wrench where both are less.
#[test]
fn a_gap_is_a_share_of_the_cost() {
    let off = |cost: f64, value: f64, tau: f64| {
        let (zero, blocks) = (0.0, Each::all(Residual::none()));
        let equilibrium = Vector6::zeros();
        let missing = Missing::<f64, 1, 1> {
            blocks,
            equilibrium,
            of_tau: zero,
            complementarity: zero,
            primal: zero,
            dual: zero,
            cost,
            value,
        };
        missing.off(tau)
    };
    for (cost, value, tau, expected) in [
        (4.0, 3.0, 1.0, 0.25),
        (3.0, 4.0, 1.0, 0.25),
        (-4.0, -3.0, 1.0, 0.25),
        (0.0, 4.0, 8.0, 1.0),
        (4e-6, 3e-6, 1.0, 1e-3),
        (4e-6, 0.0, 0.5, 8e-3),
    ] {
        let found = off(cost, value, tau);
        assert!((found - expected).abs() < 1e-12, "{cost} {value} {tau}: {found}");
    }
}

/// An iterate times a number is the same direction: it misses so many times as much, and its products are so many times as
/// large, squared. (Powers of two change no digit.)
#[test]
fn an_iterate_is_a_direction() {
    let mut rng = Pcg64Mcg::seed_from_u64(52);
    for factor in [0.25_f64, 2.0, 16.0] {
        let (program, mut at) = nothing_is_missing(&mut rng);
        at.twist.x += 0.3;
        at.blocks.fingers[2].y.x += 0.4;
        let one = program.missing(&at);
        let off = one.off(at.tau);
        at.rescale(factor);
        let many = program.missing(&at);
        assert_eq!(many.equilibrium, one.equilibrium * factor);
        assert_eq!(
            [many.of_tau, many.primal, many.dual],
            [one.of_tau, one.primal, one.dual].map(|x| x * factor)
        );
        assert_eq!(many.complementarity, one.complementarity * factor * factor);
        assert_eq!(many.off(at.tau), off);
        assert!(one.primal > 0.1 && one.dual > 0.1);
    }
}

/// In the middle all products are one, and so is their mean, however many there are.
#[test]
fn complementarity_is_the_mean_of_the_products() {
    let mut rng = Pcg64Mcg::seed_from_u64(53);
    let (program, _) = nothing_is_missing(&mut rng);
    let mut at = Iterate::middle();
    assert_eq!(program.missing(&at).complementarity, 1.0);
    // Six products: of two fingers, three half-spaces, and τκ.
    at.kappa = 4.0;
    assert_eq!(program.missing(&at).complementarity, 1.5);
    at.blocks.fingers[0].rows[1].price = 7.0;
    assert_eq!(program.missing(&at).complementarity, 2.5);
    at.blocks.fingers[2].y.x = 13.0;
    assert_eq!(program.missing(&at).complementarity, 4.5);
}
