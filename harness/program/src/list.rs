//! `harness list` and `harness schema`.

use crate::cli::SchemaArguments;
use fairflight_harness::reader::kind::plain;
use fairflight_harness::vocabulary::{schema, tables, things};
use fairflight_harness::{DONE, Failure, print};
use fairflight_reports::REPORTS;
use std::fmt::Write as _;
use std::io::Write;

/// `harness list`.
pub(crate) fn list(stdout: &mut dyn Write) -> Result<i32, Failure> {
    let mut list = String::new();
    let mut entry = |thing: &str, name: &str, keys: &str, about: &str| {
        let keys = if keys.is_empty() { String::new() } else { format!("{keys}\n{:<39}", "") };
        let _ = writeln!(list, "{thing:<15}{name:<24}{keys}{}", plain(about));
    };
    for (k, kind) in REPORTS.iter().enumerate() {
        entry(if k == 0 { "reports" } else { "" }, kind.name, "", kind.about);
    }
    for things in things() {
        for (k, kind) in things.kinds.iter().enumerate() {
            let keys = kind.keys.iter().map(|key| {
                let words = key.words().map_or_else(String::new, |words| format!(" ({words})"));
                let name = format!("{}{words}", key.name);
                if key.optional { format!("[{name}]") } else { name }
            });
            let keys = keys.collect::<Vec<_>>().join(", ");
            entry(if k == 0 { things.title } else { "" }, kind.name, &keys, kind.about);
        }
    }
    print(stdout, &list)?;
    Ok(DONE)
}

/// `harness schema`.
pub(crate) fn print_schema(arguments: SchemaArguments, stdout: &mut dyn Write) -> Result<i32, Failure> {
    print(stdout, &if arguments.tables { tables() } else { format!("{:#}\n", schema()) })?;
    Ok(DONE)
}
