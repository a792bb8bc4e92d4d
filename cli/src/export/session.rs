//! Samples to play through an exported scene, with the answers of the scene itself.

use core::fmt::Write as _;

use fingertip::wrench::{Real, Wrench};
use fingertip_scene::{CLibrary, Felt, GaugeReading, Pipeline, Scene, SceneProblem};
use nalgebra::{Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::de::DeserializeOwned;

/// How many samples are played.
const SAMPLES: usize = 200;
/// Seconds between them.
const STEP: f64 = 1e-3;
/// How often another sample is drawn for one that is no contact.
const TRIES: usize = 300;
/// Temperature of the sensor where the scene tells none \[°C\].
const USUAL_CELSIUS: f64 = 20.0;

/// A session as the header `session.h`.
#[derive(Debug)]
pub(super) struct Session {
    pub(super) text: String,
}

/// How far a point [m] and a normal of a library in single precision alone may be from those of the scene.
pub(super) const NEAR: [f64; 2] = [1e-5, 1e-3];

/// What draws samples for a scene.
struct Drawn<'a, T: Real> {
    random: Pcg64Mcg,
    scene: &'a Scene,
    celsius: Option<T>,
    takes_gauges: bool,
}

impl<T: Real> Drawn<'_, T> {
    /// A wrench of a force whose line passes near the middle of the surface, as the sensor reports it, or what gauges make
    /// of it.
    fn sample(&mut self) -> Vec<T> {
        let random = &mut self.random;
        let mut vector = |size: f64| Vector3::from_fn(|_, _| random.random_range(-size..size));
        let (direction, off, spin) = (vector(1.0), vector(1.0), vector(2e-4));
        let strength =
            (self.scene.least_force().max(1e-2) * 3.0).max(10_f64.powf(random.random_range(-0.5..0.7)));
        // Of unknown size: from half a millimetre to five centimetres.
        let size = 5e-4 * 10_f64.powf(random.random_range(0.0..2.0));
        let force = direction.normalize() * strength;
        let at = self.scene.projection().centre() + off * size;
        let load: Wrench<f64> = Wrench::on_fingertip(force, at.cross(&force) + spin * strength);
        let reported = match self.scene.convention() {
            fingertip_scene::Convention::OnFingertip => load.components(),
            fingertip_scene::Convention::Reaction => -load.components(),
        };
        match self.scene.calibration().filter(|_| self.takes_gauges) {
            None => reported.iter().map(|x| T::literal(*x)).collect(),
            Some(file) => {
                let nominal =
                    Vector6::from_iterator(file.nominal.iter().copied().chain(core::iter::repeat(1.0)));
                let signals = &file.matrix * reported.component_div(&nominal);
                let zeros = file.zero.iter().copied().chain(core::iter::repeat(0.0));
                signals.iter().zip(zeros).map(|(signal, zero)| T::literal(signal + zero)).collect()
            }
        }
    }

    /// What the scene says of a sample; `None` of a reading that is none.
    fn felt<'p>(&self, pipeline: &'p mut Pipeline<T>, sample: &[T]) -> Option<&'p Felt<T>> {
        let step = T::literal(STEP);
        if self.takes_gauges {
            let reading = GaugeReading { gauges: sample, dummy: None, celsius: self.celsius };
            return pipeline.sense_reading(&reading, None, step).ok();
        }
        let [fx, fy, fz, tx, ty, tz] = *sample.first_chunk::<6>()?;
        let wrench = self.scene.convention().wrench(Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz));
        Some(pipeline.sense(wrench, step))
    }
}

