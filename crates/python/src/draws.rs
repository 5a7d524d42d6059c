//! Raw estimates.

use crate::profile::{Asked, Profile};
use crate::spec::{self, exception};
use fairflight_elementary::lanes::LANES;
use fairflight_harness::Failure;
use fairflight_harness::estimator::{EstimatorSpec, Prepared};
use fairflight_harness::measure::MOST_COUNTED;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::plan::Plan;
use fairflight_harness::reference::{Truth, explain};
use fairflight_laws::{BATCH, batch_count, batch_moments, batch_size};
use fairflight_media::{Tolerance, Violation};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::Moments;
use numpy::PyArray1;
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use std::ops::Range;

/// Estimates of a transmittance, one after the other.
#[pyclass(frozen, get_all, module = "fairflight")]
#[derive(Debug)]
pub(crate) struct Draws {
    /// The estimates, an array of float64.
    values: Py<PyArray1<f64>>,
    /// Look-ups of sigma_t of one estimate on average, preparation included.
    lookups: f64,
    /// Mean of the estimates, with the bits that `harness estimate` gives.
    mean: f64,
    /// Sample variance of the estimates, with those bits; None for one estimate.
    variance: Option<f64>,
}

#[pymethods]
impl Draws {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let count = self.values.bind(py).len()?;
        Ok(format!("<Draws: {count} estimates, mean {}, {} look-ups each>", self.mean, self.lookups))
    }
}

/// Batches that are drawn between two looks at signals.
const CHUNK: u64 = 512;

/// Estimates of the transmittance of a profile by an estimator, given as the JSON of its spec.
///
/// Batches of 4096 estimates have streams of their own, as in the harness: the same seed gives the same estimates.
#[pyfunction]
pub(crate) fn draw(
    py: Python<'_>,
    profile: &Profile,
    estimator: &str,
    samples: u64,
    seed: u64,
) -> PyResult<Draws> {
    if samples == 0 {
        return Err(PyValueError::new_err("samples: must be a whole number of at least 1, found 0"));
    }
    let mut values: Vec<f64> = Vec::new();
    let room = usize::try_from(samples).ok().filter(|count| values.try_reserve_exact(*count).is_ok());
    room.ok_or_else(|| PyMemoryError::new_err(format!("samples: no room for {samples} estimates")))?;
    let spec = spec::estimator(estimator).map_err(exception)?;
    let asked = profile.asked(py);
    let run = asked.run(py, |asked| Run::new(asked, spec, samples, seed))?;
    let (mut moments, mut lookups, mut counted) = (Moments::new(), 0, 0);
    let batches = batch_count(samples);
    for start in (0..batches).step_by(CHUNK as usize) {
        py.check_signals()?;
        let chunk = asked.run(py, |asked| run.chunk(asked, start..batches.min(start + CHUNK)))?;
        for batch in chunk {
            moments.merge(&batch.moments);
            lookups += batch.lookups;
            counted += batch.counted;
            values.extend_from_slice(&batch.values);
        }
    }
    Ok(Draws {
        values: PyArray1::from_vec(py, values).unbind(),
        lookups: lookups as f64 / counted as f64 + run.estimator.preparation_lookups as f64,
        mean: moments.mean().unwrap_or(f64::NAN),
        variance: moments.sample_variance(),
    })
}

/// An estimator on a profile, and what is drawn of it.
struct Run {
    estimator: Prepared,
    samples: u64,
    seed: u64,
}

/// The estimates of a stream.
struct Batch {
    values: Vec<f64>,
    moments: Moments,
    lookups: u64,
    /// Estimates whose look-ups were counted.
    counted: u64,
}

/// True for the batches whose look-ups the harness counts.
fn is_counted(index: u64) -> bool {
    index * BATCH < MOST_COUNTED
}

impl Run {
    fn new(asked: &Asked, spec: EstimatorSpec, samples: u64, seed: u64) -> Result<Self, Failure> {
        let plan = Plan::on(asked.profile.clone(), spec, samples, seed)?;
        Ok(Self { estimator: plan.estimator, samples, seed })
    }

