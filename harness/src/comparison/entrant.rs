//! Entrants of a comparison: estimators whose parameters follow from the ray.

use super::TestRay;
use crate::Failure;
use crate::estimator::{
    AdaptiveRatioSpec, CellsSpec, ControlSpec, DoubleParticleSpec, EstimatorSpec, GeneralisedPoissonSpec,
    HybridSpec, JackknifeSpec, JitteredRatioSpec, LineIntegralSpec, NaiveSpec, NextFlightKind,
    NextFlightSpec, PSeriesSpec, Prepared, ProgressiveMajorantSpec, RayMarchingSpec, RegularSpec,
    ResidualCellsSpec, RouletteSpec, SamplingSpec, SingleParticleSpec, TelescopingSpec,
    UnbiasedRayMarchingSpec, WoodcockSpec,
};
use crate::reader::Kind;
use fairflight_collision::{Albedo, Version};
use fairflight_transmittance::{
    Choice, CombShape, Experience, Hybrid, Offset, PSeriesVersion, Roulette, teeth_for,
};

/// Facts that an entrant may know beside the ray: nothing of it comes from the variates that will estimate.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// The mean of σ_t over the medium \[1/length\].
    pub mean: f64,
    /// The pilots of earlier rays.
    pub experience: Experience,
}

/// An estimator whose parameters follow from the ray.
#[derive(Clone, Copy, Debug)]
pub struct Entrant {
    /// Name in tables and plots.
    pub name: &'static str,
    /// True if it is published; else it is of this project.
    pub published: bool,
    /// True if it asks for a majorant and a minorant in cells along the ray.
    pub needs_cells: bool,
    parameters: fn(&TestRay, &Facts) -> Parameters,
}

/// Parameters of an entrant for one ray.
#[derive(Clone, Debug)]
enum Parameters {
    Spec(EstimatorSpec),
    Hybrid { budget: f64 },
}

impl Entrant {
    /// The estimator for a ray.
    ///
    /// # Errors
    /// If it is not defined there.
    pub fn on(&self, ray: &TestRay, facts: &Facts) -> Result<Prepared, Failure> {
        match (self.parameters)(ray, facts) {
            Parameters::Spec(spec) => spec.kind().prepare(&ray.profile),
            Parameters::Hybrid { budget } => {
                Prepared::hybrid(&facts.experience, &ray.profile, ray.majorant, budget)
            }
        }
    }

    /// The hybrid that it is on a ray, if it is one.
    #[must_use]
    pub fn hybrid(&self, ray: &TestRay, facts: &Facts) -> Option<Hybrid> {
        match (self.parameters)(ray, facts) {
            Parameters::Spec(_) => None,
            Parameters::Hybrid { budget } => {
                let length = ray.profile.length();
                Some(Hybrid::choose(&facts.experience, length, ray.majorant * length, budget))
            }
        }
    }

    /// The value of `kind` in its specs.
    #[must_use]
    pub fn kind(&self, ray: &TestRay, facts: &Facts) -> &'static str {
        match (self.parameters)(ray, facts) {
            Parameters::Spec(spec) => spec.name(),
            Parameters::Hybrid { .. } => HybridSpec::NAME,
        }
    }

    /// True if the mean of σ_t decides a parameter. On a ray alone that mean times the length is the answer.
    #[must_use]
    pub fn knows_the_mean(&self, ray: &TestRay, facts: &Facts) -> bool {
        let other = Facts { mean: 0.5 * facts.mean, ..facts.clone() };
        self.spec(ray, facts) != self.spec(ray, &other)
    }

    /// The estimator that it runs as on a ray, as in an experiment; for a hybrid the one that it chose.
    #[must_use]
    pub fn spec(&self, ray: &TestRay, facts: &Facts) -> Option<EstimatorSpec> {
        match (self.parameters)(ray, facts) {
            Parameters::Spec(spec) => Some(spec),
            Parameters::Hybrid { .. } => Some(match self.hybrid(ray, facts)?.choice() {
                Choice::Marching(marching) => UnbiasedRayMarchingSpec {
                    roulette: RouletteSpec::Stop(marching.roulette().stop_probability()),
                    segments: marching.segments(),
                    ..UnbiasedRayMarchingSpec::of(marching.comb().shape(), marching.comb().teeth())
                }
                .into(),
                Choice::Jittered(jittered) => {
                    JitteredRatioSpec::below(ray.majorant, jittered.epsilon()).into()
                }
            }),
        }
    }
}

/// The optical thickness of the majorant.
fn depth(ray: &TestRay) -> f64 {
    ray.majorant * ray.profile.length()
}

