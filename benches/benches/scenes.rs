//! What a sample of each scene costs, from volts to the detector's verdict in single precision,
//! beside the yardstick that was written by hand. Both store their answers.

#![allow(missing_docs, reason = "criterion's macros")]

use core::hint::black_box;
use core::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use fingertip::Touches;
use fingertip::friction::SlipVerdict;
use fingertip_benches::hand_written::{HandA, HandB};
use fingertip_scenes::{Felt, Scene, SceneA, SceneB, SceneC, SceneD, Volts};

/// Not a power of two, lest inputs and outputs meet in the same lines of the cache.
const COUNT: usize = 1013;

/// The samples of the session that are in contact, over and over.
fn volts<S: Scene<N>, const N: usize>() -> Vec<Volts<N>> {
    let session = S::session();
    let pressing = session.get(60..session.len() - 30).unwrap_or(session);
    pressing.iter().cycle().take(COUNT).map(|sums| S::volts(sums)).collect()
}

/// One at a time, as they come: no two are to be done in one vector. Pipeline and answers are arguments of
/// their own, as they are places of their own in a controller: what is written to one is not taken for a
/// change of the other.
#[inline(never)]
fn one_by_one<P, I, O>(pipeline: &mut P, inputs: &[I], answers: &mut [O], sense: impl Fn(&mut P, &I) -> O) {
    for (input, answer) in inputs.iter().zip(answers) {
        *answer = sense(pipeline, black_box(input));
    }
}

fn run<P, I, O: Clone + Default>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    mut pipeline: P,
    inputs: &[I],
    sense: impl Fn(&mut P, &I) -> O,
) {
    let mut answers = vec![O::default(); inputs.len()];
    group.bench_function(name, |b| {
        b.iter(|| one_by_one(&mut pipeline, black_box(inputs), black_box(&mut answers), &sense));
    });
}

fn scene<S: Scene<N>, const N: usize>(group: &mut BenchmarkGroup<'_, WallTime>)
where
    S::Answer: Clone + Default,
{
    let Some(scene) = S::new() else { return };
    run(group, &format!("{}, pipeline", S::NAME), scene, &volts::<S, N>(), |scene, volts| scene.sense(volts));
}

/// The same stages for all samples at once, as columns.
fn batch_of_scene_a(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    mut sense_all: impl FnMut([&[f32]; 6], Touches<'_, f32>),
) {
    let volts = volts::<SceneA, 6>();
    let raw: [Vec<f32>; 6] = core::array::from_fn(|gauge| volts.iter().map(|v| v[gauge]).collect());
    let mut columns: [Vec<f32>; 9] = core::array::from_fn(|_| vec![0.0; COUNT]);
    let mut slip = vec![SlipVerdict::NotPressing; COUNT];
    group.bench_function(name, |b| {
        b.iter(|| {
            let [x, y, z, normal_force, tx, ty, tz, margin, utilisation] =
                columns.each_mut().map(|column| &mut column[..]);
            let touches = Touches {
                point: [x, y, z],
                normal_force,
                tangential_force: [tx, ty, tz],
                margin,
                utilisation,
                slip: &mut slip,
            };
            sense_all(black_box(raw.each_ref().map(|column| &column[..])), touches);
            black_box((&mut columns, &mut slip));
        });
    });
}

fn scenes(c: &mut Criterion) {
    let mut group = c.benchmark_group("scenes");
    group.throughput(Throughput::Elements(COUNT as u64));
    scene::<SceneA, 6>(&mut group);
    if let Some(hand) = HandA::new() {
        let volts: Vec<[f32; 6]> = volts::<SceneA, 6>().into_iter().map(Into::into).collect();
        run(&mut group, "a, by hand", hand, &volts, |hand, volts| -> Felt { hand.sense(volts) });
        batch_of_scene_a(&mut group, "a, batch by hand", |raw, touches| hand.sense_all(raw, touches));
    }
    if let Some(mut scene) = SceneA::new() {
        batch_of_scene_a(&mut group, "a, batch", |raw, touches| {
            scene.fingertip.sense_all(raw, 1e-3, touches);
        });
    }
    scene::<SceneB, 6>(&mut group);
    if let Some(hand) = HandB::new() {
        let volts: Vec<[f32; 6]> = volts::<SceneB, 6>().into_iter().map(Into::into).collect();
        run(&mut group, "b, by hand", hand, &volts, |hand, volts| -> Felt { hand.sense(volts) });
    }
    scene::<SceneC, 8>(&mut group);
    scene::<SceneD, 8>(&mut group);
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(700))
        .sample_size(40);
    targets = scenes
}
criterion_main!(benches);
