//! One test program: its tests, which faults each of them comes by, and what it makes of a fault.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead, BufReader};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use crate::Failure;

pub struct Program {
    /// Where cargo runs it: the folder of its package.
    pub folder: PathBuf,
    executable: PathBuf,
    data: PathBuf,
    /// Tests that come by each fault, the quickest first.
    reached: BTreeMap<u32, Vec<String>>,
    /// How long each of its tests takes.
    times: BTreeMap<String, Duration>,
    /// How long all its tests take.
    took: Duration,
}

/// Tests that take longer than this are asked only of a fault that no quicker one notices.
const QUICK: Duration = Duration::from_millis(500);

impl Program {
    /// Runs all tests once without a fault, and writes down which faults each comes by.
    pub fn observe(folder: PathBuf, executable: PathBuf, data: &Path) -> Result<Self, Failure> {
        let listed =
            Command::new(&executable).args(["--list", "--format=terse"]).current_dir(&folder).output()?;
        let names: BTreeSet<String> = String::from_utf8(listed.stdout)?
            .lines()
            .filter_map(|line| line.strip_suffix(": test").map(str::to_owned))
            .collect();
        let log = executable.with_extension("reached");
        let _ = std::fs::remove_file(&log);
        let start = Instant::now();
        let output = Command::new(&executable)
            .args(["-Zunstable-options", "--report-time", "--test-threads=2"])
            .current_dir(&folder)
            // For the times of tests, which a stable compiler's programs tell only so.
            .env("RUSTC_BOOTSTRAP", "1")
            .env("FINGERTIP_DATA", data)
            .env("FINGERTIP_MUTANTS_REACHED", &log)
            .stdin(Stdio::null())
            .output()?;
        let took = start.elapsed();
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stdout);
            return Err(format!("{} fails without a fault:\n{said}", executable.display()).into());
        }
        let mut reached = BTreeMap::<u32, BTreeSet<String>>::new();
        for line in std::fs::read_to_string(&log).unwrap_or_default().lines() {
            let Some((number, thread)) = line.split_once(' ') else { continue };
            let tests = reached.entry(number.parse()?).or_default();
            if names.contains(thread) {
                tests.insert(thread.to_owned());
            } else {
                // A thread or a process that a test started: any test may have done so.
                tests.extend(names.iter().cloned());
            }
        }
        let times = times(&String::from_utf8_lossy(&output.stdout));
        let sorted = |tests: BTreeSet<String>| {
            let mut tests: Vec<String> = tests.into_iter().collect();
            tests.sort_by_key(|test| times.get(test).copied().unwrap_or(took));
            tests
        };
        let reached = reached.into_iter().map(|(number, tests)| (number, sorted(tests))).collect();
        Ok(Self { folder, executable, data: data.to_owned(), reached, times, took })
    }

    /// How many tests come by a fault.
    pub fn tests_at(&self, fault: u32) -> usize {
        self.reached.get(&fault).map_or(0, Vec::len)
    }

    /// Whether a test fails, or does not end, with a fault switched on. Quick tests are tried together, before the others,
    /// of which each is tried alone.
    pub fn notices(&self, fault: u32) -> Result<bool, Failure> {
        let Some(tests) = self.reached.get(&fault) else { return Ok(false) };
        let is_quick = |test: &String| self.times.get(test).is_some_and(|time| *time <= QUICK);
        let (quick, slow) = tests.split_at(tests.partition_point(is_quick));
        let parts = core::iter::once(quick).chain(slow.chunks(1)).filter(|part| !part.is_empty());
        for part in parts {
            if self.fails(fault, part)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// How long these tests take, one after the other.
    fn expected(&self, tests: &[String]) -> Duration {
        tests.iter().map(|test| self.times.get(test).copied().unwrap_or(self.took)).sum()
    }

    /// Whether one of these tests fails, or does not end.
    fn fails(&self, fault: u32, tests: &[String]) -> Result<bool, Failure> {
        let mut child = Command::new(&self.executable)
            .args(["--exact", "--test-threads=1"])
            .args(tests)
            .current_dir(&self.folder)
            .env("FINGERTIP_DATA", &self.data)
            .env("FINGERTIP_MUTANT", fault.to_string())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .process_group(0)
            .spawn()?;
        let (send, lines) = mpsc::channel();
        let output = child.stdout.take();
        let reader = std::thread::spawn(move || {
            for line in output.into_iter().flat_map(|output| BufReader::new(output).lines()).flatten() {
                if send.send(line).is_err() {
                    break;
                }
            }
        });
        let limit = Instant::now() + Duration::from_secs(30) + 8 * self.expected(tests);
        let failed = loop {
            match lines.recv_timeout(limit.saturating_duration_since(Instant::now())) {
                Ok(line) if line.ends_with("FAILED") => break true,
                Ok(_) => {}
                Err(mpsc::RecvTimeoutError::Timeout) => break true,
                Err(mpsc::RecvTimeoutError::Disconnected) => break !child.wait()?.success(),
            }
        };
        // What a test started goes with it.
        let group = format!("-{}", child.id());
        let _ = Command::new("kill").args(["-9", "--", &group]).stderr(Stdio::null()).status();
        let _ = child.wait();
        drop(lines);
        let _ = reader.join();
        Ok(failed)
    }
}

/// What a program says of its tests' times: `test NAME ... ok <1.234s>`.
fn times(said: &str) -> BTreeMap<String, Duration> {
    let lines = said.lines().filter_map(|line| line.strip_prefix("test ")?.split_once(" ... ok <"));
    lines
        .filter_map(|(name, time)| {
            let seconds = time.strip_suffix("s>")?.parse().ok()?;
            Some((name.to_owned(), Duration::try_from_secs_f64(seconds).ok()?))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_that_a_program_tells() {
        let said = "\nrunning 3 tests\ntest a::b ... ok <0.250s>\ntest c ... ignored\ntest d ... ok <12.5s>\n\ntest result";
        let expected = [("a::b", 0.25), ("d", 12.5)];
        assert_eq!(
            times(said),
            expected.map(|(name, s)| (name.to_owned(), Duration::from_secs_f64(s))).into()
        );
    }
}
