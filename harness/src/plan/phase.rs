//! A phase function of any kind.

use fairflight_elementary::lanes::Lanes;
use fairflight_media::PhaseFunction;
use fairflight_media::phase::{HenyeyGreenstein, Isotropic, Rayleigh, Schlick, Tabulated};

/// A phase function of any kind. It is asked once per scattering event, far less often than the medium.
#[derive(Clone, Debug)]
pub enum AnyPhase {
    /// The same in all directions.
    Isotropic(Isotropic),
    /// Particles much smaller than the wavelength.
    Rayleigh(Rayleigh),
    /// One parameter, the mean cosine.
    HenyeyGreenstein(HenyeyGreenstein),
    /// Its rational approximation.
    Schlick(Schlick),
    /// Linear between nodes.
    Tabulated(Tabulated),
}

impl AnyPhase {
    /// Greatest value of the phase function, to the fineness of a grid of cosines that has both ends \[1/sr\].
    #[must_use]
    pub fn greatest(&self) -> f64 {
        const STEPS: u32 = 1024;
        let cosine = |i: u32| -1.0 + 2.0 * f64::from(i) / f64::from(STEPS);
        (0..=STEPS).map(|i| self.eval(cosine(i))).fold(0.0, f64::max)
    }
}

impl PhaseFunction for AnyPhase {
    #[inline]
    fn eval(&self, cosine: f64) -> f64 {
        match self {
            Self::Isotropic(phase) => phase.eval(cosine),
            Self::Rayleigh(phase) => phase.eval(cosine),
            Self::HenyeyGreenstein(phase) => phase.eval(cosine),
            Self::Schlick(phase) => phase.eval(cosine),
            Self::Tabulated(phase) => phase.eval(cosine),
        }
    }

    #[inline(always)]
    fn eval_lanes(&self, cosines: &Lanes) -> Lanes {
        match self {
            Self::Isotropic(phase) => phase.eval_lanes(cosines),
            Self::Rayleigh(phase) => phase.eval_lanes(cosines),
            Self::HenyeyGreenstein(phase) => phase.eval_lanes(cosines),
            Self::Schlick(phase) => phase.eval_lanes(cosines),
            Self::Tabulated(phase) => phase.eval_lanes(cosines),
        }
    }

    #[inline]
    fn sample_cosine(&self, u: f64) -> f64 {
        match self {
            Self::Isotropic(phase) => phase.sample_cosine(u),
            Self::Rayleigh(phase) => phase.sample_cosine(u),
            Self::HenyeyGreenstein(phase) => phase.sample_cosine(u),
            Self::Schlick(phase) => phase.sample_cosine(u),
            Self::Tabulated(phase) => phase.sample_cosine(u),
        }
    }

    #[inline(always)]
    fn sample_cosine_lanes(&self, u: &Lanes) -> Lanes {
        match self {
            Self::Isotropic(phase) => phase.sample_cosine_lanes(u),
            Self::Rayleigh(phase) => phase.sample_cosine_lanes(u),
            Self::HenyeyGreenstein(phase) => phase.sample_cosine_lanes(u),
            Self::Schlick(phase) => phase.sample_cosine_lanes(u),
            Self::Tabulated(phase) => phase.sample_cosine_lanes(u),
        }
    }

    fn mean_cosine(&self) -> f64 {
        match self {
            Self::Isotropic(phase) => phase.mean_cosine(),
            Self::Rayleigh(phase) => phase.mean_cosine(),
            Self::HenyeyGreenstein(phase) => phase.mean_cosine(),
            Self::Schlick(phase) => phase.mean_cosine(),
            Self::Tabulated(phase) => phase.mean_cosine(),
        }
    }
}
