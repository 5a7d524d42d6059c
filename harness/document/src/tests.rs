//! Tests over all files of a document.

use crate::{Block, Document, File, Script, files, fixture};

fn written(document: &Document, script: Script) -> Vec<File> {
    files(document, script).unwrap()
}

fn text(files: &[File], name: &str) -> String {
    let file = files.iter().find(|file| file.name == name).unwrap_or_else(|| panic!("no {name}"));
    String::from_utf8(file.bytes.clone()).unwrap()
}

#[test]
fn every_figure_has_every_format() {
    let mut names: Vec<String> =
        written(&fixture::document(), Script::None).into_iter().map(|file| file.name).collect();
    let mut expected: Vec<String> = ["index.html", "tables.md", "numbers.csv"].map(str::to_owned).to_vec();
    for chart in ["variance", "shares", "plane", "winners"] {
        expected.extend(["svg", "png", "csv"].map(|ending| format!("{chart}.{ending}")));
    }
    expected.extend(["coloured", "grey", "error"].map(|name| format!("looks-{name}.png")));
    names.sort();
    expected.sort();
    assert_eq!(names, expected);
}

#[test]
fn a_document_reads_back_from_json() {
    let results: serde_json::Value =
        serde_json::from_slice(&crate::json(&fixture::document()).unwrap()).unwrap();
    assert_eq!(results, serde_json::to_value(fixture::document()).unwrap());
    assert_eq!(results["provenance"]["command"], "harness report made-up");
    let block = |section: usize, k: usize| &results["sections"][section]["blocks"][k];
    let curve = &block(0, 2)["chart"]["panels"][0]["curves"][3];
    assert_eq!(curve["line"][10]["y"], serde_json::Value::Null);
    assert_eq!(curve["marks"][6]["interval"][0], -0.1);
    let cell = |k: usize| &block(0, 4)["heat_map"]["content"]["panels"][3]["values"][k];
    assert_eq!(*cell(0), serde_json::Value::Null);
    assert_eq!((cell(40), cell(100)), (&serde_json::json!(0.0), &serde_json::json!("infinity")));
    let pixels = &block(1, 0)["gallery"]["rows"][0]["pictures"][2]["pixels"];
    assert_eq!(*pixels, serde_json::json!({ "mapping": "signed", "scale": 0.2 }));
}

#[test]
fn a_csv_has_one_row_per_point_with_the_digits_of_a_figure() {
    let files = written(&fixture::document(), Script::None);
    let variance = text(&files, "variance.csv");
    assert_eq!(variance.lines().count(), 1 + 4 * (25 + 7));
    let marks: Vec<&str> = variance.lines().filter(|line| line.starts_with("Woodcock,mark,")).collect();
    let document = fixture::document();
    let Some(Block::Chart(chart)) = document.blocks().nth(2) else { panic!("a chart") };
    let mark = &chart.panels[0].curves[0].marks[3];
    let cells: Vec<&str> = marks[3].split(',').collect();
    for (cell, number) in [(cells[2], mark.x), (cells[4], mark.interval.unwrap()[0])] {
        let read: f64 = cell.parse().unwrap();
        assert!((read / number - 1.0).abs() < 5e-6 && cell.len() <= 8, "{cell} for {number}");
    }
    assert!(marks[0].ends_with(",false") && marks[3].ends_with(",true"));
    let shares = text(&files, "shares.csv");
    assert!(shares.lines().any(|line| line.starts_with("again,exact,area,0,,0,1,")), "{shares}");

    let plane = text(&files, "plane.csv");
    assert_eq!(plane.lines().count(), 1 + 6 * 24 * 16);
    assert!(plane.lines().nth(1 + 3 * 384).unwrap().ends_with(','), "no value, no number");
    assert!(plane.lines().nth(1 + 3 * 384 + 100).unwrap().ends_with(",inf"));
    let winners = text(&files, "winners.csv");
    let last: Vec<&str> = winners.lines().last().unwrap().split(',').collect();
    assert_eq!((last[0], last[1].parse(), last[2].parse()), ("lin_dec", Ok(0.99), Ok(1.0)));
    assert!(!winners.contains("never the best"));
    assert!(winners.lines().skip(1).all(|line| line.split(',').nth(4).unwrap().parse::<f64>().is_ok()));

    let numbers = text(&files, "numbers.csv");
    assert!(numbers.contains("Woodcock,100000,0.818731,0.81853,0.81893,0.1234,true,1500000\n"), "{numbers}");
}

#[test]
fn dashes_and_marks_of_one_look_are_one_path() {
    let svg = text(&written(&fixture::document(), Script::None), "variance.svg");
    assert!(svg.contains("<path fill=\"none\" opacity=\"1\" stroke="), "{svg}");
    assert!(svg.contains("<path opacity=\"1\" fill=") && svg.contains("Z\"/>"));
    let elements: Vec<&str> = svg.lines().filter(|line| line.starts_with('<')).collect();
    assert!(elements.len() < 400, "{}", elements.len());
    for line in elements {
        assert!(line.ends_with('>') && line.matches('<').count() == 1, "{line}");
    }
}

/// Links of a page to files beside it.
fn links(page: &str) -> Vec<&str> {
    let after =
        |attribute: &'static str| page.split(attribute).skip(1).filter_map(|rest| rest.split('"').next());
    let links = after(" href=\"").chain(after(" src=\""));
    links.filter(|link| !link.starts_with(['#', 'd'])).collect()
}

