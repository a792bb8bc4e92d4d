//! What each stage is handed, and what becomes of its answer.

use core::cell::RefCell;

use fingertip::contact::{Contact, ContactModel, NoContact, PointContact, Resolution};
use fingertip::friction::{
    Coulomb, DropDetector, ForceNoise, FrictionModel, NormalForceGate, RatioThreshold, SlipDetector,
    SlipMargin, SlipVerdict,
};
use fingertip::surfaces::{Sphere, Torus};
use fingertip::wrench::{
    Compensation, ContactForce, GaussianElimination, Motion, Payload, Tare, Uncompensated, Wrench,
    WrenchSolver,
};
use fingertip::{Absent, Fingertip, GripStage, SlipStage, Step};
use nalgebra::{SVector, Vector3};

use crate::paper_sensor;

const RADIUS: f64 = 13e-3;

#[test]
fn the_tare_is_taken_off_before_solving() {
    let sensor = paper_sensor::<f64>();
    let bias = SVector::<f64, 6>::from_fn(|i, _| 0.01 * (i as f64 + 1.0));
    let mut fingertip = Fingertip::builder()
        .zero(Tare::new(bias))
        .solver(GaussianElimination::new(&sensor).unwrap())
        .contact(Sphere::centred(RADIUS).unwrap(), PointContact::new(0.1).unwrap())
        .build();
    let truth = Wrench::from_force_at(&Vector3::new(RADIUS, 0.0, 0.0), Vector3::new(-2.0, 0.0, 0.0));
    let touch = fingertip.sense(&(sensor.signals(&truth) + bias), 1e-3);
    let contact = touch.resolution.into_result().unwrap();
    assert!((contact.normal_force() - 2.0).abs() < 1e-12);
}

#[test]
fn no_load_is_no_contact_and_resets_the_detector() {
    let noise = ForceNoise::isotropic(0.02).unwrap();
    let mut fingertip = Fingertip::builder()
        .contact(Sphere::centred(RADIUS).unwrap(), PointContact::new(0.1).unwrap())
        .slip_detector(DropDetector::new(noise).unwrap())
        .build();
    let touch = fingertip.sense_wrench(Wrench::<f64>::zero(), 1e-3);
    assert!(matches!(touch.resolution, Resolution::NoContact(NoContact::BelowThreshold { .. })));
    assert_eq!(touch.slip, SlipVerdict::NotPressing);
    assert!(touch.grip.is_none() && touch.point().is_none());
}

#[test]
fn an_absent_stage_takes_no_memory() {
    type Solver = GaussianElimination<f32>;
    type Bare = Fingertip<Solver, Sphere<f32>, PointContact<f32>>;
    assert_eq!(size_of::<Absent>() + size_of::<Uncompensated>(), 0);
    assert_eq!(
        size_of::<Bare>(),
        size_of::<Solver>() + size_of::<Sphere<f32>>() + size_of::<PointContact<f32>>(),
    );
}
/// A user's own stages need nothing from this workspace but its traits.
#[test]
fn own_stages_plug_in() {
    struct Counts;
    impl Compensation<SVector<f64, 6>> for Counts {
        type Raw = [i16; 6];
        fn compensate(&self, raw: &[i16; 6]) -> SVector<f64, 6> {
            SVector::from(raw.map(|count| f64::from(count) * 1e-3))
        }
    }
    struct Direct;
    impl WrenchSolver<f64, 6> for Direct {
        fn solve(&self, signals: &SVector<f64, 6>) -> Wrench<f64> {
            Wrench::from_components(signals)
        }
    }
    let mut fingertip = Fingertip::builder()
        .zero(Counts)
        .solver(Direct)
        .contact(Sphere::centred(RADIUS).unwrap(), PointContact::new(0.0).unwrap())
        .build();
    let touch = fingertip.sense(&[0, 0, -1500, 0, 0, 0], 1e-3);
    let contact = touch.resolution.into_result().unwrap();
    assert_eq!(contact.point, Vector3::new(0.0, 0.0, RADIUS));
    assert_eq!(contact.normal_force(), 1.5);
}

