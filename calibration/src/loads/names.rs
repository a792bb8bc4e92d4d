//! What samples are called.

use alloc::borrow::Cow;
use core::fmt;

/// What the samples of a table are called in reports: names of their own, or a word and a number, of which a million take
/// eight megabytes and no text before one is said.
///
/// ```
/// use fingertip_calibration::loads::Names;
///
/// let lines = Names::numbered("line", [2, 3, 5]);
/// assert_eq!((lines.len(), &*lines.get(2)), (3, "line 5"));
/// let own = Names::from(vec!["up".to_owned(), "down".to_owned()]);
/// assert_eq!(own.iter().collect::<Vec<_>>(), ["up", "down"]);
/// // One that there is not is called by its place.
/// assert_eq!(own.get(7), "sample 8");
/// ```
#[derive(Clone)]
pub struct Names(Kind);

#[derive(Clone)]
enum Kind {
    Own(Vec<String>),
    Numbered { word: &'static str, numbers: Vec<u64> },
}

impl Names {
    /// Called by a word and numbers.
    pub fn numbered(word: &'static str, numbers: impl IntoIterator<Item = u64>) -> Self {
        Self(Kind::Numbered { word, numbers: numbers.into_iter().collect() })
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match &self.0 {
            Kind::Own(names) => names.len(),
            Kind::Numbered { numbers, .. } => numbers.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What the sample at this place is called; `sample N`, counted from 1, beyond the last.
    #[must_use]
    pub fn get(&self, sample: usize) -> Cow<'_, str> {
        let name = match &self.0 {
            Kind::Own(names) => names.get(sample).map(|name| Cow::Borrowed(name.as_str())),
            Kind::Numbered { word, numbers } => {
                numbers.get(sample).map(|number| Cow::Owned(format!("{word} {number}")))
            }
        };
        name.unwrap_or_else(|| Cow::Owned(format!("sample {}", sample.saturating_add(1))))
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl Iterator<Item = Cow<'_, str>> {
        (0..self.len()).map(|sample| self.get(sample))
    }

    /// Puts others behind them.
    pub fn append(&mut self, others: &Self) {
        match (&mut self.0, &others.0) {
            (Kind::Numbered { word, numbers }, Kind::Numbered { word: other, numbers: more })
                if word == other =>
            {
                numbers.extend(more);
            }
            _ => *self = self.iter().chain(others.iter()).map(Cow::into_owned).collect(),
        }
    }

    /// Those of these samples.
    #[must_use]
    pub fn select(&self, samples: &[usize]) -> Self {
        Self(match &self.0 {
            Kind::Own(_) => Kind::Own(samples.iter().map(|sample| self.get(*sample).into_owned()).collect()),
            Kind::Numbered { word, numbers } => {
                let numbers = samples.iter().filter_map(|sample| numbers.get(*sample).copied()).collect();
                Kind::Numbered { word, numbers }
            }
        })
    }
}

/// None.
impl Default for Names {
    fn default() -> Self {
        Self(Kind::Own(Vec::new()))
    }
}

impl From<Vec<String>> for Names {
    fn from(names: Vec<String>) -> Self {
        Self(Kind::Own(names))
    }
}

impl<S: Into<String>> FromIterator<S> for Names {
    fn from_iter<I: IntoIterator<Item = S>>(names: I) -> Self {
        Self(Kind::Own(names.into_iter().map(Into::into).collect()))
    }
}

/// Names are the same if they say the same.
impl PartialEq for Names {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Kind::Numbered { word, numbers }, Kind::Numbered { word: other, numbers: others }) => {
                numbers == others && (word == other || numbers.is_empty())
            }
            _ => self.len() == other.len() && self.iter().eq(other.iter()),
        }
    }
}

impl Eq for Names {}

impl fmt::Debug for Names {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::Names;

    #[test]
    fn names_are_the_same_if_they_say_the_same() {
        let numbered = Names::numbered("line", [2, 4]);
        let own: Names = ["line 2", "line 4"].into_iter().collect();
        assert_eq!(numbered, own);
        assert_eq!(own, numbered);
        assert_eq!(numbered, Names::numbered("line", [2, 4]));
        for other in [
            Names::numbered("sample", [2, 4]),
            Names::numbered("line", [2]),
            ["line 2", "line 5"].into_iter().collect(),
        ] {
            assert_eq!([numbered == other, own == other, other == own], [false; 3], "{other:?}");
        }
        assert!(Names::numbered("line", []) == Vec::new().into() && Names::numbered("line", []).is_empty());
        assert_eq!(format!("{numbered:?}"), r#"["line 2", "line 4"]"#);
    }

    #[test]
    fn names_are_put_one_behind_the_other() {
        let own: Names = ["up"].into_iter().collect();
        let mut lines = Names::numbered("line", [2, 3]);
        lines.append(&Names::numbered("line", [2]));
        assert!(matches!(lines.0, super::Kind::Numbered { .. }));
        assert_eq!(lines.iter().collect::<Vec<_>>(), ["line 2", "line 3", "line 2"]);
        lines.append(&own);
        assert_eq!(lines.iter().collect::<Vec<_>>(), ["line 2", "line 3", "line 2", "up"]);
    }

    #[test]
    fn those_that_are_chosen_keep_their_names() {
        for names in
            [Names::numbered("line", [2, 4, 9]), ["line 2", "line 4", "line 9"].into_iter().collect()]
        {
            let chosen = names.select(&[2, 0]);
            assert_eq!((chosen.len(), &*chosen.get(0), &*chosen.get(1)), (2, "line 9", "line 2"));
            assert_eq!(chosen.get(2), "sample 3");
        }
    }
}
