//! `fingertip.Grasp`: several fingertips on one object.

use core::array;

use fingertip::hand::{
    CannotHold, Freedom, Grasp, GraspBall, GraspContact, Grip, GripOutcome, Hand, LeastGrip, Metric, Reach,
    SplitForces,
};
use fingertip::wrench::{ContactForce, Wrench};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::limits::{Each, Given, Joints};
use crate::{errors, numbers};

/// Most fingers of a grasp.
pub(crate) const MOST: usize = 5;

/// Forces of the contacts: normal [N], tangential [N], shape (3,), spin [N·m].
type Forces<'py> = Vec<(f64, Bound<'py, PyArray1<f64>>, f64)>;

/// Contacts of up to five fingers on one object.
///
/// Parameters
/// ----------
/// contacts : list of dict
///     Each with `point` [m], `outward` (the outward normal of the finger there), `friction`, and for a soft finger `arm`
///     (spin torque over tangential force at slip [m]); all in one frame, that of the hand.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> from fingertip import Grasp
/// >>> angles = [0.0, 2.1, 4.2]
/// >>> outward = [np.array([np.cos(angle), np.sin(angle), 0.0]) for angle in angles]
/// >>> grasp = Grasp([{"point": 0.04 * o, "outward": -o, "friction": 0.6, "arm": 2e-3} for o in outward])
/// >>> grasp.force_closure
/// True
/// >>> weight = np.array([0.0, 0.0, -2.94, 0.0, 0.0, 0.0])
/// >>> forces = grasp.least_grip(weight)
/// >>> [normal > 1.0 for normal, _, _ in forces]
/// [True, True, True]
#[pyclass(name = "Grasp", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyGrasp {
    grasp: Grasp<f64, MOST>,
    count: usize,
    contacts: Vec<Py<PyDict>>,
}

pub(crate) fn contact(given: &Bound<'_, PyDict>) -> PyResult<GraspContact<f64, Hand>> {
    let part = |key: &str| {
        let part = given.get_item(key)?;
        part.ok_or_else(|| errors::hand(format!("a contact needs `{key}`")))
    };
    let (point, outward) =
        (numbers::three(&part("point")?, "point")?, numbers::three(&part("outward")?, "outward")?);
    let friction = part("friction")?.extract()?;
    match given.get_item("arm")? {
        Some(arm) => GraspContact::soft(point, outward, friction, arm.extract()?),
        None => GraspContact::point(point, outward, friction),
    }
    .map_err(errors::hand)
}

