//! `fingertip.ContactModel`: one wrench at a time, and what a small change of it does.

use fingertip::contact::{
    Choice, ContactBound, ContactJacobian, ContactModel, ConvexBound, PaperBounds, WorstCase, WorstErrors,
};
use fingertip::contact::{
    ContactCovariance, GeometrySensitivity, GeometryUncertainty, PitchTest, Resolution,
};
use fingertip::surfaces::{DynSurface, SmoothSurface};
use fingertip::wrench::Wrench;
use fingertip_scene::Model;
use nalgebra::{Matrix3, Vector6};
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArray3, PyArrayLike2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::contact::{PyContact, resolution};
use crate::scene::PyScene;
use crate::sections::document;
use crate::surface::PySurface;
use crate::{errors, numbers, value};

/// A contact model on a surface, without memory: where a wrench touches, and how that answers to small changes.
///
/// Parameters
/// ----------
/// surface : Surface
/// model : str, optional
///     "point", "soft_finger" or "auto": see `Scene.choices`.
/// **parameters
///     What the section `[contact]` of a scene would hold, a `skin` as a dictionary.
///
/// Examples
/// --------
/// >>> from fingertip import ContactModel, Surface
/// >>> model = ContactModel(Surface("sphere", radius_m=0.013), "soft_finger")
/// >>> contact = model.resolve([0.0, 0.0, -1.0, 0.0, 0.0, 1e-3])
/// >>> round(contact.spin_torque, 6)
/// 0.001
#[pyclass(name = "ContactModel", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyModel {
    model: Model<f64>,
    surface: DynSurface<f64>,
    scene: String,
}

impl PyModel {
    fn of(text: String) -> PyResult<Self> {
        let scene = PyScene::from_text(text)?;
        let pipeline = scene.scene().pipeline();
        Ok(Self {
            model: pipeline.model().clone(),
            surface: pipeline.surface().clone(),
            scene: scene.text().to_owned(),
        })
    }
}

impl PyModel {
    /// Point, normal, normal force and spin torque of a wrench, and their derivatives row by row; both are left as they
    /// are where there is none.
    fn differentiate(&self, wrench: &Wrench<f64>, touch: &mut [f64], jacobian: &mut [f64]) {
        let found = self.model.resolve_near(wrench, &self.surface, None);
        let Resolution::Contact(contact) = found else { return };
        let values = contact.point.iter().chain(&contact.normal);
        let values = values.copied().chain([contact.normal_force(), contact.spin_torque]);
        touch.iter_mut().zip(values).for_each(|(to, value)| *to = value);
        let found = self.model.jacobian(&contact, wrench, &self.surface, None);
        let Some(derivatives) = found else { return };
        let (point, normal, local) = (derivatives.point(), derivatives.normal_change(), derivatives.local());
        let rows = point.row_iter().chain(normal.row_iter()).map(|row| row.clone_owned());
        let rows = rows.chain([2, 5].map(|of| local.row(of).clone_owned()));
        for (to, row) in jacobian.chunks_exact_mut(6).zip(rows) {
            to.iter_mut().zip(&row).for_each(|(to, value)| *to = *value);
        }
    }
}

fn wrench(given: &Bound<'_, PyAny>) -> PyResult<Wrench<f64>> {
    Ok(Wrench::from_components(&numbers::numbers(given, "wrench")?.into()))
}

#[pymethods]
impl PyModel {
    #[new]
    #[pyo3(signature = (surface, model="point", **parameters))]
    fn new(
        surface: &PySurface,
        model: &str,
        parameters: Option<&Bound<'_, PyDict>>,
        py: Python<'_>,
    ) -> PyResult<Self> {
        let contact = parameters.map_or_else(|| Ok(PyDict::new(py)), Bound::copy)?;
        contact.set_item("model", model)?;
        let sections = PyDict::new(py);
        // The noise of a model that weighs evidence stands in a section of its own.
        let noise = PyDict::new(py);
        for key in ["force_noise_N", "torque_noise_Nm"] {
            if let Some(deviation) = contact.get_item(key)? {
                contact.del_item(key)?;
                noise.set_item(key, deviation)?;
            }
        }
        if !noise.is_empty() {
            sections.set_item("uncertainty", noise)?;
        }
        sections.set_item("contact", contact)?;
        Self::of(surface.scene_with(&document(&sections)?)?)
    }

