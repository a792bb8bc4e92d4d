//! Scenes that nobody would write on purpose: each is refused in a sentence, or is one of finite numbers.
use std::path::Path;

use fingertip::surfaces::ActiveSurface;
use fingertip::wrench::{Line, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use toml::{Table, Value};

use fingertip_scene::Scene;

const SCENES: [&str; 6] = [
    include_str!("../../../examples/scenes/capsule.toml"),
    include_str!("../../../examples/scenes/ellipsoid.toml"),
    include_str!("../../../examples/scenes/nano17_cylinder.toml"),
    include_str!("../../../examples/scenes/paper_sphere.toml"),
    include_str!("../../../examples/scenes/plane.toml"),
    EVERYTHING,
];

/// One of each section.
const EVERYTHING: &str = "version = 2\nname = 'all'\n[input]\nconvention = 'on_fingertip'\nsample_rate_Hz = 1000.0\n\
    [sensor]\nsignal_unit = 'V'\nload_per_signal_N_Nm = [[5.0, 0.0, 0.0, 0.0, 0.0, 0.1], [0.0, 5.0, 0.0, 0.0, 0.0, 0.0], \
    [0.0, 0.0, 5.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 5.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 5.0, 0.0], \
    [0.0, 0.0, 0.0, 0.0, 0.0, 5.0]]\nzero = [0.0, 0.1, 0.0, 0.0, 0.0, 0.0]\nrange = [-5.0, 5.0]\ntemperature_C = 20.0\n\
    [payload]\nmass_kg = 0.1\ncentre_of_mass_m = [0.0, 0.0, 0.01]\n[filter]\nkind = 'low_pass'\ncutoff_Hz = 100.0\n\
    [surface]\nshape = 'capsule'\nradius_m = 0.008\nhalf_length_m = 0.01\n[pose]\nrotation_deg = [0.0, 90.0, 0.0]\n\
    [contact]\nmodel = 'soft_finger'\nleast_force_N = 0.1\nskin_share = 0.9\n\
    [contact.skin]\nlaw = 'local_hertz'\nlargest_radius_m = 0.1\nyoung_moduli_Pa = [2.0e6, inf]\npoisson_ratios = [0.49, 0.3]\n\
    [uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\nposition_m = 0.0001\nattitude_deg = 0.5\n\
    [tracking]\nspeed_m_per_s = 0.01\nturns_within_s = 0.1\nleast_touch_N = 0.1\n\
    [friction]\nlimit = 'uncertain'\nstatic_coefficient = 0.5\ndeviation = 0.05\n\
    [slip]\ndetector = 'likelihood_ratio'\nnoise_N = 0.01\n[estimate]\nnoise_N = 0.01\n\
    [grip]\nleast_N = 0.2\ngreatest_N = 20.0\nrise_N_per_s = 100.0\nfall_N_per_s = 2.0\n";

fn pick<'a, T>(random: &mut Pcg64Mcg, list: &'a [T]) -> &'a T {
    &list[random.random_range(0..list.len())]
}

/// A value that may be meant for something else.
fn odd(random: &mut Pcg64Mcg) -> Value {
    let numbers = [
        0.0,
        -0.0,
        -1.0,
        1e-320,
        -1e-320,
        // In millimetres still a number.
        1e300,
        -1e300,
        1e200,
        1e-200,
        180.0,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
    ];
    let number = *pick(random, &numbers);
    match random.random_range(0..10) {
        0 => Value::String(String::new()),
        1 => Value::String("sphere".to_owned()),
        2 => Value::Boolean(true),
        3 => Value::Integer(*pick(random, &[0, -1, 7, i64::MAX, i64::MIN])),
        4 => Value::Array(vec![Value::Float(number); random.random_range(0..5)]),
        5 => Value::Table(Table::new()),
        6 => Value::Array(vec![Value::Table(Table::new())]),
        _ => Value::Float(number),
    }
}

