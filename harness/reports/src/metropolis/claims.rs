//! The findings of the report.

use super::equal_time::{BIDIRECTIONAL, PRIMARY, better};
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
    let best = compared.iter().map(|scene| {
        let (k, id) = (least(scene), scene.scene.id);
        let name = scene.entries[k].name;
        match k {
            BIDIRECTIONAL => format!("{id} {name}"),
            _ => format!("{id} {name} ({} times bidirectional)", scene.gain(k, BIDIRECTIONAL).words(1)),
        }
    });
    let ahead = compared.iter().filter(|scene| !better(scene).is_empty()).map(|scene| scene.scene.id);
    let (ahead, best): (Vec<&str>, Vec<String>) = (ahead.collect(), best.collect());
    let behind = compared.iter().flat_map(|scene| {
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
    let direct = |row: &Row| row.over_paths().words(2);
    let mut summary = vec![
        format!("Most efficient, 1/(MSE · CPU s): {}.", best.join("; ")),
        format!(
            "Chains beat both path tracing and bidirectional path tracing, by intervals, on {}.",
            listed(&ahead)
        ),
    ];
    if !behind.is_empty() {
        summary.push(format!(
            "They lose to bidirectional path tracing where its samples find light as it is, so that steps which resemble each other say less: {}.",
            behind.join("; ")
        ));
    }
    if let (Some(thin), Some(dense)) = (rows.first(), rows.last()) {
        summary.push(format!(
            "Where a lamp lights all, a chain over paths has {} of the efficiency of the paths themselves in thin haze, {} in dense.",
            direct(thin),
            direct(dense)
        ));
    }
    summary.push(start.summary());
    summary
}

fn listed(names: &[&str]) -> String {
    if names.is_empty() { "none of these scenes".to_owned() } else { names.join(", ") }
}
