//! Tubes with gauges: the paper's family, free ones, symmetric ones.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use fingertip_wrench::gauge_layout::{Gauge, ThinWalledBeam};
use nalgebra::Vector6;

use super::tube_layout::strain;
use super::{Bridge, DesignError, DesignSpace, LoadedTube, Parameter, TubeLayout, TubeTheory};

/// A coordinate that is fixed, or follows one parameter: `constant + factor·parameter`. Several
/// coordinates that follow one parameter are how a symmetry is said.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, Parameter, TubeSpace, Wall};
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let space = |gauges: Vec<GaugeRule>| {
/// #     let q = Parameter::angle("Q", 0.0, 1.0);
/// #     TubeSpace::new(vec![q], Coordinate::fixed(5e-3), gauges, tube, Wall::Fixed(0.2e-3))
/// # };
/// use fingertip_calibration::design::{Coordinate, GaugeRule};
///
/// // Six gauges 60° apart, turned by +Q and −Q in turn: one parameter moves all.
/// let gauges = (0..6).map(|k| GaugeRule {
///     z: Coordinate::fixed(0.0),
///     theta: Coordinate::fixed(f64::from(k) * 60_f64.to_radians()),
///     q: Coordinate::following(0, if k % 2 == 0 { 1.0 } else { -1.0 }),
/// });
/// let layout = space(gauges.collect())?.layout(&[0.3])?;
/// assert!((layout.gauges[0].q - 0.3).abs() < 1e-12 && (layout.gauges[1].q + 0.3).abs() < 1e-12);
/// // Shifted, it is what is added.
/// assert_eq!(Coordinate::following(0, 2.0).plus(0.1).constant, 0.1);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinate {
    /// The fixed part.
    pub constant: f64,
    /// What the parameter is multiplied by.
    pub factor: f64,
    /// The number of the parameter (from 0), if it follows one.
    pub parameter: Option<usize>,
}

impl Coordinate {
    /// A coordinate that does not change.
    #[must_use]
    pub const fn fixed(constant: f64) -> Self {
        Self { constant, factor: 0.0, parameter: None }
    }

    /// `factor` times a parameter.
    #[must_use]
    pub const fn following(parameter: usize, factor: f64) -> Self {
        Self { constant: 0.0, factor, parameter: Some(parameter) }
    }

    /// The same, shifted.
    #[must_use]
    pub const fn plus(self, constant: f64) -> Self {
        Self { constant: self.constant + constant, ..self }
    }

    fn at(&self, values: &[f64]) -> f64 {
        let value = self.parameter.and_then(|index| values.get(index)).copied().unwrap_or(0.0);
        self.constant + self.factor * value
    }
}

/// Where one gauge may be.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, Parameter, TubeSpace, Wall};
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let space = |gauges: Vec<GaugeRule>| {
/// #     let q = Parameter::angle("Q", 0.0, 1.0);
/// #     TubeSpace::new(vec![q], Coordinate::fixed(5e-3), gauges, tube, Wall::Fixed(0.2e-3))
/// # };
/// use fingertip_calibration::design::{Coordinate, GaugeRule};
///
/// // Three rosettes of two: 120° apart, the second gauge of each is the mirror image of the first.
/// let gauges = (0..6).map(|k| GaugeRule {
///     z: Coordinate::fixed(5e-3),
///     theta: Coordinate::fixed(f64::from(k / 2) * 120_f64.to_radians()),
///     q: Coordinate::following(0, if k % 2 == 0 { 1.0 } else { -1.0 }),
/// });
/// let layout = space(gauges.collect())?.layout(&[0.25])?;
/// assert!((layout.gauges[2].theta - 120_f64.to_radians()).abs() < 1e-12);
/// assert!((layout.gauges[2].q + layout.gauges[3].q).abs() < 1e-12 && layout.gauges[2].z == 5e-3);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaugeRule {
    /// Distance behind the origin.
    pub z: Coordinate,
    /// Angle around the tube.
    pub theta: Coordinate,
    /// Angle of the gauge from the axis.
    pub q: Coordinate,
}

