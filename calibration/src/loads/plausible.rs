//! What is odd about a table of loads before anything is fitted to it.

use nalgebra::Vector3;

use super::LoadTable;
use crate::Axis;

/// Lever arms below this \[m\] are those of torques in the wrong unit, not of loads that people apply.
const SHORTEST_ARM: f64 = 1e-4;
/// And so are those above this \[m\].
const LONGEST_ARM: f64 = 2.0;
/// Forces below this share of the greatest tell no lever arm.
const LEAST_FORCE: f64 = 0.2;
/// Forces above this \[N\] are none of a fingertip. People pinch with up to some 100 N (Mathiowetz et al. 1985), and of the
/// sensors that fit behind a robot's fingertip the strongest, ATI's Nano25, is made in full for 1000 N.
const GREATEST_FORCE: f64 = 1e3;
/// Torques above this \[N·m\] neither: such a force at a lever arm of 0.1 m, longer than a finger.
const GREATEST_TORQUE: f64 = 1e2;
/// Fewer loads tell nothing.
const FEWEST: usize = 5;

impl LoadTable {
    /// Gauges whose reading never changes while another's does, counting from 0, and what they read.
    #[must_use]
    pub fn dead_gauges(&self) -> Vec<(usize, f64)> {
        let is_constant =
            |gauge: usize| self.signals.column(gauge).iter().all(|v| *v == self.signals[(0, gauge)]);
        if self.samples() < 3 {
            return Vec::new();
        }
        let constant: Vec<usize> = (0..self.gauges()).filter(|gauge| is_constant(*gauge)).collect();
        if constant.len() == self.gauges() {
            return Vec::new();
        }
        constant.into_iter().map(|gauge| (gauge, self.signals[(0, gauge)])).collect()
    }

    /// The same table without the components that no sample loads, and which these are. A table without any load stays
    /// as it is.
    #[must_use]
    pub fn of_loaded_axes(self) -> (Self, Vec<Axis>) {
        let is_loaded = |axis: &usize| self.loads.column(*axis).iter().any(|load| *load != 0.0);
        let loaded: Vec<usize> = (0..self.axes.len()).filter(is_loaded).collect();
        if loaded.is_empty() || loaded.len() == self.axes.len() {
            return (self, Vec::new());
        }
        let unloaded =
            (0..self.axes.len()).filter(|axis| !loaded.contains(axis)).map(|axis| self.axes[axis]).collect();
        let axes = loaded.iter().map(|axis| self.axes[*axis]).collect();
        let loads = self.loads.select_columns(&loaded);
        (Self { axes, loads, ..self }, unloaded)
    }

    /// What is odd about the sizes of the loads: a force or a torque above what any fingertip feels. `None` if
    /// nothing is.
    #[must_use]
    pub fn odd_sizes(&self) -> Option<String> {
        let greatest =
            self.axes.iter().zip(self.loads.column_iter()).map(|(axis, loads)| (*axis, loads.amax()));
        let limit = |axis: Axis| if axis.is_torque() { GREATEST_TORQUE } else { GREATEST_FORCE };
        let over = |(axis, load): &(Axis, f64)| load / limit(*axis);
        let (axis, load) = greatest.max_by(|a, b| over(a).total_cmp(&over(b))).filter(|it| over(it) > 1.0)?;
        let (kind, unit) = (if axis.is_torque() { "torque" } else { "force" }, axis.unit());
        let load = if load < 1e6 { format!("{load}") } else { format!("{load:e}") };
        Some(format!(
            "the greatest {} is {load} {unit}, and no fingertip feels a {kind} above {} {unit}: is the unit in the \
             column's name right?",
            axis.name(),
            limit(axis)
        ))
    }

