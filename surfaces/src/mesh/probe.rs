//! Does a line cross the boxes of a node?

use fingertip_wrench::Real;
use nalgebra::Vector3;
use wide::bytemuck::cast;
use wide::{i16x8, i32x4, i32x8, u8x16, u32x4};

use super::node::{Grid, Node, WIDTH};

/// A line in whole numbers: its direction `u` and moment `p × u`.
pub(super) struct Probe {
    direction: [i16x8; 3],
    /// Magnitudes of the direction's components.
    spread: [i16x8; 3],
    /// For each axis, the two components of the direction that a point's moment about it depends on.
    across: [i16x8; 3],
    moment: [i32x4; 3],
}

/// A pair of numbers for each of four lanes.
#[inline(always)]
fn pairs(first: i16, second: i16) -> i16x8 {
    cast(u32x4::splat(u32::from(first.cast_unsigned()) | u32::from(second.cast_unsigned()) << 16))
}

/// 256 times the numbers in some lanes, twice.
#[inline(always)]
fn widen([first, second]: [[i8; WIDTH]; 2]) -> [i16x8; 2] {
    let both: u8x16 = cast([first, second]);
    // Each becomes the upper half of a number whose lower half is zero.
    let (low, high) = if cfg!(target_endian = "big") { (both, u8x16::ZERO) } else { (u8x16::ZERO, both) };
    [cast(u8x16::unpack_low(low, high)), cast(u8x16::unpack_high(low, high))]
}

impl Probe {
    /// What stands for 1 in a direction.
    const UNIT: f64 = 32_767.0;
    /// What the rounding of a node's test comes to, in 128ths of its steps. Each product is rounded down by
    /// less than 1, and so is the moment: so what is away is short by less than 2, and what is reached by
    /// 2; halves of the units that the moment was rounded to before come on top.
    const SLACK: i16 = 4;

    #[inline]
    pub(super) fn new<T: Real>(grid: Grid, start: &Vector3<T>, direction: &Vector3<T>) -> Self {
        let (start, along) = if grid.is_even {
            (grid.in_steps(start), *direction)
        } else {
            // What is far along the line cancels, and may be much.
            let (start, along) = (grid.steps(start), grid.steps(direction));
            let along = along * (1.0 / along.norm_squared().root());
            let start = start - along * start.dot(&along);
            (start.map(T::literal), along.map(T::literal))
        };
        let round = |x: T| (x + T::literal(0.5).copysign(x)).to_f64();
        #[allow(clippy::cast_possible_truncation)]
        let u = along.map(|x| round(x * T::literal(Self::UNIT)) as i16);
        let moment = start.cross(&u.map(|x| T::literal(f64::from(x))));
        Self {
            direction: u.map(|x| pairs(x, x)).into(),
            spread: u.map(|x| pairs(x.saturating_abs(), x.saturating_abs())).into(),
            across: [
                pairs(u.z, u.y.saturating_neg()),
                pairs(u.x, u.z.saturating_neg()),
                pairs(u.y, u.x.saturating_neg()),
            ],
            #[allow(clippy::cast_possible_truncation)]
            moment: moment.map(|x| i32x4::splat(round(x) as i32)).into(),
        }
    }

    /// Which children's boxes the line may cross, a bit for each: along each axis across it and one
    /// of the box's, do their shadows overlap? (The separating axes of a line and a box.)
    #[inline(always)]
    pub(super) fn may_cross(&self, node: &Node) -> u8 {
        let has_vectors =
            cfg!(any(target_feature = "sse2", target_feature = "neon", target_feature = "simd128"));
        if has_vectors { self.all_at_once(node) } else { self.one_by_one(node) }
    }

    /// What [`all_at_once`](Self::all_at_once) answers, but for rounding, where one number at a time is
    /// reckoned with: most boxes are known to be missed by the first axis already.
    #[inline(always)]
    fn one_by_one(&self, node: &Node) -> u8 {
        let [ux, uy, uz] = self.direction.map(|axis| i32::from(axis.to_array()[0]));
        let [sx, sy, sz] = self.spread.map(|axis| i32::from(axis.to_array()[0]));
        let [centre_x, centre_y, centre_z] = node.centre.map(i32::from);
        // About the centre of the node, in 256ths of what the moments below are.
        let moment = |axis: usize, centre: i32| {
            let about = self.moment[axis].to_array()[0].wrapping_sub(centre) >> node.shift;
            about.clamp(-i32::from(i16::MAX), i32::from(i16::MAX)) << 8
        };
        let about_x = moment(0, centre_y * uz - centre_z * uy);
        let about_y = moment(1, centre_z * ux - centre_x * uz);
        let about_z = moment(2, centre_x * uy - centre_y * ux);
        let misses =
            |away: i32, about: i32, reach: i32| (away - about).abs() > reach + (i32::from(Self::SLACK) << 8);
        (0..WIDTH).fold(0, |crossed, lane| {
            let [[x, a], [y, b], [z, c]] = node.boxes.map(|axis| axis.map(|row| i32::from(row[lane])));
            let missed = misses(y * uz - z * uy, about_x, b * sz + c * sy)
                || misses(z * ux - x * uz, about_y, c * sx + a * sz)
                || misses(x * uy - y * ux, about_z, a * sy + b * sx);
            crossed | u8::from(!missed) << lane
        })
    }