    /// The estimates of some batches: on all cores, but of a callable, and of an estimator that learns from one to the next.
    fn chunk(&self, asked: &Asked, indices: Range<u64>) -> Result<Vec<Batch>, Failure> {
        let in_turn = self.estimator.is_sequential || asked.callable.is_some();
        let in_lanes = asked.prefers_lanes && !self.estimator.is_sequential;
        let width = if in_lanes && self.estimator.trial.runs_in_lanes() { LANES as u64 } else { 1 };
        let groups = (indices.end - indices.start).div_ceil(width) as usize;
        let group = |k: usize| {
            let from = indices.start + k as u64 * width;
            self.group(asked, from..indices.end.min(from + width))
        };
        let found: Vec<Vec<Batch>> = if in_turn {
            (0..groups).map(group).collect::<Result<_, Failure>>()?
        } else {
            try_in_parallel(groups, &group)?
        };
        Ok(found.into_iter().flatten().collect())
    }

    /// The estimates of batches side by side, in lanes where a look-up of many distances is cheaper; where one may not be lawful, in turn, to find
    /// which.
    fn group(&self, asked: &Asked, indices: Range<u64>) -> Result<Vec<Batch>, Failure> {
        let lanes = indices.end - indices.start;
        if (lanes > 1 || asked.callable.is_some())
            && asked.prefers_lanes
            && let Some(batches) = self.in_lanes(indices.clone())
        {
            return batches;
        }
        indices.map(|index| self.batch(asked, index)).collect()
    }

    fn in_lanes(&self, indices: Range<u64>) -> Option<Result<Vec<Batch>, Failure>> {
        let mut values: [Vec<f64>; LANES] = Default::default();
        for (values, index) in values.iter_mut().zip(indices.clone()) {
            values.resize(batch_size(self.samples, index) as usize, 0.0);
        }
        let seeds = std::array::from_fn(|lane| derive_seed(self.seed, indices.start + lane as u64));
        let mut slices = values.each_mut().map(Vec::as_mut_slice);
        let lookups = self.estimator.trial.draw_lanes(seeds, &mut slices)?;
        let batch = |((index, values), lookups): ((u64, Vec<f64>), u64)| self.told(index, values, lookups);
        Some(indices.zip(values).zip(lookups).map(batch).collect())
    }

    /// The estimates of one batch. Look-ups of a callable are counted as it is asked, others in a second run over the same variates.
    fn batch(&self, asked: &Asked, index: u64) -> Result<Batch, Failure> {
        let source = || Seeded::for_batch(self.seed, index);
        let trial = &self.estimator.trial;
        let size = batch_size(self.samples, index);
        let mut values = vec![0.0; size as usize];
        let before = asked.callable.as_ref().map(|callable| callable.lookups());
        trial.draw(&mut source(), &mut values).map_err(|violation| self.refusal(asked, violation))?;
        let lookups = match (&asked.callable, before) {
            (Some(callable), Some(before)) if !self.estimator.is_sequential => callable.lookups() - before,
            _ => trial.count(&mut source(), if is_counted(index) { size } else { 0 }),
        };
        self.told(index, values, lookups)
    }

    fn told(&self, index: u64, values: Vec<f64>, lookups: u64) -> Result<Batch, Failure> {
        let moments = batch_moments(self.seed, index, &values).map_err(Failure::refused)?;
        let (lookups, counted) = if is_counted(index) { (lookups, values.len() as u64) } else { (0, 0) };
        Ok(Batch { values, moments, lookups, counted })
    }

    /// The words of the harness for a look-up that was not lawful.
    fn refusal(&self, asked: &Asked, violation: Violation) -> Failure {
        match Truth::of(&asked.profile, Tolerance::TIGHT) {
            Ok(truth) => explain(&asked.profile, &self.estimator, &truth, violation),
            Err(failure) => failure,
        }
    }
}
