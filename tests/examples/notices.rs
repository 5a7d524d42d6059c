//! Notices of third parties whose work the program contains, as Markdown on standard output: `harness/NOTICES.md`.
//!
//! ```sh
//! cargo run -p fairflight-tests --example notices > NOTICES && mv NOTICES harness/NOTICES.md
//! ```
//!
//! The crates are those that `cargo metadata` resolves for the program on this machine, build-time and test crates left out; copyright
//! lines and licences come from their sources.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A crate as `cargo metadata` tells of it.
struct Package {
    name: String,
    version: String,
    licence: String,
    folder: PathBuf,
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// The crates of others in the program, in order of their names.
fn packages(metadata: &Value) -> Vec<Package> {
    let all: BTreeMap<String, &Value> = metadata["packages"]
        .as_array()
        .unwrap()
        .iter()
        .map(|package| (text(&package["id"]), package))
        .collect();
    let nodes: BTreeMap<String, &Value> = metadata["resolve"]["nodes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|node| (text(&node["id"]), node))
        .collect();
    let program = all.iter().find(|(_, package)| package["name"] == "fairflight-program");
    let mut waiting = vec![program.expect("the program is a member of the workspace").0.clone()];
    let mut reached = BTreeSet::new();
    while let Some(id) = waiting.pop() {
        // A macro runs at build time: none of it is in the program, nor what it depends on.
        let is_macro =
            all[&id]["targets"].as_array().unwrap().iter().any(|target| target["kind"][0] == "proc-macro");
        if is_macro || !reached.insert(id.clone()) {
            continue;
        }
        for dependency in nodes[&id]["deps"].as_array().unwrap() {
            let kinds = dependency["dep_kinds"].as_array().unwrap();
            if kinds.iter().any(|kind| kind["kind"].is_null()) {
                waiting.push(text(&dependency["pkg"]));
            }
        }
    }
    let package = |id: &String| {
        let package = all[id];
        (!package["source"].is_null()).then(|| Package {
            name: text(&package["name"]),
            version: text(&package["version"]),
            licence: text(&package["license"]),
            folder: Path::new(&text(&package["manifest_path"])).parent().unwrap().to_owned(),
        })
    };
    let mut packages: Vec<Package> = reached.iter().filter_map(package).collect();
    packages.sort_by(|a, b| (&a.name, &a.version).cmp(&(&b.name, &b.version)));
    packages
}

/// The texts of a crate's licences, by file name.
fn licences(folder: &Path) -> BTreeMap<String, String> {
    let is_licence = |name: &str| {
        let name = name.to_uppercase();
        ["LICENSE", "LICENCE", "COPYING", "NOTICE"].iter().any(|start| name.starts_with(start))
    };
    fs::read_dir(folder)
        .unwrap()
        .filter_map(|entry| {
            let path = entry.unwrap().path();
            let name = path.file_name()?.to_str()?.to_owned();
            is_licence(&name).then_some(())?;
            Some((name, fs::read_to_string(path).ok()?))
        })
        .collect()
}

/// The lines that name holders of a copyright, templates of licences left out.
fn holders(texts: &BTreeMap<String, String>) -> BTreeSet<String> {
    let names_holder = |line: &&str| {
        let lower = line.to_lowercase();
        lower.starts_with("copyright") && lower.chars().any(|c| c.is_ascii_digit()) && !line.contains('[')
    };
    texts
        .values()
        .flat_map(|text| text.lines().map(str::trim))
        .filter(names_holder)
        .map(str::to_owned)
        .collect()
}

/// True if a licence leaves a choice that includes one of the two of this project, whose texts are in the repository.
fn is_dual(licence: &str) -> bool {
    let choices = licence.split(" OR ").flat_map(|choice| choice.split('/'));
    choices.into_iter().any(|choice| matches!(choice.trim(), "MIT" | "Apache-2.0"))
}

fn main() {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let host = Command::new(std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned()))
        .args(["--print", "host-tuple"])
        .output()
        .expect("rustc runs");
    let host = String::from_utf8(host.stdout).unwrap();
    let metadata = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--locked", "--filter-platform", host.trim()])
        .output()
        .expect("cargo runs");
    assert!(metadata.status.success(), "{}", String::from_utf8_lossy(&metadata.stderr));
    let metadata: Value = serde_json::from_slice(&metadata.stdout).expect("JSON");
    let packages = packages(&metadata);

    println!("# Notices of third parties\n");
    println!(
        "Written by `cargo run -p fairflight-tests --example notices` (on {}): do not edit. The program `harness` contains the fonts, the script and\n\
         crates below. Fairflight itself is licensed under MIT or Apache-2.0, at your choice.\n",
        host.trim()
    );
    let fonts = packages.iter().find(|package| package.name == "dejavu").expect("fonts of plots");
    let licence = fs::read_to_string(fonts.folder.join("assets/dejavu-fonts-ttf-2.37/LICENSE")).unwrap();
    println!("## Fonts of plots: DejaVu 2.37\n\n```text\n{}\n```\n", licence.trim());
    let charts = packages.iter().find(|package| package.name == "plotly").expect("the script of pages");
    let script = fs::read_to_string(charts.folder.join("resource/plotly.min.js")).unwrap();
    let notice: Vec<&str> = script.lines().skip(1).take_while(|line| line.starts_with("* ")).collect();
    println!("## Script of pages: plotly.js\n\n```text\n{}\n```\n", notice.join("\n").replace("* ", ""));
    println!("## Crates\n\n| crate | version | licence | copyright |\n|---|---|---|---|");
    let mut others = String::new();
    for Package { name, version, licence, folder } in &packages {
        let texts = licences(folder);
        let holders: Vec<String> = holders(&texts).into_iter().map(|line| line.replace('|', "/")).collect();
        println!("| {name} | {version} | {licence} | {} |", holders.join("; "));
        if !is_dual(licence) {
            for (file, text) in texts {
                others += &format!("\n### {name} {version}: {file}\n\n```text\n{}\n```\n", text.trim());
            }
        }
    }
    println!(
        "\nThe texts of MIT and Apache-2.0 are LICENSE-MIT and LICENSE-APACHE of this repository, with the holders above."
    );
    print!("\n## Other licences\n{others}");
}
