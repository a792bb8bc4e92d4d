//! Runs the command in a folder of its own.
#![allow(dead_code, reason = "each test program uses what it needs")]
#![allow(clippy::unwrap_used, reason = "helpers of tests, which may fail so")]

use core::sync::atomic::{AtomicU32, Ordering};
use std::fs;
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Commands that tests run again and again in one folder.
const WRITERS: [&str; 10] =
    ["analyze", "bench", "calibrate", "check", "demo", "design", "geometry", "motion", "refine", "tare"];

/// A folder that is removed with the test.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new() -> Self {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-{}-{number}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Whether a file is being written that will have this name, in the folder in which it will be.
    pub(crate) fn has_begun(&self, name: &str) -> bool {
        let path = self.path(name);
        let begun = format!("{}.unfinished-", path.file_stem().unwrap().to_string_lossy());
        let mut all = fs::read_dir(path.parent().unwrap()).unwrap().flatten();
        all.any(|entry| entry.file_name().to_string_lossy().starts_with(&begun))
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// The command, to be run in this folder, where those that have names for their files write over them.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = self.exact_command(arguments);
        if arguments.first().is_some_and(|first| WRITERS.contains(first))
            && !arguments.contains(&"--overwrite")
        {
            command.arg("--overwrite");
        }
        command
    }

    /// The command with these arguments alone.
    pub(crate) fn exact_command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fingertip"));
        command.current_dir(&self.0).args(arguments).stdin(Stdio::null());
        name_test(&mut command);
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs what must succeed, and gives the standard output.
    pub(crate) fn succeed(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {error}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs what must fail with a code, and gives the standard error.
    pub(crate) fn fail(&self, code: i32, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
        assert!(!error.contains("panicked"), "{error}");
        error
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Tells a program which test it runs for: `.ci/mutants` wants to know.
pub(crate) fn name_test(command: &mut Command) {
    if let Some(name) = std::thread::current().name() {
        command.env("FINGERTIP_MUTANTS_TEST", name);
    }
}

/// What stands on a page, a tag a line: without its head, its style and the scripts that every page has.
pub(crate) fn body(page: &str) -> String {
    let (_, body) = page.split_once("</style>").unwrap();
    let (body, _) = body.split_once("</main>").unwrap_or((body, ""));
    let mut pieces = body.split("<script>");
    let first = pieces.next().unwrap_or_default().to_owned();
    let shown =
        pieces.fold(first, |shown, piece| shown + piece.split_once("</script>").map_or("", |(_, rest)| rest));
    shown.replace("><", ">\n<").replace(env!("CARGO_PKG_VERSION"), "VERSION")
}

/// Compares a text with the one of `tests/accepted` that somebody has looked at: the same words, and the same
/// numbers to within one unit of the last place, in which two machines may round apart. With
/// `FINGERTIP_ACCEPT=1` it is written there instead.
pub(crate) fn assert_accepted(name: &str, found: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/accepted").join(name);
    if std::env::var_os("FINGERTIP_ACCEPT").is_some() {
        fs::write(&path, found).unwrap();
        return;
    }
    let accepted = fs::read_to_string(&path).unwrap();
    assert_eq!(
        found.lines().count(),
        accepted.lines().count(),
        "{name} has another number of lines:\n{found}"
    );
    for (line, (found, accepted)) in found.lines().zip(accepted.lines()).enumerate() {
        let (mut a, mut b) = (Pieces(found), Pieces(accepted));
        loop {
            let (ours, theirs) = (a.next(), b.next());
            let same = match (&ours, &theirs) {
                (Some(ours), Some(theirs)) => ours.agrees(theirs),
                (ours, theirs) => ours.is_none() && theirs.is_none(),
            };
            assert!(same, "{name}, line {}: {ours:?} for {theirs:?} in\n{found}", line + 1);
            if ours.is_none() {
                break;
            }
        }
    }
}

/// Cuts a text into numbers and what stands between them.
struct Pieces<'a>(&'a str);

#[derive(Debug)]
enum Piece<'a> {
    Words(&'a str),
    /// The number, and one unit of its last place.
    Number(f64, f64),
}

impl<'a> Iterator for Pieces<'a> {
    type Item = Piece<'a>;

    fn next(&mut self) -> Option<Piece<'a>> {
        let text = self.0;
        let digit = text.find(|c: char| c.is_ascii_digit());
        let start = digit.map_or(text.len(), |at| if text[..at].ends_with('-') { at - 1 } else { at });
        if start > 0 {
            self.0 = &text[start..];
            return Some(Piece::Words(&text[..start]));
        }
        digit?;
        let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
        let sign = usize::from(text.starts_with('-'));
        let mut end = sign + digits(&text[sign..]);
        let mut decimals = 0;
        if text[end..].starts_with('.') && digits(&text[end + 1..]) > 0 {
            decimals = digits(&text[end + 1..]);
            end += 1 + decimals;
        }
        let mut exponent = 0;
        if let Some(power) = text[end..].strip_prefix('e') {
            let sign = usize::from(power.starts_with('-'));
            let length = digits(&power[sign..]);
            if length > 0 {
                exponent = power[..sign + length].parse().unwrap();
                end += 1 + sign + length;
            }
        }
        let number = text[..end].parse().unwrap();
        self.0 = &text[end..];
        Some(Piece::Number(number, 10_f64.powi(exponent - decimals as i32)))
    }
}

impl Piece<'_> {
    fn agrees(&self, other: &Self) -> bool {
        match (self, other) {
            (Piece::Words(a), Piece::Words(b)) => a == b,
            // Whole numbers are counts, which are the same everywhere.
            (Piece::Number(a, unit), Piece::Number(b, other)) => {
                let unit = unit.min(*other);
                a == b || unit != 1.0 && (a - b).abs() <= unit * (1.0 + 1e-9)
            }
            _ => false,
        }
    }
}

/// A port where nobody listens, and nobody will: it is below those that systems give away by themselves.
pub(crate) fn unused_port() -> u16 {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    loop {
        let number = std::process::id().wrapping_mul(16).wrapping_add(NEXT.fetch_add(1, Ordering::Relaxed));
        let port = 10_000 + (number % 10_000) as u16;
        if UdpSocket::bind(("127.0.0.1", port)).is_ok() {
            return port;
        }
    }
}

/// A scene that ships with the project.
pub(crate) fn scene(name: &str) -> String {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    workspace.join("examples/scenes").join(name).display().to_string()
}

/// The rows of a `contacts.csv` by the names of its columns.
pub(crate) struct Contacts {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Contacts {
    pub(crate) fn parse(text: &str) -> Self {
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        let mut lines = lines.map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let columns = lines.next().unwrap();
        let rows: Vec<_> = lines.collect();
        assert!(rows.iter().all(|row| row.len() == columns.len()), "a row with another number of cells");
        Self { columns, rows }
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn words(&self, name: &str) -> Vec<&str> {
        let column = self.columns.iter().position(|column| column == name).unwrap();
        self.rows.iter().map(|row| row[column].as_str()).collect()
    }

    /// The numbers of a column; NaN for empty cells.
    pub(crate) fn numbers(&self, name: &str) -> Vec<f64> {
        self.words(name)
            .iter()
            .map(|cell| if cell.is_empty() { f64::NAN } else { cell.parse().unwrap() })
            .collect()
    }
}
