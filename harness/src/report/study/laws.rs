//! Closed forms of many estimators on one ray, from one set of quadrature nodes.

use super::Subject;
use crate::Failure;
use crate::plan::{AnyEstimator, Estimator, EstimatorJob, Field, FieldJob, KnownField, Lawful};
use crate::reference::Prediction;
use fairflight_media::{Breakpoints, Cumulative, Domain, Extinction, RayQuadrature, Tolerance};
use fairflight_transmittance::Explorers;

/// The nodes of one ray with the extinction there, shared by every closed form.
///
/// Noise of twelve octaves has 10^4 breakpoints on a ray. With all of them the quadrature is exact to rounding (that is how
/// the transmittance itself is known) but takes a tenth of a second per closed form. Where there are so many, the
/// partition ignores them: at a nominal 1 % the errors found against the exact one are 1e-5, as the finest octaves average
/// out; a plotted curve and a variance measured from 10^4 samples need no more.
#[derive(Clone, Debug)]
pub(super) struct SharedLaws {
    nodes: RayQuadrature<()>,
    rough: bool,
    tolerance: Tolerance,
}

/// Beyond this number of breakpoints a ray is rough.
const MOST_BREAKPOINTS: usize = 512;

/// Integrals over a random shift (line integral, jittered marching) start from one panel and stop here on a rough ray; all
/// others keep the partition that was settled once.
const PANELS_OF_A_SHIFT: usize = 32;

impl SharedLaws {
    pub(super) fn of(subject: &Subject) -> Self {
        subject.profile.with(Settle)
    }

    /// The law of `estimator`; `None` where it is not defined on this ray.
    ///
    /// # Errors
    /// If the estimator claims a majorant that no field can have.
    pub(super) fn law(
        &self,
        subject: &Subject,
        estimator: &AnyEstimator,
    ) -> Result<Option<Prediction>, Failure> {
        let greatest = subject.facts.maximum;
        if estimator.claimed_majorant().is_some_and(|majorant| majorant < greatest) {
            return Ok(None);
        }
        subject.profile.with(LawJob { shared: self, subject, estimator })
    }
}

impl SharedLaws {
    /// ∫_0^s of σ_t and of eq. 17's variance introduction density of the double particle model,
    /// w = (σ_t − σ_main)²/σ_samp, as functions of s.
    pub(super) fn running(&self, subject: &Subject, control: &Explorers, sigma_samp: f64) -> Cumulative<2> {
        subject.profile.with(Running { shared: self, control, sigma_samp })
    }
}

struct Running<'a> {
    shared: &'a SharedLaws,
    control: &'a Explorers,
    sigma_samp: f64,
}

impl FieldJob for Running<'_> {
    type Output = Cumulative<2>;
    fn run<F: KnownField>(self, field: &F) -> Cumulative<2>
    where
        for<'a> &'a F: Field,
    {
        let mut quadrature = self.shared.nodes.with_field(field);
        quadrature.split_at(&self.control.breakpoints());
        quadrature.cumulative(self.shared.tolerance, |s, sigma_t| {
            [sigma_t, (sigma_t - self.control.sigma_t(s)).powi(2) / self.sigma_samp]
        })
    }
}

/// A field that may keep its breakpoints to itself.
#[derive(Clone, Copy, Debug)]
struct Thinned<'a, F> {
    field: &'a F,
    rough: bool,
}

impl<F: Extinction> Extinction for Thinned<'_, F> {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.field.sigma_t(s)
    }
    #[inline]
    fn length(&self) -> f64 {
        self.field.length()
    }
}

impl<F: Breakpoints> Breakpoints for Thinned<'_, F> {
    fn breakpoints(&self) -> Vec<f64> {
        if self.rough { Vec::new() } else { self.field.breakpoints() }
    }
}

struct Settle;

impl FieldJob for Settle {
    type Output = SharedLaws;
    fn run<F: KnownField>(self, field: &F) -> SharedLaws
    where
        for<'a> &'a F: Field,
    {
        let rough = field.breakpoints().len() > MOST_BREAKPOINTS;
        let mut quadrature = RayQuadrature::new(Thinned { field, rough }, &[]);
        let settled = Tolerance { relative: if rough { 1e-2 } else { 1e-9 }, ..Tolerance::to(1e-9) };
        quadrature.integrate(settled, |_, sigma_t| [sigma_t, sigma_t.powi(2), sigma_t.powi(4)]);
        let tolerance =
            if rough { Tolerance { most_panels: PANELS_OF_A_SHIFT, ..settled } } else { Tolerance::to(1e-9) };
        SharedLaws { nodes: quadrature.with_field(()), rough, tolerance }
    }
}

#[derive(Clone, Copy)]
struct LawJob<'a> {
    shared: &'a SharedLaws,
    subject: &'a Subject,
    estimator: &'a AnyEstimator,
}

impl FieldJob for LawJob<'_> {
    type Output = Result<Option<Prediction>, Failure>;
    fn run<F: KnownField>(self, field: &F) -> Self::Output
    where
        for<'a> &'a F: Field,
    {
        let thinned = Thinned { field, rough: self.shared.rough };
        self.estimator.with::<Thinned<'_, F>, _>(&thinned, self)
    }
}

impl EstimatorJob for LawJob<'_> {
    type Output = Option<Prediction>;
    fn run<G: Field, E: Estimator<G>>(self, field: G, estimator: E) -> Self::Output {
        let Self { shared, subject, estimator: any } = self;
        let mut quadrature = shared.nodes.with_field(field);
        quadrature.split_at(&any.breakpoints());
        let lawful = Lawful { field, estimator, upper_bound: f64::INFINITY };
        let admitted = |quadrature: &RayQuadrature<G>| {
            quadrature.nodes().all(|(s, sigma_t)| sigma_t.is_finite() && lawful.admits(s, sigma_t))
        };
        if !admitted(&quadrature) {
            return None;
        }
        let theory = estimator.theory(&mut quadrature, subject.truth.optical_thickness, shared.tolerance);
        Some(Prediction { theory, observed: subject.truth.observed })
    }
}
