//! Samples to touches.

use fingertip::surfaces::SmoothSurface as _;
use fingertip::wrench::{RigidTransform, Sensor};
use fingertip_calibration::object::ObjectPoint;
use fingertip_scene::Pipeline;
use nalgebra::{Matrix3, Vector3};

use super::Object;

/// Gathers samples of one contact through which the fingertip hardly moves into a touch, their mean: they share what their pose
/// is off by, so that they are not as many touches.
pub(super) struct Touched {
    apart: f64,
    samples: u64,
    touches: Vec<ObjectPoint>,
    gathered: Option<Gathered>,
}

/// Samples whose poses are near that of the first of them, each with a weight.
struct Gathered {
    first: RigidTransform<f64, Object, Sensor>,
    weight: f64,
    point: Vector3<f64>,
    normal: Vector3<f64>,
    covariance: Matrix3<f64>,
    bend: Matrix3<f64>,
}

impl Gathered {
    fn begin(first: RigidTransform<f64, Object, Sensor>) -> Self {
        let (zero, none) = (Vector3::zeros(), Matrix3::zeros());
        Self { first, weight: 0.0, point: zero, normal: zero, covariance: none, bend: none }
    }

    fn add(&mut self, touch: &ObjectPoint, weight: f64) {
        self.weight += weight;
        self.point += touch.point * weight;
        self.normal += touch.normal * weight;
        self.covariance += touch.covariance * weight;
        self.bend += touch.bend * weight;
    }

    /// The covariance is that of a sample: what is wrong with all of them no mean makes smaller.
    fn mean(&self) -> ObjectPoint {
        let Self { weight, .. } = *self;
        ObjectPoint {
            point: self.point / weight,
            normal: self.normal / weight,
            covariance: self.covariance / weight,
            bend: self.bend / weight,
        }
    }
}

/// How far a fingertip has moved [m]: its sensor, and what is `lever` away from that by the turn. (A place on a rolling fingertip
/// stands still while it touches, but the turn tells that it rolls.)
fn moved(
    first: &RigidTransform<f64, Object, Sensor>,
    now: &RigidTransform<f64, Object, Sensor>,
    lever: f64,
) -> f64 {
    // Of a turn by θ the rotations differ by √8 sin(θ/2) in the norm of Frobenius.
    let turn = 2.0 * ((now.rotation() - first.rotation()).norm() / 8.0_f64.sqrt()).min(1.0).asin();
    (now.origin() - first.origin()).norm() + turn * lever
}

impl Touched {
    pub(super) const fn new(apart: f64) -> Self {
        Self { apart, samples: 0, touches: Vec::new(), gathered: None }
    }

    /// Nothing touches any more.
    pub(super) fn release(&mut self) {
        self.touches.extend(self.gathered.take().map(|gathered| gathered.mean()));
    }

    /// What the pipeline has just sensed, where the sensor has this pose; without one the sample is left out.
    pub(super) fn sample(
        &mut self,
        pipeline: &Pipeline<f64>,
        pose: Option<&RigidTransform<f64, Object, Sensor>>,
    ) {
        let felt = pipeline.felt();
        let (Some(contact), Some(pose)) = (felt.contact(), pose) else { return self.release() };
        let (place, normal) = match &felt.tracked {
            Some(tracked) => (tracked.point, tracked.normal),
            None => (contact.point, contact.normal),
        };
        let covariance = pipeline.place_covariance().unwrap_or_default();
        let bend = pipeline.surface().shape_operator(&place);
        let touch = ObjectPoint::of_touch(pose, &place, &normal, &covariance, &bend);
        // The place is as uncertain as the force is small.
        let weight = contact.force.norm_squared();
        if !(touch.point + touch.normal).iter().chain(&touch.bend).all(|x| x.is_finite()) || !(weight > 0.0) {
            return self.release();
        }
        self.samples += 1;
        let is_near = |gathered: &Gathered| moved(&gathered.first, pose, place.norm()) <= self.apart;
        if !self.gathered.as_ref().is_some_and(is_near) {
            self.touches.extend(self.gathered.take().map(|gathered| gathered.mean()));
        }
        self.gathered.get_or_insert_with(|| Gathered::begin(*pose)).add(&touch, weight);
    }

    /// How many samples there were, and the touches that they make.
    pub(super) fn finish(mut self) -> (u64, Vec<ObjectPoint>) {
        self.release();
        (self.samples, self.touches)
    }
}

#[cfg(test)]
mod tests {
    use super::{Gathered, Object, Touched};
    use fingertip::wrench::{RigidTransform, Sensor, Wrench};
    use fingertip_calibration::object::ObjectPoint;
    use fingertip_scene::Scene;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn a_touch_is_the_mean_of_its_samples_by_their_weights() {
        let sample = |x: f64| ObjectPoint {
            point: Vector3::new(x, 0.0, 2.0),
            normal: Vector3::new(0.0, x, 1.0),
            covariance: Matrix3::from_diagonal(&Vector3::new(x, 1.0, 0.0)),
            bend: Matrix3::from_diagonal(&Vector3::new(70.0, 10.0 * x, 0.0)),
        };
        let mut gathered = Gathered::begin(RigidTransform::identity());
        gathered.add(&sample(4.0), 0.5);
        gathered.add(&sample(8.0), 1.5);
        assert_eq!(gathered.mean(), sample(7.0));
    }

    const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\n\
        radius_m = 0.013\n[contact]\nleast_force_N = 0.0\n";

    /// A force whose square is no number above zero has no weight, and would make a touch of no place.
    #[test]
    fn forces_too_weak_to_count_are_no_touch() {
        let pose: RigidTransform<f64, Object, Sensor> = RigidTransform::identity();
        let mut pipeline = Scene::from_text(BALL).unwrap().pipeline();
        for (force, touches) in [(1.0, 1), (1e-150, 1), (1e-170, 0), (1e-300, 0), (0.0, 0)] {
            let mut touched = Touched::new(1e-3);
            pipeline.sense(Wrench::from_force_at(&Vector3::zeros(), Vector3::new(0.0, 0.0, -force)), 0.0);
            touched.sample(&pipeline, Some(&pose));
            let (samples, found) = touched.finish();
            assert_eq!((samples, found.len()), (touches, touches as usize), "{force} N");
            assert!(found.iter().all(|touch| (touch.point.z - 0.013).abs() < 1e-12), "{found:?}");
        }
    }
}
