//! Files appear whole or not at all, and never in the place of another that is wanted.

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::common::{Folder, scene};

const HEADER: &str = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";

fn recording(rows: usize) -> String {
    let rows: String = (0..rows).map(|row| format!("{row}e-3,-2,0,0,0,0,0\n")).collect();
    format!("{HEADER}{rows}")
}

/// The names in a folder, in order.
fn names(folder: &Folder) -> Vec<String> {
    let all = fs::read_dir(folder.path("")).unwrap();
    let mut all: Vec<String> = all.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    all.sort();
    all
}

/// `analyze` of what comes through a pipe, so many rows of which have come: it waits for more.
#[cfg(unix)]
fn waiting(folder: &Folder, more: &[&str]) -> Child {
    let made = Command::new("mkfifo").arg(folder.path("pipe")).status().unwrap();
    assert!(made.success());
    let sphere = scene("paper_sphere.toml");
    let text = fs::read_to_string(sphere).unwrap().replace("rest_s", "# rest_s");
    folder.write("scene.toml", &text);
    let arguments = ["analyze", "pipe", "--scene", "scene.toml", "--no-report"];
    let child = folder.command(&[&arguments, more].concat()).stderr(Stdio::null()).spawn().unwrap();
    let mut pipe = fs::OpenOptions::new().write(true).open(folder.path("pipe")).unwrap();
    pipe.write_all(recording(5000).as_bytes()).unwrap();
    let output = more.iter().skip_while(|word| **word != "--output").nth(1).unwrap_or(&"contacts.csv");
    while !folder.has_begun(output) {
        std::thread::sleep(core::time::Duration::from_millis(5));
    }
    // The writing end stays open as long as the child lives.
    core::mem::forget(pipe);
    child
}

#[cfg(unix)]
fn signal(child: &mut Child, signal: &str) -> Option<i32> {
    Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    child.wait().unwrap().code()
}

#[cfg(unix)]
#[test]
fn an_interruption_leaves_nothing() {
    let folder = Folder::new();
    let mut child = waiting(&folder, &[]);
    assert_eq!(signal(&mut child, "-INT"), Some(130));
    assert_eq!(names(&folder), ["pipe", "scene.toml"]);
}

#[cfg(unix)]
#[test]
fn an_end_without_warning_leaves_the_file_that_was_there() {
    let folder = Folder::new();
    folder.write("contacts.csv", "of yesterday\n");
    let mut child = waiting(&folder, &["--overwrite"]);
    assert_eq!(signal(&mut child, "-KILL"), None);
    assert_eq!(folder.read("contacts.csv"), "of yesterday\n");
    let left = names(&folder);
    let [whole, half, ..] = left.as_slice() else { panic!("{left:?}") };
    assert!(whole == "contacts.csv" && half.starts_with("contacts.unfinished-"), "{left:?}");
}

#[test]
fn what_fails_leaves_the_file_that_was_there() {
    let folder = Folder::new();
    folder.write("contacts.csv", "of yesterday\n");
    folder.write("bad.csv", &format!("{}x,1,2\n", recording(9)));
    let sphere = scene("paper_sphere.toml");
    folder.fail(1, &["analyze", "bad.csv", "--scene", &sphere, "--no-report", "--overwrite"]);
    assert_eq!(folder.read("contacts.csv"), "of yesterday\n");
    assert_eq!(names(&folder), ["bad.csv", "contacts.csv"]);
}

