//! `[payload]`: what the sensor carries, whose weight and inertia are no contact.

use std::path::{Path, PathBuf};

use fingertip::wrench::{InertialReading, Motion, Payload, Real, Wrench};
use fingertip_calibration::file::PayloadFile;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::fault::{BadCarried, SceneProblem};
use crate::inertial::{InertialSection, Moving};
use crate::named::Folder;

/// `[payload]` of a scene: a file, or the numbers themselves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PayloadSection {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
    #[serde(rename = "mass_kg", skip_serializing_if = "Option::is_none")]
    mass: Option<f64>,
    #[serde(rename = "centre_of_mass_m", skip_serializing_if = "Option::is_none")]
    centre_of_mass: Option<[f64; 3]>,
    /// About the centre of mass.
    #[serde(rename = "inertia_kg_m2", skip_serializing_if = "Option::is_none")]
    inertia: Option<[[f64; 3]; 3]>,
    /// In the frame in which orientations are given.
    #[serde(rename = "gravity_m_per_s2", skip_serializing_if = "Option::is_none")]
    gravity: Option<[f64; 3]>,
}

/// Standard gravity, downwards \[m/s²\].
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.806_65];

/// What the sensor carries, as it was read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PayloadSource {
    file: PayloadFile,
}

impl PayloadSource {
    pub(crate) fn read(path: &Path, inertia: Option<[[f64; 3]; 3]>) -> Result<Self, SceneProblem> {
        let name = || format!("payload {}", path.display());
        let mut file = PayloadFile::read(path)
            .map_err(|source| SceneProblem::Payload { name: name(), source: Box::new(source.into()) })?;
        file.inertia = inertia.unwrap_or(file.inertia);
        Ok(Self { file })
    }

    /// What hangs on the sensor, with the inertial unit that tells how it moves, if there is one.
    pub(crate) fn build<T: Real>(
        &self,
        unit: Option<&InertialSection>,
        sample_rate: Option<f64>,
    ) -> Result<Carried<T>, SceneProblem> {
        let body = self.body::<T>().map_err(unusable)?;
        let of_file = self.file.inertial_unit.as_ref();
        let moving = unit.map(|unit| unit.build(of_file, body, sample_rate)).transpose()?;
        Ok(Carried {
            body,
            bias: Wrench::from_components(&self.file.bias().components().map(T::literal)),
            file: self.file.clone(),
            moving: moving.map(Box::new),
            resting: None,
            at_tare: None,
        })
    }

    fn body<T: Real>(&self) -> Result<Payload<T>, BadCarried> {
        let inertia = Matrix3::from_fn(|i, j| T::literal(self.file.inertia[i][j]));
        let of_a_point = PayloadFile { inertia: [[0.0; 3]; 3], ..self.file.clone() };
        Ok(of_a_point.payload::<T>()?.with_inertia(inertia)?)
    }
}

fn unusable(source: BadCarried) -> SceneProblem {
    SceneProblem::Payload { name: "[payload]".to_owned(), source: Box::new(source) }
}

impl PayloadSection {
    /// Reads what it names; files are looked for in `folder`.
    pub(crate) fn source(&self, folder: &Folder<'_>) -> Result<PayloadSource, SceneProblem> {
        let misplaced = |key| SceneProblem::Misplaced {
            section: "payload",
            key,
            belongs: "a payload without `file`, which has its own",
        };
        match (&self.file, self.mass) {
            (Some(_), Some(_)) => Err(misplaced("mass_kg")),
            (Some(_), None) if self.centre_of_mass.is_some() => Err(misplaced("centre_of_mass_m")),
            (Some(_), None) if self.gravity.is_some() => Err(misplaced("gravity_m_per_s2")),
            (Some(file), None) => PayloadSource::read(&folder.file(file), self.inertia),
            (None, Some(mass)) => {
                let centre = self.centre_of_mass.unwrap_or_default();
                let gravity = self.gravity.unwrap_or(GRAVITY);
                let file = PayloadFile::new(mass, centre.into(), gravity.into());
                let file = file.map_err(|source| unusable(source.into()))?;
                let inertia = self.inertia.unwrap_or_default();
                Ok(PayloadSource { file: PayloadFile { inertia, ..file } })
            }
            (None, None) => {
                let needed = "`file`, as `fingertip calibrate --gravity` writes it, or `mass_kg`";
                Err(SceneProblem::Needs { what: "[payload]", needed })
            }
        }
    }
}

