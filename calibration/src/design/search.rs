//! The optimiser: many starts, a smooth descent from each, then a polish on the creases.

use core::num::NonZero;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Mutex;
use std::thread;

use nalgebra::{DMatrix, DVector, Vector6};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::nelder_mead::{self, nelder_mead};
use super::objective::Objective;
use super::quasi_newton::{self, quasi_newton};
use super::{Criterion, DesignError, DesignSpace, NominalLoads, space};
use crate::linear::Singular;

/// How to search.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{Criterion, Search, search};
///
/// // Eight starts on one thread; the seed gives the same result again.
/// let how = Search { starts: 8, seed: 3, threads: core::num::NonZero::new(1), ..Search::default() };
/// let found = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ())?;
/// assert!((found.best().ok_or("none")?.criterion - 4.183).abs() < 1e-3);
/// assert_eq!(search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ())?.best(), found.best());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// Number of random starts.
    pub starts: usize,
    /// The same seed gives the same result, whatever the number of threads.
    pub seed: u64,
    /// Threads to use; `None` for as many as the machine has.
    pub threads: Option<NonZero<usize>>,
    /// Two minima whose criterion and singular values agree to this relative difference are counted
    /// as the same: they differ by a rotation, a reflection or the order of the gauges, or not at all.
    pub same: f64,
}

impl Default for Search {
    fn default() -> Self {
        Self { starts: 40, seed: 1, threads: None, same: 1e-3 }
    }
}

/// How far a search has come.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{Criterion, Progress, Search, search};
/// use std::sync::atomic::{AtomicUsize, Ordering};
///
/// // It is told after every start, from the threads that work.
/// let told = AtomicUsize::new(0);
/// let tell = |progress: Progress| {
///     assert!(progress.done <= progress.starts && progress.best > 4.18);
///     told.fetch_add(1, Ordering::Relaxed);
/// };
/// search(&space, &Criterion::ConditionNumber, &loads, &Search { starts: 4, ..Search::default() }, &tell)?;
/// assert_eq!(told.into_inner(), 4);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Starts that are done.
    pub done: usize,
    /// Starts in all.
    pub starts: usize,
    /// Least criterion so far.
    pub best: f64,
}

/// A local minimum.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{Criterion, Minimum, Search, search};
///
/// let how = Search { starts: 8, ..Search::default() };
/// let found = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ())?;
/// let best: &Minimum = found.best().ok_or("none")?;
/// // A radius of 6.55 mm, gauges at 14.45°, rings 13.46 mm apart.
/// assert!((best.values[0] - 6.55e-3).abs() < 0.02e-3 && (best.values[1].to_degrees() - 14.45).abs() < 0.1);
/// // The smallest singular value is that share of the largest.
/// assert!((best.spectrum[5] * best.criterion - 1.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// Values of the parameters, of the best of the starts that ended here.
    pub values: Vec<f64>,
    /// Other places of the same criterion and singular values where starts ended, further than 1 %
    /// of some parameter's range from `values` and from each other: other sensors that are as good,
    /// or the same one turned, mirrored or numbered otherwise.
    pub equivalents: Vec<Vec<f64>>,
    /// The criterion there.
    pub criterion: f64,
    /// How many starts ended here.
    pub starts: usize,
    /// The share of all starts: an estimate of the size of the basin.
    pub share: f64,
    /// How the criterion changes when a parameter is off by its tolerance.
    pub sensitivities: Vec<Sensitivity>,
    /// Singular values of the normalised matrix over the largest.
    pub spectrum: Vec<f64>,
}

/// Change of the criterion with one parameter. On a crease it grows to both sides.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{Criterion, Search, Sensitivity, search};
///
/// let how = Search { starts: 8, ..Search::default() };
/// let found = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ())?;
/// // At a minimum it gets no better by half a degree to either side, and not much worse.
/// let of_angle: Sensitivity = found.best().ok_or("none")?.sensitivities[1];
/// assert!(of_angle.lower >= 0.0 && of_angle.higher >= 0.0);
/// assert!(of_angle.lower < 0.5 && of_angle.higher < 0.5);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivity {
    /// By lowering the parameter by its tolerance (or to its bound).
    pub lower: f64,
    /// By raising it.
    pub higher: f64,
}

