//! An integrator on a medium, for one tile: the seam between integrators and pixels.

use super::{AnyPhase, SpaceSampling, Tally};
use fairflight_media::{Line, LineThickness};
use fairflight_paths::{Integrator, ParticleTracer};
use fairflight_scene::{Camera, Spectrum, Volume};
use fairflight_sources::{Seeded, UniformSource};
use std::ops::ControlFlow;

/// The volume of a scene whose medium has one type.
pub type SceneVolume<'s, M, C> = Volume<M, &'s AnyPhase, C>;

/// Columns and rows of pixels, and the number of estimates of each.
type Pixels<'a> = (&'a [[u32; 2]], u32);

/// Callback that is told the number of a pixel with each estimate, until it breaks.
type Take<'a, C> = dyn FnMut(usize, C) -> ControlFlow<()> + 'a;

/// An integrator on a medium, for one tile: one call per camera ray, and what happens below is compiled for the types of the scene.
pub trait TileIntegrator<C> {
    /// Draws one estimate \[radiance\] for a ray whose direction has unit length.
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> C;

    /// The same with the variates of a point.
    ///
    /// # Panics
    /// If the integrator takes no points, to which the plan gives none.
    fn radiance_by_point(&mut self, line: &Line, source: &mut dyn UniformSource) -> C {
        let _ = (line, source);
        unreachable!("it takes no points")
    }

    /// Draws one estimate for each of `lines`, of pixels that use each other's paths; unless the integrator says otherwise, of each by itself.
    fn radiances(&mut self, lines: &[Line], radiances: &mut [C], source: &mut Seeded) {
        for (line, radiance) in lines.iter().zip(radiances) {
            *radiance = self.radiance(line, source);
        }
    }

    /// Draws estimates of pixels, each from a stream of its own: one pixel after the other unless the integrator says otherwise, those of one in order.
    fn pixels(&mut self, camera: &Camera, work: Pixels<'_>, sources: &mut [Seeded], take: &mut Take<'_, C>) {
        let (pixels, samples) = work;
        for (i, (pixel, source)) in pixels.iter().zip(sources).enumerate() {
            for _ in 0..samples {
                let within = [source.next_uniform(), source.next_uniform()];
                if take(i, self.radiance(&camera.ray(*pixel, within), source)).is_break() {
                    return;
                }
            }
        }
    }

    /// Events that were counted so far.
    fn counts(&self) -> Counts;

    /// Takes what was found since the last call and is no estimate along a ray of this tile.
    fn splatted(&mut self) -> Splatted<C> {
        Splatted::none()
    }

    /// The part of the estimate, in words, that made it infinite or no number, where that is known.
    fn culprit(&self) -> Option<String> {
        None
    }
}

/// Light that an integrator found for any pixel, and by what it found all light.
#[derive(Clone, Debug, PartialEq)]
pub struct Splatted<C> {
    /// Column and row of a pixel, and the radiance to be added to its sample of this pass.
    pub splats: Vec<([u32; 2], C)>,
    /// Contributions by strategy, those of the samples along camera rays included.
    pub tally: Tally,
    /// Number of light paths.
    pub light_paths: u64,
    /// The sum over them of the power that was not followed, since no other integrator would see it.
    pub unseen_power: f64,
}

impl<C> Splatted<C> {
    /// Nothing.
    pub fn none() -> Self {
        Self { splats: Vec::new(), tally: Tally::none(), light_paths: 0, unseen_power: 0.0 }
    }
}

/// Events of an integrator that an image tells of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Walks that were cut: each is a bias.
    pub truncated: u64,
    /// Flights that were not lawful for the integrator: each is a bias.
    pub unlawful: u64,
    /// Compensation vertices that were tried.
    pub compensation_tried: u64,
    /// Compensation vertices that lay where something was lost.
    pub compensation_inside: u64,
}

/// An integrator of any kind.
pub type AnyIntegrator<'s, C> = Box<dyn TileIntegrator<C> + 's>;

/// An integrator of one type, and how its counts are asked for.
struct Compiled<I> {
    integrator: I,
    counts: fn(&I) -> Counts,
}

/// The same of one that takes points: one more copy of it is compiled for them.
struct ByPoints<I>(Compiled<I>);

impl<C: Spectrum, I: Integrator<C>> TileIntegrator<C> for ByPoints<I> {
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> C {
        self.0.radiance(line, source)
    }
    fn radiance_by_point(&mut self, line: &Line, mut source: &mut dyn UniformSource) -> C {
        self.0.integrator.radiance(line, &mut source)
    }
    fn counts(&self) -> Counts {
        TileIntegrator::<C>::counts(&self.0)
    }
}

impl<C: Spectrum, I: Integrator<C>> TileIntegrator<C> for Compiled<I> {
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> C {
        // In registers while it changes.
        let mut own = source.clone();
        let radiance = self.integrator.radiance(line, &mut own);
        *source = own;
        radiance
    }
    fn counts(&self) -> Counts {
        (self.counts)(&self.integrator)
    }
}

/// A particle tracer, whose pixels are drawn in lanes.
pub(super) struct InLanes<'s, M, C>(pub(super) ParticleTracer<'s, M, &'s AnyPhase, C, SpaceSampling<'s>>);

impl<M: LineThickness, C: Spectrum> TileIntegrator<C> for InLanes<'_, M, C> {
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> C {
        self.0.radiance(line, source)
    }
    /// Pixel beside pixel; whatever `take` says, all of them.
    fn pixels(&mut self, camera: &Camera, work: Pixels<'_>, sources: &mut [Seeded], take: &mut Take<'_, C>) {
        self.0.trace(camera, work, sources, |pixel, radiance| {
            let _ = take(pixel, radiance);
        });
    }
    fn counts(&self) -> Counts {
        Counts::cut(self.0.truncated())
    }
}

/// An integrator with its counts.
pub(super) fn counting<'s, C: Spectrum, I: Integrator<C> + 's>(
    integrator: I,
    counts: fn(&I) -> Counts,
) -> AnyIntegrator<'s, C> {
    Box::new(Compiled { integrator, counts })
}

/// An integrator that takes points, with its counts.
pub(super) fn by_points<'s, C: Spectrum, I: Integrator<C> + 's>(
    integrator: I,
    counts: fn(&I) -> Counts,
) -> AnyIntegrator<'s, C> {
    Box::new(ByPoints(Compiled { integrator, counts }))
}

/// An integrator that counts nothing.
pub(super) fn plain<'s, C: Spectrum>(integrator: impl Integrator<C> + 's) -> AnyIntegrator<'s, C> {
    counting(integrator, |_| Counts::default())
}

impl Counts {
    /// Walks that were cut, and nothing else.
    pub(super) fn cut(truncated: u64) -> Self {
        Self { truncated, ..Self::default() }
    }
}
