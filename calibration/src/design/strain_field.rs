//! Structures known by their compliance: results of finite elements, or of a measurement.

use core::f64::consts::PI;

use nalgebra::{Matrix3x6, Vector6};

use super::{Bridge, DesignError, DesignSpace, Parameter};

/// A place on the surface of a structure where a gauge may be glued: the plane strain there, per
/// unit load.
///
/// Rows are ε_x, ε_y, γ_xy in a tangent frame of the surface; columns Fx, Fy, Fz, Tx, Ty, Tz
/// \[1/N, 1/(N·m)\]. It is what six unit load cases of a finite-element program give at a node.
///
/// ```
/// use fingertip_calibration::design::StrainSite;
/// use fingertip_calibration::nalgebra::Matrix3x6;
///
/// // Under 1 N along x a surface is stretched by 3 millionths along x and shortened by 1 across; ν is about ⅓.
/// let mut site = StrainSite { strains: Matrix3x6::zeros() };
/// (site.strains[(0, 0)], site.strains[(1, 0)]) = (3e-6, -1e-6);
/// let along = site.gauge(0.0)[0];
/// let across = site.gauge(core::f64::consts::FRAC_PI_2)[0];
/// let aslant = site.gauge(core::f64::consts::FRAC_PI_4)[0];
/// assert!((along - 3e-6).abs() < 1e-18 && (across + 1e-6).abs() < 1e-18 && (aslant - 1e-6).abs() < 1e-18);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrainSite {
    /// The compliance.
    pub strains: Matrix3x6<f64>,
}

impl StrainSite {
    /// Strain of a gauge turned by `angle` \[rad\] from the site's x axis towards its y axis, per
    /// unit load: `ε_x cos² + ε_y sin² + γ_xy sin cos`.
    #[must_use]
    pub fn gauge(&self, angle: f64) -> Vector6<f64> {
        let (sin, cos) = angle.sin_cos();
        let [x, y, xy] = [0, 1, 2].map(|row| self.strains.row(row).transpose());
        x * (cos * cos) + y * (sin * sin) + xy * (sin * cos)
    }
}

/// Any linear structure with gauges at given sites: the parameters are the angles of the gauges that
/// are free to turn. Which sites are worth a gauge is [`choose_sites`]'s business.
///
/// ```
/// use fingertip_calibration::design::{Criterion, LinearStructure, NominalLoads, Search, search};
/// use fingertip_calibration::nalgebra::{Matrix6, Vector6};
///
/// // What a finite-element program says of six gauges: strain per newton and newton metre.
/// let compliance: [Vector6<f64>; 6] = core::array::from_fn(|i| {
///     Matrix6::identity().column(i) * if i < 3 { 1e-6 } else { 2e-4 }
/// });
/// let structure = LinearStructure::fixed(&compliance)?;
/// // Under 10 N or 0.1 N·m the gauges of forces are strained by 10 millionths, those of torques by 20.
/// let loads = NominalLoads::equal(10.0, 0.1)?;
/// let found = search(&structure, &Criterion::ConditionNumber, &loads, &Search::default(), &|_| ())?;
/// assert!((found.best().ok_or("none")?.criterion - 2.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LinearStructure {
    sites: Vec<StrainSite>,
    /// Angle of each gauge, or the parameter that it follows.
    angles: Vec<GaugeAngle>,
    bridges: Vec<Bridge>,
    parameters: Vec<Parameter>,
}

/// How a gauge lies at its site.
///
/// ```
/// use fingertip_calibration::design::{DesignSpace as _, GaugeAngle, LinearStructure, StrainSite};
/// use fingertip_calibration::nalgebra::{Matrix3x6, Vector6};
///
/// // Six sites; five gauges lie along x, and the last may be turned.
/// let sites = vec![StrainSite { strains: Matrix3x6::from_fn(|i, _| [3e-6, -1e-6, 0.0][i]) }; 6];
/// let mut angles = vec![GaugeAngle::Fixed(0.0); 6];
/// angles[5] = GaugeAngle::Free;
/// let structure = LinearStructure::new(sites, angles, Vec::new())?;
/// assert_eq!(structure.parameters().len(), 1);
/// // Turned by a right angle it feels what is across.
/// let mut rows = [Vector6::zeros(); 6];
/// structure.response(&[core::f64::consts::FRAC_PI_2], &mut rows)?;
/// assert!((rows[0][0] - 3e-6).abs() < 1e-18 && (rows[5][0] + 1e-6).abs() < 1e-18);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GaugeAngle {
    /// So, from the site's x axis \[rad\].
    Fixed(f64),
    /// As the optimiser likes.
    Free,
}