/// Every command that writes files refuses to write over one, and leaves it.
#[test]
fn every_command_asks_before_it_writes_over_a_file() {
    let folder = Folder::new();
    folder.write("loads.csv", "fx_N,v1_V\n0,0\n1,1\n2,2.01\n3,2.99\n4,4\n");
    folder.succeed(&["calibrate", "loads.csv", "-o", "tip.toml"]);
    folder.write("rest.csv", "v1_V\n0.1\n0.1\n");
    folder.write("a.csv", &recording(9));
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let layout = workspace.join("calibration/fuzz/seeds/layout_file/three_pairs.toml").display().to_string();
    let (sphere, mine) = (scene("paper_sphere.toml"), "mine\n");
    let names =
        ["mine.toml", "mine.html", "mine.csv", "mine.mcap", "mine.rs", "mine.json", "mine.svg", "mine.pdf"];
    let in_folders = ["c/tip.h", "man/fingertip-scene-check.1"];
    for name in ["c", "man"] {
        fs::create_dir(folder.path(name)).unwrap();
    }
    for name in names.into_iter().chain(in_folders) {
        folder.write(name, mine);
    }
    let all = [
        &["analyze", "a.csv", "--scene", &sphere, "--output", "mine.csv"][..],
        &["analyze", "a.csv", "--scene", &sphere, "--report", "mine.html"],
        &["bench", &layout, "--template", "mine.svg"],
        &["bench", &layout, "--pages", "mine.pdf"],
        &["calibrate", "loads.csv", "-o", "mine.toml"],
        &["calibrate", "loads.csv", "-o", "new.toml", "--html", "mine.html"],
        &["calibrate", "loads.csv", "-o", "new.toml", "--stream", "--rust", "mine.rs"],
        &["calibrate", "--gravity", "a.csv", "-o", "mine.toml"],
        &["calibrate", "--inertial", "a.csv", "-o", "mine.toml"],
        &["check", "tip.toml", "loads.csv", "--json", "mine.json"],
        &["convert", "a.csv", "mine.mcap"],
        &["demo", "--out", "mine.html"],
        &["demo", "--hand", "--out", "mine.html"],
        &["demo", "--out", "new.html", "--recording", "mine.csv"],
        &["design", "--force", "9", "--out", "mine.toml"],
        &["export", &sphere, "--rust", "mine.rs"],
        &["export", &sphere, "--json", "mine.json"],
        &["export", &sphere, "--c", "--output", "c"],
        &["geometry", "sphere", "a.csv", "-o", "mine.toml"],
        &["health", "a.csv", "--html", "mine.html"],
        &["import", "tip.toml", "-o", "mine.toml"],
        &["man", "man"],
        &["motion", "rest.csv", "--force", "1", "--align", "loads.csv", "-o", "mine.toml"],
        &["object", "a.csv", "--scene", &sphere, "-o", "mine.csv"],
        &["record", "sim", "-o", "mine.csv"],
        &["recover", "a.csv", "mine.csv"],
        &["refine", "tip.toml", "rest.csv", "-o", "mine.toml"],
        &["scene", "init", "mine.toml"],
        &["scene", "show", &sphere, "-o", "mine.html"],
        &["tare", "tip.toml", "rest.csv", "-o", "mine.toml"],
    ];
    for arguments in all {
        let output = folder.exact_command(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(
            error.contains("it exists already; give another name, or --overwrite"),
            "{arguments:?}: {error}"
        );
    }
    for name in names.into_iter().chain(in_folders) {
        assert_eq!(folder.read(name), mine, "{name}");
    }
    assert!(
        !folder.path("new.toml").exists() && !folder.path("new.html").exists(),
        "one of two files was written"
    );
    // Each command that has the option is among them.
    let has_option = |command: &&str| {
        let help = folder.succeed(&[command, "--help"]);
        help.contains("--overwrite") || *command == "scene"
    };
    let help = folder.succeed(&["--help"]);
    let (_, list) = help.split_once("Commands:").unwrap();
    let list = list.split_once("Options:").unwrap().0;
    let commands = list.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let commands: Vec<&str> =
        commands.filter(|name| !name.is_empty() && *name != "help").filter(has_option).collect();
    let tried = |command: &&str| all.iter().any(|arguments| arguments[0] == *command);
    assert!(commands.len() >= 19 && commands.iter().all(tried), "{commands:?}");
    folder.succeed(&["tare", "tip.toml", "rest.csv", "-o", "tip.toml", "--overwrite"]);
    folder.succeed(&["scene", "init", "mine.toml", "--overwrite"]);
}

/// A file is the same file by whatever name.
#[test]
fn files_are_compared_by_what_they_are() {
    let folder = Folder::new();
    let text = recording(9);
    folder.write("a.csv", &text);
    fs::hard_link(folder.path("a.csv"), folder.path("b.csv")).unwrap();
    let sphere = scene("paper_sphere.toml");
    let analyze = ["analyze", "a.csv", "--scene", &sphere, "--overwrite"];
    let error = folder.fail(1, &[&analyze[..], &["--no-report", "--output", "b.csv"]].concat());
    assert!(error.contains("b.csv is also an input of this run"), "{error}");
    assert_eq!((folder.read("a.csv"), folder.read("b.csv")), (text.clone(), text));
    let error = folder.fail(1, &[&analyze[..], &["--output", "x", "--report", "./x"]].concat());
    assert!(error.contains("x and ./x are the same file"), "{error}");
    folder.write("loads.csv", "fx_N,v1_V\n0,0\n1,1\n2,2.01\n3,2.99\n4,4\n");
    let error = folder.fail(1, &["calibrate", "loads.csv", "-o", "x", "--html", "x"]);
    assert!(error.contains("x and x are the same file; give two outputs two names"), "{error}");
    assert!(!folder.path("x").exists());
}

/// What a link leads to is replaced, not the link; a file keeps who may read it.
#[cfg(unix)]
#[test]
fn links_stay_links_and_rights_stay() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    let folder = Folder::new();
    folder.write("a.csv", &recording(9));
    folder.write("real.mcap", "old");
    fs::set_permissions(folder.path("real.mcap"), fs::Permissions::from_mode(0o640)).unwrap();
    symlink("real.mcap", folder.path("link.mcap")).unwrap();
    folder.succeed(&["convert", "a.csv", "link.mcap", "--overwrite"]);
    assert!(fs::symlink_metadata(folder.path("link.mcap")).unwrap().is_symlink());
    let meta = fs::metadata(folder.path("real.mcap")).unwrap();
    assert!(meta.len() > 100 && meta.permissions().mode() & 0o777 == 0o640, "{meta:?}");
    assert_eq!(names(&folder), ["a.csv", "link.mcap", "real.mcap"]);
}