    /// Where a wrench touches, or why it does not: a `Contact` or a `NoContact`.
    ///
    /// Parameters
    /// ----------
    /// wrench : array_like, shape (6,)
    ///     On the fingertip [N, N·m].
    /// last : array_like, shape (3,), optional
    ///     The contact of the sample before [m], for shapes that are not convex.
    #[pyo3(signature = (wrench, last=None))]
    fn resolve(&self, wrench: &Bound<'_, PyAny>, last: Option<&Bound<'_, PyAny>>) -> PyResult<Py<PyAny>> {
        let last = last.map(|last| numbers::three(last, "last")).transpose()?;
        resolution(wrench.py(), self.model.resolve_near(&self::wrench(wrench)?, &self.surface, last.as_ref()))
    }

    /// The derivatives of a contact that `resolve` found in a wrench; `None` where it has none, as at grazing.
    #[pyo3(signature = (contact, wrench, last=None))]
    fn jacobian(
        &self,
        contact: &PyContact,
        wrench: &Bound<'_, PyAny>,
        last: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Option<PyJacobian>> {
        let last = last.map(|last| numbers::three(last, "last")).transpose()?;
        let found = self.model.jacobian(&contact.0, &self::wrench(wrench)?, &self.surface, last.as_ref());
        Ok(found.map(PyJacobian))
    }

    /// Where many wrenches touch, each for itself, and how that answers to small changes: what a gradient descends by.
    ///
    /// Parameters
    /// ----------
    /// wrenches : array_like, shape (n, 6)
    ///     On the fingertip [N, N·m].
    ///
    /// Returns
    /// -------
    /// touch : ndarray, shape (n, 8)
    ///     The point [m], the outward normal, the normal force [N] and the spin torque [N·m] of each contact; NaN of a
    ///     wrench that touches nothing.
    /// jacobian : ndarray, shape (n, 8, 6)
    ///     Their derivatives by the components of the wrench; NaN where there is none, as at grazing.
    ///
    /// Examples
    /// --------
    /// >>> from fingertip import ContactModel, Surface
    /// >>> model = ContactModel(Surface("sphere", radius_m=0.013))
    /// >>> touch, jacobian = model.touch_and_jacobian([[0, 0, -1.0, 0, 0, 0], [0, 0, 1.0, 0, 0, 0]])
    /// >>> touch[0, :3].tolist(), jacobian.shape
    /// ([0.0, 0.0, 0.013], (2, 8, 6))
    fn touch_and_jacobian<'py>(
        &self,
        wrenches: &Bound<'py, PyAny>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray3<f64>>)> {
        let py = wrenches.py();
        let bad =
            || errors::bad(format!("`wrenches` must have the shape (n, 6), not {}", numbers::kind(wrenches)));
        let given: PyArrayLike2<'py, f64, AllowTypeChange> = wrenches.extract().map_err(|_| bad())?;
        let given = given.as_array();
        let rows = given.nrows();
        if given.ncols() != 6 {
            return Err(errors::bad(format!("`wrenches` must have 6 columns, not {}", given.ncols())));
        }
        let (mut touch, mut jacobian) = (vec![f64::NAN; 8 * rows], vec![f64::NAN; 48 * rows]);
        py.detach(|| {
            let places = touch.chunks_exact_mut(8).zip(jacobian.chunks_exact_mut(48));
            for (wrench, (touch, jacobian)) in given.rows().into_iter().zip(places) {
                let wrench = Wrench::from_components(&Vector6::from_iterator(wrench.iter().copied()));
                self.differentiate(&wrench, touch, jacobian);
            }
        });
        Ok((
            PyArray1::from_vec(py, touch).reshape([rows, 8])?,
            PyArray1::from_vec(py, jacobian).reshape([rows, 8, 6])?,
        ))
    }