/// What a model was handed: wrench and last point.
type Handed = RefCell<Vec<(Wrench<f64>, Option<Vector3<f64>>)>>;

/// A contact model that notes what it is handed and says contact wherever there is a force.
struct Noted<'a>(&'a Handed);

impl<S> ContactModel<f64, S> for Noted<'_> {
    fn resolve_near(&self, wrench: &Wrench<f64>, _: &S, last: Option<&Vector3<f64>>) -> Resolution<f64> {
        self.0.borrow_mut().push((*wrench, last.copied()));
        if wrench.force() == Vector3::zeros() {
            return Resolution::NoContact(NoContact::BelowThreshold { force: 0.0 });
        }
        Resolution::Contact(Contact {
            point: Vector3::new(0.0, 0.0, RADIUS),
            normal: Vector3::z(),
            force: wrench.force(),
            spin_torque: 0.25,
            gap: 0.0,
            alternatives: 0,
            searched: false,
        })
    }
}

/// The signals are the wrench.
struct Direct;

impl WrenchSolver<f64, 6> for Direct {
    fn solve(&self, signals: &SVector<f64, 6>) -> Wrench<f64> {
        Wrench::from_components(signals)
    }
}

/// A force whose parts along and across z all differ, and a torque.
fn pressed() -> Wrench<f64> {
    Wrench::on_fingertip(Vector3::new(3.0, 4.0, -10.0), Vector3::new(0.1, -0.2, 0.3))
}

/// What friction sees of it at a contact with the normal z.
fn split() -> ContactForce<f64> {
    ContactForce::new(10.0, Vector3::new(3.0, 4.0, 0.0), 0.25)
}

fn sphere() -> Sphere<f64> {
    Sphere::centred(RADIUS).unwrap()
}

#[test]
fn the_model_is_handed_the_wrench_and_the_last_point() {
    let handed = Handed::default();
    let mut fingertip = Fingertip::builder().solver(Direct).contact(sphere(), Noted(&handed)).build();
    let last = Vector3::new(1.0, 2.0, 3.0);
    let felt = fingertip.sense_wrench(pressed(), Step::of(1e-3).with_last(Some(last)));
    let again = fingertip.sense_wrench(pressed(), 1e-3);
    let sensed = fingertip.sense(&(-pressed()).components(), Step::of(1e-3).with_last(Some(2.0 * last)));
    // The touch reports the load on the fingertip, as it was handed in or solved.
    assert_eq!((felt.wrench, again.wrench, sensed.wrench), (pressed(), pressed(), -pressed()));
    assert_eq!((felt.force, felt.grip, felt.slip), (Some(split()), Some(()), ()));
    assert_eq!(felt.resolution.contact().unwrap().force, pressed().force());
    assert_eq!(
        *handed.borrow(),
        [(pressed(), Some(last)), (pressed(), None), (-pressed(), Some(2.0 * last))]
    );
}

/// A line through both sides of a ring enters it twice: the last point decides which entry is meant.
#[test]
fn the_last_point_chooses_between_two_entries() {
    let mut fingertip = Fingertip::builder()
        .contact(Torus::new(10e-3, 3e-3).unwrap(), PointContact::new(0.0).unwrap())
        .build();
    // Along −x through the ring: into the tube at x = 13 mm, and again at x = −7 mm.
    let wrench = Wrench::from_force_at(&Vector3::zeros(), Vector3::new(-1.0, 0.0, 0.0));
    for x in [13e-3, -7e-3] {
        let last = Vector3::new(x, 1e-3, 0.0);
        let touch = fingertip.sense_wrench(wrench, Step::of(1e-3).with_last(Some(last)));
        let point = touch.point().unwrap();
        assert!((point - Vector3::new(x, 0.0, 0.0)).norm() < 1e-15, "{point}");
    }
}

/// A payload stage of one's own, told a factor at each sample.
struct Share;

impl Compensation<Wrench<f64>> for Share {
    type Raw = (Wrench<f64>, f64);

