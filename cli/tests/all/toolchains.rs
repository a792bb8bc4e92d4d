//! What `fingertip export --c` asks of compilers, linkers and the emulator, and what it makes of their answers: stand-ins
//! write down how they are called. The real ones run in `.ci/firmware-c`, which takes minutes.

#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::process::Output;

use crate::common::{Folder, assert_accepted};

/// The smallest fingertip that begins with volts.
const BALL: &str = include_str!("../../../examples/cortex-m4-c/ball.toml");
const THUMB: &str = "thumbv7em-none-eabihf";

/// Writes down the call, and finds its last argument.
const CALLED: &str = "#!/bin/sh
for last; do :; done
[ \"$last\" = --version ] || echo \"${0##*/} $*\" >>calls.txt
";
/// Compiles to a library that tells the size of its state, 1 234 bytes.
const CARGO: &str =
    "echo \"  RUSTFLAGS=$RUSTFLAGS RUSTC_WRAPPER=$RUSTC_WRAPPER CARGO_BUILD_TARGET=$CARGO_BUILD_TARGET\" \
\"RUSTC_BOOTSTRAP=$RUSTC_BOOTSTRAP\" >>calls.txt
while [ $# -gt 0 ]; do
    case $1 in --target-dir) files=$2 ;; --target) files=$files/$2 ;; esac
    shift
done
/bin/mkdir -p \"$files/release\"
echo 'fingertip: bytes of state: 1234.' >\"$files/release/libtip.a\"
/bin/cp \"$files/release/libtip.a\" \"$files/release/libthumb.a\"
";
/// Knows where its own library is, and all targets.
const RUSTC: &str = "case $2 in sysroot) echo \"$PWD/sysroot\" ;; *) echo thumbv7em-none-eabihf; echo fingertip-none-elf ;; esac
";
/// Sections of a program as `size -A` lists them: 1 000 bytes that are flashed, and others.
const SIZE: &str = "echo 'alone  :'
echo 'section           size   addr'
echo '.text              800      0'
echo '.rodata.str         90    800'
echo '.data               60    900'
echo '.ARM.exidx          50    960'
echo '.bss               444   1000'
echo '.comment            77      0'
echo 'Total             1521'
";

/// A folder with a scene and stand-ins for all tools.
struct Tools(Folder);

impl Tools {
    fn new() -> Self {
        let tools = Self(Folder::new());
        tools.0.write("ball.toml", BALL);
        fs::create_dir_all(tools.0.path("bin")).unwrap();
        fs::create_dir_all(tools.0.path("sysroot/lib/rustlib").join(THUMB).join("lib")).unwrap();
        fs::create_dir_all(tools.0.path("source")).unwrap();
        tools.0.write("source/Cargo.toml", "");
        tools.0.write("source/Cargo.lock", "what was tried\n");
        for (name, does) in [
            ("cargo", CARGO),
            ("rustc", RUSTC),
            ("cc", "echo '#!/bin/sh\necho \"cost 200 183 0 0 0 0\"' >\"$last\"\n/bin/chmod +x \"$last\"\n"),
            ("timeout", "shift\n\"$@\"\n"),
            ("arm-none-eabi-gcc", ""),
            ("arm-none-eabi-ld", ""),
            ("arm-none-eabi-size", SIZE),
            ("qemu-system-arm", "echo 'bits 0 1\ncost 200 183 0 950 1100 640' >&2\n"),
        ] {
            tools.set(name, does);
        }
        tools
    }

