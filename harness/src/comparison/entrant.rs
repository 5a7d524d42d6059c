//! Who takes part: an estimator whose parameters follow from the ray.

use super::TestRay;
use crate::Failure;
use crate::plan::{AnyEstimator, Beyond};
use crate::spec::{
    BeyondSpec, BoundsSpec, CellsSpec, CombKind, ControlSpec, EstimatorSpec, NextFlightKind, PSeriesKind,
    RouletteSpec, SamplingSpec, TeethSpec,
};
use fairflight_transmittance::{Choice, CombShape, Experience, Hybrid, Roulette};

/// What an entrant may know beside the ray: nothing of it comes from the variates that will estimate.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// The mean of σ_t over the medium \[1/length\].
    pub mean: f64,
    /// What earlier rays taught.
    pub experience: Experience,
}

/// An estimator whose parameters follow from the ray.
#[derive(Clone, Copy, Debug)]
pub struct Entrant {
    /// What it is called.
    pub name: &'static str,
    /// Whether it is published; else it is of this project.
    pub published: bool,
    /// Whether it asks for a majorant and a minorant in cells along the ray.
    pub needs_cells: bool,
    parameters: fn(&TestRay, &Facts) -> Parameters,
}

/// What an entrant makes of a ray.
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
    pub fn on(&self, ray: &TestRay, facts: &Facts) -> Result<AnyEstimator, Failure> {
        match (self.parameters)(ray, facts) {
            Parameters::Spec(spec) => AnyEstimator::build(&spec, &ray.profile),
            Parameters::Hybrid { budget } => Ok(AnyEstimator::Beyond(Beyond::hybrid(
                &facts.experience,
                ray.profile.length(),
                ray.majorant,
                budget,
            ))),
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

    /// What it runs as on a ray, as an experiment's estimator; a hybrid as what it chose.
    #[must_use]
    pub fn spec(&self, ray: &TestRay, facts: &Facts) -> Option<EstimatorSpec> {
        match (self.parameters)(ray, facts) {
            Parameters::Spec(spec) => Some(spec),
            Parameters::Hybrid { .. } => {
                Some(EstimatorSpec::Beyond(match self.hybrid(ray, facts)?.choice() {
                    Choice::Marching(marching) => BeyondSpec::UnbiasedRayMarching {
                        teeth: TeethSpec::Given(marching.comb().teeth()),
                        comb: match marching.comb().shape() {
                            CombShape::EndpointMatched => CombKind::EndpointMatched,
                            _ => CombKind::Uniform,
                        },
                        roulette: RouletteSpec::Stop(marching.roulette().stop_probability()),
                        segments: marching.segments(),
                    },
                    Choice::Jittered(jittered) => BeyondSpec::JitteredRatio {
                        bounds: BoundsSpec::Majorant(ray.majorant),
                        epsilon: jittered.epsilon(),
                    },
                }))
            }
        }
    }
}

/// The optical thickness of the majorant.
fn depth(ray: &TestRay) -> f64 {
    ray.majorant * ray.profile.length()
}

/// As many look-ups as ratio tracking has on average, 1 at least.
fn as_many(ray: &TestRay) -> u32 {
    depth(ray).round().max(1.0) as u32
}

fn double(sigma_samp: f64, control: ControlSpec) -> Parameters {
    let sampling = SamplingSpec::Constant(sigma_samp);
    Parameters::Spec(EstimatorSpec::DoubleParticle { sampling, control })
}

fn beyond(spec: BeyondSpec) -> Parameters {
    Parameters::Spec(EstimatorSpec::Beyond(spec))
}

fn next_flight(ray: &TestRay, version: NextFlightKind) -> Parameters {
    beyond(BeyondSpec::NextFlight { majorant: ray.majorant, version })
}

fn p_series(ray: &TestRay, version: PSeriesKind) -> Parameters {
    beyond(BeyondSpec::PSeries { version, pivot: Some(depth(ray)) })
}

/// A comb of as many teeth as the rule gives for the majorant.
fn by_the_rule(ray: &TestRay, comb: CombKind, roulette: RouletteSpec, segments: u32) -> Parameters {
    let teeth = TeethSpec::Rule { pivot: Some(depth(ray)) };
    beyond(BeyondSpec::UnbiasedRayMarching { teeth, comb, roulette, segments })
}

/// P = 0.1 (kettunen-2021).
const USUAL: RouletteSpec = RouletteSpec::Stop(0.9);

/// The roulette that fits the variance of earlier combs; the usual one before there are any.
fn tuned(ray: &TestRay, facts: &Facts) -> RouletteSpec {
    match facts.experience.matched_variance(ray.profile.length()) {
        Some(k2) => RouletteSpec::Stop(Roulette::tuned(k2).stop_probability()),
        None => USUAL,
    }
}

fn telescoping(ray: &TestRay, level_ratio: f64, endpoint_matching: bool) -> Parameters {
    beyond(BeyondSpec::Telescoping { teeth: as_many(ray), level_ratio, endpoint_matching })
}

fn jittered(ray: &TestRay, epsilon: f64) -> Parameters {
    beyond(BeyondSpec::JitteredRatio { bounds: BoundsSpec::Majorant(ray.majorant), epsilon })
}

/// One cell per unit of the majorant's optical thickness.
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
        published("ratio tracking", |ray, _| double(ray.majorant, ControlSpec::None)),
        published("track length", |ray, _| {
            Parameters::Spec(EstimatorSpec::Woodcock { majorant: ray.majorant })
        }),
        published("residual ratio, global mean", |ray, facts| {
            double(2.0 * ray.majorant, ControlSpec::Constant(facts.mean))
        }),
        published("explorers and residual ratio", |ray, _| {
            let count = (1.2 * depth(ray)).floor().max(1.0) as usize + 1;
            double(0.4 * ray.majorant, ControlSpec::Explorers { count })
        }),
        published("next-flight delta", |ray, _| next_flight(ray, NextFlightKind::Delta)),
        published("next-flight ratio", |ray, _| next_flight(ray, NextFlightKind::Ratio)),
        published("unidirectional", |ray, _| next_flight(ray, NextFlightKind::Unidirectional)),
        published("bidirectional", |ray, _| next_flight(ray, NextFlightKind::Bidirectional)),
        published("p-series CMF", |ray, _| p_series(ray, PSeriesKind::Cmf)),
        published("p-series cumulative", |ray, _| p_series(ray, PSeriesKind::Cumulative)),
        published("p-series next-flight", |ray, _| p_series(ray, PSeriesKind::NextFlight)),
        published("adaptive ratio", |ray, _| {
            beyond(BeyondSpec::AdaptiveRatio { majorant: ray.majorant, floor: 0.1 })
        }),
        published("telescoping", |ray, _| telescoping(ray, 0.9, false)),
        published("unbiased ray marching", |ray, _| by_the_rule(ray, CombKind::Uniform, USUAL, 1)),
        published("unbiased ray marching, matched", |ray, _| {
            by_the_rule(ray, CombKind::EndpointMatched, USUAL, 1)
        }),
        in_cells(published("residual ratio in cells", |ray, _| {
            beyond(BeyondSpec::ResidualCells { cells: cells(ray), rate: 1.0 })
        })),
        ours("telescoping, matched", |ray, _| telescoping(ray, 0.82, true)),
        ours("matched, self-tuned", |ray, facts| {
            by_the_rule(ray, CombKind::EndpointMatched, tuned(ray, facts), 1)
        }),
        ours("periodised comb", |ray, _| by_the_rule(ray, CombKind::Periodised, USUAL, 1)),
        ours("Bernoulli comb 2", |ray, _| by_the_rule(ray, CombKind::Bernoulli2, USUAL, 1)),
        ours("Bernoulli comb 3", |ray, _| by_the_rule(ray, CombKind::Bernoulli3, USUAL, 1)),
        ours("factorised, one tooth", |ray, facts| {
            // As many segments as the rule has teeth; each has its share of the variance.
            let segments = fairflight_transmittance::teeth_for(depth(ray));
            let roulette = match facts.experience.apart_variance(ray.profile.length()) {
                Some(k2) => RouletteSpec::Stop(Roulette::tuned(k2 / f64::from(segments)).stop_probability()),
                None => USUAL,
            };
            beyond(BeyondSpec::UnbiasedRayMarching {
                teeth: TeethSpec::Given(1),
                comb: CombKind::Uniform,
                roulette,
                segments,
            })
        }),
        ours("jittered ratio, 0.5", |ray, _| jittered(ray, 0.5)),
        ours("jittered ratio, 0.25", |ray, _| jittered(ray, 0.25)),
        in_cells(ours("jittered ratio in cells, 0.25", |ray, _| {
            beyond(BeyondSpec::JitteredRatio { bounds: BoundsSpec::Cells(cells(ray)), epsilon: 0.25 })
        })),
        ours("hybrid, frugal", |_, _| Parameters::Hybrid { budget: 2.0 }),
        ours("hybrid", |_, _| Parameters::Hybrid { budget: Hybrid::USUAL_BUDGET }),
    ]
}
