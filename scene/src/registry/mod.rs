//! What a scene can choose: every shape, contact model, skin, friction limit and slip detector by the name that
//! it has in a file, with an example that works.
//!
//! Files, documentation and `--help` read this list. A new choice is known to all of them by one [`Entry`], and a test
//! fails if a choice has none. [`keys`] has every key with its meaning; a test compares them with those that the parser
//! knows.

// Before the files that use it.
macro_rules! keys {
    ($list:ident, $about:literal: $($section:literal $choice:literal: { $($need:ident $name:literal, $says:literal;)* })*) => {
        #[doc = $about]
        pub(super) const $list: &[Key] = &[$($(
            Key { section: $section, choice: $choice, name: $name, need: $need, says: $says }
        ),*),*];
    };
}

mod choice_keys;
mod keys;
mod shape_keys;

/// One choice of a section.
///
/// ```
/// use fingertip_scene::registry;
///
/// let cylinder = registry::SHAPES.iter().find(|entry| entry.name == "cylinder").ok_or("it is known")?;
/// assert!(cylinder.text().starts_with("[surface]\nshape = \"cylinder\"\nradius_m = "));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The section, as `contact.skin`.
    pub section: &'static str,
    /// The key that names the choice, as `law`.
    pub key: &'static str,
    /// The name of the choice.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub says: &'static str,
    /// The other keys that it needs, with values to start from: lines of TOML.
    pub example: &'static str,
}

impl Entry {
    /// The section with this choice, as it would stand in a file.
    #[must_use]
    pub fn text(&self) -> String {
        let Self { section, key, name, example, .. } = self;
        let end = if example.is_empty() { "" } else { "\n" };
        format!("[{section}]\n{key} = \"{name}\"\n{example}{end}")
    }
}

/// Whether a file must have something.
///
/// ```
/// use fingertip_scene::registry::{Need, sections};
///
/// let needed = sections().filter(|section| section.need == Need::Required).map(|section| section.name);
/// assert_eq!(needed.collect::<Vec<_>>(), ["", "input", "surface"]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// A file without it is refused.
    Required,
    /// It may be left out; what it says tells what holds then, or when it is needed after all.
    Optional,
}

/// A section of a scene file.
///
/// ```
/// use fingertip_scene::registry::sections;
///
/// let friction = sections().find(|section| section.name == "friction").ok_or("it is known")?;
/// assert!(friction.says.starts_with("how much friction holds"));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Section {
    /// Its name, as `contact.skin`; empty for what stands above all sections.
    pub name: &'static str,
    /// Whether a scene must have it.
    pub need: Need,
    /// What it is for.
    pub says: &'static str,
}

/// A key of a section.
///
/// ```
/// use fingertip_scene::registry::{Need, keys};
///
/// let radius = keys().find(|key| (key.choice, key.name) == ("sphere", "radius_m")).ok_or("it is known")?;
/// assert_eq!((radius.section, radius.need), ("surface", Need::Required));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    /// The section, as `contact.skin`.
    pub section: &'static str,
    /// The choice that has it, as `sphere`; empty for a key of the whole section.
    pub choice: &'static str,
    /// Its name, with the unit.
    pub name: &'static str,
    /// Whether the section, or the choice, must have it.
    pub need: Need,
    /// What it means.
    pub says: &'static str,
}

/// All keys, section by section.
pub fn keys() -> impl Iterator<Item = &'static Key> {
    [keys::KEYS, choice_keys::KEYS, shape_keys::KEYS].into_iter().flatten()
}

/// All sections, in the order in which a sample passes them.
pub fn sections() -> impl Iterator<Item = &'static Section> {
    keys::SECTIONS.iter()
}

/// All choices, section by section.
pub fn entries() -> impl Iterator<Item = &'static Entry> {
    [FILTERS, SHAPES, MODELS, SKINS, LIMITS, DETECTORS].into_iter().flatten()
}

