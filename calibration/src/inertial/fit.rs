//! Mass, centre, inertia and zero from a motion.

use fingertip_wrench::InertialUnit;
use fingertip_wrench::units::STANDARD_GRAVITY;
use nalgebra::{DMatrix, Matrix3, SVector, Vector3, Vector6};

use super::body::{Body, of_a_point};
use super::delay::coarse;
use super::error::InertialError;
use super::outcome::{Delay, InertialFit};
use super::regressor::{ENTRIES, NAMES, PARAMETERS, Parameters};
use super::samples::MovingSample;
use super::smoothed::{Smooth, smoothed};
use super::solve::{Prior, Rows, Solved, UNKNOWNS};

/// Rows that are looked at in the search for the delay.
const FEW: usize = 400;
/// Fewer rows, one time constant apart, are no motion.
const LEAST_ROWS: usize = 50;
/// Rounds of weights, scales and the step of the delay.
const ROUNDS: usize = 8;

/// What is known of the inertial unit and of the motion.
///
/// ```
/// # use fingertip_calibration::inertial::MovingSample;
/// # use fingertip_calibration::nalgebra::{Vector3, Vector6};
/// # use fingertip_wrench::InertialReading;
/// # // 0.4 kg in the sensor's origin, shaken for 4 s: the force is −m times what the accelerometer reads.
/// # let samples: Vec<MovingSample> = (0..4000).map(|k| {
/// #     let t = 1e-3 * f64::from(k);
/// #     let a = Vector3::new(3.0 * (9.0 * t).sin(), 2.0 * (7.0 * t).cos(), 9.8 + (5.0 * t).sin());
/// #     let reading = InertialReading { acceleration: a, angular_velocity: Vector3::zeros() };
/// #     let f = -0.4 * a;
/// #     MovingSample { time: t, wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0), reading }
/// # }).collect();
/// use fingertip_calibration::inertial::{InertialOptions, fit_inertial};
///
/// // Readings come at most 20 ms late, and are smoothed over 20 ms.
/// let options = InertialOptions { time_constant: 0.02, longest_delay: 0.02, ..InertialOptions::default() };
/// let fit = fit_inertial(&samples, &options)?;
/// assert!((fit.body.mass - 0.4).abs() < 1e-3 && fit.time_constant == 0.02);
/// # Ok::<(), fingertip_calibration::inertial::InertialError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialOptions {
    /// How the inertial unit sits on the sensor. What its gyroscope reads at rest is found in the rest, if one is told.
    pub unit: InertialUnit<f64>,
    /// Time constant of the filter for all channels \[s\], 10 ms by default: the longer, the less noise, and the more of what
    /// turns quickly is lost.
    pub time_constant: f64,
    /// The inertial readings come later or sooner than the wrench by no more than this \[s\], 0.1 s by default; 0 if they are
    /// known to be of the same time.
    pub longest_delay: f64,
    /// The sensor rests in the first seconds, without contact: tells the noise and what the gyroscope reads at rest.
    pub rest: Option<f64>,
    /// How far the body reaches from the sensor, about \[m\], 0.2 m by default: what the motion does not tell of centre and
    /// inertia is taken to be zero to within this.
    pub reach: f64,
}

impl Default for InertialOptions {
    fn default() -> Self {
        Self {
            unit: InertialUnit::at_the_origin(),
            time_constant: 0.01,
            longest_delay: 0.1,
            rest: None,
            reach: 0.2,
        }
    }
}

