//! Exported modules: they are what is exported today, they compile, and they give the bits of the pipeline at run time.

use std::path::{Path, PathBuf};
use std::{env, fs};

use fingertip::contact::ContactModel;
use fingertip::surfaces::ActiveSurface;
use fingertip::wrench::{Real, Uncompensated};
use fingertip::{Absent, Fingertip, GripStage, SlipStage, Step};
use fingertip_calibration::file::CalibrationFile;
use fingertip_scene::registry::entries;
use fingertip_scene::{ExportError, Pipeline, Scalar, Scene};

use crate::choices::scene_with;
use crate::curved::curved;
use crate::export_beside::{SKINNED, calibration, pushes_on};
use crate::{HEAD, exported};

pub(crate) fn example(name: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes");
    Scene::load(folder.join(format!("{name}.toml"))).unwrap()
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/all/exported/{name}.rs"))
}

/// That a module names no package but `fingertip`: what else it calls by name, it has imported from there.
fn needs_fingertip_alone(name: &str, text: &str) {
    let mut imports = text.lines().filter_map(|line| line.trim().strip_prefix("use "));
    assert_eq!(imports.find(|path| !path.starts_with("fingertip::")), None, "{name}");
    let (module, calibration) = text.split_once("pub mod calibration {").unwrap_or((text, ""));
    assert_eq!(
        module.matches("nalgebra::").count(),
        module.matches("fingertip::nalgebra::").count(),
        "{name}"
    );
    assert!(
        !calibration.contains("nalgebra::") || calibration.contains("use fingertip::{nalgebra, "),
        "{name}"
    );
}

/// That a file holds a text; with `FINGERTIP_ACCEPT=1` it is written there instead.
fn holds(name: &str, text: &str) {
    needs_fingertip_alone(name, text);
    let path = file(name);
    if env::var_os("FINGERTIP_ACCEPT").is_some() {
        fs::write(&path, text).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == text,
        "{} is not what is exported today; run this test with FINGERTIP_ACCEPT=1 and look at the difference",
        path.display()
    );
}

#[test]
fn the_modules_are_what_is_exported_today() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes");
    for entry in fs::read_dir(examples).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            let name = path.file_stem().unwrap().to_str().unwrap();
            let exported = example(name).to_rust(Scalar::F64, None);
            if name == "swung_ball" {
                // In firmware `MovingPayload` stands before the pipeline.
                let error = exported.unwrap_err().to_string();
                assert!(error.contains("the section [inertial_unit] has no type"), "{error}");
            } else {
                holds(name, &exported.unwrap());
            }
        }
    }
    for name in ["nano17_soft_finger", "paper_sphere", "rubber_tip", "tracked_ball"] {
        holds(&format!("{name}_f32"), &example(name).to_rust(Scalar::F32, None).unwrap());
    }
}

#[test]
fn modules_with_a_calibration_are_what_is_exported_today() {
    let skinned = Scene::from_text(SKINNED).unwrap();
    holds(
        "carries",
        &Scene::from_text(crate::export_before::CARRIES).unwrap().to_rust(Scalar::F64, None).unwrap(),
    );
    holds("skinned", &skinned.to_rust(Scalar::F64, None).unwrap());
    holds("skinned_six_gauges", &skinned.to_rust(Scalar::F64, Some(&calibration(6))).unwrap());
    let plane = example("plane");
    holds("plane_eight_gauges_f32", &plane.to_rust(Scalar::F32, Some(&calibration(8))).unwrap());
    holds("plane_curved_f32", &plane.to_rust(Scalar::F32, Some(&curved(8))).unwrap());
    holds("skinned_curved", &skinned.to_rust(Scalar::F64, Some(&curved(6))).unwrap());
}

/// Every choice, by a module of its own in one file.
#[test]
fn every_choice_is_exported() {
    let mut text = "//! Every choice of the registry, exported.\n".to_owned();
    for entry in entries() {
        let scene = Scene::from_text(&scene_with(entry)).unwrap();
        let module = scene.to_rust(Scalar::F64, None).unwrap_or_else(|error| panic!("{entry:?}: {error}"));
        assert!(scene.to_rust(Scalar::F32, None).is_ok(), "{entry:?}");
        let module: String = module
            .lines()
            .map(|line| format!("{}{line}\n", if line.is_empty() { "" } else { "    " }))
            .collect();
        text.push_str(&format!("\npub mod {} {{\n{module}}}\n", module_of(entry.section, entry.name)));
    }
    holds("choices", &text);
}

fn module_of(section: &str, name: &str) -> String {
    format!("{}_{name}", section.replace('.', "_"))
}

