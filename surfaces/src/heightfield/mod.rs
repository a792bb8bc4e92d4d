//! Surfaces given by heights on a grid.

mod closest;

use alloc::vec::Vec;

use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix3, Vector3};

use crate::numeric::quadratic::roots;
use crate::numeric::vectors::{foot, hypotenuse, is_finite, length, unit_or};
use crate::{ActiveSurface, BadShape, ClosestApproach, Corner, Crossing, Extent, Level, SmoothSurface};

/// Heights over a rectangular grid of the x-y plane, the outside above, bilinear in between;
/// [`Posed`](crate::Posed) puts it elsewhere. It ends where the grid ends.
///
/// A scan of a worn or moulded pad comes like this.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Heightfield};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // A square of 20 mm, 2 mm high at the far edge and flat at the near one.
/// let pad = Heightfield::new([-0.01, -0.01], [0.02, 0.02], 2, vec![0.0, 0.0, 0.002, 0.002])?;
/// let line = Line { point: Vector3::new(0.003, 0.0, 0.05), direction: -Vector3::z() };
/// let mut heights = Vec::new();
/// pad.crossings(&line, |crossing| heights.push(crossing.point.z));
/// assert!(heights.len() == 1 && (heights[0] - 0.001_f64).abs() < 1e-15); // half-way
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Heightfield<T: Real> {
    /// Corner of the grid with the least x and y.
    corner: [T; 2],
    spacing: [T; 2],
    columns: usize,
    rows: usize,
    /// Row by row; x runs within a row.
    heights: Vec<T>,
    low: T,
    high: T,
}

impl<T: Real> Heightfield<T> {
    /// From the place of the first height, the spacing of the grid along x and y, and the heights
    /// \[m\], row after row, x running within a row of `columns`.
    ///
    /// # Errors
    /// [`BadShape`] unless corner and heights are finite, the spacings positive finite lengths, and
    /// there are at least two columns and two full rows.
    pub fn new(corner: [T; 2], spacing: [T; 2], columns: usize, heights: Vec<T>) -> Result<Self, BadShape> {
        let shape = "heightfield";
        for step in spacing {
            BadShape::check_length(shape, "spacing", step)?;
        }
        let finite = corner.iter().chain(&heights).all(|x| x.is_number());
        BadShape::check(shape, "corner and heights", "finite", finite)?;
        let full = columns >= 2 && heights.len().is_multiple_of(columns) && heights.len() / columns >= 2;
        BadShape::check(shape, "grid", "two full rows of two columns at least", full)?;
        let low = heights.iter().fold(T::GREATEST, |low, h| low.min(*h));
        let high = heights.iter().fold(-T::GREATEST, |high, h| high.max(*h));
        let rows = heights.len() / columns;
        Ok(Self { corner, spacing, columns, rows, heights, low, high })
    }

    /// How many heights there are along x and y.
    #[inline]
    #[must_use]
    pub const fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    #[inline]
    fn at(&self, column: usize, row: usize) -> T {
        self.heights.get(row * self.columns + column).copied().unwrap_or_else(T::zero)
    }

    #[doc(hidden)]
    pub fn node(&self, column: usize, row: usize) -> Vector3<T> {
        let place = |k: usize| T::literal(k as f64);
        let [x, y] = self.corner;
        let [dx, dy] = self.spacing;
        Vector3::new(x + dx * place(column), y + dy * place(row), self.at(column, row))
    }

