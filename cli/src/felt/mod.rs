//! Live samples through a scene: sign, tare, contact, slip.

mod noise;
pub(crate) mod rest;

use fingertip::contact::{ConfidenceEllipse, ContactCovariance, ContactJacobian, Resolution};
use fingertip::wrench::Wrench;
use fingertip_scene::{Convention, Pipeline, Scene};
use nalgebra::{Matrix3, Vector6};

use crate::observe::SceneTouch;
pub(crate) use noise::NoiseWatch;
pub(crate) use rest::{NoZero, Rest};

/// The pipeline of a scene, with the tare that the scene asks for.
pub(crate) struct SceneFeel {
    convention: Convention,
    pipeline: Pipeline<f64>,
    rest: Rest,
    last: Option<f64>,
}

impl SceneFeel {
    /// `tared` if the wrenches have their zero taken off already, so that the scene's rest does not count.
    pub(crate) fn new(scene: &Scene, tared: bool) -> Self {
        let rest = Rest::new(scene.rest().filter(|_| !tared));
        Self { convention: scene.convention(), pipeline: scene.pipeline(), rest, last: None }
    }

    /// How noisy the sensor is at rest, for a scene that asks.
    pub(crate) fn know_noise(&mut self, noise: &Vector6<f64>) {
        // A noise that is none leaves the scene waiting, and no force is a contact.
        let _ = self.pipeline.know_noise(noise);
    }

    /// Whether the scene asks for the noise of a rest.
    pub(crate) const fn awaits_noise(&self) -> bool {
        self.pipeline.awaits_noise()
    }

    /// Forgets the samples before: the next one is as after a gap. What was learnt of the friction stays.
    pub(crate) fn start_anew(&mut self) {
        self.pipeline.start_anew();
        self.last = None;
    }

    /// What a sample means; `None` while the zero is taken.
    pub(crate) fn feel(&mut self, time: f64, reported: &Wrench<f64>) -> Result<Option<SceneTouch>, NoZero> {
        let Some(tared) = self.rest.take(time, reported)? else { return Ok(None) };
        if self.pipeline.awaits_noise()
            && let Some(noise) = self.rest.noise()
        {
            self.know_noise(&noise);
        }
        let wrench = self.convention.wrench(tared.force(), tared.torque());
        let step = self.last.replace(time).map_or(0.0, |last| time - last);
        Ok(Some(self.pipeline.sense(wrench, step).touch))
    }
}

/// Where the contact lies with 95 %, by the noise of the wrench alone. A point contact's position does not
/// depend on the curvature of the surface.
pub(crate) fn ellipse(touch: &SceneTouch, noise: &NoiseWatch) -> Option<ConfidenceEllipse<f64>> {
    let Resolution::Contact(contact) = &touch.resolution else { return None };
    let jacobian = ContactJacobian::of_point_contact(contact, &touch.wrench, &Matrix3::zeros())?;
    let covariance = noise.wrench_noise()?.covariance(&touch.wrench);
    ContactCovariance::new(&jacobian, &covariance).ellipse(0.95)
}

#[cfg(test)]
mod tests {
    use fingertip::wrench::Wrench;
    use nalgebra::{Vector3, Vector6};

    use super::{NoiseWatch, Rest, SceneFeel, ellipse};
    use fingertip_scene::Scene;

    fn uniform(value: f64) -> Wrench<f64> {
        Wrench::from_components(&Vector6::repeat(value))
    }

    #[test]
    fn the_zero_is_the_mean_of_the_rest() {
        let mut rest = Rest::new(Some(0.5));
        // From 10.0 to 10.4 s at rest; what comes at 10.5 s does not belong to it.
        for (time, value) in [(10.0, 1.0), (10.25, 2.0), (10.4, 6.0)] {
            assert!(rest.is_resting());
            assert_eq!(rest.take(time, &uniform(value)).unwrap(), None);
        }
        assert_eq!(rest.take(10.5, &uniform(5.0)).unwrap(), Some(uniform(2.0)));
        assert!(!rest.is_resting());
        assert_eq!(*rest.zero(), Vector6::repeat(3.0));
        assert_eq!(rest.take(11.0, &uniform(3.0)).unwrap(), Some(uniform(0.0)));
        // No rest takes nothing off; one without samples is an error in one sentence.
        assert_eq!(Rest::new(None).take(0.0, &uniform(7.0)).unwrap(), Some(uniform(7.0)));
        let mut short = Rest::new(Some(0.5));
        assert_eq!(short.take(0.0, &uniform(f64::NAN)).unwrap(), None);
        let error = short.take(1.0, &uniform(1.0)).unwrap_err().to_string();
        assert!(
            error.starts_with("no zero from 0.5 s at rest: ") && error.contains("rest longer"),
            "{error}"
        );
    }

    const SCENE: &str = "version = 1\n[input]\nconvention = \"reaction\"\nrest_s = 0.1\n[surface]\nshape = \"SHAPE\"\n\
        [friction]\nstatic_coefficient = 0.5\n[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n";

    fn scene(shape: &str) -> Scene {
        Scene::from_text(&SCENE.replace("SHAPE\"", shape)).unwrap()
    }

