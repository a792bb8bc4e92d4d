//! Batches where contact begins and ends: thresholds met exactly, lines that miss, columns of any length.

use fingertip::contact::PointContact;
use fingertip::friction::{Coulomb, ForceNoise, NormalForceGate, RatioThreshold, SlipVerdict};
use fingertip::surfaces::Sphere;
use fingertip::wrench::{Wrench, WrenchSolver};
use fingertip::{Fingertip, Present, Touches};
use nalgebra::{SVector, Vector3};

/// The signals are the wrench.
#[derive(Clone, Copy)]
struct Direct;

impl WrenchSolver<f64, 6> for Direct {
    #[inline(always)]
    fn solve(&self, signals: &SVector<f64, 6>) -> Wrench<f64> {
        Wrench::from_components(signals)
    }
}

type Tip =
    Fingertip<Direct, Sphere<f64>, PointContact<f64>, Present<Coulomb<f64>>, Present<RatioThreshold<f64>>>;

fn tip(sphere: Sphere<f64>, model: PointContact<f64>) -> Tip {
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.001).unwrap());
    Fingertip::builder()
        .solver(Direct)
        .contact(sphere, model)
        .friction(Coulomb::new(0.6).unwrap())
        .slip_detector(RatioThreshold::new(gate, 0.6).unwrap().with_warning_share(0.75).unwrap())
        .build()
}

/// What the columns hold where nothing was written.
const UNTOUCHED: f64 = 77.0;

/// Nine columns and the verdicts, of the lengths given; the gauges' lengths come first.
fn sense(tip: &Tip, wrenches: &[Wrench<f64>], lengths: [usize; 16]) -> ([Vec<f64>; 9], Vec<SlipVerdict>) {
    let raw: [Vec<f64>; 6] = core::array::from_fn(|gauge| {
        wrenches.iter().take(lengths[gauge]).map(|w| w.components()[gauge]).collect()
    });
    let mut columns: [Vec<f64>; 9] = core::array::from_fn(|k| vec![UNTOUCHED; lengths[6 + k]]);
    let mut slip = vec![SlipVerdict::Warning; lengths[15]];
    let [px, py, pz, normal, tx, ty, tz, margin, utilisation] = columns.each_mut().map(|c| &mut c[..]);
    { *tip }.sense_all(
        raw.each_ref().map(|column| &column[..]),
        1e-3,
        Touches {
            point: [px, py, pz],
            normal_force: normal,
            tangential_force: [tx, ty, tz],
            margin,
            utilisation,
            slip: &mut slip,
        },
    );
    (columns, slip)
}

fn sense_all(tip: &Tip, wrenches: &[Wrench<f64>]) -> ([Vec<f64>; 9], Vec<SlipVerdict>) {
    sense(tip, wrenches, [wrenches.len(); 16])
}

/// Presses with 1 to 2 N near the pole of a sphere of radius 1, and slides a little.
fn presses(count: usize) -> Vec<Wrench<f64>> {
    (0..count)
        .map(|k| {
            let turn = k as f64;
            let point = Vector3::new(0.3 * turn.sin(), 0.3 * turn.cos(), 0.9);
            Wrench::from_force_at(
                &point,
                -point * (1.5 + 0.5 * (turn * 0.7).sin()) + Vector3::new(0.1, 0.2, 0.0),
            )
        })
        .collect()
}

fn one_tip() -> Tip {
    tip(Sphere::centred(1.0).unwrap(), PointContact::new(0.1).unwrap())
}

/// Blocks and vectors begin and end anywhere: whatever the number of samples, each is sensed, once and whole.
#[test]
fn batches_of_any_length_are_sensed_whole() {
    let tip = one_tip();
    let wrenches = presses(531);
    let (all, verdicts) = sense_all(&tip, &wrenches);
    for (k, wrench) in wrenches.iter().enumerate() {
        let touch = { tip }.sense_wrench(*wrench, 1e-3);
        let contact = touch.resolution.contact().unwrap();
        for axis in 0..3 {
            assert!((all[axis][k] - contact.point[axis]).abs() < 1e-14, "{k}");
        }
        assert!((all[3][k] - contact.normal_force()).abs() < 1e-14, "{k}");
        assert_eq!(verdicts[k], touch.slip);
    }
    for count in (0..40).chain([239, 240, 255, 256, 257, 271, 272, 273, 511, 512, 513, 529]) {
        let (some, slip) = sense_all(&tip, &wrenches[..count]);
        for (found, whole) in some.iter().zip(&all) {
            assert_eq!(found[..], whole[..count], "{count} samples");
        }
        assert_eq!(slip[..], verdicts[..count], "{count} samples");
    }
}

