//! The module that an export is: header, imports, constants, the pipeline, and what stands beside it.

use core::fmt::Write as _;

use fingertip::wrench::Real;
use fingertip_calibration::file::{CalibrationFile, Scalar};
use serde::de::DeserializeOwned;
use toml::Value;

use super::ExportError;
use super::beside::Beside;
use super::calibrated::{Solved, uncertainty};
use super::layout::{comment, laid_out};
use super::resolved::resolve;
use super::shapes::ON_THE_HEAP;
use super::template::{Typed, Writer};
use crate::input::Convention;
use crate::scene::Scene;

/// The sections that are exported, or that are of no sample: how recordings are read, and how points are drawn.
const KNOWN: [&str; 17] = [
    "version",
    "name",
    "input",
    "sensor",
    "payload",
    "filter",
    "surface",
    "pose",
    "map",
    "contact",
    "uncertainty",
    "tracking",
    "fusion",
    "friction",
    "slip",
    "estimate",
    "grip",
];

/// What can be wrong with numbers: where it shows that it can, its variant, its type, and what it is of.
const FAULTS: [(&str, &str, &str, &str); 12] = [
    ("", "Shape", "surfaces::BadShape", "A shape, a contact model or an uncertainty."),
    ("friction::", "Friction", "friction::BadParameter", "A friction, a detector or a grip."),
    ("contact::Tracker::new", "Track", "contact::BadTrack", "What follows a contact over time."),
    ("wrench::Payload::new", "Payload", "wrench::BadPayload", "What the sensor carries."),
    ("RigidTransform::from_matrix", "Pose", "wrench::TransformError", "A pose."),
    ("surfaces::Mesh::new", "Mesh", "surfaces::MeshError", "A mesh."),
    ("calibration::sensor_matrix", "Sensor", "wrench::SensorMatrixError", "The sensor matrix."),
    (
        "GaussianElimination::new",
        "Singular",
        "wrench::SingularMatrix",
        "A sensor that does not tell all loads.",
    ),
    ("LeastSquares::new", "Singular", "wrench::LeastSquaresError", "A sensor that does not tell all loads."),
    ("calibration::curved_sensor", "Curve", "wrench::BadCurve", "The terms of a curved sensor."),
    ("calibration::region", "Region", "wrench::BadRegion", "Where the sensor was calibrated."),
    ("calibration::temperature", "Temperature", "wrench::BadTemperatureModel", "The drift with temperature."),
];

/// The stages of the pipeline.
struct Stages {
    surface: Typed,
    model: Typed,
    limit: Option<Typed>,
    detector: Option<Typed>,
    solved: Option<Solved>,
    /// The expression of the wrench that goes in.
    given: String,
}

/// A module, and what those who call it must know.
pub(super) struct Module {
    pub(super) text: String,
    /// How many gauges a reading has; `None` if samples are wrenches.
    pub(super) gauges: Option<usize>,
    /// Whether a reading has a temperature.
    pub(super) is_warm: bool,
    /// Readings at or beyond these are saturated.
    pub(super) range: Option<[f64; 2]>,
    pub(super) has_limit: bool,
    pub(super) has_detector: bool,
    /// Features of `fingertip` that it needs.
    pub(super) features: Vec<&'static str>,
}

