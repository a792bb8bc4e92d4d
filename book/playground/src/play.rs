//! What is played with, and what comes out.

use fingertip::contact::{
    Auto, Choice, Contact, ContactCovariance, ContactJacobian, ContactModel, NoContact, PointContact,
    Resolution, SoftFinger, SoftFingerSurface, WrenchNoise,
};
use fingertip::friction::{Coulomb, FrictionModel};
use fingertip::surfaces::SmoothSurface;
use fingertip::wrench::Wrench;
use nalgebra::{Vector3, Vector6};

use crate::shape::{self, Shape, with};

/// Smaller forces are no contact \[N\].
const LEAST_FORCE: f64 = 0.02;
/// The probability that the ellipse holds the contact.
const PROBABILITY: f64 = 0.95;
/// The number of a reason that the page has no words for.
const OTHER: u32 = 5;
/// Instructions per contact, counted on x86-64 in f32.
const COUNTS: &str = include_str!("../../../benches/instructions.txt");

/// What can be set, in the order of their numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Knobs {
    /// 0: point contact, 1: soft finger, 2: the one that the wrench speaks for.
    pub(crate) model: f64,
    /// True normal force \[N\].
    pub(crate) normal: f64,
    /// True tangential force over normal force.
    pub(crate) ratio: f64,
    /// Its direction in the tangent plane \[rad\].
    pub(crate) direction: f64,
    /// True spin torque \[N·m\].
    pub(crate) spin: f64,
    /// Standard deviation of a component of the force \[N\].
    pub(crate) force_noise: f64,
    /// Of the torque \[N·m\].
    pub(crate) torque_noise: f64,
    /// Friction coefficient.
    pub(crate) coefficient: f64,
    /// −1 where the sensor is taken to report the reaction, otherwise 1.
    pub(crate) sign: f64,
}

impl Default for Knobs {
    fn default() -> Self {
        Self {
            model: 0.0,
            normal: 2.0,
            ratio: 0.25,
            direction: 0.0,
            spin: 0.0,
            force_noise: 0.01,
            torque_noise: 5e-5,
            coefficient: 0.5,
            sign: 1.0,
        }
    }
}

impl Knobs {
    /// Whether there is a knob of this number; a number that is not finite is not taken.
    pub(crate) fn set(&mut self, knob: u32, value: f64) -> bool {
        let knobs: [&mut f64; 9] = [
            &mut self.model,
            &mut self.normal,
            &mut self.ratio,
            &mut self.direction,
            &mut self.spin,
            &mut self.force_noise,
            &mut self.torque_noise,
            &mut self.coefficient,
            &mut self.sign,
        ];
        match knobs.into_iter().nth(knob as usize) {
            Some(place) if value.is_finite() => {
                *place = value;
                true
            }
            _ => false,
        }
    }
}

/// What a page reads, by the place of the first number of each.
#[derive(Clone, Copy, Debug)]
#[repr(usize)]
pub(crate) enum Felt {
    /// Where the fingertip is truly touched \[m\].
    True = 0,
    /// The true force on the fingertip \[N\].
    Force = 3,
    /// The torque that the sensor feels \[N·m\].
    Torque = 6,
    /// The contact that was found \[m\].
    Point = 9,
    /// The outward normal there.
    Normal = 12,
    /// Normal force, tangential force \[N\], spin torque \[N·m\], slip margin \[N\].
    Parts = 15,
    /// Semi-axes of the ellipse \[m\].
    SemiAxes = 19,
    /// The direction of the longer one.
    Longer = 21,
    /// The direction of the shorter one.
    Shorter = 24,
    /// The point of the line of action next to the sensor \[m\].
    Foot = 27,
    /// Instructions of the contact, where they were counted.
    Instructions = 30,
    /// 1 where a soft finger was chosen, 0 for a point contact.
    Chosen = 31,
    /// How many numbers there are.
    Count = 32,
}

/// A fingertip that is touched.
pub(crate) struct Play {
    number: u32,
    shape: Option<Shape>,
    pub(crate) net: Vec<f64>,
    pub(crate) knobs: Knobs,
    /// Where it is truly touched, and the outward normal there.
    at: Vector3<f64>,
    normal: Vector3<f64>,
    pub(crate) felt: [f64; Felt::Count as usize],
}

impl Default for Play {
    fn default() -> Self {
        let mut play = Self {
            number: 0,
            shape: None,
            net: Vec::new(),
            knobs: Knobs::default(),
            at: Vector3::zeros(),
            normal: Vector3::z(),
            felt: [f64::NAN; Felt::Count as usize],
        };
        play.set_shape(0);
        play
    }
}

impl Play {
    /// Another shape, touched from above right.
    pub(crate) fn set_shape(&mut self, number: u32) -> bool {
        let Some(Ok(shape)) = shape::shape(number) else { return false };
        self.net = shape::net(&shape);
        self.shape = Some(shape);
        self.number = number;
        self.aim(&Vector3::new(0.05, 0.03, 0.05), &Vector3::new(-0.045, -0.027, -0.044))
    }

    /// Puts the touch where a line of sight meets the shape.
    pub(crate) fn aim(&mut self, from: &Vector3<f64>, along: &Vector3<f64>) -> bool {
        let met = self.shape.as_ref().and_then(|shape| shape::first(shape, from, along));
        if let Some(crossing) = met {
            (self.at, self.normal) = (crossing.point, crossing.normal);
        }
        met.is_some()
    }

