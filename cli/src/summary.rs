//! What a recording showed, in words and tables: the same for the terminal and for the report.

use core::fmt;
use std::path::Path;

use fingertip_recordings::Quality;
use fingertip_scene::{Limit, Scene};

use crate::observe::{Observations, Quantiles, Status};
use crate::standard::name_of;
use crate::table::{Table, count, number, number_or_dash, percent, short};

/// The result of a run, to be read by a human.
#[derive(Clone, Debug, Default)]
pub(crate) struct Findings {
    pub(crate) title: String,
    /// The result in sentences, the most important first.
    pub(crate) lead: Vec<String>,
    pub(crate) tables: Vec<Table>,
    /// What should be minded.
    pub(crate) notes: Vec<String>,
}

impl fmt::Display for Findings {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(out, "{}", self.title)?;
        for sentence in &self.lead {
            writeln!(out, "{sentence}")?;
        }
        for table in &self.tables {
            write!(out, "\n{table}")?;
        }
        if !self.notes.is_empty() {
            writeln!(out)?;
        }
        for note in &self.notes {
            writeln!(out, "Note: {note}.")?;
        }
        Ok(())
    }
}

/// What there is to tell of a recording.
pub(crate) struct Run<'a> {
    pub(crate) recording: &'a Path,
    pub(crate) scene: &'a Scene,
    pub(crate) observations: &'a Observations,
    pub(crate) quality: &'a Quality,
    pub(crate) notes: &'a [String],
    pub(crate) sensor: &'a str,
}

/// Most slips that a table lists.
const LISTED_SLIPS: usize = 20;

/// Tells of a recording.
pub(crate) fn of_recording(run: &Run<'_>) -> Findings {
    let Run { recording, scene, observations, quality, .. } = run;
    let name = name_of(recording);
    let sensor = if run.sensor.is_empty() { String::new() } else { format!(", sensor {}", run.sensor) };
    let mut findings = Findings {
        title: format!("Contacts in {name}{sensor}"),
        lead: vec![overview(observations, scene.name()), forces(observations), slips(observations, scene)],
        tables: vec![outcomes(observations), distributions(observations)],
        notes: run.notes.to_vec(),
    };
    let (contacts, pulling) =
        (observations.count_of(Status::Contact), observations.count_of(Status::OnlyPulling));
    if pulling > contacts {
        let tare = if scene.rest().is_some() { ", and that nothing touched during rest_s" } else { "" };
        findings.notes.insert(
            0,
            format!(
                "more forces pull outward than press; check `convention` and the pose in the scene{tare}"
            ),
        );
    }
    findings.lead.retain(|sentence| !sentence.is_empty());
    if observations.slips.count() > 0 {
        findings.tables.push(slip_table(observations));
    }
    if !observations.instants.kept().is_empty() {
        findings.tables.push(instant_table(observations));
    }
    let faults: Vec<_> = quality.faults().into_iter().filter(|(_, fault)| fault.count() > 0).collect();
    if !faults.is_empty() {
        let mut table = Table::new("Faults of the recording", ["", "count", "first in lines"]);
        for (name, fault) in faults {
            let lines: Vec<String> = fault.first_lines().iter().map(u64::to_string).collect();
            table.row([name.to_owned(), count(fault.count()), lines.join(", ")]);
        }
        findings.tables.push(table);
    }
    findings
}

fn overview(observations: &Observations, scene: &str) -> String {
    let (rows, contacts) = (observations.rows(), observations.count_of(Status::Contact));
    let loaded = rows
        - observations.count_of(Status::BelowThreshold)
        - observations.count_of(Status::Rest)
        - observations.count_of(Status::UnusableRow);
    format!(
        "{} samples over {} s, scene “{scene}”: {} contacts, which is {} of all samples and {} of those with enough force.",
        count(rows),
        number(observations.duration()),
        count(contacts),
        percent(contacts, rows),
        percent(contacts, loaded),
    )
}