impl Session {
    /// Random contacts, one sample in ten as it comes.
    pub(super) fn of<T: Real + DeserializeOwned>(
        scene: &Scene,
        library: &CLibrary,
    ) -> Result<Self, SceneProblem> {
        let celsius = library.is_warm().then(|| T::literal(scene.celsius().unwrap_or(USUAL_CELSIUS)));
        let random = Pcg64Mcg::seed_from_u64(7);
        let mut drawn = Drawn { random, scene, celsius, takes_gauges: library.takes_gauges() };
        let mut pipeline = scene.pipeline_in::<T>()?;
        let (mut samples, mut sums, mut told) = (Vec::new(), Vec::new(), Vec::new());
        while samples.len() < SAMPLES {
            let wanted = if samples.len() % 10 == 9 { 1 } else { TRIES };
            let mut sample = drawn.sample();
            for _ in 1..wanted {
                let felt = drawn.felt(&mut pipeline.clone(), &sample).copied();
                if felt.is_some_and(|felt| felt.contact().is_some()) {
                    break;
                }
                sample = drawn.sample();
            }
            // A reading that is saturated is no sample.
            let Some(felt) = drawn.felt(&mut pipeline, &sample) else { continue };
            sums.push(fold(felt, library));
            told.push(Told::of(felt));
            samples.push(sample);
        }
        let mut text = written(&samples, &sums, library, celsius);
        if !library.is_exact() {
            text.push_str(&near(&told));
        }
        Ok(Self { text })
    }
}

/// `session.h`.
fn written<T: Real>(samples: &[Vec<T>], sums: &[u32], library: &CLibrary, celsius: Option<T>) -> String {
    let mut text = String::new();
    let c = if size_of::<T>() == 4 { "float" } else { "double" };
    let end = if size_of::<T>() == 4 { "f" } else { "" };
    // Writing to a string cannot fail.
    let _ = write!(
        text,
        "/* Samples, and a number for all bits of each answer. Written by `fingertip export --c`. */\n\
         #include <stdint.h>\n#define TIP_SAMPLES {}\n{}static const {c} tip_step = {STEP:e}{end};\n",
        samples.len(),
        if library.takes_gauges() && !library.is_warm() { "#define TIP_TAKES_ZERO 1\n" } else { "" },
    );
    if let Some(celsius) = celsius {
        let _ = writeln!(text, "static const {c} tip_celsius = {:e}{end};", celsius.to_f64());
    }
    let _ = writeln!(text, "static const {c} tip_session[TIP_SAMPLES][{}] = {{", library.inputs());
    for sample in samples {
        let numbers: Vec<String> =
            sample.iter().map(|number| format!("{:e}{end}", number.to_f64())).collect();
        let _ = writeln!(text, "    {{{}}},", numbers.join(", "));
    }
    let sums: Vec<String> = sums.iter().map(|sum| format!("{sum}u")).collect();
    let _ = writeln!(text, "}};\nstatic const uint32_t tip_expected[TIP_SAMPLES] = {{{}}};", sums.join(", "));
    text
}

/// What the answer of a library in single precision alone is compared with.
struct Told {
    resolution: u32,
    point: [f64; 3],
    normal: [f64; 3],
}

impl Told {
    fn of<T: Real>(felt: &Felt<T>) -> Self {
        let vector = |vector: Option<Vector3<T>>| {
            vector.map_or([0.0; 3], |vector| <[T; 3]>::from(vector).map(Real::to_f64))
        };
        Self {
            resolution: resolution(felt),
            point: vector(felt.contact().map(|contact| contact.point)),
            normal: vector(felt.contact().map(|contact| contact.normal)),
        }
    }
}

/// How near answers shall be, and to what, for `session.h`.
fn near(told: &[Told]) -> String {
    let [point, normal] = NEAR;
    let rows = |of: &dyn Fn(&Told) -> [f64; 3]| {
        told.iter()
            .map(|told| format!("    {{{}}},\n", of(told).map(|x| format!("{x:e}f")).join(", ")))
            .collect::<String>()
    };
    let resolutions: Vec<String> = told.iter().map(|told| format!("{}u", told.resolution)).collect();
    format!(
        "/* How far a point [m] and a normal may be from these. */\n#define TIP_NEAR {point:e}f\n\
         #define TIP_NEAR_NORMAL {normal:e}f\n\
         static const uint32_t tip_expected_resolution[TIP_SAMPLES] = {{{}}};\n\
         static const float tip_expected_point[TIP_SAMPLES][3] = {{\n{}}};\n\
         static const float tip_expected_normal[TIP_SAMPLES][3] = {{\n{}}};\n",
        resolutions.join(", "),
        rows(&|told| told.point),
        rows(&|told| told.normal),
    )
}

