//! Images of transmittance at equal look-ups: szirmay-kalos-2017 fig. 9 and 10.

mod borrowed;
mod camera;
mod exact;
mod method;
mod render;

use super::interval::bootstrap_rmse;
use super::{Run, Subject};
use crate::standard::result::{ImagePanel, ImageStudy, Series};
use camera::Camera;
use exact::{Exact, transmittance};
use fairflight_harness::Failure;
use fairflight_harness::field::AnyProfile;
use fairflight_harness::parallel::in_parallel;
use fairflight_sources::named_seed;
use method::Method;
use render::{Image, pilot, render};

/// Look-ups per pixel that meets the medium: fig. 9 and fig. 10.
const BUDGETS: [f64; 2] = [10.0, 20.0];
/// The step of the paper's ray marching.
const STEP: f64 = 0.9;
/// Methods per study: see [`choices`].
const METHODS: u64 = 6;

/// Steps of progress of [`studies`].
pub(super) fn steps() -> u64 {
    METHODS * BUDGETS.len() as u64
}

/// The pixels of an image whose rays meet the medium.
struct Scene<'a> {
    subject: &'a Subject,
    resolution: usize,
    /// Index and profile of each pixel that meets the medium, row by row.
    pixels: Vec<(usize, AnyProfile)>,
    exact: Vec<Exact>,
    mean_length: f64,
}

/// Both studies of a medium.
pub(super) fn studies(
    run: &Run<'_>,
    subject: &Subject,
    resolution: usize,
) -> Result<Vec<ImageStudy>, Failure> {
    let scene = Scene::new(subject, resolution)?;
    BUDGETS.iter().map(|&budget| study(run, &scene, budget)).collect()
}

impl<'a> Scene<'a> {
    fn new(subject: &'a Subject, resolution: usize) -> Result<Self, Failure> {
        let camera = Camera::before(subject, resolution);
        let mut pixels = Vec::new();
        for pixel in 0..resolution * resolution {
            if let Some(profile) = camera.profile(subject, pixel)? {
                pixels.push((pixel, profile));
            }
        }
        let exact = in_parallel(pixels.len(), &|i| transmittance(&pixels[i].1));
        let mean_length =
            pixels.iter().map(|(_, profile)| profile.length()).sum::<f64>() / pixels.len() as f64;
        Ok(Self { subject, resolution, pixels, exact, mean_length })
    }

    /// The values of the pixels that meet the medium, among those that do not, which nothing attenuates.
    fn whole(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut whole = vec![1.0; self.resolution * self.resolution];
        for ((pixel, _), value) in self.pixels.iter().zip(values) {
            whole[*pixel] = value;
        }
        whole
    }
}

/// A method with its rays per pixel, and how to name it.
struct Choice {
    /// Once per study: its stream has this name.
    name: &'static str,
    series: Series,
    parameters: String,
    method: Method,
    /// Rays per pixel on average, at least 1.
    rays: f64,
}

fn study(run: &Run<'_>, scene: &Scene<'_>, budget: f64) -> Result<ImageStudy, Failure> {
    let seed = |name: &str| run.seed(format_args!("images/{}/{budget}/{name}", scene.subject.id));
    let choices = choices(scene, budget, seed("pilot"))?;
    let mut panels = Vec::with_capacity(choices.len());
    for choice in choices {
        let seed = seed(choice.name);
        panels.push(panel(scene, choice, seed)?);
        run.advance();
    }
    Ok(ImageStudy {
        medium: scene.subject.id.to_owned(),
        budget,
        resolution: [scene.resolution; 2],
        exact: scene.whole(scene.exact.iter().map(|exact| exact.transmittance)),
        exact_error: scene.exact.iter().map(|exact| exact.error).fold(0.0, f64::max),
        panels,
    })
}

/// The methods of a study. All but the first spend the budget, in
/// expectation: Woodcock by its number of rays, the others on one ray by
/// their steps or their sampling extinction. (One ray with n times the sampling extinction is never worse than n rays:
/// (exp(J/n) − 1) ≤ (exp(J) − 1)/n, eq. 16.)
fn choices(scene: &Scene<'_>, budget: f64, seed: u64) -> Result<Vec<Choice>, Failure> {
    let Scene { subject, mean_length, .. } = *scene;
    // The paper's majorant is 1, the bound of both of its media.
    let majorant = subject.truth.knowledge.upper_bound.unwrap_or(subject.majorant);
    let woodcock = Method::Woodcock { majorant };
    // A flight costs less where it is absorbed early; how much, a pilot tells that no pixel is made of.
    let rays = budget / pilot(scene, woodcock, seed)?;
    let woodcock_name = if rays < 1.0 {
        format!("majorant {majorant:.3}, one ray per pixel: more look-ups than the budget")
    } else {
        format!("majorant {majorant:.3}, {rays:.2} rays per pixel")
    };
    let sigma_samp = budget / mean_length;
    let explorers = (0.5 * budget) as usize;
    let own_sigma = (budget - explorers as f64) / mean_length;
    // The paper's step in its sphere of radius 10; the same part of the radius elsewhere.
    let step = STEP * subject.bounds.enclosing_ball().1 / 10.0;
    let one_ray = |name, series, parameters, method| Choice { name, series, parameters, method, rays: 1.0 };
    Ok(vec![
        one_ray(
            "marching from the entry",
            Series::RayMarching,
            format!("one ray, step {step:.3} from its entry, biased; costs what it costs"),
            Method::MarchFromEntry { step },
        ),
        one_ray(
            "midpoint marching",
            Series::RayMarching,
            format!("one ray, midpoints of steps of {:.3}, biased", mean_length / budget),
            Method::March { step: mean_length / budget },
        ),
        Choice { rays: rays.max(1.0), ..one_ray("Woodcock", Series::Woodcock, woodcock_name, woodcock) },
        one_ray(
            "no control",
            Series::DoubleParticle,
            format!("no control, one ray, sigma_samp {sigma_samp:.3} (what the budget allows)"),
            Method::Ratio { sigma_samp },
        ),
        one_ray(
            "own explorers",
            Series::DoubleParticleExplorers,
            format!("{explorers} explorers of the pixel's own ray, paid for; sigma_samp {own_sigma:.3}"),
            Method::OwnExplorers { count: explorers, sigma_samp: own_sigma },
        ),
        one_ray(
            "borrowed explorers",
            Series::DoubleParticleExplorers,
            format!(
                "explorers borrowed from the look-ups of the last {} pixels in {} cells; sigma_samp {sigma_samp:.3}",
                borrowed::RAYS,
                borrowed::CELLS
            ),
            Method::BorrowedExplorers { sigma_samp },
        ),
    ])
}

fn panel(scene: &Scene<'_>, choice: Choice, seed: u64) -> Result<ImagePanel, Failure> {
    let Image { means, lookups, seconds } = render(scene, choice.method, choice.rays, seed)?;
    let squares: Vec<f64> =
        means.iter().zip(&scene.exact).map(|(mean, exact)| (mean - exact.transmittance).powi(2)).collect();
    let met = squares.len().max(1) as f64;
    Ok(ImagePanel {
        series: choice.series,
        name: choice.name,
        parameters: choice.parameters,
        pixels: scene.whole(means.into_iter()),
        lookups_per_pixel: lookups as f64 / met,
        rmse: (squares.iter().sum::<f64>() / met).sqrt(),
        rmse_interval: bootstrap_rmse(&squares, named_seed(seed, "bootstrap")),
        seconds,
    })
}