fn forces(observations: &Observations) -> String {
    match (observations.normal.quantile(0.5), observations.ratio.quantile(0.5)) {
        (Some(normal), Some(ratio)) => format!(
            "In contact the median normal force is {} N and the median friction ratio |f_t|/f_n is {}.",
            number(normal),
            number(ratio)
        ),
        _ => String::new(),
    }
}

fn slips(observations: &Observations, scene: &Scene) -> String {
    let seen = match (scene.watches_for_slip(), observations.slips.count()) {
        (false, _) => String::new(),
        (true, 0) => "No slip was seen.".to_owned(),
        (true, 1) => "One slip was seen.".to_owned(),
        (true, slips) => format!("{} slips were seen.", count(slips)),
    };
    let limit = match (scene.limit().map(Limit::coefficient), observations.beyond_limit) {
        (Some(coefficient), beyond) if beyond > 0 => {
            format!(
                " The limit of the friction coefficient {} is passed in {} samples.",
                short(coefficient),
                count(beyond)
            )
        }
        _ => String::new(),
    };
    format!("{seen}{limit}").trim().to_owned()
}

fn outcomes(observations: &Observations) -> Table {
    let mut table = Table::new("Samples", ["", "count", "share"]);
    for status in Status::ALL {
        let samples = observations.count_of(status);
        if samples > 0 {
            table.row([status.meaning().to_owned(), count(samples), percent(samples, observations.rows())]);
        }
    }
    table
}

/// Quantiles of what was measured.
pub(crate) fn distributions(observations: &Observations) -> Table {
    let mut table = Table::new("Distributions", ["", "5 %", "median", "95 %", "greatest"]);
    let mut row = |name: &str, quantiles: &Quantiles, unit: f64| {
        if quantiles.count() > 0 {
            let at = |share| number_or_dash(quantiles.quantile(share).map(|value| value * unit));
            let greatest = number_or_dash(quantiles.greatest().map(|value| value * unit));
            table.row([name.to_owned(), at(0.05), at(0.5), at(0.95), greatest]);
        }
    };
    row("force, all samples / N", &observations.force, 1.0);
    row("normal force / N", &observations.normal, 1.0);
    row("tangential force / N", &observations.tangential, 1.0);
    row("friction ratio", &observations.ratio, 1.0);
    row("line misses by / mm", &observations.gap, 1e3);
    table
}

fn slip_table(observations: &Observations) -> Table {
    let (listed, all) = (observations.slips.kept(), observations.slips.count());
    let title = if all > LISTED_SLIPS as u64 {
        format!("Slips (the first {LISTED_SLIPS})")
    } else {
        "Slips".to_owned()
    };
    let mut table = Table::new(&title, ["", "at / s", "normal / N", "ratio"]);
    for (rank, slip) in listed.iter().take(LISTED_SLIPS).enumerate() {
        table.row([
            (rank + 1).to_string(),
            format!("{:.3}", slip.time),
            number_or_dash(slip.normal_force),
            number_or_dash(slip.ratio),
        ]);
    }
    table
}

