//! What the name of a column says: the one grammar of recordings and of tables of loads.

use fingertip_wrench::units::{ForceUnit, TorqueUnit};

use crate::unit::{SignalUnit, acceleration_unit, seconds, turning_unit};

/// A column, as far as its name tells: a quantity, its unit, and what tells sensors apart, in any order of words.
///
/// ```
/// use fingertip_recordings::{ColumnMeaning, ColumnName, ForceUnit};
///
/// let name = ColumnName::parse("S1_Fx (mN)");
/// assert_eq!(name.sensor, "s1");
/// assert_eq!(name.meaning, ColumnMeaning::Force(0, Some(ForceUnit::Millinewton)));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnName {
    /// What tells sensors apart, lower case; empty if nothing does.
    pub sensor: String,
    /// The quantity.
    pub meaning: ColumnMeaning,
}

/// The quantity of a column.
///
/// ```
/// use fingertip_recordings::{ColumnMeaning, ColumnName, ForceUnit, SignalUnit};
///
/// let meaning = |name: &str| ColumnName::parse(name).meaning;
/// assert_eq!(meaning("Fz_N"), ColumnMeaning::Force(2, Some(ForceUnit::Newton)));
/// assert_eq!(meaning("t_ms"), ColumnMeaning::Time(Some(1e-3)));
/// assert_eq!(meaning("v3_mV"), ColumnMeaning::Signal(3, SignalUnit::Volt, 1e-3));
/// assert_eq!(meaning("fz"), ColumnMeaning::Force(2, None)); // newtons, pounds? it does not say
/// assert_eq!(meaning("weather"), ColumnMeaning::Other);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColumnMeaning {
    /// Time; seconds per unit, if the unit is known.
    Time(Option<f64>),
    /// Axis 0..3 of the force.
    Force(usize, Option<ForceUnit>),
    /// Axis 0..3 of the torque.
    Torque(usize, Option<TorqueUnit>),
    /// A signal by its number, with the value of one unit.
    Signal(u32, SignalUnit, f64),
    /// The dummy gauge.
    Dummy(SignalUnit, f64),
    /// Axis 0..3 of an accelerometer; m/s² per unit, if the unit is known.
    Acceleration(usize, Option<f64>),
    /// Axis 0..3 of a gyroscope; rad/s per unit, if the unit is known.
    AngularVelocity(usize, Option<f64>),
    /// Another quantity, which this grammar does not know.
    Other,
}

impl ColumnName {
    /// Whether it is a force, torque, signal or dummy gauge.
    pub(crate) const fn is_of_sensor(&self) -> bool {
        matches!(
            self.meaning,
            ColumnMeaning::Force(..)
                | ColumnMeaning::Torque(..)
                | ColumnMeaning::Signal(..)
                | ColumnMeaning::Dummy(..)
        )
    }

    /// Takes a name apart.
    #[must_use]
    pub fn parse(name: &str) -> Self {
        let words = words(name);
        let other = || Self { sensor: String::new(), meaning: ColumnMeaning::Other };
        if let Some((at, length, axis, torque)) = find_axis(&words) {
            // The unit stands behind the axis, last.
            let mut end = words.len();
            let behind = words.get(at + length..).unwrap_or_default();
            let meaning = match (torque, behind.last()) {
                (false, Some(last)) if ForceUnit::from_name(last).is_some() => {
                    end -= 1;
                    ColumnMeaning::Force(axis, ForceUnit::from_name(last))
                }
                (false, _) => ColumnMeaning::Force(axis, None),
                (true, Some(_)) => {
                    let (unit, used) = torque_unit(behind);
                    end -= used;
                    ColumnMeaning::Torque(axis, unit)
                }
                (true, None) => ColumnMeaning::Torque(axis, None),
            };
            return Self { sensor: join(&words, at, length, end), meaning };
        }
        if let [word, rest @ ..] = words.as_slice()
            && matches!(word.as_str(), "t" | "time" | "timestamp" | "stamp")
        {
            return match rest {
                [] => Self { sensor: String::new(), meaning: ColumnMeaning::Time(None) },
                [unit] if seconds(unit).is_some() => {
                    Self { sensor: String::new(), meaning: ColumnMeaning::Time(seconds(unit)) }
                }
                _ => other(),
            };
        }
        if let Some((at, length, axis, turns)) = find_inertial(&words) {
            let behind = words.get(at + length..).unwrap_or_default();
            let (unit, used) = inertial_unit(behind, turns);
            let meaning = if turns {
                ColumnMeaning::AngularVelocity(axis, unit)
            } else {
                ColumnMeaning::Acceleration(axis, unit)
            };
            return Self { sensor: join(&words, at, length, words.len() - used), meaning };
        }
        let (unit, scale, used) = signal_unit(&words);
        let end = words.len() - used;
        let named = words.get(..end).unwrap_or_default();
        if let Some(at) = named.iter().position(|word| word == "dummy") {
            return Self { sensor: join(&words, at, 1, end), meaning: ColumnMeaning::Dummy(unit, scale) };
        }
        // The last one that fits, so that `s1_v0` is signal 0 of sensor `s1`.
        let found = named.iter().enumerate().rev().find_map(|(at, word)| Some((at, signal_number(word)?)));
        match found {
            Some((at, number)) => {
                Self { sensor: join(&words, at, 1, end), meaning: ColumnMeaning::Signal(number, unit, scale) }
            }
            None => other(),
        }
    }
}

