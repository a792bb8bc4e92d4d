//! What one needs to glue and to wire: a template at 1:1, and the pages of a PDF.

use fingertip_calibration::bench::{Unrolled, drawing, placements, template, wiring};
use fingertip_calibration::design::{DesignError, LayoutFile, Placement};
use fingertip_calibration::page;
use fingertip_calibration::sheet::{Sheet, pdf, tables};

use super::args::{BenchFiles, Parts};
use super::converters::Converters;
use crate::error::CliError;
use crate::output::Outputs;
use crate::report::Figure;
use crate::table::Table;

/// The design at the bench.
pub(crate) struct Bench {
    unrolled: Unrolled,
    placement: Placement,
    /// The tube with its dimensions.
    drawing: Sheet,
    wiring: Vec<Sheet>,
    converters: Converters,
}

impl Bench {
    /// Of a layout; `tip` is the radius of the spherical fingertip \[m\], if it is known.
    pub(crate) fn new(file: &LayoutFile, tip: Option<f64>, parts: &Parts) -> Result<Self, DesignError> {
        let (layout, foil, placement) = (file.layout(), parts.foil(), parts.placement());
        placement.validate()?;
        let clamped = file.loaded_tube().length;
        let unrolled = Unrolled::new(&layout, clamped, &foil, parts.paper_mm * 1e-3)?;
        let drawing = drawing(&unrolled, tip);
        let wiring = wiring(&layout, &foil, &file.excitation);
        let converters = Converters::new(file, parts)?;
        Ok(Self { unrolled, placement, drawing, wiring, converters })
    }

    /// The template, and everything on paper.
    pub(crate) fn write(&self, outputs: &Outputs, files: &BenchFiles) -> Result<(), CliError> {
        outputs.write("template", &files.template, &self.sheet().to_svg())?;
        outputs.write_bytes("pages for the bench", &files.pages, &self.pdf())
    }

    /// Which settings of each converter suit, and what to expect of it.
    pub(crate) fn tables(&self) -> Vec<Table> {
        self.converters.tables()
    }

    fn sheet(&self) -> Sheet {
        template(&self.unrolled, self.placement)
    }

    /// Everything on paper.
    fn pdf(&self) -> Vec<u8> {
        let mut sheets = vec![self.sheet()];
        sheets.extend(placements(&self.unrolled, self.placement));
        sheets.push(self.drawing.clone());
        sheets.extend(self.wiring.iter().cloned());
        let found = self.converters.tables();
        let shown = |table: &Table| {
            let rows: Vec<Vec<String>> = table
                .rows
                .iter()
                .map(|row| row.iter().map(|cell| cell.replace('-', "−")).collect())
                .collect();
            (table.title.clone(), table.head.clone(), rows)
        };
        let shown: Vec<_> = found.iter().map(shown).collect();
        let shown: Vec<page::Table<'_>> =
            shown.iter().map(|(title, head, rows)| page::Table { title, head, rows, words: false }).collect();
        sheets.extend(tables("Converters", &self.converters.lines(), &shown));
        pdf(&sheets)
    }

    /// The drawings for the report.
    pub(crate) fn figures(&self) -> Vec<Figure> {
        let figure = |sheet: &Sheet, caption: &str| Figure {
            title: sheet.title().to_owned(),
            svg: sheet.to_figure(),
            caption: caption.to_owned(),
            on_white: true,
            ..Figure::default()
        };
        let mut figures = vec![figure(&self.drawing, "")];
        figures.extend(self.wiring.iter().map(|sheet| figure(sheet, "")));
        figures
    }

    /// What to mind when gauges are glued.
    pub(crate) fn notes(&self) -> Vec<String> {
        let named = |pairs: &[(usize, usize)]| {
            let names: Vec<String> = pairs.iter().map(|(a, b)| format!("{} and {}", a + 1, b + 1)).collect();
            names.join(", ")
        };
        let mut notes = Vec::new();
        let (stacked, overlapping) = (self.unrolled.stacked(), self.unrolled.overlapping());
        if !stacked.is_empty() {
            notes.push(format!(
                "Gauges at one place are stacked: {}; they can be bought so, as a rosette",
                named(&stacked)
            ));
        }
        if !overlapping.is_empty() {
            notes.push(format!(
                "Carriers of gauges lie over each other: {}; --carrier-mm has their size",
                named(&overlapping)
            ));
        }
        notes.extend(self.converters.notes());
        notes
    }
}
