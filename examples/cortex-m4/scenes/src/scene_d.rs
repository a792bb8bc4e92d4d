//! D: everything: eight gauges that watch each other, a mesh, memory of the last contact, a power-law
//! limit surface, the likelihood ratio of a drop, the covariance of the contact.

use fingertip::contact::{ContactCovariance, PointContact};
use fingertip::friction::{LikelihoodRatioDetector, PowerLimit, PressureDistribution};
use fingertip::wrench::{
    Compensation, ConsistencyCheck, LeastSquares, SensorMatrix, Tare, Verdict, WrenchCovariance, WrenchSolver,
};
use fingertip::{Fingertip, Present, Step};
use fingertip_surfaces::Mesh;
use nalgebra::{SMatrix, SVector, Vector3};

use crate::felt::spread;
use crate::{FRICTION, Felt, LEAST_FORCE, STEP, Scene, Spread, Words, noise, sensor, session};

/// Standard deviation of a signal \[V\].
const SIGNAL_NOISE: f32 = 4e-4;
/// Radius of the sphere that the mesh approximates \[m\].
const RADIUS: f32 = 13e-3;

/// Everything, a mesh included: the only scene that needs memory from a heap, once.
pub struct SceneD {
    fingertip: Fingertip<
        LeastSquares<f32, 8>,
        Mesh<f32>,
        PointContact<f32>,
        Present<PowerLimit<f32>>,
        Present<LikelihoodRatioDetector<f32, 16>>,
        Tare<f32, 8>,
    >,
    /// The solver once more, for what its redundancy tells.
    gauges: LeastSquares<f32, 8>,
    check: ConsistencyCheck<f32, 8>,
    noise: WrenchCovariance<f32, 8>,
    last: Option<Vector3<f32>>,
}

/// What is felt, how sure that is, and whether the gauges agree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Assessment {
    /// What is felt.
    pub felt: Felt,
    /// How sure the position is.
    pub spread: Spread,
    /// 1 if noise explains what the gauges disagree by.
    pub consistent: u32,
}

impl Words for Assessment {
    fn words(&self, mut visit: impl FnMut(u32)) {
        self.felt.words(&mut visit);
        self.spread.iter().for_each(|x| visit(x.to_bits()));
        visit(self.consistent);
    }
}

/// A sphere as 128 triangles: the faces of an octahedron, each cut into sixteen.
fn mesh() -> Option<Mesh<f32>> {
    const CUTS: u16 = 4;
    let mut vertices = [Vector3::zeros(); 8 * 48];
    let mut triangles = [[0; 3]; 8 * 16];
    let mut corners = vertices.iter_mut();
    let mut place = |octant: u8, i: u16, j: u16| {
        let sign = |bit: u8| if octant & bit == 0 { 1.0 } else { -1.0 };
        let raw =
            Vector3::new(f32::from(i) * sign(1), f32::from(j) * sign(2), f32::from(CUTS - i - j) * sign(4));
        if let Some(corner) = corners.next() {
            *corner = raw * (RADIUS / fingertip::wrench::Real::root(raw.norm_squared()));
        }
    };
    for octant in 0..8_u8 {
        // A reflection turns the winding.
        let turned = octant.count_ones() % 2 == 1;
        for i in 0..CUTS {
            for j in 0..CUTS - i {
                let mut add = |a: (u16, u16), b: (u16, u16), c: (u16, u16)| {
                    let (b, c) = if turned { (c, b) } else { (b, c) };
                    place(octant, a.0, a.1);
                    place(octant, b.0, b.1);
                    place(octant, c.0, c.1);
                };
                add((i, j), (i + 1, j), (i, j + 1));
                if i + j + 1 < CUTS {
                    add((i + 1, j), (i + 1, j + 1), (i, j + 1));
                }
            }
        }
    }
    for (index, triangle) in (0_u32..).zip(&mut triangles) {
        *triangle = [3 * index, 3 * index + 1, 3 * index + 2];
    }
    Mesh::new(&vertices, &triangles).ok()
}

impl Scene<8> for SceneD {
    const NAME: &'static str = "d";
    type Answer = Assessment;

    fn session() -> &'static [[u16; 8]] {
        &session::D
    }

    fn sensor() -> Option<SensorMatrix<f32, 8>> {
        sensor(&session::EIGHT)
    }

    fn new() -> Option<Self> {
        let sensor = Self::sensor()?;
        let deviations = SVector::repeat(SIGNAL_NOISE);
        let gauges = LeastSquares::new(&sensor).ok()?;
        let check = ConsistencyCheck::new(&gauges, &deviations, 1e-6).ok()?;
        let uncertain = SMatrix::<f32, 8, 6>::repeat(1e-3);
        let noise_of_wrench = WrenchCovariance::from_noise(&sensor, &gauges, &deviations)
            .and_then(|covariance| covariance.with_matrix_deviations(&sensor, &uncertain))
            .ok()?;
        let fingertip = Fingertip::builder()
            .zero(Self::tare()?)
            .solver(gauges)
            .contact(mesh()?, PointContact::new(LEAST_FORCE).ok()?)
            .friction(PowerLimit::for_patch(FRICTION, 2e-3, PressureDistribution::Hertz).ok()?)
            .slip_detector(LikelihoodRatioDetector::new(noise()?, 1.0, 1000.0).ok()?)
            .build();
        Some(Self { fingertip, gauges, check, noise: noise_of_wrench, last: None })
    }

    #[inline(always)]
    fn sense(&mut self, volts: &SVector<f32, 8>) -> Assessment {
        let signals = self.fingertip.zero().compensate(volts);
        let consistent = matches!(self.check.verdict(&self.gauges, &signals), Verdict::Consistent);
        let wrench = self.gauges.solve(&signals);
        let touch = self.fingertip.sense_wrench(wrench, Step::of(STEP).with_last(self.last));
        self.last = touch.point();
        let spread = touch.resolution.contact().and_then(|contact| {
            let covariance =
                ContactCovariance::point_contact_position(contact, &wrench, &self.noise.at(&wrench))?;
            Some(spread(&covariance))
        });
        Assessment {
            felt: Felt::of(&touch),
            spread: spread.unwrap_or_default(),
            consistent: u32::from(consistent),
        }
    }
}
