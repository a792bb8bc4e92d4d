//! What is asked on the command line.

pub const USAGE: &str = "\
Puts faults into the code, one at a time, and lists those that no test notices.

usage: .ci/mutants [options]

  --package NAME    faults in this package, judged by its own tests; may be repeated
                    (default: faults in the hot files, judged by the tests of all packages that hold some)
  --with NAME       judged by the tests of this package too; may be repeated
  --in PATH         only files whose path starts so; may be repeated
  --count N         how many faults are drawn (default 60)
  --all             every fault
  --again FILE      those first that FILE, what an earlier run said, lists; `--count` are drawn beside them
  --seed N          draws the same faults again (default: from the clock; printed)
  --require PERCENT fail if fewer are noticed
  --list            list the faults, and try none";

#[derive(Debug)]
pub struct Options {
    pub packages: Vec<String>,
    /// Packages in which no faults are put, and whose tests judge.
    pub judges: Vec<String>,
    pub paths: Vec<String>,
    /// `None`: all.
    pub count: Option<usize>,
    /// What an earlier run said, of which the faults are tried again.
    pub again: Option<std::path::PathBuf>,
    pub seed: u64,
    pub require: f64,
    pub list: bool,
}

impl Options {
    pub fn read(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let clock = std::time::UNIX_EPOCH.elapsed().map_or(0, |since| since.as_secs());
        let mut options = Self {
            packages: Vec::new(),
            judges: Vec::new(),
            paths: Vec::new(),
            count: Some(60),
            again: None,
            seed: clock % 1_000_000,
            require: 0.0,
            list: false,
        };
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{argument} needs a value\n\n{USAGE}"));
            match argument.as_str() {
                "--package" | "-p" => options.packages.push(value()?),
                "--with" => options.judges.push(value()?),
                "--in" => options.paths.push(value()?),
                "--count" => options.count = Some(number(&value()?)?),
                "--all" => options.count = None,
                "--again" => options.again = Some(value()?.into()),
                "--seed" => options.seed = number(&value()?)?,
                "--require" => options.require = number(&value()?)?,
                "--list" => options.list = true,
                "--help" | "-h" => return Err(USAGE.to_owned()),
                _ => return Err(format!("unknown option {argument}\n\n{USAGE}")),
            }
        }
        Ok(options)
    }
}

fn number<N: std::str::FromStr>(text: &str) -> Result<N, String> {
    text.parse().map_err(|_| format!("{text:?} is no such number"))
}