    /// The cell under a place in units of the grid, and the place within it.
    fn cell(&self, u: T, v: T) -> ([usize; 2], [T; 2]) {
        // The cast stops at the borders, and takes a NaN to zero.
        let split = |u: T, count: usize| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let cell = (u.to_f64() as usize).min(count - 2);
            (cell, (u - T::literal(cell as f64)).max(T::zero()).min(T::one()))
        };
        let ((i, s), (j, t)) = (split(u, self.columns), split(v, self.rows));
        ([i, j], [s, t])
    }

    /// Height and slopes, per metre, at a place.
    fn height(&self, x: T, y: T) -> (T, T, T) {
        let ([cx, cy], [dx, dy]) = (self.corner, self.spacing);
        let ([i, j], [s, t]) = self.cell((x - cx) / dx, (y - cy) / dy);
        let [a, b] = [self.at(i, j), self.at(i + 1, j)];
        let [c, d] = [self.at(i, j + 1), self.at(i + 1, j + 1)];
        let (low, high) = (a + (b - a) * s, c + (d - c) * s);
        let by_x = ((b - a) * (T::one() - t) + (d - c) * t) / dx;
        (low + (high - low) * t, by_x, (high - low) / dy)
    }

    fn upward(&self, x: T, y: T) -> Vector3<T> {
        let (_, by_x, by_y) = self.height(x, y);
        unit_or(&Vector3::new(-by_x, -by_y, T::one()), Vector3::z)
    }

    /// `∂²z/∂x∂y` \[1/m\] of the cell at a place: all the second derivatives that a bilinear surface has.
    fn twist(&self, x: T, y: T) -> T {
        let ([cx, cy], [dx, dy]) = (self.corner, self.spacing);
        let ([i, j], _) = self.cell((x - cx) / dx, (y - cy) / dy);
        let along = |row: usize| self.at(i + 1, row) - self.at(i, row);
        (along(j + 1) - along(j)) / dx / dy
    }

    /// The stretch of the line over the grid.
    fn over_grid(&self, start: &Vector3<T>, direction: &Vector3<T>) -> Option<(T, T)> {
        let far = T::GREATEST.root();
        let ([cx, cy], [dx, dy]) = (self.corner, self.spacing);
        let width = dx * T::literal((self.columns - 1) as f64);
        let depth = dy * T::literal((self.rows - 1) as f64);
        let (mut low, mut high) = (-far, far);
        let margin = (self.high - self.low) + dx.min(dy);
        for (p, u, from, to) in [
            (start.x, direction.x, cx, cx + width),
            (start.y, direction.y, cy, cy + depth),
            (start.z, direction.z, self.low - margin, self.high + margin),
        ] {
            let (a, b) = ((from - p) / u, (to - p) / u);
            if a.is_number() && b.is_number() {
                (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
            } else if !(p >= from && p <= to) {
                return None;
            }
        }
        (low < high).then_some((low, high))
    }
}

impl<T: Real> Heightfield<T> {
    /// Compiled once, not once for each caller: a call through a pointer costs little beside what is done here.
    fn each_crossing(&self, line: &Line<T>, visit: &mut dyn FnMut(Crossing<T>)) {
        let ([cx, cy], [dx, dy]) = (self.corner, self.spacing);
        let middle = Vector3::new(cx, cy, self.low);
        let (offset, along) = foot(line, &middle);
        let start = middle + offset;
        let direction = line.direction;
        if !is_finite(&start) {
            return;
        }
        let Some((mut from, end)) = self.over_grid(&start, &direction) else { return };
        let over = |t: T| {
            let p = start + direction * t;
            p.z - self.height(p.x, p.y).0
        };
        let half = T::literal(0.5);
        let mut at_from = over(from);
        for _ in 0..2 * (self.columns + self.rows) {
            // The next border of a cell: a little beyond, in case rounding would stand still.
            let nudge = (end - from).min(dx.min(dy)) * T::literal(1e-3);
            let p = start + direction * (from + nudge);
            let ([i, j], _) = self.cell((p.x - cx) / dx, (p.y - cy) / dy);
            let border = |p: T, u: T, corner: T, step: T, k: usize| {
                let ahead = if u > T::zero() { k + 1 } else { k };
                let t = (corner + step * T::literal(ahead as f64) - p) / u;
                if t > from { t } else { end }
            };
            let to =
                end.min(border(start.x, direction.x, cx, dx, i)).min(border(start.y, direction.y, cy, dy, j));
            let at_to = over(to);
            // Over the patch: z − (a + b·s + c·t + e·s·t), about the middle of the stretch.
            let m = (from + to) * half;
            let q = start + direction * m;
            let base = self.node(i, j);
            let (s, t) = ((q.x - base.x) / dx, (q.y - base.y) / dy);
            let (us, ut) = (direction.x / dx, direction.y / dy);
            let a = self.at(i, j);
            let (b, c) = (self.at(i + 1, j) - a, self.at(i, j + 1) - a);
            let e = self.at(i + 1, j + 1) - a - b - c;
            let found = roots(
                -e * us * ut,
                (direction.z - b * us - c * ut - e * (s * ut + t * us)) * half,
                q.z - a - b * s - c * t - e * s * t,
            )
            .map(|ends| ends.map(|x| x + m));
            let within = |x: &T| *x > from && *x < to;
            let mut report = |x: T| {
                let point = start + direction * x;
                visit(Crossing {
                    along: along + x,
                    point,
                    normal: self.upward(point.x, point.y),
                    active: true,
                });
            };
            if (at_from < T::zero()) != (at_to < T::zero()) {
                let root = found.and_then(|ends| {
                    ends.into_iter().find(within).or_else(|| {
                        let off = |x: &T| (*x - m).abs();
                        ends.into_iter()
                            .filter(|x| x.is_number())
                            .min_by(|x, y| off(x).partial_cmp(&off(y)).unwrap_or(core::cmp::Ordering::Equal))
                    })
                });
                report(root.unwrap_or(m).max(from).min(to));
            } else if let Some([first, second]) = found
                && within(&first)
                && within(&second)
            {
                report(first);
                report(second);
            }
            (from, at_from) = (to, at_to);
            if !(from < end) {
                break;
            }
        }
    }
}

