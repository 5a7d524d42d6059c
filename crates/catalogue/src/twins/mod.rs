//! Wrong twins: estimators with one line wrong, each a mistake that public code or a printed listing has made.
//!
//! A law that nothing can break tests nothing. Each statistical twin states its profile, its N and the |z| that it shows
//! there, far above what is critical; each deterministic one is rejected by an exact assertion.

mod bidirectional;
mod exactly;
mod extensions;
mod freeflight;
mod jittered_flight;
mod metropolis;
mod paths;
mod phase;
mod points;
mod spectral;
pub(crate) mod trial;
mod vpl;

use crate::estimators;
use crate::function::{Function, joined};
use crate::vectors::{Answer, Replay, Variates, Vector};
use fairflight_laws::Run;
use fairflight_laws::freeflight::{FlightEvidence, FlightRefusal};
use fairflight_stats::Verdict;

/// Result of a check on a twin.
#[derive(Clone, Debug, PartialEq)]
pub struct Rejection {
    /// True if the twin was rejected, as it should be.
    pub rejected: bool,
    /// The z-score of its mean, where it has one.
    pub mean_z: Option<f64>,
    /// The z-score of its variance, where it has one.
    pub variance_z: Option<f64>,
    /// Reason, in words.
    pub reason: String,
}

impl Rejection {
    /// An exact assertion.
    pub(crate) fn exact(rejected: bool, reason: impl Into<String>) -> Self {
        Self { rejected, mean_z: None, variance_z: None, reason: reason.into() }
    }

    /// The verdict on a mean.
    fn of_mean(verdict: Verdict) -> Self {
        let Verdict { sound, mean_z, reason, .. } = verdict;
        Self { rejected: sound == Some(false), mean_z, variance_z: None, reason }
    }

    /// The evidence of flights, told by the score `shows`.
    fn of_flights(evidence: Result<FlightEvidence, FlightRefusal>, shows: &str) -> Self {
        match evidence {
            Ok(evidence) => {
                let verdict = evidence.verdict(shows);
                Self {
                    rejected: evidence.holds() == Some(false),
                    mean_z: verdict.and_then(|verdict| verdict.mean_z),
                    variance_z: None,
                    reason: verdict.map_or(String::new(), |verdict| verdict.reason.clone()),
                }
            }
            Err(refusal) => Self::exact(true, refusal.to_string()),
        }
    }
}

/// Evidence by which a twin is rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Evident {
    /// A wrong mean: the |z| expected at the stated N.
    Mean {
        /// (E\[twin\] − T)/standard error of the right estimator.
        z: f64,
    },
    /// A wrong variance: the |z| expected at the stated N.
    Variance {
        /// (right − wrong variance)/standard error of the wrong one.
        z: f64,
    },
    /// An exact assertion.
    Exactly,
}

/// A wrong twin.
#[derive(Debug)]
pub struct Twin {
    /// Unique name.
    pub id: &'static str,
    /// The estimator that it is a twin of, in words.
    pub of: &'static str,
    /// The kinds of estimator, sampler or integrator whose law rejects it; none for a twin of a phase function or a point set.
    pub kinds: Vec<&'static str>,
    /// The wrong line, and who wrote it.
    pub mistake: &'static str,
    /// The profile, or the scene, on which it is tried.
    pub profile: &'static str,
    /// N; 0 for an exact assertion.
    pub samples: u64,
    /// Evidence by which it is rejected.
    pub evident: Evident,
    function: Function<Rejection>,
    replay: Option<Replay>,
}

impl Twin {
    pub(crate) fn new(
        of: &'static str,
        id: &'static str,
        mistake: &'static str,
        profile: &'static str,
        (samples, evident): (u64, Evident),
        function: impl Fn(Run) -> Rejection + Send + Sync + 'static,
    ) -> Self {
        Self {
            of,
            kinds: Vec::new(),
            id,
            mistake,
            profile,
            samples,
            evident,
            function: Function::new(function),
            replay: None,
        }
    }

    /// The same, which makes an answer of the test vectors of its estimator: the answer to a case, `None` of one that it has no parameters for.
    pub(crate) fn answers(
        mut self,
        answer: impl Fn(&Vector<'_>, &mut Variates<'_>) -> Option<Answer> + Send + Sync + 'static,
    ) -> Self {
        self.replay = Some(Replay::new(answer));
        self
    }

    /// True of a twin of something that has test vectors.
    #[must_use]
    pub fn has_vectors(&self) -> bool {
        self.replay.is_some()
    }

    /// Its answer to a test vector; `None` of one that is not of its estimator, or that it has no parameters for.
    #[must_use]
    pub fn answer(&self, vector: &Vector<'_>, source: &mut Variates<'_>) -> Option<Answer> {
        self.replay.as_ref()?.answer(vector, source)
    }

    /// The same, which the law of these kinds rejects.
    pub(crate) fn about(mut self, kinds: impl IntoIterator<Item = &'static str>) -> Self {
        self.kinds.extend(kinds);
        self
    }

    /// Tries the twin.
    #[must_use]
    pub fn run(&self, run: Run) -> Rejection {
        self.function.run(run)
    }
}

/// All wrong twins.
#[must_use]
pub fn twins() -> Vec<Twin> {
    joined!(
        twins of estimators, exactly, freeflight, jittered_flight, spectral, points, phase, paths, extensions, vpl,
        bidirectional, metropolis
    )
}
