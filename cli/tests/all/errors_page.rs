//! The page of the book on errors quotes what the command says: each of its blocks, word for word, is what it says here.

use core::fmt::Write as _;
use std::path::Path;

use crate::common::Folder;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../book/src/how-to/errors.md");
const BALL: &str = "version = 2\n\n[input]\nconvention = \"on_fingertip\"\n\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
const CHECK: [&str; 3] = ["scene", "check", "ball.toml"];
const ANALYZE: [&str; 4] = ["analyze", "touch.csv", "--scene", "ball.toml"];
const SIX: &str = "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm";

/// The last line of the standard error; where that is empty, of the standard output.
fn said(folder: &Folder, arguments: &[&str]) -> String {
    let output = folder.exact_command(arguments).output().unwrap();
    let [error, told] = [output.stderr, output.stdout].map(|bytes| String::from_utf8(bytes).unwrap());
    let last = error.lines().last().or(told.lines().last()).unwrap_or_default().to_owned();
    assert_eq!(
        output.status.code(),
        Some(i32::from(!last.starts_with("warning: "))),
        "{arguments:?}: {error}"
    );
    last
}

fn of_scene(text: &str) -> String {
    let folder = Folder::new();
    folder.write("ball.toml", text);
    said(&folder, &CHECK)
}

fn of_recording(scene: &str, text: &str) -> String {
    let folder = Folder::new();
    folder.write("ball.toml", scene);
    folder.write("touch.csv", text);
    said(&folder, &ANALYZE)
}

/// Two gauges, one along each axis, that read so much for a newton along the first.
fn loads(volts: f64) -> String {
    let mut text = "fx_N,fy_N,v1_V,v2_V\n".to_owned();
    for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (2, 2), (-1, 0)] {
        writeln!(text, "{x},{y},{},{y}", f64::from(x) * volts).unwrap();
    }
    text
}

fn scenes() -> [String; 6] {
    let of = |from: &str, to: &str| of_scene(&BALL.replace(from, to));
    [
        of("radius_m", "radius_mm"),
        of("0.013", "\"13 mm\""),
        of("convention = \"on_fingertip\"\n", ""),
        of("version = 2\n", ""),
        of_scene(&format!("{BALL}[tracking]\nspeed_m_per_s = 0.1\nturns_within_s = 0.1\n")),
        of("0.013", "13.0"),
    ]
}

fn recordings() -> [String; 6] {
    let mut leaning = format!("t_s,{SIX}\n");
    for i in 0..1000 {
        let noise = if i % 2 == 0 { -0.01 } else { 0.01 };
        writeln!(leaning, "{},0,0,{:.3},0,0,0", f64::from(i) * 1e-3, noise - 0.13 * f64::from(i)).unwrap();
    }
    let rest = BALL.replace("[input]", "[input]\nrest_s = 0.5") + "[contact]\nleast_force_N = 0.5\n";
    let two: Vec<String> = ["S1", "S2"]
        .iter()
        .map(|name| SIX.replace('f', &format!("{name}_f")).replace('t', &format!("{name}_t")))
        .collect();
    let push = format!("t_s,{SIX}\n0,0,0,-2,0,0,0\n");
    let twice = Folder::new();
    twice.write("ball.toml", BALL);
    twice.write("touch.csv", &push);
    twice.succeed(&ANALYZE);
    [
        of_recording(BALL, &format!("{SIX}\n0,0,-2,0,0,0\n")),
        of_recording(BALL, "t_s,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n0,1,2,3,4,5,6\n"),
        of_recording(BALL, &push.replace("_Nm", "").replace("_N", "")),
        of_recording(BALL, &format!("t_s,{}\n0,0,0,-2,0,0,0,0,0,-2,0,0,0\n", two.join(","))),
        of_recording(&rest, &leaning),
        said(&twice, &ANALYZE),
    ]
}

fn sensors() -> [String; 6] {
    let folder = Folder::new();
    let mut dead = "t_s,v1_V,v2_V\n".to_owned();
    for i in 0..2000 {
        writeln!(dead, "{},0.25,{:.4}", f64::from(i) * 1e-3, 0.1 * (12.9 * f64::from(i)).sin()).unwrap();
    }
    folder.write("rest.csv", &dead);
    folder.write(
        "bad.csv",
        "fx_N,fy_N,v1_V,v2_V\n0,0,0,0\n1,0,1.1,0\n0,1,0,1.5\n1,1,0.9,0.6\n2,0,2.2,0\n0,2,0.1,1.6\n2,2,1.9,2.7\n",
    );
    folder.write("loads.csv", &loads(1.0));
    folder.succeed(&["calibrate", "loads.csv", "-o", "cal.toml"]);
    folder.write("later.csv", &loads(1.5));
    let edited = Folder::new();
    edited.write("later.csv", &loads(1.0));
    edited.write(
        "cal.toml",
        "version = 1\nchecksum = \"fnv1a64:0000000000000000\"\naxes = [\"fx\", \"fy\"]\n\
         matrix = [[2.0, 0.0], [0.0, 2.0]]\nnominal = [2.0, 2.0]\nsignal_unit = \"V\"\nzero = [0.0, 0.0]\n",
    );
    [
        said(&folder, &["health", "rest.csv"]),
        said(&folder, &["calibrate", "bad.csv", "-o", "bad.toml"]),
        said(&folder, &["check", "cal.toml", "later.csv"]),
        said(&edited, &["check", "cal.toml", "later.csv"]),
        said(&folder, &["record", "ati://127.0.0.1:1?http=1", "-o", "new.csv"]),
        said(&folder, &["record", "bota:///dev/none", "-o", "new.csv"]),
    ]
}

/// With `FINGERTIP_ACCEPT=1` the page is given today's words.
#[test]
fn every_error_on_the_page_is_what_the_command_says() {
    let page = std::fs::read_to_string(Path::new(PAGE)).unwrap();
    let said: Vec<String> = scenes().into_iter().chain(recordings()).chain(sensors()).collect();
    // What stands between the fences of each block, and what stands around them.
    let parts: Vec<&str> = page.split("```").collect();
    let quoted: Vec<&str> = parts.iter().skip(1).step_by(2).copied().collect();
    assert_eq!(quoted.len(), said.len(), "a block of the page has no case here, or a case no block");
    if std::env::var_os("FINGERTIP_ACCEPT").is_some() {
        let mut said = said.iter();
        let fill = |(place, part): (usize, &&str)| match place % 2 {
            0 => (*part).to_owned(),
            _ => format!("```text,said\n{}\n```", said.next().unwrap()),
        };
        let text: String = parts.iter().enumerate().map(fill).collect();
        std::fs::write(PAGE, text).unwrap();
        return;
    }
    for (quoted, said) in quoted.iter().zip(&said) {
        assert_eq!(*quoted, format!("text,said\n{said}\n"));
    }
}
