//! `[uncertainty]`: how sure each contact is.

use fingertip::contact::{
    CalibrationUncertainty, ConfidenceEllipse, ContactCovariance, ContactJacobian, GeometryUncertainty,
    WrenchNoise,
};
use fingertip::surfaces::BadShape;
use fingertip::wrench::{Real, Wrench};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use crate::fault::SceneProblem;
use crate::sensor::SensorSource;

/// `[uncertainty]` of a scene: standard deviations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct UncertaintySection {
    /// Of a component of the force at rest.
    #[serde(rename = "force_noise_N", skip_serializing_if = "Option::is_none")]
    force_noise: Option<f64>,
    #[serde(rename = "torque_noise_Nm", skip_serializing_if = "Option::is_none")]
    torque_noise: Option<f64>,
    /// Under load, of the load.
    #[serde(default)]
    relative: f64,
    /// Of the surface's height: of a radius, or of its departure from the shape.
    #[serde(default)]
    offset_m: f64,
    /// Of the surface's place, in each direction.
    #[serde(default)]
    position_m: f64,
    /// Of the surface's attitude, about each axis through its origin.
    #[serde(default)]
    attitude_deg: f64,
    /// Whether what the calibration's fit leaves uncertain counts; it does where the calibration tells it.
    #[serde(skip_serializing_if = "Option::is_none")]
    calibration: Option<bool>,
    /// That the contact lies within the ellipse.
    #[serde(default = "usual_probability")]
    probability: f64,
}

const fn usual_probability() -> f64 {
    0.95
}

impl UncertaintySection {
    /// Whether the noise is that of the rest.
    pub(crate) const fn awaits_noise(&self) -> bool {
        self.force_noise.is_none() && self.torque_noise.is_none()
    }

    /// The noise that is stated, or else `measured`.
    fn noise(&self, measured: &Vector6<f64>) -> Result<Vector6<f64>, SceneProblem> {
        let missing = |needed| SceneProblem::Needs { what: "[uncertainty]", needed };
        match (self.force_noise, self.torque_noise) {
            (Some(force), Some(torque)) => {
                Ok(Vector6::from_fn(|axis, _| if axis < 3 { force } else { torque }))
            }
            (None, None) => Ok(*measured),
            (None, Some(_)) => Err(missing("`force_noise_N` beside `torque_noise_Nm`")),
            (Some(_), None) => Err(missing("`torque_noise_Nm` beside `force_noise_N`")),
        }
    }

    /// What the fit of the calibration leaves uncertain.
    fn calibration<T: Real>(
        &self,
        sensor: Option<&SensorSource>,
    ) -> Result<Option<CalibrationUncertainty<T>>, SceneProblem> {
        if self.calibration == Some(false) {
            return Ok(None);
        }
        let told = sensor.map(SensorSource::uncertainty).transpose()?.flatten();
        if told.is_none() && self.calibration == Some(true) {
            return Err(SceneProblem::Needs {
                what: "`calibration = true` of [uncertainty]",
                needed: "a `calibration` in [sensor] whose file has a [covariance], as `fingertip calibrate` writes it",
            });
        }
        Ok(told)
    }

    /// `pivot` is the origin of the surface's frame, in that of the sensor, and `measured` the noise of the rest.
    pub(crate) fn build<T: Real>(
        &self,
        pivot: &Vector3<f64>,
        measured: &Vector6<f64>,
        sensor: Option<&SensorSource>,
    ) -> Result<Uncertainty<T>, SceneProblem> {
        let number = T::literal;
        let floor = self.noise(measured)?.map(number);
        let same = |deviation: f64| Matrix3::identity() * number(deviation * deviation);
        let deviations = [self.offset_m, self.position_m, self.attitude_deg];
        let good = deviations.iter().all(|deviation| *deviation >= 0.0 && deviation.is_finite());
        BadShape::check("uncertainty", "standard deviations", "finite and not negative", good)?;
        let within = self.probability > 0.0 && self.probability < 1.0;
        BadShape::check("uncertainty", "probability", "between 0 and 1", within)?;
        let geometry = GeometryUncertainty {
            offset: number(self.offset_m * self.offset_m),
            position: same(self.position_m),
            attitude: same(self.attitude_deg.to_radians()),
            pivot: pivot.map(number),
        };
        Ok(Uncertainty {
            noise: WrenchNoise::new(floor, number(self.relative))?,
            geometry: geometry.checked()?,
            exact: deviations == [0.0; 3],
            calibration: self.calibration(sensor)?,
            probability: number(self.probability),
        })
    }
}

