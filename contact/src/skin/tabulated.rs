//! A measured law.

use core::marker::PhantomData;

use fingertip_surfaces::BadShape;
use fingertip_wrench::Real;

use super::Indentation;

/// Measured points of depth and patch radius over force, with straight lines between them, from
/// zero to the first, and beyond the last with the slope before it. `P` holds the points: an array, a list or a
/// slice.
///
/// ```
/// use fingertip_contact::Tabulated;
///
/// // Measured: force \[N\], depth \[m\], radius of the patch \[m\].
/// let law = Tabulated::new([[1.0, 2.0e-4, 1.0e-3], [2.0, 3.0e-4, 1.4e-3], [4.0, 4.0e-4, 1.8e-3]])?;
/// assert!((law.indentation(1.5).depth - 2.5e-4_f64).abs() < 1e-12);
/// // Beyond the last point it goes on as between the last two.
/// assert!((law.indentation(6.0).depth - 5.0e-4).abs() < 1e-12);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tabulated<T: Real, P: AsRef<[[T; 3]]>> {
    /// Force \[N\], depth \[m\], patch radius \[m\].
    points: P,
    scalar: PhantomData<T>,
}

impl<T: Real, P: AsRef<[[T; 3]]>> Tabulated<T, P> {
    /// From `[force (N), depth (m), patch radius (m)]` of each point.
    ///
    /// # Errors
    /// [`BadShape`] unless there is a point, all numbers are positive and finite, forces grow from
    /// point to point, and depths and radii do not fall.
    pub fn new(points: P) -> Result<Self, BadShape> {
        let mut good = !points.as_ref().is_empty();
        let mut before = [T::zero(); 3];
        for &point in points.as_ref() {
            let [force, depth, radius] = point;
            good &= force > before[0] && depth >= before[1] && radius >= before[2];
            good &= (force + depth + radius).is_number();
            before = point;
        }
        BadShape::check(
            "tabulated skin",
            "points",
            "positive, finite and sorted by force, with depths and radii that do not fall",
            good,
        )
        .map(|()| Self { points, scalar: PhantomData })
    }

    /// The two points between which a force lies, or the last two.
    fn stretch(&self, normal_force: T) -> [[T; 3]; 2] {
        let points = self.points.as_ref();
        let last = points.len().saturating_sub(1);
        let after = points.partition_point(|point| point[0] < normal_force).min(last);
        let point =
            |index: Option<usize>| index.and_then(|i| points.get(i)).copied().unwrap_or([T::zero(); 3]);
        [point(after.checked_sub(1)), point(Some(after))]
    }

    /// The indentation under a normal force \[N\].
    #[must_use]
    pub fn indentation(&self, normal_force: T) -> Indentation<T> {
        let [lower, upper] = self.stretch(normal_force);
        let share = (normal_force - lower[0]) / (upper[0] - lower[0]);
        let between =
            |column: usize| (lower[column] + (upper[column] - lower[column]) * share).min(T::GREATEST);
        Indentation { depth: between(1), patch: [between(2); 2] }
    }

    /// How fast the depth grows with the normal force \[m/N\]: the slope of the straight line that the force is
    /// on; at a point of the table, of the one below.
    #[must_use]
    pub fn compliance(&self, normal_force: T) -> T {
        let [lower, upper] = self.stretch(normal_force);
        (upper[1] - lower[1]) / (upper[0] - lower[0])
    }
}

#[cfg(test)]
mod tests {
    use super::Tabulated;

    #[test]
    fn meets_its_points_and_lines_between_and_beyond() {
        let law = Tabulated::new([[1.0_f64, 0.1, 1.0], [3.0, 0.2, 1.5]]).unwrap();
        for (force, depth, radius) in [
            (0.0, 0.0, 0.0),
            (0.5, 0.05, 0.5),
            (1.0, 0.1, 1.0),
            (2.0, 0.15, 1.25),
            (3.0, 0.2, 1.5),
            (5.0, 0.3, 2.0),
        ] {
            let found = law.indentation(force);
            assert!(
                (found.depth - depth).abs() < 1e-15 && (found.patch[0] - radius).abs() < 1e-15,
                "{force}"
            );
        }
        assert!(Tabulated::new([[1.0, 0.1, 1.0], [1.0, 0.2, 1.5]]).is_err());
        assert!(Tabulated::<f64, [[f64; 3]; 0]>::new([]).is_err());
        assert!(Tabulated::new([[1.0, f64::NAN, 1.0]]).is_err());
    }
}
