//! `tables.md`: what is unsound, the ledger of claims, the tables.

use super::super::markdown::{claims, table};
use super::table::{heading, words};
use crate::report::document::Document;

/// The file.
pub(super) fn tables(document: &Document) -> String {
    let provenance = &document.provenance;
    let mut text = format!(
        "# {}: tables\n\nWritten by `{}`, revision {}, seed {}.\n",
        document.title, provenance.command, provenance.revision, provenance.seed
    );
    if !document.unsound.is_empty() {
        text.push_str("\n## Unsound\n\n");
        for sentence in &document.unsound {
            text.push_str(&format!("- {sentence}\n"));
        }
    }
    if !document.claims.is_empty() {
        text.push_str("\n## Claims\n\n");
        claims(&mut text, &document.claims);
    }
    for it in document.sections.iter().flat_map(|section| &section.tables) {
        text.push_str(&format!("\n## {}\n\n", it.title));
        if !it.caption.is_empty() {
            text.push_str(&format!("{}\n\n", it.caption));
        }
        let header: Vec<String> = it.columns.iter().map(heading).collect();
        let rows: Vec<Vec<String>> = it.rows.iter().map(|row| row.iter().map(words).collect()).collect();
        let rows = rows.iter().map(|row| row.iter().map(String::as_str).collect());
        table(&mut text, &header.iter().map(String::as_str).collect::<Vec<_>>(), rows);
    }
    text
}
