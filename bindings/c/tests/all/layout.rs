//! Every structure of the header is laid out as here: a C compiler says how it lays them out.

use core::mem::offset_of;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

use fingertip_c::{
    ft_array_reading, ft_ball, ft_beside, ft_error, ft_finger, ft_finger_limits, ft_fused, ft_fused_contact,
    ft_grip, ft_hand_order, ft_hand_settings, ft_margin, ft_motion, ft_object, ft_other, ft_pose, ft_quality,
    ft_reach, ft_reading, ft_touch, ft_touch_columns, ft_uncertain_wrench, ft_wrench, ft_wrench_columns,
};

/// Size and alignment of a structure, and offset and size of each field, by their names.
type Layout = BTreeMap<String, [usize; 2]>;

fn size_behind<V>(_: impl Fn(&V) -> usize) -> usize {
    size_of::<V>()
}

/// Fields that are forgotten do not compile.
macro_rules! layout {
    ($layout:ident: $($of:ident { $($field:ident),* $(,)? })*) => {$(
        $layout.insert(stringify!($of).to_owned(), [size_of::<$of>(), align_of::<$of>()]);
        let _ = |value: $of| {
            let $of { $($field),* } = value;
            $(let _ = $field;)*
        };
        $($layout.insert(
            concat!(stringify!($of), ".", stringify!($field)).to_owned(),
            [offset_of!($of, $field), {
                fn size_of_field<S, V>(_: fn(&S) -> &V) -> usize { size_of::<V>() }
                size_of_field(|value: &$of| &value.$field)
            }],
        );)*
    )*};
}

fn here() -> Layout {
    let mut layout = Layout::new();
    layout! { layout:
        ft_array_reading { centroid, normal_force }
        ft_ball {
            radius_m, centre_m, reaction, soft_finger, least_force_n, static_coefficient, torque_arm_m,
            load_per_signal, gauges,
        }
        ft_beside {
            has_spread, has_tracked, has_touching, touching, has_touch, has_release, has_impact,
            has_slip_probability, has_stick_slip, has_static_friction, has_kinetic_friction, has_grip_force,
            continuity, reserved, ellipse_semi_axes, ellipse_directions, normal_force_deviation,
            spin_torque_deviation, tracked_point, tracked_normal, tracked_velocity, tracked_tangents,
            tracked_position_covariance, tracked_velocity_covariance, tracked_innovation, tracked_surprise,
            touch_age, release_age, impact_peak, impact_impulse, impact_duration, slip_probability, stick_slip_period, static_friction, static_friction_deviation,
            kinetic_friction, kinetic_friction_deviation, grip_force,
        }
        ft_error { status, message }
        ft_finger {
            touching, slip, point, normal, friction, torque_arm, normal_force, tangential_force, spin_torque,
        }
        ft_finger_limits { least_normal_force, greatest_normal_force, cost }
        ft_fused { count, internal_forces, settled, reserved, disagreement, contacts }
        ft_fused_contact {
            point, normal, force, point_covariance, force_covariance, share_from_wrench, grip, reserved,
        }
        ft_grip {
            state, reserved, normal_force, tangential_force, spin_torque, cost, least_cost, velocity, turning,
        }
        ft_hand_order { state, implausible, normal_force, friction, friction_deviation, velocity, turning }
        ft_hand_settings {
            safety, rise, fall, at_slip, least_friction, greatest_ratio, recovery, friction_noise,
            friction_scatter, friction_probability,
        }
        ft_margin { newtons, utilisation }
        ft_motion { gravity, angular_velocity, angular_acceleration }
        ft_object { has_mass, has_centre, mass, mass_deviation, centre, centre_covariance }
        ft_other { is_known, touches, has_line, reserved, load, statistic, point, direction, pitch }
        ft_pose { rotation, origin }
        ft_quality {
            rank, force_closure, certified, found, weakest, freedom_velocity, freedom_turning,
        }
        ft_reach { state, reserved, times }
        ft_reading { gauges, count, dummy, celsius, motion }
        ft_touch {
            resolution, slip, has_margin, alternatives, searched, reserved, wrench, point, normal, normal_force,
            tangential_force, spin_torque, gap, margin, utilisation,
        }
        ft_touch_columns {
            point_x, point_y, point_z, normal_force, tangential_x, tangential_y, tangential_z, margin,
            utilisation, slip,
        }
        ft_uncertain_wrench { wrench, covariance }
        ft_wrench { force, torque }
        ft_wrench_columns { fx, fy, fz, tx, ty, tz }
    }
    layout
}

