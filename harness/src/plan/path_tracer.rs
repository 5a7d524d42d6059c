//! The path tracer and what extends it: its parameters checked, and the integrator of one tile.

use super::SpaceSampling;
use super::tile_integrator::{AnyIntegrator, Counts, SceneVolume, TileIntegrator, counting};
use super::transport::{Seen, Stage, TransportPlan};
use crate::Failure;
use crate::estimator::{InScene, ShadowWorker, Unlawful};
use crate::spec::{ExtensionSpec, PathTracerSpec, ReuseSpec};
use fairflight_media::{Line, LineThickness, Medium};
use fairflight_paths::extend::{PathReuse, Resampled};
use fairflight_paths::transport::{Types, World};
use fairflight_paths::{Integrator, PathTracer, SamplingExtinction};
use fairflight_photons::{AnyExtension, GuideOptions, Guided, PhotonMap};
use fairflight_scene::{Geometry, NoSurfaces, Spectrum, Surfaces};
use fairflight_sources::Seeded;
use std::cell::Cell;
use std::num::NonZeroU32;

/// A path tracer whose parameters are checked.
#[derive(Debug)]
pub struct PathTracerPlan {
    /// The flights and connections of its paths.
    pub transport: TransportPlan,
    max_vertices: u32,
    extension: Option<ExtensionSpec>,
    light_candidates: NonZeroU32,
    pub(super) reuse: Option<ReuseSpec>,
}

impl PathTracerPlan {
    pub(super) fn build(spec: &PathTracerSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        let PathTracerSpec { max_vertices, extension, light_candidates, reuse, transport } = spec.clone();
        let transport = TransportPlan::build(&transport, scene)?;
        if reuse.is_some()
            && let SpaceSampling::Uniform(rate) = transport.walk.walk().sampling()
            && let Some(greatest) = scene.medium.upper_bound()
            && rate.highest() < greatest
        {
            return Err(Failure::refused(format!(
                "integrator.sigma_samp: reuse needs at least the greatest sigma_t of the medium, {greatest}, found {}",
                rate.highest()
            )));
        }
        Ok(Self { transport, max_vertices, extension, light_candidates, reuse })
    }

    /// The light paths whose photons guide its own.
    pub(super) fn photons(&self) -> Option<u32> {
        match &self.extension {
            Some(ExtensionSpec::Guided(guided)) => Some(guided.photons),
            Some(ExtensionSpec::Resampled(_)) | None => None,
        }
    }

    /// The choice of directions of one worker.
    fn chosen<'s, C: Spectrum>(&self, map: &'s PhotonMap<C>) -> AnyExtension<'s, C> {
        match &self.extension {
            None => AnyExtension::Own,
            Some(ExtensionSpec::Guided(spec)) => {
                let (nearest, cells, own_share) = (spec.nearest, spec.cells, spec.own_share);
                AnyExtension::Guided(Guided::new(map, GuideOptions { nearest, cells, own_share }))
            }
            Some(ExtensionSpec::Resampled(spec)) => {
                AnyExtension::Resampled(Resampled::new(spec.candidates, spec.own_share))
            }
        }
    }

    pub(super) fn on<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        stage: Stage<'s, C>,
    ) -> AnyIntegrator<'s, C> {
        let Stage { lights, surfaces, map, unlawful, .. } = stage;
        let among = World::<Seen<'s, M, C, Surfaces<C>>>::new(volume, surfaces, lights);
        // Only the path tracer itself has code of its own for a scene without surfaces, unless there is no medium either, which is rare.
        if self.reuse.is_some() {
            let TransportPlan { walk, shadow, heuristic } = &self.transport;
            let reuse = PathReuse::new(among, walk.walk(), shadow.worker(unlawful), *heuristic);
            Box::new(OfGroups(reuse.with_max_vertices(self.max_vertices)))
        } else if self.extension.is_some() || self.light_candidates > NonZeroU32::MIN {
            let tracer = self.tracer(among, unlawful).with_extension(self.chosen(map));
            let tracer = tracer.with_light_candidates(self.light_candidates);
            counting(tracer, |tracer| Counts::cut(tracer.truncated()))
        } else if !M::IS_EMPTY && Geometry::surfaces(surfaces).is_empty() {
            let world = World::<Seen<'s, M, C, NoSurfaces>>::new(volume, &NoSurfaces, lights);
            counting(self.tracer(world, unlawful), |tracer| Counts::cut(tracer.truncated()))
        } else {
            counting(self.tracer(among, unlawful), |tracer| Counts::cut(tracer.truncated()))
        }
    }

    fn tracer<'s, W: Types<Sampling = SpaceSampling<'s>, Shadow = ShadowWorker<'s>>>(
        &'s self,
        world: World<'s, W>,
        unlawful: &'s Cell<Option<Unlawful>>,
    ) -> PathTracer<'s, W> {
        let TransportPlan { walk, shadow, heuristic } = &self.transport;
        let tracer = PathTracer::new(world, walk.walk(), shadow.worker(unlawful), *heuristic);
        tracer.with_max_vertices(self.max_vertices)
    }
}

/// Pixels that use each other's paths.
struct OfGroups<'s, W: Types>(PathReuse<'s, W>);

impl<W: Types<Medium: LineThickness>> TileIntegrator<W::Spectrum> for OfGroups<'_, W> {
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> W::Spectrum {
        self.0.radiance(line, source)
    }

    fn radiances(&mut self, lines: &[Line], radiances: &mut [W::Spectrum], source: &mut Seeded) {
        self.0.radiances(lines, radiances, source);
    }

    fn counts(&self) -> Counts {
        Counts { unlawful: self.0.unlawful(), ..Counts::cut(self.0.truncated()) }
    }
}
