//! The tube unrolled: where its gauges come to lie on a flat sheet.

use core::f64::consts::{PI, TAU};

use fingertip_wrench::gauge_layout::Gauge;

use super::Foil;
use crate::design::{DesignError, TubeLayout};

/// One gauge on the sheet. Places are \[m\]: from the left edge to the right, and behind the origin downwards.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::bench::{Foil, Outline, Unrolled};
///
/// let unrolled = Unrolled::new(&layout, 30e-3, &Foil::default(), 0.1e-3)?;
/// let first: &Outline = &unrolled.outlines[0];
/// // Its middle is where the gauge is, and its carrier 4 mm long.
/// assert!((first.centre[1] - first.gauge.z).abs() < 1e-12);
/// assert!((first.centre[0] - unrolled.place(first.gauge.theta)).abs() < 1e-12);
/// let [a, b] = first.axis;
/// assert!(((a[0] - b[0]).hypot(a[1] - b[1]) - 8e-3).abs() < 1e-3);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// The gauge itself.
    pub gauge: Gauge<f64>,
    /// The middle of its grid.
    pub centre: [f64; 2],
    /// The corners of the grid, in order.
    pub grid: [[f64; 2]; 4],
    /// The corners of the carrier, in order.
    pub carrier: [[f64; 2]; 4],
    /// The line along the grid through the middle, as long as two carriers.
    pub axis: [[f64; 2]; 2],
}

/// A tube unrolled, seen from outside with the tip upwards, so that angles around it grow to the right.
///
/// A sheet that is wrapped around the tube bends about its middle, half its thickness outside the wall: the sheet is
/// as long as that circle, and the arc of an angle θ on it is `(R + s/2 + p/2)·θ` for the mean radius R, the wall s
/// and the paper p. Gauges lie on the wall itself, at R + s/2; their outlines are drawn so that they cover them when the
/// sheet is wrapped, a little longer around (`docs/theory/calibration.md#a-template-that-is-wrapped`).
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::bench::{Foil, Unrolled};
///
/// // A tube of 6.55 mm with a wall of 0.2 mm, clamped 30 mm behind the origin, wrapped in paper of 0.1 mm.
/// let unrolled = Unrolled::new(&layout, 30e-3, &Foil::default(), 0.1e-3)?;
/// assert!((unrolled.outer - 6.65e-3).abs() < 1e-12);
/// // The paper bends about its middle: 6.7 mm.
/// assert!((unrolled.length() - core::f64::consts::TAU * 6.7e-3).abs() < 1e-9);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Unrolled {
    /// Outer radius of the tube \[m\].
    pub outer: f64,
    /// Inner radius of the tube \[m\].
    pub inner: f64,
    /// Radius of the circle that the sheet becomes \[m\].
    pub drawn: f64,
    /// Angle of the sheet's left edge \[rad\]: in the middle of the widest gap between gauges.
    pub seam: f64,
    /// The sheet's upper edge, behind the origin \[m\]: mostly negative.
    pub top: f64,
    /// Where the tube is clamped, the sheet's lower edge, behind the origin \[m\].
    pub clamped: f64,
    /// The gauges that are glued.
    pub foil: Foil,
    /// Where they come to lie, in the order of the layout.
    pub outlines: Vec<Outline>,
}

impl Unrolled {
    /// Of a layout whose tube is clamped so far behind the origin \[m\], on paper so thick \[m\].
    ///
    /// # Errors
    /// [`DesignError`] for a bad layout or foil, a paper without a thickness (nothing is one), or a clamp that is not
    /// below the upper edge.
    pub fn new(layout: &TubeLayout, clamped: f64, foil: &Foil, paper: f64) -> Result<Self, DesignError> {
        layout.validate()?;
        foil.validate()?;
        let not_negative = |quantity, value: f64| {
            if value >= 0.0 && value.is_finite() {
                Ok(())
            } else {
                Err(DesignError::OutOfRange { quantity, value, requirement: "finite and not negative" })
            }
        };
        not_negative("thickness of the paper", paper)?;
        not_negative("place of the clamp", clamped)?;
        let half = 0.5 * layout.beam.thickness;
        let (outer, inner) = (layout.beam.radius + half, layout.beam.radius - half);
        let drawn = outer + 0.5 * paper;
        let seam = widest_gap(&layout.gauges);
        let outline = |gauge: &Gauge<f64>| Outline::new(*gauge, foil, outer, drawn, seam);
        let outlines: Vec<Outline> = layout.gauges.iter().map(outline).collect();
        let highest = outlines.iter().flat_map(|outline| outline.carrier).map(|[_, z]| z).fold(0.0, f64::min);
        // Room above for the numbers of gauges and for the knife.
        let top = highest - 6e-3;
        Ok(Self { outer, inner, drawn, seam, top, clamped, foil: *foil, outlines })
    }

