//! Every check by name: what `verify` runs.

mod bidirectional;
mod exact;
mod exactly;
mod extensions;
mod freeflight;
mod media;
mod metropolis;
pub(crate) mod paths;
mod phase;
mod points;
mod specimen;
mod spectral;
mod vpl;

pub(crate) use media::{LAWFUL, analytic_cosine, voxels};
pub(crate) use specimen::{Specimen, SpecimenField};

use crate::function::{Function, joined};
use crate::{estimators, hard_cases, twins};
use fairflight_laws::{CheckResult, Run};
use fairflight_sources::named_seed;
use fairflight_stats::sidak_level;

/// False alarm of all checks together: one in a million.
pub const FAMILY_LEVEL: f64 = 1e-6;

/// The number of checks that share it: of those that draw. More than there are: the catalogue can grow, and no check changes its level,
/// its N or its verdict by that.
pub const FAMILY_SIZE: usize = 1000;

/// The false alarm of one check ([`sidak_level`]), whichever part of the catalogue is run.
#[must_use]
pub fn check_level() -> f64 {
    sidak_level(FAMILY_LEVEL, FAMILY_SIZE)
}

/// Law that a check is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// E\[estimate\] = exp(−τ), the variance of eq. 16 to 20 where that can be tested, and the expected look-ups.
    Transmittance,
    /// The variance in closed form, with a law mild enough that it is tested for sure.
    Variance,
    /// A biased baseline has the expectation that its theory states. Its bias is told, not judged.
    OwnExpectation,
    /// Weighted flights integrate any test function against σ_t T; their expected look-ups.
    FreeFlight,
    /// szirmay-kalos-2017 eq. 8, by exact algebra.
    Collision,
    /// A phase function is normalised, has its mean cosine, and is drawn as it is evaluated.
    Phase,
    /// An integrator's expectation is the radiance of the equation of transfer.
    Radiance,
    /// The weights of all strategies of a path sum to one.
    Partition,
    /// Two strategies, each weighted by both, find the same light.
    Pair,
    /// Importons and photons have the same expectation.
    Adjoint,
    /// Bounded connections and their compensation add up to unbounded ones.
    Compensation,
    /// The power of light paths is absorbed or escapes.
    Energy,
    /// No estimate exceeds its bound, and estimators coincide in their limits, by exact comparison.
    Bound,
    /// The squared energy of walks grows as their collisions say, by exact algebra.
    Growth,
    /// A decision has its probability, a direction the density that is told, a closed form is what it stands for: without chance.
    Exact,
    /// A wrong twin is rejected.
    WrongTwin,
    /// A hard case has its exact answer, or is refused where it must be.
    HardCase,
}

impl Law {
    /// The name in a result.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Transmittance => "transmittance",
            Self::Variance => "variance",
            Self::OwnExpectation => "own_expectation",
            Self::FreeFlight => "free_flight",
            Self::Collision => "collision",
            Self::Phase => "phase",
            Self::Radiance => "radiance",
            Self::Partition => "partition",
            Self::Pair => "pair",
            Self::Adjoint => "adjoint",
            Self::Compensation => "compensation",
            Self::Energy => "energy",
            Self::Bound => "bound",
            Self::Growth => "growth",
            Self::Exact => "exact",
            Self::WrongTwin => "wrong_twin",
            Self::HardCase => "hard_case",
        }
    }
}

/// Factor of the samples of a full run over those of a quick one.
const FULL: u64 = 5;

/// Thoroughness of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Seconds for all checks: enough for every law to be testable.
    Quick,
    /// Five times the samples.
    Full,
}

/// A named check.
#[derive(Debug)]
pub struct Check {
    /// Unique: `medium/estimator`, `series/medium/estimator`, `combs/medium/estimator`, `cells/medium/estimator`, `hybrid/medium/estimator`,
    /// `freeflight/medium/sampler`, `spectral/medium/sampler`, `points/set`, `paths/what/which`, `vpl/what/which`, `bidirectional/what/which`, `extensions/which`, `collision/model`,
    /// `phase/name`, `exact/what/which`, `twin/name`, `hard/number name`.
    pub id: String,
    /// The law.
    pub law: Law,
    /// The estimator or model, in words.
    pub estimator: String,
    /// The kinds of estimator, free-flight sampler and integrator that it draws from, by their names; of a wrong twin those
    /// whose law rejects it. None for a check of phase functions, point sets or rays alone.
    pub kinds: Vec<&'static str>,
    /// The medium, in words.
    pub medium: String,
    quick_samples: u64,
    function: Function<CheckResult>,
}

impl Check {
    pub(crate) fn new(
        id: impl Into<String>,
        law: Law,
        estimator: impl Into<String>,
        medium: impl Into<String>,
        quick_samples: u64,
        function: impl Fn(Run) -> CheckResult + Send + Sync + 'static,
    ) -> Self {
        Self {
            kinds: Vec::new(),
            id: id.into(),
            law,
            estimator: estimator.into(),
            medium: medium.into(),
            quick_samples,
            function: Function::new(function),
        }
    }

    /// The same, which also draws from these kinds.
    pub(crate) fn about(mut self, kinds: impl IntoIterator<Item = &'static str>) -> Self {
        self.kinds.extend(kinds);
        self
    }

    /// The N of this check. A twin is rejected, and a hard case decided, at the N that it states itself.
    #[must_use]
    pub fn samples(&self, effort: Effort) -> u64 {
        match (effort, self.law) {
            (
                Effort::Full,
                Law::Transmittance
                | Law::Variance
                | Law::OwnExpectation
                | Law::FreeFlight
                | Law::Phase
                | Law::Radiance
                | Law::Adjoint
                | Law::Compensation
                | Law::Energy,
            ) => FULL * self.quick_samples,
            _ => self.quick_samples,
        }
    }

    /// Runs the check. Its own seed is derived from `seed` and its name, so that a check keeps its numbers when others are
    /// added. `alpha` is its share of the false alarm: [`check_level`].
    #[must_use]
    pub fn run(&self, effort: Effort, seed: u64, alpha: f64) -> CheckResult {
        let seed = named_seed(seed, &self.id);
        self.function.run(Run { samples: self.samples(effort), seed, alpha })
    }
}

/// All checks, in the order of a report.
#[must_use]
pub fn catalogue() -> Vec<Check> {
    let mut checks = joined!(
        checks of exact, phase, media, estimators, freeflight, spectral, points, paths, vpl, bidirectional, extensions, metropolis, exactly
    );
    checks.extend(twins().into_iter().map(|twin| {
        let (id, samples, kinds) = (format!("twin/{}", twin.id), twin.samples, twin.kinds.clone());
        Check::new(id, Law::WrongTwin, twin.of, twin.profile, samples, move |run| {
            let rejection = twin.run(run);
            CheckResult {
                holds: Some(rejection.rejected),
                samples: run.samples,
                mean_z: rejection.mean_z,
                variance_z: rejection.variance_z,
                reason: rejection.reason,
                ..CheckResult::default()
            }
        })
        .about(kinds)
    }));
    checks.extend(hard_cases().into_iter().map(|case| {
        let (id, kinds) = (format!("hard/{} {}", case.number, case.title), case.kinds.clone());
        Check::new(id, Law::HardCase, case.estimator, case.title.clone(), case.samples, move |run| {
            let outcome = case.run(run);
            CheckResult {
                holds: Some(outcome.passes),
                samples: outcome.evidence.samples.max(run.samples),
                reason: outcome.ours,
                ..outcome.evidence
            }
        })
        .about(kinds)
    }));
    checks
}
