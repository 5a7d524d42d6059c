//! Sets of virtual point lights, and maps of photons: what light paths leave for a pass.

use super::batch::Batch;
use super::canvas::Spent;
use super::draw::Draw;
use crate::plan::{Seen, TransportPlan, VplPlan};
use crate::{Failure, interrupt};
use cpu_time::ThreadTime;
use fairflight_media::LineThickness;
use fairflight_paths::transport::World;
use fairflight_photons::PhotonMap;
use fairflight_scene::{Geometry, NoSurfaces, Spectrum};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_vpl::{Emitters, KeepNear, Ledger, LightPaths, Vpl};
use rayon::prelude::*;

/// The streams of sets are children of this child of the seed: no pixel has its number.
const LIGHT_STREAM: u64 = u64::MAX - 2;
/// The streams of maps, alike.
const MAP_STREAM: u64 = u64::MAX - 4;
/// The stream of the paths that are traced to find out why a set is empty.
const TRIAL_STREAM: u64 = u64::MAX - 3;
/// Number of paths that share a stream, and a worker.
const CHUNK: u32 = 256;
/// Least number of paths that are traced to find out why a set is empty: fewer that deposit nothing prove nothing.
const LEAST_TRIAL: u32 = 4096;

struct Traced<C> {
    vpls: Vec<Vpl<C>>,
    ledger: Ledger<C>,
    spent: Spent,
}

impl<C: Spectrum> Draw<'_, C> {
    /// The virtual point lights of pass number `pass`, and what they cost.
    ///
    /// # Errors
    /// If a look-up is not lawful, or nothing that could be gathered is ever deposited.
    pub(super) fn virtual_lights<M: LineThickness + Copy + Sync>(
        &self,
        medium: M,
        plan: &VplPlan,
        (emitters, pass): (&Emitters<C>, usize),
    ) -> Result<(Batch<C>, Spent), Failure> {
        let surfaces = &self.radiant.surfaces;
        if !M::IS_EMPTY && surfaces.surfaces().is_empty() {
            self.among(&NoSurfaces, medium, plan, (emitters, pass))
        } else {
            self.among(surfaces, medium, plan, (emitters, pass))
        }
    }

    fn among<G: Geometry<C> + Sync, M: LineThickness + Copy + Sync>(
        &self,
        surfaces: &G,
        medium: M,
        plan: &VplPlan,
        (emitters, pass): (&Emitters<C>, usize),
    ) -> Result<(Batch<C>, Spent), Failure> {
        let bound = plan.bound(self.radiant, &self.plan.phase, emitters.power().max_channel())?;
        let is_dark = emitters.power().max_channel() <= 0.0;
        let keep_near = plan.keep_near.map(|radius| KeepNear { point: self.plan.camera.origin(), radius });
        let trace = |stream: u64, paths: u32, share: f64| {
            self.light_paths(
                surfaces,
                medium,
                (&plan.transport, keep_near),
                emitters,
                (derive_seed(stream, pass as u64), paths, share),
            )
        };
        let paths = plan.light_paths;
        let set = trace(derive_seed(self.seed, LIGHT_STREAM), paths, 1.0 / f64::from(paths))?;
        if set.vpls.is_empty() && pass == 0 && !is_dark {
            let trial = paths.max(LEAST_TRIAL);
            let trial = trace(derive_seed(self.seed, TRIAL_STREAM), trial, 1.0 / f64::from(trial))?;
            if trial.vpls.is_empty() {
                return Err(none_deposited(&trial.ledger));
            }
        }
        let vpls = set.vpls;
        let spent = Spent { vpls: vpls.len() as u64, ..set.spent };
        Ok((Batch { vpls, bound, ..Batch::none() }, spent))
    }

    /// The map of photons of pass number `pass`, and what it cost. Surfaces are asked for also where there are none: that costs next to
    /// nothing, and saves a copy.
    ///
    /// # Errors
    /// If a look-up is not lawful.
    pub(super) fn map<M: LineThickness + Copy + Sync>(
        &self,
        medium: M,
        (paths, transport): (u32, &TransportPlan),
        (emitters, pass): (&Emitters<C>, usize),
    ) -> Result<(Batch<C>, Spent), Failure> {
        let stream = derive_seed(derive_seed(self.seed, MAP_STREAM), pass as u64);
        let drawn = (stream, paths, 1.0 / f64::from(paths));
        let traced = self.light_paths(&self.radiant.surfaces, medium, (transport, None), emitters, drawn)?;
        let (clock, vpls) = (ThreadTime::now(), traced.vpls.len() as u64);
        let map = PhotonMap::new(traced.vpls);
        let cpu_seconds = clock.elapsed().as_secs_f64();
        let sorted = Spent { vpls, cpu_seconds, light_path_seconds: cpu_seconds, ..Spent::default() };
        Ok((Batch { map, ..Batch::none() }, traced.spent.and(sorted)))
    }

    /// Traces light paths in chunks with streams of their own, put together in order.
    fn light_paths<G: Geometry<C> + Sync, M: LineThickness + Copy + Sync>(
        &self,
        surfaces: &G,
        medium: M,
        (transport, keep_near): (&TransportPlan, Option<KeepNear>),
        emitters: &Emitters<C>,
        (stream, paths, share): (u64, u32, f64),
    ) -> Result<Traced<C>, Failure> {
        let chunk = |index: u32| {
            interrupt::check()?;
            let clock = ThreadTime::now();
            let volume = self.volume(medium);
            let world = World::<Seen<'_, _, _, _>>::new(&volume, surfaces, &self.radiant.lights);
            let tracer = LightPaths::new(world, emitters, transport.walk.walk()).keeping_near(keep_near);
            let mut source = Seeded::for_batch(stream, u64::from(index));
            let (mut vpls, mut ledger) = (Vec::new(), Ledger::empty());
            for _ in index * CHUNK..((index + 1) * CHUNK).min(paths) {
                tracer.trace(share, &mut ledger, &mut source, |vpl| vpls.push(vpl));
            }
            self.judge(&volume.medium)?;
            let cpu_seconds = clock.elapsed().as_secs_f64();
            let spent = Spent {
                lookups: volume.medium.lookups(),
                cpu_seconds,
                light_path_seconds: cpu_seconds,
                truncated: ledger.truncated,
                ..Spent::default()
            };
            Ok(Traced { vpls, ledger, spent })
        };
        in_chunks(paths.div_ceil(CHUNK), &chunk)
    }
}

