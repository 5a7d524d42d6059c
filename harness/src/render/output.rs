//! Files that appear whole or not at all.

use crate::image::{Exposure, Format, Image};
use crate::interrupt::{Guard, shield};
use crate::{Failure, partial};
use serde::Serialize;
use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Content of an output file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The picture.
    Image(Format),
    /// The numbers.
    Statistics,
}

impl Kind {
    /// The content by the extension.
    fn of(path: &Path) -> Result<Self, Failure> {
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) {
            return Ok(Self::Statistics);
        }
        Format::of(path).map(Self::Image).ok_or_else(|| {
            Failure::refused(format!(
                "--out {}: the extension must be .pfm, .exr, .png or .json",
                path.display()
            ))
        })
    }
}

/// The files that a command names.
#[derive(Debug)]
pub(super) struct Targets(Vec<(PathBuf, Kind)>);

impl Targets {
    /// Files of these paths; nothing is touched yet.
    ///
    /// # Errors
    /// If an extension says nothing.
    pub(super) fn of(paths: &[PathBuf]) -> Result<Self, Failure> {
        paths.iter().map(|path| Ok((path.clone(), Kind::of(path)?))).collect::<Result<_, _>>().map(Self)
    }

    /// True if one of them is tone-mapped.
    pub(super) fn has_tone_mapped(&self) -> bool {
        self.0.iter().any(|(_, kind)| *kind == Kind::Image(Format::Png))
    }

    /// The files of one image.
    pub(super) fn outputs(&self) -> Outputs {
        Outputs { targets: self.0.clone(), prepared: Vec::new() }
    }

    /// The files of one point of a sweep of so many: images with its number in their names, and the statistics of all points.
    pub(super) fn outputs_of(&self, point: usize, points: usize) -> Outputs {
        let mut outputs = self.outputs();
        for (path, _) in outputs.targets.iter_mut().filter(|(_, kind)| *kind != Kind::Statistics) {
            *path = numbered(path, point, points);
        }
        outputs
    }
}

/// Files that an image is written into, once or again and again.
#[derive(Debug)]
pub(super) struct Outputs {
    targets: Vec<(PathBuf, Kind)>,
    /// Made in advance, for the next time that something is put.
    prepared: Vec<Prepared>,
}

impl Outputs {
    /// Prepares to write: a long run should not end with the news that nobody can write there.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub(super) fn prepare(&mut self) -> Result<(), Failure> {
        self.prepared =
            self.targets.iter().map(|(path, _)| Prepared::new(path)).collect::<Result<_, Failure>>()?;
        Ok(())
    }

    /// Writes all files and puts them in their places together; those that were there before are replaced.
    ///
    /// # Errors
    /// If one cannot be written: none is put. If one cannot be put: those behind it are not.
    pub(super) fn put(
        &mut self,
        image: &Image,
        exposure: Exposure,
        statistics: &impl Serialize,
    ) -> Result<(), Failure> {
        if self.prepared.is_empty() {
            self.prepare()?;
        }
        for ((path, kind), file) in self.targets.iter().zip(&mut self.prepared) {
            let bytes = match kind {
                Kind::Image(Format::Png) => image.tone_mapped(exposure),
                Kind::Image(format) => image.encode(*format),
                Kind::Statistics => serde_json::to_vec_pretty(statistics).map_err(|error| error.to_string()),
            };
            file.write(&bytes.map_err(|error| Failure::not_written(path, error))?)?;
        }
        put(std::mem::take(&mut self.prepared))
    }

    /// The files that hold less than the image: they are tone-mapped.
    pub(super) fn tone_mapped(&self) -> impl Iterator<Item = &Path> {
        let is_png = |kind: &Kind| *kind == Kind::Image(Format::Png);
        self.targets.iter().filter(move |(_, kind)| is_png(kind)).map(|(path, _)| path.as_path())
    }
}

