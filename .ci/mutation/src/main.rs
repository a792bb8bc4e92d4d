//! Puts faults into the workspace, one at a time, and says which of them no test notices.
//!
//! All faults of a sample are compiled into one copy of the workspace, each behind a switch that an
//! environment variable turns on: one build, instead of one a fault. A first run without a fault writes
//! down which test comes by which fault, so that each fault is tried with the tests that can notice it.

mod build;
mod compiled;
mod equivalents;
mod fault;
mod find;
mod options;
mod program;
mod splice;
mod tree;
mod workspace;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use build::Built;
use fault::Fault;
use options::Options;
use program::Program;

type Failure = Box<dyn std::error::Error + Send + Sync>;

fn main() -> ExitCode {
    let options = match Options::read(std::env::args().skip(1)) {
        Ok(options) => options,
        Err(words) => {
            eprintln!("{words}");
            return ExitCode::from(2);
        }
    };
    match run(&options) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(2)
        }
    }
}

fn run(options: &Options) -> Result<bool, Failure> {
    let root = std::env::current_dir()?;
    let packages = workspace::packages(&root)?;
    let files = workspace::files(&root)?;
    let judged = equivalents::read(&root.join(".ci/mutation/equivalents"))?;
    let mut faults = all_faults(&root, &files)?;
    let equivalent = equivalents::take_out(&mut faults, &judged)?;
    let left_out = workspace::leave_out(&mut faults, &root, &packages, workspace::is_root())?;
    faults.retain(|fault| is_asked_for(options, &root, &packages, &fault.file));
    println!(
        "{} places for faults; {equivalent} more, in the whole project, are judged equivalent, and {} stand in files that \
         tests do not compile",
        faults.len(),
        left_out.not_compiled
    );
    if left_out.as_root > 0 {
        println!("not tried as root: {} in files whose faults may harm the machine", left_out.as_root);
    }
    shuffle(&mut faults, options.seed);
    let listed = match &options.again {
        Some(path) => listed_first(&mut faults, &std::fs::read_to_string(path)?),
        None => 0,
    };
    let wanted = options.count.map_or(faults.len(), |count| listed + count).min(faults.len());
    if options.list {
        faults[..wanted].iter().for_each(|fault| println!("{fault}"));
        return Ok(true);
    }
    println!("seed {}", options.seed);

    // Some will not compile.
    let spare = wanted / 3 + 5;
    let mut numbered: BTreeMap<u32, Fault> = (1..).zip(faults.into_iter().take(wanted + spare)).collect();
    let built = build_tests(&root, options, &packages, &files, &mut numbered)?;
    let numbered: BTreeMap<u32, Fault> = numbered.into_iter().take(wanted).collect();

    let data = std::env::var_os("FINGERTIP_DATA").map_or_else(|| root.join("../shared/data"), PathBuf::from);
    let mut programs = Vec::new();
    for (folder, executable) in built {
        programs.push(Program::observe(folder, executable, &data)?);
    }
    let survivors = try_all(&root, &numbered, &programs)?;
    Ok(report(&numbered, &survivors, &programs, &root, &packages, options.require))
}

/// Brings the faults that an earlier run lists to the front, and says how many there are: wherever their lines stand today.
fn listed_first(faults: &mut [Fault], said: &str) -> usize {
    let is_listed = |fault: &Fault| {
        let what = format!(": {}    {}", fault.change, fault.source);
        said.lines().any(|line| line.contains(&format!("{}:", fault.file)) && line.contains(&what))
    };
    faults.sort_by_cached_key(|fault| !is_listed(fault));
    faults.iter().take_while(|fault| is_listed(fault)).count()
}

fn all_faults(root: &Path, files: &[String]) -> Result<Vec<Fault>, Failure> {
    let mut faults = Vec::new();
    for file in files.iter().filter(|file| workspace::is_source(file)) {
        let text = std::fs::read_to_string(root.join(file))?;
        faults.extend(find::faults(file, &text).map_err(|error| format!("{file}: {error}"))?);
    }
    Ok(faults)
}

fn is_asked_for(options: &Options, root: &Path, packages: &[workspace::Package], file: &str) -> bool {
    let package = workspace::package_of(root, packages, file);
    let chosen = match (options.packages.is_empty(), package) {
        (true, _) => workspace::is_hot(file),
        (false, Some(package)) => options.packages.contains(&package.name),
        (false, None) => false,
    };
    chosen && (options.paths.is_empty() || options.paths.iter().any(|start| file.starts_with(start)))
}

