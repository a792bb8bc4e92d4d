//! The `fingertip` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(fingertip_cli::run(std::env::args_os()))
}
