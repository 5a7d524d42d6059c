//! A scene rendered several times over: images with the mean squared error that they have, and an interval of it.

use super::measured::{Measured, mean_and_error};
use fairflight_document::{self as document, Pixels};
use fairflight_harness::Failure;
use fairflight_harness::field::MediumLibrary;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::plan::{ScenePlan, Spectra};
use fairflight_harness::render::{Moments, StrategyShare, moments};
use fairflight_harness::spec::{SceneOverrides, SceneSpec};
use fairflight_metropolis::Acceptance;
use fairflight_scene::EnvironmentMap;
use fairflight_sources::named_seed;
use fairflight_stats as stats;
use serde_json::{Value, json};

/// A scene of a report: the JSON that `harness render` takes, and perhaps a map that lights it.
#[derive(Clone, Debug)]
pub(super) struct Subject {
    /// The scene, without seed and samples per pixel.
    pub(super) scene: Value,
    /// A gray map on top of its lights.
    pub(super) map: Option<EnvironmentMap<f64>>,
}

impl Subject {
    pub(super) fn new(scene: Value) -> Self {
        Self { scene, map: None }
    }

    /// The scene of this text, without colours.
    pub(super) fn gray(text: &str, resolution: [u32; 2]) -> Result<Self, Failure> {
        let mut scene: Value = serde_json::from_str(text)
            .map_err(|error| Failure::refused(format!("a scene of the report: {error}")))?;
        for surface in scene.get_mut("surfaces").and_then(Value::as_array_mut).into_iter().flatten() {
            // Smooth surfaces have none, and must not get one.
            let Some(reflectance) = surface["material"].get_mut("reflectance") else { continue };
            if let Some(rgb) = reflectance.as_array() {
                let sum: f64 = rgb.iter().filter_map(Value::as_f64).sum();
                *reflectance = json!(sum / rgb.len() as f64);
            }
        }
        scene["camera"]["resolution"] = json!(resolution);
        Ok(Self::new(scene))
    }

    /// The same scene with this value at a path of keys.
    pub(super) fn with(&self, path: &str, value: impl Into<Value>) -> Self {
        let mut changed = self.clone();
        let mut node = &mut changed.scene;
        for key in path.split('.') {
            node = &mut node[key];
        }
        *node = value.into();
        changed
    }

    /// The plan of one replica.
    pub(super) fn plan(
        &self,
        samples_per_pixel: u32,
        seed: u64,
        library: &MediumLibrary,
    ) -> Result<ScenePlan, Failure> {
        let overrides = SceneOverrides { samples_per_pixel: Some(samples_per_pixel), seed: Some(seed) };
        let spec = SceneSpec::parse(&self.scene.to_string(), overrides)?;
        let mut plan = ScenePlan::of(&spec, library)?;
        if let (Some(map), Spectra::Gray(radiant)) = (&self.map, &mut plan.spectra) {
            radiant.lights.background.maps.push(map.clone());
        }
        Ok(plan)
    }

    /// Renders once.
    pub(super) fn render(
        &self,
        samples_per_pixel: u32,
        seed: u64,
        library: &MediumLibrary,
    ) -> Result<Picture, Failure> {
        let plan = self.plan(samples_per_pixel, seed, library)?;
        let resolution = plan.camera.resolution().map(|side| side as usize);
        Ok(Picture { moments: moments(&plan, &|_| {})?, resolution })
    }

    /// Renders `replicas` ≥ 2 independent images.
    pub(super) fn measure(
        &self,
        samples_per_pixel: u32,
        (seed, replicas): (u64, u32),
        library: &MediumLibrary,
    ) -> Result<Replicas, Failure> {
        // Small images are a tile or two: side by side they use all cores.
        let images = try_in_parallel(replicas.max(2) as usize, &|k| {
            self.render(samples_per_pixel, named_seed(seed, &format!("replica {k}")), library)
        })?;
        Ok(Replicas { images, samples_per_pixel })
    }
}

/// An image of a scene.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    moments: Moments,
    resolution: [usize; 2],
}

impl Picture {
    /// Columns and rows.
    pub(super) fn resolution(&self) -> [usize; 2] {
        self.resolution
    }

    /// The mean radiance of each pixel, row by row from the top.
    pub(super) fn means(&self) -> &[[f64; 3]] {
        self.moments.means()
    }

    /// Light by strategy, where the integrator has some.
    pub(super) fn strategies(&self) -> Vec<StrategyShare> {
        self.moments.strategies()
    }

