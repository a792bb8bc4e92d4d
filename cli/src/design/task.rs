//! What is asked for, in the words of the library.

use fingertip_calibration::design::{
    Assessment, ContactWeight, Criterion, DesignError, Excitation, LoadedTube, NominalLoads, Search,
    TubeLayout, TubeSpace, Wall, search,
};

use super::args::{CriterionName, DesignArguments, LayoutFamily};

/// Angles of gauges that the search may use \[°\]: none along the axis, none where axial strain is nil.
const ANGLES: (f64, f64) = (1.0, 59.0);
/// Part of the clamped length that gauges may use: near the clamp the strain is not that of a beam.
const USABLE: f64 = 0.8;
/// Part of the fingertip that is touched, from its pole \[°\].
const HALF_ANGLE: f64 = 90.0;

/// What is asked for.
pub(super) struct Task {
    pub(super) space: TubeSpace,
    /// The same with gauges turned the other way, where that is another sensor.
    pub(super) turned: Option<TubeSpace>,
    pub(super) criterion: Criterion,
    /// For wrenches in nominal loads, at a tenth of the force.
    pub(super) weight: ContactWeight,
    pub(super) tube: LoadedTube,
    pub(super) excitation: Excitation,
    pub(super) tip_radius: f64,
    pub(super) half_angle: f64,
    /// Noise of a channel \[strain\].
    pub(super) noise: f64,
    /// Force at which the contact error is stated \[N\].
    pub(super) touch_force: f64,
    radius: (f64, f64),
    wall: Wall,
    seed: u64,
    family: LayoutFamily,
}

impl Task {
    pub(super) fn new(arguments: &DesignArguments) -> Result<Self, DesignError> {
        let loads = NominalLoads::equal(arguments.force, arguments.torque)?;
        let [least, greatest] = arguments.radius_mm[..] else {
            let found = arguments.radius_mm.len();
            return Err(DesignError::WrongCount { what: "radii", found, expected: 2 });
        };
        let radius = (least * 1e-3, greatest * 1e-3);
        let length = arguments.length_mm * 1e-3;
        let tube = LoadedTube { material: arguments.material, radius: radius.1, length, loads };
        let wall = match arguments.wall_mm {
            Some(wall) => Wall::Fixed(wall * 1e-3),
            None => Wall::AtStrength { safety: arguments.safety },
        };
        let turned = (arguments.layout == LayoutFamily::Paper)
            .then(|| space(arguments, radius, tube, wall, (-ANGLES.1, -ANGLES.0)))
            .transpose()?;
        let space = space(arguments, radius, tube, wall, ANGLES)?;
        let half_angle = HALF_ANGLE.to_radians();
        let (tip_radius, touch_force) = (arguments.tip_radius_mm * 1e-3, 0.1 * arguments.force);
        let weight = ContactWeight::on_sphere(tip_radius, half_angle, arguments.friction, touch_force)?;
        let weight = weight.normalised(&loads.components());
        let criterion = match arguments.criterion {
            CriterionName::ConditionNumber => Criterion::ConditionNumber,
            CriterionName::ContactError => Criterion::ContactError(weight),
            CriterionName::WorstAxis => Criterion::WorstAxis,
            CriterionName::Trace => Criterion::Trace,
            CriterionName::LogDeterminant => Criterion::LogDeterminant,
        };
        let excitation = Excitation {
            supply: arguments.supply,
            gauge_factor: arguments.gauge_factor,
            amplifier_gain: arguments.gain,
        };
        let noise = arguments.noise_microstrain * 1e-6;
        let (seed, family) = (arguments.seed, arguments.layout);
        Ok(Self {
            space,
            turned,
            criterion,
            weight,
            tube,
            excitation,
            tip_radius,
            half_angle,
            noise,
            touch_force,
            radius,
            wall,
            seed,
            family,
        })
    }

    /// Torque over force \[m\].
    pub(super) fn arm(&self) -> f64 {
        self.tube.loads.torque[0] / self.tube.loads.force[0]
    }

    pub(super) fn assess(&self, layout: &TubeLayout) -> Result<Assessment, DesignError> {
        let matrix = layout.normalised(1.0, &self.tube.loads)?;
        Assessment::new(&matrix, Some(&self.weight))
            .ok_or(DesignError::Singular { reason: "the sensor matrix is not finite" })
    }

    /// The design beside others for the same loads, radii and wall.
    pub(super) fn compare(&self, layout: &TubeLayout) -> Result<Vec<(String, Assessment)>, DesignError> {
        let mut compared = vec![("this design".to_owned(), self.assess(layout)?)];
        let radius = layout.beam.radius;
        let here = LoadedTube { radius, ..self.tube };
        let wall = Wall::Fixed(layout.beam.thickness);
        // The paper's own proportions, Q = 14° and d = 2R, on the same tube.
        let distance = 2.0 * radius;
        let around = |value: f64| (0.5 * value, 2.0 * value);
        let paper = TubeSpace::bicchi_dario(around(radius), degrees(ANGLES), around(distance), here, wall)?;
        let paper = paper.layout(&[radius, 14_f64.to_radians(), distance])?;
        if distance <= USABLE * self.tube.length {
            compared.push(("paper's gauges on this tube".to_owned(), self.assess(&paper)?));
        }
        if self.family != LayoutFamily::Rosettes {
            let z = (0.0, USABLE * self.tube.length);
            let rosettes = TubeSpace::rosettes(3, self.radius, degrees(ANGLES), z, self.tube, self.wall)?;
            let how = Search { starts: 10, seed: self.seed, ..Search::default() };
            let found = search(&rosettes, &self.criterion, &self.tube.loads, &how, &|_| ())?;
            if let Some(best) = found.best() {
                let layout = rosettes.layout(&best.values)?;
                let name = format!(
                    "three pairs at ±{:.1}°, R {:.1} mm",
                    best.values[1].to_degrees(),
                    best.values[0] * 1e3
                );
                compared.push((name, self.assess(&layout)?));
            }
        }
        Ok(compared)
    }
}

fn degrees((low, high): (f64, f64)) -> (f64, f64) {
    (low.to_radians(), high.to_radians())
}

fn space(
    arguments: &DesignArguments,
    radius: (f64, f64),
    tube: LoadedTube,
    wall: Wall,
    angles: (f64, f64),
) -> Result<TubeSpace, DesignError> {
    let (count, length) = (arguments.gauges, USABLE * tube.length);
    let wrong = |expected| DesignError::WrongCount { what: "gauges", found: count, expected };
    match arguments.layout {
        LayoutFamily::Paper if count != 6 => Err(wrong(6)),
        LayoutFamily::Paper => {
            TubeSpace::bicchi_dario(radius, degrees(angles), (0.05 * length, length), tube, wall)
        }
        LayoutFamily::Rosettes if count < 6 || count % 2 == 1 => Err(wrong(6.max(count + 1))),
        LayoutFamily::Rosettes => {
            TubeSpace::rosettes(count / 2, radius, degrees(ANGLES), (0.0, length), tube, wall)
        }
        LayoutFamily::Free => TubeSpace::free(count, (0.0, length), tube, wall),
    }
}
