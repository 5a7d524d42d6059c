//! Every estimator of transmittance by its kind: how one is made for a profile, and what it admits there.

use super::profile::Profile;
use super::{Found, Subject};
use crate::checks::FirstEstimate;
use crate::hard_cases::LAWFUL;
use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version};
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::{Observed, check};
use fairflight_laws::{CheckResult, Expectation, Run, Truth};
use fairflight_media::{Extinction, Majorant, RayQuadrature, Tolerance, Vacuum};
use fairflight_stats::Scores;
use fairflight_transmittance::{
    AdaptiveRatio, Bidirectional, ClosedForm, Comb, CombShape, Experience, GeneralisedPoisson, Hybrid,
    Jackknife, JitteredRatio, JitteredRatioInCells, LineIntegral, NextFlight, NextFlightVersion, Offset,
    PSeries, PSeriesVersion, ProgressiveMajorant, RayMarching, Regular, ResidualCells, Roulette, Telescoping,
    Theory, Tracking, TransmittanceEstimator, UnbiasedRayMarching, Unidirectional, Woodcock,
};

/// An estimator of the `kind`, called `name`, which admits σ_t `above` the majorant and `below` 0 as it is stated; a function of the
/// profile makes it. A macro, because no bound says of a type that it is an estimator for every lifetime of an observed field.
macro_rules! estimator {
    ($kind:literal, $name:literal, above: $above:literal, below: $below:literal, |$profile:pat_param| $make:expr) => {
        Subject::new(
            ($kind, $name),
            ($above, $below),
            |profile, run| {
                let $profile = profile;
                law(profile, &$make, run)
            },
            |profile| {
                let $profile = profile;
                watched(profile, &$make)
            },
            |profile, source| {
                let $profile = profile;
                $make.estimate(profile, source).is_finite()
            },
        )
    };
}

/// Estimators of every kind, several of a kind with versions.
pub(super) fn subjects() -> Vec<Subject> {
    let all = vec![
        estimator!("woodcock", "woodcock", above: false, below: false, |_| Woodcock),
        estimator!("double_particle", "double particle", above: true, below: true, |profile| {
            let model = DoubleParticle { albedo: Albedo::default() };
            Tracking::new(model, Vacuum::new(profile.length()), profile.rates(1.0))
        }),
        estimator!("single_particle", "terminating", above: false, below: false, |profile| {
            single(profile, Version::Terminating)
        }),
        estimator!("single_particle", "non-terminating", above: true, below: true, |profile| {
            single(profile, Version::NonTerminating)
        }),
        estimator!("single_particle", "adaptive", above: true, below: true, |profile| {
            single(profile, Version::Adaptive)
        }),
        estimator!("line_integral", "line integral of 4", above: false, below: false, |_| {
            LineIntegral::new(4).expect(LAWFUL)
        }),
        estimator!("ray_marching", "midpoints", above: true, below: true, |_| {
            RayMarching::new(4, Offset::Fixed).expect(LAWFUL)
        }),
        estimator!("ray_marching", "one offset", above: true, below: true, |_| {
            RayMarching::new(4, Offset::Jittered).expect(LAWFUL)
        }),
        estimator!("naive", "naive", above: true, below: true, |_| {
            RayMarching::new(7, Offset::Jittered).expect(LAWFUL)
        }),
        estimator!("next_flight", "delta", above: false, below: false, |_| {
            NextFlight::new(NextFlightVersion::Delta)
        }),
        estimator!("next_flight", "ratio", above: true, below: true, |_| {
            NextFlight::new(NextFlightVersion::Ratio)
        }),
        estimator!("next_flight", "unidirectional", above: true, below: true, |_| Unidirectional),
        estimator!("next_flight", "bidirectional", above: true, below: true, |_| Bidirectional),
        estimator!("p_series", "cmf", above: true, below: true, |profile| series(profile, PSeriesVersion::Cmf)),
        estimator!("p_series", "cumulative", above: true, below: true, |profile| {
            series(profile, PSeriesVersion::Cumulative)
        }),
        estimator!("p_series", "ratio", above: true, below: true, |profile| {
            series(profile, PSeriesVersion::Ratio)
        }),
        estimator!("p_series", "next flight", above: true, below: true, |profile| {
            series(profile, PSeriesVersion::NextFlight)
        }),
        estimator!("generalised_poisson", "generalised poisson", above: true, below: true, |profile| {
            // Ratio tracking with its points unsorted; its rate is positive.
            let depth = if profile.depth() > 0.0 { profile.depth() } else { 1.0 };
            GeneralisedPoisson::new(depth, depth).expect(LAWFUL)
        }),
        estimator!("adaptive_ratio", "adaptive ratio", above: true, below: true, |_| {
            AdaptiveRatio::new(0.1).expect(LAWFUL)
        }),
        estimator!("unbiased_ray_marching", "whole", above: true, below: true, |_| {
            UnbiasedRayMarching::new(comb(), Roulette::KETTUNEN)
        }),
        estimator!("unbiased_ray_marching", "in segments", above: true, below: true, |_| {
            UnbiasedRayMarching::new(comb(), Roulette::KETTUNEN).in_segments(4).expect(LAWFUL)
        }),
        estimator!("telescoping", "telescoping", above: true, below: true, |_| {
            Telescoping::new(4, 0.8, CombShape::EndpointMatched).expect(LAWFUL)
        }),
        estimator!("jackknife", "jackknife", above: true, below: true, |_| Jackknife::new(comb())),
        estimator!("jittered_ratio", "one majorant", above: false, below: false, |_| {
            JitteredRatio::new(0.5).expect(LAWFUL)
        }),
        estimator!("jittered_ratio", "in cells", above: false, below: true, |_| {
            JitteredRatioInCells::new(0.5).expect(LAWFUL)
        }),
        estimator!("residual_cells", "residual cells", above: false, below: true, |_| ResidualCells::default()),
        estimator!("hybrid", "hybrid without experience", above: false, below: false, |profile| {
            Hybrid::choose(&Experience::default(), profile.length(), profile.depth(), Hybrid::USUAL_BUDGET)
        }),
        estimator!("regular", "regular", above: true, below: true, |_| Regular),
        estimator!("progressive_majorant", "first estimate", above: true, below: false, |profile| {
            // One look-up on average where there is no majorant to begin with.
            let guess = if profile.depth() > 0.0 { profile.majorant() } else { 1.0 / profile.length().max(1.0) };
            FirstEstimate { guess, start: ProgressiveMajorant::new(guess).expect(LAWFUL) }
        }),
    ];
    all.into_iter().map(|subject| Subject { is_tried: trials(&subject), ..subject }).collect()
}

