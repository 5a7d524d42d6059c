//! Renders an image: rows in parallel, pixels of a row in order, since a pixel may borrow from the one before.

use super::Scene;
use super::borrowed::Borrowed;
use super::method::{Estimate, Method, Pixel};
use cpu_time::ThreadTime;
use fairflight_harness::Failure;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_sources::Seeded;

/// The estimates of the pixels that meet the medium.
pub(super) struct Image {
    pub(super) means: Vec<f64>,
    pub(super) lookups: u64,
    /// CPU seconds over all threads, look-ups being counted (an addition each).
    pub(super) seconds: f64,
}

/// Rays of the pixel number `index` if there are `average` per pixel: whole numbers whose running sum follows the average,
/// whatever the rays find.
pub(super) fn rays_of(index: usize, average: f64) -> u64 {
    let up_to = |n: usize| (n as f64 * average).floor() as u64;
    up_to(index + 1) - up_to(index)
}

/// Mean look-ups of one ray by `method`, from a few rays per pixel.
pub(super) fn pilot(scene: &Scene<'_>, method: Method, seed: u64) -> Result<f64, Failure> {
    const RAYS: f64 = 16.0;
    let image = render(scene, method, RAYS, seed)?;
    Ok(image.lookups as f64 / (RAYS * scene.pixels.len() as f64))
}

/// One image with `rays` rays per pixel on average, at least 1.
pub(super) fn render(scene: &Scene<'_>, method: Method, rays: f64, seed: u64) -> Result<Image, Failure> {
    let row_of = |i: usize| scene.pixels[i].0 / scene.resolution;
    let numbered: Vec<usize> = (0..scene.pixels.len()).collect();
    let rows: Vec<&[usize]> = numbered.chunk_by(|&a, &b| row_of(a) == row_of(b)).collect();
    let rendered = try_in_parallel(rows.len(), &|row| {
        let clock = ThreadTime::now();
        let mut borrowed = Borrowed::default();
        let mut image = Image { means: Vec::with_capacity(rows[row].len()), lookups: 0, seconds: 0.0 };
        for &i in rows[row] {
            let pixel = one(scene, method, rays, seed, i, &mut borrowed)?;
            image.means.push(pixel.mean);
            image.lookups += pixel.lookups;
        }
        image.seconds = clock.elapsed().as_secs_f64();
        Ok(image)
    })?;
    let mut image = Image { means: Vec::with_capacity(scene.pixels.len()), lookups: 0, seconds: 0.0 };
    for row in rendered {
        image.means.extend(row.means);
        image.lookups += row.lookups;
        image.seconds += row.seconds;
    }
    Ok(image)
}

fn one(
    scene: &Scene<'_>,
    method: Method,
    rays: f64,
    seed: u64,
    index: usize,
    borrowed: &mut Borrowed,
) -> Result<Pixel, Failure> {
    let (number, profile) = &scene.pixels[index];
    let mut source = Seeded::for_batch(seed, *number as u64);
    let estimate = Estimate {
        method,
        rays: rays_of(index, rays),
        source: &mut source,
        borrowed,
        entry: profile.entry_distance(),
    };
    let in_image = |reason: &dyn std::fmt::Display| {
        Failure::refused(format!("report: image of {}, pixel {number}: {reason}", scene.subject.id))
    };
    let pixel = estimate.draw(profile.field()).map_err(|error| in_image(&error))?;
    if let Some(violation) = pixel.violation {
        let place = profile.place(violation.s);
        return Err(in_image(&format!("sigma_t = {} is not lawful at {place}", violation.sigma_t)));
    }
    if !pixel.mean.is_finite() {
        return Err(in_image(&format!("the estimate is {}", pixel.mean)));
    }
    Ok(pixel)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::standard::{images, run_for_tests, subject};
    use fairflight_harness::field::MediumLibrary;

    #[test]
    fn rays_follow_their_average() {
        for average in [1.0, 1.37, 2.0, 7.9] {
            let total: u64 = (0..1000).map(|i| rays_of(i, average)).sum();
            assert_eq!(total, (1000.0 * average) as u64);
            assert!((0..1000).all(|i| rays_of(i, average).abs_diff(average as u64) <= 1));
        }
    }

    #[test]
    fn every_method_spends_its_budget() {
        let subject = subject::analytic(&MediumLibrary::default()).unwrap();
        for study in images::studies(&run_for_tests(), &subject, 96).unwrap() {
            // The first, of the paper's step, costs what it costs.
            for panel in &study.panels[1..] {
                let spent = panel.lookups_per_pixel / study.budget;
                assert!((spent - 1.0).abs() < 0.015, "{}: {spent}", panel.parameters);
            }
        }
    }
}
