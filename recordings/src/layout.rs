//! Which columns belong to which sensor.

mod inertial;
mod left_out;

use fingertip_wrench::units::{ForceUnit, TorqueUnit};

use crate::column_name::{ColumnMeaning, ColumnName};
use crate::columns::{CONTACT_COLUMNS, ContactColumns, SignalColumns, WrenchColumns, of_sensor};
use crate::error::HeaderProblem;
use crate::options::AssumedUnits;
use crate::shortened::shortened;
use crate::unit::SignalUnit;

pub use left_out::LeftOut;

/// What a recording holds, as its header says.
///
/// ```
/// use fingertip_recordings::{AssumedUnits, Layout};
///
/// let header = ["t_s", "v1_V", "v2_V", "left_v1_V", "left_v2_V", "weather"];
/// let layout = Layout::from_header(&header, AssumedUnits::default())?;
/// assert!(layout.has_time());
/// assert_eq!(layout.signals().len(), 2); // of a sensor without a name, and of the left one
/// assert_eq!(layout.names_of_signals(layout.signals_of("left")?), ["left_v1_V", "left_v2_V"]);
/// assert_eq!(layout.ignored().collect::<Vec<_>>(), ["weather"]);
/// # Ok::<(), fingertip_recordings::HeaderProblem>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    columns: Vec<String>,
    pub(super) used: Vec<UsedColumn>,
    pub(super) time: Option<UsedColumn>,
    wrenches: Vec<WrenchColumns>,
    signals: Vec<SignalColumns>,
    contacts: Option<ContactColumns>,
    left_out: Vec<LeftOut>,
    /// Names of frames by those of sensors.
    frames: Vec<(String, String)>,
}

/// A column whose cells are read, and what one of its unit is in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UsedColumn {
    pub(super) column: usize,
    pub(super) scale: f64,
    /// Whether an empty cell is as good as a number.
    pub(super) optional: bool,
}

/// How a comment names the frame of a sensor: `# frame_id of NAME: FRAME`, or `# frame_id: FRAME` without a name.
pub(super) const FRAME_OF: &str = "frame_id";

impl Layout {
    /// The name of a sensor's frame, where a comment above the header gives it; an empty name for the only sensor.
    #[must_use]
    pub fn frame(&self, sensor: &str) -> Option<&str> {
        self.frames.iter().find(|(of, _)| of == sensor).map(|(_, frame)| frame.as_str())
    }

    pub(super) fn take_frames(&mut self, comments: &[String]) {
        for comment in comments {
            let parts = comment.strip_prefix(FRAME_OF).and_then(|rest| rest.split_once(": "));
            let sensor =
                parts.and_then(|(of, _)| if of.is_empty() { Some("") } else { of.strip_prefix(" of ") });
            if let Some(((_, frame), sensor)) = parts.zip(sensor) {
                self.frames.push((sensor.to_lowercase(), frame.trim().to_owned()));
            }
        }
    }

    /// From the names of the columns.
    ///
    /// # Errors
    /// [`HeaderProblem`] if two columns mean the same or no sensor is complete. Sensors that are
    /// not, beside ones that are, are listed by [`left_out`](Self::left_out).
    pub fn from_header<S: AsRef<str>>(names: &[S], assumed: AssumedUnits) -> Result<Self, HeaderProblem> {
        let columns: Vec<String> =
            names.iter().map(|name| name.as_ref().trim_start_matches('\u{feff}').trim().to_owned()).collect();
        let parsed: Vec<ColumnName> = columns.iter().map(|name| ColumnName::parse(name)).collect();
        let mut layout = Self {
            columns,
            used: Vec::new(),
            time: None,
            wrenches: Vec::new(),
            signals: Vec::new(),
            contacts: None,
            left_out: Vec::new(),
            frames: Vec::new(),
        };
        layout.find_time(&parsed)?;
        let mut sensors: Vec<&str> = Vec::new();
        for column in parsed.iter().filter(|column| column.is_of_sensor()) {
            if !sensors.contains(&column.sensor.as_str()) {
                sensors.push(&column.sensor);
            }
        }
        layout.find_contacts();
        for sensor in sensors {
            layout.find_wrench(sensor, &parsed, assumed)?;
            layout.find_signals(sensor, &parsed)?;
        }
        if layout.wrenches.is_empty() && layout.signals.is_empty() {
            return Err(match layout.left_out.first() {
                Some(left_out) => left_out.problem.clone(),
                None => HeaderProblem::NoSensor { columns: shortened(&layout.columns.join(", "), 120) },
            });
        }
        Ok(layout)
    }

    fn name(&self, column: usize) -> String {
        self.columns.get(column).cloned().unwrap_or_default()
    }

    fn duplicate(&self, first: usize, second: usize) -> HeaderProblem {
        HeaderProblem::Duplicate { first: self.name(first), second: self.name(second) }
    }

