//! `fingertip analyze` with a tactile array beside the wrench.

use crate::common::{Contacts, Folder, scene};

const HEADER: &str = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,array1_x_m,array1_y_m,array1_z_m,array1_normal_N,\
                      array2_x_m,array2_y_m,array2_z_m,array2_normal_N\n";

type Triple = [f64; 3];

/// What a wrench sums up of pushes at places.
fn row(time: f64, pushes: &[(Triple, Triple)], read: [&str; 2]) -> String {
    let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
    for ([x, y, z], [fx, fy, fz]) in pushes {
        for (sum, part) in force.iter_mut().zip([fx, fy, fz]) {
            *sum += part;
        }
        for (sum, part) in torque.iter_mut().zip([y * fz - z * fy, z * fx - x * fz, x * fy - y * fx]) {
            *sum += part;
        }
    }
    let numbers: Vec<String> = force.iter().chain(&torque).map(ToString::to_string).collect();
    format!("{time},{},{},{}\n", numbers.join(","), read[0], read[1])
}

#[test]
fn both_sides_of_a_gripped_ball_are_told() {
    const LEFT: Triple = [-0.013, 0.0, 0.0];
    const RIGHT: Triple = [0.013, 0.0, 0.0];
    // The sides pull along y by different amounts, which an array of pressures does not feel.
    let (first, second) = ([3.0, 0.9, 0.0], [-3.2, -0.3, 0.2]);
    let both = [(LEFT, first), (RIGHT, second)];
    let rows = [
        row(0.0, &both, ["-0.013,0.0003,0,3.05", "0.013,0,-0.0002,3.2"]),
        // One place alone, and none.
        row(0.005, &[(RIGHT, second)], ["0,0,0,0", "0.013,0,-0.0002,3.2"]),
        row(0.01, &[], ["0,0,0,0", "0,0,0,0"]),
        // A place that is not the one that is pressed.
        row(0.015, &both, ["0,0,0.013,3.05", "0.013,0,0,3.2"]),
        // Of a row that cannot be used, the cells of the array are empty, too.
        "0.02,,0,0,0,0,0,0,0,0.013,3.05,0.013,0,0,3.2\n".to_owned(),
        // Forces whose squares are no numbers.
        row(0.025, &both, ["-0.013,0,0,1e200", "0.013,0,0,3.2"]),
        row(0.03, &both, ["-0.013,0,0,3.05", "0.013,0,0,1e200"]),
    ];
    let folder = Folder::new();
    folder.write("grip.csv", &format!("{HEADER}{}", rows.concat()));
    let said =
        folder.succeed(&["analyze", "grip.csv", "--scene", &scene("gripped_ball.toml"), "--no-report"]);
    assert!(
        said.contains("wrench and array could not be fused in 2 rows, in the first of them since: "),
        "{said}"
    );
    assert!(said.contains("the reading of an array contact must be finite"), "{said}");
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    let near = |name: &str, row: usize, expected: f64, within: f64| {
        let found = contacts.numbers(name)[row];
        assert!((found - expected).abs() < within, "{name} of row {row}: {found} for {expected}");
    };
    for (axis, k) in [("x", 0), ("y", 1), ("z", 2)] {
        near(&format!("fused1_f{axis}_N"), 0, first[k], 0.12);
        near(&format!("fused2_f{axis}_N"), 0, second[k], 0.12);
        near(&format!("fused2_f{axis}_N"), 1, second[k], 0.03);
        near(&format!("fused1_{axis}_m"), 0, LEFT[k], 5e-4);
        near(&format!("fused2_{axis}_m"), 1, RIGHT[k], 2e-4);
    }
    // One contact is known from the wrench nearly alone; of two, forces that cancel are not.
    near("fused2_share_from_wrench", 1, 1.0, 0.1);
    let deviations = contacts.numbers("fused2_deviation_N");
    assert!(deviations[0] > 3.0 * deviations[1] && deviations[1] > 0.005, "{deviations:?}");
    // χ² with six degrees of freedom, where all is right.
    let disagreement = contacts.numbers("fused_disagreement");
    assert!(disagreement[0] < 20.0 && disagreement[3] > 100.0, "{disagreement:?}");
    assert_eq!(contacts.words("status")[4], "unusable_row");
    for (name, row) in [
        ("fused1_x_m", 1),
        ("fused1_fx_N", 2),
        ("fused2_fx_N", 2),
        ("fused_disagreement", 2),
        ("fused1_x_m", 4),
        ("fused_disagreement", 4),
        ("fused1_x_m", 5),
        ("fused_disagreement", 6),
    ] {
        assert!(contacts.numbers(name)[row].is_nan(), "{name} of row {row}");
    }
}

#[test]
fn columns_that_are_missing_are_named() {
    let folder = Folder::new();
    folder.write("grip.csv", "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,1,0,0,0\n");
    let error = folder.fail(1, &["analyze", "grip.csv", "--scene", &scene("gripped_ball.toml")]);
    assert!(error.contains("has no columns array1_x_m, array1_y_m, array1_z_m, array1_normal_N"), "{error}");
    assert!(error.contains("leave [fusion] out") && !folder.path("contacts.csv").exists(), "{error}");
}
