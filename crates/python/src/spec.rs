//! Specs from Python, as JSON, by the reader of the harness.

use fairflight_harness::Failure;
use fairflight_harness::estimator::EstimatorSpec;
use fairflight_harness::field::ProfileSpec;
use fairflight_harness::reader::{Node, json};
use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyValueError};
use serde_json::{Map, Value};

/// A profile by the JSON of its spec.
///
/// # Errors
/// If it is not JSON, or a key is missing, unknown or of the wrong kind.
pub(crate) fn profile(text: &str) -> Result<ProfileSpec, Failure> {
    read("profile", text, ProfileSpec::read)
}

/// An estimator by the JSON of its spec.
///
/// # Errors
/// If it is not JSON, or a key is missing, unknown or of the wrong kind.
pub(crate) fn estimator(text: &str) -> Result<EstimatorSpec, Failure> {
    read("estimator", text, EstimatorSpec::read)
}

/// A part of an experiment, under the key that it has there: a refusal names its keys as `harness estimate` does.
fn read<T>(
    key: &'static str,
    text: &str,
    part: impl Fn(&Node<'_>) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let value = json::parse(text).map_err(|failure| failure.within(key))?;
    let spec = Value::Object(Map::from_iter([(key.to_owned(), value)]));
    part(&Node::root(&spec).object()?.required(key)?)
}

/// The exception of a failure: a ValueError with the words of a refusal.
pub(crate) fn exception(failure: Failure) -> PyErr {
    match failure {
        Failure::Refused(reason) => PyValueError::new_err(reason),
        Failure::NotWritten(reason) => PyOSError::new_err(reason),
        Failure::Interrupted => PyKeyboardInterrupt::new_err(()),
    }
}
