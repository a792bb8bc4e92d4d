//! A grasp in words, tables and pictures.

use std::path::Path;

use super::beside::Beside;
use super::file::{HandScene, MOST};
use super::grasped::Grasped;
use crate::observe::{Quantiles, Trace};
use crate::report::{Axis, Chart, Figure};
use crate::standard::name_of;
use crate::summary::Findings;
use crate::table::{Table, count, number, number_or_dash, percent};

/// Curves behind the normal forces of the fingers.
const GRIP: usize = MOST;
const LEAST: usize = MOST + 1;
const MARGIN: usize = MOST + 2;
const LOAD: usize = MOST + 3;
const CURVES: usize = MOST + 4;
const CLASSES: [&str; MOST] = ["a", "b", "c", "d", "e", "f", "g", "h"];

/// What was seen of a hand: bounded memory, however long the recording.
pub(super) struct Seen {
    title: String,
    fingers: Vec<String>,
    rows: u64,
    /// Rows in which as many fingers touched.
    touching: [u64; MOST + 1],
    held: u64,
    /// Only without the factor of safety.
    without_safety: u64,
    not_held: u64,
    undecided: u64,
    /// A finger feels what cannot be.
    doubtful: u64,
    unusable: u64,
    /// Of the rows where any finger touches: grip, squeeze, least grip, load, margin \[N\].
    spread: [Quantiles; 5],
    /// The same of what the scene asks for beside, by what it is.
    beside: Vec<(String, Quantiles)>,
    trace: Trace<CURVES>,
    times: (f64, f64),
    /// Of sums of normal forces, of loads, and of normal forces \[N\].
    greatest: [f64; 3],
    /// Least and greatest \[N\].
    margins: (f64, f64),
}

impl Seen {
    pub(super) fn new(scene: &HandScene) -> Self {
        Self {
            title: scene.name.clone(),
            fingers: scene.fingers.iter().map(|finger| finger.name.clone()).collect(),
            rows: 0,
            touching: [0; MOST + 1],
            held: 0,
            without_safety: 0,
            not_held: 0,
            undecided: 0,
            doubtful: 0,
            unusable: 0,
            spread: Default::default(),
            beside: scene.beside.names().into_iter().map(|name| (name, Quantiles::default())).collect(),
            trace: Trace::default(),
            times: (f64::INFINITY, f64::NEG_INFINITY),
            greatest: [0.0; 3],
            margins: (0.0, 0.0),
        }
    }

    pub(super) fn rows(&self) -> u64 {
        self.rows
    }

    pub(super) fn add(&mut self, time: f64, grasped: Option<&Grasped>, beside: &Beside) {
        self.rows += 1;
        let mut values = [f64::NAN; CURVES];
        if time.is_finite() {
            self.times = (self.times.0.min(time), self.times.1.max(time));
        }
        let Some(grasped) = grasped else {
            self.unusable += 1;
            self.trace.add(time, &values);
            return;
        };
        let touching = grasped.touching();
        if let Some(count) = self.touching.get_mut(touching) {
            *count += 1;
        }
        let load = grasped.load.force().norm();
        let (margin, least) = (grasped.least_margin(), grasped.least.map(|(sum, _)| sum));
        self.doubtful += u64::from(grasped.held == "doubtful");
        if touching > 0 {
            match grasped.held {
                "held" => self.held += 1,
                "without_safety" => self.without_safety += 1,
                "cannot_hold" => self.not_held += 1,
                _ => self.undecided += 1,
            }
            let told = [Some(grasped.grip), Some(grasped.squeeze), least, Some(load), margin];
            for (spread, value) in self.spread.iter_mut().zip(told) {
                if let Some(value) = value {
                    spread.add(value);
                }
            }
            for ((_, spread), value) in self.beside.iter_mut().zip(grasped.answers.told(beside)) {
                if let Some(value) = value {
                    spread.add(value);
                }
            }
            values[GRIP] = grasped.grip;
            values[LEAST] = least.unwrap_or(f64::NAN);
            values[MARGIN] = margin.unwrap_or(f64::NAN);
            let margin = margin.unwrap_or(0.0);
            self.margins = (self.margins.0.min(margin), self.margins.1.max(margin));
        }
        values[LOAD] = load;
        let each = grasped.contacts.iter().zip(&grasped.forces);
        for (value, (contact, force)) in values.iter_mut().zip(each) {
            if contact.is_some() {
                *value = force.normal;
            }
        }
        let most = |a: f64, b: f64| if b.is_finite() { a.max(b) } else { a };
        let sums = most(most(self.greatest[0], values[GRIP]), values[LEAST]);
        let normal = values.iter().take(MOST).fold(self.greatest[2], |a, b| most(a, *b));
        self.greatest = [sums, most(self.greatest[1], load), normal];
        self.trace.add(time, &values);
    }