/// Selects the profiles that an estimator is tried on.
fn trials(subject: &Subject) -> fn(&Profile) -> bool {
    match (subject.kind, subject.name) {
        // It connects all points of two walks.
        (_, "bidirectional") => |profile| profile.depth() <= 100.0,
        // Their law is one of each stratum.
        ("hybrid", _) | ("jittered_ratio", "one majorant") => |profile| profile.depth() <= 3e3,
        ("jittered_ratio", _) => |profile| profile.depth_in_cells() <= 3e3,
        // A look-up for each mean free path of one majorant.
        ("woodcock" | "line_integral" | "next_flight" | "p_series", _)
        | ("generalised_poisson" | "adaptive_ratio" | "progressive_majorant", _) => {
            |profile| profile.depth() <= 1e7
        }
        _ => |_| true,
    }
}

fn single(profile: &Profile, version: Version) -> Tracking<SingleParticle, Vacuum, Profile> {
    let model = SingleParticle { version, albedo: Albedo::new(0.5).expect(LAWFUL) };
    Tracking::new(model, Vacuum::new(profile.length()), profile.rates(1.0))
}

fn series(profile: &Profile, version: PSeriesVersion) -> PSeries {
    PSeries::with_majorant(version, profile).expect(LAWFUL)
}

fn comb() -> Comb {
    Comb::new(4, CombShape::EndpointMatched).expect(LAWFUL)
}

/// The law of `estimator`: as many estimates as it asks for, and as `run` says, within the budget.
fn law<'f, E>(profile: &'f Profile, estimator: &E, run: Run) -> Found
where
    E: ClosedForm<Profile>,
    for<'e> &'e E: TransmittanceEstimator<&'f Profile> + TransmittanceEstimator<Observed<&'f Profile, &'e E>>,
{
    let truth = Truth::closed_form(profile);
    let mut quadrature = RayQuadrature::new(profile.clone(), &profile.borders());
    let theory = estimator.theory(&mut quadrature, truth.optical_thickness, Tolerance::TIGHT);
    let expected = Expectation { truth, theory, scores: Scores::Unbounded, lookups: LookupLaw::Unknown };
    let cost = if theory.lookups.is_finite() { theory.lookups } else { profile.depth() };
    let samples = super::affordable(expected.sufficient(run).samples, cost);
    let evidence = check(profile, estimator, &expected, Run { samples, ..run });
    Found {
        result: CheckResult::of_evidence(&evidence),
        refused: evidence.err().map(|refusal| refusal.to_string()),
    }
}

/// Refusals among the look-ups of a hundred estimates.
fn watched<'f, E>(profile: &'f Profile, estimator: &E) -> Found
where
    for<'e> &'e E: TransmittanceEstimator<&'f Profile> + TransmittanceEstimator<Observed<&'f Profile, &'e E>>,
{
    // What is expected does not matter: nothing is judged before every look-up was lawful.
    let truth = Truth { optical_thickness: 1.0, error: 0.0 };
    let theory = Theory::mean_only(1.0);
    let expected = Expectation { truth, theory, scores: Scores::Unbounded, lookups: LookupLaw::Unknown };
    let evidence = check(profile, estimator, &expected, super::WATCHED);
    Found { result: CheckResult::default(), refused: evidence.err().map(|refusal| refusal.to_string()) }
}