/// How thick the wall is.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// // A wall of 0.2 mm whatever the radius, or as thin as twice the loads allow.
/// let design = [6.55e-3, 14.45_f64.to_radians(), 13.46e-3];
/// assert_eq!(layout.beam.thickness, 0.2e-3);
/// let strong = Wall::AtStrength { safety: 2.0 };
/// let strong = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, strong)?.layout(&design)?;
/// let tube = LoadedTube { radius: 6.55e-3, ..tube };
/// assert!((strong.beam.thickness - tube.least_thickness(2.0)?).abs() < 1e-9);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wall {
    /// So thick \[m\].
    Fixed(f64),
    /// As thin as the loads allow with this safety factor ([`LoadedTube::least_thickness`]), so that
    /// designs of different radius are compared at equal strength.
    AtStrength {
        /// Failing load over nominal load.
        safety: f64,
    },
}

/// A family of tubes with gauges.
///
/// ```
/// use fingertip_calibration::design::{DesignSpace as _, LoadedTube, Material, NominalLoads, TubeSpace, Wall};
///
/// let loads = NominalLoads::equal(10.0, 0.1)?;
/// let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// // Three pairs of gauges around the tube: radius, angle and place of the ring are free.
/// let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// let space = TubeSpace::rosettes(3, (2e-3, 15e-3), angles, (0.0, 20e-3), tube, Wall::Fixed(0.2e-3))?;
/// assert_eq!((space.parameters().len(), space.channels()), (3, 6));
/// let layout = space.layout(&[8e-3, 0.35, 10e-3])?;
/// assert!(layout.gauges.len() == 6 && layout.beam.radius == 8e-3);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TubeSpace {
    parameters: Vec<Parameter>,
    radius: Coordinate,
    gauges: Vec<GaugeRule>,
    bridges: Vec<Bridge>,
    tube: LoadedTube,
    wall: Wall,
    /// The wall where the radius is fixed.
    known_wall: Option<f64>,
    theory: TubeTheory,
}

impl TubeSpace {
    /// A family by rules. `tube` gives material, loads and clamped length; its radius is ignored in
    /// favour of `radius`.
    ///
    /// # Errors
    /// [`DesignError`] for a parameter without a range, a rule that names a parameter that is not
    /// there, fewer than six gauges, a bad tube, or, where the radius is fixed, a wall that cannot be
    /// thin.
    pub fn new(
        parameters: Vec<Parameter>,
        radius: Coordinate,
        gauges: Vec<GaugeRule>,
        tube: LoadedTube,
        wall: Wall,
    ) -> Result<Self, DesignError> {
        let count = parameters.len();
        let coordinates = gauges.iter().flat_map(|rule| [rule.z, rule.theta, rule.q]);
        for coordinate in coordinates.chain([radius]) {
            if let Some(index) = coordinate.parameter.filter(|index| *index >= count) {
                return Err(DesignError::NoSuchPart { what: "a rule of a gauge", index, count });
            }
        }
        let middle: Vec<f64> = parameters.iter().map(|p| 0.5 * (p.lower + p.upper)).collect();
        let tube = LoadedTube { radius: radius.at(&middle), ..tube };
        tube.validate()?;
        match wall {
            Wall::Fixed(thickness) => DesignError::check_positive("wall thickness", thickness)?,
            Wall::AtStrength { safety } => DesignError::check_positive("safety factor", safety)?,
        };
        let theory = TubeTheory::Corrected;
        let mut space =
            Self { parameters, radius, gauges, bridges: Vec::new(), tube, wall, known_wall: None, theory };
        super::space::validate(&space)?;
        if radius.parameter.is_none() {
            space.known_wall = Some(space.thickness(radius.constant)?);
        }
        Ok(space)
    }

