//! The text of a spec, a medium or a scene, from a file or from standard input.

use crate::reader::json;
use crate::result::{Provenance, RecordedSpec};
use crate::{Environment, Failure};
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::{Path, PathBuf};

/// A text that was read, and where.
#[derive(Debug)]
pub(crate) struct Input {
    path: PathBuf,
    text: String,
}

impl Input {
    /// Reads a file; - is standard input.
    ///
    /// # Errors
    /// If it cannot be read or is no text; the file is named.
    pub(crate) fn read(path: &Path, stdin: &mut dyn Read) -> Result<Self, Failure> {
        let mut input = Self { path: path.to_owned(), text: String::new() };
        let bytes = if path.as_os_str() == "-" {
            let mut bytes = Vec::new();
            stdin.read_to_end(&mut bytes).map(|_| bytes)
        } else {
            std::fs::read(path)
        };
        let text = bytes.map_err(Failure::refused).and_then(json::text);
        input.text = text.map_err(|failure| input.within(failure))?;
        Ok(input)
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// The name in a refusal.
    pub(crate) fn name(&self) -> String {
        if self.path.as_os_str() == "-" {
            "standard input".to_owned()
        } else {
            self.path.display().to_string()
        }
    }

    /// The folder to which the paths in it are relative; that of standard input is the working directory.
    pub(crate) fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// A refusal that names the file; a file that cannot be written names itself.
    pub(crate) fn within(&self, failure: Failure) -> Failure {
        match failure {
            Failure::Refused(_) => failure.within(self.name()),
            Failure::NotWritten(_) | Failure::Interrupted => failure,
        }
    }

    /// Provenance of numbers that were made from this text with this `seed`.
    ///
    /// # Errors
    /// If it is no JSON.
    pub(crate) fn provenance(&self, environment: &Environment, seed: u64) -> Result<Provenance, Failure> {
        let digest = Sha256::digest(self.text.as_bytes());
        let spec_sha256 = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        let spec = RecordedSpec { spec: json::parse(&self.text)?, spec_sha256 };
        Ok(Provenance { spec: Some(spec), ..environment.provenance(seed) })
    }
}