/// Number of look-ups that ratio tracking has on average, 1 at least.
fn as_many(ray: &TestRay) -> u32 {
    depth(ray).round().max(1.0) as u32
}

fn spec(spec: impl Into<EstimatorSpec>) -> Parameters {
    Parameters::Spec(spec.into())
}

fn double(sigma_samp: f64, control: ControlSpec) -> Parameters {
    spec(DoubleParticleSpec::at(sigma_samp, control))
}

fn next_flight(ray: &TestRay, version: NextFlightKind) -> Parameters {
    spec(NextFlightSpec { majorant: ray.majorant, version })
}

fn p_series(ray: &TestRay, version: PSeriesVersion) -> Parameters {
    spec(PSeriesSpec { version, pivot: Some(depth(ray)) })
}

/// A comb of as many teeth as the rule gives for the majorant.
fn by_the_rule(ray: &TestRay, shape: CombShape, roulette: RouletteSpec) -> Parameters {
    let marching = UnbiasedRayMarchingSpec::of(shape, 1).by_the_rule(depth(ray));
    spec(UnbiasedRayMarchingSpec { roulette, ..marching })
}

const USUAL: RouletteSpec = RouletteSpec::USUAL;

/// The roulette that fits the variance of earlier combs; the usual one before there are any.
fn tuned(ray: &TestRay, facts: &Facts) -> RouletteSpec {
    match facts.experience.matched_variance(ray.profile.length()) {
        Some(k2) => RouletteSpec::Stop(Roulette::tuned(k2).stop_probability()),
        None => USUAL,
    }
}

fn telescoping(ray: &TestRay, level_ratio: f64, endpoint_matching: bool) -> Parameters {
    spec(TelescopingSpec { teeth: as_many(ray), level_ratio, endpoint_matching })
}

fn jittered(ray: &TestRay, epsilon: f64) -> Parameters {
    spec(JitteredRatioSpec::below(ray.majorant, epsilon))
}

/// Cells along the ray, one per unit of the majorant's optical thickness.
fn cells(ray: &TestRay) -> CellsSpec {
    CellsSpec::Count(as_many(ray))
}

const fn entrant(
    name: &'static str,
    published: bool,
    parameters: fn(&TestRay, &Facts) -> Parameters,
) -> Entrant {
    Entrant { name, published, needs_cells: false, parameters }
}

/// All entrants, ratio tracking first.
#[must_use]
pub fn entrants() -> Vec<Entrant> {
    let published = |name, parameters| entrant(name, true, parameters);
    let ours = |name, parameters| entrant(name, false, parameters);
    let in_cells = |entrant: Entrant| Entrant { needs_cells: true, ..entrant };
    vec![
        published("ratio tracking", |ray, _| double(ray.majorant, ControlSpec::none())),
        published("track length", |ray, _| spec(WoodcockSpec { majorant: ray.majorant })),
        published("residual ratio, global mean", |ray, facts| {
            double(2.0 * ray.majorant, ControlSpec::constant(facts.mean))
        }),
        published("explorers and residual ratio", |ray, _| {
            let count = (1.2 * depth(ray)).floor().max(1.0) as u32 + 1;
            double(0.4 * ray.majorant, ControlSpec::through(count))
        }),
        published("next-flight delta", |ray, _| next_flight(ray, NextFlightKind::Delta)),
        published("next-flight ratio", |ray, _| next_flight(ray, NextFlightKind::Ratio)),
        published("unidirectional", |ray, _| next_flight(ray, NextFlightKind::Unidirectional)),
        published("bidirectional", |ray, _| next_flight(ray, NextFlightKind::Bidirectional)),
        published("p-series CMF", |ray, _| p_series(ray, PSeriesVersion::Cmf)),
        published("p-series cumulative", |ray, _| p_series(ray, PSeriesVersion::Cumulative)),
        published("p-series next-flight", |ray, _| p_series(ray, PSeriesVersion::NextFlight)),
        published("adaptive ratio", |ray, _| spec(AdaptiveRatioSpec { majorant: ray.majorant, floor: 0.1 })),
        published("telescoping", |ray, _| telescoping(ray, 0.9, false)),
        published("unbiased ray marching", |ray, _| by_the_rule(ray, CombShape::Uniform, USUAL)),
        published("unbiased ray marching, matched", |ray, _| {
            by_the_rule(ray, CombShape::EndpointMatched, USUAL)
        }),
        in_cells(published("residual ratio in cells", |ray, _| {
            spec(ResidualCellsSpec { cells: cells(ray), rate: 1.0 })
        })),
        ours("telescoping, matched", |ray, _| telescoping(ray, 0.82, true)),
        ours("matched, self-tuned", |ray, facts| {
            by_the_rule(ray, CombShape::EndpointMatched, tuned(ray, facts))
        }),
        ours("periodised comb", |ray, _| by_the_rule(ray, CombShape::Periodised, USUAL)),
        ours("Bernoulli comb 2", |ray, _| by_the_rule(ray, CombShape::Bernoulli2, USUAL)),
        ours("Bernoulli comb 3", |ray, _| by_the_rule(ray, CombShape::Bernoulli3, USUAL)),
        ours("factorised, one tooth", |ray, facts| {
            // As many segments as the rule has teeth; each has its share of the variance.
            let segments = teeth_for(depth(ray));
            let roulette = match facts.experience.apart_variance(ray.profile.length()) {
                Some(k2) => RouletteSpec::Stop(Roulette::tuned(k2 / f64::from(segments)).stop_probability()),
                None => USUAL,
            };
            let marching = UnbiasedRayMarchingSpec::of(CombShape::Uniform, 1);
            spec(UnbiasedRayMarchingSpec { roulette, segments, ..marching })
        }),
        ours("jittered ratio, 0.5", |ray, _| jittered(ray, 0.5)),
        ours("jittered ratio, 0.25", |ray, _| jittered(ray, 0.25)),
        in_cells(ours("jittered ratio in cells, 0.25", |ray, _| {
            spec(JitteredRatioSpec::in_cells(cells(ray), 0.25))
        })),
        ours("hybrid, frugal", |_, _| Parameters::Hybrid { budget: 2.0 }),
        ours("hybrid", |_, _| Parameters::Hybrid { budget: Hybrid::USUAL_BUDGET }),
    ]
}

