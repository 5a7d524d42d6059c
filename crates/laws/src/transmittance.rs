//! The law of transmittance as a function of any estimator: E\[estimate\] = exp(−τ).
//!
//! One run tests three things at once: the mean, the variance against its closed form, and the number of look-ups; and
//! that every look-up was lawful.

mod in_lanes;

use crate::lookups::{self, LookupLaw};
use crate::{NotFinite, Run, Truth, Unit, batch_count, batch_moments, draw_batch};
use fairflight_media::{Counted, Domain, Extinction, Violation, Watched};
use fairflight_stats::reference::ROUNDING;
use fairflight_stats::{ClosedMoments, Moments, Reference, Scores, Verdict, judge};
use fairflight_transmittance::{Theory, TransmittanceEstimator};

pub use in_lanes::check_in_lanes;

/// Expectations about the estimates of one profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expectation {
    /// The optical thickness.
    pub truth: Truth,
    /// The law of one estimate, relative to exp(−τ).
    pub theory: Theory,
    /// The values that one estimate can take, in [`Unit::of`] the optical thickness.
    pub scores: Scores,
    /// Law of the look-ups of one estimate.
    pub lookups: LookupLaw,
}

impl Expectation {
    /// The unit of the estimates.
    #[must_use]
    pub fn unit(&self) -> Unit {
        Unit::of(self.truth.optical_thickness)
    }

    /// The reference that estimates are judged against, in [`Self::unit`].
    ///
    /// The error of the mean is that of τ, and its rounding: ε of τ is ε τ of exp(−τ), which shows in no logarithm of a
    /// mean of 1. Where T is out of the range of numbers nothing is known but the mean.
    #[must_use]
    pub fn reference(&self) -> Reference {
        let Self { truth, theory, scores, .. } = self;
        let one = self.unit().exp(-truth.optical_thickness);
        let mean = one * theory.relative_mean;
        let error = mean * (truth.error.exp_m1() + ROUNDING * truth.optical_thickness.abs());
        let moments =
            (one == 1.0).then(|| ClosedMoments::from_central(mean, &theory.relative_central.map(Some)));
        let variance_bound =
            Some(theory.relative_variance_bound).filter(|bound| one == 1.0 && bound.is_finite());
        Reference { error, moments, variance_bound, scores: *scores, ..Reference::exact(mean) }
    }

    /// The reference that the look-ups are judged against; `None` where nothing is known of them.
    #[must_use]
    pub fn lookups_reference(&self) -> Option<Reference> {
        lookups::reference(self.theory.lookups, self.lookups)
    }

    /// The share of the false alarm that goes to the estimates, and again to the look-ups where these are judged.
    fn level(&self, alpha: f64) -> f64 {
        if self.lookups_reference().is_some() { 0.5 * alpha } else { alpha }
    }

    /// The same run with as many samples as the closed moments of estimates and look-ups ask for, where they are known.
    #[must_use]
    pub fn sufficient(&self, run: Run) -> Run {
        let level = self.level(run.alpha);
        run.sufficient_for([Some(self.reference()), self.lookups_reference()].into_iter().flatten(), level)
    }
}

/// The outcome of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// The moments of the estimates, in the unit of the expectation.
    pub estimates: Moments,
    /// Verdict on mean and variance.
    pub verdict: Verdict,
    /// The moments of the number of look-ups.
    pub lookups: Moments,
    /// Verdict on the mean number of look-ups; `None` where nothing is known of it.
    pub lookups_verdict: Option<Verdict>,
}

impl Evidence {
    /// True if all laws hold; `None` if none is broken and one is not testable.
    #[must_use]
    pub fn holds(&self) -> Option<bool> {
        let lookups = self.lookups_verdict.as_ref().map_or(Some(true), |verdict| verdict.sound);
        match (self.verdict.sound, lookups) {
            (Some(false), _) | (_, Some(false)) => Some(false),
            (Some(true), Some(true)) => Some(true),
            _ => None,
        }
    }
}

/// Reason why there is no evidence.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// A look-up found what the estimator is not defined for.
    #[error("sigma_t = {} at s = {} is outside what the estimator admits", .0.sigma_t, .0.s)]
    Unlawful(Violation),
    /// An estimate is no number.
    #[error(transparent)]
    NotFinite(#[from] NotFinite),
}

/// The values of σ_t that an estimator admits on a field: what a law check watches for.
#[derive(Clone, Copy, Debug)]
pub struct Admitted<G, E> {
    /// The field.
    pub field: G,
    /// The estimator.
    pub estimator: E,
}

