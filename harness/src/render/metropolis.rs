//! Chains of paths: all pixels at once.

use super::batch::Batch;
use super::canvas::Spent;
use super::draw::Draw;
use super::lessons::Lessons;
use super::replicas::{Chains, REPLICA_STREAM, Replica};
use crate::plan::{ChainStarts, Lesson, MetropolisPlan, Stage, Walked};
use crate::{Failure, interrupt};
use cpu_time::ThreadTime;
use fairflight_media::LineThickness;
use fairflight_metropolis::{
    Acceptance, Bootstrap, Film, NotFinite, Plan, Proposed, Redistribution, Target, Which,
};
use fairflight_paths::transport::Emitters;
use fairflight_photons::PhotonMap;
use fairflight_scene::Spectrum;
use fairflight_sources::{UniformSource, derive_seed};
use fairflight_stats::{Autocorrelation, Moments};
use std::cell::Cell;

/// Samples between two looks at the interrupt.
const BREATH: u64 = 1024;
/// Samples that tell how bright the image is, roughly, and their stream: no pixel has its number.
const ENERGY_PILOT: u64 = 4096;
const ENERGY_STREAM: u64 = u64::MAX - 5;

/// A target that tells how far its chains are, and ends one that an interrupt has come for.
struct Watched<'w, C> {
    target: &'w mut dyn Target<C>,
    /// Samples that are still to be told: those of a pilot or of a start that is drawn again are not.
    left: u64,
    drawn: u64,
    advance: &'w (dyn Fn(u64) + Sync),
    interrupted: bool,
}

impl<C> Watched<'_, C> {
    /// Counts a sample; false if an interrupt came.
    fn goes_on(&mut self) -> bool {
        self.drawn += 1;
        if self.drawn.is_multiple_of(BREATH) {
            let told = BREATH.min(self.left);
            self.left -= told;
            (self.advance)(told);
            self.interrupted |= interrupt::check().is_err();
        }
        !self.interrupted
    }
}