    /// Of the model "auto": what speaks for a torque of the contact's own. The name of what it chooses ("point",
    /// "soft_finger"), and the pitch of the wrench [m] with its standard deviation; `None` of other models.
    fn choice(&self, wrench: &Bound<'_, PyAny>) -> PyResult<Option<(&'static str, f64, f64)>> {
        let Model::Auto(auto) = &self.model else { return Ok(None) };
        let test: Option<PitchTest<f64>> = auto.test(&self::wrench(wrench)?);
        Ok(test.map(|test| {
            let name = match test.choice {
                Choice::SoftFinger => "soft_finger",
                _ => "point",
            };
            (name, test.pitch, test.deviation)
        }))
    }

    /// How far the point of a point contact on a convex surface may be off at most, with all its rounding [m]; `None`
    /// where nothing bounds it.
    ///
    /// Parameters
    /// ----------
    /// wrench : array_like, shape (6,)
    /// force_error, torque_error : float
    ///     Greatest error of the force [N] and of the torque [N·m].
    /// shape_error, place_error : float, optional
    ///     By how much the shape may be larger or smaller, and be elsewhere [m].
    #[pyo3(signature = (wrench, force_error, torque_error, shape_error=0.0, place_error=0.0))]
    fn worst_distance(
        &self,
        wrench: &Bound<'_, PyAny>,
        force_error: f64,
        torque_error: f64,
        shape_error: f64,
        place_error: f64,
    ) -> PyResult<Option<f64>> {
        let mut worst = WorstErrors::of_wrench(force_error, torque_error);
        (worst.radius, worst.centre) = (shape_error, place_error);
        let extent = self.surface.extent();
        let reach = extent.centre.norm() + extent.radius;
        let bound = ConvexBound::new(&self.surface, &self::wrench(wrench)?, &worst, reach);
        Ok(bound.map(ContactBound::from).map(|bound| bound.distance))
    }

    #[staticmethod]
    fn _from_bytes(bytes: &[u8]) -> PyResult<Self> {
        Self::of(value::from_bytes(bytes)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<value::Reduced<'py>> {
        value::reduced(slf.as_any(), &slf.get().scene)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let same = |other: &Self| other.model == self.model && other.surface == self.surface;
        other.cast::<Self>().is_ok_and(|other| same(other.get()))
    }
}

/// The first derivatives of a contact with respect to the wrench.
#[pyclass(name = "ContactJacobian", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyJacobian(pub(crate) ContactJacobian<f64>);

/// Variances of the geometry, the same in all directions.
fn geometry(offset: f64, position: f64, attitude: f64) -> PyResult<GeometryUncertainty<f64>> {
    let same = |deviation: f64| Matrix3::identity() * (deviation * deviation);
    let of = GeometryUncertainty {
        offset: offset * offset,
        position: same(position),
        attitude: same(attitude),
        ..GeometryUncertainty::none()
    };
    of.checked().map_err(errors::shape)
}

#[pymethods]
impl PyJacobian {
    /// Two unit vectors in the tangent plane, right-handed with the normal.
    #[getter]
    fn tangents<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 2] {
        self.0.tangents().map(|tangent| numbers::array(py, &tangent))
    }

