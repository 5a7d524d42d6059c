//! Tells the program which revision it was built from.

use std::process::Command;

fn main() {
    // There is no such file: git is asked at every build, since what has changed is not a matter of a few files. Only the program is
    // compiled again, and only where the answer is another one.
    println!("cargo::rerun-if-changed=always");
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    // Without git, or outside a checkout (an unpacked archive), the version is all there is.
    let revision = match git(&["rev-parse", "--short=12", "HEAD"]) {
        Some(revision)
            // A report that was written again changes nothing of the program.
            if git(&["status", "--porcelain", "--untracked-files=no", "--", ":/", ":(top,exclude)reports"])
                .is_some_and(|changes| changes.is_empty()) =>
        {
            revision
        }
        Some(revision) => format!("{revision}+changes"),
        None => format!("v{}", env!("CARGO_PKG_VERSION")),
    };
    println!("cargo::rustc-env=FAIRFLIGHT_REVISION={revision}");
}
