//! What a surface is near a point, in its place.

use fingertip_surfaces::LocalSurface;
use fingertip_surfaces::numeric::twofold::Wide;
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_wrench::{Real, RigidTransform};
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::patch::{Digits, Seen, Three, Way, cross, dot, exactly, plus_times, rounded};
use super::three::unit;

/// The surface near a point, to the last digit, wherever it is.
///
/// ```
/// use fingertip_contact::{Patch, SoftFingerSurface};
/// use fingertip_surfaces::{Capsule, LocalSurface, Posed};
/// use fingertip_wrench::RigidTransform;
/// use nalgebra::Vector3;
///
/// // A capsule of 8 mm radius and 20 mm between its centres: a ball at its tip, a cylinder at its side.
/// let capsule = Capsule::new(Vector3::zeros(), Vector3::z(), 0.008, 0.01)?;
/// let tip: Patch = capsule.patch(&Vector3::new(0.0, 0.0, 0.018)).ok_or("not known")?;
/// let side = capsule.patch(&Vector3::new(0.008, 0.0, 0.0)).ok_or("not known")?;
/// assert!(matches!(tip.surface, LocalSurface::Ball { .. }) && matches!(side.surface, LocalSurface::Cone { .. }));
/// // 5 mm aside it is the same in its own frame.
/// let moved = Posed::new(capsule, RigidTransform::translation(Vector3::new(0.005, 0.0, 0.0)));
/// let of_moved = moved.patch(&Vector3::new(0.005, 0.0, 0.018)).ok_or("not known")?;
/// assert!(of_moved.surface == tip.surface && tip.pose.is_none() && of_moved.pose.is_some());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// What the surface is, in the frame of its shape.
    pub surface: LocalSurface,
    /// Where that frame is in the sensor's: the surface is that of the points which the transpose of the rotation
    /// takes to it, the origin taken off first. `None` where the two frames are one.
    pub pose: Option<RigidTransform<f64>>,
}

impl From<LocalSurface> for Patch {
    fn from(surface: LocalSurface) -> Self {
        Self { surface, pose: None }
    }
}

/// `Rᵀ v`.
fn turned_back<W: Wide>(pose: &RigidTransform<f64>, v: Three<W>) -> Three<W> {
    rows(&pose.rotation().transpose(), v)
}

/// `R v`.
fn turned_out<W: Wide>(pose: &RigidTransform<f64>, v: Three<W>) -> Three<W> {
    rows(&pose.rotation(), v)
}

/// `M v`. By the names of the entries: an index would be checked while it runs, where a compiler makes small code.
fn rows<W: Wide>(matrix: &Matrix3<f64>, v: Three<W>) -> Three<W> {
    let m = matrix;
    let row = |x: f64, y: f64, z: f64| dot([W::exactly(x), W::exactly(y), W::exactly(z)], v);
    [row(m.m11, m.m12, m.m13), row(m.m21, m.m22, m.m23), row(m.m31, m.m32, m.m33)]
}

/// What a pose of its shape, if it has one, makes of a patch.
pub(crate) fn placed<T: Real>(patch: Patch, pose: Option<&RigidTransform<T>>) -> Option<Patch> {
    let Some(pose) = pose else { return Some(patch) };
    // Of a pose of a pose nothing is told.
    let Patch { surface, pose: None } = patch else { return None };
    Some(Patch { surface, pose: Some(widely(pose)) })
}

/// The same numbers in double precision. A rotation that was stored in a narrower type stays orthogonal to the digits of
/// that type only.
pub(crate) fn widely<T: Real>(pose: &RigidTransform<T>) -> RigidTransform<f64> {
    let rotation = Rotation3::from_matrix_unchecked(pose.rotation().map(Real::to_f64));
    RigidTransform::from_parts(rotation, wide(&pose.origin()))
}

impl Patch {
    /// Force and torque in the frame of the shape under which it has the contact there: `Rᵀf` and
    /// `det R · R⁻¹(m − o × f)`, whatever the digits of `R` say (`docs/theory/contact.md#shapes-in-a-pose`).
    pub(super) fn load_inside<W: Wide>(&self, [f, m]: [Vector3<f64>; 2]) -> [Three<W>; 2] {
        let (force, torque) = (exactly(&f), exactly(&m));
        let Some(pose) = &self.pose else { return [force, torque] };
        let about = plus_times(torque, cross(exactly(&pose.origin()), force), W::exactly(-1.0));
        let r = pose.rotation();
        let [a, b, c] = [[r.m11, r.m21, r.m31], [r.m12, r.m22, r.m32], [r.m13, r.m23, r.m33]]
            .map(|column| column.map(W::exactly));
        // The adjugate of R has the cross products of its columns for rows.
        let torque = [dot(cross(b, c), about), dot(cross(c, a), about), dot(cross(a, b), about)];
        [turned_back(pose, force), torque]
    }

    /// A point, in the frame of the shape.
    pub(super) fn point_inside(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.pose.map_or(*point, |pose| pose.rotation().tr_mul(&(point - pose.origin())))
    }

    /// A point of the frame of the shape.
    pub(super) fn point_outside(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.pose.map_or(*point, |pose| pose.transform_point(point))
    }

    /// A direction, in the frame of the shape.
    pub(super) fn direction_inside(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        self.pose.map_or(*direction, |pose| pose.rotation().tr_mul(direction))
    }

    /// A direction of the frame of the shape.
    pub(super) fn direction_outside(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        self.pose.map_or(*direction, |pose| pose.rotate(direction))
    }
}

impl Digits for Patch {
    fn seen<W: Wide>(&self, point: Three<W>) -> Seen<W> {
        let Some(pose) = &self.pose else { return self.surface.seen(point) };
        let away = plus_times(point, exactly(&pose.origin()), W::exactly(-1.0));
        let seen = self.surface.seen(turned_back(pose, away));
        let (_, normal) = unit(turned_out(pose, seen.normal));
        let around = pose.rotation() * seen.around;
        let around = around - rounded(normal) * rounded(normal).dot(&around);
        Seen { normal, around: around.normalize(), ..seen }
    }

    fn left_by<W: Wide>(&self, point: Three<W>, way: &Vector3<f64>) -> Way {
        let Some(pose) = &self.pose else { return self.surface.left_by(point, way) };
        let away = plus_times(point, exactly(&pose.origin()), W::exactly(-1.0));
        self.surface.left_by(turned_back(pose, away), &pose.rotation().tr_mul(way))
    }
}