/// What is not finite ends a replica.
impl<C> Target<C> for Watched<'_, C> {
    fn draw(&mut self, source: &mut dyn UniformSource) -> f64 {
        if self.goes_on() { self.target.draw(source) } else { f64::NAN }
    }
    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed {
        if self.goes_on() { self.target.propose(source) } else { Proposed { kind: 0, acceptance: f64::NAN } }
    }
    fn accept(&mut self) {
        self.target.accept();
    }
    fn deposit(&self, which: Which, energy: f64, film: &mut Film<'_, C>) {
        self.target.deposit(which, energy, film);
    }
    fn kinds(&self) -> &[&'static str] {
        self.target.kinds()
    }
    fn ln_present(&self) -> f64 {
        self.target.ln_present()
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
        let (learning, resolution) = (plan.learning(), self.plan.camera.resolution());
        let mut lessons = Lessons::first(learning, plan.small_step(), resolution)?;
        let (mut all, stages) = (Vec::new(), u64::from(learning.stages()));
        for stage in 0..stages {
            let [from, to] = [stage, stage + 1].map(|stage| (u64::from(count) * stage / stages) as u32);
            let replica =
                |index, numbers| self.chain(medium, plan, (emitters, lessons.of(index)), (index, numbers));
            let made = self.replicas((from..to, count), &replica)?;
            if stage + 1 < stages {
                lessons = lessons.next(&made)?;
            }
            if !made.is_empty() {
                // Series of another target.
                all.iter_mut().for_each(Replica::forget_series);
            }
            all.extend(made);
        }
        let (layer, spent) = self.layer(&all);
        Ok((Batch { replicas: Some(layer), ..Batch::none() }, spent))
    }

    fn chain<M: LineThickness + Copy + Sync>(
        &self,
        medium: M,
        plan: &MetropolisPlan,
        (emitters, lesson): (&Emitters<C>, Lesson<'_>),
        (index, samples): (u32, u32),
    ) -> Result<Replica<C>, Failure> {
        let clock = ThreadTime::now();
        let camera = &self.plan.camera;
        let [columns, rows] = camera.resolution().map(|side| side as usize);
        let (volume, unlawful, map) = (self.volume(medium), Cell::new(None), PhotonMap::new([]));
        let stage = Stage {
            lights: &self.radiant.lights,
            surfaces: &self.radiant.surfaces,
            camera,
            emitters,
            mean: None,
            map: &map,
            vpls: &[],
            bound: f64::INFINITY,
            unlawful: &unlawful,
        };
        let mut pixels = vec![C::ZERO; columns * rows];
        let drawn = (columns * rows) as u64 * u64::from(samples);
        let mut made = None;
        let walked = plan.with_target(&volume, (stage, lesson), &mut |target| {
            let mut target =
                Watched { target, left: drawn, drawn: 0, advance: self.advance, interrupted: false };
            let mut film = |[column, row]: [u32; 2], value| {
                pixels[row as usize * columns + column as usize] += value;
            };
            let chains = match plan.starts {
                ChainStarts::Bootstrap { samples, chains, .. } => {
                    MetropolisPlan::sizes(samples, chains, drawn)
                        .and_then(|sizes| self.long_chains(&mut target, sizes, index, &mut film))
                }
                ChainStarts::EverySample { steps, chains, most } => {
                    self.short_chains(&mut target, (steps, chains, most), (index, drawn), &mut film)
                }
            };
            made = Some((chains, target.interrupted));
        });
        self.judge(&volume.medium)?;
        if let Some(unlawful) = unlawful.get() {
            return Err(self.plan.integrator.explain(unlawful));
        }
        let Walked { truncated, experience } = walked?;
        let chains = match made {
            Some((chains, false)) => chains?,
            _ => return Err(Failure::Interrupted),
        };
        let cpu_seconds = clock.elapsed().as_secs_f64();
        let cost = Spent { lookups: volume.medium.lookups(), cpu_seconds, truncated, ..Spent::default() };
        Ok(Replica { number: index, pixels, samples, cost, chains: Some(chains), experience })
    }

    /// A few long chains, from starts that independent samples chose.
    fn long_chains(
        &self,
        target: &mut dyn Target<C>,
        sizes: Plan,
        index: u32,
        film: &mut Film<'_, C>,
    ) -> Result<Chains, Failure> {
        let seed = derive_seed(self.seed, REPLICA_STREAM);
        let replica = sizes
            .replica(target, (index.into(), seed), film)
            .map_err(|refused| Failure::refused(format!("seed {}: {refused}", self.seed)))?;
        Ok(Chains {
            replicas: 1,
            bootstrap: replica.bootstrap,
            black: replica.is_black.into(),
            steps: target.kinds().iter().copied().zip(replica.acceptance).collect(),
            autocorrelation: replica.autocorrelation,
        })
    }

    /// Short chains from every sample, whose energy a pilot fixes before.
    fn short_chains(
        &self,
        target: &mut dyn Target<C>,
        (steps, chains, most): (u64, f64, Option<u64>),
        (index, samples): (u32, u64),
        film: &mut Film<'_, C>,
    ) -> Result<Chains, Failure> {
        let refused = |what: &dyn std::fmt::Display| Failure::refused(format!("seed {}: {what}", self.seed));
        let pilot = Bootstrap::draw(target, ENERGY_PILOT, derive_seed(self.seed, ENERGY_STREAM))
            .map_err(|(number, NotFinite)| refused(&format!("pilot sample {number} is not finite")))?;
        // Where the pilot saw nothing any energy is right.
        let brightness = Some(pilot.brightness()).filter(|&light| light > 0.0).unwrap_or(1.0);
        let energy = brightness / (steps as f64 * chains);
        let mut rule = Redistribution::new(steps, energy).map_err(|error| refused(&error))?;
        if let Some(most) = most {
            rule = rule.with_most_chains(most).map_err(|error| refused(&error))?;
        }
        let (share, mut weights) = (1.0 / samples as f64, Moments::new());
        let mut acceptance = vec![Acceptance::default(); target.kinds().len()];
        let seed = derive_seed(derive_seed(self.seed, REPLICA_STREAM), index.into());
        for sample in 0..samples {
            let mut film = |pixel, value: C| film(pixel, value * share);
            let made =
                rule.sample(target, (sample, seed), &mut acceptance, &mut film).map_err(|NotFinite| {
                    refused(&format!("replica {index}, sample {sample}: a contribution is not finite"))
                })?;
            weights.push(made.weight);
        }
        Ok(Chains {
            replicas: 1,
            black: u32::from(weights.maximum() == Some(0.0)),
            bootstrap: weights,
            steps: target.kinds().iter().copied().zip(acceptance).collect(),
            autocorrelation: Autocorrelation::new(),
        })
    }
}
