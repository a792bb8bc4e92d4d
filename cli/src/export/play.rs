//! Plays a session through a library that was compiled: on this computer, or in an emulator, which counts.

use core::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::build::{Build, BuildError, run, write};
use super::session::{NEAR, Session};

/// The programs that play it, which examples/cortex-m4-c explains.
const FILES: [(&str, &str); 5] = [
    ("start.c", include_str!("firmware/start.c")),
    ("board.h", include_str!("firmware/board.h")),
    ("host.c", include_str!("firmware/host.c")),
    ("link.ld", include_str!("firmware/link.ld")),
    ("play.c", include_str!("firmware/play.c")),
];
/// The target that is emulated.
const EMULATED: &str = "thumbv7em-none-eabihf";
/// Functions of the code that a sample of the scene needs, in a file that holds nothing else.
const FLAGS: [&str; 8] = [
    "-std=c11",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-pedantic",
    "-O2",
    "-ffp-contract=off",
    "-ffunction-sections",
];
const CORE: [&str; 5] =
    ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-ffreestanding"];

/// What a session showed.
#[derive(Debug)]
pub(super) struct Played {
    samples: u32,
    contacts: u32,
    /// Of a library in single precision alone: how many answers are the scene's to the last bit, by how many nanometres
    /// points differ at most, and normals by how many millionths.
    near: Option<[u32; 3]>,
    /// Instructions of a sample, median and greatest, and bytes of stack: where they are counted.
    counted: Option<[u32; 3]>,
    /// Bytes of code and constants of a sample, and with the beginning of a fingertip.
    flash: Option<[u64; 2]>,
}

/// Plays; the inner error names the programs that are missing.
pub(super) fn play(
    build: &Build,
    library: &Path,
    header: &str,
    name: &str,
    session: &Session,
) -> Result<Result<Played, String>, BuildError> {
    let needed: &[&str] = match build.target() {
        None => &["cc"],
        Some(EMULATED) => &["arm-none-eabi-gcc", "arm-none-eabi-ld", "arm-none-eabi-size", "qemu-system-arm"],
        Some(other) => return Ok(Err(format!("nothing here plays {other}"))),
    };
    let there = |program: &&&str| Command::new(program).arg("--version").output().is_ok();
    let missing: Vec<&str> = needed.iter().filter(|program| !there(program)).copied().collect();
    if !missing.is_empty() {
        return Ok(Err(format!("{} cannot be run", missing.join(", "))));
    }
    let folder = build.folder("firmware")?;
    for (file, text) in FILES {
        write(&folder.join(file), text)?;
    }
    // The programs call it by its usual name.
    let upper = name.to_uppercase();
    let usual = header.replace(&format!("{upper}_"), "TIP_");
    let alias =
        ["init", "sense", "start_anew"].map(|call| format!("#define tip_{call} {name}_{call}\n")).concat();
    let alias = if name == "tip" { String::new() } else { alias };
    let types = if name == "tip" {
        String::new()
    } else {
        format!("#define tip_state {name}_state\n#define tip_touch {name}_touch\n")
    };
    write(&folder.join("tip.h"), &format!("{usual}{alias}{types}"))?;
    write(&folder.join("session.h"), &session.text)?;
    let program = folder.join("play");
    let said = match build.target() {
        None => {
            let mut command = Command::new("cc");
            command.args(FLAGS).args([folder.join("play.c"), folder.join("host.c")]).arg(library);
            run(command.args(["-Wl,--gc-sections", "-lm", "-o"]).arg(&program))?;
            run(&mut Command::new(&program))?
        }
        Some(_) => emulated(&folder, library, &program)?,
    };
    let weigh = |calls| weighed(&folder, library, name, calls);
    let flash = match build.target() {
        None => None,
        Some(_) => Some([weigh(&["sense"])?, weigh(&["sense", "init"])?]),
    };
    let bad = |said: &str| BuildError::Failed { program: "the session".to_owned(), said: said.to_owned() };
    let cost = said.lines().find_map(|line| line.strip_prefix("cost ")).ok_or_else(|| bad(&said))?;
    let numbers: Vec<u32> = cost.split(' ').filter_map(|word| word.parse().ok()).collect();
    let [samples, contacts, different, median, greatest, stack] = numbers[..] else { return Err(bad(&said)) };
    let near = said.lines().find_map(|line| line.strip_prefix("near ")).and_then(told_near);
    if different > 0 {
        let how = near.map_or_else(|| "bit for bit".to_owned(), |_| tolerance());
        return Err(bad(&format!("{different} of {samples} answers are not the scene's, {how}")));
    }
    Ok(Ok(Played { samples, contacts, near, counted: flash.map(|_| [median, greatest, stack]), flash }))
}

