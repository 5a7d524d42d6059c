//! Hidden files and folders beside what they will become, `.NAME.partial-xxxxxx`: what is put in place is whole.
//!
//! Each is locked as long as its run lives, and the system unlocks it when a run is killed. So the next run with the same target tells
//! what is abandoned from what another run is writing, and removes it. Where the system has no such locks, nothing is removed.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile, TempDir};

/// Characters that make a name unique.
const RANDOM: usize = 6;

/// `.NAME.WHAT-`
fn prefix(name: &OsStr, what: &str) -> OsString {
    let mut prefix = OsString::from(".");
    prefix.push(name);
    prefix.push(format!(".{what}-"));
    prefix
}

/// Builder of files and folders with these rights, where a system has them.
#[cfg_attr(not(unix), allow(unused_variables))]
fn builder(prefix: &OsStr, mode: u32) -> Builder<'_, 'static> {
    let mut builder = Builder::new();
    builder.prefix(prefix).rand_bytes(RANDOM);
    #[cfg(unix)]
    builder.permissions(<fs::Permissions as std::os::unix::fs::PermissionsExt>::from_mode(mode));
    builder
}

/// A new file with the rights of an ordinary one, into which it will be renamed.
pub fn file(parent: &Path, name: &OsStr) -> io::Result<NamedTempFile> {
    let prefix = prefix(name, "partial");
    loop {
        let file = builder(&prefix, 0o666).tempfile_in(parent)?;
        let _ = file.as_file().lock();
        // Before it was locked another run may have taken it for abandoned.
        if file.path().exists() {
            return Ok(file);
        }
    }
}

/// A new folder with the rights of an ordinary one, and what keeps it locked: nothing where folders cannot be opened.
pub fn folder(parent: &Path, name: &OsStr, what: &str) -> io::Result<(TempDir, Option<File>)> {
    let prefix = prefix(name, what);
    loop {
        let folder = builder(&prefix, 0o777).tempdir_in(parent)?;
        let lock = File::open(folder.path()).ok();
        let _ = lock.as_ref().map(File::lock);
        if folder.path().exists() {
            return Ok((folder, lock));
        }
    }
}

/// Partial files that killed runs left beside the target `name`, each with the lock that keeps others from it.
pub fn abandoned(parent: &Path, name: &OsStr, what: &str) -> Vec<(PathBuf, File)> {
    let prefix = prefix(name, what);
    let entries = fs::read_dir(parent).into_iter().flatten().flatten();
    let ours = entries.filter(|entry| {
        let name = entry.file_name();
        let rest = name.as_encoded_bytes().strip_prefix(prefix.as_encoded_bytes());
        rest.is_some_and(|rest| rest.len() == RANDOM && rest.iter().all(u8::is_ascii_alphanumeric))
            // A link or a pipe is none of ours.
            && entry.file_type().is_ok_and(|kind| kind.is_file() || kind.is_dir())
    });
    ours.filter_map(|entry| {
        let lock = File::open(entry.path()).ok()?;
        lock.try_lock().ok()?;
        Some((entry.path(), lock))
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_use_is_not_abandoned() {
        let root = tempfile::tempdir().unwrap();
        let name = OsStr::new("image.png");
        let file = file(root.path(), name).unwrap();
        let (folder, lock) = folder(root.path(), name, "partial").unwrap();
        for other in
            [".image.png.partial-abc", ".image.png.partial-abcde.", ".image.partial-abcdef", "image.png"]
        {
            fs::write(root.path().join(other), "").unwrap();
        }
        assert!(abandoned(root.path(), name, "partial").is_empty());
        let mut left = [file.path().to_owned(), folder.path().to_owned()];
        // A killed run removes nothing.
        let (_, _) = (file.keep().unwrap(), folder.keep());
        drop(lock);
        let mut found: Vec<PathBuf> =
            abandoned(root.path(), name, "partial").into_iter().map(|(path, _)| path).collect();
        left.sort();
        found.sort();
        // Elsewhere folders cannot be opened.
        assert_eq!(found, if cfg!(unix) { &left[..] } else { &left[..1] });
    }
}
