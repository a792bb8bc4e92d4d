//! `fingertip.Contact` and `fingertip.NoContact`.

use fingertip::contact::{Contact, NoContact, Resolution};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::value::value_class;
use crate::{enums, numbers};

/// One contact of the fingertip, in the sensor frame.
#[pyclass(name = "Contact", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyContact(pub(crate) Contact<f64>);

#[pymethods]
impl PyContact {
    /// A contact that something else found.
    ///
    /// Parameters
    /// ----------
    /// point : array_like, shape (3,)
    ///     Where the environment touches [m].
    /// normal : array_like, shape (3,)
    ///     Outward unit normal of the fingertip there.
    /// force : array_like, shape (3,)
    ///     Force on the fingertip [N].
    /// spin_torque : float, optional
    ///     Torque on the fingertip about the normal [N·m].
    #[new]
    #[pyo3(signature = (point, normal, force, spin_torque=0.0))]
    fn new(
        point: &Bound<'_, PyAny>,
        normal: &Bound<'_, PyAny>,
        force: &Bound<'_, PyAny>,
        spin_torque: f64,
    ) -> PyResult<Self> {
        Ok(Self(Contact {
            point: numbers::three(point, "point")?,
            normal: numbers::three(normal, "normal")?,
            force: numbers::three(force, "force")?,
            spin_torque,
            gap: 0.0,
            alternatives: 0,
            searched: false,
        }))
    }

    /// Where the environment touches [m].
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.point)
    }

    /// Outward unit normal of the fingertip there.
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.normal)
    }

    /// Force on the fingertip [N].
    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.force)
    }

    /// Normal force [N], positive when pressing.
    #[getter]
    fn normal_force(&self) -> f64 {
        self.0.normal_force()
    }

    /// Tangential force on the fingertip [N].
    #[getter]
    fn tangential_force<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.tangential_force())
    }

    /// Spin torque on the fingertip about the outward normal [N·m]; zero for a point contact.
    #[getter]
    fn spin_torque(&self) -> f64 {
        self.0.spin_torque
    }

    /// Tangential over normal force; `None` without normal force.
    #[getter]
    fn friction_ratio(&self) -> Option<f64> {
        self.0.contact_force().friction_ratio()
    }

    /// Cosine of the angle between the force and the inward normal: errors of the point grow as its reciprocal.
    #[getter]
    fn incidence(&self) -> f64 {
        self.0.incidence()
    }

    /// Distance between the line of action and the point [m]: zero unless a miss was accepted.
    #[getter]
    fn gap(&self) -> f64 {
        self.0.gap
    }

    /// How many other points of the surface would explain the wrench as well.
    #[getter]
    fn alternatives(&self) -> u8 {
        self.0.alternatives
    }

    /// Whether contacts were searched for, and the surface says too little of itself to know that none was missed.
    #[getter]
    fn searched(&self) -> bool {
        self.0.searched
    }

    pub(crate) fn __repr__(&self) -> String {
        let Contact { point: p, .. } = &self.0;
        let (normal, tangential) = (self.0.normal_force(), self.0.tangential_force().norm());
        format!(
            "Contact(point=[{:.6}, {:.6}, {:.6}] m, normal_force={normal:.4} N, tangential={tangential:.4} N)",
            p.x, p.y, p.z
        )
    }
}

/// Why a wrench gives no contact: false as a condition, a sentence as a text.
#[pyclass(name = "NoContact", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyNoContact(pub(crate) NoContact<f64>);

#[pymethods]
impl PyNoContact {
    /// The reason, a `NoContactReason`.
    #[getter]
    fn reason<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        enums::member(py, "NoContactReason", &self.0)
    }

    fn __bool__(&self) -> bool {
        false
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    pub(crate) fn __repr__(&self) -> String {
        format!("NoContact({:?})", self.0.to_string())
    }
}

value_class!(PyContact, PyNoContact);

/// A contact, or why there is none.
pub(crate) fn resolution(py: Python<'_>, resolution: Resolution<f64>) -> PyResult<Py<PyAny>> {
    Ok(match resolution {
        Resolution::Contact(contact) => Py::new(py, PyContact(contact))?.into_any(),
        Resolution::NoContact(reason) => Py::new(py, PyNoContact(reason))?.into_any(),
    })
}
