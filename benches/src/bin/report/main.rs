//! Error against run time, and the stability of every routine.
//!
//! `cargo run --release -p fingertip-benches --bin report [-- --quick] [--only PART] [--out FOLDER] [--book FOLDER]`
//!
//! Writes `report.html` (diagrams, tables), `report.md` (one page for people in a hurry), and the
//! diagrams and data as SVG and CSV, by default into `target/report`. `--quick` takes seconds and
//! only shows that everything works; its times are rough. `--only PART` leaves out all other parts (`--only contact`).
//! `--book FOLDER` also writes the pages of the book that have the diagrams as small multiples, of all parts.
//!
//! Times are by calibrated repetition (`timing`); errors are against arithmetic of 220 bits
//! (`reference`), the truth from which an input was made, or a stiff solver.

extern crate alloc;

mod machine;
mod multiples;
mod page;
mod pareto;
mod plots;
mod reference;
mod sections;
mod table;
mod timing;

/// Shapes of drawn proportions, which the trials of contacts run on.
#[path = "../../../../contact/tests/trials/draw.rs"]
#[allow(dead_code, clippy::unwrap_used, reason = "the trials ask for more of it")]
mod draw;
#[path = "../slip_report/ramps.rs"]
#[allow(dead_code, reason = "the slip report asks for more of it")]
mod ramps;
/// The table of stress cases, which the test of the root crate runs too.
#[path = "../../../../tests/stability/mod.rs"]
mod stability;
#[path = "../../../../contact/tests/soft/wrenches.rs"]
#[allow(dead_code, reason = "tests ask for more of it")]
mod wrenches;

use core::error::Error;
use std::path::PathBuf;

use page::Page;
use timing::Effort;

type Failure = Box<dyn Error>;

struct Options {
    effort: Effort,
    only: Option<String>,
    folder: PathBuf,
    book: Option<PathBuf>,
}

fn options() -> Result<Options, Failure> {
    let mut options = Options {
        effort: Effort { quick: false },
        only: None,
        folder: PathBuf::from("target/report"),
        book: None,
    };
    let mut arguments = std::env::args_os().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--quick") => options.effort.quick = true,
            Some("--only") => {
                let part = arguments.next().ok_or("--only wants the name of a part")?;
                options.only = Some(part.to_string_lossy().into_owned());
            }
            Some("--out") => options.folder = arguments.next().ok_or("--out wants a folder")?.into(),
            Some("--book") => options.book = Some(arguments.next().ok_or("--book wants a folder")?.into()),
            _ => {
                let known = "--quick, --only PART, --out FOLDER and --book FOLDER";
                return Err(format!("unknown option {argument:?}; there are {known}").into());
            }
        }
    }
    if options.only.is_some() && options.book.is_some() {
        return Err("--book wants all parts, so it does not go with --only".into());
    }
    Ok(options)
}

fn main() -> Result<(), Failure> {
    let Options { effort, only, folder, book } = options()?;
    std::fs::create_dir_all(&folder)?;
    let machine = machine::name();
    let mut page = Page::default();
    let parts = sections::all(&mut page, effort, only.as_deref())?;
    let pace = if effort.quick { " A quick run: the times are rough." } else { "" };
    let introduction = format!(
        "Measured on: {machine}. Times are medians of short batches, with quartiles as bars.{pace} \
         Hollow marks are f32, full ones f64."
    );
    if let Some(book) = book {
        std::fs::create_dir_all(&book)?;
        for (name, text) in multiples::pages(&format!("Measured on: {machine}.{pace}"), page.groups(), &parts)
        {
            std::fs::write(book.join(name), text)?;
        }
    }
    let mut text = format!("# Error against run time\n\n{introduction}\n");
    for (_, (title, said)) in parts {
        text += &format!("\n## {title}\n\n{said}");
    }
    page.write(&folder, &introduction)?;
    std::fs::write(folder.join("report.md"), &text)?;
    println!("{text}");
    println!("Wrote {}", folder.join("report.html").display());
    Ok(())
}