    /// In words and tables.
    pub(super) fn findings(&self, recording: &Path, mut notes: Vec<String>) -> Findings {
        let name = name_of(recording);
        let title = if self.title.is_empty() {
            format!("A hand in {name}")
        } else {
            format!("{} in {name}", self.title)
        };
        let held = self.held + self.without_safety;
        let judged = held + self.not_held + self.undecided;
        let lead = vec![
            format!(
                "{} rows of {} fingers; all of them touch in {} of these.",
                count(self.rows),
                self.fingers.len(),
                percent(self.touching.get(self.fingers.len()).copied().unwrap_or(0), self.rows)
            ),
            format!(
                "Of the {} rows in which any finger touches, forces within friction and limits hold the load in {}, and \
                 none do in {}.",
                count(judged),
                percent(held, judged),
                percent(self.not_held, judged)
            ),
        ];
        notes.push(
            "the load is the sum of what all sensors feel, and what no sensor feels, as a finger without one, is part of it; load \
             and places are in the frame of the hand"
                .to_owned(),
        );
        if self.without_safety > 0 {
            notes.push(format!(
                "in {} of the rows that hold, the load is held without the factor of safety alone, and the least grip is that \
                 without it",
                count(self.without_safety)
            ));
        }
        if self.doubtful > 0 {
            notes.push(format!(
                "{} rows are doubtful: a finger feels a force that no contact explains, or more friction than there is, so what \
                 the others are to bear is not known",
                count(self.doubtful)
            ));
        }
        if self.unusable > 0 {
            notes.push(format!(
                "{} rows are rest or repeat the row before, or lack a sensor or a pose",
                count(self.unusable)
            ));
        }
        Findings { title, lead, tables: vec![self.touches(), self.spreads()], notes }
    }

    fn touches(&self) -> Table {
        let mut table = Table::new("How many fingers touch", ["fingers", "rows", "share"]);
        for (fingers, rows) in self.touching.iter().enumerate().take(self.fingers.len() + 1) {
            table.row([fingers.to_string(), count(*rows), percent(*rows, self.rows)]);
        }
        table
    }

    fn spreads(&self) -> Table {
        let head = ["in N, while any finger touches", "5 %", "median", "95 %", "greatest"];
        let mut table = Table::new("Forces", head);
        let names = [
            "grip: sum of the normal forces",
            "squeeze: the internal part of it",
            "least grip that holds the load",
            "load: sum of all forces",
            "margin of the contact nearest to slipping",
        ];
        let beside = self.beside.iter().map(|(name, spread)| (name.as_str(), spread));
        for (name, spread) in names.into_iter().zip(&self.spread).chain(beside) {
            let at = |share| number_or_dash(spread.quantile(share));
            table.row([
                name.to_owned(),
                at(0.05),
                at(0.5),
                at(0.95),
                spread.greatest().map_or("–".to_owned(), number),
            ]);
        }
        table
    }

    fn chart(&self, title: &str, y: Axis, curves: &[(&str, usize)]) -> String {
        let (low, high) = if self.times.0 < self.times.1 { self.times } else { (0.0, 1.0) };
        let mut chart = Chart::new(title, Axis::linear("time / s", low, high), y);
        for (class, curve) in curves {
            chart.curve(class, &self.trace.pieces(*curve));
        }
        chart.finish()
    }

    /// In pictures.
    pub(super) fn figures(&self) -> Vec<Figure> {
        let top = self.greatest[0].max(1e-3);
        let fingers: Vec<_> = CLASSES.into_iter().zip(0..self.fingers.len()).collect();
        let named = CLASSES.into_iter().zip(self.fingers.iter().cloned()).collect();
        let figure = |title: &str, svg, keys, caption: &str| Figure {
            title: title.to_owned(),
            svg,
            keys,
            caption: caption.to_owned(),
            on_white: false,
        };
        let axis = |label: &str, low: f64, high: f64| Axis::rounded(label, low, high);
        let normal =
            self.chart("Normal forces", axis("normal force / N", 0.0, self.greatest[2].max(1e-3)), &fingers);
        let grip =
            self.chart("Grip", axis("sum of normal forces / N", 0.0, top), &[("a", GRIP), ("b", LEAST)]);
        let load = axis("load / N", 0.0, self.greatest[1].max(1e-3));
        let load = self.chart("Load", load, &[("a", LOAD)]);
        let (low, high) = self.margins;
        let margin = axis("margin / N", low, high.max(low + 1e-3));
        let margin = self.chart("Margin", margin, &[("a", MARGIN)]);
        let key = |class, name: &str| (class, name.to_owned());
        vec![
            figure("Normal forces", normal, named, "Of the fingers that touch."),
            figure(
                "Grip, and the least that holds",
                grip,
                vec![key("a", "felt"), key("b", "least")],
                "Sums of normal forces. The least is that of the cone program for the load that is felt, within friction \
                 and limits; it has gaps where no forces hold it.",
            ),
            figure("Load", load, Vec::new(), "The magnitude of the sum of what all sensors feel."),
            figure(
                "Margin",
                margin,
                Vec::new(),
                "Of the contact nearest to slipping: by how much its force may change before it slips.",
            ),
        ]
    }
}
