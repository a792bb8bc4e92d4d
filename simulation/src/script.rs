//! What happens to the fingertip, as a list.

use crate::surface_point::SurfacePoint;

/// One thing that happens. Forces follow a smooth ramp (`3u² − 2u³`) unless said otherwise.
///
/// ```
/// use fingertip_simulation::{Script, Segment, SurfacePoint};
///
/// let script = Script::default().press(SurfacePoint::TOP, 2.0, 0.1).drag(0.0, (0.5, 0.35), 0.3, 0.2);
/// assert_eq!(script.segments[0], Segment::Press { at: SurfacePoint::TOP, force: 2.0, duration: 0.1 });
/// assert_eq!(script.segments[1].duration(), 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(tag = "do", rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Segment {
    /// Nothing touches, for `duration` \[s\].
    Rest {
        /// How long \[s\].
        duration: f64,
    },
    /// Something touches and presses straight in, up to a normal force.
    Press {
        /// Where.
        at: SurfacePoint,
        /// Normal force at the end \[N\].
        force: f64,
        /// How long the force takes to get there \[s\].
        duration: f64,
    },
    /// Everything stays as it is.
    Hold {
        /// How long \[s\].
        duration: f64,
    },
    /// The normal force changes, the tangential force stays.
    Squeeze {
        /// Normal force at the end \[N\].
        force: f64,
        /// How long \[s\].
        duration: f64,
    },
    /// The object rolls along the great circle to another point, under the same force.
    Roll {
        /// Where it ends.
        to: SurfacePoint,
        /// How long \[s\].
        duration: f64,
    },
    /// The object is dragged until it slips: the tangential force rises linearly to the static
    /// limit, breaks away, and falls within milliseconds to the kinetic level, where it slides.
    Drag {
        /// Direction of the tangential force on the fingertip: see [`SurfacePoint::tangent`]
        /// \[rad\].
        heading: f64,
        /// Static friction coefficient.
        static_coefficient: f64,
        /// Kinetic friction coefficient.
        kinetic_coefficient: f64,
        /// How long the tangential force rises until it slips \[s\].
        ramp: f64,
        /// How long it slides \[s\]; then it sticks, and the tangential force stays.
        slide: f64,
    },
    /// The object lifts off: normal and tangential force vanish in proportion.
    Release {
        /// How long \[s\].
        duration: f64,
    },
}

/// A list of [`Segment`]s, played one after the other.
///
/// ```
/// use fingertip_simulation::{Options, Script, SimulatedFingertip, SurfacePoint};
///
/// // Touch at the top, roll down to the side, let go.
/// let script = Script::default()
///     .rest(0.2)
///     .press(SurfacePoint::TOP, 3.0, 0.1)
///     .roll(SurfacePoint::degrees(60.0, 90.0), 0.5)
///     .release(0.1);
/// assert_eq!(SimulatedFingertip::new(&script, Options::default())?.count(), 900);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct Script {
    /// What happens.
    pub segments: Vec<Segment>,
}

impl Script {
    /// Adds a segment.
    pub fn then(mut self, segment: Segment) -> Self {
        self.segments.push(segment);
        self
    }

    /// Nothing touches, for a time \[s\].
    pub fn rest(self, duration: f64) -> Self {
        self.then(Segment::Rest { duration })
    }

    /// Presses at a point, up to a normal force \[N\], within a time \[s\].
    pub fn press(self, at: SurfacePoint, force: f64, duration: f64) -> Self {
        self.then(Segment::Press { at, force, duration })
    }

    /// Stays, for a time \[s\].
    pub fn hold(self, duration: f64) -> Self {
        self.then(Segment::Hold { duration })
    }

    /// Changes the normal force \[N\] within a time \[s\].
    pub fn squeeze(self, force: f64, duration: f64) -> Self {
        self.then(Segment::Squeeze { force, duration })
    }

    /// Rolls to a point within a time \[s\].
    pub fn roll(self, to: SurfacePoint, duration: f64) -> Self {
        self.then(Segment::Roll { to, duration })
    }

    /// Drags in a direction \[rad\] with `(static, kinetic)` friction coefficients: slips after
    /// `ramp` \[s\], then slides for `slide` \[s\].
    pub fn drag(self, heading: f64, friction: (f64, f64), ramp: f64, slide: f64) -> Self {
        let (static_coefficient, kinetic_coefficient) = friction;
        self.then(Segment::Drag { heading, static_coefficient, kinetic_coefficient, ramp, slide })
    }

    /// Lifts off within a time \[s\].
    pub fn release(self, duration: f64) -> Self {
        self.then(Segment::Release { duration })
    }
}

impl Segment {
    /// How long the segment takes \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        match *self {
            Self::Rest { duration }
            | Self::Press { duration, .. }
            | Self::Hold { duration }
            | Self::Squeeze { duration, .. }
            | Self::Roll { duration, .. }
            | Self::Release { duration } => duration,
            Self::Drag { ramp, slide, .. } => ramp + slide,
        }
    }
}