    /// The true load: what an object does at the place that is touched.
    fn load(&self) -> Wrench<f64> {
        let Knobs { normal, ratio, direction, spin, .. } = self.knobs;
        let aside = if self.normal.z.abs() < 0.9 { Vector3::z() } else { Vector3::x() };
        let first = aside.cross(&self.normal).normalize();
        let second = self.normal.cross(&first);
        let tangential = (first * direction.cos() + second * direction.sin()) * (normal * ratio);
        let force = tangential - self.normal * normal;
        Wrench::on_fingertip(force, self.at.cross(&force) + self.normal * spin)
    }

    /// Feels the load through the chosen model; 0, or the place of the reason.
    pub(crate) fn touch(&mut self) -> u32 {
        self.felt = [f64::NAN; Felt::Count as usize];
        let truth = self.load();
        let (at, force, torque) = (self.at, truth.force(), truth.torque());
        self.put(Felt::True, at.as_slice());
        self.put(Felt::Force, force.as_slice());
        self.put(Felt::Torque, torque.as_slice());
        let wrench = if self.knobs.sign < 0.0 { Wrench::from_reaction(force, torque) } else { truth };
        let squared = force.norm_squared();
        if squared > 0.0 {
            self.put(Felt::Foot, (force.cross(&torque) / squared).as_slice());
        }
        // Taken out, so that it can be read while what is felt is written.
        let Some(shape) = self.shape.take() else { return OTHER };
        let told = with!(&shape, surface => self.feel(&wrench, surface));
        self.shape = Some(shape);
        told.map_or_else(|reason| reason, |()| 0)
    }

    fn put(&mut self, place: Felt, numbers: &[f64]) {
        for (place, number) in self.felt.iter_mut().skip(place as usize).zip(numbers) {
            *place = *number;
        }
    }

    fn feel<S>(&mut self, wrench: &Wrench<f64>, surface: &S) -> Result<(), u32>
    where
        S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    {
        let Knobs { force_noise, torque_noise, coefficient, .. } = self.knobs;
        let floor = Vector6::from_fn(|axis, _| if axis < 3 { force_noise } else { torque_noise });
        let noise = WrenchNoise::new(floor, 0.0).map_err(|_| OTHER)?.covariance(wrench);
        let point = PointContact::new(LEAST_FORCE).map_err(|_| OTHER)?;
        let soft = SoftFinger::new(LEAST_FORCE).map_err(|_| OTHER)?;
        let (resolution, is_soft) = match self.knobs.model as u32 {
            0 => (point.resolve(wrench, surface), false),
            1 => (soft.resolve(wrench, surface), true),
            _ => {
                let auto = Auto::new(point, soft, noise).map_err(|_| OTHER)?;
                let chosen = auto.test(wrench).is_some_and(|test| matches!(test.choice, Choice::SoftFinger));
                (auto.resolve(wrench, surface), chosen)
            }
        };
        let contact = match resolution {
            Resolution::Contact(contact) => contact,
            Resolution::NoContact(reason) => return Err(number_of(&reason)),
        };
        self.put(Felt::Point, contact.point.as_slice());
        self.put(Felt::Normal, contact.normal.as_slice());
        let force = contact.contact_force();
        let margin = Coulomb::new(coefficient).map_or(f64::NAN, |limit| limit.slip_margin(&force).newtons);
        self.put(
            Felt::Parts,
            &[contact.normal_force(), force.tangential_magnitude(), contact.spin_torque, margin],
        );
        self.put(Felt::Chosen, &[f64::from(u8::from(is_soft))]);
        if let Some(count) = instructions(self.number, is_soft) {
            self.put(Felt::Instructions, &[count]);
        }
        self.spread(&contact, wrench, surface, &noise, is_soft);
        Ok(())
    }

    /// The ellipse in the tangent plane that holds the contact.
    fn spread<S: SmoothSurface<f64>>(
        &mut self,
        contact: &Contact<f64>,
        wrench: &Wrench<f64>,
        surface: &S,
        noise: &nalgebra::Matrix6<f64>,
        is_soft: bool,
    ) {
        let jacobian = if is_soft {
            ContactJacobian::of_soft_finger_on(contact, surface)
        } else {
            ContactJacobian::of_point_contact(contact, wrench, &surface.shape_operator(&contact.point))
        };
        let ellipse =
            jacobian.and_then(|jacobian| ContactCovariance::new(&jacobian, noise).ellipse(PROBABILITY));
        if let Some(ellipse) = ellipse {
            self.put(Felt::SemiAxes, &ellipse.semi_axes);
            self.put(Felt::Longer, ellipse.directions[0].as_slice());
            self.put(Felt::Shorter, ellipse.directions[1].as_slice());
        }
    }
}

/// The number of a reason, as the page knows it: misses, only pulling, below the threshold, beyond friction, another.
fn number_of(reason: &NoContact<f64>) -> u32 {
    match reason {
        NoContact::Misses { .. } => 1,
        NoContact::OnlyPulling { .. } => 2,
        NoContact::BelowThreshold { .. } => 3,
        NoContact::BeyondFriction { .. } => 4,
        _ => OTHER,
    }
}

/// Instructions of a contact on a shape, as the table has them.
fn instructions(number: u32, is_soft: bool) -> Option<f64> {
    let (model, name) = (if is_soft { "soft_on_" } else { "point_on_" }, shape::counted(number)?);
    COUNTS.lines().find_map(|line| line.strip_prefix(model)?.strip_prefix(name)?.strip_prefix(' ')?.parse().ok())
}
