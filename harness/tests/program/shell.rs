//! Completions and manual pages.

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