/// Lower-case words, parted by anything that parts words in headers.
fn words(name: &str) -> Vec<String> {
    name.trim_start_matches('\u{feff}')
        .split(['_', '(', ')', '[', ']', '/', ':', ' ', '\t', ',', ';'])
        .flat_map(|word| {
            // `force.x` parts words, `N.m` does not.
            let dotted = word
                .split('.')
                .any(|part| part.eq_ignore_ascii_case("force") || part.eq_ignore_ascii_case("torque"));
            if dotted { word.split('.').collect::<Vec<_>>() } else { vec![word] }
        })
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
        .collect()
}

/// Where the axis stands: index, how many words it takes, axis, whether it is of the torque.
fn find_axis(words: &[String]) -> Option<(usize, usize, usize, bool)> {
    let letter = |word: &str| ["x", "y", "z"].iter().position(|axis| *axis == word);
    words.iter().enumerate().find_map(|(at, word)| {
        let next = words.get(at + 1).and_then(|next| letter(next));
        match (word.as_str(), next) {
            ("force" | "f", Some(axis)) => return Some((at, 2, axis, false)),
            ("torque" | "moment", Some(axis)) => return Some((at, 2, axis, true)),
            _ => {}
        }
        let mut letters = word.chars();
        let (kind, axis) = (letters.next()?, letter(letters.as_str())?);
        match kind {
            'f' => Some((at, 1, axis, false)),
            't' | 'm' => Some((at, 1, axis, true)),
            _ => None,
        }
    })
}

/// Where the axis of an accelerometer (`ax`, `acc_x`) or a gyroscope (`wx`, `gyro_x`) stands: index, how many words it
/// takes, axis, whether it is of the gyroscope.
fn find_inertial(words: &[String]) -> Option<(usize, usize, usize, bool)> {
    let letter = |word: &str| ["x", "y", "z"].iter().position(|axis| *axis == word);
    words.iter().enumerate().find_map(|(at, word)| {
        let next = words.get(at + 1).and_then(|next| letter(next));
        match (word.as_str(), next) {
            ("acc" | "accel" | "acceleration", Some(axis)) => return Some((at, 2, axis, false)),
            ("gyro" | "gyroscope" | "omega", Some(axis)) => return Some((at, 2, axis, true)),
            _ => {}
        }
        let mut letters = word.chars();
        let (kind, axis) = (letters.next()?, letter(letters.as_str())?);
        match kind {
            'a' => Some((at, 1, axis, false)),
            'w' => Some((at, 1, axis, true)),
            _ => None,
        }
    })
}

/// A unit of acceleration or of angular velocity at the end of the words, in SI, and how many words it takes
/// (`m per s2`: three).
fn inertial_unit(behind: &[String], turns: bool) -> (Option<f64>, usize) {
    (1..=behind.len().min(3))
        .rev()
        .find_map(|count| {
            let name = behind.get(behind.len() - count..)?.join("/").replace("/per/", "/");
            let size = if turns { turning_unit(&name) } else { acceleration_unit(&name) };
            size.map(|size| (Some(size), count))
        })
        .unwrap_or((None, 0))
}

/// A unit of torque at the end of the words, and how many words it takes (`n m`, `lbf in`: two).
fn torque_unit(behind: &[String]) -> (Option<TorqueUnit>, usize) {
    if let [.., first, second] = behind
        && let Some(unit) = TorqueUnit::from_name(&format!("{first}{second}"))
    {
        return (Some(unit), 2);
    }
    match behind.last().and_then(|last| TorqueUnit::from_name(last)) {
        Some(unit) => (Some(unit), 1),
        None => (None, 0),
    }
}

/// A unit of signals at the end of the words, and how many words it takes (`mv v`: two).
fn signal_unit(words: &[String]) -> (SignalUnit, f64, usize) {
    let known = match words {
        [_, .., first, second] => SignalUnit::from_name(&format!("{first}/{second}")).map(|known| (known, 2)),
        _ => None,
    };
    let last = || match words {
        [_, .., last] => SignalUnit::from_name(last).map(|known| (known, 1)),
        _ => None,
    };
    known.or_else(last).map_or((SignalUnit::Unstated, 1.0, 0), |((unit, scale), used)| (unit, scale, used))
}

/// The number of `v3`, `s0`, `ch12`, `gauge1`, `sg6`.
fn signal_number(word: &str) -> Option<u32> {
    let digits = word.find(|c: char| c.is_ascii_digit())?;
    let (name, number) = word.split_at(digits);
    if matches!(name, "v" | "s" | "ch" | "channel" | "g" | "gauge" | "sg" | "signal") {
        number.parse().ok()
    } else {
        None
    }
}

/// The words that are neither the axis nor the unit.
fn join(words: &[String], at: usize, length: usize, end: usize) -> String {
    let kept = words.iter().take(end).enumerate().filter(|(index, _)| *index < at || *index >= at + length);
    kept.map(|(_, word)| word.as_str()).collect::<Vec<_>>().join("_")
}