/// What a search has found.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{Criterion, Findings, Search, search};
///
/// let how = Search { starts: 8, ..Search::default() };
/// let found: Findings = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ())?;
/// // Every start ends in some minimum or fails, and the best comes first.
/// let ended: usize = found.minima.iter().map(|minimum| minimum.starts).sum();
/// assert_eq!(ended + found.failed, 8);
/// assert!(found.minima.windows(2).all(|pair| pair[0].criterion <= pair[1].criterion));
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Findings {
    /// All local minima, best first.
    pub minima: Vec<Minimum>,
    /// Starts that found no sensor at all.
    pub failed: usize,
    /// How often a response was computed.
    pub evaluations: u64,
}

impl Findings {
    /// The best design, if there is one.
    #[must_use]
    pub fn best(&self) -> Option<&Minimum> {
        self.minima.first()
    }
}

/// Powers of the norm that stands for the maximum: smooth first, then close. After the last one the
/// surrogate is within log 6/4096 = 0.04 % of the criterion.
const POWERS: [f64; 6] = [2.0, 8.0, 32.0, 128.0, 512.0, 4096.0];

/// Where one start ended.
struct End {
    values: Vec<f64>,
    criterion: f64,
    evaluations: u64,
}

/// Searches a design space for the least value of a criterion. `progress` is called after every
/// start, from the threads that work.
///
/// From each random start a quasi-Newton descent follows the surrogate of
/// [`Criterion::smoothed`] with rising power, then the simplex method polishes the criterion itself.
/// A search by one coordinate at a time would jam on the creases, as it seems to have done in 1987.
///
/// # Errors
/// [`DesignError`] for a parameter with an empty range, fewer than six channels, bad loads or no
/// starts; [`DesignError::Singular`] if no start gave a sensor.
pub fn search(
    space: &dyn DesignSpace,
    criterion: &Criterion,
    loads: &NominalLoads,
    how: &Search,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Findings, DesignError> {
    space::validate(space)?;
    loads.validate()?;
    if how.starts == 0 {
        return Err(DesignError::WrongCount { what: "starts", found: 0, expected: 1 });
    }
    let threads =
        how.threads.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZero::get).min(how.starts);
    let next = AtomicUsize::new(0);
    let ends: Mutex<Vec<(usize, End)>> = Mutex::new(Vec::with_capacity(how.starts));
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= how.starts {
                        break;
                    }
                    let end = from_start(space, criterion, loads, how.seed, index);
                    // A thread that has panicked leaves whole entries behind.
                    let mut ends = ends.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                    ends.push((index, end));
                    let best = ends.iter().map(|(_, end)| end.criterion).fold(f64::INFINITY, f64::min);
                    progress(Progress { done: ends.len(), starts: how.starts, best });
                }
            });
        }
    });
    let mut ends = ends.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    ends.sort_by_key(|(index, _)| *index);
    gather(space, criterion, loads, how, ends)
}

