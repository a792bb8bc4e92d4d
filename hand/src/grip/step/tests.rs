//! What a step leaves, and what its corrections are.

use super::{Aim, Direction, System};
use crate::grip::block::{Block, Row};
use crate::grip::iterate::{Each, Iterate};
use crate::grip::program::{Ending, Program, Stop};
use crate::grip::workspace::Workspace;
use nalgebra::{Matrix6x4, Vector4, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Four contacts of any map, one of them with a half-space.
fn program(rng: &mut Pcg64Mcg) -> Program<f64, 4, 1> {
    let mut blocks = Each::all(None);
    for block in &mut blocks.fingers {
        let map = Matrix6x4::from_fn(|_, _| rng.random_range(-1.0..1.0));
        *block = Some(Block { map, cost: 1.0, rows: [None] });
    }
    if let Some(block) = &mut blocks.fingers[1] {
        block.rows = [Some(Row { normal: Vector4::x(), bound: 0.7, opposite: false })];
    }
    Program { blocks, wrench: Vector6::from_fn(|_, _| rng.random_range(-1.0..1.0)), cost_factor: 1.0 }
}

/// The law of τ and κ, `κ dτ + τ dκ = centre − τκ − dτ dκ`, where the last is that of the direction before.
#[test]
fn each_correction_is_of_the_direction_before() {
    let mut rng = Pcg64Mcg::seed_from_u64(41);
    for _ in 0..50 {
        let program = program(&mut rng);
        let mut at = Iterate::middle();
        (at.tau, at.kappa) = (rng.random_range(0.3..2.0), rng.random_range(0.3..2.0));
        let missing = program.missing(&at);
        let mut work = Workspace::new(&program.blocks);
        let mut system = System::new(&program, &at, &missing, &mut work.scaled);
        let aim = Aim { centre: 0.1, keep: 0.9 };
        let mut before = system.predict();
        let mut along = system.correct(&before, &aim);
        for _ in 0..3 {
            let found = at.kappa * along.tau + at.tau * along.kappa;
            let wanted = aim.centre - at.tau * at.kappa - before.tau * before.kappa;
            assert!((found - wanted).abs() < 1e-12 * (1.0 + wanted.abs()), "{found} {wanted}");
            (before.tau, before.kappa) = (along.tau, along.kappa);
            system.correct_again(&mut along, &aim);
        }
    }
}

/// What a step is said to leave of the equations is what is missing then; also after a start from the way.
#[test]
fn what_a_step_leaves_is_known() {
    let mut rng = Pcg64Mcg::seed_from_u64(42);
    let mut solved = 0;
    for _ in 0..50 {
        let program = program(&mut rng);
        let mut at = Iterate::middle();
        let mut missing = program.missing(&at);
        let mut work = Workspace::new(&program.blocks);
        for _ in 0..4 {
            let before = missing.of_tau;
            let equilibrium = missing.equilibrium;
            assert!(program.step(&mut at, &mut missing, &mut work, 0.0));
            let found = program.missing(&at);
            assert!((found.equilibrium - missing.equilibrium).amax() < 1e-11);
            let share = missing.equilibrium.amax() / equilibrium.amax();
            assert!((found.of_tau - share * before).abs() < 1e-11, "{} {}", found.of_tau, share * before);
            missing = found;
        }
        // The point on the way misses a thousandth.
        let stop = Stop { tolerance: 1e-8, greatest: 1e8, steps: 30 };
        let (mut at, mut midway) = (Iterate::middle(), None);
        if program.iterate(&mut at, &stop, &mut midway).0 == Ending::Solved {
            solved += 1;
            let midway = midway.unwrap();
            let off = program.missing(&midway).off(midway.tau);
            assert!(off > 0.5e-3 && off < 1.5e-3, "{off}");
        }
    }
    assert!(solved > 10, "{solved}");
}

/// A step that takes enough off the equations goes where the first corrector does, and one that would have to go to the
/// border, or beyond, is corrected again.
#[test]
fn a_step_is_corrected_until_it_reaches_enough() {
    let mut rng = Pcg64Mcg::seed_from_u64(43);
    let (mut near, mut again) = (0, 0);
    for _ in 0..50 {
        let program = program(&mut rng);
        let mut at = Iterate::middle();
        let mut work = Workspace::new(&program.blocks);
        for _ in 0..4 {
            let before = at;
            let missing = || program.missing(&before);
            let (along, reach, keep) = {
                let missing = missing();
                let mut system = System::new(&program, &before, &missing, &mut work.scaled);
                let predicted = system.predict();
                let left = 1.0 - system.greatest_step(&predicted, 1.0);
                let aim = Aim { centre: left * left * missing.complementarity, keep: 1.0 - left * left };
                let along = system.correct(&predicted, &aim);
                let reach = system.greatest_step(&along, 2.0);
                (along, reach, aim.keep)
            };
            // How far the twist is from where the first corrector's step goes.
            let mut aside = |may_leave: f64| {
                at = before;
                assert!(program.step(&mut at, &mut missing(), &mut work, may_leave) && at.is_inside());
                let went = (at.tau - before.tau) / along.tau;
                let off = (at.twist - before.twist - along.twist * went).amax() / along.twist.amax();
                (off, went)
            };
            for share in [0.0, 0.9, 0.98] {
                let (off, went) = aside(1.0 - keep * share * reach);
                assert!(off < 1e-9 && (went - (reach * 0.99).min(1.0)).abs() < 1e-9, "{share}: {off}");
            }
            // The step is held back from the border by a hundredth where the prediction left so much.
            let (left, wide) = ((1.0 - keep).sqrt(), reach < 0.95);
            if wide && (0.1..0.59).contains(&left) {
                near += 1;
                again += u32::from(aside(1.0 - keep * 0.9999 * reach).0 > 1e-6);
            }
            aside(0.0);
        }
    }
    // Not all: a correction that shortens the step is given up.
    assert!(near > 20 && again * 3 > near * 2, "{again} of {near}");
}

/// What τ and κ bear of a step, where nothing else ends it.
#[test]
fn a_step_ends_where_tau_or_kappa_does() {
    let mut rng = Pcg64Mcg::seed_from_u64(45);
    let program = program(&mut rng);
    let mut at = Iterate::middle();
    (at.tau, at.kappa) = (3.0, 0.5);
    let missing = program.missing(&at);
    let mut work = Workspace::new(&program.blocks);
    let mut system = System::new(&program, &at, &missing, &mut work.scaled);
    for (tau, kappa, end) in [
        (-2.0, 0.0, 1.5),
        (-2.0, 1.0, 1.5),
        (0.0, -0.3, 0.5 / 0.3),
        (-2.0, -0.4, 1.25),
        (-1.4, -0.2, 2.0),
        (-30.0, 0.0, 0.1),
    ] {
        // No block has a direction yet.
        let along = Direction { twist: Vector6::zeros(), tau, kappa, second: 0.0 };
        let found = system.greatest_step(&along, 2.0);
        assert!((found - end).abs() < 1e-15, "{tau} {kappa}: {found}");
    }
}

/// However often it is corrected: the reach that is told is that of the direction that is.
#[test]
fn what_a_correction_reaches_is_told() {
    let mut rng = Pcg64Mcg::seed_from_u64(44);
    let mut farther = 0;
    for _ in 0..50 {
        let program = program(&mut rng);
        let mut at = Iterate::middle();
        let mut work = Workspace::new(&program.blocks);
        for _ in 0..4 {
            let mut missing = program.missing(&at);
            let mut system = System::new(&program, &at, &missing, &mut work.scaled);
            let aim = Aim { centre: 0.1 * missing.complementarity, keep: 0.9 };
            let predicted = system.predict();
            let along = system.correct(&predicted, &aim);
            let first = system.greatest_step(&along, 2.0);
            let (along, reach) = system.correct_more((along, first), &aim, 1.5);
            assert_eq!(reach, system.greatest_step(&along, 2.0));
            assert!(reach >= first * (2.0 / 3.0));
            // Neither τ nor κ is less than nothing there.
            for (x, d) in [(at.tau, along.tau), (at.kappa, along.kappa)] {
                assert!(x + d * reach > -1e-12, "{x} {d} {reach}");
            }
            farther += u32::from(reach > first);
            assert!(program.step(&mut at, &mut missing, &mut work, 0.0));
        }
    }
    assert!(farther > 100, "{farther}");
}
