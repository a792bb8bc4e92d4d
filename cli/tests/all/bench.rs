//! `fingertip bench`, and what `fingertip design` writes of the same: paper that is to scale, figures that are right.

use std::fs;

use fingertip_calibration::design::LayoutFile;
use fingertip_test_support::drawn::{self, Paper};

use crate::common::Folder;

/// A layout of twelve gauges in six bridges, wired by hand: two full bridges and four halves.
const WIRED: &str = r#"
version = 1
gauges = [
    { z_m = 0.0, theta_deg = 0.0, q_deg = 0.0 },    { z_m = 0.0, theta_deg = 180.0, q_deg = 0.0 },
    { z_m = 0.0, theta_deg = 90.0, q_deg = 0.0 },   { z_m = 0.0, theta_deg = 270.0, q_deg = 0.0 },
    { z_m = 0.012, theta_deg = 0.0, q_deg = 0.0 },  { z_m = 0.012, theta_deg = 180.0, q_deg = 0.0 },
    { z_m = 0.012, theta_deg = 90.0, q_deg = 0.0 }, { z_m = 0.012, theta_deg = 270.0, q_deg = 0.0 },
    { z_m = 0.006, theta_deg = 45.0, q_deg = 45.0 },  { z_m = 0.006, theta_deg = 135.0, q_deg = -45.0 },
    { z_m = 0.006, theta_deg = 225.0, q_deg = 45.0 }, { z_m = 0.006, theta_deg = 315.0, q_deg = -45.0 },
    { z_m = 0.006, theta_deg = 0.0, q_deg = 0.0 },   { z_m = 0.006, theta_deg = 180.0, q_deg = 0.0 },
]
bridges = [
    { arm0 = 0, arm1 = 1 }, { arm0 = 2, arm1 = 3 }, { arm0 = 4, arm1 = 5 }, { arm0 = 6, arm1 = 7 },
    { arm0 = 8, arm1 = 9, arm2 = 10, arm3 = 11 }, { arm0 = 12, arm2 = 13 },
]
material = { youngs_modulus_Pa = 71.7e9, poisson_ratio = 0.33, yield_strength_Pa = 503e6 }
tube = { radius_m = 0.008, thickness_m = 0.0002, clamped_at_m = 0.02 }
loads = { force_N = [30.0, 30.0, 30.0], torque_Nm = [0.3, 0.3, 0.3] }
excitation = { supply_V = 5.0, gauge_factor = 2.0, amplifier_gain = 500.0 }
"#;

/// How far the outlines on a sheet of paper are from those of a layout \[mm\], on paper of 0.1 mm: from the line of 0° and the
/// lower edge, by ruler.
fn off(paper: &Paper, template: &Paper, file: &LayoutFile, sizes: [[f64; 2]; 2]) -> f64 {
    let layout = file.layout();
    let outer = layout.beam.radius + 0.5 * layout.beam.thickness;
    let drawn = (outer + 0.05e-3) * 1e3;
    let strip = &template.named("strip").points;
    let (left, long, bottom) = (strip[0][0], strip[1][0] - strip[0][0], strip[2][1]);
    let zero = template.named("angle-0").points[0][0];
    let mut worst = (long - core::f64::consts::TAU * drawn).abs();
    for gauge in &layout.gauges {
        let x = left + (zero - left + gauge.theta * drawn).rem_euclid(long);
        let y = bottom - (file.loaded_tube().length - gauge.z) * 1e3;
        let (sin, cos) = gauge.q.sin_cos();
        for [along, across] in sizes {
            let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)].map(|(a, b)| {
                let (a, b) = (0.5 * a * along, 0.5 * b * across);
                [x + (a * sin + b * cos) * drawn / (outer * 1e3), y - (a * cos - b * sin)]
            });
            worst = worst.max(paper.nearest(&corners));
        }
    }
    worst
}

/// Measured back from the files that a design leaves, the template agrees with the layout to 0.05 mm.
#[test]
fn the_template_of_a_design_is_to_scale() {
    let folder = Folder::new();
    for (more, sizes) in [
        (&[][..], [[1.5, 1.2], [4.0, 2.5]]),
        (&["--grid-mm", "0.6", "1", "--carrier-mm", "5", "3.2"][..], [[0.6, 1.0], [5.0, 3.2]]),
    ] {
        for layout in ["paper", "rosettes", "free"] {
            let arguments = ["design", "--layout", layout, "--starts", "2", "--radius-mm", "5", "9"];
            let said = folder.succeed(&[&arguments[..], more].concat());
            assert!(said.contains("Written: layout.toml, template.svg, bench.pdf, design.html"), "{said}");
            let file = LayoutFile::from_toml(&folder.read("layout.toml")).unwrap();
            let template = drawn::svg(&folder.read("template.svg"));
            let far = off(&template, &template, &file, sizes);
            assert!(far < 0.05, "{layout}: {far} mm in the SVG");
            let pages = drawn::pdf(&fs::read(folder.path("bench.pdf")).unwrap());
            let far = off(&pages[0], &template, &file, sizes);
            assert!(far < 0.05, "{layout}: {far} mm on the page");
            assert!(
                (pages[0].size[0] - template.size[0]).abs() < 1e-3
                    && (pages[0].size[1] - template.size[1]).abs() < 1e-3
            );
            let scale = &template.named("scale-across").points;
            assert!((scale[1][0] - scale[0][0] - 100.0).abs() < 1e-9 && pages[0].nearest(scale) < 1e-3);
            let headings = [
                "Template of the gauges, 1:1",
                "Where the gauges go",
                "The tube and its gauges",
                "Wiring of the bridges",
                "Converters",
            ];
            assert!(pages.iter().map(|page| page.texts[0].as_str()).eq(headings), "{layout}");
        }
    }
}

