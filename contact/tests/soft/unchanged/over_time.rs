//! Contacts over time, and contacts fused with an array.

use fingertip_contact::{
    ArrayContact, Contact, ContactEvents, ContactModel, FingerVelocity, Fusion, LineMeeting, MotionJudge,
    PointContact, RollingCurvature, Sighting, SoftFinger, Tracker, WrenchSpread,
};
use fingertip_surfaces::{DynSurface, SmoothSurface};
use fingertip_test_support::Unchanged;
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix2, Matrix3, Vector3};

use super::Double;
use super::draw::{Draw, noise};
use crate::common;

/// A wrench whose contact wanders over the surface by small steps, and now and then jumps, lets go or presses hard.
struct Wandering<'a> {
    draw: Draw,
    surface: &'a Double,
    last: (Vector3<f64>, Vector3<f64>),
    aside: Vector3<f64>,
    step: u32,
}

impl<'a> Wandering<'a> {
    fn new(surface: &'a Double) -> Self {
        let mut draw = Draw::new(41);
        let last = draw.place(surface, 0.015);
        Self { draw, surface, last, aside: Vector3::x(), step: 0 }
    }

    /// Force and torque, which are zero while nothing touches, and the time since the last \[s\].
    fn next(&mut self) -> (Wrench<f64>, f64) {
        self.step += 1;
        if self.step.is_multiple_of(97) {
            self.last = self.draw.place(self.surface, 0.015);
        }
        let (point, normal) = self.last;
        let moved = point + self.aside * 2e-5 + self.draw.vector() * 3e-6;
        let found = PointContact::new(0.0).unwrap().with_greatest_gap(0.01).unwrap().resolve_near(
            &Wrench::from_force_at(&moved, -normal),
            self.surface,
            Some(&moved),
        );
        if let Some(contact) = found.contact() {
            self.last = (contact.point, contact.normal);
        }
        if self.step.is_multiple_of(31) {
            self.aside = self.draw.direction();
        }
        let size = match self.step % 150 {
            0..20 => 0.0,
            20..24 => 9.0,
            _ => 1.0 + self.draw.within(-0.1, 0.1),
        };
        let pressing = Wrench::from_force_at(&self.last.0, (self.aside * 0.2 - self.last.1) * size);
        let noise = Wrench::on_fingertip(self.draw.vector() * 3e-3, self.draw.vector() * 4e-5);
        let time = if self.step.is_multiple_of(211) { 0.3 } else { 1e-3 };
        (pressing + noise, time)
    }
}

fn followed<T: Real>(unchanged: &mut Unchanged, name: &str, surface: &DynSurface<T>, double: &Double) {
    let number = T::literal;
    let mut wandering = Wandering::new(double);
    let mut tracker = Tracker::new(number(0.02), number(0.1)).unwrap();
    let mut soft_tracker = tracker.with_gate(number(1e-4)).unwrap();
    let events = ContactEvents::new(number(3e-3), number(0.05), number(1e6)).unwrap();
    let mut events = events.with_longest_impact(number(0.03)).unwrap();
    let judge = MotionJudge::new(number(0.02), number(1e-3), number(0.05)).unwrap();
    let mut learnt = RollingCurvature::new(number(0.013)).unwrap();
    let mut meeting = LineMeeting::new();
    let (point, soft) = (PointContact::new(number(0.05)).unwrap(), SoftFinger::new(number(0.05)).unwrap());
    let spread = WrenchSpread::Isotropic { force: number(9e-6), torque: number(16e-10) };
    let full = noise();
    let mut last = None;
    let answers = (0..700).map(|k| {
        let (wrench, time) = wandering.next();
        let wrench = Wrench::on_fingertip(wrench.force().map(number), wrench.torque().map(number));
        let time = number(time);
        let found = point.resolve_near(&wrench, surface, last.as_ref());
        let found: Option<&Contact<T>> = found.contact();
        let seen = found.and_then(|contact| Sighting::of_point_contact(contact, &wrench, spread));
        let tracked = tracker.follow(surface, seen.as_ref(), time);
        last = tracked.map(|tracked| tracked.point);
        let felt = soft.resolve_near(&wrench, surface, last.as_ref());
        let felt = felt.contact().and_then(|contact| Sighting::of_soft_finger(contact, surface, &full));
        let soft_tracked = soft_tracker.follow(surface, felt.as_ref(), time);
        let finger = FingerVelocity {
            linear: Vector3::new(0.02, 0.0, -0.01).map(number),
            angular: wandering.draw.vector().map(number),
        };
        let (mut motions, mut over) = (None, None);
        if let (Some(tracked), Some(seen)) = (tracked, seen) {
            let bend = surface.shape_operator(&tracked.point);
            let [e1, e2] = tracked.tangents;
            let curvature = Matrix2::new(
                e1.dot(&(bend * e1)),
                e1.dot(&(bend * e2)),
                e2.dot(&(bend * e1)),
                e2.dot(&(bend * e2)),
            );
            learnt.roll(&tracked, &seen, &finger, &curvature, time);
            motions = judge.judge(&tracked, &finger);
            let sliding = finger.sliding(&tracked.point, &tracked.normal);
            over = Some((
                finger.rolling(&tracked.normal, &tracked.tangents, &curvature, &Matrix2::zeros()),
                sliding,
            ));
        }
        if k % 60 == 0 {
            meeting.reset();
        }
        let taken = meeting.add(&wrench, spread);
        let met = meeting.find();
        let deviation = met.as_ref().ok().map(|met| met.deviation());
        let happened = events.observe(&wrench.force(), time);
        ((tracked, soft_tracked, happened), (motions, over, learnt.find()), (taken, met, deviation))
    });
    unchanged.note(name, answers);
}

fn fused<T: Real>(unchanged: &mut Unchanged, name: &str, surface: &DynSurface<T>, double: &Double) {
    let mut draw = Draw::new(43);
    let fusion = Fusion::new(noise(), T::literal(0.6)).unwrap();
    let answers = (0..60).map(|k| {
        let places = [(); 3].map(|()| draw.place(double, 0.015));
        let mut wrench: Wrench<f64> = Wrench::zero();
        let readings = places.map(|(point, normal)| {
            let pressing = draw.within(0.3, 3.0);
            let force = draw.aside(&normal) * (pressing * draw.within(0.0, 0.9)) - normal * pressing;
            wrench = wrench + Wrench::from_force_at(&point, force);
            ArrayContact {
                centroid: (point + draw.vector() * 3e-4).map(T::literal),
                centroid_covariance: Matrix3::identity() * T::literal(9e-8),
                normal_force: T::literal(pressing + draw.within(-0.1, 0.1)),
                normal_deviation: T::literal(0.1),
            }
        });
        let wrench = Wrench::on_fingertip(wrench.force().map(T::literal), wrench.torque().map(T::literal));
        let [first, second, _] = readings;
        match k % 3 {
            0 => format!("{:?}", fusion.estimate(surface, &wrench, &[first])),
            1 => format!("{:?}", fusion.estimate(surface, &wrench, &[first, second])),
            _ => format!("{:?}", fusion.estimate(surface, &wrench, &readings)),
        }
    });
    unchanged.note(name, answers);
}

#[test]
fn followed_over_time() {
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/followed.txt");
    each_shape!(followed, unchanged; sphere ellipsoid capsule capped_cylinder mesh);
    unchanged.check();
}

#[test]
fn fused_with_an_array() {
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/fused.txt");
    each_shape!(fused, unchanged; sphere ellipsoid capsule);
    unchanged.check();
}
