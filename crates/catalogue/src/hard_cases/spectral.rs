//! Rows 6 and 22: a wavelength that nothing attenuates, and one distance for two wavelengths.

use super::{HardCase, LAWFUL, Outcome};
use crate::profiles::constant;
use fairflight_freeflight::ClosedForm;
use fairflight_freeflight::spectral::{
    AverageScheme, HeroWavelength, MaxScheme, SeparateSolve, SharedDistance, SpectralFlight,
    SpectralFreeFlight, SpectralTracking,
};
use fairflight_laws::{CheckResult, Run, measure};
use fairflight_media::{Constant, RayQuadrature, Scaled, Tolerance, Wavelength};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::{Reference, Scores, judge};

/// σ_t of the channels of row 6.
const ONE_IS_CLEAR: [f64; 3] = [0.0, 1.0, 1.0];

type Clear = Scaled<Constant, 3>;

fn one_is_clear(length: f64) -> Clear {
    Scaled::new(constant(1.0, length), ONE_IS_CLEAR).expect(LAWFUL)
}

/// The weights of a path in a rod between walls of radiance 1, albedo 1, that flies back at each collision: radiance 1 for
/// each channel.
fn furnace<E: SpectralFreeFlight<Clear, 3>>(sampler: impl Fn(f64) -> E, source: &mut Seeded) -> [f64; 3] {
    const LENGTH: f64 = 1.5;
    let (mut weights, mut ahead) = ([1.0; 3], LENGTH);
    loop {
        match sampler(ahead).sample_from(&one_is_clear(ahead), weights, source) {
            SpectralFlight::Escaped { weights } => return weights,
            SpectralFlight::Collided { distance, weights: scattered } => {
                weights = scattered;
                ahead = LENGTH - (ahead - distance);
            }
        }
    }
}

/// Outcome of a judged furnace, channel by channel; where weights share a sum, each path must keep it to rounding.
fn judged_furnace(
    run: Run,
    most: Option<f64>,
    keeps_sum: bool,
    path: impl Fn(&mut Seeded) -> [f64; 3],
) -> Outcome {
    let scores = most.map_or(Scores::Unbounded, |maximum| Scores::Bounded { minimum: 0.0, maximum });
    let reference = Reference { scores, ..Reference::exact(1.0) };
    let run = Run { alpha: run.alpha / 3.0, ..run }.sufficient_for([reference], run.alpha / 3.0);
    let mut keeps = true;
    let (mut means, mut verdicts) = (Vec::new(), Vec::new());
    for (channel, name) in ["channel 0", "channel 1", "channel 2"].into_iter().enumerate() {
        let mut astray = 0.0_f64;
        let seed = derive_seed(run.seed, channel as u64);
        let moments = measure(seed, run.samples, |source| {
            let weights = path(source);
            astray = astray.max((weights.iter().sum::<f64>() / 3.0 - 1.0).abs());
            weights[channel]
        });
        let moments = match moments {
            Ok(moments) => moments,
            Err(error) => return Outcome::said(false, error.to_string()),
        };
        let verdict = judge(&moments, &reference, run.alpha);
        verdicts.push((name, CheckResult::of_verdict(&verdict, run.samples)));
        keeps &= !keeps_sum || astray <= 1e-12;
        means.push(format!("{:.4}", moments.mean().unwrap_or(f64::NAN)));
    }
    let evidence = CheckResult::of_all(verdicts);
    let passes = keeps && evidence.holds == Some(true);
    Outcome { evidence, ..Outcome::said(passes, means.join(", ")) }
}

/// Row 6 without a variate: collided and escaped weights of one flight add up to 1 for each channel.
fn exact_furnace() -> Outcome {
    let field = one_is_clear(1.5);
    let mut sums = Vec::new();
    for sampling in [1.0, 1.7] {
        let tracking = SpectralTracking::new(MaxScheme, constant(sampling, 1.5));
        for channel in 0..3 {
            let wavelength = Wavelength::new(&field, channel).expect(LAWFUL);
            let mut quadrature = RayQuadrature::new(wavelength, &[]);
            let collided = tracking.weights().collided(&mut quadrature, Tolerance::TIGHT, &|_| 1.0).value[0];
            sums.push(collided + tracking.weights().escaped(&mut quadrature, Tolerance::TIGHT)[0]);
        }
    }
    let worst = sums.into_iter().fold(1.0, |worst: f64, sum| {
        if (sum - 1.0).abs() > (worst - 1.0).abs() || sum.is_nan() { sum } else { worst }
    });
    Outcome::value(worst, 1.0, 1e-13)
}

