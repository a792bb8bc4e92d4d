//! Designs: their strains, what they are worth, and where a search ends.

use fingertip_calibration::design::{
    Assessment, ContactWeight, Coordinate, Criterion, Decoupling, DesignError, DesignSpace, Excitation,
    GaugeAngle, GaugeRule, Landscape, LayoutFile, LinearStructure, LoadedTube, MalteseCross,
    MalteseCrossSpace, Material, MatrixUsed, NominalLoads, Parameter, Placement, Search, Stewart,
    StewartSpace, StrainSite, Touch, Touches, Trial, TubeLayout, TubeSpace, TubeTheory, Wall, choose_sites,
    gram, search, tolerance,
};
use fingertip_calibration::nalgebra::{Matrix3x6, Vector3, Vector6};
use fingertip_surfaces::Sphere;

use super::{Draw, to_ten_digits, unchanged};

fn loads() -> NominalLoads {
    NominalLoads::equal(30.0, 0.3).unwrap()
}

fn tube(radius: f64) -> LoadedTube {
    LoadedTube { material: Material::ALUMINIUM_7075_T6, radius, length: 20e-3, loads: loads() }
}

fn degrees(low: f64, high: f64) -> (f64, f64) {
    (low.to_radians(), high.to_radians())
}

fn spaces() -> [TubeSpace; 4] {
    let (wall, angle) = (Wall::Fixed(0.2e-3), degrees(1.0, 59.0));
    [
        TubeSpace::bicchi_dario((2e-3, 15e-3), angle, (2e-3, 20e-3), tube(5e-3), wall).unwrap(),
        TubeSpace::rosettes(3, (2e-3, 15e-3), angle, (-20e-3, 20e-3), tube(5e-3), wall).unwrap(),
        TubeSpace::rings(
            2,
            3,
            true,
            (2e-3, 15e-3),
            (0.0, 20e-3),
            tube(5e-3),
            Wall::AtStrength { safety: 2.0 },
        )
        .unwrap(),
        TubeSpace::free(6, (0.0, 20e-3), tube(7e-3), wall).unwrap(),
    ]
}

/// Halfway between the bounds, and at a third.
fn values(parameters: &[Parameter], share: f64) -> Vec<f64> {
    parameters
        .iter()
        .enumerate()
        .map(|(k, p)| p.lower + (p.upper - p.lower) * (share + 0.07 * k as f64).fract())
        .collect()
}

fn layouts() -> Vec<TubeLayout> {
    let of = |space: &TubeSpace| {
        [0.2, 0.55].map(|share| space.layout(&values(space.parameters(), share)).unwrap())
    };
    spaces().iter().flat_map(of).collect()
}

fn criteria() -> Vec<Criterion> {
    vec![
        Criterion::ConditionNumber,
        Criterion::LogDeterminant,
        Criterion::Trace,
        Criterion::WorstAxis,
        Criterion::ContactError(ContactWeight::on_sphere(13e-3, 1.2, 0.5, 5.0).unwrap()),
    ]
}

