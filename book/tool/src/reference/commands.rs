//! The commands, by what they say of themselves.

use core::fmt::Write;
use std::process::Command;

use fingertip_cli::EXIT_CODES;

use crate::failure::Failure;

/// The command, which is built beside this program.
pub(crate) fn program() -> Result<std::path::PathBuf, Failure> {
    let here = std::env::current_exe().map_err(|error| Failure::Command(error.to_string()))?;
    let program = here.with_file_name("fingertip");
    if program.is_file() {
        Ok(program)
    } else {
        Err(Failure::Command(format!(
            "{} is not there; build it: cargo build -p fingertip-cli",
            program.display()
        )))
    }
}

/// What it says for some arguments.
fn said(arguments: &[&str]) -> Result<String, Failure> {
    let output = Command::new(program()?).args(arguments).env_remove("COLUMNS").output();
    let output = output.map_err(|error| Failure::Command(format!("fingertip: {error}")))?;
    if !output.status.success() {
        return Err(Failure::Command(format!("fingertip {} fails", arguments.join(" "))));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    Ok(lines.join("\n").trim_end().to_owned())
}

/// Names of commands: indented by two below `Commands:`.
fn commands_in(help: &str) -> Vec<&str> {
    help.lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter(|line| !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect()
}

/// Every command with its help.
pub(super) fn page() -> Result<String, Failure> {
    let help = said(&["--help"])?;
    let mut text = format!(
        "# The command\n\nWith all its bridges, which a build has that asks for them: \
         `cargo install --path cli --features web,foxglove,ros2`.\n\n```text,help\n{help}\n```\n"
    );
    for name in commands_in(&help) {
        let own = said(&[name, "--help"])?;
        let _ = write!(text, "\n## `fingertip {name}`\n\n```text,help\n{own}\n```\n");
        for below in commands_in(&own) {
            let _ = write!(
                text,
                "\n### `fingertip {name} {below}`\n\n```text,help\n{}\n```\n",
                said(&[name, below, "--help"])?
            );
        }
    }
    Ok(text)
}

/// The exit codes.
pub(super) fn exit_codes() -> String {
    let mut text =
        String::from("# Exit codes\n\nOf `fingertip`, for scripts.\n\n| code | meaning |\n|---|---|\n");
    for (code, says) in EXIT_CODES {
        let _ = writeln!(text, "| {code} | {says} |");
    }
    text
}
