//! What a contact model answers.

use core::fmt;

use fingertip_surfaces::ClosestApproach;
use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;
use thiserror::Error;

/// One contact of the fingertip, in the sensor frame.
///
/// ```
/// use fingertip_contact::{Contact, ContactModel, PointContact};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 1 N down and 0.3 N aside, at the top of a sphere of 10 mm.
/// let top = Vector3::new(0.0, 0.0, 0.01);
/// let wrench = Wrench::from_force_at(&top, Vector3::new(0.3, 0.0, -1.0));
/// let contact: Contact<f64> = PointContact::new(0.05)?.resolve(&wrench, &Sphere::centred(0.01)?).into_result()?;
/// assert!((contact.point - top).norm() < 1e-12 && (contact.normal_force() - 1.0).abs() < 1e-12);
/// assert!((contact.tangential_force() - Vector3::x() * 0.3).norm() < 1e-12);
/// assert!((contact.incidence() - 1.0 / 1.09_f64.sqrt()).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Contact<T: Real> {
    /// Where the environment touches \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal of the fingertip there.
    pub normal: Vector3<T>,
    /// Force on the fingertip \[N\].
    pub force: Vector3<T>,
    /// Spin torque on the fingertip about the outward normal \[N·m\]; zero for a point contact.
    pub spin_torque: T,
    /// Distance between the line of action and the contact point \[m\]: zero unless the line
    /// missed the surface by less than the gap that the model was told to accept.
    pub gap: T,
    /// How many *other* points of the surface would explain the wrench as well (only shapes that
    /// are not convex have them).
    pub alternatives: u8,
    /// `true` where contacts were searched for, and the surface says too little of itself to know that none was
    /// missed, which might press more squarely: a soft finger on a surface of
    /// [unknown](fingertip_surfaces::Topology::Unknown) topology.
    #[cfg_attr(feature = "serde", serde(default))]
    pub searched: bool,
}

impl<T: Real> Contact<T> {
    /// Normal force, tangential force and spin torque.
    #[inline]
    #[must_use]
    pub fn contact_force(&self) -> ContactForce<T> {
        ContactForce::split(&self.force, &self.normal, self.spin_torque)
    }

    /// Normal force \[N\], positive when pressing.
    #[inline]
    #[must_use]
    pub fn normal_force(&self) -> T {
        -self.force.dot(&self.normal)
    }

    /// Cosine of the angle between the force and the inward normal, in [0, 1]: 1 for a push
    /// straight in. Errors of the contact point grow as its reciprocal
    /// (`docs/theory/contact.md#errors-of-a-point-contact`).
    #[inline]
    #[must_use]
    pub fn incidence(&self) -> T {
        let scale = self.force.amax().normalising_factor();
        let force = self.force * scale;
        (-force.dot(&self.normal) / force.norm_squared().root()).max(T::zero()).min(T::one())
    }

    /// Tangential force on the fingertip \[N\].
    #[inline]
    #[must_use]
    pub fn tangential_force(&self) -> Vector3<T> {
        self.contact_force().tangential.vector()
    }
}

