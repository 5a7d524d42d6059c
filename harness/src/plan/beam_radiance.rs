//! The beam radiance estimate: its parameters checked, and the integrator of one tile.

use super::tile_integrator::{AnyIntegrator, Counts, SceneVolume, by_points};
use super::transport::{Seen, Stage, TransportPlan};
use crate::Failure;
use crate::estimator::InScene;
use crate::spec::BeamRadianceSpec;
use fairflight_media::LineThickness;
use fairflight_paths::transport::World;
use fairflight_photons::{BeamRadiance, SurfaceLight};
use fairflight_scene::{Spectrum, Surfaces};

/// The beam radiance estimate whose parameters are checked.
#[derive(Debug)]
pub struct BeamRadiancePlan {
    /// The flights of photons, and the paths from surfaces.
    pub transport: TransportPlan,
    /// Light paths per map.
    pub photons: u32,
    radius: f64,
    surfaces: SurfaceLight,
    max_vertices: u32,
}

impl BeamRadiancePlan {
    pub(super) fn build(spec: &BeamRadianceSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        let BeamRadianceSpec { photons, radius, surfaces, max_vertices, ref transport, .. } = *spec;
        let transport = TransportPlan::build(transport, scene)?;
        Ok(Self { transport, photons, radius, surfaces, max_vertices })
    }

    /// The integrator of one tile. Surfaces are asked for also where there are none: that costs next to nothing, and saves a copy.
    pub(super) fn on<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        Stage { lights, surfaces, map, unlawful, .. }: Stage<'s, C>,
    ) -> Result<AnyIntegrator<'s, C>, Failure> {
        let TransportPlan { walk, shadow, heuristic } = &self.transport;
        let world = World::<Seen<'s, M, C, Surfaces<C>>>::new(volume, surfaces, lights);
        let shadow = shadow.worker(unlawful);
        let beam = BeamRadiance::new(world, (map, self.radius), walk.walk(), shadow, *heuristic)
            .map_err(|error| Failure::refused(format!("integrator.radius: {error}")))?;
        let beam = beam.with_surfaces(self.surfaces).with_max_vertices(self.max_vertices);
        Ok(by_points(beam, |beam| Counts::cut(beam.truncated())))
    }
}