/// Changes one thing of a section, or of one below it.
fn spoil(random: &mut Pcg64Mcg, table: &mut Table) {
    let keys: Vec<String> = table.keys().cloned().collect();
    let Some(key) = (!keys.is_empty()).then(|| pick(random, &keys).clone()) else { return };
    let choice = random.random_range(0..8);
    match table.get_mut(&key) {
        Some(Value::Table(below)) if choice > 0 => spoil(random, below),
        Some(Value::Array(list)) if choice > 3 && !list.is_empty() => {
            let index = random.random_range(0..list.len());
            list[index] = odd(random);
        }
        _ => match choice {
            0 => drop(table.remove(&key)),
            1 => {
                let value = table.remove(&key).unwrap();
                table.insert(format!("{key}x"), value);
            }
            2 => {
                let others =
                    ["radius_m", "shape", "axis", "pole", "file", "noise_N", "rest_s", "law", "limit"];
                table.insert((*pick(random, &others)).to_owned(), odd(random));
            }
            _ => drop(table.insert(key, odd(random))),
        },
    }
}

fn spoiled(random: &mut Pcg64Mcg) -> String {
    let original = *pick(random, &SCENES);
    let mut table: Table = original.parse().unwrap();
    (0..random.random_range(1..4)).for_each(|_| spoil(random, &mut table));
    let mut text = toml::to_string(&table).unwrap();
    match random.random_range(0..10) {
        // A section twice, and text that ends too early.
        0 => {
            let twice = ["\n[surface]\nshape = 'plane'\n", "\n[input]\n", "\n[slip]\n[slip]\n"];
            text.push_str(twice[random.random_range(0..twice.len())]);
        }
        1 => {
            let end = random.random_range(0..text.len());
            text = text.chars().take(end).collect();
        }
        _ => {}
    }
    text
}

/// What is computed with a scene, for a line past its surface and for a push.
fn numbers(scene: &Scene) -> Vec<f64> {
    let line = Line { point: Vector3::new(0.001, 0.002, 0.003), direction: Vector3::x() };
    let (u, v) = scene.projection().project(&line.point);
    let mut all = vec![u, v];
    // A surface as large as the world has no nearest point in numbers: what it gives then is no contact.
    if let Some(approach) = scene.surface().closest_approach(&line)
        && approach.point.iter().all(|x| x.is_finite())
    {
        all.extend(approach.normal.iter().copied());
    }
    let push = Wrench::from_force_at(&Vector3::new(0.001, 0.0, 0.002), Vector3::new(0.1, 0.2, -1.0));
    let mut pipeline = scene.pipeline();
    let felt = pipeline.sense(push, 1e-3);
    if let Some(contact) = felt.contact() {
        all.extend(contact.point.iter().chain(contact.normal.iter()).copied());
    }
    all.extend(felt.spread.iter().flat_map(|spread| spread.ellipse.semi_axes));
    all.extend(felt.tracked.iter().flat_map(|tracked| {
        [tracked.point, tracked.velocity]
            .into_iter()
            .flat_map(|v| [v.x, v.y, v.z])
            .chain([tracked.deviation()])
    }));
    all.extend([felt.slip_probability, felt.grip_force].into_iter().flatten());
    all.extend([scene.sample_rate(), scene.rest()].into_iter().flatten());
    all.extend(scene.limit().map(fingertip_scene::Limit::coefficient));
    all.push(scene.least_force());
    all
}

#[test]
fn a_spoiled_scene_is_refused_in_a_sentence_or_has_finite_numbers() {
    let random = &mut Pcg64Mcg::seed_from_u64(17);
    let (mut refused, mut taken) = (0, 0);
    for _ in 0..2500 {
        let text = spoiled(random);
        match Scene::parse(&text, "test", Path::new("")) {
            Err(fault) => {
                let (line, message) = (fault.line, fault.problem.to_string());
                refused += 1;
                assert!(message.len() > 10 && !message.contains('\n'), "{message:?} for\n{text}");
                assert!(
                    line.is_none_or(|line| line >= 1 && line <= text.lines().count() + 1),
                    "{line:?}\n{text}"
                );
            }
            Ok(scene) => {
                taken += 1;
                let numbers = numbers(&scene);
                assert!(numbers.iter().all(|number| number.is_finite()), "{numbers:?} from\n{text}");
            }
        }
    }
    assert!(refused > 400 && taken > 80, "{refused} refused, {taken} taken");
}
