//! `fingertip completions` and `fingertip man`: for shells and for readers.

use std::io;
use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;

use crate::error::CliError;
use crate::output::{Outputs, Overwrite, print, print_exactly};

#[derive(Debug, Args)]
#[command(
    after_help = "For bash, once: fingertip completions bash > ~/.local/share/bash-completion/completions/fingertip"
)]
pub(crate) struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

#[derive(Debug, Args)]
#[command(after_help = "To look at one: fingertip man pages && man pages/fingertip-analyze.1")]
pub(crate) struct ManArguments {
    /// The folder to write them to, one for each command; it must exist
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    #[command(flatten)]
    overwrite: Overwrite,
}

/// Prints what a shell completes by.
pub(crate) fn completions(arguments: &CompletionsArguments, mut whole: Command) -> Result<(), CliError> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut whole, "fingertip", &mut text);
    print_exactly(&String::from_utf8_lossy(&text))
}

/// Writes the pages of the manual.
pub(crate) fn man(arguments: &ManArguments, mut whole: Command) -> Result<(), CliError> {
    whole.build();
    let mut pages = Vec::new();
    collect(&whole, "fingertip", &mut pages).map_err(CliError::Stdout)?;
    let paths: Vec<PathBuf> =
        pages.iter().map(|(name, _)| arguments.folder.join(format!("{name}.1"))).collect();
    let outputs = Outputs::guard(arguments.overwrite, "page", [], &paths)?;
    for (path, (_, text)) in paths.iter().zip(&pages) {
        outputs.write("page", path, text)?;
    }
    print(&format!("{} pages in {}\n", paths.len(), arguments.folder.display()))
}

fn collect(command: &Command, name: &str, pages: &mut Vec<(String, String)>) -> io::Result<()> {
    let mut page = Vec::new();
    let title: &'static str = Box::leak(name.to_owned().into_boxed_str());
    Man::new(command.clone().name(title)).render(&mut page)?;
    pages.push((name.to_owned(), String::from_utf8_lossy(&page).into_owned()));
    for part in command.get_subcommands().filter(|part| !part.is_hide_set() && part.get_name() != "help") {
        collect(part, &format!("{name}-{}", part.get_name()), pages)?;
    }
    Ok(())
}
