//! Invariants of the repository that no compiler checks.

use fairflight_tests::{files, has_extension, members, repository, sources};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

#[test]
fn crates_know_no_files_clocks_threads_or_terminals() {
    const FORBIDDEN: [&str; 9] = [
        "std::fs",
        "std::thread",
        "std::time",
        "std::env",
        "std::process",
        "std::net",
        "println!",
        "eprint!",
        "dbg!",
    ];
    for (path, text) in sources("crates").into_iter().chain(sources("harness/document")) {
        // A test may ask a browser.
        let is_test = path.ends_with("document/src/browser.rs") || path.ends_with("document/src/tests.rs");
        let is_library = path.components().any(|part| part.as_os_str() == "src") && !is_test;
        for word in FORBIDDEN {
            let mut code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            let is_used = code.any(|line| line.contains(word));
            assert!(!is_library || !is_used, "{} uses {word}", path.display());
        }
    }
}

/// Words like `novak-2014`: lower-case letters and hyphens, then a year.
fn citation_keys(text: &str) -> BTreeSet<String> {
    let is_part = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    text.split(|c| !is_part(c))
        .filter(|word| {
            let Some((name, year)) = word.rsplit_once('-') else { return false };
            let is_name = name.starts_with(|c: char| c.is_ascii_lowercase())
                && name.chars().all(|c| c.is_ascii_lowercase() || c == '-');
            is_name
                && year.len() == 4
                && (year.starts_with("19") || year.starts_with("20"))
                && year.chars().all(|c| c.is_ascii_digit())
        })
        .map(str::to_owned)
        .collect()
}

#[test]
fn a_citation_key_is_recognised() {
    let keys =
        citation_keys("as szirmay-kalos-2017 eq. 4, not (novak-2014) or 2^-2017, SAND2008-6212, 1999-2000.");
    assert_eq!(keys.into_iter().collect::<Vec<_>>(), ["novak-2014", "szirmay-kalos-2017"]);
}

#[test]
fn every_citation_key_is_listed() {
    let references = fs::read_to_string(repository().join("docs/REFERENCES.md")).unwrap_or_default();
    let listed = citation_keys(&references);
    let texts = sources("crates").into_iter().chain(
        files("docs")
            .into_iter()
            .filter(|path| has_extension(path, &["md"]))
            .map(|path| (path.clone(), fs::read_to_string(&path).unwrap())),
    );
    let missing: BTreeSet<String> = texts
        .flat_map(|(path, text)| {
            citation_keys(&text)
                .into_iter()
                .map(move |key| (key, path.display().to_string()))
                .collect::<Vec<_>>()
        })
        .filter(|(key, _)| !listed.contains(key))
        .map(|(key, path)| format!("{key} in {path}"))
        .collect();
    assert!(missing.is_empty(), "not in docs/REFERENCES.md: {missing:#?}");
}

#[test]
fn a_long_file_says_why() {
    const MOST_LINES: usize = 400;
    for folder in ["crates", "harness", "tests"] {
        for (path, text) in sources(folder) {
            let lines = text.lines().count();
            let heading: String = text.lines().take_while(|line| line.starts_with("//!")).collect();
            let explains = ["longer than", "long because"].iter().any(|words| heading.contains(words));
            assert!(lines <= MOST_LINES || explains, "{}: {lines} lines without a reason", path.display());
        }
    }
}

/// Product lines of the harness, its packages and the build script included: all lines of formatted Rust but modules of tests, integration tests,
/// benches and examples. The number only falls, or rises by what a change of the program is worth, said where it is raised: 1,200 for the
/// integrator `bidirectional`, its light image, its table of strategies, and its report; 840 for the extensions of `path_tracer` and for
/// `beam_radiance`, their keys, refusals, maps and groups; 450 for the sections of the reports on both at equal time, and strategies without weights;
/// 1,050 for `metropolis` and `energy_redistribution` in both spaces, their refusals, mutations and layer of replicas; 330 for stages of chains that learn, shares
/// of mutations, and images of chains that end early; 1,100 for the report on them: two modes in closed form, rows, mutations, equal time, resolution; 200 for
/// estimates in lanes; 240 for what chains learn from each other, in that report, and aims of an importance; 260 for point sets of pixels; 285 for test vectors,
/// the answers of ports and their statistics; 90 for importons in lanes; 855 for the report on speed, which takes the place of 380 lines of benches, and
/// phase functions and single particles in lanes.
const MOST_PRODUCT_LINES: usize = 36_960;

