//! What a run remembers of its samples: bounded memory, however long the recording.

mod instants;
mod quantiles;
mod reservoir;
mod slips;
mod status;
mod trace;

use fingertip::Touch;
use fingertip::contact::{NoContact, Resolution};
use fingertip::friction::{SlipMargin, SlipVerdict};
use nalgebra::Vector3;

pub(crate) use instants::Instants;
pub(crate) use quantiles::Quantiles;
pub(crate) use reservoir::Reservoir;
pub(crate) use slips::Slips;
pub(crate) use status::Status;
pub(crate) use trace::{Pieces, Point, Trace};

use fingertip_scene::Projection;

/// One sample as the pipeline of a scene leaves it.
pub(crate) type SceneTouch = Touch<f64, Option<SlipMargin<f64>>, Option<SlipVerdict>>;

/// Most contact points that are drawn.
const MAP_POINTS: usize = 1500;

/// What is traced of a sample without contact.
const NOTHING: [f64; 7] = [f64::NAN; 7];

/// A contact on the map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapPoint {
    /// On the map, see [`Projection::project`].
    pub(crate) place: (f64, f64),
    /// In the sensor frame \[m\].
    pub(crate) point: Vector3<f64>,
    /// \[N\]
    pub(crate) normal_force: f64,
}

/// Counts, distributions and curves of a run.
#[derive(Clone, Debug)]
pub(crate) struct Observations {
    projection: Projection,
    /// Whether the curves and the map are kept, which only a report shows.
    is_drawn: bool,
    counts: [u64; Status::ALL.len()],
    rows: u64,
    first_time: Option<f64>,
    last_time: f64,
    /// Of every finite sample \[N\].
    pub(crate) force: Quantiles,
    /// Of contacts \[N\].
    pub(crate) normal: Quantiles,
    /// Of contacts \[N\].
    pub(crate) tangential: Quantiles,
    /// |f_t|/f_n of contacts.
    pub(crate) ratio: Quantiles,
    /// How far lines of action miss \[m\].
    pub(crate) gap: Quantiles,
    /// Components of the load on the fingertip \[N, N·m\].
    load: Trace<6>,
    /// Of contacts: normal and tangential force \[N\], their ratio, the spin torque \[N·m\], and the point \[m\].
    contacts: Trace<7>,
    pub(crate) map: Reservoir<MapPoint>,
    pub(crate) slips: Slips,
    /// How sure contacts were.
    pub(crate) instants: Instants,
    /// Contacts whose friction limit is passed.
    pub(crate) beyond_limit: u64,
}

impl Observations {
    /// All that is kept of a run.
    pub(crate) fn new(projection: Projection) -> Self {
        Self::of(projection, true)
    }

    /// Without what only a report shows, unless it is drawn.
    pub(crate) fn of(projection: Projection, is_drawn: bool) -> Self {
        Self {
            projection,
            is_drawn,
            counts: [0; Status::ALL.len()],
            rows: 0,
            first_time: None,
            last_time: f64::NEG_INFINITY,
            force: Quantiles::default(),
            normal: Quantiles::default(),
            tangential: Quantiles::default(),
            ratio: Quantiles::default(),
            gap: Quantiles::default(),
            load: Trace::default(),
            contacts: Trace::default(),
            map: Reservoir::new(MAP_POINTS),
            slips: Slips::default(),
            instants: Instants::default(),
            beyond_limit: 0,
        }
    }

    /// Takes the next sample, made at `time` \[s\].
    #[inline]
    pub(crate) fn add(&mut self, time: f64, touch: &SceneTouch) {
        self.count(time, Status::of(&touch.resolution));
        self.force.add(touch.wrench.force().norm());
        let split = touch.resolution.contact().zip(touch.force).map(|(contact, force)| {
            (contact, force.normal, force.tangential_magnitude(), force.friction_ratio())
        });
        if self.is_drawn {
            let mut traced = NOTHING;
            if let Some((contact, normal_force, tangential, ratio)) = split {
                let point = contact.point;
                self.map.add(|| MapPoint { place: self.projection.project(&point), point, normal_force });
                let ratio = ratio.unwrap_or(f64::NAN);
                traced = [normal_force, tangential, ratio, contact.spin_torque, point.x, point.y, point.z];
            }
            self.load.add(time, &touch.wrench.components().into());
            self.contacts.add(time, &traced);
        }
        let ratio = split.and_then(|(.., ratio)| ratio);
        if let Some((_, normal, tangential, _)) = split {
            self.normal.add(normal);
            self.tangential.add(tangential);
        }
        if let Some(ratio) = ratio {
            self.ratio.add(ratio);
        }
        if let Resolution::NoContact(NoContact::Misses { closest: Some(closest) }) = touch.resolution {
            self.gap.add(closest.gap);
        }
        if touch.grip.flatten().is_some_and(|margin| margin.newtons < 0.0) {
            self.beyond_limit += 1;
        }
        self.slips.follow(time, touch.slip, split.map(|(_, normal, ..)| normal), ratio);
    }