pub(crate) fn wrench(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Wrench<f64, Hand>> {
    Ok(Wrench::from_components(&numbers::numbers::<6>(given, what)?.into()))
}

impl PyGrasp {
    fn forces(&self, given: &[(f64, Bound<'_, PyAny>, f64)]) -> PyResult<[ContactForce<f64>; MOST]> {
        if given.len() != self.count {
            let (found, expected) = (given.len(), self.count);
            return Err(errors::hand(format!(
                "there must be a force for each of {expected} contacts, not {found}"
            )));
        }
        let mut forces = array::from_fn(|_| ContactForce::zero());
        for (force, (normal, tangential, spin)) in forces.iter_mut().zip(given) {
            *force = ContactForce::new(*normal, numbers::three(tangential, "tangential")?, *spin);
        }
        Ok(forces)
    }

    fn said<'py>(&self, py: Python<'py>, forces: &[ContactForce<f64>; MOST]) -> Forces<'py> {
        let of = |force: &ContactForce<f64>| {
            (force.normal, numbers::array(py, &force.tangential.vector()), force.spin)
        };
        forces.iter().take(self.count).map(of).collect()
    }
}

#[pymethods]
impl PyGrasp {
    #[new]
    fn new(contacts: Vec<Bound<'_, PyDict>>) -> PyResult<Self> {
        if contacts.len() > MOST {
            return Err(errors::hand(format!("a grasp has at most {MOST} contacts, not {}", contacts.len())));
        }
        let mut places = [None; MOST];
        for (place, given) in places.iter_mut().zip(&contacts) {
            *place = Some(contact(given)?);
        }
        let (count, contacts) = (contacts.len(), contacts.into_iter().map(Bound::unbind).collect());
        Ok(Self { grasp: Grasp::new(places), count, contacts })
    }

    /// Whether any wrench can be borne by pressing hard enough; `None` where it cannot be told.
    #[getter]
    fn force_closure(&self) -> Option<bool> {
        self.grasp.force_closure()
    }

    /// In how many directions the contacts hold the object.
    #[getter]
    fn rank(&self) -> usize {
        self.grasp.rank()
    }

    /// How the object can move though no contact slides: velocity of the grasp's centre [m/s] and turning [rad/s], each
    /// with a sentence.
    fn freedoms<'py>(
        &self,
        py: Python<'py>,
    ) -> Vec<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, String)> {
        let of = |freedom: &Freedom<f64, MOST>| {
            (numbers::array(py, &freedom.velocity), numbers::array(py, &freedom.turning), freedom.to_string())
        };
        self.grasp.freedoms().iter().flatten().map(of).collect()
    }

    /// The wrench of contact forces on the fingers, about the origin of the frame [N, N·m].
    fn wrench<'py>(
        &self,
        py: Python<'py>,
        forces: Vec<(f64, Bound<'py, PyAny>, f64)>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(numbers::array(py, &self.grasp.wrench(&self.forces(&forces)?).components()))
    }

    /// Contact forces as those that bear the load and those that only squeeze.
    fn split<'py>(
        &self,
        py: Python<'py>,
        forces: Vec<(f64, Bound<'py, PyAny>, f64)>,
    ) -> PyResult<(Forces<'py>, Forces<'py>)> {
        let SplitForces { bearing, internal } = self.grasp.split(&self.forces(&forces)?);
        Ok((self.said(py, &bearing), self.said(py, &internal)))
    }

    /// Of each contact, signed distance to slip [N] and how much of the friction is used.
    fn slip_margins(&self, forces: Vec<(f64, Bound<'_, PyAny>, f64)>) -> PyResult<Vec<Option<(f64, f64)>>> {
        let margins = self.grasp.slip_margins(&self.forces(&forces)?);
        Ok(margins.iter().take(self.count).map(|m| m.map(|m| (m.newtons, m.utilisation))).collect())
    }

    /// The contact forces that hold a load with the least sum of normal forces.
    ///
    /// Parameters
    /// ----------
    /// load : array_like, shape (6,)
    ///     What pulls at the object, such as its weight, about the origin of the frame [N, N·m].
    /// least, greatest : float or list of float, optional
    ///     Normal force [N], of all fingers or of each.
    /// cost : float or list of float, optional
    ///     What a newton of normal force costs, of all fingers or of each: ratios count.
    /// joints : list, optional
    ///     Of each finger `None`, or the columns of the hand's Jacobian and what its joints can give: an array of shape
    ///     (6, joints), of each joint the velocity of the fingertip as a rigid body at the origin of the frame and its angular
    ///     velocity for a unit rate, and as many torques [N·m] (forces [N] of linear drives). A torque is the column times the
    ///     wrench on the fingertip.
    ///
    /// Returns
    /// -------
    /// list of tuple
    ///     Of each contact the normal force [N], the tangential force [N], and the spin torque [N·m].
    ///
    /// Raises
    /// ------
    /// HandError
    ///     The load cannot be held so.
    ///
    /// Examples
    /// --------
    /// Two fingers carry 1 kg with a motor each, that pulls at a lever of 8 cm across the grip:
    ///
    /// >>> from fingertip import Grasp
    /// >>> sides = [{"point": [x, 0, 0], "outward": [-x, 0, 0], "friction": 0.5, "arm": 3e-3} for x in (-0.02, 0.02)]
    /// >>> hinge = [[0.08], [0], [0], [0], [1], [0]]
    /// >>> for torque in (1.0, 0.7):
    /// ...     try:
    /// ...         forces = Grasp(sides).least_grip([0, 0, -9.81, 0, 0, 0], joints=[(hinge, [torque])] * 2)
    /// ...         print(round(forces[0][0], 2), "N")
    /// ...     except ValueError:
    /// ...         print("not held")
    /// 9.81 N
    /// not held
    #[pyo3(
        signature = (load, *, least=Each::All(0.0), greatest=None, cost=Each::All(1.0), joints=None),
        text_signature = "($self, load, *, least=0.0, greatest=None, cost=1.0, joints=None)"
    )]
    fn least_grip<'py>(
        &self,
        py: Python<'py>,
        load: &Bound<'py, PyAny>,
        least: Each,
        greatest: Option<Each>,
        cost: Each,
        joints: Option<Joints<'py>>,
    ) -> PyResult<Forces<'py>> {
        let given = Given::read(Some(self.count), &least, greatest.as_ref(), &cost, joints)?;
        let (limits, load) = (given.limits()?, wrench(load, "load")?);
        match LeastGrip::new().solve(&self.grasp, &limits, &load) {
            GripOutcome::Held(Grip { forces, .. }) => Ok(self.said(py, &forces)),
            GripOutcome::CannotHold(CannotHold { velocity, turning, .. }) => {
                let (v, w) = (velocity.as_slice(), turning.as_slice());
                Err(errors::hand(format!(
                    "the load cannot be held: the object would move by {v:?} m/s and turn by {w:?} rad/s"
                )))
            }
            GripOutcome::NotFinite => Err(errors::hand("the load or a contact is not finite")),
            GripOutcome::Undecided => Err(errors::hand(
                "whether the load can be held was not decided within the bound of the search",
            )),
        }
    }

    /// How many times a disturbance can be added to a load before it cannot be held: infinite where there is no end,
    /// `None` where the load itself is not held or it cannot be told.
    /// Limits as in `least_grip`.
    #[pyo3(
        signature = (load, disturbance, *, least=Each::All(0.0), greatest=None, joints=None),
        text_signature = "($self, load, disturbance, *, least=0.0, greatest=None, joints=None)"
    )]
    fn reach(
        &self,
        load: &Bound<'_, PyAny>,
        disturbance: &Bound<'_, PyAny>,
        least: Each,
        greatest: Option<Each>,
        joints: Option<Joints<'_>>,
    ) -> PyResult<Option<f64>> {
        let given = Given::read(Some(self.count), &least, greatest.as_ref(), &Each::All(1.0), joints)?;
        let limits = given.limits()?;
        let reach = self.grasp.reach(&limits, &wrench(load, "load")?, &wrench(disturbance, "disturbance")?);
        Ok(match reach {
            Reach::Times(times) => Some(times),
            Reach::Unlimited => Some(f64::INFINITY),
            Reach::NotHeld | Reach::Unknown => None,
        })
    }

    /// The largest ball of wrenches that fingers pressing with 1 N in all (or each) can resist, torques being counted over
    /// a length [m]: a radius that is certain, the one that was found [N], and the weakest direction.
    #[pyo3(signature = (length, *, each=false))]
    fn ball<'py>(
        &self,
        py: Python<'py>,
        length: f64,
        each: bool,
    ) -> Option<(f64, f64, Bound<'py, PyArray1<f64>>)> {
        let metric = if each { Metric::Each { length } } else { Metric::Total { length } };
        let GraspBall { certified, found, weakest } = self.grasp.ball(metric)?;
        Some((certified, found, numbers::array(py, &weakest.components())))
    }

    fn __len__(&self) -> usize {
        self.count
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, (Vec<Py<PyDict>>,)) {
        let contacts = slf.get().contacts.iter().map(|contact| contact.clone_ref(slf.py())).collect();
        (slf.get_type().into_any(), (contacts,))
    }
}