/// Fits the ten inertial parameters of a rigid body, the zero of the sensor and the delay between its readings and those of
/// an inertial unit, by weighted least squares on filtered readings (Atkeson, An & Hollerbach 1986).
///
/// Wrenches \[N, N·m\] are loads on the sensor, without contact, in its frame. The accelerometer's own error at rest cannot be
/// told from the sensor's and is in its zero; a wrong scale of the accelerometer is in the mass. What the motion does not
/// excite stays at what is believed before (`InertialOptions::reach`) and is named. The covariance holds for noise that hangs
/// together in time. Formulas: `docs/theory/calibration.md#a-payload-from-a-motion`.
///
/// ```
/// use fingertip_calibration::inertial::{InertialOptions, MovingSample, fit_inertial};
/// use fingertip_calibration::nalgebra::{Vector3, Vector6};
/// use fingertip_wrench::InertialReading;
///
/// // 0.4 kg in the sensor's origin, shaken along each axis: the force is −m times what the accelerometer reads.
/// let samples: Vec<MovingSample> = (0..4000).map(|k| {
///     let t = 1e-3 * f64::from(k);
///     let a = Vector3::new(3.0 * (9.0 * t).sin(), 2.0 * (7.0 * t).cos(), 9.8 + (5.0 * t).sin());
///     let f = -0.4 * a;
///     let reading = InertialReading { acceleration: a, angular_velocity: Vector3::zeros() };
///     MovingSample { time: t, wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0), reading }
/// }).collect();
/// let fit = fit_inertial(&samples, &InertialOptions::default())?;
/// assert!((fit.body.mass - 0.4).abs() < 1e-4);
/// // It never turned: nothing tells the inertia, and that is said.
/// assert!(fit.undetermined.contains(&"inertia xx"));
/// # Ok::<(), fingertip_calibration::inertial::InertialError>(())
/// ```
///
/// # Errors
/// [`InertialError`].
pub fn fit_inertial(
    samples: &[MovingSample],
    options: &InertialOptions,
) -> Result<InertialFit, InertialError> {
    check(options)?;
    let unit = match options.rest.and_then(|rest| resting_rate(samples, rest)) {
        Some(rate) => options.unit.with_resting_rate(rate)?,
        None => options.unit,
    };
    let smooth = smoothed(samples, &unit, options.time_constant)?;
    let place = unit.position();
    let rest_ends = begin(samples) + options.rest.unwrap_or(f64::NEG_INFINITY);
    let rows = Rows::of(&smooth, place, options.time_constant, rest_ends, usize::MAX);
    if rows.chosen.len() < LEAST_ROWS {
        return Err(InertialError::TooShort {
            seconds: rows.chosen.len() as f64 * options.time_constant,
            needed: LEAST_ROWS as f64 * options.time_constant,
        });
    }
    let load = spread(rows.chosen.iter().filter_map(|index| smooth.get(*index)));
    let (solved, delay) = solved(&rows, &smooth, options, &load)?;
    let Some(mass) = solved.parameters.get(0).copied() else { return Err(no_mass(&solved)) };
    let deviation = solved.covariance[(0, 0)].max(0.0).sqrt();
    if mass < -3.0 * deviation {
        return Err(InertialError::NegativeMass { mass });
    }
    if !(mass > 4.0 * deviation) {
        return Err(no_mass(&solved));
    }
    Ok(outcome(&solved, delay, options, &Known { unit, load, samples }))
}

fn check(options: &InertialOptions) -> Result<(), InertialError> {
    let positive = |x: f64| x > 0.0 && x.is_finite();
    let wrong = |what, needed| Err(InertialError::Option { what, needed });
    if !(options.longest_delay >= 0.0 && options.longest_delay <= 10.0) {
        return wrong("the longest delay", "between 0 and 10 s");
    }
    if !positive(options.reach) {
        return wrong("the reach of the body", "a positive length");
    }
    if options.rest.is_some_and(|rest| !positive(rest)) {
        return wrong("the rest", "a positive time");
    }
    Ok(())
}

fn no_mass(solved: &Solved) -> InertialError {
    InertialError::NoMass { mass: solved.parameters[0], deviation: solved.covariance[(0, 0)].max(0.0).sqrt() }
}

fn begin(samples: &[MovingSample]) -> f64 {
    samples.first().map_or(0.0, |first| first.time)
}

/// The samples of the rest.
fn resting(samples: &[MovingSample], rest: f64) -> &[MovingSample] {
    let ends = begin(samples) + rest;
    let count = samples.iter().take_while(|sample| sample.time < ends).count();
    samples.get(..count).unwrap_or_default()
}

