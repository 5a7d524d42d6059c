//! Estimators beyond the source papers, of any kind.

mod build;
mod cells;
mod erased;
mod exact;
mod learning;
mod progressive;
mod range;

pub use learning::pilot;
pub(super) use learning::{PILOTS, TUNING};

use erased::{AnyField, AnyPieces, Erased};
use fairflight_laws::Unit;
use fairflight_media::{Breakpoints, Extinction, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use fairflight_stats::Scores;
use fairflight_transmittance::{ClosedForm, Theory, TransmittanceEstimator};
use std::sync::Arc;

/// An estimator beyond the source papers, prepared for one profile.
#[derive(Clone, Debug)]
pub struct Beyond {
    estimator: Arc<dyn Erased>,
    facts: Facts,
}

/// What the plan knows of it.
#[derive(Clone, Debug, Default)]
struct Facts {
    /// The name of its kind.
    kind: &'static str,
    /// The majorant that it claims.
    majorant: Option<f64>,
    /// The values that an estimate can take, where they are bounded.
    range: Option<(f64, f64)>,
    /// How the variance is known.
    variance: &'static str,
    /// What was chosen for it, in words.
    chosen: Option<String>,
    /// Whether estimates must be drawn one after another, since each learns from those before it.
    sequential: bool,
    /// Whether its closed form is an integral for each of many segments.
    costly: bool,
}

impl Beyond {
    /// The majorant that the estimator claims, if it needs one.
    #[must_use]
    pub fn claimed_majorant(&self) -> Option<f64> {
        self.facts.majorant
    }

    /// The name of its kind.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.facts.kind
    }

    /// Whether estimates must be drawn one after another, since each learns from those before it.
    #[must_use]
    pub fn is_sequential(&self) -> bool {
        self.facts.sequential
    }

    /// Whether its closed form takes tens of milliseconds and more.
    #[must_use]
    pub fn closed_form_is_costly(&self) -> bool {
        self.facts.costly
    }

    /// How its variance is known, in words.
    #[must_use]
    pub fn variance_method(&self) -> String {
        match &self.facts.chosen {
            Some(chosen) => format!("{}; {chosen}", self.facts.variance),
            None => self.facts.variance.to_owned(),
        }
    }

    /// Which values an estimate can take.
    #[must_use]
    pub fn scores(&self, unit: Unit) -> Scores {
        match self.facts.range {
            Some((minimum, maximum)) => {
                Scores::Bounded { minimum: minimum * unit.scale(), maximum: maximum * unit.scale() }
            }
            None => Scores::Unbounded,
        }
    }
}

impl<F: Extinction> TransmittanceEstimator<F> for Beyond {
    #[inline]
    fn estimate<S: UniformSource + ?Sized>(&self, field: &F, mut source: &mut S) -> f64 {
        self.estimator.estimate(field as AnyField<'_>, &mut source)
    }

    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        self.estimator.admits(field as AnyField<'_>, s, sigma_t)
    }
}

impl<F: Breakpoints> ClosedForm<F> for Beyond {
    fn theory(
        &self,
        quadrature: &mut RayQuadrature<F>,
        optical_thickness: f64,
        tolerance: Tolerance,
    ) -> Theory {
        let erased = quadrature.with_field(quadrature.field() as AnyPieces<'_>);
        self.estimator.theory(&erased, optical_thickness, tolerance)
    }
}
