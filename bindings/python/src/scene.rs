//! `fingertip.Scene`.

use std::io::Write;
use std::path::{Path, PathBuf};

use fingertip_scene::{Scene, SceneError, SceneProblem, registry};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors;
use crate::numbers;
use crate::sections::document;
use crate::surface::PySurface;

/// A file that takes the place of a section, with what stands in it: a scene that is pickled finds it anywhere.
#[derive(Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
struct Enclosed {
    /// From where it was read.
    path: PathBuf,
    /// What tells the formats of calibrations apart.
    ending: String,
    text: String,
}

impl Enclosed {
    fn read(path: &Path) -> PyResult<Self> {
        let text = fingertip_calibration::file::read_text(path)
            .map_err(|error| errors::scene(format!("cannot read {}: {error}", path.display())))?;
        let ending = path.extension().map(|ending| ending.to_string_lossy().into_owned());
        Ok(Self { path: path.to_owned(), ending: ending.unwrap_or_default(), text })
    }

    /// Gives it to what reads files.
    fn with_file<A>(&self, read: impl FnOnce(&Path) -> Result<A, SceneProblem>) -> PyResult<A> {
        let mut file = tempfile::Builder::new().suffix(&format!(".{}", self.ending)).tempfile()?;
        file.write_all(self.text.as_bytes())?;
        read(file.path()).map_err(errors::scene)
    }
}

/// What a scene is made of.
#[derive(Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
struct Made {
    text: String,
    name: String,
    /// What messages call it, and where its files are looked for.
    path: PathBuf,
    folder: PathBuf,
    calibration: Option<Enclosed>,
    payload: Option<Enclosed>,
}

impl Made {
    fn scene(&self) -> PyResult<Scene> {
        let Self { text, name, path, folder, calibration, payload } = self;
        let mut scene = Scene::parse(text, name, folder)
            .map_err(|fault| errors::scene(SceneError::Fault { path: path.clone(), fault }))?;
        if let Some(calibration) = calibration {
            scene = calibration.with_file(|path| scene.calibrated_by(path))?;
        }
        if let Some(payload) = payload {
            scene = payload.with_file(|path| scene.carrying(path))?;
        }
        Ok(scene)
    }
}

/// A scene that has been checked: what stands behind a fingertip, from sensor to slip detector.
///
/// Make one by `from_file`, `from_toml` or `from_dict`. A scene does not change. It pickles whole but for files that it
/// names in its text, such as a mesh: these are looked for in the same folder.
#[pyclass(name = "Scene", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyScene {
    made: Made,
    scene: Scene,
}

impl PyScene {
    fn new(made: Made) -> PyResult<Self> {
        Ok(Self { scene: made.scene()?, made })
    }

    pub(crate) const fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(crate) fn text(&self) -> &str {
        &self.made.text
    }

    pub(crate) fn path(&self) -> &Path {
        &self.made.path
    }

    pub(crate) fn from_text(text: String) -> PyResult<Self> {
        let (name, path, folder) = ("scene".to_owned(), PathBuf::from("of a text"), PathBuf::new());
        Self::new(Made { text, name, path, folder, calibration: None, payload: None })
    }
}

