//! The keys of filters, skins, limits and detectors.

use super::Key;
use super::Need::{Optional, Required};

keys!(KEYS, "Keys of the choices of a section, choice by choice.":
"filter" "low_pass": {
    Required "cutoff_Hz", "noise above this goes";
}
"filter" "notch": {
    Required "frequency_Hz", "the hum that goes";
    Required "width_Hz", "between the frequencies where half of the power is left";
}
"contact.skin" "linear": {
    Required "stiffness_N_per_m", "force over depth";
    Required "radius_m", "of the tip";
}
"contact.skin" "power": {
    Required "patch_at_1_N_m", "radius of the patch at 1 N";
    Required "patch_exponent", "with which it grows with the force";
    Required "depth_at_1_N_m", "depth at 1 N";
    Required "depth_exponent", "with which it grows with the force";
}
"contact.skin" "hertz": {
    Required "radii_m", "two relative radii of curvature";
    Required "young_moduli_Pa", "of skin and object (`inf` is rigid)";
    Required "poisson_ratios", "of skin and object";
}
"contact.skin" "local_hertz": {
    Required "largest_radius_m", "of curvature that is believed: a flatter place counts as this";
    Optional "object_curvature_per_m", "of the object, 0 (flat) by default";
    Required "young_moduli_Pa", "of skin and object (`inf` is rigid)";
    Required "poisson_ratios", "of skin and object";
}
"contact.skin" "table": {
    Required "force_depth_patch_N_m_m", "measured points of force, depth and radius of the patch";
}
"friction" "coulomb": {
    Required "static_coefficient", "μ: greatest tangential force over normal force";
}
"friction" "anisotropic": {
    Required "grain", "a direction along the flat surface, in the surface's frame. Shapes plane, disk and rectangle";
    Required "coefficient_along", "μ along the grain";
    Required "coefficient_across", "μ across it";
}
"friction" "soft_finger": {
    Required "static_coefficient", "μ without spin torque";
    Required "torque_arm_m", "greatest spin torque over greatest tangential force";
    Optional "conservative", "`true` for the rhombus in place of the ellipse";
}
"friction" "power": {
    Required "static_coefficient", "μ without spin torque";
    Required "patch_radius_m", "radius of the patch";
    Required "pressure", "how it lies on the patch: `\"uniform\"`, `\"hertz\"` or `\"winkler\"`";
}
"friction" "load_dependent": {
    Required "static_coefficient", "μ without spin torque";
    Required "torque_arm_m", "greatest spin torque over greatest tangential force, at the reference force";
    Required "reference_force_N", "the force of the torque arm";
    Required "growth_exponent", "with which the patch grows with the force: 0.33 for elastic tips";
}
"friction" "uncertain": {
    Required "static_coefficient", "mean of μ";
    Required "deviation", "standard deviation of μ";
    Optional "noise_N", "standard deviation of a force component, 0 by default";
    Optional "probability", "with which the coefficient that margins and grip count with is undercut, 0.01 by default";
}
"slip" "drop": {
    Required "noise_N", "standard deviation of a force component at rest; contacts of less than ten times this are not judged";
    Optional "false_alarms_per_minute", "how often noise alone may raise an alarm; with it, `sample_rate_Hz` must be known";
}
"slip" "threshold": {
    Required "noise_N", "standard deviation of a force component at rest; contacts of less than ten times this are not judged";
    Optional "warning_share", "warn at this share of μ, 0.8 by default";
}
"slip" "likelihood_ratio": {
    Required "noise_N", "standard deviation of a force component at rest; contacts of less than ten times this are not judged";
    Optional "false_alarms_per_minute", "how often noise alone may raise an alarm, 1 by default; `sample_rate_Hz` must be known";
}
"slip" "stick_slip": {
    Required "noise_N", "standard deviation of a force component at rest; contacts of less than ten times this are not judged";
}
"slip" "adaptive_drop": {
    Required "noise_N", "standard deviation of a force component at rest, to begin with; contacts of less than ten times this are not judged";
    Optional "false_alarms_per_minute", "how often noise alone may raise an alarm, 1 by default; `sample_rate_Hz` must be known";
}
);
