//! Tests over whole folders.

use super::super::write_all_or_nothing;
use super::*;
use crate::report::document::{Chart, GalleryRow, Picture};
use crate::testing::{linked_files, names};
use std::fs;

fn written() -> tempfile::TempDir {
    let root = tempfile::tempdir().unwrap();
    write_all_or_nothing(&fixture::document(), &root.path().join("made-up")).unwrap();
    assert_eq!(names(root.path()), ["made-up"]);
    root
}

#[test]
fn a_folder_has_every_format_and_makes_way_for_the_next() {
    let root = written();
    let folder = root.path().join("made-up");
    let mut expected: Vec<String> =
        ["index.html", "results.json", "tables.md", "numbers.csv"].map(str::to_owned).to_vec();
    for chart in ["variance", "shares", "plane", "winners"] {
        expected.extend(["svg", "png", "csv"].map(|ending| format!("{chart}.{ending}")));
    }
    expected.extend(["coloured", "grey", "error"].map(|name| format!("looks-{name}.png")));
    expected.sort();
    assert_eq!(names(&folder), expected);

    let results: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join("results.json")).unwrap()).unwrap();
    assert_eq!(results["provenance"]["command"], "harness report made-up");
    let curve = &results["sections"][0]["charts"][0]["curves"][3];
    assert_eq!(curve["line"][10]["y"], serde_json::Value::Null);
    assert_eq!(curve["marks"][6]["interval"][0], -0.1);
    let plane = &results["sections"][0]["heat_maps"][0]["content"];
    let cell = |k: usize| &plane["panels"][3]["values"][k];
    assert_eq!(*cell(0), serde_json::Value::Null);
    assert_eq!((cell(40), cell(100)), (&serde_json::json!(0.0), &serde_json::json!("infinity")));
    assert_eq!(
        results["sections"][0]["heat_maps"][1]["content"]["panels"][5]["values"][4],
        serde_json::Value::Null
    );
    let pixels = &results["sections"][1]["galleries"][0]["rows"][0]["pictures"][2]["pixels"];
    assert_eq!(*pixels, serde_json::json!({ "mapping": "signed", "scale": 0.2 }));

    // It is recognised as a report of ours, and replaced.
    write_all_or_nothing(&fixture::document(), &folder).unwrap();
    assert_eq!(names(root.path()), ["made-up"]);
}

#[test]
fn a_csv_has_one_row_per_point_and_numbers_that_read_back() {
    let root = written();
    let read = |name: &str| fs::read_to_string(root.path().join("made-up").join(name)).unwrap();
    let variance = read("variance.csv");
    assert_eq!(variance.lines().count(), 1 + 4 * (25 + 7));
    let marks: Vec<&str> = variance.lines().filter(|line| line.starts_with("Woodcock,mark,")).collect();
    let mark = &fixture::document().sections[0].charts[0].curves[0].marks[3];
    let cells: Vec<&str> = marks[3].split(',').collect();
    assert_eq!(cells[2].parse(), Ok(mark.x));
    assert_eq!(cells[4].parse(), Ok(mark.interval.unwrap()[0]));
    assert!(marks[0].ends_with(",false") && marks[3].ends_with(",true"));

    let plane = read("plane.csv");
    assert_eq!(plane.lines().count(), 1 + 6 * 24 * 16);
    assert_eq!(plane.lines().nth(1 + 3 * 384 + 12).unwrap().split(',').count(), 4);
    assert!(plane.lines().nth(1 + 3 * 384).unwrap().ends_with(','), "no value, no number");
    assert!(plane.lines().nth(1 + 3 * 384 + 100).unwrap().ends_with(",inf"));
    let winners = read("winners.csv");
    assert_eq!(winners.lines().count(), 1 + 6 * 24 * 16);
    let last: Vec<&str> = winners.lines().last().unwrap().split(',').collect();
    assert_eq!((last[0], last[1].parse(), last[2].parse()), ("lin_dec", Ok(0.99), Ok(1.0)));
    assert!(!winners.contains("never the best"));
    assert!(winners.lines().skip(1).all(|line| line.split(',').nth(4).unwrap().parse::<f64>().is_ok()));

    let numbers = read("numbers.csv");
    assert!(numbers.lines().all(|line| line.split(',').count() == 8), "{numbers}");
    assert!(numbers.contains("Woodcock,100000,0.818731,0.81853,0.81893,0.1234,true,1500000\n"), "{numbers}");
}

#[test]
fn the_page_needs_no_network_and_its_links_lead_somewhere() {
    let root = written();
    let folder = root.path().join("made-up");
    let page = fs::read_to_string(folder.join("index.html")).unwrap();
    assert!(page.starts_with("<!doctype html>"));
    let files = linked_files(&page, &folder);
    // Everything beside the page can be reached from it.
    for name in names(&folder).iter().filter(|name| *name != "index.html") {
        assert!(files.contains(name), "{name}");
    }
    let sources: Vec<&str> = page.split("src=\"").skip(1).collect();
    assert_eq!(sources.len(), 3);
    assert!(sources.iter().all(|source| source.starts_with("data:image/png;base64,")));
    assert!(!page.contains("<markup>") && !page.contains("<nothing>"), "text of the document is escaped");
    assert!(
        page.contains("sRGB encoding of 2.00 · L") && page.contains("% of the pixels negative, clipped to 0")
    );
    assert!(!page.contains("not sound"));
    let seen = "aria-label=\"The best of five. Heat map of which of Woodcock; ";
    assert!(page.contains(seen) && page.contains("; jittered ratio, over transmittance T [1]"));
    assert!(page.contains("lower left &lt;corner&gt;"));
}