#[pymethods]
impl PyScene {
    /// Reads and checks the scene in a TOML file.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     The file; files that it names are looked for in its folder.
    ///
    /// Raises
    /// ------
    /// SceneError
    ///     It names the file, the line where it is known, the key, and the mend.
    #[staticmethod]
    fn from_file(path: PathBuf) -> PyResult<Self> {
        let text = fingertip_calibration::file::read_text(&path)
            .map_err(|source| errors::scene(SceneError::Unreadable { path: path.clone(), source }))?;
        let name =
            path.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy()).into_owned();
        // Whole, so that what is pickled does not depend on where a program runs.
        let whole = std::path::absolute(&path).unwrap_or_else(|_| path.clone());
        let folder = whole.parent().unwrap_or(Path::new("")).to_owned();
        Self::new(Made { text, name, path, folder, calibration: None, payload: None })
    }

    /// Checks a scene in a text, as it would stand in a file.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     TOML.
    /// folder : str or os.PathLike, optional
    ///     Where files that it names are looked for; where the program runs by default.
    ///
    /// Examples
    /// --------
    /// >>> import fingertip
    /// >>> scene = fingertip.Scene.from_toml('''
    /// ... version = 2
    /// ... [input]
    /// ... convention = "on_fingertip"
    /// ... [surface]
    /// ... shape = "sphere"
    /// ... radius_m = 0.013
    /// ... ''')
    /// >>> scene.convention.value
    /// 'on_fingertip'
    #[staticmethod]
    #[pyo3(signature = (text, folder=None))]
    fn from_toml(text: String, folder: Option<PathBuf>) -> PyResult<Self> {
        let (name, path) = ("scene".to_owned(), PathBuf::from("of a text"));
        let folder = folder.unwrap_or_default();
        Self::new(Made { text, name, path, folder, calibration: None, payload: None })
    }

    /// Checks a scene of sections as dictionaries, with the keys of a file.
    ///
    /// Parameters
    /// ----------
    /// sections : dict
    ///     By the names of the sections; `version` may be left out, and `input` too, whose convention then is
    ///     "on_fingertip".
    /// folder : str or os.PathLike, optional
    ///     Where files that it names are looked for.
    ///
    /// Examples
    /// --------
    /// >>> import fingertip
    /// >>> fingertip.Scene.from_dict({"surface": {"shape": "sphere", "radius_m": 0.013}}).least_force
    /// 0.0
    #[staticmethod]
    #[pyo3(signature = (sections, folder=None))]
    fn from_dict(sections: &Bound<'_, PyDict>, folder: Option<PathBuf>) -> PyResult<Self> {
        Self::from_toml(document(sections)?, folder)
    }

    /// With a calibration in the place of the section `[sensor]`.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     TOML as `calibrate` writes it, or an ATI `.cal`.
    fn calibrated_by(&self, path: PathBuf) -> PyResult<Self> {
        Self::new(Made { calibration: Some(Enclosed::read(&path)?), ..self.made.clone() })
    }

    /// With a payload in the place of the section `[payload]`.
    fn carrying(&self, path: PathBuf) -> PyResult<Self> {
        Self::new(Made { payload: Some(Enclosed::read(&path)?), ..self.made.clone() })
    }

    /// What reports call it.
    #[getter]
    fn name(&self) -> &str {
        self.scene.name()
    }

    /// Its text, as it stands in the file.
    fn to_toml(&self) -> &str {
        &self.made.text
    }

    /// Whose load a recording holds.
    #[getter]
    fn convention<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        crate::enums::member(py, "Convention", &self.scene.convention())
    }

    /// Smaller forces are no contact [N].
    #[getter]
    fn least_force(&self) -> f64 {
        self.scene.least_force()
    }

    /// Samples per second where a recording has no time [Hz], or `None`.
    #[getter]
    fn sample_rate(&self) -> Option<f64> {
        self.scene.sample_rate()
    }

    /// Prefix of the sensor's columns in a recording, or `None`.
    #[getter]
    fn sensor_name(&self) -> Option<&str> {
        self.scene.sensor_name()
    }

    /// Whether readings are gauges, which a `[sensor]` turns into wrenches.
    #[getter]
    fn has_sensor(&self) -> bool {
        self.scene.calibration().is_some()
    }

    /// How long the sensor is known to be unloaded at the start of a recording [s], or `None`.
    #[getter]
    fn rest(&self) -> Option<f64> {
        self.scene.rest()
    }

    /// By how much the wrench of a `[filter]` comes late where it changes slowly [s].
    #[getter]
    fn delay(&self) -> f64 {
        self.scene.delay()
    }

    /// The surface, in the sensor frame.
    #[getter]
    fn surface(&self) -> PySurface {
        PySurface::of_scene(self.scene.surface().clone(), &self.made.text)
    }

    /// What it says, in a line for each of its sections.
    fn meaning(&self) -> Vec<String> {
        self.scene.meaning()
    }

    /// What in it can be and is hardly meant, such as a radius of 13 m: a sentence each.
    fn doubts(&self) -> Vec<String> {
        self.scene.doubts()
    }

    /// The files that were read for it beside its own: calibration, payload, mesh, the description of a robot and the
    /// meshes that it names. Whoever writes files should write over none of them.
    fn files(&self) -> Vec<PathBuf> {
        // Those that travel with the scene were given to it in temporary places, behind all others.
        let Made { calibration, payload, .. } = &self.made;
        let enclosed: Vec<PathBuf> =
            [calibration, payload].into_iter().flatten().map(|file| file.path.clone()).collect();
        let named = self.scene.files().len() - enclosed.len();
        self.scene.files().iter().take(named).cloned().chain(enclosed).collect()
    }

    /// Where points of the surface lie on its flat map, as reports draw it: in mm on a plane and an unrolled
    /// cylinder, in radii on the map of a sphere that keeps areas.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (n, 3)
    ///     On the surface [m].
    ///
    /// Returns
    /// -------
    /// right, up : ndarray, shape (n,)
    fn project<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
        let points = numbers::table(points, "points")?;
        if points.ncols() != 3 {
            return Err(errors::bad(format!("`points` must have 3 columns, not {}", points.ncols())));
        }
        let map = self.scene.projection();
        let (right, up): (Vec<_>, Vec<_>) = points
            .row_iter()
            .map(|row| map.project(&row.transpose().fixed_rows::<3>(0).into_owned()))
            .unzip();
        Ok((PyArray1::from_vec(py, right), PyArray1::from_vec(py, up)))
    }

    /// What a section can choose, by name: every shape, model, skin, limit, detector and filter, with an example.
    ///
    /// Returns
    /// -------
    /// list of dict
    ///     With the keys `section`, `key`, `name`, `says` and `example`, which is TOML.
    #[staticmethod]
    fn choices(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
        let of = |entry: &registry::Entry| {
            let choice = PyDict::new(py);
            choice.set_item("section", entry.section)?;
            choice.set_item("key", entry.key)?;
            choice.set_item("name", entry.name)?;
            choice.set_item("says", entry.says)?;
            choice.set_item("example", entry.example)?;
            Ok(choice)
        };
        registry::entries().map(of).collect()
    }

    #[staticmethod]
    fn _from_bytes(bytes: &[u8]) -> PyResult<Self> {
        Self::new(crate::value::from_bytes(bytes)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<crate::value::Reduced<'py>> {
        crate::value::reduced(slf.as_any(), &slf.get().made)
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().made == self.made)
    }

    fn __repr__(&self) -> String {
        format!("<fingertip.Scene {:?}: {}>", self.scene.name(), self.scene.meaning().join("; "))
    }
}
