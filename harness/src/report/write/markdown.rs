//! `tables.md`: the ledger of claims, the hard cases, the optima.

use super::super::result::{Claim, ClaimVerdict, MediumReport, Report};
use super::number::{short, short_of_log10};
use super::optimum::{self, Optimum, Place};
use super::palette::{look, rank};

/// The name of the file.
pub(super) const FILE: &str = "tables.md";

/// The words of a verdict.
pub(super) fn verdict(verdict: ClaimVerdict) -> &'static str {
    match verdict {
        ClaimVerdict::Holds => "holds",
        ClaimVerdict::HoldsUnder => "holds under a condition",
        ClaimVerdict::DoesNotHold => "does not hold",
        ClaimVerdict::NotTestable => "not testable",
    }
}

/// The best σ_samp of a curve, in words.
#[derive(serde::Serialize)]
pub(super) struct OptimumRow {
    pub(super) name: &'static str,
    pub(super) parameters: String,
    pub(super) per_lookup: [String; 2],
    pub(super) per_second: [String; 2],
}

/// One row per curve of a medium.
pub(super) fn optima(medium: &MediumReport) -> Vec<OptimumRow> {
    let mut curves: Vec<_> = medium.sweeps.iter().collect();
    curves.sort_by_key(|curve| rank(curve.series));
    curves
        .into_iter()
        .map(|curve| OptimumRow {
            name: look(curve.series).name,
            parameters: curve.parameters.clone(),
            per_lookup: words(optimum::per_lookup(curve)),
            per_second: words(optimum::per_second(curve)),
        })
        .collect()
}

fn words(best: Option<Optimum<'_>>) -> [String; 2] {
    best.map_or_else(
        || ["—".to_owned(), "—".to_owned()],
        |best| {
            let end = match best.place {
                Place::Inside => "",
                Place::LowerEnd => " ⤓",
                Place::UpperEnd => " ⤒",
            };
            [format!("{}{end}", short(best.sigma_samp)), short_of_log10(best.log10_efficiency)]
        },
    )
}

/// What the arrows of [`optima`] mean.
pub(super) const ARROWS: &str = "⤓ and ⤒: the best point is the lower or upper end of the curve, which is the end of the \
                                 estimator's domain or of the sweep.";

/// The file.
pub(super) fn tables(report: &Report) -> String {
    let provenance = &report.provenance;
    let mut text = format!(
        "# Tables of the standard report\n\nWritten by `{}`, revision {}, seed {}.\n\n## Claims\n\n",
        provenance.command, provenance.revision, provenance.seed
    );
    claims(&mut text, &report.claims);
    text.push_str("\n## Hard cases\n\n");
    let numbers: Vec<String> = report.stability.iter().map(|row| row.number.to_string()).collect();
    let rows = report.stability.iter().zip(&numbers).map(|(row, number)| {
        vec![&**number, &*row.case, &*row.exact, &*row.ours, if row.passes { "yes" } else { "NO" }]
    });
    table(&mut text, &["no.", "case", "exact", "ours", "right"], rows);
    for medium in &report.media {
        text.push_str(&format!("\n## Best σ_samp: {}\n\n{ARROWS}\n\n", medium.title));
        let rows = optima(medium);
        let rows = rows.iter().map(|row| {
            let mut cells = vec![row.name, &*row.parameters];
            cells.extend(row.per_lookup.iter().chain(&row.per_second).map(String::as_str));
            cells
        });
        let header = [
            "estimator",
            "parameters",
            "best σ_samp per look-up [1/length]",
            "T²/(MSE · look-ups)",
            "best σ_samp per CPU second [1/length]",
            "T²/(MSE · s) [1/s]",
        ];
        table(&mut text, &header, rows);
    }
    text
}

/// The ledger.
pub(super) fn claims(text: &mut String, claims: &[Claim]) {
    let rows = claims.iter().map(|claim| {
        vec![
            &*claim.id,
            &*claim.claim,
            &*claim.source,
            &*claim.measured,
            verdict(claim.verdict),
            &*claim.comment,
        ]
    });
    table(text, &["id", "claim", "source", "measured", "verdict", "comment"], rows);
}

/// A table with this header.
pub(super) fn table<'a>(text: &mut String, header: &[&str], rows: impl Iterator<Item = Vec<&'a str>>) {
    let mut line = |cells: &[&str]| {
        let cells: Vec<String> = cells.iter().map(|cell| escaped(cell)).collect();
        text.push_str(&format!("| {} |\n", cells.join(" | ")));
    };
    line(header);
    line(&vec!["---"; header.len()]);
    for row in rows {
        line(&row);
    }
}

/// A cell is one line, and a bar would end it.
fn escaped(cell: &str) -> String {
    cell.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}