/// Fisher and Yates, with Steele's splitmix64: the same order on every machine.
fn shuffle(faults: &mut [Fault], seed: u64) {
    let mut state = seed;
    for last in (1..faults.len()).rev() {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        faults.swap(last, ((z ^ (z >> 31)) % (last as u64 + 1)) as usize);
    }
}

/// Builds again without the faults that do not compile, until the rest does.
fn build_tests(
    root: &Path,
    options: &Options,
    packages: &[workspace::Package],
    files: &[String],
    faults: &mut BTreeMap<u32, Fault>,
) -> Result<Vec<(PathBuf, PathBuf)>, Failure> {
    let copy = root.join("target/mutants");
    let mut asked: Vec<String> = if options.packages.is_empty() {
        let mut names: Vec<String> = faults
            .values()
            .filter_map(|fault| workspace::package_of(root, packages, &fault.file))
            .map(|package| package.name.clone())
            .collect();
        names.sort();
        names.dedup();
        names
    } else {
        options.packages.clone()
    };
    asked.extend(options.judges.iter().cloned());
    let chosen = packages.iter().filter(|package| options.packages.contains(&package.name));
    asked.extend(chosen.flat_map(workspace::Package::judges).cloned());
    if let Some(unknown) = asked.iter().find(|name| !packages.iter().any(|package| package.name == **name)) {
        return Err(format!("there is no package {unknown}").into());
    }
    let asked: Vec<_> = packages.iter().filter(|package| asked.contains(&package.name)).collect();
    for _ in 0..12 {
        let places = tree::write(root, &copy, files, faults)?;
        match build::tests(&copy, &asked, &places)? {
            Built::Programs(programs) => return Ok(programs),
            Built::Refused(refused) => {
                println!("{} faults do not compile", refused.len());
                faults.retain(|number, _| !refused.contains(number));
            }
        }
    }
    Err("faults that do not compile are left after twelve builds".into())
}

/// The faults that no program notices.
fn try_all(root: &Path, faults: &BTreeMap<u32, Fault>, programs: &[Program]) -> Result<Vec<u32>, Failure> {
    let copy = root.join("target/mutants");
    let numbers: Vec<u32> = faults.keys().copied().collect();
    let next = AtomicUsize::new(0);
    let survivors = Mutex::new(Vec::new());
    let failure = Mutex::new(None);
    let work = || {
        while let Some(number) = numbers.get(next.fetch_add(1, Ordering::Relaxed)) {
            // The package's own tests first, and the program with the fewest tests to run.
            let own = copy.join(&faults[number].file);
            let mut order: Vec<&Program> =
                programs.iter().filter(|program| program.tests_at(*number) > 0).collect();
            order.sort_by_key(|program| (!own.starts_with(&program.folder), program.tests_at(*number)));
            let mut noticed = Ok(false);
            for program in order {
                noticed = program.notices(*number);
                if !matches!(noticed, Ok(false)) {
                    break;
                }
            }
            match noticed {
                Ok(true) => {}
                Ok(false) => {
                    println!("survives: {}", faults[number]);
                    survivors.lock().unwrap_or_else(|held| held.into_inner()).push(*number);
                }
                Err(error) => *failure.lock().unwrap_or_else(|held| held.into_inner()) = Some(error),
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, |count| count.get()) {
            scope.spawn(work);
        }
    });
    match failure.into_inner().unwrap_or_else(|held| held.into_inner()) {
        Some(error) => Err(error),
        None => Ok(survivors.into_inner().unwrap_or_else(|held| held.into_inner())),
    }
}

fn report(
    faults: &BTreeMap<u32, Fault>,
    survivors: &[u32],
    programs: &[Program],
    root: &Path,
    packages: &[workspace::Package],
    require: f64,
) -> bool {
    println!("\nnot noticed:");
    for number in survivors {
        let tests: usize = programs.iter().map(|program| program.tests_at(*number)).sum();
        println!("  {}    ({tests} tests come by)", faults[number]);
    }
    let mut by_package = BTreeMap::<&str, (usize, usize)>::new();
    for (number, fault) in faults {
        let name = workspace::package_of(root, packages, &fault.file).map_or("?", |package| &package.name);
        let (noticed, all) = by_package.entry(name).or_default();
        *noticed += usize::from(!survivors.contains(number));
        *all += 1;
    }
    let mut enough = true;
    println!();
    for (name, (noticed, all)) in by_package {
        let share = 100.0 * noticed as f64 / all as f64;
        println!("{name}: {noticed} of {all} noticed, {share:.1} %");
        enough &= share >= require;
    }
    enough
}