#[test]
fn of_tubes() {
    let mut unchanged = unchanged("tubes");
    let weight = ContactWeight::on_sphere(13e-3, 1.2, 0.5, 5.0).unwrap();
    let layouts = layouts();
    unchanged.note(
        "layouts",
        layouts.iter().map(|layout| {
            let normalised = layout.normalised(1000.0, &loads()).unwrap();
            let strains =
                [TubeTheory::Corrected, TubeTheory::Reconstructed1987].map(|theory| layout.strains(theory));
            to_ten_digits(&(
                layout,
                strains,
                layout.closest_gauges(),
                Assessment::new(&normalised, Some(&weight.normalised(&loads().components()))),
                Decoupling::find(&normalised),
                LayoutFile::new(
                    layout,
                    &tube(layout.beam.radius),
                    Excitation { supply: 5.0, gauge_factor: 2.0, amplifier_gain: 1.0 },
                )
                .and_then(|file| Ok((file.to_toml()?, file.predicted_calibration()?.to_toml().ok()))),
            ))
        }),
    );
    let strengths = [1e-3, 5e-3, 20e-3].into_iter().flat_map(|radius| {
        [2e-5, 1e-4, 5e-4].map(|wall| {
            let tube = tube(radius);
            let strength =
                tube.strength(wall).map(|s| (s.worst_ratio(), s.safety(), s.failure(), s.holds(2.0), s));
            to_ten_digits(&(strength, tube.least_thickness(1.0 + 1e4 * wall)))
        })
    });
    unchanged.note("strengths", strengths.collect::<Vec<_>>());
    let care = Placement { angle: 8e-3, position: 5e-5 };
    let touches = Touch::on_sphere(13e-3, 1.2, 0.4, 5.0).unwrap();
    let few: Vec<Touch> = touches.iter().copied().step_by(40).collect();
    let spread = layouts.iter().take(4).map(|layout| {
        let judged = Touches::new(&few).unwrap();
        to_ten_digits(&(
            tolerance(layout, &loads(), care, Some(&judged), 12, 3),
            tolerance(layout, &loads(), care, None, 12, 3),
        ))
    });
    unchanged.note("tolerances", spread.collect::<Vec<_>>());
    let sphere = Sphere::centred(13e-3).unwrap();
    let used = [MatrixUsed::AsDesigned, MatrixUsed::Calibrated { loads: 30, load_error: 2e-3 }];
    let trials = used.into_iter().flat_map(|matrix| {
        let trial = Trial {
            loads: loads(),
            placement: care,
            noise: 1e-6,
            resolution: 5e-7,
            matrix,
            sensors: 5,
            seed: 4,
        };
        layouts[..4].iter().map(|layout| to_ten_digits(&trial.run(layout, &sphere, &few))).collect::<Vec<_>>()
    });
    unchanged.note("trials", trials.collect::<Vec<_>>());
    unchanged.check();
}

#[test]
fn of_criteria_and_structures() {
    let mut unchanged = unchanged("structures");
    let draw = &mut Draw::new(9);
    let nominal = loads().components();
    let grams: Vec<_> = (0..12)
        .map(|k| {
            let mut rows: Vec<Vector6<f64>> =
                (0..6 + k % 4).map(|_| Vector6::from_fn(|_, _| draw.signed())).collect();
            if k % 3 == 1 {
                rows[0] = rows[1] * 2.0 + rows[2] * 1e-6;
            }
            gram(&rows, &nominal)
        })
        .collect();
    for criterion in criteria() {
        unchanged.note(
            criterion.name(),
            grams.iter().map(|gram| {
                let smoothed = [2.0, 8.0, 30.0].map(|power| criterion.smoothed(gram, power));
                to_ten_digits(&(criterion.of(gram), criterion.has_creases(), smoothed))
            }),
        );
    }
    let candidates: Vec<Vector6<f64>> = (0..20).map(|_| Vector6::from_fn(|_, _| draw.signed())).collect();
    unchanged.note(
        "sites",
        criteria().iter().map(|criterion| to_ten_digits(&choose_sites(&candidates, 8, criterion, &loads()))),
    );
    let cross = MalteseCross {
        hub_radius: 6e-3,
        length: 15e-3,
        width: 4e-3,
        height: 6e-3,
        membrane_compliance: 1e-8,
        height_of_origin: 10e-3,
        gauge_distance: 2e-3,
    };
    let metal = Material::ALUMINIUM_7075_T6;
    let crosses = [
        cross,
        MalteseCross { width: 6e-3, height: 4e-3, ..cross },
        MalteseCross { width: 5e-3, height: 5e-3, membrane_compliance: 0.0, ..cross },
        MalteseCross { gauge_distance: 30e-3, ..cross },
    ];
    unchanged.note("crosses", crosses.iter().map(|cross| to_ten_digits(&cross.strains(&metal))));
    let platform = Stewart {
        base_radius: 20e-3,
        platform_radius: 15e-3,
        height: 25e-3,
        base_half_angle: 0.2,
        platform_half_angle: 0.3,
        height_of_origin: 30e-3,
    };
    let platforms = [
        platform,
        Stewart { base_radius: 15e-3, platform_half_angle: 0.8, ..platform },
        Stewart { height: 0.0, ..platform },
        Stewart {
            platform_half_angle: core::f64::consts::FRAC_PI_3 - 0.2,
            platform_radius: 20e-3,
            ..platform
        },
    ];
    unchanged.note(
        "platforms",
        platforms.iter().map(|p| {
            to_ten_digits(&(p.tensions(), p.strains(&metal, 3e-6), p.strength(&metal, 2e-3, &loads())))
        }),
    );
    unchanged.check();
}

