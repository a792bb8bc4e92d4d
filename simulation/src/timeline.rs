//! A script with its times worked out: the load at any time.

use fingertip_wrench::{ContactForce, Wrench};
use nalgebra::Vector3;

use crate::design::Design;
use crate::error::{ScriptProblem, SimulationError};
use crate::ramp::smooth;
use crate::script::{Script, Segment};
use crate::surface_point::{SurfacePoint, great_circle, turned};

/// Time constant with which the friction falls from its static peak to its kinetic level \[s\]: the
/// quarter period of a light object (20 g) on the compliance of a finger joint (5 N/mm), 3 ms.
const BREAK_AWAY: f64 = 3e-3;

/// A segment and when it is played.
///
/// ```
/// use fingertip_simulation::{Options, Script, Segment, SimulatedFingertip, SurfacePoint};
///
/// let script = Script::default().rest(0.5).press(SurfacePoint::TOP, 2.0, 0.1);
/// let fingertip = SimulatedFingertip::new(&script, Options::default())?;
/// let press = fingertip.phases()[1];
/// assert!(matches!(press.segment, Segment::Press { .. }));
/// assert_eq!((press.start, press.end), (0.5, 0.6));
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Phase {
    /// What happens.
    pub segment: Segment,
    /// When it starts \[s\].
    pub start: f64,
    /// When it ends \[s\].
    pub end: f64,
    from: Load,
    to: Load,
}

/// What really touches.
///
/// ```
/// use fingertip_simulation::{Options, Script, SimulatedFingertip, SurfacePoint};
///
/// let script = Script::default().press(SurfacePoint::TOP, 2.0, 0.1).hold(0.1);
/// let last = SimulatedFingertip::new(&script, Options::default())?.last().ok_or("a sample")?;
/// let contact = last.truth.contact.ok_or("it touches")?;
/// assert!((contact.point.x - 13e-3).abs() < 1e-12 && (contact.contact_force().normal - 2.0).abs() < 1e-9);
/// assert_eq!(contact.wrench().force(), contact.force);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueContact {
    /// Where \[m\].
    pub point: Vector3<f64>,
    /// Outward unit normal there.
    pub normal: Vector3<f64>,
    /// Force on the fingertip \[N\].
    pub force: Vector3<f64>,
}

impl TrueContact {
    /// Normal and tangential force.
    #[must_use]
    pub fn contact_force(&self) -> ContactForce<f64> {
        ContactForce::split(&self.force, &self.normal, 0.0)
    }

    /// The load on the fingertip about the centre of the sphere.
    #[must_use]
    pub fn wrench(&self) -> Wrench<f64> {
        Wrench::from_force_at(&self.point, self.force)
    }
}

/// The load at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Load {
    at: SurfacePoint,
    /// Outward unit normal.
    normal: Vector3<f64>,
    /// Normal force \[N\]; zero without contact.
    pressing: f64,
    /// Tangential force \[N\].
    tangential: Vector3<f64>,
}

impl Load {
    fn none() -> Self {
        Self { at: SurfacePoint::TOP, normal: Vector3::x(), pressing: 0.0, tangential: Vector3::zeros() }
    }

    pub(super) fn contact(&self, sphere_radius: f64) -> Option<TrueContact> {
        (self.pressing > 0.0).then(|| TrueContact {
            point: self.normal * sphere_radius,
            normal: self.normal,
            force: self.tangential - self.normal * self.pressing,
        })
    }
}

/// The phases of a script.
#[derive(Clone, Debug)]
pub(super) struct Timeline {
    pub(super) phases: Vec<Phase>,
    pub(super) slip_onsets: Vec<f64>,
}

impl Timeline {
    pub(super) fn new(script: &Script, design: &Design) -> Result<Self, SimulationError> {
        let mut timeline =
            Self { phases: Vec::with_capacity(script.segments.len()), slip_onsets: Vec::new() };
        let (mut start, mut from) = (0.0, Load::none());
        for (index, segment) in script.segments.iter().enumerate() {
            let to = end_of(segment, &from, design)
                .map_err(|problem| SimulationError::Script { segment: index + 1, problem })?;
            let end = start + segment.duration();
            if let Segment::Drag { ramp, .. } = segment {
                timeline.slip_onsets.push(start + ramp);
            }
            timeline.phases.push(Phase { segment: *segment, start, end, from, to });
            (start, from) = (end, to);
        }
        Ok(timeline)
    }

    pub(super) fn end(&self) -> f64 {
        self.phases.last().map_or(0.0, |phase| phase.end)
    }
}