    /// The same of a gray scene.
    fn gray(&self) -> impl Iterator<Item = f64> + '_ {
        self.means().iter().map(|[gray, ..]| *gray)
    }

    /// Means of blocks of `side` x `side` pixels, gray, row by row.
    fn blocks(&self, side: usize) -> Vec<f64> {
        let ([width, height], pixels) = (self.resolution, self.means());
        let block = |row: usize, column: usize| {
            let rows = (row * side..(row + 1) * side).map(|y| &pixels[y * width + column * side..][..side]);
            rows.flatten().map(|[gray, ..]| *gray).sum::<f64>() / (side * side) as f64
        };
        (0..height / side).flat_map(|row| (0..width / side).map(move |column| block(row, column))).collect()
    }

    /// Look-ups per pixel, on average.
    pub(super) fn lookups_per_pixel(&self) -> f64 {
        self.moments.lookups() as f64 / self.means().len() as f64
    }
}

/// Independent images of one scene.
#[derive(Clone, Debug)]
pub(super) struct Replicas {
    images: Vec<Picture>,
    samples_per_pixel: u32,
}

/// Virtual point lights of images, on average.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct VirtualLights {
    pub(super) per_set: f64,
    /// CPU seconds of an image, a part of all.
    pub(super) light_path_seconds: f64,
    /// The share of compensation vertices that lay where something was lost; NaN if none was tried.
    pub(super) share_inside: f64,
}

/// Steps of one kind, with 95 % intervals from independent images.
#[derive(Clone, Debug)]
pub(super) struct Moves {
    pub(super) kind: &'static str,
    /// Mean probability to accept one.
    pub(super) acceptance: Measured,
    /// Part of all accepted steps.
    pub(super) share: Measured,
}

impl Replicas {
    /// The mean over pixels of the squared error of one image, from the sample variance of its pixels: unbiased without a
    /// reference, for an unbiased integrator.
    pub(super) fn squared_error(&self) -> Measured {
        let n = f64::from(self.samples_per_pixel);
        let variance = |image: &Picture| image.moments.variance().unwrap_or(f64::NAN);
        let errors: Vec<f64> = self.images.iter().map(|image| variance(image) / n).collect();
        Measured::positive(&errors)
    }

    /// The mean over pixels of the squared difference of one image from a reference with the squared error `of_reference`, which
    /// is subtracted: right also for a biased integrator.
    pub(super) fn squared_difference(&self, reference: &[f64], of_reference: f64) -> Measured {
        self.squared_difference_in(&(0..reference.len()).collect::<Vec<_>>(), reference, of_reference)
    }

    /// The same over some pixels, whose squared error in the reference is `of_reference` on average.
    pub(super) fn squared_difference_in(
        &self,
        pixels: &[usize],
        reference: &[f64],
        of_reference: f64,
    ) -> Measured {
        let error = |image: &Picture| {
            let squares = pixels.iter().map(|&pixel| (image.means()[pixel][0] - reference[pixel]).powi(2));
            squares.sum::<f64>() / pixels.len() as f64 - of_reference
        };
        Measured::positive(&self.images.iter().map(error).collect::<Vec<_>>())
    }

    /// A function of the squared bias and of the variance of one image, means over pixels, against images of another integrator without a bias. The
    /// noise of both is taken off, and its interval is that of both.
    pub(super) fn bias_and_variance(&self, exact: &Self, function: impl Fn([f64; 2]) -> f64) -> Measured {
        let pixels = self.first().means().len();
        // Mean of a pixel, its squared error, and the variance of one image.
        let moments = |of: &Self, without: Option<usize>, pixel: usize| {
            let kept = of.images.iter().enumerate().filter(|(k, _)| Some(*k) != without);
            let values: stats::Moments = kept.map(|(_, image)| image.means()[pixel][0]).collect();
            let variance = values.sample_variance().unwrap_or(f64::NAN);
            [values.mean().unwrap_or(f64::NAN), variance / values.count() as f64, variance]
        };
        Measured::jackknife([self.images.len(), exact.images.len()], |[one, other]| {
            let mut sums = [0.0; 2];
            for pixel in 0..pixels {
                let [mean, error, variance] = moments(self, one, pixel);
                let [right, its_error, _] = moments(exact, other, pixel);
                sums[0] += (mean - right).powi(2) - error - its_error;
                sums[1] += variance;
            }
            function(sums.map(|sum| sum / pixels as f64))
        })
    }

    /// The first image: what one sees.
    pub(super) fn first(&self) -> &Picture {
        &self.images[0]
    }

    /// The first image for a gallery.
    pub(super) fn picture(
        &self,
        id: impl Into<String>,
        label: impl Into<String>,
        lines: Vec<String>,
        exposure: f64,
    ) -> document::Picture {
        let Picture { moments, resolution } = self.first();
        let pixels = Pixels::Radiance { values: moments.means().to_vec(), exposure };
        document::Picture { id: id.into(), label: label.into(), lines, resolution: *resolution, pixels }
    }

    /// The mean of all images, gray, and its squared error.
    pub(super) fn mean(&self) -> (Vec<f64>, f64) {
        let n = self.images.len() as f64;
        let mut mean = vec![0.0; self.first().gray().count()];
        for image in &self.images {
            for (sum, value) in mean.iter_mut().zip(image.gray()) {
                *sum += value / n;
            }
        }
        (mean, self.squared_error().value / n)
    }

