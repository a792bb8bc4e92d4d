//! `[fusion]`: a tactile array in the skin beside the wrench, which tells one to four contacts at once.

use fingertip::contact::{ArrayContact, FusedContact, Fusion};
use fingertip::surfaces::{BadShape, DynSurface};
use fingertip::wrench::{Real, Wrench};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::fault::SceneProblem;
use crate::pipeline::Pipeline;
use crate::uncertainty::Uncertainty;

/// Most contacts that are told apart.
const MOST: usize = 4;

/// `[fusion]` of a scene: how well the array tells a contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FusionSection {
    /// Standard deviation of a centroid, in each direction along the surface.
    position_deviation_m: f64,
    /// Standard deviation of a normal force.
    #[serde(rename = "normal_deviation_N")]
    normal_deviation: f64,
    /// Of a normal force, as a share of it.
    #[serde(default)]
    relative_deviation: f64,
    /// What holds a tangential force; that of `[friction]` without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    static_coefficient: Option<f64>,
    /// How many places of the array there are.
    #[serde(default = "usual_places")]
    places: usize,
}

const fn usual_places() -> usize {
    2
}

/// What one place of a tactile array reads: where it is pressed, and how hard.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip::wrench::Wrench;
/// use fingertip_scene::{ArrayReading, Scene};
/// use nalgebra::Vector3;
///
/// let rest = "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n\
///             [fusion]\nposition_deviation_m = 0.001\nnormal_deviation_N = 0.1\nstatic_coefficient = 0.8\n";
/// let mut pipeline = Scene::from_text(&format!("{BALL}{rest}"))?.pipeline();
/// pipeline.sense(Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.0, 0.0, -2.0)), 1e-3);
/// // The array is off by half a millimetre and a tenth of a newton.
/// let reading = ArrayReading { centroid: Vector3::new(0.0005, 0.0, 0.013), normal_force: 2.1 };
/// let fused = pipeline.fuse(&[reading])?;
/// let contact = fused.contacts[0].as_ref().ok_or("one contact")?;
/// assert!(contact.point.x.abs() < 1e-4); // the wrench knows better
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Serialize", deserialize = "T: Deserialize<'de>"))]
pub struct ArrayReading<T: Real> {
    /// Centroid of the pressure, in the sensor frame \[m\].
    pub centroid: Vector3<T>,
    /// Sum of the pressure \[N\].
    pub normal_force: T,
}

/// What wrench and array say together.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip::wrench::Wrench;
/// use fingertip_scene::{ArrayReading, Scene};
/// use nalgebra::Vector3;
///
/// let rest = "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n\
///             [fusion]\nposition_deviation_m = 0.001\nnormal_deviation_N = 0.1\nstatic_coefficient = 0.8\n";
/// let mut pipeline = Scene::from_text(&format!("{BALL}{rest}"))?.pipeline();
/// let places = [Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.013, 0.0, 0.0)];
/// // It is pressed from above and, as the array alone does not see, from the side.
/// let both = places.map(|place| Wrench::from_force_at(&place, -place.normalize() * 2.0));
/// pipeline.sense(both[0] + both[1], 1e-3);
/// let reading = |place: usize| ArrayReading { centroid: places[place], normal_force: 2.0 };
/// let (one, two) = (pipeline.fuse(&[reading(0)])?, pipeline.fuse(&[reading(0), reading(1)])?);
/// assert_eq!(two.contacts.iter().flatten().count(), 2);
/// assert!(one.disagreement > 50.0 && two.disagreement < 10.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Serialize", deserialize = "T: Deserialize<'de>"))]
pub struct FusedTouch<T: Real> {
    /// The contacts, in the order of the readings; none behind the last of them.
    pub contacts: [Option<FusedContact<T>>; MOST],
    /// How far the wrench is from what the array alone predicts: follows χ² with six degrees of freedom if all is right.
    /// Much more, and a contact is missing.
    pub disagreement: T,
    /// Dimension of the forces that the wrench cannot see, since they cancel.
    pub internal_forces: u8,
    /// Whether the estimate came to rest.
    pub settled: bool,
}