    /// Why the torques seem to be in another unit than their column says: by the distances of the forces' lines from the
    /// origin. `None` if nothing is odd, or if there are pure torques, whose size nothing tells.
    #[must_use]
    pub fn odd_lever_arms(&self) -> Option<String> {
        if self.axes != Axis::ALL {
            return None;
        }
        let parts = |i: usize| {
            let at = |j: usize| self.loads[(i, j)];
            (Vector3::new(at(0), at(1), at(2)), Vector3::new(at(3), at(4), at(5)))
        };
        let greatest = (0..self.samples()).map(|i| parts(i).0.norm()).fold(0.0, f64::max);
        let mut arms = Vec::new();
        for (force, torque) in (0..self.samples()).map(parts).filter(|(_, torque)| torque.norm() > 0.0) {
            if force.norm() < 0.01 * greatest {
                return None;
            }
            if force.norm() > LEAST_FORCE * greatest {
                arms.push(force.cross(&torque).norm() / force.norm_squared());
            }
        }
        if arms.len() < FEWEST {
            return None;
        }
        arms.sort_by(f64::total_cmp);
        let (middle, longest) = (arms[arms.len() / 2], arms[arms.len() - 1]);
        if longest < SHORTEST_ARM {
            return Some(format!(
                "all forces act within {:.3} mm of the origin: the torques seem to be N·m in columns of N·mm, a thousand times \
                 too small",
                1e3 * longest
            ));
        }
        (middle > LONGEST_ARM).then(|| {
            format!(
                "half of the forces act more than {middle:.1} m from the origin: the torques seem to be N·mm in columns of N·m, a \
                 thousand times too large"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, Vector3};

    use crate::Axis;
    use crate::file::SignalUnit;
    use crate::loads::LoadTable;

    /// Forces at some centimetres, with torques of a unit of this size.
    fn table(size: f64) -> LoadTable {
        let loads: Vec<f64> = (0..20)
            .flat_map(|i| {
                let angle = f64::from(i);
                let force = Vector3::new(5.0 * angle.sin(), 4.0, 6.0 * angle.cos());
                let at = Vector3::new(0.01 * (2.0 * angle).cos(), 0.02 * angle.sin(), 0.015);
                let torque = at.cross(&force) * size;
                [force.x, force.y, force.z, torque.x, torque.y, torque.z]
            })
            .collect();
        let loads = DMatrix::from_row_slice(20, 6, &loads);
        let signals = DMatrix::from_fn(20, 7, |i, j| if j == 4 { 0.25 } else { (i * (j + 1)) as f64 });
        LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap()
    }

    #[test]
    fn torques_in_another_unit_are_seen_by_their_lever_arms() {
        assert_eq!(table(1.0).odd_lever_arms(), None);
        assert!(table(1e-3).odd_lever_arms().unwrap().contains("N·m in columns of N·mm"));
        assert!(table(1e3).odd_lever_arms().unwrap().contains("N·mm in columns of N·m"));
        // Pure torques have no lever arm.
        let mut pure = table(1e-3);
        pure.loads.row_mut(3).copy_from_slice(&[0.0, 0.0, 0.0, 0.1, 0.0, 0.0]);
        assert_eq!(pure.odd_lever_arms(), None);
        // One of another unit among many says nothing of the others, wherever it stands.
        let mut one = table(1.0);
        for axis in 3..6 {
            one.loads[(10, axis)] *= 1e6;
        }
        assert_eq!(one.odd_lever_arms(), None);
        // Forces through the origin have no torque at all.
        assert_eq!(table(0.0).odd_lever_arms(), None);
    }

    #[test]
    fn loads_that_no_fingertip_feels_are_odd() {
        assert_eq!(table(1.0).odd_sizes(), None);
        let with = |axis: usize, load: f64| {
            let mut table = table(1.0);
            table.loads[(3, axis)] = load;
            table.odd_sizes()
        };
        assert_eq!((with(2, -1000.0), with(4, 100.0)), (None, None));
        assert!(
            with(2, -1001.0)
                .unwrap()
                .starts_with("the greatest fz is 1001 N, and no fingertip feels a force above")
        );
        assert!(
            with(4, 101.0)
                .unwrap()
                .starts_with("the greatest ty is 101 N·m, and no fingertip feels a torque above")
        );
        // Numbers that are long to read are written with a power of ten.
        assert!(with(0, 999_999.0).unwrap().starts_with("the greatest fx is 999999 N, "));
        assert!(with(0, 1e6).unwrap().starts_with("the greatest fx is 1e6 N, "));
        assert!(with(0, 1e8).unwrap().starts_with("the greatest fx is 1e8 N, "));
        // The oddest is told of.
        let mut both = table(1.0);
        (both.loads[(1, 0)], both.loads[(2, 5)]) = (2e3, 1e4);
        assert!(both.odd_sizes().unwrap().starts_with("the greatest tz is 10000 N·m, "));
    }

    #[test]
    fn dead_gauges_and_axes_without_load_are_found() {
        let mut table = table(1.0);
        assert_eq!(table.dead_gauges(), [(4, 0.25)]);
        table.loads.column_mut(2).fill(0.0);
        table.loads.column_mut(5).fill(0.0);
        let (loaded, unloaded) = table.clone().of_loaded_axes();
        assert_eq!(unloaded, [Axis::Fz, Axis::Tz]);
        assert_eq!((loaded.axes, loaded.loads.ncols()), (vec![Axis::Fx, Axis::Fy, Axis::Tx, Axis::Ty], 4));
        table.loads.fill(0.0);
        assert_eq!(table.clone().of_loaded_axes(), (table.clone(), Vec::new()));
        table.signals.fill(1.0);
        assert_eq!(table.dead_gauges(), []);
    }
}
