//! A report folder appears whole or not at all.
//!
//! Everything is written into a folder beside the final one, which is then renamed. An older report makes way; anything else is
//! never touched. An interrupted run removes what it has begun.

use fairflight_document::File;
use fairflight_harness::interrupt::{Guard, shield};
use fairflight_harness::{Failure, partial};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The name of the file by which a folder is recognised as a report.
pub(super) const RESULTS: &str = "results.json";

/// A folder that will become the report.
#[derive(Debug)]
pub(super) struct Prepared {
    folder: PathBuf,
    partial: TempDir,
    /// Keeps other runs from it.
    _lock: Option<fs::File>,
    /// The parents that did not exist before, innermost first.
    created: Vec<PathBuf>,
    /// Of the temporary folder and of the parents.
    guards: Vec<Guard>,
    committed: bool,
}

impl Prepared {
    /// Prepares to write `folder`: a long measurement should not end with the news that nobody can write there.
    pub(super) fn new(folder: &Path) -> Result<Self, Failure> {
        let failed = |error: std::io::Error| Failure::not_written(folder, error);
        // What a link points to is replaced, not the link.
        let target = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
        let Some(name) = target.file_name() else {
            return Err(Failure::not_written(folder, "the path has no name to give to a report"));
        };
        let parent = match target.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        clear_abandoned(&target, parent, name);
        refuse_foreign(&target)?;
        let missing = parent.ancestors().filter(|path| *path != Path::new("") && !path.exists());
        let mut created = Created(missing.map(Path::to_owned).collect());
        // An interrupt comes before all of this or finds it registered.
        let mut shield = shield();
        fs::create_dir_all(parent).map_err(failed)?;
        let (partial, _lock) = partial::folder(parent, name, "partial").map_err(failed)?;
        let created = std::mem::take(&mut created.0);
        let mut guards = vec![shield.remove_on_interrupt(partial.path())];
        guards.extend(created.iter().map(|folder| shield.remove_on_interrupt_if_empty(folder)));
        Ok(Self { folder: target, partial, _lock, created, guards, committed: false })
    }

    /// Writes the files, and puts the folder in its place when it is complete.
    ///
    /// # Errors
    /// [`Failure::NotWritten`] at the first file that cannot be written; then nothing has changed.
    pub(super) fn commit(self, files: &[File]) -> Result<(), Failure> {
        for file in files {
            let path = self.partial.path().join(&file.name);
            fs::write(&path, &file.bytes).map_err(|error| Failure::not_written(&path, error))?;
        }
        self.put()
    }

    /// Puts the written folder in its place.
    fn put(mut self) -> Result<(), Failure> {
        // Time has passed since the first look.
        refuse_foreign(&self.folder)?;
        let failed = |error: std::io::Error| Failure::not_written(&self.folder, error);
        // Between the two renames there is neither the older report nor the new one in place: an interrupt waits.
        let _shield = shield();
        if fs::symlink_metadata(&self.folder).is_ok() {
            let parent = self.partial.path().parent().unwrap_or(Path::new("."));
            let name = self.folder.file_name().unwrap_or_default();
            // The older report is removed with this folder, after the new one is in place.
            let (old, _lock) = partial::folder(parent, name, "old").map_err(failed)?;
            let aside = old.path().join("report");
            fs::rename(&self.folder, &aside).map_err(failed)?;
            if let Err(error) = fs::rename(self.partial.path(), &self.folder) {
                // If even the way back fails, the older report must outlive this run where it is.
                if fs::rename(&aside, &self.folder).is_err() {
                    let kept = old.keep();
                    let reason = format!("{error}; the older report is in {}", kept.display());
                    return Err(Failure::not_written(&self.folder, reason));
                }
                return Err(failed(error));
            }
        } else {
            fs::rename(self.partial.path(), &self.folder).map_err(failed)?;
        }
        self.committed = true;
        self.guards.clear();
        Ok(())
    }
}

impl Drop for Prepared {
    fn drop(&mut self) {
        if self.committed {
            // Nothing is left under the temporary name.
            self.partial.disable_cleanup(true);
        } else {
            // The parents can only go when they are empty, which the temporary folder prevents: it goes first.
            let _ = fs::remove_dir_all(self.partial.path());
            drop(Created(std::mem::take(&mut self.created)));
        }
    }
}

/// Folders that are removed again, if they are empty, unless someone takes them over.
struct Created(Vec<PathBuf>);

