//! What a sample says.

use core::ffi::c_char;

use fingertip::contact::{NoContact, Resolution};
use fingertip::friction::SlipVerdict;
use fingertip_scene::Felt;

use crate::border::{Place, fresh, fresh_vector, put};
use crate::load::ft_wrench;

/// Whether a sample is a contact, and if not, why not.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ft_resolution {
    /// It is a contact.
    FT_CONTACT = 0,
    /// A number of the wrench is NaN or infinite.
    FT_NOT_FINITE = 1,
    /// The force is smaller than the least one of the scene; or the scene waits for a rest to know it.
    FT_BELOW_THRESHOLD = 2,
    /// The line of the force passes the surface by.
    FT_MISSES = 3,
    /// The force would pull the fingertip where its line meets it.
    FT_ONLY_PULLING = 4,
    /// The force presses at so flat an angle that friction could not hold it.
    FT_BEYOND_FRICTION = 5,
    /// The force presses on a part of the shape that is not the active surface.
    FT_OUTSIDE_ACTIVE_REGION = 6,
    /// There is a torque but no force.
    FT_PURE_COUPLE = 7,
    /// Two grazing contacts explain the wrench.
    FT_AMBIGUOUS = 8,
    /// The search ended at its bound without an answer.
    FT_UNRESOLVED = 9,
    /// No single contact gives such a wrench.
    FT_NOT_ONE_CONTACT = 10,
    /// A reason that this version of the interface has no name for.
    FT_OTHER_REASON = 11,
}

/// What the slip detector says.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ft_slip {
    /// The normal force is too small to tell, or the scene has no detector.
    FT_NOT_PRESSING = 0,
    /// The contact holds, as far as the detector sees.
    FT_HOLDING = 1,
    /// Slip is near.
    FT_WARNING = 2,
    /// The contact slips.
    FT_SLIPPING = 3,
}

impl ft_slip {
    #[inline(always)]
    pub(crate) const fn of(verdict: SlipVerdict) -> Self {
        match verdict {
            SlipVerdict::NotPressing => Self::FT_NOT_PRESSING,
            SlipVerdict::Holding => Self::FT_HOLDING,
            SlipVerdict::Warning => Self::FT_WARNING,
            SlipVerdict::Slipping => Self::FT_SLIPPING,
        }
    }
}

/// What a sample says: the contact on the fingertip, in the sensor frame. Without a contact all but the wrench,
/// the resolution and the verdict is zero.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_touch {
    /// Contact, or why none.
    pub resolution: ft_resolution,
    /// What the slip detector says.
    pub slip: ft_slip,
    /// 1 if the scene has friction and there is a contact, so that margin and utilisation are known; 0 else.
    pub has_margin: u32,
    /// How many other points of the surface would explain the wrench as well.
    pub alternatives: u32,
    /// 1 if contacts were searched for, and the surface says too little of itself to know that none was missed; 0 else.
    pub searched: u32,
    /// Zero.
    pub reserved: u32,
    /// The load that the environment applies to the fingertip, without zero and payload.
    pub wrench: ft_wrench,
    /// Where the environment touches, in m.
    pub point: [f64; 3],
    /// Outward unit normal of the fingertip there.
    pub normal: [f64; 3],
    /// Normal force in N, positive when pressing.
    pub normal_force: f64,
    /// Tangential force on the fingertip, in N.
    pub tangential_force: [f64; 3],
    /// Spin torque on the fingertip about the outward normal, in N·m; zero for a point contact.
    pub spin_torque: f64,
    /// Distance between the line of the force and the point, in m: zero unless the scene accepts a gap.
    pub gap: f64,
    /// Distance to the friction limit in N, positive while the contact holds.
    pub margin: f64,
    /// How much of the friction limit is used: 0 without tangential load, 1 at slip.
    pub utilisation: f64,
}

