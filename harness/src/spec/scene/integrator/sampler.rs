//! Variates of the samples of a pixel, where an integrator draws few of them.

use super::{BeamRadianceSpec, IntegratorSpec, SingleScatteringSpec, TransmittanceSpec};
use crate::reader::rule::{Maybe, Whole};
use crate::reader::{Kind, Node, Object};
use crate::{Failure, keys, words};

/// Source of the variates of a pixel's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampler {
    /// Independent variates.
    Independent,
    /// Points of Sobol's sequence, scrambled as Owen does.
    Sobol,
    /// Points of Halton's sequence, their digits scrambled.
    Halton,
}

words! {
    /// Source of the variates of a pixel's samples.
    pub(super) SamplerWord for Sampler {
        "independent" => Sampler::Independent,
        "sobol" => Sampler::Sobol,
        "halton" => Sampler::Halton,
    }
}

keys! {
    /// Variates of the samples of a pixel.
    pub SamplerSpec {
        /// Variates of the samples of a pixel: independent, or the coordinates of points that fill the cube evenly, scrambled (owen-1995, matousek-1998); the first 16
        /// of a sample, two of them its place in the pixel.
        sampler: Sampler as SamplerWord = Sampler::Independent,
        /// Point sets of a pixel, each with a randomisation of its own, which share its samples evenly: errors are told by them alone. 4 by default.
        replicas: Option<u32> as Maybe<Whole<2, MOST_REPLICAS>> = None,
    }
}

/// More leave few points to each.
const MOST_REPLICAS: u64 = 1_000;
/// Point sets of a pixel where nothing else is asked for.
const REPLICAS: u32 = 4;
/// Integrators that take points.
const TAKE_POINTS: [&str; 3] = [TransmittanceSpec::NAME, SingleScatteringSpec::NAME, BeamRadianceSpec::NAME];

impl SamplerSpec {
    pub(super) fn check(&self, object: &Object<'_>) -> Result<(), Failure> {
        if self.sampler == Sampler::Independent && self.replicas.is_some() {
            return Err(object
                .required("replicas")?
                .refuse("needs sampler: sobol or halton: independent samples tell their error themselves"));
        }
        Ok(())
    }

    /// Number of point sets of a pixel; `None` where samples are independent.
    #[must_use]
    pub fn point_sets(&self) -> Option<u32> {
        (self.sampler != Sampler::Independent).then(|| self.replicas.unwrap_or(REPLICAS))
    }
}

/// Refuses a sampler for an integrator that takes none.
pub(in super::super) fn refuse_for_walks(integrator: &Node<'_>) -> Result<(), Failure> {
    let object = integrator.object()?;
    let Some(sampler) = object.optional("sampler") else { return Ok(()) };
    let kind = object.required("kind")?.text()?;
    if TAKE_POINTS.contains(&kind) || !IntegratorSpec::NAMES.contains(&kind) {
        return Ok(());
    }
    Err(sampler.reject(format!(
        "{kind} draws more variates than points spread evenly; it is a key of {}",
        TAKE_POINTS.join(", ")
    )))
}
