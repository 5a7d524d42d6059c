//! Whole images of random sets of virtual point lights, judged by replicas of the set.

use fairflight_compensation::{Compensation, CompensationOptions, LocalMean};
use fairflight_laws::{NotFinite, Run, measure};
use fairflight_media::{Bounds, Line, Medium, PhaseFunction};
use fairflight_paths::transport::World;
use fairflight_paths::{Heuristic, Integrator, PathTracer, RayTransmittance, SamplingExtinction, Walk};
use fairflight_scene::{Geometry, Lights, Volume};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::{Reference, Verdict, judge};
use fairflight_vpl::{Emitters, Gather, Ledger, LightPaths, Term, Vpl, VplIntegrator};

/// A scene, and one ray that looks into it.
#[derive(Clone, Debug)]
pub struct Room<G, M, P> {
    /// The medium.
    pub volume: Volume<M, P, f64>,
    /// The surfaces.
    pub surfaces: G,
    /// The lights that are no surfaces.
    pub lights: Lights<f64>,
    /// The ray.
    pub eye: Line,
}

/// Parameters of a replica: one sample is one replica, a set of light paths and the radiance that it shows along some rays.
#[derive(Clone, Copy, Debug)]
pub struct Replica<R, T> {
    /// Light paths of a set.
    pub paths: u32,
    /// Times that the eye ray is followed.
    pub rays: u32,
    /// Points on each.
    pub eye_samples: u32,
    /// b \[1/length²\].
    pub bound: f64,
    /// Options of the compensation of the bound.
    pub options: CompensationOptions,
    /// Flights of light paths, eye rays and compensation.
    pub walk: Walk<R>,
    /// Transmittance of connections.
    pub shadow: T,
}

impl<G: Geometry<f64>, M: Medium, P: PhaseFunction> Room<G, M, P> {
    /// The mean radiance of each replica.
    pub(super) fn replicas<R: SamplingExtinction + Copy, T: RayTransmittance<M> + Copy>(
        &self,
        replica: Replica<R, T>,
    ) -> impl FnMut(&mut Seeded) -> f64 {
        let world = World::new(&self.volume, &self.surfaces, &self.lights);
        let emitters = Emitters::new(&self.lights, &self.surfaces, world.enclosing_ball(), self.eye.origin);
        let bounds: &Bounds = &self.volume.bounds;
        let mean = LocalMean::of(&self.volume.medium, bounds, [4; 3], 2);
        let mut vpls: Vec<Vpl<f64>> = Vec::new();
        move |source| {
            let Replica { paths, rays, eye_samples, bound, options, walk, shadow } = replica;
            vpls.clear();
            let light_paths = LightPaths::new(world, &emitters, walk);
            let mut ledger = Ledger::empty();
            for _ in 0..paths {
                light_paths.trace(1.0 / f64::from(paths), &mut ledger, source, |vpl| vpls.push(vpl));
            }
            let heuristic = Heuristic::Balance;
            let term = Term::Bounded(bound);
            let gather = Gather { world, vpls: &vpls, term, heuristic, walk, shadow };
            let correction = Compensation::new(options, &mean);
            let pairing = correction.pairing();
            let mut integrator = VplIntegrator::new(gather, (eye_samples, pairing), correction);
            (0..rays).map(|_| integrator.radiance(&self.eye, source)).sum::<f64>() / f64::from(rays)
        }
    }

    /// **Law.** Over sets of light paths, the radiance of bounded lights and their compensation is the one of a furnace, known without
    /// error.
    ///
    /// # Errors
    /// If an estimate is no number.
    pub fn check<R: SamplingExtinction + Copy, T: RayTransmittance<M> + Copy>(
        &self,
        replica: Replica<R, T>,
        reference: &Reference,
        run: Run,
    ) -> Result<Verdict, NotFinite> {
        Ok(judge(
            &measure(run.seed, run.samples, self.replicas(replica))?,
            &reference.with_mild_tails(),
            run.alpha,
        ))
    }

    /// **Law.** The same against path tracing. One sample is a replica less the mean of `paths` paths, whose expectation is 0; the mean of a
    /// run of path tracing of its own is added, so that power can be told as a relative bias.
    ///
    /// # Errors
    /// If an estimate is no number.
    pub fn check_against_paths<R: SamplingExtinction + Copy, T: RayTransmittance<M> + Copy>(
        &self,
        replica: Replica<R, T>,
        paths: u32,
        run: Run,
    ) -> Result<Verdict, NotFinite> {
        let world = World::new(&self.volume, &self.surfaces, &self.lights);
        let mut tracer = PathTracer::new(world, replica.walk, replica.shadow, Heuristic::Balance);
        let mut traced = |source: &mut Seeded| tracer.radiance(&self.eye, source);
        let scale = measure(derive_seed(run.seed, 1), run.samples, &mut traced)?.mean().unwrap_or(0.0);
        let mut replicas = self.replicas(replica);
        let measured = measure(run.seed, run.samples, |source| {
            let paths_mean = (0..paths).map(|_| traced(source)).sum::<f64>() / f64::from(paths);
            scale + replicas(source) - paths_mean
        })?;
        Ok(judge(&measured, &Reference::exact(scale).with_mild_tails(), run.alpha))
    }
}