impl LinearStructure {
    /// One gauge per site. `bridges` may be empty: each gauge is then a channel of its own.
    ///
    /// # Errors
    /// [`DesignError`] for a count that does not match, fewer than six channels, an arm without its
    /// gauge, or an entry that is not finite.
    pub fn new(
        sites: Vec<StrainSite>,
        angles: Vec<GaugeAngle>,
        bridges: Vec<Bridge>,
    ) -> Result<Self, DesignError> {
        if angles.len() != sites.len() {
            let (found, expected) = (angles.len(), sites.len());
            return Err(DesignError::WrongCount { what: "angles of gauges", found, expected });
        }
        for bridge in &bridges {
            bridge.validate(sites.len())?;
        }
        let fixed = angles.iter().filter_map(|angle| match angle {
            GaugeAngle::Fixed(angle) => Some(*angle),
            GaugeAngle::Free => None,
        });
        let entries = sites.iter().flat_map(|site| site.strains.iter().copied());
        if let Some(value) = entries.chain(fixed).find(|x| !x.is_finite()) {
            return Err(DesignError::OutOfRange { quantity: "strain field", value, requirement: "finite" });
        }
        let parameters = (1..)
            .zip(&angles)
            .filter(|(_, angle)| **angle == GaugeAngle::Free)
            .map(|(number, _)| Parameter::periodic_angle(&format!("angle{number}"), PI))
            .collect();
        let structure = Self { sites, angles, bridges, parameters };
        super::space::validate(&structure)?;
        Ok(structure)
    }

    /// A structure whose channels are what they are: the rows of an N×6 compliance matrix, signal
    /// (strain) per newton and newton metre. Nothing is free, but it can be assessed, tried and
    /// decoupled as any other.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn fixed(compliance: &[Vector6<f64>]) -> Result<Self, DesignError> {
        let site = |row: &Vector6<f64>| {
            let mut strains = Matrix3x6::zeros();
            strains.row_mut(0).copy_from(&row.transpose());
            StrainSite { strains }
        };
        let sites: Vec<_> = compliance.iter().map(site).collect();
        let angles = vec![GaugeAngle::Fixed(0.0); sites.len()];
        Self::new(sites, angles, Vec::new())
    }
}

impl DesignSpace for LinearStructure {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn channels(&self) -> usize {
        if self.bridges.is_empty() { self.sites.len() } else { self.bridges.len() }
    }

    fn response(&self, values: &[f64], rows: &mut [Vector6<f64>]) -> Result<(), DesignError> {
        let mut free = values.iter();
        let gauges = self.sites.iter().zip(&self.angles).map(|(site, angle)| match angle {
            GaugeAngle::Fixed(angle) => site.gauge(*angle),
            GaugeAngle::Free => site.gauge(free.next().copied().unwrap_or(0.0)),
        });
        if self.bridges.is_empty() {
            for (row, gauge) in rows.iter_mut().zip(gauges) {
                *row = gauge;
            }
        } else {
            let gauges: Vec<_> = gauges.collect();
            for (row, bridge) in rows.iter_mut().zip(&self.bridges) {
                *row = bridge.response(&gauges)?;
            }
        }
        Ok(())
    }
}