/// The same wrenches through both, which must say the same, bit for bit.
fn agree<T, S, M, F, D>(
    what: &str,
    mut tip: Fingertip<Absent, S, M, F, D, Uncompensated, Absent>,
    mut pipeline: Pipeline<T>,
    count: usize,
) where
    T: Real,
    S: ActiveSurface<T>,
    M: ContactModel<T, S>,
    F: GripStage<T>,
    D: SlipStage<T>,
{
    let step = T::literal(1e-3);
    let (mut last, mut touched) = (None, 0);
    let pushes = pushes_on(pipeline.surface(), count);
    for push in pushes {
        let felt = pipeline.sense(push, step);
        let touch = tip.sense_wrench(push, Step::of(step).with_last(last));
        last = touch.point();
        touched += usize::from(last.is_some());
        // As texts, which tell a zero from a negative one.
        assert_eq!(format!("{:?}", felt.touch.resolution), format!("{:?}", touch.resolution), "{what}");
        assert_eq!(felt.touch.force, touch.force, "{what}");
        assert_eq!(felt.margin(), touch.grip.as_ref().and_then(F::margin), "{what}");
        assert_eq!(felt.touch.slip, D::slip(&touch.slip), "{what}");
    }
    assert!(touched * 20 > count, "{what}: {touched} of {count}");
}

macro_rules! each {
    ($count:expr, $scene:expr, $t:ty: $($name:ident),*) => {
        $(agree::<$t, _, _, _, _>(
            stringify!($name),
            exported::$name::tip().unwrap(),
            $scene(stringify!($name)).pipeline_in::<$t>().unwrap(),
            $count,
        );)*
    };
}

#[test]
fn the_examples_give_the_bits_of_the_pipeline() {
    each!(1000, example, f64: auto_capsule, capsule, ellipsoid, gripped_ball, nano17_cylinder, nano17_soft_finger, paper_sphere,
        plane, robot_link, rubber_tip, tracked_ball);
    each!(40, example, f64: formula_pad);
    let skinned = |_| Scene::from_text(SKINNED).unwrap();
    each!(300, skinned, f64: skinned);
    let narrow = |name: &str| example(name.trim_end_matches("_f32"));
    each!(1000, narrow, f32: nano17_soft_finger_f32, paper_sphere_f32, rubber_tip_f32, tracked_ball_f32);
}

#[test]
fn every_choice_gives_the_bits_of_the_pipeline() {
    // Filters are not of the pipeline but stand before it: `export_before` tests them.
    let mut entries = entries().filter(|entry| entry.section != "filter");
    macro_rules! each {
        ($($name:ident),* $(,)?) => {
            $({
                let entry = entries.next().unwrap();
                assert_eq!(module_of(entry.section, entry.name), stringify!($name));
                let pipeline = Scene::from_text(&scene_with(entry)).unwrap().pipeline();
                agree(stringify!($name), exported::choices::$name::tip().unwrap(), pipeline, 40);
            })*
        };
    }
    each!(
        surface_plane,
        surface_disk,
        surface_rectangle,
        surface_sphere,
        surface_ellipsoid,
        surface_cylinder,
        surface_capped_cylinder,
        surface_elliptic_cylinder,
        surface_capsule,
        surface_cone,
        surface_frustum,
        surface_torus,
        surface_superquadric,
        surface_rounded_box,
        surface_paraboloid,
        surface_revolution,
        surface_heightfield,
        surface_mesh,
        surface_formula,
        surface_posed,
        surface_trimmed,
        surface_compound,
        contact_point,
        contact_soft_finger,
        contact_auto,
        contact_skin_linear,
        contact_skin_power,
        contact_skin_hertz,
        contact_skin_local_hertz,
        contact_skin_table,
        friction_coulomb,
        friction_anisotropic,
        friction_soft_finger,
        friction_power,
        friction_load_dependent,
        friction_uncertain,
        slip_drop,
        slip_threshold,
        slip_likelihood_ratio,
        slip_stick_slip,
        slip_adaptive_drop,
    );
    assert!(entries.next().is_none());
}

/// The JSON is a whole scene: read back, it makes the same pipeline.
#[test]
fn json_is_the_scene_that_it_was_made_of() {
    let mut texts: Vec<String> = entries().map(scene_with).collect();
    texts.push(SKINNED.to_owned());
    for text in texts {
        let scene = Scene::from_text(&text).unwrap();
        let json: serde_json::Value = serde_json::from_str(&scene.to_json().unwrap()).unwrap();
        assert_eq!(json["version"], 2);
        assert!(json["contact"]["model"].is_string() && json["pose"]["translation_m"].is_array(), "{json}");
        let again = toml::to_string(&json).unwrap().replace("\"inf\"", "inf");
        let again = Scene::from_text(&again).unwrap_or_else(|problem| panic!("{problem}\n{again}"));
        assert_eq!(again.pipeline(), scene.pipeline(), "{text}");
        assert_eq!(again.to_json().unwrap(), scene.to_json().unwrap());
    }
}

