//! A small image of the same scene, drawn beside the one that is asked for: what it tells depends on the scene
//! alone, not on seed, samples, passes or threads.
//!
//! **Exposure.** White must not follow noise, nor a lamp that the camera sees. So (1) the pilot has streams and a size of its own. (2) Pixels
//! in which the camera sees an emitting surface are left out: its radiance says nothing of what it lights. (3)
//! The luminance is averaged over blocks of pixels, some 256 samples each, and only blocks with light count.
//! (4) White is the 95th percentile of these blocks, but at most [`HEADROOM`] times their median: whatever is
//! seen of lamps by mirrors, of a bright window, or of samples of a heavy tail, if it covers less than half of
//! what is lit, can darken the picture by no more than that.

use super::painting::moments;
use crate::Failure;
use crate::field::MediumLibrary;
use crate::image::{Exposure, luminance};
use crate::plan::{Radiant, ScenePlan, Spectra};
use crate::spec::{
    BeamRadianceSpec, ComponentSpec, EnergyRedistributionSpec, IntegratorSpec, MetropolisSpec,
    PathTracerSpec, SceneSpec, VplSpec,
};
use fairflight_scene::{Camera, Geometry, Segment, Spectrum};
use std::num::NonZeroU32;

/// Columns and rows, and those of a block.
const SIDE: u32 = 32;
const BLOCK: usize = 4;
/// Samples per pixel: 256 per block.
const SAMPLES: u32 = 16;
/// Virtual point lights are few where no path tracer can stand for them.
const MOST_LIGHT_PATHS: u32 = 256;
/// The seed of its variates, whatever that of the image.
const SEED: u64 = 0x6578_706F_7365;
/// White is at most so many times the median: three stops above it.
const HEADROOM: f64 = 8.0;

/// The exposure of every picture of a scene.
///
/// # Errors
/// If a look-up is not lawful, or a sample not finite.
pub(super) fn exposure(spec: &SceneSpec, library: &MediumLibrary) -> Result<Exposure, Failure> {
    let plan = ScenePlan::of(&pilot(spec)?, library)?;
    let shown = match &plan.spectra {
        Spectra::Gray(radiant) => emitters_in_pixels(radiant, &plan.camera),
        Spectra::Colour(radiant) => emitters_in_pixels(radiant, &plan.camera),
        Spectra::Separate(channels) => emitters_in_pixels(&channels[0], &plan.camera),
    };
    let drawn = moments(&plan, &|_| ())?;
    let luminance: Vec<f64> = drawn.means().iter().map(|rgb| luminance(*rgb)).collect();
    Ok(Exposure::of_white(white(&luminance, &shown)))
}

/// The same scene in `side` columns and rows, with so many samples per pixel, from streams of its own.
///
/// # Errors
/// If there are no pixels.
pub(super) fn reduced(spec: &SceneSpec, side: u32, samples: u32) -> Result<SceneSpec, Failure> {
    let mut reduced = spec.clone();
    reduced.camera = spec.camera.with_resolution([side; 2]).map_err(Failure::refused)?;
    reduced.samples_per_pixel = samples;
    reduced.seed = SEED;
    // Whether the walks have a second moment is for the image itself to say.
    if let Some(walk) = reduced.integrator.walk_mut() {
        walk.allow_supercritical = true;
    }
    reduced.integrator.without_points();
    Ok(reduced)
}

/// The scene of the pilot.
fn pilot(spec: &SceneSpec) -> Result<SceneSpec, Failure> {
    let mut pilot = reduced(spec, SIDE, SAMPLES)?;
    match &mut pilot.integrator {
        IntegratorSpec::Vpl(vpl) if vpl.component != ComponentSpec::All => {
            vpl.light_paths = vpl.light_paths.min(MOST_LIGHT_PATHS);
        }
        // All of the light is what a path tracer finds, too, and its cost does not grow with the number of light paths.
        IntegratorSpec::Vpl(VplSpec { transport, .. })
        | IntegratorSpec::BeamRadiance(BeamRadianceSpec { transport, .. }) => {
            pilot.integrator = PathTracerSpec::of_all_lengths(transport.clone()).into();
        }
        IntegratorSpec::Metropolis(MetropolisSpec { steps, .. })
        | IntegratorSpec::EnergyRedistribution(EnergyRedistributionSpec { steps, .. }) => {
            pilot.integrator = steps.independent();
        }
        // Nor does that of any extension matter, which leave it as it is.
        IntegratorSpec::PathTracer(tracer) => {
            let PathTracerSpec { extension, light_candidates, reuse, .. } = tracer;
            (*extension, *light_candidates, *reuse) = (None, NonZeroU32::MIN, None);
        }
        _ => {}
    }
    Ok(pilot)
}

