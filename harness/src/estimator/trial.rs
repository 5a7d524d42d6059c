//! An estimator on a profile: the seam between the crates and the harness.

use crate::field::{Field, KnownField};
use fairflight_media::{Breakpoints, Counted, Domain, RayQuadrature, Tolerance, Violation, Watched};
use fairflight_sources::Seeded;
use fairflight_transmittance::{ClosedForm, Theory, TransmittanceEstimator};
use std::fmt::Debug;
use std::sync::Arc;

/// An estimator on a profile. One call draws a whole batch: what happens per look-up is compiled for the field.
pub trait Trial: Debug + Send + Sync {
    /// Fills `estimates` from one stream; the first look-up that is not lawful, if there is one.
    ///
    /// # Errors
    /// If a look-up is not finite, exceeds the majorant that the profile declares, or is not admitted by the estimator.
    fn draw(&self, source: &mut Seeded, estimates: &mut [f64]) -> Result<(), Violation>;

    /// Look-ups of so many estimates from the same stream.
    fn count(&self, source: &mut Seeded, estimates: u64) -> u64;

    /// True where the estimator and the declared majorant admit σ_t \[1/length\] at the distance `s` \[length\].
    fn admits(&self, s: f64, sigma_t: f64) -> bool;

    /// The law of one estimate, in units of T; the nodes grow where it needs more.
    fn theory(&self, nodes: &mut RayQuadrature<&dyn Breakpoints>, tau: f64, tolerance: Tolerance) -> Theory;
}

/// A field behind a pointer, with its breakpoints.
pub type AnyPieces<'a> = &'a dyn Breakpoints;

/// An estimator on a field, also where look-ups are watched and counted.
pub trait Estimator<G: Field>:
    Copy
    + Sync
    + TransmittanceEstimator<G>
    + TransmittanceEstimator<Watched<G, Lawful<G, Self>>>
    + TransmittanceEstimator<Counted<Watched<G, Lawful<G, Self>>>>
{
}

impl<G: Field, E> Estimator<G> for E
where
    E: Copy + Sync + TransmittanceEstimator<G>,
    E: TransmittanceEstimator<Watched<G, Lawful<G, E>>>,
    E: TransmittanceEstimator<Counted<Watched<G, Lawful<G, E>>>>,
{
}

/// The values of σ_t that are lawful for an estimator on a field about which a majorant is declared.
#[derive(Clone, Copy, Debug)]
pub struct Lawful<G, E> {
    /// The field.
    pub field: G,
    /// The estimator.
    pub estimator: E,
    /// The declared majorant, infinite without one.
    pub upper_bound: f64,
}

impl<G: Field, E: TransmittanceEstimator<G>> Domain for Lawful<G, E> {
    #[inline]
    fn admits(&self, s: f64, sigma_t: f64) -> bool {
        sigma_t <= self.upper_bound && self.estimator.admits(&self.field, s, sigma_t)
    }
}

/// An estimator of one type on a field of one type.
#[derive(Debug)]
pub struct On<F, E> {
    field: F,
    estimator: E,
    upper_bound: f64,
}

impl<F: KnownField + Debug + Send, E: Debug + Send + Sync + for<'a> ClosedForm<AnyPieces<'a>>> Trial
    for On<F, E>
where
    for<'a> &'a F: Field,
    for<'a> &'a E: Estimator<&'a F>,
{
    fn draw(&self, source: &mut Seeded, estimates: &mut [f64]) -> Result<(), Violation> {
        let estimator = &self.estimator;
        let watched = Watched::new(&self.field, self.lawful());
        estimates.iter_mut().for_each(|estimate| *estimate = estimator.estimate(&watched, source));
        watched.violation().map_or(Ok(()), Err)
    }

    fn count(&self, source: &mut Seeded, estimates: u64) -> u64 {
        let estimator = &self.estimator;
        let counting = Counted::new(Watched::new(&self.field, self.lawful()));
        for _ in 0..estimates {
            estimator.estimate(&counting, source);
        }
        counting.lookups()
    }

    fn admits(&self, s: f64, sigma_t: f64) -> bool {
        self.lawful().admits(s, sigma_t)
    }

    fn theory(&self, nodes: &mut RayQuadrature<AnyPieces<'_>>, tau: f64, tolerance: Tolerance) -> Theory {
        self.estimator.theory(nodes, tau, tolerance)
    }
}

impl<F, E> On<F, E> {
    /// The estimator on the field.
    pub fn trial(field: F, estimator: E) -> Arc<dyn Trial>
    where
        F: KnownField,
        Self: Trial + 'static,
    {
        let upper_bound = field.knowledge().upper_bound.unwrap_or(f64::INFINITY);
        Arc::new(Self { field, estimator, upper_bound })
    }

    fn lawful(&self) -> Lawful<&F, &E> {
        Lawful { field: &self.field, estimator: &self.estimator, upper_bound: self.upper_bound }
    }
}
