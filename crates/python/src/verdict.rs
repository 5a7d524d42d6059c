//! Verdicts on estimates from anywhere.

use fairflight_laws::BATCH;
use fairflight_stats::{ClosedMoments, DEFAULT_ALPHA, Moments, Reference, Scores};
use numpy::{AllowTypeChange, PyArrayLike1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The verdict on a sample: whether its mean and variance agree with what they should be.
#[pyclass(frozen, get_all, module = "fairflight")]
#[derive(Debug)]
pub(crate) struct Verdict {
    /// True: agrees, and a relative bias of a half would have been found; False: disagrees; None: not testable with so few estimates.
    sound: Option<bool>,
    /// Reason, in words.
    reason: String,
    /// (mean of the sample - mean) / standard error; evidence only where the reason says so. None without a standard error.
    mean_z: Option<f64>,
    /// (variance of the sample - variance) / its standard error; None without one.
    variance_z: Option<f64>,
    /// p-value of the test of the mean; None if no test holds its level.
    mean_p: Option<f64>,
    /// p-value of the test of the variance; None if no test holds its level.
    variance_p: Option<f64>,
    /// Smallest relative bias of the mean that would have been found with probability 0.99.
    detectable_relative_bias: Option<f64>,
    /// Estimates that would make the mean testable, possibly infinite; None where it is testable or nobody can tell.
    samples_needed: Option<f64>,
}

#[pymethods]
impl Verdict {
    fn __repr__(&self) -> String {
        let sound = match self.sound {
            Some(true) => "True",
            Some(false) => "False",
            None => "None",
        };
        format!("<Verdict: sound={sound}; {}>", self.reason)
    }
}

/// The verdict on estimates, from anywhere, that should have the mean `mean`.
///
/// What else is known of the law gives the verdict its power, since a sample's own spread is blind to rare large values: the `variance` of one
/// estimate, or its `central` moments of order 2 to 8 as `moments` gives them (both: the variance counts), a `least` and a `greatest` value, or
/// `two_valued`, the value of estimates that are that or 0.
/// `error` bounds the error of the mean that is given. A right estimator is called unsound with a probability of at most `false_alarm`,
/// by default that of the program, 1e-6.
///
/// Raises ValueError if a number is not lawful.
#[pyfunction]
#[pyo3(signature = (estimates, mean, variance=None, *, central=None, error=0.0, least=None, greatest=None, two_valued=None, false_alarm=None))]
#[expect(clippy::too_many_arguments, reason = "keywords in Python")]
#[expect(clippy::needless_pass_by_value, reason = "arguments from Python are values")]
pub(crate) fn judge(
    estimates: PyArrayLike1<'_, f64, AllowTypeChange>,
    mean: f64,
    variance: Option<f64>,
    central: Option<Vec<Option<f64>>>,
    error: f64,
    least: Option<f64>,
    greatest: Option<f64>,
    two_valued: Option<f64>,
    false_alarm: Option<f64>,
) -> PyResult<Verdict> {
    let refuse = |reason: String| Err(PyValueError::new_err(reason));
    let false_alarm = false_alarm.unwrap_or(DEFAULT_ALPHA);
    if !(false_alarm > 0.0 && false_alarm < 0.5) {
        return refuse(format!("false_alarm: must lie between 0 and 1/2, found {false_alarm}"));
    }
    if variance.is_some_and(|variance| variance < 0.0) {
        return refuse(format!("variance: must be a number of at least 0, found {variance:?}"));
    }
    let mut moments = central.unwrap_or_default();
    if let Some(variance) = variance {
        moments.resize(moments.len().max(1), None);
        moments[0] = Some(variance);
    }
    let scores = match (two_valued, least, greatest) {
        (Some(high), None, None) => Scores::TwoValued { high },
        (Some(_), ..) => return refuse("two_valued: leaves no room for least or greatest".to_owned()),
        (None, None, None) => Scores::Unbounded,
        (None, least, greatest) => Scores::Bounded {
            minimum: least.unwrap_or(f64::NEG_INFINITY),
            maximum: greatest.unwrap_or(f64::INFINITY),
        },
    };
    let moments = (!moments.is_empty()).then(|| ClosedMoments::from_central(mean, &moments));
    let reference = Reference { error, moments, scores, ..Reference::exact(mean) };
    // Merged by batches, as the harness does: the same bits for the same estimates.
    let mut measured = Moments::new();
    for batch in estimates.as_array().to_vec().chunks(BATCH as usize) {
        measured.merge(&Moments::from_slice(batch));
    }
    let verdict = fairflight_stats::judge(&measured, &reference, false_alarm);
    Ok(Verdict {
        sound: verdict.sound,
        reason: verdict.reason,
        mean_z: verdict.mean_z,
        variance_z: verdict.variance_z,
        mean_p: verdict.mean_p,
        variance_p: verdict.variance_p,
        detectable_relative_bias: verdict.detectable_relative_bias,
        samples_needed: verdict.samples_needed,
    })
}
