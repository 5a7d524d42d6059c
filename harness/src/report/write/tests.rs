//! Tests over whole folders.

use super::*;
use crate::testing::{linked_files, names};
use std::fs;

fn written() -> tempfile::TempDir {
    let root = tempfile::tempdir().unwrap();
    write_all_or_nothing(&fixture::report(), &root.path().join("standard")).unwrap();
    assert_eq!(names(root.path()), ["standard"]);
    root
}

/// Splits a file of ours: quoted cells hold no line breaks.
fn rows(csv: &str) -> Vec<Vec<String>> {
    let row = |line: &str| {
        let mut cells = vec![String::new()];
        let mut inside = false;
        for c in line.chars() {
            match c {
                '"' => inside = !inside,
                ',' if !inside => cells.push(String::new()),
                c => cells.last_mut().unwrap().push(c),
            }
        }
        cells
    };
    csv.lines().map(row).collect()
}

#[test]
fn a_folder_has_every_format_of_every_figure() {
    let root = written();
    let folder = root.path().join("standard");
    let names = names(&folder);
    let count = |ending: &str| names.iter().filter(|name| name.ends_with(ending)).count();
    // Three albedos, look-ups, two efficiencies, two convergences, anatomy, functions; images have a table of their own.
    assert_eq!(count(".svg"), 10);
    assert_eq!(count(".csv"), 11);
    assert_eq!(count(".png"), 10 + 1 + 2 * 10);
    assert!(["index.html", "results.json", "tables.md"].iter().all(|name| names.iter().any(|n| n == name)));

    let results: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join("results.json")).unwrap()).unwrap();
    assert_eq!(results["provenance"]["command"], "harness report --quick");
    assert_eq!(results["media"][0]["sweeps"][0]["points"][12]["log10_relative_variance"], "-infinity");
}

#[test]
fn a_csv_has_one_row_per_point_and_numbers_that_read_back() {
    let root = written();
    let read = |name: &str| rows(&fs::read_to_string(root.path().join("standard").join(name)).unwrap());
    let report = fixture::report();
    let medium = &report.media[0];
    // Seven curves for every albedo and three of its own, of 13 points each.
    for albedo in ["0", "0.5", "0.9"] {
        assert_eq!(read(&format!("eq21-variance-albedo-{albedo}.csv")).len(), 1 + 10 * 13);
    }
    assert_eq!(
        read("eq21-lookups.csv").len(),
        1 + medium.sweeps.iter().map(|c| c.points.len()).sum::<usize>()
    );
    assert_eq!(read("eq21-error-against-seconds.csv").len(), 1 + 10 * 6);
    assert_eq!(read("eq21-anatomy.csv").len(), 1 + 21 + 4);
    assert_eq!(read("eq21-functions.csv").len(), 1 + 21);
    assert_eq!(read("eq21-images-10.csv").len(), 1 + 10);

    for name in names(&root.path().join("standard")).iter().filter(|name| name.ends_with(".csv")) {
        let rows = read(name);
        assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{name}");
    }
    let curve = &medium.sweeps[1];
    let file = read("eq21-variance-albedo-0.csv");
    let lines = file.iter().filter(|row| row[0] == "Double particle");
    for (row, point) in lines.zip(&curve.points) {
        assert_eq!(row[3].parse(), Ok(point.sigma_samp));
        assert_eq!(row[5].parse(), Ok(point.log10_relative_variance.unwrap()));
    }
}

#[test]
fn the_page_needs_no_network_and_its_links_lead_somewhere() {
    let root = written();
    let folder = root.path().join("standard");
    let page = fs::read_to_string(folder.join("index.html")).unwrap();
    let files = linked_files(&page, &folder);
    assert!(files.len() > 40);
    for source in page.split("src=\"").skip(1) {
        assert!(source.starts_with("data:image/png;base64,"));
    }
    assert!(!page.contains("<length>"), "text of the report is escaped");
}

#[test]
fn tables_keep_their_columns() {
    let tables = markdown::tables(&fixture::report());
    for line in tables.lines().filter(|line| line.starts_with("| S1")) {
        assert_eq!(line.replace("\\|", "").matches('|').count(), 7, "{line}");
    }
}

#[test]
fn a_failing_write_changes_nothing() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("standard");
    write_all_or_nothing(&fixture::report(), &folder).unwrap();
    let before = names(&folder);
    let mut broken = fixture::report();
    broken.images[0].exact.pop();
    let failure = write_all_or_nothing(&broken, &folder).unwrap_err();
    assert_eq!(failure.code(), crate::NOT_WRITTEN);
    assert_eq!(names(&folder), before);
    assert_eq!(names(root.path()), ["standard"]);

    let elsewhere = root.path().join("new/standard");
    assert!(write_all_or_nothing(&broken, &elsewhere).is_err());
    assert_eq!(names(root.path()), ["standard"]);
}

#[test]
fn the_same_report_gives_the_same_files() {
    let (one, other) = (written(), written());
    for name in names(&one.path().join("standard")) {
        let read = |root: &tempfile::TempDir| fs::read(root.path().join("standard").join(&name)).unwrap();
        assert!(read(&one) == read(&other), "{name}");
    }
}

#[test]
fn an_empty_report_is_still_a_report() {
    let root = tempfile::tempdir().unwrap();
    let mut empty = fixture::report();
    for medium in &mut empty.media {
        medium.sweeps.clear();
        medium.convergence.clear();
    }
    empty.images.clear();
    empty.claims.clear();
    empty.stability.clear();
    write_all_or_nothing(&empty, &root.path().join("standard")).unwrap();
}
