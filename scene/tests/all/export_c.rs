//! Libraries for C as texts; `.ci/firmware-c` compiles and plays them.

use fingertip_scene::{CLibrary, ExportError, Scalar, Scene};

use crate::export_beside::calibration;
use crate::{BALL, HEAD, NOISE};

fn library(more: &str, scalar: Scalar) -> Result<CLibrary, ExportError> {
    Scene::from_text(&format!("{HEAD}{BALL}{more}")).unwrap().to_c(scalar, None, "thumb")
}

const FRICTION: &str = "[friction]\nstatic_coefficient = 0.6\n";
const GRIP: &str = "[grip]\nleast_N = 0.3\ngreatest_N = 15.0\nrise_N_per_s = 200.0\nfall_N_per_s = 2.0\n";

#[test]
fn the_header_says_what_the_functions_take() {
    let plain = library("", Scalar::F32).unwrap();
    let header = plain.header(93);
    for part in [
        "uint64_t bytes[12];",
        "#define THUMB_INPUTS 6\n",
        "#ifndef THUMB_H\n",
        "uint32_t thumb_init(thumb_state *state);",
        "uint32_t thumb_sense(thumb_state *state, const float input[6], float time_step, thumb_touch *touch);",
        "uint32_t thumb_start_anew(thumb_state *state);",
        "Takes a wrench as the sensor reports it",
    ] {
        assert!(header.contains(part), "{part}: {header}");
    }
    assert!(!header.contains("grip_force") && !header.contains("malloc") && !header.contains("REAL"));
    assert!(
        plain.manifest("path = \"..\"").contains("features = [\"libm\", \"mixed-precision\"]")
            && plain.is_exact()
    );
    let smallest = plain.without_mixed_precision();
    assert!(smallest.manifest("path = \"..\"").contains("features = [\"libm\"]") && !smallest.is_exact());
    assert!(library("", Scalar::F64).unwrap().without_mixed_precision().is_exact());
    let rich = library(&format!("{FRICTION}{GRIP}{NOISE}"), Scalar::F64).unwrap();
    let header = rich.header(8);
    assert!(
        header.contains("double grip_force;") && header.contains("[uncertainty] is not told here"),
        "{header}"
    );
    assert!(rich.has_grip() && rich.untold() == ["uncertainty"] && !rich.takes_gauges());

    let scene = Scene::from_text(&format!("{HEAD}{BALL}")).unwrap();
    // Eight gauges whose zero can be set, and six whose zero drifts with the temperature.
    for (gauges, is_warm) in [(8, false), (6, true)] {
        let mut file = calibration(gauges);
        file.range = Some([-5.0, 5.0]);
        let gauged = scene.to_c(Scalar::F32, Some(&file), "tip").unwrap();
        assert_eq!((gauged.inputs(), gauged.takes_gauges(), gauged.is_warm()), (gauges, true, is_warm));
        let (header, border) = (gauged.header(8), gauged.border());
        assert_eq!(header.contains("float celsius, "), is_warm, "{header}");
        assert_eq!(header.contains(&format!("const float zero[{gauges}]")), !is_warm, "{header}");
        assert_eq!(border.contains("tip.set_zero("), !is_warm, "{border}");
        assert!(border.contains("return INCOMPLETE;"), "{border}");
        assert!(border.contains("*gauge > -5.0 && *gauge < 5.0"), "{border}");
    }
}

#[test]
fn the_border_holds_no_place_that_is_not_filled() {
    for more in ["", FRICTION, &format!("{FRICTION}{GRIP}[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n")] {
        let border = library(more, Scalar::F32).unwrap().border();
        for place in [
            "REAL", "NAME", "MARGIN", "GRIP_", "ZERO_", "CELSIUS_", "CHECK", "RESET", "SLIP,", "INPUTS",
            "MARK",
        ] {
            assert!(!border.contains(place), "{place}: {border}");
        }
        assert_eq!(border.contains("SlipDetector"), more.contains("slip"), "{border}");
        let slip = if more.contains("slip") { "slip: felt.slip as u32," } else { "slip: 0," };
        assert!(border.contains(slip), "{border}");
        assert_eq!(border.contains("state.grip.command"), more.contains("grip"), "{border}");
    }
}

#[test]
fn the_size_of_the_state_is_read_of_the_compiled_library() {
    let compiled = |text: &str| CLibrary::state_bytes(&[b"\x7fELF\0\0", text.as_bytes(), b"   \0"].concat());
    assert_eq!(compiled(&format!("{}1234", CLibrary::MARK)), Some(1234));
    assert_eq!(compiled(CLibrary::MARK), None);
    assert_eq!(compiled("nothing"), None);
    assert_eq!(compiled(&format!("{}{}", CLibrary::MARK, "9".repeat(40))), None);
}

#[test]
fn what_a_library_cannot_hold_is_named() {
    let refused = |more: &str| library(more, Scalar::F32).unwrap_err().to_string();
    let tracking = "[tracking]\nspeed_m_per_s = 0.01\nturns_within_s = 0.1\n";
    assert!(refused(&format!("{NOISE}{tracking}")).starts_with("the section [tracking], of which"));
    let slip = "[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n[estimate]\nnoise_N = 0.01\n";
    assert!(refused(&format!("{FRICTION}{slip}")).starts_with("the section [estimate], of which"));
    assert!(refused("[filter]\nkind = \"low_pass\"\ncutoff_Hz = 50.0\n").contains("[filter]"));
    let scene = Scene::from_text(&format!("{HEAD}{BALL}")).unwrap();
    for name in ["", "2tip", "Tip", "a-b", "tip ", "_tip"] {
        let error = scene.to_c(Scalar::F32, None, name).unwrap_err();
        assert!(matches!(error, ExportError::Name { .. }), "{name}");
    }
}