    /// Takes a sample that gave no wrench, or one that is not analysed. Curves break here.
    pub(crate) fn add_without_wrench(&mut self, time: f64, status: Status) {
        self.count(time, status);
        if self.is_drawn {
            self.load.add(time, &[f64::NAN; 6]);
            self.contacts.add(time, &NOTHING);
        }
    }

    /// Force components on the fingertip \[N\].
    pub(crate) fn forces(&self) -> [Pieces; 3] {
        [0, 1, 2].map(|curve| self.load.pieces(curve))
    }

    /// Torque components on the fingertip \[N·m\].
    pub(crate) fn torques(&self) -> [Pieces; 3] {
        [3, 4, 5].map(|curve| self.load.pieces(curve))
    }

    /// Normal and tangential force of contacts \[N\].
    pub(crate) fn split(&self) -> [Pieces; 2] {
        [0, 1].map(|curve| self.contacts.pieces(curve))
    }

    /// |f_t|/f_n of contacts.
    pub(crate) fn ratios(&self) -> Pieces {
        self.contacts.pieces(2)
    }

    /// Spin torque of contacts \[N·m\].
    pub(crate) fn spin_torques(&self) -> Pieces {
        self.contacts.pieces(3)
    }

    /// x, y and z of contact points \[m\].
    pub(crate) fn positions(&self) -> [Pieces; 3] {
        [4, 5, 6].map(|curve| self.contacts.pieces(curve))
    }

    #[inline]
    fn count(&mut self, time: f64, status: Status) {
        self.rows += 1;
        self.counts[status as usize] += 1;
        if time.is_finite() {
            self.first_time.get_or_insert(time);
            // A time that goes back is not the last one.
            self.last_time = self.last_time.max(time);
        }
    }

    /// How many samples ended so.
    pub(crate) fn count_of(&self, status: Status) -> u64 {
        self.counts[status as usize]
    }

    pub(crate) fn rows(&self) -> u64 {
        self.rows
    }

    /// From first to last sample \[s\].
    pub(crate) fn duration(&self) -> f64 {
        self.first_time.map_or(0.0, |first| self.last_time - first)
    }

    /// First and last time \[s\].
    pub(crate) fn time_range(&self) -> (f64, f64) {
        self.first_time.map_or((0.0, 0.0), |first| (first, self.last_time))
    }

    pub(crate) fn projection(&self) -> &Projection {
        &self.projection
    }
}

#[cfg(test)]
mod tests {
    use fingertip::contact::{NoContact, Resolution};
    use fingertip::friction::SlipMargin;
    use fingertip::wrench::Wrench;
    use nalgebra::Vector3;

    use super::{Observations, Projection, SceneTouch, Status};

    fn observations(is_drawn: bool) -> Observations {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        Observations::of(Projection::plane(Vector3::zeros(), Vector3::z(), &axes), is_drawn)
    }

    /// A sample without a contact, with so much left of friction \[N\].
    fn touch(left: Option<f64>) -> SceneTouch {
        SceneTouch {
            wrench: Wrench::on_fingertip(Vector3::new(0.0, 3.0, 4.0), Vector3::new(0.1, 0.2, 0.3)),
            resolution: Resolution::NoContact(NoContact::Misses { closest: None }),
            force: None,
            grip: Some(left.map(|newtons| SlipMargin { newtons, utilisation: 1.0 })),
            slip: None,
            tracked: (),
        }
    }

    #[test]
    fn what_is_at_the_limit_of_friction_is_not_beyond_it() {
        let mut observations = observations(false);
        for left in [Some(0.0), Some(0.5), None] {
            observations.add(0.0, &touch(left));
        }
        assert_eq!(observations.beyond_limit, 0);
        observations.add(0.0, &touch(Some(-1e-9)));
        assert_eq!(observations.beyond_limit, 1);
    }

    #[test]
    fn a_time_that_goes_back_is_not_the_last_one() {
        let mut observations = observations(false);
        assert_eq!((observations.duration(), observations.time_range()), (0.0, (0.0, 0.0)));
        for time in [f64::NAN, 2.0, 5.0, 4.0] {
            observations.add_without_wrench(time, Status::Rest);
        }
        assert_eq!((observations.duration(), observations.time_range()), (3.0, (2.0, 5.0)));
        assert_eq!((observations.rows(), observations.count_of(Status::Rest)), (4, 4));
    }

    /// Curves break where there is no wrench, and are kept only where they are drawn.
    #[test]
    fn curves_are_kept_for_a_report_only() {
        for is_drawn in [true, false] {
            let mut observations = observations(is_drawn);
            observations.add(0.0, &touch(None));
            observations.add_without_wrench(1.0, Status::UnusableRow);
            observations.add(2.0, &touch(None));
            let [forces, torques] = [observations.forces(), observations.torques()];
            for (curve, value) in forces.iter().chain(&torques).zip([0.0, 3.0, 4.0, 0.1, 0.2, 0.3]) {
                let points: Vec<Vec<(f64, f64)>> = curve
                    .iter()
                    .map(|piece| piece.iter().map(|point| (point.time, point.value)).collect())
                    .collect();
                let expected = if is_drawn { vec![vec![(0.0, value)], vec![(2.0, value)]] } else { vec![] };
                assert_eq!(points, expected);
            }
            assert_eq!(observations.force.count(), 2);
        }
    }
}