/// Chooses `count` of the candidate gauges (rows of strain per unit load) so that `criterion` is
/// small: greedy for the determinant, then exchanges of one gauge for another as long as they help
/// (Fedorov 1972; Mitchell 1974). It ends in a local optimum of exchanges. Returns their numbers,
/// ascending.
///
/// # Errors
/// [`DesignError::WrongCount`] for fewer than six gauges or too few candidates,
/// [`DesignError::Singular`] if no choice sees all loads.
pub fn choose_sites(
    candidates: &[Vector6<f64>],
    count: usize,
    criterion: &super::Criterion,
    loads: &super::NominalLoads,
) -> Result<Vec<usize>, DesignError> {
    loads.validate()?;
    if count < 6 || candidates.len() < count {
        let (what, found) = ("candidate gauges", candidates.len().min(count));
        return Err(DesignError::WrongCount { what, found, expected: count.max(6) });
    }
    let nominal = loads.components();
    let of = |chosen: &[usize]| {
        let rows: Vec<_> = chosen.iter().filter_map(|index| candidates.get(*index)).copied().collect();
        super::gram(&rows, &nominal)
    };
    // Greedy: the first six by orthogonalisation (largest remainder), the others by the criterion.
    let mut chosen: Vec<usize> = Vec::with_capacity(count);
    let mut remainders: Vec<Vector6<f64>> =
        candidates.iter().map(|row| row.component_mul(&nominal)).collect();
    let largest = remainders.iter().map(Vector6::norm).fold(0.0, f64::max);
    for _ in 0..6 {
        let best = (0..candidates.len())
            .filter(|index| !chosen.contains(index))
            .max_by(|a, b| remainders[*a].norm().total_cmp(&remainders[*b].norm()));
        let singular = DesignError::Singular { reason: "no choice of candidate gauges sees all loads" };
        let best = best.ok_or_else(|| singular.clone())?;
        let size = remainders[best].norm();
        if !(size > 1e-12 * largest && size.is_finite()) {
            return Err(singular);
        }
        let direction = remainders[best] / size;
        chosen.push(best);
        for remainder in &mut remainders {
            *remainder -= direction * direction.dot(remainder);
        }
    }
    while chosen.len() < count {
        let mut with = |index: usize| {
            chosen.push(index);
            let value = criterion.of(&of(&chosen));
            chosen.pop();
            value
        };
        let values: Vec<f64> = (0..candidates.len()).map(&mut with).collect();
        let best = (0..candidates.len())
            .filter(|index| !chosen.contains(index))
            .min_by(|a, b| values[*a].total_cmp(&values[*b]));
        chosen.extend(best);
    }
    let mut value = criterion.of(&of(&chosen));
    // Each exchange improves by a part in 10⁹ at least, so it ends; the bound is for peace of mind.
    for _ in 0..1000 {
        let mut best = (value * (1.0 - 1e-9), None);
        for place in 0..chosen.len() {
            let kept = chosen[place];
            for index in 0..candidates.len() {
                if chosen.contains(&index) {
                    continue;
                }
                chosen[place] = index;
                let tried = criterion.of(&of(&chosen));
                if tried < best.0 {
                    best = (tried, Some((place, index)));
                }
                chosen[place] = kept;
            }
        }
        let (better, Some((place, index))) = best else { break };
        chosen[place] = index;
        value = better;
    }
    chosen.sort_unstable();
    Ok(chosen)
}

#[cfg(test)]
mod tests {
    use super::{GaugeAngle, LinearStructure, StrainSite, choose_sites};
    use crate::design::test_spaces::{free, rosettes};
    use crate::design::{Criterion, DesignSpace, NominalLoads, Search, gram, search};
    use core::f64::consts::{FRAC_PI_2, TAU};
    use nalgebra::{Matrix3x6, Vector6};

    /// The plane strain of the tube by its gauges at 0°, 90° and ±45°: a stand-in for finite elements.
    fn tube_site(theta: f64) -> StrainSite {
        let mut values = vec![0.0; 18];
        values[1] = theta;
        let at = |q: f64| {
            let mut values = values.clone();
            values[2] = q;
            let mut rows = vec![Vector6::zeros(); 6];
            free().response(&values, &mut rows).unwrap();
            rows[0]
        };
        let mut strains = Matrix3x6::zeros();
        strains.row_mut(0).copy_from(&at(0.0).transpose());
        strains.row_mut(1).copy_from(&at(FRAC_PI_2).transpose());
        let shear = at(FRAC_PI_2 / 2.0) - at(-FRAC_PI_2 / 2.0);
        strains.row_mut(2).copy_from(&shear.transpose());
        StrainSite { strains }
    }

    #[test]
    fn turning_gauges_at_given_sites_finds_the_rosette() {
        let sites: Vec<_> = (0..6).map(|i| tube_site(TAU * f64::from(i / 2) / 3.0)).collect();
        let structure = LinearStructure::new(sites, vec![GaugeAngle::Free; 6], Vec::new()).unwrap();
        let loads = NominalLoads::equal(10.0, 0.1).unwrap();
        let how = Search { starts: 20, ..Search::default() };
        let found = search(&structure, &Criterion::ConditionNumber, &loads, &how, &|_| ()).unwrap();
        let best = found.best().unwrap();
        assert!((best.criterion / 2.0_f64.sqrt() - 1.0).abs() < 1e-3, "{}", best.criterion);
    }