/// The module of a scene.
pub(super) fn of<T: Real + DeserializeOwned>(
    scene: &Scene,
    scalar: Scalar,
    calibration: Option<&CalibrationFile>,
) -> Result<Module, ExportError> {
    let resolved = resolve::<T>(scene)?;
    if let Some(unknown) = resolved.keys().find(|key| !KNOWN.contains(&key.as_str())) {
        return Err(ExportError::NoType { what: format!("the section [{unknown}]") });
    }
    if scene.awaits_noise() {
        let what = "a threshold or an uncertainty that the rest tells (state `least_force_N` and the noise)"
            .to_owned();
        return Err(ExportError::NoType { what });
    }
    let calibration = calibration.or_else(|| scene.calibration());
    let section = |name: &str| resolved.get(name).and_then(Value::as_table);
    let needed =
        |name: &str| section(name).cloned().ok_or_else(|| ExportError::Missing { key: name.to_owned() });
    // Also checks that each number is within the range of the precision.
    let pipeline = scene.pipeline_in::<T>()?;
    let contact = needed("contact")?;
    let uncertainty = uncertainty::<T>(scene, &resolved, calibration)?;
    let mut writer = Writer::<T>::new();
    let (mut beside, given) = writer.before(&pipeline, calibration.is_some())?;
    let stages = Stages {
        surface: writer.placed(&needed("surface")?, &scene.pose)?,
        model: writer.model(&contact, uncertainty.as_ref())?,
        limit: match (section("friction"), pipeline.limit()) {
            (Some(friction), Some(limit)) => Some(writer.limit(friction, limit)?),
            _ => None,
        },
        detector: match section("slip") {
            Some(slip) => Some(writer.detector(slip, pipeline.limit(), scene.sample_rate())?),
            None => None,
        },
        solved: match calibration {
            Some(file) => Some(writer.solved(file, scalar, scene.convention())?),
            None => None,
        },
        given,
    };
    if let Some(uncertainty) = &uncertainty {
        beside.push(writer.uncertainty(uncertainty, &contact)?);
    }
    if let Some(tracking) = section("tracking") {
        beside.push(writer.tracking(tracking, uncertainty.as_ref(), &contact)?);
    }
    if let Some(joined) = pipeline.fusion() {
        let calibrated = uncertainty.as_ref().is_some_and(|uncertainty| uncertainty.calibration.is_some());
        beside.push(writer.fusion(joined, calibrated)?);
    }
    if let Some(friction) = section("friction") {
        beside.extend(writer.friction_model(friction)?);
    }
    if let Some(estimate) = section("estimate") {
        beside.push(writer.estimate(estimate)?);
    }
    if let Some(grip) = section("grip") {
        beside.push(writer.grip(grip, stages.detector.is_some())?);
    }
    let items = items::<T>(scene, &stages, &beside, &writer.statics);
    let header = header::<T>(scene, &stages, &beside, &items);
    let solved = stages.solved.as_ref();
    // The module of a calibration stands for itself.
    let own = solved.map_or("", |solved| solved.module.as_str());
    Ok(Module {
        text: format!("{header}{}{}{own}", imports(&items), laid_out(&with_imports(&items))),
        gauges: calibration.map(CalibrationFile::gauges),
        is_warm: solved.is_some_and(|solved| solved.is_warm),
        range: solved.and_then(|solved| solved.range),
        has_limit: stages.limit.is_some(),
        has_detector: stages.detector.is_some(),
        features: features(&items),
    })
}

/// A text that stays within a comment.
fn in_a_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
}

/// Whether the items need a heap.
fn on_the_heap(items: &str) -> bool {
    ON_THE_HEAP.iter().any(|shape| items.contains(shape))
}

/// The feature that refines single precision in double.
pub(super) const MIXED_PRECISION: &str = "mixed-precision";

/// Features of `fingertip` that the items need.
fn features(items: &str) -> Vec<&'static str> {
    let mut features = vec!["libm", MIXED_PRECISION];
    features.extend(on_the_heap(items).then_some("alloc"));
    features.extend(items.contains("friction::").then_some("friction"));
    features.extend(items.contains("contact::Compliant").then_some("skin"));
    features.extend(items.contains("contact::Tracker").then_some("track"));
    features.extend(items.contains("contact::Fusion").then_some("fusion"));
    features
}

