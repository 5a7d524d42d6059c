//! What is half written when a person gives up is removed: no file or folder stays behind that nobody asked for.
//!
//! Whoever creates something temporary registers it with [`remove_on_interrupt`] and keeps the [`Guard`] until it is complete or gone.
//! The handler, which only the program installs, removes what is registered at that moment and ends the process. A program that embeds
//! the library keeps its own handlers; the registry is then a list that nobody reads.
//!
//! Work that can stop early with a result says so with [`stop_gently`]: the first interrupt then only asks it to, the second ends the
//! process.

use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Exit code 130: ended by a signal, as a shell says it of SIGINT.
pub const INTERRUPTED: i32 = 130;

/// How often a removal is tried while another thread may still be creating files in the same folder.
const ATTEMPTS: usize = 100;

static REGISTRY: Mutex<Registry> = Mutex::new(Registry { next: 0, entries: Vec::new(), gentle: Vec::new() });

/// Ends the process on SIGINT, SIGTERM and SIGHUP (on Windows: Ctrl-C, Ctrl-Break, close) after a removal of what is registered,
/// unless something is running that can [`stop gently`](stop_gently) and was not asked yet.
///
/// # Errors
/// If the process has such a handler already, or the system refuses one.
pub fn install() -> Result<(), String> {
    let handler = || {
        let mut stderr = io::stderr();
        // The line of a progress bar has no end yet.
        let gap = if stderr.is_terminal() { "\n" } else { "" };
        let shield = shield();
        if shield.registry.ask_to_stop() {
            let _ = writeln!(stderr, "{gap}interrupted: stops with what is done, again: stops at once");
            return;
        }
        // It is never released: from here on nothing is created under a shield, and nothing is put in place.
        shield.registry.clear();
        let _ = writeln!(stderr, "{gap}interrupted");
        std::process::exit(INTERRUPTED);
    };
    ctrlc::try_set_handler(handler).map_err(|error| error.to_string())
}

/// Until it is dropped, the first interrupt only asks to stop.
#[must_use = "an interrupt ends the process once this is dropped"]
pub fn stop_gently() -> GentleStop {
    let requested = Arc::new(AtomicBool::new(false));
    shield().registry.gentle.push(Arc::clone(&requested));
    GentleStop { requested }
}

/// See [`stop_gently`].
#[derive(Debug)]
pub struct GentleStop {
    requested: Arc<AtomicBool>,
}

impl GentleStop {
    /// Whether an interrupt asked to stop.
    #[must_use]
    pub fn is_requested(&self) -> bool {
        self.requested.load(Ordering::Relaxed)
    }
}

impl Drop for GentleStop {
    fn drop(&mut self) {
        shield().registry.gentle.retain(|other| !Arc::ptr_eq(other, &self.requested));
    }
}

/// Registers a file, or a folder with all that is in it, for removal. See [`Shield::remove_on_interrupt`].
#[must_use = "the path is forgotten when the guard is dropped"]
pub fn remove_on_interrupt(path: impl Into<PathBuf>) -> Guard {
    shield().remove_on_interrupt(path)
}

/// Keeps the handler waiting as long as it lives: for steps that belong together, such as the creation of a temporary file and
/// its registration, or two renames.
///
/// It is a lock: a thread must not ask for a second one, nor drop a [`Guard`], while it holds one; [`Shield::forget`] takes guards.
#[must_use]
pub fn shield() -> Shield {
    Shield { registry: REGISTRY.lock().unwrap_or_else(PoisonError::into_inner) }
}

/// See [`shield`].
pub struct Shield {
    registry: MutexGuard<'static, Registry>,
}

impl Shield {
    /// Registers a file, or a folder with all that is in it, until the guard is dropped. Relative paths are those of this moment.
    #[must_use = "the path is forgotten when the guard is dropped"]
    pub fn remove_on_interrupt(&mut self, path: impl Into<PathBuf>) -> Guard {
        self.registry.add(path.into(), What::Whole)
    }

    /// Registers a folder that is removed if it is empty then, after all that is removed whole; of several, the first first.
    #[must_use = "the path is forgotten when the guard is dropped"]
    pub fn remove_on_interrupt_if_empty(&mut self, path: impl Into<PathBuf>) -> Guard {
        self.registry.add(path.into(), What::IfEmpty)
    }

    /// Forgets a path: it is complete, or gone.
    pub fn forget(&mut self, mut guard: Guard) {
        if let Some(key) = guard.key.take() {
            self.registry.forget(key);
        }
    }
}

