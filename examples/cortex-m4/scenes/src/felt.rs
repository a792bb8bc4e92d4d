//! What a scene tells of a sample.

use fingertip::Touch;
use fingertip::friction::{SlipMargin, SlipVerdict};
use nalgebra::Matrix2;

/// An answer as bits, to be compared between machines.
pub trait Words {
    /// Calls `visit` with every word of the answer.
    fn words(&self, visit: impl FnMut(u32));
}

/// One number that stands for all bits of an answer (FNV-1a, word by word).
#[must_use]
pub fn fold(answer: &impl Words) -> u32 {
    let mut sum = 0x811c_9dc5_u32;
    answer.words(|word| sum = (sum ^ word).wrapping_mul(0x0100_0193));
    sum
}

/// Contact, forces, slip margin and what the detector says: what a hand controller needs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Felt {
    /// 1 in contact, 0 without; all forces are zero then.
    pub contact: u32,
    /// Where \[m\].
    pub point: [f32; 3],
    /// Normal force \[N\].
    pub normal_force: f32,
    /// Tangential force \[N\].
    pub tangential_force: [f32; 3],
    /// Spin torque \[N·m\].
    pub spin_torque: f32,
    /// Slip margin \[N\].
    pub margin: f32,
    /// How much of the friction limit is used.
    pub utilisation: f32,
    /// The detector's verdict: 0 not pressing, 1 holding, 2 warning, 3 slipping.
    pub slip: u32,
}

impl Felt {
    #[inline(always)]
    pub(crate) fn of(touch: &Touch<f32, SlipMargin<f32>, SlipVerdict>) -> Self {
        let slip = match touch.slip {
            SlipVerdict::NotPressing => 0,
            SlipVerdict::Holding => 1,
            SlipVerdict::Warning => 2,
            SlipVerdict::Slipping => 3,
        };
        match (touch.resolution.contact(), touch.force, touch.grip) {
            (Some(contact), Some(force), Some(grip)) => Self {
                contact: 1,
                point: contact.point.into(),
                normal_force: force.normal,
                tangential_force: force.tangential.vector().into(),
                spin_torque: force.spin,
                margin: grip.newtons,
                utilisation: grip.utilisation,
                slip,
            },
            _ => Self { slip, ..Self::default() },
        }
    }
}

impl Words for Felt {
    fn words(&self, mut visit: impl FnMut(u32)) {
        visit(self.contact);
        visit(self.slip);
        let forces = self.point.iter().chain(&self.tangential_force);
        let rest = [self.normal_force, self.spin_torque, self.margin, self.utilisation];
        forces.chain(&rest).for_each(|x| visit(x.to_bits()));
    }
}

/// Covariance of a contact's position along two tangents \[m²\]: both variances, and the covariance.
pub type Spread = [f32; 3];

pub(crate) fn spread(covariance: &Matrix2<f32>) -> Spread {
    [covariance.m11, covariance.m22, covariance.m12]
}