/// Checks a segment that starts from a load, and gives the load at its end.
fn end_of(segment: &Segment, from: &Load, design: &Design) -> Result<Load, ScriptProblem> {
    let good = |value: f64| value > 0.0 && value.is_finite();
    let active = |point: &SurfacePoint| {
        if !(point.from_top.is_finite() && point.azimuth.is_finite()) {
            Err(ScriptProblem::BadAngle)
        } else if design.is_active(&point.direction()) {
            Ok(())
        } else {
            Err(ScriptProblem::NotOnActiveSurface)
        }
    };
    if !good(segment.duration()) {
        return Err(ScriptProblem::BadDuration);
    }
    let touching = from.pressing > 0.0;
    match segment {
        Segment::Rest { .. } | Segment::Press { .. } if touching => {
            return Err(ScriptProblem::AlreadyInContact);
        }
        Segment::Rest { .. } | Segment::Press { .. } => {}
        _ if !touching => return Err(ScriptProblem::NotInContact),
        _ => {}
    }
    Ok(match *segment {
        Segment::Rest { .. } | Segment::Release { .. } => Load::none(),
        Segment::Hold { .. } => *from,
        Segment::Press { at, force, .. } => {
            active(&at)?;
            if !good(force) {
                return Err(ScriptProblem::BadForce);
            }
            Load { at, normal: at.direction(), pressing: force, tangential: Vector3::zeros() }
        }
        Segment::Squeeze { force, .. } if good(force) => Load { pressing: force, ..*from },
        Segment::Squeeze { .. } => return Err(ScriptProblem::BadForce),
        Segment::Roll { to, .. } => {
            active(&to)?;
            let rotation = great_circle(&from.at, &to);
            Load {
                at: to,
                normal: to.direction(),
                tangential: turned(&from.tangential, &rotation, 1.0),
                ..*from
            }
        }
        Segment::Drag { heading, static_coefficient, kinetic_coefficient, ramp, slide } => {
            if !heading.is_finite() {
                return Err(ScriptProblem::BadAngle);
            }
            if !(good(ramp) && good(slide)) {
                return Err(ScriptProblem::BadDuration);
            }
            if !(good(static_coefficient)
                && good(kinetic_coefficient)
                && kinetic_coefficient <= static_coefficient)
            {
                return Err(ScriptProblem::BadFriction);
            }
            let ratio = sliding_ratio(static_coefficient, kinetic_coefficient, slide);
            Load { tangential: from.at.tangent(heading) * (ratio * from.pressing), ..*from }
        }
    })
}

/// The friction ratio a time after the break-away.
fn sliding_ratio(static_coefficient: f64, kinetic_coefficient: f64, since: f64) -> f64 {
    kinetic_coefficient + (static_coefficient - kinetic_coefficient) * (-since / BREAK_AWAY).exp()
}

impl Phase {
    /// The load at a time of this phase, and whether it slips.
    pub(super) fn load(&self, time: f64) -> (Load, bool) {
        let since = time - self.start;
        let smooth = smooth(since / (self.end - self.start));
        let (from, to) = (&self.from, &self.to);
        let load = match self.segment {
            Segment::Rest { .. } | Segment::Hold { .. } => *from,
            Segment::Press { .. } => Load { pressing: to.pressing * smooth, ..*to },
            Segment::Squeeze { .. } => {
                Load { pressing: from.pressing + (to.pressing - from.pressing) * smooth, ..*from }
            }
            Segment::Release { .. } => Load {
                pressing: from.pressing * (1.0 - smooth),
                tangential: from.tangential * (1.0 - smooth),
                ..*from
            },
            Segment::Roll { .. } => {
                let rotation = great_circle(&from.at, &to.at);
                let turned = |vector| turned(vector, &rotation, smooth);
                Load { normal: turned(&from.normal), tangential: turned(&from.tangential), ..*from }
            }
            Segment::Drag { heading, static_coefficient, kinetic_coefficient, ramp, .. } => {
                let peak = from.at.tangent(heading) * (static_coefficient * from.pressing);
                if since < ramp {
                    let tangential = from.tangential + (peak - from.tangential) * (since / ramp);
                    return (Load { tangential, ..*from }, false);
                }
                let ratio = sliding_ratio(static_coefficient, kinetic_coefficient, since - ramp);
                let tangential = peak * (ratio / static_coefficient);
                return (Load { tangential, ..*from }, true);
            }
        };
        (load, false)
    }
}