/// Why wrench and array say nothing together.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::{NoFusion, Scene};
///
/// let pipeline = Scene::from_text(BALL)?.pipeline();
/// assert_eq!(pipeline.fuse(&[]), Err(NoFusion::NoSection));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoFusion {
    /// The scene has no `[fusion]`.
    #[error("the scene has no [fusion] that tells how well an array reads")]
    NoSection,
    /// The noise of the rest is asked for and not known.
    #[error("the noise of the rest, which [uncertainty] asks for, is not known yet")]
    AwaitsNoise,
    /// None or too many.
    #[error("{0} readings of an array; one to four can be told apart")]
    Readings(usize),
    /// A reading or the wrench is no number, or a reading is not near the surface.
    #[error(transparent)]
    Reading(#[from] BadShape),
}

/// Joins a wrench with the readings of an array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Joined<T: Real> {
    pub(crate) position_variance: T,
    pub(crate) normal_deviation: T,
    pub(crate) relative: T,
    pub(crate) friction: T,
    pub(crate) places: usize,
}

fn wrong(key: &'static str, requirement: &'static str) -> SceneProblem {
    SceneProblem::Range { key, section: "fusion", requirement }
}

impl FusionSection {
    /// `coefficient` is that of `[friction]`.
    pub(crate) fn build<T: Real>(
        &self,
        uncertainty: Option<&Uncertainty<T>>,
        coefficient: Option<T>,
    ) -> Result<Joined<T>, SceneProblem> {
        let Some(uncertainty) = uncertainty else {
            return Err(SceneProblem::Needs {
                what: "[fusion]",
                needed: "the section [uncertainty], which tells how much the wrench counts beside the array",
            });
        };
        let good = |value: f64, least: bool| (value > 0.0 || (least && value == 0.0)) && value < 1e6;
        for (key, value, least, requirement) in [
            ("position_deviation_m", self.position_deviation_m, true, "finite and not negative"),
            ("normal_deviation_N", self.normal_deviation, false, "positive and finite"),
            ("relative_deviation", self.relative_deviation, true, "finite and not negative"),
        ] {
            if !good(value, least) {
                return Err(wrong(key, requirement));
            }
        }
        if !(1..=MOST).contains(&self.places) {
            return Err(wrong("places", "a number from 1 to 4"));
        }
        let Some(friction) = self.static_coefficient.map(T::literal).or(coefficient) else {
            return Err(SceneProblem::Needs {
                what: "[fusion]",
                needed: "`static_coefficient`, or the section [friction]",
            });
        };
        if !(friction > T::zero() && friction.is_number()) {
            return Err(wrong("static_coefficient", "positive and finite"));
        }
        // What is wrong with the noise is said before the first sample.
        Fusion::new(uncertainty.at_rest(), friction).map_err(|_| SceneProblem::Range {
            key: "force_noise_N",
            section: "uncertainty",
            requirement: "positive, and so must `torque_noise_Nm`, where a [fusion] weighs the wrench by it",
        })?;
        let number = T::literal;
        Ok(Joined {
            position_variance: number(self.position_deviation_m * self.position_deviation_m),
            normal_deviation: number(self.normal_deviation),
            relative: number(self.relative_deviation),
            friction,
            places: self.places,
        })
    }
}

impl<T: Real> Joined<T> {
    /// What a reading is to the estimate.
    fn contact(&self, reading: &ArrayReading<T>) -> ArrayContact<T> {
        let relative = self.relative * reading.normal_force;
        let variance = self.normal_deviation * self.normal_deviation + relative * relative;
        ArrayContact {
            centroid: reading.centroid,
            centroid_covariance: Matrix3::from_diagonal_element(self.position_variance),
            normal_force: reading.normal_force,
            normal_deviation: variance.root(),
        }
    }

