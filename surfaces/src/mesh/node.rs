//! A node of the tree: the boxes around its children.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::split::Bounds;

/// Children of a node.
pub(super) const WIDTH: usize = 8;
/// Marks a child that is a packet, in the highest bit of its index.
pub(super) const LEAF: u32 = 1 << 31;

/// The whole numbers in which boxes and lines are expressed: steps from the origin of the mesh. Along the
/// axes of a mesh that is narrow they differ: lines stay lines and boxes stay boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// Steps in a unit of the stored vertices.
    steps_per_unit: Vector3<f64>,
    /// Whether these are the same along all axes.
    pub(super) is_even: bool,
    /// What boxes are wider than what is in them, in steps, on each side.
    margin: Vector3<f64>,
}

impl Grid {
    /// Steps to the farthest side of the box around the mesh: so many that the moment of a line, in steps
    /// times [`Probe::UNIT`](super::probe::Probe::UNIT), keeps within 32 bits.
    const EXTENT: f64 = 20_000.0;
    /// A line whose direction is rounded to a [`UNIT`](super::probe::Probe::UNIT)th leaves its place by
    /// half that times the distance from where it is known, and none within the mesh is greater than twice
    /// the mesh's radius: 2·√3·20000/2/32767. In single precision the half may be 32767/2²³ more.
    const LEAVE: f64 = 1.07;
    /// Epsilons of the mesh's size that all rounding in the test on a triangle is below, and in what a line
    /// is on the grid.
    const ROUNDINGS: f64 = 64.0;

    /// That of a mesh which lies in a box.
    pub(super) fn around<T: Real>(bounds: &Bounds<T>) -> Self {
        let extents = bounds.low.abs().sup(&bounds.high.abs()).map(Real::to_f64);
        let greatest = extents.max();
        let is_even = extents.min() >= 0.5 * greatest;
        let steps_per_unit = extents.map(|extent| Self::EXTENT / if is_even { greatest } else { extent });
        let rounding = Self::ROUNDINGS * T::EPSILON.to_f64() * greatest;
        Self { steps_per_unit, is_even, margin: (steps_per_unit * rounding).add_scalar(Self::LEAVE) }
    }

    /// In steps, if these are the same along all axes.
    #[inline]
    pub(super) fn in_steps<T: Real>(&self, of: &Vector3<T>) -> Vector3<T> {
        of * T::literal(self.steps_per_unit.x)
    }

    /// In steps.
    #[inline]
    pub(super) fn steps<T: Real>(&self, of: &Vector3<T>) -> Vector3<f64> {
        of.map(Real::to_f64).component_mul(&self.steps_per_unit)
    }
}

/// Boxes of the children side by side, rounded outward to bytes: so a node fills one line of a usual cache,
/// whatever the precision of the mesh. Boxes only have to be certain to contain the triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// For each axis, the centres relative to the node's, then half the extents; these are negative where
    /// there is no child. In steps of the node.
    pub(super) boxes: [[[i8; WIDTH]; 2]; 3],
    /// Index of a child that is a node, less its lane.
    pub(super) node: u32,
    /// Index of a child that is a packet, less its lane.
    pub(super) packet: u32,
    /// Centre, in steps of the grid.
    pub(super) centre: [i16; 3],
    /// Bits by which a step of the node is longer than [`FINEST`](Self::FINEST) of a step of the grid.
    pub(super) shift: u8,
    /// A bit for each child that is a node.
    pub(super) nodes: u8,
}

const _: () = assert!(size_of::<Node>() == 64);

#[allow(clippy::cast_possible_truncation)]
fn round(x: f64) -> f64 {
    f64::from((x + 0.5_f64.copysign(x)) as i32)
}

impl Node {
    /// The shortest step of a node, in steps of the grid.
    const FINEST: f64 = 1.0 / 256.0;
    /// Steps of a node from its centre to its farthest side, at most: two less than what a number can hold,
    /// since a centre and an extent may both be rounded away from zero.
    const REACH: f64 = 125.0;