/// What hangs on the sensor, and how it hung when the zero was taken.
///
/// A zero taken with the body on holds its weight as it then hung: a rest says how, by
/// [`rest`](Self::rest) and [`end_rest`](Self::end_rest), and only what changed since is taken off. Without a rest the
/// bias of the payload's file is.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip::wrench::{Motion, Wrench};
/// use fingertip_scene::Scene;
/// use nalgebra::Vector3;
///
/// // 100 g hang on the sensor, 20 mm out.
/// let payload = "[payload]\nmass_kg = 0.1\ncentre_of_mass_m = [0.0, 0.0, 0.02]\n";
/// let scene = Scene::from_text(&format!("{BALL}{payload}"))?;
/// let carried = scene.carried().ok_or("it carries something")?;
/// // The sensor lies on its side: the quaternion turns it by 90° about y.
/// let half = 0.5_f64.sqrt();
/// let gravity = carried.gravity([0.0, half, 0.0, half]).ok_or("an orientation")?;
/// let weight = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.02), gravity * 0.1);
/// let left = carried.take_off(&weight, &Motion::resting(gravity));
/// assert!(left.force().norm() < 1e-12 && left.torque().norm() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Carried<T: Real> {
    /// Gravity, and how the sensor sits on the flange.
    file: PayloadFile,
    body: Payload<T>,
    bias: Wrench<T>,
    /// Takes it off by the readings of an inertial unit.
    moving: Option<Box<Moving<T>>>,
    /// Sum and number of the gravities \[m/s²\] during a rest.
    resting: Option<(Vector3<T>, u32)>,
    /// Gravity in the sensor frame when the zero was taken.
    at_tare: Option<Vector3<T>>,
}

impl<T: Real> Carried<T> {
    /// Gravity in the sensor frame \[m/s²\], from the orientation that is recorded, a quaternion (x, y, z, w) of any
    /// length; `None` if it is zero or not finite.
    #[must_use]
    pub fn gravity(&self, quaternion: [T; 4]) -> Option<Vector3<T>> {
        Some(self.file.gravity_at(quaternion.map(Real::to_f64))?.map(T::literal))
    }

    /// Takes how the sensor lies at a reading of the rest: gravity in its frame \[m/s²\].
    pub fn rest(&mut self, gravity: &Vector3<T>) {
        let (sum, number) = self.resting.unwrap_or((Vector3::zeros(), 0));
        self.resting = Some((sum + gravity, number.saturating_add(1)));
    }

    /// The zero was taken with the body on, as it hung on average in the rest.
    pub fn end_rest(&mut self) {
        if let Some((sum, number)) = self.resting.take() {
            let gravity = sum / T::literal(f64::from(number));
            self.at_tare = Some(gravity);
            if let Some(moving) = &mut self.moving {
                moving.zeroed_under(gravity);
            }
        }
    }

    /// Whether the scene has an `[inertial_unit]`, whose readings tell how the sensor moves.
    #[must_use]
    pub const fn has_inertial_unit(&self) -> bool {
        self.moving.is_some()
    }

    /// By how much what is left behind the `[inertial_unit]` comes late \[s\]; 0 without one.
    #[must_use]
    pub fn delay(&self) -> T {
        self.moving.as_ref().map_or_else(T::zero, |moving| moving.delay())
    }

    /// Takes what the inertial unit reads in the rest, for [`end_rest`](Self::end_rest); `false` without an
    /// `[inertial_unit]` or for a number that is not finite.
    pub fn rest_moving(&mut self, reading: &InertialReading<T>) -> bool {
        let gravity = self.moving.as_ref().map(|moving| moving.gravity(reading));
        let Some(gravity) = gravity.filter(|gravity| gravity.iter().all(|x| x.is_number())) else {
            return false;
        };
        self.rest(&gravity);
        true
    }

    /// A wrench without what the body does to the sensor, by what the `[inertial_unit]` reads; it comes late by
    /// [`delay`](Self::delay). `None` without such a section, and for a number that is not finite: the sample is left out.
    #[inline]
    pub fn take_off_moving(
        &mut self,
        measured: &Wrench<T>,
        reading: &InertialReading<T>,
        time_step: T,
    ) -> Option<Wrench<T>> {
        let moving = self.moving.as_mut()?;
        let unbiased = if self.at_tare.is_some() { *measured } else { *measured - self.bias };
        moving.take_off(&unbiased, reading, time_step)
    }

    /// The next reading of the inertial unit is the first, as after a pause.
    pub fn start_anew(&mut self) {
        if let Some(moving) = &mut self.moving {
            moving.start_anew();
        }
    }

    pub(crate) const fn body(&self) -> &Payload<T> {
        &self.body
    }

    pub(crate) const fn bias(&self) -> &Wrench<T> {
        &self.bias
    }

    /// A wrench without what the body does to the sensor.
    #[inline]
    #[must_use]
    pub fn take_off(&self, measured: &Wrench<T>, motion: &Motion<T>) -> Wrench<T> {
        match &self.at_tare {
            Some(at_tare) => {
                let gravity = motion.gravity - at_tare;
                *measured - self.body.load(&Motion { gravity, ..*motion })
            }
            None => *measured - self.bias - self.body.load(motion),
        }
    }
}