#[test]
fn what_is_unsound_is_said_in_the_page_and_in_the_tables() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("made-up");
    let mut document = fixture::document();
    document.unsound.push("the mean is 7 standard errors off".to_owned());
    write_all_or_nothing(&document, &folder).unwrap();
    for name in ["index.html", "tables.md"] {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        assert!(text.contains("the mean is 7 standard errors off"), "{name}");
    }
}

#[test]
fn tables_keep_their_columns_and_round_by_the_interval() {
    let tables = markdown::tables(&fixture::document());
    let line = tables.lines().find(|line| line.starts_with("| spectral \\|")).unwrap();
    assert_eq!(line, "| spectral \\| with bar | 100000 | 0.81873 [0.81853, 0.81893] | 0.123 | no | — |");
    let claim = tables.lines().find(|line| line.starts_with("| M1")).unwrap();
    assert_eq!(claim.replace("\\|", "").matches('|').count(), 7, "{claim}");
}

#[test]
fn heat_maps_are_summed_up_in_the_tables() {
    let tables = markdown::tables(&fixture::document());
    let hole = tables.lines().find(|line| line.starts_with("| hole")).unwrap();
    assert!(hole.starts_with("| hole | 0 |") && hole.ends_with(" | 18 |"), "{hole}");
    assert!(hole.contains("| ∞ |"), "{hole}");
    let shares = tables.lines().skip_while(|line| !line.starts_with("| share of the cells"));
    let rows: Vec<Vec<f64>> = shares
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.split('|').skip(2).filter_map(|cell| cell.trim().parse().ok()).collect())
        .collect();
    assert!(rows.iter().all(|row| row.len() == 6));
    for panel in 0..6 {
        // Rounded to three digits.
        let sum: f64 = rows.iter().map(|row| row[panel]).sum();
        assert!((sum - 100.0).abs() < 0.3, "{sum}");
    }
}

/// The canonical plane with six panels, and the page has every drawing inside.
#[test]
fn a_heat_map_is_small() {
    let root = written();
    for (name, most) in
        [("plane.svg", 120_000), ("plane.png", 120_000), ("winners.svg", 80_000), ("winners.png", 80_000)]
    {
        let bytes = fs::metadata(root.path().join("made-up").join(name)).unwrap().len();
        assert!(bytes < most, "{name}: {bytes}");
    }
}

#[test]
fn a_mistake_of_a_study_changes_nothing() {
    let root = tempfile::tempdir().unwrap();
    let mut document = fixture::document();
    document.sections[0].tables[0].rows[0].pop();
    let failure = write_all_or_nothing(&document, &root.path().join("new/made-up")).unwrap_err();
    assert_eq!(failure.code(), crate::NOT_WRITTEN);
    assert!(names(root.path()).is_empty());
}

#[test]
fn the_same_document_gives_the_same_files() {
    let (one, other) = (written(), written());
    for name in names(&one.path().join("made-up")) {
        let read = |root: &tempfile::TempDir| fs::read(root.path().join("made-up").join(&name)).unwrap();
        assert!(read(&one) == read(&other), "{name}");
    }
}

#[test]
fn a_document_without_contents_is_still_a_document() {
    let root = tempfile::tempdir().unwrap();
    let mut document = fixture::document();
    document.claims.clear();
    document.summary.clear();
    for chart in &mut document.sections[0].charts {
        (chart.curves, chart.y.range) = (Vec::new(), None);
    }
    document.sections[0].tables[0].rows.clear();
    document.sections[1].galleries[0].rows.clear();
    write_all_or_nothing(&document, &root.path().join("made-up")).unwrap();
}

/// Forty pictures are about the most that a planned report has.
#[test]
fn a_folder_of_forty_pictures_is_small() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("made-up");
    let mut document = fixture::document();
    let gallery = fixture::gallery([128, 128]);
    let pictures = &gallery.rows[0].pictures;
    // A smooth one for each noisy one and its error.
    let forty = (0..40).map(|k| Picture { id: format!("p-{k}"), ..pictures[k % 3].clone() }).collect();
    document.sections[0].heat_maps.clear();
    document.sections[1].galleries[0].rows = vec![GalleryRow { label: String::new(), pictures: forty }];
    for k in 0..6 {
        let chart = &document.sections[0].charts[k % 2];
        let chart = Chart { id: format!("chart-{k}"), ..chart.clone() };
        document.sections[0].charts.push(chart);
    }
    write_all_or_nothing(&document, &folder).unwrap();
    let bytes: u64 = names(&folder).iter().map(|name| fs::metadata(folder.join(name)).unwrap().len()).sum();
    assert!(bytes < 1_500_000, "{bytes}");
}
