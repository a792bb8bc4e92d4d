//! Wrench and tactile array together, where the scene asks for it.

use fingertip::contact::{FusedContact, Grip};
use fingertip_scene::{ArrayReading, FusedTouch, NoFusion};
use nalgebra::Vector3;

use crate::border::{on, place, read_many};
use crate::fault::{Fault, ft_status};
use crate::tip::ft_tip;

/// Most places of a tactile array that are told apart.
pub const FT_MAX_PLACES: usize = 4;

/// What one place of a tactile array reads.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ft_array_reading {
    /// Centroid of the pressure in the sensor frame, in m.
    pub centroid: [f64; 3],
    /// Sum of the pressure, in N.
    pub normal_force: f64,
}

/// One contact of those that wrench and array tell together.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ft_fused_contact {
    /// Where, on the surface, in m.
    pub point: [f64; 3],
    /// Outward unit normal there.
    pub normal: [f64; 3],
    /// Force on the fingertip, in N.
    pub force: [f64; 3],
    /// Covariance of the point in m2, row by row.
    pub point_covariance: [[f64; 3]; 3],
    /// Covariance of the force in N2, row by row.
    pub force_covariance: [[f64; 3]; 3],
    /// How much of the variance of the force the wrench removed: 1, nearly all is known from it; 0, nothing.
    pub share_from_wrench: f64,
    /// 0 while friction holds more than is asked, 1 where it slides, 2 where it carries nothing.
    pub grip: u32,
    /// Zero.
    pub reserved: u32,
}

/// What wrench and array say together.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ft_fused {
    /// How many contacts there are: one for each reading.
    pub count: u32,
    /// Dimension of the forces that the wrench cannot see, since they cancel.
    pub internal_forces: u32,
    /// 1 if the estimate came to rest.
    pub settled: u32,
    /// Zero.
    pub reserved: u32,
    /// How far the wrench is from what the array alone predicts: follows chi-squared with six degrees of freedom if all is
    /// right. Much more, and a contact is missing.
    pub disagreement: f64,
    /// The contacts in the order of the readings, zero behind the last.
    pub contacts: [ft_fused_contact; FT_MAX_PLACES],
}

impl ft_fused_contact {
    fn of(contact: &FusedContact<f64>) -> Self {
        Self {
            point: contact.point.into(),
            normal: contact.normal.into(),
            force: contact.force.into(),
            // Row by row, of columns.
            point_covariance: contact.point_covariance.transpose().into(),
            force_covariance: contact.force_covariance.transpose().into(),
            share_from_wrench: contact.share_from_wrench,
            grip: match contact.grip {
                Grip::Sticks => 0,
                Grip::Slides => 1,
                Grip::Lifted => 2,
            },
            reserved: 0,
        }
    }
}

impl ft_fused {
    fn of(touch: &FusedTouch<f64>) -> Self {
        let mut told = Self {
            internal_forces: u32::from(touch.internal_forces),
            settled: u32::from(touch.settled),
            disagreement: touch.disagreement,
            ..Self::default()
        };
        for (place, contact) in told.contacts.iter_mut().zip(touch.contacts.iter().flatten()) {
            *place = ft_fused_contact::of(contact);
            told.count += 1;
        }
        told
    }
}

/// The contacts that the wrench of the last sample and the readings of a tactile array tell together, of a scene with
/// [fusion]: one for each reading, one to FT_MAX_PLACES. Nothing of it is carried to the next sample. Allocates nothing.
///
/// FT_BAD_SCENE for a scene without [fusion], FT_NO_REST while it waits for the noise of a rest, FT_WRONG_SIZE for none or
/// too many readings, FT_BAD_NUMBER for one that is not finite or not near the surface.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_fuse(
    tip: *mut ft_tip,
    readings: *const ft_array_reading,
    count: usize,
    fused: *mut ft_fused,
) -> ft_status {
    on(tip, |tip| {
        let place = place(fused, "fused")?;
        if count > FT_MAX_PLACES {
            return Err(NoFusion::Readings(count).into());
        }
        let given = ft_array_reading::default();
        let given = read_many::<_, FT_MAX_PLACES>(readings, count, "readings", given)?;
        let readings = given.map(|reading| ArrayReading {
            centroid: Vector3::from(reading.centroid),
            normal_force: reading.normal_force,
        });
        let fused = tip.pipeline.fuse(readings.get(..count).unwrap_or_default()).map_err(Fault::from)?;
        place.put(ft_fused::of(&fused));
        Ok(())
    })
}