fn found(space: &dyn DesignSpace, criterion: &Criterion, starts: usize) -> String {
    let how = Search { starts, seed: 5, threads: core::num::NonZero::new(2), same: 1e-3 };
    let findings = search(space, criterion, &loads(), &how, &|_| {});
    let parameters = space.parameters();
    let landscape = |values: &[f64]| {
        let axes = if parameters.len() > 1 {
            [0, 1]
        } else {
            return Err(DesignError::WrongCount { what: "axes", found: 1, expected: 2 });
        };
        Landscape::new(space, criterion, &loads(), values, axes, [5, 4]).map(|l| (l.least(), l))
    };
    let map = findings.as_ref().ok().and_then(|found| found.best()).map(|best| landscape(&best.values));
    to_ten_digits(&(findings, map))
}

#[test]
fn of_searches() {
    let mut unchanged = unchanged("searches");
    let [paper, _, rings, _] = spaces();
    let criteria = criteria();
    unchanged.note("tubes", [found(&paper, &criteria[0], 2), found(&rings, &criteria[2], 2)]);
    let section = Coordinate::fixed(5e-3);
    let angle = |name: &str| Parameter::periodic_angle(name, core::f64::consts::TAU);
    let rules: Vec<GaugeRule> = (0..6)
        .map(|k| GaugeRule {
            z: Coordinate::fixed(1e-3 * f64::from(k % 2)),
            theta: Coordinate::following(0, 1.0).plus(f64::from(k) * core::f64::consts::FRAC_PI_3),
            q: Coordinate::following(1, if k % 2 == 0 { 1.0 } else { -1.0 }),
        })
        .collect();
    let own = TubeSpace::new(
        vec![angle("turn"), angle("direction")],
        section,
        rules,
        tube(5e-3),
        Wall::Fixed(2e-4),
    )
    .unwrap();
    unchanged.note("a space of one's own", [found(&own, &criteria[4], 2)]);
    let metal = Material::ALUMINIUM_7075_T6;
    let stewart = StewartSpace::new((10e-3, 25e-3), (10e-3, 40e-3), 30e-3, metal, 3e-6).unwrap();
    let cross = MalteseCross {
        hub_radius: 6e-3,
        length: 15e-3,
        width: 4e-3,
        height: 6e-3,
        membrane_compliance: 1e-8,
        height_of_origin: 10e-3,
        gauge_distance: 2e-3,
    };
    let cross = MalteseCrossSpace::new((10e-3, 25e-3), (2e-3, 8e-3), cross, metal).unwrap();
    unchanged.note("structures", [found(&stewart, &criteria[0], 2), found(&cross, &criteria[2], 2)]);
    let draw = &mut Draw::new(10);
    let sites: Vec<StrainSite> =
        (0..8).map(|_| StrainSite { strains: Matrix3x6::from_fn(|_, _| 1e-6 * draw.signed()) }).collect();
    let angles = (0..8)
        .map(|k| if k < 3 { GaugeAngle::Free } else { GaugeAngle::Fixed(0.3 * f64::from(k)) })
        .collect();
    let structure = LinearStructure::new(sites, angles, Vec::new()).unwrap();
    unchanged.note("strain fields", [found(&structure, &criteria[3], 2)]);
    unchanged.check();
}

#[test]
fn of_touches() {
    let mut unchanged = unchanged("touches");
    let sphere = Sphere::new(Vector3::new(1e-3, 0.0, 2e-3), 13e-3).unwrap();
    for friction in [0.0, 0.6] {
        let sets = [
            Touch::on_sphere(13e-3, 1.1, friction, 2.5),
            Touch::on_surface(&sphere, Vector3::new(1e-3, 0.0, 2e-3), 0.05, friction, 2.5),
        ];
        let told = sets.iter().map(|set| {
            let touches = set.as_ref().unwrap();
            let weight = ContactWeight::over(touches.iter().copied()).unwrap();
            format!("{} {}", to_ten_digits(weight.matrix()), to_ten_digits(touches))
        });
        unchanged.note(&format!("friction {friction}"), told);
    }
    unchanged.check();
}