/// How sure contacts were, at instants that are spread over the recording.
fn instant_table(observations: &Observations) -> Table {
    let head = ["at / s", "x / mm", "y / mm", "z / mm", "ellipse / mm", "normal / N", "± / N"];
    let mut table = Table::new("How sure some contacts are", head);
    for instant in observations.instants.kept() {
        let [a, b] = instant.semi_axes.map(|axis| number(axis * 1e3));
        let [x, y, z] =
            [instant.point.x, instant.point.y, instant.point.z].map(|x| format!("{:.2}", x * 1e3));
        table.row([
            format!("{:.3}", instant.time),
            x,
            y,
            z,
            format!("{a} × {b}"),
            number(instant.normal_force),
            number(instant.deviation),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use fingertip::friction::SlipVerdict;
    use fingertip_scene::{Projection, Scene};
    use nalgebra::Vector3;

    use super::{Findings, LISTED_SLIPS, Table, distributions, outcomes, overview, slip_table, slips};
    use crate::observe::{Observations, Status};

    const PLANE: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"plane\"\n";

    fn observations() -> Observations {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        Observations::new(Projection::plane(Vector3::zeros(), Vector3::z(), &axes))
    }

    #[test]
    fn what_was_not_seen_has_no_distribution() {
        let mut observations = observations();
        assert!(distributions(&observations).rows.is_empty());
        observations.gap.add(0.002);
        let rows = distributions(&observations).rows;
        assert_eq!(rows, [["line misses by / mm", "2.00", "2.00", "2.00", "2.00"]]);
    }

    /// Shares are of all samples, and of those that could have been contacts.
    #[test]
    fn what_could_be_no_contact_is_left_out_of_a_share() {
        let mut observations = observations();
        let samples = [
            (Status::Contact, 3),
            (Status::OnlyPulling, 1),
            (Status::BelowThreshold, 2),
            (Status::Rest, 5),
            (Status::UnusableRow, 4),
        ];
        for (k, status) in samples.iter().flat_map(|(status, count)| vec![*status; *count]).enumerate() {
            observations.add_without_wrench(0.5 * k as f64, status);
        }
        assert_eq!(
            overview(&observations, "a"),
            "15 samples over 7.00 s, scene “a”: 3 contacts, which is 20.00 % of all samples and 75.00 % of those with enough force."
        );
        // A row for each that there was, in the order of all.
        let found: Vec<[String; 2]> =
            outcomes(&observations).rows.iter().map(|row| [row[0].clone(), row[1].clone()]).collect();
        let seen = |status: &Status| samples.iter().find(|(other, _)| other == status);
        let expected: Vec<[String; 2]> = Status::ALL
            .iter()
            .filter_map(seen)
            .map(|(status, count)| [status.meaning().to_owned(), count.to_string()])
            .collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn slips_are_counted_where_they_are_watched_for_and_the_first_are_listed() {
        let watching = format!("{PLANE}[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n");
        let [plane, watching] = [PLANE, &watching].map(|text| Scene::from_text(text).unwrap());
        let mut observations = observations();
        assert_eq!(
            (slips(&observations, &plane).as_str(), slips(&observations, &watching).as_str()),
            ("", "No slip was seen.")
        );
        for slip in 1..=LISTED_SLIPS + 1 {
            let verdict = Some(SlipVerdict::Slipping);
            observations.slips.follow(slip as f64, verdict, Some(2.0), None);
            let table = slip_table(&observations);
            let title = if slip > LISTED_SLIPS { "Slips (the first 20)" } else { "Slips" };
            assert_eq!((table.title.as_str(), table.rows.len()), (title, slip.min(LISTED_SLIPS)));
            let last = slip.min(LISTED_SLIPS);
            assert_eq!(table.rows[last - 1], [&last.to_string(), &format!("{last}.000"), "2.00", "–"]);
            let said =
                if slip == 1 { "One slip was seen.".to_owned() } else { format!("{slip} slips were seen.") };
            assert_eq!(slips(&observations, &watching), said);
        }
        // A limit needs no watch, and one that is not passed is not named.
        let limit = "[friction]\nstatic_coefficient = 0.5\n";
        let limited = Scene::from_text(&format!("{PLANE}{limit}")).unwrap();
        assert_eq!(slips(&observations, &limited), "");
        observations.beyond_limit = 3;
        assert_eq!(
            slips(&observations, &limited),
            "The limit of the friction coefficient 0.5 is passed in 3 samples."
        );
    }

    #[test]
    fn findings_are_sentences_tables_and_notes() {
        let mut table = Table::new("Rows", ["a", "b"]);
        table.row(["1".to_owned(), "2".to_owned()]);
        let tables = table.to_string();
        let [lead, notes] = [vec!["One.".to_owned()], vec!["mind it".to_owned(), "and that".to_owned()]];
        let findings = Findings { title: "T".to_owned(), lead, tables: vec![table], notes };
        assert_eq!(findings.to_string(), format!("T\nOne.\n\n{tables}\nNote: mind it.\nNote: and that.\n"));
        let title = Findings { title: "T".to_owned(), ..Findings::default() };
        assert_eq!(title.to_string(), "T\n");
    }
}
