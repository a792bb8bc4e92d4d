//! `fingertip scene`: scenes to begin with, what one means, and what there is to choose.

use core::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use fingertip_scene::registry::{self, Entry};
use fingertip_scene::{Scene, VERSION};

use super::{load, load_or_simulated};
use crate::error::CliError;
use crate::output::{self, Outputs, Overwrite};
use crate::report;
use crate::standard::shown;

/// What to do with scenes.
#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    #[command(subcommand)]
    command: SceneCommand,
}

#[derive(Debug, Subcommand)]
enum SceneCommand {
    /// Write a scene to begin with: the choices, and their other keys with values to start from
    Init(InitArguments),
    /// Say what a scene means, and what in it is implausible
    Check {
        /// The scene
        #[arg(value_name = "SCENE.toml")]
        scene: PathBuf,
    },
    /// Draw a scene on a page: the surface, where it may touch, the axes of the sensor, and what all means
    Show {
        /// The scene; `sim` is that of the simulated fingertip
        #[arg(value_name = "SCENE.toml")]
        scene: PathBuf,
        /// Where to write the page
        #[arg(short, long, value_name = "FILE", default_value = "scene.html")]
        output: PathBuf,
        #[command(flatten)]
        overwrite: Overwrite,
    },
    /// List all that a scene can choose
    Choices {
        /// Of this section alone, as `friction` or `contact.skin`
        #[arg(value_name = "SECTION")]
        section: Option<String>,
    },
}

#[derive(Debug, Args)]
struct InitArguments {
    /// Where to write it
    #[arg(value_name = "SCENE.toml")]
    output: PathBuf,
    /// The shape of the tip
    #[arg(long, default_value = "sphere")]
    shape: String,
    /// The contact model
    #[arg(long, default_value = "point")]
    model: String,
    /// The law of a skin
    #[arg(long)]
    skin: Option<String>,
    /// The friction limit
    #[arg(long)]
    friction: Option<String>,
    /// The slip detector
    #[arg(long)]
    slip: Option<String>,
    /// The filter of the wrench
    #[arg(long)]
    filter: Option<String>,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub(crate) fn run(arguments: &SceneArguments) -> Result<(), CliError> {
    match &arguments.command {
        SceneCommand::Init(init) => write_scene(init),
        SceneCommand::Check { scene } => check(scene),
        SceneCommand::Show { scene, output, overwrite } => show(scene, output, *overwrite),
        SceneCommand::Choices { section } => choices(section.as_deref()),
    }
}

/// The entry of a choice.
fn entry(section: &str, option: &str, name: &str) -> Result<&'static Entry, CliError> {
    registry::entries().find(|entry| entry.section == section && entry.name == name).ok_or_else(|| {
        CliError::option(option, name, "is not among the choices; `fingertip scene choices` lists them")
    })
}

fn write_scene(init: &InitArguments) -> Result<(), CliError> {
    let outputs = Outputs::guard(init.overwrite, "scene", [], [&init.output])?;
    let mut text = format!(
        "# The keys are explained in book/src/reference/scene.md of fingertip.\nversion = {VERSION}\n\n[input]\n\
         # Whose load is recorded: \"on_fingertip\", what the environment does to the fingertip, or \"reaction\".\n\
         convention = \"on_fingertip\"\n# Where the recording has no time.\nsample_rate_Hz = 1000.0\n"
    );
    let mut chosen =
        vec![entry("surface", "--shape", &init.shape)?, entry("contact", "--model", &init.model)?];
    for (section, option, name) in [
        ("contact.skin", "--skin", &init.skin),
        ("friction", "--friction", &init.friction),
        ("slip", "--slip", &init.slip),
        ("filter", "--filter", &init.filter),
    ] {
        if let Some(name) = name {
            chosen.push(entry(section, option, name)?);
        }
    }
    if init.model == "auto" {
        text.push_str("\n[uncertainty]\n# Standard deviations at rest.\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n");
    }
    for entry in chosen {
        let mut says = entry.says.chars();
        let first = says.next().map_or_else(String::new, |first| first.to_uppercase().collect());
        // Writing to a string cannot fail.
        let _ = write!(text, "\n# {first}{}.\n{}", says.as_str(), entry.text());
    }
    let folder = init.output.parent().unwrap_or(Path::new(""));
    Scene::parse(&text, "scene", folder).map_err(|fault| {
        CliError::Scene(fingertip_scene::SceneError::Fault { path: init.output.clone(), fault })
    })?;
    outputs.write("scene", &init.output, &text)?;
    outputs.tell(&outputs.written())
}

fn check(path: &Path) -> Result<(), CliError> {
    let scene = load(path)?;
    let mut text = format!("{}: {}\n", shown(path), scene.name());
    for line in scene.meaning() {
        let _ = writeln!(text, "  {line}");
    }
    for doubt in scene.doubts() {
        let _ = writeln!(text, "warning: {doubt}");
    }
    output::print(&text)
}

fn show(path: &PathBuf, output: &PathBuf, overwrite: Overwrite) -> Result<(), CliError> {
    let outputs = Outputs::guard(overwrite, "page", [path], [output])?;
    let scene = load_or_simulated(path)?;
    outputs.spare(scene.files())?;
    outputs.write("page", output, &report::of_scene(&scene))?;
    outputs.tell(&outputs.written())
}

fn choices(section: Option<&str>) -> Result<(), CliError> {
    let mut text = String::new();
    let mut last = "";
    for entry in registry::entries().filter(|entry| section.is_none_or(|section| entry.section == section)) {
        if entry.section != last {
            let _ = writeln!(
                text,
                "{}[{}] {} =",
                if last.is_empty() { "" } else { "\n" },
                entry.section,
                entry.key
            );
            last = entry.section;
        }
        let _ = writeln!(text, "  {:<18} {}", format!("\"{}\"", entry.name), entry.says);
        for line in entry.example.lines() {
            let _ = writeln!(text, "      {line}");
        }
    }
    if text.is_empty() {
        let section = section.unwrap_or_default();
        return Err(CliError::option(
            "section",
            section,
            "has no choices; give filter, surface, contact, contact.skin, friction or slip",
        ));
    }
    output::print(&text)
}
