//! Temperature terms: fitted, applied, and never forgotten.

use crate::common::{Contacts, Folder};

/// Loads at temperatures from 20 to 30 °C: zeros drift by 10 mV/K, gains by 0.2 %/K.
fn warm_loads(column: bool) -> String {
    let plain = super::loads(1.0);
    let mut text = String::new();
    for pass in 0..4_u32 {
        for (i, line) in plain.lines().enumerate() {
            if i == 0 {
                if pass == 0 {
                    text += &format!("{line}{}\n", if column { ",temperature_C" } else { "" });
                }
                continue;
            }
            let celsius = 20.0 + f64::from((i as u32 * 7 + pass * 3) % 11);
            let cells: Vec<&str> = line.split(',').collect();
            let volts: Vec<String> =
                cells[7..].iter().map(|cell| warm(cell.parse().unwrap(), celsius).to_string()).collect();
            text += &format!("{pass}-{},{}", cells[..7].join(","), volts.join(","));
            text += &if column { format!(",{celsius}\n") } else { "\n".to_owned() };
        }
    }
    text
}

/// What a reading with zero 0.1 V at 25 °C becomes.
fn warm(volts: f64, celsius: f64) -> f64 {
    let warmer = celsius - 25.0;
    0.1 + 0.01 * warmer + (volts - 0.1) * (1.0 + 0.002 * warmer)
}

#[test]
fn drift_is_applied_or_the_calibration_refused() {
    let folder = Folder::new();
    folder.write("warm.csv", &warm_loads(true));
    folder.write("unknown.csv", &warm_loads(false));
    let full = ["--full-scale", "10,10,10,0.1,0.1,0.1", "--reference-celsius", "25"];
    folder.succeed(&[&["calibrate", "warm.csv", "-o", "cal.toml", "--rust", "cal.rs"][..], &full].concat());
    assert!(folder.read("cal.toml").contains("range_celsius = [20.0, 30.0]"));
    assert!(folder.read("cal.rs").contains("pub fn temperature_compensation"));
    let error =
        folder.fail(1, &[&["calibrate", "warm.csv", "-o", "c.toml", "--cal", "x.cal"][..], &full].concat());
    assert!(error.contains("temperature"), "{error}");
    folder.succeed(&["check", "cal.toml", "warm.csv"]);
    let error = folder.fail(1, &["check", "cal.toml", "unknown.csv"]);
    assert!(error.contains("unknown.csv") && error.contains("temperature"), "{error}");
    let error = folder.fail(1, &["check", "cal.toml", "warm.csv", "--tare-groups"]);
    assert!(
        error.contains(
            "warm.csv: the calibration drifts with temperature (reference 25 °C): a tare by group would"
        ) && error.contains("check without --tare-groups"),
        "{error}"
    );
    // One temperature for all is not what they had.
    folder.fail(1, &["check", "cal.toml", "unknown.csv", "--celsius", "30", "--limit", "0.5"]);

    // 4 N on the top of a sphere at 30 °C.
    let share: [f64; 6] = [0.0, 0.0, -0.4, 0.0, 0.0, 0.0];
    let volts: Vec<String> =
        (0..6).map(|i| warm(0.1 + 2.0 * share[i] + 0.2 * share[(i + 1) % 6], 30.0).to_string()).collect();
    let header = "t_s,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V";
    folder.write("touch.csv", &format!("{header},temperature_C\n0,{},30\n", volts.join(",")));
    folder.write("bare.csv", &format!("{header}\n0,{}\n", volts.join(",")));
    let scene = "version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.01\n";
    folder.write("scene.toml", scene);
    let analyze = |recording, more: &[&'static str]| {
        let start =
            ["analyze", recording, "--scene", "scene.toml", "--calibration", "cal.toml", "--no-report"];
        [&start[..], more].concat()
    };
    for arguments in [analyze("touch.csv", &[]), analyze("bare.csv", &["--celsius", "30"])] {
        let said = folder.succeed(&arguments);
        assert!(
            said.contains("Note: tare: the zero of the calibration, since the scene gives no rest_s"),
            "{said}"
        );
        let contacts = Contacts::parse(&folder.read("contacts.csv"));
        assert!((contacts.numbers("normal_N")[0] - 4.0).abs() < 0.005, "{:?}", contacts.numbers("normal_N"));
    }
    // A dummy gauge would tell the same as the thermometer.
    folder.write("dummy.csv", &format!("{header},dummy_V\n0,{},0.1\n", volts.join(",")));
    let said = folder.succeed(&analyze("dummy.csv", &["--celsius", "30"]));
    assert!(
        said.contains("the dummy gauge is not used: the temperature terms of the calibration are"),
        "{said}"
    );
    folder.write("plain.csv", &super::loads(1.0));
    folder.succeed(&["calibrate", "plain.csv", "-o", "plain.toml"]);
    let plain =
        ["analyze", "dummy.csv", "--scene", "scene.toml", "--calibration", "plain.toml", "--no-report"];
    let said = folder.succeed(&plain);
    assert!(said.contains("the dummy gauge is not used: that needs a rest, rest_s in the scene"), "{said}");
    let said = folder.succeed(&[&plain[..], &["--celsius", "30"]].concat());
    assert!(said.contains("the temperature is known, but the calibration has no terms for it"), "{said}");
    let error = folder.fail(1, &analyze("bare.csv", &[]));
    assert!(error.contains("temperature_C") && error.contains("--celsius"), "{error}");

    folder.write("rest.csv", "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n.2,.2,.2,.2,.2,.2\n.2,.2,.2,.2,.2,.2\n");
    let error = folder.fail(1, &["tare", "cal.toml", "rest.csv", "-o", "new.toml"]);
    assert!(error.contains("temperature"), "{error}");
    folder.succeed(&["tare", "cal.toml", "rest.csv", "-o", "new.toml", "--celsius", "30"]);
    assert!(folder.read("new.toml").contains("zero = [0.1"), "{}", folder.read("new.toml"));
}