    #[test]
    fn every_shape_is_felt_where_it_is_pressed() {
        for (shape, top) in [
            ("plane\"\npoint_m = [0.0, 0.0, 0.01]", 0.01),
            ("sphere\"\nradius_m = 0.02", 0.02),
            ("cylinder\"\nradius_m = 0.03\naxis = [1.0, 0.0, 0.0]", 0.03),
            ("ellipsoid\"\nsemi_axes_m = [0.01, 0.02, 0.04]", 0.04),
        ] {
            let push: Wrench<f64> =
                Wrench::from_force_at(&Vector3::new(0.0, 0.0, top), Vector3::new(0.1, 0.0, -1.0));
            let reaction = Wrench::from_components(&-push.components());
            // Behind its rest, or at once where the zero is taken off already.
            let mut feel = SceneFeel::new(&scene(shape), false);
            for time in [0.0, 0.05] {
                assert!(feel.feel(time, &uniform(0.3)).unwrap().is_none());
            }
            let biased = Wrench::from_components(&(reaction.components() + Vector6::repeat(0.3)));
            let behind = feel.feel(0.1, &biased).unwrap().unwrap();
            let at_once = SceneFeel::new(&scene(shape), true).feel(0.0, &reaction).unwrap().unwrap();
            for touch in [behind, at_once] {
                let contact = touch.resolution.contact().unwrap();
                assert!((contact.point - Vector3::new(0.0, 0.0, top)).norm() < 1e-12, "{shape}: {contact:?}");
                assert!((touch.wrench.components() - push.components()).norm() < 1e-12);
                assert!((touch.force.unwrap().normal - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn after_a_pause_nothing_is_known_of_the_contact() {
        // A push along −x enters a torus twice, at x = 40 mm and at x = −20 mm: that which is nearer to the last
        // contact is meant. The contact before is on the inner wall on the left, where the line enters only once.
        let torus = "torus\"\nring_radius_m = 0.03\ntube_radius_m = 0.01";
        let push = |point: Vector3<f64>, force: Vector3<f64>| -> Wrench<f64> {
            let wrench: Wrench<f64> = Wrench::from_force_at(&point, force);
            Wrench::from_components(&-wrench.components())
        };
        let left = push(Vector3::new(0.0, 0.0, 0.012), Vector3::new(-1.0, 0.0, -0.7));
        let twice = push(Vector3::zeros(), -Vector3::x());
        let met = |feel: &mut SceneFeel, time: f64, wrench: &Wrench<f64>| {
            let touch = feel.feel(time, wrench).unwrap().unwrap();
            touch.resolution.contact().unwrap().point.x
        };
        let fresh = met(&mut SceneFeel::new(&scene(torus), true), 0.0, &twice);
        assert!((fresh - 0.04).abs() < 1e-9, "{fresh}");
        for (pause, expected) in [(0.01, -0.02), (0.5, -0.02), (0.51, 0.04)] {
            let mut feel = SceneFeel::new(&scene(torus), true);
            assert!(met(&mut feel, 0.0, &left) < -0.02);
            let found = met(&mut feel, pause, &twice);
            assert!((found - expected).abs() < 1e-9, "{found} after {pause} s");
        }
    }

    /// Where a slip is told, is the same by the first samples that ever came and by those behind a reset.
    #[test]
    fn behind_a_reset_slips_are_told_as_at_the_start() {
        let scene = scene("plane\"");
        // A load that rises, and slips at once.
        let rows = |begin: f64| {
            (0..60_u32).map(move |row| {
                let pull = if row % 20 < 13 { 0.05 * f64::from(row % 20) } else { 0.3 };
                let force = Vector3::new(pull, 0.0, -2.0);
                let load: Wrench<f64> = Wrench::from_force_at(&Vector3::zeros(), force);
                (begin + f64::from(row) * 1e-3, Wrench::from_components(&-load.components()))
            })
        };
        let told = |feel: &mut SceneFeel, begin: f64| -> Vec<_> {
            rows(begin).map(|(time, wrench)| feel.feel(time, &wrench).unwrap().unwrap().slip).collect()
        };
        let expected = told(&mut SceneFeel::new(&scene, true), 0.0);
        assert!(expected.iter().any(|slip| *slip != expected[0]), "{expected:?}");
        for pause in [1e-3, 7e-3, 0.1, 0.4, 3.0] {
            let mut feel = SceneFeel::new(&scene, true);
            told(&mut feel, 0.0);
            feel.start_anew();
            assert_eq!(told(&mut feel, 0.059 + pause), expected, "{pause} s");
        }
    }

    #[test]
    fn the_ellipse_is_that_of_the_noise() {
        let mut noise = NoiseWatch::default();
        let mut feel = SceneFeel::new(&scene("plane\""), true);
        let load = Wrench::from_force_at(&Vector3::zeros(), Vector3::new(0.0, 0.0, 1.0));
        let touch = feel.feel(0.0, &load).unwrap().unwrap();
        assert!(touch.resolution.contact().is_some() && ellipse(&touch, &noise).is_none());
        for sample in 0..400_u32 {
            // Second differences of ±a are ±4a: a deviation of 0.01 N·m in the two torques that move the point.
            let deviation = if sample.is_multiple_of(2) { 1.0 } else { -1.0 } * 0.01 * 6.0_f64.sqrt() / 4.0;
            let wobble = Vector6::new(0.0, 0.0, 0.0, deviation, deviation, 0.0);
            noise.add(&Wrench::from_components(&(load.components() + wobble)));
        }
        // Under 1 N a torque of 0.01 N·m moves the point by 10 mm; 95 % of two dimensions is 2.4477 deviations.
        let ellipse = ellipse(&touch, &noise).unwrap();
        for axis in ellipse.semi_axes {
            assert!((axis / (0.01 * 2.447_746_8) - 1.0).abs() < 1e-4, "{axis}");
        }
    }
}