    fn compensate(&self, (measured, share): &(Wrench<f64>, f64)) -> Wrench<f64> {
        *measured * *share
    }
}

#[test]
fn the_load_of_the_payload_is_taken_off_before_the_contact_is_sought() {
    let tip = Payload::new(0.5, Vector3::new(0.01, 0.02, 0.03)).unwrap();
    let moves = Motion {
        gravity: Vector3::new(1.0, -2.0, 9.0),
        angular_velocity: Vector3::new(3.0, 1.0, -2.0),
        angular_acceleration: Vector3::new(-20.0, 30.0, 10.0),
    };
    let measured = pressed() + tip.load(&moves);
    let step = Step::of(0.5).with_motion(moves).with_last(Some(Vector3::x()));
    assert_eq!((step.time, step.motion, step.last), (0.5, moves, Some(Vector3::x())));
    let (handed, followed) = (Handed::default(), Followed::default());
    let mut carrying = Fingertip::builder()
        .payload(tip)
        .solver(Direct)
        .contact(sphere(), Noted(&handed))
        .slip_detector(Witness(&followed))
        .build();
    for touch in [carrying.sense_wrench(measured, step), carrying.sense(&measured.components(), step)] {
        assert_eq!(touch.wrench, measured - tip.load(&moves));
        assert!((touch.wrench.components() - pressed().components()).norm() < 1e-14);
    }
    let mut of_ones_own = Fingertip::builder().payload(Share).contact(sphere(), Noted(&handed)).build();
    let touch = of_ones_own.sense_wrench(pressed(), Step::of(0.5).with_motion(0.25));
    assert_eq!(touch.wrench, pressed() * 0.25);
    let less = (measured - tip.load(&moves), Some(Vector3::x()));
    assert_eq!(*handed.borrow(), [less, less, (pressed() * 0.25, None)]);
    assert!(followed.borrow().iter().all(|(_, time)| *time == 0.5));
}

/// What a detector was handed: the force, if there was one, and the time step.
type Followed = RefCell<Vec<(Option<ContactForce<f64>>, f64)>>;

/// A friction model and a slip detector that note what they are handed.
struct Witness<'a>(&'a Followed);

impl FrictionModel<f64> for Witness<'_> {
    fn slip_margin(&self, force: &ContactForce<f64>) -> SlipMargin<f64> {
        SlipMargin { newtons: force.normal, utilisation: force.spin }
    }

    fn least_normal_force(&self, _: &ContactForce<f64>, _: f64) -> f64 {
        0.0
    }
}

impl SlipDetector<f64> for Witness<'_> {
    fn update(&mut self, force: &ContactForce<f64>, time_step: f64) -> SlipVerdict {
        self.0.borrow_mut().push((Some(*force), time_step));
        SlipVerdict::Warning
    }

    fn update_open(&mut self, time_step: f64) -> SlipVerdict {
        self.0.borrow_mut().push((None, time_step));
        SlipVerdict::NotPressing
    }

    fn reset(&mut self) {
        self.0.borrow_mut().clear();
    }
}

#[test]
fn friction_and_detector_are_handed_force_and_time() {
    let (handed, followed) = (Handed::default(), Followed::default());
    let mut fingertip = Fingertip::builder()
        .solver(Direct)
        .contact(sphere(), Noted(&handed))
        .friction(Witness(&followed))
        .slip_detector(Witness(&followed))
        .build();
    let held = fingertip.sense_wrench(pressed(), 0.5);
    assert_eq!(held.grip, Some(SlipMargin { newtons: 10.0, utilisation: 0.25 }));
    assert_eq!(held.slip, SlipVerdict::Warning);
    let sensed = fingertip.sense(&pressed().components(), 0.25);
    assert_eq!((sensed.grip, sensed.slip), (held.grip, held.slip));
    let open = fingertip.sense(&SVector::zeros(), 2.0);
    assert_eq!((open.force, open.grip, open.slip), (None, None, SlipVerdict::NotPressing));
    assert_eq!(*followed.borrow(), [(Some(split()), 0.5), (Some(split()), 0.25), (None, 2.0)]);
    // The stages are to be had.
    assert_eq!(fingertip.friction().0.slip_margin(&split()).newtons, 10.0);
    assert_eq!(*fingertip.surface(), sphere());
    fingertip.detector_mut().0.reset();
    assert!(followed.borrow().is_empty());
}