impl<G: Extinction, E: TransmittanceEstimator<G>> Domain for Admitted<G, E> {
    #[inline]
    fn admits(&self, s: f64, sigma_t: f64) -> bool {
        self.estimator.admits(&self.field, s, sigma_t)
    }
}

/// A field whose look-ups are counted and watched.
pub type Observed<G, E> = Counted<Watched<G, Admitted<G, E>>>;

/// Runs `estimator` on `field` (both cheap to copy: pass references) and judges mean, variance and look-ups.
///
/// Half of the false alarm goes to the estimates, half to the look-ups; all of it to the estimates where nothing is known
/// of the look-ups.
///
/// # Errors
/// If a look-up or an estimate is not lawful: a law says nothing then.
pub fn check<
    G: Extinction + Copy,
    E: TransmittanceEstimator<G> + TransmittanceEstimator<Observed<G, E>> + Copy,
>(
    field: G,
    estimator: E,
    expected: &Expectation,
    run: Run,
) -> Result<Evidence, Refusal> {
    let mut observed: Observed<G, E> = Counted::new(Watched::new(field, Admitted { field, estimator }));
    let mut tally = Tally::new(expected, run);
    for batch in 0..batch_count(run.samples) {
        tally.draw(&estimator, &mut observed, batch)?;
    }
    Ok(tally.judged())
}

/// A run, batch after batch.
struct Tally<'a> {
    expected: &'a Expectation,
    run: Run,
    /// Of the unit of the expectation.
    scale: f64,
    estimates: Moments,
    lookups: Moments,
    values: Vec<f64>,
    counts: Vec<f64>,
}

impl<'a> Tally<'a> {
    fn new(expected: &'a Expectation, run: Run) -> Self {
        let (estimates, lookups) = (Moments::new(), Moments::new());
        let scale = expected.unit().scale();
        Self { expected, run, scale, estimates, lookups, values: Vec::new(), counts: Vec::new() }
    }

    /// Draws a batch from its stream.
    fn draw<G: Extinction, E: TransmittanceEstimator<G> + TransmittanceEstimator<Observed<G, E>>>(
        &mut self,
        estimator: &E,
        observed: &mut Observed<G, E>,
        batch: u64,
    ) -> Result<(), Refusal> {
        let (mut values, mut counts) = (std::mem::take(&mut self.values), std::mem::take(&mut self.counts));
        counts.clear();
        draw_batch(self.run.seed, batch, self.run.samples, &mut values, |source| {
            let before = observed.lookups();
            let estimate = estimator.estimate(observed, source);
            counts.push((observed.lookups() - before) as f64);
            estimate
        });
        if let Some(violation) = observed.field().violation() {
            return Err(Refusal::Unlawful(violation));
        }
        self.add(batch, &mut values, &counts)?;
        (self.values, self.counts) = (values, counts);
        Ok(())
    }

    /// Adds the estimates of a batch, and the look-ups of each.
    fn add(&mut self, batch: u64, estimates: &mut [f64], lookups: &[f64]) -> Result<(), NotFinite> {
        estimates.iter_mut().for_each(|estimate| *estimate *= self.scale);
        self.estimates.merge(&batch_moments(self.run.seed, batch, estimates)?);
        self.lookups.merge(&Moments::from_slice(lookups));
        Ok(())
    }

    fn judged(self) -> Evidence {
        let Self { expected, run, estimates, lookups, .. } = self;
        let (lookups_reference, level) = (expected.lookups_reference(), expected.level(run.alpha));
        Evidence {
            verdict: judge(&estimates, &expected.reference(), level),
            lookups_verdict: lookups_reference.map(|reference| judge(&lookups, &reference, level)),
            estimates,
            lookups,
        }
    }
}

/// Judges as [`check`] for the estimates alone, unwatched and uncounted: what a wrong twin is tried with. All of the false
/// alarm goes to the estimates.
///
/// # Errors
/// If an estimate is no number.
pub fn check_estimates<G: Extinction, E: TransmittanceEstimator<G>>(
    field: G,
    estimator: E,
    expected: &Expectation,
    run: Run,
) -> Result<Verdict, NotFinite> {
    let scale = expected.unit().scale();
    let measured =
        crate::measure(run.seed, run.samples, |source| scale * estimator.estimate(&field, source))?;
    Ok(judge(&measured, &expected.reference(), run.alpha))
}