/// A file that says no name is called as whoever reads it says, and the JSON, which has no file, keeps that.
#[test]
fn json_says_what_the_scene_is_called() {
    let plane = "[surface]\nshape = \"plane\"\n";
    for (text, name) in
        [(format!("{HEAD}{plane}"), "by its file"), (format!("name = \"its own\"\n{HEAD}{plane}"), "its own")]
    {
        let scene = Scene::parse(&text, "by its file", Path::new("")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&scene.to_json().unwrap()).unwrap();
        assert_eq!((scene.name(), &json["name"]), (name, &serde_json::Value::from(name)));
    }
}

/// Keys that no example has.
#[test]
fn rare_keys_come_along() {
    let text = format!(
        "{HEAD}[surface]\nshape = \"plane\"\n[contact]\ngreatest_gap_m = 0.001\n[friction]\nlimit = \"uncertain\"\n\
         static_coefficient = 0.5\ndeviation = 0.0\n"
    );
    let module = Scene::from_text(&text).unwrap().to_rust(Scalar::F64, None).unwrap();
    for part in [
        "contact::PointContact::new(0.0)?.with_greatest_gap(0.001)?;",
        "friction::UncertainCoulomb::new(0.5, 0.0, None)?",
    ] {
        assert!(module.contains(part), "{part}\n{module}");
    }
}

#[test]
fn a_mesh_comes_out_of_its_file() {
    let folder = env::temp_dir().join(format!("fingertip-export-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let corner = |at: [f64; 3]| format!("vertex {} {} {}\n", at[0], at[1], at[2]);
    let [a, b, c, d] = [[10.1, 0.0, 0.0], [-10.0, 10.3, 0.0], [-10.0, -10.7, 0.1], [0.0, 0.3, 10.0]];
    let facets = [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
    let facets = facets.map(|facet| {
        format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", facet.map(corner).concat())
    });
    fs::write(folder.join("tip.stl"), format!("solid tip\n{}endsolid tip\n", facets.concat())).unwrap();
    let text = format!("{HEAD}[surface]\nshape = \"mesh\"\nfile = \"tip.stl\"\nmetres_per_unit = 0.001\n");
    let scene = Scene::parse(&text, "mesh", &folder).unwrap();
    let inline: serde_json::Value = serde_json::from_str(&scene.to_json().unwrap()).unwrap();
    assert_eq!(inline["surface"]["vertices_m"].as_array().unwrap().len(), 4);
    let again = Scene::from_text(&toml::to_string(&inline).unwrap()).unwrap();
    assert_eq!(again.pipeline(), scene.pipeline());
    let module = scene.to_rust(Scalar::F32, None).unwrap();
    assert!(
        module.contains("static VERTICES_M_0: [Vector3<f32>; 4]") && module.contains("a heap"),
        "{module}"
    );
    fs::remove_dir_all(&folder).unwrap();
    assert!(matches!(scene.to_rust(Scalar::F64, None), Err(ExportError::Scene(_))));
}

#[test]
fn what_cannot_be_exported_is_said() {
    let scene = example("paper_sphere");
    let error = |file: &CalibrationFile| scene.to_rust(Scalar::F32, Some(file)).unwrap_err().to_string();
    let mut file = calibration(8);
    file.matrix[(2, 3)] = 1e200;
    assert!(error(&file).contains("matrix[2][3]"), "{}", error(&file));
    file = calibration(5);
    assert!(error(&file).contains("5 gauges"), "{}", error(&file));
    let large =
        Scene::from_text(&format!("{HEAD}[surface]\nshape = \"sphere\"\nradius_m = 1e100\n")).unwrap();
    assert!(large.to_rust(Scalar::F64, None).is_ok());
    assert!(matches!(large.to_rust(Scalar::F32, None), Err(ExportError::Scene(_))));
}

/// Written to be read: an entry a line, lists of numbers in one; and complete, within other shapes, too.
#[test]
fn json_is_laid_out_and_complete() {
    let text = format!(
        "{HEAD}[surface]\nshape = \"posed\"\nsurface = {{ shape = \"capsule\", radius_m = 0.008, half_length_m = 0.01 }}\n\
         [contact.skin]\nlaw = \"table\"\nforce_depth_patch_N_m_m = [[0.5, 0.0002, 0.001], [2.0, 0.0005, 0.002]]\n"
    );
    let json = Scene::from_text(&text).unwrap().to_json().unwrap();
    for part in [
        "{\n  \"contact\": {\n    \"greatest_gap_m\": 0.0,\n",
        "\n      \"force_depth_patch_N_m_m\": [\n        [0.5, 0.0002, 0.001],\n        [2.0, 0.0005, 0.002]\n      ]",
        "\n  \"pose\": {\n    \"rotation_deg\": [0.0, 0.0, 0.0],\n    \"translation_m\": [0.0, 0.0, 0.0]\n  },\n",
        "\"centre_m\": [0.0, 0.0, 0.0]",
    ] {
        assert!(json.contains(part), "{part}\n{json}");
    }
}
