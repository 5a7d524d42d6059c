//! Gradient noise.

use super::known::{Knowledge, KnownField, bounds_of};
use super::{AnyMedium, BoundsRule, MediumKind, MediumLibrary};
use crate::reader::rule::{Number, Whole};
use crate::{Failure, kind};
use fairflight_media::{Bounds, Certificate, Certified, Perlin, PerlinParameters, Ray};
use std::sync::Arc;

const SEEDS: u64 = u32::MAX as u64;

/// The defaults of the noise.
fn usual() -> PerlinParameters {
    PerlinParameters::default()
}

kind! {
    /// max(0, offset + scale · fBm(frequency · p)), octaves of gradient noise.
    PerlinSpec = "perlin" {
        /// Octaves.
        octaves: u32 as Whole<1, 32> = usual().octaves,
        /// The frequency of the first octave \[1/length\].
        frequency: f64 as Number = usual().frequency,
        /// The ratio of frequencies of successive octaves.
        lacunarity: f64 as Number = usual().lacunarity,
        /// The ratio of weights of successive octaves.
        gain: f64 as Number = usual().gain,
        /// The seed of the lattice.
        seed: u32 as Whole<0, SEEDS> = usual().seed,
        /// The factor of the noise \[1/length\].
        scale: f64 as Number = usual().scale,
        /// The constant added to the noise \[1/length\].
        offset: f64 as Number = usual().offset,
        /// The bounds, with vacuum outside.
        bounds: Bounds as BoundsRule,
    }
}

impl PerlinSpec {
    /// Noise of these parameters.
    #[must_use]
    pub fn of(parameters: PerlinParameters, bounds: Bounds) -> Self {
        let PerlinParameters { octaves, frequency, lacunarity, gain, seed, scale, offset } = parameters;
        Self { octaves, frequency, lacunarity, gain, seed, scale, offset, bounds }
    }
}

impl MediumKind for PerlinSpec {
    fn build(&self, _library: &MediumLibrary, key: &str) -> Result<(AnyMedium, Bounds), Failure> {
        let &Self { octaves, frequency, lacunarity, gain, seed, scale, offset, bounds } = self;
        let parameters = PerlinParameters { octaves, frequency, lacunarity, gain, seed, scale, offset };
        let medium = Perlin::new(parameters).map_err(|error| Failure::refused(format!("{key}: {error}")))?;
        Ok((AnyMedium::Perlin(Arc::new(medium)), bounds))
    }
}

impl KnownField for Certified<Ray<Arc<Perlin>>> {
    fn knowledge(&self) -> Knowledge {
        bounds_of(self)
    }
    fn certificate(&self) -> Option<&Certificate> {
        Some(Certified::certificate(self))
    }
}