    /// The paper's six gauges with its three parameters: radius `R` \[m\], gauge angle `Q` \[rad\]
    /// and distance `d` \[m\] of the two rear gauges (Figure 3 of Bicchi & Dario 1987).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn bicchi_dario(
        radius: (f64, f64),
        angle: (f64, f64),
        distance: (f64, f64),
        tube: LoadedTube,
        wall: Wall,
    ) -> Result<Self, DesignError> {
        let parameters = vec![
            Parameter::length("R", radius.0, radius.1),
            Parameter::angle("Q", angle.0, angle.1),
            Parameter::length("d", distance.0, distance.1),
        ];
        let ring = Coordinate::fixed(0.0);
        let rear = Coordinate::following(2, 1.0);
        let places = [(ring, 2.0, -1.0), (ring, 1.0, 1.0), (ring, 0.0, -1.0), (ring, 3.0, 1.0)];
        let gauges = places
            .into_iter()
            .chain([(rear, 2.0, -1.0), (rear, 1.0, 1.0)])
            .map(|(z, quarters, sign)| GaugeRule {
                z,
                theta: Coordinate::fixed(quarters * FRAC_PI_2),
                q: Coordinate::following(1, sign),
            })
            .collect();
        Self::new(parameters, Coordinate::following(0, 1.0), gauges, tube, wall)
    }

    /// `count` gauges, each free in place and angle: `3·count` parameters `z1, theta1, Q1, …`. The
    /// radius is that of the tube.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn free(count: usize, z: (f64, f64), tube: LoadedTube, wall: Wall) -> Result<Self, DesignError> {
        let mut parameters = Vec::with_capacity(3 * count);
        let mut gauges = Vec::with_capacity(count);
        for gauge in 0..count {
            let number = gauge + 1;
            parameters.push(Parameter::length(&format!("z{number}"), z.0, z.1));
            parameters.push(Parameter::periodic_angle(&format!("theta{number}"), TAU));
            parameters.push(Parameter::periodic_angle(&format!("Q{number}"), PI));
            gauges.push(GaugeRule {
                z: Coordinate::following(3 * gauge, 1.0),
                theta: Coordinate::following(3 * gauge + 1, 1.0),
                q: Coordinate::following(3 * gauge + 2, 1.0),
            });
        }
        Self::new(parameters, Coordinate::fixed(tube.radius), gauges, tube, wall)
    }

    /// `count` equally spaced pairs of gauges at `±Q` in one ring: parameters `R`, `Q` and the ring's
    /// distance `Z` behind the origin.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn rosettes(
        count: usize,
        radius: (f64, f64),
        angle: (f64, f64),
        z: (f64, f64),
        tube: LoadedTube,
        wall: Wall,
    ) -> Result<Self, DesignError> {
        let parameters = vec![
            Parameter::length("R", radius.0, radius.1),
            Parameter::angle("Q", angle.0, angle.1),
            Parameter::length("Z", z.0, z.1),
        ];
        let rule = |place: usize, sign: f64| GaugeRule {
            z: Coordinate::following(2, 1.0),
            theta: Coordinate::fixed(TAU * place as f64 / count as f64),
            q: Coordinate::following(1, sign),
        };
        let gauges = (0..count).flat_map(|place| [rule(place, 1.0), rule(place, -1.0)]).collect();
        Self::new(parameters, Coordinate::following(0, 1.0), gauges, tube, wall)
    }

    /// `rings` rings of `count` equally spaced gauges. Each ring has a distance `z`, a turn `theta`
    /// and a gauge angle `Q` of its own; with `alternating` the sign of `Q` changes from gauge to
    /// gauge. The radius is the first parameter.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn rings(
        rings: usize,
        count: usize,
        alternating: bool,
        radius: (f64, f64),
        z: (f64, f64),
        tube: LoadedTube,
        wall: Wall,
    ) -> Result<Self, DesignError> {
        let mut parameters = vec![Parameter::length("R", radius.0, radius.1)];
        let mut gauges = Vec::with_capacity(rings * count);
        for ring in 0..rings {
            let (first, number) = (parameters.len(), ring + 1);
            parameters.push(Parameter::length(&format!("z{number}"), z.0, z.1));
            parameters.push(Parameter::periodic_angle(&format!("theta{number}"), TAU));
            parameters.push(Parameter::periodic_angle(&format!("Q{number}"), PI));
            gauges.extend((0..count).map(|place| GaugeRule {
                z: Coordinate::following(first, 1.0),
                theta: Coordinate::following(first + 1, 1.0).plus(TAU * place as f64 / count as f64),
                q: Coordinate::following(first + 2, if alternating && place % 2 == 1 { -1.0 } else { 1.0 }),
            }));
        }
        Self::new(parameters, Coordinate::following(0, 1.0), gauges, tube, wall)
    }

    /// The same with gauges wired in bridges: one channel per bridge.
    ///
    /// # Errors
    /// [`DesignError`] for an arm without its gauge or fewer than six bridges.
    pub fn with_bridges(mut self, bridges: Vec<Bridge>) -> Result<Self, DesignError> {
        for bridge in &bridges {
            bridge.validate(self.gauges.len())?;
        }
        self.bridges = bridges;
        super::space::validate(&self)?;
        Ok(self)
    }

    /// The same with other constants.
    #[must_use]
    pub fn with_theory(self, theory: TubeTheory) -> Self {
        Self { theory, ..self }
    }

    fn thickness(&self, radius: f64) -> Result<f64, DesignError> {
        match (self.known_wall, self.wall) {
            (Some(thickness), _) | (None, Wall::Fixed(thickness)) => Ok(thickness),
            (None, Wall::AtStrength { safety }) => LoadedTube { radius, ..self.tube }.least_thickness(safety),
        }
    }

    fn beam(&self, values: &[f64]) -> Result<ThinWalledBeam<f64>, DesignError> {
        let radius = self.radius.at(values);
        Ok(LoadedTube { radius, ..self.tube }.beam(self.thickness(radius)?))
    }

    fn place(&self, rule: &GaugeRule, values: &[f64]) -> Gauge<f64> {
        Gauge { z: rule.z.at(values), theta: rule.theta.at(values), q: rule.q.at(values) }
    }

    /// The sensor at these values of the parameters.
    ///
    /// # Errors
    /// [`DesignError`] for a wrong number of values, or a sensor that cannot be built.
    pub fn layout(&self, values: &[f64]) -> Result<TubeLayout, DesignError> {
        let expected = self.parameters.len();
        if values.len() != expected {
            return Err(DesignError::WrongCount { what: "parameters", found: values.len(), expected });
        }
        let gauges = self.gauges.iter().map(|rule| self.place(rule, values)).collect();
        let layout = TubeLayout { beam: self.beam(values)?, gauges, bridges: self.bridges.clone() };
        layout.validate()?;
        Ok(layout)
    }
}

impl DesignSpace for TubeSpace {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn channels(&self) -> usize {
        if self.bridges.is_empty() { self.gauges.len() } else { self.bridges.len() }
    }

    fn response(&self, values: &[f64], rows: &mut [Vector6<f64>]) -> Result<(), DesignError> {
        let beam = self.beam(values)?;
        let section = self.theory.section(&beam)?;
        let mut gauges = self.gauges.iter().map(|rule| {
            let gauge = self.place(rule, values);
            strain(gauge, section, beam.poisson_ratio)
        });
        if self.bridges.is_empty() {
            for (row, strain) in rows.iter_mut().zip(gauges) {
                *row = strain;
            }
        } else {
            let gauges: Vec<_> = gauges.by_ref().collect();
            for (row, bridge) in rows.iter_mut().zip(&self.bridges) {
                *row = bridge.response(&gauges)?;
            }
        }
        Ok(())
    }
}
