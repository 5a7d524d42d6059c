//! `tables.md`: what is unsound, the ledger of claims, the tables, heat maps in few numbers.

use super::super::markdown::{claims, table};
use super::heat_map;
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
    for section in &document.sections {
        for it in &section.heat_maps {
            let (header, rows) = heat_map::summary(it);
            titled(&mut text, [&it.title, &it.caption], &header, &rows);
        }
        for it in &section.tables {
            let header: Vec<String> = it.columns.iter().map(heading).collect();
            let rows: Vec<Vec<String>> = it.rows.iter().map(|row| row.iter().map(words).collect()).collect();
            titled(&mut text, [&it.title, &it.caption], &header, &rows);
        }
    }
    text
}

fn titled(text: &mut String, [title, caption]: [&str; 2], header: &[String], rows: &[Vec<String>]) {
    text.push_str(&format!("\n## {title}\n\n"));
    if !caption.is_empty() {
        text.push_str(&format!("{caption}\n\n"));
    }
    let rows = rows.iter().map(|row| row.iter().map(String::as_str).collect());
    table(text, &header.iter().map(String::as_str).collect::<Vec<_>>(), rows);
}
