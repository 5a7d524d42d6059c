//! Equality with the scalar tracer, on every instruction set that the machine has.

use super::*;
use crate::{Grid, Integrator, Uniform, Walk};
use fairflight_collision::Version;
use fairflight_media::phase::{HenyeyGreenstein, Isotropic, Rayleigh, Schlick, Tabulated};
use fairflight_media::{AnalyticCosine, Bounds, Homogeneous, Observed, Perlin, PerlinParameters};
use fairflight_scene::{Background, Camera, EnvironmentMap, Lights, Source, Volume};
use glam::dvec3;

const SAMPLES: u32 = 5;
/// More than two groups of lanes, the last of which is not full.
const STREAMS: usize = 2 * LANES + 7;

/// All that a run tells: estimates of each stream, where the streams stand, walks that were cut, look-ups and their range.
#[derive(Debug, PartialEq)]
struct Told {
    estimates: Vec<Vec<Vec<u64>>>,
    streams: Vec<Seeded>,
    truncated: u64,
    lookups: u64,
    range: [u64; 2],
}

struct Scene<M, P, C, R> {
    volume: Volume<M, P, C>,
    lights: Lights<C>,
    walk: Walk<R>,
    camera: Camera,
}

fn bits<C: Spectrum>(radiance: C) -> Vec<u64> {
    (0..C::CHANNELS).map(|channel| radiance.channel(channel).to_bits()).collect()
}

fn streams() -> Vec<Seeded> {
    (0..STREAMS as u64).map(|index| Seeded::for_batch(7, index)).collect()
}

/// At −20 that of the paper: pixels at the edge see no medium.
fn camera(z: f64) -> Camera {
    Camera::new(dvec3(0.0, 0.0, z), dvec3(0.0, 0.0, 10.0), DVec3::Y, 60.0, [8, 5]).unwrap()
}

