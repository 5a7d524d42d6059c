//! A Python callable as a field.

use fairflight_elementary::lanes::Lanes;
use fairflight_harness::field::{Knowledge, KnownField, ThicknessMethod};
use fairflight_media::{Breakpoints, Certificate, Enclosed, Extinction, Stretch, Tolerance};
use numpy::{AllowTypeChange, PyArray1, PyArrayLike1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// Declarations about a callable, beside it.
#[derive(Debug)]
pub(crate) struct Declared {
    /// σ_t \[1/length\] at a distance, or at each of an array of distances.
    pub(crate) sigma_t: Py<PyAny>,
    /// The length of the profile \[length\].
    pub(crate) length: f64,
    /// An upper bound of σ_t \[1/length\], which every look-up checks.
    pub(crate) majorant: Option<f64>,
    /// Distances at which σ_t is not smooth \[length\].
    pub(crate) breakpoints: Vec<f64>,
    /// True if it takes arrays of distances.
    pub(crate) is_vectorised: bool,
}

/// A callable in one run: counts its look-ups, and keeps the first exception. After one it is asked no more, and every look-up is NaN, which the run
/// refuses.
#[derive(Debug)]
pub(crate) struct Callable {
    declared: Declared,
    certificate: Certificate,
    lookups: AtomicU64,
    raised: OnceLock<PyErr>,
}

impl Callable {
    /// A callable that was not asked yet.
    pub(crate) fn new(declared: Declared) -> Self {
        // Nothing is proved of a callable: no operation is worth spending.
        let certificate = Certificate::within(&Unknown { length: declared.length }, Tolerance::TIGHT, 0);
        Self { declared, certificate, lookups: AtomicU64::new(0), raised: OnceLock::new() }
    }

    /// Look-ups so far, those of all lanes counted.
    pub(crate) fn lookups(&self) -> u64 {
        self.lookups.load(Ordering::Relaxed)
    }

    /// The first exception.
    pub(crate) fn raised(&self, py: Python<'_>) -> Option<PyErr> {
        self.raised.get().map(|error| error.clone_ref(py))
    }

    /// Puts the callable's values at distances into `found`: NaN once it has raised.
    fn ask(&self, s: &[f64], found: &mut [f64]) {
        self.lookups.fetch_add(s.len() as u64, Ordering::Relaxed);
        if self.raised.get().is_none() {
            match Python::attach(|py| self.call(py, s, found)) {
                Ok(()) => return,
                Err(error) => self.raised.set(error).unwrap_or_default(),
            }
        }
        found.fill(f64::NAN);
    }

    fn call(&self, py: Python<'_>, s: &[f64], found: &mut [f64]) -> PyResult<()> {
        let sigma_t = &self.declared.sigma_t;
        if !self.declared.is_vectorised {
            for (found, s) in found.iter_mut().zip(s) {
                *found = sigma_t.call1(py, (*s,))?.extract(py)?;
            }
            return Ok(());
        }
        let array: PyArrayLike1<'_, f64, AllowTypeChange> =
            sigma_t.bind(py).call1((PyArray1::from_slice(py, s),))?.extract()?;
        let values = array.as_array();
        if values.len() != found.len() {
            let (asked, given) = (found.len(), values.len());
            return Err(PyValueError::new_err(format!(
                "profile.sigma_t: must return a value for each of {asked} distances, found {given}"
            )));
        }
        found.iter_mut().zip(values).for_each(|(found, value)| *found = *value);
        Ok(())
    }
}

impl Extinction for Callable {
    fn sigma_t(&self, s: f64) -> f64 {
        let mut found = [f64::NAN];
        self.ask(&[s], &mut found);
        found[0]
    }

    fn sigma_t_lanes(&self, s: &Lanes) -> Lanes {
        let mut found = [f64::NAN; _];
        self.ask(s, &mut found);
        found
    }

    fn length(&self) -> f64 {
        self.declared.length
    }
}

impl Breakpoints for Callable {
    fn breakpoints(&self) -> Vec<f64> {
        self.declared.breakpoints.clone()
    }
}

impl KnownField for Callable {
    fn knowledge(&self) -> Knowledge {
        Knowledge {
            optical_thickness: None,
            method: ThicknessMethod::Quadrature,
            upper_bound: self.declared.majorant,
            lower_bound: None,
            maximum: None,
        }
    }

    fn certificate(&self) -> Option<&Certificate> {
        Some(&self.certificate)
    }
}

/// A profile of which nothing is known between look-ups.
#[derive(Debug)]
struct Unknown {
    length: f64,
}

impl Extinction for Unknown {
    fn sigma_t(&self, _s: f64) -> f64 {
        f64::NAN
    }
    fn length(&self) -> f64 {
        self.length
    }
}

impl Enclosed for Unknown {
    fn enclose(&self, _from: f64, _to: f64) -> Stretch {
        Stretch {
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
            integral: f64::NAN,
            truncation: f64::INFINITY,
            rounding: 0.0,
            may_be_undefined: true,
            kink: None,
            cost: 1,
        }
    }
}
