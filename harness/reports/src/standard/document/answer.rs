//! The answer: whether all is sound, the estimator to take, the sampling extinction to take.

use super::super::findings::{Agreement, Best, Limit};
use super::super::optimum::{CurveOptima, Place};
use super::super::result::{MediumReport, Report};
use super::super::subject::VOLUME;
use fairflight_document::{listed, short};

/// A paragraph for each.
pub(super) fn summary(report: &Report) -> Vec<String> {
    let mut summary = vec![soundness(report)];
    if report.media.iter().any(|medium| !medium.findings.per_lookup.is_empty()) {
        summary.push(estimators(report));
    }
    if report.media.iter().any(|medium| !medium.findings.limits.is_empty()) {
        summary.push(sampling(report));
    }
    if report.media.iter().any(|medium| medium.id == VOLUME) {
        summary.push(RAY_OF_A_VOLUME.to_owned());
    }
    summary
}

/// What advice on the same file measures otherwise.
const RAY_OF_A_VOLUME: &str = "On the volume this is one ray, through its middle and below a majorant of its own, just above its greatest \
    σ_t. harness advise --vdb and harness report estimators --vdb send random rays through it, all below the greatest σ_t of the whole \
    volume: their gains are means over those rays, and another estimator may lead.";

fn soundness(report: &Report) -> String {
    let rays: Vec<String> = report
        .media
        .iter()
        .map(|medium| format!("{} with T = {}", medium.title, short(medium.ray.transmittance)))
        .collect();
    let mut labels: Vec<&str> = Vec::new();
    for row in report.media.iter().flat_map(|medium| &medium.estimators) {
        if !labels.contains(&row.series.label()) {
            labels.push(row.series.label());
        }
    }
    let all = report.media.iter().map(|medium| medium.findings.agreement);
    let Agreement { measured, agree, disagree } = all.fold(Agreement::default(), Agreement::and);
    let right = report.stability.iter().filter(|row| row.passes).count();
    format!(
        "{} estimators of transmittance, on a ray through each of {}: of {measured} measurements of the unbiased ones {agree} agree with their closed \
         forms, {disagree} do not, {} cannot tell with these samples; {right} of {} hard cases are right.",
        labels.len(),
        listed(&rays),
        measured - agree - disagree,
        report.stability.len()
    )
}

fn estimators(report: &Report) -> String {
    let on = |of: fn(&MediumReport) -> &[Best]| {
        let first = |medium: &MediumReport| Some((medium.id.clone(), of(medium).first()?.clone()));
        let best: Vec<(String, Best)> = report.media.iter().filter_map(first).collect();
        let told = |(medium, best): &(String, Best)| match best.gain {
            Some(gain) => format!("{} times as efficient as ratio tracking on {medium}", short(gain)),
            None => format!("on {medium}"),
        };
        let labels: Vec<&str> = best.iter().map(|(_, best)| best.series.label()).collect();
        if labels.windows(2).all(|pair| pair[0] == pair[1]) {
            let all: Vec<String> = best.iter().map(told).collect();
            return format!("{}, {}", labels.first().unwrap_or(&""), listed(&all));
        }
        let each = best.iter().map(|best| format!("{}, {}", best.1.series.label(), told(best)));
        listed(&each.collect::<Vec<_>>())
    };
    format!(
        "Which estimator: per look-up take {}; per CPU second take {}. All of them stand in the tables below.",
        on(|medium| &medium.findings.per_lookup),
        on(|medium| &medium.findings.per_second)
    )
}

fn sampling(report: &Report) -> String {
    let limits = report.media.first().map_or_else(String::new, |medium| {
        let told = || medium.findings.limits.iter().filter(|limit| !limit.series.is_oracle());
        let all = |words: &dyn Fn(&Limit) -> String| listed(&told().map(words).collect::<Vec<_>>());
        format!(
            "on {} to {}. At the greatest σ_t it is still {} times that; from σ_samp = {} on it is within a tenth.",
            medium.id,
            all(&|limit| format!("{} ({})", short(limit.product), limit.series.label())),
            all(&|limit| short(limit.at_majorant)),
            all(&|limit| short(limit.within_a_tenth_from))
        )
    });
    let ending = [
        best_at(report, Place::LowerEnd)
            .map(|(labels, _)| format!(" Best with the least lawful majorant: {}.", listed(&labels))),
        best_at(report, Place::Inside).map(|(labels, [low, high])| {
            format!(" Best at {} to {} times the greatest σ_t: {}.", short(low), short(high), listed(&labels))
        }),
    ];
    let ending: String = ending.into_iter().flatten().collect();
    format!(
        "Which σ_samp: There is no best one for transmittance. Variance times look-ups of the double particle model only falls as σ_samp \
         grows, to L·∫(σ_t − σ_main)² ds (eq. 16), {limits}{ending} For walks that scatter there is a best one, at 0.8 to 1 times the \
         greatest extinction: harness report particle-tracing."
    )
}

/// The unbiased estimators whose best σ_samp per look-up lies there on every curve, and the range of those σ_samp over the greatest σ_t.
fn best_at(report: &Report, place: Place) -> Option<(Vec<String>, [f64; 2])> {
    let all = || report.media.iter().flat_map(|medium| medium.optima.iter().map(move |row| (medium, row)));
    let is_there = |row: &CurveOptima| row.per_lookup.is_none_or(|best| best.place == place);
    let always = |series| all().filter(|(_, row)| row.series == series).all(|(_, row)| is_there(row));
    let (mut labels, mut range) = (Vec::new(), [f64::INFINITY, 0.0_f64]);
    for (medium, row) in all().filter(|(_, row)| !row.series.is_baseline() && always(row.series)) {
        let Some(best) = row.per_lookup else { continue };
        let label = row.series.label().to_owned();
        if !labels.contains(&label) {
            labels.push(label);
        }
        let ratio = best.sigma_samp / medium.ray.maximum;
        range = [range[0].min(ratio), range[1].max(ratio)];
    }
    (!labels.is_empty()).then_some((labels, range))
}