#[test]
fn the_harness_does_not_grow() {
    let is_product = |path: &Path| {
        let inside = path.strip_prefix(repository()).unwrap_or(path);
        let named = |name: &str| inside.components().any(|part| part.as_os_str() == name);
        !["tests", "benches", "examples"].into_iter().any(named)
    };
    let mut lines = 0;
    let all = sources("harness");
    // Files that a `#[cfg(test)] mod name;` beside them declares.
    let tests: BTreeSet<PathBuf> = all.iter().flat_map(|(path, text)| test_files(path, text)).collect();
    for (_, text) in all.iter().filter(|(path, _)| is_product(path) && !tests.contains(path)) {
        let code: Vec<&str> = text.lines().collect();
        let inline = |k: &usize| {
            code[*k].trim() == "#[cfg(test)]"
                && code[k + 1].trim_start().starts_with("mod ")
                && code[k + 1].ends_with('{')
        };
        lines += (0..code.len().saturating_sub(1)).find(inline).unwrap_or(code.len());
    }
    assert!(lines <= MOST_PRODUCT_LINES, "{lines} product lines, {MOST_PRODUCT_LINES} are allowed");
    assert!(
        lines + 200 > MOST_PRODUCT_LINES,
        "{lines} product lines: the limit can fall from {MOST_PRODUCT_LINES}"
    );
}

/// Files of modules that a source declares for tests only.
fn test_files(path: &Path, text: &str) -> Vec<PathBuf> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let folder = path.parent().unwrap();
    let inside = if path.ends_with("mod.rs") || path.ends_with("lib.rs") || path.ends_with("main.rs") {
        folder.to_owned()
    } else {
        path.with_extension("")
    };
    let declared = lines.windows(2).filter(|pair| pair[0] == "#[cfg(test)]");
    declared
        .filter_map(|pair| pair[1].strip_suffix(';')?.rsplit(' ').next())
        .map(|name| inside.join(format!("{name}.rs")))
        .collect()
}

/// Blocks of bounds: the number of the line that ends with `where`, and the lines of the block, that one included.
fn where_blocks(text: &str) -> Vec<(usize, usize)> {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let lines: Vec<&str> = text.lines().collect();
    let starts = |line: &str| {
        let code = line.trim();
        !code.starts_with("//") && (code == "where" || code.ends_with(" where"))
    };
    let length = |start: usize| {
        let deeper = |line: &&&str| indent(line) > indent(lines[start]);
        1 + lines[start + 1..].iter().take_while(deeper).count()
    };
    let blocks = lines.iter().enumerate().filter(|(_, line)| starts(line));
    blocks.map(|(start, _)| (start + 1, length(start))).collect()
}

#[test]
fn blocks_of_bounds_are_counted() {
    let text = "fn a<F>()\nwhere\n    F: X\n        + Y,\n{\n    // a place where\n    b\n}\nimpl<E> A for E where\n    E: B,\n{\n}\n";
    assert_eq!(where_blocks(text), [(2, 3), (9, 2)]);
}

/// Bounds that many functions share have a name: a trait that bundles types ([`Types`](fairflight_paths::transport::Types)), or one that
/// implies them. The total may fall, and not rise.
#[test]
fn bounds_are_short() {
    const MOST_LINES: usize = 4;
    const TOTAL: usize = 129;
    let mut total = 0;
    for folder in ["crates", "harness", "tests"] {
        for (path, text) in sources(folder) {
            for (line, lines) in where_blocks(&text) {
                assert!(lines <= MOST_LINES, "{}:{line}: {lines} lines of bounds", path.display());
                total += lines;
            }
        }
    }
    assert!(total <= TOTAL, "{total} lines of bounds, more than {TOTAL}");
}

/// A type says what it holds: something to be done is a function, or an object with a method.
#[test]
fn no_type_is_a_job() {
    for folder in ["crates", "harness", "tests"] {
        for (path, text) in sources(folder) {
            let words = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
            let mut jobs = words.filter(|word| word.len() > 3 && word.ends_with("Job"));
            assert_eq!(jobs.next(), None, "{}", path.display());
        }
    }
}

