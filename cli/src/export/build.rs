//! Compiles the package of a library for C with cargo.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use fingertip_scene::CLibrary;
use thiserror::Error;

/// Why a library cannot be compiled.
#[derive(Debug, Error)]
pub(super) enum BuildError {
    #[error("{program} cannot be run ({source}); --c needs cargo and rustc")]
    NoProgram { program: String, source: io::Error },
    #[error(
        "no compiler here has the target {target}; `rustup target add {target}`, or take a compiler with the sources of \
         its standard library (Debian: rustc-web, cargo-web, rust-web-src)"
    )]
    NoTarget { target: String },
    #[error("{what} {path}: {source}", path = .path.display())]
    File { what: &'static str, path: PathBuf, source: io::Error },
    #[error("{program} failed:\n{said}")]
    Failed { program: String, said: String },
}

/// Where fingertip itself is taken from.
#[derive(Debug)]
pub(super) struct Source(Option<PathBuf>);

impl Source {
    /// The one that is given, or that which this command was built of, if it is still there.
    pub(super) fn find(given: Option<&Path>) -> Self {
        let built_of = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let there = built_of.join("Cargo.toml").is_file().then_some(built_of);
        Self(given.map(Path::to_owned).or(there))
    }

    fn dependency(&self) -> Result<String, BuildError> {
        let Some(folder) = &self.0 else { return Ok(format!("version = \"{}\"", env!("CARGO_PKG_VERSION"))) };
        let whole = fs::canonicalize(folder).map_err(|source| BuildError::File {
            what: "fingertip's source",
            path: folder.clone(),
            source,
        })?;
        Ok(format!("path = {:?}", whole.display().to_string()))
    }
}

/// A compiler, and how it is asked for a target.
#[derive(Debug)]
struct Compiler {
    cargo: PathBuf,
    rustc: PathBuf,
    /// Whether the standard library is compiled, too.
    builds_core: bool,
}

/// A folder to compile in, for a target.
#[derive(Debug)]
pub(super) struct Build {
    target: Option<String>,
    compiler: Compiler,
    folder: PathBuf,
    /// Keeps a folder of its own until the end.
    _own: Option<tempfile::TempDir>,
}

/// Runs a program to its end: what it says, the standard output first, or that of its failure.
pub(super) fn run(command: &mut Command) -> Result<String, BuildError> {
    let program = command.get_program().to_string_lossy().into_owned();
    let ended =
        command.output().map_err(|source| BuildError::NoProgram { program: program.clone(), source })?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    // The emulator passes what a firmware says on as an error.
    let said = text(&ended.stdout) + &text(&ended.stderr);
    if ended.status.success() { Ok(said) } else { Err(BuildError::Failed { program, said }) }
}

impl Compiler {
    /// One that can compile for a target: that of the path if it has it, else Debian's, which brings the sources of the
    /// standard library.
    fn find(target: Option<&str>) -> Result<Self, BuildError> {
        let pairs = [("cargo", "rustc"), ("/usr/bin/cargo", "/usr/bin/rustc")];
        let Some(target) = target else {
            return Ok(Self { cargo: "cargo".into(), rustc: "rustc".into(), builds_core: false });
        };
        for (builds_core, part) in [
            (false, format!("lib/rustlib/{target}/lib")),
            (true, "lib/rustlib/src/rust/library/core".to_owned()),
        ] {
            for (cargo, rustc) in pairs {
                let Ok(sysroot) = run(Command::new(rustc).args(["--print", "sysroot"])) else { continue };
                let knows = || {
                    let list = run(Command::new(rustc).args(["--print", "target-list"]));
                    list.is_ok_and(|list| list.lines().any(|known| known == target))
                };
                if builds_core && !knows() {
                    continue;
                }
                if Path::new(sysroot.lines().next().unwrap_or_default()).join(&part).is_dir() {
                    return Ok(Self { cargo: cargo.into(), rustc: rustc.into(), builds_core });
                }
            }
        }
        Err(BuildError::NoTarget { target: target.to_owned() })
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.cargo);
        // Flags and wrappers are for what the user builds, not for this.
        for variable in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_BUILD_TARGET", "RUSTC_WRAPPER"] {
            command.env_remove(variable);
        }
        if self.cargo.is_absolute() {
            command.env("RUSTC", &self.rustc).env("PATH", "/usr/bin:/bin").env_remove("RUSTUP_TOOLCHAIN");
        }
        if self.builds_core {
            // To compile `core` is not stable.
            command.env("RUSTC_BOOTSTRAP", "1");
        }
        command
    }
}

impl Build {
    pub(super) fn new(folder: Option<&Path>, target: Option<&str>) -> Result<Self, BuildError> {
        let compiler = Compiler::find(target)?;
        let (folder, own) = match folder {
            Some(folder) => (folder.to_owned(), None),
            None => {
                let own = tempfile::tempdir().map_err(|source| BuildError::File {
                    what: "a temporary folder in",
                    path: env::temp_dir(),
                    source,
                })?;
                (own.path().to_owned(), Some(own))
            }
        };
        Ok(Self { target: target.map(str::to_owned), compiler, folder, _own: own })
    }

    /// The target, if it is another machine than this.
    pub(super) fn target(&self) -> Option<&str> {
        self.target.as_deref()
    }

    /// A folder for files of its own.
    pub(super) fn folder(&self, name: &str) -> Result<PathBuf, BuildError> {
        let folder = self.folder.join(name);
        fs::create_dir_all(&folder).map_err(|source| BuildError::File {
            what: "folder",
            path: folder.clone(),
            source,
        })?;
        Ok(folder)
    }

    /// The path of the static library.
    pub(super) fn compile(
        &self,
        library: &CLibrary,
        name: &str,
        source: &Source,
    ) -> Result<PathBuf, BuildError> {
        let package = self.folder("package")?;
        write(&package.join("Cargo.toml"), &library.manifest(&source.dependency()?))?;
        write(&package.join("lib.rs"), &library.border())?;
        write(&package.join("scene.rs"), library.module())?;
        // With the versions that fingertip itself was tried with.
        if let Some(folder) = &source.0 {
            let (from, to) = (folder.join("Cargo.lock"), package.join("Cargo.lock"));
            if from.is_file() {
                fs::copy(&from, &to).map_err(|source| BuildError::File { what: "file", path: to, source })?;
            }
        }
        let compiled = self.folder("compiled")?;
        let mut command = self.compiler.command();
        command.args(["build", "--release", "--manifest-path"]).arg(package.join("Cargo.toml"));
        command.arg("--target-dir").arg(&compiled);
        let mut files = compiled;
        if let Some(target) = &self.target {
            command.args(["--target", target]);
            files.push(target);
        }
        if self.compiler.builds_core {
            command.arg("-Zbuild-std=core,alloc");
        }
        run(&mut command)?;
        Ok(files.join("release").join(format!("lib{name}.a")))
    }
}

/// Writes a file of the build.
pub(super) fn write(path: &Path, text: &str) -> Result<(), BuildError> {
    fs::write(path, text).map_err(|source| BuildError::File { what: "file", path: path.to_owned(), source })
}
