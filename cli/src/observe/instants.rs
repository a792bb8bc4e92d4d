//! How sure contacts were, at some instants of a run.

use fingertip_scene::{Felt, Projection};
use nalgebra::Vector3;

/// Fewer than twice as many are kept.
const SOME: usize = 8;
/// Corners of an ellipse that is drawn.
const CORNERS: usize = 48;

/// A contact, and how sure it was.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    /// \[s\]
    pub(crate) time: f64,
    /// In the sensor frame \[m\].
    pub(crate) point: Vector3<f64>,
    /// Of the ellipse in which it lies \[m\].
    pub(crate) semi_axes: [f64; 2],
    /// Unit vectors along them.
    pub(crate) directions: [Vector3<f64>; 2],
    /// \[N\]
    pub(crate) normal_force: f64,
    /// Its standard deviation \[N\].
    pub(crate) deviation: f64,
}

/// Instants evenly spread over the contacts of a run, however many these are.
#[derive(Clone, Debug)]
pub(crate) struct Instants {
    kept: Vec<Instant>,
    /// Each so many contacts one is kept.
    stride: u64,
    seen: u64,
}

impl Default for Instants {
    fn default() -> Self {
        Self { kept: Vec::with_capacity(2 * SOME), stride: 1, seen: 0 }
    }
}

impl Instants {
    /// Takes the next contact, if the scene tells how sure it is.
    #[inline]
    pub(crate) fn add(&mut self, time: f64, felt: &Felt<f64>) {
        let Some(spread) = &felt.spread else { return };
        let due = self.seen.is_multiple_of(self.stride);
        self.seen += 1;
        let Some((contact, force)) = felt.contact().zip(felt.force()).filter(|_| due) else { return };
        self.kept.push(Instant {
            time,
            point: contact.point,
            semi_axes: spread.ellipse.semi_axes,
            directions: spread.ellipse.directions,
            normal_force: force.normal,
            deviation: spread.normal_force,
        });
        if self.kept.len() == 2 * SOME {
            let mut number = 0;
            self.kept.retain(|_| {
                number += 1;
                number % 2 == 1
            });
            self.stride *= 2;
        }
    }

    /// Those that are kept, in their order.
    pub(crate) fn kept(&self) -> &[Instant] {
        &self.kept
    }
}

impl Instant {
    /// The ellipse on a map, as a polygon; `None` where the map tears it apart, as at the edge of a cylinder that is
    /// unrolled.
    pub(crate) fn outline(&self, projection: &Projection) -> Option<Vec<(f64, f64)>> {
        let [a, b] = [0, 1].map(|k| self.directions[k] * self.semi_axes[k]);
        let corner = |k: usize| {
            let (sin, cos) = (core::f64::consts::TAU * k as f64 / CORNERS as f64).sin_cos();
            projection.project(&(self.point + a * cos + b * sin))
        };
        let outline: Vec<(f64, f64)> = (0..CORNERS).map(corner).collect();
        let (u, v) = projection.project(&self.point);
        let reach = outline.iter().map(|(x, y)| (x - u).hypot(y - v)).fold(0.0, f64::max);
        // Neighbours are no farther apart than the ellipse is wide, an eighth of a turn given.
        let steps = outline.iter().zip(outline.iter().cycle().skip(1));
        let whole =
            steps.map(|(from, to)| (from.0 - to.0).hypot(from.1 - to.1)).all(|step| step <= 0.5 * reach);
        (whole && reach.is_finite() && reach > 0.0).then_some(outline)
    }
}

#[cfg(test)]
mod tests {
    use fingertip::wrench::Wrench;
    use fingertip_scene::Scene;
    use nalgebra::Vector3;

    use super::{Instants, SOME};

    const SCENE: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"plane\"\n\
        [uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n";