/// A sample that is no contact, wherever it lies in a batch, spoils neither itself nor the others.
#[test]
fn one_sample_without_contact_changes_no_other() {
    let tip = one_tip();
    let wrenches = presses(300);
    let (all, verdicts) = sense_all(&tip, &wrenches);
    let nan = Wrench::on_fingertip(Vector3::repeat(f64::NAN), Vector3::zeros());
    let past = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 2.0), Vector3::x());
    for none in [Wrench::zero(), past, nan] {
        for place in [0, 1, 15, 16, 255, 256, 299] {
            let mut mixed = wrenches.clone();
            mixed[place] = none;
            let (found, slip) = sense_all(&tip, &mixed);
            for k in 0..mixed.len() {
                for column in 0..9 {
                    // Without contact no force is there, and none of friction's limit is used.
                    let wanted = if k == place { 0.0 } else { all[column][k] };
                    assert_eq!(found[column][k], wanted, "{none:?} at {place}: sample {k}, column {column}");
                }
                let wanted = if k == place { SlipVerdict::NotPressing } else { verdicts[k] };
                assert_eq!(slip[k], wanted, "{none:?} at {place}: sample {k}");
            }
        }
    }
}

/// Each column in turn is the shortest.
#[test]
fn the_shortest_column_counts_and_the_rest_is_left() {
    let tip = one_tip();
    let wrenches = presses(40);
    let (all, verdicts) = sense_all(&tip, &wrenches);
    for shortest in 0..16 {
        for count in [0, 1, 17, 33] {
            let mut lengths = [40; 16];
            lengths[shortest] = count;
            let (found, slip) = sense(&tip, &wrenches, lengths);
            for (column, whole) in found.iter().zip(&all) {
                assert_eq!(column[..count], whole[..count], "column {shortest} of {count}");
                assert!(column[count..].iter().all(|x| *x == UNTOUCHED), "column {shortest} of {count}");
            }
            assert_eq!(slip[..count], verdicts[..count]);
            assert!(slip[count..].iter().all(|verdict| *verdict == SlipVerdict::Warning));
        }
    }
}

/// Whether one sample and a batch of it agree on a contact, and what they say.
fn touches(tip: &Tip, wrench: Wrench<f64>) -> bool {
    let one = { *tip }.sense_wrench(wrench, 1e-3).resolution.contact().is_some();
    // Among others that press, and among others that do not.
    for others in [vec![], presses(20), vec![Wrench::zero(); 20]] {
        let mut batch = others;
        batch.push(wrench);
        let (columns, _) = sense_all(tip, &batch);
        let normal = columns[3][batch.len() - 1];
        assert_eq!(normal > 0.0, one, "{wrench:?}: {normal}");
    }
    one
}

#[test]
fn thresholds_that_are_met_exactly_are_met() {
    let sphere = Sphere::centred(1.0).unwrap();
    let down = |newtons: f64| Wrench::on_fingertip(Vector3::new(0.0, 0.0, -newtons), Vector3::zeros());
    // The least force.
    let least = tip(sphere, PointContact::new(0.5).unwrap());
    assert!(touches(&least, down(0.5)) && !touches(&least, down(0.5 - 1e-9)));
    assert!(!touches(&least, -down(0.5 - 1e-9)) && touches(&least, -down(0.5)));
    // No friction at all, and a force that asks for none; one that asks for little.
    let smooth = tip(sphere, PointContact::new(0.1).unwrap().with_greatest_friction(0.0).unwrap());
    assert!(touches(&smooth, down(2.0)));
    let aslant = Wrench::from_force_at(&Vector3::z(), Vector3::new(1e-3, 0.0, -1.0));
    assert!(!touches(&smooth, aslant) && touches(&one_tip(), aslant));
    let rough =
        |ratio: f64| tip(sphere, PointContact::new(0.1).unwrap().with_greatest_friction(ratio).unwrap());
    let sliding = Wrench::from_force_at(&Vector3::z(), Vector3::new(0.5, 0.0, -1.0));
    assert!(touches(&rough(0.5 + 1e-9), sliding) && !touches(&rough(0.5 - 1e-9), sliding));
}

/// A centre beside the origin, in all three directions, and at the origin: the same but for the shift.
#[test]
fn a_sphere_may_lie_anywhere() {
    let wrenches = presses(50);
    let (here, slip) = sense_all(&one_tip(), &wrenches);
    for centre in [Vector3::x(), Vector3::y() * -2.0, Vector3::z() * 0.5, Vector3::new(0.25, -0.5, 1.0)] {
        let moved: Vec<_> = wrenches
            .iter()
            .map(|w| Wrench::on_fingertip(w.force(), w.torque() + centre.cross(&w.force())))
            .collect();
        let tip = tip(Sphere::new(centre, 1.0).unwrap(), PointContact::new(0.1).unwrap());
        let (there, other_slip) = sense_all(&tip, &moved);
        for k in 0..50 {
            for column in 0..9 {
                let shift = if column < 3 { centre[column] } else { 0.0 };
                // Each passes some thirty roundings, of lengths up to 4 m and forces up to 3 N.
                assert!((there[column][k] - here[column][k] - shift).abs() < 1e-13, "{column} {k}");
            }
        }
        assert_eq!(slip, other_slip);
    }
}

