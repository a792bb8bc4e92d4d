//! What does not change from sample to sample.

use nalgebra::Vector3;

use crate::Parameter;

/// What readers are told once: what is measured, and how it is drawn.
///
/// ```
/// use fingertip_bridges::{About, Hub};
///
/// let about =
///     About { source: "ati://192.168.1.1".to_owned(), frame: "thumb".to_owned(), ..About::default() };
/// // Every bridge of the hub tells its readers.
/// assert_eq!(Hub::new(about).about().frame, "thumb");
/// ```
#[derive(Clone, Debug, Default)]
pub struct About {
    /// Where samples come from, in words.
    pub source: String,
    /// The frame of wrenches and contacts.
    pub frame: String,
    /// Whether samples carry contacts.
    pub has_scene: bool,
    /// Whether samples carry verdicts on slip.
    pub watches_slip: bool,
    /// The coefficient of the friction limit, if it has one.
    pub coefficient: Option<f64>,
    /// The surface, if it can be drawn.
    pub surface: Net,
    /// Where the frame of the surface is \[m\].
    pub centre: Vector3<f64>,
    /// Its axes, the third one out of the fingertip.
    pub axes: [Vector3<f64>; 3],
    /// What the scene says, for tools that ask for it by name.
    pub parameters: Vec<Parameter>,
}

/// A surface as a net of points \[m\]: rows of `columns` points that close to a ring.
///
/// ```
/// use fingertip_bridges::Net;
/// use nalgebra::Vector3;
///
/// // A frustum: a ring of four corners, and a smaller one above it.
/// let ring = |half: f64, z: f64| {
///     [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
///         .map(|(x, y)| Some(Vector3::new(half * x, half * y, z)))
/// };
/// let net = Net { points: [ring(0.01, 0.0), ring(0.005, 0.02)].concat(), columns: 4 };
/// // Two triangles for each of four sides.
/// assert_eq!(net.triangles().count(), 8);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Net {
    /// Row after row; `None` where there is no surface.
    pub points: Vec<Option<Vector3<f64>>>,
    /// Points of a row.
    pub columns: usize,
}

impl Net {
    /// The triangles of the net, counter-clockwise seen from outside: two for each four points that are all there.
    pub fn triangles(&self) -> impl Iterator<Item = [Vector3<f64>; 3]> {
        let columns = self.columns.max(1);
        let at = move |row: usize, column: usize| {
            self.points.get(row * columns + column % columns).copied().flatten()
        };
        let places =
            (0..self.points.len() / columns).flat_map(move |row| (0..columns).map(move |c| (row, c)));
        places
            .filter_map(move |(row, c)| {
                let corners = [at(row, c)?, at(row + 1, c)?, at(row + 1, c + 1)?, at(row, c + 1)?];
                let [one, two, three, four] = corners;
                Some([[one, two, three], [one, three, four]])
            })
            .flatten()
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{PI, TAU};

    use nalgebra::Vector3;

    use super::Net;

    #[test]
    fn the_triangles_of_a_ball_have_its_area_and_look_outwards() {
        let (rows, columns) = (40, 80);
        let angles = (0..=rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let points = angles
            .map(|(row, column)| {
                let (polar, azimuth) =
                    (PI * f64::from(row) / f64::from(rows), TAU * f64::from(column) / f64::from(columns));
                let (sin, cos) = polar.sin_cos();
                Some(Vector3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos))
            })
            .collect();
        let mut net = Net { points, columns: 80 };
        let area = |net: &Net| {
            let across = |[a, b, c]: [Vector3<f64>; 3]| (b - a).cross(&(c - a)).dot(&(a + b + c).normalize());
            net.triangles().map(across).sum::<f64>() / 2.0
        };
        let whole = area(&net);
        assert!(whole < 4.0 * PI && whole > 0.99 * 4.0 * PI, "{whole}");
        // A point that is not there takes the four facets around it away.
        let count = net.triangles().count();
        net.points[20 * 80] = None;
        assert_eq!(net.triangles().count(), count - 8);
        assert_eq!(Net::default().triangles().count(), 0);
        assert_eq!(Net { points: vec![None; 3], columns: 0 }.triangles().count(), 0);
    }
}