/// A path that is removed if the process is interrupted while this lives.
#[derive(Debug)]
pub struct Guard {
    key: Option<u64>,
}

impl Drop for Guard {
    fn drop(&mut self) {
        if let Some(key) = self.key {
            shield().registry.forget(key);
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum What {
    Whole,
    IfEmpty,
}

struct Registry {
    next: u64,
    entries: Vec<(u64, PathBuf, What)>,
    gentle: Vec<Arc<AtomicBool>>,
}

impl Registry {
    fn add(&mut self, path: PathBuf, what: What) -> Guard {
        let key = self.next;
        self.next += 1;
        let path = std::path::absolute(&path).unwrap_or(path);
        self.entries.push((key, path, what));
        Guard { key: Some(key) }
    }

    fn forget(&mut self, key: u64) {
        self.entries.retain(|entry| entry.0 != key);
    }

    /// Asks all work that can stop gently to do so; whether some was not asked before.
    fn ask_to_stop(&self) -> bool {
        // Not `any`, which would stop at the first one.
        self.gentle.iter().filter(|requested| !requested.swap(true, Ordering::Relaxed)).count() > 0
    }

    /// Removes what is registered. Nobody is left to be told what could not be removed.
    fn clear(&self) {
        let of = |what| self.entries.iter().filter(move |entry| entry.2 == what).map(|entry| &entry.1);
        of(What::Whole).for_each(|path| remove(path));
        for path in of(What::IfEmpty) {
            let _ = fs::remove_dir(path);
        }
    }
}

/// Removes a file, a link or a folder. Other threads still run: what they add to the folder meanwhile needs another attempt.
fn remove(path: &Path) {
    for _ in 0..ATTEMPTS {
        let Ok(metadata) = fs::symlink_metadata(path) else { return };
        let removed = if metadata.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
        if removed.is_ok() {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A registry of its own: the guards of others in this process are not touched.
    fn registry() -> Registry {
        Registry { next: 0, entries: Vec::new(), gentle: Vec::new() }
    }

    /// The guard of a registry of its own must not speak to the global one.
    fn key(mut guard: Guard) -> u64 {
        guard.key.take().unwrap()
    }

    #[test]
    fn what_is_registered_goes_and_the_rest_stays() {
        let root = tempfile::tempdir().unwrap();
        let at = |name: &str| root.path().join(name);
        fs::create_dir_all(at("folder/below")).unwrap();
        fs::create_dir_all(at("outer/inner")).unwrap();
        fs::create_dir_all(at("kept")).unwrap();
        for file in ["folder/below/file", "file", "done", "kept/file", "outer/inner/file"] {
            fs::write(at(file), "x").unwrap();
        }
        let mut registry = registry();
        // Folders that must be empty come after those that are removed whole, whatever the order of their registration.
        for name in ["outer/inner", "outer", "kept"] {
            key(registry.add(at(name), What::IfEmpty));
        }
        for name in ["folder", "file", "outer/inner/file", "never/was"] {
            key(registry.add(at(name), What::Whole));
        }
        let done = key(registry.add(at("done"), What::Whole));
        registry.forget(done);
        registry.clear();
        let mut left: Vec<_> =
            fs::read_dir(root.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, ["done", "kept"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_goes_and_what_it_points_to_stays() {
        let root = tempfile::tempdir().unwrap();
        let (target, link) = (root.path().join("target"), root.path().join("link"));
        fs::create_dir(&target).unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        remove(&link);
        assert!(target.is_dir() && fs::symlink_metadata(&link).is_err());
    }

    #[test]
    fn work_that_can_stop_is_asked_once() {
        let mut registry = registry();
        assert!(!registry.ask_to_stop(), "nobody is there to be asked");
        registry.gentle = vec![Arc::default(), Arc::default()];
        assert!(registry.ask_to_stop());
        assert!(registry.gentle.iter().all(|requested| requested.load(Ordering::Relaxed)));
        assert!(!registry.ask_to_stop());
    }

    #[test]
    fn a_dropped_guard_is_forgotten() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("file");
        let registered = || shield().registry.entries.iter().any(|entry| entry.1 == path);
        let guard = remove_on_interrupt(&path);
        assert!(registered());
        drop(guard);
        assert!(!registered());
        let guard = remove_on_interrupt(&path);
        shield().forget(guard);
        assert!(!registered());
    }
}
