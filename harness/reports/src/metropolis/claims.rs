//! The findings of the report.

use super::equal_time::{BIDIRECTIONAL, PRIMARY, better, judged};
use super::rows::Row;
use super::start;
use crate::compared::Compared;

/// The findings, in words.
pub(super) fn summary(compared: &[Compared], rows: &[Row], start: &start::Study) -> Vec<String> {
    let least = |scene: &Compared| {
        let order =
            |a: &usize, b: &usize| scene.entries[*a].cost.value.total_cmp(&scene.entries[*b].cost.value);
        (0..scene.entries.len()).min_by(order).unwrap_or_default()
    };
    let best = judged(compared).map(|scene| {
        let (k, id) = (least(scene), scene.scene.id);
        let name = scene.entries[k].name;
        match k {
            BIDIRECTIONAL => format!("{id} {name}"),
            _ => format!("{id} {name} ({} times bidirectional)", scene.gain(k, BIDIRECTIONAL).words(2)),
        }
    });
    let ahead = judged(compared).filter(|scene| !better(scene).is_empty()).map(|scene| scene.scene.id);
    let (ahead, best): (Vec<&str>, Vec<String>) = (ahead.collect(), best.collect());
    let behind = judged(compared).flat_map(|scene| {
        let loses = |&k: &usize| scene.gain(k, BIDIRECTIONAL).exceeds(1.0) == Some(false);
        (PRIMARY..scene.entries.len()).filter(loses).map(|k| {
            format!(
                "{} on {} {}",
                scene.entries[k].name,
                scene.scene.id,
                scene.gain(k, BIDIRECTIONAL).words(2)
            )
        })
    });
    let behind: Vec<String> = behind.collect();
    let mut summary = vec![
        format!("Most efficient, 1/(MSE · CPU s): {}.", best.join("; ")),
        format!(
            "Chains beat both path tracing and bidirectional path tracing, by intervals, on {}.",
            listed(&ahead)
        ),
    ];
    if !behind.is_empty() {
        summary.push(format!(
            "A chain finds light no faster than the samples that it starts from, and steps that resemble each other say less than samples do: they lose to bidirectional path \
             tracing where that finds light as it is, or where chains are short and light is rare: {}.",
            behind.join("; ")
        ));
    }
    let efficiencies: Vec<_> =
        rows.iter().filter_map(|row| row.over_paths().map(|efficiency| (row.sigma_t, efficiency))).collect();
    let best = efficiencies.iter().max_by(|(_, a), (_, b)| a.interval[0].total_cmp(&b.interval[0]));
    if let (Some(thin), Some(best)) = (efficiencies.first(), best) {
        let [thin, best] =
            [thin, best].map(|(sigma_t, efficiency)| format!("{} at σ_t = {sigma_t}", efficiency.words(2)));
        summary.push(format!(
            "Where a lamp lights all, the efficiency of a chain over paths is {thin} of that of the paths themselves, and at best {best}."
        ));
    }
    summary.push(start.summary());
    summary
}

fn listed(names: &[&str]) -> String {
    if names.is_empty() { "none of these scenes".to_owned() } else { names.join(", ") }
}
