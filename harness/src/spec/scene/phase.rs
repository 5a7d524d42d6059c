//! Phase functions.

use crate::plan::AnyPhase;
use crate::reader::rule::{Number, Numbers};
use crate::{kind, registry};
use fairflight_media::phase::{HenyeyGreenstein, Isotropic, PhaseError, Rayleigh, Schlick, Tabulated};

registry! {
    /// The phase function of a medium.
    PhaseSpec: PhaseKind as "phase" {
        Isotropic(IsotropicSpec),
        Rayleigh(RayleighSpec),
        HenyeyGreenstein(HenyeyGreensteinSpec),
        Schlick(SchlickSpec),
        Tabulated(TabulatedSpec),
        HazyMie(HazyMieSpec),
    }
}

/// A kind of phase functions: how it is built.
pub trait PhaseKind {
    /// The phase function.
    ///
    /// # Errors
    /// If a parameter is not lawful.
    fn build(&self) -> Result<AnyPhase, PhaseError>;
}

kind! {
    /// The same in all directions.
    IsotropicSpec = "isotropic" {}
}

kind! {
    /// Particles much smaller than the wavelength.
    RayleighSpec = "rayleigh" {}
}

kind! {
    /// One parameter, the mean cosine (henyey-1941).
    HenyeyGreensteinSpec = "henyey_greenstein" {
        /// The mean cosine.
        g: f64 as Number,
    }
}

kind! {
    /// A rational approximation of it (blasi-1993).
    SchlickSpec = "schlick" {
        /// The elongation.
        k: f64 as Number,
    }
}

kind! {
    /// Linear between nodes, normalised on reading.
    TabulatedSpec = "tabulated" {
        /// Cosines from −1 to 1.
        cosines: Vec<f64> as Numbers,
        /// Their values in any unit.
        values: Vec<f64> as Numbers,
    }
}

kind! {
    /// The hazy atmosphere of nishita-1987, as a table.
    HazyMieSpec = "hazy_mie" {}
}

impl PhaseKind for IsotropicSpec {
    fn build(&self) -> Result<AnyPhase, PhaseError> {
        Ok(AnyPhase::Isotropic(Isotropic))
    }
}

impl PhaseKind for RayleighSpec {
    fn build(&self) -> Result<AnyPhase, PhaseError> {
        Ok(AnyPhase::Rayleigh(Rayleigh))
    }
}

impl PhaseKind for HenyeyGreensteinSpec {
    fn build(&self) -> Result<AnyPhase, PhaseError> {
        HenyeyGreenstein::new(self.g).map(AnyPhase::HenyeyGreenstein)
    }
}

impl PhaseKind for SchlickSpec {
    fn build(&self) -> Result<AnyPhase, PhaseError> {
        Schlick::new(self.k).map(AnyPhase::Schlick)
    }
}

impl PhaseKind for TabulatedSpec {
    fn build(&self) -> Result<AnyPhase, PhaseError> {
        Tabulated::new(self.cosines.clone(), self.values.clone()).map(AnyPhase::Tabulated)
    }
}

impl PhaseKind for HazyMieSpec {
    fn build(&self) -> Result<AnyPhase, PhaseError> {
        /// Right to 1e-4 of the peak.
        const NODES: usize = 257;
        Tabulated::hazy_mie(NODES).map(AnyPhase::Tabulated)
    }
}