    #[test]
    fn choosing_among_many_gauges_is_as_good_as_the_best_of_random_choices() {
        use rand::{RngExt as _, SeedableRng as _};
        let loads = NominalLoads::equal(10.0, 0.1).unwrap();
        let candidates: Vec<_> = (0..12)
            .flat_map(|place| {
                let site = tube_site(TAU * f64::from(place) / 12.0);
                [-20.0, 0.0, 20.0, 45.0_f64].map(|angle| site.gauge(angle.to_radians()))
            })
            .collect();
        let criterion = Criterion::Trace;
        let chosen = choose_sites(&candidates, 6, &criterion, &loads).unwrap();
        let value_of = |chosen: &[usize]| {
            let rows: Vec<_> = chosen.iter().map(|i| candidates[*i]).collect();
            criterion.of(&gram(&rows, &loads.components()))
        };
        let value = value_of(&chosen);
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        for _ in 0..5000 {
            let choice: Vec<usize> = (0..6).map(|_| random.random_range(0..candidates.len())).collect();
            assert!(value_of(&choice) > value * 0.999);
        }
        assert_eq!(choose_sites(&candidates, 8, &criterion, &loads).unwrap().len(), 8);
    }

    #[test]
    fn a_compliance_matrix_is_a_sensor() {
        let rosette = rosettes(3);
        let mut rows = vec![Vector6::zeros(); 6];
        rosette.response(&[8e-3, 0.3, 0.0], &mut rows).unwrap();
        let structure = LinearStructure::fixed(&rows).unwrap();
        let mut again = vec![Vector6::zeros(); 6];
        structure.response(&[], &mut again).unwrap();
        assert_eq!(rows, again);
        assert!(structure.parameters().is_empty());
    }

    #[test]
    fn refuses_what_is_no_structure() {
        let site = tube_site(0.0);
        assert!(LinearStructure::new(vec![site; 5], vec![GaugeAngle::Free; 5], Vec::new()).is_err());
        assert!(LinearStructure::new(vec![site; 6], vec![GaugeAngle::Free; 5], Vec::new()).is_err());
        assert!(LinearStructure::fixed(&[Vector6::repeat(f64::NAN); 6]).is_err());
        let loads = NominalLoads::equal(10.0, 0.1).unwrap();
        let same = [Vector6::repeat(1.0); 9];
        assert!(choose_sites(&same, 6, &Criterion::Trace, &loads).is_err());
        assert!(choose_sites(&same, 5, &Criterion::Trace, &loads).is_err());
    }

    /// Of all choices none is better that differs in one gauge only.
    #[test]
    fn no_exchange_of_one_gauge_improves_a_choice() {
        let loads = NominalLoads { force: [10.0, 20.0, 20.0], torque: [0.1, 0.3, 0.2] };
        let candidates: Vec<_> = (0..7)
            .flat_map(|place| {
                let site = tube_site(0.9 * f64::from(place));
                [-25.0, 10.0, 40.0_f64].map(|angle| site.gauge((angle + f64::from(place)).to_radians()))
            })
            .collect();
        for (count, criterion) in [(6, Criterion::Trace), (8, Criterion::ConditionNumber)] {
            let chosen = choose_sites(&candidates, count, &criterion, &loads).unwrap();
            assert_eq!(chosen.len(), count);
            assert!(chosen.is_sorted_by(|a, b| a < b) && chosen[count - 1] < candidates.len(), "{chosen:?}");
            let value_of = |chosen: &[usize]| {
                let rows: Vec<_> = chosen.iter().map(|i| candidates[*i]).collect();
                criterion.of(&gram(&rows, &loads.components()))
            };
            let value = value_of(&chosen);
            for place in 0..count {
                for other in (0..candidates.len()).filter(|other| !chosen.contains(other)) {
                    let mut exchanged = chosen.clone();
                    exchanged[place] = other;
                    assert!(value_of(&exchanged) >= value * (1.0 - 1e-8), "{place} {other}");
                }
            }
        }
        // All of them, where there are no more.
        let all = choose_sites(&candidates[..9], 9, &Criterion::Trace, &loads).unwrap();
        assert_eq!(all, [0, 1, 2, 3, 4, 5, 6, 7, 8]);
        for (few, count) in [(5, 6), (8, 9)] {
            assert!(choose_sites(&candidates[..few], count, &Criterion::Trace, &loads).is_err());
        }
        assert!(choose_sites(&[Vector6::zeros(); 8], 6, &Criterion::Trace, &loads).is_err());
    }
}