/// Why a wrench gives no contact.
///
/// ```
/// use fingertip_contact::{ContactModel, NoContact, PointContact};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let (model, sphere) = (PointContact::new(0.05)?, Sphere::centred(0.01_f64)?);
/// // 1 N along a line that passes the centre of a sphere of 10 mm at 12 mm.
/// let aside = Wrench::on_fingertip(-Vector3::z(), Vector3::new(0.0, 0.012, 0.0));
/// match model.resolve(&aside, &sphere).into_result() {
///     Err(NoContact::Misses { closest: Some(closest) }) => assert!((closest.gap - 2e-3).abs() < 1e-9),
///     other => panic!("{other:?}"),
/// }
/// // 20 mN are noise.
/// let light = Wrench::on_fingertip(Vector3::z() * -0.02, Vector3::zeros());
/// let reason = model.resolve(&light, &sphere).into_result();
/// assert!(matches!(reason, Err(NoContact::BelowThreshold { force }) if (force - 0.02).abs() < 1e-12));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        rename_all = "snake_case",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
#[non_exhaustive]
pub enum NoContact<T: Real> {
    /// A component of the wrench is NaN or infinite, or its line of action lies too far away to be
    /// represented.
    #[error("the wrench is not finite")]
    NotFinite,
    /// The force is smaller than the least one that the model accepts.
    #[error("the force of {force} N is below the threshold")]
    BelowThreshold {
        /// Magnitude of the force \[N\].
        force: T,
    },
    /// The line of action passes the surface by.
    #[error("the line of action misses the surface{}", by_how_much(closest))]
    Misses {
        /// The place of the surface closest to the line, and by how much the line misses it; `None` if the
        /// surface does not know
        /// ([`ActiveSurface::closest_approach`](fingertip_surfaces::ActiveSurface::closest_approach)).
        closest: Option<ClosestApproach<T>>,
    },
    /// The line meets the active surface only where the force would pull it outward.
    #[error("the force pulls where its line meets the active surface")]
    OnlyPulling {
        /// Where the line meets the active surface \[m\].
        point: Vector3<T>,
    },
    /// The force presses, but at so flat an angle that friction could not hold it.
    #[error("the force meets the surface at a friction ratio of {friction_ratio}, more than it can hold")]
    BeyondFriction {
        /// Where it presses most squarely \[m\].
        point: Vector3<T>,
        /// The friction ratio `|f_t|/f_n` there.
        friction_ratio: T,
    },
    /// The force presses on a part of the shape that is not part of the active surface.
    #[error("the force presses outside the active region")]
    OutsideActiveRegion {
        /// Where it presses \[m\].
        point: Vector3<T>,
    },
    /// There is a torque but no force: a contact that presses always has one.
    #[error("a couple of {torque} N·m without a force is no contact")]
    PureCouple {
        /// Magnitude of the torque \[N·m\].
        torque: T,
    },
    /// A pure force whose line misses the surface could, with a spin torque, only graze it: at
    /// either of two points, with opposite spin torques.
    #[error("two grazing contacts explain the wrench, with opposite spin torques")]
    Ambiguous {
        /// One of the points \[m\].
        first: Vector3<T>,
        /// The other \[m\].
        second: Vector3<T>,
    },
    /// The search for a contact ended at its bound without an answer that it could vouch for.
    #[error("no contact was found within the bound of the search")]
    Unresolved,
    /// No single contact of the stated friction gives such a wrench: there are several contacts,
    /// or something else bears load.
    #[error("no single contact gives the pitch {pitch} m, which is {excess} standard deviations too large")]
    NotOneContact {
        /// Pitch of the wrench `f·m/|f|²` \[m\].
        pitch: T,
        /// By how many standard deviations its magnitude exceeds what one contact can give.
        excess: T,
    },
}

impl<T: Real> NoContact<T> {
    /// The number that stands for the reason where there are no enumerations of Rust, as in C: from 1, since 0 is a
    /// contact. A number keeps its meaning.
    ///
    /// ```
    /// use fingertip_contact::NoContact;
    ///
    /// assert_eq!(NoContact::<f32>::NotFinite.number(), 1);
    /// ```
    #[inline]
    #[must_use]
    pub const fn number(&self) -> u32 {
        match self {
            Self::NotFinite => 1,
            Self::BelowThreshold { .. } => 2,
            Self::Misses { .. } => 3,
            Self::OnlyPulling { .. } => 4,
            Self::BeyondFriction { .. } => 5,
            Self::OutsideActiveRegion { .. } => 6,
            Self::PureCouple { .. } => 7,
            Self::Ambiguous { .. } => 8,
            Self::Unresolved => 9,
            Self::NotOneContact { .. } => 10,
        }
    }
}

/// Says how far a line passes, if that is known.
fn by_how_much<T: Real>(closest: &Option<ClosestApproach<T>>) -> impl fmt::Display {
    let gap = closest.map(|closest| closest.gap);
    fmt::from_fn(move |f| match gap {
        Some(gap) => write!(f, " by {gap} m"),
        None => f.write_str("; by how much the surface does not tell"),
    })
}

/// Contact, or the reason why there is none.
///
/// ```
/// use fingertip_contact::{ContactModel, PointContact, Resolution};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
/// let text = match PointContact::new(0.05)?.resolve(&wrench, &Sphere::centred(0.01)?) {
///     Resolution::Contact(contact) => format!("{:.1} mm above the centre", contact.point.z * 1e3),
///     Resolution::NoContact(reason) => reason.to_string(),
/// };
/// assert_eq!(text, "10.0 mm above the centre");
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        rename_all = "snake_case",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub enum Resolution<T: Real> {
    /// The wrench is explained by this contact.
    Contact(Contact<T>),
    /// It is not, because.
    NoContact(NoContact<T>),
}

impl<T: Real> Resolution<T> {
    /// The contact, if there is one.
    #[inline]
    #[must_use]
    pub const fn contact(&self) -> Option<&Contact<T>> {
        match self {
            Self::Contact(contact) => Some(contact),
            Self::NoContact(_) => None,
        }
    }

    /// The contact, or the reason as an error.
    ///
    /// # Errors
    /// [`NoContact`].
    #[inline]
    pub fn into_result(self) -> Result<Contact<T>, NoContact<T>> {
        match self {
            Self::Contact(contact) => Ok(contact),
            Self::NoContact(reason) => Err(reason),
        }
    }
}
