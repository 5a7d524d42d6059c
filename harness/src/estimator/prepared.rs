//! An estimator prepared for one profile, with what is known of it there.

use super::Trial;
use crate::Failure;
use fairflight_laws::Unit;
use fairflight_stats::Scores;
use std::fmt::Debug;
use std::sync::Arc;

/// The values that an estimate can take, in a unit.
type ScoresOf = dyn Fn(Unit) -> Scores + Send + Sync;
/// The reason why σ_t at a distance is not lawful; the place is given in words.
type Objection = dyn Fn(&str, f64, f64) -> String + Send + Sync;

/// An estimator prepared for one profile.
#[derive(Clone)]
pub struct Prepared {
    /// The estimator on the profile.
    pub trial: Arc<dyn Trial>,
    /// The majorant that it claims, if it needs one.
    pub claimed_majorant: Option<f64>,
    /// The source of its variance, in words.
    pub variance: String,
    /// Look-ups of the profile that preparing it cost; charged to every estimate.
    pub preparation_lookups: u64,
    /// Explorers whose fit costs time before the first estimate.
    pub explorers: Option<fairflight_transmittance::Explorers>,
    /// Distances at which the control or the sampling extinction is not smooth \[length\].
    pub breakpoints: Vec<f64>,
    /// True if estimates must be drawn one after another, since each learns from those before it.
    pub is_sequential: bool,
    /// True if its closed form takes tens of milliseconds and more.
    pub closed_form_is_costly: bool,
    pub(super) scores: Arc<ScoresOf>,
    pub(super) objection: Arc<Objection>,
}

impl Prepared {
    /// An estimator of which no more is known than how its variance is; estimates may take any value.
    pub(super) fn new(name: &'static str, trial: Arc<dyn Trial>, variance: impl Into<String>) -> Self {
        Self {
            trial,
            claimed_majorant: None,
            variance: variance.into(),
            preparation_lookups: 0,
            explorers: None,
            breakpoints: Vec::new(),
            is_sequential: false,
            closed_form_is_costly: false,
            scores: Arc::new(|_| Scores::Unbounded),
            objection: Arc::new(move |place, _, sigma_t| {
                format!("estimator: {name} is not defined for sigma_t = {sigma_t} at {place}")
            }),
        }
    }

    /// The same estimator with the majorant that it claims.
    pub(super) fn claiming(self, majorant: f64) -> Self {
        let otherwise = Arc::clone(&self.objection);
        let objection = move |place: &str, s: f64, sigma_t: f64| {
            if sigma_t > majorant {
                format!("estimator.majorant: {majorant} is none, since sigma_t = {sigma_t} at {place}")
            } else {
                otherwise(place, s, sigma_t)
            }
        };
        Self { claimed_majorant: Some(majorant), objection: Arc::new(objection), ..self }
    }

    /// The same estimator with the least and the greatest value that an estimate can take.
    pub(super) fn within(self, range: Option<(f64, f64)>) -> Self {
        let Some((minimum, maximum)) = range else { return self };
        self.scoring(move |unit| Scores::Bounded {
            minimum: minimum * unit.scale(),
            maximum: maximum * unit.scale(),
        })
    }

    /// The same estimator with the values that an estimate can take.
    pub(super) fn scoring(self, scores: impl Fn(Unit) -> Scores + Send + Sync + 'static) -> Self {
        Self { scores: Arc::new(scores), ..self }
    }

    /// The same estimator with the reason why a value of σ_t is not lawful.
    pub(super) fn objecting(
        self,
        objection: impl Fn(&str, f64, f64) -> String + Send + Sync + 'static,
    ) -> Self {
        Self { objection: Arc::new(objection), ..self }
    }

    /// The values that an estimate can take, in `unit`.
    #[must_use]
    pub fn scores(&self, unit: Unit) -> Scores {
        (self.scores)(unit)
    }

    /// The reason why σ_t at the distance `s` is not lawful; `place` is that distance in words.
    #[must_use]
    pub fn objection(&self, place: &str, s: f64, sigma_t: f64) -> Failure {
        Failure::refused((self.objection)(place, s, sigma_t))
    }
}

impl Debug for Prepared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Prepared")
            .field("trial", &self.trial)
            .field("variance", &self.variance)
            .finish_non_exhaustive()
    }
}
