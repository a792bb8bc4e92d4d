//! A criterion over two parameters, as the paper's authors walked it.

use nalgebra::Vector6;

use super::criterion::gram;
use super::{Criterion, DesignError, DesignSpace, NominalLoads, space};

/// Values of a criterion on a grid over two parameters, the others held.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{Criterion, Landscape};
///
/// // The condition number over radius and angle, the distance of the rings held at its best, on a coarse grid.
/// let held = [6.55e-3, 14.45_f64.to_radians(), 13.46e-3];
/// let landscape = Landscape::new(&space, &Criterion::ConditionNumber, &loads, &held, [0, 1], [27, 30])?;
/// let (least, column, row) = landscape.least().ok_or("no sensor")?;
/// // Nothing on it is better than the best, and the least is near to it.
/// assert!(least > 4.18 && least < 4.6);
/// assert!((landscape.xs[column] - 6.55e-3).abs() < 1e-3 && landscape.ys[row] < 0.4);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Landscape {
    /// Number of the parameter along x.
    pub x: usize,
    /// Number of the parameter along y.
    pub y: usize,
    /// Grid along x, `columns` values.
    pub xs: Vec<f64>,
    /// Grid along y, `rows` values.
    pub ys: Vec<f64>,
    /// `values[row][column]`; infinite where there is no sensor.
    pub values: Vec<Vec<f64>>,
}

impl Landscape {
    /// Computes it over the whole range of both parameters.
    ///
    /// # Errors
    /// [`DesignError`] for a space that is not one, a wrong number of values, parameters that are
    /// not there or the same, or fewer than two grid points in a direction.
    pub fn new(
        design: &dyn DesignSpace,
        criterion: &Criterion,
        loads: &NominalLoads,
        held: &[f64],
        axes: [usize; 2],
        [columns, rows]: [usize; 2],
    ) -> Result<Self, DesignError> {
        space::validate(design)?;
        loads.validate()?;
        let parameters = design.parameters();
        let count = parameters.len();
        if held.len() != count {
            return Err(DesignError::WrongCount { what: "parameters", found: held.len(), expected: count });
        }
        let [x, y] = axes;
        let part = |index: usize| {
            parameters.get(index).ok_or(DesignError::NoSuchPart { what: "a landscape", index, count })
        };
        let (along_x, along_y) = (part(x)?, part(y)?);
        if x == y {
            return Err(DesignError::WrongCount { what: "parameters of a landscape", found: 1, expected: 2 });
        }
        if columns.min(rows) < 2 {
            return Err(DesignError::WrongCount {
                what: "grid points",
                found: columns.min(rows),
                expected: 2,
            });
        }
        let grid = |lower: f64, upper: f64, count: usize| -> Vec<f64> {
            (0..count).map(|i| lower + (upper - lower) * i as f64 / (count - 1) as f64).collect()
        };
        let xs = grid(along_x.lower, along_x.upper, columns);
        let ys = grid(along_y.lower, along_y.upper, rows);
        let nominal = loads.components();
        let mut place = held.to_vec();
        let mut response = vec![Vector6::zeros(); design.channels()];
        let values = ys
            .iter()
            .map(|y_value| {
                xs.iter()
                    .map(|x_value| {
                        place[x] = *x_value;
                        place[y] = *y_value;
                        match design.response(&place, &mut response) {
                            Ok(()) => criterion.of(&gram(&response, &nominal)),
                            Err(_) => f64::INFINITY,
                        }
                    })
                    .collect()
            })
            .collect();
        Ok(Self { x, y, xs, ys, values })
    }

    /// The least value, and its column and row.
    #[must_use]
    pub fn least(&self) -> Option<(f64, usize, usize)> {
        let all = self.values.iter().enumerate().flat_map(|(row, values)| {
            values.iter().enumerate().map(move |(column, value)| (*value, column, row))
        });
        all.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

#[cfg(test)]
mod tests {
    use super::Landscape;
    use crate::design::test_spaces::paper;
    use crate::design::{Criterion, NominalLoads};

    #[test]
    fn grid_through_the_optimum_has_it_as_its_least() {
        let loads = NominalLoads::equal(10.0, 0.1).unwrap();
        let optimum = [6.546e-3, 14.451_f64.to_radians(), 13.462e-3];
        let found =
            Landscape::new(&paper(), &Criterion::ConditionNumber, &loads, &optimum, [0, 1], [131, 117])
                .unwrap();
        let (least, column, row) = found.least().unwrap();
        assert!((4.182..4.3).contains(&least), "{least}");
        assert!((found.xs[column] - optimum[0]).abs() < 0.3e-3);
        assert!((found.ys[row] - optimum[1]).abs() < 0.03);
    }

    #[test]
    fn refuses_what_is_no_landscape() {
        let loads = NominalLoads::equal(10.0, 0.1).unwrap();
        let make =
            |held: &[f64], axes, size| Landscape::new(&paper(), &Criterion::Trace, &loads, held, axes, size);
        let held = [6e-3, 0.2, 10e-3];
        assert!(make(&held, [0, 0], [4, 4]).is_err());
        assert!(make(&held, [0, 3], [4, 4]).is_err());
        assert!(make(&held[..2], [0, 1], [4, 4]).is_err());
        assert!(make(&held, [0, 1], [1, 4]).is_err());
    }
}