/// Stages of one's own in the place of a friction model and a detector.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Own;

impl GripStage<f64> for Own {
    type Reading = f64;

    fn judge(&self, force: &ContactForce<f64>) -> f64 {
        force.normal
    }
}

impl SlipStage<f64> for Own {
    type Verdict = (Option<f64>, f64);

    fn follow(&mut self, force: Option<&ContactForce<f64>>, time_step: f64) -> (Option<f64>, f64) {
        (force.map(|force| force.normal), time_step)
    }
}

#[test]
fn stages_of_ones_own_answer_in_their_own_words() {
    let handed = Handed::default();
    let mut fingertip =
        Fingertip::builder().friction_stage(Own).slip_stage(Own).contact(sphere(), Noted(&handed)).build();
    let held = fingertip.sense_wrench(pressed(), 0.5);
    assert_eq!((held.grip, held.slip), (Some(10.0), (Some(10.0), 0.5)));
    let open = fingertip.sense_wrench(Wrench::zero(), 0.25);
    assert_eq!((open.grip, open.slip), (None, (None, 0.25)));
    assert_eq!((*fingertip.friction(), *fingertip.detector_mut()), (Own, Own));
}

/// The order in which stages are chosen does not matter, and the later choice of a stage counts.
#[test]
fn stages_are_chosen_in_any_order() {
    let model = PointContact::new(0.1).unwrap();
    let friction = Coulomb::new(0.5).unwrap();
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01).unwrap());
    let detector = RatioThreshold::new(gate, 0.5).unwrap().with_warning_share(0.75).unwrap();
    let solver = GaussianElimination::new(&paper_sensor::<f64>()).unwrap();
    let zero = Tare::new(SVector::<f64, 6>::repeat(0.5));
    let one = Fingertip::builder()
        .zero(zero)
        .solver(solver)
        .contact(sphere(), model)
        .friction(friction)
        .slip_detector(detector)
        .build();
    let other = Fingertip::builder()
        .slip_detector(detector)
        .friction(friction)
        .contact(Torus::new(10e-3, 3e-3).unwrap(), PointContact::new(0.0).unwrap())
        .contact(sphere(), model)
        .solver(Direct)
        .solver(solver)
        .payload(Absent)
        .zero(Uncompensated)
        .zero(zero)
        .build();
    assert_eq!(one, other);
    assert_eq!((one.zero(), one.surface(), one.friction().0), (&zero, &sphere(), friction));
}

#[test]
fn another_zero_is_taken_from_the_next_sample_on() {
    let handed = Handed::default();
    let tare = |offset: f64| Tare::new(SVector::<f64, 6>::repeat(offset));
    let mut fingertip =
        Fingertip::builder().zero(tare(1.0)).solver(Direct).contact(sphere(), Noted(&handed)).build();
    let raw = SVector::from([1.0, 2.0, 4.0, 8.0, 16.0, 32.0]);
    assert_eq!(fingertip.sense(&raw, 1e-3).wrench.components(), raw.add_scalar(-1.0));
    fingertip.set_zero(tare(-2.0));
    assert_eq!(*fingertip.zero(), tare(-2.0));
    assert_eq!(fingertip.sense(&raw, 1e-3).wrench.components(), raw.add_scalar(2.0));
}