    #[test]
    fn instants_are_spread_over_the_run_however_long() {
        let mut pipeline = Scene::from_text(SCENE).unwrap().pipeline();
        for contacts in [1, 5, 15, 16, 17, 1000, 4097_u32] {
            let mut instants = Instants::default();
            for i in 0..2 * contacts {
                // Every other sample is no contact, of which nothing is to be told.
                let force = if i % 2 == 0 { -2.0 } else { 2.0 };
                let at = Vector3::new(0.002, 0.001, 0.0);
                let push: Wrench<f64> = Wrench::from_force_at(&at, Vector3::new(0.0, 0.0, force));
                instants.add(f64::from(i), pipeline.sense(push, 1e-3));
            }
            let times: Vec<f64> = instants.kept().iter().map(|instant| instant.time).collect();
            assert!(times.len() == (contacts as usize).min(times.len()) && times.len() < 2 * SOME);
            assert!(times.len() >= SOME.min(contacts as usize) && times[0] == 0.0, "{times:?}");
            let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert!(steps.iter().all(|step| *step == steps[0]), "{times:?}");
        }
    }

    /// Under 2 N a torque of 0.1 mN·m moves the point by 50 µm; 95 % of two dimensions is 2.4477 deviations.
    #[test]
    fn an_ellipse_on_a_plane_is_to_scale() {
        let scene = Scene::from_text(SCENE).unwrap();
        let mut instants = Instants::default();
        let push: Wrench<f64> = Wrench::from_force_at(&Vector3::zeros(), Vector3::new(0.0, 0.0, -2.0));
        instants.add(0.5, scene.pipeline().sense(push, 1e-3));
        let instant = instants.kept()[0];
        assert!((instant.normal_force - 2.0).abs() < 1e-12 && (instant.deviation - 0.01).abs() < 1e-9);
        let (outline, radius) = (instant.outline(scene.projection()).unwrap(), 0.05 * 2.447_746_8);
        for (u, v) in &outline {
            assert!((u.hypot(*v) - radius).abs() < 1e-6, "{u} {v}");
        }
        // All around: by Gauss's area formula nearly that of the circle.
        let next = outline.iter().cycle().skip(1);
        let area: f64 = 0.5 * outline.iter().zip(next).map(|((a, b), (c, d))| a * d - b * c).sum::<f64>();
        let share = area.abs() / (core::f64::consts::PI * radius * radius);
        assert!((0.99..1.0).contains(&share), "{share}");
    }

    /// The map of a cylinder is cut where its sides meet: an ellipse there is none on the map, however far along the
    /// axis, and half a turn from there it is what it is on the surface.
    #[test]
    fn an_ellipse_that_the_map_tears_apart_has_no_outline() {
        let tube = "shape = \"cylinder\"\nradius_m = 0.009\nhalf_length_m = 0.2\n\
                    axis = [0.0, 0.0, 1.0]\n";
        let scene = Scene::from_text(&SCENE.replace("shape = \"plane\"\n", tube)).unwrap();
        let mut pipeline = scene.pipeline();
        for height in [-0.15, -0.01, 0.0, 0.01, 0.15] {
            let (mut torn, mut whole) = (0, 0);
            for k in 0..360 {
                let (sin, cos) = f64::from(k).to_radians().sin_cos();
                let outward = Vector3::new(cos, sin, 0.0);
                let at = outward * 0.009 + Vector3::z() * height;
                let mut instants = Instants::default();
                let push: Wrench<f64> = Wrench::from_force_at(&at, outward * -2.0);
                instants.add(0.0, pipeline.sense(push, 1e-3));
                let instant = instants.kept()[0];
                let (u, v) = scene.projection().project(&instant.point);
                match instant.outline(scene.projection()) {
                    None => torn += 1,
                    Some(outline) => {
                        whole += 1;
                        let near = |(x, y): &(f64, f64)| (x - u).hypot(y - v) < 3.0;
                        assert!(outline.iter().all(near), "{height} {k}: {outline:?}");
                    }
                }
            }
            assert!((1..20).contains(&torn) && whole >= 340, "{height}: {torn} {whole}");
        }
    }
}
