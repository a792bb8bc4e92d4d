//! Many samples at once, a column for each quantity.

use fingertip::Touches;
use fingertip::friction::SlipVerdict;
use fingertip_scene::NoWrench;
use nalgebra::Vector6;

use crate::border::{on, read, read_many, write_many};
use crate::fault::{Fault, ft_status};
use crate::load::ft_wrench;
use crate::tip::ft_tip;

/// Samples that are taken together: few enough for the stack and the nearest cache.
const BLOCK: usize = 128;

/// Columns of wrenches as the sensor reports them: forces in N, torques in N·m.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ft_wrench_columns {
    /// Force along x.
    pub fx: *const f64,
    /// Force along y.
    pub fy: *const f64,
    /// Force along z.
    pub fz: *const f64,
    /// Torque about x.
    pub tx: *const f64,
    /// Torque about y.
    pub ty: *const f64,
    /// Torque about z.
    pub tz: *const f64,
}

/// Where touches are written. A column that is NULL is left out.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ft_touch_columns {
    /// Where the environment touches, along x, in m; zero without contact, as all that follows.
    pub point_x: *mut f64,
    /// The same along y.
    pub point_y: *mut f64,
    /// The same along z.
    pub point_z: *mut f64,
    /// Normal force in N.
    pub normal_force: *mut f64,
    /// Tangential force on the fingertip along x, in N.
    pub tangential_x: *mut f64,
    /// The same along y.
    pub tangential_y: *mut f64,
    /// The same along z.
    pub tangential_z: *mut f64,
    /// Distance to the friction limit in N; zero without friction.
    pub margin: *mut f64,
    /// How much of the friction limit is used; zero without friction.
    pub utilisation: *mut f64,
    /// What the slip detector says, a byte each: the numbers of ft_slip.
    pub slip: *mut u8,
}

/// A column as bytes, to see whether it overlaps with another.
#[derive(Clone, Copy)]
struct Span {
    name: &'static str,
    start: usize,
    bytes: usize,
}

impl Span {
    fn of<V>(name: &'static str, column: *const V, count: usize) -> Self {
        Self { name, start: column.addr(), bytes: if column.is_null() { 0 } else { count * size_of::<V>() } }
    }

    fn overlaps(&self, other: &Self) -> bool {
        let ends = |span: &Self| span.start.saturating_add(span.bytes);
        self.bytes > 0 && other.bytes > 0 && self.start < ends(other) && other.start < ends(self)
    }
}

impl ft_wrench_columns {
    fn columns(&self) -> [(&'static str, *const f64); 6] {
        let names = ["fx", "fy", "fz", "tx", "ty", "tz"];
        let columns = [self.fx, self.fy, self.fz, self.tx, self.ty, self.tz];
        core::array::from_fn(|axis| (names[axis], columns[axis]))
    }
}

impl ft_touch_columns {
    fn numbers(&self) -> [(&'static str, *mut f64); 9] {
        [
            ("point_x", self.point_x),
            ("point_y", self.point_y),
            ("point_z", self.point_z),
            ("normal_force", self.normal_force),
            ("tangential_x", self.tangential_x),
            ("tangential_y", self.tangential_y),
            ("tangential_z", self.tangential_z),
            ("margin", self.margin),
            ("utilisation", self.utilisation),
        ]
    }

    /// That nothing is written over what is still to be read or was written. A column may be written where one is read,
    /// from the same start on: each block is read before it is written.
    fn check(&self, wrenches: &ft_wrench_columns, count: usize) -> Result<(), Fault> {
        let read = wrenches.columns().map(|(name, column)| Span::of(name, column, count));
        let mut written = [Span::of("slip", self.slip.cast_const(), count); 10];
        for (span, (name, column)) in written.iter_mut().zip(self.numbers()) {
            *span = Span::of(name, column.cast_const(), count);
        }
        for (index, to) in written.iter().enumerate() {
            let in_place = |from: &Span| from.start == to.start && from.bytes == to.bytes;
            let others = written.iter().skip(index + 1);
            let clash =
                others.chain(read.iter().filter(|from| !in_place(from))).find(|other| to.overlaps(other));
            if let Some(other) = clash {
                return Err(Fault::Overlap(to.name, other.name));
            }
        }
        Ok(())
    }
}

/// What a block of samples is read into and written from.
struct Block {
    wrenches: [[f64; BLOCK]; 6],
    numbers: [[f64; BLOCK]; 9],
    slip: [SlipVerdict; BLOCK],
}

impl Block {
    fn read(&mut self, columns: &ft_wrench_columns, start: usize, count: usize) -> Result<(), Fault> {
        for ((name, column), numbers) in columns.columns().into_iter().zip(&mut self.wrenches) {
            // Within the column, of which `start` and `count` samples more are the caller's.
            let from = if column.is_null() { column } else { column.wrapping_add(start) };
            *numbers = read_many(from, count, name, 0.0)?;
        }
        Ok(())
    }