/// What is uncertain of a fingertip: its wrench, by noise and by calibration, and where its surface is.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::Scene;
///
/// // A calibration that is not there cannot be counted.
/// let noise = "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n";
/// assert!(Scene::from_text(&format!("{BALL}{noise}"))?.tells().spread);
/// assert!(Scene::from_text(&format!("{BALL}{noise}calibration = true\n")).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty<T: Real> {
    pub(crate) noise: WrenchNoise<T>,
    pub(crate) geometry: GeometryUncertainty<T>,
    /// Whether the geometry is taken to be known exactly.
    pub(crate) exact: bool,
    /// What the fit of the calibration leaves uncertain, if that is known.
    pub(crate) calibration: Option<CalibrationUncertainty<T>>,
    pub(crate) probability: T,
}

/// How sure a contact is: standard deviations to first order.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip::wrench::Wrench;
/// use fingertip_scene::Scene;
/// use nalgebra::Vector3;
///
/// let noise = "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n";
/// let mut pipeline = Scene::from_text(&format!("{BALL}{noise}"))?.pipeline();
/// let mut axis = |newtons: f64| {
///     let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.0, 0.0, -newtons));
///     pipeline.sense(push, 1e-3).spread.map(|spread| spread.ellipse.semi_axes[0])
/// };
/// let (soft, firm) = (axis(1.0).ok_or("a spread")?, axis(4.0).ok_or("a spread")?);
/// assert!((soft / firm - 4.0).abs() < 1e-6); // the firmer, the surer
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Serialize", deserialize = "T: Deserialize<'de>"))]
pub struct Spread<T: Real> {
    /// The ellipse in the tangent plane in which the contact lies with the probability that the scene asks for.
    pub ellipse: ConfidenceEllipse<T>,
    /// Standard deviation of the normal force \[N\].
    pub normal_force: T,
    /// Standard deviation of the spin torque \[N·m\].
    pub spin_torque: T,
}

impl<T: Real> Uncertainty<T> {
    /// Covariance of a wrench at rest.
    pub(crate) fn at_rest(&self) -> Matrix6<T> {
        Matrix6::from_diagonal(&self.noise.floor.component_mul(&self.noise.floor))
    }

    /// Standard deviation of the noisiest component of the force at rest \[N\].
    pub(crate) fn force_noise(&self) -> T {
        self.noise.floor.fixed_rows::<3>(0).amax()
    }

    /// Covariance of a wrench: that of its noise, and what the calibration adds under this load.
    pub(crate) fn of_wrench(&self, wrench: &Wrench<T>) -> Matrix6<T> {
        let noise = self.noise.covariance(wrench);
        match &self.calibration {
            Some(calibration) => noise + calibration.covariance(wrench),
            None => noise,
        }
    }

    /// How sure a contact with these derivatives is, under this wrench; `None` where that cannot be said.
    pub(crate) fn of(&self, jacobian: &ContactJacobian<T>, wrench: &Wrench<T>) -> Option<Spread<T>> {
        let mut covariance = ContactCovariance::new(jacobian, &self.of_wrench(wrench));
        if !self.exact {
            covariance = covariance.with_geometry(jacobian, &self.geometry);
        }
        let root = |variance: T| variance.max(T::zero()).root();
        let spread = Spread {
            ellipse: covariance.ellipse(self.probability)?,
            normal_force: root(covariance.normal_force_variance()),
            spin_torque: root(covariance.spin_variance()),
        };
        (spread.normal_force + spread.spin_torque).is_number().then_some(spread)
    }
}
