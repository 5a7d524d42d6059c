//! Interrupts: whoever works asks whether to go on.
//!
//! The first signal is a request. Batches, passes and checks ask for it with [`check`] and return, so that
//! temporary files are removed as on any other way out. Work that can end early with a result says so with
//! [`stop_gently`], and asks when it has something whole. What has not come to an end [`GRACE`] after the
//! request, or at a second signal, is ended where it is: then, and only then, the files and folders that are
//! registered under a [`shield`] are removed from here.
//!
//! Only the program [installs](install) this; a program that embeds the library keeps its own handlers, and no
//! request is ever made.

use crate::{Failure, INTERRUPTED};
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::Duration;

/// The time that work has to notice a request, unless it stops gently.
pub const GRACE: Duration = Duration::from_secs(2);

/// Number of attempts at a removal while another thread may still be creating files in the same folder.
const ATTEMPTS: usize = 100;

/// Signals so far.
static REQUESTS: AtomicUsize = AtomicUsize::new(0);
/// Pieces of work that stop gently.
static GENTLE: AtomicUsize = AtomicUsize::new(0);
/// True once the end has begun.
static ENDING: AtomicBool = AtomicBool::new(false);
static TEMPORARY: Mutex<Vec<Temporary>> = Mutex::new(Vec::new());

/// Serves SIGHUP, SIGINT, SIGQUIT and SIGTERM, each by itself. One that was ignored when the program started
/// stays ignored, as `nohup` and background jobs of a shell want it; that is known on Linux only, elsewhere all
/// are served.
///
/// # Errors
/// If the system refuses some: the others are served.
#[cfg(unix)]
pub fn install() -> Result<(), String> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    use signal_hook::iterator::Signals;
    let failed = |error: io::Error| error.to_string();
    let mut signals = Signals::new::<[i32; 0], i32>([]).map_err(failed)?;
    let ignored = fs::read_to_string("/proc/self/status").map_or(0, |status| ignored(&status));
    let mut refused = Vec::new();
    for (signal, name) in [(SIGHUP, "SIGHUP"), (SIGINT, "SIGINT"), (SIGQUIT, "SIGQUIT"), (SIGTERM, "SIGTERM")]
    {
        if ignored >> (signal - 1) & 1 == 1 {
            continue;
        }
        if let Err(error) = signals.add_signal(signal) {
            refused.push(format!("{name}: {error}"));
        }
    }
    let serve = move || signals.forever().for_each(|_| request());
    std::thread::Builder::new().name("signals".to_owned()).spawn(serve).map_err(failed)?;
    if refused.is_empty() { Ok(()) } else { Err(refused.join(", ")) }
}

/// Serves Ctrl-C, Ctrl-Break and close.
///
/// # Errors
/// If the process has such a handler already, or the system refuses one.
#[cfg(windows)]
pub fn install() -> Result<(), String> {
    ctrlc::try_set_handler(request).map_err(|error| error.to_string())
}