#[test]
fn the_page_needs_no_network_and_its_links_lead_somewhere() {
    for script in [Script::None, Script::Embedded] {
        let files = written(&fixture::document(), script);
        let page = text(&files, "index.html");
        // The library speaks of addresses; nothing of the page asks for one.
        let (before, after) = page.split_once("</style>").unwrap();
        let after = match script {
            Script::None => after,
            Script::Embedded => after.split_once("</head>").unwrap().1,
        };
        let ours = format!("{before}{after}");
        assert!(!ours.contains("http") || ours.matches("http").count() == ours.matches("http-equiv").count());
        for link in links(&ours) {
            assert!(link == "results.json" || files.iter().any(|file| file.name == link), "{link}");
        }
        for file in files.iter().filter(|file| file.name != "index.html") {
            // Pages under review show each figure once.
            let drawn = file.name.ends_with(".png") && !file.name.starts_with("looks-");
            let is_linked = links(&ours).contains(&&*file.name);
            assert_eq!(is_linked, !(drawn && script == Script::None), "{}", file.name);
        }
        for anchor in ours.split("href=\"#").skip(1).filter_map(|rest| rest.split('"').next()) {
            assert!(ours.contains(&format!("id=\"{anchor}\"")), "{anchor}");
        }
        assert!(!ours.contains("<markup>") && !ours.contains("<nothing>"), "text of the document is escaped");
        assert!(
            ours.contains("% of the pixels negative, clipped to 0")
                && ours.contains("sRGB encoding of 2.00 · L")
        );
        assert!(!ours.contains("not sound") && ours.contains(">sound<"));
        assert!(ours.contains("=\"The best of five. Heat map of the best of Woodcock"));
        assert_eq!(ours.matches("id=\"shares\"").count(), 1, "the hero stands beside the answer alone");
        assert_eq!(page.contains("Plotly.newPlot"), script == Script::Embedded);
    }
}

#[test]
fn a_page_with_its_library_stays_below_six_megabytes() {
    let page = text(&written(&fixture::document(), Script::Embedded), "index.html");
    assert!(page.len() < 5_600_000, "{}", page.len());
    let page = text(&written(&fixture::document(), Script::None), "index.html");
    assert!(page.len() < 600_000, "{}", page.len());
}

#[test]
fn unsound_findings_are_said_in_the_page_and_in_the_tables() {
    let mut document = fixture::document();
    document.unsound.push("the mean is 7 standard errors off".to_owned());
    let files = written(&document, Script::None);
    for name in ["index.html", "tables.md"] {
        assert!(text(&files, name).contains("the mean is 7 standard errors off"), "{name}");
    }
    assert!(text(&files, "index.html").contains("not sound"));
}

#[test]
fn tables_keep_their_columns_and_round_by_the_interval() {
    let tables = text(&written(&fixture::document(), Script::None), "tables.md");
    let line = tables.lines().find(|line| line.starts_with("| spectral \\|")).unwrap();
    assert_eq!(line, "| spectral \\| with bar | 100000 | 0.81873 [0.81853, 0.81893] | 0.123 | no | — |");
    let claim = tables.lines().find(|line| line.starts_with("| M1")).unwrap();
    assert_eq!(claim.replace("\\|", "").matches('|').count(), 7, "{claim}");
    let hole = tables.lines().find(|line| line.starts_with("| hole")).unwrap();
    assert!(hole.starts_with("| hole | 0 |") && hole.ends_with(" | 18 |"), "{hole}");
    let shares = tables.lines().skip_while(|line| !line.starts_with("| share of the cells"));
    let rows: Vec<Vec<f64>> = shares
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.split('|').skip(2).filter_map(|cell| cell.trim().parse().ok()).collect())
        .collect();
    for panel in 0..6 {
        // Rounded to three digits.
        let sum: f64 = rows.iter().map(|row| row[panel]).sum();
        assert!((sum - 100.0).abs() < 0.3, "{sum}");
    }
}

#[test]
fn the_same_document_gives_the_same_files() {
    assert!(
        written(&fixture::document(), Script::Embedded) == written(&fixture::document(), Script::Embedded)
    );
}

#[test]
fn a_document_without_contents_is_still_a_document() {
    let mut document = fixture::document();
    (document.claims, document.summary, document.hero) = (Vec::new(), Vec::new(), None);
    for block in document.sections.iter_mut().flat_map(|section| &mut section.blocks) {
        match block {
            Block::Chart(chart) => {
                for panel in &mut chart.panels {
                    (panel.curves, panel.y.range) = (Vec::new(), None);
                }
            }
            Block::Table(table) => table.rows.clear(),
            Block::Gallery(gallery) => gallery.rows.clear(),
            _ => {}
        }
    }
    written(&document, Script::Embedded);
}

#[test]
fn a_wide_figure_does_not_stand_beside_the_answer() {
    let mut document = fixture::document();
    for (hero, is_beside) in [("variance", true), ("plane", false)] {
        document.hero = Some(hero.to_owned());
        let page = text(&written(&document, Script::None), "index.html");
        assert_eq!(page.contains("class=\"answer beside\""), is_beside, "{hero}");
    }
}

#[test]
fn long_tables_are_folded_under_their_line() {
    let mut document = fixture::document();
    for block in document.sections.iter_mut().flat_map(|section| &mut section.blocks) {
        let Block::Table(table) = block else { continue };
        table.rows = (0..20).map(|_| table.rows[0].clone()).collect();
    }
    let page = text(&written(&document, Script::None), "index.html");
    assert!(page.contains("<summary>20 rows</summary>"));
}