/// Row 22: E\[weight²\] of σ_1 = 1 by distances of σ_2 = `ratio`, and by ours, over an optical depth of 50 and twice that: of more, the eighth
/// moment, which the quadrature carries along, is no number.
fn two_wavelengths(ratio: f64, run: Run) -> Outcome {
    let second_moments = |length: f64| {
        let field = Scaled::new(constant(1.0, length), [1.0, ratio]).expect(LAWFUL);
        let mut quadrature = RayQuadrature::new(Wavelength::new(&field, 0).expect(LAWFUL), &[]);
        let mut of = |sampler: &dyn ClosedForm<_>| {
            sampler.weights().collided(&mut quadrature, Tolerance::TIGHT, &|_| 1.0).value[1]
        };
        let shared = of(&SharedDistance::new(constant(ratio, length)));
        (shared, of(&SpectralTracking::new(MaxScheme, constant(ratio, length))))
    };
    let exact = |length: f64| {
        let rest = 2.0 - ratio;
        (if rest == 0.0 { length } else { -(-rest * length).exp_m1() / rest }) / ratio
    };
    let [(near, ours), (far, ours_far)] = [50.0, 100.0].map(second_moments);
    let is_formula = (near / exact(50.0) - 1.0).abs() < 1e-9 && (far / exact(100.0) - 1.0).abs() < 1e-9;
    // What the paper says: it settles below a ratio of 2, and only there. (At 1.9 e^−5 of it is still missing.)
    let settles = far / near < 1.01;
    let ours_settles = (ours_far / ours - 1.0).abs() < 1e-9;

    // The hero's weights are bounded by 2, so that its second moment is at most twice its mean, 1.
    let hero = HeroWavelength::new(constant(ratio, 100.0));
    let field = Scaled::new(constant(1.0, 100.0), [1.0, ratio]).expect(LAWFUL);
    let reference =
        Reference { scores: Scores::Bounded { minimum: 0.0, maximum: 2.0 }, ..Reference::exact(1.0) };
    let run = run.sufficient_for([reference], run.alpha);
    let moments = match measure(run.seed, run.samples, |source| hero.sample(&field, source).weights()[0]) {
        Ok(moments) => moments,
        Err(error) => return Outcome::said(false, error.to_string()),
    };
    let verdict = judge(&moments, &reference, run.alpha);
    let by_hero = moments.population_variance().unwrap_or(f64::NAN) + 1.0;
    let passes = is_formula
        && settles == (ratio < 2.0)
        && ours_settles
        // Weights within [0, 2], which the verdict asks for: a second moment of twice the mean at most.
        && verdict.sound == Some(true);
    let kind = if settles { "finite" } else { "infinite" };
    let text =
        format!("{kind} ({near:.4e} at depth 50, {far:.4e} at 100); max scheme {ours:.4}, hero {by_hero:.4}");
    Outcome { evidence: CheckResult::of_verdict(&verdict, run.samples), ..Outcome::said(passes, text) }
}

pub(super) fn cases() -> Vec<HardCase> {
    const SAMPLES: u64 = 20_000;
    const EXACT: &str = "1 for each channel (a furnace)";
    let of_furnace = |estimator: &'static str, kind, judged: fn(Run) -> Outcome| {
        let name = estimator.trim_start_matches("spectral flight, ");
        let title = format!("sigma_t = 0 in one channel, 1 in the others, a furnace, {name}");
        HardCase::statistical(6, title, estimator, EXACT, SAMPLES, judged).about([kind])
    };
    let mut cases = vec![
        HardCase::deterministic(
            6,
            "sigma_t = 0 in one channel, 1 in the others, one flight",
            "spectral flight, max scheme",
            "1 for each channel (collided and escaped)",
            "1e-13",
            exact_furnace,
        )
        .about(["spectral_tracking"]),
        of_furnace("spectral flight, average scheme", "spectral_tracking", |run| {
            let average = |ahead| SpectralTracking::new(AverageScheme, constant(1.0, ahead));
            judged_furnace(run, Some(3.0), true, |source| furnace(average, source))
        }),
        of_furnace("spectral flight, hero wavelength", "hero_wavelength", |run| {
            let hero = |ahead| HeroWavelength::new(constant(1.0, ahead));
            judged_furnace(run, Some(3.0), true, |source| furnace(hero, source))
        }),
        of_furnace("spectral flight, separate solve", "separate_solve", |run| {
            let separate = |ahead| SeparateSolve::new(ONE_IS_CLEAR.map(|sigma| constant(sigma, ahead)));
            judged_furnace(run, Some(3.0), true, |source| furnace(separate, source))
        }),
    ];
    for ratio in [1.9, 2.0, 2.1] {
        cases.push(HardCase {
            tolerance: "1e-9 of the second moments; the law of ours",
            ..HardCase::statistical(
                22,
                format!("two wavelengths, sigma_2 = {ratio} sigma_1"),
                "spectral flight, shared distance, max scheme, hero wavelength",
                format!(
                    "{} second moment by distances of sigma_2 (raab-2008 section 3.2), at most 2 by the hero",
                    if ratio < 2.0 { "finite" } else { "infinite" }
                ),
                SAMPLES,
                move |run| two_wavelengths(ratio, run),
            )
            .about(["shared_distance", "spectral_tracking", "hero_wavelength"])
        });
    }
    cases
}