    /// To the loads on the fingertip.
    fn load(&mut self, tip: &ft_tip, count: usize) {
        let [fx, fy, fz, tx, ty, tz] = &mut self.wrenches;
        let forces = fx.iter_mut().zip(fy).zip(fz);
        let torques = tx.iter_mut().zip(ty).zip(tz);
        for (((fx, fy), fz), ((tx, ty), tz)) in forces.zip(torques).take(count) {
            let reported = ft_wrench { force: [*fx, *fy, *fz], torque: [*tx, *ty, *tz] };
            let loaded: Vector6<f64> = tip.loaded(&reported).components();
            [*fx, *fy, *fz, *tx, *ty, *tz] = loaded.into();
        }
    }

    fn sense(&mut self, tip: &mut ft_tip, time_step: f64, count: usize) {
        let wrenches = self.wrenches.each_ref().map(|column| column.get(..count).unwrap_or_default());
        let numbers = self.numbers.each_mut().map(|column| column.get_mut(..count).unwrap_or_default());
        let [x, y, z, normal_force, sx, sy, sz, margin, utilisation] = numbers;
        let touches = Touches {
            point: [x, y, z],
            normal_force,
            tangential_force: [sx, sy, sz],
            margin,
            utilisation,
            slip: self.slip.get_mut(..count).unwrap_or_default(),
        };
        tip.pipeline.sense_all(wrenches, time_step, touches);
    }

    fn write(&self, touches: &ft_touch_columns, start: usize, count: usize) {
        for ((_, column), numbers) in touches.numbers().into_iter().zip(&self.numbers) {
            if !column.is_null() {
                write_many(column.wrapping_add(start), numbers.get(..count).unwrap_or_default());
            }
        }
        if !touches.slip.is_null() {
            let bytes = self.slip.map(|verdict| crate::ft_slip::of(verdict) as u8);
            write_many(touches.slip.wrapping_add(start), bytes.get(..count).unwrap_or_default());
        }
    }
}

/// As ft_sense_wrench of `count` wrenches, one behind the other in time, `time_step` seconds apart. Allocates nothing.
///
/// No column of the touches may overlap with another one; it may lie where a column of the wrenches does, from the same
/// start on. Scenes of a point contact with Coulomb friction and the threshold detector run in vectors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_sense_all(
    tip: *mut ft_tip,
    wrenches: *const ft_wrench_columns,
    count: usize,
    time_step: f64,
    touches: *const ft_touch_columns,
) -> ft_status {
    on(tip, |tip| {
        let (wrenches, touches) = (read(wrenches, "wrenches")?, read(touches, "touches")?);
        if tip.pipeline.carried().is_some() {
            return Err(NoWrench::NoMotion.into());
        }
        if count > isize::MAX as usize / size_of::<f64>() {
            return Err(Fault::Number { name: "count", requirement: "no more than memory can hold" });
        }
        if let Some((name, _)) = wrenches.columns().into_iter().find(|(_, column)| column.is_null()) {
            return Err(Fault::Null(name));
        }
        touches.check(&wrenches, count)?;
        let mut block = Block {
            wrenches: [[0.0; BLOCK]; 6],
            numbers: [[0.0; BLOCK]; 9],
            slip: [SlipVerdict::NotPressing; BLOCK],
        };
        for start in (0..count).step_by(BLOCK) {
            let size = BLOCK.min(count - start);
            block.read(&wrenches, start, size)?;
            block.load(tip, size);
            block.sense(tip, time_step, size);
            block.write(&touches, start, size);
        }
        Ok(())
    })
}