/// The row of a table as numbers, behind its name.
fn row(said: &str, table: &str, name: &str) -> Vec<String> {
    let (_, rest) = said.split_once(table).unwrap_or_else(|| panic!("no {table} in {said}"));
    let line = rest.lines().find(|line| line.trim().starts_with(name)).unwrap();
    line.trim()
        .split("  ")
        .map(str::trim)
        .filter(|cell| !cell.is_empty())
        .map(str::to_owned)
        .skip(1)
        .collect()
}

fn numbers(cells: &[String]) -> Vec<f64> {
    cells.iter().filter_map(|cell| cell.parse().ok()).collect()
}

/// The settings and what they give, against what follows from the chip's range and the layout's matrix by hand.
#[test]
fn settings_of_converters_follow_from_the_layout() {
    let folder = Folder::new();
    let said = folder.succeed(&["design", "--starts", "2", "--radius-mm", "5", "7", "--wall-mm", "0.2"]);
    let file = LayoutFile::from_toml(&folder.read("layout.toml")).unwrap();
    let strains = file.layout().normalised(1.0, &file.loads).unwrap();
    let most = strains.row_iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
    // HX711: ±0.5/128 of the supply are 2²³ counts; a quarter bridge of factor 2 gives half its strain.
    let cells = row(&said, "Settings of the converter", "hx711");
    assert_eq!(cells[..5], ["7", "128", "5 supply", "80.0", "80.0"]);
    let per_strain = 0.5 * 8_388_608.0 * 128.0 / 0.5;
    let found = numbers(&cells[5..]);
    assert!((found[0] / (per_strain * 1e-6) - 1.0).abs() < 5e-3, "{cells:?}");
    assert!((found[1] - per_strain * most).abs() <= 1.0, "{cells:?} {most}");
    // 90 nV of the chip, and of 350 ohm within 40 Hz at 300 K.
    let volts = (90e-9_f64.powi(2) + 4.0 * 1.380649e-23 * 300.0 * 350.0 * 40.0).sqrt();
    let noise = volts / 5.0 / 0.5;
    assert!(
        (found[3] / (noise * 1e6) - 1.0).abs() < 5e-3 && (found[2] / (noise * per_strain) - 1.0).abs() < 5e-3,
        "{cells:?}"
    );
    // What that is in the load: by the inverse of the matrix.
    let inverse = strains.clone().try_inverse().unwrap();
    let nominal = file.loads.components();
    for (title, strain) in [("Noise of the load", noise), ("What one count is", per_strain.recip())] {
        let loads = numbers(&row(&said, title, "hx711"));
        for axis in 0..6 {
            let expected = inverse.row(axis).norm() * nominal[axis] * strain * 1e3;
            assert!(
                (loads[axis] / expected - 1.0).abs() < 6e-3,
                "{title}, axis {axis}: {loads:?} {expected}"
            );
        }
    }
    // The strains themselves: of the first channel, and all at once.
    let first = numbers(&row(&said, "Strain at the nominal loads", "1"));
    for axis in 0..6 {
        assert!((first[axis] - strains[(0, axis)] * 1e6).abs() <= 0.05 + 1e-9, "{first:?}");
    }
    assert!((first[6] - strains.row(0).iter().map(|x| x.abs()).sum::<f64>() * 1e6).abs() <= 0.05 + 1e-9);
    // The others: what their references are made of.
    for (name, cells) in [
        ("ads131m", ["1", "64", "1.2 inside", "250", "250"]),
        ("ads1256", ["2", "64", "2.5 supply/2", "1000", "209"]),
        ("nau7802", ["7", "128", "5 supply", "320", "320"]),
    ] {
        assert_eq!(row(&said, "Settings of the converter", name)[..5], cells, "{name}");
    }
    assert!(said.contains("Note: hx711 cannot give 200 samples a second."), "{said}");
    assert!(said.contains("stacked: 1 and 2, 3 and 4, 5 and 6"), "{said}");
    // What is asked for counts: a quiet rate, bridges that are well balanced, another gauge.
    let arguments =
        ["bench", "layout.toml", "--sample-rate", "50", "--imbalance", "0.1", "--gauge-ohm", "1000"];
    let said = folder.succeed(&arguments);
    let cells = row(&said, "Settings of the converter", "ads131m");
    assert_eq!(cells[..5], ["1", "128", "1.2 inside", "250", "250"]);
    let noise = numbers(&row(&said, "Settings of the converter", "hx711")[5..])[3] * 1e-6;
    let volts = (90e-9_f64.powi(2) + 4.0 * 1.380649e-23 * 300.0 * 1000.0 * 40.0).sqrt();
    assert!((noise / (volts / 2.5) - 1.0).abs() < 6e-3, "{noise}");
    assert!(!said.contains("cannot give"), "{said}");
}

