//! The columns of `contacts.csv`, with what they mean: written by the command, and explained by the book.

use fingertip_scene::Tells;

/// A column, or several of one meaning, of `contacts.csv`.
///
/// ```
/// use fingertip_cli::contact_columns::CONTACT_COLUMNS;
///
/// let of = |name: &str| CONTACT_COLUMNS.iter().find(|columns| columns.names.contains(&name));
/// // The torque about the normal is told of a soft finger only, the contact point of any.
/// assert_eq!(of("spin_Nm").map(|columns| columns.of), Some("soft finger"));
/// assert_eq!(of("x_m").map(|columns| (columns.of, columns.says)), Some(("", "contact point")));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// The section of a scene, or its key, that asks for them; empty for those of every scene.
    pub of: &'static str,
    /// Their names; units are in the names.
    pub names: &'static [&'static str],
    /// What they mean.
    pub says: &'static str,
    pub(super) asked: fn(&Tells) -> bool,
}

const fn always(names: &'static [&'static str], says: &'static str) -> Columns {
    Columns { of: "", names, says, asked: |_| true }
}

const fn asked(
    of: &'static str,
    asked: fn(&Tells) -> bool,
    names: &'static [&'static str],
    says: &'static str,
) -> Columns {
    Columns { of, names, says, asked }
}

/// All columns but those of a tactile array, in their order. Where a sample has no value, the cell is empty.
pub const CONTACT_COLUMNS: &[Columns] = &[
    always(&["t_s"], "time"),
    always(
        &["status"],
        "`contact`, or why there is none: `below_threshold`, `misses`, `only_pulling`, `outside_active_region`, \
         `not_finite`, `beyond_friction` (more than `greatest_friction_ratio`, which is 10 for a soft finger unless the \
         scene sets another); `rest` (used for the tare), `saturated`, `uncalibrated` (beyond the readings that a curved sensor was calibrated with), `unusable_row` (repeated, out of time, incomplete)",
    ),
    always(&["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"], "load on the fingertip, tared"),
    always(&["x_m", "y_m", "z_m"], "contact point"),
    always(&["nx", "ny", "nz"], "outward unit normal there"),
    always(&["normal_N"], "normal force, positive when pressing"),
    always(&["tangential_N"], "magnitude of the tangential force"),
    always(&["ratio"], "tangential over normal force"),
    always(&["margin_N"], "distance from the friction limit, negative beyond it; needs `[friction]`"),
    always(
        &["gap_m"],
        "how far the line of action misses the surface (0 in a contact, unless a gap is accepted)",
    ),
    always(&["slip"], "`not_pressing`, `holding`, `warning`, `slipping`; needs `[slip]`"),
    asked("soft finger", |tells| tells.spin_torque, &["spin_Nm"], "torque about the outward normal"),
    asked(
        "[uncertainty]",
        |tells| tells.spread,
        &["ellipse_a_m", "ellipse_b_m"],
        "semi-axes of the ellipse in the tangent plane that holds the contact with the probability of `[uncertainty]`",
    ),
    asked(
        "[uncertainty]",
        |tells| tells.spread,
        &["ellipse_x", "ellipse_y", "ellipse_z"],
        "direction of the longer one",
    ),
    asked(
        "[uncertainty]",
        |tells| tells.spread,
        &["normal_deviation_N"],
        "standard deviation of the normal force",
    ),
    asked(
        "[tracking]",
        |tells| tells.tracked,
        &["track"],
        "`new`, `followed`, `doubted` or `bridged`: how the sample fits to the contact before",
    ),
    asked(
        "[tracking]",
        |tells| tells.tracked,
        &["track_x_m", "track_y_m", "track_z_m"],
        "where the contact is by all samples so far",
    ),
    asked(
        "[tracking]",
        |tells| tells.tracked,
        &["track_vx_m_per_s", "track_vy_m_per_s", "track_vz_m_per_s"],
        "how fast it moves over the fingertip",
    ),
    asked(
        "[tracking]",
        |tells| tells.tracked,
        &["track_deviation_m", "track_surprise"],
        "standard deviation of the place where it is known worst; normalised innovation squared, 2 in the mean",
    ),
    asked(
        "least_touch_N",
        |tells| tells.happened,
        &["event", "event_since_s"],
        "`touch` or `release`, and how long ago it showed first",
    ),
    asked(
        "least_touch_N",
        |tells| tells.happened,
        &["impact_peak_N", "impact_x_Ns", "impact_y_Ns", "impact_z_Ns"],
        "greatest force and impulse of a blow that is over",
    ),
    asked(
        "uncertain friction",
        |tells| tells.slip_probability,
        &["slip_probability"],
        "that the contact slips",
    ),
    asked(
        "[estimate]",
        |tells| tells.friction,
        &["mu_static", "mu_static_deviation", "mu_kinetic", "mu_kinetic_deviation"],
        "what has been learnt of the friction so far, with standard deviations",
    ),
    asked("[grip]", |tells| tells.grip_force, &["grip_N"], "the normal force to command next"),
];

/// Columns of each place of a tactile array, behind `fused1_`, `fused2_` and so on.
pub const FUSED_COLUMNS: &[(&str, &str)] = &[
    ("x_m", "contact point"),
    ("y_m", "contact point"),
    ("z_m", "contact point"),
    ("fx_N", "force on the fingertip there"),
    ("fy_N", "force on the fingertip there"),
    ("fz_N", "force on the fingertip there"),
    ("deviation_N", "standard deviation of that force in the direction in which it is known worst"),
    ("share_from_wrench", "how much of its variance the wrench removed"),
];

/// Column of the array as a whole, and its meaning.
pub const FUSED_DISAGREEMENT: (&str, &str) = (
    "fused_disagreement",
    "how far the wrench is from what the array alone predicts: χ² with six degrees of freedom if all is right",
);