    fn find_time(&mut self, parsed: &[ColumnName]) -> Result<(), HeaderProblem> {
        for (column, name) in parsed.iter().enumerate() {
            if let ColumnMeaning::Time(unit) = name.meaning {
                let Some(scale) = unit else {
                    let example = format!("{}_s", self.name(column));
                    return Err(HeaderProblem::MissingUnit { column: self.name(column), example });
                };
                if let Some(first) = self.time.replace(UsedColumn { column, scale, optional: false }) {
                    return Err(self.duplicate(first.column, column));
                }
            }
        }
        Ok(())
    }

    /// All columns of a contact, or none: some of them alone mean something else.
    fn find_contacts(&mut self) {
        let place = |name| self.columns.iter().position(|column| column.eq_ignore_ascii_case(name));
        let found: Vec<usize> = CONTACT_COLUMNS.into_iter().filter_map(place).collect();
        let Ok(mut slots) = <[usize; CONTACT_COLUMNS.len()]>::try_from(found) else { return };
        for slot in &mut slots {
            self.used.push(UsedColumn { column: *slot, scale: 1.0, optional: true });
            *slot = self.used.len() - 1;
        }
        self.contacts = Some(ContactColumns { slots });
    }

    fn find_wrench(
        &mut self,
        sensor: &str,
        parsed: &[ColumnName],
        assumed: AssumedUnits,
    ) -> Result<(), HeaderProblem> {
        let mut axes: [Option<UsedColumn>; 6] = [None; 6];
        let mut problem = None;
        for (column, name) in parsed.iter().enumerate().filter(|(_, name)| name.sensor == sensor) {
            let (axis, scale, unit) = match name.meaning {
                ColumnMeaning::Force(axis, unit) => {
                    (axis, unit.or(assumed.force).map(ForceUnit::in_newtons), "N")
                }
                ColumnMeaning::Torque(axis, unit) => {
                    (axis + 3, unit.or(assumed.torque).map(TorqueUnit::in_newton_metres), "Nm")
                }
                _ => continue,
            };
            let Some(place) = axes.get_mut(axis) else { continue };
            if scale.is_none() && problem.is_none() {
                let example = format!("{}_{unit}", self.name(column));
                problem = Some(HeaderProblem::MissingUnit { column: self.name(column), example });
            }
            if let Some(first) =
                place.replace(UsedColumn { column, scale: scale.unwrap_or(1.0), optional: false })
            {
                return Err(self.duplicate(first.column, column));
            }
        }
        if axes.iter().all(Option::is_none) {
            return Ok(());
        }
        let missing: Vec<&str> = ["fx", "fy", "fz", "tx", "ty", "tz"]
            .iter()
            .zip(&axes)
            .filter_map(|(name, axis)| axis.is_none().then_some(*name))
            .collect();
        if !missing.is_empty() {
            problem =
                Some(HeaderProblem::MissingAxis { sensor: of_sensor(sensor), missing: missing.join(", ") });
        }
        if let Some(problem) = problem {
            self.left_out.push(LeftOut { sensor: sensor.to_owned(), problem });
            return Ok(());
        }
        let mut slots = [0; 6];
        for (slot, axis) in slots.iter_mut().zip(axes.iter().flatten()) {
            *slot = self.used.len();
            self.used.push(*axis);
        }
        self.wrenches.push(WrenchColumns { name: sensor.to_owned(), slots });
        Ok(())
    }

    fn find_signals(&mut self, sensor: &str, parsed: &[ColumnName]) -> Result<(), HeaderProblem> {
        let mut found: Vec<(u32, SignalUnit, UsedColumn)> = Vec::new();
        let mut dummy: Option<(SignalUnit, UsedColumn)> = None;
        for (column, name) in parsed.iter().enumerate().filter(|(_, name)| name.sensor == sensor) {
            match name.meaning {
                ColumnMeaning::Signal(number, unit, scale) => {
                    if let Some((.., first)) = found.iter().find(|(known, ..)| *known == number) {
                        return Err(self.duplicate(first.column, column));
                    }
                    found.push((number, unit, UsedColumn { column, scale, optional: false }));
                }
                ColumnMeaning::Dummy(unit, scale) => {
                    if let Some((_, first)) =
                        dummy.replace((unit, UsedColumn { column, scale, optional: false }))
                    {
                        return Err(self.duplicate(first.column, column));
                    }
                }
                _ => {}
            }
        }
        found.sort_by_key(|(number, ..)| *number);
        let Some((start, unit, first)) = found.first().copied() else { return Ok(()) };
        let hole = (start.min(1)..).zip(&found).find(|(expected, (number, ..))| expected != number);
        let other =
            found.iter().map(|(_, unit, used)| (*unit, *used)).chain(dummy).find(|(other, _)| *other != unit);
        let problem = if let Some((number, _)) = hole {
            Some(HeaderProblem::MissingSignal { sensor: of_sensor(sensor), number })
        } else {
            other.map(|(_, used)| HeaderProblem::MixedUnits {
                first: self.name(first.column),
                second: self.name(used.column),
            })
        };
        if let Some(problem) = problem {
            self.left_out.push(LeftOut { sensor: sensor.to_owned(), problem });
            return Ok(());
        }
        let mut take = |used| {
            self.used.push(used);
            self.used.len() - 1
        };
        let slots = found.iter().map(|(.., used)| take(*used)).collect();
        let dummy = dummy.map(|(_, used)| take(used));
        self.signals.push(SignalColumns { name: sensor.to_owned(), unit, slots, dummy });
        Ok(())
    }

