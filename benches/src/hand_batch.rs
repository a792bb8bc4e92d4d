//! The yardstick of a batch: scene A by hand for many samples, one loop from volts to verdicts that the
//! compiler vectorises for the processor at hand.
//!
//! It keeps the contract of the pipeline as the yardstick of a sample does: if a sample is no contact,
//! all are done over one by one.

use fingertip::Touches;
use fingertip::friction::SlipVerdict;

use crate::hand_written::{HandA, add, cross, dot};

impl HandA {
    /// Many samples, a column for each gauge; all columns are as long as the first.
    pub fn sense_all(&self, raw: [&[f32]; 6], touches: Touches<'_, f32>) {
        // What it is given moves into the closure, which then is called itself, not by way of a function
        // that knows no wide vectors.
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || self.sense_columns(raw, touches),
        );
    }

    #[inline(always)]
    fn sense_columns(&self, raw: [&[f32]; 6], touches: Touches<'_, f32>) {
        let Touches { point: [px, py, pz], normal_force, tangential_force: [tx, ty, tz], .. } = touches;
        let (margin, utilisation, slip) = (touches.margin, touches.utilisation, touches.slip);
        if self.sweep(raw, px, py, pz, normal_force, tx, ty, tz, margin, utilisation, slip) {
            return;
        }
        for k in 0..slip.len() {
            let felt = self.sense(&raw.map(|column| column[k]));
            [px[k], py[k], pz[k]] = felt.point;
            [tx[k], ty[k], tz[k]] = felt.tangential_force;
            (normal_force[k], margin[k], utilisation[k]) = (felt.normal_force, felt.margin, felt.utilisation);
            slip[k] = match felt.slip {
                0 => SlipVerdict::NotPressing,
                1 => SlipVerdict::Holding,
                2 => SlipVerdict::Warning,
                _ => SlipVerdict::Slipping,
            };
        }
    }

    /// Samples that all press: `false` if one does not, and then what is written means nothing.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn sweep(
        &self,
        raw: [&[f32]; 6],
        px: &mut [f32],
        py: &mut [f32],
        pz: &mut [f32],
        normal_force: &mut [f32],
        tx: &mut [f32],
        ty: &mut [f32],
        tz: &mut [f32],
        margin: &mut [f32],
        utilisation: &mut [f32],
        slip: &mut [SlipVerdict],
    ) -> bool {
        let count = slip.len();
        let [a, b, c, d, e, f] = raw.map(|column| &column[..count]);
        let (px, py, pz) = (&mut px[..count], &mut py[..count], &mut pz[..count]);
        let (tx, ty, tz) = (&mut tx[..count], &mut ty[..count], &mut tz[..count]);
        let (normal_force, margin) = (&mut normal_force[..count], &mut margin[..count]);
        let utilisation = &mut utilisation[..count];
        let friction = &self.friction;
        let mut all = true;
        for k in 0..count {
            let (force, torque) = self.wrench(&[a[k], b[k], c[k], d[k], e[k], f[k]]);
            let squared = dot(force, force);
            let inverse = 1.0 / squared;
            let scale = inverse * self.curvature;
            let foot = cross(force, torque).map(|x| x * scale);
            let sine_squared = dot(foot, foot);
            let cosine_squared = 1.0 - sine_squared;
            all &= (squared >= self.least_squared) & (cosine_squared > 0.0);
            let back = (cosine_squared * inverse).sqrt();
            let normal = add(foot, force, -back);
            let point = normal.map(|x| x * self.radius);
            let pressing = squared * back;
            let tangential = add(force, normal, pressing);
            let load = (squared * sine_squared).sqrt();
            let holding = friction.coefficient * pressing;
            (px[k], py[k], pz[k]) = (point[0], point[1], point[2]);
            (tx[k], ty[k], tz[k]) = (tangential[0], tangential[1], tangential[2]);
            (normal_force[k], margin[k]) = (pressing, (holding - load) * friction.cosine);
            utilisation[k] = load / holding;
            let near =
                if load >= friction.warning * pressing { SlipVerdict::Warning } else { SlipVerdict::Holding };
            let said = if load >= holding { SlipVerdict::Slipping } else { near };
            slip[k] = if pressing > friction.gate { said } else { SlipVerdict::NotPressing };
        }
        all
    }
}