    /// Length of the sheet once around \[m\].
    #[must_use]
    pub fn length(&self) -> f64 {
        TAU * self.drawn
    }

    /// Where an angle comes to lie, from the left edge \[m\].
    #[must_use]
    pub fn place(&self, theta: f64) -> f64 {
        self.drawn * (theta - self.seam).rem_euclid(TAU)
    }

    /// Pairs of gauges at one place, which are stacked (counted from 0).
    #[must_use]
    pub fn stacked(&self) -> Vec<(usize, usize)> {
        self.pairs(|a, b, shift| (a.centre[0] + shift - b.centre[0]).hypot(a.centre[1] - b.centre[1]) < 1e-6)
    }

    /// Pairs of gauges at different places whose carriers lie over each other (counted from 0).
    #[must_use]
    pub fn overlapping(&self) -> Vec<(usize, usize)> {
        let stacked = self.stacked();
        let mut over = self.pairs(|a, b, shift| overlap(&a.carrier.map(|[x, z]| [x + shift, z]), &b.carrier));
        over.retain(|pair| !stacked.contains(pair));
        over
    }

    /// The pairs of which something holds, the one shifted once around the tube either way.
    fn pairs(&self, holds: impl Fn(&Outline, &Outline, f64) -> bool) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        for (i, a) in self.outlines.iter().enumerate() {
            for (j, b) in self.outlines.iter().enumerate().skip(i + 1) {
                if [-1.0, 0.0, 1.0].into_iter().any(|turns| holds(a, b, turns * self.length())) {
                    found.push((i, j));
                }
            }
        }
        found
    }
}

impl Outline {
    fn new(gauge: Gauge<f64>, foil: &Foil, outer: f64, drawn: f64, seam: f64) -> Self {
        let centre = [drawn * (gauge.theta - seam).rem_euclid(TAU), gauge.z];
        let (sin, cos) = gauge.q.sin_cos();
        // Along the gauge, which is from the tube's axis (up) towards increasing angles (right), and across it.
        let at = |along: f64, across: f64| {
            let (up, right) = (along * cos - across * sin, along * sin + across * cos);
            [centre[0] + right / outer * drawn, centre[1] - up]
        };
        let corners = |[along, across]: [f64; 2]| {
            [(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)]
                .map(|(a, b)| at(0.5 * a * along, 0.5 * b * across))
        };
        let axis = [at(-foil.carrier[0], 0.0), at(foil.carrier[0], 0.0)];
        Self { gauge, centre, grid: corners(foil.grid), carrier: corners(foil.carrier), axis }
    }

    /// Whether any part of the carrier lies between these edges.
    pub(super) fn reaches(&self, left: f64, right: f64) -> bool {
        let least = self.carrier.iter().map(|[x, _]| *x).fold(f64::INFINITY, f64::min);
        let most = self.carrier.iter().map(|[x, _]| *x).fold(f64::NEG_INFINITY, f64::max);
        least < right && most > left
    }
}

/// The middle of the widest gap between angles; the side opposite to a single one.
fn widest_gap(gauges: &[Gauge<f64>]) -> f64 {
    let mut angles: Vec<f64> = gauges.iter().map(|gauge| gauge.theta.rem_euclid(TAU)).collect();
    angles.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (angles.first().copied(), angles.last().copied()) else { return PI };
    let mut widest = (first + TAU - last, last);
    for pair in angles.array_windows() {
        let [a, b] = *pair;
        // The first of equals, but for rounding.
        if b - a > widest.0 + 1e-9 {
            widest = (b - a, a);
        }
    }
    let middle = widest.1 + 0.5 * widest.0;
    if middle >= TAU { middle - TAU } else { middle }
}

/// Whether two rectangles (or what is left of them when they are sheared) share more than an edge: no side of either
/// separates them (the theorem of the separating axis).
fn overlap(a: &[[f64; 2]; 4], b: &[[f64; 2]; 4]) -> bool {
    let sides = |corners: &[[f64; 2]; 4]| {
        let [o, p, q, _] = *corners;
        [[p[1] - o[1], o[0] - p[0]], [q[1] - p[1], p[0] - q[0]]]
    };
    let span = |corners: &[[f64; 2]; 4], [nx, ny]: [f64; 2]| {
        let along = corners.map(|[x, y]| nx * x + ny * y);
        (along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max))
    };
    sides(a).into_iter().chain(sides(b)).all(|normal| {
        let ((a0, a1), (b0, b1)) = (span(a, normal), span(b, normal));
        a0 < b1 && b0 < a1
    })
}
