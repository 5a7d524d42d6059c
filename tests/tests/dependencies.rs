//! The direction of dependencies between packages, which no compiler checks.

use fairflight_tests::{members, repository};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The crates of this workspace that a manifest names, with the name of its own.
fn fairflight_dependencies(manifest: &Path) -> Vec<String> {
    let text = fs::read_to_string(manifest).unwrap();
    text.lines()
        .filter_map(|line| line.strip_prefix("fairflight-"))
        .filter_map(|rest| rest.split([' ', '=', '.']).next())
        .map(str::to_owned)
        .collect()
}

/// Dependency direction (docs/ARCHITECTURE.md): what a crate names directly; what that reaches is allowed too.
const ARROWS: [(&str, &[&str]); 18] = [
    ("elementary", &[]),
    ("sources", &["elementary"]),
    ("stats", &[]),
    ("media", &["elementary"]),
    ("volumes", &[]),
    // Independent of what it judges.
    ("vectors", &[]),
    ("collision", &["sources", "media"]),
    ("transmittance", &["collision"]),
    ("freeflight", &["collision"]),
    ("scene", &["media"]),
    // Statistics for tests, which judge means: of paths, photons and bidirectional.
    ("paths", &["scene", "freeflight", "transmittance", "stats"]),
    ("vpl", &["paths"]),
    ("photons", &["vpl"]),
    ("bidirectional", &["paths"]),
    ("metropolis", &["bidirectional"]),
    ("compensation", &["vpl"]),
    ("laws", &["stats", "transmittance", "freeflight"]),
    ("catalogue", &["laws", "paths", "vpl", "photons", "bidirectional", "metropolis", "compensation"]),
];

fn reachable(from: &str) -> BTreeSet<&'static str> {
    let direct = ARROWS.iter().find(|(name, _)| *name == from).map_or(&[][..], |(_, direct)| *direct);
    direct.iter().flat_map(|name| reachable(name).into_iter().chain([*name])).collect()
}

#[test]
fn dependencies_point_one_way() {
    for manifest in &members("crates") {
        let folder = manifest.parent().and_then(Path::file_name).unwrap().to_str().unwrap();
        assert!(ARROWS.iter().any(|(name, _)| *name == folder), "{folder} is not in the design");
        let allowed = reachable(folder);
        for dependency in fairflight_dependencies(manifest) {
            assert!(allowed.contains(dependency.as_str()), "{folder} must not depend on {dependency}");
        }
    }
    // Users and what they never name.
    const FOREIGN: [(&str, &[&str]); 4] = [
        ("harness", &["tests", "reports", "program", "document"]),
        ("harness/reports", &["tests", "program"]),
        ("harness/program", &["tests", "document"]),
        ("tests", &["harness", "reports", "program"]),
    ];
    for (user, foreign) in FOREIGN {
        let named = fairflight_dependencies(&repository().join(user).join("Cargo.toml"));
        assert!(
            named.iter().all(|name| !foreign.contains(&name.as_str())),
            "{user} must not depend on {foreign:?}"
        );
    }
}

#[test]
fn documents_know_no_crate_of_ours() {
    let manifest = repository().join("harness/document/Cargo.toml");
    assert!(fairflight_dependencies(&manifest).is_empty());
}

#[test]
fn who_depends_on_the_laws_compiles_no_scene() {
    let (mut reached, mut open) = (BTreeSet::new(), vec!["laws".to_owned()]);
    while let Some(name) = open.pop() {
        let manifest = repository().join("crates").join(&name).join("Cargo.toml");
        open.extend(
            fairflight_dependencies(&manifest).into_iter().filter(|next| reached.insert(next.clone())),
        );
    }
    for heavy in ["scene", "paths", "vpl", "compensation", "volumes", "catalogue"] {
        assert!(!reached.contains(heavy), "laws reach {heavy}");
    }
    assert!(reached.contains("stats"), "{reached:?}");
}
