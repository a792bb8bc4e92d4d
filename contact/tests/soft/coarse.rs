//! A surface whose formula rounds badly has contacts all the same, as far as its digits go.

use fingertip_contact::{ContactModel, Search, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{Implicit, ImplicitSurface, Sphere, Term, Topology};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::wrenches::{Case, Random};

const RADIUS: f64 = 0.01;

/// A ball of 10 mm, by a formula to which a large number is added and from which it is taken away.
#[derive(Clone, Copy, Debug)]
struct Coarse {
    lost: f64,
    topology: Topology,
}

impl<T: Real> ImplicitSurface<T> for Coarse {
    fn formula(&self, point: [Term<T>; 3]) -> Term<T> {
        let [x, y, z] = point.map(|x| (x * T::literal(1.0 / RADIUS)).square());
        x + y + z + T::literal(self.lost) - T::literal(self.lost + 1.0)
    }

    fn ball(&self) -> (Vector3<T>, T) {
        (Vector3::zeros(), T::literal(RADIUS * 1.01))
    }

    fn steepest(&self) -> Option<T> {
        Some(T::literal(2.1 / RADIUS))
    }

    fn topology(&self) -> Topology {
        self.topology
    }
}

/// The contacts are those of the ball, and are found one and all; the error, in units of rounding.
fn as_on_the_ball<T: Real>(lost: f64, topology: Topology, count: usize) -> f64
where
    Implicit<T, Coarse>: SoftFingerSurface<T>,
{
    let coarse: Implicit<T, Coarse> = Implicit::new(Coarse { lost, topology }).unwrap();
    let ball = Sphere::centred(RADIUS).unwrap();
    let model = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
    let (mut random, mut worst) = (Random::new(191), 0.0_f64);
    for _ in 0..count {
        let case = Case::random(&mut random, &ball, RADIUS, [1e-3, 30.0], 1.0);
        let force = case.wrench.force().map(T::literal);
        let wrench = Wrench::on_fingertip(force, case.wrench.torque().map(T::literal));
        let found = model.resolve(&wrench, &coarse);
        let contact = found.contact().unwrap_or_else(|| panic!("{lost} {topology:?} {case:?} {found:?}"));
        assert_eq!(contact.alternatives, 0, "{case:?}");
        let off = (contact.point.map(Real::to_f64) - case.point).norm() / RADIUS * case.incidence.min(1.0);
        worst = worst.max(off / (T::EPSILON.to_f64() * (lost + 10.0)));
    }
    worst
}

#[test]
fn digits_that_a_formula_loses_do_not_lose_the_contact() {
    for lost in [30.0, 1e3, 1e5] {
        let convex = as_on_the_ball::<f64>(lost, Topology::Convex, 150);
        let closed = as_on_the_ball::<f64>(lost, Topology::Closed { euler_characteristic: 2 }, 3);
        println!("{lost}: {convex:.1} and {closed:.1} of rounding");
        assert!(convex < 4.0 && closed < 4.0, "{lost} {convex} {closed}");
    }
    let single = as_on_the_ball::<f32>(30.0, Topology::Convex, 150);
    println!("single: {single:.1} of rounding");
    assert!(single < 4.0, "{single}");
}

/// A closed surface that is said to be of another kind than it is has too few contacts, or too many.
#[test]
fn a_wrong_number_of_contacts_is_noticed() {
    let ball = Sphere::centred(RADIUS).unwrap();
    let mut random = Random::new(192);
    for (euler_characteristic, holds) in [(2, true), (0, false), (-2, false), (4, false)] {
        let coarse: Implicit<f64, Coarse> =
            Implicit::new(Coarse { lost: 0.0, topology: Topology::Closed { euler_characteristic } }).unwrap();
        for _ in 0..2 {
            let case = Case::random(&mut random, &ball, RADIUS, [0.1, 1.0], 1.0);
            let mut found = 0;
            let search = coarse.soft_contacts(&case.wrench, None, |_| found += 1);
            assert_eq!(found, 1);
            assert_eq!(matches!(search, Search::Complete), holds, "{euler_characteristic}");
        }
    }
}