    /// All boxes side by side.
    #[inline(always)]
    fn all_at_once(&self, node: &Node) -> u8 {
        let [[x, a], [y, b], [z, c]] = node.boxes.map(widen);
        let ([ux, uy, uz], [sx, sy, sz]) = (self.direction, self.spread);
        // About the centre of the node, in 128ths of its steps.
        let [centre_x, centre_y, centre_z] = node.centre;
        let centres = [pairs(centre_y, centre_z), pairs(centre_z, centre_x), pairs(centre_x, centre_y)];
        let moment = |axis: usize| {
            let about = (self.moment[axis] - centres[axis].dot(self.across[axis])) >> u32::from(node.shift);
            let [p, q, r, s] = about.to_array();
            i16x8::from_i32x8_saturate(i32x8::new([p, q, r, s, p, q, r, s]))
        };
        let times = i16x8::mul_keep_high;
        let beyond =
            |away: i16x8, reach: i16x8| away.max(i16x8::ZERO.saturating_sub(away)).saturating_sub(reach);
        let over_x =
            beyond((times(y, uz) - times(z, uy)).saturating_sub(moment(0)), times(b, sz) + times(c, sy));
        let over_y =
            beyond((times(z, ux) - times(x, uz)).saturating_sub(moment(1)), times(c, sx) + times(a, sz));
        let over_z =
            beyond((times(x, uy) - times(y, ux)).saturating_sub(moment(2)), times(a, sy) + times(b, sx));
        let misses = over_x.max(over_y).max(over_z).simd_gt(i16x8::splat(Self::SLACK)).to_bitmask();
        !misses.to_le_bytes()[0]
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;
    use crate::mesh::split::Bounds;

    /// A line that passes a point of a box may cross it, whatever the sizes of the box, its node and the
    /// mesh; a box that is far from the line is not crossed.
    fn no_box_is_left_out<T: Real>(stretch: [f64; 3]) {
        let stretch = Vector3::from(stretch);
        let mut random = Pcg64Mcg::seed_from_u64(9);
        let mut any = |size: f64| Vector3::from_fn(|_, _| random.random_range(-size..=size));
        let stretched = |v: Vector3<f64>| v.component_mul(&stretch).map(T::literal);
        let around = |middle: Vector3<f64>, half: Vector3<f64>| Bounds {
            low: stretched(middle - half),
            high: stretched(middle + half),
        };
        let grid = Grid::around(&around(Vector3::zeros(), Vector3::repeat(1.5)));
        for k in 0..10_000 {
            let size = 10_f64.powi(-(k % 6));
            let middle = any(1.5 - size);
            let mut node = Node::around(&around(middle, Vector3::repeat(size)), grid);
            let boxes: [_; WIDTH] =
                core::array::from_fn(|_| (middle + any(0.9 * size), any(0.1 * size).abs()));
            for (lane, (middle, half)) in boxes.iter().enumerate() {
                node.put(lane, &around(*middle, *half), grid);
            }
            let lane = k as usize % WIDTH;
            let aim = boxes[lane].0 + any(1.0).component_mul(&boxes[lane].1);
            let mut direction = any(1.0);
            if k % 7 == 0 {
                direction[k as usize % 3] = 0.0;
            }
            let along = direction.component_mul(&stretch).normalize();
            let aimed = aim.component_mul(&stretch);
            let start = aimed - along * along.dot(&aimed);
            let probe = Probe::new(grid, &start.map(T::literal), &along.map(T::literal));
            let far = |(middle, half): &(Vector3<f64>, Vector3<f64>)| {
                let away = middle - aim;
                let along = direction.normalize();
                (away - along * away.dot(&along)).norm() > 2.0 * half.norm() + 0.05 * size + 1e-3
            };
            for found in [probe.all_at_once(&node), probe.one_by_one(&node)] {
                assert!(found >> lane & 1 == 1, "{k}: {:?} {aim:?} {direction:?}", boxes[lane]);
                let false_alarms =
                    boxes.iter().enumerate().filter(|(lane, b)| found >> lane & 1 == 1 && far(b));
                assert_eq!(false_alarms.count(), 0, "{k}");
            }
        }
    }

    #[test]
    fn a_box_that_is_crossed_is_never_left_out() {
        for stretch in [[1.0, 0.9, 0.6], [1.0, 0.02, 0.4], [1e-3, 1.0, 1e-3]] {
            no_box_is_left_out::<f64>(stretch);
        }
        no_box_is_left_out::<f32>([1.0, 0.9, 0.6]);
        no_box_is_left_out::<f32>([1.0, 0.3, 0.4]);
        no_box_is_left_out::<f32>([1.0, 0.02, 0.4]);
    }

    #[test]
    fn an_empty_node_is_never_crossed() {
        let everything = Bounds { low: Vector3::repeat(-1.0), high: Vector3::repeat(1.0) };
        let grid = Grid::around(&everything);
        let mut random = Pcg64Mcg::seed_from_u64(10);
        for _ in 0..1000 {
            let direction = Vector3::from_fn(|_, _| random.random_range(-1.0_f64..1.0)).normalize();
            let probe = Probe::new(grid, &Vector3::zeros(), &direction);
            for node in [Node::around(&everything, grid), Node::EMPTY] {
                assert_eq!((probe.all_at_once(&node), probe.one_by_one(&node)), (0, 0));
            }
        }
    }
}