fn pixels() -> [[u32; 2]; STREAMS] {
    std::array::from_fn(|pixel| [pixel as u32 % 8, pixel as u32 / 8])
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction + Copy> Scene<M, P, C, R> {
    /// Results of `run` with a tracer of its own.
    fn told(
        &self,
        run: impl FnOnce(&mut ParticleTracer<'_, Observed<&M>, &P, C, R>, &mut [Seeded], &mut dyn FnMut(usize, C)),
    ) -> Told {
        let volume = self.volume.with_medium(Observed::new(&self.volume.medium));
        let mut tracer = ParticleTracer::new(&volume, &self.lights, self.walk);
        let (mut streams, mut estimates) = (streams(), vec![Vec::new(); STREAMS]);
        run(&mut tracer, &mut streams, &mut |stream, radiance| estimates[stream].push(bits(radiance)));
        let truncated = tracer.truncated();
        let (lookups, range) = (volume.medium.lookups(), volume.medium.range());
        Told { estimates, streams, truncated, lookups, range: [range.0, range.1].map(f64::to_bits) }
    }

    fn one_after_the_other(&self) -> Told {
        self.told(|tracer, streams, take| {
            for (i, (pixel, source)) in pixels().into_iter().zip(streams).enumerate() {
                for _ in 0..SAMPLES {
                    let line = self.camera.ray(pixel, [source.next_uniform(), source.next_uniform()]);
                    take(i, tracer.radiance(&line, source));
                }
            }
        })
    }

    /// Holds lanes to be what one walk after the other is.
    fn is_the_same(&self, name: &str) -> Told {
        let expected = self.one_after_the_other();
        let (camera, pixels, samples) = (&self.camera, &pixels(), SAMPLES);
        for set in InstructionSet::of_this_machine() {
            let found = self.told(|tracer, streams, take| {
                tracer.trace_by(set, camera, (pixels, samples), streams, take);
            });
            assert_eq!(found, expected, "{name}: {}", set.name());
        }
        expected
    }
}

fn environment<C: Spectrum>() -> Lights<C> {
    Lights { background: Background { constant: C::splat(1.0), maps: vec![] }, sources: vec![] }
}

fn everything<C: Spectrum>() -> Lights<C> {
    let pixels = (0..8).map(|i| C::from_rgb([0.1, 0.2, 0.3].map(|step| step * f64::from(i)))).collect();
    let map = EnvironmentMap::new(4, 2, pixels).unwrap();
    let point = Source::point(dvec3(0.0, 0.0, 10.0), C::from_rgb([600.0, 500.0, 400.0])).unwrap();
    let sun = Source::directional(dvec3(0.3, -1.0, 0.2), C::splat(2.0)).unwrap();
    Lights { background: Background { constant: C::splat(0.5), maps: vec![map] }, sources: vec![point, sun] }
}

fn eq_21<P, C: Spectrum>(phase: P, albedo: C) -> Volume<AnalyticCosine, P, C> {
    Volume {
        medium: AnalyticCosine::new(1.0).unwrap(),
        bounds: AnalyticCosine::default_bounds(),
        albedo,
        phase,
    }
}

fn walk(version: Version, sigma_samp: f64) -> Walk<Uniform> {
    Walk::new(version, Uniform::new(sigma_samp).unwrap())
}

/// Every version, with and without lights to be connected with, at rates above, at, and below the extinction.
fn versions_are_the_same<M: Medium + Clone, P: PhaseFunction + Clone, C: Spectrum>(
    name: &str,
    volume: &Volume<M, P, C>,
) {
    use Version::{Adaptive, NonTerminating, Terminating};
    for (version, sigma_samp) in [(Terminating, 1.0), (NonTerminating, 0.8), (Adaptive, 0.8), (Adaptive, 2.0)]
    {
        for lights in [environment(), everything()] {
            let volume = volume.clone();
            let scene = Scene { volume, lights, walk: walk(version, sigma_samp), camera: camera(-20.0) };
            scene.is_the_same(&format!("{name}, {version:?} at {sigma_samp}"));
        }
    }
}

#[test]
fn every_phase_function_and_version() {
    let (forward, back) = (HenyeyGreenstein::new(0.85).unwrap(), Schlick::new(-0.5).unwrap());
    versions_are_the_same("isotropic", &eq_21(Isotropic, 0.7));
    versions_are_the_same("Rayleigh", &eq_21(Rayleigh, 0.7));
    versions_are_the_same("Henyey-Greenstein", &eq_21(forward, 0.95));
    versions_are_the_same("Schlick", &eq_21(back, 0.0));
    versions_are_the_same("tabulated", &eq_21(Tabulated::hazy_mie(33).unwrap(), 1.0));
}

#[test]
fn every_medium_and_both_spectra() {
    let bounds = Bounds::aligned_box(dvec3(-4.0, -5.0, 1.0), dvec3(4.0, 5.0, 8.0)).unwrap();
    let haze = Homogeneous::new(0.6).unwrap();
    versions_are_the_same("a box of haze", &Volume { medium: haze, bounds, albedo: 0.8, phase: Rayleigh });
    let noise =
        Perlin::new(PerlinParameters { offset: 0.25, scale: 0.75, ..PerlinParameters::default() }).unwrap();
    versions_are_the_same("noise", &Volume { medium: noise, bounds, albedo: 0.8, phase: Isotropic });
    versions_are_the_same("colour", &eq_21(Rayleigh, dvec3(0.9, 0.5, 0.0)));
    versions_are_the_same("gain", &eq_21(Rayleigh, dvec3(1.2, 1.0, 0.3)));
}

#[test]
fn every_sampling_extinction() {
    let medium = AnalyticCosine::new(1.0).unwrap();
    let grid = Grid::fitted(&medium, &AnalyticCosine::default_bounds(), [6; 3], (3, 1.2, 0.1)).unwrap();
    let walk = Walk::new(Version::NonTerminating, &grid);
    for lights in [environment(), everything()] {
        let scene = Scene { volume: eq_21(Rayleigh, 0.7), lights, walk, camera: camera(-20.0) };
        scene.is_the_same("grid");
    }
}

#[test]
fn cut_walks_and_roulette() {
    for most in [0, 1, 7] {
        let walk = walk(Version::NonTerminating, 1.0).with_max_collisions(most);
        let (volume, lights) = (eq_21(Rayleigh, 0.7), everything());
        let told = Scene { volume, lights, walk, camera: camera(-20.0) }.is_the_same("cut");
        assert!(told.truncated > 0);
    }
    // Dense and black: the energy falls fast.
    let medium = AnalyticCosine::new(20.0).unwrap();
    let volume = Volume { medium, ..eq_21(Rayleigh, 0.01) };
    for version in [Version::NonTerminating, Version::Adaptive] {
        let (lights, walk) = (everything(), walk(version, 20.0));
        Scene { volume, lights, walk, camera: camera(-20.0) }.is_the_same("dense");
    }
}

#[test]
fn a_camera_in_the_medium_and_one_at_its_end() {
    for z in [3.0, 0.0, 19.99] {
        let (volume, lights, walk) = (eq_21(Rayleigh, 0.7), everything(), walk(Version::Adaptive, 1.0));
        Scene { volume, lights, walk, camera: camera(z) }.is_the_same("inside");
        let bounds = Bounds::aligned_box(dvec3(-4.0, -5.0, 0.0), dvec3(4.0, 5.0, 20.0)).unwrap();
        let volume = Volume { bounds, ..volume };
        Scene { volume, lights: environment(), walk, camera: camera(z) }.is_the_same("inside a box");
    }
}

/// A twin that hands a variate from one lane to the next is not the scalar walk.
#[test]
fn lanes_that_are_mixed_are_told() {
    let scene = Scene {
        volume: eq_21(Rayleigh, 0.7),
        lights: environment(),
        walk: walk(Version::Adaptive, 1.0),
        camera: camera(-20.0),
    };
    let mixed = scene.told(|tracer, streams, take| {
        streams.swap(19, 20);
        tracer.trace(&scene.camera, (&pixels(), SAMPLES), streams, take);
        streams.swap(19, 20);
    });
    assert!(mixed.estimates != scene.one_after_the_other().estimates);
}
