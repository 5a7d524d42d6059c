//! Chains of paths: all pixels at once.

use super::batch::Batch;
use super::canvas::Spent;
use super::draw::Draw;
use super::replicas::{Chains, REPLICA_STREAM, Replica};
use crate::plan::{MetropolisPlan, Stage};
use crate::{Failure, interrupt};
use cpu_time::ThreadTime;
use fairflight_media::LineThickness;
use fairflight_metropolis::{Integrand, Splats, Target};
use fairflight_paths::transport::Emitters;
use fairflight_photons::PhotonMap;
use fairflight_scene::Spectrum;
use fairflight_sources::{UniformSource, derive_seed};
use std::cell::Cell;

/// Samples between two looks at the interrupt.
const BREATH: u64 = 1024;

/// An integrand that tells how far it is, and ends a chain that an interrupt has come for.
struct Watched<'w, C> {
    integrand: &'w mut dyn Integrand<C>,
    /// Samples that do not count: those before the chains.
    before: u64,
    drawn: u64,
    advance: &'w (dyn Fn(u64) + Sync),
    interrupted: bool,
}

impl<C: Spectrum> Integrand<C> for Watched<'_, C> {
    fn sample(&mut self, splats: &mut Splats<C>, source: &mut dyn UniformSource) {
        self.drawn += 1;
        if self.drawn.is_multiple_of(BREATH) {
            if self.drawn > self.before {
                (self.advance)(BREATH.min(self.drawn - self.before));
            }
            if interrupt::check().is_err() {
                // What is not finite ends the replica.
                self.interrupted = true;
                return splats.push([0; 2], C::splat(f64::NAN));
            }
        }
        self.integrand.sample(splats, source);
    }
}

impl<C: Spectrum> Draw<'_, C> {
    /// The light of chains in `count` replicas, and what it cost.
    ///
    /// # Errors
    /// If a look-up is not lawful, a contribution not finite, or an interrupt came: that of the first replica where it happens.
    pub(super) fn chains<M: LineThickness + Copy + Sync>(
        &self,
        medium: M,
        plan: &MetropolisPlan,
        (emitters, count): (&Emitters<C>, u32),
    ) -> Result<(Batch<C>, Spent), Failure> {
        let (layer, spent) =
            self.layer(count, &|index, samples| self.chain(medium, plan, emitters, (index, samples)))?;
        Ok((Batch { replicas: Some(layer), ..Batch::none() }, spent))
    }

    fn chain<M: LineThickness + Copy + Sync>(
        &self,
        medium: M,
        plan: &MetropolisPlan,
        emitters: &Emitters<C>,
        (index, samples): (u32, u32),
    ) -> Result<Replica<C>, Failure> {
        let clock = ThreadTime::now();
        let camera = &self.plan.camera;
        let [columns, rows] = camera.resolution().map(u64::from);
        let mutations = columns * rows * u64::from(samples);
        let sizes = plan.sizes(mutations)?;
        let (volume, unlawful, map) = (self.volume(medium), Cell::new(None), PhotonMap::new([]));
        let (lights, surfaces) = (&self.radiant.lights, &self.radiant.surfaces);
        let (mean, vpls, bound, unlawful_at) = (None, &[][..], f64::INFINITY, &unlawful);
        let stage =
            Stage { lights, surfaces, camera, emitters, mean, map: &map, vpls, bound, unlawful: unlawful_at };
        let mut pixels = vec![C::ZERO; (columns * rows) as usize];
        let mut made = None;
        let truncated = plan.over(&volume, stage, &mut |integrand| {
            let before = sizes.evaluations() - mutations;
            let advance = self.advance;
            let mut watched = Watched { integrand, before, drawn: 0, advance, interrupted: false };
            let replica = plan.target(&mut watched).map(|mut target| {
                let seed = derive_seed(self.seed, REPLICA_STREAM);
                let replica =
                    sizes.replica(&mut target, (u64::from(index), seed), &mut |[column, row], value| {
                        pixels[u64::from(row) as usize * columns as usize + column as usize] += value;
                    });
                (replica, target.kinds().to_vec())
            });
            made = Some((replica, watched.interrupted));
        });
        self.judge(&volume.medium)?;
        if let Some(unlawful) = unlawful.get() {
            return Err(self.plan.integrator.explain(unlawful));
        }
        let Some((replica, interrupted)) = made else { return Err(Failure::Interrupted) };
        if interrupted {
            return Err(Failure::Interrupted);
        }
        let (replica, kinds) = replica?;
        let replica =
            replica.map_err(|refused| Failure::refused(format!("seed {}: {refused}", self.seed)))?;
        let chains = Chains {
            bootstrap: replica.bootstrap,
            black: u32::from(replica.is_black),
            steps: kinds.into_iter().zip(replica.acceptance).collect(),
        };
        let cpu_seconds = clock.elapsed().as_secs_f64();
        let cost = Spent { lookups: volume.medium.lookups(), cpu_seconds, truncated, ..Spent::default() };
        Ok(Replica { pixels, samples, cost, chains: Some(chains) })
    }
}
