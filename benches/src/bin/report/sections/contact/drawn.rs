//! Closed forms one wrench at a time beside columns of them, on shapes of many proportions: a single shape may
//! hide what its proportions spare.

use core::hint::black_box;

use fingertip_contact::batch::BatchSurface;
use fingertip_contact::{ContactModel, PointContact, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{
    ActiveSurface, CappedCylinder, Capsule, Cone, Cylinder, Ellipsoid, EllipticCylinder, Frustum, Paraboloid,
    Plane, RoundedBox, Sphere,
};
use fingertip_wrench::Real;

use super::columns::Columns;
use super::study::{SCALE, SPIN, Touch};
use crate::Failure;
use crate::draw::Drawn;
use crate::table::{Table, shown};
use crate::timing::{Effort, time};
use crate::wrenches::Random;

/// How many shapes of each kind are drawn.
const SHAPES: u64 = 8;

/// A shape and touches all over it.
type Touched<T, S> = (S, Columns<T>);

/// The shape is drawn in double precision, too, for its places.
fn touched<T: Real, S: Drawn, D: Drawn + ActiveSurface<f64>>(
    effort: Effort,
    seed: u64,
    spins: bool,
) -> Touched<T, S> {
    let (surface, ..) = S::draw(&mut Random::new(seed), SCALE);
    let mut random = Random::new(seed);
    let (exactly, ..) = D::draw(&mut random, SCALE);
    let size = 2.0 * SCALE;
    // No multiple of a page, whose columns would compete for the lines of the cache.
    let touches = (0..effort.choose(10, 120)).map(|_| {
        let (point, normal) = random.place(&exactly, 5.0 * SCALE);
        let force = random.force(&normal, 0.5, 2.0);
        let touch = Touch { point, force, normal, spin: SPIN * 2.0 * size * random.uniform(-1.0, 1.0) };
        (touch, touch.wrench(spins, 0.0, size, &mut random.0))
    });
    (surface, Columns::new(touches.collect(), size))
}

/// Median times of a contact \[ns\]: one by one, and in columns.
fn pace<T: Real, S, M: ContactModel<T, S>>(
    effort: Effort,
    model: &M,
    touched: &mut [Touched<T, S>],
    in_columns: impl Fn(&mut Columns<T>, &S),
) -> [f64; 2] {
    let items = touched.iter().map(|(_, columns)| columns.touches.len()).sum();
    let one_by_one = time(effort, items, || {
        for (surface, columns) in &*touched {
            for (_, wrench) in &columns.touches {
                black_box(&model.resolve(black_box(wrench), surface));
            }
        }
    });
    let in_columns = time(effort, items, || {
        touched.iter_mut().for_each(|(surface, columns)| in_columns(columns, surface));
    });
    [one_by_one, in_columns].map(|timed| timed.median)
}

/// Of a point contact, and of a soft finger with spin.
fn paces<T, S, D>(effort: Effort) -> Result<[[f64; 2]; 2], Failure>
where
    T: Real,
    S: Drawn + BatchSurface<T> + SoftFingerSurface<T>,
    D: Drawn + ActiveSurface<f64>,
{
    let (point, soft) = (PointContact::new(T::zero())?, SoftFinger::new(T::zero())?);
    let [mut without_spin, mut with_spin] = [false, true]
        .map(|spins| (0..SHAPES).map(|seed| touched::<T, S, D>(effort, seed, spins)).collect::<Vec<_>>());
    Ok([
        pace(effort, &point, &mut without_spin, |columns, surface| columns.point_contacts(surface)),
        pace(effort, &soft, &mut with_spin, |columns, surface| columns.soft_contacts(&soft, surface)),
    ])
}

/// A row for each convex closed form.
pub(super) fn in_columns(effort: Effort) -> Result<Table, Failure> {
    let mut table = Table::new(&[
        "shape",
        "point f32 ns",
        "in columns",
        "times",
        "point f64 ns",
        "in columns",
        "times",
        "soft f32 ns",
        "in columns",
        "times",
        "soft f64 ns",
        "in columns",
        "times",
    ]);
    macro_rules! rows {
        ($($name:literal $shape:ident),* $(,)?) => {
            $(
                let [point, soft] = paces::<f32, $shape<f32>, $shape<f64>>(effort)?;
                let [wide_point, wide_soft] = paces::<f64, $shape<f64>, $shape<f64>>(effort)?;
                let cells = [point, wide_point, soft, wide_soft]
                    .map(|[one_by_one, in_columns]| [one_by_one, in_columns, one_by_one / in_columns].map(shown));
                table.row([$name.to_owned()].into_iter().chain(cells.into_iter().flatten()));
            )*
        };
    }
    rows!(
        "plane" Plane,
        "sphere" Sphere,
        "ellipsoid" Ellipsoid,
        "paraboloid" Paraboloid,
        "cylinder" Cylinder,
        "elliptic cylinder" EllipticCylinder,
        "cone" Cone,
        "capped cylinder" CappedCylinder,
        "frustum" Frustum,
        "capsule" Capsule,
        "rounded box" RoundedBox,
    );
    Ok(table)
}