impl<T: Real> ActiveSurface<T> for Heightfield<T> {
    /// From cell to cell under the line; in each, the height of the line over the patch is a
    /// quadratic. Signs at the borders of cells are computed once, so that no crossing falls
    /// between two.
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.each_crossing(line, &mut visit);
    }

    /// Exact but for rounding: of a cell, the nearest place is a node, on a straight edge, or where the
    /// normal is across the line, which is a root of a cubic. Of a line
    /// that crosses, a crossing. Takes a time that grows with the size of the
    /// grid, some steps per node and more for the cells near the line.
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (nearest, distance) = self.nearest_to(line);
        let mut crossing: Option<Crossing<T>> = None;
        let from_nearest = |c: &Crossing<T>| length(&(c.point - nearest));
        self.crossings(line, |c| {
            if crossing.is_none_or(|known| from_nearest(&c) < from_nearest(&known)) {
                crossing = Some(c);
            }
        });
        let (point, gap) = crossing.map_or((nearest, distance), |c| (c.point, T::zero()));
        Some(ClosestApproach { gap, point, normal: self.upward(point.x, point.y), active: true })
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.upward(point.x, point.y)
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        let ([cx, cy], far) = (self.corner, self.node(self.columns - 1, self.rows - 1));
        let over = point.x >= cx && point.x <= far.x && point.y >= cy && point.y <= far.y;
        over && point.z < self.height(point.x, point.y).0 && hypotenuse(point.x, point.y).is_number()
    }
}

/// `z − h(x, y)`, cell by cell. The normal jumps from cell to cell, and so the curvature is that *within* a
/// cell: for the curvature of the pad that was scanned ask
/// [`shape_operator_by_differences`](crate::shape_operator_by_differences) over some cells.
impl<T: Real> SmoothSurface<T> for Heightfield<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let (height, by_x, by_y) = self.height(point.x, point.y);
        let (zero, mixed) = (T::zero(), -self.twist(point.x, point.y));
        Level {
            value: point.z - height,
            gradient: Vector3::new(-by_x, -by_y, T::one()),
            hessian: Matrix3::new(zero, mixed, zero, mixed, zero, zero, zero, zero, zero),
        }
    }

    fn extent(&self) -> Extent<T> {
        let half = T::literal(0.5);
        let [low, high] = [self.node(0, 0), self.node(self.columns - 1, self.rows - 1)];
        let rim = (low + high) * half;
        let centre = Vector3::new(rim.x, rim.y, (self.low + self.high) * half);
        let corner = Vector3::new(high.x, high.y, self.high);
        Extent { centre, radius: length(&(corner - centre)) }
    }

    /// A node of the grid.
    fn corner(&self, _point: &Vector3<T>, _normal: &Vector3<T>) -> Option<Corner<T>> {
        Some(Corner::Tip)
    }
}

/// In files, the grid and the heights.
#[cfg(feature = "serde")]
mod files {
    use alloc::vec::Vec;

    use fingertip_wrench::Real;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    use super::Heightfield;

    #[derive(Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Parts<T> {
        corner_m: [T; 2],
        spacing_m: [T; 2],
        columns: usize,
        heights_m: Vec<T>,
    }

    impl<T: Real + Serialize> Serialize for Heightfield<T> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            Parts {
                corner_m: self.corner,
                spacing_m: self.spacing,
                columns: self.columns,
                heights_m: self.heights.clone(),
            }
            .serialize(serializer)
        }
    }

    impl<'de, T: Real + Deserialize<'de>> Deserialize<'de> for Heightfield<T> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let parts = Parts::<T>::deserialize(deserializer)?;
            Self::new(parts.corner_m, parts.spacing_m, parts.columns, parts.heights_m).map_err(Error::custom)
        }
    }
}