/// What the gyroscope reads on average in the rest.
fn resting_rate(samples: &[MovingSample], rest: f64) -> Option<Vector3<f64>> {
    let resting = resting(samples, rest);
    let sum: Vector3<f64> = resting.iter().map(|sample| sample.reading.angular_velocity).sum();
    let mean = sum / resting.len() as f64;
    // Of no samples it is no number.
    mean.iter().all(|x| x.is_finite()).then_some(mean)
}

/// Standard deviation of each component of the wrench.
fn spread<'a>(samples: impl Iterator<Item = &'a Smooth> + Clone) -> Vector6<f64> {
    let count = samples.clone().count().max(1) as f64;
    let mean = samples.clone().fold(Vector6::zeros(), |sum, sample| sum + sample.wrench) / count;
    let squares = samples.fold(Vector6::zeros(), |sum, sample| {
        let off: Vector6<f64> = sample.wrench - mean;
        sum + off.component_mul(&off)
    });
    (squares / count).map(f64::sqrt)
}

/// Deviations of nothing weigh endlessly: at least this share of the load.
fn floored(deviations: &Vector6<f64>, load: &Vector6<f64>) -> Vector6<f64> {
    let force = load.fixed_rows::<3>(0).amax().max(1e-12);
    let torque = load.fixed_rows::<3>(3).amax().max(1e-3 * force);
    Vector6::from_fn(|i, _| deviations[i].max(1e-7 * if i < 3 { force } else { torque }))
}

/// What is believed before of a body of this mass and centre \[kg, m\].
fn prior(options: &InertialOptions, about: &Parameters, delay: f64) -> Prior {
    let (reach, mass) = (options.reach, about[0].abs().max(1e-3));
    let of_point = of_a_point(about[0], &(about.fixed_rows::<3>(1) / about[0]));
    let mut mean = SVector::<f64, UNKNOWNS>::zeros();
    // Mass and zero are as good as free.
    let mut deviation = SVector::<f64, UNKNOWNS>::repeat(1e3);
    deviation[0] = 1e3 * mass;
    for k in 0..3 {
        deviation[1 + k] = mass * reach;
    }
    for (k, entry) in ENTRIES.into_iter().enumerate() {
        mean[4 + k] = if of_point[entry].is_finite() { of_point[entry] } else { 0.0 };
        deviation[4 + k] = mass * reach * reach;
    }
    mean[PARAMETERS] = -delay;
    // A delay that is not sought is known.
    deviation[PARAMETERS] = if options.longest_delay > 0.0 { options.longest_delay } else { 1e-12 };
    Prior { mean, deviation }
}

fn solved(
    rows: &Rows<'_>,
    smooth: &[Smooth],
    options: &InertialOptions,
    load: &Vector6<f64>,
) -> Result<(Solved, f64), InertialError> {
    let bad = InertialError::NotFinite { sample: 0 };
    let mut deviations = floored(load, load);
    let mut about = Parameters::zeros();
    about[0] = 1.0;
    let mut delay = 0.0;
    if options.longest_delay > 0.0 {
        let few = Rows::of(smooth, rows.place, options.time_constant, f64::NEG_INFINITY, FEW);
        let before = prior(options, &about, 0.0);
        let found = coarse(&few, options.longest_delay, options.time_constant, &deviations, &before);
        delay = found.ok_or_else(|| bad.clone())?;
    }
    let mut last = None;
    for round in 0..ROUNDS {
        let before = prior(options, &about, delay);
        let solved = rows
            .solve(delay, &about, &deviations, &before, round + 1 == ROUNDS)
            .ok_or_else(|| bad.clone())?;
        if solved.rows < LEAST_ROWS {
            let seconds = solved.rows as f64 * options.time_constant;
            return Err(InertialError::TooShort {
                seconds,
                needed: LEAST_ROWS as f64 * options.time_constant,
            });
        }
        about = solved.parameters;
        deviations = floored(&solved.rms, load);
        // About nothing, the first has no slope by the delay.
        if round > 0 {
            delay = (delay + solved.change).clamp(-options.longest_delay, options.longest_delay);
        }
        last = Some(solved);
    }
    Ok((last.ok_or(bad)?, delay))
}