impl Drop for Created {
    fn drop(&mut self) {
        for folder in &self.0 {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Removes what killed runs left beside `target`. One that was killed between its two renames left the older report aside: that one is put
/// back.
fn clear_abandoned(target: &Path, parent: &Path, name: &OsStr) {
    for (old, _lock) in partial::abandoned(parent, name, "old") {
        let aside = old.join("report");
        if aside.exists() && fs::symlink_metadata(target).is_err() && fs::rename(aside, target).is_err() {
            // The older report must outlive this run where it is.
            continue;
        }
        let _ = fs::remove_dir_all(old);
    }
    for (path, _lock) in partial::abandoned(parent, name, "partial") {
        let _ = fs::remove_dir_all(path);
    }
}

/// Refuses to replace what is neither empty nor a report.
fn refuse_foreign(folder: &Path) -> Result<(), Failure> {
    if fs::symlink_metadata(folder).is_err() {
        return Ok(());
    }
    let mut entries = fs::read_dir(folder).map_err(|error| Failure::not_written(folder, error))?;
    if entries.next().is_none() || is_report(folder) {
        Ok(())
    } else {
        Err(Failure::not_written(
            folder,
            "the folder exists and is no report of this program; it is left as it is",
        ))
    }
}

/// True for a folder that has results with a provenance of ours.
fn is_report(folder: &Path) -> bool {
    let Ok(text) = fs::read_to_string(folder.join(RESULTS)) else { return false };
    let Ok(results) = serde_json::from_str::<serde_json::Value>(&text) else { return false };
    let provenance = &results["provenance"];
    provenance["command"].as_str().is_some_and(|command| command.split(' ').next() == Some("harness"))
        && provenance["revision"].is_string()
        && provenance["seed"].is_u64()
        && (results["media"].is_array() || results["sections"].is_array())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names in a folder, in their order.
    fn names(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn giving_up_leaves_nothing_not_even_parents() {
        let root = tempfile::tempdir().unwrap();
        let prepared = Prepared::new(&root.path().join("a/b/standard")).unwrap();
        fs::write(prepared.partial.path().join("file"), "x").unwrap();
        drop(prepared);
        assert!(names(root.path()).is_empty());
    }

    #[test]
    fn a_file_in_the_way_of_a_parent_leaves_nothing() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("file"), "x").unwrap();
        let failure = Prepared::new(&root.path().join("file/standard")).unwrap_err();
        assert_eq!(failure.code(), fairflight_harness::NOT_WRITTEN);
        assert_eq!(names(root.path()), ["file"]);
    }

    #[test]
    fn a_foreign_folder_is_left_as_it_is() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("standard");
        fs::create_dir(&folder).unwrap();
        for results in
            ["", "{}", r#"{"provenance": {"command": "make", "revision": "1", "seed": 1}, "media": []}"#]
        {
            fs::write(folder.join(RESULTS), results).unwrap();
            let failure = Prepared::new(&folder).unwrap_err();
            assert_eq!(failure.code(), fairflight_harness::NOT_WRITTEN);
            assert_eq!(fs::read_to_string(folder.join(RESULTS)).unwrap(), results);
        }
        assert_eq!(names(root.path()), ["standard"]);
    }

    #[test]
    fn an_older_report_makes_way() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("standard");
        let ours =
            r#"{"provenance": {"command": "harness report", "revision": "1", "seed": 1}, "media": []}"#;
        for round in ["tables-1", "tables-2"] {
            let prepared = Prepared::new(&folder).unwrap();
            fs::write(prepared.partial.path().join(RESULTS), ours).unwrap();
            fs::write(prepared.partial.path().join(round), "x").unwrap();
            prepared.put().unwrap();
            assert_eq!(names(&folder), [RESULTS, round]);
            assert_eq!(names(root.path()), ["standard"]);
        }
    }

    #[cfg(unix)]
    #[test]
    fn what_a_killed_run_left_is_removed_and_what_it_put_aside_is_put_back() {
        let root = tempfile::tempdir().unwrap();
        let (target, name) = (root.path().join("standard"), OsStr::new("standard"));
        let abandon = |what: &str| partial::folder(root.path(), name, what).unwrap().0.keep();
        fs::create_dir(abandon("old").join("report")).unwrap();
        fs::write(abandon("partial").join("index.html"), "half").unwrap();
        let prepared = Prepared::new(&target).unwrap();
        assert!(target.is_dir());
        assert_eq!(names(root.path()).len(), 2, "the older report and what is being written");
        // A run beside this one takes nothing from it.
        drop(Prepared::new(&target).unwrap());
        prepared.put().unwrap();
        assert_eq!(names(root.path()), ["standard"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_report_is_as_readable_as_any_folder() {
        use std::os::unix::fs::PermissionsExt;
        let root = tempfile::tempdir().unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        let ordinary = root.path().join("ordinary");
        fs::create_dir(&ordinary).unwrap();
        let folder = root.path().join("standard");
        Prepared::new(&folder).unwrap().put().unwrap();
        assert_eq!(mode(&folder), mode(&ordinary));
    }
}
