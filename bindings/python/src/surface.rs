//! `fingertip.Surface`.

use fingertip::surfaces::{ActiveSurface, ClosestApproach, Corner, DynSurface, Extent, Level, SmoothSurface};
use fingertip::wrench::Line;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::numbers;
use crate::sections::{self, document};
use crate::{errors, value};

/// The part of a fingertip that may touch: any shape that a scene can have, by the same keys.
///
/// Parameters
/// ----------
/// shape : str
///     Its name: see `Scene.choices`.
/// **parameters
///     What the section `[surface]` of a scene would hold, with the units in the names.
///
/// Examples
/// --------
/// >>> from fingertip import Surface
/// >>> ball = Surface("sphere", radius_m=0.013)
/// >>> [round(along, 3) for along, _, _, _ in ball.crossings([0, 0, 0.05], [0, 0, -1])]
/// [0.037, 0.063]
/// >>> ball.contains([0.0, 0.0, 0.012])
/// True
#[pyclass(name = "Surface", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PySurface {
    surface: DynSurface<f64>,
    /// The scene that it is of, to be made anew from.
    scene: String,
}

impl PySurface {
    pub(crate) fn of_scene(surface: DynSurface<f64>, scene: &str) -> Self {
        Self { surface, scene: scene.to_owned() }
    }

    fn of_text(scene: String) -> PyResult<Self> {
        Ok(Self { surface: sections::scene(&scene)?.surface().clone(), scene })
    }

    pub(crate) const fn surface(&self) -> &DynSurface<f64> {
        &self.surface
    }

    /// The text of a scene of this surface in its pose, and of other sections.
    pub(crate) fn scene_with(&self, sections: &str) -> PyResult<String> {
        let parse = |text: &str| text.parse::<toml::Table>().map_err(errors::scene);
        let (mut scene, own) = (parse(sections)?, parse(&self.scene)?);
        for key in ["surface", "pose"] {
            if let Some(section) = own.get(key) {
                scene.insert(key.to_owned(), section.clone());
            }
        }
        toml::to_string(&scene).map_err(errors::scene)
    }
}

/// Distance along the line [m], point [m], outward normal, and whether the point may touch.
type PyCrossing<'py> = (f64, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, bool);

/// Value, gradient and Hessian.
type PyLevel<'py> = (f64, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>);

/// A line through a point along a direction of any length.
pub(crate) fn line(point: &Bound<'_, PyAny>, direction: &Bound<'_, PyAny>) -> PyResult<Line<f64>> {
    let (point, direction) = (numbers::three(point, "point")?, numbers::three(direction, "direction")?);
    let unit = direction.try_normalize(0.0).filter(|unit| unit.iter().all(|x| x.is_finite()));
    let direction = unit.ok_or_else(|| errors::bad("`direction` must be finite and not zero"))?;
    Ok(Line { point, direction })
}

#[pymethods]
impl PySurface {
    #[new]
    #[pyo3(signature = (shape, **parameters))]
    fn new(shape: &str, parameters: Option<&Bound<'_, PyDict>>, py: Python<'_>) -> PyResult<Self> {
        let sections = PyDict::new(py);
        let section = parameters.map_or_else(|| Ok(PyDict::new(py)), Bound::copy)?;
        section.set_item("shape", shape)?;
        sections.set_item("surface", section)?;
        Self::of_text(document(&sections)?)
    }

    /// A shape that a function of Python describes: see `formula`.
    ///
    /// Parameters
    /// ----------
    /// outside : callable
    ///     Takes the coordinates x, y, z [m]; positive outside of the body, negative inside.
    /// reach_m : float
    ///     Radius of a ball around the whole shape [m].
    /// centre_m : array_like, shape (3,), optional
    ///     Its centre [m].
    /// convex : bool, optional
    ///     Whether the shape is known to be convex, which makes soft fingers much faster.
    /// steepest_per_m : float, optional
    ///     No gradient of the function in the ball is longer [1/m]; needed only where it takes the root of zero, or
    ///     divides by zero, on the surface.
    ///
    /// Examples
    /// --------
    /// >>> from fingertip import Surface
    /// >>> def pillow(x, y, z):
    /// ...     return (x / 0.01) ** 4 + (y / 0.01) ** 4 + (z / 0.01) ** 4 - 1
    /// >>> surface = Surface.from_function(pillow, reach_m=0.0132)
    /// >>> surface.contains([0.0, 0.0, 0.0099]), surface.contains([0.0, 0.0, 0.0101])
    /// (True, False)
    #[staticmethod]
    #[pyo3(signature = (outside, *, reach_m, centre_m=None, convex=false, steepest_per_m=None))]
    fn from_function(
        outside: &Bound<'_, PyAny>,
        reach_m: f64,
        centre_m: Option<&Bound<'_, PyAny>>,
        convex: bool,
        steepest_per_m: Option<f64>,
    ) -> PyResult<Self> {
        let py = outside.py();
        let parameters = PyDict::new(py);
        let written = py.import("fingertip._formula")?.getattr("formula")?.call1((outside,))?;
        parameters.set_item("outside", written)?;
        parameters.set_item("reach_m", reach_m)?;
        if let Some(centre) = centre_m {
            parameters.set_item("centre_m", numbers::three(centre, "centre_m")?.as_slice().to_vec())?;
        }
        parameters.set_item("convex", convex)?;
        if let Some(steepest) = steepest_per_m {
            parameters.set_item("steepest_per_m", steepest)?;
        }
        Self::new("formula", Some(&parameters), py)
    }