/// Readings at 30 °C are those of 25 °C, drifted.
#[test]
fn touches_are_brought_to_the_reference_before_they_mend() {
    let folder = Folder::new();
    folder.write("warm.csv", &warm_loads(true));
    let full = ["--full-scale", "10,10,10,0.1,0.1,0.1", "--reference-celsius", "25"];
    folder.succeed(&[&["calibrate", "warm.csv", "-o", "cal.toml"][..], &full].concat());
    let touches = |celsius: f64| {
        let mut text = "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V,temperature_C\n".to_owned();
        for k in 0..60 {
            // Pure forces of 4 N at a sphere of 10 mm, all round.
            let at = f64::from(k);
            let force = [(1.1 * at).sin(), (1.7 * at).cos(), (2.3 * at).sin()];
            let normal = [(0.9 * at).cos(), (1.3 * at).sin(), 0.4];
            let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
            let arm = normal.map(|x| 0.01 * x / length);
            let torque: [f64; 3] = core::array::from_fn(|i| {
                arm[(i + 1) % 3] * force[(i + 2) % 3] - arm[(i + 2) % 3] * force[(i + 1) % 3]
            });
            let share: [f64; 6] =
                core::array::from_fn(|i| if i < 3 { 0.4 * force[i] } else { 4.0 * torque[i - 3] / 0.1 });
            let volts: Vec<String> = (0..6)
                .map(|i| format!("{:.9}", warm(0.1 + 2.0 * share[i] + 0.2 * share[(i + 1) % 6], celsius)))
                .collect();
            text += &format!("{},{celsius}\n", volts.join(","));
        }
        text
    };
    // Up to where rounding is said.
    let said = |celsius: f64| {
        folder.write("touches.csv", &touches(celsius));
        let said = folder.succeed(&["refine", "cal.toml", "touches.csv"]);
        said.split(" ambiguity").next().unwrap().to_owned()
    };
    assert_eq!(said(25.0), said(30.0));
}