/// The signals, a bit each from the lowest, that a process ignores: `SigIgn` of its `/proc/PID/status`
/// (proc_pid_status(5)).
#[cfg(unix)]
fn ignored(status: &str) -> u64 {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Handles a signal.
fn request() {
    if REQUESTS.fetch_add(1, Ordering::SeqCst) > 0 {
        end_at_once();
    }
    if GENTLE.load(Ordering::SeqCst) > 0 {
        tell("interrupted: stops with what is done, again: stops at once");
        return;
    }
    let late = || {
        std::thread::sleep(GRACE);
        end_at_once();
    };
    if std::thread::Builder::new().spawn(late).is_err() {
        end_at_once();
    }
}

/// True for the caller that asks first, by whom the process ends: it tells that it was interrupted, nobody else does.
pub fn ends_here() -> bool {
    !ENDING.swap(true, Ordering::SeqCst)
}

/// Removes what is registered, and ends the process.
fn end_at_once() -> ! {
    if !ends_here() {
        // The program is on its way out.
        loop {
            std::thread::park();
        }
    }
    // It is never released: from here on nothing is created under a shield, and nothing is put in place.
    let shield = shield();
    clear(&shield.0);
    tell("interrupted");
    std::process::exit(INTERRUPTED);
}

fn tell(what: &str) {
    let mut stderr = io::stderr();
    // The line of a progress bar has no end yet. Nobody is left to tell if standard error is closed.
    let gap = if stderr.is_terminal() { "\n" } else { "" };
    let _ = writeln!(stderr, "{gap}{what}");
}

/// Checks that work may go on.
///
/// # Errors
/// [`Failure::Interrupted`] after a signal, unless something stops gently.
pub fn check() -> Result<(), Failure> {
    if REQUESTS.load(Ordering::Relaxed) > 0 && GENTLE.load(Ordering::Relaxed) == 0 {
        return Err(Failure::Interrupted);
    }
    Ok(())
}

/// Until it is dropped, the first interrupt stops nobody else.
#[must_use = "an interrupt stops all work once this is dropped"]
pub fn stop_gently() -> GentleStop {
    GENTLE.fetch_add(1, Ordering::SeqCst);
    GentleStop(())
}

/// See [`stop_gently`].
#[derive(Debug)]
pub struct GentleStop(());

impl GentleStop {
    /// True if an interrupt asked to stop.
    #[must_use]
    pub fn is_requested(&self) -> bool {
        REQUESTS.load(Ordering::Relaxed) > 0
    }
}

impl Drop for GentleStop {
    fn drop(&mut self) {
        GENTLE.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Keeps the end of the process waiting as long as it lives: for steps that belong together, such as the
/// creation of a temporary file and its registration, or two renames. A thread must not ask for a second one
/// while it holds one.
#[must_use]
pub fn shield() -> Shield {
    Shield(TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner))
}

/// See [`shield`].
pub struct Shield(MutexGuard<'static, Vec<Temporary>>);

impl Shield {
    /// Registers a file, or a folder with all that is in it, until the guard is dropped. Relative paths are those of this moment.
    #[must_use = "the path is forgotten when the guard is dropped"]
    pub fn remove_on_interrupt(&mut self, path: impl Into<PathBuf>) -> Guard {
        register(&mut self.0, path.into(), What::Whole)
    }

    /// Registers a folder that is removed if it is empty then, after all that is removed whole; of several, the first first.
    #[must_use = "the path is forgotten when the guard is dropped"]
    pub fn remove_on_interrupt_if_empty(&mut self, path: impl Into<PathBuf>) -> Guard {
        register(&mut self.0, path.into(), What::IfEmpty)
    }
}

/// A path that is removed if the process is ended while this lives.
#[derive(Debug)]
#[must_use = "the path is forgotten when the guard is dropped"]
pub struct Guard {
    /// Alive as long as this, which is what the registry sees.
    _path: Arc<PathBuf>,
}

struct Temporary {
    path: Weak<PathBuf>,
    what: What,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum What {
    Whole,
    IfEmpty,
}

fn register(temporary: &mut Vec<Temporary>, path: PathBuf, what: What) -> Guard {
    temporary.retain(|old| old.path.strong_count() > 0);
    let path = Arc::new(std::path::absolute(&path).unwrap_or(path));
    temporary.push(Temporary { path: Arc::downgrade(&path), what });
    Guard { _path: path }
}

/// Removes what is registered. Nobody is left to be told what could not be removed.
fn clear(temporary: &[Temporary]) {
    let of = |what| temporary.iter().filter(move |it| it.what == what).filter_map(|it| it.path.upgrade());
    of(What::Whole).for_each(|path| remove(&path));
    for path in of(What::IfEmpty) {
        let _ = fs::remove_dir(&*path);
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
        // A list of its own: the files of others in this process are not touched.
        let mut temporary = Vec::new();
        // Folders that must be empty come after those that are removed whole, whatever the order of their registration.
        let mut guards = Vec::new();
        for name in ["outer/inner", "outer", "kept"] {
            guards.push(register(&mut temporary, at(name), What::IfEmpty));
        }
        for name in ["folder", "file", "outer/inner/file", "never/was"] {
            guards.push(register(&mut temporary, at(name), What::Whole));
        }
        drop(register(&mut temporary, at("done"), What::Whole));
        clear(&temporary);
        let mut left: Vec<_> =
            fs::read_dir(root.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, ["done", "kept"]);
        drop(guards);
        let _last = register(&mut temporary, at("file"), What::Whole);
        assert_eq!(temporary.len(), 1, "what is gone is forgotten");
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

    #[cfg(unix)]
    #[test]
    fn what_is_ignored_is_read_from_the_status() {
        let status = "Name:\tharness\nSigBlk:\t0000000000000002\nSigIgn:\t0000000000001007\nSigCgt:\t0000000000000000\n";
        let ignores = |signal: u32| ignored(status) >> (signal - 1) & 1 == 1;
        assert_eq!([1, 2, 3, 13, 15].map(ignores), [true, true, true, true, false]);
        assert_eq!(ignored("Name:\tharness\n"), 0);
    }
}