    /// The names of all columns, as in the file.
    #[must_use]
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Whether the rows have a time.
    #[must_use]
    pub const fn has_time(&self) -> bool {
        self.time.is_some()
    }

    /// The wrenches, in the order of their first column.
    #[must_use]
    pub fn wrenches(&self) -> &[WrenchColumns] {
        &self.wrenches
    }

    /// The sensors with signals, in the order of their first column.
    #[must_use]
    pub fn signals(&self) -> &[SignalColumns] {
        &self.signals
    }

    /// The contacts, if the file has them.
    #[must_use]
    pub const fn contacts(&self) -> Option<&ContactColumns> {
        self.contacts.as_ref()
    }

    /// Sensors whose columns are incomplete or without units.
    #[must_use]
    pub fn left_out(&self) -> &[LeftOut] {
        &self.left_out
    }

    /// The names of the columns of a sensor's signals as they stand in the file, its dummy gauge last.
    #[must_use]
    pub fn names_of_signals(&self, columns: &SignalColumns) -> Vec<&str> {
        columns.slots.iter().chain(&columns.dummy).map(|slot| self.name_of(*slot)).collect()
    }

    /// The names of the columns of a wrench as they stand in the file.
    #[must_use]
    pub fn names_of_wrench(&self, columns: &WrenchColumns) -> [&str; 6] {
        columns.slots.map(|slot| self.name_of(slot))
    }

    fn name_of(&self, slot: usize) -> &str {
        let column = self.used.get(slot).map(|used| used.column);
        column.and_then(|column| self.columns.get(column)).map_or("", String::as_str)
    }

    /// Columns that no sensor uses.
    pub fn ignored(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().enumerate().filter_map(|(index, name)| {
            let used = self.used.iter().chain(&self.time).any(|used| used.column == index);
            (!used).then_some(name.as_str())
        })
    }

    /// The wrench of a sensor by its name, whatever its case.
    ///
    /// # Errors
    /// [`HeaderProblem::NoSuchSensor`], or why the sensor of that name was left out.
    pub fn wrench(&self, sensor: &str) -> Result<&WrenchColumns, HeaderProblem> {
        let found = self.wrenches.iter().find(|wrench| wrench.name.eq_ignore_ascii_case(sensor));
        found.ok_or_else(|| self.absent("wrench", sensor, self.wrenches.iter().map(WrenchColumns::name)))
    }

    /// The signals of a sensor by its name, whatever its case.
    ///
    /// # Errors
    /// [`HeaderProblem::NoSuchSensor`], or why the sensor of that name was left out.
    pub fn signals_of(&self, sensor: &str) -> Result<&SignalColumns, HeaderProblem> {
        let found = self.signals.iter().find(|signals| signals.name.eq_ignore_ascii_case(sensor));
        found.ok_or_else(|| self.absent("signals", sensor, self.signals.iter().map(SignalColumns::name)))
    }

    /// The wrench of the only sensor that has one.
    ///
    /// # Errors
    /// [`HeaderProblem`] if there is none, or several to choose from.
    pub fn only_wrench(&self) -> Result<&WrenchColumns, HeaderProblem> {
        match self.wrenches.as_slice() {
            [only] => Ok(only),
            [] => Err(self.absent("wrench", "", core::iter::empty())),
            several => {
                Err(HeaderProblem::SeveralSensors { known: listed(several.iter().map(WrenchColumns::name)) })
            }
        }
    }

    /// The signals of the only sensor that has some.
    ///
    /// # Errors
    /// [`HeaderProblem`] if there is none, or several to choose from.
    pub fn only_signals(&self) -> Result<&SignalColumns, HeaderProblem> {
        match self.signals.as_slice() {
            [only] => Ok(only),
            [] => Err(self.absent("signals", "", core::iter::empty())),
            several => {
                Err(HeaderProblem::SeveralSensors { known: listed(several.iter().map(SignalColumns::name)) })
            }
        }
    }

    fn absent<'a>(
        &self,
        what: &'static str,
        sensor: &str,
        known: impl Iterator<Item = &'a str>,
    ) -> HeaderProblem {
        let left_out = self.left_out.iter().find(|left_out| left_out.sensor.eq_ignore_ascii_case(sensor));
        match left_out {
            Some(left_out) => left_out.problem.clone(),
            None => HeaderProblem::NoSuchSensor { what, sensor: sensor.to_owned(), known: listed(known) },
        }
    }
}

fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> =
        names.map(|name| if name.is_empty() { "(without a name)" } else { name }).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}