    /// Of the position along the tangents [m], normal force, tangential forces [N] and spin torque [N·m], shape (6, 6).
    #[getter]
    fn local<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        numbers::array2(py, &self.0.local())
    }

    /// Of the point [m], shape (3, 6).
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        numbers::array2(py, &self.0.point())
    }

    /// Of the outward normal, shape (3, 6).
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        numbers::array2(py, &self.0.normal_change())
    }

    /// What noise makes of the contact, to first order.
    ///
    /// Parameters
    /// ----------
    /// wrench : array_like, shape (6, 6)
    ///     Covariance of the wrench.
    /// offset, position, attitude : float, optional
    ///     Standard deviations: the surface lies deeper [m], elsewhere [m], is turned [rad].
    #[pyo3(signature = (wrench, offset=0.0, position=0.0, attitude=0.0))]
    fn covariance(
        &self,
        wrench: &Bound<'_, PyAny>,
        offset: f64,
        position: f64,
        attitude: f64,
    ) -> PyResult<PyCovariance> {
        let covariance = ContactCovariance::new(&self.0, &numbers::matrix::<6, 6>(wrench, "wrench")?);
        Ok(PyCovariance(covariance.with_geometry(&self.0, &geometry(offset, position, attitude)?)))
    }

    /// How the point [m] moves per metre that the surface lies farther out, shape (3,): what a wrong radius does.
    #[getter]
    fn offset<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.point_answer_to(&GeometrySensitivity::offset()))
    }

    /// Greatest errors, to first order, under greatest errors of the components of the wrench: of the components of the
    /// point [m], of its distance [m], of the normal force [N] and of the spin torque [N·m].
    fn worst_case<'py>(
        &self,
        py: Python<'py>,
        errors: &Bound<'py, PyAny>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, f64, f64, f64)> {
        let errors = Vector6::from(numbers::numbers::<6>(errors, "errors")?);
        let WorstCase { components, distance, normal_force, spin_torque } = self.0.worst_case(&errors);
        Ok((numbers::array(py, &components), distance, normal_force, spin_torque))
    }
}

/// How sure a contact is.
#[pyclass(name = "ContactCovariance", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyCovariance(ContactCovariance<f64>);

#[pymethods]
impl PyCovariance {
    /// Of the point [m²], shape (3, 3).
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        numbers::array2(py, &self.0.point())
    }

    /// Of the position along the tangents [m²], shape (2, 2).
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        numbers::array2(py, &self.0.position())
    }

    /// Of the tangential force along the tangents [N²], shape (2, 2).
    #[getter]
    fn tangential_force<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        numbers::array2(py, &self.0.tangential_force())
    }

    /// Variance of the normal force [N²].
    #[getter]
    fn normal_force(&self) -> f64 {
        self.0.normal_force_variance()
    }

    /// Variance of the spin torque [(N·m)²].
    #[getter]
    fn spin_torque(&self) -> f64 {
        self.0.spin_variance()
    }

    /// The ellipse in the tangent plane in which the contact lies with a probability: semi-axes [m], and unit vectors
    /// along them. `None` where there is none.
    fn ellipse<'py>(
        &self,
        py: Python<'py>,
        probability: f64,
    ) -> Option<([f64; 2], [Bound<'py, PyArray1<f64>>; 2])> {
        let ellipse = self.0.ellipse(probability)?;
        Some((ellipse.semi_axes, ellipse.directions.map(|direction| numbers::array(py, &direction))))
    }
}

/// Greatest errors of the contact point on a centred sphere, as Bicchi and Dario bound them.
///
/// Parameters
/// ----------
/// radius : float
///     Of the sphere [m].
/// relative_error : float
///     Greatest error of each component of the wrench over its size.
/// force, torque : array_like, shape (3,)
///     On the fingertip [N, N·m].
///
/// Returns
/// -------
/// ndarray, shape (3,)
///     Of the components of the point [m].
#[pyfunction]
pub(crate) fn paper_bounds<'py>(
    py: Python<'py>,
    radius: f64,
    relative_error: f64,
    force: &Bound<'py, PyAny>,
    torque: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let bounds = PaperBounds::new(radius, relative_error).map_err(errors::shape)?;
    let (force, torque) = (numbers::three(force, "force")?, numbers::three(torque, "torque")?);
    Ok(numbers::array(py, &bounds.contact(&force, &torque)))
}

value::value_class!(PyJacobian, PyCovariance);
