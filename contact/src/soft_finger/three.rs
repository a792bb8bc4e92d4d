//! Vectors with more digits than a number has.

use fingertip_surfaces::numeric::twofold::Wide;
use nalgebra::Vector3;

pub(crate) type Three<W> = [W; 3];

pub(crate) fn exactly<W: Wide>(v: &Vector3<f64>) -> Three<W> {
    [W::exactly(v.x), W::exactly(v.y), W::exactly(v.z)]
}

pub(crate) fn rounded<W: Wide>(v: Three<W>) -> Vector3<f64> {
    Vector3::from(v.map(W::rounded))
}

#[inline(never)]
pub(crate) fn dot<W: Wide>(a: Three<W>, b: Three<W>) -> W {
    a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
}

/// `a + b·t`.
#[inline(never)]
pub(crate) fn plus_times<W: Wide>(a: Three<W>, b: Three<W>, t: W) -> Three<W> {
    [a[0].plus(b[0].times(t)), a[1].plus(b[1].times(t)), a[2].plus(b[2].times(t))]
}

pub(crate) fn cross<W: Wide>(a: Three<W>, b: Three<W>) -> Three<W> {
    let part = |i: usize, j: usize| a[i].times(b[j]).minus(a[j].times(b[i]));
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// A vector's length, and the unit vector along it.
pub(super) fn unit<W: Wide>(v: Three<W>) -> (W, Three<W>) {
    let length = dot(v, v).root();
    (length, v.map(|x| x.over(length)))
}
