//! What the fingers of a hand can give: from arguments.

use fingertip::hand::FingerLimits;
use nalgebra::Vector6;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::hand::MOST;
use crate::{errors, numbers};

/// Most joints of a finger.
const JOINTS: usize = 6;
/// Half-spaces that limit a finger: of its least and its greatest normal force, and two of each joint.
pub(crate) const ROWS: usize = 2 + 2 * JOINTS;

/// A number for all fingers, or one for each.
#[derive(Clone, Debug, FromPyObject)]
pub(crate) enum Each {
    #[pyo3(transparent, annotation = "float")]
    All(f64),
    #[pyo3(transparent, annotation = "sequence of float")]
    Every(Vec<f64>),
}

impl Each {
    fn spread(&self, what: &str, fingers: Option<usize>, fill: f64) -> PyResult<[f64; MOST]> {
        let mut all = [fill; MOST];
        match self {
            Self::All(number) => all = [*number; MOST],
            Self::Every(each) => {
                fits(what, each.len(), fingers)?;
                all.iter_mut().zip(each).for_each(|(to, from)| *to = *from);
            }
        }
        Ok(all)
    }
}

/// Of each finger the Jacobian, shape (6, joints), and the greatest torques; `None` for one without limits.
pub(crate) type Joints<'py> = Vec<Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>>;

/// That there is one for each finger, where their number is known.
fn fits(what: &str, found: usize, fingers: Option<usize>) -> PyResult<()> {
    if fingers.map_or(found <= MOST, |fingers| found == fingers) {
        return Ok(());
    }
    let most = fingers.unwrap_or(MOST);
    Err(errors::hand(format!("`{what}` has {found} entries, for {most} fingers")))
}

/// Limits as they were given.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Given {
    least: [f64; MOST],
    greatest: Option<[f64; MOST]>,
    cost: [f64; MOST],
    joints: [Vec<([f64; 6], f64)>; MOST],
}

impl Given {
    /// `fingers` is how many there are, where that is known.
    pub(crate) fn read(
        fingers: Option<usize>,
        least: &Each,
        greatest: Option<&Each>,
        cost: &Each,
        joints: Option<Joints<'_>>,
    ) -> PyResult<Self> {
        let mut each: [Vec<_>; MOST] = Default::default();
        let given = joints.unwrap_or_default();
        if !given.is_empty() {
            fits("joints", given.len(), fingers)?;
        }
        for (to, given) in each.iter_mut().zip(given) {
            if let Some((jacobian, torques)) = given {
                *to = of_finger(&jacobian, &torques)?;
            }
        }
        Ok(Self {
            least: least.spread("least", fingers, 0.0)?,
            greatest: greatest.map(|each| each.spread("greatest", fingers, f64::INFINITY)).transpose()?,
            cost: cost.spread("cost", fingers, 1.0)?,
            joints: each,
        })
    }

    /// A least force that is not positive and a greatest one that is infinite are no limits.
    pub(crate) fn limits(&self) -> PyResult<[FingerLimits<f64, ROWS>; MOST]> {
        let mut all = [FingerLimits::none(); MOST];
        for (finger, limits) in all.iter_mut().enumerate() {
            let bad = |error| errors::hand(format!("finger {finger}: {error}"));
            let of = |each: &[f64; MOST]| each.get(finger).copied();
            if let Some(least) = of(&self.least).filter(|least| !(*least <= 0.0)) {
                *limits = limits.with_least_normal(least).map_err(bad)?;
            }
            if let Some(greatest) = self.greatest.as_ref().and_then(of).filter(|most| *most != f64::INFINITY)
            {
                *limits = limits.with_greatest_normal(greatest).map_err(bad)?;
            }
            *limits = limits.with_cost(of(&self.cost).unwrap_or(1.0)).map_err(bad)?;
            for (column, torque) in self.joints.get(finger).into_iter().flatten() {
                *limits = limits.with_joint(&Vector6::from(*column), *torque).map_err(bad)?;
            }
        }
        Ok(all)
    }
}

fn of_finger(jacobian: &Bound<'_, PyAny>, torques: &Bound<'_, PyAny>) -> PyResult<Vec<([f64; 6], f64)>> {
    let (table, torques) = (numbers::table(jacobian, "jacobian")?, numbers::list(torques, "torques")?);
    if table.nrows() != 6 || table.ncols() != torques.len() || torques.len() > JOINTS {
        let (rows, columns) = table.shape();
        return Err(errors::hand(format!(
            "a Jacobian has six rows and a column for each torque, {JOINTS} at most, not {rows} × {columns} for {} torques",
            torques.len()
        )));
    }
    let column = |column: usize| core::array::from_fn(|row| table[(row, column)]);
    Ok(torques.into_iter().enumerate().map(|(joint, torque)| (column(joint), torque)).collect())
}