fn from_start(
    space: &dyn DesignSpace,
    criterion: &Criterion,
    loads: &NominalLoads,
    seed: u64,
    index: usize,
) -> End {
    let objective = Objective::new(space, criterion, loads);
    let mixed = seed ^ (index as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mut random = Pcg64Mcg::seed_from_u64(mixed);
    let dimension = space.parameters().len();
    let mut t = DVector::zeros(dimension);
    // A start where no sensor can be built says nothing of basins: draw again.
    for _ in 0..100 {
        t = DVector::from_fn(dimension, |_, _| random.random_range(0.0..1.0));
        if objective.at(t.as_slice()).is_finite() {
            break;
        }
    }
    let mut best = (t.as_slice().to_vec(), objective.at(t.as_slice()));
    let powers: &[f64] = if criterion.has_creases() { &POWERS } else { &[1.0] };
    let limits = quasi_newton::Limits { iterations: 40 + 20 * dimension, slope: 1e-8, value: 1e-10 };
    for power in powers {
        let Some((place, _)) = quasi_newton(|t| objective.smoothed(t, *power), &t, limits) else { break };
        t = place;
        let value = objective.at(t.as_slice());
        if value < best.1 {
            best = (t.as_slice().to_vec(), value);
        }
    }
    let limits = nelder_mead::Limits { evaluations: 400 * (dimension + 1), value: 1e-11, place: 1e-7 };
    let (place, value, _) = nelder_mead(|t| objective.at(t), &best.0, 0.02, limits);
    let values = objective.values(&place);
    End { values, criterion: value.exp(), evaluations: objective.evaluations() }
}

fn gather(
    space: &dyn DesignSpace,
    criterion: &Criterion,
    loads: &NominalLoads,
    how: &Search,
    ends: Vec<(usize, End)>,
) -> Result<Findings, DesignError> {
    let evaluations = ends.iter().map(|(_, end)| end.evaluations).sum();
    let mut found: Vec<End> =
        ends.into_iter().map(|(_, end)| end).filter(|end| end.criterion.is_finite()).collect();
    let failed = how.starts - found.len();
    found.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
    let nominal = loads.components();
    let mut minima: Vec<Minimum> = Vec::new();
    for end in found {
        let spectrum = spectrum(space, &nominal, &end.values)?;
        let alike = |minimum: &&mut Minimum| {
            (end.criterion / minimum.criterion - 1.0).abs() <= how.same
                && spectrum.iter().zip(&minimum.spectrum).all(|(a, b)| (a - b).abs() <= how.same)
        };
        if let Some(minimum) = minima.iter_mut().find(alike) {
            minimum.starts += 1;
            let known = minimum.equivalents.iter().chain([&minimum.values]);
            if known.into_iter().all(|values| apart(space, values, &end.values)) {
                minimum.equivalents.push(end.values);
            }
        } else {
            minima.push(Minimum {
                values: end.values,
                equivalents: Vec::new(),
                criterion: end.criterion,
                starts: 1,
                share: 0.0,
                sensitivities: Vec::new(),
                spectrum,
            });
        }
    }
    if minima.is_empty() {
        return Err(DesignError::Singular { reason: "no start gave a sensor" });
    }
    let objective = Objective::new(space, criterion, loads);
    for minimum in &mut minima {
        minimum.share = minimum.starts as f64 / how.starts as f64;
        minimum.sensitivities = sensitivities(space, &objective, &minimum.values);
    }
    Ok(Findings { minima, failed, evaluations })
}

/// `true` if some parameter differs by more than 1 % of its range.
fn apart(space: &dyn DesignSpace, a: &[f64], b: &[f64]) -> bool {
    space.parameters().iter().zip(a.iter().zip(b)).any(|(parameter, (a, b))| {
        let distance = (a - b).abs() / parameter.span();
        (if parameter.periodic { distance.min(1.0 - distance) } else { distance }) > 0.01
    })
}

fn spectrum(
    space: &dyn DesignSpace,
    nominal: &Vector6<f64>,
    values: &[f64],
) -> Result<Vec<f64>, DesignError> {
    let mut rows = vec![Vector6::zeros(); space.channels()];
    space.response(values, &mut rows)?;
    let matrix = DMatrix::from_fn(rows.len(), 6, |i, j| rows[i][j] * nominal[j]);
    let singular =
        Singular::new(&matrix).ok_or(DesignError::Singular { reason: "the response is not finite" })?;
    let largest = singular.values.max();
    Ok(singular.values.iter().map(|value| value / largest).collect())
}

fn sensitivities(space: &dyn DesignSpace, objective: &Objective<'_>, values: &[f64]) -> Vec<Sensitivity> {
    let here = objective.criterion(values);
    let parameters = space.parameters();
    let change = |index: usize, step: f64| {
        let mut moved = values.to_vec();
        if let (Some(value), Some(parameter)) = (moved.get_mut(index), parameters.get(index)) {
            *value = parameter.admissible(*value + step);
        }
        objective.criterion(&moved) - here
    };
    (0..parameters.len())
        .map(|index| {
            let tolerance = parameters[index].tolerance;
            Sensitivity { lower: change(index, -tolerance), higher: change(index, tolerance) }
        })
        .collect()
}