/// A layout that was wired by hand: its bridges are drawn as they are, and no dummy is asked for where none is needed.
#[test]
fn bridges_come_from_the_file() {
    let folder = Folder::new();
    folder.write("wired.toml", WIRED);
    let arguments = ["bench", "wired.toml", "--tip-radius-mm", "13", "--template", "t.svg", "--pages", "-"];
    let output = folder.run(&arguments);
    assert!(output.status.success());
    let pages = drawn::pdf(&output.stdout);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("14 gauges on a tube of Ø 16.2 mm, in 6 bridges"), "{said}");
    let wiring = pages.iter().find(|page| page.texts[0] == "Wiring of the bridges").unwrap();
    let count = |word: &str| wiring.texts.iter().filter(|text| *text == word).count();
    // Four halves and the one of opposite arms have two resistors each.
    assert_eq!((count("R"), count("gauge 12"), count("gauge 14"), count("+ supply")), (10, 1, 1, 6));
    assert!(
        wiring.texts.iter().any(|text| text.starts_with("One bridge feels temperature")),
        "{:?}",
        wiring.texts
    );
    assert_eq!(row(&said, "Settings of the converter", "hx711")[0], "7");
    let file = LayoutFile::from_toml(WIRED).unwrap();
    let template = drawn::svg(&folder.read("t.svg"));
    assert!(off(&template, &template, &file, [[1.5, 1.2], [4.0, 2.5]]) < 0.05);
    // Gauges of 12 mm do not fit beside each other.
    let said = folder.succeed(&["bench", "wired.toml", "--carrier-mm", "12.5", "2.5"]);
    let (_, over) = said.split_once("Carriers of gauges lie over each other: ").unwrap();
    assert!(
        over.starts_with("1 and 5, ") && over.contains(" 1 and 13") && !over.contains(" 1 and 2,"),
        "{said}"
    );
    // Without the bridge of opposite arms every bridge compensates itself.
    let steady = WIRED.replace("{ arm0 = 12, arm2 = 13 }", "{ arm0 = 12, arm1 = 8, arm2 = 13, arm3 = 10 }");
    folder.write("steady.toml", &steady);
    let said = folder.succeed(&["bench", "steady.toml"]);
    assert_eq!(row(&said, "Settings of the converter", "hx711")[0], "6");
}

#[test]
fn says_what_cannot_be_built() {
    let folder = Folder::new();
    folder.write("wired.toml", WIRED);
    for (arguments, expected) in [
        (&["--grid-mm", "5", "1"][..], "at most that of its carrier"),
        (&["--carrier-mm", "0", "1"], "size of a gauge's carrier is 0"),
        (&["--gauge-ohm", "0"], "resistance of a gauge is 0"),
        (&["--paper-mm", "inf"], "thickness of the paper is inf"),
        (&["--position-tolerance-mm", "nan"], "placement tolerance of positions"),
    ] {
        let error = folder.fail(1, &[&["bench", "wired.toml"], arguments].concat());
        assert!(error.contains(expected) && error.contains("wired.toml"), "{arguments:?}: {error}");
    }
    let error = folder.fail(1, &["bench", "nowhere.toml"]);
    assert!(error.contains("cannot read layout nowhere.toml"), "{error}");
    let error = folder.fail(1, &["design", "--gauge-ohm", "nan"]);
    assert!(error.contains("resistance of a gauge"), "{error}");
    // A supply that no chip bears, and bridges that are too far out of balance for the least gain.
    folder.write("high.toml", &WIRED.replace("supply_V = 5.0", "supply_V = 9.0"));
    let said = folder.succeed(&["bench", "high.toml"]);
    assert!(said.contains("hx711 does not suit: it needs a supply of 2.6 to 5.5 V, not of 9 V"), "{said}");
    assert_eq!(row(&said, "Settings of the converter", "mcp3564")[2], "3 supply/3");
    let said = folder.succeed(&["bench", "wired.toml", "--imbalance", "200"]);
    assert!(said.contains("hx711 does not suit: a bridge gives up to"), "{said}");
    // Files that are there stay.
    let output = folder.exact_command(&["bench", "wired.toml"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
}