/// Equal answers, nanometres and millionths.
fn told_near(line: &str) -> Option<[u32; 3]> {
    let numbers: Vec<u32> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
    numbers.try_into().ok()
}

/// How near the answers of a library in single precision alone shall be.
fn tolerance() -> String {
    let [point, normal] = NEAR;
    format!("points to {} mm and normals to {normal}", point * 1e3)
}

/// What the firmware says in the emulator, where each instruction takes 1.024 µs.
fn emulated(folder: &Path, library: &Path, program: &PathBuf) -> Result<String, BuildError> {
    let mut command = Command::new("arm-none-eabi-gcc");
    command.args(FLAGS).args(CORE).args([folder.join("play.c"), folder.join("start.c")]).arg(library);
    command.args(["-nostdlib", "-Wl,--gc-sections", "-Wl,-z,noexecstack", "-T"]).arg(folder.join("link.ld"));
    run(command.arg("-o").arg(program))?;
    let mut emulator = Command::new("timeout");
    emulator.args([
        "300",
        "qemu-system-arm",
        "-M",
        "mps2-an386",
        "-nographic",
        "-monitor",
        "none",
        "-serial",
        "none",
    ]);
    emulator.args(["-semihosting-config", "enable=on,target=native", "-icount", "shift=10", "-kernel"]);
    run(emulator.arg(program))
}

/// Bytes of code and constants of a file that holds some of the functions and nothing else.
fn weighed(folder: &Path, library: &Path, name: &str, calls: &[&str]) -> Result<u64, BuildError> {
    let alone = folder.join("alone");
    let mut command = Command::new("arm-none-eabi-ld");
    command.args(["--gc-sections", "-o"]).arg(&alone);
    for call in calls {
        command.args(["--undefined", &format!("{name}_{call}")]);
    }
    command.args(["--entry", &format!("{name}_sense"), "--unresolved-symbols=ignore-all"]).arg(library);
    run(&mut command)?;
    let sizes = run(Command::new("arm-none-eabi-size").arg("-A").arg(&alone))?;
    let bytes = |line: &str| {
        let mut words = line.split_whitespace();
        let section = words.next()?;
        let counts = [".text", ".rodata", ".data", ".ARM.exidx"].iter().any(|kept| section.starts_with(kept));
        counts.then(|| words.next()?.parse::<u64>().ok()).flatten()
    };
    Ok(sizes.lines().filter_map(bytes).sum())
}

impl Played {
    /// The table.
    pub(super) fn text(&self, scene: &str, target: Option<&str>, state: usize) -> String {
        let Self { samples, contacts, near, counted, flash } = self;
        let how = match near {
            None => "bit for bit".to_owned(),
            Some([equal, far, turned]) => format!(
                "{}: {equal} of them bit for bit, points within {far} nm, normals within {turned}e-6",
                tolerance()
            ),
        };
        let mut text = format!(
            "{scene}, for {}: {samples} answers ({contacts} contacts) are the scene's, {how}.\n",
            target.unwrap_or("this computer")
        );
        // Writing to a string cannot fail.
        let _ = match (counted, flash) {
            (Some([median, greatest, stack]), Some([sense, all])) => write!(
                text,
                "\n| instructions of a sample, median | greatest | flash of a sample [B] | with its beginning [B] | stack [B] | state [B] |\n\
                 |---|---|---|---|---|---|\n| {median} | {greatest} | {sense} | {all} | {stack} | {state} |\n\n\
                 Counted in QEMU on a Cortex-M4F, the call itself taken off; instructions are no cycles.\n"
            ),
            _ => writeln!(text, "A state takes {state} bytes. Instructions are counted for {EMULATED}."),
        };
        text
    }
}