    /// What a stand-in does after it wrote down that it was called.
    fn set(&self, name: &str, does: &str) {
        let path = self.0.path("bin").join(name);
        fs::write(&path, format!("{CALLED}{does}")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }

    fn remove(&self, name: &str) {
        fs::remove_file(self.0.path("bin").join(name)).unwrap();
    }

    /// Exports with nothing on the path but the stand-ins.
    fn export(&self, arguments: &[&str]) -> Output {
        let always = [
            "export",
            "ball.toml",
            "--c",
            "-o",
            "out",
            "--build",
            "made",
            "--source",
            "source",
            "--overwrite",
        ];
        let mut command = self.0.exact_command(&[&always, arguments].concat());
        command
            .env("PATH", self.0.path("bin"))
            .env("RUSTFLAGS", "-Copt-level=0")
            .env("RUSTC_WRAPPER", "slow");
        command.env("CARGO_BUILD_TARGET", "other").env_remove("RUSTC_BOOTSTRAP").output().unwrap()
    }

    /// What an export says that succeeds: outputs first, then notes.
    fn succeed(&self, arguments: &[&str]) -> String {
        let output = self.export(arguments);
        let [said, noted] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert!(output.status.success(), "{noted}");
        said + &noted
    }

    /// What an export says that fails and leaves nothing.
    fn fail(&self, arguments: &[&str]) -> String {
        let output = self.export(arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(!self.0.path("out/tip.h").exists() && !self.0.path("out/libtip.a").exists(), "{error}");
        error
    }

    /// The calls since the last time.
    fn calls(&self) -> String {
        let calls = self.0.read("calls.txt");
        fs::remove_file(self.0.path("calls.txt")).unwrap();
        calls
    }
}

/// For this computer, for a microcontroller under another name, and again from what stands there.
#[test]
fn tools_are_called_as_they_were() {
    let tools = Tools::new();
    let mut told = tools.succeed(&[]) + &tools.calls();
    assert_eq!(tools.0.read("out/libtip.a"), "fingertip: bytes of state: 1234.\n");
    assert_eq!(tools.0.read("made/package/Cargo.lock"), "what was tried\n");
    let source = fs::canonicalize(tools.0.path("source")).unwrap();
    assert!(
        tools
            .0
            .read("made/package/Cargo.toml")
            .contains(&format!("path = {:?}", source.display().to_string()))
    );
    let played = tools.0.read("made/firmware/tip.h");
    assert_eq!(played, tools.0.read("out/tip.h"), "a library of the usual name is played by its own header");
    assert!(played.contains("tip_state") && tools.0.read("made/package/lib.rs").contains("tip_sense"));
    assert!(tools.0.read("out/tip.md").contains("for this computer"));

    told += &tools.succeed(&["--target", THUMB, "--name", "thumb"]);
    told += &tools.calls();
    assert!(told.contains(&tools.0.read("out/thumb.md")));
    let played = tools.0.read("made/firmware/tip.h");
    for alias in [
        "#define tip_init thumb_init\n",
        "#define tip_sense thumb_sense\n",
        "#define tip_state thumb_state\n",
    ] {
        assert!(played.contains(alias), "{played}");
    }
    assert!(played.contains("TIP_") && !played.contains("THUMB_"), "programs of the session know one name");
    assert_accepted("export_calls.txt", &told);
}

/// In single precision alone a library is compared by a tolerance, and the package leaves the refinement out.
#[test]
fn single_precision_alone_is_near_the_scene() {
    let tools = Tools::new();
    let answers = |said: &str| {
        format!("echo '#!/bin/sh\necho \"cost 200 183 {said}\"' >\"$last\"\n/bin/chmod +x \"$last\"\n")
    };
    tools.set("cc", &answers("0 0 0 0\nnear 170 2500 36"));
    let said = tools.succeed(&["--single-only"]);
    let how = "are the scene's, points to 0.01 mm and normals to 0.001: 170 of them bit for bit, points within 2500 nm, \
               normals within 36e-6.";
    assert!(said.contains(how), "{said}");
    assert!(!tools.0.read("made/package/Cargo.toml").contains("mixed-precision"));
    let session = tools.0.read("made/firmware/session.h");
    for part in [
        "#define TIP_NEAR 1e-5f\n",
        "tip_expected_point[TIP_SAMPLES][3]",
        "tip_expected_resolution[TIP_SAMPLES]",
    ] {
        assert!(session.contains(part), "{part}: {session}");
    }
    let tools = Tools::new();
    tools.set("cc", &answers("3 0 0 0\nnear 170 250000 36"));
    let error = tools.fail(&["--single-only"]);
    assert!(error.contains("3 of 200 answers are not the scene's, points to 0.01 mm"), "{error}");
    let error = Tools::new().fail(&["--single-only", "--scalar", "f64"]);
    assert!(error.contains("--single-only is for single precision"), "{error}");
}

/// A compiler that has the sources of the standard library compiles these, too; what nothing plays is said.
#[test]
fn a_target_without_a_library_is_compiled_from_sources() {
    let tools = Tools::new();
    let error = tools.fail(&["--target", "fingertip-none-elf"]);
    assert!(error.contains("no compiler here has the target fingertip-none-elf"), "{error}");
    fs::create_dir_all(tools.0.path("sysroot/lib/rustlib/src/rust/library/core")).unwrap();
    let error = tools.fail(&["--target", "unknown-none-elf"]);
    assert!(error.contains("no compiler here has the target unknown-none-elf"), "{error}");
    drop(tools.calls());
    let said = tools.succeed(&["--target", "fingertip-none-elf"]);
    assert!(said.contains("what it costs was not measured: nothing here plays fingertip-none-elf"), "{said}");
    let calls = tools.calls();
    assert!(calls.contains("--target fingertip-none-elf -Zbuild-std=core,alloc\n"), "{calls}");
    assert!(calls.contains("RUSTC_BOOTSTRAP=1\n"), "{calls}");
    assert!(tools.0.path("out/libtip.a").exists() && !tools.0.path("out/tip.md").exists());
}

/// The library is there, what it costs is not.
#[test]
fn tools_that_play_and_are_missing_are_named() {
    let tools = Tools::new();
    tools.remove("qemu-system-arm");
    tools.remove("arm-none-eabi-size");
    let said = tools.succeed(&["--target", THUMB]);
    assert!(said.contains("not measured: arm-none-eabi-size, qemu-system-arm cannot be run"), "{said}");
    assert!(tools.0.path("out/libtip.a").exists() && !tools.0.path("out/tip.md").exists());
    tools.remove("cc");
    let said = tools.succeed(&[]);
    assert!(said.contains("not measured: cc cannot be run"), "{said}");
}

/// A tool that fails is named with what it said, and no file is left.
#[test]
fn what_fails_leaves_no_library() {
    let refused = |name: &str, does: &str, arguments: &[&str], says: &str| {
        let tools = Tools::new();
        tools.set(name, does);
        let error = tools.fail(arguments);
        assert!(error.contains(says), "{name}: {error}");
    };
    refused("cargo", "echo no >&2; exit 3", &[], "cargo failed:\nno");
    refused("cargo", "exit 0", &[], "libtip.a");
    refused("cc", "echo what is that; exit 1", &[], "cc failed:\nwhat is that");
    let cost =
        |said: &str| format!("echo '#!/bin/sh\necho \"{said}\"' >\"$last\"\n/bin/chmod +x \"$last\"\n");
    refused("cc", &cost("cost 200 183 2 0 0 0"), &[], "2 of 200 answers are not the scene's, bit for bit");
    refused("cc", &cost("hardly"), &[], "the session failed:\nhardly");
    refused("cc", &cost("cost 200 183"), &[], "the session failed:\ncost 200 183");
    for name in ["arm-none-eabi-gcc", "arm-none-eabi-ld", "arm-none-eabi-size", "qemu-system-arm"] {
        refused(name, "[ \"$last\" = --version ] || exit 1", &["--target", THUMB], "failed");
    }
    let silent = CARGO.replace("of state", "of nothing");
    refused("cargo", &silent, &[], "does not tell the size of its state");
    let tools = Tools::new();
    tools.remove("cargo");
    assert!(tools.fail(&[]).contains("--c needs cargo and rustc"));
    let tools = Tools::new();
    fs::remove_dir_all(tools.0.path("source")).unwrap();
    assert!(tools.fail(&[]).contains("fingertip's source source"));
    let tools = Tools::new();
    tools.0.write("made", "in the way");
    assert!(tools.fail(&[]).contains("folder made/package"));
}