/// A new file has the rights of any other, and is begun where it will be, which may be another disk.
#[cfg(unix)]
#[test]
fn new_files_are_like_others() {
    use std::os::unix::fs::PermissionsExt as _;

    let folder = Folder::new();
    folder.write("a.csv", &recording(9));
    folder.succeed(&["convert", "a.csv", "a.mcap"]);
    let rights = |name: &str| fs::metadata(folder.path(name)).unwrap().permissions().mode();
    assert_eq!(rights("a.mcap"), rights("a.csv"));
    fs::create_dir(folder.path("sub")).unwrap();
    let mut child = waiting(&folder, &["--output", "sub/contacts.csv"]);
    assert!(!folder.has_begun("contacts.csv"));
    signal(&mut child, "-INT");
}

#[test]
fn the_standard_output_holds_one_thing() {
    let folder = Folder::new();
    folder.write("a.csv", &recording(9));
    let sphere = scene("paper_sphere.toml");
    let error = folder.fail(1, &["analyze", "a.csv", "--scene", &sphere, "--output", "-", "--report", "-"]);
    assert!(error.contains("the standard output holds one output"), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_called_one() {
    let folder = Folder::new();
    folder.write("a.csv", &recording(2000));
    let sphere = scene("paper_sphere.toml");
    let error =
        folder.fail(1, &["analyze", "a.csv", "--scene", &sphere, "--no-report", "--output", "/dev/full"]);
    assert!(error.contains("No space left on device") && error.contains("make room"), "{error}");
}

/// So it is of every format, by every command, and what was there stays; the file that is full is named, not the one that is
/// read.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_called_one_by_every_writer() {
    use std::os::unix::fs::symlink;

    let folder = Folder::new();
    folder.write("a.csv", &recording(2000));
    folder.succeed(&["convert", "a.csv", "a.mcap"]);
    folder.write("loads.csv", "fx_N,v1_V\n0,0\n1,1\n2,2.01\n3,2.99\n4,4\n");
    // A device whose name has the ending of a format.
    for name in ["full.csv", "full.mcap", "full.toml", "full.html"] {
        symlink("/dev/full", folder.path(name)).unwrap();
    }
    for (full, arguments) in [
        ("full.mcap", &["convert", "a.csv", "full.mcap"][..]),
        ("full.mcap", &["convert", "a.csv", "full.mcap", "--compression", "zstd"]),
        ("full.csv", &["convert", "a.mcap", "full.csv"]),
        ("full.mcap", &["recover", "a.mcap", "full.mcap"]),
        ("full.mcap", &["recover", "a.mcap", "full.mcap", "--compression", "lz4"]),
        ("full.csv", &["recover", "a.csv", "full.csv"]),
        ("full.mcap", &["record", "sim", "--samples", "500", "-o", "full.mcap"]),
        ("full.csv", &["record", "sim", "--samples", "500", "-o", "full.csv"]),
        ("full.toml", &["calibrate", "loads.csv", "-o", "full.toml"]),
        ("full.html", &["check", "full.toml", "loads.csv", "--html", "full.html"]),
    ] {
        if arguments[0] == "check" {
            fs::remove_file(folder.path("full.toml")).unwrap();
            folder.succeed(&["calibrate", "loads.csv", "-o", "full.toml"]);
        }
        let error = folder.fail(1, arguments);
        assert!(
            error.contains("No space left on device") && error.contains("; make room"),
            "{arguments:?}: {error}"
        );
        assert!(error.contains(full) && !error.contains("a.mcap:"), "{arguments:?}: {error}");
    }
    // A disk that fills up in the middle: files of this process may have 100 kB at most.
    folder.write("big.csv", &recording(100_000));
    folder.write("b.mcap", "of yesterday");
    let run = format!(
        "ulimit -f 100; trap '' XFSZ; exec {} convert big.csv b.mcap --overwrite",
        env!("CARGO_BIN_EXE_fingertip")
    );
    let output = Command::new("bash").args(["-c", &run]).current_dir(folder.path("")).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(
        output.status.code() == Some(1) && error.contains("cannot write recording b.mcap: File too large"),
        "{error}"
    );
    assert_eq!(folder.read("b.mcap"), "of yesterday");
    assert!(names(&folder).iter().all(|name| !name.contains("unfinished")), "{:?}", names(&folder));
}
