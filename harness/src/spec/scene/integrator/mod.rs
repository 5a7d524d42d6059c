//! Integrators: one file per kind, with its keys; the list of all.

mod beam_radiance;
mod bidirectional;
mod extension;
mod line_splitting;
mod metropolis;
mod particle_tracer;
mod path_tracer;
mod sampler;
mod single_scattering;
mod transmittance;
mod transport;
mod vpl;
mod walk;

pub use beam_radiance::BeamRadianceSpec;
pub use bidirectional::{BidirectionalSpec, ThicknessSpec};
pub use extension::{ExtensionSpec, GuidedSpec, ResampledSpec, ReuseSpec};
pub use line_splitting::LineSplittingSpec;
pub use metropolis::{
    Adaptation, EnergyRedistributionSpec, MetropolisSpec, MutationKind, Over, StagesSpec, StepsSpec,
};
pub use particle_tracer::{Particles, TracerSpec};
pub use path_tracer::PathTracerSpec;
pub(super) use sampler::refuse_for_walks;
pub use sampler::{Sampler, SamplerSpec};
pub use single_scattering::{SingleScatteringSpec, Strategy};
pub use transmittance::TransmittanceSpec;
pub use transport::TransportSpec;
pub use vpl::{ClampSpec, ComponentSpec, VplSpec};
pub use walk::{Collisions, SamplingFieldSpec, WalkSpec};

use crate::registry;

registry! {
    /// An integrator with its parameters.
    IntegratorSpec: IntegratorKind {
        Transmittance(TransmittanceSpec),
        ParticleTracer(TracerSpec),
        LineSplitting(LineSplittingSpec),
        SingleScattering(SingleScatteringSpec),
        PathTracer(PathTracerSpec),
        Vpl(VplSpec),
        Bidirectional(BidirectionalSpec),
        BeamRadiance(BeamRadianceSpec),
        Metropolis(MetropolisSpec),
        EnergyRedistribution(EnergyRedistributionSpec),
    }
}

/// A kind of integrators: its walks, its surfaces, its bias.
pub trait IntegratorKind {
    /// The flights, connections and weights of its paths among surfaces; none of an integrator that knows no surfaces.
    fn transport(&self) -> Option<&TransportSpec> {
        None
    }

    /// Walks of the integrator, if it has some.
    fn walk(&self) -> Option<&WalkSpec> {
        self.transport().map(|transport| &transport.walk)
    }

    /// Variates of the samples of a pixel, of an integrator that takes points.
    fn sampler(&self) -> Option<&SamplerSpec> {
        None
    }

    /// The part that is biased by design, if any.
    fn bias(&self) -> Option<&'static str> {
        None
    }
}

/// More points per ray, flights or pixels per control are a slip of the keyboard.
const MOST: u64 = 1_000_000;

const BASELINE: &str = "its estimator of transmittance is a biased baseline";

fn of_a_baseline(is_biased: bool) -> Option<&'static str> {
    is_biased.then_some(BASELINE)
}

impl IntegratorSpec {
    /// The walks of an integrator that has some.
    #[must_use]
    pub fn walk(&self) -> Option<&WalkSpec> {
        self.kind().walk()
    }

    /// The walks of an integrator that has some, to be changed.
    pub fn walk_mut(&mut self) -> Option<&mut WalkSpec> {
        match self {
            Self::ParticleTracer(spec) => Some(&mut spec.walk),
            Self::LineSplitting(spec) => Some(&mut spec.walk),
            Self::PathTracer(spec) => Some(&mut spec.transport.walk),
            Self::Vpl(spec) => Some(&mut spec.transport.walk),
            Self::Bidirectional(spec) => Some(&mut spec.transport.walk),
            Self::BeamRadiance(spec) => Some(&mut spec.transport.walk),
            Self::Metropolis(spec) => Some(&mut spec.steps.transport.walk),
            Self::EnergyRedistribution(spec) => Some(&mut spec.steps.transport.walk),
            Self::Transmittance(_) | Self::SingleScattering(_) => None,
        }
    }

    /// Draws independent samples, if it takes others.
    pub fn without_points(&mut self) {
        let points = match self {
            Self::Transmittance(spec) => &mut spec.points,
            Self::SingleScattering(spec) => &mut spec.points,
            Self::BeamRadiance(spec) => &mut spec.points,
            _ => return,
        };
        *points = SamplerSpec { sampler: Sampler::Independent, replicas: None };
    }
}