    pub(super) const EMPTY: Self = Self {
        boxes: [[[0; WIDTH], [i8::MIN; WIDTH]]; 3],
        node: 0,
        packet: 0,
        centre: [0; 3],
        shift: 0,
        nodes: 0,
    };

    /// Without children yet, for such as lie in a box.
    pub(super) fn around<T: Real>(bounds: &Bounds<T>, grid: Grid) -> Self {
        let mut node = Self::EMPTY;
        let (low, high) = (grid.steps(&bounds.low), grid.steps(&bounds.high));
        let centre = ((low + high) * 0.5).map(round);
        #[allow(clippy::cast_possible_truncation)]
        {
            node.centre = centre.map(|x| x as i16).into();
        }
        let reach = ((high - centre).sup(&(centre - low)) + grid.margin).max();
        while node.step() * Self::REACH < reach && node.shift < 31 {
            node.shift += 1;
        }
        node
    }

    /// In steps of the grid.
    fn step(&self) -> f64 {
        f64::from(1_u32 << self.shift) * Self::FINEST
    }

    /// Puts a box in its place.
    pub(super) fn put<T: Real>(&mut self, lane: usize, bounds: &Bounds<T>, grid: Grid) {
        let step = self.step();
        let centre = Vector3::from(self.centre.map(f64::from));
        let (low, high) = (grid.steps(&bounds.low) - centre, grid.steps(&bounds.high) - centre);
        for (axis, [centres, halves]) in self.boxes.iter_mut().enumerate() {
            let middle = round((low[axis] + high[axis]) * 0.5 / step);
            let half = (high[axis] - middle * step).max(middle * step - low[axis]) + grid.margin[axis];
            if let (Some(c), Some(h)) = (centres.get_mut(lane), halves.get_mut(lane)) {
                #[allow(clippy::cast_possible_truncation)]
                {
                    (*c, *h) = (middle as i8, ((half / step) as i8).saturating_add(1));
                }
            }
        }
    }

    /// Each child with its lane: a node, or else a packet.
    pub(super) fn children(&self) -> impl Iterator<Item = (usize, Result<u32, u32>)> + '_ {
        let [[_, halves], ..] = &self.boxes;
        (0..WIDTH).zip(0..).filter(|(k, _)| halves.get(*k).is_some_and(|half| *half >= 0)).map(|(k, lane)| {
            let is_node = self.nodes >> lane & 1 == 1;
            let child = if is_node { Ok(self.node) } else { Err(self.packet) };
            let at = |first: u32| first.wrapping_add(lane);
            (k, child.map(at).map_err(at))
        })
    }

    /// Each child, with centre and radius of the ball around its box.
    pub(super) fn balls<T: Real>(&self, grid: Grid) -> impl Iterator<Item = (u32, Vector3<T>, T)> + '_ {
        let unit = grid.steps_per_unit.map(|steps| 1.0 / steps);
        let centre = Vector3::from(self.centre.map(f64::from)).component_mul(&unit);
        let step = unit * self.step();
        (0..WIDTH).zip(0..).filter_map(move |(k, lane)| {
            let [x, y, z] =
                self.boxes.each_ref().map(|axis| axis.map(|row| row.get(k).map_or(0.0, |x| f64::from(*x))));
            let half = Vector3::new(x[1], y[1], z[1]).component_mul(&step);
            let child = if self.nodes >> lane & 1 == 1 {
                self.node.wrapping_add(lane)
            } else {
                self.packet.wrapping_add(lane) | LEAF
            };
            (half.x >= 0.0).then(|| {
                let middle = centre + Vector3::new(x[0], y[0], z[0]).component_mul(&step);
                (child, middle.map(T::literal), T::literal(half.norm_squared()).root())
            })
        })
    }
}