/// Every detector of the crate forgets a contact that is lost: what it saw before is no drop afterwards.
#[test]
fn a_lost_contact_starts_a_detector_anew() {
    let noise = ForceNoise::isotropic(0.01).unwrap();
    let mut fingertip = Fingertip::builder()
        .contact(sphere(), PointContact::new(0.1).unwrap())
        .slip_detector(DropDetector::new(noise).unwrap())
        .build();
    let at = |ratio: f64| {
        let point = Vector3::new(0.0, 0.0, RADIUS);
        Wrench::from_force_at(&point, Vector3::new(5.0 * ratio, 0.0, -5.0))
    };
    let mut slips = |lift: bool| {
        (0..200).for_each(|_| _ = fingertip.sense_wrench(at(0.6), 1e-3));
        if lift {
            (0..50).for_each(|_| _ = fingertip.sense_wrench(Wrench::zero(), 1e-3));
        }
        (0..200).any(|_| fingertip.sense_wrench(at(0.3), 1e-3).slip == SlipVerdict::Slipping)
    };
    // The ratio halves while pressed: slip. Lifted in between: another grasp.
    assert_eq!([slips(false), slips(true)], [true, false]);
}

/// The stage does what one would do by hand with the same tracker: to the last bit, for both models, with lost contacts
/// between; and a detector and friction beside it change nothing.
#[cfg(feature = "track")]
#[test]
fn a_tracker_as_a_stage_is_the_tracker_by_hand() {
    use fingertip::TouchSensor;
    use fingertip::contact::{Sighting, SoftFinger, Tracker, WrenchNoise};
    use nalgebra::Vector6;

    let noise = WrenchNoise::new(Vector6::new(0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4), 0.01).unwrap();
    let tracker = || Tracker::new(0.01, 0.1).unwrap();
    let ball = Sphere::centred(RADIUS).unwrap();
    let push = |sample: u32| {
        let angle = 1e-3 * f64::from(sample);
        let normal = Vector3::new(angle.sin(), 0.0, angle.cos());
        // Every seventh sample is no contact.
        let strength = if sample % 7 == 6 { 0.01 } else { 0.5 };
        Wrench::from_force_at(&(normal * RADIUS), -normal * strength)
    };
    let (point, soft) = (PointContact::new(0.1).unwrap(), SoftFinger::new(0.1).unwrap());
    let mut by_point = Fingertip::builder()
        .contact(ball, point)
        .friction(Coulomb::new(0.5).unwrap())
        .slip_detector(DropDetector::new(ForceNoise::isotropic(0.02).unwrap()).unwrap())
        .tracker(tracker(), noise)
        .build();
    let mut by_soft = Fingertip::builder().contact(ball, soft).tracker(tracker(), noise).build();
    let (mut point_hand, mut soft_hand) = (tracker(), tracker());
    let mut followed = 0;
    for sample in 0..60 {
        let wrench = push(sample);
        let covariance = noise.covariance(&wrench);
        let found = point.resolve(&wrench, &ball);
        let sighting =
            found.contact().and_then(|found| Sighting::of_point_contact(found, &wrench, &covariance));
        let expected = point_hand.follow(&ball, sighting.as_ref(), 1e-3);
        let touch = by_point.sense_wrench(wrench, 1e-3);
        assert_eq!(touch.tracked, expected);
        assert_eq!(touch.resolution, found);
        let found = soft.resolve(&wrench, &ball);
        let sighting = found.contact().and_then(|found| Sighting::of_soft_finger(found, &ball, &covariance));
        let expected = soft_hand.follow(&ball, sighting.as_ref(), 1e-3);
        assert_eq!(by_soft.sense_wrench(wrench, 1e-3).tracked, expected);
        followed += u32::from(expected.is_some_and(|tracked| !tracked.is_new()));
    }
    assert!(followed > 50, "{followed}");
    assert_eq!((by_point.track().tracker, by_soft.track().tracker), (point_hand, soft_hand));
    // As a touch sensor it follows, too, and forgets on demand.
    let _ = by_point.feel(push(61), Step::of(1e-3));
    assert_ne!(by_point.track().tracker, point_hand);
    by_point.start_anew();
    assert!(by_point.sense_wrench(push(63), 1e-3).tracked.unwrap().is_new());
    by_soft.start_anew();
    assert!(by_soft.sense_wrench(push(63), 1e-3).tracked.unwrap().is_new());
}
