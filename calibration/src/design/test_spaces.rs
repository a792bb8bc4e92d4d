//! Spaces that several tests use.

use super::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};

fn tube() -> LoadedTube {
    LoadedTube {
        material: Material { poisson_ratio: 0.33, ..Material::ALUMINIUM_7075_T6 },
        radius: 10e-3,
        length: 40e-3,
        loads: NominalLoads { force: [10.0; 3], torque: [0.1; 3] },
    }
}

/// The paper's six gauges, over all radii, angles and distances that make sense.
pub(super) fn paper() -> TubeSpace {
    let angle = (1_f64.to_radians(), 59_f64.to_radians());
    TubeSpace::bicchi_dario((2e-3, 15e-3), angle, (2e-3, 40e-3), tube(), Wall::Fixed(0.2e-3)).unwrap()
}

/// Six free gauges on a tube of R = m/f.
pub(super) fn free() -> TubeSpace {
    TubeSpace::free(6, (-20e-3, 20e-3), tube(), Wall::Fixed(0.2e-3)).unwrap()
}

/// Pairs at ±Q in a ring.
pub(super) fn rosettes(count: usize) -> TubeSpace {
    let angle = (1_f64.to_radians(), 59_f64.to_radians());
    TubeSpace::rosettes(count, (2e-3, 20e-3), angle, (-20e-3, 20e-3), tube(), Wall::Fixed(0.2e-3)).unwrap()
}