/// Teeth of each of two combs that share those of the rule.
fn half(ray: &TestRay) -> u32 {
    (teeth_for(depth(ray)) / 2).max(1)
}

fn single(ray: &TestRay, version: Version) -> Parameters {
    /// Walks that rarely end.
    const ALBEDO: f64 = 0.9;
    spec(SingleParticleSpec {
        version,
        albedo: Albedo::new(ALBEDO).unwrap_or_default(),
        sigma_samp: SamplingSpec::Constant(ray.majorant),
        control: ControlSpec::none(),
    })
}

/// A progressive majorant begins with this share of the majorant.
const GUESS: f64 = 0.1;
/// Flights of a line integral.
const SPLITS: u32 = 8;

/// Estimators that take no part in contests: biased baselines, the closed form, and those that another is never worse than.
#[must_use]
pub fn others() -> Vec<Entrant> {
    let published = |name, parameters| entrant(name, true, parameters);
    vec![
        published("terminating", |ray, _| single(ray, Version::Terminating)),
        published("non-terminating", |ray, _| single(ray, Version::NonTerminating)),
        published("adaptive", |ray, _| single(ray, Version::Adaptive)),
        published("line integral", |ray, _| {
            spec(LineIntegralSpec { majorant: ray.majorant, splits: SPLITS })
        }),
        published("generalised Poisson", |ray, _| {
            spec(GeneralisedPoissonSpec { pivot: depth(ray), rate: depth(ray) })
        }),
        published("regular", |_, _| spec(RegularSpec {})),
        published("ray marching (biased)", |ray, _| spec(RayMarchingSpec::at(as_many(ray), Offset::Fixed))),
        published("jackknife (biased)", |ray, _| spec(JackknifeSpec { teeth: half(ray) })),
        published("naive (biased)", |ray, _| spec(NaiveSpec { teeth: half(ray) })),
        published("progressive majorant (biased)", |ray, _| {
            spec(ProgressiveMajorantSpec { start: GUESS * ray.majorant })
        }),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::AnyProfile;
    use crate::reference::Truth;
    use fairflight_media::{Constant, Tolerance};

    #[test]
    fn every_kind_is_an_entrant_or_among_the_others() {
        let profile = AnyProfile::Constant(Constant::new(0.5, 4.0).unwrap());
        let truth = Truth::of(&profile, Tolerance::TIGHT).unwrap();
        let ray = TestRay { profile, truth, majorant: 1.0 };
        let all: Vec<Entrant> = entrants().into_iter().chain(others()).collect();
        let kinds: Vec<&str> = all.iter().map(|entrant| entrant.kind(&ray, &Facts::default())).collect();
        let missing: Vec<_> = EstimatorSpec::NAMES.iter().filter(|name| !kinds.contains(name)).collect();
        assert!(missing.is_empty(), "not in reports: {missing:?}");
        for entrant in all {
            assert_eq!(
                entrant.knows_the_mean(&ray, &Facts { mean: 0.5, ..Facts::default() }),
                entrant.name == "residual ratio, global mean"
            );
        }
    }
}
