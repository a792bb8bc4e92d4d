//! The `fingertip` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    fingertip_cli::run(std::env::args_os())
}
