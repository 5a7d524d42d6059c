//! The medium of a scene: one of an experiment, with how much and whereto it scatters.

use super::{ColourSpec, PhaseSpec};
use crate::Failure;
use crate::field::MediumSpec;
use crate::reader::Node;

/// A medium that scatters, as given.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeSpec {
    /// Extinction and bounds of the medium.
    pub medium: MediumSpec,
    /// σ_s/σ_t.
    pub albedo: ColourSpec,
    /// The phase function.
    pub phase: PhaseSpec,
}

impl VolumeSpec {
    /// Reads `medium`. An albedo above 1 needs `allow_gain`.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind.
    pub fn read(node: &Node<'_>, allow_gain: bool) -> Result<Self, Failure> {
        let object = node.object()?;
        let medium = MediumSpec::take(&object)?;
        let most = if allow_gain { f64::INFINITY } else { 1.0 };
        let albedo = ColourSpec::read(&object.required("albedo")?, most)?;
        let phase = PhaseSpec::read(&object.required("phase")?)?;
        object.finish()?;
        Ok(Self { medium, albedo, phase })
    }
}