    /// Every place where a line passes through the shape.
    ///
    /// Parameters
    /// ----------
    /// point : array_like, shape (3,)
    ///     A point of the line [m].
    /// direction : array_like, shape (3,)
    ///     Along it, of any length.
    ///
    /// Returns
    /// -------
    /// list of tuple
    ///     Distance from the point along the line [m], the place [m], the outward normal, and whether it may touch.
    fn crossings<'py>(
        &self,
        py: Python<'py>,
        point: &Bound<'py, PyAny>,
        direction: &Bound<'py, PyAny>,
    ) -> PyResult<Vec<PyCrossing<'py>>> {
        let mut found = Vec::new();
        self.surface.crossings(&line(point, direction)?, |crossing| found.push(crossing));
        found.sort_by(|a, b| a.along.total_cmp(&b.along));
        let of = |c: &fingertip::surfaces::Crossing<f64>| {
            (c.along, numbers::array(py, &c.point), numbers::array(py, &c.normal), c.active)
        };
        Ok(found.iter().map(of).collect())
    }

    /// The place closest to a line that misses: how far [m], where [m], the outward normal, and whether it may touch.
    /// `None` if the shape does not know.
    fn closest_approach<'py>(
        &self,
        py: Python<'py>,
        point: &Bound<'py, PyAny>,
        direction: &Bound<'py, PyAny>,
    ) -> PyResult<Option<PyCrossing<'py>>> {
        let closest = self.surface.closest_approach(&line(point, direction)?);
        Ok(closest.map(|ClosestApproach { gap, point, normal, active }| {
            (gap, numbers::array(py, &point), numbers::array(py, &normal), active)
        }))
    }

    /// Outward unit normal at a point of the shape.
    fn normal<'py>(&self, py: Python<'py>, point: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(numbers::array(py, &self.surface.normal(&numbers::three(point, "point")?)))
    }

    /// Whether a point lies within the shape.
    fn contains(&self, point: &Bound<'_, PyAny>) -> PyResult<bool> {
        Ok(self.surface.contains(&numbers::three(point, "point")?))
    }

    /// How fast the normal changes along the shape [1/m]: the shape operator, a matrix of 3 × 3.
    fn shape_operator<'py>(
        &self,
        py: Python<'py>,
        point: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        Ok(numbers::array2(py, &self.surface.shape_operator(&numbers::three(point, "point")?)))
    }

    /// The level function whose zero is the shape: its value, gradient and Hessian at a point.
    fn level<'py>(&self, py: Python<'py>, point: &Bound<'py, PyAny>) -> PyResult<PyLevel<'py>> {
        let Level { value, gradient, hessian } = self.surface.level(&numbers::three(point, "point")?);
        Ok((value, numbers::array(py, &gradient), numbers::array2(py, &hessian)))
    }

    /// Centre [m] and radius [m] of a ball around the part of the shape that matters.
    fn extent<'py>(&self, py: Python<'py>) -> (Bound<'py, PyArray1<f64>>, f64) {
        let Extent { centre, radius } = self.surface.extent();
        (numbers::array(py, &centre), radius)
    }

    /// Where the normal turns though the point stays: `None` on a smooth place; along an edge its direction and how it
    /// bends [1/m]; at a tip no direction.
    fn corner<'py>(
        &self,
        py: Python<'py>,
        point: &Bound<'py, PyAny>,
        normal: &Bound<'py, PyAny>,
    ) -> PyResult<Option<(Option<Bound<'py, PyArray1<f64>>>, f64)>> {
        let (point, normal) = (numbers::three(point, "point")?, numbers::three(normal, "normal")?);
        Ok(self.surface.corner(&point, &normal).map(|corner| match corner {
            Corner::Edge { direction, bend } => (Some(numbers::array(py, &direction)), bend),
            Corner::Tip => (None, f64::INFINITY),
        }))
    }

    #[staticmethod]
    fn _from_bytes(bytes: &[u8]) -> PyResult<Self> {
        let text: String = value::from_bytes(bytes)?;
        Self::of_text(text)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<value::Reduced<'py>> {
        value::reduced(slf.as_any(), &slf.get().scene)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().surface == self.surface)
    }

    fn __repr__(&self) -> String {
        let shape = self.scene.parse::<toml::Table>().ok().and_then(|scene| scene.get("surface").cloned());
        format!("<fingertip.Surface {}>", shape.map_or_else(String::new, |shape| shape.to_string()))
    }
}