/// A line that misses the surface by no more than is accepted is a contact at its closest point, alone as in
/// a batch; unless friction is limited, of which it needs more than any.
#[test]
fn lines_that_miss_by_little_are_taken_alike() {
    let accepting = PointContact::new(0.1).unwrap().with_greatest_gap(0.25).unwrap();
    let any_gap = PointContact::new(0.1).unwrap().with_greatest_gap(f64::MAX).unwrap();
    let limited = accepting.with_greatest_friction(1e6).unwrap();
    let mut missed = [0; 3];
    for (index, model) in [accepting, any_gap, limited].into_iter().enumerate() {
        for centre in [Vector3::zeros(), Vector3::new(0.5, -0.25, 0.125)] {
            let tip = tip(Sphere::new(centre, 1.0).unwrap(), model);
            for k in 0..200 {
                // From 0.8 to 1.4 off the centre, in any direction.
                let (turn, height) = (f64::from(k), 0.8 + 0.003 * f64::from(k));
                let up = Vector3::new(turn.sin(), turn.cos(), (2.0 * turn).sin()).normalize();
                let along = up.cross(&Vector3::new(0.3, turn.cos(), 0.7)).normalize();
                let wrench = Wrench::from_force_at(&(centre + up * height), along * 2.0);
                let touch = { tip }.sense_wrench(wrench, 1e-3);
                let mut batch = presses(20);
                batch.push(wrench);
                let (columns, slip) = sense_all(&tip, &batch);
                let found = columns.each_ref().map(|column| column[20]);
                let Some(contact) = touch.resolution.contact() else {
                    assert_eq!(found, [0.0; 9], "{height}");
                    continue;
                };
                missed[index] += usize::from(contact.gap > 0.0);
                // The incidence is flat: errors grow as its reciprocal cosine, which is about √(2 · 0.003) for
                // the first height below 1. Where it misses, they do not.
                let tolerance = 1e-13;
                let force = contact.contact_force();
                for axis in 0..3 {
                    assert!((found[axis] - contact.point[axis]).abs() < tolerance, "{height}: {found:?}");
                    assert!(
                        (found[4 + axis] - force.tangential[axis]).abs() < tolerance,
                        "{height}: {found:?}"
                    );
                }
                assert!(
                    found[3] >= 0.0 && (found[3] - force.normal).abs() < tolerance,
                    "{height}: {found:?}"
                );
                assert!((found[7] - touch.grip.unwrap().newtons).abs() < tolerance, "{height}: {found:?}");
                assert_eq!(slip[20], touch.slip);
            }
        }
    }
    let [within, whatever, none] = missed;
    assert!(within > 100 && whatever > 200 && none == 0, "{missed:?}");
}

/// The gap that is accepted is accepted to its end; a force without an answer lies at no gap.
#[test]
fn gaps_end_where_they_are_said_to() {
    let sphere = Sphere::centred(1.0).unwrap();
    let accepting = |gap: f64| tip(sphere, PointContact::new(0.1).unwrap().with_greatest_gap(gap).unwrap());
    let past = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 1.25), Vector3::new(-2.0, 0.0, 0.0));
    for (gap, taken) in [(0.25, true), (0.25 - 1e-9, false), (0.25 + 1e-9, true)] {
        let tip = accepting(gap);
        assert_eq!({ tip }.sense_wrench(past, 1e-3).resolution.contact().is_some(), taken, "{gap}");
        let (columns, _) = sense_all(&tip, &[past]);
        assert_eq!(columns[2][0], if taken { 1.0 } else { 0.0 }, "{gap}");
    }
    // Squares of this force overflow.
    let huge = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 1.25), Vector3::new(-1e200, 0.0, 0.0));
    let (columns, slip) = sense_all(&accepting(f64::MAX), &[huge]);
    assert_eq!((columns.map(|column| column[0]), slip[0]), ([0.0; 9], SlipVerdict::NotPressing));
}

/// Friction so strong or so weak that what it holds, or what is used of it, leaves the range.
#[test]
fn frictions_out_of_range_are_answered_alike() {
    for (coefficient, size) in [(1e300, 1e100), (1e-300, 1e-12), (1e-300, 1e100), (1e300, 1e-12)] {
        let tip = Fingertip::builder()
            .solver(Direct)
            .contact(Sphere::centred(1.0).unwrap(), PointContact::new(0.0).unwrap())
            .friction(Coulomb::new(coefficient).unwrap())
            .slip_detector(
                RatioThreshold::new(NormalForceGate::from_noise(&ForceNoise::isotropic(1e-15).unwrap()), 0.6)
                    .and_then(|detector| detector.with_warning_share(0.75))
                    .unwrap(),
            )
            .build();
        let wrenches: Vec<_> = presses(40).into_iter().map(|wrench| wrench * size).collect();
        let (columns, _) = sense_all(&tip, &wrenches);
        for (k, wrench) in wrenches.iter().enumerate() {
            let grip = { tip }.sense_wrench(*wrench, 1e-3).grip.unwrap();
            let close = |found: f64, wanted: f64| found == wanted || (found / wanted - 1.0).abs() < 1e-9;
            assert!(
                close(columns[7][k], grip.newtons),
                "{coefficient:e} {size:e}: {} {grip:?}",
                columns[7][k]
            );
            assert!(
                close(columns[8][k], grip.utilisation),
                "{coefficient:e} {size:e}: {} {grip:?}",
                columns[8][k]
            );
        }
    }
}