/// The number of a resolution for C.
fn resolution<T: Real>(felt: &Felt<T>) -> u32 {
    felt.touch.resolution.into_result().map_or_else(|why| why.number(), |_| 0)
}

/// A number for all bits of an answer: FNV-1a over the words of the structure that C gets.
fn fold<T: Real>(felt: &Felt<T>, library: &CLibrary) -> u32 {
    let touch = &felt.touch;
    let (contact, force, margin) = (felt.contact(), felt.force(), felt.margin());
    let zero = T::zero();
    let vector = |vector: Option<Vector3<T>>| <[T; 3]>::from(vector.unwrap_or_else(Vector3::zeros));
    let (load, torque) = (touch.wrench.force(), touch.wrench.torque());
    let mut numbers = Vec::new();
    numbers.extend(vector(Some(load)));
    numbers.extend(vector(Some(torque)));
    numbers.extend(vector(contact.map(|contact| contact.point)));
    numbers.extend(vector(contact.map(|contact| contact.normal)));
    numbers.push(force.map_or(zero, |force| force.normal));
    numbers.extend(vector(force.map(|force| force.tangential.vector())));
    numbers.push(force.map_or(zero, |force| force.spin));
    numbers.push(contact.map_or(zero, |contact| contact.gap));
    numbers.push(margin.map_or(zero, |margin| margin.newtons));
    numbers.push(margin.map_or(zero, |margin| margin.utilisation));
    if library.has_grip() {
        numbers.push(felt.grip_force.unwrap_or(zero));
    }
    let mut words = vec![
        resolution(felt),
        touch.slip.map_or(0, |slip| slip as u32),
        u32::from(margin.is_some()),
        contact.map_or(0, |contact| u32::from(contact.alternatives)),
    ];
    for number in numbers {
        let wide = number.to_f64();
        if size_of::<T>() == 4 {
            #[allow(clippy::cast_possible_truncation, reason = "it came from that precision")]
            words.push((wide as f32).to_bits());
        } else {
            let bits = wide.to_bits();
            words.extend([bits & 0xffff_ffff, bits >> 32].map(|half| u32::try_from(half).unwrap_or(0)));
        }
    }
    words.into_iter().fold(0x811c_9dc5_u32, |sum, word| (sum ^ word).wrapping_mul(0x0100_0193))
}

/// What an exported library is played with is held bit for bit; `.ci/firmware-c` plays it.
#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::path::Path;

    use fingertip_scene::{Scalar, Scene};
    use fingertip_test_support::Unchanged;

    use super::Session;

    #[test]
    fn sessions_stay_as_they_are() {
        let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/sessions.txt");
        let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes");
        let mut scenes: Vec<_> = ["paper_sphere", "capsule", "nano17_cylinder", "ellipsoid", "gauges"]
            .map(|name| (name, Scene::load(examples.join(format!("{name}.toml"))).unwrap()))
            .into();
        let gauges = std::fs::read_to_string(examples.join("gauges.toml")).unwrap();
        let zeroed = gauges.replace("range = [", "zero = [0.5, -0.25, 0.125, 0.0625, 1.0, -1.0]\nrange = [");
        scenes.push(("gauges with a zero", Scene::from_text(&zeroed).unwrap()));
        let grip = "[grip]\nleast_N = 0.2\ngreatest_N = 20.0\nrise_N_per_s = 100.0\nfall_N_per_s = 2.0\n";
        let sphere = std::fs::read_to_string(examples.join("paper_sphere.toml")).unwrap();
        scenes.push(("paper_sphere that grips", Scene::from_text(&(sphere + grip)).unwrap()));
        for (name, scene) in scenes {
            let single = scene.to_c(Scalar::F32, None, "tip").unwrap();
            let double = scene.to_c(Scalar::F64, None, "tip").unwrap();
            let sessions =
                [Session::of::<f32>(&scene, &single).unwrap(), Session::of::<f64>(&scene, &double).unwrap()];
            for (scalar, session) in ["f32", "f64"].into_iter().zip(sessions) {
                assert!(session.text.contains("#define TIP_SAMPLES 200\n"));
                unchanged.note(&format!("{name} {scalar}"), session.text.lines());
            }
        }
        unchanged.check();
    }
}
