//! Limits and detectors that are chosen at run time and owned: in a box, with an allocator.

use fingertip_wrench::{ContactForce, Real};

use crate::{FrictionLimit, FrictionModel, SlipDetector, SlipDirection, SlipMargin, SlipVerdict};

impl<T: Real, M: FrictionModel<T> + ?Sized> FrictionModel<T> for Box<M> {
    #[inline]
    fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T> {
        (**self).slip_margin(force)
    }

    #[inline]
    fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T {
        (**self).least_normal_force(force, safety)
    }
}

impl<T: Real, M: FrictionLimit<T> + ?Sized> FrictionLimit<T> for Box<M> {
    #[inline]
    fn normal_force_keeping(&self, force: &ContactForce<T>, margin: T) -> T {
        (**self).normal_force_keeping(force, margin)
    }

    #[inline]
    fn project(&self, force: &ContactForce<T>) -> ContactForce<T> {
        (**self).project(force)
    }

    #[inline]
    fn slip_direction(&self, force: &ContactForce<T>) -> Option<SlipDirection<T>> {
        (**self).slip_direction(force)
    }
}

impl<T: Real, D: SlipDetector<T> + ?Sized> SlipDetector<T> for Box<D> {
    #[inline]
    fn update(&mut self, force: &ContactForce<T>, time_step: T) -> SlipVerdict {
        (**self).update(force, time_step)
    }

    #[inline]
    fn update_open(&mut self, time_step: T) -> SlipVerdict {
        (**self).update_open(time_step)
    }

    #[inline]
    fn reset(&mut self) {
        (**self).reset();
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::{Coulomb, ForceNoise, NormalForceGate, RatioThreshold, SoftFingerLimit};

    /// A box answers as what is in it, whichever call is made.
    #[test]
    fn a_box_is_what_is_in_it() {
        let force = ContactForce::new(2.0, Vector3::new(0.7, -0.2, 0.0), 1e-3);
        let (plain, soft) = (Coulomb::new(0.5).unwrap(), SoftFingerLimit::new(0.5, 3e-3).unwrap());
        let boxed: [Box<dyn FrictionLimit<f64>>; 2] = [Box::new(plain), Box::new(soft)];
        let bare: [&dyn FrictionLimit<f64>; 2] = [&plain, &soft];
        for (boxed, bare) in boxed.iter().zip(bare) {
            assert_eq!(FrictionModel::slip_margin(boxed, &force), bare.slip_margin(&force));
            let least = FrictionModel::least_normal_force(boxed, &force, 1.5);
            assert_eq!(least.to_bits(), bare.least_normal_force(&force, 1.5).to_bits());
            assert_eq!(FrictionLimit::project(boxed, &force), bare.project(&force));
            assert_eq!(FrictionLimit::slip_direction(boxed, &force), bare.slip_direction(&force));
            let keeping = FrictionLimit::normal_force_keeping(boxed, &force, 0.1);
            assert_eq!(keeping.to_bits(), bare.normal_force_keeping(&force, 0.1).to_bits());
        }
        let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01).unwrap());
        let mut detector: Box<dyn SlipDetector<f64>> =
            Box::new(RatioThreshold::new(gate, 0.3).unwrap().with_warning_share(0.8).unwrap());
        assert_eq!(SlipDetector::update(&mut detector, &force, 1e-3), SlipVerdict::Slipping);
        assert_eq!(SlipDetector::update_open(&mut detector, 1e-3), SlipVerdict::NotPressing);
        SlipDetector::reset(&mut detector);
    }
}