impl ft_touch {
    /// Writes what a sample says, field by field: a whole one that is put together first and copied then takes longer than
    /// a sample of a small scene.
    #[inline(always)]
    pub(crate) fn put(felt: &Felt<f64>, place: Place<Self>) {
        let touch = &felt.touch;
        put!(place.slip = touch.slip.map_or(ft_slip::FT_NOT_PRESSING, ft_slip::of));
        put!(place.wrench = ft_wrench::of(&touch.wrench));
        let (contact, force) = match (&touch.resolution, &touch.force) {
            (Resolution::Contact(contact), Some(force)) => (contact, force),
            (Resolution::NoContact(why), _) => return Self::put_none(reason(why), &place),
            // A contact always has its force.
            (Resolution::Contact(_), None) => return Self::put_none(ft_resolution::FT_OTHER_REASON, &place),
        };
        put!(place.resolution = ft_resolution::FT_CONTACT);
        put!(place.alternatives = u32::from(contact.alternatives));
        put!(place.searched = u32::from(contact.searched));
        put!(place.reserved = 0);
        put!(place.point = fresh_vector(&contact.point));
        put!(place.normal = fresh_vector(&contact.normal));
        put!(place.gap = fresh(&contact.gap));
        put!(place.normal_force = fresh(&force.normal));
        put!(place.tangential_force = force.tangential.vector().into());
        put!(place.spin_torque = fresh(&force.spin));
        let (known, margin, utilisation) = match &touch.grip {
            Some(Some(margin)) => (1, fresh(&margin.newtons), fresh(&margin.utilisation)),
            _ => (0, 0.0, 0.0),
        };
        put!(place.has_margin = known);
        put!(place.margin = margin);
        put!(place.utilisation = utilisation);
    }

    /// All but the wrench and the verdict of a sample that is no contact.
    #[inline(never)]
    fn put_none(resolution: ft_resolution, place: &Place<Self>) {
        put!(place.resolution = resolution);
        put!(place.has_margin = 0);
        put!(place.alternatives = 0);
        put!(place.searched = 0);
        put!(place.reserved = 0);
        put!(place.point = [0.0; 3]);
        put!(place.normal = [0.0; 3]);
        put!(place.normal_force = 0.0);
        put!(place.tangential_force = [0.0; 3]);
        put!(place.spin_torque = 0.0);
        put!(place.gap = 0.0);
        put!(place.margin = 0.0);
        put!(place.utilisation = 0.0);
    }
}

fn reason(why: &NoContact<f64>) -> ft_resolution {
    match why {
        NoContact::NotFinite => ft_resolution::FT_NOT_FINITE,
        NoContact::BelowThreshold { .. } => ft_resolution::FT_BELOW_THRESHOLD,
        NoContact::Misses { .. } => ft_resolution::FT_MISSES,
        NoContact::OnlyPulling { .. } => ft_resolution::FT_ONLY_PULLING,
        NoContact::BeyondFriction { .. } => ft_resolution::FT_BEYOND_FRICTION,
        NoContact::OutsideActiveRegion { .. } => ft_resolution::FT_OUTSIDE_ACTIVE_REGION,
        NoContact::PureCouple { .. } => ft_resolution::FT_PURE_COUPLE,
        NoContact::Ambiguous { .. } => ft_resolution::FT_AMBIGUOUS,
        NoContact::Unresolved => ft_resolution::FT_UNRESOLVED,
        NoContact::NotOneContact { .. } => ft_resolution::FT_NOT_ONE_CONTACT,
        _ => ft_resolution::FT_OTHER_REASON,
    }
}

/// What a resolution means, in a sentence. Any number may be given, such as one that was stored.
#[unsafe(no_mangle)]
pub extern "C" fn ft_resolution_text(resolution: u32) -> *const c_char {
    let text = match resolution {
        0 => c"a contact",
        1 => c"the wrench is not finite",
        2 => c"the force is below the threshold",
        3 => c"the line of action misses the surface",
        4 => c"the force pulls where its line meets the active surface",
        5 => c"the force meets the surface at a flatter angle than friction can hold",
        6 => c"the force presses outside the active region",
        7 => c"a couple without a force is no contact",
        8 => c"two grazing contacts explain the wrench",
        9 => c"no contact was found within the bound of the search",
        10 => c"no single contact gives such a wrench",
        11 => c"no contact, for another reason",
        _ => c"no resolution of this library",
    };
    text.as_ptr()
}

#[cfg(test)]
mod tests {
    use fingertip::contact::NoContact;
    use nalgebra::Vector3;

    use super::reason;

    /// The numbers of the header are those that libraries of one scene give, too.
    #[test]
    fn reasons_have_their_numbers() {
        let point = Vector3::zeros();
        for why in [
            NoContact::NotFinite,
            NoContact::BelowThreshold { force: 0.0 },
            NoContact::Misses { closest: None },
            NoContact::OnlyPulling { point },
            NoContact::BeyondFriction { point, friction_ratio: 1.0 },
            NoContact::OutsideActiveRegion { point },
            NoContact::PureCouple { torque: 1.0 },
            NoContact::Ambiguous { first: point, second: point },
            NoContact::Unresolved,
            NoContact::NotOneContact { pitch: 1.0, excess: 4.0 },
        ] {
            assert_eq!(reason(&why) as u32, why.number(), "{why}");
        }
    }
}
