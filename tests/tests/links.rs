//! Links of the documentation: each leads to something that is there.

use fairflight_tests::repository;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The pages written by hand: those at the root, and all below `docs`.
fn pages() -> Vec<PathBuf> {
    let root = repository();
    let mut folders = vec![root.clone(), root.join("docs"), root.join("tests/fixtures")];
    folders.extend(["docs/decisions", "docs/porting"].map(|folder| root.join(folder)));
    let mut found: Vec<PathBuf> = folders
        .iter()
        .flat_map(|folder| fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .collect();
    found.sort();
    found
}

/// The targets of the links `[text](target)` of a page, formulas and code left out, but for those to other hosts.
fn targets(text: &str) -> impl Iterator<Item = &str> {
    text.lines()
        .filter(|line| !line.starts_with("    "))
        .flat_map(|line| line.split("](").skip(1))
        .filter_map(|rest| rest.split_once(')'))
        .map(|(target, _)| target)
        .filter(|target| !target.contains("://") && !target.starts_with("mailto:"))
}

/// The anchors of a page, made from its headings as hosts of Markdown make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let anchor = |heading: &str| -> String {
        let kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
        heading.trim().to_lowercase().chars().filter(kept).map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    text.lines()
        .filter(|line| line.starts_with('#'))
        .map(|line| anchor(line.trim_start_matches('#')))
        .collect()
}

/// Says what is wrong with a link of a page; `None` if nothing is.
fn fault(page: &Path, text: &str, target: &str) -> Option<String> {
    let (file, anchor) = target.split_once('#').map_or((target, None), |(file, anchor)| (file, Some(anchor)));
    let path = if file.is_empty() { page.to_owned() } else { page.parent()?.join(file) };
    if !path.exists() {
        return Some(format!("{}: no {target}", page.display()));
    }
    let anchor = anchor?;
    let text = if file.is_empty() { text.to_owned() } else { fs::read_to_string(&path).ok()? };
    (!anchors(&text).contains(anchor)).then(|| format!("{}: no heading for {target}", page.display()))
}

#[test]
fn no_link_is_dead() {
    let mut links = 0;
    let mut faults = Vec::new();
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        for target in targets(&text) {
            links += 1;
            faults.extend(fault(&page, &text, target));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(links > 100, "only {links} links were read");
}

/// Files that a page of a report links to or shows.
fn files_of_page(page: &str) -> Vec<&str> {
    let after = |name: &'static str| page.split(name).skip(1).filter_map(|rest| rest.split('"').next());
    after(" href=\"")
        .chain(after(" src=\""))
        .filter(|link| !link.starts_with('#') && !link.contains(':'))
        .collect()
}

#[test]
fn reviewed_pages_have_all_that_they_link_to() {
    let mut links = 0;
    for folder in fs::read_dir(repository().join("reports/reference")).unwrap() {
        let folder = folder.unwrap().path();
        let Ok(page) = fs::read_to_string(folder.join("index.html")) else { continue };
        for link in files_of_page(&page) {
            links += 1;
            assert!(folder.join(link).is_file(), "{}: no {link}", folder.display());
        }
    }
    assert!(links > 100, "only {links} links were read");
}

/// The crates that people port from: their front page leads to the vectors and to the page for ports.
#[test]
fn front_pages_lead_to_vectors() {
    for name in ["sources", "stats", "media", "collision", "transmittance", "freeflight"] {
        let text = fs::read_to_string(repository().join("crates").join(name).join("src/lib.rs")).unwrap();
        let page: String = text.lines().take_while(|line| line.starts_with("//!")).collect();
        assert!(page.contains("**Law.**") || page.contains("law of"), "{name}: no law");
        assert!(page.contains("`docs/PORTING.md`"), "{name}: no page for ports");
        let vectors: Vec<&str> = page.split('`').filter(|word| word.starts_with("tests/vectors/")).collect();
        assert!(!vectors.is_empty(), "{name}: no vectors");
        let dead = vectors.iter().find(|file| !file.contains("KIND") && !repository().join(file).is_file());
        assert_eq!(dead, None, "{name}");
    }
}

#[test]
fn a_dead_link_is_found() {
    let page = repository().join("README.md");
    let text = "# Where things are\n[a](docs/none.md) [b](https://example.org/none) [c](#nowhere) [d](#where-things-are)";
    let faults: Vec<String> = targets(text).filter_map(|target| fault(&page, text, target)).collect();
    assert_eq!(faults.len(), 2, "{faults:?}");
}

#[test]
fn every_decision_is_in_the_index() {
    let folder = repository().join("docs/decisions");
    let index = fs::read_to_string(folder.join("README.md")).unwrap();
    for page in pages().iter().filter(|page| page.starts_with(&folder) && !page.ends_with("README.md")) {
        let name = page.file_name().unwrap().to_str().unwrap();
        assert!(index.contains(&format!("]({name})")), "{name}");
        let text = fs::read_to_string(page).unwrap();
        for part in ["**Decision.** ", "**Reason.** ", "**Code.** "] {
            assert!(text.contains(part), "{name}: no {part}");
        }
    }
}