/// What is known beside the solution.
struct Known<'a> {
    unit: InertialUnit<f64>,
    load: Vector6<f64>,
    samples: &'a [MovingSample],
}

fn outcome(solved: &Solved, delay: f64, options: &InertialOptions, known: &Known<'_>) -> InertialFit {
    let parameters = &solved.parameters;
    let fitted = Body::of(parameters);
    let deviation = |k: usize| solved.covariance[(k, k)].max(0.0).sqrt();
    let before = prior(options, parameters, delay).deviation;
    let is_open = |k: &usize| deviation(*k) > 0.5 * before[*k];
    let undetermined = (1..10).filter(is_open).filter_map(|k| NAMES.get(k).copied()).collect();
    let (centre_deviation, inertia_deviation) = deviations(solved);
    let rest = options.rest.map(|rest| resting(known.samples, rest)).unwrap_or_default();
    let read: Vector3<f64> = rest.iter().map(|sample| sample.reading.acceleration).sum();
    let sought = options.longest_delay > 0.0;
    let mut fit = InertialFit {
        body: fitted.made_consistent(),
        mass_deviation: deviation(0),
        centre_deviation,
        inertia_deviation,
        least_moment: fitted.consistency().least_moment,
        force_bias: parameters.fixed_rows::<3>(10).into_owned(),
        torque_bias: parameters.fixed_rows::<3>(13).into_owned(),
        bias_deviation: Vector6::from_fn(|k, _| deviation(10 + k)),
        delay: sought.then(|| Delay { seconds: delay, deviation: deviation(PARAMETERS) }),
        unit: known.unit,
        time_constant: options.time_constant,
        load: known.load,
        left: solved.rms,
        noise: solved.at_rest,
        gravity_read: (!rest.is_empty()).then(|| (read / rest.len() as f64).norm()),
        undetermined,
        covariance: DMatrix::from_fn(UNKNOWNS, UNKNOWNS, |i, j| solved.covariance[(i, j)]),
        rows: solved.rows,
        warnings: Vec::new(),
    };
    fit.warnings = warnings(&fit, options);
    fit
}

/// Standard deviations of the centre and of the inertia about it, to first order by differences of one deviation.
fn deviations(solved: &Solved) -> (Vector3<f64>, Matrix3<f64>) {
    let mut slopes = nalgebra::SMatrix::<f64, 12, PARAMETERS>::zeros();
    for k in 0..10 {
        let step = solved.covariance[(k, k)].max(0.0).sqrt().max(1e-9 * solved.parameters[k].abs());
        if !(step > 0.0) {
            continue;
        }
        // Short, where the mass is in a denominator.
        let step = if k == 0 { 0.1 * step } else { step };
        let at = |sign: f64| {
            let mut moved = solved.parameters;
            moved[k] += sign * step;
            let body = Body::of(&moved);
            SVector::<f64, 12>::from_iterator(body.centre.iter().chain(body.inertia.iter()).copied())
        };
        slopes.set_column(k, &((at(1.0) - at(-1.0)) / (2.0 * step)));
    }
    let covariance = solved.covariance.fixed_view::<PARAMETERS, PARAMETERS>(0, 0);
    let spread = slopes * covariance * slopes.transpose();
    let deviation = |k: usize| spread[(k, k)].max(0.0).sqrt();
    (Vector3::from_fn(|i, _| deviation(i)), Matrix3::from_fn(|i, j| deviation(3 + 3 * j + i)))
}

