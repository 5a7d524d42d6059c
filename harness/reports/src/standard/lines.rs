//! Estimators with all their parameters on one ray: those of the papers, and all others with usual parameters.

use super::Run;
use super::Subject;
use super::laws::SharedLaws;
use super::result::{Refusal, Series, SweepCurve};
use super::series::{EXPLORERS, Entry, SPLITS};
use super::sweep::known_variance;
use fairflight_collision::Albedo;
use fairflight_harness::Failure;
use fairflight_harness::comparison::{Entrant, Facts, entrants, facts_of, others};
use fairflight_harness::estimator::EstimatorSpec;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::plan::Plan;
use fairflight_harness::reference::Prediction;
use fairflight_sources::Seeded;
use fairflight_transmittance::Theory;
use serde_json::Value;

/// An estimator with all its parameters.
pub(super) struct Line {
    pub(super) series: Series,
    pub(super) kind: &'static str,
    pub(super) parameters: String,
    pub(super) spec: EstimatorSpec,
    /// The law of one estimate; of its mean alone where no more is known.
    pub(super) law: Prediction,
    /// Look-ups of one estimate without preparation: expected ones, or counted where these are not known.
    pub(super) lookups: f64,
    /// True where the answer is presumed.
    pub(super) is_oracle: bool,
    /// True of an estimator of the papers.
    pub(super) is_of_the_papers: bool,
}

impl Line {
    /// True if estimates differ: those of the closed form itself do not.
    pub(super) fn varies(&self) -> bool {
        known_variance(&self.law.theory) != Some(0.0)
    }
}

/// All estimators on the ray of a subject, and those that are not defined on it.
pub(super) fn all(
    run: &Run<'_>,
    subject: &Subject,
    laws: &SharedLaws,
    sweeps: &[SweepCurve],
) -> Result<(Vec<Line>, Vec<Refusal>), Failure> {
    let mut lines = of_the_papers(subject, laws, sweeps)?;
    let ray = subject.ray(subject.majorant);
    let seed = |name: &str| run.seed(format_args!("lines/{}/{name}", subject.id));
    let facts = facts_of(&ray, seed("facts"));
    let is_new = |entrant: &Entrant| lines.iter().all(|line| line.series != Series::of(entrant.name));
    let entrants: Vec<Entrant> = entrants().into_iter().chain(others()).filter(is_new).collect();
    let found = try_in_parallel(entrants.len(), &|i| {
        let entrant = entrants[i];
        Ok(of_entrant(subject, laws, entrant, &facts, seed(entrant.name))
            .map_err(|failure| Refusal { series: Series::of(entrant.name), reason: failure.to_string() }))
    })?;
    let mut refused = Vec::new();
    for line in found {
        match line {
            Ok(line) => lines.push(line),
            Err(refusal) => refused.push(refusal),
        }
    }
    Ok((lines, refused))
}

fn of_entrant(
    subject: &Subject,
    laws: &SharedLaws,
    entrant: Entrant,
    facts: &Facts,
    seed: u64,
) -> Result<Line, Failure> {
    /// Estimates whose look-ups are counted where no law tells.
    const COUNTED: u64 = 64;
    let ray = subject.ray(subject.majorant);
    let undefined = || Failure::refused("not defined for an extinction of this ray");
    let spec = entrant.spec(&ray, facts).ok_or_else(undefined)?;
    let plan = Plan::on(subject.profile.clone(), spec.clone(), 0, 0)?;
    // Combs: an integral over their offset does not end on a rough ray.
    let is_costly = laws.is_rough() && plan.estimator.claimed_majorant.is_none();
    let law = if is_costly || plan.estimator.closed_form_is_costly {
        Prediction { theory: Theory::mean_only(f64::NAN), observed: subject.truth.observed }
    } else {
        laws.law(subject, &plan.estimator)?.ok_or_else(undefined)?
    };
    let counted = || plan.estimator.trial.count(&mut Seeded::new(seed), COUNTED) as f64 / COUNTED as f64;
    Ok(Line {
        series: Series::of(entrant.name),
        kind: entrant.kind(&ray, facts),
        parameters: words(&spec),
        lookups: Some(law.theory.lookups).filter(|lookups| lookups.is_finite()).unwrap_or_else(counted),
        spec,
        law,
        is_oracle: entrant.knows_the_mean(&ray, facts),
        is_of_the_papers: false,
    })
}

/// The parameters of a spec: "majorant 1, version ratio".
fn words(spec: &EstimatorSpec) -> String {
    let Value::Object(keys) = spec.written() else { return String::new() };
    let word = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let parameters = keys.iter().filter(|(key, _)| *key != "kind");
    parameters.map(|(key, value)| format!("{key} {}", word(value))).collect::<Vec<_>>().join(", ")
}

/// The representative set of the papers; those without a majorant of their own at the sampling extinction of the best closed-form
/// efficiency per look-up.
fn of_the_papers(subject: &Subject, laws: &SharedLaws, sweeps: &[SweepCurve]) -> Result<Vec<Line>, Failure> {
    let majorant = subject.majorant;
    let best = |series| best_sampling(sweeps, series).unwrap_or(majorant);
    let mean_best = best(Series::DoubleParticleMean);
    let explorers_best = best(Series::DoubleParticleExplorers);
    let albedo = Albedo::new(0.9).unwrap_or_default();
    let plain = Entry::plain;
    let chosen = [
        (plain(Series::Woodcock), majorant, format!("majorant {majorant}")),
        (plain(Series::DoubleParticle), majorant, format!("no control, sigma_samp = majorant = {majorant}")),
        (
            plain(Series::DoubleParticleMean),
            mean_best,
            format!("control = mean of the ray (an oracle), most efficient sigma_samp {mean_best:.3}"),
        ),
        (
            plain(Series::DoubleParticleExplorers),
            explorers_best,
            format!(
                "{EXPLORERS} explorers, looked up once per replica; most efficient sigma_samp {explorers_best:.3}"
            ),
        ),
        (
            Entry { albedo: Some(albedo), ..plain(Series::Adaptive) },
            majorant,
            format!("albedo {albedo}, sigma_samp {majorant}"),
        ),
        (plain(Series::LineIntegral), majorant, format!("{SPLITS} splits, majorant {majorant}")),
    ];
    let mut lines = Vec::new();
    for (entry, sigma_samp, parameters) in chosen {
        let spec = entry.at(subject, sigma_samp);
        let plan = Plan::on(subject.profile.clone(), spec.clone(), 0, 0)?;
        // An estimator that is not defined on this ray (a field below 0) has no curve.
        let Some(law) = laws.law(subject, &plan.estimator)? else { continue };
        lines.push(Line {
            series: entry.series,
            kind: spec.name(),
            parameters,
            lookups: law.theory.lookups,
            spec,
            law,
            is_oracle: entry.series.is_oracle(),
            is_of_the_papers: true,
        });
    }
    Ok(lines)
}

fn best_sampling(sweeps: &[SweepCurve], series: Series) -> Option<f64> {
    let points = sweeps.iter().filter(|curve| curve.series == series).flat_map(|curve| &curve.points);
    points
        .filter_map(|point| Some((point.sigma_samp, point.log10_efficiency_per_lookup?)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(sigma_samp, _)| sigma_samp)
}
