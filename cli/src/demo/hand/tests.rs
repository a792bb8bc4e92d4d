//! A session of a hand that was made up, in words and pictures.

use fingertip_simulation::hand::HandSegment;
use nalgebra::Vector3;

use super::{Mass, Moment, Outcome, figures, findings};
use crate::report::Figure;
use fingertip_test_support::read_back::{paths, points, rulers};

const DURATION: f64 = 1.0;

/// Four segments, of which the third lifts, and a sample every ten milliseconds.
fn outcome() -> Outcome {
    let by = |z: f64| HandSegment::Move { by: Vector3::z() * z, duration: DURATION };
    let phases = vec![
        (HandSegment::Open { duration: DURATION }, 0.0),
        (HandSegment::Hold { duration: DURATION }, 1.03),
        (by(0.1), 2.07),
        (by(-0.1), 3.11),
    ];
    let moment = |k: u32| {
        let time = 0.01 * f64::from(k);
        let phase = phases.iter().filter(|(_, start)| *start <= time).count() - 1;
        let grips = phase > 0;
        Moment {
            time,
            commanded: grips.then_some([1.5, 2.5, 3.5]),
            felt: if grips { [1.0 + time, 2.0, 3.0] } else { [0.0; 3] },
            left: grips.then_some((0.5, if k == 350 { -0.7 } else { 0.4 - 0.1 * time })),
            slip: (k == 252, k == 260 || k == 261),
            moved: (phase == 2).then_some(1e-5 * f64::from(k)),
            phase,
            holding: phase == 2 && k.is_multiple_of(2),
        }
    };
    let mass = |time: f64| Mass { time, found: 0.2 + 0.01 * time, deviation: 0.0024, truth: 0.201 };
    // Two weighings, with a pause between.
    let masses = (0..10).map(|k| mass(2.1 + 0.02 * f64::from(k))).chain([mass(3.0), mass(3.04)]).collect();
    Outcome { moments: (0..400).map(moment).collect(), masses, phases, seed: 7 }
}

#[test]
fn a_session_is_told_with_its_numbers() {
    let found = findings::of(&outcome());
    assert!(found.lead[0].contains(" held a jar for 3.99 s: "), "{}", found.lead[0]);
    // At the last of each weighing: 0.2 + 0.01 t.
    assert_eq!(found.lead[1], "It weighed 223 ± 2.40 g for 201 g, 230 ± 2.40 g for 201 g.");
    assert_eq!(
        found.lead[2],
        "A contact slipped in 2 samples; in the hand the jar moved by 3.10 mm at most."
    );
    assert!(found.notes.iter().any(|note| note.contains("are those of seed 7")), "{:?}", found.notes);
    // From, greatest normal force, least of the friction left, how far it moved, and how often it is held.
    let rows: Vec<Vec<&str>> =
        found.tables[0].rows.iter().map(|row| row.iter().map(String::as_str).collect()).collect();
    assert_eq!(
        rows,
        [
            ["open", "0", "0", "–", "–", "0"],
            ["hold", "1.03", "3.06", "19.4", "–", "0"],
            ["lift", "2.07", "4.10", "9.00", "3.10", "50.0"],
            ["put down", "3.11", "4.99", "-70.0", "–", "0"],
        ]
    );
    let calm =
        Outcome { moments: outcome().moments.into_iter().filter(|m| !m.slip.1).collect(), ..outcome() };
    assert!(findings::of(&calm).lead[2].starts_with("No contact slipped; "));
}

/// The values of a curve with their times, as they are read off the axes.
fn read(figure: &Figure, class: &str) -> Vec<(f64, f64)> {
    let (across, up) = rulers(&figure.svg);
    points(&figure.svg, class).into_iter().map(|(x, y)| (across.at(x), up.at(y))).collect()
}

#[test]
fn what_is_drawn_of_a_session_can_be_read_off() {
    let outcome = outcome();
    let [forces, margins, mass, movement] = &figures::of(&outcome)[..] else { panic!("four figures") };
    let thinned = || outcome.moments.iter().step_by(4);
    let agree = |figure: &Figure, class: &str, expected: Vec<(f64, f64)>| {
        let (across, up) = rulers(&figure.svg);
        let found = read(figure, class);
        assert_eq!(found.len(), expected.len(), "{class} of {}", figure.title);
        for ((time, value), (at, what)) in found.iter().zip(&expected) {
            assert!(
                (time - at).abs() <= across.error() && (value - what).abs() <= up.error(),
                "{class}: {time} {value} {what}"
            );
        }
    };
    for (class, finger) in [("curve a", 0), ("curve b", 1), ("curve c", 2)] {
        agree(forces, class, thinned().map(|moment| (moment.time, moment.felt[finger])).collect());
    }
    let commanded = |finger: usize| thinned().filter_map(move |m| Some((m.time, m.commanded?[finger])));
    agree(forces, "curve e wide", (0..3).flat_map(commanded).collect());
    let left = |pick: fn((f64, f64)) -> f64| {
        thinned().filter_map(move |m| Some((m.time, (100.0 * pick(m.left?)).max(-20.0)))).collect::<Vec<_>>()
    };
    agree(margins, "curve a", left(|left| left.0));
    agree(margins, "curve e wide", left(|left| left.1));
    let (across, _) = rulers(&margins.svg);
    let marks = points(&margins.svg, "mark");
    assert!(marks.len() == 2 && marks.iter().all(|(x, _)| (across.at(*x) - 2.52).abs() <= across.error()));
    agree(movement, "curve a", thinned().filter_map(|m| Some((m.time, 1e3 * m.moved?))).collect());
    let masses = |value: fn(&Mass) -> f64| {
        outcome.masses.iter().map(|mass| (mass.time, 1e3 * value(mass))).collect::<Vec<_>>()
    };
    agree(mass, "curve e", masses(|mass| mass.truth));
    agree(mass, "curve a wide", masses(|mass| mass.found));
    let both = [masses(|m| m.found - 2.0 * m.deviation), masses(|m| m.found + 2.0 * m.deviation)].concat();
    agree(mass, "curve b", both);
    // Curves are broken where there is nothing, and a weighing is one piece.
    let broken = |figure: &Figure, class: &str| {
        paths(&figure.svg).iter().find(|path| path.class == class).unwrap().pieces.len()
    };
    assert_eq!(
        (broken(mass, "curve a wide"), broken(movement, "curve a"), broken(margins, "curve a")),
        (2, 1, 1)
    );
    // A line upright at the beginning of every segment.
    for figure in [forces, margins, mass, movement] {
        let (across, _) = rulers(&figure.svg);
        let grid = paths(&figure.svg).into_iter().filter(|path| path.class == "grid");
        let upright: Vec<f64> = grid
            .map(|path| path.pieces[0].clone())
            .filter(|line| line[0].0 == line[1].0)
            .map(|line| across.at(line[0].0))
            .collect();
        for (_, start) in &outcome.phases {
            assert!(
                upright.iter().any(|x| (x - start).abs() <= across.error()),
                "{}: {upright:?}",
                figure.title
            );
        }
    }
}