fn warnings(fit: &InertialFit, options: &InertialOptions) -> Vec<String> {
    let mut warnings = Vec::new();
    if !fit.undetermined.is_empty() {
        warnings.push(format!(
            "the motion tells next to nothing of {}: taken as of a point, and right for motions like this one alone",
            fit.undetermined.join(", ")
        ));
    }
    let slack = fit.inertia_deviation.amax();
    if fit.least_moment < -3.0 * slack.max(1e-12) {
        warnings.push(format!(
            "no body has the inertia as fitted (second moment {:.2e} ± {slack:.1e} kg·m²): it was brought to the nearest that is; \
             the unit may sit elsewhere than said, or something is loose",
            fit.least_moment
        ));
    }
    if let Some(ratio) = fit.over_noise().filter(|ratio| *ratio > 2.0) {
        warnings.push(format!(
            "what is left of the motion is {ratio:.1} times the noise at rest: the sensor, the unit's place, or the rigidity of \
             the body"
        ));
    }
    if fit.mass_deviation > 0.02 * fit.body.mass {
        warnings.push("the mass is known to no better than 2 %".to_owned());
    }
    let off = |read: f64| (read / STANDARD_GRAVITY - 1.0).abs();
    match fit.gravity_read {
        Some(read) if (0.9..1.1).contains(&read) => warnings.push(format!(
            "the accelerometer reads {read:.3} at rest, as one in g does: say so in the name of its columns"
        )),
        Some(read) if off(read) > 0.02 => warnings.push(format!(
            "the accelerometer reads {read:.3} m/s² at rest: the mass may be off by {:.0} %",
            100.0 * off(read)
        )),
        _ => {}
    }
    if let Some(delay) = fit.delay {
        if delay.deviation > 0.3 * options.longest_delay {
            warnings.push("the motion does not tell the delay of the inertial readings".to_owned());
        } else if delay.seconds.abs() > 0.98 * options.longest_delay {
            warnings.push("the delay of the inertial readings is at the end of what was searched".to_owned());
        }
    }
    warnings
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector6;

    use super::{InertialOptions, Parameters, floored, prior};

    /// Readings without any scatter do not weigh endlessly: as if they scattered by 1e-7 of the load, torques at least by
    /// that of the force at a millimetre.
    #[test]
    fn what_does_not_scatter_weighs_by_the_load() {
        let still = Vector6::zeros();
        let load = Vector6::new(0.5, -2.0, 1.0, 0.01, 0.0, -0.03);
        let floor = floored(&still, &load);
        for (found, expected) in floor.iter().zip([2e-7, 2e-7, 2e-7, 3e-9, 3e-9, 3e-9]) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{floor}");
        }
        let pure = Vector6::new(0.5, -2.0, 1.0, 0.0, 0.0, 0.0);
        assert!((floored(&still, &pure)[4] / 2e-10 - 1.0).abs() < 1e-12);
        // What scatters more weighs by its scatter.
        let noisy = Vector6::new(1e-3, 0.0, 2e-3, 1e-5, 2e-5, 0.0);
        let expected = Vector6::new(1e-3, 2e-7, 2e-3, 1e-5, 2e-5, 3e-9);
        assert!((floored(&noisy, &load) - expected).amax() < 1e-18);
        // Without any load at all they are still numbers to divide by.
        assert!(floored(&still, &still).iter().all(|x| *x > 0.0));
    }

    /// Of a tonne as of a gram a thousand times itself may be the mass, and the centre within the reach.
    #[test]
    fn what_is_believed_before_grows_with_the_mass() {
        let options = InertialOptions::default();
        for mass in [1e-3, 0.05, 1e3] {
            let mut about = Parameters::zeros();
            about[0] = mass;
            let prior = prior(&options, &about, 0.3);
            assert_eq!(prior.mean[super::PARAMETERS], -0.3);
            let deviation = prior.deviation;
            let reach = options.reach;
            let expected = [1e3 * mass, mass * reach, mass * reach, mass * reach, mass * reach * reach];
            for (k, expected) in expected.into_iter().enumerate() {
                assert!((deviation[k] / expected - 1.0).abs() < 1e-12, "{k}: {deviation}");
            }
        }
    }
}