/// What the module is, what it needs, and how it is called.
fn header<T: Real>(scene: &Scene, stages: &Stages, beside: &[Beside], items: &str) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        text,
        "// {}: a fingertip as a type, in {}.\n//\n// Written by `fingertip export` (fingertip-scene {}). Change the \
         scene and export it again rather than this.\n//\n",
        in_a_line(scene.name()),
        core::any::type_name::<T>(),
        env!("CARGO_PKG_VERSION"),
    );
    for line in scene.meaning() {
        text.push_str(&comment(&in_a_line(&line), 3, 13));
    }
    let features: Vec<String> = features(items).iter().map(|feature| format!("{feature:?}")).collect();
    let heap = if on_the_heap(items) {
        "a heap, but no standard library"
    } else {
        "neither heap nor standard library"
    };
    let _ = write!(
        text,
        "//\n// It needs {heap}, and in Cargo.toml:\n//\n//   fingertip = {{ version = \"{}\", default-features = false, \
         features = [{}] }}\n//\n// With a standard library, \"std\" in the place of \"libm\".\n//\n",
        env!("CARGO_PKG_VERSION"),
        features.join(", "),
    );
    for line in usage::<T>(scene, stages, beside).lines() {
        let _ = writeln!(text, "//{}{line}", if line.is_empty() { "" } else { " " });
    }
    text
}

/// How a sample is taken.
fn usage<T: Real>(scene: &Scene, stages: &Stages, beside: &[Beside]) -> String {
    let sense = match &stages.solved {
        Some(solved) => format!("let touch = tip.sense(&reading, step); // reading: {}", solved.reading),
        None => format!("let touch = tip.sense_wrench({}, step);", stages.given),
    };
    let mut text = format!(
        "Once, and then for each sample, `time_step` seconds after the one before:\n\n    \
             let (mut tip, mut last) = (tip()?, None);\n\n    \
             let step = fingertip::Step::of(time_step).with_last(last);\n    \
             {sense}\n    \
             last = touch.point();\n"
    );
    if let Some([low, high]) = stages.solved.as_ref().and_then(|solved| solved.range) {
        let _ = write!(
            text,
            "\nA gauge at or below {low:?}, or at or above {high:?}, is saturated: leave such a reading out.\n"
        );
    }
    if let Some(rest) = scene.rest() {
        let then = match &stages.solved {
            None => "the mean of force and torque there is to be taken off both.",
            Some(solved) if solved.is_warm => "the zero stays that of the calibration at its temperature.",
            Some(_) => "a `wrench::TareAccumulator` makes a zero of it, which `tip.set_zero` puts in place.",
        };
        let _ = write!(text, "\nThe sensor is unloaded for {rest:?} s at the start: {then}\n");
    }
    if stages.detector.is_some() {
        let _ = write!(
            text,
            "\nAfter a pause, `last = None` and `friction::SlipDetector::<{}>::reset(&mut tip.detector_mut().0)`.\n",
            core::any::type_name::<T>()
        );
    }
    for part in beside {
        text.push('\n');
        text.push_str(&part.call);
    }
    text
}

/// The imports of what the items name.
fn imports(items: &str) -> String {
    let mut text = "\n".to_owned();
    if items.contains(".to_vec()") {
        text.push_str("extern crate alloc;\n\n");
    }
    let crates: Vec<&str> = ["contact", "friction", "surfaces", "wrench"]
        .into_iter()
        .filter(|name| items.contains(&format!("{name}::")))
        .collect();
    let stages: Vec<&str> = ["Absent", "Fingertip", "Present"]
        .into_iter()
        .filter(|name| items.contains(&format!("{name},")) || items.contains(&format!("{name}<")))
        .collect();
    let numeric: Vec<&str> =
        NUMERIC.into_iter().filter(|name| items.contains(&format!("nalgebra::{name}"))).collect();
    if let [first, rest @ ..] = numeric.as_slice() {
        let list = if rest.is_empty() { (*first).to_owned() } else { format!("{{{}}}", numeric.join(", ")) };
        let _ = writeln!(text, "use fingertip::nalgebra::{list};");
    }
    let _ = writeln!(
        text,
        "use fingertip::{{{}}};\nuse fingertip::{{{}}};",
        stages.join(", "),
        crates.join(", ")
    );
    text
}

/// What is imported of nalgebra where it is used.
const NUMERIC: [&str; 7] =
    ["ComplexField", "Matrix3", "Matrix6", "RealField", "SVector", "Vector3", "Vector6"];

/// The items with imported names.
fn with_imports(items: &str) -> String {
    NUMERIC.iter().fold(items.to_owned(), |items, name| items.replace(&format!("nalgebra::{name}"), name))
}