    /// The most probable contacts under a wrench.
    pub(crate) fn contacts(
        &self,
        surface: &DynSurface<T>,
        uncertainty: &Uncertainty<T>,
        wrench: &Wrench<T>,
        readings: &[ArrayReading<T>],
    ) -> Result<FusedTouch<T>, NoFusion> {
        match readings {
            [a] => self.of(surface, uncertainty, wrench, [a]),
            [a, b] => self.of(surface, uncertainty, wrench, [a, b]),
            [a, b, c] => self.of(surface, uncertainty, wrench, [a, b, c]),
            [a, b, c, d] => self.of(surface, uncertainty, wrench, [a, b, c, d]),
            other => Err(NoFusion::Readings(other.len())),
        }
    }

    fn of<const K: usize>(
        &self,
        surface: &DynSurface<T>,
        uncertainty: &Uncertainty<T>,
        wrench: &Wrench<T>,
        readings: [&ArrayReading<T>; K],
    ) -> Result<FusedTouch<T>, NoFusion> {
        let fusion = Fusion::new(uncertainty.of_wrench(wrench), self.friction)?;
        let fused = fusion.estimate(surface, wrench, &readings.map(|reading| self.contact(reading)))?;
        Ok(FusedTouch {
            contacts: core::array::from_fn(|place| fused.contacts.get(place).copied()),
            disagreement: fused.disagreement,
            internal_forces: fused.internal_forces,
            settled: fused.settled,
        })
    }
}

impl<T: Real> Pipeline<T> {
    /// The contacts that the wrench of the last sample and the readings of a tactile array tell together, of a scene with
    /// `[fusion]`: one for each reading, one to four. Nothing of it is carried to the next sample.
    ///
    /// ```
    /// use fingertip::wrench::Wrench;
    /// use fingertip_scene::{ArrayReading, Scene};
    /// use nalgebra::Vector3;
    ///
    /// let scene = Scene::from_text(
    ///     r#"
    ///     version = 2
    ///     [input]
    ///     convention = "on_fingertip"
    ///     [surface]
    ///     shape = "sphere"
    ///     radius_m = 0.013
    ///     [uncertainty]
    ///     force_noise_N = 0.01
    ///     torque_noise_Nm = 0.0001
    ///     [fusion]
    ///     position_deviation_m = 0.001
    ///     normal_deviation_N = 0.1
    ///     static_coefficient = 0.5
    ///     "#,
    /// )?;
    /// // An object between two sides of one fingertip: the wrench alone sees hardly anything of it.
    /// let (left, right) = (Vector3::new(-0.013, 0.0, 0.0), Vector3::new(0.013, 0.0, 0.0));
    /// let first: Wrench<f64> = Wrench::from_force_at(&left, Vector3::new(1.0, 0.2, 0.0));
    /// let second: Wrench<f64> = Wrench::from_force_at(&right, Vector3::new(-1.1, 0.2, 0.0));
    /// let mut pipeline = scene.pipeline();
    /// pipeline.sense(Wrench::from_components(&(first.components() + second.components())), 1e-3);
    /// let pressed = |centroid, normal_force| ArrayReading { centroid, normal_force };
    /// let touch = pipeline.fuse(&[pressed(left, 1.05), pressed(right, 1.05)])?;
    /// let [Some(first), Some(second), None, None] = touch.contacts else { panic!("two were pressed") };
    /// assert!((first.force.x - 1.0).abs() < 0.1 && (second.force.y - 0.2).abs() < 0.05);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`NoFusion`].
    pub fn fuse(&self, readings: &[ArrayReading<T>]) -> Result<FusedTouch<T>, NoFusion> {
        let fusion = self.fusion().ok_or(NoFusion::NoSection)?;
        if self.awaits_noise() {
            return Err(NoFusion::AwaitsNoise);
        }
        let uncertainty = self.uncertainty().ok_or(NoFusion::NoSection)?;
        fusion.contacts(self.surface(), uncertainty, &self.felt().touch.wrench, readings)
    }

    /// How many places the array of `[fusion]` has; `None` for a scene without one.
    pub fn array_places(&self) -> Option<usize> {
        self.fusion().map(|fusion| fusion.places)
    }
}