macro_rules! entries {
    ($list:ident, $about:literal, $section:literal, $key:literal: $($name:literal, $says:literal, $example:literal;)*) => {
        #[doc = $about]
        pub const $list: &[Entry] =
            &[$(Entry { section: $section, key: $key, name: $name, says: $says, example: $example }),*];
    };
}

entries!(FILTERS, "The filters of `[filter]`.", "filter", "kind":
    "low_pass", "noise above a frequency is taken off the wrench, by a Butterworth filter of second order", "cutoff_Hz = 50.0";
    "notch", "a hum of one frequency is taken off the wrench", "frequency_Hz = 50.0\nwidth_Hz = 10.0";
);

entries!(SHAPES, "The shapes of `[surface]`.", "surface", "shape":
    "plane", "a plane", "point_m = [0.0, 0.0, 0.01]\nnormal = [0.0, 0.0, 1.0]";
    "disk", "a round plate", "radius_m = 0.01";
    "rectangle", "a rectangular plate", "first_half_edge_m = [0.01, 0.0, 0.0]\nsecond_half_edge_m = [0.0, 0.02, 0.0]";
    "sphere", "a sphere, or a part of it around a pole", "radius_m = 0.013";
    "ellipsoid", "an ellipsoid", "semi_axes_m = [0.008, 0.010, 0.013]";
    "cylinder", "the side of a round cylinder", "radius_m = 0.01\naxis = [1.0, 0.0, 0.0]";
    "capped_cylinder", "a round cylinder with flat ends", "radius_m = 0.01\nhalf_length_m = 0.02";
    "elliptic_cylinder", "an elliptic cylinder, without ends, open or capped", "semi_axes_m = [0.008, 0.012]\nends_m = { capped = 0.01 }";
    "capsule", "a cylinder with round ends", "radius_m = 0.008\nhalf_length_m = 0.01";
    "cone", "a cone with its tip", "half_angle_deg = 30.0\naxis = [0.0, 0.0, -1.0]\ndepth_m = 0.02";
    "frustum", "a cone that is cut off", "base_radius_m = 0.012\ntop_radius_m = 0.006\nheight_m = 0.02";
    "torus", "a ring", "ring_radius_m = 0.007\ntube_radius_m = 0.004";
    "superquadric", "between a box, an ellipsoid and an octahedron", "semi_axes_m = [0.008, 0.010, 0.013]\nexponents = [0.7, 0.8]";
    "rounded_box", "a box with round edges", "half_extents_m = [0.008, 0.010, 0.013]\nrounding_m = 0.003";
    "paraboloid", "a bowl with two radii of curvature at its apex", "radii_m = [0.010, 0.015]\ndepth_m = 0.01";
    "revolution", "a profile turned about an axis", "profile_m = [[-0.010, 0.0], [-0.006, 0.006], [0.0, 0.008], [0.006, 0.006], [0.010, 0.0]]";
    "heightfield", "heights over a grid", "corner_m = [-0.01, -0.01]\nspacing_m = [0.02, 0.02]\ncolumns = 2\nheights_m = [0.01, 0.01, 0.01, 0.011]";
    "mesh", "a closed triangle mesh; or `file` (.stl, .obj) and `metres_per_unit`",
        "vertices_m = [[0.01, 0.0, 0.0], [-0.01, 0.01, 0.0], [-0.01, -0.01, 0.0], [0.0, 0.0, 0.01]]\ntriangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]";
    "formula", "a shape of your own: where a formula of x, y and z is zero, within a ball", "outside = \"(x/a)^4 + (y/a)^4 + (z/b)^2 - 1\"\nparameters = { a = 0.010, b = 0.013 }\nreach_m = 0.018\nconvex = true";
    "posed", "another shape, turned and moved", "translation_m = [0.0, 0.0, 0.01]\nrotation_deg = [0.0, 90.0, 0.0]\nsurface = { shape = \"capsule\", radius_m = 0.008, half_length_m = 0.01 }";
    "trimmed", "the part of another shape on one side of a plane", "surface = { shape = \"sphere\", radius_m = 0.013 }\nregion = { point_m = [0.0, 0.0, 0.0], inward = [0.0, 0.0, 1.0] }";
    "compound", "the union of several shapes", "parts = [{ shape = \"sphere\", radius_m = 0.01 }, { shape = \"capsule\", radius_m = 0.006, half_length_m = 0.012 }]";
);

