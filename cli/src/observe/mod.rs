//! What a run remembers of its samples: bounded memory, however long the recording.

mod quantiles;
mod reservoir;
mod slips;
mod status;
mod trace;

use fingertip::Touch;
use fingertip::contact::{NoContact, Resolution};
use fingertip::friction::{SlipMargin, SlipVerdict};

pub(crate) use quantiles::Quantiles;
pub(crate) use reservoir::Reservoir;
pub(crate) use slips::Slips;
pub(crate) use status::Status;
pub(crate) use trace::{Point, Trace};

use fingertip_scene::Projection;

/// One sample as the pipeline of a scene leaves it.
pub(crate) type SceneTouch = Touch<f64, Option<SlipMargin<f64>>, Option<SlipVerdict>>;

/// Most contact points that are drawn.
const MAP_POINTS: usize = 1500;

/// A contact on the map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapPoint {
    /// On the map, see [`Projection::project`].
    pub(crate) place: (f64, f64),
    /// \[N\]
    pub(crate) normal_force: f64,
}

/// Counts, distributions and curves of a run.
#[derive(Clone, Debug)]
pub(crate) struct Observations {
    projection: Projection,
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
    /// Force components on the fingertip \[N\].
    pub(crate) components: [Trace; 3],
    /// Normal and tangential force of contacts \[N\].
    pub(crate) split: [Trace; 2],
    /// |f_t|/f_n of contacts.
    pub(crate) ratio_trace: Trace,
    pub(crate) map: Reservoir<MapPoint>,
    pub(crate) slips: Slips,
    /// Contacts whose friction limit is passed.
    pub(crate) beyond_limit: u64,
}

impl Observations {
    pub(crate) fn new(projection: Projection) -> Self {
        Self {
            projection,
            counts: [0; Status::ALL.len()],
            rows: 0,
            first_time: None,
            last_time: f64::NEG_INFINITY,
            force: Quantiles::default(),
            normal: Quantiles::default(),
            tangential: Quantiles::default(),
            ratio: Quantiles::default(),
            gap: Quantiles::default(),
            components: Default::default(),
            split: Default::default(),
            ratio_trace: Trace::default(),
            map: Reservoir::new(MAP_POINTS),
            slips: Slips::default(),
            beyond_limit: 0,
        }
    }

    /// Takes the next sample, made at `time` \[s\].
    #[inline]
    pub(crate) fn add(&mut self, time: f64, touch: &SceneTouch) {
        self.count(time, Status::of(&touch.resolution));
        let force = touch.wrench.force();
        for (trace, component) in self.components.iter_mut().zip(force.iter()) {
            trace.add(time, Some(*component));
        }
        self.force.add(force.norm());
        let split = touch.resolution.contact().zip(touch.force).map(|(contact, force)| {
            self.map.add(|| MapPoint {
                place: self.projection.project(&contact.point),
                normal_force: force.normal,
            });
            (force.normal, force.tangential_magnitude(), force.friction_ratio())
        });
        let [normal_trace, tangential_trace] = &mut self.split;
        normal_trace.add(time, split.map(|(normal, ..)| normal));
        tangential_trace.add(time, split.map(|(_, tangential, _)| tangential));
        let ratio = split.and_then(|(.., ratio)| ratio);
        self.ratio_trace.add(time, ratio);
        if let Some((normal, tangential, _)) = split {
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
        self.slips.follow(time, touch.slip, split.map(|(normal, ..)| normal), ratio);
    }

    /// Takes a sample that gave no wrench, or one that is not analysed. Curves break here.
    pub(crate) fn add_without_wrench(&mut self, time: f64, status: Status) {
        self.count(time, status);
        for trace in self.components.iter_mut().chain(&mut self.split).chain([&mut self.ratio_trace]) {
            trace.add(time, None);
        }
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
