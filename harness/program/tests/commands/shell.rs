//! Completions, manual pages, licences.

use crate::common::harness;

#[test]
fn every_shell_completes_every_subcommand() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let outcome = harness(&["completions", shell], "");
        assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""), "{shell}");
        for word in ["estimate", "completions", "samples-per-pixel"] {
            assert!(outcome.stdout.contains(word), "{shell}: no {word}");
        }
    }
    assert_eq!(harness(&["completions", "fishy"], "").code, 2);
}

#[test]
fn every_subcommand_has_a_manual_page() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("man/man1");
    assert_eq!(harness(&["man", folder.to_str().unwrap()], "").code, 0);
    let page = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    assert!(page("harness.1").contains("unbiased estimators"));
    assert!(page("harness-render.1").contains("STOPS"));
    let help = harness(&["--help"], "").stdout;
    let commands =
        help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let commands: Vec<&str> =
        commands.filter_map(|line| line.strip_prefix("  ")?.split(' ').next()).collect();
    for command in commands.iter().filter(|command| !["", "help"].contains(command)) {
        assert!(page(&format!("harness-{command}.1")).contains(command), "{command}");
    }
    let file = root.path().join("file");
    std::fs::write(&file, "").unwrap();
    assert_eq!(harness(&["man", file.to_str().unwrap()], "").code, 3);
}

#[test]
fn the_licences_are_those_of_what_is_locked() {
    let notices = harness(&["licences"], "").stdout;
    assert!(notices.contains("Bitstream Vera Fonts Copyright"));
    let lock = include_str!("../../../../Cargo.lock");
    let crates: Vec<[&str; 2]> = notices
        .lines()
        .filter_map(|line| line.strip_prefix("| "))
        .filter_map(|line| line.split(" | ").collect::<Vec<_>>().first_chunk().copied())
        .filter(|[name, _]| *name != "crate")
        .collect();
    assert!(crates.len() > 50, "{}", crates.len());
    for [name, version] in &crates {
        let locked = format!("name = \"{name}\"\nversion = \"{version}\"\n");
        assert!(lock.contains(&locked), "{name} {version}: cargo run -p fairflight-tests --example notices");
    }
    // What the harness depends on is in the program; on Windows and elsewhere more crates are.
    let manifest = include_str!("../../../Cargo.toml");
    let own = manifest.split("[dependencies]").nth(1).unwrap().split("\n[").next().unwrap();
    for name in own.lines().filter_map(|line| line.split(" = ").next()).filter(|name| !name.is_empty()) {
        let is_listed = crates.iter().any(|[listed, _]| *listed == name);
        assert!(is_listed || name.starts_with("fairflight-"), "{name} is not in the notices");
    }
}