entries!(MODELS, "The models of `[contact]`.", "contact", "model":
    "point", "a contact transmits a force and no torque of its own", "least_force_N = 0.1";
    "soft_finger", "a contact transmits a force and a torque about the normal, as a soft tip does", "least_force_N = 0.1";
    "auto", "point contact or soft finger, whichever the wrench speaks for, given the noise in [uncertainty]", "least_force_N = 0.1\ngreatest_pitch_m = 0.01";
);

entries!(SKINS, "The laws of `[contact.skin]`.", "contact.skin", "law":
    "linear", "depth in proportion to the force", "stiffness_N_per_m = 8000.0\nradius_m = 0.013";
    "power", "depth and patch as powers of the force", "patch_at_1_N_m = 0.002\npatch_exponent = 0.33\ndepth_at_1_N_m = 0.0004\ndepth_exponent = 0.67";
    "hertz", "an elastic body with the same curvature everywhere", "radii_m = [0.013, 0.013]\nyoung_moduli_Pa = [2.0e6, inf]\npoisson_ratios = [0.49, 0.3]";
    "local_hertz", "an elastic body with the curvature that the surface has where it touches", "largest_radius_m = 0.1\nyoung_moduli_Pa = [2.0e6, inf]\npoisson_ratios = [0.49, 0.3]";
    "table", "measured points of force, depth and radius of the patch", "force_depth_patch_N_m_m = [[0.5, 0.0002, 0.001], [2.0, 0.0005, 0.002], [5.0, 0.0009, 0.003]]";
);

entries!(LIMITS, "The limits of `[friction]`.", "friction", "limit":
    "coulomb", "one coefficient in all directions", "static_coefficient = 0.5";
    "anisotropic", "one coefficient along the grain of a flat surface, another across it", "grain = [1.0, 0.0, 0.0]\ncoefficient_along = 0.4\ncoefficient_across = 0.6";
    "soft_finger", "tangential force and spin torque together", "static_coefficient = 0.5\ntorque_arm_m = 0.003";
    "power", "tangential force and spin torque on a patch whose pressure is known: \"uniform\", \"hertz\" or \"winkler\"", "static_coefficient = 0.5\npatch_radius_m = 0.004\npressure = \"hertz\"";
    "load_dependent", "tangential force and spin torque on a patch that grows with the force", "static_coefficient = 0.5\ntorque_arm_m = 0.003\nreference_force_N = 1.0\ngrowth_exponent = 0.33";
    "uncertain", "a coefficient with a standard deviation", "static_coefficient = 0.5\ndeviation = 0.05\nnoise_N = 0.01";
);

entries!(DETECTORS, "The detectors of `[slip]`.", "slip", "detector":
    "drop", "the friction ratio falls suddenly", "noise_N = 0.01";
    "threshold", "the friction ratio passes the coefficient of [friction]", "noise_N = 0.01\nwarning_share = 0.8";
    "likelihood_ratio", "the friction ratio falls, suddenly or not", "noise_N = 0.01\nfalse_alarms_per_minute = 1.0";
    "stick_slip", "falls that come again and again", "noise_N = 0.01";
    "adaptive_drop", "the friction ratio falls suddenly, in noise that is learnt: hum, vibration, steps of a converter", "noise_N = 0.01\nfalse_alarms_per_minute = 1.0";
);