    /// The mean radiance of each image.
    fn means_of_images(&self) -> Vec<f64> {
        self.images.iter().map(|image| image.gray().sum::<f64>() / image.means().len() as f64).collect()
    }

    /// The mean radiance of all images and its standard error, from their scatter: right also where the pixels of an image share
    /// their randomness.
    pub(super) fn mean_of_images(&self) -> (f64, f64) {
        mean_and_error(&self.means_of_images())
    }

    /// The mean radiance of all images with its 95 % interval, from their scatter.
    pub(super) fn measured_mean(&self) -> Measured {
        Measured::mean(&self.means_of_images())
    }

    /// CPU seconds of an image with its 95 % interval.
    pub(super) fn measured_seconds(&self) -> Measured {
        let seconds: Vec<f64> = self.images.iter().map(|image| image.moments.cpu_seconds()).collect();
        Measured::positive(&seconds)
    }

    /// The change of the mean radiance from `other`, image by image of the same seeds, with its 95 % interval.
    pub(super) fn measured_change(&self, other: &Self) -> Measured {
        let pairs = self.means_of_images().into_iter().zip(other.means_of_images());
        Measured::mean(&pairs.map(|(a, b)| a - b).collect::<Vec<_>>())
    }

    /// The change of each block of `side` x `side` pixels from `other`, row by row, with its standard error from the scatter of pairs of
    /// images of the same seeds.
    pub(super) fn changes_of_blocks(&self, other: &Self, side: usize) -> Vec<(f64, f64)> {
        let [ours, theirs] = [self, other].map(|of| of.blocks(side));
        let changes = |k: usize| ours.iter().zip(&theirs).map(move |(a, b)| a[k] - b[k]).collect::<Vec<_>>();
        (0..ours[0].len()).map(|k| mean_and_error(&changes(k))).collect()
    }

    /// Means of blocks of each image.
    fn blocks(&self, side: usize) -> Vec<Vec<f64>> {
        self.images.iter().map(|image| image.blocks(side)).collect()
    }

    /// The mean of all images in blocks of `side` x `side` pixels, gray, and its squared errors, from the scatter of the images.
    pub(super) fn mean_of_blocks(&self, side: usize) -> (Vec<f64>, Vec<f64>) {
        let blocks = self.blocks(side);
        let count = blocks[0].len();
        let all = (0..count).map(|k| mean_and_error(&blocks.iter().map(|of| of[k]).collect::<Vec<_>>()));
        let (means, errors): (Vec<f64>, Vec<f64>) = all.unzip();
        (means, errors.iter().map(|error| error * error).collect())
    }

    /// Steps of chains by their kind: the mean probability to accept one, and their part in all that were accepted; empty without chains.
    pub(super) fn moves(&self) -> Vec<Moves> {
        let accepted =
            |image: &Picture| image.moments.steps().iter().map(|(_, steps)| steps.accepted).sum::<f64>();
        let of_kind = |(place, &(kind, _)): (usize, &(&'static str, Acceptance))| {
            let of_images = |of: &dyn Fn(&Picture, Acceptance) -> f64| {
                let each = self.images.iter().map(|image| of(image, image.moments.steps()[place].1));
                Measured::mean(&each.collect::<Vec<_>>())
            };
            Moves {
                kind,
                acceptance: of_images(&|_, steps| steps.mean().unwrap_or(f64::NAN)),
                share: of_images(&|image, steps| steps.accepted / accepted(image)),
            }
        };
        self.first().moments.steps().iter().enumerate().map(of_kind).collect()
    }

    /// The virtual point lights that the images told of, if they had any.
    pub(super) fn virtual_lights(&self) -> VirtualLights {
        let n = self.images.len() as f64;
        let mean =
            |of: fn(&Moments) -> f64| self.images.iter().map(|image| of(&image.moments)).sum::<f64>() / n;
        VirtualLights {
            per_set: mean(Moments::lights_per_set),
            light_path_seconds: mean(Moments::light_path_seconds),
            share_inside: mean(|moments| moments.compensation_share().unwrap_or(f64::NAN)),
        }
    }

    /// Look-ups per pixel of one image, on average.
    pub(super) fn lookups_per_pixel(&self) -> f64 {
        let n = self.images.len() as f64;
        self.images.iter().map(Picture::lookups_per_pixel).sum::<f64>() / n
    }

    /// CPU seconds of one image, on average.
    pub(super) fn seconds(&self) -> f64 {
        self.images.iter().map(|image| image.moments.cpu_seconds()).sum::<f64>() / self.images.len() as f64
    }

    /// Camera rays per pixel of one image.
    pub(super) fn rays_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    /// True if the pixels have more than one sample, so that their variance is known.
    pub(super) fn variance_is_known(&self) -> bool {
        self.samples_per_pixel > 1
    }
}