/// Traces so many chunks on the threads of the current pool, and puts them together in their order. One copy for all scenes.
fn in_chunks<C: Spectrum>(
    count: u32,
    chunk: &(dyn Fn(u32) -> Result<Traced<C>, Failure> + Sync),
) -> Result<Traced<C>, Failure> {
    let chunks: Vec<Result<Traced<C>, Failure>> = (0..count).into_par_iter().map(chunk).collect();
    let nothing = Traced { vpls: Vec::new(), ledger: Ledger::empty(), spent: Spent::default() };
    chunks.into_iter().try_fold(nothing, |mut all, chunk| {
        let mut chunk = chunk?;
        all.vpls.append(&mut chunk.vpls);
        let (ledger, spent) = (all.ledger.and(&chunk.ledger), all.spent.and(chunk.spent));
        Ok(Traced { vpls: all.vpls, ledger, spent })
    })
}

fn none_deposited<C: Spectrum>(ledger: &Ledger<C>) -> Failure {
    let share = |power: C| 100.0 * power.mean() / ledger.emitted.mean();
    Failure::refused(format!(
        "integrator.light_paths: none of {} light paths left a virtual point light: {:.1} % of the power left the scene, {:.1} % is \
         that of points or directions behind smooth surfaces, the rest was absorbed; nothing was scattered by a diffuse surface or a \
         medium. path_tracer needs no virtual point lights",
        ledger.paths,
        share(ledger.escaped),
        share(ledger.unseen)
    ))
}