#[test]
fn no_path_of_a_machine() {
    // Spelled in two parts, so that this file has none.
    let forbidden = [["/ho", "me/"], ["/wo", "rk/"], ["/Us", "ers/"], ["/ro", "ot/"], ["C:", "\\"]]
        .map(|parts| parts.concat());
    for folder in ["crates", "harness", "tests", "docs", "reports"] {
        let is_text =
            |path: &PathBuf| has_extension(path, &["rs", "md", "toml", "json", "html", "csv", "svg"]);
        for path in files(folder).into_iter().filter(is_text) {
            let text = fs::read_to_string(&path).unwrap_or_default();
            for word in &forbidden {
                assert!(!text.contains(word.as_str()), "{} contains {word}", path.display());
            }
        }
    }
}

/// True if `folder` or one above it, up to `root`, has results or tables that state their command.
fn states_its_command(folder: &Path, root: &Path) -> bool {
    let results = fs::read_to_string(folder.join("results.json")).unwrap_or_default();
    let json: serde_json::Value = serde_json::from_str(&results).unwrap_or_default();
    if json["provenance"]["command"].as_str().is_some_and(|command| !command.is_empty()) {
        return true;
    }
    // Where the results are too large to be reviewed.
    let tables = fs::read_to_string(folder.join("tables.md")).unwrap_or_default();
    if tables.lines().any(|line| line.starts_with("Written by `harness ")) {
        return true;
    }
    folder != root && folder.parent().is_some_and(|above| states_its_command(above, root))
}

#[test]
fn reports_are_generated_and_say_by_what() {
    let root = repository().join("reports/reference");
    for path in files("reports/reference") {
        // A page that stands alone says it in an HTML comment.
        let text = if has_extension(&path, &["md", "html", "svg"]) {
            fs::read_to_string(&path).unwrap()
        } else {
            String::new()
        };
        let comment = text.split("<!--").skip(1).any(|comment| comment.contains("fairflight"));
        let covered = path.parent().is_some_and(|folder| states_its_command(folder, &root));
        assert!(comment || covered, "{} does not say what made it", path.display());
    }
}

/// Streams of reports, comparisons and advice have names: a number would be a place in a list, which moves when something is added to it.
///
/// Seen in the text: nothing there derives a child by its number but `Seeded::for_batch` (batches and pixels have no other name), and what
/// a call of a function of seeds is given begins with no digit and, where it is a string, says a word beside what is put into it.
#[test]
fn seeds_of_reports_are_made_from_names() {
    for folder in ["harness/reports/src", "harness/src/comparison", "harness/src/advise"] {
        for (path, text) in sources(folder) {
            assert!(!text.contains("derive_seed"), "{} derives a seed from a number", path.display());
            for call in text.split("seed(").skip(1) {
                let call = call.split(';').next().unwrap_or_default();
                let (_, name) = call.split_once('"').unwrap_or_default();
                let name = name.split('"').next().unwrap_or_default();
                let words: String =
                    name.split('{').map(|part| part.rsplit('}').next().unwrap_or_default()).collect();
                let is_word = name.is_empty() || words.contains(char::is_alphabetic);
                let is_number = call.starts_with(|c: char| c.is_ascii_digit());
                assert!(is_word && !is_number, "{}: seed({call}", path.display());
            }
        }
    }
}

#[test]
fn library_crates_can_be_published() {
    let workspace = fs::read_to_string(repository().join("Cargo.toml")).unwrap();
    let paths = workspace.lines().filter(|line| line.starts_with("fairflight-"));
    for line in paths.filter(|line| line.contains("path = \"crates/")) {
        assert!(
            line.contains("version = "),
            "a published crate names versions of those that it builds on: {line}"
        );
    }
    for manifest in members("crates") {
        let text = fs::read_to_string(&manifest).unwrap();
        assert!(!text.contains("publish"), "{}", manifest.display());
        for key in ["description = ", "license.workspace", "keywords.workspace", "categories.workspace"] {
            assert!(text.contains(key), "{}: no {key}", manifest.display());
        }
        let library = fs::read_to_string(manifest.with_file_name("src").join("lib.rs")).unwrap();
        let front_page = library.lines().take_while(|line| line.starts_with("//!"));
        assert!(
            front_page.filter(|line| line.starts_with("//! ```")).count() >= 2,
            "{}: no example",
            manifest.display()
        );
    }
}