/// Structures of the header with their fields.
fn structures(header: &str) -> Vec<(String, Vec<String>)> {
    let bodies = header.split("\ntypedef struct ").skip(1).filter_map(|rest| {
        let (name, body) = rest.split_once(" {\n")?;
        let (body, _) = body.split_once("\n}")?;
        (!name.contains(';')).then_some((name, body))
    });
    let field = |line: &str| {
        let line = line.trim();
        let declared = line.strip_suffix(';').filter(|_| !line.starts_with("//"))?;
        let name = declared.split('[').next()?.rsplit([' ', '*']).next()?;
        Some(name.to_owned())
    };
    bodies.map(|(name, body)| (name.to_owned(), body.lines().filter_map(field).collect())).collect()
}

fn in_c(compiler: &str, language: &str, structures: &[(String, Vec<String>)], folder: &Path) -> Layout {
    let mut lines = String::new();
    for (name, fields) in structures {
        lines.push_str(&format!("    printf(\"{name} %zu %zu\\n\", sizeof({name}), ALIGN({name}));\n"));
        for field in fields {
            lines.push_str(&format!(
                "    printf(\"{name}.{field} %zu %zu\\n\", offsetof({name}, {field}), sizeof((({name} *)0)->{field}));\n"
            ));
        }
    }
    let source = folder.join(format!("layout.{language}"));
    let program = folder.join("layout");
    let text = format!(
        "#include <fingertip.h>\n#include <stdio.h>\n#ifdef __cplusplus\n#define ALIGN(t) alignof(t)\n#else\n\
         #define ALIGN(t) _Alignof(t)\n#endif\nint main(void) {{\n{lines}    return 0;\n}}\n"
    );
    fs::write(&source, text).unwrap();
    let include = concat!(env!("CARGO_MANIFEST_DIR"), "/include");
    let built = Command::new(compiler).args(["-I", include, "-o"]).arg(&program).arg(&source).output();
    let built = built.unwrap_or_else(|error| panic!("a C compiler is needed, `{compiler}`: {error}"));
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let said = Command::new(&program).output().unwrap().stdout;
    let entry = |line: &str| {
        let mut words = line.split(' ');
        let name = words.next().unwrap().to_owned();
        (name, [words.next().unwrap().parse().unwrap(), words.next().unwrap().parse().unwrap()])
    };
    String::from_utf8(said).unwrap().lines().map(entry).collect()
}

#[test]
fn structures_are_laid_out_as_in_c() {
    let header = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/include/fingertip.h")).unwrap();
    let structures = structures(&header);
    let folder = tempfile::tempdir().unwrap();
    let compiler = |name: &str, usual: &str| env::var(name).unwrap_or_else(|_| usual.to_owned());
    let expected = here();
    assert!(expected.len() > 100, "{}", expected.len());
    for (compiler, language) in [(compiler("CC", "cc"), "c"), (compiler("CXX", "c++"), "cpp")] {
        let found = in_c(&compiler, language, &structures, folder.path());
        assert_eq!(found, expected, "as {compiler} has it, and as it is here");
    }
}

#[test]
fn enumerations_are_numbers_of_32_bits() {
    let sizes = [
        size_behind(|_: &fingertip_c::ft_status| 0),
        size_behind(|_: &fingertip_c::ft_resolution| 0),
        size_behind(|_: &fingertip_c::ft_slip| 0),
        size_behind(|_: &fingertip_c::ft_hand_state| 0),
        size_behind(|_: &fingertip_c::ft_reach_state| 0),
    ];
    assert_eq!(sizes, [4; 5]);
}
