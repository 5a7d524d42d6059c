//! An estimator on a profile: the seam between the crates and the harness.

use crate::field::{Field, KnownField};
use fairflight_elementary::lanes::LANES;
use fairflight_media::{
    Breakpoints, Counted, Domain, Extinction, RayQuadrature, Tolerance, Violation, Watched,
};
use fairflight_sources::Seeded;
use fairflight_transmittance::lockstep::{self, Lockstep};
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

    /// True if estimates can be drawn [in lanes](Self::draw_lanes).
    fn runs_in_lanes(&self) -> bool {
        false
    }

    /// Fills the estimates of several streams side by side, each with the bits of [`draw`](Self::draw) from [`Seeded::new`] of its seed; returns the
    /// look-ups of each. `None` where a look-up may not have been lawful: one stream after the other tells which.
    fn draw_lanes(&self, _seeds: [u64; LANES], _estimates: &mut [&mut [f64]; LANES]) -> Option<[u64; LANES]> {
        None
    }

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

/// An estimator that runs in lanes on a field, also where look-ups are watched.
pub trait InLanes<F: Extinction>:
    Lockstep<F> + for<'a> Lockstep<lockstep::Watched<'a, F, Self>> + Sized + 'static
{
}

impl<F: Extinction, E: Lockstep<F> + for<'a> Lockstep<lockstep::Watched<'a, F, E>> + 'static> InLanes<F>
    for E
{
}

/// Function that draws in lanes.
type Fill<T> = fn(&T, [u64; LANES], &mut [&mut [f64]; LANES]) -> Option<[u64; LANES]>;

/// An estimator of one type on a field of one type.
#[derive(Debug)]
pub struct On<F, E> {
    field: F,
    estimator: E,
    upper_bound: f64,
    /// The same in lanes, of an estimator that runs in some.
    fill: Option<Fill<Self>>,
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

    fn runs_in_lanes(&self) -> bool {
        self.fill.is_some()
    }

    fn draw_lanes(&self, seeds: [u64; LANES], estimates: &mut [&mut [f64]; LANES]) -> Option<[u64; LANES]> {
        self.fill.and_then(|fill| fill(self, seeds, estimates))
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

impl<F: KnownField, E> On<F, E> {
    /// The estimator on the field.
    pub fn trial(field: F, estimator: E) -> Arc<dyn Trial>
    where
        Self: Trial + 'static,
    {
        Arc::new(Self::new(field, estimator))
    }

    fn new(field: F, estimator: E) -> Self {
        let upper_bound = field.knowledge().upper_bound.unwrap_or(f64::INFINITY);
        Self { field, estimator, upper_bound, fill: None }
    }
}

impl<F: KnownField, E: InLanes<F>> On<F, E> {
    /// The same of an estimator that runs in lanes.
    pub fn trial_in_lanes(field: F, estimator: E) -> Arc<dyn Trial>
    where
        Self: Trial + 'static,
    {
        let fill: Fill<Self> = |trial, seeds, estimates| {
            let watched = lockstep::Watched::new(&trial.field, &trial.estimator, trial.upper_bound);
            let lookups = lockstep::fill(&trial.estimator, &watched, seeds, estimates);
            watched.all_lawful().then_some(lookups)
        };
        Arc::new(Self { fill: Some(fill), ..Self::new(field, estimator) })
    }
}

impl<F, E> On<F, E> {
    fn lawful(&self) -> Lawful<&F, &E> {
        Lawful { field: &self.field, estimator: &self.estimator, upper_bound: self.upper_bound }
    }
}
