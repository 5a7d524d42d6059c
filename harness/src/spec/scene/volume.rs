//! The medium of a scene: one of an experiment, with how much and whereto it scatters.

use super::ColourSpec;
use crate::Failure;
use crate::field::MediumSpec;
use crate::reader::Node;

/// A medium that scatters, as given.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeSpec {
    /// Its extinction and bounds.
    pub medium: MediumSpec,
    /// σ_s/σ_t.
    pub albedo: ColourSpec,
    /// Whereto it scatters.
    pub phase: PhaseSpec,
}

/// A phase function as given.
#[derive(Clone, Debug, PartialEq)]
pub enum PhaseSpec {
    /// The same in all directions.
    Isotropic,
    /// Particles much smaller than the wavelength.
    Rayleigh,
    /// Henyey-Greenstein.
    HenyeyGreenstein {
        /// The mean cosine.
        g: f64,
    },
    /// Schlick.
    Schlick {
        /// Its elongation.
        k: f64,
    },
    /// Linear between nodes.
    Tabulated {
        /// From −1 to 1.
        cosines: Vec<f64>,
        /// Their values in any unit.
        values: Vec<f64>,
    },
    /// The hazy atmosphere of nishita-1987, as a table.
    HazyMie,
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

impl PhaseSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        let object = node.object()?;
        let kind = object.required("kind")?;
        let phase = match kind.text()? {
            "isotropic" => Self::Isotropic,
            "rayleigh" => Self::Rayleigh,
            "henyey_greenstein" => Self::HenyeyGreenstein { g: object.required("g")?.number()? },
            "schlick" => Self::Schlick { k: object.required("k")?.number()? },
            "tabulated" => Self::Tabulated {
                cosines: object.required("cosines")?.numbers()?,
                values: object.required("values")?.numbers()?,
            },
            "hazy_mie" => Self::HazyMie,
            _ => {
                return Err(kind.refuse(
                    "must be isotropic, rayleigh, henyey_greenstein, schlick, tabulated or hazy_mie",
                ));
            }
        };
        object.finish()?;
        Ok(phase)
    }
}