/// Tells for each pixel, row by row, whether an emitting surface is the first thing that it shows, in any of 4 x 4
/// points.
fn emitters_in_pixels<C: Spectrum>(radiant: &Radiant<C>, camera: &Camera) -> Vec<bool> {
    let emits = |pixel: [u32; 2]| {
        (0..16_u8).any(|i| {
            let within = [f64::from(i % 4), f64::from(i / 4)].map(|i| (i + 0.5) / 4.0);
            let line = camera.ray(pixel, within);
            let segment = Segment { line, length: f64::INFINITY, from: None, to: None };
            let hit = Geometry::intersect(&radiant.surfaces, &segment);
            hit.is_some_and(|hit| hit.surface.emission.max_channel() > 0.0)
        })
    };
    (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| [column, row])).map(emits).collect()
}

/// The luminance that is shown white; 0 without light.
fn white(luminance: &[f64], shows_emitter: &[bool]) -> f64 {
    let side = SIDE as usize;
    let mut sums = [(0.0, 0_u32); (SIDE as usize / BLOCK).pow(2)];
    // Where all that is to be seen shines it is the picture.
    let all = shows_emitter.iter().all(|emits| *emits);
    for (i, (value, emits)) in luminance.iter().zip(shows_emitter).enumerate() {
        if all || !emits {
            let block = &mut sums[i / side / BLOCK * (side / BLOCK) + i % side / BLOCK];
            *block = (block.0 + value, block.1 + 1);
        }
    }
    let means = sums.iter().filter(|(_, count)| *count > 0).map(|(sum, count)| sum / f64::from(*count));
    let mut lit: Vec<f64> = means.filter(|mean| *mean > 0.0).collect();
    lit.sort_unstable_by(f64::total_cmp);
    let Some(last) = lit.len().checked_sub(1) else { return 0.0 };
    lit[last * 19 / 20].min(HEADROOM * lit[last / 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXELS: usize = (SIDE * SIDE) as usize;

    #[test]
    fn white_is_near_the_brightest_and_not_moved_by_what_is_rare() {
        let none = [false; PIXELS];
        let even = white(&[0.5; PIXELS], &none);
        assert!((even - 0.5).abs() < 1e-15);
        assert_eq!(white(&[0.0; PIXELS], &none), 0.0);
        // Darkness around a small subject does not count.
        let mut small = [0.0; PIXELS];
        small[..BLOCK].fill(0.25);
        assert!((white(&small, &none) - 0.25 / BLOCK as f64).abs() < 1e-15);
        // Three of 64 blocks with a sample of a heavy tail.
        let mut tail = [0.5; PIXELS];
        [5, 300, 1000].iter().for_each(|&i| tail[i] = 1e9);
        assert!((white(&tail, &none) - 0.5).abs() < 1e-15);
        // A bright window over a third of the view costs three stops and no more.
        let mut window = [0.5; PIXELS];
        window[..PIXELS / 3].fill(1e6);
        assert_eq!(white(&window, &none), HEADROOM * 0.5);
    }

    #[test]
    fn emitters_are_left_out_unless_there_is_nothing_else() {
        let lamp: Vec<bool> = (0..PIXELS).map(|i| i < PIXELS * 9 / 10).collect();
        let luminance: Vec<f64> = lamp.iter().map(|lamp| if *lamp { 60.0 } else { 0.1 }).collect();
        assert!((white(&luminance, &lamp) - 0.1).abs() < 1e-15);
        assert_eq!(white(&luminance, &[true; PIXELS]), 60.0_f64.min(HEADROOM * 60.0));
    }
}