/// `NAME-0.png` for the first point of `NAME.png`; of more than ten points `NAME-00.png`, so that names are in order.
fn numbered(path: &Path, point: usize, points: usize) -> PathBuf {
    let width = points.saturating_sub(1).to_string().len();
    let mut name = path.file_stem().map(OsString::from).unwrap_or_default();
    name.push(format!("-{point:0width$}."));
    name.push(path.extension().unwrap_or_default());
    path.with_file_name(name)
}

/// A temporary file beside the one that it will become.
#[derive(Debug)]
struct Prepared {
    given: PathBuf,
    target: PathBuf,
    file: NamedTempFile,
    _guard: Guard,
}

impl Prepared {
    /// Prepares to write `path`.
    fn new(path: &Path) -> Result<Self, Failure> {
        let failed = |error: std::io::Error| Failure::not_written(path, error);
        // What a link points to is replaced, not the link.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if fs::symlink_metadata(&target).is_ok_and(|metadata| !metadata.is_file()) {
            return Err(Failure::not_written(path, "it exists and is no regular file; it is left as it is"));
        }
        let Some(name) = target.file_name() else {
            return Err(Failure::not_written(path, "the path has no name"));
        };
        let parent = match target.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        for (path, _lock) in partial::abandoned(parent, name, "partial") {
            // One that stays does no harm.
            let _ = fs::remove_file(path);
        }
        // An interrupt comes before this or finds it registered.
        let mut shield = shield();
        let file = partial::file(parent, name).map_err(failed)?;
        let guard = shield.remove_on_interrupt(file.path());
        Ok(Self { given: path.to_owned(), target, file, _guard: guard })
    }

    /// Fills the temporary file.
    fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let file = self.file.as_file_mut();
        file.write_all(bytes).and_then(|()| file.sync_all()).map_err(|e| Failure::not_written(&self.given, e))
    }
}

/// Puts all files in their places.
///
/// # Errors
/// If one cannot be: those behind it are not put either.
fn put(files: Vec<Prepared>) -> Result<(), Failure> {
    let _shield = shield();
    files.into_iter().try_for_each(|Prepared { given, target, file, .. }| {
        file.persist(&target).map(|_| ()).map_err(|error| Failure::not_written(&given, error.error))
    })
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
    fn nothing_is_there_before_it_is_put() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("image.pfm");
        fs::write(&path, "old").unwrap();
        let mut prepared = Prepared::new(&path).unwrap();
        prepared.write(b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        drop(prepared);
        assert_eq!(names(root.path()), ["image.pfm"]);
        let mut prepared = Prepared::new(&path).unwrap();
        prepared.write(b"new").unwrap();
        put(vec![prepared]).unwrap();
        assert_eq!(
            (names(root.path()), fs::read(&path).unwrap()),
            (vec!["image.pfm".to_owned()], b"new".to_vec())
        );
    }

    #[test]
    fn points_of_a_sweep_are_numbered() {
        let of = |name: &str, point, points| numbered(Path::new(name), point, points);
        assert_eq!(of("a/b.c.png", 0, 1), Path::new("a/b.c-0.png"));
        assert_eq!(of("b.EXR", 9, 10), Path::new("b-9.EXR"));
        assert_eq!(of("b.pfm", 9, 11), Path::new("b-09.pfm"));
    }

    #[test]
    fn what_is_no_file_is_left_alone() {
        let root = tempfile::tempdir().unwrap();
        fs::create_dir(root.path().join("folder.png")).unwrap();
        for name in ["folder.png", "no/such/image.png", ".."] {
            assert_eq!(Prepared::new(&root.path().join(name)).unwrap_err().code(), crate::NOT_WRITTEN);
        }
        assert_eq!(names(root.path()), ["folder.png"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_file_is_as_readable_as_any() {
        use std::os::unix::fs::PermissionsExt;
        let root = tempfile::tempdir().unwrap();
        let (path, ordinary) = (root.path().join("image.png"), root.path().join("ordinary"));
        fs::write(&ordinary, "").unwrap();
        put(vec![Prepared::new(&path).unwrap()]).unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&path), mode(&ordinary));
    }
}
