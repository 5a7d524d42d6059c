//! `tables.md`: what is unsound, the ledger of claims, the tables, heat maps in few numbers.

use crate::csv::heading;
use crate::figure::data;
use crate::{Block, Cell, Claim, Document, Table, measured, short};

/// The name of the file.
pub(crate) const FILE: &str = "tables.md";

/// The file.
pub(crate) fn tables(document: &Document) -> String {
    let provenance = &document.provenance;
    let mut text = format!(
        "# {}: tables\n\nWritten by `{}`, revision {}, seed {}.\n",
        document.title, provenance.command, provenance.revision, provenance.seed
    );
    if !document.unsound.is_empty() {
        text.push_str("\n## Unsound\n\n");
        text.extend(document.unsound.iter().map(|sentence| format!("- {sentence}\n")));
    }
    if !document.claims.is_empty() {
        text.push_str("\n## Claims\n\n");
        claims(&mut text, &document.claims);
    }
    for block in document.blocks() {
        match block {
            Block::HeatMap(map) => table(&mut text, &data::summary(map)),
            Block::Table(it) => table(&mut text, it),
            _ => {}
        }
    }
    text
}

/// A cell for people: three digits, or as many as an interval allows.
pub(crate) fn words(cell: &Cell) -> String {
    match cell {
        Cell::Text(text) => text.clone(),
        Cell::Number(x) => short(*x),
        Cell::Count(n) => n.to_string(),
        Cell::Measured { value, interval: Some(interval) } => measured(*value, *interval),
        Cell::Measured { value, interval: None } => short(*value),
        Cell::Flag(true) => "yes".to_owned(),
        Cell::Flag(false) => "no".to_owned(),
        Cell::Empty => "—".to_owned(),
    }
}

fn claims(text: &mut String, claims: &[Claim]) {
    line(text, ["id", "claim", "source", "measured", "verdict", "comment"].map(str::to_owned));
    line(text, vec!["---".to_owned(); 6]);
    for Claim { id, claim, source, measured, verdict, comment } in claims {
        line(text, [id, claim, source, measured, verdict.words(), comment].map(str::to_owned));
    }
}

fn table(text: &mut String, it: &Table) {
    text.push_str(&format!("\n## {}\n\n", it.title));
    if !it.caption.is_empty() {
        text.push_str(&format!("{}\n\n", it.caption));
    }
    line(text, it.columns.iter().map(heading));
    line(text, vec!["---".to_owned(); it.columns.len()]);
    for row in &it.rows {
        line(text, row.iter().map(words));
    }
}

/// A row. A cell is one line, and a bar would end it.
fn line(text: &mut String, cells: impl IntoIterator<Item = String>) {
    let escaped = |cell: String| cell.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|");
    let cells: Vec<String> = cells.into_iter().map(escaped).collect();
    text.push_str(&format!("| {} |\n", cells.join(" | ")));
}
