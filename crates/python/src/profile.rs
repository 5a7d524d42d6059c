//! Profiles: of the harness by their specs, nodes, and callables.

use crate::callable::{Callable, Declared};
use crate::spec::{self, exception};
use fairflight_harness::Failure;
use fairflight_harness::field::{AnyProfile, ErasedField, MediumLibrary};
use fairflight_media::PiecewiseLinear;
use numpy::{AllowTypeChange, PyArrayLike1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// Extinction sigma_t along a ray, from the distance 0 to its length.
///
/// Profile(sigma_t, length, *, majorant=None, breakpoints=None, vectorised=False) takes a callable: sigma_t(s) is the extinction [1/length] at the
/// distance s, a float. A vectorised one gets a one-dimensional numpy array of distances (16 of them, or 1) and returns an array of as many values.
/// The same distance must always give the same value. `majorant` declares an upper bound, which every look-up checks; `breakpoints` are distances at
/// which sigma_t or a derivative of it jumps, for the quadratures of
/// `moments`.
///
/// Estimators of the transmittance exp(-integral of sigma_t) take negative values unless they say otherwise; values that are not finite are refused.
#[pyclass(frozen, module = "fairflight")]
#[derive(Debug)]
pub(crate) struct Profile {
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Known(AnyProfile),
    Own(Declared),
}

/// A profile in one run, and the callable behind it, if there is one.
pub(crate) struct Asked {
    pub(crate) profile: AnyProfile,
    pub(crate) callable: Option<Arc<Callable>>,
    /// True if look-ups of many distances at once are cheaper than one by one.
    pub(crate) prefers_lanes: bool,
}

impl Profile {
    /// The profile for one run.
    pub(crate) fn asked(&self, py: Python<'_>) -> Asked {
        match &self.kind {
            Kind::Known(profile) => Asked { profile: profile.clone(), callable: None, prefers_lanes: true },
            Kind::Own(declared) => {
                let declared = Declared {
                    sigma_t: declared.sigma_t.clone_ref(py),
                    breakpoints: declared.breakpoints.clone(),
                    ..*declared
                };
                let prefers_lanes = declared.is_vectorised;
                let callable = Arc::new(Callable::new(declared));
                let field = ErasedField(Arc::clone(&callable) as _);
                Asked { profile: AnyProfile::Own(field), callable: Some(callable), prefers_lanes }
            }
        }
    }
}

impl Asked {
    /// Result of `work` on the profile; an exception of the callable comes before whatever followed from it.
    ///
    /// A callable is asked by this thread, which stays attached to the interpreter; without one other Python threads go on meanwhile.
    pub(crate) fn run<R: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Self) -> Result<R, Failure> + Send,
    ) -> PyResult<R> {
        let Some(callable) = &self.callable else { return py.detach(|| work(self)).map_err(exception) };
        let result = work(self);
        match callable.raised(py) {
            Some(error) => Err(error),
            None => result.map_err(exception),
        }
    }
}

#[pymethods]
impl Profile {
    #[new]
    #[pyo3(signature = (sigma_t, length, *, majorant=None, breakpoints=None, vectorised=false))]
    fn new(
        sigma_t: Bound<'_, PyAny>,
        length: f64,
        majorant: Option<f64>,
        breakpoints: Option<Vec<f64>>,
        vectorised: bool,
    ) -> PyResult<Self> {
        let refuse = |reason: String| Err(PyValueError::new_err(reason));
        if !sigma_t.is_callable() {
            return refuse(format!(
                "profile.sigma_t: must be callable, found {}; Profile.linear takes nodes",
                sigma_t.repr()?
            ));
        }
        let lawful = |value: f64| value.is_finite() && value >= 0.0;
        if let Some((key, value)) = [("length", Some(length)), ("majorant", majorant)]
            .into_iter()
            .find_map(|(key, value)| value.filter(|value| !lawful(*value)).map(|value| (key, value)))
        {
            return refuse(format!("profile.{key}: must be a number of at least 0, found {value}"));
        }
        let breakpoints = breakpoints.unwrap_or_default();
        if let Some(outside) = breakpoints.iter().find(|s| !(**s > 0.0 && **s < length)) {
            return refuse(format!("profile.breakpoints: must lie inside the profile, found {outside}"));
        }
        let sigma_t = sigma_t.unbind();
        let declared = Declared { sigma_t, length, majorant, breakpoints, is_vectorised: vectorised };
        Ok(Self { kind: Kind::Own(declared) })
    }

    /// Extinction linear between nodes: `sigma_t` [1/length] at `positions` [length], which increase from 0.
    #[staticmethod]
    #[expect(clippy::needless_pass_by_value, reason = "arguments from Python are values")]
    fn linear(
        positions: PyArrayLike1<'_, f64, AllowTypeChange>,
        sigma_t: PyArrayLike1<'_, f64, AllowTypeChange>,
    ) -> PyResult<Self> {
        let numbers = |array: &PyArrayLike1<'_, f64, AllowTypeChange>| array.as_array().to_vec();
        PiecewiseLinear::new(numbers(&positions), numbers(&sigma_t))
            .map(|field| Self { kind: Kind::Known(AnyProfile::PiecewiseLinear(field)) })
            .map_err(|error| PyValueError::new_err(format!("profile: {error}")))
    }

    /// A profile by the JSON of its spec; paths of files are relative to the working directory.
    #[staticmethod]
    fn read(py: Python<'_>, text: &str) -> PyResult<Self> {
        // A file may be long.
        let build = || spec::profile(text)?.kind().build(&MediumLibrary::default());
        py.detach(build).map(|profile| Self { kind: Kind::Known(profile) }).map_err(exception)
    }

    /// The length of the profile [length].
    #[getter]
    fn length(&self) -> f64 {
        match &self.kind {
            Kind::Known(profile) => profile.length(),
            Kind::Own(declared) => declared.length,
        }
    }

    /// An upper bound of sigma_t that is known or was declared [1/length]; None without one.
    #[getter]
    fn majorant(&self) -> Option<f64> {
        match &self.kind {
            Kind::Known(profile) => profile.declared(),
            Kind::Own(declared) => declared.majorant,
        }
    }

    /// The extinction at a distance from the start of the profile [1/length].
    fn sigma_t(&self, py: Python<'_>, s: f64) -> PyResult<f64> {
        self.asked(py).run(py, |asked| Ok(asked.profile.field().sigma_t(s)))
    }

    fn __repr__(&self) -> String {
        let kind = match &self.kind {
            Kind::Known(_) => "",
            Kind::Own(declared) if declared.is_vectorised => "vectorised callable, ",
            Kind::Own(_) => "callable, ",
        };
        let majorant = self.majorant().map_or_else(String::new, |majorant| format!(", majorant {majorant}"));
        format!("<Profile: {kind}length {}{majorant}>", self.length())
    }
}