/// All items of the module.
fn items<T: Real>(scene: &Scene, stages: &Stages, beside: &[Beside], statics: &[String]) -> String {
    let mut text = String::new();
    for list in statics {
        let _ = write!(text, "\n{list}");
    }
    text.push_str(&pipeline(stages));
    if stages.solved.is_none() {
        let make = match scene.convention() {
            Convention::OnFingertip => "on_fingertip",
            Convention::Reaction => "from_reaction",
        };
        let t = core::any::type_name::<T>();
        let _ = write!(
            text,
            "\n/// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.\n\
             pub fn load(force: nalgebra::Vector3<{t}>, torque: nalgebra::Vector3<{t}>) -> wrench::Wrench<{t}> {{\n    \
                 wrench::Wrench::{make}(force, torque)\n}}\n"
        );
    }
    for part in beside {
        text.push_str(&part.items);
    }
    let faults = faults(&text);
    text.push_str(&faults);
    if let Some(solved) = &stages.solved {
        text.push_str(&solved.opposite);
    }
    text
}

/// The type of the pipeline, and the function that makes it.
fn pipeline(stages: &Stages) -> String {
    let Stages { surface, model, limit, detector, solved, .. } = stages;
    let present = |stage: &Option<Typed>| {
        stage.as_ref().map_or_else(|| "Absent".to_owned(), |stage| format!("Present<{}>", stage.of))
    };
    let solver = solved.as_ref().map_or("Absent", |solved| &solved.solver.of);
    let mut text = format!(
        "\n/// The pipeline.\npub type Tip = Fingertip<\n    {solver},\n    {},\n    {},\n    {},\n    {},\n",
        surface.of,
        model.of,
        present(limit),
        present(detector)
    );
    if let Some(solved) = solved {
        let _ = writeln!(text, "    {},", solved.zero.of);
    }
    let _ = write!(
        text,
        ">;\n\n/// Makes the pipeline.\n///\n/// # Errors\n/// Never for the numbers below.\n\
         #[allow(clippy::approx_constant)]\n\
         pub fn tip() -> Result<Tip, BadTip> {{\n    let surface = {};\n    let model = {};\n    \
         Ok(Fingertip::builder()\n",
        surface.make, model.make
    );
    if let Some(solved) = solved {
        let _ =
            write!(text, "        .zero({})\n        .solver({})\n", solved.zero.make, solved.solver.make);
    }
    text.push_str("        .contact(surface, model)\n");
    for (stage, method) in [(limit, "friction"), (detector, "slip_detector")] {
        if let Some(stage) = stage {
            let _ = writeln!(text, "        .{method}({})", stage.make);
        }
    }
    text.push_str("        .build())\n}\n");
    text
}

/// What functions of the module return in the place of an error.
fn faults(items: &str) -> String {
    const ABOUT: &str =
        "Why the numbers of this module make nothing: never, unless they are edited into nonsense.";
    let can: Vec<_> = FAULTS.iter().filter(|(where_, ..)| items.contains(where_)).collect();
    if let [(_, _, of, _)] = can.as_slice() {
        return format!("\n/// {ABOUT}\npub type BadTip = {of};\n");
    }
    let mut text = format!("\n/// {ABOUT}\n#[derive(Clone, Debug, PartialEq)]\npub enum BadTip {{\n");
    for (_, variant, of, says) in &can {
        let _ = write!(text, "    /// {says}\n    {variant}({of}),\n");
    }
    text.push_str(
        "}\n\nimpl core::fmt::Display for BadTip {\n    \
             fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {\n        match self {\n",
    );
    for (_, variant, ..) in &can {
        let _ = writeln!(text, "            Self::{variant}(bad) => bad.fmt(f),");
    }
    text.push_str("        }\n    }\n}\n\nimpl core::error::Error for BadTip {}\n");
    for (_, variant, of, _) in &can {
        let _ = write!(
            text,
            "\nimpl From<{of}> for BadTip {{\n    fn from(bad: {of}) -> Self {{\n        Self::{variant}(bad)\n    }}\n}}\n"
        );
    }
    text
}
