//! Closed forms of many estimators on one ray, from one set of quadrature nodes.

use super::Subject;
use fairflight_harness::Failure;
use fairflight_harness::estimator::{AnyPieces, Prepared};
use fairflight_harness::field::KnownField;
use fairflight_harness::reference::Prediction;
use fairflight_media::{Breakpoints, Cumulative, Extinction, RayQuadrature, Tolerance};
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
        let field = subject.profile.field();
        let rough = field.breakpoints().len() > MOST_BREAKPOINTS;
        let mut quadrature = RayQuadrature::new(Thinned { field, rough }, &[]);
        let settled = Tolerance { relative: if rough { 1e-2 } else { 1e-9 }, ..Tolerance::to(1e-9) };
        quadrature.integrate(settled, |_, sigma_t| [sigma_t, sigma_t.powi(2), sigma_t.powi(4)]);
        let tolerance =
            if rough { Tolerance { most_panels: PANELS_OF_A_SHIFT, ..settled } } else { Tolerance::to(1e-9) };
        Self { nodes: quadrature.with_field(()), rough, tolerance }
    }

    /// True of a ray with so many breakpoints that closed forms are not exact to rounding.
    pub(super) fn is_rough(&self) -> bool {
        self.rough
    }

    /// The law of `estimator`; `None` where it is not defined on this ray.
    ///
    /// # Errors
    /// If the estimator claims a majorant that no field can have.
    pub(super) fn law(&self, subject: &Subject, estimator: &Prepared) -> Result<Option<Prediction>, Failure> {
        let greatest = subject.facts.maximum;
        if estimator.claimed_majorant.is_some_and(|majorant| majorant < greatest) {
            return Ok(None);
        }
        let thinned = Thinned { field: subject.profile.field(), rough: self.rough };
        let mut nodes = self.nodes.with_field(&thinned as AnyPieces<'_>);
        nodes.split_at(&estimator.breakpoints);
        if !nodes.nodes().all(|(s, sigma_t)| sigma_t.is_finite() && estimator.trial.admits(s, sigma_t)) {
            return Ok(None);
        }
        let theory = estimator.trial.theory(&mut nodes, subject.truth.optical_thickness, self.tolerance);
        Ok(Some(Prediction { theory, observed: subject.truth.observed }))
    }

    /// ∫_0^s of σ_t and of eq. 17's variance introduction density of the double particle model,
    /// w = (σ_t − σ_main)²/σ_samp, as functions of s.
    pub(super) fn running(&self, subject: &Subject, control: &Explorers, sigma_samp: f64) -> Cumulative<2> {
        let mut quadrature = self.nodes.with_field(subject.profile.field());
        quadrature.split_at(&control.breakpoints());
        quadrature.cumulative(self.tolerance, |s, sigma_t| {
            [sigma_t, (sigma_t - control.sigma_t(s)).powi(2) / sigma_samp]
        })
    }
}

/// A field that may keep its breakpoints to itself.
#[derive(Clone, Copy, Debug)]
struct Thinned<'a> {
    field: &'a dyn KnownField,
    rough: bool,
}

impl Extinction for Thinned<'_> {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.field.sigma_t(s)
    }
    #[inline]
    fn length(&self) -> f64 {
        self.field.length()
    }
}

impl Breakpoints for Thinned<'_> {
    fn breakpoints(&self) -> Vec<f64> {
        if self.rough { Vec::new() } else { self.field.breakpoints() }
    }
}
