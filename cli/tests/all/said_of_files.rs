//! What is said of recordings and their sensors, as somebody has looked at it.

use core::f64::consts::TAU;
use core::fmt::Write as _;

use fingertip_recordings::mcap::Compression;
use nalgebra::Rotation3;

use crate::calibrate::{loads, payload};
use crate::common::{Folder, assert_accepted, body};
use crate::health::{calibration, gauges, normal};
use crate::recordings::two_wrists;
use crate::said::{noisy, noisy_loads};

/// What is said of what may be wrong, and what is complained of.
fn all_said(folder: &Folder, command: &[&str]) -> String {
    let output = folder.run(command);
    [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat()
}

/// Rows that are good, and, behind the first hundred, some of every fault.
fn with_faults(ragged: bool) -> String {
    let mut text = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,S1_Fx_N,v1_V,mood\n".to_owned();
    for k in 0..160_u32 {
        let time = f64::from(k) * 2e-3 + if k > 120 { 0.5 } else { 0.0 };
        let row = format!("{time:.3},{},0,-2,0,0,0,1,0.5,x", f64::from(k) * 0.01);
        match k {
            100..=112 => writeln!(text, "{time:.3},1,2,,4,5,6,1,0.5,x"),
            113 if ragged => writeln!(text, "{row},one more"),
            114 => writeln!(text, "{time:.3},NaN,0,-2,0,0,0,1,0.5,x"),
            115 => writeln!(text, "0.001,1,0,-2,0,0,0,1,0.5,x"),
            116 | 117 => writeln!(text, "0.230,1,0,-2,0,0,0,1,0.5,x"),
            118 if ragged => writeln!(text, "{time:.3},word,0,-2,0,0,0,1,0.5,x"),
            _ => writeln!(text, "{row}"),
        }
        .unwrap();
    }
    text
}

#[test]
fn of_what_files_hold() {
    let folder = Folder::new();
    folder.write("faults.csv", &with_faults(false));
    folder.write("ragged.csv", &with_faults(true));
    let good: String = with_faults(false).lines().take(90).map(|line| format!("{line}\n")).collect();
    folder.write("good.csv", &good);
    two_wrists(&folder, "two.mcap", 40, Compression::Zstd);
    folder.succeed(&["convert", "good.csv", "good.mcap"]);
    folder.succeed(&["convert", "two.mcap", "one.csv", "--topic", "/left/ft"]);
    folder.succeed(&["convert", "one.csv", "one.mcap"]);
    two_wrists(&folder, "cut.mcap", 2000, Compression::None);
    let whole = std::fs::read(folder.path("cut.mcap")).unwrap();
    std::fs::write(folder.path("cut.mcap"), &whole[..whole.len() / 2]).unwrap();
    for name in ["faults.csv", "ragged.csv", "good.csv", "two.mcap", "good.mcap", "one.mcap", "cut.mcap"] {
        let said = all_said(&folder, &["info", name]);
        assert_accepted(&format!("info_{}.txt", name.replace('.', "_")), &said);
    }
}

/// Sensors with what ails sensors: stuck, dead, at the end of the range, humming, jumping, warming, noisy.
#[test]
fn of_sensors() {
    let folder = Folder::new();
    calibration(&folder);
    folder.write("sound.csv", &gauges(4000, |_, _| {}));
    folder.write(
        "ill.csv",
        &gauges(4000, |time, readings| {
            readings[0] += 4e-3 * (TAU * 50.0 * time).sin();
            readings[1] = 0.25;
            readings[2] = if time > 2.0 { 0.5007 } else { readings[2] };
            readings[3] +=
                if (1.0..1.004).contains(&time) || (3.0..3.004).contains(&time) { 0.4 } else { 0.0 };
            readings[4] += 0.02 * time;
            readings[5] = (readings[5] + if time > 1.5 { 1.0 } else { 0.0 }).min(1.5);
        }),
    );
    let state = core::cell::Cell::new(11);
    folder.write(
        "gappy.csv",
        &gauges(3000, |time, readings| {
            let mut next = state.get();
            readings[5] += 8e-3 * normal(&mut next);
            state.set(next);
            if (0.5..0.6).contains(&(time % 1.0)) {
                readings[3] = f64::NAN;
            }
            // Less than half a step of its converter.
            readings[1] = 0.5 + if (time * 1e3).round() % 97.0 < 1.0 { 1e-4 } else { 0.0 };
        })
        .lines()
        .enumerate()
        .filter(|(line, _)| line % 700 < 600)
        .map(|(_, line)| format!("{line}\n"))
        .collect::<String>(),
    );
    for name in ["sound", "ill", "gappy"] {
        let file = format!("{name}.csv");
        let page = format!("{name}.html");
        assert_accepted(
            &format!("health_{name}.txt"),
            &all_said(&folder, &["health", &file, "--html", &page]),
        );
        let with = ["health", &file, "--calibration", "tip.toml", "--celsius", "24"];
        assert_accepted(&format!("health_{name}_loads.txt"), &all_said(&folder, &with));
        // The words and figures of the page; its curves follow the noise of sines and logarithms.
        let page = body(&folder.read(&page));
        let page: String =
            page.lines().filter(|line| !line.starts_with("<path")).map(|line| format!("{line}\n")).collect();
        assert_accepted(&format!("health_{name}.html"), &page);
        assert_accepted(
            &format!("tare_{name}.txt"),
            &all_said(&folder, &["tare", "tip.toml", &file, "-o", "x.toml"]),
        );
    }
}

#[test]
fn of_a_check_by_groups_and_under_a_payload() {
    let folder = Folder::new();
    folder.write("loads.csv", &noisy_loads());
    folder.succeed(&["calibrate", "loads.csv", "-o", "cal.toml", "--full-scale", "10,10,10,0.1,0.1,0.1"]);
    // Three groups, each with a zero of its own, and how the sensor lay.
    let table = noisy(&loads(1.0), &["v"], 4e-3);
    let mut lines = table.lines();
    let header = lines.next().unwrap();
    let mut grouped = format!("{header},group,qx,qy,qz,qw\n");
    for (i, line) in lines.enumerate() {
        let group = i % 3;
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        for cell in cells.iter_mut().skip(7).take(6) {
            *cell = format!("{:.6}", cell.parse::<f64>().unwrap() + 0.05 * group as f64);
        }
        let turned = ["0,0,0,1", "0.6,0,0,0.8", "0,0.8,0,0.6"][i / 3 % 3];
        writeln!(grouped, "{},{group},{turned}", cells.join(",")).unwrap();
        if i < 3 {
            let zeros =
                (0..6).map(|gauge| format!("{:.3}", 0.1 + 0.05 * group as f64 + 1e-3 * f64::from(gauge)));
            let zeros: Vec<String> = zeros.collect();
            writeln!(grouped, "{},0,0,0,0,0,0,{},{group},{turned}", 24 + group, zeros.join(",")).unwrap();
        }
    }
    folder.write("grouped.csv", &grouped);
    folder.write("poses.csv", &payload::poses(&Rotation3::identity()));
    folder.succeed(&["calibrate", "--gravity", "poses.csv"]);
    for (name, more) in [
        ("plain", &[][..]),
        ("tared", &["--tare-groups"]),
        ("laden", &["--payload", "payload.toml"]),
        ("tared_laden", &["--tare-groups", "--payload", "payload.toml"]),
        ("warm", &["--celsius", "30"]),
    ] {
        let said = all_said(&folder, &[&["check", "cal.toml", "grouped.csv"][..], more].concat());
        assert_accepted(&format!("check_groups_{name}.txt"), &said);
    }
}
